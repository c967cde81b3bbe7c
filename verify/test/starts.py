# SPDX-License-Identifier: GPL-3.0-or-later
"""starts.py SPHPROOF: what runs start from, and what is at the ends of their boxes.

Particles of a file are the same as those of the case that wrote it; a file beside a case file is
found from anywhere; without a reference there are no errors but null; walls and gravity of a case
are those of `rates` with the same words."""
import json
import os
import subprocess
import sys
import tempfile

SPHPROOF = os.path.abspath(sys.argv[1])

CASE = """[case]
title = Particles of a file
dimension = 2
reference = %s
[domain]
lo = 0
hi = 1
%s
[initial]
kind = particles
file = start.csv
[run]
gamma = 1.6666666666666667
t_end = 0.05
"""


def call(*words, status=0):
    done = subprocess.run([SPHPROOF, *words, "--json", "-", "--threads", "1"], capture_output=True, text=True)
    if done.returncode != status:
        sys.exit("%s: exit %d, not %d: %s" % (" ".join(words), done.returncode, status, done.stderr))
    return json.loads(done.stdout) if done.stdout else None


def write(path, text):
    with open(path, "w", encoding="ascii") as f:
        f.write(text)


def read(path):
    with open(path, encoding="utf-8", errors="surrogateescape") as f:
        return f.read()


def rows(path):
    """The names and the particles, without what the snapshot says of its run."""
    return [line for line in read(path).split("\n")[:-1] if line[0] != "#"]


def apart(first, second):
    """The largest difference of two snapshots."""
    pairs = list(zip(rows(first)[1:], rows(second)[1:]))
    demand(len(pairs) == 576, "%d particles" % len(pairs))
    return max(abs(float(a) - float(b)) for one, two in pairs for a, b in zip(one.split(","), two.split(",")))


def demand(condition, what):
    if not condition:
        sys.exit(what)


def files(folder):
    start, ours, theirs = (os.path.join(folder, name) for name in ("start.csv", "a.csv", "b.csv"))
    keys = ["n=24^2", "jitter=0.1"]
    call("run", "gresho", *keys, "t_end=0", "--snapshot", start)
    plain = call("run", "gresho", *keys, "t_end=0.05", "--snapshot", ours)
    case = os.path.join(folder, "judged.ini")
    write(case, CASE % ("gresho", ""))
    judged = call("run", case, "--snapshot", theirs)
    demand(judged["n"] == judged["settings"]["n"] == 576, "the number of particles is the file's")
    demand(apart(ours, theirs) <= 1e-8, "particles of a file move otherwise than those of the case: %g" % apart(ours, theirs))
    for found in (judged, call("run", "gresho", "file=" + start, "t_end=0.05")):
        for field, norms in plain["errors"].items():
            for norm, value in (norms or {}).items():
                other = found["errors"][field][norm]
                demand(value is other or abs(other - value) <= 1e-6 * abs(value), "%s %s: %r, not %r" % (field, norm, other, value))
    case = os.path.join(folder, "alone.ini")
    write(case, CASE % ("none", ""))
    alone = call("run", case, "--snapshot", theirs)
    # their first guess of the density is another one
    demand(apart(ours, theirs) <= 1e-8, "particles of a file move otherwise without a reference")
    demand(all(v is None for f, e in alone["errors"].items() if e for v in e.values()), "errors of what is not known")
    demand(alone["conservation"]["energy"] <= 1e-12, "conservation without a reference")
    write(case, CASE % ("riemann", ""))
    done = subprocess.run([SPHPROOF, "run", case], capture_output=True, text=True)
    demand(done.returncode == 2 and "left" in done.stderr, "a reference's own keys are needed: " + done.stderr)


def ends(folder):
    """A case's boundary and gravity against the same words of rates; defaults by the case file."""
    start, case = os.path.join(folder, "start.csv"), os.path.join(folder, "ends.ini")
    for boundary in ("periodic reflecting", "open", "reflecting"):
        write(case, CASE % ("none", "boundary = %s\ngravity = 0.25 -1" % boundary))
        found = call("rates", case)
        want = call("rates", start, "lo=0", "hi=1", "gamma=1.6666666666666667", "boundary=" + boundary, "gravity=0.25 -1")
        for one, two in zip(found["particles"], want["particles"]):
            same = all(abs(a - b) <= 1e-9 for a, b in zip([one["rho"], *one["force"]], [two["rho"], *two["force"]]))
            demand(same and one["neighbours"] == two["neighbours"], "boundary=%s of a case" % boundary)
        words = boundary.split()
        demand(found["settings"]["boundary"] == (words if len(words) > 1 else boundary), "boundary as used")
        demand(found["settings"]["gravity"] == [0.25, -1], "gravity as used")
    walls = call("rates", "gresho", "n=24^2", "boundary=reflecting")
    demand(walls["particles"] != call("rates", "gresho", "n=24^2")["particles"], "walls change nothing")
    demand(call("rates", "gresho", "n=24^2")["settings"]["boundary"] == "periodic", "boundary by default")
    # momentum that walls take is no error: along them it is kept
    run = call("run", "rest_2d", "n=16^2", "t_end=0.2", "boundary=periodic,reflecting")
    demand(run["conservation"]["momentum"] <= 1e-13, "momentum along walls")
    # layers that are kept drag what is beside them: nobody asks for momentum along them
    keys = ["kernel=cubic_spline", "eta=1.8", "gradient=standard", "viscosity=constant"]
    run = call("run", "rest_2d", "n=28^2", "t_end=0.05", "boundary=periodic,fixed", *keys)
    demand(run["conservation"]["momentum"] == 0, "momentum along layers")


def columns(path):
    lines = rows(path)
    return {name: [float(line.split(",")[k]) for line in lines[1:]] for k, name in enumerate(lines[0].split(","))}


def glasses(folder):
    """Seeded, far more even than random points, and where masses are equal as dense as the gas."""
    path = os.path.join(folder, "glass.csv")

    def start(case, *words):
        document = call("run", case, "t_end=0", *words, "--snapshot", path)
        return document, columns(path)

    for case, n, bound in (("rest_2d", "24^2", 0.01), ("rest_3d", "8^3", 0.006)):
        glass, first = start(case, "n=" + n, "lattice=glass")
        demand(glass["start"]["density_rms"] <= bound, "%s: %r" % (case, glass["start"]))
        # the same sum over neighbours, once by the solver with the widths that it finds
        error = glass["errors"]["density"]["l2"]
        demand(abs(error / glass["start"]["density_rms"] - 1) <= 0.3, "%s: %r, %r" % (case, glass["start"], error))
    random, _ = start("rest_2d", "n=24^2", "lattice=random")
    demand(random["errors"]["density"]["l2"] >= 0.05 and "start" not in random, "random points: %r" % random["errors"])
    demand(0.01 < glass["start"]["spread"] < 0.2, "distances of neighbours in a glass: %r" % glass["start"])
    again = start("rest_2d", "n=24^2", "lattice=glass")[1]
    demand(start("rest_2d", "n=24^2", "lattice=glass")[1] == again, "a glass is not repeated")
    demand(start("rest_2d", "n=24^2", "lattice=glass", "seed=2")[1] != again, "the seed changes nothing")
    _, equal = start("kelvin_helmholtz", "n=40^2", "equal_masses=yes")
    demand(len(set(equal["m"])) == 1 and len(equal["m"]) == 1600, "masses are not equal")
    inside = [rho for y, rho in zip(equal["y"], equal["rho"]) if 0.4 < y < 0.6]
    outside = [rho for y, rho in zip(equal["y"], equal["rho"]) if y < 0.1 or y > 0.9]
    demand(abs(sum(inside) / len(inside) - 2) <= 0.05 and abs(sum(outside) / len(outside) - 1) <= 0.05, "their density")
    demand(abs(len(inside) / len(outside) - 2) <= 0.1, "%d, %d: places do not follow the density" % (len(inside), len(outside)))
    _, spaced = start("kelvin_helmholtz", "n=40^2")
    demand(max(spaced["m"]) > 1.9 * min(spaced["m"]), "masses at equal spacing")


def hdf5(folder):
    """A snapshot in HDF5 holds what the one in CSV holds; read by `judge` and, where it is, by h5py."""
    paths = [os.path.join(folder, name) for name in ("end.csv", "end.hdf5")]
    words = [SPHPROOF, "run", "gresho", "n=20^2", "t_end=0.05", "--snapshot"]
    done = [subprocess.run(words + [path], capture_output=True, text=True) for path in paths]
    if "built without HDF5" in done[1].stderr:
        demand(done[1].returncode == 4 and not os.path.exists(paths[1]), "without HDF5: " + done[1].stderr)
        return
    demand(done[1].returncode == 0, done[1].stderr)
    one, two = (call("judge", path, "--case", "gresho", "--time", "0.05", "--gamma", "1.6666666666666667") for path in paths)
    demand(one["n"] == two["n"] == 400 and two["dim"] == 2, "judge of HDF5")
    for field, norms in one["errors"].items():
        for norm, value in (norms or {}).items():
            demand(value == two["errors"][field][norm], "HDF5: %s %s" % (field, norm))
    try:
        import h5py
    except ImportError:
        return
    state = columns(paths[0])
    with h5py.File(paths[1], "r") as f:
        gas, header = f["PartType0"], f["Header"].attrs
        demand(header["NumPart_ThisFile"][0] == 400 and header["BoxSize"] == 1 and header["Time"] == 0.05, "header")
        for name, column in (("Masses", "m"), ("Density", "rho"), ("InternalEnergy", "u"), ("SmoothingLength", "h")):
            demand(gas[name].dtype == "f8" and list(gas[name]) == state[column], name)
        demand(list(gas["Coordinates"][:, 1]) == state["y"] and gas["Coordinates"].shape == (400, 3), "positions")
        demand(list(gas["Velocities"][:, 0]) == state["vx"] and not gas["Velocities"][:, 2].any(), "velocities")


def kept(folder):
    """A glass is relaxed once, and read after that; one that is damaged is made again."""
    def entries():
        place = os.path.join(folder, "sphproof", "glass")
        return [os.path.join(at, name) for at, _, names in os.walk(place) for name in names]

    def points(*words):
        path = os.path.join(folder, "kept.csv")
        call("run", "rest_2d", "n=32^2", "t_end=0", "lattice=glass", *words, "--snapshot", path)
        return read(path)

    before = entries()
    first = points()
    new = [e for e in entries() if e not in before]
    demand(len(new) == 1, "a glass is not kept: %r" % new)
    made = os.stat(new[0]).st_ino
    demand(points() == first and os.stat(new[0]).st_ino == made, "a glass that is kept is not read, or is another one")
    text = read(new[0])
    write(new[0], text[:len(text) // 2])
    demand(points() == first and read(new[0]) == text, "a damaged glass is used")
    demand(points("seed=2") != first and len(entries()) == len(before) + 2, "glasses of two seeds are one")


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.environ["XDG_CACHE_HOME"] = folder
        kept(folder)
        files(folder)
        ends(folder)
        glasses(folder)
        hdf5(folder)
    print("particles of files and ends of boxes are what the cases say")


main()
