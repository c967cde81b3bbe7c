# SPDX-License-Identifier: GPL-3.0-or-later
"""What tests of studies share: the program of sys.argv[1] is called, and faults are collected."""
import json
import os
import subprocess
import sys

program = os.path.abspath(sys.argv[1])
faults = []


def expect(what, well, got=""):
    if not well:
        faults.append("%s: %s" % (what, got))


def study(*words):
    """Exit status, document without its date, what was said."""
    done = subprocess.run([program, *words, "--json", "-"], capture_output=True, text=True, timeout=300)
    document = json.loads(done.stdout) if done.stdout else {}
    document.pop("date", None)
    return done.returncode, document, done.stderr


def without_times(document):
    for level in document.get("levels", ()):
        level.pop("cpu_s", None)
    return document
