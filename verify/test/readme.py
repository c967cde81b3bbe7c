#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""readme.py keys PROGRAM PAGE        tests that a page's table of keys is the program's
   readme.py scripts PROGRAM SOURCE WORK  tests scripts: they answer wrong options and --help before
                                  anything is built, and pass right ones unchanged to the program,
                                  those of the nightly jobs, too
   readme.py stories SOURCE WORK  runs all commands of all pages in a copy of the tree"""
import fnmatch
import json
import os
import re
import resource
import shlex
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
        sys.exit("the table of keys differs from `sphproof list keys --markdown`")
    # the wrapped text is compared with the document's
    keys_ = json.loads(subprocess.run([program, "list", "keys", "--json", "-"], capture_output=True, text=True,
                                      check=True).stdout)["families"]["keys"]
    said = " ".join(subprocess.run([program, "list", "keys"], capture_output=True, text=True,
                                   check=True).stdout.split())
    whole = subprocess.run([program, "list"], capture_output=True, text=True, check=True).stdout
    whole = whole.split("\nkeys: ")[1].split("\ncode_keys: ")[0].splitlines()[1:]
    if not [k["name"] for k in keys_] == [line.split()[0] for line in whole] == re.findall(r"^\| `?(\w+)", table, flags=re.M)[1:]:
        sys.exit("sphproof list keys: not the same keys in the table, the document and the list of everything")
    helped = subprocess.run([program, "help", "list"], capture_output=True, text=True, check=True).stdout
    whole = json.loads(subprocess.run([program, "list", "--json", "-"], capture_output=True, text=True, check=True).stdout)
    if helped.split("FAMILY: ")[1].split("\n\n")[0].split() != list(whole["families"]):
        sys.exit("sphproof help list: other families than those of its document")
    for key in keys_:
        if " ".join(key["label"].split()) not in said or "| %s | %s |" % (key["allowed"], key["label"]) not in table:
            sys.exit("sphproof list keys: what %s means is cut" % key["name"])
    print("the table of keys is the program's")


# The pages whose blocks of commands are run, in this order. Commands within sentences are run as well, except those of
# cases/README.md, which another test measures.
PAGES = ("README.md", "cases/README.md", "src/README.md", "verify/README.md", "reports/README.md")


def pages(folder, names=PAGES):
    return "\n".join(open(os.path.join(folder, name), encoding="utf-8").read() for name in names)


# Replacements for words in capitals in commands; None: another test runs the command.
PLACES = {
    "sphproof COMMAND --help": "sphproof run --help",
    "sphproof converge sod kernel=cubic_spline eta=4.8":
        "sphproof converge sod kernel=cubic_spline eta=4.8  # exit 1",  # its gate is not for this scheme
    "sphproof run CASE": "sphproof run sod",
    "sphproof verify GROUP": "sphproof verify kernels",
    "sphproof verify --mutants": "sphproof verify norms --mutants",  # the quick suite runs all groups
    "sphproof run CASE n=64^2": "sphproof run gresho n=24^2 t_end=0.1",
    "sphproof diff OLD.json NEW.json": "sphproof run sod --json try/a.json; sphproof diff try/a.json try/a.json",
    "sphproof kernel ./mine.so --dim 3":
        "cc -shared -fPIC -O2 -Isrc/include/sphproof -o try/mine.so verify/examples/wendland_c8.c -lm && "
        "sphproof kernel try/mine.so --dim 3",
    "sphproof converge sod kernel=./mine.so":
        "sphproof converge sod kernel=./try/mine.so --n 100,200,300,400  # exit 1",  # gates of another kernel
    "sphproof gradient cloud.csv --operator ia --kernel wendland_c2 --dim 2 --eta 2":
        "printf 'x,y,volume,f\\n0,0,1,2\\n1,0,1,3\\n0,1,1,4\\n1,1,1,5\\n' >try/cloud.csv; "
        "sphproof gradient try/cloud.csv --operator ia --kernel wendland_c2 --dim 2 --eta 2",
    "sphproof rates particles.csv lo=0 hi=1 --check theirs.csv":
        "printf 'x,vx,m,u\\n0.1,0,1,1\\n0.4,0,1,1\\n0.6,0,1,1\\n0.9,0,1,1\\n' >try/particles.csv; "
        "sphproof rates try/particles.csv lo=0 hi=1 --csv try/theirs.csv; "
        "sphproof rates try/particles.csv lo=0 hi=1 --check try/theirs.csv",
    "sphproof autopsy yee": "sphproof autopsy yee --n 16^2,24^2,32^2,48^2 t_end=0.5",
    "sphproof bench --kernels": "sphproof bench --kernels --vary kernel=cubic_spline --samples 1",
    "sphproof report --code swift.ini --code pysph.ini --out page": None,  # tests `small codes`, `PySPH`
    "python3 verify/test/faults.py build/sphproof PART": None,  # test `faults`
    "reports/run": None, "reports/run --nightly": None, "reports/compare main": None,  # tests `README: scripts`, `reports/compare`
    "verify/run --only valgrind,threads": None, "verify/run --full": None, "verify/run --nightly": None,
}


def inline(text):
    """The commands within the text's sentences."""
    found = []
    text = re.sub(r"```.*?```", "", text, flags=re.S)
    for span in re.findall(r"`([^`]+)`", text):
        span = " ".join(span.split())
        if re.fullmatch(r"sphproof \w+", span):
            span += " --help"  # the name of a command
        if not re.match(r"(sphproof |reports/\w+ |reports/run$|verify/run|python3 )", span) or span == "verify/run":
            continue
        command = PLACES.get(span, span)
        if span not in PLACES and re.search(r"\b[A-Z]{3,}\b", span):
            sys.exit("README: what stands for the words in capitals of `%s`? Tell readme.py" % span)
        if command and command not in found:
            found.append(command)
    if len(found) < 8:
        sys.exit("README: only %d commands in the text" % len(found))
    return found


def job(text):
    """The commands of the job in YAML."""
    yaml = text.split("```yaml\n", 1)[1].split("```", 1)[0]
    return [line.split("run:", 1)[1].strip() for line in yaml.splitlines() if re.search(r"\brun: ", line)]


def stub(path, text):
    with open(path, "w", encoding="utf-8") as file:
        file.write("#!/bin/sh\n" + text)
    os.chmod(path, 0o755)


def scripts(program, source, work):
    shutil.rmtree(work, ignore_errors=True)
    folder = os.path.join(work, "build")
    os.makedirs(os.path.join(work, "bin"))
    environment = dict(os.environ, BUILD=folder, PATH=os.path.join(work, "bin") + os.pathsep + os.environ["PATH"])

    def run(command):
        result = subprocess.run(["sh", "-c", command], cwd=work, env=environment, capture_output=True, text=True,
                                stdin=subprocess.DEVNULL, check=False)
        return result.returncode, result.stdout, result.stderr

    def in_source(command):
        return re.sub(r"(?<![\w/])(reports|verify)/(run|compare)", shlex.quote(source) + r"/\1/\2", command)

    wrong = {"reports/run": ["--bogus", "--out a --out=b", "--out", "word", "--quick --nightly", "--resume --force"],
             "verify/run": ["--bogus", "--full --bogus", "--full --nightly", "word", "--only", "--only bogus",
                            "--only gcc,bogus", "--full --only gcc", "--only gcc --nightly"],
             "reports/compare": ["HEAD --bogus", "HEAD HEAD", "HEAD --threshold", "no-such-revision"]}
    for script, lines in wrong.items():
        for line in lines:
            code, out, said = run(in_source(script) + " " + line)
            if code != 2 or out or not said or os.path.exists(folder):
                sys.exit("%s %s: exit %d\n%s%s" % (script, line, code, out, said))
        for line in ("--help", "-h"):
            code, out, said = run(in_source(script) + " " + line)
            if code or script not in out or said or os.path.exists(folder):
                sys.exit("%s %s: exit %d\n%s%s" % (script, line, code, out, said))
    # the "built" program prints its arguments; nothing is compiled
    os.makedirs(folder)
    for name in ("meson", "ninja", "python3"):
        stub(os.path.join(work, "bin", name), "exit 0\n")
    stub(os.path.join(folder, "sphproof"), "printf '%%s\\n' \"$@\" >%s/words\n" % shlex.quote(work))
    text = pages(source, ["reports/README.md"])
    cron = re.search(r"^    15 3 .*(reports/run.*)$", text, flags=re.M).group(1)
    known = subprocess.run([program, "report", "--help"], capture_output=True, text=True, check=True).stdout
    for line in [c for c in job(text) if "reports/run" in c] + [cron, "reports/run --out=a", "reports/run --out a",
                                                                "reports/run", "reports/run --jobs --out"]:
        code, out, said = run("mkdir -p a nights/report; touch nights/report/faults.json a/faults.json; " +
                              in_source(line).replace("--nightly", "--nightly --out nights/report"
                                                      if "--out" not in line else "--nightly"))
        if not os.path.exists(os.path.join(work, "words")):
            sys.exit("%s: exit %d, the program was not called\n%s%s" % (line, code, out, said))
        words = open(os.path.join(work, "words"), encoding="utf-8").read().split("\n")[:-1]
        options = [word for before, word in zip(words, words[1:]) if word.startswith("--") and before != "--jobs"]
        if code or len(options) != len(set(options)) or options.count("--out") != 1:
            sys.exit("%s: exit %d, the program got %s\n%s%s" % (line, code, words, out, said))
        for option in options:
            if option not in known:
                sys.exit("%s: `sphproof report` knows no %s" % (line, option))
        if "--out" in line and "jobs" not in line and words[words.index("--out") + 1] not in line:
            sys.exit("%s: the folder is %s" % (line, words))
    print("scripts are right")


def cpu():
    """CPU time of all commands that have ended, in s."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def stories(source, work):
    tree = os.path.join(work, "tree")
    shutil.rmtree(work, ignore_errors=True)
    shutil.copytree(source, tree, ignore=shutil.ignore_patterns("build*", ".git", "out"))
    # the same folder and options as in a tree, so that ccache finds the objects
    subprocess.run(["meson", "setup", "build", "-Dtests=false"], cwd=tree, check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["ninja", "-C", "build"], cwd=tree, check=True, stdout=subprocess.DEVNULL)
    print("  %6.1f s  the build" % cpu())
    environment = dict(os.environ, PATH=os.path.join(tree, "build") + os.pathsep + os.environ["PATH"])
    text = pages(tree)
    blocks = [part.split("```", 1)[0] for part in text.split("```sh\n")[1:]]
    commands = [line for block in blocks for line in block.splitlines() if line.strip()]
    if len(commands) < 12:
        sys.exit("README: only %d commands in the stories" % len(commands))
    commands += inline(pages(tree, [name for name in PAGES if "cases" not in name]))
    # a small share of the job's report: the test `report` makes the whole one and its summary
    commands += [command.replace("--nightly", "--quick --shard 7/60") for command in job(text)
                 if command.startswith("reports/run")]
    for command in commands:
        wanted = int(command.rsplit("# exit ", 1)[1]) if "# exit " in command else 0
        began = cpu()
        result = subprocess.run(["sh", "-c", command], cwd=tree, env=environment,
                                capture_output=True, text=True, stdin=subprocess.DEVNULL)
        print("%d %6.1f s  %s" % (result.returncode, cpu() - began, command), flush=True)
        if result.returncode != wanted:
            sys.exit("exit %d instead of %d\n%s%s" % (result.returncode, wanted,
                                                      result.stdout[-2000:], result.stderr[-2000:]))
        if "first bad commit" in command and "    step 6" not in result.stdout.splitlines():
            sys.exit("the bisection does not find step 6:\n" + result.stdout)
    for made in ("sod.svg", "streams.svg"):
        if os.path.getsize(os.path.join(tree, "try", made)) < 1000:
            sys.exit(made + " is empty")
    with open(os.path.join(tree, ".gitignore"), encoding="ascii") as file:
        ignored = [line.strip().strip("/") for line in file]
    left = [name for name in os.listdir(tree) if name not in os.listdir(source) and
            not any(fnmatch.fnmatch(name, pattern) for pattern in ignored)]
    if left:
        sys.exit("the stories leave behind what git does not ignore: %s" % ", ".join(left))
    if not os.listdir(os.path.join(tree, "nights", "report", "cache")):
        sys.exit("the job's report has computed nothing")


if sys.argv[1] == "keys":
    keys(*sys.argv[2:4])
elif sys.argv[1] == "scripts":
    scripts(*sys.argv[2:5])
else:
    stories(*sys.argv[2:4])
