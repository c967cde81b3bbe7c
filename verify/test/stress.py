# SPDX-License-Identifier: GPL-3.0-or-later
"""stress.py SPHPROOF [GROUP ...]: results of the stress test of these groups (or of round-off, blasts, and random
tubes).

Every cell has an outcome, and a reason unless it is ok; the default scheme survives everything that the seed
program's method survives; and a cell's command, run by itself, ends as the cell says."""
import json
import math
import shlex
import subprocess
import sys

COMMANDS = 24  # number of commands repeated, spread over the cells


def fail(text):
    sys.exit("stress: " + text)


def stress(program, groups):
    done = subprocess.run([program, "stress", *groups, "--quiet", "--json", "-"],
                          capture_output=True, text=True, timeout=600)
    if done.returncode != 0:
        fail("exit status %d: %s" % (done.returncode, done.stderr))
    return json.loads(done.stdout)


def check_again(program, cell):
    """Runs the cell's own command; true if it could be compared."""
    words = shlex.split(cell["command"])
    done = subprocess.run([program, *words[1:], "--json", "-"], capture_output=True, text=True,
                          timeout=120)
    expected = 3 if cell["outcome"] == "broke_down" else 0
    if "budget" in cell["reason"] or "steps" in cell["reason"]:
        return False
    if done.returncode != expected:
        fail("%s: exit status %d, but the cell is %s" % (cell["command"], done.returncode,
                                                         cell["outcome"]))
    errors = json.loads(done.stdout)["errors"]["density"]["l1"]
    if expected == 0 and not (isinstance(errors, float) and math.isfinite(errors)):
        fail("%s: density error %r" % (cell["command"], errors))
    return True


def main():
    program, groups = sys.argv[1], sys.argv[2:] or ["amplification", "tubes", "blasts"]
    document = stress(program, groups)
    cells = document["cells"]
    runs = [c for c in cells if c["command"].startswith("sphproof run")]
    if {c["group"] for c in cells} != set(groups):
        fail("groups %s" % sorted({c["group"] for c in cells}))
    for cell in cells:
        if cell["outcome"] not in ("ok", "inaccurate", "broke_down"):
            fail("%s is %s: %s" % (cell["command"], cell["outcome"], cell["reason"]))
        if cell["outcome"] != "ok" and not cell["reason"]:
            fail("%s is %s without a reason" % (cell["command"], cell["outcome"]))
        if cell["outcome"] == "broke_down" and ("NaN" in cell["reason"] or "crash" in cell["reason"]):
            fail("%s: %s" % (cell["command"], cell["reason"]))
    if document["comparison"]["lost"]:
        fail("the default scheme does not survive %s" % document["comparison"]["lost"][0]["command"])
    again = [check_again(program, cell) for cell in runs[::max(1, len(runs) // COMMANDS)]]
    if runs and 2 * sum(again) < len(again):
        fail("only %d of %d commands could be compared with their cells" % (sum(again), len(again)))
    unknown = subprocess.run([program, "stress", "nonsense"], capture_output=True, text=True)
    if unknown.returncode != 2 or "limits" not in unknown.stderr:
        fail("an unknown group: exit status %d, %s" % (unknown.returncode, unknown.stderr))
    print("%d cells, %d ok, %d done again" % (len(cells), sum(c["outcome"] == "ok" for c in cells), sum(again)))


main()
