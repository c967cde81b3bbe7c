# SPDX-License-Identifier: GPL-3.0-or-later
"""codes.py SPHPROOF SPH: the small codes of verify/examples/codes (SPH: the compiled one in C) solve Sod's tube and
Gresho's vortex as well as their schemes can, by judge's verdict and the gates of their files, and each planted fault
is detected."""
import os
import shutil
import subprocess
import sys

from script import call, json_of, play, read, write

C_PROGRAM = os.path.abspath(sys.argv[2])
CODES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "examples", "codes")
CODE = os.path.join(CODES, "sph.py")
SOD = 0.0105  # L1 of density with 396 particles: the scheme has 0.0089, the smallest fault 0.0110


def solved(start, case, t_end, *words):
    """The verdict of judge on a run of the code from its own initial state."""
    ending = os.path.splitext(start)[1]
    subprocess.run(["/usr/bin/python3", os.path.abspath(CODE), start, "out", "--t-end", t_end, *words], check=True)
    return json_of("judge", "out_000" + ending, "out_001" + ending, "--case", case, status=None)


def test_sod():
    call("ic", "sod", "n=396", "--format", "csv", "--out", "sod.csv")
    right = solved("sod.csv", "sod", "0.2")
    assert 0.007 < right["errors"]["density"]["l1"] < SOD, right["errors"]
    assert right["kernel"]["name"] == "wendland_c4" and right["conservation"]["momentum"] < 1e-14, right
    for fault in ("gamma", "first_order", "viscosity", "width"):
        wrong = solved("sod.csv", "sod", "0.2", "--fault", fault)
        assert wrong["errors"]["density"]["l1"] > SOD, (fault, wrong["errors"])
    leak = solved("sod.csv", "sod", "0.2", "--fault", "momentum")
    assert leak["conservation"]["momentum"] > 1e-6, leak["conservation"]


def test_gresho():
    call("ic", "gresho", "n=24^2", "--format", "gadget_hdf5", "--out", "gresho.hdf5")
    got = solved("gresho.hdf5", "gresho", "0.3")
    assert 0.01 < got["errors"]["velocity"]["l1"] < 0.1 and got["conservation"]["momentum"] < 1e-14, got


def ladder(case, code_file, status):
    """Tests that the only gate has this status, pass or fail."""
    found = json_of("converge", case, "--code", code_file, "--replicates", "1", status=status != "pass")
    gates = [order["status"] for order in found["orders"] if order["gate"]]
    assert gates == [status], (case, code_file, gates)


def test_ladder():
    """The gates of the code file beside it hold."""
    ladder("sod", CODE.replace(".py", ".ini"), "pass")


def test_c():
    """The code in C: the gates of its file hold, judge finds its kernel, and each fault in its file fails a gate."""
    shutil.copy(C_PROGRAM, "sph")
    text = read(os.path.join(CODES, "sph_c.ini"))
    right = "command = sph @IC@ @OUT@ @T_END@\n"
    faults = [part.split("]")[0] for part in text.split("[fault ")[1:]]
    assert text.count(right) == 1 and faults == ["gamma", "viscosity"], faults
    for fault in [""] + faults:
        write("sph_c.ini", text.replace(right, right.replace("\n", " %s\n" % fault)))
        ladder("sod", "sph_c.ini", "fail" if fault else "pass")
    write("sph_c.ini", text)
    ladder("gresho", "sph_c.ini", "pass")
    found = json_of("run", "sod", "--code", "sph_c.ini")
    assert found["judged"]["kernel"]["name"] == "cubic_spline" and found["conservation"]["momentum"] < 1e-14, found


def there(module):
    return not subprocess.run(["/usr/bin/python3", "-c", "import " + module], capture_output=True).returncode


def test_calibrate():
    """Each fault that was calibrated is detected by a gate; the ladder fails with the fault and passes without it."""
    for name in ("sph.py", "sph.ini"):
        shutil.copy(os.path.join(CODES, name), name)
    write("sph.ini", read("sph.ini").replace("n = 12^2 16^2 20^2 24^2", "n = 8^2 10^2 12^2 14^2"))
    words = ("gresho", "--cache", "kept", "--quiet")
    found = json_of("calibrate", "sph.ini", *words, "--runs", "2")["cases"][0]
    assert {fault["name"]: fault["status"] for fault in found["faults"]} == dict.fromkeys(
        ("gamma", "viscosity", "momentum", "first_order", "width"), "seen"), found["faults"]
    # changes of the initial state by 2 units in the last place have a small effect
    assert all(0 < gate["spread"] < 1e-9 for gate in found["gates"] if gate["name"].endswith("_l1")), found["gates"]
    for fault in ("", "gamma", "viscosity", "momentum", "first_order", "width"):
        text = read("sph.calibrated.ini")
        if fault:
            text = text.replace("--t-end @T_END@\n", "--t-end @T_END@ --fault " + fault + "\n", 1)
        write("mine.ini", text)
        call("converge", words[0], "--code", "mine.ini", *words[1:], status=bool(fault))
        if fault in ("", "momentum"): # a report has the same status
            write("mine.ini", text.replace(text[text.index("[case sod]"):text.index("[case gresho]")], ""))
            call("report", "--code", "mine.ini", "--out", "page", status=bool(fault))


def skip():
    print("no numpy: the code in Python is skipped")
    sys.exit(77)


play(test_c, *([test_gresho] if there("h5py") else []), *((test_sod, test_ladder, test_calibrate) if there("numpy") else (skip,)))
