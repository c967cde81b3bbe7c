#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""gradients.py PROGRAM: sphproof gradient on periodic clouds (the same as with the images of the points
written out), and with several --check. (Bad input: the transcripts; tables as Fortran writes them: test_csv.)"""
import itertools
import json
import os
import random
import subprocess
import sys
import tempfile

PROGRAM = os.path.abspath(sys.argv[1])
failures = []


def check(good, *what):
    if not good:
        failures.append(" ".join(str(w) for w in what))


def gradient(*arguments):
    r = subprocess.run([PROGRAM, "gradient", *arguments, "--json", "-"], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                       text=True, timeout=100)
    return r.returncode, json.loads(r.stdout) if r.stdout else None, r.stderr


def write(names, rows):
    with open("cloud.csv", "w") as f:
        f.write(",".join(names) + "\n")
        for row in rows:
            f.write(",".join("%.17g" % v for v in row) + "\n")


def cloud(dim, side=7):
    """In the box from -1 to 1, and from 0 to 3 along the other directions."""
    random.seed(dim)
    lengths, lows = [2, 3, 3][:dim], [-1, 0, 0][:dim]
    rows = []
    for place in itertools.product(range(side), repeat=dim):
        x = [lo + L * (k + 0.4 * random.random()) / side for k, L, lo in zip(place, lengths, lows)]
        volume = random.uniform(0.8, 1.2)
        for L in lengths:
            volume *= L / side
        rows.append(x + [volume, random.uniform(-2, 2), random.uniform(1, 5)])
    return rows, lengths, ",".join("%d:%d" % (lo, lo + L) for lo, L in zip(lows, lengths))


def images(rows, lengths):
    dim = len(lengths)
    away = [s for s in itertools.product((-1, 0, 1), repeat=dim) if any(s)]
    return rows + [[x + k * L for x, k, L in zip(r, s, lengths)] + r[dim:] for s in away for r in rows]


def periodic(dim):
    rows, lengths, box = cloud(dim, side=[0, 12, 7, 4][dim])
    names = ["x", "y", "z"][:dim] + ["volume", "f", "g"]
    keys = ["cloud.csv", "--kernel", "wendland_c2", "--dim", str(dim), "--eta", "2.2"]
    for operator in ("standard", "ia") if dim < 3 else ("linear_exact",):
        write(names, images(rows, lengths))
        code, whole, err = gradient(*keys, "--operator", operator)
        check(code == 0, dim, operator, err)
        write(names, rows)
        code, boxed, err = gradient(*keys, "--operator", operator, "--box", box)
        check(code == 0 and boxed and len(boxed["points"]) == len(rows), dim, operator, err)
        code, opened, err = gradient(*keys, "--operator", operator)
        for got, want in zip(boxed["points"], whole["points"]):
            for field in "f", "g":
                for a, b in zip(got["gradients"][field], want["gradients"][field]):
                    check(abs(a - b) <= 1e-11 * max(1, abs(b)), dim, operator, got["x"], field, a, "not", b)
            check(got["neighbours"] == want["neighbours"], dim, operator, "neighbours", got, want)
        check(opened["points"] != boxed["points"], dim, operator, "the box changes nothing")
    return boxed


def several_checks():
    rows, _, box = cloud(2)
    names = ["x", "y", "volume", "f", "g"]
    keys = ["cloud.csv", "--operator", "ia", "--kernel", "cubic_spline", "--dim", "2", "--eta", "2.4", "--box", box]
    write(names, rows)
    points = gradient(*keys)[1]["points"]
    given = [r + p["gradients"]["f"] + p["gradients"]["g"] for r, p in zip(rows, points)]
    write(names + ["fx", "fy", "gx", "gy"], given)
    both = ["--check", "f=fx,fy", "--check", "g=gx,gy"]
    code, document, err = gradient(*keys, *both)
    check(code == 0 and [j["column"] for j in document["judgements"]] == ["f", "g"], "checks", code, err)
    check(all(j["judged"] == len(rows) and j["failed"] == 0 for j in document["judgements"]), document["judgements"])
    check(all(sorted(p["gradients"]) == ["f", "g"] for p in document["points"]), "gradients of given columns")
    given[11][8] *= 1 + 1e-6
    write(names + ["fx", "fy", "gx", "gy"], given)
    code, document, err = gradient(*keys, *both)
    check(code == 1 and [j["status"] for j in document["judgements"]] == ["pass", "fail"], "one is off", code, document)
    check(document["judgements"][1]["worst_row"] == 12, "worst row", document["judgements"])


with tempfile.TemporaryDirectory() as scratch:
    os.chdir(scratch)
    for d in 1, 2, 3:
        periodic(d)
    several_checks()
if failures:
    sys.exit("\n".join(failures[:40]))
