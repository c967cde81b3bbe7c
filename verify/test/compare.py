# SPDX-License-Identifier: GPL-3.0-or-later
"""compare.py SPHPROOF: figures of `sphproof compare` against those of single runs. (Sides, snapshots, pages and refusals: the
transcripts.)"""
import json
import math
import os
import subprocess
import sys

PROGRAM = os.path.abspath(sys.argv[1])
A, B = "sod n=60", "sod n=60 kernel=wendland_c4"


def call(*words):
    done = subprocess.run([PROGRAM, *words], capture_output=True, text=True, timeout=60)
    return done.returncode, done.stdout, done.stderr


def compare(*words):
    status, out, err = call("compare", *words, "--json", "-")
    assert status == 0, (words, err)
    got = json.loads(out)
    return got, {c["name"]: c for c in got["comparisons"]}


def against_runs():
    """Three draws on a line: n, one step above, one below, of 2.5 % of n each; the same numbers by hand."""
    got, figures = compare(A, B, "--draws", "3")
    assert got["draws"] == 3
    errors = []
    for n in ("n=60", "n=62", "n=58"):
        errors.append([json.loads(call("run", "sod", n, *keys, "--json", "-")[1])["errors"]["density"]["l1"]
                       for keys in ([], ["kernel=wendland_c4"])])
    logs = [math.log(b / a) for a, b in errors]
    mean = sum(logs) / 3
    spread = math.sqrt(sum((x - mean) ** 2 for x in logs) / 2)
    t = 0.9875 * math.sqrt(2 / (1 - 0.9875 ** 2))  # Student, two-sided 5 %/4, 2 degrees of freedom
    assert abs(figures["density"]["change"] - math.expm1(mean)) < 1e-9, (figures["density"], errors)
    assert abs(figures["density"]["half"] / (math.exp(mean) * t * spread / math.sqrt(3)) - 1) < 1e-9, figures["density"]
    assert figures["density"]["verdict"] == ("worse" if mean > t * spread / math.sqrt(3) else "none")


against_runs()
print("compared as single runs are")
