# SPDX-License-Identifier: GPL-3.0-or-later
"""studies.py SPHPROOF: `sphproof converge` with a cache on a processor with other mathematics; its progress on a terminal;
what is deleted from a cache by its age; where the program finds its files. (Damaged entries, kill -9 and two at once: test_cache, faults.py; cold and warm: exits.py.)"""
import glob
import json
import os
import pty
import shutil
import subprocess
import sys
import time

from script import call, expect, json_of, play, program, write

QUICK = ["converge", "sod", "--n", "40,60,80,120", "t_end=0.1", "--vary", "gradient",
         "--replicates", "1"]
# long enough for its progress to be shown: half a second a run and more
LONG = ["converge", "sod", "--n", "100,140,200,6400", "t_end=0.1", "kernel=wendland_c6", "eta=9", "skip=none",
        "integrator=rk3", "volume_element=energy", "--replicates", "1"]


def entries():
    return glob.glob("cache/*/*")


BITS = "import math\n"\
       "print([f(0.37 * k) for f in (math.sin, math.cos, math.log,\n"\
       "lambda x: math.exp(-x), lambda x: x ** (1 / 3), lambda x: x ** -0.4) for k in range(1, 400)])"


def test_mathematics():
    """Results are not taken from a cache of a machine where sin, exp and pow have other last bits."""
    usual = subprocess.run([sys.executable, "-c", BITS], capture_output=True).stdout
    kept = []
    said = call(*QUICK, "--cache", "cache").stderr
    expect("progress in a log", "\r" not in said and "\033" not in said, said)
    for words in ("", "-AVX2,-FMA", "-AVX2_Usable,-FMA_Usable"):
        other = dict(os.environ, GLIBC_TUNABLES="glibc.cpu.hwcaps=" + words) if words else dict(os.environ)
        bits = subprocess.run([sys.executable, "-c", BITS], capture_output=True, env=other).stdout
        listed = call(*QUICK, "--cache", "cache", "--list", env=other)
        found = listed.stdout.count("\tkept\t")
        kept.append(found)
        expect("found with other mathematics (%s)" % words, found == 8 if not words else bits == usual or not found, found)
    if kept == [8, 8, 8]:
        print("nothing changes the mathematics of this C library: not tried")


def test_progress():
    shown = ["--vary", "alpha=0.5,1,1.5"]
    lead, follow = pty.openpty()
    running = subprocess.Popen([program, *LONG, *shown], stderr=follow, stdout=subprocess.DEVNULL)
    os.close(follow)
    text = ""
    try:
        while part := os.read(lead, 1 << 12):
            text += part.decode()
    except OSError:  # the other side is closed
        pass
    os.close(lead)
    running.wait()
    expect("progress on a terminal", "\rsod, n = " in text and " of 12 (" in text and " s left" in text
           and "\n" not in text and text.endswith("\r\033[K"), repr(text[-300:]))
    quiet = call(*QUICK, "--quiet")
    expect("quiet", not quiet.stderr, quiet.stderr)


def test_colors():
    """On a terminal with colours, unless NO_COLOR is set; elsewhere on request."""
    for change, words, colored in (({}, (), True), ({"NO_COLOR": ""}, (), True), ({"NO_COLOR": "0"}, (), False),
                                   ({"TERM": "dumb"}, (), False), ({"TERM": None}, (), False),
                                   ({"NO_COLOR": "1"}, ("--color", "always"), True), ({}, ("--color", "never"), False)):
        usual = {name: value for name, value in os.environ.items() if name != "NO_COLOR"}
        how = {name: value for name, value in {**usual, "TERM": "xterm", **change}.items() if value is not None}
        lead, follow = pty.openpty()
        call("list", "fields", *words, status=0, env=how, capture_output=False, stdout=follow)
        text = os.read(lead, 1 << 12).decode()
        os.close(follow)
        os.close(lead)
        expect("colours, %s %s" % (change, words), ("\033[" in text) == colored, repr(text[:80]))
    for words, colored in (((), False), (("--color", "always"), True)):
        expect("colours in a pipe %s" % (words,), ("\033[" in call("list", "fields", *words).stdout) == colored)


def test_prune():
    """Days are days of 24 hours."""
    old = time.time() - 1.5 * 24 * 3600
    for name in entries():
        os.utime(name, (old, old))
    for days, left in (("2", 8), ("1.6", 8), ("1.4", 0)):
        found = json.loads(call("cache", "cache", "--prune", days, "--json", "-", status=0).stdout)
        expect("entries not used for %s days" % days, len(entries()) == left and found["removed"] == 8 - left, found)
        size = sum(map(os.path.getsize, entries()))
        expect("bytes after %s days" % days, found["bytes"] == size and call("cache", "cache", status=0).stdout
               == "%d results, %.3g MB; 0 removed\n" % (left, size / 1e6), (found, size))


def test_where():
    """Files beside the program are found before those that are installed elsewhere."""
    names = "cases", "sphproof-1.schema.json"
    os.makedirs("own/bin")
    shutil.copy(program, "own/bin/sphproof")
    elsewhere = None
    for beside in range(3):
        if beside == 1:
            os.makedirs("own/share/sphproof/cases")
        if beside == 2:
            write("own/share/sphproof/" + names[1], "{}")
        found = json.loads(subprocess.run(["own/bin/sphproof", "list", "--where", "--json", "-"], capture_output=True).stdout)
        elsewhere = elsewhere or found["installed"]
        paths = [os.path.abspath("own/share/sphproof/" + name) if k < beside
                 else elsewhere[name] and elsewhere[name].encode() for k, name in enumerate(names)]
        expect("places, %d beside the program" % beside, list(found["installed"]) == list(names) and not found["families"]
               and [p and os.path.realpath(p.encode()) for p in found["installed"].values()]
               == [p and os.path.realpath(os.fsencode(p)) for p in paths], found)
        said = subprocess.run(["own/bin/sphproof", "list", "--where"], capture_output=True, encoding="utf-8").stdout
        expect("places printed, %d beside the program" % beside, said == "".join(
            "%-24s %s\n" % (name, path or "not installed") for name, path in found["installed"].items()), said)
    for words in (["list", "keys", "--where"], ["list", "--markdown", "--where"]):
        expect("refused: %s" % words, call(*words, status=2).stdout == "")
    expect("no families: a document without places", "installed" not in json_of("list", "fields"))


play(test_mathematics, test_progress, test_colors, test_prune, test_where)
