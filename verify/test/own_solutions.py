#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""own_solutions.py SPHPROOF [FOLDER]: `reference = table FILE` and `reference = ./F.so` in case files. Both, made
from Sod's exact solution, give the errors of the case sod, the table up to its interpolation error; faults are
reported with their line. FOLDER: of the shared objects; without it, those built beside SPHPROOF."""
import json
import os
import random
import sys

from script import check, play, program, read, said

folder = os.path.abspath(sys.argv[2] if sys.argv[2:] else os.path.join(os.path.dirname(program), "verify/examples"))
CASE = """[case]
title = Sod's tube
dimension = 1
reference = %s
[initial]
kind = riemann
left = 1 0 1
right = 0.125 0 0.1
[run]
t_end = 0.2
n = 198
[measure]
window = -0.5 0.5
%s
"""
FIELDS = ("density", "velocity", "pressure", "internal_energy")


def result(*words):
    status, out, err = said(*words, "--json", "-")
    check(status == 0, words, status, err)
    return json.loads(out) if out else {}


missing = set()


def library(name):
    """Links into this folder, because messages shorten long paths."""
    built, link = os.path.join(folder, name + ".so"), "./%s.so" % name
    if not os.path.exists(built):
        missing.add(link)
    elif not os.path.exists(link):
        os.symlink(built, link)
    return link


def refused(reference, *words, fields="", status=2, line=4):
    if not sys.argv[2:] and reference.split()[0] in missing:
        return  # it has not been built
    with open("bad.ini", "w") as file:
        file.write(CASE % (reference, fields))
    code, out, err = said("run", "./bad.ini", "--json", "bad.json")
    check(code == status and not out and not os.path.exists("bad.json"), reference, code, out, err)
    check(line is None or ":%d: " % line in err, reference, "has no line", err)
    for word in words:
        check(word in err, reference, "does not say", repr(word), "but", err)


def rows(places, time=0.2, start=-0.6, step=1.2 / 1200):
    sampled = json.loads(said("riemann", "1", "0", "1", "0.125", "0", "0.1", "--time", "0.2", "--sample=-0.6:0.6:1201",
                              "--json", "-")[1])["samples"]
    return "# time = %r\nx,rho,vx,P\n" % time + "".join(
        "%r,%r,%r,%r\n" % (s["x"], s["density"], s["velocity"], s["pressure"]) for s in sampled[places])


def main():
    os.environ["XDG_CACHE_HOME"] = os.getcwd()
    with open("fine.csv", "w") as file:
        file.write(rows(slice(None)))
    with open("table.ini", "w") as file:
        file.write(CASE % ("table fine.csv", ""))
    with open("so.ini", "w") as file:
        file.write(CASE % (library("sod_reference"), ""))
    with open("slip.ini", "w") as file:
        file.write(CASE % (library("sod_reference") + " slip=0.5", ""))
    for word in random.Random(7).sample(("kernel=cubic_spline", "n=301", "eta=2.4", "alpha=1.3", "gradient=ia"), 2):
        exact, so, table, slip = (result("run", case, "n=198", word)["errors"]
                                  for case in ("sod", "./so.ini", "./table.ini", "./slip.ini"))
        for field in FIELDS:
            a, b, c = (e[field]["l1"] for e in (exact, so, table))
            check(abs(b / a - 1) < 1e-10, word, field, "of the shared object", b, "for", a)
            check(abs(c - a) <= 3 * table["interpolation"][field] < 0.6 * a, word, field, "of the table", c, "for", a,
                  table["interpolation"][field])
        check(slip["density"]["l1"] > 1.2 * exact["density"]["l1"], "a wrong solution is not seen", slip["density"])
        check("interpolation" not in so, "interpolation without a table")
    with open("swapped.csv", "w") as file:
        file.write(read("fine.csv").replace("rho,vx,P", "P,vx,rho"))
    with open("swapped.ini", "w") as file:
        file.write(CASE % ("table swapped.csv", ""))
    note = "sphproof: note: density is nearer the exact pressure than its own exact solution\n"
    for quiet in (), ("--quiet",):
        found = said("run", "./swapped.ini", "n=198", *quiet)
        check((note in found[2]) == (not quiet), "exchanged columns of the table", found)
    check(said("run", "sod", "n=198", "--snapshot", "s.csv", "--quiet")[0] == 0, "no snapshot")
    exact, so, table = (result("judge", "s.csv", "--case", case)["errors"] for case in ("sod", "./so.ini", "./table.ini"))
    check(all(abs(so[f]["l1"] / exact[f]["l1"] - 1) < 1e-10 for f in FIELDS), "judge", so, exact)
    check(all(abs(table[f]["l1"] - exact[f]["l1"]) <= 3 * table["interpolation"][f] for f in FIELDS), "judge", table, exact)
    # a ladder, cached by content: another table is another result
    words = ("converge", "./table.ini", "--n", "60,80,100,120", "--replicates", "1", "--cache", "kept")
    first = result(*words)
    check(first == dict(result(*words), **{k: first[k] for k in ("date",)}) or
          result(*words)["levels"] == first["levels"], "a kept ladder differs")
    check("interpolation" in first["levels"][0]["errors"] or "table" in said(*words)[1], "a ladder without a word of the table")
    with open("fine.csv", "w") as file:
        file.write(rows(slice(None, None, 8)))
    check(result(*words)["levels"] != first["levels"], "another table, the same ladder")
    # another code, whose snapshot is ours
    os.symlink(program, "ours")
    with open("code.ini", "w") as file:
        file.write("[code]\ntitle = a code\nic = csv\ncommand = ./ours run sod n=@N@ t_end=@T_END@ --quiet --snapshot @OUT@.csv\n"
                   "snapshot = @OUT@.csv\n[case ./so.ini]\n")
    ours, theirs = result("run", "./so.ini"), result("run", "./so.ini", "--code", "code.ini")
    for field in FIELDS:
        a, b = (e.get("errors", {}).get(field, {}).get("l1", 0) for e in (ours, theirs))
        check(abs(b / a - 1) < 1e-10, "--code", field, b, "for", a)
    # particles with the state of a solution at t = 0
    with open("laid.ini", "w") as file:
        file.write("[case]\ntitle = Sod's tube\ndimension = 1\nreference = %s\n[initial]\nkind = particles\n[run]\n"
                   "t_end = 0.05\n" % library("sod_reference"))
    laid = result("run", "./laid.ini", "n=200", "window=-0.5 0.5")["errors"]
    check(0 < laid["density"]["l1"] < 0.02, "laid particles", laid["density"])

    # faults
    good = rows(slice(None, None, 100)).splitlines()
    head, lines = good[:2], good[2:]
    nan = lines[3].split(",")
    broken = {
        "unsorted": (head + lines[:4] + [lines[3]] + lines[4:], ":7: x = ", "rising"),
        "nan": (head + lines[:3] + [",".join(nan[:1] + ["nan"] + nan[2:])] + lines[4:], ":6:"),
        "one": (head + lines[:1], "1 row:", "2 or more"),
        "none": (head, "0 rows"),
        "places": ([head[0], head[1].replace("x,", "s,")] + lines, "a column x"),
        "fields": ([head[0], "x,a,b,c"] + lines, "columns rho, vx, vy, vz, P, u"),
        "time": (head[1:] + lines, "# time = T"),
        "early": (["# time = 0.1", head[1]] + lines, "is of t = 0.1"),
        "short": (head + lines[:-3], "do not cover the window", "x = 0.5"),
        "grid": ([head[0], "x,y,rho", "0,0,1", "0,1,1", "1,0,1", "1,2,1"], ":6: x = 1, y = 2", "rectangular grid"),
    }
    for name, (text, *words) in broken.items():
        with open(name + ".csv", "w") as file:
            file.write("\n".join(text) + "\n")
        refused("table %s.csv" % name, *words, line=None if name in ("early", "short") else 4)
    with open("thin.csv", "w") as file:
        file.write("\n".join([head[0], "x,rho,vx,q"] + lines) + "\n")
    refused("table thin.csv", "says nothing of pressure", fields="fields = density pressure", line=14)
    refused("table no.csv", "no.csv", "no file")
    refused("table", "table FILE")
    refused("table fine.csv more", "more")
    refused("./no.so", "no.so", "no file")
    refused("./fine.so nu", "no file")
    refused(library("sod_reference") + " nu", "NAME=NUMBER")
    refused(library("sod_reference") + " nu=1 nu=2", "nu stands twice")
    with open("text.so", "w") as file:
        file.write("text")
    refused("./text.so", "no shared object", line=None)
    refused(library("cubic_copy"), "has no function sphproof_reference", line=None)
    refused(library("sod_reference_crashes"), "crashes (Aborted) in sphproof_reference(", line=None)
    refused(library("sod_reference_loops"), "does not return within 1 s in sphproof_reference(", line=None)
    refused(library("sod_reference_prints"), "it prints", line=None)
    refused(library("sod_reference_unknown"), "nothing is known at t = 0.2", line=None)
    refused(library("sod_reference_partly"), "not finite at", line=None)
    refused(library("sod_reference_later"), "reference", "crashes (Aborted) in sphproof_reference(", status=1, line=None)


play(main)
