# SPDX-License-Identifier: GPL-3.0-or-later
"""damages.py SPHPROOF: what `sphproof ic` writes is found to be the case's initial state, of every case on lattices drawn at
random; damages drawn at random are told in words: which field, of how many particles, where, and what would explain it."""
import csv
import json
import os
import random
import struct
import subprocess
import sys
import tempfile

PROGRAM = os.path.abspath(sys.argv[1])
GAMMA = 1.4  # of yee, whose velocity, density and energy all vary
CASES = ("sod", "leblanc", "sound_wave", "sod_2d", "sod_3d", "gresho", "yee", "kelvin_helmholtz", "square", "noh_2d", "sedov_2d",
         "rotation", "rayleigh_taylor_mode")
KEYS = {1: ("lattice=uniform", "grade=0.9", "mass_ratio=0.5"), 2: ("lattice=square", "lattice=hexagonal", "lattice=jittered", "jitter=0.3"),
        3: ("lattice=cubic", "lattice=jittered")}


def call(*words, status=0):
    done = subprocess.run([PROGRAM, *words], capture_output=True, text=True, timeout=100)
    assert done.returncode == status or status is None, (words, done)
    return done


def judged(path, status):
    """What judge says of a start: "start" of its document, and the verdict."""
    document = json.loads(call("judge", path, "--json", "-", status=status).stdout)
    return document["start"], document["verdict"]


def test_undamaged(draw):
    moved = ("noh_2d", "rotation", "yee", "kelvin_helmholtz", "rayleigh_taylor_mode")  # jitter leaves masses, or all
    for case in draw.sample(CASES, 3) + list(moved):
        dim = 1 if case in ("sod", "leblanc", "sound_wave") else 3 if case == "sod_3d" else 2
        key = "jitter=0.3" if case in moved else draw.choice(KEYS[dim] if case != "sound_wave" else KEYS[dim][:1])
        call("ic", case, "n=%d" % {1: 90, 2: 1600 if case == "sod_2d" else 400, 3: 9216}[dim], key, "seed=%d" % draw.randint(1, 999), "--format", "csv",
             "--out", "start.csv")
        start, verdict = judged("start.csv", None)
        assert start["wrong"] == 0 and (start["message"] == "" and start["velocity"] < 1e-13
                                      or case in moved and "jitter" in key and "to a spacing" in start["message"]), (case, key, start, verdict)


def read(path):
    """Lines before the rows, and rows of numbers; rho0 is what was set, where cells are equal."""
    with open(path, encoding="ascii") as file:
        lines = file.readlines()
    head = [line for line in lines if line[0] == "#"]
    rows = [{name: float(value) for name, value in row.items()} for row in
            csv.DictReader(line for line in lines if line[0] != "#")]
    volume = 100 / len(rows)
    for row in rows:
        row["rho0"] = row["m"] / volume
    return head, rows


def write(path, head, rows):
    names = [name for name in rows[0] if name != "rho0"]
    with open(path, "w", encoding="ascii") as file:
        file.writelines([",".join(names) + "\n", *head])
        file.writelines(",".join(repr(row[name]) for name in names) + "\n" for row in rows)


def single(value):
    return struct.unpack("f", struct.pack("f", value))[0]


def times(*names, by):
    def change(row, scale):
        for name in names:
            row[name] *= scale if by is None else by
    return change


def exchange(a, b):
    def change(row, _):
        row[a], row[b] = row[b], row[a]
    return change


def momentum(row, _):
    row["vx"], row["vy"] = row["rho0"] * row["vx"], row["rho0"] * row["vy"]


def temperature(row, _):
    row["u"] *= GAMMA - 1


def entropy(row, _):
    row["u"] *= (GAMMA - 1) * row["rho0"] ** (1 - GAMMA)


def total(row, _):
    row["u"] += 0.5 * (row["vx"]**2 + row["vy"]**2)


def shift(row, scale):
    row["x"] = (row["x"] + 5 + scale) % 10 - 5


def rounded(row, _):
    for name in ("x", "y", "vx", "vy", "u"):
        row[name] = single(row[name])


# what is done to rows: to all, to those beyond some x, to each fourth; and the words that tell it (%s: the factor)
DAMAGES = (("beyond", times("u", by=None), ("wrong internal energy, at x > ", "%s times")),
           ("beyond", times("m", by=None), ("wrong mass, at x > ", "%s times")),
           ("beyond", times("vx", "vy", by=0), ("wrong velocity", "it is 0")),
           ("fourth", times("u", by=None), ("a quarter", "wrong internal energy, each 4th in the file", "%s times")),
           ("fourth", times("P", by=None), ("a quarter", "wrong pressure, each 4th in the file", "%s times (gamma - 1) rho u")),
           ("all", times("m", by=None), ("wrong mass", "%s times")),
           ("all", times("vx", "vy", by=None), ("wrong velocity", "%s times")),
           ("all", times("vx", "vy", by=-1), ("wrong velocity", "the other sign")),
           ("all", exchange("vx", "vy"), ("wrong velocity", "x and y are exchanged")),
           ("all", exchange("x", "y"), ("wrong velocity", "x and y of their places are exchanged")),
           ("all", exchange("m", "u"), ("wrong internal energy", "it is the mass")),
           ("all", momentum, ("wrong velocity", "a momentum")), ("all", temperature, ("wrong internal energy", "a temperature")),
           ("all", entropy, ("wrong internal energy", "an entropy")), ("all", total, ("wrong internal energy", "the total energy")),
           ("all", shift, ("all particles of the file are shifted by %s, 0",)))


def test_damages(draw):
    call("ic", "yee", "n=%d^2" % draw.randint(16, 24), "--format", "csv", "--out", "start.csv")
    for rows_of, damage, told in DAMAGES:
        head, rows = read("start.csv")
        scale = draw.choice((0.6, 1.25, 3))
        edge = draw.uniform(0.3, 2)  # what most particles have is taken for right, but for masses
        if "wrong mass, at x > " in told:
            edge = draw.uniform(-4.5, 4)
        for i, row in enumerate(rows):
            if rows_of == "all" or (rows_of == "fourth" and i % 4 == 0) or (rows_of == "beyond" and row["x"] > edge):
                damage(row, scale)
        write("damaged.csv", head, rows)
        start, verdict = judged("damaged.csv", 1)
        for words in told:
            assert words.replace("%s", "%.4g" % scale) in start["message"], (rows_of, told, scale, edge, start)
        assert start["message"] in verdict and start["wrong"] > 0, (start, verdict)
    head, rows = read("start.csv")
    for row in rows:
        rounded(row, 0)
    write("rounded.csv", head, rows)
    start, _ = judged("rounded.csv", 0)
    assert start["wrong"] == 0 and "single precision" in start["message"], start


seed = random.randrange(10**6) if len(sys.argv) < 3 else int(sys.argv[2])
print("seed", seed)
with tempfile.TemporaryDirectory() as work:
    os.chdir(work)
    test_damages(random.Random(seed))
    test_undamaged(random.Random(seed))
    os.chdir("/")
