#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds one-line faults of the sources, which the checks must detect.

  mutants.py check SOURCE WORK               does each one still apply exactly once?
  mutants.py run SOURCE WORK [NAME ...] (names or groups) build each fault into a copy of the tree and expect
                                             `sphproof verify GROUP`, or the test that is named,
                                             to fail (two at a time)
  mutants.py build SOURCE WORK NAME PROGRAM  the whole program with one fault (meson -Dmutant=NAME)

The list is mutants.txt beside this script; its head says how an entry looks. Nothing is ever
changed in SOURCE. Exit status 1: a fault was not noticed, or does not apply any more."""
import json
import os
import queue
import re
import shutil
import subprocess
import sys
import threading
import time

LIST = os.path.join(os.path.dirname(os.path.abspath(__file__)), "mutants.txt")
OPTIONS = ["-Dclones=false", "-Doptimization=1", "-Dwerror=false", "-Dslow=false"]
OWN = ("meson-info", "meson-logs", "meson-private", "build.ninja", "compile_commands.json")  # name the build's folder
WORKERS = 2
PATIENCE = 240  # seconds that one verification may take


class Mutant:
    def __init__(self, name):
        self.name, self.fault, self.group, self.test, self.file, self.also = name, "", "", "", "", ""
        self.old, self.new = [], []

    def targets(self):
        """The build targets besides the program that its test needs."""
        return (["verify/test/" + self.test] if self.test.startswith("test_") else []) + self.also.split()

    def apply(self, tree):
        """Puts the fault into tree; returns the original text."""
        path = os.path.join(tree, self.file)
        with open(path) as f:
            text = f.read()
        old, new = "\n".join(self.old), "\n".join(self.new)
        if text.count(old) != 1:
            raise ValueError("mutant %s: its text stands %d times in %s, not once:\n%s"
                             % (self.name, text.count(old), self.file, old))
        with open(path, "w") as f:
            f.write(text.replace(old, new))
        return text


def read_list():
    mutants = []
    with open(LIST) as f:
        for number, line in enumerate(f, 1):
            line = line.rstrip("\n")
            if re.match(r"\[\w+\]$", line):
                mutants.append(Mutant(line[1:-1]))
            elif line.startswith("- "):
                mutants[-1].old.append(line[2:])
            elif line.startswith("+ "):
                mutants[-1].new.append(line[2:])
            elif ": " in line and not line.startswith("#"):
                key, value = line.split(": ", 1)
                if key not in ("fault", "group", "test", "also", "file"):
                    sys.exit("%s:%d: unknown key '%s'" % (LIST, number, key))
                setattr(mutants[-1], key, value)
            elif line and not line.startswith("#"):
                sys.exit("%s:%d: what is this?" % (LIST, number))
    names = [m.name for m in mutants]
    for m in mutants:
        if names.count(m.name) > 1 or not (m.fault and bool(m.group) != bool(m.test) and m.file and m.old):
            sys.exit("%s: mutant %s is incomplete or listed twice" % (LIST, m.name))
    return mutants


def same(a, b):
    with open(a, "rb") as x, open(b, "rb") as y:
        return x.read() == y.read()


def copy_tree(source, tree):
    """Makes tree equal to source. Equal files stay untouched, others get a new date, so that a build of the
    tree rebuilds only what an earlier fault, or an edit, has changed."""
    ignore = shutil.ignore_patterns("build*", ".git", "out", "__pycache__")
    os.makedirs(tree, exist_ok=True)
    names = os.listdir(source)
    names = set(names) - ignore(source, names)
    for name in set(os.listdir(tree)) - names:
        path = os.path.join(tree, name)
        shutil.rmtree(path) if os.path.isdir(path) else os.remove(path)
    for name in names:
        old, new = os.path.join(source, name), os.path.join(tree, name)
        if os.path.isdir(old):
            copy_tree(old, new)
        elif not (os.path.exists(new) and same(old, new)):
            shutil.copyfile(old, new)
            shutil.copymode(old, new)


def quietly(command, **more):
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          **more)


def demand(command):
    result = quietly(command)
    if result.returncode:
        sys.exit("%s\n%s" % (result.stdout[-3000:], "failed: " + " ".join(command)))


class Worker:
    """A copy of the tree with its build, in which one fault after the other is built."""

    def __init__(self, folder):
        folder = os.path.abspath(folder)
        self.tree, self.build = os.path.join(folder, "tree"), os.path.join(folder, "build")
        self.clean = os.path.join(folder, "clean")
        self.program = os.path.join(self.build, "sphproof")

    def prepare(self, first=None):
        """Configures; copies the build of the first worker, whose copy of the tree is equally old."""
        shutil.rmtree(self.build, ignore_errors=True)
        demand(["meson", "setup", self.build, self.tree] + OPTIONS)
        if first:
            self.clean = first.clean
            self.restore()

    def keep(self, targets):
        """Builds, and keeps a copy of the build without a fault."""
        demand(["ninja", "-C", self.build, "sphproof"] + targets)
        shutil.rmtree(self.clean, ignore_errors=True)
        shutil.copytree(self.build, self.clean, symlinks=True, ignore=shutil.ignore_patterns(*OWN))

    def restore(self):
        """Restores the files of the build that a fault has changed, with their dates, so that ninja has no work."""
        for folder, _, names in os.walk(self.clean):
            here = os.path.join(self.build, os.path.relpath(folder, self.clean))
            os.makedirs(here, exist_ok=True)
            for name in names:
                kept, now = os.path.join(folder, name), os.path.join(here, name)
                if not (os.path.islink(kept) or os.path.exists(now) and os.stat(now).st_mtime_ns == os.stat(kept).st_mtime_ns):
                    shutil.copy2(kept, now)

    def verify(self, mutant):
        """The exit status of the judge that must notice the fault: a group of checks, a script or a C test."""
        if mutant.group:
            command = [self.program, "verify", *mutant.group.split(), "--first", "--quiet", "--failures",
                       os.path.join(self.build, "failures")]
        elif mutant.test.endswith(".py"):
            command = [sys.executable, os.path.join(self.tree, "verify/test", mutant.test), self.program]
        else:
            command = self.command_of(os.path.join(self.build, mutant.targets()[0]))
        try:
            # in that folder, because a faulty test may leave files behind
            result = quietly(command, timeout=PATIENCE, cwd=self.build)
            self.said = result.stdout
            return result.returncode
        except subprocess.TimeoutExpired:
            self.said = "not ended after %d s" % PATIENCE
            return "hangs"

    def command_of(self, program):
        """The command of a test with the arguments that meson gives it."""
        tests = json.loads(quietly(["meson", "introspect", "--tests", self.build]).stdout)
        return next(t["cmd"] for t in tests if t["cmd"][0] == program)

    def judge(self, mutant):
        """Returns 'caught', or why the fault was not caught. Does not restore the build."""
        path = os.path.join(self.tree, mutant.file)
        try:
            date = os.stat(path)
            original = mutant.apply(self.tree)
        except (ValueError, OSError) as error:
            return str(error)
        try:
            built = quietly(["ninja", "-C", self.build, "sphproof"] + mutant.targets())
            if built.returncode:
                return "does not compile:\n" + built.stdout[-2000:]
            code = self.verify(mutant)
            return "caught" if code not in (0, 2, 4) or (mutant.test and code) else "NOT CAUGHT (exit status %s)" % code
        finally:
            with open(path, "w") as f:
                f.write(original)
            os.utime(path, ns=(date.st_atime_ns, date.st_mtime_ns))


def share(workers, tasks, do):
    """Calls do(worker, task) for each task, on the next free worker."""
    waiting = queue.Queue()
    for task in tasks:
        waiting.put(task)

    def work_off(worker):
        while True:
            try:
                task = waiting.get_nowait()
            except queue.Empty:
                return
            do(worker, task)

    threads = [threading.Thread(target=work_off, args=(w,)) for w in workers]
    for t in threads:
        t.start()
    for t in threads:
        t.join()


def run(source, work, names):
    mutants = [m for m in read_list() if not names or {m.name, m.group, m.test} & set(names)]
    began, outcomes, failing = time.monotonic(), {}, {}
    workers = [Worker(os.path.join(work, "worker%d" % i)) for i in range(min(WORKERS, len(mutants)))]
    for worker in workers:
        copy_tree(source, worker.tree)
    workers[0].prepare()
    workers[0].keep(sorted({target for m in mutants for target in m.targets()}))
    for worker in workers[1:]:
        worker.prepare(workers[0])

    def without_fault(worker, mutant):
        if worker.verify(mutant) != 0:
            failing[mutant.group or mutant.test] = worker.said

    share(workers, {m.group or m.test: m for m in mutants}.values(), without_fault)
    if failing:
        sys.exit("without any fault these fail already: " + "".join("\n%s: %s" % (name, said[-2000:]) for name, said in failing.items()))

    def with_fault(worker, mutant):
        start = time.monotonic()
        outcomes[mutant.name] = worker.judge(mutant)
        worker.restore()
        print("%3d/%d  %-34s %-14s %5.1f s  %s" % (len(outcomes), len(mutants), mutant.name, mutant.group or mutant.test,
                                                  time.monotonic() - start, outcomes[mutant.name]), flush=True)

    share(workers, mutants, with_fault)
    missed = [m for m in mutants if outcomes[m.name] != "caught"]
    with open(os.path.join(work, "mutants.json"), "w") as f:
        json.dump([{"mutant": m.name, "group": m.group or m.test, "file": m.file, "fault": m.fault,
                    "outcome": outcomes[m.name]} for m in mutants], f, indent=1)
    print("\n%d source mutants, %d caught, %d not; %.0f s"
          % (len(mutants), len(mutants) - len(missed), len(missed), time.monotonic() - began))
    for m in missed:
        print("  %s (%s): %s\n      %s" % (m.name, m.file, m.fault, outcomes[m.name]))
    return 1 if missed else 0


def check(source, work):
    bad = 0
    for m in read_list():
        folder = os.path.join(work, os.path.dirname(m.file))
        os.makedirs(folder, exist_ok=True)
        try:
            shutil.copy(os.path.join(source, m.file), folder)
            m.apply(work)
        except (ValueError, OSError) as error:
            print(error)
            bad += 1
    print("%d source mutants, %d do not apply" % (len(read_list()), bad))
    return 1 if bad else 0


def build(source, work, name, program):
    chosen = [m for m in read_list() if m.name == name]
    if not chosen:
        sys.exit("no mutant '%s'; there are: %s" % (name, " ".join(m.name for m in read_list())))
    tree, folder = os.path.join(work, "tree"), os.path.join(work, "build")
    copy_tree(source, tree)
    chosen[0].apply(tree)
    if not os.path.exists(os.path.join(folder, "build.ninja")):
        demand(["meson", "setup", folder, tree, "-Dwerror=false", "-Dslow=false"])
    demand(["ninja", "-C", folder, "sphproof"])
    shutil.copy(os.path.join(folder, "sphproof"), program)
    return 0


def main(arguments):
    if len(arguments) == 3 and arguments[0] == "check":
        return check(arguments[1], arguments[2])
    if len(arguments) >= 3 and arguments[0] == "run":
        return run(arguments[1], arguments[2], arguments[3:])
    if len(arguments) == 5 and arguments[0] == "build":
        return build(*arguments[1:])
    sys.exit(__doc__)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
