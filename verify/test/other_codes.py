# SPDX-License-Identifier: GPL-3.0-or-later
"""other_codes.py SPHPROOF: runs of other codes. A stand-in is a script that calls SPHPROOF itself, so that errors
must be those of our own runs; then every way in which a code can fail, by name; no process that it has started is
left behind."""
import glob
import hashlib
import json
import os
import random
import shlex
import signal
import subprocess
import sys
import time
import xml.etree.ElementTree

from schema import Validator
from script import call, play, program, read, write

with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "schema", "sphproof-1.schema.json"), encoding="ascii") as text:
    validator = Validator(json.load(text))

# The code: MODE CASE N T_END SEED OUT. Modes that only run ours are those of a shell, which starts in a tenth of the
# time that Python takes.
CODE = """#!/bin/sh
echo "the code says: mode $1"
case $1 in
good) key= ;;
thick) key=noise=3 ;;
thicker) key=noise=4 ;;
viscous) key=alpha=2; [ "$2" != gresho ] || key=noise=2 ;;
gas) key=gamma=1.5 ;;
nothing) exit ;;
*) exec %s -IS "${0%%/*}/other_code.py" "$@" ;;
esac
exec %s run "$2" "n=$3" "t_end=$4" $key --quiet --snapshot "$6_1.csv"
"""
# the other modes: the file has to end in code.py, by which processes are found
OTHERS = """import glob, os, struct, sys, time
mode, case, n, t_end, seed, out = sys.argv[1:7]
def call(*words):
    if os.spawnl(os.P_WAIT, %r, "sphproof", *words): # modules take longer to start than most runs
        sys.exit(1)
def run(t=t_end, n=n, to=out + "_1.csv", *keys):
    call("run", case, "n=" + n, "t_end=" + t, *keys, "--quiet", "--snapshot", to)
def change(path, to, keep, of_column):
    with open(path) as file:
        lines = [line for line in file.read().splitlines() if not line.startswith(("# box", "# keys", "# case"))]
    names = lines[0].split(",")
    rows = [line.split(",") if line[0] != "#" else line for line in lines[1:]]
    with open(to, "w") as file:
        print(",".join(name for name in names if keep(name)), file=file)
        for row in rows:
            print(row if isinstance(row, str) else ",".join(of_column(*pair) for pair in zip(names, row) if keep(pair[0])), file=file)
if mode == "hang":
    time.sleep(1000)
if mode == "eat":
    eaten = bytearray(400000000)
    time.sleep(1000)
if mode == "feast": # its processes together
    for _ in range(2):
        if not os.fork():
            eaten = bytearray(120000000)
            time.sleep(1000)
    time.sleep(1000)
if mode == "works": # mostly in the system, and sleeps
    with open("/dev/zero", "rb", buffering=0) as file:
        while os.times().system < 0.3:
            file.read(1 << 20)
    time.sleep(0.3)
if mode == "exit":
    print("no such table", file=sys.stderr)
    sys.exit(7)
if mode == "killed":
    os.kill(os.getpid(), 9)
if mode == "wound":
    run()
    for name, part, lost in (out + "_-.csv", 4, 1), (out + "_0.csv", 2, 0): # the first one lacks a particle
        lines = open("ic.csv").read().replace("# time = 0", "# time = " + repr(float(t_end) / part)).splitlines()
        names = lines[0].split(",")
        with open(name, "w") as file:
            for line in lines[:len(lines) - lost]:
                words = line.split(",")
                if line[0] not in "#x":
                    for name in "vx", "vy":
                        words[names.index(name)] = repr(1.1 * float(words[names.index(name)]))
                print(",".join(words), file=file)
elif mode == "early":
    run(t=repr(0.998 * float(t_end)))
elif mode == "late":
    run(t=repr(1.0005 * float(t_end)))
elif mode == "corner":
    run()
    with open(out + "_1.csv") as file:
        lines = file.read().splitlines()
    for i, line in enumerate(lines):
        if line.startswith("# box"):
            lines[i] = "# box = 0:2"
        elif i and line[0] != "#":
            lines[i] = repr(float(line.split(",")[0]) + 1) + "," + line.split(",", 1)[1]
    lines = [line for line in lines if not line.startswith(("# keys", "# case"))]
    with open(out + "_1.csv", "w") as file:
        file.write("\\n".join(lines) + "\\n")
elif mode == "count": # from 0, and does not say so
    run()
    with open(out + "_1.csv") as file:
        ends = next(line for line in file if line.startswith("# box")).split()[3:]
    corner = dict(zip("xyz", (float(end.split(":")[0]) for end in 3 * ends)))
    change(out + "_1.csv", out + "_1.csv", lambda name: True, lambda name, word: repr(float(word) - corner.get(name, 0)))
elif mode in ("flat", "flat start"):
    run()
    which = out + "_1.csv" if mode == "flat" else "ic.csv"
    change(which, out + "_%%d.csv" %% (mode == "flat"), lambda name: name not in ("y", "vy"), lambda name, word: word)
elif mode == "stuck": # a binary of GADGET, with another time
    with open(glob.glob("ic*")[0], "rb") as file, open(out + "_1.dat", "wb") as to:
        said = file.read()
        to.write(said[:76] + struct.pack("<d", float(t_end)) + said[84:])
elif mode in ("touches", "same"): # a file that is there already
    there = os.path.join(%r, "there.csv")
    was = os.stat(there)
    with open(there, "r+") as file:
        file.write(file.read()[:0])
    os.utime(there, ns=(was.st_atime_ns, was.st_mtime_ns + (mode == "touches")))
elif mode in ("starts", "kicked"):
    with open("ic.csv") as file:
        lines = file.read().splitlines()
    for i in range(len(lines) // 2, len(lines) // 2 + 9) if mode == "kicked" else ():
        lines[i] = lines[i].replace(",0,", ",0.3,")
    with open(out + "_0.csv", "w") as file:
        file.write("\\n".join(lines) + "\\n")
    os.remove("ic.csv")
    run()
elif mode == "own":
    call("ic", case, "n=" + n, "jitter=0.02", "--format", "csv", "--out", out + "_0.csv")
    run()
elif mode == "fast":
    with open("ic.csv") as file, open(out + "_0.csv", "w") as to:
        to.write(file.read().replace(",0,", ",0.1,"))
    run()
elif mode == "once":
    if not os.path.exists(os.path.join(%r, "tried")):
        open(os.path.join(%r, "tried"), "w").close()
        sys.exit(1)
    run()
elif mode == "few":
    run(n=str(int(n) // 2))
elif mode == "heavy":
    run(t_end, n, out + "_1.csv", "left=2 0 2", "right=0.25 0 0.2")
elif mode == "still":
    with open("ic.csv") as file, open(out + "_1.csv", "w") as to:
        to.write(file.read().replace("# time = 0", "# time = " + t_end))
elif mode != "old":
    run()
with open(out + "_1.csv") if os.path.exists(out + "_1.csv") else open(os.devnull) as file:
    text = file.read()
if mode == "cut":
    text = text[:len(text) // 2 + 3].rsplit(",", 1)[0]
if mode == "nan":
    lines = text.splitlines()
    lines[-3] = ",".join(["nan"] + lines[-3].split(",")[1:])
    text = "\\n".join(lines) + "\\n"
if mode == "uneven": # their sum is right
    lines = text.splitlines()
    column = lines[0].split(",").index("m")
    rows = [i for i, line in enumerate(lines) if i and line[0] != "#"]
    for k, i in enumerate(rows):
        words = lines[i].split(",")
        words[column] = repr((1.5, 0.5)[k %% 2] * float(words[column]))
        lines[i] = ",".join(words)
    text = "\\n".join(lines) + "\\n"
if mode in ("cut", "nan", "uneven"):
    with open(out + "_1.csv", "w") as file:
        file.write(text)
if mode == "old":
    run()
    os.utime(out + "_1.csv", (1e9, 1e9))
if mode in ("grandchild", "daemon"):
    import subprocess
    subprocess.Popen(["sleep", "9%%d" %% os.getppid()], start_new_session=mode == "daemon")
    with open(os.path.join(%r, "child"), "w") as file:
        file.write("9%%d" %% os.getppid())
"""
FILE = """[code]
title = Stand-in
command = ./code.py %s @N@ @T_END@ @SEED@ @OUT@
snapshot = @OUT@_*.csv
timeout = %s
memory = %s
[case sod]
[case gresho]
command = ./code.py good gresho @N@ @T_END@ @SEED@ @OUT@
n = 10^2 12^2 14^2 16^2
velocity_l1 = 0.5 10
"""
# mode, reason, words of the message
FAILURES = (("exit", "exit_status", "no such table"), ("killed", "exit_status", "signal 9"), ("nothing", "no_snapshot", "out_*.csv: the run"),
            ("hang", "timeout", "1 s"), ("eat", "memory", "200 MB"), ("feast", "memory", "200 MB"), ("cut", "truncated", "out_1.csv"),
            ("old", "old_snapshot", "older"), ("nan", "not_a_number", "nan"), ("early", "wrong_time", "0.1996"),
            ("gas", "wrong_gamma", "1.5"), ("own", "ignored_ic", "out_0.csv: positions along x"),
            ("fast", "ignored_ic", "out_0.csv: vx differs"),
            ("few", "wrong_particles", "99"), ("heavy", "ignored_ic", "masses"), ("uneven", "ignored_ic", "masses"), ("still", "ignored_ic", "at the start"))
GOOD = FILE % ("good sod", 60, "none")
# replaced text, replacement, words of the message
BAD = ((GOOD, "", "is empty"), ("title", "titel", "did you mean 'title'"), ("[case sod]", "[case sodd]", "did you mean 'sod'"),
       ("[case sod]", "[casus sod]", "[casus sod]|casus"), ("[case gresho]", "[case sod]", "given twice"),
       ("@SEED@", "@SEAD@", "did you mean '@SEED@'"), ("./code.py good sod", "./none.py", ":3: command = ./none.py"),
       ("timeout = 60", "timeout = soon", ":5: timeout = soon"), ("timeout = 60", "timeout = 0", "seconds, above 0"),
       ("memory = none", "memory = 3", "MB or GB"), ("memory = none", "memory = none\nmemory = none", "first in line 6"),
       ("memory = none", "shell = perhaps", "yes no"), ("memory = none", "elements = grid", "particles cells"), ("memory = none", "ic = swfit", "did you mean 'swift'"),
       ("memory = none", "ic = ./code.py @OUT@", "@IC@"), ("memory = none", "parameters = nothing.in", "relative to the code file"),
       ("memory = none", "parameters = bad.in", "bad.in:2: no word '@WRONG@'"), ("memory = none", "depends = nothing", "relative"),
       ("n = 10^2", "n = 10^2 8^2", "rising"), ("velocity_l1 = 0.5 10", "velocity_l1 = 3", "least order"),
       ("velocity_l1", "velocity_l9", "no key in [case gresho]"), ("n = 10^2", "title = x", "title"),
       ("snapshot = @OUT@_*.csv\n", "", "key snapshot is missing"), ("[code]\n", "", "before the first section"),
       ("[case gresho]", "[fault slow]\n[case gresho]", "[fault slow] has no key"),
       ("memory = none", "ic = ./none.py @IC@", ":6: ic = ./none.py"), ("./code.py good sod", '""', ':3: command = ""'),
       ("velocity_l1", "shock_radius", "exclude each other"))


def answer(*words, status=0, environment=None):
    done = call(*words, status=status, env=environment)
    assert status is not None or done.returncode < 2, (words, done)
    return done.stdout, done.stderr


def document(*words, status=0):
    found = json.loads(answer(*words, "--json", "-", status=status)[0])
    faults = list(validator.faults(found, validator.root))
    assert not faults, (words, faults)
    return found


def running(words):
    """Processes started by the test."""
    found = []
    for path in glob.glob("/proc/[0-9]*/cmdline"):
        try:
            with open(path, "rb") as file:
                if words.encode() in file.read().replace(b"\0", b" "):
                    found.append(path)
        except OSError:
            pass
    return found


def until(condition, what):
    end = time.monotonic() + 60
    while not condition():
        assert time.monotonic() < end, what
        time.sleep(0.02)


def same(ours, theirs, path="", most=1e-12):
    """Compares measured members to round-off."""
    if isinstance(ours, dict):
        for key in ours:
            same(ours[key], theirs[key], path + "/" + key, most)
    elif isinstance(ours, list):
        for a, b in zip(ours, theirs):
            same(a, b, path, most)
    elif isinstance(ours, (int, float)) and ours != theirs:
        assert abs(ours - theirs) <= most * abs(ours) + 1e-14, (path, ours, theirs)


def test_same(draw):
    for case, n in (("sod", str(draw.randint(60, 300))), ("gresho", "%d^2" % draw.randint(14, 22))):
        ours, theirs = document("run", case, "n=" + n), document("run", case, "n=" + n, "--code", "good.ini")
        for key in ("errors", "functionals", "spacing", "h", "n", "time", "window", "regularity", "budget", "measured"):
            # h is the file's times a ratio that sums over the kernel determine
            same(ours[key], theirs[key], case + "/" + key, 1e-9 if key in ("h", "regularity", "budget") else 1e-12)
        assert theirs["conservation"]["energy"] < 1e-12 and theirs["status"] == "ok", theirs
        code = theirs["code"]
        assert code["title"] == "Stand-in" and code["sha256"] == hashlib.sha256(read("code.py").encode()).hexdigest() and code["exit_status"] == 0, code
        assert "mode good" in code["log"] and theirs["cost"]["cpu_s"] > 0 and theirs["cost"]["steps"] is None, theirs
        assert "kernel" not in theirs["settings"] and theirs["judged"]["assumptions"], theirs
    said = answer("run", "sod", "n=198", "--code", "good.ini")[0]
    assert "computed by Stand-in" in said and "density " in said, said


def test_failures():
    for mode, reason, reported in FAILURES:
        text = FILE % (mode + " sod", 1 if mode == "hang" else 60, "200 MB" if mode == "eat" else "none")
        write("bad.ini", text.replace("[case sod]", "[case sod]\nmemory = 200 MB") if mode == "feast" else text)
        done = document("run", "sod", "n=198", "--code", "bad.ini", status=3)
        assert (done["status"], done["reason"], done["n"]) == ("failed", reason, 198), (mode, done["reason"], done["message"])
        assert reported in done["message"] and reason in done["message"], (mode, done["message"])
        assert "the code says: mode " + mode in done["code"]["log"] or mode in ("exit", "hang", "eat", "feast", "killed"), done["code"]
    assert not glob.glob("tmp/*"), glob.glob("tmp/*")


def bad_file(mode, case, *changes):
    """A code file with one case, of which the stand-in has this mode."""
    text = (FILE % (mode + " @CASE@", 60, "none")).split("[case")[0] + "[case %s]\n" % case
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new)
    write("bad.ini", text)


def test_stuck():
    """A code that moves nothing, given a file that counts positions from 0: in each case some particles move along
    some direction. A code that writes fewer directions than the case has."""
    for case, n, along in ("lax", "60", "x"), ("sedov_2d", "20^2", "x"), ("sedov_3d", "12^3", "x"), ("shear", "12^2", "y"):
        bad_file("stuck", case, ("[code]", "[code]\nic = gadget_binary"), (".csv", ".dat"))
        done = document("run", case, "n=" + n, "--code", "bad.ini", status=3)
        assert done["reason"] == "ignored_ic" and "at the start along " + along in done["message"], done["message"]
    for mode, reason in ("flat", "wrong_particles"), ("flat start", "ignored_ic"):
        bad_file('"%s"' % mode, "noh_2d")
        done = document("run", "noh_2d", "n=16^2", "t_end=0.05", "--code", "bad.ini", status=3)
        assert done["reason"] == reason and "particles in 1D" in done["message"], done["message"]


def test_count_from_0():
    """Files that do not say that they count positions from 0 have the results of ours, in boxes of any corner."""
    for case, *words in ("sod", "n=60"), ("yee", "n=14^2", "t_end=0.5"), ("rayleigh_taylor_mode", "n=200", "t_end=0.2"):
        bad_file("count", case)
        ours, theirs = document("run", case, *words), document("run", case, *words, "--code", "bad.ini")
        for key in ("errors",) if case == "sod" else ("errors", "functionals"):  # positions of sod's shock differ
            same(ours[key], theirs[key], case + "/" + key, 1e-9)
        for key in "mass", "energy", "angular_momentum":  # of the start as of the end
            assert abs((ours["conservation"][key] or 0) - (theirs["conservation"][key] or 0)) < 1e-9, (case, key, ours["conservation"], theirs["conservation"])
        assert "box" in json.dumps(theirs["judged"]["assumptions"]), theirs["judged"]


def test_files_before():
    """A file that was there before the run is no result unless the run has changed it, be it by a nanosecond, nor
    is it a snapshot of the start."""
    answer("ic", "sod", "n=60", "jitter=0.02", "--format", "csv", "--out", "here.csv")
    answer("run", "sod", "n=60", "--quiet", "--snapshot", "there.csv")
    for mode, status in ("same", 3), ("touches", 0):
        bad_file(mode, "sod", ("@OUT@_*.csv", "@HERE@/*here.csv"))
        done = document("run", "sod", "n=60", "--code", "bad.ini", status=status)
        assert done.get("reason", "") == ("old_snapshot" if status else ""), done


def test_cost():
    """A code's CPU time is that of the user and of the system; while it sleeps only the wall-clock time grows."""
    bad_file("works", "sod")
    done = document("run", "sod", "n=60", "--code", "bad.ini")
    code, cost = done["code"], done["cost"]
    assert code["cpu_s"] >= 0.3 and code["wall_s"] >= 0.6 and code["wall_s"] > code["cpu_s"] + 0.2, code
    assert (cost["cpu_s"], cost["wall_s"]) == (code["cpu_s"], code["wall_s"]), (cost, code)


def test_threads():
    """Every command tells the code how many threads it may take."""
    bad_file("good", "sound_wave", ("command = ", "shell = yes\ncommand = echo @THREADS@ >> \"@HERE@\"/took && \"@HERE@\"/"), ("./code.py", "code.py"),
             ("[case sound_wave]", "[case sound_wave]\nn = 16 20 24 28"))
    for words, runs in (("run", "sound_wave", "n=16"), 1), (("converge", "sound_wave", "--replicates", "1"), 4), \
            (("bench", "sound_wave", "--time", "1e-5", "--samples", "1", "--n", "16"), None):
        write("took", "")
        answer(*words, "--code", "bad.ini", "--threads", "3", status=None)
        took = read("took").split()
        assert took and set(took) == {"3"} and len(took) == (runs or len(took)), (words, took)


def test_starts(draw):
    """Results that are not failures: a snapshot of the start, a time within the tolerance, cells of a grid."""
    for mode, more in ("starts", ""), ("kicked", ""), ("late", ""), ("still", "elements = cells"), ("heavy", "elements = cells"):
        write("start.ini", (FILE % (mode + " @CASE@", 60, "none")).replace("[case sod]", more + "\n[case sod]"))
        document("run", "sod", "n=%d" % draw.randint(60, 200), "--code", "start.ini")


def test_again():
    """A failed run is not kept for good: the next command tries it again, a share does not."""
    write("once.ini", FILE % ("once sod", 60, "none"))
    ladder = ("converge", "sod", "--n", "60,61,62,63", "--replicates", "1", "--code", "once.ini", "--cache", "again")
    answer(*ladder, status=3)
    answer(*ladder, "--shard", "1/1", status=0)
    for name in ("first", "second"):
        found = document(*ladder, status=None)
        assert found["status"] != "failed", (name, found)


def test_refused():
    write("bad.in", "a = @N@\nb = @WRONG@\n")
    for old, new, reported in BAD:
        assert old in GOOD, old
        write("bad.ini", GOOD.replace(old, new, 1))
        out, said = answer("run", "sod", "--code", "bad.ini", "--work", "refused", status=2)
        assert not out and any(part in said for part in reported.split("|")), (new, said)
    for words, reported in ((("run", "noh_2d"), "gresho"), (("run", "sod", "kernel=cubic_spline"), "kernel"),
                        (("run", "sod", "--snapshot", "a.csv"), "--work"), (("run", "sod", "n=2"), "n")):
        out, said = answer(*words, "--code", "good.ini", "--work", "refused", status=2)
        assert not out and reported in said, (words, said)
    assert "--code" in answer("run", "sod", "--work", "refused", status=2)[1]
    assert not os.path.exists("refused") and not os.path.exists("a.csv")


def test_work():
    """Templates, a starting command of the user's, a shell; kept files."""
    write("par.txt.in", "n @N@ dim @DIM@ gamma @GAMMA@ box @LO@ @HI@ end @T_END@ out @OUT@ ic @IC@ seed @SEED@ spacing @SPACING@")
    write("line.ini", GOOD.replace("[case sod]", "parameters = par.txt.in\nshell = yes\n[case sod]")
          .replace("./code.py good sod", "test -f @PARAMETERS@ && \"@HERE@\"/code.py good sod", 1))
    done = document("run", "sod", "n=100", "--code", "line.ini", "--work", "kept")
    assert read(os.path.join(done["code"]["folder"], "par.txt")) == ("n 100 dim 1 gamma 1.4 box -1 1 end 0.2 out out ic ic.csv seed 1 spacing 0.02"), done
    assert {"ic.csv", "out_1.csv", "par.txt", "stderr", "stdout"} == set(os.listdir(done["code"]["folder"]))
    for entry in json.loads(answer("list", "formats", "--json", "-")[0])["families"]["formats"]:
        if entry["name"] == "sph_exa":  # 3D only
            continue
        write("format.ini", GOOD.replace("[case sod]", "parameters = par.txt.in\nic = %s\n[case sod]" % entry["name"], 1))
        done = document("run", "sod", "n=100", "--code", "format.ini", "--work", "kept")
        words = read(os.path.join(done["code"]["folder"], "par.txt")).split()
        assert os.path.exists(os.path.join(done["code"]["folder"], words[words.index("ic") + 1])), entry
        assert ("box 0 2" if "gadget" in entry["name"] or entry["name"] == "swift" else "box -1 1") in " ".join(words), (entry, words)
    write("start.ini", GOOD.replace("[case sod]", "ic = ./start.sh @IC@ @N@\n[case sod]"))
    write("start.sh", "#!/bin/sh\nexec %s ic sod n=$2 --format csv --out $1 --quiet\n" % shlex.quote(program))
    os.chmod("start.sh", 0o700)
    write("start.ini", read("start.ini").replace("./code.py", "@HERE@/code.py"))
    # a command has to find the format of its file by itself
    done = document("run", "sod", "n=100", "--code", "start.ini")
    same(document("run", "sod", "n=100")["errors"], done["errors"])
    assert done["code"]["sha256"] == hashlib.sha256(read("code.py").encode()).hexdigest(), done["code"]


SLAB = """#!/bin/sh
# a code that knows 3D alone: T_END OUT, and the ends of the box
printf '[case]\\ntitle = t\\ndimension = 3\\nreference = none\\n[domain]\\nlo = %%s %%s %%s\\nhi = %%s %%s %%s\\n' $3 $4 $5 $6 $7 $8 > it.ini
printf '[initial]\\nkind = particles\\nfile = ic.csv\\n[run]\\ngamma = 1.6666666666666667\\nt_end = %%s\\n' $1 >> it.ini
%s run ./it.ini --quiet --snapshot all.csv
sed '/^# case/d;/^# keys/d' all.csv > $2_1.csv
"""


def test_slab(draw):
    """A code in 3D runs a case in 2D as layers: its errors are nearly ours in 2D, and n is that of a layer."""
    write("slab.sh", SLAB % shlex.quote(program))
    os.chmod("slab.sh", 0o700)
    write("slab.ini", GOOD.replace("[case gresho]", "[case gresho]\nas_3d = %d\nequal_masses = yes" % draw.randint(8, 10))
          .replace("./code.py good gresho @N@ @T_END@ @SEED@ @OUT@", "./slab.sh @T_END@ @OUT@ @LO@ @HI@"))
    words = ("run", "gresho", "n=14^2", "t_end=0.1")
    ours, theirs = document(*words), document(*words, "--code", "slab.ini")
    assert theirs["n"] == 196 and 0.8 < theirs["errors"]["velocity"]["l1"] / ours["errors"]["velocity"]["l1"] < 1.2, theirs
    assert theirs["conservation"]["mass"] < 1e-12 and theirs["conservation"]["energy"] < 1e-12, theirs["conservation"]
    assert any(one["what"] == "plane" and "slab" in one["value"] for one in theirs["judged"]["assumptions"]), theirs["judged"]
    write("slab.ini", read("slab.ini").replace("./slab.sh", "false"))
    assert document(*words, "--code", "slab.ini", status=3)["n"] == 196
    write("slab.ini", GOOD.replace("[case gresho]", "as_3d = 3.5\n[case gresho]"))
    assert "a number of layers" in answer(*words, "--code", "slab.ini", status=2)[1]


def test_no_errors():
    """A case without an exact solution has no errors and orders to print."""
    said = answer("converge", "kelvin_helmholtz", "--n", "12^2,14^2,16^2,18^2", "--replicates", "1", status=None)[0]
    assert "nan" not in said and "mode_amplitude" in said and "no errors of fields" in said, said


def test_ladder(draw):
    """Orders and gates are those of our own runs, in any place and any number of jobs; kept results are not computed
    again unless a file that determines them has changed."""
    ladder = ",".join("%d^2" % n for n in sorted(draw.sample(range(10, 20), 4)))
    ours = document("converge", "gresho", "--n", ladder, status=None)
    for more in ((), ("--jobs", "3", "--cache", "cache"), ("--cache", "cache")):
        theirs = document("converge", "gresho", "--n", ladder, "--code", "good.ini", "--work", "runs", *more)
        assert [level["n"] for level in theirs["levels"]] == [level["n"] for level in ours["levels"]]
        for a, b in zip(ours["levels"], theirs["levels"]):
            same(a["errors"], b["errors"], "errors", 1e-10)
        for a, b in zip(ours["orders"], theirs["orders"]):
            same({key: a[key] for key in ("order", "pairwise")}, b, a["field"], 1e-8)
        gates = {order["field"]: order["gate"] for order in theirs["orders"] if order["gate"]}
        assert list(gates) == ["velocity"] and gates["velocity"]["bound"] >= 10, gates
        assert theirs["code"]["title"] == "Stand-in" and not theirs["floors"] and "kernel" not in theirs["settings"], theirs
    count = len(os.listdir("runs"))
    assert count == 8, os.listdir("runs")
    for change in ("# other", "# timeout"):
        write("other.ini", GOOD.replace("[case sod]", "depends = other.txt\n[case sod]"))
        write("other.txt", change)
        document("converge", "gresho", "--n", ladder, "--code", "other.ini", "--work", "runs", "--cache", "cache")
        count += 4
        assert len(os.listdir("runs")) == count, change
    write("bad.ini", GOOD.replace("good gresho", "exit gresho"))
    done = document("converge", "gresho", "--code", "bad.ini", "--work", "runs", status=3)
    assert done["status"] == "failed" and "no such table" in done["message"] and "n = 100" in done["message"], done
    for words, reported in (("--vary", "kernel"), "kernel"), (("eta=3",), "eta"):
        assert reported in answer("converge", "gresho", *words, "--code", "good.ini", status=2)[1], words
    write("tight.ini", GOOD.replace("0.5 10", "0.5 1e-9"))
    document("converge", "gresho", "--n", ladder, "--code", "tight.ini", "--cache", "cache", status=1)
    # the old bound is that at the end of the case's own ladder, and allows a larger one at the end of a shorter
    # ladder
    write("short.ini", GOOD.replace("velocity_l1 = 0.5 10\n", ""))
    bounds = [{order["field"]: order["gate"] for order in document("converge", "gresho", *words, status=None)["orders"]
               if order["gate"]}["velocity"] for words in (("--n", "10^2,12^2,14^2,16^2"), ("--code", "short.ini"))]
    assert abs(bounds[0]["bound"] / bounds[1]["bound"] - 1) < 1e-12, bounds


def test_changed_program():
    """Each way to name a program or its script: kept results are computed again after the file has changed."""
    ladder = ("converge", "sod", "--code", "named.ini", "--n", "50,52,54,56", "--replicates", "1", "--cache", "named")
    for command in ("./named.sh", "sh named.sh", "sh @HERE@/named.sh", "env A=1 @HERE@/named.sh",
                    "shell = yes\ncommand = true; sh \"@HERE@/named.sh\"", "shell = yes\ncommand = A=1&&(\"@HERE@/named.sh\""):
        write("named.ini", "[code]\nsnapshot = @OUT@_1.csv\n%s @N@ @T_END@ @OUT@%s\n[case sod]\ndensity_l1 = 0 1\n"
              % (command if "shell" in command else "command = " + command, ")" * command.count("(")))
        kept = []
        for change in "", "# changed\n":
            write("named.sh", "#!/bin/sh\n%s%s run sod n=$1 t_end=$2 --quiet --snapshot $3_1.csv\n" % (change, shlex.quote(program)))
            os.chmod("named.sh", 0o700)
            kept.append(answer(*ladder, "--list")[0].count("kept"))
            if not change:
                answer(*ladder)
                kept.append(answer(*ladder, "--list")[0].count("kept"))
        assert kept == [0, 4, 0], (command, kept)


def test_key():
    """Whatever decides about the results of a code is in their key: each file that it reads, each key of the code
    file."""
    ini = ("[code]\nic = sh start.sh @IC@ @N@\nparameters = one.in two.in\ndepends = three.txt four.txt\nsnapshot = @OUT@_1.csv\n"
           "command = sh key.sh @N@ @T_END@ @OUT@\n[case sod]\ndensity_l1 = 0 1\n")
    files = {"start.sh": "exec %s ic sod n=$2 --format csv --out $1 --quiet\n" % shlex.quote(program),
             "key.sh": "exec %s run sod n=$1 t_end=$2 --quiet --snapshot $3_1.csv\n" % shlex.quote(program),
             "one.in": "@N@\n", "two.in": "@N@\n", "three.txt": "3\n", "four.txt": "4\n"}
    ladder = ("converge", "sod", "--code", "key.ini", "--n", "50,52,54,56", "--replicates", "1", "--cache", "keyed")
    for name, text in (*files.items(), ("key.ini", ini)):
        write(name, text)
    answer(*ladder)
    changes = [(name, text + "# changed\n") for name, text in files.items()]
    changes += [("key.ini", ini.replace("_1.csv\n", "_?.csv\n")), ("key.ini", ini.replace("[case", "elements = cells\n[case")),
                ("key.ini", ini.replace("@OUT@\n", "@OUT@ more\n")), ("key.ini", ini.replace("[case", "equal_masses = yes\n[case")),
                ("key.ini", ini.replace("[case", "shell = yes\n[case")), ("key.ini", ini.replace("sh start.sh @IC@ @N@", "csv"))]
    for name, text in changes:
        kept = [answer(*ladder, "--list")[0].count("kept")]
        write(name, text)
        kept.append(answer(*ladder, "--list")[0].count("kept"))
        write(name, files.get(name, ini))
        assert kept == [4, 0], (name, text, kept)


def test_motion():
    """A code that winds a vortex up during the run: neither its last snapshot nor its total energy shows it, but all
    snapshots do. One with another number of particles does not count."""
    shown = {}
    for mode in "good", "wound":
        write("wound.ini", GOOD.replace("good gresho", mode + " gresho"))
        run = document("run", "gresho", "n=14^2", "--code", "wound.ini")
        shown[mode] = run["conservation"]
        assert len(run["through_time"]["time"]) == (3 if mode == "wound" else 2), run["through_time"]
    gained = document("run", "gresho", "n=14^2")["conservation"]
    assert shown["good"]["ke_rebound"] == 0 and shown["good"]["centre"] < 1e-9 and gained["ke_rebound"] < 0.1, (shown, gained)
    assert 0.2 < shown["wound"]["ke_rebound"] < 0.22 and shown["wound"]["energy"] > 100 * shown["good"]["energy"], shown
    assert shown["wound"]["mass"] < 1e-9, shown
    assert document("run", "sod", "n=60", "--code", "good.ini")["conservation"]["ke_rebound"] is None
    write("tight.ini", GOOD.replace("velocity_l1 = 0.5 10", "ke_rebound = 0 0.1").replace("good gresho", "wound gresho"))
    failed = document("converge", "gresho", "--code", "tight.ini", status=1)
    assert [order["field"] for order in failed["orders"] if order["status"] == "fail"] == ["ke_rebound"], failed["orders"]


def test_calibrate():
    """Bounds lie between the effects of initial states and those of faults; the file that is written passes the code,
    and fails each fault that it claims to detect; results that are too good fail as well. Calibrating the written
    file gives the same file."""
    ladder = "10^2 12^2 14^2 16^2"
    command = "command = ./code.py %s gresho @N@ @T_END@ @SEED@ @OUT@"
    faults = "".join("[fault %s]\n%s\n" % (name, command % mode)
                     for name, mode in (("thick", "thick"), ("viscous", "viscous"), ("same", "good"), ("thicker", "thicker"), ("dead", "exit")))
    write("mine.ini", "[code]\n; my own\ntitle = Stand-in\n%s\nsnapshot = @OUT@_*.csv\n\n[case sod]\ndensity_l1 = 0 1\n\n"
          "[case gresho]\nn = %s\nvelocity_l1 = 0.5 10\n\n[fault late]\nsnapshot = late_*.csv\n%s" % (command % "good", ladder, faults))
    keep = ("--cache", "calibrated", "--jobs", "2")
    found = document("calibrate", "mine.ini", "gresho", "--runs", "3", *keep, status=1)
    assert (found["runs"], found["out"], found["status"]) == (3, "mine.calibrated.ini", "fail"), found
    case = found["cases"][0]
    assert {fault["name"]: fault["status"] for fault in case["faults"]} == {
        "late": "failed", "thick": "seen", "viscous": "seen", "same": "unseen", "thicker": "seen", "dead": "failed"}, case["faults"]
    gates = {gate["name"]: gate for gate in case["gates"]}
    assert gates["velocity_l1"]["sees"] == ["thick", "viscous", "thicker"] and gates["velocity_l1"]["smallest"] == "viscous", gates
    assert gates["velocity_l1"]["status"] == "sees" and gates["mass"]["status"] == "blind", gates
    for gate in gates.values():
        assert (gate["status"] == "sees") == bool(gate["sees"]) == (gate["bound"] is not None), gate
        if gate["status"] != "sees":
            continue
        assert set(gate["sees"]) <= {"thick", "viscous", "thicker"} and gate["smallest"] in gate["sees"], gate
        if gate["change"] < 9 * gate["floor"]:  # detected by a bound that follows from a larger fault
            continue
        width = gate["bound"] - (gate["value"] if gate["name"] not in ("mass", "momentum", "angular_momentum", "energy") else 0)
        assert 2.99 * gate["floor"] < width < 0.34 * max(gate["change"], 9 * gate["floor"]), gate
        assert abs(width**2 / gate["floor"] / gate["change"] - 1) < 1e-6, gate
        assert gate["least"] == 0 or gate["least"] == max(gate["value"] / 2, 2 * gate["value"] - gate["bound"]), gate
    assert gates["velocity_l1"]["least"] > 0 and not gates["momentum"]["least"], gates
    text = read("mine.calibrated.ini")
    assert "; my own" in text and "density_l1 = 0 1\n\n" in text and "velocity_l1 = 0.5 10" not in text, text
    assert "mass = " not in text.replace("angular_momentum", ""), text

    def converge(change, status, *words):
        write("theirs.ini", change(text))
        return document("converge", "gresho", *words, "--code", "theirs.ini", *keep, status=status)

    converge(lambda said: said, 0)
    converge(lambda said: said.replace("code.py good", "code.py viscous", 1), 1)
    line = [line for line in text.splitlines() if line.startswith("velocity_l1")][0]
    least, bound = (float(word) for word in line.split()[3].split(":"))
    for factor in 1.2, 0.8:
        wrong = converge(lambda said: said.replace(line, "velocity_l1 = 0 %.9g:%.9g" % (factor * least, factor * bound)), 1)
        why = [order["why"] for order in wrong["orders"] if order["status"] == "fail"]
        assert len(why) == 1 and ("strangely below" if factor > 1 else "exceeds") in why[0], why
    document("calibrate", "mine.calibrated.ini", "gresho", "--runs", "3", *keep, "--out", "again.ini", status=1)
    assert read("again.ini") == text
    write("free.ini", text.split("[fault")[0].replace(ladder, ladder.replace("10", "11")))
    free = document("calibrate", "free.ini", "gresho", "--runs", "2", *keep)
    assert {gate["status"] for gate in free["cases"][0]["gates"]} == {"free"} and not free["cases"][0]["faults"], free
    os.mkdir("elsewhere")
    write("none.ini", text.replace(command % "viscous", "command = ./none.py"))
    assert "command = ./none.py" in answer("calibrate", "none.ini", "gresho", status=2)[1]
    for words, reported in ((("--runs", "1"), "from 2 to 16"), (("--out", "elsewhere/a.ini"), "in the folder of mine.ini"),
                        (("sedd",), "sedd"), (("gresho", "gresho"), "given twice"), (("--jobs", "0"), "--jobs")):
        said = answer("calibrate", "mine.ini", *words, status=2)
        assert reported in said[1] and not said[0], (words, said)
    assert not os.listdir("elsewhere")
    assert "sees no fault" in answer("calibrate", "mine.ini", "gresho", "--runs", "3", *keep, status=1)[0]


def test_shares():
    """Three shares into one folder, and the plain command that finds all results there."""
    words = ("converge", "gresho", "--code", "good.ini", "--work", "shared_runs", "--cache", "shared")
    for share in 1, 2, 3:
        answer(*words, "--shard", "%d/3" % share)
    assert len(os.listdir("shared_runs")) == 4
    assert [level["n"] for level in document(*words)["levels"]] == [100, 144, 196, 256]
    assert len(os.listdir("shared_runs")) == 4


def test_report():
    """Codes beside our own schemes: a column each; a failure is a red cell, and so is a case whose program is
    missing, and the history continues."""
    both = GOOD.replace("@OUT@", "@OUT@ @THREADS@", 1).replace("good sod", "good sound_wave").replace("[case sod]", "[case sound_wave]\nn = 16 20 24 28\ndensity_l1 = 0.5 10")
    write("both.ini", both)
    write("bad.ini", GOOD.replace("Stand-in", "Broken").replace("good gresho", "exit gresho").replace("[case sod]\n", ""))
    write("third.ini", GOOD.replace("Stand-in", "Third").replace("[case sod]", "[case sound_wave]\ncommand = ./none.py\nn = 16 20 24 28")
          .replace("n = 10^2 12^2 14^2 16^2", "n = 11^2 12^2 14^2 15^2"))
    for night in range(2):
        found = document("report", "--code", "both.ini", "--code", "third.ini", "--code", "bad.ini", "--out", "out", "--jobs", "2", "--threads", "3", status=1)
        assert [run["code"]["command"][-2:] for run in found["runs"] if run["case"] == "sound_wave" and run["label"] == "Stand-in"] == [" 3"], found["runs"]
        assert found["mode"] == "code" and len(found["history"]["nights"]) == night + 1, found["history"]
        tried_again = 8  # levels of failed cases
        assert not night or found["found"] == found["computations"] - tried_again, (found["found"], found["computations"])
    labels = {(study["case"], study["label"]): study for study in found["studies"]}
    assert set(labels) == {("sound_wave", "Stand-in"), ("sound_wave", "default"), ("sound_wave", "textbook SPH"), ("sound_wave", "Third"), ("gresho", "Third"), ("gresho", "Stand-in"),
                           ("gresho", "Broken"), ("gresho", "default"), ("gresho", "textbook SPH")}, labels.keys()
    for case in "sound_wave", "gresho":
        for ours, theirs in zip(labels[case, "default"]["levels"], labels[case, "Stand-in"]["levels"]):
            same(ours["errors"], theirs["errors"], case, 1e-10)
        assert labels[case, "Stand-in"]["reproduce"] == "sphproof converge %s --code both.ini" % case
        assert not any(order["gate"] for order in labels[case, "default"]["orders"])
    assert labels["gresho", "Broken"]["status"] == "failed" and "code" in labels["gresho", "Broken"]
    none = "the program ./none.py is not there"
    failed = found["verdict"]["failures"]
    assert sorted(failure["area"] for failure in failed) == ["run", "run", "study", "study"], failed
    assert sorted("no such table" in failure["detail"] or 2 * (none in failure["detail"]) for failure in failed) == [1, 1, 2, 2], failed
    assert ":8: command = ./none.py" in answer("converge", "sound_wave", "--code", "third.ini", status=2)[1]
    assert sorted(len(bench["points"]) for bench in found["bench"]) == [12, 16], found["bench"]
    page = xml.etree.ElementTree.fromstring(read("out/index.html").replace("<!DOCTYPE html>", ""))
    text = "".join(page.itertext())
    for word in none, "Stand-in", "Broken", "exit_status", "What was assumed of", "sphproof converge gresho --code bad.ini", "textbook SPH":
        assert word in text, word
    assert "nan" not in text.split(), text
    assert "L1() over n" not in text and "order of L1()" not in text, text
    # errors over n, of different ladders: a dash if a code has not run
    table = next(table for table in page.iter("table") if table.get("class") == "overview")
    row = next(row for row in table.iter("tr") if "gresho" in "".join(row[0].itertext()))
    heads = ["".join(cell.itertext()) for cell in next(table.iter("tr"))]
    for name, n in ("Stand-in", 256), ("Third", 225), ("default", 256):  # each at the end of its own ladder
        assert "at n = %d" % n in "".join(row[heads.index(name)].itertext()).replace("\u00a0", " "), (name, heads)
    table = next(table for table in page.iter("table") if table.get("class") == "errors" and "Broken" in "".join(table[0].itertext()))
    rows = [["".join(cell.itertext()) for cell in row] for row in table.iter("tr")]
    for name, missing in ("Broken", "100 121 144 196 225 256 order"), ("Third", "100 256"), ("default", "121 225"):
        column = rows[0].index(name)
        assert [row[0] for row in rows if row[column] == "—"] == missing.split(), (name, rows)
    assert "Broken" in read("out/junit.xml")
    for words, reported in ((("--nightly",), "--nightly and --code"), (("--code", "both.ini"), "two codes are called")):
        assert reported in answer("report", "--code", "both.ini", *words, "--out", "none", status=2)[1], words
    assert not os.path.exists("none")


def test_corner():
    """A code that counts positions from 0 is drawn at the case's positions; motion of its gas at rest is reported and
    not judged."""
    write("corner.ini", (FILE % ("corner sod", 60, "none")).split("[case gresho]")[0] + "n = 60 80 100 120\n")
    words = ("report", "--code", "corner.ini", "--out", "corner", "--jobs", "2")
    said = answer(*words, "--json", "-", status=4, environment={**os.environ, "PATH": "/nowhere"})
    assert "plots are missing: no plot: gnuplot" in said[1], said[1]
    found = json.loads(said[0])
    runs = {run["label"]: run["profile"] for run in found["runs"]}
    for x in (runs["Stand-in"]["x"], runs["Stand-in"]["exact"]["x"]):
        assert -0.51 < min(x) < -0.45 and 0.45 < max(x) < 0.51, (min(x), max(x))
    same(runs["default"]["density"], runs["Stand-in"]["density"], "density", 1e-9)
    still = {study["label"]: study["budgets"][0]["still_gas"] for study in found["studies"]}
    assert still["default"]["status"] == "pass" and still["Stand-in"]["status"] == "none", still
    assert abs(still["default"]["value"] - still["Stand-in"]["value"]) < 1e-12, still


def test_bench():
    """A code's points are drawn beside ours, with the errors of its runs."""
    brief = ("--time", "1e-5", "--samples", "1", "--n", "14^2,18^2")
    for more in (), ("--cache", "costs"):
        found = document("bench", "gresho", "--code", "good.ini", *brief, *more)
        points = [point for point in found["points"] if point["scheme"] == "Stand-in"]
        assert [point["n"] for point in points] == [196, 324] and all(point["cpu_s"] > 0 for point in points), points
        ours = [point for point in found["points"] if point["scheme"] == "as given"]
        for a, b in zip(ours, points):
            same(a["error"], b["error"], "error", 1e-10)
        assert found["status"] == "ok", found["status"]
    write("bad.ini", GOOD.replace("good gresho", "exit gresho"))
    found = document("bench", "gresho", "--code", "bad.ini", *brief)
    reported = [scheme for scheme in found["excluded"] if scheme["scheme"] == "Broken" or "no such table" in json.dumps(scheme)]
    assert reported and not [point for point in found["points"] if point["scheme"] == "Stand-in"], found["excluded"]
    assert "exclude each other" in answer("bench", "--kernels", "--code", "good.ini", status=2)[1]


def test_nothing_left():
    for mode in ("grandchild", "daemon"):
        write("bad.ini", FILE % (mode + " sod", 60, "none"))
        document("run", "sod", "n=60", "--code", "bad.ini")
        name = "sleep " + read("child")
        assert not running(name), (mode, running(name))
    write("bad.ini", FILE % ("hang sod", 60, "none"))
    words = "code.py hang sod 61"
    for number in signal.SIGINT, signal.SIGTERM, signal.SIGKILL:
        child = subprocess.Popen([program, "run", "sod", "n=61", "--code", "bad.ini"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                 preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
        until(lambda: running(words), "the code never ran")
        child.send_signal(number)
        child.wait()
        until(lambda: not running(words), "the code goes on after signal %d" % number)
        until(lambda: not glob.glob("tmp/*"), "files are left after signal %d" % number)


seed = random.randrange(10**6) if len(sys.argv) < 3 else int(sys.argv[2])
print("seed", seed)


def lay():
    work = os.getcwd()
    os.mkdir("tmp")
    os.environ["TMPDIR"] = os.path.abspath("tmp")
    write("code.py", CODE % (shlex.quote(sys.executable), shlex.quote(program)))
    write("other_code.py", OTHERS % (program, work, work, work, work))
    os.chmod("code.py", 0o700)
    write("good.ini", GOOD)


drawing = [lambda test=test: test(random.Random(seed)) for test in (test_same, test_starts, test_slab, test_ladder)]
play(lay, *drawing, test_failures, test_stuck, test_count_from_0, test_files_before, test_cost, test_threads, test_key, test_again, test_refused, test_work, test_no_errors, test_motion, test_changed_program,
     test_calibrate, test_shares, test_report,
     test_corner, test_bench, test_nothing_left)
