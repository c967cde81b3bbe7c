# SPDX-License-Identifier: GPL-3.0-or-later
"""properties.py SPHPROOF COUNT [FIRST]: tests properties of runs with random valid settings.

COUNT runs with random settings (draw number FIRST, FIRST + 1, ...; the same ones every time). Each must end well,
with finite numbers that conserve what the scheme conserves, or break down with exit status 3 and a reason; soon, and
without a crash. The command of a run that does not is printed, and reproduces it."""
import csv
import json
import math
import random
import re
import shlex
import subprocess
import sys
import tempfile

SECONDS = 60  # limit for a run; nearly all take hundredths of a second
# Relative bounds. Momentum: over sum |p| + sum m c. Forces are antisymmetric to the last bit except for pairs across the
# ends of the box, whose distance is rounded (to eps box/distance of itself): the few runs that press particles together
# there may exceed round-off.
MOMENTUM, MOMENTUM_FEW, FEW = 1e-12, 1e-6, 0.02
# Total energy: round-off if it is integrated; else to the integrator's order, which is a small number only for a
# stable run.
ENERGY, ENERGY_TAME, ENERGY_ANY = 1e-11, 0.05, 0.5
# Some draws are refused: the message names an allowed value, which must be accepted.
ADVICE = [(r"unless (eta) > (\S*)", 1.05), (r"allowed: (t_end) <= ([^,]*),", 1),
          (r"(t_end)=.* breaks at (\S*) and", 0.9)]
RIEMANN = ["sod", "sod_standard", "strong_shock", "lax", "two_rarefactions"]


def names(program, family):
    return [line.split()[0] for line in subprocess.run(
        [program, "list", family], capture_output=True, text=True, check=True).stdout.splitlines()
        if line.startswith("  ")]


class Program:
    def __init__(self, path):
        self.path = path
        self.choices = {key: [name for name in names(path, family) if self.has_form(key, name)]
                        for key, family in (
            ("kernel", "kernels"), ("gradient", "gradients"), ("formulation", "formulations"),
            ("volume_element", "volume_elements"), ("integrator", "integrators"),
            ("viscosity", "viscosities"), ("h_method", "h_methods"))}
        self.cases = [name for name in names(path, "cases") if name in RIEMANN + ["sound_wave"]]

    def has_form(self, key, name):
        """True if this choice exists in 1D."""
        refused = subprocess.run([self.path, "run", "sod", f"{key}={name}", "--explain"],
                                 capture_output=True, text=True).stderr
        return "dimension=1 exclude each other" not in refused


def log_uniform(rng, low, high):
    return float("%.4g" % math.exp(rng.uniform(math.log(low), math.log(high))))


def state(rng):
    return "%g %g %g" % (log_uniform(rng, 1e-2, 10), round(rng.uniform(-1.5, 1.5), 3),
                         log_uniform(rng, 1e-3, 10))


def draw(program, number):
    """Case, keys and threads of one run."""
    rng = random.Random(number)
    case = rng.choice(program.cases)
    keys = {key: rng.choice(values) for key, values in program.choices.items()}
    maybe = lambda chance, key, value: keys.update({key: value}) if rng.random() < chance else None
    keys["eta"] = log_uniform(rng, 1.8, 20 if rng.random() < 0.1 else 7)
    maybe(0.3, "eta", "auto")
    maybe(0.5, "cfl", log_uniform(rng, 0.03, 1.5))
    maybe(0.5, "energy", rng.choice(["internal", "total"]))
    maybe(0.6, "h_method", "auto")
    widths = ["mean"] if keys["formulation"] == "lagrangian" else ["mean", "max", "harmonic"]
    maybe(0.4, "pair_width", rng.choice(widths))
    maybe(0.2, "alpha", round(rng.uniform(0, 3), 2))
    maybe(0.1, "beta", round(rng.uniform(0, 6), 2))
    maybe(0.2, "gamma", round(rng.uniform(1.05, 3), 2))
    maybe(0.3, "jitter", round(rng.uniform(0, 0.49), 2))
    maybe(0.1, "lattice", rng.choice(["clustered", "coincident"]))
    maybe(0.3, "skip", "none")
    maybe(0.1, "h_tolerance", log_uniform(rng, 1e-14, 1e-3))
    maybe(0.3, "sinc_n", rng.randint(3, 12))
    unused = {"sinc_n": keys["kernel"] != "sinc", "alpha": keys["viscosity"] in ("none", "time_dependent"),
              "beta": keys["viscosity"] == "none"}  # combinations that are refused
    for key in unused:
        if unused[key]:
            keys.pop(key, None)
    if case in RIEMANN:
        maybe(0.2, "grade", round(rng.uniform(0.05, 1), 2))
        maybe(0.1, "mass_ratio", log_uniform(rng, 0.05, 20))
        if rng.random() < 0.2:
            keys.update(left=state(rng), right=state(rng), t_end=0.05)
    else:
        maybe(0.5, "amplitude", log_uniform(rng, 1e-8, 0.2))
        maybe(0.3, "waves", rng.randint(1, 5))
        maybe(0.8, "t_end", round(rng.uniform(0.01, 0.3), 3))
    keys["n"] = rng.randint(4, 30) if rng.random() < 0.2 else rng.randint(30, 200)
    seed = rng.randint(0, 4294967295)
    if keys.get("jitter"):
        keys["seed"] = seed
    return case, keys, rng.randint(1, 3)


SHIFTING = [("gresho", 300, 0.1), ("noh_2d", 300, 0.1), ("kelvin_helmholtz", 300, 0.2), ("sedov_3d", 1000, 0.03)]


def draw_shifting(number):
    """Case, keys and threads of one run with shifting in 2D or 3D."""
    rng = random.Random(number)
    case, least, t_end = rng.choice(SHIFTING)
    keys = {"shifting": rng.choice(["fluxes", "closed"]), "kernel": rng.choice(["cubic_spline", "wendland_c4"])}
    if rng.random() < 0.3:
        keys["alpha_u"] = round(rng.uniform(0.1, 1), 2)
    keys.update(n=rng.randint(least, 2 * least), t_end=round(t_end * rng.uniform(0.3, 1), 4),
                jitter=round(rng.uniform(0.01, 0.2), 2), seed=rng.randint(0, 4294967295))
    return case, keys, rng.randint(1, 3)


# Cases with blocks of local steps, and least numbers of particles.
LOCALS = [("noh_2d", 300, 0.1), ("sedov_2d", 300, 0.05), ("noh_3d", 1000, 0.1), ("sedov_3d", 1000, 0.03)]
LOCAL_BOUND = 1e-12  # of momentum, and of total energy if that is integrated


def draw_local(number):
    """Case, keys and threads of one run with steps=local in 2D or 3D."""
    rng = random.Random(number)
    case, least, t_end = rng.choice(LOCALS)
    keys = {"steps": "local", "kernel": rng.choice(["cubic_spline", "wendland_c2", "quadratic_spline"])}
    maybe = lambda chance, key, value: keys.update({key: value}) if rng.random() < chance else None
    maybe(0.3, "gradient", rng.choice(["standard", "ia", "blended"]))
    maybe(0.3, "viscosity", rng.choice(["constant", "reconstructed", "projected"]))
    maybe(0.3, "alpha_u", round(rng.uniform(0.1, 1), 2))
    maybe(0.3, "shock_conductivity", round(rng.uniform(0, 4), 2))
    maybe(0.3, "cfl", log_uniform(rng, 0.05, 0.4))
    maybe(0.3, "energy", rng.choice(["internal", "total"]))
    maybe(0.3, "jitter", round(rng.uniform(0, 0.2), 2))
    maybe(0.4, "skip", "none")
    keys.update(n=rng.randint(least, 2 * least), t_end=round(t_end * rng.uniform(0.3, 1), 4))
    seed = rng.randint(0, 4294967295)
    if keys.get("jitter"):
        keys["seed"] = seed
    return case, keys, rng.randint(1, 3)


def check_cloud(program, drawn):
    """The fault of such a run (None if there is none), its command, its document."""
    with tempfile.TemporaryDirectory() as folder:
        done, command = execute(program, *drawn, folder + "/end.csv")
    if not done or done.returncode not in (0, 3):
        return done.stderr.strip() if done else "more than %d s" % SECONDS, command, None
    document = json.loads(done.stdout)
    if done.returncode == 3:
        return None, command, document
    kept = document["conservation"]
    wrong = wrong_numbers({k: document[k] for k in ("conservation", "cost", "time", "errors")})
    if wrong:
        return "not finite: " + ", ".join(wrong), command, document
    bounds = {"mass": 1e-15 if document["settings"]["shifting"] == "none" else 1e-13, "momentum": LOCAL_BOUND,
              "energy": LOCAL_BOUND if document["settings"]["energy"] == "total" else ENERGY_TAME}
    drifts = {name: kept[name] for name, bound in bounds.items() if not kept[name] <= bound}
    return "not kept: %s" % drifts if drifts else None, command, document


def wrong_numbers(value, path=""):
    """Paths of numbers in a document that are not finite."""
    if isinstance(value, dict):
        return [w for k, v in value.items() for w in wrong_numbers(v, path + "/" + k)]
    if isinstance(value, list):
        return [w for i, v in enumerate(value) for w in wrong_numbers(v, path + "/%d" % i)]
    bad = value in ("nan", "inf", "-inf") or (isinstance(value, float) and not math.isfinite(value))
    return [path] if bad else []


def read_particles(path):
    with open(path, newline="", encoding="utf-8") as file:
        return [{k: float(v) for k, v in row.items()} for row in csv.DictReader(line for line in file if line[0] != "#")]


def check_particles(rows):
    for i, row in enumerate(rows):
        for name, value in row.items():
            if not math.isfinite(value) or (name in ("m", "rho", "u", "P", "h") and value <= 0):
                return "%s of particle %d is %r" % (name, i, value)
        if i and row["x"] < rows[i - 1]["x"]:
            return "particle %d is out of order" % i
    return None


def tame(keys):
    """True if time step and scheme are defaults, and the start is orderly."""
    return keys["n"] >= 30 and not {"cfl", "alpha", "beta", "jitter", "lattice", "pair_width"} & set(keys) and (
        keys["eta"] == "auto" and keys["viscosity"] == "constant")


def check_document(document, rows, keys):
    """The fault of a run that ended well (None if there is none)."""
    wrong = wrong_numbers({k: document[k] for k in ("conservation", "cost", "time")})
    low, high = document["window"]
    if any(low <= row["x"] <= high for row in rows):
        wrong += wrong_numbers(document["errors"])
    if wrong:
        return "not finite: " + ", ".join(wrong)
    kept, settings = document["conservation"], document["settings"]
    if kept["mass"] > 1e-15:
        return "mass error %g" % kept["mass"]
    bound = (ENERGY if settings["energy"] == "total" else
             ENERGY_TAME if tame(keys) else ENERGY_ANY)
    if not kept["energy"] <= bound:
        return "energy error %g above %g" % (kept["energy"], bound)
    if not document["momentum_error"] <= MOMENTUM_FEW:
        return "momentum error %g" % document["momentum_error"]
    return None


def momentum_error(document, rows):
    """Relative to sum |p| + sum m c; the document's is relative to sum |p|, however small."""
    p = sum(row["m"] * abs(row["vx"]) for row in rows)
    sound = sum(row["m"] * math.sqrt(document["settings"]["gamma"] * row["P"] / row["rho"])
                for row in rows)
    return document["conservation"]["momentum"] * (p if p > 1e-12 * sound else sound) / (p + sound)


def execute(program, case, keys, threads, snapshot):
    command = ["run", case, *("%s=%s" % item for item in keys.items()), "--threads", str(threads)]
    try:
        done = subprocess.run([program, *command, "--json", "-", "--snapshot", snapshot],
                              capture_output=True, text=True, timeout=SECONDS)
    except subprocess.TimeoutExpired:
        done = None
    return done, shlex.join(["sphproof", *command])


def check_run(program, case, keys, threads, folder):
    """The fault of a run (None if there is none), its command, its document."""
    snapshot = folder + "/end.csv"
    done, command = execute(program, case, keys, threads, snapshot)
    for pattern, factor in ADVICE:
        advice = done and done.returncode == 2 and re.search(pattern, done.stderr)
        if advice:
            keys[advice.group(1)] = factor * float(advice.group(2))
            done, command = execute(program, case, keys, threads, snapshot)
    if not done:
        return "more than %d s" % SECONDS, command, None
    if done.returncode not in (0, 3):
        return "exit status %d: %s" % (done.returncode, done.stderr.strip()), command, None
    document = json.loads(done.stdout)
    if done.returncode == 3:
        well = document["status"] == "broke_down" and "broke down at t = " in done.stderr
        return None if well else "no reason: " + done.stderr, command, document
    if document["status"] != "ok":
        return "status %s" % document["status"], command, document
    rows = read_particles(snapshot)
    if len(rows) != document["n"]:
        return "%d particles of %d" % (len(rows), document["n"]), command, document
    document["momentum_error"] = momentum_error(document, rows)
    return check_particles(rows) or check_document(document, rows, keys), command, document


def same_in_units(path):
    """Sod's tube in other units, by powers of two: the same result to the last bit, and no unit is refused."""
    def l1(mass, pressure, length):
        speed = 2.0 ** ((pressure - mass) // 2)
        keys = ["left=%.17g 0 %.17g" % (2.0 ** mass, 2.0 ** pressure),
                "right=%.17g 0 %.17g" % (2.0 ** mass / 8, 2.0 ** pressure / 8),
                "lo=%.17g" % -2.0 ** length, "hi=%.17g" % 2.0 ** length,
                "window=%.17g %.17g" % (-2.0 ** length / 2, 2.0 ** length / 2),
                "t_end=%.17g" % (2.0 ** length / speed / 8)]
        done = subprocess.run([path, "run", "sod", "n=60", *keys, "--json", "-"], capture_output=True, text=True)
        return json.loads(done.stdout)["errors"]["density"]["l1"] / 2.0 ** mass if done.stdout else done.stderr
    seen = [l1(*units) for units in ((0, 0, 0), (20, -26, 17), (-40, 40, -30), (66, -20, 50))]
    return "" if all(value == seen[0] for value in seen) else "errors in four units: %s" % seen


def main():
    program = Program(sys.argv[1])
    count, first = int(sys.argv[2]), int(sys.argv[3]) if len(sys.argv) > 3 else 1
    ended, broken, failed, drifting = 0, 0, 0, []
    scaled = same_in_units(program.path)
    if scaled:
        failed += 1
        print(scaled)
    with tempfile.TemporaryDirectory() as folder:
        for number in range(first, first + count):
            wrong, command, document = check_run(program.path, *draw(program, number), folder)
            if wrong:
                failed += 1
                print("draw %d: %s\n    %s" % (number, wrong, command))
            elif document["status"] == "broke_down":
                broken += 1
            else:
                ended += 1
                if document["momentum_error"] > MOMENTUM:
                    drifting.append("momentum error %g\n    %s" % (document["momentum_error"],
                                                                   command))
    in_blocks = 0
    for number in range(first, first + max(count // 8, 4)):
        wrong, command, document = check_cloud(program.path, draw_local(number))
        shifted, shifting, _ = check_cloud(program.path, draw_shifting(number))
        failed += bool(wrong) + bool(shifted)
        if shifted:
            print("draw %d of shifting: %s\n    %s" % (number, shifted, shifting))
        if wrong:
            print("draw %d of local steps: %s\n    %s" % (number, wrong, command))
        else:
            in_blocks += document["settings"]["skip"] == "none" and document["cost"]["skipped_particle_updates"] > 0
    if not in_blocks:
        failed += 1
        print("no run took blocks of local steps")
    if len(drifting) > FEW * count + 1:
        failed += 1
        print("\n".join(["too many with momentum errors beyond round-off:"] + drifting))
    if ended < count / 2 and count > 20:
        failed += 1
        print("only %d of %d runs ended well" % (ended, count))
    print("%d runs: %d ended, %d broke down, %d beyond round-off in momentum, %d wrong" %
          (count, ended, broken, len(drifting), failed))
    sys.exit(failed > 0)


main()
