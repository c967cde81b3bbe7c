# SPDX-License-Identifier: GPL-3.0-or-later
"""snapshots.py SPHPROOF: snapshots during a run (`run --snapshot-every`). They do not affect the run: its results are
those of a run without them, to the last bit; and each is, to the last bit, that of a run that ends there. A snapshot
that cannot be written is reported and affects nothing else. (Intervals and refusals: test_snapshots, the
transcripts.)"""
import csv
import glob
import json
import os
import re
import resource

from script import call, expect, play, read

# arguments, end, interval in units of the end, numbers of the snapshots that are compared with runs that end there
RUNS = [(["sod", "n=200"], 0.2, 0.07, (0, 1, 7, 14)),
        (["sound_wave", "n=64", "viscosity=none"], 0.5, 0.002, (1, 2, 250, 499)),  # several within each step
        (["strong_shock", "n=100", "integrator=leapfrog", "skip=none"], 0.006, 0.11, (1, 8)),
        (["gresho", "n=16^2", "viscosity=cullen_dehnen"], 0.4, 0.3, (0, 2)),
        (["kelvin_helmholtz_mode", "n=16^2"], 0.9, 0.09, (2, 7, 11)),  # the run also stops to measure the growth of the mode
        (["noh_3d", "n=12^3", "integrator=vl2"], 0.05, 0.5, (0, 1))]


def run(words, *more, **options):
    return call("run", *words, *more, **options)


def get(path):
    with open(path, "rb") as file:
        return file.read()


def seen(path):
    """A document without times and memory."""
    document = json.loads(get(path))
    for name in ("wall_s", "cpu_s", "peak_rss_bytes"):
        document["cost"].pop(name)
    document["estimate"].pop("memory_bytes")
    document.pop("date")
    return document


def number(k):
    return "way_%04d.csv" % k


def test_bits():
    for words, t_end, part, which in RUNS:
        name, every = " ".join(words), repr(part * t_end)
        long = [*words, "t_end=%r" % t_end]
        for path in glob.glob("way*"):
            os.remove(path)
        one = run(long, "--snapshot", "plain.csv", "--json", "plain.json")
        other = run(long, "--snapshot", "way.csv", "--json", "way.json", "--snapshot-every", every)
        expect(name, one.returncode == other.returncode == 0, one.stderr + other.stderr)
        if one.returncode or other.returncode:
            continue
        expect("%s: particles at the end" % name, get("plain.csv") == get("way.csv"))
        expect("%s: results" % name, seen("plain.json") == seen("way.json"))
        count = -int(-1 // part)
        names = sorted(glob.glob("way_*"))
        expect("%s: files" % name, names == [number(k) for k in range(count)], names)
        for k in which:
            done = run([*words, "t_end=%r" % (k * part * t_end)], "--snapshot", "short.csv", "--quiet")
            expect("%s: number %d" % (name, k), done.returncode == 0 and get("short.csv") == get(number(k)),
                   done.stderr)
    expect("what is said", re.search(r"way_0000.csv to way_0001.csv, t = 0 to 0.025 in steps of 0.025; way.csv",
                                     other.stdout), other.stdout)


def rows(path):
    return [[float(value) for value in line] for line in list(csv.reader(read(path).splitlines()))[1:] if line[0][0] != "#"]


def test_late():
    """A resumed run with a snapshot within its next step, which was predicted for another time. The step is repeated;
    with the old prediction it would be off by 1.06e-3 here."""
    words = ["sod", "n=100", "--quiet"]
    first = run(words, "--checkpoint", "late.state", "--every", "0")
    again = run(words, "--checkpoint", "late.state", "--resume", "--snapshot", "late.csv", "--snapshot-every", "0.1985")
    alone = run(words, "t_end=0.1985", "--snapshot", "alone.csv")
    expect("late", first.returncode == again.returncode == alone.returncode == 0, again.stderr)
    missed = max(abs(a - b) for one, other in zip(rows("late_0001.csv"), rows("alone.csv")) for a, b in zip(one, other))
    expect("late: is near", 0 < missed < 6e-4, missed)
    expect("late: what is over", not os.path.exists("late_0000.csv"))


def test_trouble():
    """One file cannot be written: that is reported, and the others and all results are there."""
    os.makedirs("lost_0002.csv/full")
    done = run(["sod", "n=64"], "--snapshot", "lost.csv", "--snapshot-every", "0.05", "--json", "lost.json")
    expect("one is lost", done.returncode == 4 and "lost_0002.csv" in done.stderr, (done.returncode, done.stderr))
    expect("others", all(map(os.path.isfile, ("lost_0000.csv", "lost_0001.csv", "lost_0003.csv", "lost.csv", "lost.json"))))
    expect("nothing half", not [name for name in os.listdir(".") if "tmp" in name], os.listdir("."))
    full = run(["sod", "n=3000", "t_end=1e-4"], "--snapshot", "large.csv", "--snapshot-every", "5e-5", "--json", "large.json",
               preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (100000, 100000)))
    expect("no space", full.returncode == 4 and "large_0000.csv" in full.stderr and not glob.glob("large*csv") and
           os.path.exists("large.json"), (full.returncode, full.stderr, glob.glob("large*")))


play(test_bits, test_late, test_trouble)
