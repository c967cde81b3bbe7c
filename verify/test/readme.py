#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""readme.py keys PROGRAM README      the README's table of keys is the program's
   readme.py stories SOURCE WORK  its stories, run as written in a copy of the tree"""
import os
import shutil
import subprocess
import sys


def keys(program, readme):
    table = subprocess.run([program, "list", "keys", "--markdown"], capture_output=True, text=True,
                           check=True).stdout.strip()
    text = open(readme, encoding="utf-8").read()
    begin, end = "<!-- sphproof list keys --markdown -->\n", "\n<!-- end -->"
    inside = text.split(begin, 1)[1].split(end, 1)[0].strip() if begin in text else ""
    if inside != table:
        sys.exit("README.md: the table of keys differs from `sphproof list keys --markdown`")
    print("the table of keys is the program's")


def stories(source, work):
    tree = os.path.join(work, "tree")
    shutil.rmtree(work, ignore_errors=True)
    shutil.copytree(source, tree, ignore=shutil.ignore_patterns("build*", ".git", "out"))
    subprocess.run(["meson", "setup", "build", "-Dclones=false", "-Doptimization=1", "-Dslow=false"],
                   cwd=tree, check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["ninja", "-C", "build"], cwd=tree, check=True, stdout=subprocess.DEVNULL)
    path = os.path.join(tree, "build") + os.pathsep + os.environ["PATH"]
    text = open(os.path.join(tree, "README.md"), encoding="utf-8").read()
    blocks = [part.split("```", 1)[0] for part in text.split("```sh\n")[1:]]
    commands = [line for block in blocks for line in block.splitlines() if line.strip()]
    if len(commands) < 12:
        sys.exit("README.md: only %d commands in its stories" % len(commands))
    for command in commands:
        wanted = int(command.rsplit("# exit ", 1)[1]) if "# exit " in command else 0
        result = subprocess.run(["sh", "-c", command], cwd=tree, env=dict(os.environ, PATH=path),
                                capture_output=True, text=True, stdin=subprocess.DEVNULL)
        print("%d  %s" % (result.returncode, command), flush=True)
        if result.returncode != wanted:
            sys.exit("exit %d instead of %d\n%s%s" % (result.returncode, wanted,
                                                      result.stdout[-2000:], result.stderr[-2000:]))
    for made in ("sod.svg", "streams.svg"):
        if os.path.getsize(os.path.join(tree, made)) < 1000:
            sys.exit(made + " is empty")


if sys.argv[1] == "keys":
    keys(*sys.argv[2:4])
else:
    stories(*sys.argv[2:4])
