# SPDX-License-Identifier: GPL-3.0-or-later
"""memory.py SPHPROOF: compares the memory that `run --explain` estimates for a run with the memory that it uses, both
beyond those of a tiny run (systems count the memory of libraries differently); runs for which there is not enough
memory are refused before they begin, with the number."""
import json
import os
import resource
import subprocess

from script import call, expect, play, program

WITHIN = 0.2
TINY = ["gresho", "n=12^2", "t_end=0.0005"]
RUNS = [["gresho", "n=120^2", "t_end=0.0005"],
        ["sound_wave_3d", "n=32^3", "t_end=0.0001", "kernel=wendland_c4", "eta=3.6", "gradient=standard",
         "viscosity=constant"],
        ["sound_wave_3d", "n=34^3", "t_end=0.0001", "lattice=jittered"]]
CLOSELY = 0.05  # tolerance of the last run, whose estimate must hold for a million particles in a GiB

# meson makes malloc fill its blocks: then unused arrays would need memory
PLAIN = {name: value for name, value in os.environ.items() if name != "MALLOC_PERTURB_"}
AWAY = ["--snapshot", "end.csv", "--snapshot-every", "0.0003"]


def sphproof(*words, limit=None, status=0):
    def confine():
        if limit:
            resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
    return call(*words, "--threads", "1", status=status, env=PLAIN, preexec_fn=confine)


def estimated(words):
    said = json.loads(sphproof("run", *words, "--explain", "--json", "-").stdout)
    assert "status" not in said and said["estimate"]["cpu_s"] > 0
    return said["estimate"]


def taken(words, estimate):
    cost = json.loads(sphproof("run", *words, "--json", "-").stdout)["cost"]
    expect("steps of %s" % words, 0.3 * cost["steps"] - 1 <= estimate["steps"] <= 3 * cost["steps"] + 1, (estimate, cost))
    return cost["peak_rss_bytes"]


def main():
    bytes_of = [json.loads(sphproof("run", *RUNS[0], "--explain", "--json", "-", *more).stdout)["estimate"]["memory_bytes"]
                for more in ([], AWAY)]
    expect("snapshots on the way", bytes_of[1] - bytes_of[0] >= 300 * 120**2 and not os.path.exists("end_0000.csv"), bytes_of)
    tiny = estimated(TINY)
    # addresses differ from run to run, and with them the number of used pages: the least of up to three runs counts
    least = min(taken(TINY, tiny) for _ in range(3))
    for words in [*RUNS, RUNS[0] + AWAY]:
        estimate, took = estimated(words), float("inf")
        said = estimate["memory_bytes"] - tiny["memory_bytes"]
        within = CLOSELY if words == RUNS[2] else WITHIN
        for _ in range(3):
            took = min(took, taken(words, estimate) - least)
            if abs(said / took - 1) <= within:
                break
        expect("memory of %s" % words, abs(said / took - 1) <= within, (said, took))
        print("%s: %.1f MB said, %.1f taken" % (words[0], 1e-6 * said, 1e-6 * took))
    said = sphproof("run", *RUNS[0], "--explain").stdout
    expect("estimate as it is printed", " about %.0f MB of memory" % (1e-6 * bytes_of[0]) in said, said)
    said = sphproof("run", *TINY, "--json", "tiny.json").stdout
    with open("tiny.json", encoding="ascii") as file:
        took = json.load(file)["cost"]["peak_rss_bytes"]
    expect("memory as it is printed", " interactions, %.1f MB\n" % (1e-6 * took) in said, (took, said))
    for more in ([], ["--explain"], ["--json", "-"], AWAY):
        done = sphproof("run", "sound_wave_3d", "n=10000000", *more, limit=3 << 30, status=4)
        expect("what does not fit", not done.stdout and all(
            word in done.stderr for word in ("n=10000000", "GB of memory", "3.22 GB")), done)


def try_group():
    """The same in a control group, if one can be made."""
    group, file = "/sys/fs/cgroup/sphproof-test-%d" % os.getpid(), "memory.max"
    if os.path.exists("/sys/fs/cgroup/memory"):
        group, file = group.replace("cgroup/", "cgroup/memory/"), "memory.limit_in_bytes"
    try:
        os.mkdir(group)
    except OSError:
        return
    try:
        with open(os.path.join(group, file), "w", encoding="ascii") as limit:
            limit.write("1000001536")
        done = subprocess.run(["sh", "-c", 'echo $$ >%s/cgroup.procs; exec "$@"' % group, "sh", program, "run", "sound_wave_3d",
                               "n=10000000"], capture_output=True, text=True, timeout=100)
        expect("more than a control group has", done.returncode == 4 and "n=10000000" in done.stderr and
               "more than the 1 GB" in done.stderr, done)
    except OSError as reason:
        print("no control group can be tried: %s" % reason)
    finally:
        os.rmdir(group)


play(main, try_group)
