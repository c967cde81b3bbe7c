# SPDX-License-Identifier: GPL-3.0-or-later
"""compare.py SPHPROOF: `sphproof compare`: figures against those of single runs, sides swapped, a scheme against
itself, snapshots, the page. (Refusals: the transcripts.)"""
import json
import math
import os
import subprocess
import sys
import tempfile
from xml.etree import ElementTree

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


def swapped_and_alike():
    one, ab = compare(A, B)
    two, ba = compare(B, A)
    turned = {"better": "worse", "worse": "better", "none": "none"}
    assert "worse" in {f["verdict"] for f in ab.values()} and "b is worse in " in one["verdict"], one["verdict"]
    assert "b is better in " in two["verdict"] and "worse" not in two["verdict"], two["verdict"]
    for name, figure in ab.items():
        assert ba[name]["verdict"] == turned[figure["verdict"]], name
        assert abs((1 + figure["change"]) * (1 + ba[name]["change"]) - 1) < 1e-12, name
    for side in (A, "gresho n=12^2 t_end=0.02", "noh_2d n=12^2 t_end=0.05 lattice=random seed=3"):
        got, figures = compare(side, side, "--draws", "3")
        assert got["verdict"].startswith("no difference can be told in "), got["verdict"]
        assert got["draws"] == 3 and all(f["verdict"] == "none" and f["change"] == 0 for f in figures.values()), figures
    # a change that is real, but of no account
    got, figures = compare("sod n=60 alpha=1.0", "sod n=60 alpha=1.00001")
    assert any(f["change"] != 0 for f in figures.values()) and got["verdict"].startswith("no difference"), got["verdict"]


def snapshots(folder):
    paths = [os.path.join(folder, name) for name in ("a.csv", "b.csv")]
    for path, side in zip(paths, (A, B)):
        assert call("run", *side.split(), "--snapshot", path, "--quiet")[0] == 0
    got, figures = compare(*paths)
    assert got["draws"] == 1 and got["cpu"] is None and "a single draw does not tell" in got["verdict"], got["verdict"]
    assert all(f["verdict"] == "unknown" and f["half"] is None for f in figures.values()), figures
    _, single = compare(paths[0], B)
    _, paired = compare(A, B)
    assert single["density"]["half"] > paired["density"]["half"], "a single draw scatters more than a mean"
    got, figures = compare(paths[0], A)
    assert got["verdict"].startswith("no difference"), got["verdict"]
    lines = open(paths[0], encoding="utf-8").read().splitlines()
    far = os.path.join(folder, "far.csv")
    with open(far, "w", encoding="utf-8") as file:
        for line in lines:
            cells = line.split(",")
            file.write((line if line[0] in "#x" else ",".join([cells[0], "3", *cells[2:]])) + "\n")
    status, out, err = call("compare", far, A)
    assert status == 1 and not out and "far from" in err, (status, err)


def pages(folder):
    """The page has the verdict, and both sides in its pictures."""
    for words in ((A, B), ("gresho n=12^2 t_end=0.02", "gresho n=12^2 t_end=0.02 gradient=standard")):
        path = os.path.join(folder, "page.html")
        got, _ = compare(*words, "--draws", "2", "--html", path)
        with open(path, encoding="utf-8") as file:
            html = file.read()
        ElementTree.fromstring(html.split("\n", 1)[1] if html.startswith("<!DOCTYPE") else html)
        assert "<h1>%s</h1>" % got["verdict"].replace("<", "&lt;") in html, got["verdict"]
        for side in words:
            assert "<code>%s</code>" % side in html, side


def main():
    against_runs()
    swapped_and_alike()
    with tempfile.TemporaryDirectory() as folder:
        snapshots(folder)
        pages(folder)
    print("compared as single runs are; swapped, alike, snapshots and pages as they should be")


main()
