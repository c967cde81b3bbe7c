# SPDX-License-Identifier: GPL-3.0-or-later
"""exits.py SPHPROOF [all]: the exit status of a study is the same alone, from an empty or a full cache, after its
shares in either order, after a missing share, and with an engine. A share itself exits with 0 whatever it finds,
unless its input is bad (2) or its results cannot be kept (4). With `all` for every command that has shares."""
import contextlib
import json
import os
import re
import sys

from script import call, expect, play, read, write

TUBE = """[case]
title = A tube
dimension = 1
reference = riemann
[initial]
kind = riemann
left = 1 0 1
right = 0.125 0 0.1
[run]
t_end = 0.05
[measure]
window = -0.5 0.5
"""
LADDER = ["--n", "40,44,50,60", "--replicates", "1"]
STUDIES = [
    (0, ["converge", "./tube.ini", *LADDER]),
    (1, ["converge", "sod", *LADDER, "t_end=0.05"]),
    (2, ["converge", "sod", *LADDER, "kernel=none"]),
    (3, ["converge", "sod", *LADDER, "cfl=50", "viscosity=none"]),
    (0, ["verify", "riemann/star_states", "norms/window_parts", "--mutants"]),
    (0, ["bench", "sod", "--n", "40,60", "--samples", "1", "--time", "1e-4"]),
    (3, ["bench", "sod", "--n", "60,100", "--samples", "1", "--time", "1e-4", "viscosity=none", "cfl=3", "integrator=symplectic_euler"]),
]
OTHERS = [
    (2, ["verify", "nonsense"]),
    (2, ["bench", "sod", "--n", "40,60", "kernel=none"]),
    (0, ["stress", "leblanc"]),
    (2, ["stress", "nonsense"]),
]
TIMED = {"date", "seconds", "found", "cost", "on_front", "cheapest", "figure_of_merit", "seed_plain_over_this"}
# first both tasks of the array run, then both have ended
FAKE = """#!/bin/sh
case ${0##*/} in
squeue) [ ! -e submitted ] || printf '7 1 COMPLETED None\\n7 2 COMPLETED None\\n' ;;
sbatch)
    for wrap; do :; done
    for task in 1 2; do (SLURM_ARRAY_TASK_ID=$task; eval "$wrap") >/dev/null 2>&1; done
    echo "$@" >submitted
    echo 7 ;;
esac
"""


def fixed(value):
    """A document without the members that differ from call to call."""
    if isinstance(value, dict):
        return {k: fixed(v) for k, v in value.items() if k not in TIMED and not k.endswith("_s")}
    return [fixed(v) for v in value] if isinstance(value, list) else value


def tried(*words):
    """Exit status, contents of the document (and of a JUnit file), which a share does not write, and error messages."""
    for name in ("out.json", "out.xml"):
        with contextlib.suppress(FileNotFoundError):
            os.remove(name)
    files = () if "--shard" in words else ("--json", "out.json", *(("--junit", "out.xml") if words[0] == "verify" else ()))
    done = call(*words, "--quiet", *files)
    document = None
    if os.path.exists("out.json"):
        document = fixed(json.loads(read("out.json")))
    if os.path.exists("out.xml"):
        document["junit"] = re.sub(r' time="[^"]*"', "", read("out.xml"))
    return done.returncode, document, done.stderr


def share(words, cache, number, code):
    status, document, said = tried(*words, "--cache", cache, "--shard", "%d/2" % number)
    expect("%s, share %d" % (words, number), status == (2 if code == 2 else 0) and document is None, (status, said))


def try_study(number, code, words):
    alone = tried(*words)
    what = "exit %d, %s" % (code, " ".join(words[:2]))
    expect(what, alone[0] == code and bool(alone[2]) == (code > 1), alone)
    for how, shares in (("cold", ()), ("warm", ()), ("joined", (2, 1)), ("one is missing", (2,))):
        cache = "%d-%s" % (number, "warm" if how == "cold" else how)
        for one in shares:
            share(words, cache, one, code)
        expect("%s: %s" % (what, how), tried(*words, "--cache", cache) == alone, how)
        if code == 2:
            expect("%s: a cache is made" % what, not os.path.exists(cache) or not os.listdir(cache), how)
    if os.path.exists("submitted"):
        os.remove("submitted")
    jobs = () if words[0] == "bench" else ("--jobs", "2")
    engine = tried(*words, "--cache", "%d-engine" % number, "--engine", "slurm", "--engine-tasks", "2", *jobs)
    expect("%s: an engine" % what, engine == alone, engine)
    expect("%s: an engine was asked" % what, os.path.exists("submitted") == (code != 2))
    if jobs and code != 2:
        asked = read("submitted")
        expect("%s: jobs of a task" % what, " --jobs 2 " in asked + " " and "--cpus-per-task=2 " in asked, asked)


def test_all_checks():
    """All checks are computed, each once."""
    listed, names = (call(*words).stdout.splitlines() for words in (("verify", "--slow", "--list"), ("list", "checks")))
    expect("all checks", len(set(listed)) == len(listed) == len(names) - 1, (len(listed), len(names)))


def test_environment():
    """If nothing can be kept, or there is no Slurm, every way ends with 4."""
    words = STUDIES[0][1]
    for more in ((), ("--shard", "1/2"), ("--engine", "slurm")):
        status, document, said = tried(*words, "--cache", "/dev/null/cache", *more)
        expect("no place for a cache %s" % (more,), status == 4 and document is None and "/dev/null" in said, said)
    os.rename("bin", "gone")
    status, document, said = tried(*words, "--cache", "none", "--engine", "slurm")
    expect("no Slurm", status == 4 and document is None and "no command squeue" in said, said)


def test_one_at_a_time():
    """Without --jobs one run begins after another has ended."""
    write("slow.ini", "[code]\nshell = yes\nsnapshot = none\n"
          "command = echo begins >>\"@HERE@/log\"; sleep 0.02; echo ends >>\"@HERE@/log\"\n[case sod]\nn = 40 50 60 70\n")
    for words in (["converge", "sod", "--code", "slow.ini", "--replicates", "1"], ["calibrate", "slow.ini", "--runs", "2"],
                  ["bench", "sod", "--code", "slow.ini", "--n", "40,60", "--samples", "1", "--time", "1e-4", "--cache", "slow"]):
        write("log", "")
        call(*words, "--quiet")
        log = read("log").split()
        expect("one at a time: %s" % words[0], log and log == ["begins", "ends"] * (len(log) // 2), log)


def try_studies():
    write("tube.ini", TUBE)
    os.makedirs("bin")
    for name in ("sbatch", "squeue", "scancel"):
        write("bin/" + name, FAKE)
        os.chmod("bin/" + name, 0o755)
    os.environ["PATH"] = os.path.abspath("bin")  # hides an installed Slurm
    for number, (code, words) in enumerate(STUDIES + (OTHERS if "all" in sys.argv else [])):
        try_study(number, code, words)


play(test_one_at_a_time, try_studies, test_all_checks, test_environment)
