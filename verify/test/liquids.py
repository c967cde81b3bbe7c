#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""liquids.py SPHPROOF: snapshots of liquids, computed here with other formulas than the program's, are judged as
exact; with a wrong viscosity, a missing term of the series, gravity of the wrong sign or another time they are not.
Our solver does not run these cases; their initial states are judged as exact."""
import json
import math
import os
import random

from script import check, play, said

draw = random.Random(11)


def judged(path, case, *words):
    code, out, err = said("judge", path, "--case", case, *words, "--json", "-")
    check(code in (0, 1) and out, path, case, code, err)
    return json.loads(out) if out else {"errors": {}, "functionals": []}


def couette(y, t, nu):
    """Couette flow, by the method of images."""
    width = 2 * math.sqrt(nu * t)
    return sum(math.erfc((2 * n + 1 - y) / width) - math.erfc((2 * n + 1 + y) / width) for n in range(60))


def poiseuille(y, t, nu, force, terms=4000):
    """Poiseuille flow from its eigenfunctions, without the known parabola of the steady flow."""
    return sum(4 * force / (nu * (n * math.pi) ** 3) * math.sin(n * math.pi * y) * (1 - math.exp(-nu * (n * math.pi) ** 2 * t))
               for n in range(1, 2 * terms, 2))


def cloud(wide=1):
    n = draw.randint(9, 12)
    places = [(wide * (i + 0.5 + draw.uniform(-0.3, 0.3)) / (wide * n), (j + 0.5 + draw.uniform(-0.3, 0.3)) / n)
              for i in range(wide * n) for j in range(n)]
    return places, 1 / n ** 2


def write(path, flow, t, places, mass, walls=False, pressure=True):
    if walls:  # particles of plates, which are not compared
        places = places + [(x, y) for x, _ in places[::7] for y in (-0.05, 1.05)]
    with open(path, "w") as file:
        file.write("# time = %r\nx,y,vx,vy,m,rho%s\n" % (t, ",P" if pressure else ""))
        for x, y in places:
            vx, vy, rho, P = flow(x, y)
            file.write(",".join(map(repr, (x, y, vx, vy, mass * rho, rho) + ((P,) if pressure else ()))) + "\n")


def try_flow(name, case, t, right, wrong, words=(), wide=1, field="velocity", far=0.02):
    places, mass = cloud(wide)
    box = draw.choice((("--box", "0:%d 0:1" % wide), ()))
    for walls in (False, True) if case in ("couette", "poiseuille") else (False,):
        write("right.csv", right, t, places, mass, walls, pressure=draw.random() < 0.5 or field == "pressure")
        result = judged("right.csv", case, *box, *words)
        check(result["errors"].get(field, {}).get("l1", 1) < 1e-9, name, "walls" if walls else "", result["errors"].get(field))
    for what, flow in wrong.items():
        write("wrong.csv", flow, t, places, mass)
        error = judged("wrong.csv", case, *box, *words)["errors"].get(field, {}).get("l1", 0)
        check(error > far * 1e-2, name, what, "is not seen:", error)
    return result


def still(vx, vy=0.0):
    return vx, vy, 1.0, draw.uniform(-1, 1)


def main():
    t = draw.uniform(0.2, 2)
    try_flow("couette", "couette", t, lambda x, y: still(couette(y, t, 0.1)),
             {"viscosity": lambda x, y: still(couette(y, t, 0.11)), "time": lambda x, y: still(couette(y, 0.9 * t, 0.1)),
              "plate": lambda x, y: still(couette(1 - y, t, 0.1))})
    try_flow("poiseuille", "poiseuille", t, lambda x, y: still(poiseuille(y, t, 0.1, 0.8)),
             {"viscosity": lambda x, y: still(poiseuille(y, t, 0.11, 0.8)),
              "a term": lambda x, y: still(poiseuille(y, t, 0.1, 0.8, terms=1)),
              "sign": lambda x, y: still(-poiseuille(y, t, 0.1, 0.8))})

    def vortices(x, y, nu=0.01, e=2):
        k = 2 * math.pi
        a = math.exp(-e * nu * k * k * t) / 2
        return still(a * (math.sin(k * (x + y)) + math.sin(k * (x - y))), -a * (math.sin(k * (x + y)) - math.sin(k * (x - y))))

    result = try_flow("vortices", "taylor_green", t, vortices,
                      {"viscosity": lambda x, y: vortices(x, y, 0.011), "decay": lambda x, y: vortices(x, y, 0.01, 1)})
    decay = {f["name"]: f for f in result["functionals"]}.get("vortex_decay", {"value": 0, "reference": 1})
    check(abs(decay["value"] / decay["reference"] - 1) < 1e-9 and abs(decay["value"] - 0.02 * 4 * math.pi ** 2) < 1e-9, decay)

    def column(x, y, g=1.0, c=10.0, steps=2000):
        rho, dy = 1.0, (1 - y) / steps  # from the surface downwards, by the midpoint rule
        for _ in range(steps):
            rho += dy * g / c ** 2 * (rho + 0.5 * dy * g / c ** 2 * rho)
        return 0.0, 0.0, rho, c ** 2 * (rho - 1)

    for field in "density", "pressure":
        try_flow("column", "hydrostatic", t, column, {"sign of gravity": lambda x, y: column(x, y, -1.0),
                                                      "speed of sound": lambda x, y: column(x, y, 1.0, 12.0)}, field=field)

    def wave(x, y, g=1.0, depth=1.0):
        k = math.pi
        omega = math.sqrt(g * k * (math.exp(2 * k) - 1) / (math.exp(2 * k) + 1))
        a = 0.01 * omega * math.cos(omega * t) / (math.exp(k) - math.exp(-k))
        return still(-a * (math.exp(k * y) + math.exp(-k * y)) * math.sin(k * x), a * (math.exp(k * y) - math.exp(-k * y)) * math.cos(k * x))

    try_flow("wave", "standing_wave", t, wave, {"gravity": lambda x, y: wave(x, y, 1.2),
                                                "sign": lambda x, y: tuple(-v for v in wave(x, y)[:2]) + (1.0, 0.0)}, wide=2, far=1e-3)
    for case in "taylor_green", "couette", "poiseuille", "hydrostatic", "standing_wave":
        code, out, err = said("run", case, "n=400", "--json", "run.json")
        check(code == 2 and not out and "does not run" in err and not os.path.exists("run.json"), case, code, err)
        check(said("ic", case, "n=400", "--format", "csv", "--out", "ic.csv")[0] == 0, case, "has no initial state")
        result = judged("ic.csv", case)
        for field in ("velocity", "pressure") if case == "hydrostatic" else ("velocity",):
            check(result["errors"][field]["l1"] < 1e-15, case, "starts otherwise:", field, result["errors"][field])
    # a column at rest, of a code that stores no pressure, or pressures below 0
    for change in "| cut -d, -f1-6", r"| sed '/^[0-9]/s/[^,]*,\([^,]*\)$/-1,\1/'":
        with open("code.ini", "w") as file:
            file.write("[code]\nshell = yes\nsnapshot = @OUT@.csv\ncommand = sed 's/^# time = 0/# time = @T_END@/' @IC@ %s "
                       ">@OUT@.csv\n[case hydrostatic]\n" % change)
        code, out, err = said("run", "hydrostatic", "n=400", "--code", "code.ini", "--json", "-")
        check(code == 0 and out, change, code, err)
        result = json.loads(out or "{}")
        errors, kept = result.get("errors", {}), result.get("conservation", {})
        check(errors.get("density", {}).get("l1", 1) < 1e-3, change, errors)
        check(kept.get("energy", 1) < 1e-12, change, kept)  # whatever u says, or if there is none
        pressure = errors.get("pressure", {}).get("l1", 0)
        check(pressure == "nan" if "cut" in change else pressure > 1, change, errors)
    for words, reported in ((("nu=0",), "nu=0"), (("gravity=0 -1",), "along x"), (("speed=0",), "stays at rest")):
        code, _, err = said("ic", "couette", *words, "--format", "csv", "--out", "no.csv")
        check(code == 2 and reported in err and not os.path.exists("no.csv"), words, code, err)
    for case, word, reported in (("hydrostatic", "gravity=0 1", "downwards"), ("standing_wave", "gravity=1 0", "downwards"),
                             ("taylor_green", "hi=2 1", "one length"), ("taylor_green", "speed=0", "no vortices"),
                             ("standing_wave", "amplitude=0", "no wave")):
        code, _, err = said("ic", case, word, "--format", "csv", "--out", "no.csv")
        check(code == 2 and reported in err, case, word, code, err)


play(main)
