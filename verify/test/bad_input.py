# SPDX-License-Identifier: GPL-3.0-or-later
"""bad_input.py SPHPROOF: frequent mistakes of users, and the program's answers. Mistakes in case files and keys are
tested in C (run/test_case.c, test_settings.c, test_prepare.c), and those in commands word for word in the
transcripts.

Each line: arguments, exit status, words that the message must contain (what, where, what is allowed). In each case:
one message on standard error, nothing on standard output, no file left behind, no hang."""
import json
import os
import subprocess
import sys
import tempfile

GOOD = """[case]
title = A tube
dimension = 1
reference = riemann
[initial]
kind = riemann
left = 1 0 1
right = 0.125 0 0.1
[run]
t_end = 0.02
n = 40
[measure]
window = -0.5 0.5
"""

FILES = {
    "good.ini": GOOD,
    "crlf.ini": GOOD.replace("\n", "\r\n"),
    "indented.ini": GOOD.replace("\nn = 40", "\n   n = 40"),
    "empty.ini": "",
    "binary.ini": b"[case]\x00\x01\x02\n",
    "type.ini": GOOD.replace("n = 40", "n = many"),
    "bracket.ini": GOOD + "[converge\n",
    "space name.ini": GOOD,
    "some.csv": "x,y,vx,vy,m,u\n0.1,0.2,0,0,1,1\n0.6,0.7,0,0,1,1\n",
    "no_u.csv": "x,y,vx,vy,m\n0.1,0.2,0,0,1\n0.6,0.7,0,0,1\n",
    "massless.csv": "x,vx,m,u\n0.1,0,1,1\n0.6,0,0,1\n",
    "far.csv": "x,y,vx,vy,m,u\n0.1,0.2,0,0,1,1\n1e8,0.7,0,0,1,1\n",
    "theirs.csv": "h,rho\n1,1\n",
}

# arguments, exit status, words of the message
BAD = [
    ("bench sodd", 2, "sodd", "did you mean 'sod'"),
    ("bench sod --n 100,many", 2, "many", "integers"),
    ("bench --kernels --vary eta=2", 2, "eta", "kernel=A,B"),
    ("bench --kernels --skips", 2, "exclude each other"),
    ("bench --scaling n=100", 2, "n", "--n N1,N2"),
    ("bench sod --plot front.jpg", 2, "front.jpg", ".svg"),
    ("", 2, "no command", "--help"),
    ("frobnicate", 2, "frobnicate", "allowed", "run"),
    ("rnu sod", 2, "rnu", "run"),
    ("run", 2, "case", "usage"),
    ("run sodd", 2, "sodd", "did you mean 'sod'"),
    ("run sod --frob", 2, "--frob", "allowed", "--snapshot"),
    ("run sod --jsn x", 2, "--jsn", "did you mean '--json'"),
    ("run sod --json", 2, "--json", "argument"),
    ("run sod --threads two", 2, "--threads", "two", "integer"),
    ("autopsy kelvin_helmholtz", 2, "kelvin_helmholtz", "without jumps"),
    ("autopsy yee --rates nosuch.csv", 2, "nosuch.csv", "cannot be read"),
    ("autopsy yee --plot shares.pdf", 2, "shares.pdf", ".svg"),
    ("autopsy yee --n 10^3,11^3,12^3,13^3", 2, "10^3"),
    ("rates folder.csv lo=0 hi=1", 2, "folder.csv"),
    ("rates some.csv lo=0 hi=one", 2, "hi=one", "one number or 2"),
    ("rates some.csv lo=0 hi=1 eta=2.4", 2, "beyond half the box", "eta"),
    ("rates some.csv lo=0 hi=0.5", 2, "some.csv:3", "x = 0.6", "0 to 0.5"),
    ("rates no_u.csv lo=0 hi=1", 2, "no_u.csv:1", "'u'", "vx"),
    ("rates massless.csv lo=0 hi=1", 2, "massless.csv:3", "m = 0", "above 0"),
    ("rates sod n=60 --check theirs.csv", 2, "theirs.csv", "1 rows", "60"),
    ("run gresho boundary=open", 2, "boundary=open", "along x", "gresho", "periodic reflecting"),
    ("run rest_2d boost=0,1 boundary=periodic,reflecting", 2, "boost=1 along y", "reflecting"),
    ("run sod boundary=open", 2, "boundary=open", "allowed: periodic reflecting"),
    ("run sod gravity=1", 2, "gravity", "dimension=1", "2 and 3"),
    ("run gresho file=nope.csv", 2, "nope.csv", "No such file"),
    ("run gresho file=" + 300 * "x", 2, "file=", "path of a file", "255"),
    ("run gresho file=far.csv n=100", 2, "n", "file=far.csv", "exclude each other"),
    ("run square file=far.csv equal_masses=yes", 2, "equal_masses", "exclude each other"),
    ("run yee equal_masses=yes lattice=square", 2, "lattice=square", "equal_masses=yes", "glass random"),
    ("run rest_2d n=9 lattice=glass", 2, "n=9", "a glass", "half"),
    ("run sod kind=particles", 2, "kind particles", "file = PARTICLES.csv"),
    ("run sedov_3d n=8^3", 2, "n=512", "images", "n >= 10^3", "t_end <= 0.03"),
    ("run sedov_3d n=9^3", 2, "n=729", "images", "n >= 10^3", "t_end <= 0.05"),
    ("run sod kernel=cubic", 2, "cubic", "did you mean 'cubic_spline'", "wendland_c2"),
    ("run sod kernel=cubic_spline eta=1.2", 2, "eta", "1.2", "1.333"),
    ("run sod t_end=1", 2, "t_end", "mirrored tube", "allowed"),
    ("run sod|left=-1 0 1", 2, "left", "-1 0 1", "rho > 0"),
    ("run sod|right=0 0 0", 2, "right", "vacuum"),
    ("run missing.ini", 2, "missing.ini", "No such file"),
    ("run ./folder", 2, "folder", "directory"),
    ("run empty.ini", 2, "empty.ini", "empty"),
    ("run binary.ini", 2, "binary.ini:1", "0x00"),
    ("run type.ini", 2, "type.ini:11", "n=many", "integer"),
    ("run bracket.ini", 2, "bracket.ini:14", "section"),
    ("run /dev/zero.ini", 2, "/dev/zero.ini"),
    ("run sod --plot x.pdf", 2, "x.pdf", ".svg or"),
    ("run sod --snapshot nowhere/s.csv", 4, "nowhere/s.csv", "No such file"),
    ("run sod --snapshot folder", 4, "folder", "directory"),
    ("run sod --json nowhere/r.json", 4, "nowhere/r.json", "No such file"),
    ("run sod cfl=50", 3, "particle", "t ="),
    ("converge sod --n 100,100,100,100", 2, "--n", "1 distinct", "at least 4"),
    ("converge sod --vary n=1,2", 2, "--n"),
    ("converge good.ini", 2, "ladder", "--n"),
    ("run sod --n 400", 2, "'--n' is a key, not an option; write it as n=400"),
    ("judge a.csv --case sod --gate density_l1=1 --gate pressure_l1=1", 2, "--gate is given twice; allowed: once, as NAME=BOUND,..."),
    ("bench sod --steps", 2, "sod has no local steps"),
    ("bench sod --steps --n 100,200", 2, "--n"),
    ("run sod --n=400", 2, "write it as n=400"),
    ("run sod --eta --json -", 2, "write it as eta=VALUE"),
    ("run gresho n=64^3", 2, "n=64^3", "the case has 2 dimensions; allowed: 64^2"),
    ("converge gresho --n 16^3,24^2,32^2,48^2", 2, "--n: 16^3", "allowed: 16^2"),
    ("help nothing", 2, "nothing", "allowed", "kernel"),
]

GOOD_ONES = ["run good.ini", "run ./crlf.ini", "run indented.ini", "run|space name.ini",
             "run sod n=1e2 t_end=1e-2", "run sod n=20 n=30 t_end=0.01", "run --quiet sod n=20",
             "--threads 2 run sod n=20 t_end=.01"]

# words that each call must print on standard output or (notes) on standard error
SAID = [
    ("help run", "usage: sphproof run CASE"),
    ("help", "usage: sphproof COMMAND"),
    ("run gresho n=64 --explain", "about 8 along each side; did you mean n=64^2?"),
    ("run gresho n=64^2 --explain", "3.6 mean spacings, so it holds about 41 neighbours; h/dx = 1.8"),
    ("run noh_3d n=6^3 --explain eta=3", "holds about 113 neighbours"),
    ("run sod n=100 --explain eta=2", "holds about 4 neighbours"),
]
# words that it must not print
UNSAID = [("run gresho n=64^2 --explain", "did you mean"), ("run sod n=64 --explain", "did you mean")]


def words(line):
    """Blanks separate arguments up to the first '|', then each '|' does."""
    head, *rest = line.split("|")
    return head.split() + rest


def call(program, line, folder):
    return subprocess.run([program, *words(line)], capture_output=True, text=True, cwd=folder,
                          stdin=subprocess.DEVNULL, timeout=60, errors="replace")


def judge(program, folder, line, status, needed):
    done = call(program, line, folder)
    if done.returncode != status:
        yield "exit %d, not %d" % (done.returncode, status)
    message = done.stderr.strip()
    for word in needed:
        if word not in message:
            yield "the message does not say %r" % word
    if message.count("\n") > (1 if status == 3 else 0):
        yield "more than one message"
    # a result that cannot be written to one place is still printed to the other
    if done.stdout and "/dev/full" not in line:
        yield "standard output is not empty: %r" % done.stdout[:60]
    if len(message) > 700:
        yield "a message of %d characters" % len(message)
    left = set(os.listdir(folder)) - set(FILES) - {"folder"}
    if left:
        yield "files left behind: %s" % left


def main():
    program, bad = os.path.abspath(sys.argv[1]), 0
    with tempfile.TemporaryDirectory() as folder:
        os.mkdir(os.path.join(folder, "folder"))
        for name, text in FILES.items():
            with open(os.path.join(folder, name), "wb") as file:
                file.write(text if isinstance(text, bytes) else text.encode())
        for line, status, *needed in BAD:
            faults = list(judge(program, folder, line, status, needed))
            for fault in faults:
                print("sphproof %s: %s\n    %s" % (line, fault,
                                                   call(program, line, folder).stderr.strip()))
            bad += bool(faults)
        for line in GOOD_ONES:
            done = call(program, line, folder)
            if done.returncode or (not done.stdout and "quiet" not in line):
                print("sphproof %s: exit %d: %s" % (line, done.returncode, done.stderr))
                bad += 1
        for line, phrase in SAID + UNSAID:
            done = call(program, line, folder)
            if done.returncode or (phrase in done.stdout + done.stderr) != ((line, phrase) in SAID):
                print("sphproof %s: exit %d, %r is %s" % (line, done.returncode, phrase, "missing or unwanted"))
                bad += 1
        families = json.loads(call(program, "list --json -", folder).stdout)["families"]
        named = call(program, "help list", folder).stdout.split("FAMILY: ")[1].split("\n\n")[0].split()
        if named != list(families):
            print("sphproof help list names %s, but the families are %s" % (named, list(families)))
            bad += 1
    print("%d kinds of bad input, %d good ones, %d answered wrongly"
          % (len(BAD), len(GOOD_ONES), bad))
    return bad > 0


sys.exit(main())
