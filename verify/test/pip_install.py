#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests that pip installs the Python module from the tree, without network, and that it finds program and library.

  pip_install.py SOURCE PROGRAM LIBRARY WORK

Exit status 77 (skipped): no venv, pip, setuptools, wheel or numpy, or this build makes no library."""
import os
import re
import shutil
import subprocess
import sys

source, program, library, work = map(os.path.abspath, sys.argv[1:5])
LOOKS = """
import sphproof, sys
assert "site-packages" in sphproof.__file__, sphproof.__file__
print(sphproof._program() if sys.argv[1] != "library" else "")
try:
    print(sphproof._library()._name, sphproof.riemann((1, 0, 1), (0.125, 0, 0.1), [0.0], 0.2).rho[0])
except sphproof.Error as error:
    print(error)
if sys.argv[1] == "run":
    print(sphproof.run("sod", n=64)["n"])
"""


def call(*words, **environment):
    done = subprocess.run(words, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL, env={
        **{key: value for key, value in os.environ.items() if not key.startswith(("SPHPROOF", "PYTHON", "LD_LIBRARY"))}, **environment})
    if done.returncode:
        sys.exit("%s\nexit %d\n%s%s" % (words, done.returncode, done.stdout, done.stderr))
    return done.stdout.splitlines()


def missing():
    for name in ("venv", "ensurepip", "pip", "setuptools", "wheel", "numpy"):
        if subprocess.run([sys.executable, "-c", "import " + name], capture_output=True, check=False).returncode:
            return "%s has no %s (Debian: python3-%s)" % (sys.executable, name, {"ensurepip": "venv"}.get(name, name))
    return None if os.path.exists(library) else "this build has no %s" % library


def main():
    why = missing()
    if why:
        print(why)
        sys.exit(77)
    shutil.rmtree(work, ignore_errors=True)
    shutil.copytree(os.path.join(source, "verify", "python"), os.path.join(work, "python"),
                    ignore=shutil.ignore_patterns("__pycache__", "build", "*.egg-info"))
    venv = os.path.join(work, "venv")
    python = os.path.join(venv, "bin", "python")
    call(sys.executable, "-m", "venv", "--system-site-packages", venv)
    call(python, "-m", "pip", "install", "-q", "--no-index", "--no-build-isolation", os.path.join(work, "python"))
    with open(os.path.join(source, "meson.build"), encoding="utf-8") as file:
        version = re.search(r"version: '([0-9.]+)'", file.read()).group(1)
    said = call(python, "-m", "pip", "show", "sphproof")
    assert "Version: " + version in said, (version, said)  # pyproject.toml and meson.build agree

    prefix = os.path.join(work, "prefix")
    os.makedirs(os.path.join(prefix, "lib", "some-linux"))
    os.makedirs(os.path.join(prefix, "bin"))
    there, beside = os.path.join(prefix, "bin", "sphproof"), os.path.join(prefix, "lib", "some-linux", "libsphproof.so.0")
    shutil.copy(program, there)
    shutil.copy(library, beside)
    os.makedirs(os.path.join(work, "links"))
    os.symlink(there, os.path.join(work, "links", "sphproof"))
    nowhere = {"PATH": "/nowhere"}
    built = os.path.join(os.path.dirname(program), "verify", "package", "libsphproof.so.0")
    for what, environment, finds, loads in (
            ("run", {"PATH": os.path.dirname(there)}, there, beside),  # an installed prefix
            ("run", {"PATH": os.path.join(work, "links")}, os.path.join(work, "links", "sphproof"), beside),
            ("run", {"SPHPROOF": program, **nowhere}, program, built),  # a build folder
            ("run", {"SPHPROOF": program, "SPHPROOF_LIBRARY": beside, **nowhere}, program, beside),
            ("library", {"SPHPROOF_LIBRARY": beside, **nowhere}, "", beside)):
        said = call(python, "-c", LOOKS, what, **environment)
        name, rho = said[1].split()
        assert said[0] == finds and os.path.realpath(name) == os.path.realpath(loads), (environment, said)
        assert 0.125 < float(rho) < 1 and (what != "run" or int(said[2]) == 64), said
    installed = shutil.which("sphproof", path="/usr/bin:/bin")
    if installed is None:  # otherwise a venv would find the system's
        said = call(python, "-c", LOOKS, "library", **nowhere)[1]
        assert "no library libsphproof" in said and "SPHPROOF_LIBRARY" in said or os.path.exists(said.split()[0]), said
    print("pip installs it, and it finds an installed prefix, a build folder and what the environment names")


main()
