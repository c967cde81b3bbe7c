# SPDX-License-Identifier: GPL-3.0-or-later
"""clouds.py SPHPROOF: particles in 2D and 3D of which there are no rates, such as many in one place: `rates`
and `run` say why. (Forces and steps of clouds that are hard but have rates, particle by particle: the check
hostile of `sphproof verify clouds`.)"""
import os
import random
import subprocess
import sys
import tempfile

PROGRAM = os.path.abspath(sys.argv[1])
KEYS = ["kernel=wendland_c4", "eta=2.6", "formulation=lagrangian", "viscosity=reconstructed"]


def draw(dim):
    """A lattice, much displaced: without holes that h would be wider than half of the box in."""
    side = 11 if dim == 2 else 7
    n = side**dim
    return [[(i // side**a % side + random.uniform(0.1, 0.9)) / side for a in range(dim)] + [random.gauss(0, 1) for _ in range(dim)] +
            [random.uniform(0.5, 1.5) / n, random.uniform(0.5, 2)] for i in range(n)]


def plain(rows, dim):
    pass


def many_in_one_place(rows, dim):
    for r in rows[:40]:
        r[:dim] = rows[0][:dim]


def all_in_one_place(rows, dim):
    for r in rows:
        r[:dim] = [0.5] * dim


def one_alone(rows, dim):
    for r in rows:
        r[:dim] = [0.5 + 1e-3 * x for x in r[:dim]]
    rows[0][:dim] = [0.01] * dim


def plane(rows, dim):
    for r in rows:
        r[0] = 0.5


def far_off(rows, dim):
    for r in rows:
        r[:dim] = [1e8 + x for x in r[:dim]]


# boundary, keys, exit status and what the message has to name; all in one plane have rates, although no matrix can be inverted
ROWS = [(many_in_one_place, "periodic", [], 3, "smoothing length"), (all_in_one_place, "open", [], 3, "smoothing length"),
        (one_alone, "periodic", [], 2, "half the box"), (far_off, "periodic", [], 2, "inside of the box"),
        (plain, "periodic", ["eta=9"], 2, "half the box"), (plane, "open", ["gradient=corrected"], 0, "")]
CASE = """[case]
title = hostile
dimension = %d
reference = none
[domain]
lo = 0
hi = 1
boundary = %s
[initial]
kind = particles
file = cloud.csv
[run]
t_end = 1e-6
gamma = 1.4
"""


def main():
    random.seed(2385)
    for dim in (2, 3):
        for change, boundary, words, status, message in ROWS:
            rows = draw(dim)
            change(rows, dim)
            axes = "xyz"[:dim]
            with open("cloud.csv", "w", encoding="ascii") as f:
                f.write(",".join([*axes, *("v" + a for a in axes), "m", "u"]) + "\n")
                f.writelines(",".join("%.17g" % x for x in r) + "\n" for r in rows)
            with open("hostile.ini", "w", encoding="ascii") as f:
                f.write(CASE % (dim, boundary))
            box = ["boundary=open"] if boundary == "open" else ["lo=0", "hi=1"]
            for command in (["rates", "cloud.csv", *box], ["run", "./hostile.ini"]):
                done = subprocess.run([PROGRAM, *command, *KEYS, *words], capture_output=True, text=True, timeout=100)
                if done.returncode != status or message not in done.stderr:
                    sys.exit("%dD %s, %s: exit status %d, not %d, and it says %r, not '%s'" % (
                        dim, change.__name__, " ".join(command + words), done.returncode, status, done.stderr, message))
    print("%d clouds: refused with the reason, where they have no rates" % (2 * len(ROWS)))


with tempfile.TemporaryDirectory() as scratch:
    os.chdir(scratch)
    main()
