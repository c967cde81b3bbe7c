# SPDX-License-Identifier: GPL-3.0-or-later
"""studies.py SPHPROOF: `sphproof converge` with a cache, from outside: any number of jobs, a second time, damaged
entries, kill -9 in the middle, two at once, other mathematical functions; its progress in a log and on a terminal."""
import glob
import json
import os
import pty
import signal
import subprocess
import sys
import time

from script import call, expect, play, program

QUICK = ["converge", "sod", "--n", "40,60,80,120", "t_end=0.1", "--vary", "gradient",
         "--replicates", "1"]
# long enough to be killed in the middle: a run takes half a second and more
LONG = ["converge", "sod", "--n", "100,140,200,6400", "t_end=0.1", "kernel=wendland_c6", "eta=9", "skip=none",
        "integrator=rk3", "volume_element=energy", "--replicates", "1"]


def study(*words):
    """Exit status, document without its date, error output."""
    done = call(*words, "--json", "-")
    found = json.loads(done.stdout) if done.stdout else {}
    found.pop("date", None)
    return done.returncode, found, done.stderr


def without_times(found):
    for level in found.get("levels", ()):
        level.pop("cpu_s", None)
    return found


def entries():
    return glob.glob("cache/*/*")


def test_cache():
    _, alone, _ = study(*QUICK)
    _, first, _ = study(*QUICK, "--cache", "cache", "--jobs", "2")
    expect("entries", len(entries()) == 8, entries())
    before = {name: os.stat(name).st_mtime_ns for name in entries()}
    inodes = {name: os.stat(name).st_ino for name in entries()}
    _, second, _ = study(*QUICK, "--cache", "cache")
    expect("a second time, times and all", first == second)
    expect("written again", inodes == {name: os.stat(name).st_ino for name in entries()}, before)
    expect("jobs and cache", without_times(alone) == without_times(first))
    for damage in (lambda text: text[: len(text) // 2], lambda text: text[:-1], lambda text: b"",
                   lambda text: text.replace(b'"l1":', b'"l1": ', 1),
                   lambda text: text[:300] + bytes([text[300] ^ 1]) + text[301:]):
        name = entries()[3]
        with open(name, "rb") as file:
            text = file.read()
        with open(name, "wb") as file:
            file.write(damage(text))
        _, again, stderr = study(*QUICK, "--cache", "cache", "--jobs", "3")
        expect("a damaged entry", without_times(again) == without_times(alone), stderr)
        with open(name, "rb") as file:
            expect("a damaged entry, mended", len(file.read()) > 300)
    status, _, stderr = study(*QUICK, "--cache", "/dev/null/cache")
    expect("no place for a cache", status == 4 and "/dev/null" in stderr, stderr)


def test_kill():
    for name in entries():
        os.remove(name)
    running = subprocess.Popen([program, *LONG, "--cache", "cache", "--quiet", "--jobs", "2"], start_new_session=True)
    for _ in range(1000):
        if len([name for name in entries() if name.endswith(".entry")]) >= 3 or running.poll() is not None:
            break
        time.sleep(0.01)
    expect("nothing to kill", running.poll() is None)
    os.killpg(running.pid, signal.SIGKILL)
    running.wait()
    whole = [name for name in entries() if name.endswith(".entry")]
    expect("entries after kill -9", len(whole) == 3, entries())
    inodes = {name: os.stat(name).st_ino for name in whole}
    status, resumed, stderr = study(*LONG, "--cache", "cache")
    expect("resumed", status in (0, 1) and len(resumed["levels"]) == 4, stderr)
    expect("computed twice", inodes == {name: os.stat(name).st_ino for name in whole})
    _, alone, said = study(*LONG, "--jobs", "2")
    expect("resumed, other results", without_times(resumed) == without_times(alone))
    expect("progress in a log", "\r" not in said and "\033" not in said, said)


def test_two_at_once():
    for name in entries():
        os.remove(name)
    both = [subprocess.Popen([program, *QUICK, "--cache", "cache", "--jobs", "2", "--json", "%d.json" % i],
                             stdout=subprocess.DEVNULL) for i in range(2)]
    for one in both:
        one.wait()
    _, alone, _ = study(*QUICK)
    for i in range(2):
        with open("%d.json" % i, encoding="utf-8") as file:
            document = json.load(file)
        document.pop("date", None)
        expect("two at once", without_times(document) == without_times(dict(alone)))
    expect("two at once, entries", len(entries()) == 8 and all(n.endswith(".entry") for n in entries()),
           entries())


BITS = "import math\n"\
       "print([f(0.37 * k) for f in (math.sin, math.cos, math.log,\n"\
       "lambda x: math.exp(-x), lambda x: x ** (1 / 3), lambda x: x ** -0.4) for k in range(1, 400)])"


def test_mathematics():
    """Results are not taken from a cache of a machine where sin, exp and pow have other last bits."""
    usual = subprocess.run([sys.executable, "-c", BITS], capture_output=True).stdout
    kept = []
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


play(test_cache, test_kill, test_two_at_once, test_mathematics, test_progress, test_colors, test_prune)
