# SPDX-License-Identifier: GPL-3.0-or-later
"""resume.py SPHPROOF FOLDER: a report that is killed, resumed, repeated on an unchanged night, and
repeated with a damaged entry: what is found, how long it takes, that results are the same; its
history."""
import glob
import json
import os
import shutil
import signal
import subprocess
import sys
import time

program, folder = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
faults = []


def expect(what, well, got=""):
    if not well:
        faults.append("%s: %s" % (what, got))


def report(*words):
    done = subprocess.run([program, "report", "--out", folder, "--jobs", "2", *words], capture_output=True,
                          text=True)
    expect("exit status of %s" % (words,), done.returncode == 0, done.stdout[:300] + done.stderr)
    with open(os.path.join(folder, "results.json"), encoding="utf-8") as file:
        return json.load(file)


def entries():
    return glob.glob(os.path.join(folder, "cache", "*", "*.entry"))


def fixed(value):
    """Everything that may not differ between two reports of one program."""
    if isinstance(value, dict):
        drop = ("cost", "cpu_s", "wall_s", "seconds", "date", "found", "history", "bench", "ns_per_point", "ns_per_pair")
        return {k: fixed(v) for k, v in value.items() if k not in drop}
    return [fixed(v) for v in value] if isinstance(value, list) else value


shutil.rmtree(folder, ignore_errors=True)
running = subprocess.Popen([program, "report", "--out", folder, "--jobs", "2", "--quiet"], start_new_session=True)
while running.poll() is None and len(entries()) < 5:
    time.sleep(0.05)
expect("nothing to kill", running.poll() is None)
os.killpg(running.pid, signal.SIGKILL)
running.wait()
for _ in range(200):  # its processes may still be about to end
    try:
        os.killpg(running.pid, 0)
    except ProcessLookupError:
        break
    time.sleep(0.05)
before = {name: os.stat(name).st_ino for name in entries()}
expect("a page of nothing", not os.path.exists(os.path.join(folder, "index.html")))

resumed = report("--resume")
expect("found after kill -9", resumed["found"] == len(before) >= 5, (resumed["found"], len(before)))
expect("computed twice", before.items() <= {name: os.stat(name).st_ino for name in entries()}.items())

unchanged = report()
expect("found on an unchanged night", unchanged["found"] == unchanged["computations"], unchanged["found"])
expect("an unchanged night, results", fixed(unchanged) == fixed(resumed))
since = unchanged["history"]["since"]
expect("an unchanged night, history", since["worse"] == since["better"] == 0 and since["same"] > 1000, since)

with open(entries()[0], "r+b") as file:
    file.seek(200)
    file.write(b"!")
os.truncate(entries()[1], 100)
mended = report()
expect("found beside damaged entries", mended["found"] == mended["computations"] - 2, mended["found"])
expect("mended, results", fixed(mended) == fixed(resumed))
with open(os.path.join(folder, "history.jsonl"), encoding="utf-8") as file:
    expect("nights", len([json.loads(line) for line in file]) == 3)

print("\n".join(faults) or "reports are resumed")
sys.exit(bool(faults))
