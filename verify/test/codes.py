# SPDX-License-Identifier: GPL-3.0-or-later
"""codes.py SPHPROOF SPH: the small codes of verify/examples/codes (SPH: the one in C, compiled) solve Sod's tube and
Gresho's vortex as well as their schemes can, by judge's verdict and the gates of their files, and each planted fault is told."""
import json
import os
import shutil
import subprocess
import sys
import tempfile

PROGRAM = os.path.abspath(sys.argv[1])
C_PROGRAM = os.path.abspath(sys.argv[2])
CODES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "examples", "codes")
CODE = os.path.join(CODES, "sph.py")
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


def ladder(case, code_file, status):
    """Of the gate and of nothing else: pass, fail."""
    done = subprocess.run([PROGRAM, "converge", case, "--code", code_file, "--replicates", "1", "--json", "-"],
                          capture_output=True, text=True, timeout=300)
    assert done.returncode == (status != "pass"), done
    gates = [order["status"] for order in json.loads(done.stdout)["orders"] if order["gate"]]
    assert gates == [status], (case, code_file, gates)


def test_ladder():
    """The code file beside it: gates hold."""
    ladder("sod", CODE.replace(".py", ".ini"), "pass")


def test_c():
    """The code in C: gates of its file hold, judge finds its kernel, and each fault that the file plants fails a gate."""
    shutil.copy(C_PROGRAM, "sph")
    with open(os.path.join(CODES, "sph_c.ini"), encoding="ascii") as file:
        text = file.read()
    right = "command = sph @IC@ @OUT@ @T_END@\n"
    faults = [part.split("]")[0] for part in text.split("[fault ")[1:]]
    assert text.count(right) == 1 and faults == ["gamma", "viscosity"], faults
    for fault in [""] + faults:
        with open("sph_c.ini", "w", encoding="ascii") as file:
            file.write(text.replace(right, right.replace("\n", " %s\n" % fault)))
        ladder("sod", "sph_c.ini", "fail" if fault else "pass")
    with open("sph_c.ini", "w", encoding="ascii") as file:
        file.write(text)
    ladder("gresho", "sph_c.ini", "pass")
    found = json.loads(call(PROGRAM, "run", "sod", "--code", "sph_c.ini", "--json", "-"))
    assert found["judged"]["kernel"]["name"] == "cubic_spline" and found["conservation"]["momentum"] < 1e-14, found


def there(module):
    return not subprocess.run(["/usr/bin/python3", "-c", "import " + module], capture_output=True).returncode


def test_calibrate():
    """Of all faults each is seen by a gate, which then fails the ladder, and passes it without the fault."""
    for name in ("sph.py", "sph.ini"):
        shutil.copy(os.path.join(CODES, name), name)
    with open("sph.ini", encoding="ascii") as file:
        text = file.read().replace("n = 12^2 16^2 20^2 24^2", "n = 8^2 10^2 12^2 14^2")
    write("sph.ini", text)
    words = ("gresho", "--cache", "kept", "--quiet")
    done = subprocess.run([PROGRAM, "calibrate", "sph.ini", *words, "--runs", "2", "--json", "-"], capture_output=True, text=True,
                          timeout=300)
    assert done.returncode == 0, done
    found = json.loads(done.stdout)["cases"][0]
    assert {fault["name"]: fault["status"] for fault in found["faults"]} == dict.fromkeys(
        ("gamma", "viscosity", "momentum", "first_order", "width"), "seen"), found["faults"]
    # 2 units in the last place of the start change something, and little
    assert all(0 < gate["spread"] < 1e-9 for gate in found["gates"] if gate["name"].endswith("_l1")), found["gates"]
    for fault in ("", "gamma", "viscosity", "momentum", "first_order", "width"):
        with open("sph.calibrated.ini", encoding="ascii") as file:
            text = file.read()
        if fault:
            text = text.replace("--t-end @T_END@\n", "--t-end @T_END@ --fault " + fault + "\n", 1)
        write("mine.ini", text)
        done = subprocess.run([PROGRAM, "converge", words[0], "--code", "mine.ini", *words[1:]], capture_output=True, timeout=300)
        assert done.returncode == (1 if fault else 0), (fault, done)
        if fault in ("", "momentum"): # a report says the same
            write("mine.ini", text.replace(text[text.index("[case sod]"):text.index("[case gresho]")], ""))
            done = subprocess.run([PROGRAM, "report", "--code", "mine.ini", "--out", "page"], capture_output=True, timeout=300)
            assert done.returncode == (1 if fault else 0), (fault, done)


def write(name, text):
    with open(name, "w", encoding="ascii") as file:
        file.write(text)


with tempfile.TemporaryDirectory() as work:
    os.chdir(work)
    test_c()
    if there("numpy"):
        test_sod()
        test_ladder()
        test_calibrate()
    if there("h5py"):
        test_gresho()
    os.chdir("/")
if not there("numpy"):
    print("no numpy: the code in Python is skipped")
    sys.exit(77)
