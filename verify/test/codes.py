# SPDX-License-Identifier: GPL-3.0-or-later
"""codes.py SPHPROOF: the small codes of verify/examples/codes solve Sod's tube and Gresho's vortex as well as their
schemes can, by judge's verdict on their snapshots, and each planted fault is told by an error or by conservation."""
import json
import os
import subprocess
import sys
import tempfile

PROGRAM = os.path.abspath(sys.argv[1])
CODE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "examples", "codes", "sph.py")
SOD = 0.0105  # L1 of density of 396 particles: the scheme has 0.0089, the smallest fault 0.0110


def call(*words):
    done = subprocess.run(words, capture_output=True, text=True, timeout=300)
    assert done.returncode in (0, 1), (words, done)
    return done.stdout


def solved(start, case, t_end, *words):
    """What judge says of a run of the code, from its own initial state on."""
    ending = os.path.splitext(start)[1]
    call("/usr/bin/python3", os.path.abspath(CODE), start, "out", "--t-end", t_end, *words)
    return json.loads(call(PROGRAM, "judge", "out_000" + ending, "out_001" + ending, "--case", case, "--json", "-"))


def test_sod():
    call(PROGRAM, "ic", "sod", "n=396", "--format", "csv", "--out", "sod.csv")
    right = solved("sod.csv", "sod", "0.2")
    assert 0.007 < right["errors"]["density"]["l1"] < SOD, right["errors"]
    assert right["kernel"]["name"] == "wendland_c4" and right["conservation"]["momentum"] < 1e-14, right
    for fault in ("gamma", "first_order", "viscosity", "width"):
        wrong = solved("sod.csv", "sod", "0.2", "--fault", fault)
        assert wrong["errors"]["density"]["l1"] > SOD, (fault, wrong["errors"])
    leak = solved("sod.csv", "sod", "0.2", "--fault", "momentum")
    assert leak["conservation"]["momentum"] > 1e-6, leak["conservation"]


def test_gresho():
    call(PROGRAM, "ic", "gresho", "n=24^2", "--format", "gadget_hdf5", "--out", "gresho.hdf5")
    got = solved("gresho.hdf5", "gresho", "0.3")
    assert 0.01 < got["errors"]["velocity"]["l1"] < 0.1 and got["conservation"]["momentum"] < 1e-14, got


def test_ladder():
    """The code file beside it: gates hold."""
    done = subprocess.run([PROGRAM, "converge", "sod", "--code", CODE.replace(".py", ".ini"), "--replicates", "1", "--json", "-"],
                          capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done
    gates = [order["status"] for order in json.loads(done.stdout)["orders"] if order["gate"]]
    assert gates == ["pass"], gates


if subprocess.run(["/usr/bin/python3", "-c", "import numpy"], capture_output=True).returncode:
    print("no numpy: skipped")
    sys.exit(77)
with tempfile.TemporaryDirectory() as work:
    os.chdir(work)
    test_sod()
    test_ladder()
    if not subprocess.run(["/usr/bin/python3", "-c", "import h5py"], capture_output=True).returncode:
        test_gresho()
    os.chdir("/")
