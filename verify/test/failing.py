# SPDX-License-Identifier: GPL-3.0-or-later
"""failing.py SPHPROOF: the output that a user sees for one fault, here a plug-in kernel whose dw is off by 3e-11 in
its outer half."""
import json
import os
import shutil
import subprocess
import sys

from script import expect, play, program, said

wrong = os.path.join(os.path.dirname(program), "verify/examples/faulty_DW_ELEVENTH_DIGIT.so")
first_failure = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../first_failure.py")


def sphproof(*words, what="kernels"):
    return said("verify", what, "--failures", "failures", *words)


def last_words(log, name="testlog.json"):
    """What first_failure prints for a build folder with this test log and nothing else."""
    shutil.rmtree("meson-logs", ignore_errors=True)
    os.makedirs("meson-logs")
    with open(os.path.join("meson-logs", name), "w", encoding="utf-8") as file:
        file.writelines(json.dumps(line) + "\n" for line in log)
    done = subprocess.run([sys.executable, first_failure, "."], capture_output=True, text=True, check=True)
    return done.stdout


def main():
    os.makedirs("verify/test")
    os.makedirs("failures")
    stale = "failures/kernels-sign.svg"
    open(stale, "w", encoding="ascii").close()
    code, out, _ = sphproof("--kernel-plugin", wrong, "--json", "verify/test/kernels.json")
    with open("verify/test/kernels.json", encoding="utf-8") as file:
        document = json.load(file)
    failing = [c for c in document["checks"] if c["status"] == "fail"]
    members = {c["subject"].split(",")[0].split(":")[0] for c in failing}
    headlines = document["failures"]
    expect("one fault, one headline", code == 1 and len(headlines) == len(members) == 1 < len(failing), headlines)
    first = headlines[0]
    expect("the member", first["member"] == "faulty_DW_ELEVENTH_DIGIT", first)
    expect("the cause", "dw is not the derivative of w" in first["headline"] and
           first["check"] == "radial_derivative", first)
    expect("all figures counted", first["figures"] == len(failing), (first["figures"], len(failing)))
    worst = max(c["value"] / c["bound"] for c in failing if c["name"] == "radial_derivative")
    expect("how far", abs(first["ratio"] / worst - 1) < 1e-12 and first["value"] > first["bound"], first)
    expect("where", "dim " in first["place"] and "q 0." in first["place"], first["place"])
    tail = out.split("\n\n")[-1].splitlines()
    expect("printed last", tail[0] == first["headline"] and len(tail) < 8, tail)
    expect("details on demand", sum(" got " in line for line in out.splitlines()) == 1, out)
    expect("what an earlier fault left", not os.path.exists(stale))
    plots = [name for name in os.listdir("failures") if name.endswith(".svg")]
    checks = {c["name"] for c in failing}
    expect("a plot of every failing check", len(plots) == len(checks), plots)
    _, details, _ = sphproof("--kernel-plugin", wrong, "--details", what="kernels/radial_derivative")
    figures = [c for c in failing if c["name"] == "radial_derivative"]
    expect("every figure with --details", sum(" got " in line for line in details.splitlines()) ==
           len(figures) + 1 > 2, details)

    test = {"name": "sphproof:quick / verify kernels", "result": "FAIL", "starttime": 0}
    other = {"name": "sphproof:quick / kernel", "result": "FAIL", "starttime": 0, "stderr": "[  ERROR   ] --- 0x1d != 0"}
    good = dict(other, result="OK")
    last = last_words([good, other, test]).strip().splitlines()
    expect("last lines: what", last[1] == first["headline"], last)
    expect("last lines: how far, where", "times over" in last[2] and first["place"] in last[2], last)
    plot = [line.split(":", 1)[1].strip() for line in last if "plot:" in line]
    expect("last lines: plot", len(plot) == 1 and os.path.getsize(plot[0]) > 1000, last)
    expect("last lines: command", any("./sphproof verify kernels" in line for line in last), last)
    expect("last lines: all that failed", last[-1] == "2 tests failed: kernel, verify kernels", last)
    last = last_words([dict(test, starttime=4e9), other])
    expect("results of an earlier run", first["headline"] not in last and "0x1d != 0" in last and
           "--print-errorlogs" in last, last)
    expect("all well", last_words([good]) == "")
    expect("under a wrapper", "0x1d != 0" in last_words([other], "testlog-valgrind.json"))
    code, out, _ = sphproof("--json", "verify/test/kernels.json")
    with open("verify/test/kernels.json", encoding="utf-8") as file:
        expect("repaired", code == 0 and json.load(file)["failures"] == [] and not os.path.exists("failures"), out)


def everyone_gets_to(folder):
    return os.stat(folder).st_mode & 1 and (folder == "/" or everyone_gets_to(os.path.dirname(folder)))


def test_folder():
    """Data of failures are written beside the program, or in the working folder if that is not possible."""
    os.chmod(".", 0o755)
    for name, mode, nobody in (("own", 0o755, False), ("locked", 0o555, True)):
        if nobody and not everyone_gets_to(os.getcwd()):
            continue  # root ignores the permissions
        os.makedirs(name)
        shutil.copy(program, name + "/sphproof")
        shutil.copy(wrong, name + "/wrong.so")
        os.chmod(name, mode)
        here = name + "-here"
        os.makedirs(here)
        os.chmod(here, 0o777)
        how = {"user": 65534, "group": 65534, "extra_groups": []} if nobody and os.geteuid() == 0 else {}
        done = subprocess.run([os.path.abspath(name + "/sphproof"), "verify", "kernels/radial_derivative", "--quiet",
                               "--kernel-plugin", os.path.abspath(name + "/wrong.so")], cwd=here, **how)
        left = [os.path.isdir(folder + "/failures") for folder in (name, here)]
        expect("failures of a program in a folder %s" % name, done.returncode == 1 and left == [not nobody, nobody],
               (done, left))
        os.chmod(name, 0o755)


play(main, test_folder)
