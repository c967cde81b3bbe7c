# SPDX-License-Identifier: GPL-3.0-or-later
"""starts.py SPHPROOF: initial states of runs, and the ends of their boxes.

Particles of a file are those of the case that wrote it; a file beside a case file is found from any folder; without a
reference errors are null; walls and gravity of a case are those of `rates` with the same words."""
import sys

from script import call, json_of, play, read, write


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
[scheme]
shifting = none
[run]
gamma = 1.6666666666666667
t_end = 0.05
"""


def found(*words):
    return json_of(*words, "--threads", "1")


def rows(path):
    """The names and the particles, without the comments about the run."""
    return [line for line in read(path).split("\n")[:-1] if line[0] != "#"]


def apart(first, second):
    """The largest difference of two snapshots."""
    pairs = list(zip(rows(first)[1:], rows(second)[1:]))
    demand(len(pairs) == 576, "%d particles" % len(pairs))
    return max(abs(float(a) - float(b)) for one, two in pairs for a, b in zip(one.split(","), two.split(",")))


def demand(condition, what):
    if not condition:
        sys.exit(what)


def files():
    start, ours, theirs = "start.csv", "a.csv", "b.csv"
    keys = ["n=24^2", "jitter=0.1", "shifting=none"]
    found("run", "gresho", *keys, "t_end=0", "--snapshot", start)
    plain = found("run", "gresho", *keys, "t_end=0.05", "--snapshot", ours)
    case = "./judged.ini"
    write(case, CASE % ("gresho", ""))
    judged = found("run", case, "--snapshot", theirs)
    demand(judged["n"] == judged["settings"]["n"] == 576, "the number of particles is the file's")
    demand(apart(ours, theirs) <= 1e-8, "particles of a file move otherwise than those of the case: %g" % apart(ours, theirs))
    for document in (judged, found("run", "gresho", "file=" + start, "t_end=0.05", "shifting=none")):
        for field, norms in plain["errors"].items():
            for norm, value in (norms or {}).items():
                other = document["errors"][field][norm]
                demand(value is other or abs(other - value) <= 1e-6 * abs(value), "%s %s: %r, not %r" % (field, norm, other, value))
    case = "./alone.ini"
    write(case, CASE % ("none", ""))
    alone = found("run", case, "--snapshot", theirs)
    # their first guess of the density differs
    demand(apart(ours, theirs) <= 1e-8, "particles of a file move otherwise without a reference")
    demand(all(v is None for f, e in alone["errors"].items() if e for v in e.values()), "errors of what is not known")
    demand(alone["conservation"]["energy"] <= 1e-12, "conservation without a reference")
    write(case, CASE % ("riemann", ""))
    done = call("run", case)
    demand(done.returncode == 2 and "left" in done.stderr, "a reference's own keys are needed: " + done.stderr)


def ends():
    """A case's boundary and gravity against the same words of rates; defaults from the case file."""
    start, case = "start.csv", "./ends.ini"
    for boundary in ("periodic reflecting", "open", "reflecting"):
        write(case, CASE % ("none", "boundary = %s\ngravity = 0.25 -1" % boundary))
        own = found("rates", case)
        want = found("rates", start, "lo=0", "hi=1", "gamma=1.6666666666666667", "boundary=" + boundary, "gravity=0.25 -1")
        for one, two in zip(own["particles"], want["particles"]):
            same = all(abs(a - b) <= 1e-9 for a, b in zip([one["rho"], *one["force"]], [two["rho"], *two["force"]]))
            demand(same and one["neighbours"] == two["neighbours"], "boundary=%s of a case" % boundary)
        words = boundary.split()
        demand(own["settings"]["boundary"] == (words if len(words) > 1 else boundary), "boundary as used")
        demand(own["settings"]["gravity"] == [0.25, -1], "gravity as used")
    walls = found("rates", "gresho", "n=24^2", "boundary=reflecting")
    demand(walls["particles"] != found("rates", "gresho", "n=24^2")["particles"], "walls change nothing")
    demand(found("rates", "gresho", "n=24^2")["settings"]["boundary"] == "periodic", "boundary by default")
    # momentum that walls take is no error: along them it is conserved
    run = found("run", "rest_2d", "n=16^2", "t_end=0.2", "boundary=periodic,reflecting")
    demand(run["conservation"]["momentum"] <= 1e-13, "momentum along walls")
    # fixed layers drag the gas beside them: momentum along them is not checked
    keys = ["kernel=cubic_spline", "eta=1.8", "gradient=standard", "viscosity=constant"]
    run = found("run", "rest_2d", "n=28^2", "t_end=0.05", "boundary=periodic,fixed", *keys)
    demand(run["conservation"]["momentum"] == 0, "momentum along layers")


play(files, ends)
