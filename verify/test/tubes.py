# SPDX-License-Identifier: GPL-3.0-or-later
"""tubes.py SPHPROOF [COUNT [FIRST]]: skipped work and round-off change nothing.

COUNT random shock tubes (draw number FIRST, FIRST + 1, ...; the same ones every time), with the default scheme and
others. With and without skips figures are the same, and momentum is to round-off; with skip=none every particle is in
every step. A displacement of the start by 1e-13 of the spacing changes no figure of the default scheme by more than
1e-13 times AMPLIFICATION. Healthy runs with much work end. Total energy is conserved to round-off though widths are
loosely solved, and gas is inactive. Commands that disagree are printed."""
import json
import math
import random
import re
import subprocess
import sys
import tempfile

from properties import execute, log_uniform, momentum_error, read_particles

SAME, MOMENTUM, MOVED, AMPLIFICATION = 1e-9, 1e-13, 1e-13, 1e4
DENSITIES, PRESSURES = 100, 1000  # largest ratios
WINDOW = "-0.49871 0.49913"  # no particle of a lattice is at its edge, or at that of a bin
OTHERS = [{"kernel": "cubic_spline", "gradient": "ia", "viscosity": "reconstructed"},
          {"kernel": "cubic_spline", "eta": 4.8, "integrator": "modified_leapfrog"},
          {"kernel": "quartic_spline", "formulation": "lagrangian", "integrator": "vl2"},
          {"kernel": "wendland_c2", "integrator": "leapfrog", "viscosity": "time_dependent"},
          {"viscosity": "fading"}, {"grade": 0.5}]
LEBLANC = {"gamma": 5 / 3, "t_end": 0.4, "mass_ratio": 1e-3, "left": "1 0 0.066667",
           "right": "1e-3 0 6.6667e-11"}
TELLING = [119, 216, 722]  # draws in which a pair's distance lies between two widths of one step
HEALTHY = [{"n": 400, "kernel": "cubic_spline", "eta": 2, "formulation": "lagrangian",
            "integrator": "vl2", **LEBLANC},
           {"n": 3200, "left": "10.51 0 0.006665", "right": "0.03605 0 1.511", "t_end": 0.027}]

LOOSE = {"kernel": "wendland_c2", "formulation": "lagrangian", "integrator": "modified_leapfrog",
         "energy": "total", "h_tolerance": 1e-2}
ENERGY = 1e-12


def draw(number):
    """The keys of a tube, and whether its scheme is the default."""
    rng = random.Random(number)
    rho, P = log_uniform(rng, 0.05, 10), log_uniform(rng, 0.01, 10)
    rho = [rho, rho * log_uniform(rng, 1 / DENSITIES, DENSITIES)]
    P = [P, P * log_uniform(rng, 1 / PRESSURES, PRESSURES)]
    c = [math.sqrt(1.4 * p / r) for p, r in zip(P, rho)]
    v = [round(rng.uniform(-1.5, 1.5) * min(c), 4) for _ in c]
    while v[1] - v[0] > 4 * sum(c):  # close to vacuum, or beyond
        v = [v[0], round(0.5 * (v[0] + v[1]), 4)]
    drift = rng.random()
    if drift < 0.5:  # at rest, or slowly moving as a whole
        v = [0, 0] if drift < 0.2 else [log_uniform(rng, 1e-6, 0.1) * min(c)] * 2
    keys = {"left": "%.6g %.6g %.6g" % (rho[0], v[0], P[0]),
            "right": "%.6g %.6g %.6g" % (rho[1], v[1], P[1]), "n": rng.randint(60, 200),
            "window": WINDOW, "t_end": 1e6}
    default = rng.random() < 0.7
    if not default:
        keys.update(rng.choice(OTHERS))
    return keys, default


class Run:
    def __init__(self, program, keys, folder):
        snapshot = folder + "/end.csv"
        done, self.command = execute(program, "sod", keys, 1, snapshot)
        self.wrong, self.momentum = None, 0
        if not done or done.returncode not in (0, 3):
            self.wrong = done.stderr.strip() if done else "it does not end"
            return
        self.document = json.loads(done.stdout)
        self.ended = done.returncode == 0
        if self.ended:
            self.momentum = momentum_error(self.document, read_particles(snapshot))

    def figures(self):
        """Every error norm by its name."""
        flat = {}
        for field, norms in self.document["errors"].items():
            flat.update({field + " " + k: v for k, v in norms.items()} if isinstance(norms, dict)
                        else {field: norms})
        return {name: value for name, value in flat.items() if value is not None}


def difference(a, b):
    """The largest relative difference of a figure, and its name."""
    if not a.ended or not b.ended:
        return (0 if a.ended == b.ended else math.inf), "the end of the run"
    other = b.figures()
    return max((abs(value - other[name]) / max(abs(value), abs(other[name]), 1e-300), name)
               for name, value in a.figures().items())


def settle(program, keys):
    """The t_end that the mirrored tube allows, from the refusal."""
    done = subprocess.run([program, "run", "sod", *("%s=%s" % item for item in keys.items())],
                          capture_output=True, text=True)
    allowed = re.search(r"allowed: t_end <= ([^,]*),", done.stderr).group(1)
    keys["t_end"] = float("%.4g" % (0.9 * float(allowed)))


def check_draw(program, number, folder, worst):
    """The faults of a draw: lines of text."""
    keys, default = draw(number)
    settle(program, keys)
    auto, none = (Run(program, dict(keys, skip=skip), folder) for skip in ("auto", "none"))
    moved = Run(program, dict(keys, skip="none", jitter=MOVED), folder) if default else none
    for run in (auto, none, moved):
        if run.wrong:
            return [run.command, run.wrong]
    wrong = []
    apart, figure = difference(auto, none)
    grown, grown_figure = difference(none, moved)
    worst["skip"] = max(worst["skip"], apart)
    worst["amplification"] = max(worst["amplification"], grown / MOVED)
    worst["momentum"] = max(worst["momentum"], auto.momentum, none.momentum)
    if not apart <= SAME:
        wrong += ["%s: skip=auto and skip=none differ by %.2g" % (figure, apart), auto.command]
    if not grown / MOVED <= AMPLIFICATION:
        wrong += ["%s: %.2g times the change of the start" % (grown_figure, grown / MOVED),
                  moved.command]
    wrong += [line for run in (auto, none) if not run.momentum <= MOMENTUM
              for line in ("momentum error %.2g" % run.momentum, run.command)]
    cost = none.document["cost"]
    if cost["skipped_particle_updates"] or cost["particle_updates"] != keys["n"] * cost["steps"]:
        wrong += ["skip=none left something out", none.command]
    worst["left out"] += auto.document["cost"]["skipped_particle_updates"] > 0
    worst["broke down"] += not none.ended
    return wrong


def check_loose(program, number, folder):
    """The faults of a draw whose widths are solved to a hundredth: lines of text."""
    keys = dict(draw(number)[0], **LOOSE)
    settle(program, keys)
    run = Run(program, keys, folder)
    if run.wrong:
        return [run.command, run.wrong]
    energy = run.document["conservation"]["energy"] if run.ended else 0
    return [] if energy <= ENERGY else ["energy error %.2g" % energy, run.command]


def main():
    program = sys.argv[1]
    count, first = (int(a) for a in (sys.argv[2:] + ["50", "1"][len(sys.argv) - 2:]))
    worst = {"skip": 0, "amplification": 0, "momentum": 0, "left out": 0, "broke down": 0}
    failed = 0
    with tempfile.TemporaryDirectory() as folder:
        for number in TELLING + list(range(first, first + count)):
            wrong = check_draw(program, number, folder, worst)
            failed += bool(wrong)
            for line in wrong:
                print("draw %d: %s" % (number, line))
        for number in range(first, first + count // 5):
            for line in check_loose(program, number, folder):
                failed += 1
                print("draw %d, loosely solved: %s" % (number, line))
        for keys in HEALTHY:
            run = Run(program, keys, folder)
            if run.wrong or not run.ended:
                failed += 1
                print("a healthy run does not end: %s" % run.command)
    if 2 * worst["left out"] < count:
        failed += 1
        print("skip=auto left nothing out of most tubes")
    print("%d tubes: %d wrong; %s" % (count, failed, ", ".join(
        "%s %.2g" % item for item in worst.items())))
    sys.exit(failed > 0)


if __name__ == "__main__":
    main()
