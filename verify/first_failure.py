#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""first_failure.py BUILD: what of the tests that ran last in BUILD fails first and most specifically:
how far over its bound, for which member, the command that shows it, the plot's path. Then the other
tests that failed. verify/run ends with these lines."""
import glob
import json
import os
import sys

OTHERS_SHOWN = 12


def results(build):
    logs = glob.glob(os.path.join(glob.escape(build), "meson-logs/testlog*.json"))  # under a wrapper its name is added
    with open(max(logs, key=os.path.getmtime), encoding="utf-8") as file:
        return [json.loads(line) for line in file if line.strip()]


def headlines(build, test):
    """The result that `sphproof verify GROUP` wrote, if it is from this run."""
    group = test["name"].split(" / ")[-1].removeprefix("verify ")
    path = os.path.join(build, "verify/test", group + ".json")
    try:
        if os.path.getmtime(path) < test["starttime"]:
            return []
        with open(path, encoding="utf-8") as file:
            return json.load(file).get("failures") or []
    except (OSError, ValueError):
        return []


def tell(build, program, first):
    print(first["headline"])
    far = "  %s: got %s, bound %s" % (first["check"], brief(first["value"]), brief(first["bound"]))
    if isinstance(first.get("ratio"), (int, float)):
        far += ", %.2g times over" % first["ratio"]
    print(far + (", at " + first["place"] if first["place"] else ""))
    print("  property: " + first["property"])
    if first.get("also"):
        print("  also failing of %s: %s" % (first["member"], ", ".join(first["also"])))
    print("  see it:   " + first["command"].replace("sphproof", program, 1))
    for what, ending in (("plot:    ", ".svg"), ("figures: ", ".json")):
        path = os.path.join(build, "failures", first.get("data", "") + ending)
        if first.get("data") and os.path.exists(path):
            print("  %s %s" % (what, path))


def brief(value):
    return "%.3g" % value if isinstance(value, (int, float)) else str(value)


def last_lines(test):
    text = (test.get("stderr") or "") + (test.get("stdout") or "")
    lines = [line for line in text.splitlines() if line.strip()]
    said = [line for line in lines if "[  ERROR" in line or "Error" in line or "error" in line]
    return (said or lines)[-5:]


def main(build):
    failed = [t for t in results(build) if t["result"] not in ("OK", "EXPECTEDFAIL", "SKIP")]
    found = [h for t in failed for h in headlines(build, t)]
    if not failed:
        return
    print("\nWhat fails first:")
    found.sort(key=lambda h: (h["rank"], -h["ratio"] if isinstance(h.get("ratio"), (int, float)) else -1e300))
    if found:
        tell(build, os.path.join(build, "sphproof"), found[0])
        for headline in found[1:4]:
            print("then: " + headline["headline"])
    else:
        speaker = next((t for t in failed if last_lines(t)), failed[0])
        name = speaker["name"].split(" / ")[-1]
        print("test '%s' (%s)" % (name, speaker["result"].lower()))
        for line in last_lines(speaker):
            print("  " + line)
        print("  see it:   meson test -C %s --no-rebuild --print-errorlogs '%s'" % (build, name))
    names = [t["name"].split(" / ")[-1] for t in failed]
    print("%d tests failed: %s%s" % (len(names), ", ".join(names[:OTHERS_SHOWN]),
                                     " ..." if len(names) > OTHERS_SHOWN else ""))


if __name__ == "__main__":
    main(sys.argv[1])
