# SPDX-License-Identifier: GPL-3.0-or-later
"""vtu.py SPHPROOF [DRAWS] [--others] [--seed SEED]: snapshots for ParaView (`--snapshot F.vtu`). In random setups in
1, 2 and 3 dimensions every number is, to the last bit, that of the same run's CSV; values of the whole run are there;
a series has a collection; judge finds the same as in CSV, also if arrays are compressed and appended as other
programs write them. With --others VTK and meshio, if one is installed for this Python or the system's, must read the
same bits."""
import base64
import json
import os
import random
import struct
import subprocess
import sys
import xml.etree.ElementTree as tree
import zlib

from script import call, play

DRAWS = int(sys.argv[2]) if sys.argv[2:] and sys.argv[2].isdigit() else 2
KINDS = {"Float64": "d", "Int64": "q", "UInt8": "B", "Int32": "i"}
NAMES = {"m": "mass", "rho": "density", "u": "internal_energy", "P": "pressure", "h": "smoothing_length"}
OTHERS = r"""
import sys
def bits(array):
    return array.tobytes().hex()
fields = ["velocity", "mass", "density", "pressure", "internal_energy", "smoothing_length", "particle_spacing"]
if sys.argv[1] == "vtk":
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
    from vtkmodules.util.numpy_support import vtk_to_numpy
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(sys.argv[2])
    reader.Update()
    grid = reader.GetOutput()
    assert grid.GetNumberOfCells() == grid.GetNumberOfPoints() and grid.GetCellType(0) == 1
    assert reader.GetNumberOfTimeSteps() in (0, 1) and grid.GetFieldData().GetArray("TimeValue").GetNumberOfTuples() == 1
    print(bits(vtk_to_numpy(grid.GetPoints().GetData())))
    for name in fields:
        print(bits(vtk_to_numpy(grid.GetPointData().GetArray(name))))
    for name in ("TimeValue", "gamma", "box"):
        print(bits(vtk_to_numpy(grid.GetFieldData().GetArray(name))))
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetInputData(grid)
    for mode in ("Ascii", "Binary", "Appended"):
        for packed in (False, True):
            getattr(writer, "SetDataModeTo" + mode)()
            writer.SetCompressorTypeToZLib() if packed else writer.SetCompressorTypeToNone()
            for encoded in (0, 1):
                writer.SetEncodeAppendedData(encoded)
                writer.SetFileName("again_%s_%d_%d.vtu" % (mode, packed, encoded))
                writer.Write()
else:
    import meshio
    mesh = meshio.read(sys.argv[2])
    assert mesh.cells[0].type == "vertex"
    for array in [mesh.points] + [mesh.point_data[name] for name in fields] + [mesh.field_data[name] for name in ("TimeValue", "gamma", "box")]:
        print(bits(array))
    mesh.write("again_meshio.vtu", binary=True)
"""
TESTERS = "--others" in sys.argv and [(python, word) for word, module in (("vtk", "vtkmodules.vtkIOXML"), ("meshio", "meshio"))
           for python in [next((p for p in (sys.executable, "/usr/bin/python3") if os.path.exists(p) and subprocess.run(
               [p, "-c", "import " + module], capture_output=True, check=False).returncode == 0), None)] if python]


def run(*words, status=0):
    done = call(*words, status=status)
    return done.stdout + done.stderr


def setup(draw):
    """The arguments of a run: few particles, a random start and time."""
    state = lambda: "%.3g %.3g %.3g" % (draw.uniform(0.2, 2), draw.uniform(-0.3, 0.3), draw.uniform(0.2, 2))
    side = draw.randint(12, 18)
    return draw.choice([
        ["sod", "n=%d" % draw.randint(40, 120), "left=" + state(), "right=" + state(), "t_end=%.4g" % draw.uniform(0, 0.04)],
        ["gresho", "n=%d^2" % side, "boost=%.3g %.3g" % (draw.uniform(-1, 1), draw.uniform(-1, 1)), "t_end=%.4g" % draw.uniform(0, 0.05)],
        ["kelvin_helmholtz_mode", "n=%d^2" % side, "t_end=%.4g" % draw.uniform(0, 0.05)],
        ["noh_3d", "n=%d^3" % draw.randint(10, 12), "t_end=%.4g" % draw.uniform(0, 0.01)]])


def csv_of(path):
    with open(path, encoding="utf-8") as file:
        lines = file.read().split("\n")[:-1]
    rows = [[float(value) for value in line.split(",")] for line in lines[1:] if line[0] != "#"]
    said = dict(line[2:].split(" = ", 1) for line in lines if line.startswith("# ") and " = " in line)
    return {name: [row[k] for row in rows] for k, name in enumerate(lines[0].split(","))}, said


def array_of(element):
    if element.get("format") == "ascii":
        return [(int if element.get("type") != "Float64" else float)(word) for word in element.text.split()]
    data = base64.b64decode(element.text.strip(), validate=True)
    assert struct.unpack("=Q", data[:8])[0] == len(data) - 8
    return list(struct.unpack("=%d%s" % ((len(data) - 8) / struct.calcsize(KINDS[element.get("type")]), KINDS[element.get("type")]), data[8:]))


def vtu_of(path):
    root = tree.parse(path).getroot()
    assert root.attrib == {"type": "UnstructuredGrid", "version": "1.0", "header_type": "UInt64",
                           "byte_order": "LittleEndian" if sys.byteorder == "little" else "BigEndian"}, root.attrib
    piece = root.find("UnstructuredGrid/Piece")
    arrays = {e.get("Name"): array_of(e) for e in piece.iter("DataArray")}
    fields = {e.get("Name"): array_of(e) for e in root.find("UnstructuredGrid/FieldData")}
    assert piece.get("NumberOfPoints") == piece.get("NumberOfCells")
    return int(piece.get("NumberOfPoints")), arrays, fields


def same(what, got, want):
    assert len(got) == len(want) and len(want) > 0, (what, len(got), len(want))
    assert struct.pack("=%dd" % len(got), *got) == struct.pack("=%dd" % len(want), *want), what


def compare(csv, said, n, arrays, fields):
    axes = [a for a in "xyz" if a in csv]
    zero = [0.0] * n
    for name, letters in (("Points", "xyz"), ("velocity", ["vx", "vy", "vz"])):
        same(name, arrays[name], [value for row in zip(*(csv.get(k, zero) for k in letters)) for value in row])
    for short, name in NAMES.items():
        same(name, arrays[name], csv[short])
    for d, m, rho in zip(arrays["particle_spacing"], csv["m"], csv["rho"]):
        assert abs(d - (m / rho) ** (1 / len(axes))) < 1e-14 * d
    assert arrays["connectivity"] == list(range(n)) and arrays["offsets"] == list(range(1, n + 1)) and arrays["types"] == [1] * n
    same("time", fields["TimeValue"], [float(said["time"])])
    same("gamma", fields["gamma"], [float(said["gamma"])])
    same("box", fields["box"], [float(end) for part in said["box"].split() for end in part.split(":")])
    assert fields["ndims"] == [len(axes)], fields["ndims"]
    for key in ("case", "boundary", "keys"):
        assert bytes(fields[key]).decode() == said[key], (key, fields[key])


def packed(path, to, raw, single_blocks):
    """The same file as written by VTK: zlib, appended, sizes of 32 bits."""
    root = tree.parse(path).getroot()
    root.set("compressor", "vtkZLibDataCompressor")
    root.attrib.pop("header_type")
    data = b""
    for element in root.iter("DataArray"):
        if element.get("format") != "binary":
            continue
        plain = base64.b64decode(element.text.strip())[8:]
        size = len(plain) if single_blocks else 1000
        blocks = [plain[k:k + size] for k in range(0, len(plain), size)]
        small = [zlib.compress(block) for block in blocks]
        head = struct.pack("=%dI" % (3 + len(small)), len(small), size, len(blocks[-1]) % size, *map(len, small))
        element.set("format", "appended")
        element.set("offset", str(len(data)))
        element.text = None
        data += head + b"".join(small) if raw else base64.b64encode(head) + base64.b64encode(b"".join(small))
    text = tree.tostring(root).replace(b"</VTKFile>", b'<AppendedData encoding="%s">_' % (b"raw" if raw else b"base64"))
    with open(to, "wb") as file:
        file.write(text + data + b"</AppendedData></VTKFile>")


def judged(path):
    document = json.loads(run("judge", path, "--allow-far", "--json", "-", "--quiet"))
    return {key: document[key] for key in ("case", "time", "errors", "gamma", "settings") if key in document}


def random_setups(draw):
    for number in range(DRAWS):
        words = ["run", *setup(draw), "--quiet", "--threads", "1"]
        run(*words, "--snapshot", "s.csv")
        run(*words, "--snapshot", "s.vtu")
        csv, said = csv_of("s.csv")
        n, arrays, fields = vtu_of("s.vtu")
        compare(csv, said, n, arrays, fields)
        result = judged("s.csv")
        packed("s.vtu", "raw.vtu", True, draw.random() < 0.5)
        packed("s.vtu", "base.vtu", False, draw.random() < 0.5)
        for name in ("s.vtu", draw.choice(["raw.vtu", "base.vtu"])):
            assert judged(name) == result and result["errors"], (words, name)
        if TESTERS and number < 4:
            for python, word in TESTERS:
                got = subprocess.run([python, "-c", OTHERS, word, "s.vtu"], capture_output=True, text=True, check=True).stdout.split()
                want = [struct.pack("=%dd" % len(a), *a).hex() for a in
                        [arrays[k] for k in ["Points", "velocity", "mass", "density", "pressure", "internal_energy",
                                             "smoothing_length", "particle_spacing"]] +
                        [fields[k] for k in ("TimeValue", "gamma", "box")]]
                assert got == want, (word, words)
                again = sorted(name for name in os.listdir(".") if name.startswith("again"))
                assert len(again) == (12 if word == "vtk" else 1)
                for name in again:  # files that they write; meshio keeps no fields, VTK's text has 6 to 12 digits
                    if word == "vtk" and "Ascii" not in name:
                        assert judged(name) == result, (name, words)
                    else:
                        run("judge", name, "--case", result["case"], "--allow-far", "--time", repr(result["time"]))
                    os.remove(name)


def series():
    """A collection names all snapshots, each with its time; one that could not be written is left out."""
    os.makedirs("a & b/lost_0001.vtu/full")
    run("run", "sod", "n=64", "t_end=0.05", "--snapshot", "a & b/s \"1\".vtu", "--snapshot-every", "0.02")
    root = tree.parse("a & b/s \"1\".pvd").getroot()
    assert root.get("type") == "Collection"
    got = [(e.get("file"), float(e.get("timestep"))) for e in root.iter("DataSet")]
    assert got == [('s "1"_0000.vtu', 0), ('s "1"_0001.vtu', 0.02), ('s "1"_0002.vtu', 0.04), ('s "1".vtu', 0.05)], got
    for name, time in got:
        assert vtu_of(os.path.join("a & b", name))[2]["TimeValue"] == [time]
    said = run("run", "sod", "n=64", "t_end=0.05", "--snapshot", "a & b/lost.vtu", "--snapshot-every", "0.02", status=4)
    assert "lost_0001.vtu" in said
    got = [e.get("file") for e in tree.parse("a & b/lost.pvd").getroot().iter("DataSet")]
    assert got == ["lost_0000.vtu", "lost_0002.vtu", "lost.vtu"], got


def refused():
    said = run("run", "sod", "--snapshot", "s.vtk", status=2)
    assert "'.vtk'; allowed: .csv" in said and ".vtu" in said, said


seed = int(sys.argv[sys.argv.index("--seed") + 1]) if "--seed" in sys.argv else random.randrange(1 << 30)
print("seed", seed)
if TESTERS is not False:
    print("also read by: %s" % (", ".join(word for _, word in TESTERS) or "nobody, as neither VTK nor meshio is here"))
play(lambda: random_setups(random.Random(seed)), series, refused)
