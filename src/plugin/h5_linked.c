/* SPDX-License-Identifier: GPL-3.0-or-later
 * A program that is linked with HDF5, for h5_soname.py to look at. */
#include <hdf5.h>

int main(void)
{
    return H5open() < 0;
}
