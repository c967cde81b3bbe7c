# SPDX-License-Identifier: GPL-3.0-or-later
"""engine.py SPHPROOF: `--engine slurm` with scripts in place of Slurm's commands: what is missing is
submitted again, twice at most; then it is said what, and nothing is lost. (slurm.py has the real ones.)"""
import glob
import json
import os
import subprocess
import sys
import tempfile

from studying import expect, faults, program, study, without_times

QUICK = ["converge", "sod", "--n", "40,44,50,60", "t_end=0.1", "--replicates", "2"]


def entries():
    return glob.glob("cache/*/*.entry")


# Stands for Slurm's commands: sbatch computes the shares at once, but those of $SPARED; it counts itself.
FAKE = """#!/bin/sh
case ${0##*/} in
squeue) [ ! -e submitted ] || echo "7 2 ${STATE:-TIMEOUT} None" ;;
scancel) ;;
sbatch)
    echo >>submitted
    while [ $# -gt 1 ]; do
        case $1 in --array=*) array=${1#--array=} ;; --wrap) wrap=$2 ;; esac
        shift
    done
    case $array in 1-3) array='1 2 3' ;; esac
    for SLURM_ARRAY_TASK_ID in $array; do
        [ "$SLURM_ARRAY_TASK_ID" = "$SPARED" ] || sh -c "SLURM_ARRAY_TASK_ID=$SLURM_ARRAY_TASK_ID; $wrap" >/dev/null
    done
    echo 7 ;;
esac
"""


def test_engine():
    os.makedirs("bin")
    for name in ("sbatch", "squeue", "scancel"):
        with open("bin/" + name, "w", encoding="ascii") as file:
            file.write(FAKE)
        os.chmod("bin/" + name, 0o755)
    _, alone, _ = study(*QUICK)
    for spared, state, submitted, code in (("", "", 1, 1), ("2", "TIMEOUT", 3, 4), ("2", "CANCELLED", 1, 4)):
        for name in entries() + glob.glob("submitted"):
            os.remove(name)
        done = subprocess.run([program, *QUICK, "--cache", "cache", "--engine", "slurm", "--engine-tasks", "3",
                               "--engine-options", "--partition=any", "--json", "slurm.json"], capture_output=True,
                              text=True, env=dict(os.environ, PATH=os.path.abspath("bin") + ":" + os.environ["PATH"],
                                                  SPARED=spared, STATE=state))
        expect("slurm, %s" % state, done.returncode == code, done.stderr)
        with open("submitted", encoding="ascii") as file:
            expect("slurm, %s: submitted" % state, len(file.readlines()) == submitted, done.stderr)
        if spared:
            expect("slurm, %s: said" % state, "share 2 of 3 (%s" % state in done.stderr
                   and "missing: sod, n = " in done.stderr, done.stderr)
            expect("slurm, %s: kept" % state, 0 < len(entries()) < 8, entries())
        else:
            with open("slurm.json", encoding="utf-8") as file:
                document = json.load(file)
            document.pop("date")
            expect("slurm: results", without_times(document) == without_times(alone))
    _, _, stderr = study(*QUICK, "--cache", "cache", "--shard", "1/2", "--only-build", "0123")
    expect("another build", "not 0123" in stderr, stderr)


def test_bench():
    """What an error costs, each n on a machine of its own: figures that are no times are the same."""
    words = ["bench", "sod", "--n", "40,60", "--samples", "1", "--time", "0.0001"]
    _, alone, _ = study(*words)
    for i in (1, 2):
        done = subprocess.run([program, *words, "--cache", "bench", "--shard", "%d/2" % i], capture_output=True, text=True)
        expect("a share of bench", "share %d of 2: 1 of 2 computations, 0" % i in done.stdout, done)
    _, whole, _ = study(*words, "--cache", "bench")
    _, again, _ = study(*words, "--cache", "bench")
    figures = [[[p[k] for k in ("scheme", "n", "error", "error_spread", "pair_interactions", "settings")]
                for p in document["points"]] for document in (alone, whole)]
    expect("bench in shares", figures[0] == figures[1] and len(figures[0]) == 8, figures)
    expect("bench in shares, times", whole == again)
    status, _, said = study("bench", "--skips", "--cache", "bench")
    expect("bench --skips in shares", status == 2 and "--cache" in said, said)


BITS = "import math\n"\
       "print([f(0.37 * k) for f in (math.sin, math.cos, math.log,\n"\
       "lambda x: math.exp(-x), lambda x: x ** (1 / 3), lambda x: x ** -0.4) for k in range(1, 400)])"


def test_mathematics():
    """Where sin, exp and pow have other last bits, nothing is found that was kept elsewhere."""
    for name in entries():
        os.remove(name)
    study(*QUICK, "--cache", "cache")
    usual = subprocess.run([sys.executable, "-c", BITS], capture_output=True).stdout
    kept = []
    for words in ("", "-AVX2,-FMA", "-AVX2_Usable,-FMA_Usable"):
        other = dict(os.environ, GLIBC_TUNABLES="glibc.cpu.hwcaps=" + words) if words else dict(os.environ)
        bits = subprocess.run([sys.executable, "-c", BITS], capture_output=True, env=other).stdout
        listed = subprocess.run([program, *QUICK, "--cache", "cache", "--list"], capture_output=True, text=True, env=other)
        found = listed.stdout.count("\tkept\t")
        kept.append(found)
        expect("found with other mathematics (%s)" % words, found == 8 if not words else bits == usual or not found, found)
    if kept == [8, 8, 8]:
        print("skipped: nothing changes the mathematics of this C library")


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        test_engine()
        test_mathematics()
        test_bench()
        os.chdir("/")
    print("\n".join(faults) or "a study is computed elsewhere")
    return bool(faults)


sys.exit(main())
