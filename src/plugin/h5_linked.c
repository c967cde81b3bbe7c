/* SPDX-License-Identifier: GPL-3.0-or-later
 * A program linked with HDF5, examined by h5_soname.py. */
#include <hdf5.h>

int main(void)
{
    return H5open() < 0;
}
