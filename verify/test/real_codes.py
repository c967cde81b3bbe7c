# SPDX-License-Identifier: GPL-3.0-or-later
"""real_codes.py SPHPROOF: PySPH, an independent code, computes Sod's tube and Gresho's vortex with its code file,
within the file's gates; it starts from our particles; and planted faults are detected: another gamma, viscosity,
particles of its own."""
import os
import shutil
import subprocess
import sys

from script import json_of, play, read, write

CODES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "examples", "codes")
COMMAND = "command = /usr/bin/python3 pysph_driver.py @IC@ @OUT@ --t-end @T_END@\n"


def document(*words, status=0):
    return json_of(*words, "--code", "pysph.ini", status=status, timeout=600)


def gates(case, status, keys=()):
    """The ladder of the code file; each n once, without replicates."""
    found = document("converge", case, *keys, "--replicates", "1", "--jobs", "2", status=status != "pass")
    reported = [order["status"] for order in found["orders"] if order["gate"]]
    assert reported == [status], (case, reported, found["orders"])


def test_pysph():
    for name in "pysph.ini", "pysph_driver.py":
        shutil.copy(os.path.join(CODES, name), name)
    text = read("pysph.ini")
    faults = dict(part.split("]\n", 1) for part in text.split("[fault ")[1:])
    assert set(faults) == {"gamma", "viscosity"} and text.count(COMMAND) == 1, faults
    document("run", "sod", "n=60")  # compiles its equations for 1D
    document("run", "gresho", "n=8^2", "t_end=0.01")  # and for 2D
    gates("sod", "pass")
    gates("gresho", "pass")
    right = document("run", "gresho", "n=16^2")
    assert right["conservation"]["momentum"] < 1e-12 and 1e-6 < right["conservation"]["energy"] < 1e-3, right["conservation"]
    for name, case in ("gamma", "sod"), ("viscosity", "gresho"):
        write("pysph.ini", text.replace(COMMAND, faults[name].strip().splitlines()[0] + "\n"))
        gates(case, "fail")
    write("pysph.ini", text.replace(COMMAND, COMMAND.replace("\n", " --shift 0.3\n")))
    own = document("run", "sod", "n=100", status=3)
    assert own["reason"] == "ignored_ic" and "out_000.csv: positions along x" in own["message"], own["message"]


if subprocess.run(["/usr/bin/python3", "-c", "import pysph.solver.application, pysph.base.nnps"], capture_output=True).returncode:
    print("no PySPH (Debian's package python3-pysph): skipped")
    sys.exit(77)
play(test_pysph)
