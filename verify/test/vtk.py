#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""vtk.py SPHPROOF: legacy files of VTK, as text and binary, with arrays as SCALARS, VECTORS and FIELD, are judged
like the table of the same particles; every truncated file is reported. (Other refusals: test_readers_text_faults.)"""
import itertools
import json
import random
import struct

from script import check, play, said

draw = random.Random(5)


def judged(path):
    return said("judge", path, "--case", "taylor_green", "--time", "0", "--allow-far", "--json", "-")


# types of integers, as letters of struct; each document has two of them, the next ones in turn
LETTERS = {b"unsigned_int": "I", b"vtkIdType": "i", b"char": "b", b"unsigned_char": "B", b"short": "h", b"unsigned_short": "H",
           b"int": "i", b"long": "q", b"unsigned_long": "Q", b"vtktypeint64": "q"}
WHOLE = itertools.cycle(LETTERS)
METADATA = b"METADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 1 7\n\n"


def make(points, binary, field, grid, kind):
    """As DualSPHysics (SCALARS, VECTORS) or PySPH's converter (FIELD) writes it, with their names."""
    def numbers(rows, of):
        if binary:
            return struct.pack(">%d%s" % (len(rows) * len(rows[0]), of[0]), *(v for row in rows for v in row)) + b"\n"
        return "".join(" ".join(map(repr, row)) + "\n" for row in rows).encode()

    n = len(points)
    paired = field != grid  # offsets and connectivity, as in version 5.1
    text = b"# vtk DataFile Version %s\nparticles\n" % (b"5.1" if paired else b"3.0") + (b"BINARY\n" if binary else b"ASCII\n")
    text += b"DATASET UNSTRUCTURED_GRID\n" if grid else b"DATASET POLYDATA\n"
    text += b"POINTS %d %s\n" % (n, kind) + numbers([(x, y, 0.0) for x, y, *_ in points], kind.decode())
    text += b"CELLS" if grid else b"VERTICES"
    if paired:
        text += b" %d %d\nOFFSETS vtktypeint64\n" % (n + 1, n) + numbers([(i,) for i in range(n + 1)], "q")
        text += b"CONNECTIVITY vtktypeint64\n" + numbers([(i,) for i in range(n)], "q")
    else:
        text += b" %d %d\n" % (n, 2 * n) + numbers([(1, i) for i in range(n)], "i")
    if grid:
        text += b"CELL_TYPES %d\n" % n + numbers([(1,)] * n, "i")
    if grid:  # as ParaView writes it: cell data first, and metadata after each array
        text += b"CELL_DATA %d\nSCALARS rho %s 1\nLOOKUP_TABLE default\n" % (n, kind) + numbers([(7.0,)] * n, kind.decode())
        text += b"VECTORS vel %s\n" % kind + numbers([(7.0, 8.0, 9.0)] * n, kind.decode())
        text += b"FIELD FieldData 2\n" + b"".join(b"%s 1 %d int\n" % (name, n) + numbers([(7,)] * n, "i") for name in (b"u", b"m"))
    text += b"POINT_DATA %d\n" % n
    arrays = [(name, next(WHOLE), [(i,) for i in range(n)]) for name in (b"Idp", b"Type")]
    arrays += [(b"Vel", kind, [(p[2], p[3], 0.0) for p in points]),
              (b"Rhop", kind, [(p[5],) for p in points]), (b"Mass", kind, [(p[4],) for p in points])]
    draw.shuffle(arrays)
    if field:
        text += b"FIELD FieldData %d\n" % len(arrays)
    for name, type_, rows in arrays:
        if field:
            text += b"%s %d %d %s\n" % (name, len(rows[0]), n, type_)
        elif len(rows[0]) == 3:
            text += b"VECTORS %s %s\n" % (name, type_)
        else:
            text += b"SCALARS %s %s%s\nLOOKUP_TABLE default\n" % (name, type_, draw.choice((b"", b" 1")))
        text += numbers(rows, LETTERS.get(type_, type_.decode()))
        if field and paired and name != arrays[-1][0]:
            text += METADATA
    # the last number ends the file, or the last metadata do, with an empty line or in the middle of a line
    return text[:-1] if not field or grid else text + METADATA[:draw.choice((None, -2))]


def main():
    points = [(draw.random(), draw.random(), draw.gauss(0, 1), draw.gauss(0, 1), 0.0025, draw.uniform(0.9, 1.1)) for _ in range(40)]
    with open("a.csv", "w") as file:
        file.write("x,y,vx,vy,m,rho\n" + "".join(",".join(map(repr, p)) + "\n" for p in points))
    want = json.loads(judged("a.csv")[1])["errors"]["velocity"]["l1"]
    for binary in False, True:
        for field in False, True:
            for grid in False, True:
                for kind in b"double", b"float":
                    text = make(points, binary, field, grid, kind)
                    with open("a.vtk", "wb") as file:
                        file.write(text)
                    code, out, err = judged("a.vtk")
                    have = json.loads(out)["errors"]["velocity"]["l1"] if out else 0
                    bound = 1e-12 if kind == b"double" or not binary else 1e-6
                    check(abs(have / want - 1) < bound, binary, field, grid, kind, have, want, err)
        for cut in draw.sample(range(40, len(text) - 200), 12):
            with open("cut.vtk", "wb") as file:
                file.write(text[:cut])
            code, out, err = judged("cut.vtk")
            check(code == 2 and "cut.vtk" in err and not out, "cut off at", cut, code, err)


play(main)
