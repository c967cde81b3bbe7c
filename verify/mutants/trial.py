# SPDX-License-Identifier: GPL-3.0-or-later
"""Tries mutants: decides which tests run, which mutants they reach, in what order they run, and when to stop. Part of
verify/mutants/score.

A unit is a test of the quick suite or one of its checks. Its key is a hash of what it runs: measurements of a unit
(reach.json), and mutants that it did not notice (the record), are valid as long as the key is the same."""
import collections
import concurrent.futures
import glob
import hashlib
import json
import os
import queue
import re
import resource
import shutil
import signal
import subprocess
import threading
import time

LEAST = 3  # at least this many tests are tried on a mutant, however long they take
START = 0.03  # CPU-s of a process
ROUNDS = (0.5, 4, float("inf"))  # largest CPU-s of a test: cheap tests are tried on every mutant first


class Unit:
    def __init__(self, name, command, folder, key):
        self.name, self.command, self.folder, self.key = name, command, folder, key


def quietly(command, **more):
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **more)


# --- units --------------------------------------------------------------------------------------------


def hash_of(paths, tree):
    h = hashlib.sha256()
    for path in sorted(paths):
        with open(path, "rb") as f:
            h.update(os.path.relpath(path, tree).encode() + b"\0" + f.read())
    return h.hexdigest()[:16]


def files_below(top):
    if os.path.isfile(top):
        return [top]
    return [os.path.join(folder, f) for folder, _, files in os.walk(top) for f in files if not f.endswith(".pyc")]


def quick_tests(build):
    """The quick tests that meson lists, without those that only inspect sources and libraries."""
    tests = json.loads(quietly(["meson", "introspect", "--tests", build]).stdout)
    suites = [{s.split(":")[-1] for s in t["suite"]} for t in tests]
    return [t for t, suite in zip(tests, suites) if "quick" in suite and "once" not in suite]


def units_of(build, source, tree, wanted):
    """The quick suite's tests from meson; groups of checks are split into checks, and transcripts likewise. tree: the
    rewritten copy of source. wanted: a regular expression for their names."""
    checked, tested = os.path.join(source, "verify", "check"), os.path.join(source, "verify", "test")
    folders = [os.path.join(source, r) for r in ("src", "reference", "reports", "cases", "verify")]
    common = hash_of([f for r in folders for f in files_below(r) if f.endswith((".c", ".h", ".def", ".in", ".case"))
                      and not f.startswith((checked, tested))], source)
    checks = checks_of(checked)
    checks_key = hash_of(files_below(checked), source)
    units = []
    for test in quick_tests(build):
        command, folder = test["cmd"], test["workdir"] or build
        program = os.path.join(build, command[0])
        if command[1:2] == ["verify"] and "--mutants" in command:
            for name in checks.get(command[2], command[2:3]):
                units.append(Unit(name, [program, "verify", name, "--mutants", "--first", "--quiet", "--failures",
                                         "@SCRATCH@/failures"], folder, common + checks_key))
            continue
        own = [p for w in command for p in files_below(w.replace(tree, source)) if p.startswith(tested)]
        own += glob.glob(os.path.join(tested, "**", os.path.basename(command[0]) + ".c"), recursive=True)
        own += glob.glob(os.path.join(tested, "*.h"))
        if test["name"] == "suite":
            own += files_below(checked)
        program = program if os.path.exists(program) else command[0]
        for one in command[2:] if test["name"] == "transcripts" else [None]:
            units.append(Unit("transcripts/" + one if one else test["name"],
                              [program] + ([command[1], one] if one else command[1:]), folder, common + hash_of(own, source)))
    return [u for u in units if re.search(wanted, u.name)]


def checks_of(folder):
    """The quick checks of each group as GROUP/CHECK, from their descriptors; a group is left out if macros make some
    of its descriptors."""
    quick, found, listed = collections.defaultdict(list), collections.Counter(), collections.Counter()
    for path in sorted(glob.glob(os.path.join(folder, "*.c"))):
        with open(path) as f:
            for group, name, rest in re.findall(r'^CHECK_DEFINE\(\s*(\w+),\s*(\w+),(.*?)\);$', f.read(), flags=re.S | re.M):
                found[group] += 1
                if ".slow = true" not in rest:
                    quick[group].append("%s/%s" % (group, name))
    for path in glob.glob(os.path.join(folder, "checks.def")):
        with open(path) as f:
            listed = collections.Counter(re.findall(r"^CHECK\(\w+, ([a-z]+)_", f.read(), flags=re.M))  # file, then group_name
    return {group: checks for group, checks in quick.items() if found[group] == listed[group]}


# --- running ------------------------------------------------------------------------------------------


def limits(cpu, sanitized):
    def set_limits():
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 28, 1 << 28))
        if not sanitized:  # the address sanitizer reserves terabytes
            resource.setrlimit(resource.RLIMIT_AS, (6 << 30, 6 << 30))
        resource.setrlimit(resource.RLIMIT_CPU, (cpu, cpu + 1))
    return set_limits


def run_unit(unit, place, scratch, environment, usual):
    """Returns '' if the unit passes, else how it fails; and its CPU-s. place: the folder of the first build and
    the copy that replaces it. usual: CPU-s without a mutant; twice that is a hang. The limit of wall time
    is much longer, because the machine may be busy."""
    shutil.rmtree(scratch, ignore_errors=True)
    os.makedirs(os.path.join(scratch, "cache"))
    built, here = place
    words = [w.replace("@SCRATCH@", scratch).replace(built, here) for w in unit.command]
    process = subprocess.Popen(words, cwd=unit.folder.replace(built, here), stdin=subprocess.DEVNULL,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True,
                               preexec_fn=limits(int(2 + 2 * usual), "ASAN_OPTIONS" in environment),
                               env=dict(os.environ, TMPDIR=scratch, XDG_CACHE_HOME=os.path.join(scratch, "cache"),
                                        OMP_WAIT_POLICY="passive", **environment))
    end, pause = time.time() + 30 + 30 * usual, 0.001
    while True:
        pid, status, used = os.wait4(process.pid, os.WNOHANG)
        if pid or time.time() > end:
            break
        time.sleep(pause)
        pause = min(0.05, 1.3 * pause)
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass
    if not pid:
        _, _, used = os.wait4(process.pid, 0)
        status = signal.SIGXCPU
    code = process.returncode = os.waitstatus_to_exitcode(status)
    hangs = -code in (signal.SIGXCPU, signal.SIGKILL)
    return "" if code in (0, 77) else "hangs" if hangs else "exit status %d" % code, used.ru_utime + used.ru_stime


def copy_build(build, copy):
    """Copies the programs, so that they run beside the first build's; leaves out objects and libraries."""
    shutil.rmtree(copy, ignore_errors=True)
    shutil.copytree(build, copy, ignore=shutil.ignore_patterns("*.p", "*.a", "meson-*", "*.ninja", ".ninja*"),
                    symlinks=True)


def in_threads(function, workers):
    """Calls function(i) in `workers` threads; raises a thread's exception when all have ended."""
    with concurrent.futures.ThreadPoolExecutor(workers) as threads:
        for done in [threads.submit(function, i) for i in range(workers)]:
            done.result()


class Table:
    """Measurements of the units without a mutant: CPU-s, the mutants that they reach, and the reached mutants
    that change a value there. Stored in reach.json. environment: further variables for tests with and without mutants."""

    def __init__(self, work, drawn, shard, environment=None):
        self.environment = environment or {}
        self.work, self.build, self.shard = work, os.path.join(work, "build"), shard
        self.count = 1 + max((m.number for m in drawn), default=0)
        self.drawn = hashlib.sha256(repr(sorted((m.number, m.key) for m in drawn)).encode()).hexdigest()
        self.path, self.lock = os.path.join(work, "reach.json"), threading.Lock()
        self.units = {}
        if os.path.exists(self.path):
            with open(self.path) as f:
                self.units = json.load(f)

    def write(self):
        new = self.path + self.shard + ".new"
        with open(new, "w") as f:
            json.dump(self.units, f)
        os.replace(new, self.path)

    def place(self, worker):
        """The folder of the first build and its copy for this worker; the scratch folder."""
        own = os.path.join(self.work, "%%s%d%s" % (worker, self.shard))
        return (self.build, own % "worker"), own % "scratch"

    def copy_builds(self, workers):
        for worker in range(workers):
            copy_build(*self.place(worker)[0])

    def in_rounds(self, units):
        """Cheap units first; the cheapest notice most. What is new is cheap if it is a program of the
        build, and dearer if it is a script that calls some."""
        rounds = [[] for _ in ROUNDS]
        for unit in units:
            usual = ROUNDS[not unit.command[0].startswith(self.build)]
            seconds = self.units.get(unit.name, {}).get("seconds", usual)
            rounds[next(i for i, most in enumerate(ROUNDS) if seconds <= most)].append(unit)
        return [r for r in rounds if r]

    def knows(self, unit):
        return self.units.get(unit.name, {}).get("key") == [unit.key, self.drawn]

    def find(self, units, workers, over):
        """Runs each unknown unit once, until the time is over. Returns the units that are known."""
        waiting = queue.Queue()
        for unit in units:
            if not self.knows(unit):
                waiting.put(unit)

        def work_off(worker):
            place, scratch = self.place(worker)
            marks = scratch + ".marks"
            while not over():
                try:
                    unit = waiting.get_nowait()
                except queue.Empty:
                    return
                with open(marks, "wb") as f:
                    f.truncate(self.count)
                failed, seconds = run_unit(unit, place, scratch, {"SPHPROOF_REACH": marks}, 200)
                if failed:  # the marks may be the cause
                    failed, seconds = run_unit(unit, place, scratch, {}, 200)
                with open(marks, "rb") as f:
                    seen = f.read()
                entry = {"key": [unit.key, self.drawn], "seconds": round(seconds, 3), "failed": failed,
                         "reached": [i for i, b in enumerate(seen) if b],
                         "differs": [i for i, b in enumerate(seen) if b == 2]}
                with self.lock:
                    self.units[unit.name] = entry
                    print("  reach of %-32s %6.2f CPU-s  %6d mutants, %6d would differ  %s"
                          % (unit.name, seconds, len(entry["reached"]), len(entry["differs"]),
                             "fails without any mutant: " + failed if failed else ""), flush=True)
                    self.write()

        in_threads(work_off, workers)
        if not waiting.empty():
            print("  %d tests are left out: half of the time that was left was over" % waiting.qsize(), flush=True)
        return [u for u in units if self.knows(u)]

    def sound(self, unit, place, scratch):
        """True if the unit passes without a mutant. Tested when it notices its first mutant."""
        entry = self.units[unit.name]
        if "sound" not in entry:
            failed, seconds = run_unit(unit, place, scratch, self.environment, max(10, 3 * entry["seconds"]))
            with self.lock:
                entry["sound"], entry["failed"], entry["seconds"] = not failed, failed, round(seconds, 3)
                if failed:
                    print("  %s fails without any mutant: %s" % (unit.name, failed), flush=True)
                self.write()
        return entry["sound"]


# --- judging ------------------------------------------------------------------------------------------


class Judge:
    def __init__(self, table, record, patience):
        self.table, self.patience, self.units, self.breadth = table, patience, {}, {}
        self.differs, self.reached = collections.defaultdict(set), collections.defaultdict(set)
        self.learnt, self.lock = collections.defaultdict(lambda: [0, 0]), threading.Lock()
        for entry in record.values():
            self.learn(entry)

    def admit(self, units):
        """Adds units whose reached mutants the table knows."""
        for unit in units:
            entry, name = self.table.units[unit.name], unit.name
            if entry["failed"]:
                continue
            self.units[name], self.breadth[name] = unit, 1 + len(entry["reached"])
            for number in entry["differs"]:
                self.differs[number].add(name)
            for number in entry["reached"]:
                self.reached[number].add(name)

    def learn(self, entry):
        with self.lock:
            for name in entry["ran"]:
                noticed = name == entry.get("by")
                for where in (entry["file"], ""):
                    at = self.learnt[where, name]
                    at[0] += noticed
                    at[1] += 1

    def seconds(self, name):
        return self.table.units[name]["seconds"]

    def order(self, mutant, names):
        """Sorts tests by probability of noticing the mutant per CPU time: from their record in this file, and
        elsewhere. Without a record, a test that reaches few mutants is taken to be written for this one. A
        test that notices a mutant ends early, after about a tenth of its time."""
        def worth(name):
            here, all_ = self.learnt[mutant.file, name], self.learnt["", name]
            start = 1 / (1 + self.breadth[name] / 1000)
            rate = (here[0] + 2 * (all_[0] + 2 * start) / (all_[1] + 2)) / (here[1] + 2)
            return -rate / (START + self.seconds(name) * (1 - 0.9 * min(1, rate)))
        return sorted(names, key=worth)

    def judge(self, mutant, near, before, worker):
        """Judges a mutant; returns a line of the record. before: its last line, or that of the previous round,
        if any; units that did not notice the mutant then are not run again."""
        reaching = near if mutant.constant else self.differs[mutant.number]
        place, scratch = self.table.place(worker)
        if not mutant.number:  # compiled in place
            place = self.table.build, self.table.build
        known = before["ran"] if before and before["outcome"] == "survived" else {}
        ran = {n: k for n, k in known.items() if n in reaching and n in self.units and self.units[n].key == k}
        by, how, spent, tried, began = None, "", 0, 0, time.time()
        for name in self.order(mutant, [n for n in reaching if n not in ran]):
            unit, usual = self.units[name], self.seconds(name)
            if not mutant.number and not self.built(unit):
                by, how = name, "does not compile"
                break
            if tried >= LEAST and spent + usual > self.patience:
                continue
            spent, tried = spent + usual + START, tried + 1
            how, _ = run_unit(unit, place, scratch, {"SPHPROOF_MUTANT": str(mutant.number), **self.table.environment},
                              usual)
            # a copy of the build lacks the mutant that is compiled in place
            if how and not self.table.sound(unit, self.table.place(worker)[0], scratch):
                how = ""
                continue
            ran[name] = unit.key
            if how:
                by = name
                break
        entry = {"key": mutant.key, "file": mutant.file, "line": mutant.line, "change": mutant.change,
                 "outcome": "killed" if by else "survived", "by": by, "how": how, "ran": ran,
                 "why": "" if by else self.why(mutant, reaching, ran), "seconds": round(time.time() - began, 2)}
        self.learn({**entry, "ran": [n for n in ran if n not in known]})
        return entry

    def built(self, unit):
        """Builds the programs of a unit after a change of a source."""
        build = self.table.build
        targets = {os.path.relpath(w, build) for w in unit.command + [os.path.join(build, "sphproof")]
                   if w.startswith(build) and os.path.isfile(w)}
        return quietly(["ninja", "-C", build] + sorted(targets)).returncode == 0

    def why(self, mutant, reaching, ran):
        if not mutant.constant and not self.reached[mutant.number]:
            return "no test comes by"
        if not reaching:
            return "no test would see another value"
        return "no test fails: %d of %d that come by" % (len(ran), len(reaching))
