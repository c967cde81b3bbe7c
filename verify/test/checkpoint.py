# SPDX-License-Identifier: GPL-3.0-or-later
"""checkpoint.py SPHPROOF [SETUPS] [SEED]: random runs that are killed and resumed. The final particles, the snapshots
and the document, without times and memory, have the bytes of the uninterrupted run; the final particles and the
document also have those of a run without snapshots. (Checkpoints that are damaged, or of another build or run:
test_checkpoint.)"""
import contextlib
import glob
import json
import os
import random
import subprocess
import sys
import time

from script import call, expect, faults, play, program

setups, seed = int(sys.argv[2]) if len(sys.argv) > 2 else 12, int(sys.argv[3]) if len(sys.argv) > 3 else 1
# case, range of the number of particles, end time after a few dozen steps or more
LINES = [("sod", (100, 300), 0.05), ("strong_shock", (100, 200), 0.01), ("sound_wave", (64, 128), 0.2),
         ("lax", (100, 200), 0.03), ("noh_1d", (100, 200), 0.1)]
CLOUDS = [("sod_2d", (1400, 2000), 0.03), ("gresho", (256, 576), 0.03), ("kelvin_helmholtz", (256, 400), 0.05),
          ("kelvin_helmholtz_mode", (256, 400), 0.6), ("sedov_2d", (256, 400), 0.02), ("sod_3d", (9216, 9600), 0.02),
          ("rest_3d", (512, 729), 0.05), ("noh_2d", (400, 600), 0.02)]
CHOICES = {"kernel": ["cubic_spline", "quintic_spline", "wendland_c2", "wendland_c4", "sinc"],
           "gradient": ["standard", "ia"], "volume_element": ["mass", "energy", "number"],
           "integrator": ["leapfrog", "modified_leapfrog", "symplectic_euler", "rk2", "vl2", "rk3",
                          "predicted_midpoint"],
           "viscosity": ["constant", "time_dependent", "reconstructed", "fading"],
           "energy": ["internal", "total"], "skip": ["auto", "none"], "h_method": ["newton", "predicted"]}
CLOUD_VISCOSITIES = ["cullen_dehnen", "projected"]
# cases with local time steps that take blocks of steps
LOCALS = [("noh_2d", (400, 1600), 0.1), ("sedov_2d", (400, 900), 0.05), ("noh_3d", (1200, 1600), 0.2),
          ("sedov_3d", (1000, 1400), 0.05)]
SHIFTING_CHOICES = {"shifting": ["fluxes", "closed"], "kernel": ["cubic_spline", "wendland_c2"],
                    "alpha_u": ["0", "0.5"]}
LOCAL_CHOICES = {"gradient": ["standard", "ia"], "skip": ["auto", "none"], "energy": ["internal", "total"],
                 "viscosity": ["constant", "reconstructed", "projected"], "alpha_u": ["0", "0.5"]}


def draw(generator):
    """Arguments of a run; some combinations exclude each other."""
    local, cloud = generator.random() < 0.25, generator.random() < 0.6
    case, numbers, t_end = generator.choice(LOCALS if local else CLOUDS if cloud else LINES)
    words = [case, "n=%d" % generator.randint(*numbers), "t_end=%g" % (t_end * generator.uniform(0.7, 1.3))]
    shifts = cloud and not local and generator.random() < 0.2
    if local:
        words += ["steps=local", "kernel=cubic_spline"]
    choices = LOCAL_CHOICES if local else SHIFTING_CHOICES if shifts else CHOICES
    for key in generator.sample(sorted(choices), 3):
        values = choices[key] + (CLOUD_VISCOSITIES if cloud and not local and key == "viscosity" else [])
        words.append("%s=%s" % (key, generator.choice(values)))
    return words


def run(words, *more):
    return call("run", *words, *more, "--quiet")


def seen(stem):
    """The output of a run without times and memory."""
    with open(stem + ".json", encoding="utf-8") as file:
        document = json.load(file)
    for name in ("wall_s", "cpu_s", "peak_rss_bytes"):
        document["cost"].pop(name, None)
    document.pop("date")
    with open(stem + ".csv", "rb") as file:
        return document, file.read()


def on_the_way(stem):
    """Snapshots of a run: end of the file name -> contents."""
    found = {}
    for path in glob.glob(stem + "_????.csv"):
        with open(path, "rb") as file:
            found[path[len(stem):]] = file.read()
    return found


def resume(words, files, generator, longest):
    """Kills the run repeatedly, each time a moment after the first checkpoint it writes; returns how often."""
    kills = 0
    while True:
        threads = ["--threads", generator.choice(["1", "2"])]
        child = subprocess.Popen([program, "run", *words, *files, *threads, "--quiet", "--checkpoint", "state",
                                  "--every", "0", "--resume"], stderr=subprocess.PIPE, text=True)
        before = os.stat("state").st_ino if os.path.exists("state") else None
        until = time.monotonic() + 60
        while kills < 3 and child.poll() is None and time.monotonic() < until:
            if os.path.exists("state") and os.stat("state").st_ino != before:
                time.sleep(generator.uniform(0, longest))
                break
            time.sleep(0.001)
        if kills >= 3 or child.poll() is not None:
            said = child.communicate()[1]
            return kills, said if child.returncode else ""
        child.kill()
        child.communicate()
        kills += 1


def test_bits():
    generator = random.Random(seed)
    resumed = done = passed_over = 0
    while done < setups:
        words = draw(generator)
        began = time.monotonic()
        way = ["--snapshot-every", "%.3g" % (float(words[2].partition("=")[2]) / generator.uniform(1.5, 9))]
        if run(words, "--snapshot", "alone.csv", *way, "--json", "alone.json").returncode:
            passed_over += 1  # keys that exclude each other, or a breakdown
            if passed_over > 4 * setups + 8:
                break
            continue
        longest = (time.monotonic() - began) / 3
        done += 1
        without = run(words, "--snapshot", "plain.csv", "--json", "plain.json")
        expect("a run without snapshots, %s" % " ".join(words), without.returncode == 0, without.stderr)
        kills, said = resume(words, ["--snapshot", "again.csv", *way, "--json", "again.json"], generator, longest)
        resumed += kills
        expect("resumed, %s" % " ".join(words), not said, said)
        if said or not os.path.exists("again.json"):
            break
        (one, rows), (other, others) = seen("alone"), seen("again")
        expect("particles of %s" % " ".join(words), rows == others)
        expect("document of %s" % " ".join(words), one == other, [k for k in one if one[k] != other.get(k)])
        expect("snapshots on the way of %s" % " ".join(words), on_the_way("alone") == on_the_way("again") != {},
               [k for k, rows in on_the_way("alone").items() if rows != on_the_way("again").get(k)])
        plain, still = seen("plain")
        for document in (plain, one):
            document.get("estimate", {}).pop("memory_bytes", None)  # differs by the memory of the state set aside
        expect("%s knows nothing of snapshots" % " ".join(words), (plain, still) == (one, rows))
        for path in glob.glob("a*_????.csv"):
            os.remove(path)
        with contextlib.suppress(FileNotFoundError):  # the run was too short for a checkpoint
            os.remove("state")
    expect("draws that ran, %d were passed over" % passed_over, done >= setups or faults, done)
    expect("runs that were killed", resumed >= (setups + 1) // 4, resumed)


play(test_bits)
