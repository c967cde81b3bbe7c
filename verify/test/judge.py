# SPDX-License-Identifier: GPL-3.0-or-later
"""judge.py SPHPROOF: `sphproof judge` on files written by GIZMO, SWIFT and Phantom, compared with the results of an
independent script (data/snapshots/expected.json); on our own runs, whose errors must be the same; one list of
findings in all forms of output; and input that must be refused. (Conclusions and assumptions of judge:
verify/test/judge; layouts, byte orders and damage: verify/test/readers.)"""
import json
import os
import random
import re
import subprocess
import sys
import tempfile
from xml.etree import ElementTree

PROGRAM = os.path.abspath(sys.argv[1])
DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), "data", "snapshots")
KERNELS = {"cubic": "cubic_spline"}
CASES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "cases")
BINARY = os.path.join(DATA, "gizmo_sod1d_dsph_n198.gadget1")
# a quarter of the box, y < 0 and z < 0: the flow is along x and repeats in the other directions
PHANTOM = os.path.join(DATA, "phantom_sod3d_2592.ascii.gz")


def call(*words):
    done = subprocess.run([PROGRAM, "judge", *words, "--json", "-"], capture_output=True, timeout=120)
    if done.returncode < 0 or done.returncode > 2:
        sys.exit("judge %s: exit status %d\n%s" % (" ".join(words), done.returncode, done.stderr))
    return done.returncode, done.stdout, done.stderr.decode()


def judge(*words, status=None):
    """status: None if it follows from the document: 1 for "fail"."""
    code, out, err = call(*words)
    got = json.loads(out) if code in (0, 1) else {}
    wanted = {"pass": 0, "fail": 1}.get(got.get("status")) if status is None else status
    if code != wanted:
        sys.exit("judge %s: exit status %d, not %s\n%s" % (" ".join(words), code, wanted, err))
    return got


def refused(*words, says):
    code, out, err = call(*words)
    if code != 2 or out or len(err.strip().split("\n")) != 1:
        sys.exit("judge %s: exit status %d, output of %d bytes, message\n%s" % (" ".join(words), code, len(out), err))
    for word in says if isinstance(says, tuple) else (says,):
        if word not in err:
            sys.exit("judge %s: the message lacks '%s':\n%s" % (" ".join(words), word, err))


def near(what, got, wanted, bound):
    if not abs(got - wanted) <= bound * abs(wanted):
        sys.exit("%s: %r, not %r" % (what, got, wanted))


def with_hdf5():
    code, _, err = call(os.path.join(DATA, "gizmo_gresho2d_mfm_32.hdf5"), "--case", "gresho")
    if code == 2 and "built without" in err:
        print("no HDF5: only the message is looked at")
        return False
    return True


def without_its_library(folder):
    """If the HDF5 library cannot be loaded, only commands that need it fail."""
    with open(PROGRAM, "rb") as program:
        name = re.search(rb"\0(libhdf5\w*\.so[.\d]*)\0", program.read())
    if not name:
        return
    write(folder, name.group(1).decode(), b"")
    hidden = dict(os.environ, LD_LIBRARY_PATH=":".join(filter(None, [folder, os.environ.get("LD_LIBRARY_PATH")])))
    for words, code in ((["judge", os.path.join(DATA, "gizmo_gresho2d_mfm_32.hdf5"), "--case", "gresho"], 4),
                        (["run", "sod", "n=50", "--snapshot", os.path.join(folder, "a.h5")], 4),
                        (["run", "sod", "n=50", "--snapshot", os.path.join(folder, "a.csv")], 0)):
        done = subprocess.run([PROGRAM, *words], capture_output=True, text=True, timeout=60, env=hidden)
        assert done.returncode == code and ("cannot be loaded" in done.stderr) == (code == 4), done
        assert bool(done.stdout) == (code == 0), done


def with_zlib():
    code, _, err = call(PHANTOM, "--case", "sod")
    if code == 2 and "built without" in err:
        print("no zlib: only the message is looked at")
        return False
    return True


def against_script(hdf5):
    with open(os.path.join(DATA, "expected.json"), encoding="ascii") as text:
        expected = json.load(text)
    for name, want in expected.items():
        if name.endswith(".hdf5") and not hdf5:
            continue
        # the script measures Gresho's vortex in the disc R < 0.5
        window = ["--window", "0.5"] if want["case"] == "gresho" else []
        got = judge(os.path.join(DATA, name), "--case", want["case"], *window)
        if window:
            assert got["window"] == {"centre": [0.5, 0.5], "radius": 0.5}, got["window"]
        assert got["n"] == want["n"] and got["time"] == want["time"], name
        assert got["settings"]["gamma"] == want["gamma"], (name, got["settings"]["gamma"])
        for field, figures in want.get("L1", {}).items():
            near(name + " L1 of " + field, got["errors"][field]["l1_whole"], figures["vol"], 1e-6)
            near(name + " particle mean of " + field, got["errors"][field]["particle_mean"], figures["part"], 1e-6)
        if "mode_amplitude" in want:
            values = {f["name"]: f["value"] for f in got["functionals"]}
            near(name + " mode", values["mode_amplitude"], want["mode_amplitude"], 1e-6)
        kernel, ratio, residual = want["kernel"]
        if residual < 1e-4:  # the script has identified the kernel
            assert got["kernel"]["name"] == KERNELS[kernel], (name, got["kernel"])
            near(name + " H/h", got["kernel"]["ratio"], ratio, 1e-3)
            assert got["kernel"]["residual"] < 3 * residual, name
        else:
            assert got["kernel"]["name"] == "not identifiable" and got["kernel"]["ratio"] is None, name
            assert len(got["kernel"]["candidates"]) >= 4, name
        # 32^2 and viscous: the vortex has almost gone, and the billow does not grow
        assert got["foreign"] == (name in ("swift_gresho2d_minimal_32.hdf5", "gizmo_kh2d_dsph_64.hdf5")), name
        print("%s: as the script has it; %s" % (name, got["verdict"]))


def phantom():
    got = judge(PHANTOM, "--case", "sod")
    assert got["n"] == 1512 and got["dim"] == 3 and got["time"] == 0.05
    assert got["kernel"]["name"] == "quintic_spline" and got["kernel"]["residual"] < 1e-5, got["kernel"]
    near("Phantom's H/h", got["kernel"]["ratio"], 3, 1e-4)
    # every particle is near a jump, so that only means are compared; those for another gamma differ much
    assert not got["foreign"], got["verdict"]
    other = judge(PHANTOM, "--case", "sod", "--gamma", "1.6666666666666667")
    assert other["foreign"] and not any("inf" in note["evidence"] for note in other["assumptions"]), other["assumptions"]


def write(folder, name, data):
    path = os.path.join(folder, name)
    with open(path, "wb") as file:
        file.write(data if isinstance(data, bytes) else os.fsencode(data))
    return path


# ---- our own runs ----


def same_as_run(got, want, what):
    assert got["window"] == want["window"] and got["case"] == want["case"], (what, got["window"], got["case"])
    for field, norms in want["errors"].items():
        for norm, value in norms.items() if isinstance(norms, dict) else ():
            if value is not None:
                near("%s, %s of %s" % (what, norm, field), got["errors"][field][norm], value, 1e-12)
    for a, b in zip(got["functionals"], want["functionals"]):
        assert a["name"] == b["name"], (what, a, b)
        if isinstance(b["value"], float) and abs(b["value"]) > 1e-9 and a["name"] != "growth_rate":
            near("%s, %s" % (what, a["name"]), a["value"], b["value"], 1e-9)


# Windows of every kind, other boxes, walls, moving gas, another solution.
OWN = (["sod", "n=99"], ["sod", "n=99", "lo=-2", "hi=3"], ["sod", "n=99", "left=1.2 0.1 1", "window=-0.3 0.4"],
       ["noh_2d", "n=20^2"], ["gresho", "n=16^2", "boost=1 0.5"], ["yee", "n=16^2"],
       ["yee", "n=12^2", "window_radius=3"], ["gresho", "n=12^2", "boundary=reflecting periodic"],
       ["noh_3d", "n=8^3", "t_end=0.005"], ["noh_2d", "n=16^2", "t_end=0.01"], ["sound_wave_2d", "n=12^2", "direction=1 1", "amplitude=1e-3"])


def files_of_ours(folder, hdf5):
    """Our own snapshot describes its run: judged without options it has the errors of its run."""
    document = os.path.join(folder, "own.json")
    for k, words in enumerate(OWN):
        name = "own.hdf5" if hdf5 and k % 2 else "own.csv"
        path = os.path.join(folder, name)
        subprocess.run([PROGRAM, "run", words[0], "t_end=0.02", *words[1:], "--snapshot", path, "--json", document,
                        "--quiet"], check=True)
        with open(document, encoding="ascii") as text:
            want = json.load(text)
        same_as_run(judge(path), want, " ".join(words) + ", " + name)
    case = write(folder, "streams.ini", "[case]\ntitle = Two\ndimension = 1\nreference = riemann\n[initial]\n"
                 "kind = riemann\nleft = 1 0.5 1\nright = 1 -0.5 1\n[run]\nt_end = 0.1\nn = 100\n"
                 "[measure]\nwindow = -0.5 0.5\n")
    path = os.path.join(folder, "own.csv")
    subprocess.run([PROGRAM, "run", case, "--snapshot", path, "--json", document, "--quiet"], check=True)
    with open(document, encoding="ascii") as text:
        want = json.load(text)
    same_as_run(judge(path), want, "a case file of one's own")
    # the snapshot contains the case's path, which may have any encoding
    with open(path, encoding=sys.getfilesystemencoding(), errors="surrogateescape") as text:
        head, *rest = text.readlines()
    assert head == "x,vx,m,rho,u,P,h\n" and rest[0] == "# case = %s\n" % case, (head, rest[0])
    # the command line overrides the file
    other = judge(path, "--case", "sod", "--time", "0.05", "--gamma", "1.3", "--window", "-0.25:0.125")
    assert other["case"] == "sod" and other["time"] == 0.05 and other["settings"]["gamma"] == 1.3
    assert other["window"] == [-0.25, 0.125] and "keys" not in [a["what"] for a in other["assumptions"]]
    # values that are not numbers are dashes in tables
    for words in (["noh_2d", "n=16^2", "t_end=0.001"], ["noh_1d", "n=64", "t_end=0"]):
        subprocess.run([PROGRAM, "run", *words, "--snapshot", path, "--quiet"], check=True)
        done = subprocess.run([PROGRAM, "judge", path], capture_output=True, text=True)
        assert done.returncode == 0 and "nan" not in done.stdout.replace(path, ""), done.stdout + done.stderr
    subprocess.run([PROGRAM, "run", case, "--snapshot", path, "--quiet"], check=True)
    for line, says in (("# box = -1:0.5\n", ("box", "positions")), ("# case = nope\n", "nope"),
                       ("# keys = left=1\n", ("left", "of its run")),
                       ("# box = 1:-1\n", "box = -2")):
        own = [one for one in rest[:6] if not one.startswith(line[:6])]  # a contradiction is refused as well
        refused(write(folder, "bad.csv", head + "".join(own) + line + "".join(rest[6:])), says=says)
    # judge counts rows of another type among the gas, and finds their mass missing; shifted gas has the same errors
    rows = [one for one in rest if one[0] not in "#\n"]
    whole = judge(path, "--case", case)
    typed = write(folder, "typed.csv", head.strip() + ",itype\n" + "".join(one for one in rest if one[0] == "#")
                  + "".join("%s,%d\n" % (one.strip(), i % 3 < 2) for i, one in enumerate(rows)))
    done = subprocess.run([PROGRAM, "judge", typed, "--case", case, "--gate", "mass=1e-3"], capture_output=True, text=True)
    assert done.returncode == 1 and "%d of %d rows" % (-(-2 * len(rows) // 3), len(rows)) in done.stdout, done
    assert "gate mass " in done.stdout and "times that of the case in this box" in done.stdout, done
    moved = write(folder, "moved.csv", head + "".join("%.17g,%s" % (float(one.split(",")[0]) + 1, one.split(",", 1)[1]) for one in rows))
    moved = judge(moved, "--case", case, "--time", repr(whole["time"]))
    assert moved["assumptions"] != whole["assumptions"]
    assert abs(moved["errors"]["density"]["l1"] / whole["errors"]["density"]["l1"] - 1) < 1e-6, (moved["errors"], whole["errors"])
    for text in ("1:2:3", "2:1", "-1", "x"):
        refused(path, "--window", text, says=("--window", "A:B"))


# ---- refused input ----


def hostile(folder, hdf5):
    """Options that a snapshot excludes, and damaged files of HDF5. (Other options: the transcripts; truncated or
    damaged files: the tests of readers.)"""
    draw = random.Random(1)
    refused(BINARY, "--case", "gresho", says="dimensions")
    refused(BINARY, "--case", "gresho", "--x0", "1", says="--x0")
    refused(BINARY, "--case", "sod", "--x0", "50", says=("--x0", "0 to 2"))
    refused(BINARY, "--case", "sod", "--time", "0.5", says=("waves", "snapshot's time"))
    refused(BINARY, "--case", "sod", "--map", "rho=d", says="--map is for text")
    refused(BINARY, "--left", "1 0 1", "--right", "1 0 0.1", says="--gamma")
    with open(PHANTOM, "rb") as file:
        packed = file.read()
    refused(write(folder, "cut.gz", packed[:5000]), "--case", "sod", says="")
    if hdf5:
        for name in ("gizmo_sod1d_dsph_n396.hdf5", "swift_sod1d_sphenix_n396.hdf5"):
            with open(os.path.join(DATA, name), "rb") as file:
                data = file.read()
            for size in (600, 2000, len(data) // 2, len(data) - 1000):
                refused(write(folder, "cut.hdf5", data[:size]), "--case", "sod", says="")
            for _ in range(6):  # the library must not crash the test
                changed = bytearray(data)
                for _ in range(200):
                    changed[draw.randrange(len(data))] = draw.randrange(256)
                call(write(folder, "damaged.hdf5", bytes(changed)), "--case", "sod")


def nothing_known(folder):
    """After the reference's last time nothing is compared, which is a failure."""
    path = os.path.join(folder, "late_billow.csv")
    subprocess.run([PROGRAM, "run", "kelvin_helmholtz", "n=12^2", "t_end=1.6", "--snapshot", path, "--quiet"], check=True)
    got = judge(path, status=1)
    assert "nothing was compared" in got["verdict"] and got["findings"][0]["status"] == "undetermined", got
    assert [(f["name"], f["status"]) for f in got["findings"][1:]] == [("comparison", "fail")], got["findings"]
    judge(path, "--allow-far", status=0)
    judge(path, "--gate", "mass=1e-9", status=0)


def one_list_of_findings(folder):
    """Exit status, JSON, JUnit, terminal and page agree on gates of every kind, including the case's own."""
    ladder = []
    for n in (100, 200, 400, 800):
        ladder.append(os.path.join(folder, "sod%d.csv" % n))
        subprocess.run([PROGRAM, "run", "sod", "n=%d" % n, "--snapshot", ladder[-1], "--quiet"], check=True)
    for words, status, said in (
            (["--gate", "order.density>=0.5,energy<=1e-9,density_l1.shock=1"], 0, ["pass"] * 3),
            (["--gate", "order.density>=3"], 1, ["fail"]),
            (["--gate", "order.velocity>=0.9"], 1, ["undetermined"]),
            (["--gates", "case"], 0, ["pass", "undetermined", "pass", "pass", "pass"]),
            (["--gates", "case", "--gate", "velocity_linf=1e-30"], 1, ["fail", "pass", "undetermined", "pass", "pass", "pass"])):
        xml, page = os.path.join(folder, "j.xml"), os.path.join(folder, "j.html")
        got = judge(*ladder, *words, "--junit", xml, "--html", page, status=status)
        assert [g["status"] for g in got["gates"]] == said, (words, got["gates"])
        # a requested gate that cannot be decided fails in all of them
        reported = ["fail" if s == "undetermined" and g["source"] == "--gate" else s for s, g in zip(said, got["gates"])]
        assert [f["status"] for f in got["findings"]] == ["pass"] * 4 + reported, (words, got["findings"])
        assert got["status"] == ("fail" if "fail" in reported else "pass"), (words, got["status"])
        tests = ElementTree.parse(xml).findall(".//testcase")
        assert [t.get("name") for t in tests] == [f["name"] for f in got["findings"]], words
        assert [{"failure": "fail", "skipped": "undetermined"}[t[0].tag] if len(t) else "pass" for t in tests] == \
            [f["status"] for f in got["findings"]], words
        reported = subprocess.run([PROGRAM, "judge", *ladder, *words], capture_output=True, text=True, timeout=120).stdout
        with open(page, encoding="utf-8") as file:
            html = file.read()
        for gate in got["gates"]:
            assert ": %s" % gate["status"] in next(line for line in reported.split("\n") if line.startswith("gate %s " % gate["name"]))
            assert "<code>%s</code>" % gate["name"] in html, gate
        assert reported.endswith(got["headline"] + "\n") and got["headline"].replace("<", "&lt;").replace(">", "&gt;") in html, reported
    bound = next(g for g in judge(ladder[1], "--gates", "case")["gates"] if g["name"] == "density_l1")
    near("the case's bound", bound["bound"], 1.5e-3 * (1584 / 200) ** 0.85, 1e-9)
    assert bound["source"] == "case sod: 0.0015 at n = 1584, raised by order 0.85 to n = 200", bound
    # a tube of half the length has the same spacing with half the number of particles
    short = tube(os.path.join(folder, "short.csv"), 0.2, n=100)
    asked = [short, "--case", "sod", "--time", "0.2", "--gates", "case", "--box", "0:1"]
    assert judge(*asked)["gates"][0]["source"].endswith("to n = 200"), judge(*asked)["gates"][0]
    refused(*asked[:4], "0.1", *asked[5:], "--allow-far", says=("t = 0.2", "at t = 0.1"))
    refused(*asked, "--left", "1 0 2", "--allow-far", says=("another initial state", "[converge]"))
    refused(*asked[:6], "all", "--box", "0:1", says=("--gates 'all'", "allowed: case"))
    refused(write(folder, "three.csv", "x,y,z,vx,vy,vz,m,rho,u\n" + "".join("%r,%r,%r,0,0,0,1,1,2.5\n" % (i % 4, i // 4 % 4, i // 16) for i in range(64))),
            "--case", "sod", "--gates", "case", "--time", "0.2", says=("in 1 dimensions", "for 3"))
    # a user's own case has bounds of its own
    text = open(os.path.join(CASES, "sod.ini"), encoding="utf-8").read()
    for bound, status in (("9e-3", 0), ("1e-5", 1)):
        case = write(folder, "own.ini", text[:text.index("[converge]")] + "[converge]\nn = 100 200 400 800\ndensity_l1 = 0.8 1.2 %s\n" % bound)
        got = judge(ladder[1], "--case", case, "--gates", "case", status=status)
        assert got["gates"][0]["source"].startswith("case own: "), got["gates"][0]
    case = write(folder, "own.ini", text[:text.index("[converge]")])
    refused(ladder[1], "--case", case, "--gates", "case", says=("own has none", "[converge]"))


def tube(path, t, lo=0.0, hi=1.0, n=400):
    """Sod's tube as in textbooks: exact, between two ends."""
    step = (hi - lo) / n
    said = subprocess.run([PROGRAM, "riemann", "1", "0", "1", "0.125", "0", "0.1", "--time", repr(t), "--x0", "0.5",
                           "--sample", "%r:%r:%d" % (lo + step / 2, hi - step / 2, n), "--json", "-"],
                          capture_output=True, text=True, check=True)
    with open(path, "w", encoding="ascii") as file:
        file.write("x,vx,m,rho,u,P\n")
        for s in json.loads(said.stdout)["samples"]:
            file.write("%r,%r,%r,%r,%r,%r\n" % (s["x"], s["velocity"], s["density"] * step, s["density"],
                                               s["pressure"] / (0.4 * s["density"]), s["pressure"]))
    return path


def main():
    hdf5 = with_hdf5()
    against_script(hdf5)
    if with_zlib():
        phantom()
    with tempfile.TemporaryDirectory() as folder:
        files_of_ours(folder, hdf5)
        if hdf5:
            without_its_library(folder)
        one_list_of_findings(folder)
        nothing_known(folder)
        hostile(folder, hdf5)
    print("real codes, our own runs, findings, hostile files: all as they should be")


main()
