# SPDX-License-Identifier: GPL-3.0-or-later
"""Functions shared by scripts that test the program of sys.argv[1] from outside: calls of it, files, failed
expectations."""
import json
import os
import subprocess
import sys
import tempfile

program = os.path.abspath(sys.argv[1])
faults = []


def expect(what, well, got=""):
    if not well:
        faults.append("%s: %s" % (what, got))


def check(good, *what):
    expect(" ".join(map(str, what)), good)


def call(*words, status=None, **how):
    """Runs the program to its end; it must have this status."""
    done = subprocess.run([program, *words], **{"capture_output": True, "text": True, "timeout": 300, "stdin": subprocess.DEVNULL, **how})
    assert status is None or done.returncode == status, (words, done)
    return done


def said(*words, **how):
    """Exit status, standard output and standard error."""
    done = call(*words, **how)
    return done.returncode, done.stdout, done.stderr


def json_of(*words, status=0, **how):
    return json.loads(call(*words, "--json", "-", status=status, **how).stdout)


def write(path, text):
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def read(path):
    with open(path, encoding="utf-8", errors="surrogateescape") as file:
        return file.read()


def play(*acts):
    """Runs the tests in turn, in an empty folder, and ends the script."""
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for act in acts:
            act()
        os.chdir("/")
    print("\n".join(faults) or "all is as expected")
    sys.exit(bool(faults))
