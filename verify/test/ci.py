#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""ci.py SOURCE WORK: the examples for CI (verify/examples/ci) work. The steps of GitHub's action and of GitLab's
template run as they would there, with a snapshot whose gate passes and one whose gate fails."""
import os
import re
import shutil
import subprocess
import sys

RUN = "sphproof run sod n=198 --quiet --snapshot out.csv\nsphproof judge out.csv --case sod --gate density_l1=%s"
GATES = {"8e-3": 0, "1e-5": 1}


def shell(command, folder, environment):
    done = subprocess.run(["bash", "-e", "-c", command], cwd=folder, env={**os.environ, **environment}, text=True,
                          capture_output=True, stdin=subprocess.DEVNULL, check=False)
    return done.returncode, done.stdout + done.stderr


def expect(what, got, wanted):
    if got[0] != wanted:
        sys.exit("%s: exit %d instead of %d\n%s" % (what, got[0], wanted, got[1][-3000:]))


def github(text, source, work):
    first, second = re.findall(r"^      run: (.*)$", text, flags=re.M)
    runner = {"RUNNER_TEMP": work, "GITHUB_ACTION_PATH": os.path.join(source, "verify/examples/ci")}
    expect("the action's installation", shell(first, work, runner), 0)
    for gate, status in GATES.items():
        expect("the action with a gate of " + gate, shell(second, work, {**runner, "COMMANDS": RUN % gate}), status)


def gitlab(text, source, work):
    section = text.split("  before_script:\n", 1)[1].split("  artifacts:", 1)[0]
    steps = re.findall(r"^    - (.*)$", section, flags=re.M)
    variables = {"SPHPROOF": source, "CI_PROJECT_DIR": work}
    expect("the template's installation", shell("\n".join(steps[:-1]), work, variables), 0)
    for gate, status in GATES.items():
        expect("the template with a gate of " + gate, shell("\n".join([steps[-1], RUN % gate]), work, variables), status)


def main():
    source, work = sys.argv[1:3]
    if not os.path.exists(os.path.join(source, ".git")):
        print("this tree is no clone, and GitLab's template clones it: not tried")
        sys.exit(77)
    shutil.rmtree(work, ignore_errors=True)
    for name, run in (("action.yml", github), ("sphproof.gitlab-ci.yml", gitlab)):
        folder = os.path.join(work, name.split(".", 1)[0])
        os.makedirs(folder)
        with open(os.path.join(source, "verify/examples/ci", name), encoding="utf-8") as file:
            run(file.read(), source, folder)
        print("%s: installed, a gate that holds passes and one that fails is reported" % name)


main()
