# SPDX-License-Identifier: GPL-3.0-or-later
"""shares.py SPHPROOF: `verify --mutants` in shares: they are all checks, each once, even by cost; the plain call that
follows finds everything and says what one machine alone says, times aside."""
import json
import os
import re
import subprocess
import sys
import tempfile

from studying import expect, faults, program

CHECKS = ["verify", "riemann", "norms/window_parts", "gradients/ia_assumption", "conservation", "--mutants"]
SHARES = 3


def sphproof(*words):
    return subprocess.run([program, *words], capture_output=True, text=True, timeout=100)


def listed(*words):
    """Name -> seconds of each computation."""
    lines = [line.split("\t") for line in sphproof(*words, "--list").stdout.splitlines()]
    return {name: float(seconds) for seconds, _, _, name in lines}


def test_division():
    for words in (["verify", "--mutants"], ["verify", "--mutants", "--slow"], ["verify", "kernels"]):
        for of in (2, 3, 7):
            shares = [listed(*words, "--cache", "none", "--shard", "%d/%d" % (i + 1, of)) for i in range(of)]
            whole, loads = listed(*words), [sum(share.values()) for share in shares]
            together = [name for share in shares for name in share]
            expect("%s: all, once" % words, sorted(together) == sorted(whole) and len(whole) > 10, (len(together), len(whole)))
            # the last one that went to the heaviest share went where least was
            expect("%s: even" % words, max(loads) <= min(loads) + max(whole.values()) * 1.001, loads)
    names = sphproof("list", "checks").stdout.count("\n") - 1
    expect("all checks", len(listed("verify", "--slow")) == names, names)
    expect("no folder is made to list", not os.path.exists("none"))


def told(stem):
    """Document and JUnit file but for times."""
    with open(stem + ".json", encoding="utf-8") as file:
        document = json.load(file)
    document.pop("date")
    for check in document["checks"]:
        check.pop("seconds")
    with open(stem + ".xml", encoding="utf-8") as file:
        return document, re.sub(r' time="[^"]*"', "", file.read())


def test_shares():
    said = [sphproof(*CHECKS, "--cache", "cache", "--shard", "%d/%d" % (i + 1, SHARES), "--json", "share.json", "--junit",
                     "share.xml") for i in range(SHARES)]
    parts = [re.match(r"share \d of 3: (\d+) of (\d+) computations, 0 of them", one.stdout) for one in said]
    expect("shares", all(one.returncode == 0 for one in said) and all(parts), [one.stdout + one.stderr for one in said])
    total = len(listed(*CHECKS))
    expect("all of it", sum(int(part[1]) for part in parts if part) == total, total)
    expect("a share judges nothing", not os.path.exists("share.json") and not os.path.exists("share.xml"))
    kept = sphproof(*CHECKS, "--cache", "cache", "--list").stdout
    expect("kept", kept.count("\tkept\t") == total, kept)
    expect("without mutants it is something else", "\tkept\t" not in sphproof(*CHECKS[:-1], "--cache", "cache", "--list").stdout)
    whole = sphproof(*CHECKS, "--cache", "cache", "--json", "whole.json", "--junit", "whole.xml")
    alone = sphproof(*CHECKS, "--json", "alone.json", "--junit", "alone.xml")
    expect("the same", whole.returncode == alone.returncode == 0 and told("whole") == told("alone"), whole.stderr)
    expect("mutants", told("whole")[0]["summary"]["detected"] > 10, told("whole")[0]["summary"])
    pages = [re.sub(r" +[0-9.]+\n|; [0-9.]+ s\n", "\n", done.stdout) for done in (whole, alone)]
    expect("the same table", pages[0] == pages[1], pages[0])


def test_refused():
    for words, code, reason in ((["--first", "--jobs", "2"], 2, "--first"),
                                (["--kernel-plugin", "./k.so", "--shard", "1/2", "--cache", "cache"], 2, "--kernel-plugin"),
                                (["--shard", "1/2"], 2, "--cache DIR"), (["--shard", "3/2", "--cache", "c"], 2, "I/N"),
                                (["--jobs", "0"], 2, "--jobs"), (["--engine", "slurm"], 2, "--cache DIR")):
        done = sphproof("verify", "riemann", *words)
        expect(" ".join(words), done.returncode == code and reason in done.stderr and not done.stdout,
               (done.returncode, done.stderr))


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        test_division()
        test_shares()
        test_refused()
        os.chdir("/")
    print("\n".join(faults) or "shares of checks are all of them")
    return bool(faults)


sys.exit(main())
