# SPDX-License-Identifier: GPL-3.0-or-later
"""clouds.py SPHPROOF [SEEDS]: particles where a search for neighbours goes wrong first, in 2D and 3D, drawn
at random: in one place, in one cell, in a plane, one alone, density contrasts of 1e6, boxes at 1e8 box
lengths. Either the rates are right (h and rho are those of sums over all pairs, momentum is conserved to
1e-13) or the program says clearly why there are none; and so is what `run` makes of them in a short
time. (Forces and steps, particle by particle: the check hostile of `sphproof verify clouds`.)"""
import json
import math
import os
import random
import subprocess
import sys
import tempfile

PROGRAM = os.path.abspath(sys.argv[1])
ETA = 2.6
KEYS = ["kernel=wendland_c4", "eta=%g" % ETA, "formulation=lagrangian", "pair_width=mean", "viscosity=reconstructed",
        "volume_element=mass"]
C = {2: 9 / math.pi, 3: 495 / (32 * math.pi)}


def draw(dim):
    """A lattice, much displaced: without holes that h would be wider than half of the box in."""
    side = 11 if dim == 2 else 7
    n = side**dim
    return [[(i // side**a % side + random.uniform(0.1, 0.9)) / side for a in range(dim)] + [random.gauss(0, 1) for _ in range(dim)] +
            [random.uniform(0.5, 1.5) / n, random.uniform(0.5, 2)] for i in range(n)]


def plain(rows, dim):
    pass


def pair_in_one_place(rows, dim):
    rows[7][:dim] = rows[8][:dim]
    rows[7][2 * dim] = rows[8][2 * dim]  # the lighter one of a pair may have no h


def many_in_one_place(rows, dim):
    for r in rows[:40]:
        r[:dim] = rows[0][:dim]


def all_in_one_place(rows, dim):
    for r in rows:
        r[:dim] = [0.5] * dim


def one_cell(rows, dim):
    for r in rows:
        r[:dim] = [0.5 + 1e-3 * x for x in r[:dim]]


def one_alone(rows, dim):
    one_cell(rows, dim)
    rows[0][:dim] = [0.01] * dim


def contrast(rows, dim):
    random.shuffle(rows)
    for r in rows[3 * len(rows) // 4:]:
        r[:dim] = [0.5 + 1e-6**(1 / dim) * (x - 0.5) for x in r[:dim]]
        r[-1] *= 1e-6  # else it explodes


def plane(rows, dim):
    for r in rows:
        r[0] = 0.5


def far_off(rows, dim):
    for r in rows:
        r[:dim] = [1e8 + x for x in r[:dim]]


PERIODIC, OPEN, FAR = ["lo=0", "hi=1"], ["boundary=open"], ["lo=100000000", "hi=100000001"]
SETUPS = [(plain, PERIODIC), (plain, OPEN), (pair_in_one_place, PERIODIC), (one_cell, PERIODIC), (one_cell, OPEN),
          (one_alone, OPEN), (contrast, PERIODIC), (plane, OPEN), (far_off, FAR)]
# and what the message has to name
REFUSED = [(many_in_one_place, PERIODIC, 3, "smoothing length"), (all_in_one_place, OPEN, 3, "smoothing length"),
           (one_alone, PERIODIC, 2, "half the box"), (far_off, PERIODIC, 2, "inside of the box"),
           (plain, PERIODIC + ["eta=9"], 2, "half the box")]


def run(rows, dim, words, status=0):
    with tempfile.TemporaryDirectory() as folder:
        path, axes = os.path.join(folder, "cloud.csv"), "xyz"[:dim]
        with open(path, "w", encoding="ascii") as f:
            f.write(",".join([*axes, *("v" + a for a in axes), "m", "u"]) + "\n")
            f.writelines(",".join("%.17g" % x for x in r) + "\n" for r in rows)
        done = subprocess.run([PROGRAM, "rates", path, *KEYS, *words, "--json", "-"], capture_output=True, text=True,
                              timeout=100)
    if done.returncode != status:
        sys.exit("%dD %s: exit status %d, not %d: %s" % (dim, words, done.returncode, status, done.stderr))
    return done


CASE = """[case]
title = hostile
dimension = %d
reference = none
[domain]
%s
[initial]
kind = particles
file = cloud.csv
[run]
t_end = %r
gamma = 1.4
"""


def case_of(dim, words):
    """The box of a case file, and the keys that are left."""
    box = {"lo": "0", "hi": "1", "boundary": "periodic"}
    box.update(w.split("=") for w in words if w.split("=")[0] in box)
    return "\n".join("%s = %s" % pair for pair in box.items()), [w for w in words if w.split("=")[0] not in box]


def march(name, rows, dim, words, status=0, t_end=1e-6):
    """`run` of the same particles; the document, or what it says on stderr."""
    with tempfile.TemporaryDirectory() as folder:
        axes, end = "xyz"[:dim], os.path.join(folder, "end.csv")
        with open(os.path.join(folder, "cloud.csv"), "w", encoding="ascii") as f:
            f.write(",".join([*axes, *("v" + a for a in axes), "m", "u"]) + "\n")
            f.writelines(",".join("%.17g" % x for x in r) + "\n" for r in rows)
        box, keys = case_of(dim, words)
        with open(os.path.join(folder, "hostile.ini"), "w", encoding="ascii") as f:
            f.write(CASE % (dim, box, t_end))
        done = subprocess.run([PROGRAM, "run", os.path.join(folder, "hostile.ini"), *KEYS, *keys, "--json", "-",
                               "--snapshot", end], capture_output=True, text=True, timeout=100)
        if done.returncode != status:
            sys.exit("run %dD %s: exit status %d, not %d: %s" % (dim, name, done.returncode, status, done.stderr))
        if status:
            return done.stderr
        with open(end, encoding="utf-8", errors="surrogateescape") as f:
            lines = [[float(x) for x in line.split(",")] for line in f.read().splitlines()[1:] if line[0] != "#"]
    return json.loads(done.stdout), lines


def judge_run(name, rows, dim, words, t_end, periodic):
    document, end = march(name, rows, dim, words, 0, t_end)
    kept = document["conservation"]
    if not (kept["mass"] == 0 and kept["momentum"] <= 1e-12 and kept["energy"] <= 1e-9 and
            document["cost"]["steps"] >= 1 and len(end) == len(rows)):
        sys.exit("run %dD %s: %r, %r" % (dim, name, kept, document["cost"]))
    for i in range(0, len(end), 11):  # x, v, m, rho, u, P, h
        rho, h = density(end, dim, i, end[i][2 * dim + 4], periodic), end[i][2 * dim + 4]
        if not abs(end[i][2 * dim + 1] / rho - 1) <= 1e-6:
            sys.exit("run %dD %s: particle %d: rho %r, the sum is %r; h %r" % (dim, name, i, end[i][2 * dim + 1], rho, h))


def density(rows, dim, i, h, periodic):
    """sum m C/h^d (1-q)^6 (1 + 6 q + 35/3 q^2)"""
    total = 0
    for r in rows:
        d = [a - b for a, b in zip(rows[i][:dim], r[:dim])]
        q = math.hypot(*(x - round(x) if periodic else x for x in d)) / h
        total += r[2 * dim] * (1 - q)**6 * (1 + 6 * q + 35 / 3 * q * q) if q < 1 else 0
    return C[dim] / h**dim * total


def judge(name, rows, dim, document, periodic):
    particles, size = document["particles"], 0
    for i, p in enumerate(particles):
        numbers = [p["h"], p["rho"], p["P"], p["dU"], *p["force"]]
        if not all(isinstance(x, float) for x in numbers):
            sys.exit("%dD %s: particle %d: %r" % (dim, name, i, p))
        size += math.hypot(*p["force"])
        if i % 7:
            continue
        rho, m = density(rows, dim, i, p["h"], periodic), rows[i][2 * dim]
        if not abs(p["rho"] / rho - 1) <= 1e-7 or not abs(p["h"] / (ETA * (m / rho)**(1 / dim)) - 1) <= 1e-7:
            sys.exit("%dD %s: particle %d: rho %r, the sum is %r; h %r" % (dim, name, i, p["rho"], rho, p["h"]))
    if not math.hypot(*document["sums"]["force"]) <= 1e-13 * size:
        sys.exit("%dD %s: sum of forces %r of %r" % (dim, name, document["sums"]["force"], size))


def main():
    seeds = int(sys.argv[2]) if len(sys.argv) > 2 else 1
    count = 0
    for seed in range(seeds):
        random.seed(2385 + seed)
        for dim in (2, 3):
            for change, words in SETUPS:
                gradient = random.choice(["standard", "ia", "corrected", "blended"])
                rows = draw(dim)
                change(rows, dim)
                document = json.loads(run(rows, dim, words + ["gradient=" + gradient]).stdout)
                name = "%s %s %s" % (change.__name__, words, gradient)
                judge(name, rows, dim, document, words != OPEN)
                # short: of a cold lump that gas runs into at Mach 1000 some particles get colder than 0 soon
                width = min(p["h"] for p in document["particles"])
                if seed or dim == 2 or change in (pair_in_one_place, contrast):
                    judge_run(name, rows, dim, words + ["gradient=" + gradient], 0.001 * width, words != OPEN)
                count += 1
            for change, words, status, message in REFUSED:
                rows = draw(dim)
                change(rows, dim)
                said = run(rows, dim, words, status).stderr
                if message not in said:
                    sys.exit("%dD %s %s: it says %r, not '%s'" % (dim, change.__name__, words, said, message))
                if seed or dim == 2:
                    said = march(change.__name__, rows, dim, words, status)
                    if message not in said:
                        sys.exit("run %dD %s %s: it says %r, not '%s'" % (dim, change.__name__, words, said, message))
                count += 1
    print("%d setups: right, or refused with the reason" % count)


main()
