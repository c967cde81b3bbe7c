# SPDX-License-Identifier: GPL-3.0-or-later
"""case_gates.py SPHPROOF [CASE...]: `judge --gates case` passes our own run of every case at its own n, and fails it
with planted faults: velocities 10 % too low, particles moved by two spacings along the diagonal, noise of a tenth of
speed and sound speed."""
import json
import math
import random
import sys

from script import call, json_of, play, read, write

# Faults that no gate of the case can detect, and why.
UNSEEN = {("rest_2d", "slow"): "gas at rest, which moves by noise alone", ("rest_2d", "moved"): "it is uniform",
          ("rest_3d", "slow"): "as in 2D", ("rest_3d", "moved"): "as in 2D", ("square", "slow"): "its gas should rest",
          ("kelvin_helmholtz", "moved"): "the amplitude of a mode hardly depends on its place",
          ("square", "moved"): "particles across the edge err by more than that anyway"}


def judge(path):
    done = call("judge", path, "--gates", "case", "--allow-far", "--json", "-")
    if done.returncode not in (0, 1):
        sys.exit("%s: exit status %d\n%s" % (path, done.returncode, done.stderr))
    return done.returncode, json.loads(done.stdout)["gates"]


def plant(fault, head, remarks, rows):
    at = {name: k for k, name in enumerate(head)}
    axes = [a for a in "xyz" if a in at]
    box = next(line for line in remarks if line.startswith("# box")).split("=")[1].split()
    ends = [tuple(map(float, along.split(":"))) for along in box]
    spacing = (math.prod(hi - lo for lo, hi in ends) / len(rows)) ** (1 / len(axes))
    draw = random.Random(26)
    for row in rows:
        speed = math.sqrt(1.4 * row[at["P"]] / row[at["rho"]]) + math.hypot(*(row[at["v" + a]] for a in axes))
        for a, (lo, hi) in zip(axes, ends):
            if fault == "slow":
                row[at["v" + a]] *= 0.9
            elif fault == "moved":
                row[at[a]] = lo + (row[at[a]] + 2 * spacing - lo) % (hi - lo)
            else:
                row[at["v" + a]] += draw.gauss(0, 0.1 * speed)
    return "\n".join([",".join(head), *remarks, *(",".join(map(repr, row)) for row in rows)]) + "\n"


def one_case(case):
    path, bad = "own.csv", "bad.csv"
    call("run", case, "--quiet", "--snapshot", path, status=0, timeout=600)
    status, gates = judge(path)
    said = {g["name"]: g["status"] for g in gates}
    assert status == 0 and "pass" in said.values(), (case, gates)
    assert all(g["source"].startswith("case " + case) or g["name"] in ("mass", "momentum", "angular_momentum", "energy")
               for g in gates), (case, gates)
    assert len(said) > 3 or case == "none", "%s has no gates of its own" % case
    lines = read(path).splitlines()
    head, remarks = lines[0].split(","), [line for line in lines if line.startswith("#")]
    numbers = [list(map(float, line.split(","))) for line in lines[1:] if not line.startswith("#")]
    for fault in ("slow", "moved", "noise"):
        write(bad, plant(fault, head, remarks, [list(row) for row in numbers]))
        status, gates = judge(bad)
        failed = [g["name"] for g in gates if g["status"] == "fail"]
        unseen = (case, fault) in UNSEEN
        assert status == (not unseen) == bool(failed), (case, fault, gates)
        print("%s, %s: %s" % (case, fault, UNSEEN[case, fault] if unseen else ", ".join(failed)))


def main():
    cases = [c["name"] for c in json_of("list", "cases")["families"]["cases"]]
    assert len(cases) > 20
    for case in sys.argv[2:] or cases:
        said = call("run", case, "--explain", status=None)
        if said.returncode == 2 and "weakly compressible liquid" in said.stderr:
            print("%s: is not run here" % case)
            continue
        one_case(case)


play(main)
