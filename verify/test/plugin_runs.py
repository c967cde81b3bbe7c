#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""plugin_runs.py PROGRAM [FOLDER [all]]: plug-in kernels in runs. A copy of the cubic spline gives the figures of the
built-in one to round-off, in every command that names a kernel; a wrong one is refused with its certificate; one that
crashes, ends its process or does not return is reported as an error, and leaves no process. FOLDER: of the plug-ins;
without it, those built beside PROGRAM."""
import csv
import json
import os
import signal
import subprocess
import sys
import time

from script import check, play, program, said

FOLDER = os.path.abspath(sys.argv[2]) if sys.argv[2:] else os.path.join(os.path.dirname(program), "verify/examples")
ALL = sys.argv[3:] == ["all"]
COPY = os.path.join(FOLDER, "cubic_copy.so")


def figures(document):
    """All numbers of a document except costs."""
    if isinstance(document, dict):
        return [f for k in sorted(document) if k not in ("cost", "machine", "cpu_s", "wall_s")
                for f in figures(document[k])]
    if isinstance(document, list):
        return [f for d in document for f in figures(d)]
    return [document] if isinstance(document, float) else []


def far(a, b):
    """Largest difference over the largest value."""
    size = max(abs(y) for y in b)
    return max(abs(x - y) for x, y in zip(a, b)) / size if len(a) == len(b) and size > 0 else float("inf")


def same_rates(*words):
    """Compares every column of every particle: to 1e-11 of the largest value."""
    tables = []
    for kernel in COPY, "cubic_spline":
        path = "rates.csv"
        code, _, err = said("rates", *words, "kernel=" + kernel, "--csv", path, "--quiet")
        check(code == 0, "rates", words, kernel, err)
        with open(path) as f:
            rows = list(csv.DictReader(f))
        tables.append({c: [float(r[c]) for r in rows] for c in rows[0]})
    for column in tables[1]:
        if any(tables[1][column]):
            worst = far(tables[0][column], tables[1][column])
            check(worst <= 1e-11, "rates", *words, column, "differ by", worst)


def same_document(bound, *words, option=None):
    documents = []
    for kernel in COPY, "cubic_spline":
        named = ["--kernel", kernel] if option else ["kernel=" + kernel]
        code, out, err = said(*words, *named, "--json", "-")
        check(code in (0, 1), words, kernel, err)
        documents.append(json.loads(out) if out else {})
    a, b = figures(documents[0]), figures(documents[1])
    # each relative to itself, or to 1e-4 if it is smaller
    worst = max(abs(x - y) / max(abs(y), 1e-4) for x, y in zip(a, b)) if len(a) == len(b) > 0 else float("inf")
    check(worst <= bound, *words, "differ by", worst)
    return documents[0]


def refused(status, words, *arguments, lasting=60):
    began = time.monotonic()
    code, out, err = said(*arguments)
    check(code == status and not out and words in err and err.count("\n") == 1, *arguments, "ends with", code,
          "and says", repr(out[:200]), repr(err[:300]), "not", repr(words))
    check(time.monotonic() - began < lasting, *arguments, "takes", time.monotonic() - began, "s")


def nothing_left(name):
    for pid in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open("/proc/%s/cmdline" % pid, "rb") as f:
                words = f.read()
        except OSError:
            continue
        check(not (name.encode() in words and int(pid) != os.getpid() and program.encode() in words),
              "process", pid, "of", name, "is left")


def interrupted():
    """Ctrl-C ends the run and the process that watches it with the signal."""
    p = subprocess.Popen([program, "run", "sod", "n=100000", "kernel=" + COPY], stdout=subprocess.DEVNULL,
                         stderr=subprocess.PIPE, preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
    time.sleep(1)
    p.send_signal(signal.SIGINT)
    check(p.wait(60) == -signal.SIGINT and not p.stderr.read(), "interrupt", p.returncode)
    nothing_left("n=100000")


def is_there(path):
    return sys.argv[2:] or os.path.exists(path)


def by_day():
    wrong, crashes = (os.path.join(FOLDER, "%s.so" % n) for n in ("faulty_CONSTANT_SEVENTH_DIGIT", "cubic_crashes"))
    if is_there(wrong):
        refused(1, "checks that fail: normalisation", "run", "sod", "n=50", "kernel=" + wrong, "--json", "-")
        code, out, err = said("run", "sod", "n=50", "kernel=" + wrong, "--uncertified", "--json", "-")
        check(code == 0 and out and "although its certificate is refused" in err, "--uncertified", code, err)
    if is_there(crashes):
        refused(1, "crashes (Aborted) in sphproof_kernel_w(", "run", "sod", "n=400", "--json", "-", "kernel=" + crashes)
    if not is_there(COPY):
        return
    same_document(1e-9, "run", "sod", "n=100", "gradient=ia")
    same_rates("yee", "n=256", "gradient=ia", "lattice=jittered")
    same_rates("sound_wave_3d", "n=512", "gradient=standard", "lattice=jittered")
    refused(2, "No such file", "run", "sod", "kernel=./no_such_kernel.so")
    refused(2, "its content is", "run", "sod", "kernel=%s@0123456789abcdef" % COPY)


def by_night():
    for gradient in "standard", "ia":
        for words in (["sod", "n=200"], ["yee", "n=256", "lattice=jittered"], ["sound_wave_3d", "n=512", "lattice=jittered"]):
            same_rates(*words, "gradient=" + gradient)
    same_document(1e-8, "run", "sound_wave_2d", "n=256", "t_end=0.1")
    same_document(1e-4, "converge", "sound_wave", "--n", "16,24,32,48", "--replicates", "1")
    cloud = "cloud.csv"
    with open(cloud, "w") as f:
        f.write("x,y,volume,f\n")
        for i in range(100):
            f.write("%g,%g,0.01,%g\n" % (i % 10 / 10 + 0.01 * (i * 7 % 5), i // 10 / 10, (i * 13 % 17)))
    for operator in "standard", "ia", "linear_exact":
        same_document(1e-11, "gradient", cloud, "--operator", operator, "--dim", "2", "--eta", "2.4", option=True)
    snapshot = "end.csv"
    said("run", "sod", "n=200", "kernel=cubic_spline", "eta=2.5", "--snapshot", snapshot)
    judged = same_document(1e-7, "judge", snapshot, "--case", "sod", "--time", "0.2", option=True)
    check(judged["kernel"]["name"].startswith(COPY + "@"), "judge names the kernel", judged["kernel"])
    # a document names the kernel with its checksum, and the command line accepts this name
    code, out, _ = said("run", "sod", "n=50", "kernel=" + COPY, "--json", "-")
    name = json.loads(out)["settings"]["kernel"]
    check(name.startswith(COPY + "@") and said("run", "sod", "n=50", "kernel=" + name)[0] == 0, "name", name)
    # in a case file, and with --vary
    case = "./mine.ini"
    with open(case, "w") as f:
        f.write("[case]\ntitle = mine\ndimension = 1\nreference = riemann\n[initial]\nkind = riemann\nleft = 1 0 1\n"
                "right = 0.125 0 0.1\n[scheme]\nkernel = %s\n[run]\nt_end = 0.1\n" % COPY)
    code, out, err = said("run", case, "n=50", "--json", "-")
    check(code == 0 and json.loads(out)["settings"]["kernel"] == name, "case file", err)
    code, out, err = said("bench", "sod", "--vary", "kernel=cubic_spline," + COPY, "--n", "20,40", "t_end=0.05",
                          "--time", "1e-5", "--samples", "2", "--json", "-")
    check(code == 0 and name in out, "bench", code, err[-300:])
    # harmful kernels
    wrong = os.path.join(FOLDER, "faulty_CONSTANT_SEVENTH_DIGIT.so")
    refused(1, "is refused", "converge", "sod", "--n", "20,30,40,50", "--vary", "kernel=cubic_spline," + wrong)
    refused(2, "no function sphproof_kernel_dw", "run", "sod", "kernel=" + os.path.join(FOLDER, "gaussian_without_dw.so"))
    refused(1, "refused: it crashes", "run", "sod", "kernel=" + os.path.join(FOLDER, "hostile_abort_late.so"))
    for name, words in (("exits", "ends its process (exit status 0) in sphproof_kernel_w("),
                        ("loops", "has not come back for 5 s: stands in sphproof_kernel_w("),
                        ("sleeps", "has not come back for 5 s: stands in sphproof_kernel_w(")):
        path = os.path.join(FOLDER, "cubic_%s.so" % name)
        refused(1, words, "run", "sod", "n=400", "--json", "-", "kernel=" + path)
        nothing_left(path)
    refused(1, "crashes (Aborted)", "run", "sod_2d", "n=2000", "--threads", "2", "--json", "-",
            "kernel=" + os.path.join(FOLDER, "cubic_crashes.so"))
    code, out, err = said("converge", "sod", "--n", "100,200,300,400", "--replicates", "1", "--jobs", "2", "--json", "-",
                          "kernel=" + os.path.join(FOLDER, "cubic_crashes.so"))
    check(code == 1 and "crashes or ends its process" in err, "converge", code, err[-300:])
    interrupted()


play(by_night if ALL else by_day)
