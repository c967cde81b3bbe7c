# SPDX-License-Identifier: GPL-3.0-or-later
"""slurm.py SPHPROOF DATA [--night FOLDER]: `--engine slurm` on a cluster of two nodes on this host. The results must
be those of this machine alone; finished computations must not be computed again, nor be lost by a power failure of a
node, by kill -9 of the submitting process or of a worker. Tasks that are requeued, preempted, out of time or killed
are done again, or the message names them. With --night a whole quick report in FOLDER, and a task beyond its --time;
then the test is skipped if Slurm is not installed."""
import contextlib
import functools
import glob
import json
import os
import pty
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import traceback

import cluster

program, data = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
night = os.path.abspath(sys.argv[4]) if len(sys.argv) > 3 else None
SLURM = ["--engine", "slurm"]
QUICK = ["converge", "sod", "--n", "40,60,80,120", "t_end=0.1", "--replicates", "2"]
# one computation of some seconds, and a few short ones
LONG = ["converge", "sod", "--n", "100,140,200,20000", "t_end=0.1", "kernel=wendland_c6", "eta=9", "skip=none",
        "integrator=rk3", "volume_element=energy", "--replicates", "1"]
HELD = [*LONG[:3], "100,140,200,8000", *LONG[4:]]
TIMES = ("cost", "cpu_s", "wall_s", "seconds", "date", "found", "history", "bench", "ns_per_point", "ns_per_pair")
faults = []
held = set()  # tasks that were stopped


def expect(what, well, got=""):
    if not well:
        faults.append("%s: %s" % (what, got))


def fixed(value):
    """Members that must be the same as on one machine alone."""
    if isinstance(value, dict):
        return {k: fixed(v) for k, v in value.items() if k not in TIMES}
    return [fixed(v) for v in value] if isinstance(value, list) else value


def load(path):
    with open(path, encoding="utf-8") as file:
        return fixed(json.load(file))


def alone(words):
    subprocess.run([program, *words, "--json", "alone.json", "--quiet"], check=False)
    return load("alone.json")


def start(words, cache, *more, **options):
    return subprocess.Popen([program, *words, "--cache", cache, *SLURM, *more], text=True, stdout=subprocess.DEVNULL,
                            stderr=subprocess.PIPE, **options)


def entries(cache):
    return {name: os.stat(name).st_ino for name in glob.glob(os.path.join(cache, "*", "*.entry"))}


def queue():
    """State of each task that has not ended: "1_2" -> RUNNING."""
    said = subprocess.run(["squeue", "-h", "-r", "-o", "%i %T"], capture_output=True, text=True).stdout
    return {task: state for task, state in map(str.split, said.splitlines()) if state != "COMPLETING"}


def test_same(nodes):
    """A study on two nodes; and again with all results in the cache, when Slurm is not asked."""
    running = start(QUICK, "same", "--engine-tasks", "2", "--json", "same.json")
    said = running.communicate()[1]
    expect("exit", running.returncode in (0, 1), said)
    expect("two nodes", load("same.json") == alone(QUICK), said)
    expect("what is left behind", not glob.glob("same/slurm/*"), glob.glob("same/slurm/*"))
    path = dict(os.environ, PATH="/nowhere")
    again = subprocess.run([program, *QUICK, "--cache", "same", *SLURM, "--json", "again.json", "--quiet"], env=path)
    expect("all is there: no Slurm is needed", again.returncode in (0, 1) and load("again.json") == load("same.json"))
    expect("nobody is left", not nodes.tasks(), nodes.tasks())


def test_code():
    """Another code with a template and a program beside its file, which is named relative to this folder."""
    os.mkdir("mine")
    for name, text in (("mine/code.sh", "#!/bin/sh\nexec %s run $(cat keys) --quiet --snapshot $1_1.csv\n" % program),
                       ("mine/keys.in", "@CASE@ n=@N@ t_end=@T_END@\n"),
                       ("mine/code.ini", "[code]\nparameters = keys.in\ncommand = ./code.sh @OUT@\nsnapshot = @OUT@_*.csv\n"
                        "[case sod]\n")):
        with open(name, "w", encoding="ascii") as file:
            file.write(text)
    os.chmod("mine/code.sh", 0o700)
    words = [*QUICK[:5], "--replicates", "1", "--code", "mine/code.ini"]
    running = start(words, "coded", "--engine-tasks", "2", "--json", "coded.json")
    said = running.communicate()[1]
    expect("another code", running.returncode in (0, 1) and load("coded.json") == alone(words), (running.returncode, said))
    expect("another code: by tasks alone", "submitted again" not in said and load("coded.json")["code"]["title"] == "code", said)


def kill(nodes):
    for pid in nodes.tasks():
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, signal.SIGKILL)


def hold(nodes):
    """Waits for a new task at its first computation, the long one, and stops it there. Returns its name and its
    processes."""
    def new():
        return [task for task, state in queue().items() if state == "RUNNING" and "_" in task and task not in held]

    nodes.wait(lambda: new() and len(nodes.tasks()) >= 2, "task and its worker", 200)
    stopped = list(nodes.tasks())
    for pid in stopped:
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, signal.SIGSTOP)
    held.add(new()[0])
    return max(held, key=lambda task: int(task.split("_")[0])), stopped


def end_held(nodes, end):
    """Holds the next task and ends it with end(its name), which is repeated if Slurm, on a busy host, loses it."""
    task, stopped = hold(nodes)
    for patience in (30, 30, 60):
        end(task)
        with contextlib.suppress(RuntimeError):
            return nodes.wait(lambda: not set(stopped) & set(nodes.tasks()), "end of a held task", patience)
    expect("a held task ends", False, (task, queue(), nodes.states()))


@functools.cache
def held_alone():
    return alone(HELD)


def scontrol(*words):
    done = subprocess.run(["scontrol", *words], capture_output=True, text=True)
    expect("scontrol %s" % " ".join(words), done.returncode == 0, done.stderr)


def test_again(nodes):
    """Tasks that Slurm itself ends early: it starts them again, or else they are submitted again."""
    urgent = ["sbatch", "--partition=urgent", "--nodes=2", "--output=/dev/null", "--wrap", "sleep 1"]
    for what, end, more, said in (
            ("requeued", lambda job: scontrol("requeue", job), (), None),
            ("preempted, requeued", lambda job: subprocess.run(urgent, stdout=subprocess.DEVNULL), (), None),
            ("preempted, ended", lambda job: subprocess.run(urgent, stdout=subprocess.DEVNULL), ("--no-requeue",),
             "(PREEMPTED)"),
            ("out of time", lambda job: scontrol("update", "jobid=" + job, "EndTime=now"), ("--time=10",), "(TIMEOUT)")):
        cache = re.sub(r"\W+", "-", what)
        options = ("--engine-options", *more) if more else ()
        running = start(HELD, cache, "--engine-tasks", "1", "--json", "again.json", *options)
        end_held(nodes, end)
        heard = running.communicate()[1]
        expect(what, running.returncode in (0, 1), heard)
        expect("%s: results" % what, load("again.json") == held_alone(), heard)
        expect("%s: submitted" % what, heard.count("submitted again") == (said is not None), heard)
        expect("%s: said" % what, said is None or "share 1 ended %s" % said in heard, heard)
        expect("%s: nobody is left" % what, not nodes.tasks(), nodes.tasks())


def test_given_up(nodes, end, state, *more):
    """A task that never completes is submitted three times in all; then the message names what is missing, and the
    log; finished computations are kept."""
    subprocess.run([program, *HELD, "--cache", "given-up", "--shard", "2/2"], stdout=subprocess.DEVNULL)
    kept = entries("given-up")
    expect("given up: something to lose", len(kept) == 3, kept)
    running = start(HELD, "given-up", "--engine-tasks", "1", *more)
    for _ in range(3):
        end_held(nodes, end)
    heard = running.communicate()[1]
    expect("given up", running.returncode == 4 and "submitted again (2 of 2)" in heard, (running.returncode, heard))
    found = re.search(r"share 1 of 1 \(%s, submitted 3 times\), log (\S+):" % state, heard)
    expect("given up: log", found and os.path.exists(found[1]), heard)
    expect("given up: what", "missing: sod, n = 8000 (share 1)" in heard, heard)
    expect("given up: kept", entries("given-up") == kept, entries("given-up"))
    again = start(HELD, "given-up", "--engine-tasks", "1", "--json", "given-up.json")
    heard = again.communicate()[1]
    expect("given up: computed twice", kept.items() <= entries("given-up").items())
    expect("given up, called again", again.returncode in (0, 1) and load("given-up.json") == held_alone(), heard)


def test_interrupt(nodes):
    """Ctrl-C asks once; with y its own tasks are cancelled. Without a terminal they continue."""
    others = queue().keys()
    for answer, left in ((b"n", True), (b"y", False)):  # each with a cache of its own, so that everything is computed
        cache = "interrupted-" + answer.decode()
        lead, follow = pty.openpty()
        running = subprocess.Popen([program, *LONG, "--cache", cache, *SLURM, "--engine-tasks", "1"],
                                   stdin=follow, stderr=follow, stdout=subprocess.DEVNULL, start_new_session=True)
        os.close(follow)
        text = b""
        with contextlib.suppress(OSError):  # it has ended
            while b"slurm: " not in text:
                text += os.read(lead, 1000)
            running.send_signal(signal.SIGINT)
            while b"[y/N]" not in text:
                text += os.read(lead, 1000)
        with contextlib.suppress(OSError):
            os.write(lead, answer + b"\n")
        expect("interrupted", running.wait(20) == 4, (running.returncode, text))
        expect("interrupted, %s" % answer, bool(queue().keys() - others) == left, (queue(), others))
        nodes.wait(lambda: not queue().keys() - others, "end of what goes on", 60)
        os.close(lead)
    expect("interrupted, state", not glob.glob("interrupted-y/slurm/*.json"))


def test_power(nodes):
    """kill -9 of the submitting process, then a power failure of a node: a second call attaches, and Slurm starts the
    task on the other node."""
    first = start(LONG, "power", "--engine-tasks", "2", start_new_session=True)
    nodes.wait(lambda: nodes.tasks("n0") and len(entries("power")) >= 3 and len(queue()) == 1, "task on n0")
    os.killpg(first.pid, signal.SIGKILL)
    first.wait()
    before = queue()
    state = glob.glob("power/slurm/*.json")
    expect("state", len(state) == 1, state)
    nodes.crash("n0")
    kept = entries("power")
    expect("something to lose", len(kept) == 3 and len(before) == 1, (kept, before))
    second = start(LONG, "power", "--json", "power.json")
    yield  # Slurm notices it after some seconds
    expect("attached", queue().keys() <= before.keys(), (queue(), before))
    said = second.communicate()[1]
    expect("a node without power", second.returncode in (0, 1), said)
    expect("a node without power: results", load("power.json") == alone(LONG), said)
    expect("a node without power: computed twice", kept.items() <= entries("power").items())
    expect("a node without power: as one machine", len(entries("power")) == 4, entries("power"))


def test_report(nodes):
    """A quick report, during which a node fails, is that of this machine alone."""
    shutil.rmtree(night, ignore_errors=True)
    words = [program, "report", "--quick", "--quiet", "--history", os.devnull, "--out"]
    running = subprocess.Popen([*words, night + "/slurm", *SLURM, "--engine-tasks", "8"])
    nodes.wait(lambda: len(entries(night + "/slurm/cache")) > 40 and nodes.tasks("n0"), "half of a report", 600)
    kept = entries(night + "/slurm/cache")
    nodes.crash("n0")
    time.sleep(30)
    nodes.start("n0")
    expect("a report", running.wait(1800) == 0, running.returncode)
    expect("a report: computed twice", kept.items() <= entries(night + "/slurm/cache").items())
    subprocess.run([*words, night + "/alone"], check=False)
    one, other = load(night + "/slurm/results.json"), load(night + "/alone/results.json")
    expect("a report from two nodes", one == other, [key for key in one if one[key] != other.get(key)])


def too_slow(nodes, frame):
    """Says where the test waited and what Slurm did last."""
    where = "".join(traceback.format_stack(frame)[-3:])
    with open(os.path.join(nodes.folder, "ctld.log"), encoding="utf-8", errors="replace") as file:
        last = "".join(file.readlines()[-30:])
    sys.exit("too slow: %s\n%s\n%s %s\n%s" % (faults, where, queue(), nodes.states(), last))


def main():
    if cluster.missing():
        print("skipped: not here: %s (Debian: slurm-wlm, munge)" % " ".join(cluster.missing()))
        return 1 if night else 77
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # so that daemons are ended
    signal.alarm(3600 if night else 700)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        nodes = cluster.Cluster(folder, data)
        signal.signal(signal.SIGALRM, lambda _, frame: too_slow(nodes, frame))
        try:
            nodes.begin()
            if night:
                test_given_up(nodes, lambda task: None, "TIMEOUT", "--engine-options", "--time=1")
                test_report(nodes)
            else:
                test_same(nodes)
                test_code()
                power = test_power(nodes)
                next(power)
                test_interrupt(nodes)
                next(power, None)
                nodes.start("n0")  # which had a power failure
                nodes.wait(lambda: nodes.states() == ["idle", "idle"], "two idle nodes", 60)
                test_again(nodes)
                test_given_up(nodes, lambda task: kill(nodes), "FAILED")
        finally:
            nodes.end()
            os.chdir("/")
    print("\n".join(faults) or "a cluster computes what one machine does")
    return bool(faults)


sys.exit(main())
