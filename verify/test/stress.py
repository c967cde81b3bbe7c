# SPDX-License-Identifier: GPL-3.0-or-later
"""stress.py SPHPROOF [GROUP ...]: tests results of the stress test of these groups (or of round-off, blasts, and random
tubes).

Every cell has an outcome, and a reason unless it is ok; the default scheme survives everything that the seed
program's method survives; and a cell's command, run by itself, ends as the cell says."""
import math
import shlex
import sys

from script import call, expect, json_of, play

COMMANDS = 24  # number of commands repeated, spread over the cells


def check_again(cell):
    """Runs the cell's own command; true if it could be compared."""
    if "budget" in cell["reason"] or "steps" in cell["reason"]:
        return False
    broken = cell["outcome"] == "broke_down"
    error = json_of(*shlex.split(cell["command"])[1:], status=3 if broken else 0)["errors"]["density"]["l1"]
    expect("density error of " + cell["command"], broken or isinstance(error, float) and math.isfinite(error), error)
    return True


def main():
    groups = sys.argv[2:] or ["amplification", "tubes", "blasts"]
    document = json_of("stress", *groups, "--quiet", timeout=600)
    cells, lost = document["cells"], document["comparison"]["lost"]
    runs = [c for c in cells if c["command"].startswith("sphproof run")]
    expect("groups", {c["group"] for c in cells} == set(groups), {c["group"] for c in cells})
    for cell in cells:
        expect("an outcome", cell["outcome"] in ("ok", "inaccurate", "broke_down"), cell)
        expect("a reason", cell["outcome"] == "ok" or cell["reason"], cell)
        expect("what breaks down", cell["outcome"] != "broke_down" or not ("NaN" in cell["reason"] or "crash" in cell["reason"]), cell)
    expect("the default scheme survives", not lost, lost)
    again = [check_again(cell) for cell in runs[::max(1, len(runs) // COMMANDS)]]
    expect("commands that are compared with their cells", not runs or 2 * sum(again) >= len(again), "%d of %d" % (sum(again), len(again)))
    expect("an unknown group", "limits" in call("stress", "nonsense", status=2).stderr)
    print("%d cells, %d ok, %d done again" % (len(cells), sum(c["outcome"] == "ok" for c in cells), sum(again)))


play(main)
