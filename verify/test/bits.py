# SPDX-License-Identifier: GPL-3.0-or-later
"""bits.py SOURCE FOLDER: tests that every build computes the same bits.

Builds the program in FOLDER with gcc and with clang (if installed): with loops chosen at run time, and compiled
entirely for the baseline, AVX2 and AVX-512 (if this processor has them). All builds, each with 1, 2 and 7 threads,
must give the same particles, errors, conservation and counts of work, to the last of 17 digits."""
import hashlib
import json
import os
import shutil
import subprocess
import sys

# more than 2048 particles, because fewer are computed by one thread
RUNS = [
    "sod n=2113 t_end=0.05",
    "sod n=450 grade=0.2",
    "strong_shock n=2500 t_end=0.004 kernel=cubic_spline gradient=ia viscosity=reconstructed",
    "sod_standard n=2113 t_end=0.02 kernel=cubic_spline eta=4.8 integrator=modified_leapfrog",
    "lax n=2200 t_end=0.02 kernel=quintic_spline formulation=lagrangian integrator=rk3",
    "two_rarefactions n=2113 t_end=0.03 volume_element=energy viscosity=time_dependent",
    "sound_wave n=2113 t_end=0.02 kernel=wendland_c6 gradient=ia integrator=vl2",
    "sound_wave n=300 t_end=0.1 kernel=sinc integrator=leapfrog jitter=0.2",
    "sod n=2113 t_end=0.02 kernel=quartic_spline pair_width=harmonic integrator=rk2 jitter=0.2",
    "sod n=2113 t_end=0.02 kernel=wendland_c2 integrator=symplectic_euler energy=total",
    "sod n=2113 t_end=0.02 kernel=wendland_c4 formulation=lagrangian gradient=ia",
    "gresho n=32^2 t_end=0.05",
    "gresho n=24^2 t_end=0.05 viscosity=cullen_dehnen balsara=on kernel=cubic_spline",
    "sod_2d n=2000 t_end=0.05 gradient=corrected integrator=rk2 viscosity=reconstructed",
    "kelvin_helmholtz_mode n=16^2 t_end=0.02",
    "rayleigh_taylor_mode n=16^2 t_end=0.02",
    "rotation n=16^2 t_end=0.02",
    "square n=24^2 t_end=0.05 gradient=blended formulation=lagrangian volume_element=energy integrator=leapfrog",
    "sod_3d n=4000 t_end=0.02 gradient=standard viscosity=constant kernel=wendland_c2",
    "rest_3d n=12^3 t_end=0.1 jitter=0.2",
    "rest_3d n=10^3 t_end=0.1 jitter=0.2 kernel=quintic_spline viscosity=time_dependent h_method=newton",
    "noh_2d n=2500 t_end=0.06 steps=local kernel=cubic_spline",
    "sedov_2d n=50^2 t_end=0.02 steps=local skip=none kernel=cubic_spline alpha_u=0.5",
    "noh_3d n=3000 t_end=0.1 steps=local kernel=cubic_spline",
]
THREADS = [1, 2, 7]


def instruction_sets():
    """(name, compiler arguments) of each instruction set; None: the program chooses its loops at run time."""
    try:
        with open("/proc/cpuinfo", encoding="ascii") as file:
            flags = next((line for line in file if line.startswith("flags")), "").split()
    except OSError:
        flags = []
    sets = [("chosen at run time", None), ("baseline", "")]
    if "avx2" in flags:
        sets.append(("AVX2 and FMA", "-mavx2 -mfma" if "fma" in flags else "-mavx2"))
    if "avx512f" in flags and "avx512dq" in flags:
        sets.append(("AVX-512", "-mavx512f -mavx512dq -mfma -mprefer-vector-width=512"))
    return sets


def build(source, folder, compiler, arguments):
    """Builds the program and returns its path."""
    shutil.rmtree(folder, ignore_errors=True)
    options = [] if arguments is None else ["-Dclones=false", "-Dc_args=" + arguments]
    for command in (["meson", "setup", folder, source, "-Dslow=false", *options],
                    ["ninja", "-C", folder, "sphproof"]):
        done = subprocess.run(command, capture_output=True, text=True,
                              env={**os.environ, "CC": compiler, "CFLAGS": ""})
        if done.returncode:
            sys.exit("bits: %s:\n%s%s" % (" ".join(command), done.stdout[-2000:], done.stderr))
    return folder + "/sphproof"


def fingerprint(program, run, threads, snapshot):
    done = subprocess.run([program, "run", *run.split(), "--threads", str(threads), "--json", "-",
                           "--snapshot", snapshot], capture_output=True, text=True, timeout=600)
    if done.returncode:
        sys.exit("bits: %s run %s: %s" % (program, run, done.stderr))
    document = json.loads(done.stdout)
    cost = {k: document["cost"][k] for k in ("steps", "particle_updates", "pair_interactions")}
    kept = json.dumps([document["errors"], document["conservation"], cost], sort_keys=True)
    with open(snapshot, "rb") as file:
        particles = file.read()
    return hashlib.sha256(particles).hexdigest(), kept


def main():
    source, folder = sys.argv[1:3]
    os.makedirs(folder, exist_ok=True)
    snapshot, known, wrong, builds = folder + "/end.csv", {}, 0, 0
    for compiler in ("gcc", "clang"):
        if not shutil.which(compiler):
            print("%s is not there: not compared" % compiler)
            continue
        for name, arguments in instruction_sets():
            program = build(source, folder + "/" + compiler, compiler, arguments)
            builds += 1
            for run in RUNS:
                for threads in THREADS:
                    found = fingerprint(program, run, threads, snapshot)
                    first = known.setdefault(run, (found, "%s, %s, %d threads" %
                                                   (compiler, name, threads)))
                    if found != first[0]:
                        wrong += 1
                        what = "particles" if found[0] != first[0][0] else "errors"
                        print("%s, %s, %d threads: %s differ from those of %s\n    sphproof run %s"
                              % (compiler, name, threads, what, first[1], run))
    print("%d builds, %d runs each: %d differ" % (builds, len(RUNS) * len(THREADS), wrong))
    if builds < 2:
        print("one build and another are needed: nothing was compared")
    sys.exit(wrong > 0 or builds < 2)


main()
