#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The quick suite does not depend on the machine: runs it as things are, then under each condition of the table in
worlds.py, and prints a table: condition, passed, failed, skipped, seconds.

  world.py run SOURCE BUILD WORK [--only NAME,...] [--test NAME ...] [--no-suite NAME ...]
  world.py try WORK [--only NAME,...]    the test of this test, on a small project
  world.py list                          the conditions

BUILD must be built; only conditions that concern the tree itself build again, in WORK. A condition that cannot be set
up is listed as "not tried", with the reason.
Each condition has a sign that it holds, which is tested before the suite runs: without the sign the condition was not
tried either. `try` makes a project with one planted fault for each condition, a test that fails if the sign is seen,
and requires that exactly this test is reported under this condition.
Exit status 1: a test failed under a condition, or nothing could be tried."""
import argparse
import glob
import json
import os
import shlex
import shutil
import subprocess
import sys
import time

sys.dont_write_bytecode = True  # the source tree may be read-only, and stays clean
import worlds  # noqa: E402


def clean_environment():
    """The environment without what `meson test` adds to it."""
    return {name: value for name, value in os.environ.items()
            if name not in ("MALLOC_PERTURB_", "ASAN_OPTIONS", "UBSAN_OPTIONS", "MSAN_OPTIONS")
            and not name.startswith("MESON_")}


class Outcome:
    """The results of the tests under one condition: names of tests by result."""

    def __init__(self, seconds, results):
        self.seconds = seconds
        self.passed = sorted(name for name, result in results if result in ("OK", "EXPECTEDFAIL"))
        self.skipped = sorted(name for name, result in results if result == "SKIP")
        self.failed = sorted(name for name, result in results if result not in ("OK", "EXPECTEDFAIL", "SKIP"))


def run_tests(world, selection):
    """Runs the tests of world.build inside the world."""
    base = "world-%s" % "".join(c if c.isalnum() else "-" for c in world.name)
    logs = os.path.join(world.logs, base + "*.json")
    for log in glob.glob(logs):
        os.remove(log)
    command = ["meson", "test", "-C", world.build, "--no-rebuild", "--logbase", base, *selection]
    if world.wrapper:
        command += ["--wrapper", shlex.join(world.wrapper)]
    began = time.monotonic()
    done = subprocess.run(world.prefix + command, env=world.environment, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace", check=False)
    results = []
    for log in glob.glob(logs):
        with open(log, encoding="utf-8", errors="replace") as file:
            for line in file:
                test = json.loads(line)
                results.append((test["name"].split(" / ")[-1], test["result"]))
    outcome = Outcome(time.monotonic() - began, results)
    if done.returncode and not outcome.failed or not results:
        outcome.failed.append("(meson test itself, exit status %d: %s)"
                              % (done.returncode, done.stdout.strip()[-300:].replace("\n", " | ")))
    return outcome


def sign_missing(world, condition):
    """Why a process started in this world does not detect the condition; None: it does."""
    command = [*world.prefix, *world.wrapper, sys.executable, os.path.abspath(__file__), "sign", condition.name, world.source]
    done = subprocess.run(command, env=world.environment, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                          stderr=subprocess.PIPE, text=True, errors="replace", check=False, cwd=world.build)
    if done.returncode == 0:
        return None
    return (["its sign is not seen"] + done.stderr.strip().splitlines())[-1]


def try_condition(condition, place, selection):
    """The outcome under this condition, or why there is none."""
    try:
        with worlds.World(condition, place) as world:
            missing = condition.sign and sign_missing(world, condition)
            return missing or run_tests(world, selection)
    except worlds.NotTried as reason:
        return str(reason)
    except worlds.NotBuilt as reason:
        return Outcome(0, [("(the tree does not build: %s)" % reason, "FAIL")])


def print_row(name, outcome, plain):
    """One row of the table; below it failures, and tests that were skipped here only."""
    if isinstance(outcome, str):
        print("%-34s not tried: %s" % (name, outcome), flush=True)
        return
    print("%-34s %6d %6d %7d %7.1f" % (name, len(outcome.passed), len(outcome.failed), len(outcome.skipped),
                                      outcome.seconds), flush=True)
    for test in outcome.failed:
        print("    failed: " + test, flush=True)
    for test in outcome.skipped:
        if plain and test not in plain.skipped:
            print("    skipped here only: " + test, flush=True)


def go_through(conditions, place, select):
    """Runs and prints everything; {name: outcome}. select(condition): the tests."""
    print("%-34s %6s %6s %7s %7s" % ("condition", "passed", "failed", "skipped", "seconds"), flush=True)
    outcomes, plain = {}, None
    for condition in conditions:
        outcomes[condition.name] = outcome = try_condition(condition, place, select(condition))
        print_row(condition.name, outcome, plain)
        plain = plain or outcome
    return outcomes


def run(arguments):
    place = worlds.Place(os.path.realpath(arguments.source), os.path.realpath(arguments.build),
                         os.path.realpath(arguments.work), clean_environment())
    selection = ["--suite", "quick"]
    for suite in arguments.no_suite:
        selection += ["--no-suite", suite]
    if arguments.test:
        selection = arguments.test
    outcomes = go_through(worlds.chosen(arguments.only), place, lambda condition: selection)
    tried = [o for o in outcomes.values() if not isinstance(o, str)]
    bad = [name for name, o in outcomes.items() if not isinstance(o, str) and o.failed]
    print("%d conditions, %d tried, %d with failed tests%s" % (len(outcomes), len(tried), len(bad),
                                                               ": " + ", ".join(bad) if bad else ""))
    return 1 if bad or not tried else 0


def plant(place):
    """The small project: a git repository with one test for each condition."""
    shutil.rmtree(place.source, ignore_errors=True)
    os.makedirs(place.source)
    lines = ["project('planted', meson_version: '>=1.0.0')\n"]
    for condition in worlds.CONDITIONS:
        if condition.sign:
            lines.append("test('%s', find_program('%s'), suite: 'quick', args: ['%s', 'planted', '%s', meson.project_source_root()])\n"
                         % (condition.name, sys.executable, os.path.abspath(__file__), condition.name))
    with open(os.path.join(place.source, "meson.build"), "w", encoding="utf-8") as file:
        file.writelines(lines)
    git = ["git", "-C", place.source, "-c", "user.name=me", "-c", "user.email=me@here", "-c", "commit.gpgsign=false"]
    for words in ["init", "-q"], ["add", "."], ["commit", "-qm", "one"], ["commit", "--allow-empty", "-qm", "two"]:
        subprocess.run(git + words, check=True)
    subprocess.run(["meson", "setup", place.build, place.source], check=True, stdout=subprocess.DEVNULL)


def planted_for(condition):
    """Without a condition all planted tests; else that of the condition, and two that must pass with it."""
    if condition is worlds.CONDITIONS[0]:
        return ["--suite", "quick"]
    others = [c.name for c in worlds.CONDITIONS[1:] if c is not condition and c.name not in condition.implies]
    return [condition.name, *(others[:1] + others[-1:])]


def complaints_about(name, outcome, so_already):
    """The faults in this row of the table of planted faults."""
    condition = worlds.named(name)
    allowed = {name, *so_already, *condition.implies}
    if name not in outcome.failed:
        yield "%s: its planted fault was not reported" % name
    if not set(outcome.failed) <= allowed:
        yield "%s: %s was reported, too" % (name, sorted(set(outcome.failed) - allowed))
    ran = sorted(outcome.passed + outcome.failed)
    if ran != sorted(planted_for(condition)):
        yield "%s: what ran is %s" % (name, ran)


def try_all(arguments):
    work = os.path.realpath(arguments.work)
    build = os.path.join(work, "planted-build")
    shutil.rmtree(build, ignore_errors=True)
    # The work folder is in the build, as it is by night.
    place = worlds.Place(os.path.join(work, "planted"), build, os.path.join(build, "worlds"), clean_environment())
    plant(place)
    outcomes = go_through(worlds.chosen(arguments.only), place, planted_for)
    # A machine may already have the condition: then the fault must show as things are, too.
    with worlds.World(worlds.CONDITIONS[0], place) as world:
        so_already = sorted(c.name for c in worlds.CONDITIONS if c.sign and not sign_missing(world, c))
    plain = outcomes.pop("as it is")
    tried = {name: outcome for name, outcome in outcomes.items() if not isinstance(outcome, str)}
    complaints = [line for name, outcome in tried.items() for line in complaints_about(name, outcome, so_already)]
    if plain.failed != so_already:
        complaints.append("as it is: %s failed, but %s hold" % (plain.failed, so_already))
    if len(tried) < 10 and not arguments.only:
        complaints.append("only %d conditions were tried" % len(tried))
    print("\n".join(complaints) or "each of the %d conditions that were tried showed its planted fault" % len(tried))
    return 1 if complaints else 0


def main():
    if sys.argv[1:2] == ["sign"]:
        return 0 if worlds.named(sys.argv[2]).sign(sys.argv[3]) else 1
    if sys.argv[1:2] == ["planted"]:
        return 1 if worlds.named(sys.argv[2]).sign(sys.argv[3]) else 0
    parser = argparse.ArgumentParser()
    commands = parser.add_subparsers(dest="command", required=True)
    for name, folders in (("run", ["source", "build", "work"]), ("try", ["work"]), ("list", [])):
        command = commands.add_parser(name)
        for folder in folders:
            command.add_argument(folder)
        command.add_argument("--only", default="")
        if name == "run":
            command.add_argument("--test", nargs="*", default=[])
            command.add_argument("--no-suite", nargs="*", default=[])
    arguments = parser.parse_args()
    if arguments.command == "list":
        print("\n".join(condition.name for condition in worlds.CONDITIONS))
        return 0
    return run(arguments) if arguments.command == "run" else try_all(arguments)


if __name__ == "__main__":
    sys.exit(main())
