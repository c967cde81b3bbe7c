# SPDX-License-Identifier: GPL-3.0-or-later
"""ic.py SPHPROOF: `sphproof ic` writes the particles that `run` starts from, to the last bit, on scenes drawn at
random; SWIFT's h is twice the standard deviation; judge finds the file right, and a damaged one wrong."""
import csv
import json
import os
import random
import struct
import subprocess
import sys
import tempfile
import time

program = os.path.abspath(sys.argv[1])
SCENES = (("sod", "%d", (40, 200), ("uniform", "clustered")), ("sound_wave", "%d", (16, 64), ("uniform", "clustered")),
          ("gresho", "%d^2", (12, 20), ("square", "hexagonal", "jittered")),
          ("yee", "%d^2", (12, 20), ("square", "jittered")), ("noh_3d", "%d^3", (7, 10), ("cubic", "jittered")))
BAD = (("ic", "case"), ("ic sod --out a.csv", "--format"), ("ic sod --format csv", "--out"),
       ("ic sod --format nothing --out a.csv", "gadget_hdf5"), ("ic nothing --format csv --out a.csv", "nothing"),
       ("ic sod kernel=none --format csv --out a.csv", "none"), ("ic sod --format csv --out a --json a", "same file"))


def call(*words, status=0):
    done = subprocess.run([program, *words], capture_output=True, text=True, timeout=100)
    assert done.returncode == status, (words, done)
    return done.stdout + done.stderr


def content(path):
    """Without the times at which HDF5 has made its arrays."""
    with open(path, "rb") as file:
        text = file.read()
    for back in range(60 if path.endswith("hdf5") else 0):
        text = text.replace(struct.pack("<I", int(time.time()) - back), bytes(4))
    return text


def judged(path, case):
    """Errors of a file as judge finds them."""
    done = subprocess.run([program, "judge", path, "--case", case, "--time", "0", "--json", "-", "--quiet"],
                          capture_output=True, text=True, timeout=100)
    assert done.returncode in (0, 1), done
    return done.returncode, json.loads(done.stdout)


def test_bits(draw):
    for case, power, sizes, lattices in SCENES:
        keys = ["n=" + power % draw.randint(*sizes), "lattice=" + draw.choice(lattices),
                "seed=%d" % draw.randint(1, 999)]
        for name, ending in (("csv", "csv"), ("vtu", "vtu"), ("gadget_hdf5", "hdf5")):
            call("run", case, *keys, "t_end=1e-9", "--snapshot", "run." + ending, "--snapshot-every", "6e-10",
                 "--quiet")
            call("ic", case, *keys, "t_end=1e-9", "--format", name, "--out", "ic." + ending)
            assert content("ic." + ending) == content("run_0000." + ending), (case, keys, name)


def test_judge():
    said = call("ic", "gresho", "n=16^2", "--format", "csv", "--out", "right.csv")
    assert "256 particles" in said, said
    status, right = judged("right.csv", "gresho")
    assert status == 0 and right["errors"]["velocity"]["l1"] < 1e-15, right
    with open("right.csv", encoding="ascii") as file:
        lines = [line for line in file if line[0] != "#"]
        remarks = [line for line in content("right.csv").decode().splitlines(True) if line[0] == "#"]
    rows = list(csv.DictReader(lines))
    for row in rows[::4]:
        row["vx"] = repr(float(row["vx"]) + 1)
    with open("wrong.csv", "w", encoding="ascii") as file:
        file.writelines([lines[0], *remarks, *(",".join(row.values()) + "\n" for row in rows)])
    assert judged("wrong.csv", "gresho")[1]["errors"]["velocity"]["l1"] > 0.01


def test_swift():
    said = call("ic", "gresho", "n=16^2", "kernel=cubic_spline", "--format", "swift", "--out", "swift.hdf5")
    for word in ("--with-adiabatic-index", "--with-hydro-dimension", "time_end"):
        assert word in said, said
    call("ic", "gresho", "n=16^2", "kernel=cubic_spline", "--format", "gadget_hdf5", "--out", "gadget.hdf5")
    theirs, ours = content("swift.hdf5"), content("gadget.hdf5")
    assert b"Flag_Entropy_ICs" in theirs and len(theirs) == len(ours)
    # the files differ in one array alone, which is not packed
    whole = len(ours) // 8
    pairs = zip(struct.unpack("<%dd" % whole, ours[:8 * whole]), struct.unpack("<%dd" % whole, theirs[:8 * whole]))
    ratios = [a / b for a, b in pairs if a != b and a == a and b == b]
    assert len(ratios) == 256, len(ratios)
    assert all(abs(ratio - 1.7780014) < 1e-6 for ratio in ratios), ratios[:3]  # SWIFT's own "Kernel gamma" in 2D


def test_refused():
    for words, told in BAD:
        said = call(*words.split(), status=2)
        assert told in said, (words, said)
        assert not os.path.exists("a.csv") and not os.path.exists("a"), words


seed = random.randrange(10**6)
print("seed", seed)
with tempfile.TemporaryDirectory() as work:
    os.chdir(work)
    test_bits(random.Random(seed))
    test_judge()
    test_swift()
    test_refused()
    os.chdir("/")
