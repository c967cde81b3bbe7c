#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests plug-in kernels with subtle faults, and plug-ins that crash, hang or write where they must not: the table
examples/hostile.txt has the program's answer to each.

  plugins.py PROGRAM FOLDER TABLE [OPTION ...]   FOLDER: of the plug-ins; OPTIONs for `sphproof kernel`

Standard output is one document, or empty if the kernel is refused; no process is left."""
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor

PROGRAM, FOLDER, TABLE, MORE = sys.argv[1], sys.argv[2], sys.argv[3], sys.argv[4:]
PATIENCE = 600 if MORE else 100  # seconds
VERIFIED = ["none", "sign_narrow", "exit_42"] if MORE else ["exit_42"]  # with `verify kernels`, too
ENDLESS = ["loop_late", "loop_at_load"]  # each takes seconds
RIGHT = ["wendland_c8", "gaussian", "super_gaussian", "table", "table_12", "table_4000"]


# so that a sanitizer's malloc fails like any other when memory is exhausted
for name in "ASAN_OPTIONS", "TSAN_OPTIONS":
    os.environ[name] = os.environ.get(name, "") + ":allocator_may_return_null=1"


def unloads():
    """With musl, whose dlclose does nothing, a plug-in's code for unloading never runs."""
    with open(PROGRAM, "rb") as f:
        return b"/ld-musl-" not in f.read(4096)


def read_table():
    """The table's lines, and the number of those before its last part, which take a whole certificate each."""
    with open(TABLE) as f:
        parts = f.read().split("# -- never a value --\n")
    left_out = ("#",) if unloads() else ("#", "crash_at_unload ")
    lines = [[line for line in part.splitlines() if line.strip() and not line.startswith(left_out)] for part in parts]
    return [[cell.strip() for cell in line.split("|", 4)] for line in sum(lines, [])], len(lines[0])


def module(name):
    return os.path.join(FOLDER, "hostile_%s.so" % name)


def call(*arguments):
    result = subprocess.run([PROGRAM, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                            text=True, timeout=PATIENCE, stdin=subprocess.DEVNULL)
    return result.returncode, result.stdout, result.stderr


def said(document):
    """The findings of a document: names of failing checks, and all texts about precision, locations, prints."""
    checks = document["checks"]
    names = [c["name"] for c in checks if c["status"] == "fail"]
    words = [c.get("subject") or "" for c in checks] + [json.dumps(document.get(k))
                                                       for k in ("precision", "printed")]
    return names, " ".join(words)


def judge(line):
    name, _, options, status, words = line
    try:
        code, out, err = call("kernel", module(name), "--dim", "1", "--json", "-", *MORE,
                              *options.split())
    except subprocess.TimeoutExpired:
        return "hangs"
    if code != int(status):
        return "exit status %d, not %s: %s" % (code, status, err.strip())
    if code == 2:
        return None if not out and words in err else "says %r%r, not %r" % (out, err, words)
    try:
        names, text = said(json.loads(out))
    except ValueError as error:
        return "no document on standard output: %s" % error
    if json.loads(out)["normalisation"] is None and [json.loads(out)["checks"][0][k] for k in ("value", "bound", "floor")] != [1, 0, 0]:
        return "a kernel that does not return has %s" % json.loads(out)["checks"]
    if (code == 1) != bool(names):
        return "exit status %d and failing checks %s" % (code, names)
    if code == 1 and words in ("between", "continuity", "radial_derivative", "width_derivative", "runs",
                               "sign", "fundamental", "normalisation"):
        return None if words in names else "%s fails, not %s" % (", ".join(names), words)
    return None if words in text else "does not say %r but %s" % (words, text[-600:])


def by_day(table, certified):
    """Every third line that takes a whole certificate; all others except endless ones."""
    return table[:certified:3] + [line for line in table[certified:] if line[0] not in ENDLESS]


def judge_verify(line):
    name, _, options, status, words = line
    code, out, err = call("verify", "kernels", "--kernel-plugin", module(name), "--json", "-",
                          "--failures", os.path.join(FOLDER, "failures"))
    if code != int(status):
        return "verify: exit status %d, not %s: %s" % (code, status, err.strip())
    if code == 2:
        return None if not out and words in err else "verify: says %r%r" % (out, err)
    failing = [c["name"] + " " + c["subject"] for c in json.loads(out)["checks"]
               if c["status"] == "fail"]
    if code == 1 and not any(words in text for text in failing):
        return "verify: fails in %s, not in %s" % (failing, words)
    return None


def judge_right(name, dim):
    code, out, err = call("kernel", os.path.join(FOLDER, name + ".so"), "--dim", dim, "--json", "-", *MORE)
    return None if code == 0 else "dim %s: exit status %d: %s%s" % (dim, code, said(json.loads(out))[0], err)


def judge_words(name):
    """The printed summary: kernel, number of dimensions, and outcome."""
    for dim, many in (("1", "1 dimension"), ("3", "3 dimensions")):
        code, out, err = call("kernel", module(name), "--dim", dim)
        if code != 1 or err or not re.fullmatch("hostile_%s, %s\n\nREJECTED: it crashes [^\n]*\n" % (name, many), out):
            return "exit status %d: %r%r" % (code, out, err)
    return None


def judge_derived(name, hows):
    """What a plug-in supplies, and how the rest is found."""
    path = os.path.join(FOLDER, name + ".so")
    with tempfile.NamedTemporaryFile() as file:
        code, out, err = call("kernel", path, "--dim", "1", "--color", "never", "--json", file.name)
        with open(file.name) as f:
            derived = json.load(f)["derived"]
    if derived != [what for what, how in zip(("constant", "dw_dh", "knots", "class"), hows) if how]:
        return "derived: %s" % derived
    lines = ["  %-28s %s" % (what, "supplied and checked" if not how else "not supplied: found " + how)
             for what, how in zip(("constant", "dW/dh", "knots", "class"), hows)]
    return None if code == 0 and out.endswith(" bounds\n%s\n\n" % "\n".join(lines)) else "exit status %d: %r%r" % (code, out, err)


def judge_printed(name):
    """What a plug-in printed is at the end of the summary, as in the document."""
    with tempfile.NamedTemporaryFile() as file:
        code, out, err = call("kernel", module(name), "--dim", "1", "--json", file.name)
        with open(file.name) as f:
            printed = json.load(f)["printed"]
    return None if code == 1 and "\n\nREJECTED: " in out and out.endswith(
        "\nnote: it printed %(bytes)d bytes: %(text)s\n" % printed) else "exit status %d: %r%r" % (code, out, err)


def processes(path):
    found = []
    for pid in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open("/proc/%s/cmdline" % pid, "rb") as f:
                if path.encode() in f.read().split(b"\0") and int(pid) != os.getpid():
                    found.append(int(pid))
        except OSError:
            pass
    return found


def wait_for(condition, seconds=20):
    until = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > until:
            return False
        time.sleep(0.02)
    return True


def judge_interrupt(number):
    """An interrupt ends everything, also if the plug-in has processes of its own."""
    path = os.path.realpath(module("forks_and_sleeps"))
    work = subprocess.Popen([PROGRAM, "kernel", path, "--dim", "1"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                            # a background job of a script, as this test may be, ignores interrupts
                            preexec_fn=lambda: signal.signal(number, signal.SIG_DFL))
    if not wait_for(lambda: len(processes(path)) == 3):
        work.kill()
        return "%d processes at work, not 3" % len(processes(path))
    work.send_signal(number)
    work.wait(PATIENCE)
    if not wait_for(lambda: not processes(path)):
        return "left behind: %s" % processes(path)
    return None if work.returncode == -number else "exit status %d" % work.returncode


def main():
    (table, certified), bad = read_table(), 0
    by_name = {line[0]: line for line in table}
    with ThreadPoolExecutor(2) as pool:
        outcomes = [(line[0], pool.submit(judge, line)) for line in (table if MORE else by_day(table, certified))]
        outcomes += [(name, pool.submit(judge_verify, by_name[name])) for name in VERIFIED]
        outcomes += [("abort_in_dh", pool.submit(judge_words, "abort_in_dh"))]
        outcomes += [("prints_without_end", pool.submit(judge_printed, "prints_without_end"))]
        for name, hows in (("table", ("by quadrature", "from w and dw", "by bisection", "by measurement")), ("faulty_NONE", 4 * ("",)),
                           ("wendland_c8", ("by quadrature", "from w and dw", "by bisection", ""))):
            outcomes += [(name, pool.submit(judge_derived, name, hows))]
        if MORE:
            outcomes += [(name, pool.submit(judge_right, name, dim)) for name in RIGHT for dim in "123"]
        for name, outcome in outcomes:
            trouble = outcome.result()
            print("%-24s %s" % (name, trouble or "ok"), flush=True)
            bad += trouble is not None
    if os.path.isdir("/proc/self"):
        def left():
            return [p for line in table for p in processes(module(line[0]))]
        gone = wait_for(lambda: not left()) # a killed process takes a moment to end; plug-ins that stay do not end
        for name, trouble in [("nothing left", None if gone else "left behind: %s" % left()),
                              ("interrupted", judge_interrupt(signal.SIGINT)),
                              ("terminated", judge_interrupt(signal.SIGTERM))]:
            print("%-24s %s" % (name, trouble or "ok"))
            bad += trouble is not None
    print("%d plug-ins, %d wrong verdicts" % (len(outcomes), bad))
    return 1 if bad else 0


sys.exit(main())
