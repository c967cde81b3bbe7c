# SPDX-License-Identifier: GPL-3.0-or-later
"""report.py SPHPROOF FOLDER: tests the report as a whole, in FOLDER: killed and resumed; repeated on an unchanged night
without gnuplot; repeated with damaged entries after a better night, whose changes it reports with the same results.
Its history; its files; the page needs no other file; each plot can be drawn again; kept results are the computed
ones; and failures of all kinds."""
import base64
import glob
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
import zlib
import xml.etree.ElementTree as xml

program, folder = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
faults = []


def expect(what, well, got=""):
    if not well:
        faults.append("%s %s" % (what, got))


def report(*arguments, **environment):
    return subprocess.run([program, "report", *arguments], capture_output=True, text=True,
                          stdin=subprocess.DEVNULL, env={**os.environ, **environment})


def read(*path):
    with open(os.path.join(folder, *path), encoding="utf-8") as file:
        return file.read()


def unsealed(page):
    """The unfolded page, as its script inflates it."""
    return re.sub(r'(<div class="sealed") data-z="([^"]*)">',
                  lambda part: part[1] + ">" + zlib.decompress(base64.b64decode(part[2])).decode(), page)


def lasting(value):
    """Members that must be the same in a report and in one from its cache."""
    if isinstance(value, dict):
        drop = ("seconds", "date", "found", "history")
        return {k: lasting(v) for k, v in value.items() if k not in drop}
    return [lasting(v) for v in value] if isinstance(value, list) else value


def computed(value):
    """Members that must be the same in two reports of one program."""
    if isinstance(value, dict):
        drop = ("cost", "cpu_s", "wall_s", "seconds", "date", "found", "history", "bench", "ns_per_point", "ns_per_pair",
                "cpu_s_without_skip", "saves") + (("spread",) if "saves" in value else ())
        return {k: computed(v) for k, v in value.items() if k not in drop}
    return [computed(v) for v in value] if isinstance(value, list) else value


def entries():
    return sorted(glob.glob(os.path.join(folder, "cache", "*", "*.entry")))


def kill_one():
    """Kills a report after it has stored some results, and returns these with their inodes."""
    running = subprocess.Popen([program, "report", "--out", folder, "--jobs", "2", "--quiet"], start_new_session=True)
    while running.poll() is None and len(entries()) < 5:
        time.sleep(0.05)
    expect("nothing to kill:", running.poll() is None)
    os.killpg(running.pid, signal.SIGKILL)
    running.wait()
    for _ in range(200):  # its processes may take a moment to end
        try:
            os.killpg(running.pid, 0)
        except ProcessLookupError:
            break
        time.sleep(0.05)
    expect("a page of nothing:", not os.path.exists(os.path.join(folder, "index.html")))
    return {name: os.stat(name).st_ino for name in entries()}


shutil.rmtree(folder, ignore_errors=True)
folder = os.path.join(folder, "a b", "é")
kept = kill_one()
done = report("--quick", "--out", folder, "--jobs", "2", "--resume")
expect("exit status of a sound report:", done.returncode == 0, done.stdout[:500] + done.stderr)
expect("where the report is:", os.path.join(folder, "index.html") in done.stdout, done.stdout)
page, results = read("index.html"), json.loads(read("results.json"))
expect("found after kill -9:", results["found"] == len(kept) >= 5, (results["found"], len(kept)))
expect("computed twice:", kept.items() <= {name: os.stat(name).st_ino for name in entries()}.items())
expect("verdict:", "<h1>%s</h1>" % results["verdict"]["headline"] in page and results["verdict"]["status"] == "pass")
counts = {"smoke": 0, "undetermined": 0, "known": 0, "pass": 0}
for entry in [o for s in results["studies"] for o in s["orders"] + [b["still_gas"] for b in s.get("budgets", []) if b.get("still_gas")]] \
        + [g for r in results["runs"] for g in r.get("gates", [])]:
    counts[entry["status"]] = counts.get(entry["status"], 0) + 1
for word, name in (("smoke", "smoke"), ("undetermined", "undetermined"), ("known", "known"), ("pass", "passed")):
    expect("gates counted as %s:" % word, results["verdict"]["gates_" + name] == counts[word],
           (results["verdict"], counts))
expect("the headline's counts:", results["verdict"]["gates"] in results["verdict"]["headline"]
       and results["verdict"]["gates"] in read("summary.md"), results["verdict"]["headline"])
itself = os.path.join(folder, "results.json")
done = subprocess.run([program, "diff", itself, itself], capture_output=True, text=True)
expect("a figure that nobody can compare:", done.returncode == 0 and "\nwell: " in done.stdout, done)
closed, page = page, unsealed(page)
for text in closed, page:
    expect("asks the network:", not re.search(r"(src|href)=\"(https?:)?//|url\(|@import|<script |<link|<iframe|fetch\(|XMLHttpRequest|import\(|WebSocket", text))
    xml.fromstring(text.replace("<!DOCTYPE html>", ""))
if closed != page:
    expect("size of the page:", len(closed.encode()) < 3e6, len(closed.encode()))
cases = {d["case"] for d in results["runs"] + results["studies"]}
expect("pictures on the closed page:", closed.count('<svg class="mini"') == len(cases), (closed.count("<svg "), len(cases)))
xml.fromstring(read("junit.xml"))
expect("summary:", results["verdict"]["headline"] in read("summary.md"))
plots = [name[:-3] for name in os.listdir(os.path.join(folder, "plots")) if name.endswith(".gp")]
expect("plots:", len(plots) == page.count('<svg class="plot"') > 10, (len(plots), page.count('<svg class="plot"')))
for name in plots:
    expect("links of a plot:", 'href="plots/%s.dat"' % name in page, name)
subprocess.run(["gnuplot", plots[0] + ".gp"], cwd=os.path.join(folder, "plots"), check=True)
expect("a plot drawn again:", "<svg" in read("plots", plots[0] + ".svg"))

for run in results["runs"]:
    through, end = run["through_time"], run["regularity"]
    seen = through["regularity"]
    expect("times at which regularity is seen:", seen["time"][0] == 0 and seen["time"][-1] == run["time"]
           and 3 <= len(seen["time"]) <= 18, (run["case"], seen["time"]))
    for figure, value in end.items():
        expect("the end of %s:" % figure, value == seen[figure][-1] or abs(value - seen[figure][-1]) <= 1e-9 * abs(value),
               (run["case"], value, seen[figure]))
    turning = run["conservation"]["angular_momentum"]
    expect("angular momentum through time:", turning is None if through["angular_momentum"] is None
           else turning == through["angular_momentum"][-1], run["case"])

commands = [d["reproduce"] for d in results["runs"] + results["studies"] + results["kernels"]]
expect("commands of the page:", len(commands) > 50, len(commands))
for command in commands:
    expect("a command of the page:", command in page, command)
again = subprocess.run([program] + commands[1].split()[1:] + ["--json", "-"], capture_output=True,
                       text=True)
expect("a run seen again:",
       json.loads(again.stdout)["errors"] == results["runs"][1]["errors"], again.stderr)

done = report("--quick", "--out", folder, "--jobs", "1", PATH="/nowhere")
unchanged = json.loads(read("results.json"))
expect("exit status without gnuplot:", done.returncode == 4 and "gnuplot" in done.stderr, done)
expect("page without gnuplot:", '<svg class="plot"' not in unsealed(read("index.html"))
       and results["verdict"]["headline"] in read("index.html"))
expect("found on an unchanged night:", unchanged["found"] == unchanged["computations"], unchanged["found"])
expect("what was kept is not what was computed:", lasting(unchanged) == lasting(results))
since = unchanged["history"]["since"]
expect("an unchanged night, history:", since["worse"] == since["better"] == 0 and since["same"] > 1000, since)

for arguments, status in ((["--jobs", "0"], 2), (["--quick", "--nightly"], 2), (["sod"], 2),
                          (["--out", os.path.join(folder, "index.html")], 4)):
    done = report(*arguments)
    expect("exit status of %s:" % arguments, done.returncode == status and done.stderr
           and not done.stdout, done)

# a run that survived the night before and breaks down now fails the report, its page, its JUnit file and its exit
# status; damaged entries are computed again
night = json.loads(read("history.jsonl").splitlines()[-1])
lost = next(path for path, value in night["figures"].items() if path.startswith("stress") and value == "broke_down")
night["figures"][lost] = "ok"
with open(os.path.join(folder, "nights.jsonl"), "w", encoding="utf-8") as file:
    file.write(read("history.jsonl") + json.dumps(night) + "\n")
with open(entries()[0], "r+b") as file:
    file.seek(200)
    file.write(b"!")
os.truncate(entries()[1], 100)
done = report("--quick", "--out", folder, "--jobs", "2", "--history", os.path.join(folder, "nights.jsonl"))
mended = json.loads(read("results.json"))
expect("found beside damaged entries:", mended["found"] == mended["computations"] - 2, mended["found"])
expect("mended, results:", {**computed(mended), "verdict": 0} == {**computed(results), "verdict": 0})
expect("nights:", len([json.loads(line) for line in read("nights.jsonl").splitlines()]) == 4)
verdict = mended["verdict"]
expect("lost since the night before:", done.returncode == 1 and verdict["status"] == "fail"
       and [failure["name"] for failure in verdict["failures"]] == [lost], (done.returncode, verdict, done.stderr))
failing = [case.get("name") for case in xml.fromstring(read("junit.xml")).iter("testcase") if case.find("failure") is not None]
expect("lost, in the JUnit file:", failing == [lost], failing)
expect("lost, on the page:", "<h1>%s</h1>" % verdict["headline"] in read("index.html") and lost in verdict["headline"])

print("\n".join(faults) or "the report is sound")
sys.exit(bool(faults))
