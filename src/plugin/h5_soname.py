# SPDX-License-Identifier: GPL-3.0-or-later
"""h5_soname.py PROGRAM HEADER: writes the name by which a program that is linked with HDF5 asks for its library."""
import re
import sys

with open(sys.argv[1], "rb") as program:
    found = re.search(rb"\0([^\0]*libhdf5[^\0/]*(\.so[.\d]*|\.dylib))\0", program.read())
if not found:
    sys.exit("HDF5 is not there as a shared library; -Dhdf5=disabled leaves it out")
with open(sys.argv[2], "w", encoding="ascii") as header:
    header.write('/* made by h5_soname.py */\n#define H5_SONAME "%s"\n' % found.group(1).decode())
