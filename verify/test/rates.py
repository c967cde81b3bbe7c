# SPDX-License-Identifier: GPL-3.0-or-later
"""rates.py SPHPROOF: `sphproof rates` against rates that independent code computed (data:
rates_2d.csv and rates_3d.csv: one evaluation on rates_*_particles.csv, h to 1e-14, of which every
ninth particle stands there), in any order of columns, in 1D, and what --check says of rates that
are wrong."""
import csv
import json
import math
import os
import subprocess
import sys
import tempfile

PROGRAM, DATA = os.path.abspath(sys.argv[1]), os.path.join(os.path.dirname(os.path.abspath(__file__)), "data")
SETS = {"a": ("cubic_spline", "standard", "vanilla_ice", "mass"),
        "b": ("wendland_c2", "ia", "vanilla_ice", "mass"),
        "c": ("quintic_spline", "standard", "lagrangian", "energy")}
ETA = {2: "2.4", 3: "2.1"}


def rates(*words, status=0):
    done = subprocess.run([PROGRAM, "rates", *words, "--json", "-"], capture_output=True, text=True, timeout=60)
    if done.returncode != status:
        sys.exit("rates %s: exit status %d, not %d\n%s" % (" ".join(words), done.returncode, status, done.stderr))
    return json.loads(done.stdout)


def scheme(name, dim):
    kernel, gradient, formulation, element = SETS[name]
    return ["lo=0", "hi=1", "gamma=1.4", "eta=" + ETA[dim], "alpha=1", "beta=2", "viscosity=constant",
            "pair_width=mean", "kernel=" + kernel, "gradient=" + gradient, "formulation=" + formulation,
            "volume_element=" + element]


def particles(dim):
    return os.path.join(DATA, "rates_%dd_particles.csv" % dim)


def table(path):
    with open(path, newline="", encoding="utf-8", errors="surrogateescape") as f:
        return list(csv.DictReader(line for line in f if not line.startswith("#")))


def against_data(dim):
    """Every value of the file, relative to the largest one of its column and set."""
    rows, worst = table(os.path.join(DATA, "rates_%dd.csv" % dim)), 0
    axes = "xyz"[:dim]
    for name in SETS:
        got = rates(particles(dim), *scheme(name, dim))["particles"]
        mine = [r for r in rows if r["set"] == name]
        assert len(mine) > 20
        for column in ["h", "rho", "P", "dU"] + ["F" + a for a in axes]:
            scale = max(abs(float(r[column])) for r in mine)
            for r in mine:
                p = got[int(r["particle"])]
                value = p["force"][axes.index(column[1])] if column[0] == "F" else p[column]
                worst = max(worst, abs(value - float(r[column])) / scale)
                if not abs(value - float(r[column])) <= 1e-10 * scale:
                    sys.exit("%dD set %s particle %s: %s = %r, not %s"
                             % (dim, name, r["particle"], column, value, r[column]))
    print("%dD: %d values, worst %.1e of the largest" % (dim, len(rows) * (4 + dim), worst))


def sums_and_neighbours(dim):
    standard, ia = (rates(particles(dim), *scheme(s, dim)) for s in "ab")
    scale = sum(abs(f) for p in standard["particles"] for f in p["force"])
    for document in (standard, ia):
        assert max(map(abs, document["sums"]["force"])) <= 1e-13 * scale, document["sums"]
        assert all(p["neighbours"] > 5 for p in document["particles"])
    assert abs(standard["sums"]["power"]) <= 1e-13 * sum(abs(p["dU"]) for p in standard["particles"])
    assert all(p["condition"] is None for p in standard["particles"])
    assert all(1 <= p["condition"] < 1000 for p in ia["particles"])


def check(folder, dim, ours, theirs, cause, quantity="ax"):
    """Rates with keys `theirs`, judged as rates with keys `ours`."""
    path = os.path.join(folder, "theirs.csv")
    rates(particles(dim), *theirs, "--csv", path)
    document = rates(particles(dim), *ours, "--check", path, status=1)
    said = {c["quantity"]: c["likely_cause"] for c in document["comparison"]}
    if document["status"] != "fail" or not said[quantity] or cause not in said[quantity]:
        sys.exit("--check: of %s it says %r, not %r" % (quantity, said, cause))


def verdicts(folder, dim):
    """The last line of --check is one sentence: that all is well, or what it comes from."""
    theirs = os.path.join(folder, "verdict.csv")
    words = ["rates", os.path.join(DATA, "rates_%dd_particles.csv" % dim), "lo=0", "hi=1", "kernel=cubic_spline", "eta=2.4"]
    subprocess.run([PROGRAM, *words, "--csv", theirs, "--quiet"], check=True)
    for more, status, phrase in (([], 0, "quantities agree within 1e-09."),
                                 (["alpha=2"], 1, "likely cause, from ax: viscosity: alpha and beta are half of ours."),
                                 (["alpha=1.3"], 1, "no single choice")):
        done = subprocess.run([PROGRAM, *words, *more, "--check", theirs], capture_output=True, text=True, check=False)
        last = done.stdout.strip().split("\n")[-1]
        if done.returncode != status or phrase not in last or len(done.stdout.split("\n")) > 28:
            sys.exit("rates --check %s: exit %d, %d lines, the last: %s"
                     % (more, done.returncode, len(done.stdout.split("\n")), last))


def edited(folder, dim, ours, column, change, cause):
    """The right rates with one column changed."""
    path = os.path.join(folder, "edited.csv")
    rates(particles(dim), *ours, "--csv", path)
    rows, state = table(path), table(particles(dim))
    document = rates(particles(dim), *ours, "--check", path)
    assert document["status"] == "pass" and all(c["worst"] == 0 for c in document["comparison"])
    for row, p in zip(rows, state):
        row[column] = repr(change(row, p))
    with open(path, "w", encoding="ascii") as f:
        f.write(column + "\n" + "".join(row[column] + "\n" for row in rows))
    document = rates(particles(dim), *ours, "--check", path, status=1)
    assert [c["quantity"] for c in document["comparison"]] == [column]
    if cause not in (document["comparison"][0]["likely_cause"] or ""):
        sys.exit("--check: of %s it says %r, not %r" % (column, document["comparison"][0], cause))
    row = rows[3]
    row[column] = "1e3"
    with open(path, "w", encoding="ascii") as f:
        f.write(column + "\n" + "".join(row[column] + "\n" for row in rows))
    assert rates(particles(dim), *ours, "--check", path, status=1)["comparison"][0]["particle"] == 3


def causes(folder, dim):
    a, c = scheme("a", dim), scheme("c", dim)
    check(folder, dim, a, a + ["viscosity=none"], "viscosity: they have none")
    check(folder, dim, a, a + ["beta=0"], "beta = 0", "du")
    check(folder, dim, a, a + ["pair_width=max"], "max(h_i, h_j)")
    check(folder, dim, a, a + ["formulation=lagrangian"], "lagrangian")
    check(folder, dim, a, a + ["gradient=ia"], "ia")
    check(folder, dim, c, c + ["volume_element=mass"], "mass", "rho")
    check(folder, dim, a, a + ["gamma=1.6666666666666667"], "5/3", "P")
    m = lambda p: float(p["m"])
    edited(folder, dim, a, "ay", lambda r, p: float(r["ay"]) * m(p), "dp/dt")
    edited(folder, dim, a, "du", lambda r, p: -float(r["du"]), "sign")
    edited(folder, dim, a, "h", lambda r, p: float(r["h"]) / 2, "0.5 times")
    C = {2: 40 / (7 * 3.141592653589793), 3: 8 / 3.141592653589793}[dim]
    edited(folder, dim, a, "rho", lambda r, p: float(r["rho"]) - m(p) * C / float(r["h"]) ** dim, "self-contribution")


def without_grad_h(folder):
    """The lagrangian pair sum written down without its factors f, in 2D."""
    words = scheme("a", 2) + ["formulation=lagrangian", "viscosity=none"]
    state, found = table(particles(2)), rates(particles(2), *words)["particles"]
    x = [(float(p["x"]), float(p["y"])) for p in state]
    m = [float(p["m"]) for p in state]

    def slope(r, h):  # dW/dr over r of the cubic spline
        q = r / h
        return 40 / (7 * math.pi) / h**3 / r * (0 if q >= 1 else 18 * q * q - 12 * q if q < 0.5 else -6 * (1 - q)**2)

    path = os.path.join(folder, "plain.csv")
    with open(path, "w", encoding="ascii") as f:
        f.write("ax,ay\n")
        for i, a in enumerate(found):
            total = [0, 0]
            for j, b in enumerate(found):
                d = [x[i][k] - x[j][k] - round(x[i][k] - x[j][k]) for k in range(2)]
                r = math.hypot(*d)
                if i == j or r >= max(a["h"], b["h"]):
                    continue
                pair = a["P"] / a["rho"]**2 * slope(r, a["h"]) + b["P"] / b["rho"]**2 * slope(r, b["h"])
                total = [total[k] - m[j] * pair * d[k] for k in range(2)]
            f.write("%r,%r\n" % tuple(total))
    said = rates(particles(2), *words, "--check", path, status=1)["comparison"]
    if any("grad-h" not in (c["likely_cause"] or "") for c in said):
        sys.exit("--check: without grad-h it says %r" % said)


def any_order(folder):
    """Columns in another order, with others between them; boxes with a number for each direction."""
    rows = table(particles(2))
    path = os.path.join(folder, "other.csv")
    with open(path, "w", encoding="ascii") as f:
        f.write("u,vy,colour,x,m,vx,y\n")
        for r in rows:
            f.write(",".join([r["u"], r["vy"], "3", r["x"], r["m"], r["vx"], r["y"]]) + "\n")
    words = scheme("a", 2)
    first, second = rates(particles(2), *words), rates(path, *words, "lo=0,0", "hi=1 1", "boundary=periodic,periodic")
    assert first["particles"] == second["particles"]
    opened = rates(path, *words, "boundary=open")
    assert opened["settings"]["boundary"] == ["open", "open"] and opened["particles"] != first["particles"]


def line(folder):
    """In 1D as a run starts; and a case is a source, too."""
    path = os.path.join(folder, "line.csv")
    with open(path, "w", encoding="ascii") as f:
        f.write("x,vx,m,u\n" + "".join("%r,%r,0.1,2.5\n" % (0.05 + 0.1 * i, 0.1 * (i % 3)) for i in range(10)))
    document = rates(path, "lo=0", "hi=1", "kernel=cubic_spline", "eta=2.3", "gradient=standard")
    assert document["dim"] == 1 and len(document["particles"]) == 10
    assert abs(document["particles"][0]["rho"] - 1) < 0.05 and document["particles"][0]["neighbours"] == 5
    document = rates("sod", "n=90")
    assert len(document["particles"]) == 90 and document["settings"]["h_tolerance"] == 1e-14


def main():
    with tempfile.TemporaryDirectory() as folder:
        for dim in (2, 3):
            against_data(dim)
            sums_and_neighbours(dim)
        causes(folder, 2)
        verdicts(folder, 2)
        without_grad_h(folder)
        any_order(folder)
        line(folder)
    print("causes are named, columns may stand in any order")


main()
