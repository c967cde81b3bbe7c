# SPDX-License-Identifier: GPL-3.0-or-later
"""rates.py SPHPROOF: compares `sphproof rates` with rates that independent code computed (data: rates_2d.csv and
rates_3d.csv: one evaluation for rates_*_particles.csv, with h to 1e-14, of which every ninth particle is kept), in
any order of columns, and in 1D. (Messages of --check: the transcripts and test_rate_check.)"""
import csv
import os
import sys

from script import json_of, play, read, write

DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), "data")
SETS = {"a": ("cubic_spline", "standard", "vanilla_ice", "mass"),
        "b": ("wendland_c2", "ia", "vanilla_ice", "mass"),
        "c": ("quintic_spline", "standard", "lagrangian", "energy")}
ETA = {2: "2.4", 3: "2.1"}


def rates(*words):
    return json_of("rates", *words)


def scheme(name, dim):
    kernel, gradient, formulation, element = SETS[name]
    return ["lo=0", "hi=1", "gamma=1.4", "eta=" + ETA[dim], "alpha=1", "beta=2", "viscosity=constant",
            "pair_width=mean", "kernel=" + kernel, "gradient=" + gradient, "formulation=" + formulation,
            "volume_element=" + element]


def particles(dim):
    return os.path.join(DATA, "rates_%dd_particles.csv" % dim)


def table(path):
    return list(csv.DictReader(line for line in read(path).splitlines() if not line.startswith("#")))


def against_data(dim):
    """Every value of the file, relative to the largest one in its column and set."""
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


def any_order():
    """Columns in another order, with others between them; boxes with a number for each direction."""
    rows = table(particles(2))
    path = "other.csv"
    with open(path, "w", encoding="ascii") as f:
        f.write("u,vy,colour,x,m,vx,y\n")
        for r in rows:
            f.write(",".join([r["u"], r["vy"], "3", r["x"], r["m"], r["vx"], r["y"]]) + "\n")
    words = scheme("a", 2)
    first, second = rates(particles(2), *words), rates(path, *words, "lo=0,0", "hi=1 1", "boundary=periodic,periodic")
    assert first["particles"] == second["particles"]
    opened = rates(path, *words, "boundary=open")
    assert opened["settings"]["boundary"] == ["open", "open"] and opened["particles"] != first["particles"]


def line():
    """In 1D rates are those at the start of a run; a case may be the source, too."""
    write("line.csv", "x,vx,m,u\n" + "".join("%r,%r,0.1,2.5\n" % (0.05 + 0.1 * i, 0.1 * (i % 3)) for i in range(10)))
    document = rates("line.csv", "lo=0", "hi=1", "kernel=cubic_spline", "eta=2.3", "gradient=standard")
    assert document["dim"] == 1 and len(document["particles"]) == 10
    assert abs(document["particles"][0]["rho"] - 1) < 0.05 and document["particles"][0]["neighbours"] == 5
    document = rates("sod", "n=90")
    assert len(document["particles"]) == 90 and document["settings"]["h_tolerance"] == 1e-14


def of_planes_and_boxes():
    for dim in (2, 3):
        against_data(dim)
        sums_and_neighbours(dim)


play(of_planes_and_boxes, any_order, line)
