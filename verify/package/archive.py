#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The static library as one object in which only the public names are global.

  archive.py OUT OBJCOPY AR PUBLIC.a OTHER.a... -- CC...

All of PUBLIC.a and what it needs of the others is linked into an object; names of the rooms (kernel_value,
sort ...) become local to it, so that they cannot clash with those of a program that links the library."""
import os
import subprocess
import sys


def main(out, objcopy, ar, *rest):
    split = rest.index("--")
    public, others, cc = rest[0], list(rest[1:split]), list(rest[split + 1:])
    whole = out + ".o"
    subprocess.run(cc + ["-r", "-nostdlib", "-o", whole, "-Wl,--whole-archive", public, "-Wl,--no-whole-archive",
                         "-Wl,--start-group"] + others + ["-Wl,--end-group"], check=True)
    subprocess.run([objcopy, "--wildcard", "--keep-global-symbol=sphproof_*", whole], check=True)
    if os.path.exists(out):
        os.remove(out)
    subprocess.run([ar, "rcsD", out, whole], check=True)
    os.remove(whole)


if __name__ == "__main__":
    if len(sys.argv) < 7:
        sys.exit(__doc__)
    main(*sys.argv[1:])
