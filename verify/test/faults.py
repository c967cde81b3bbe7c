# SPDX-License-Identifier: GPL-3.0-or-later
"""faults.py SPHPROOF [PART ...] [--kills N] [--json FILE]: how the program ends when its
environment fails.

Tests for each fault the exit status, words of the message, and that nothing is lost: existing files
are unchanged, new files are complete, no temporary file is left. Prints a table, and writes it as a
result document. PART: only these (default: all); N (default 0): so many reports are killed at
random moments as well, which takes some minutes."""
import argparse
import contextlib
import json
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as xml

sys.dont_write_bytecode = True  # the source tree may be read-only, and stays clean
import kills
import schema

root = os.geteuid() == 0
here = os.path.dirname(os.path.abspath(__file__))
program = anyones = folder = part = None  # anyones: a copy of the program where every user gets to
rows = []
OLD = "what was there before\n"
RUN = ["run", "sod", "n=200", "t_end=0.02"]
STUDY_KILLS = 16


def sphproof(*arguments, limits=(), nobody=False, **options):
    """Runs the program; limits: pairs of a resource and its value."""
    def prepare():
        for what, value in limits:
            resource.setrlimit(what, (value, value))
        if nobody:
            os.setgroups([])
            os.setgid(65534)
            os.setuid(65534)
    options = {"capture_output": True, "text": True, "errors": "replace", "cwd": folder,
               "stdin": subprocess.DEVNULL, "timeout": 120, **options}
    try:
        return subprocess.run([anyones if nobody else program, *arguments], preexec_fn=prepare, **options)
    except subprocess.TimeoutExpired as late:
        return subprocess.CompletedProcess(late.cmd, -9, "", "no end in %g s" % late.timeout)


def shell(line):
    """Runs a line in bash; $SPHPROOF is the program."""
    return subprocess.run(["bash", "-c", "set -o pipefail; " + line], capture_output=True, text=True,
                          cwd=folder, stdin=subprocess.DEVNULL, timeout=300, errors="replace",
                          env={**os.environ, "SPHPROOF": program})


def add(fault, expected, ended, status, message, detail=""):
    rows.append({"fault": fault, "part": part, "expected": expected, "exit": ended, "status": status,
                 "detail": detail.replace(folder + "/", ""), "message": message.replace(folder + "/", ""),
                 "command": "python3 verify/test/faults.py build/sphproof " + part})


def not_tried(fault, why):
    add(fault, [], None, "skip", why)


def row(fault, done, status, *words, also=(), says=""):
    """Prints one line of the table; also: pairs of a condition and its meaning."""
    allowed = status if isinstance(status, tuple) else (status,)
    wrong = []
    if done.returncode not in allowed:
        wrong.append("exit %d, not %s" % (done.returncode, "/".join(map(str, allowed))))
    wrong += ["no %r in the message" % word for word in words if word not in (done.stderr or "")]
    wrong += [str(text) for well, text in also if not well]
    left = parts(folder)
    if left:
        wrong.append("left behind: %s" % left)
        sweep(left)
    message = says or (done.stderr or "").strip().split("\n")[-1]
    add(fault, list(allowed), done.returncode, "fail" if wrong else "pass", message, "; ".join(wrong))


def parts(place):
    """Temporary files."""
    return [os.path.join(path, name) for path, _, files in os.walk(place) for name in files if ".part" in name]


def sweep(files):
    for name in files:
        os.unlink(name)


def put(name, text=OLD):
    with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
        file.write(text)
    return os.path.join(folder, name)


def get(name, mode="r"):
    try:
        with open(os.path.join(folder, name), mode) as file:
            return file.read()
    except FileNotFoundError:
        return None


def same(name, text=OLD):
    return (get(name) == text, "%s is not as it was" % name)


def absent(name):
    return (not os.path.exists(os.path.join(folder, name)), "%s is there" % name)


def tool(name, script):
    """A folder for PATH with this script in place of the tool."""
    place = os.path.join(folder, "tools " + name + str(len(os.listdir(folder))))
    os.mkdir(place)
    path = os.path.join(place, name)
    with open(path, "w", encoding="utf-8") as file:
        file.write("#!/bin/sh\n" + script + "\n")
    os.chmod(path, 0o755)
    return {**os.environ, "PATH": place + os.pathsep + os.environ["PATH"]}


@contextlib.contextmanager
def small_disk(fault, kibi):
    """A folder on a separate small disk, or None if none can be made."""
    place = "small disk"
    os.makedirs(os.path.join(folder, place), exist_ok=True)
    mount = ["mount", "-t", "tmpfs", "-o", "size=%dk" % kibi, "tmpfs", os.path.join(folder, place)]
    if not root or subprocess.run(mount, capture_output=True).returncode:
        not_tried(fault, "no disk can be mounted here")
        yield None
        return
    try:
        yield place
    finally:
        subprocess.run(["umount", os.path.join(folder, place)], check=True)


def disk():
    for option, name in (("--json", "r.json"), ("--snapshot", "s.csv"), ("--plot", "p.svg")):
        put(name)
        done = sphproof(*RUN, option, name, limits=[(resource.RLIMIT_FSIZE, 1024)])
        row("no file above 1 KiB, %s" % option, done, 4, name, "File too large", also=[same(name)])
        os.unlink(os.path.join(folder, name))
    row("full device, table", shell("$SPHPROOF run sod n=50 > /dev/full"), 4, "standard output",
        "No space left")
    row("full device, --json -", shell("$SPHPROOF run sod n=50 --json - > /dev/full"), 4,
        "No space left")
    row("full device, --json", sphproof(*RUN, "--json", "/dev/full"), 4, "/dev/full",
        "No space left")
    with small_disk("full disk, --snapshot", 64) as place:
        if place:
            put(place + "/s.csv")
            done = sphproof(*RUN, "n=2000", "--snapshot", place + "/s.csv")
            row("full disk, --snapshot", done, 4, "s.csv", "No space left",
                also=[same(place + "/s.csv")])


def permissions():
    shut = os.path.join(folder, "shut")
    os.mkdir(shut)
    put("shut/r.json")
    os.chmod(os.path.join(shut, "r.json"), 0o444)
    os.chmod(shut, 0o555)
    os.chmod(folder, 0o755)
    for what in ("shut/r.json", "shut/new.json"):
        done = sphproof(*RUN, "--json", what, nobody=root)
        row("read-only %s" % what, done, 4, what, "Permission denied", also=[same("shut/r.json"),
                                                                             absent("shut/new.json")])
    row("read-only folder, report", sphproof("report", "--out", "shut/report", nobody=root), 4,
        "shut/report", "Permission denied")
    os.chmod(shut, 0o755)


def drawing():
    for what, script, word in (("fails", "echo out of ink >&2; exit 1", "out of ink"),
                               ("is killed", "kill -9 $$", "signal 9"),
                               ("draws nothing", "cat >/dev/null", "gnuplot"),
                               ("draws nonsense", "cat >/dev/null; echo no picture", "gnuplot"),
                               ("does not read", "exec <&-; sleep 1; exit 1", "gnuplot")):
        put("p.svg")
        done = sphproof(*RUN, "--plot", "p.svg", "--json", "r.json", env=tool("gnuplot", script))
        row("gnuplot %s" % what, done, 4, word, "gnuplot", also=[
            same("p.svg"), ("density" in done.stdout, "the table is lost"),
            ("errors" in json.loads(get("r.json") or "{}"), "the results are lost")])
    done = sphproof(*RUN, "--plot", "p.svg", env={**os.environ, "PATH": "/nowhere"})
    row("gnuplot is missing", done, 4, "gnuplot-nox", also=[same("p.svg")])
    began = time.monotonic()
    done = sphproof(*RUN, "--plot", "p.svg", env=tool("gnuplot", "exec sleep 1000"))
    row("gnuplot hangs", done, 4, "no answer", also=[same("p.svg"),
                                                     (time.monotonic() - began < 120, "waited too long")])


def decimal_comma():
    places = os.path.join(folder, "locales")
    os.mkdir(places)
    made = shutil.which("localedef") and subprocess.run(
        ["localedef", "-i", "de_DE", "-f", "UTF-8", os.path.join(places, "de_DE.UTF-8")],
        capture_output=True).returncode in (0, 1) and os.listdir(places)
    sphproof(*RUN, "--snapshot", "plain.csv", env={**os.environ, "LC_ALL": "C"})
    for name in (["de_DE.UTF-8"] if made else []) + ["C", "C.UTF-8", "xx_XX"]:
        environment = {**os.environ, "LC_ALL": name, "LOCPATH": places if name[0] == "d" else ""}
        done = sphproof(*RUN, "--snapshot", "s.csv", "--plot", "p.svg", env=environment)
        row("LC_ALL=%s" % name, done, 0, also=[
            (get("s.csv") == get("plain.csv"), "another snapshot"),
            ("<svg" in (get("p.svg") or ""), "no plot")])
    if not made:
        not_tried("decimal comma", "localedef cannot make de_DE.UTF-8 here")


def paths():
    strange = os.path.join(folder, "a b", "\u00e9t\u00e9 'q' \"d\" $HOME `x` %s")
    os.makedirs(strange)
    shutil.copy(os.path.join(folder, "good.ini"), os.path.join(strange, "l'\u00e9t\u00e9.ini"))
    for locale in "C", "C.UTF-8":
        done = sphproof("run", os.path.join(strange, "l'\u00e9t\u00e9.ini"), "--json", "r \u00e9.json", "--snapshot",
                        "%s.csv", "--plot", "p q.svg", cwd=strange,
                        env={**os.environ, "LC_ALL": locale})
        inside = sorted(os.listdir(strange))
        row("blanks, quotes, \u00e9 in paths, %s" % locale, done, 0, also=[
            (inside == ["%s.csv", "l'\u00e9t\u00e9.ini", "p q.svg", "r \u00e9.json"], inside)])
    raw = os.path.join(os.fsencode(folder), b"raw \xff\xfe.ini")
    shutil.copy(os.path.join(folder, "good.ini"), raw)
    row("path that is not UTF-8", sphproof("run", raw, "--json", "raw.json"), 0,
        also=[("case" in json.loads(get("raw.json") or "{}"), "no results")])
    gone = os.path.join(folder, "gone")
    os.mkdir(gone)
    done = shell("cd gone && rmdir ../gone && $SPHPROOF run sod n=50 --json r.json")
    row("the working folder is gone", done, 4, "r.json", "No such file")


def streams():
    row("list | head -1", shell("$SPHPROOF list | head -1"), 0)
    row("--help | true", shell("$SPHPROOF --help | true"), 0)
    row("run --json - | head -c 10", shell("$SPHPROOF run sod n=50 --json - | head -c 10"), 0)
    row("stdout closed", shell("$SPHPROOF list >&-"), 4, "standard output")
    done = shell("$SPHPROOF run sod n=50 --json r.json >&-")
    row("stdout closed, --json FILE", done, 4, "standard output",
        also=[("errors" in json.loads(get("r.json") or "{}"), "the results are lost")])
    row("stdout closed, --quiet", shell("$SPHPROOF run sod n=50 --quiet >&-"), 0)
    row("stderr closed", shell("$SPHPROOF run nope 2>&-"), 2)
    row("stdin closed", shell("$SPHPROOF run sod n=50 --plot p.svg <&-"), 0)
    row("all closed", shell("$SPHPROOF run sod n=50 --json r.json --plot p.svg <&- >&- 2>&-"), 4,
        also=[("errors" in json.loads(get("r.json") or "{}"), "the results are lost")])
    row("empty environment", subprocess.run(["env", "-i", program, "run", "sod", "n=50"], cwd=folder,
                                            capture_output=True, text=True), 0)


def interrupts():
    for number in signal.SIGINT, signal.SIGTERM, signal.SIGHUP:
        put("r.json")
        child = subprocess.Popen([program, "run", "sod", "n=200000", "--json", "r.json", "--snapshot",
                                  "new.csv"], cwd=folder, stdout=subprocess.PIPE, text=True,
                                 stderr=subprocess.PIPE,
                                 # a background job of a script, as this test may be, ignores these signals
                                 preexec_fn=lambda number=number: signal.signal(number, signal.SIG_DFL))
        time.sleep(0.3)
        child.send_signal(number)
        child.stdout, child.stderr, _ = *child.communicate(timeout=60), None
        row(number.name, child, -number, also=[same("r.json"), absent("new.csv")])


def memory():
    mebi = 1 << 20
    done = sphproof("run", "sod", "n=10000000", limits=[(resource.RLIMIT_AS, 256 * mebi)])
    row("no memory: run of 1e7 particles", done, 4, "memory", "10000000")
    worst, status = None, set()
    for size in list(range(8, 40, 4)) + list(range(40, 200, 16)):
        limits = [(resource.RLIMIT_AS, size * mebi)]
        if sphproof("--version", limits=limits).returncode:
            continue  # too little memory to load the program
        done = sphproof("run", "sod", "n=200000", "t_end=1e-5", "--snapshot", "s.csv", limits=limits)
        status.add(done.returncode)
        if done.returncode not in (0, 4) or (done.returncode == 4 and "memory" not in done.stderr):
            worst = done
    done = worst or done
    row("no memory: runs within 8 to 200 MiB", done, (0, 4), says="exit status %s" % sorted(status))
    done = sphproof("run", "sod", "n=20000", "t_end=0.001", "--threads", "64",
                    limits=[(resource.RLIMIT_AS, 200 * mebi)])
    row("no memory for 64 threads", done, (0, 4), *(["threads"] if done.returncode else []))


def threads():
    row("one thread", sphproof("run", "sod", "n=5000", "t_end=0.001", "--snapshot", "1.csv"), 0)
    done = sphproof("run", "sod", "n=5000", "t_end=0.001", "--snapshot", "many.csv", "--threads",
                    "%d" % (8 * os.cpu_count()))
    row("threads: 8 times the cores", done, 0, also=[
        (get("1.csv") == get("many.csv"), "other results")])
    if root: # limits on processes do not apply to root
        done = sphproof("run", "sod", "n=5000", "t_end=0.001", "--threads", "64", nobody=True,
                        limits=[(resource.RLIMIT_NPROC, 8)])
        row("eight processes, 64 threads", done, 4, "threads")


def whole(out):
    """The files of a killed report are complete or missing."""
    page, results = get(os.path.join(out, "index.html")), get(os.path.join(out, "results.json"))
    if page is not None:
        xml.fromstring(page.replace("<!DOCTYPE html>", ""))
    if results is not None:
        json.loads(results)
    return page


def killed(fault, done, count, final, before, cache, also=()):
    """A row for a command that was killed repeatedly and then completed."""
    row(fault, final, 0, also=[
        (not done.wrong, "; ".join(done.wrong[:3])),
        (not kills.lost(before, kills.entries(cache)), "computed again, or lost, after the last kill"),
        *also],
        says="%d kills, %d with computations finished, %d in all: each was kept" % (
            done.kills, done.halfway, done.kept))


def kill_studies(count=STUDY_KILLS):
    study = ["converge", "sod", "--n", "200,400,600,800", "--vary", "kernel,gradient", "--jobs", "2"]
    cache = os.path.join(folder, "studies")
    done, before = kills.kill([program, *study, "--cache", cache, "--quiet"], cache, count, 0.4,
                              fine=(0, 1), cwd=folder)
    sweep(parts(cache))  # at most one partial file for each kill
    final = sphproof(*study, "--cache", "studies", "--json", "kept.json")
    fresh = sphproof(*study, "--json", "fresh.json")
    kept, new = (json.loads(get(name) or "{}").get("orders") for name in ("kept.json", "fresh.json"))
    final.returncode = 0 if final.returncode == fresh.returncode else final.returncode
    killed("kill -9, study, %d times" % count, done, count, final, before, cache,
           also=[(kept and kept == new, "other results than without kills")])


def kill_reports(count):
    generator, cache = random.Random(20240229), os.path.join(folder, "killed", "cache")
    done, before = kills.kill([program, "report", "--quiet", "--out", "killed", "--jobs", "2"], cache,
                              count, 3, look=lambda: whole("killed"), cwd=folder)
    sweep(parts(folder))
    final = sphproof("report", "--out", "killed", "--jobs", "2", timeout=900)
    results = json.loads(get("killed/results.json") or "{}")
    again = []
    for run in generator.sample(results.get("runs", []), min(3, len(results.get("runs", [])))):
        rerun = sphproof(*run["reproduce"].split()[1:], "--json", "-")
        again.append(json.loads(rerun.stdout)["errors"] == run["errors"])
    killed("kill -9, report, %d times" % count, done, count, final, before, cache, also=[
        (whole("killed"), "no page"),
        (results.get("found") == len(before), "%s computations were found of %d that were kept" % (
            results.get("found"), len(before))),
        (again and all(again), "other results than a run of its own")])
    cached_reports(cache)


def cached_reports(cache):
    """Faults of a report whose results are all in the cache."""
    size = sum(4 + sum(-(-os.path.getsize(os.path.join(inside, name)) // 4096) * 4 for name in names)
               for inside, _, names in os.walk(cache))
    with small_disk("full disk, report", size + 200) as place:
        if place:
            shutil.copytree(cache, os.path.join(folder, place, "report", "cache"))
            done = sphproof("report", "--out", place + "/report", "--jobs", "2")
            row("full disk, report", done, 4, place, "No space left",
                also=[absent(place + "/report/index.html")])
    for fault, limit, word in (("six open files, report", (resource.RLIMIT_NOFILE, 6), "open files"),
                               ("64 MiB, report", (resource.RLIMIT_AS, 64 << 20), "")):
        out = os.path.join(folder, fault)
        shutil.copytree(cache, os.path.join(out, "cache"))
        row(fault, sphproof("report", "--out", out, "--jobs", "2", limits=[limit]), 4, word)
    for fault, script, word in (("gnuplot fails, report", "exit 1", "gnuplot"),
                                ("gnuplot hangs, report", "exec sleep 1000", "no answer")):
        done = sphproof("report", "--out", "killed", "--jobs", "2", env=tool("gnuplot", script))
        row(fault, done, 4, word, also=[(whole("killed"), "no page"),
                                        ("<h1>All " in get("killed/index.html"), "no verdict")])


PARTS = {"disk": disk, "permissions": permissions, "gnuplot": drawing, "locale": decimal_comma,
         "paths": paths, "streams": streams, "interrupts": interrupts, "memory": memory, "threads": threads,
         "studies": kill_studies, "reports": kill_reports}


def document(seconds):
    """A result document; its head is the program's."""
    document = json.loads(sphproof("list", "kernels", "--json", "-").stdout)
    del document["families"]
    counts = {counted: sum(r["status"] == status for r in rows)
              for counted, status in (("passed", "pass"), ("failed", "fail"), ("skipped", "skip"))}
    result = {**document, "command": "faults", "faults": rows, "summary": counts, "seconds": seconds}
    with open(os.path.join(here, "..", "schema", "sphproof-1.schema.json"), encoding="ascii") as file:
        rules = json.load(file)
    wrong = list(schema.Validator(rules).faults(result, rules))
    assert not wrong, wrong
    return result


def main(arguments):
    global part
    began = time.monotonic()
    os.makedirs(folder)
    shutil.copy(os.path.join(here, "..", "..", "cases", "sod.ini"), os.path.join(folder, "good.ini"))
    for part, try_all in PARTS.items():
        if part == "reports" and arguments.kills:
            try_all(arguments.kills)
            for r in rows:
                r["command"] += " --kills %d" % arguments.kills if r["part"] == part else ""
        elif part != "reports" and part in (arguments.part or PARTS):
            try_all()
    result = document(time.monotonic() - began)
    if arguments.json:
        with open(arguments.json + ".new", "w", encoding="utf-8") as file:
            json.dump(result, file, indent=1)
        os.replace(arguments.json + ".new", arguments.json)
    print("%-38s %4s  %-6s %s" % ("fault", "exit", "status", "message"))
    for r in rows:
        print("%-38s %4s  %-6s %s" % (r["fault"], "-" if r["exit"] is None else r["exit"], r["status"],
                                      r["detail"] or r["message"][:150]))
    print("%d faults, %d answered wrongly" % (len(rows), result["summary"]["failed"]))
    return result["summary"]["failed"] > 0


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sphproof")
    parser.add_argument("part", nargs="*", metavar="PART", help=" ".join(PARTS))
    parser.add_argument("--kills", type=int, default=0)
    parser.add_argument("--json")
    given = parser.parse_intermixed_args()
    if set(given.part) - set(PARTS):
        parser.error("no part %s; allowed: %s" % (" ".join(set(given.part) - set(PARTS)), " ".join(PARTS)))
    program = os.path.abspath(given.sphproof)
    with tempfile.TemporaryDirectory() as temporary: # a folder that `nobody` may enter
        os.chmod(temporary, 0o755)
        folder = os.path.join(temporary, "faults")
        anyones = shutil.copy(program, temporary)
        sys.exit(main(given))
