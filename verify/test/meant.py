# SPDX-License-Identifier: GPL-3.0-or-later
"""meant.py SPHPROOF [full]: if a snapshot is judged as a wrong case, or without one, `sphproof judge` names the right
one, with figures, or reports that none is near; never a wrong one. full: every case as every other one of its
dimension."""
import json
import os
import re
import sys

from script import call, play, read, write

FULL = "full" in sys.argv
CASES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "cases")
SIZE = {1: "100", 2: "24^2", 3: "10^3"}
LARGER = {"sod_2d": "1400", "sod_3d": "9216", "rayleigh_taylor_mode": "1152"}
QUICK = (("gresho", "sod_2d"), ("gresho", "yee"), ("gresho", None), ("sod", "lax"), ("lax", "sod"), ("sound_wave", "sod"),
         ("square", "kelvin_helmholtz_mode"))  # the square's noise happens to have the mode's amplitude
# Snapshots that pass as another case: one gas at two times, and two modes of layers with the same measures. (A growing
# mode has an exact value only at its own time.)
PASS = {("sod", "sod_standard"), ("sod_standard", "sod"), ("kelvin_helmholtz_mode", "rayleigh_taylor_mode")}


def output(*words):
    done = call(*words)
    assert done.returncode in (0, 1, 2), (words, done)
    return done.returncode, done.stdout + done.stderr


def judged(path, case):
    status, text = output("judge", path, *(["--case", case] if case else []), "--quiet", "--json", "-")
    got = json.loads(text) if status < 2 else None
    return status, got["verdict"] if got else text.strip(), got and got["meant"]


def look(path, true, asked, fits):
    """fits: the snapshot is near the solution of its own case, so that this case must be named."""
    status, text, meant = judged(path, asked)
    reported = re.search(r"did you mean (\w+)\? \((.*)\)$", text)
    nearer = re.search(r"nearer, though far as well, is (\w+) \((.*)\)$", text)
    if status == 0:
        assert (true, asked) in PASS or asked == "kelvin_helmholtz", (true, asked, text)
        return 0
    if "another gas" in text and "far from" not in text:
        return 0
    assert (bool(reported) if fits else not reported), (true, asked, text)
    for found in filter(None, (reported, nearer)):
        assert found[1] == true, (true, asked, text)
        numbers = [float(x) for x in re.findall(r"(?:by|against) (\S+?)(?: |$)", found[2])]
        assert "its value is" in found[2] or numbers and sorted(numbers) == numbers, (true, asked, text)
    assert meant == (true if reported and status < 2 else None), (true, asked, meant)
    assert fits or nearer or status == 2 or "none of our other cases" in text, (true, asked, text)
    return 1


def main():
    cases = {}
    for name in sorted(os.listdir(CASES)):
        if name.endswith(".ini"):
            text = read(os.path.join(CASES, name))
            if re.search(r"^kind = (channel|hydrostatic|standing_wave|taylor_green)$", text, flags=re.M):
                continue  # a liquid, which is not run
            found = re.search(r"(?s)dimension = (\d).*t_end = (\S+)", text)
            cases[name[:-4]] = int(found[1]), float(found[2])
    pairs = [(a, b) for a in cases for b in cases if a != b and cases[a][0] == cases[b][0]] if FULL else QUICK
    reported, own = 0, {}
    for true, asked in pairs:
        path = true + ".csv"
        if true not in own:
            dim, end = cases[true]
            call("run", true, "n=" + LARGER.get(true, SIZE[dim]), "t_end=%r" % (0.3 * end), "--snapshot", path, "--quiet", status=0)
            write(path, re.sub("(?m)^# (case|keys).*\n", "", read(path)))
            own[true] = judged(path, true)[0] == 0
        reported += look(path, true, asked, own[true])
    assert reported >= 0.8 * len(pairs) and sum(own.values()) >= 0.7 * len(own), (reported, len(pairs), own)
    print("%d pairs of cases: %d distinguished" % (len(pairs), reported))


play(main)
