# SPDX-License-Identifier: GPL-3.0-or-later
"""bad_input.py SPHPROOF: what a stranger gets wrong, and what the program answers. (More of it, word for
word: the transcripts.)

Each line: arguments, exit status, words that the message must contain (what, where, what is
allowed). Always: one message on standard error, nothing on standard output, no file left behind,
no hang."""
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
    "comment.ini": "; nothing here\n",
    "binary.ini": b"[case]\x00\x01\x02\n",
    "nonascii.ini": GOOD.replace("A tube", "Une \u00e9tude").encode(),
    "bom.ini": b"\xef\xbb\xbf" + GOOD.encode(),
    "huge.ini": "; padding padding padding\n" * 40000,
    "longline.ini": GOOD + "; " + "x" * 60000 + "\n",
    "cutline.ini": GOOD.replace("window =", "window = -0.5 0.5" + " " * 170 + "\nwindow ="),
    "duplicate.ini": GOOD.replace("n = 40", "n = 40\nn = 50"),
    "unknown.ini": GOOD.replace("n = 40", "nn = 40"),
    "misplaced.ini": GOOD.replace("n = 40", "eta = 2"),
    "section.ini": GOOD.replace("[run]", "[rum]"),
    "outside.ini": "n = 4\n" + GOOD,
    "type.ini": GOOD.replace("n = 40", "n = many"),
    "range.ini": GOOD.replace("n = 40", "n = 2"),
    "nokey.ini": GOOD.replace("t_end = 0.02\n", ""),
    "noise.ini": GOOD.replace("n = 40", "forty particles"),
    "state.ini": GOOD.replace("1 0 1", "1 0"),
    "reference.ini": GOOD.replace("reference = riemann", "reference = simple_wave"),
    "dimension.ini": GOOD.replace("dimension = 1", "dimension = 4"),
    "foreign.ini": GOOD.replace("kind = riemann", "kind = riemann\nwaves = 2"),
    "gate.ini": GOOD + "[converge]\ndensity_l1 = 1.1 0.9 1\n",
    "known.ini": GOOD + "[converge]\ndensity_l1 = 0.9 1.1 1 known:\n",
    "known2.ini": GOOD + "[converge]\ndensity_l1 = 0.9 known: it is so\n",
    "ladder.ini": GOOD + "[converge]\nn = 100 200 400\n",
    "field.ini": GOOD + "fields = density presure\n",
    "bracket.ini": GOOD + "[converge\n",
    "space name.ini": GOOD,
    "some.csv": "x,y,vx,vy,m,u\n0.1,0.2,0,0,1,1\n0.6,0.7,0,0,1,1\n",
    "no_u.csv": "x,y,vx,vy,m\n0.1,0.2,0,0,1\n0.6,0.7,0,0,1\n",
    "no_y.csv": "x,z,vx,vy,vz,m,u\n0.1,0.2,0,0,0,1,1\n0.6,0.7,0,0,0,1,1\n",
    "no_vy.csv": "x,y,vx,m,u\n0.1,0.2,0,1,1\n0.6,0.7,0,1,1\n",
    "massless.csv": "x,vx,m,u\n0.1,0,1,1\n0.6,0,0,1\n",
    "cold.csv": "x,vx,m,u\n0.1,0,1,1\n\n0.6,0,1,-1\n",
    "one.csv": "x,vx,m,u\n0.1,0,1,1\n",
    "far.csv": "x,y,vx,vy,m,u\n0.1,0.2,0,0,1,1\n1e8,0.7,0,0,1,1\n",
    "theirs.csv": "h,rho\n1,1\n",
    "other.csv": "density\n1\n1\n",
}

# arguments, exit status, words of the message
BAD = [
    ("bench sodd", 2, "sodd", "did you mean 'sod'"),
    ("bench sod --n 100,many", 2, "many", "integers"),
    ("bench sod --vary kernels", 2, "kernels", "did you mean 'kernel'"),
    ("bench sod --n 40 --vary eta=0.5,0.7", 2, "no combination", "eta"),
    ("bench --kernels --vary eta=2", 2, "eta", "kernel=A,B"),
    ("bench --kernels --skips", 2, "exclude each other"),
    ("bench --skips sodd", 2, "sodd", "did you mean 'sod'"),
    ("bench --scaling --n 3", 2, "--n", "from 4"),
    ("bench --scaling n=100", 2, "n", "--n N1,N2"),
    ("bench sod --samples 1e9", 2, "--samples", "1 to"),
    ("bench sod --plot front.jpg", 2, "front.jpg", ".svg"),
    ("", 2, "no command", "--help"),
    ("frobnicate", 2, "frobnicate", "allowed", "run"),
    ("rnu sod", 2, "rnu", "run"),
    ("run", 2, "case", "usage"),
    ("run nope", 2, "nope", "allowed", "sod"),
    ("run sodd", 2, "sodd", "did you mean 'sod'"),
    ("run sod --frob", 2, "--frob", "allowed", "--snapshot"),
    ("run sod --jsn x", 2, "--jsn", "did you mean '--json'"),
    ("run sod --json", 2, "--json", "argument"),
    ("run sod -x", 2, "-x", "allowed"),
    ("run sod --quiet=3", 2, "--quiet", "no argument"),
    ("run sod --threads 0", 2, "--threads", "0", "1 to"),
    ("run sod --threads two", 2, "--threads", "two", "integer"),
    ("run sod --color blue", 2, "--color", "blue", "always"),
    ("run sod n", 2, "n", "KEY=VALUE"),
    ("run sod nn=5", 2, "nn", "allowed"),
    ("autopsy kelvin_helmholtz", 2, "kelvin_helmholtz", "without jumps"),
    ("autopsy yee n=100", 2, "the key n and a ladder", "--n"),
    ("autopsy yee --rates nosuch.csv", 2, "nosuch.csv", "cannot be read"),
    ("autopsy yee --plot shares.pdf", 2, "shares.pdf", ".svg"),
    ("autopsy yee --n 10^3,11^3,12^3,13^3", 2, "10^3"),
    ("rates folder.csv lo=0 hi=1", 2, "folder.csv"),
    ("rates some.csv lo=0 hi=one", 2, "hi=one", "one number or 2"),
    ("rates some.csv|lo=0 0 0|hi=1", 2, "lo=0 0 0", "one number or 2"),
    ("rates some.csv lo=0 hi=1 kernel=cubic", 2, "cubic", "did you mean 'cubic_spline'"),
    ("rates some.csv lo=0 hi=1 eta=2.4", 2, "beyond half the box", "eta"),
    ("rates some.csv lo=0 hi=0.5", 2, "some.csv:3", "x = 0.6", "0 to 0.5"),
    ("rates far.csv lo=0 hi=1", 2, "far.csv:3", "x = 100000000"),
    ("rates no_u.csv lo=0 hi=1", 2, "no_u.csv:1", "'u'", "vx"),
    ("rates no_y.csv lo=0 hi=1", 2, "no_y.csv:1", "'y'"),
    ("rates no_vy.csv lo=0 hi=1", 2, "no_vy.csv:1", "'vy'"),
    ("rates massless.csv lo=0 hi=1", 2, "massless.csv:3", "m = 0", "above 0"),
    ("rates cold.csv lo=0 hi=1", 2, "cold.csv:4", "u = -1", "above 0"),
    ("rates one.csv lo=0 hi=1", 2, "one.csv", "1 particles", "2 or more"),
    ("rates sod n=60 --check theirs.csv", 2, "theirs.csv", "1 rows", "60"),
    ("rates massless.csv lo=0 hi=1 --check other.csv", 2, "massless.csv:3"),
    ("run gresho boundary=open", 2, "boundary=open", "along x", "gresho", "periodic reflecting"),
    ("run rest_2d boundary=fixd", 2, "fixd", "did you mean 'fixed'"),
    ("run rest_2d boundary=fixed,fixed,fixed", 2, "boundary", "one word", "has 2"),
    ("run rest_2d|boundary=fixed fixed fixed fixed", 2, "boundary", "1, 2 or 3 of", "fixed"),
    ("run rest_2d boundary=", 2, "boundary", "1, 2 or 3 of"),
    ("run rest_2d boost=0,1 boundary=periodic,reflecting", 2, "boost=1 along y", "reflecting"),
    ("run rest_2d gravity=0,-1", 2, "gravity=-1 along y", "rest"),
    ("run rest_2d gravity=0,0,1", 2, "gravity", "one number", "has 2"),
    ("run sod boundary=open", 2, "boundary=open", "allowed: periodic reflecting"),
    ("run sod gravity=1", 2, "gravity", "dimension=1", "2 and 3"),
    ("run gresho file=far.csv", 2, "far.csv:3", "x = 100000000", "0 to 1"),
    ("run gresho file=no_vy.csv", 2, "no_vy.csv:1", "'vy'"),
    ("run gresho file=cold.csv", 2, "cold.csv:4", "u = -1", "above 0"),
    ("run gresho file=massless.csv", 2, "massless.csv:3", "m = 0", "above 0"),
    ("run rest_3d file=far.csv", 2, "far.csv:1", "2D", "dimension = 3"),
    ("run gresho file=nope.csv", 2, "nope.csv", "No such file"),
    ("run gresho file=" + 300 * "x", 2, "file=", "path of a file", "255"),
    ("run gresho file=far.csv n=100", 2, "n", "file=far.csv", "exclude each other"),
    ("run square file=far.csv equal_masses=yes", 2, "equal_masses", "exclude each other"),
    ("run rest_2d boundary=fixed file=some.csv", 2, "some.csv:1", "'rho'", "boundary=fixed"),
    ("run yee equal_masses=yes lattice=square", 2, "lattice=square", "equal_masses=yes", "glass random"),
    ("run rest_2d n=9 lattice=glass", 2, "n=9", "a glass", "half"),
    ("run sod lattice=glass", 2, "lattice=glass", "1 dimension"),
    ("run sod kind=particles", 2, "kind particles", "file = PARTICLES.csv"),
    ("run sedov_3d n=8^3", 2, "n=512", "images", "n >= 10^3", "t_end <= 0.03"),
    ("run sedov_3d n=9^3", 2, "n=729", "images", "n >= 10^3", "t_end <= 0.05"),
    ("run sod kernal=cubic_spline", 2, "kernal", "did you mean 'kernel'"),
    ("run sod kernel=cubic", 2, "cubic", "did you mean 'cubic_spline'", "wendland_c2"),
    ("run sod kernel=", 2, "kernel", "allowed"),
    ("run sod gradient=best", 2, "best", "standard ia"),
    ("run sod integrator=rk4", 2, "rk4", "rk3"),
    ("run sod viscosity=some", 2, "some", "constant"),
    ("run sod n=0", 2, "n=0", "from 4"),
    ("run sod n=-5", 2, "n=-5", "from 4"),
    ("run sod n=1000000000000", 2, "n=1000000000000", "to 10000000"),
    ("run sod n=1e3x", 2, "n=1e3x", "integer"),
    ("run sod n=0x40", 2, "n=0x40", "integer"),
    ("run sod n=10.5", 2, "n=10.5", "integer"),
    ("run sod n=", 2, "n=", "integer"),
    ("run sod eta=0", 2, "eta=0", "above 0"),
    ("run sod eta=nan", 2, "eta=nan", "number"),
    ("run sod kernel=cubic_spline eta=1.2", 2, "eta", "1.2", "1.333"),
    ("run sod cfl=0", 2, "cfl=0", "above 0"),
    ("run sod cfl=-0.1", 2, "cfl=-0.1", "above 0"),
    ("run sod gamma=1", 2, "gamma=1", "above 1"),
    ("run sod gamma=0.9", 2, "gamma=0.9", "above 1"),
    ("run sod t_end=inf", 2, "t_end=inf", "number"),
    ("run sod t_end=-1", 2, "t_end=-1", "from 0"),
    ("run sod t_end=1", 2, "t_end", "mirrored tube", "allowed"),
    ("run sod|left=-1 0 1", 2, "left", "-1 0 1", "rho > 0"),
    ("run sod|left=1 0", 2, "left", "1 0", "3 numbers"),
    ("run sod|left=1 0 1 1", 2, "left", "3 numbers"),
    ("run sod|left=1 0 0", 2, "left", "P > 0"),
    ("run sod|right=0 0 0", 2, "right", "vacuum"),
    ("run sod alpha=-1", 2, "alpha=-1", "from 0"),
    ("run sod jitter=0.5", 2, "jitter=0.5", "to 0.49"),
    ("run sod sinc_n=2", 2, "sinc_n=2", "from 3 to 12"),
    ("run sod waves=2", 2, "waves", "riemann", "exclude"),
    ("run sod lo=1 hi=-1", 2, "lo", "hi"),
    ("run sod|window=0.5 -0.5", 2, "window", "rising"),
    ("run sod pair_width=max formulation=lagrangian", 2, "pair_width", "lagrangian", "exclude"),
    ("run sound_wave left=1", 2, "left"),
    ("run missing.ini", 2, "missing.ini", "No such file"),
    ("run ./folder", 2, "folder", "directory"),
    ("run empty.ini", 2, "empty.ini", "empty"),
    ("run comment.ini", 2, "comment.ini", "missing", "title"),
    ("run binary.ini", 2, "binary.ini:1", "0x00"),
    ("run nonascii.ini", 2, "nonascii.ini:2", "ASCII"),
    ("run bom.ini", 2, "bom.ini:1", "0xef"),
    ("run huge.ini", 2, "huge.ini", "64 KiB"),
    ("run longline.ini", 2, "longline.ini:14", "180"),
    ("run cutline.ini", 2, "cutline.ini:13", "180"),
    ("run duplicate.ini", 2, "duplicate.ini:12", "twice", "line 11"),
    ("run unknown.ini", 2, "unknown.ini:11", "nn", "allowed"),
    ("run misplaced.ini", 2, "misplaced.ini:11", "eta", "[scheme]"),
    ("run section.ini", 2, "section.ini:10", "rum", "did you mean 'run'"),
    ("run outside.ini", 2, "outside.ini:1", "before the first section"),
    ("run type.ini", 2, "type.ini:11", "n=many", "integer"),
    ("run range.ini", 2, "range.ini:11", "n=2", "from 4"),
    ("run nokey.ini", 2, "nokey.ini", "t_end", "missing"),
    ("run noise.ini", 2, "noise.ini:11", "key = value"),
    ("run state.ini", 2, "state.ini:7", "left=1 0", "3 numbers"),
    ("run reference.ini", 2, "reference.ini:4", "simple_wave", "riemann"),
    ("run dimension.ini", 2, "dimension.ini:3", "4", "allowed: 1 2 3"),
    ("run foreign.ini", 2, "foreign.ini:7", "waves", "exclude"),
    ("run gate.ini", 2, "gate.ini:15", "density_l1", "allowed"),
    ("run known.ini", 2, "known.ini:15", "density_l1", "known: WHY"),
    ("run known2.ini", 2, "known2.ini:15", "density_l1", "known: WHY"),
    ("run ladder.ini", 2, "ladder.ini:15", "at least four"),
    ("run field.ini", 2, "field.ini:14", "presure", "did you mean 'pressure'"),
    ("run bracket.ini", 2, "bracket.ini:14", "section"),
    ("run /dev/zero.ini", 2, "/dev/zero.ini"),
    ("run sod --plot x.pdf", 2, "x.pdf", ".svg or"),
    ("run sod --snapshot nowhere/s.csv", 4, "nowhere/s.csv", "No such file"),
    ("run sod --snapshot folder", 4, "folder", "directory"),
    ("run sod --json nowhere/r.json", 4, "nowhere/r.json", "No such file"),
    ("run sod cfl=50", 3, "particle", "t ="),
    ("converge sod --n 100,100,100,100", 2, "--n", "1 distinct", "at least 4"),
    ("converge sod --n 1,2,3,4", 2, "--n", "from 4"),
    ("converge sod --vary kernel=cubic", 2, "cubic", "cubic_spline"),
    ("converge sod --vary eta", 2, "eta", "values"),
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

# what each call must say on standard output, or (notes) on standard error
SAID = [
    ("help run", "usage: sphproof run CASE"),
    ("help", "usage: sphproof COMMAND"),
    ("run gresho n=64 --explain", "about 8 along each side; did you mean n=64^2?"),
    ("run gresho n=64^2 --explain", "3.6 mean spacings, so it holds about 41 neighbours; h/dx = 1.8"),
    ("run noh_3d n=6^3 --explain eta=3", "holds about 113 neighbours"),
    ("run sod n=100 --explain eta=2", "holds about 4 neighbours"),
]
# what it must not say
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
    # a result that cannot be written to one place is still shown in the other
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
