#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares the Python module with physical laws and with the program, not with stored figures.

  python_module.py PROGRAM LIBRARY MODULE_FOLDER

Exit status 77 (skipped): no numpy, or this build makes no library."""
import os
import sys

program, library, folder = sys.argv[1:4]
sys.path.insert(0, folder)
sys.dont_write_bytecode = True
try:
    import numpy
except ImportError:
    print("no numpy for %s (Debian: python3-numpy)" % sys.executable)
    sys.exit(77)
if not os.path.exists(library):
    print("this build has no %s" % library)
    sys.exit(77)
os.environ.update(SPHPROOF=program, SPHPROOF_LIBRARY=library)
import sphproof  # noqa: E402

SOD = (1, 0, 1), (0.125, 0, 0.1)


def refused(status, call, *arguments, **keys):
    try:
        call(*arguments, **keys)
    except sphproof.Error as error:
        assert error.status == status and str(error), (error.status, str(error))
        return str(error)
    raise AssertionError("not refused: %s" % (arguments,))


def solutions():
    x = numpy.linspace(-0.5, 0.5, 101)
    state = sphproof.riemann(*SOD, x, t=0.2)
    assert state.rho.shape == x.shape and state.rho[0] == 1 and state.P[-1] == 0.1
    star = sphproof.star(*SOD)
    between = (x > 0.2 * star["speed"][1] + 1e-9) & (x < 0.2 * star["speed"][3] - 1e-9)
    assert between.sum() > 20 and abs(state.P[between] - star["P"]).max() < 1e-14
    # the mass between -0.5 and 0.5 is the initial one: no gas crosses the ends yet
    fine = (numpy.arange(20000) + 0.5) / 20000 - 0.5
    assert abs(sphproof.riemann(*SOD, fine, 0.2).rho.mean() - 0.5625) < 1e-4
    # the mirrored tube has the mirrored flow
    mirrored = sphproof.riemann(*SOD[::-1], -x, t=0.2)
    assert abs(mirrored.rho - state.rho)[between].max() < 1e-14 and abs(mirrored.v + state.v).max() < 1e-13
    grid = sphproof.sedov(numpy.full((2, 3), 0.1), 1.0)
    assert grid.rho.shape == (2, 3)
    for dim in (1, 2, 3):
        assert abs(sphproof.noh(0.01, 0.6, dim=dim).rho - 4 ** dim) < 1e-12
    r = (numpy.arange(4000) + 0.5) / 4000
    for vortex in (sphproof.gresho(r), sphproof.yee(5 * r)):
        R = r if vortex.v[-1] == 0 else 5 * r
        slope = numpy.gradient(vortex.P, R)
        assert abs(slope - vortex.rho * vortex.v ** 2 / R)[2:-2].max() < 0.02  # the pressure gradient is the centripetal force
    wave = sphproof.wave(x, 0.3)
    assert abs(wave.P - wave.rho ** 1.4).max() < 1e-13
    assert "allowed" in refused(2, sphproof.wave, x, 1e9)
    refused(2, sphproof.riemann, (1, 0), SOD[1], x, 0.2)
    refused(2, sphproof.riemann, (-1, 0, 1), SOD[1], x, 0.2)
    refused(2, sphproof.sedov, x, 1.0, dim=4)


def runs():
    sod = sphproof.run("sod", n=198, left=SOD[0])
    p = sod["particles"]
    assert len(p["x"]) == sod["n"] and sod["exit_status"] == 0 and sod["settings"]["left"] == [1, 0, 1]
    inside = abs(p["x"]) <= 0.5
    volume = p["m"] / p["rho"]
    exact = sphproof.riemann(*SOD, p["x"], 0.2)
    ours = (volume * abs(p["rho"] - exact.rho))[inside].sum() / volume[inside].sum()
    theirs = sod["errors"]["density"]["l1"]
    assert 0 < theirs < 0.02 and abs(ours / theirs - 1) < 1e-9, (ours, theirs)
    judged = sphproof.judge(p, case="sod", time=0.2)
    assert abs(judged["errors"]["density"]["l1"] / theirs - 1) < 1e-6 and judged["verdict"]
    assert sphproof.judge(p, case="sod", time=0.2, gate="density_l1=1e-9")["exit_status"] == 1
    by_states = sphproof.judge(p, left=SOD[0], right=SOD[1], gamma=1.4, time=0.2)
    assert abs(by_states["errors"]["density"]["l1"] / theirs - 1) < 1e-6
    assert "kernel" in refused(2, sphproof.run, "sod", kernel="none")
    far = dict(p, rho=p["rho"] * 3)
    for allowed, status in (True, 0), (False, 1), (None, 1):
        said = sphproof.judge(far, case="sod", time=0.2, h_is="half", allow_far=allowed)
        assert said["exit_status"] == status and said["kernel"]["candidates"][0]["ratio"] == 2, (allowed, said)
    start = sphproof.run("sod", n=198, t_end=0)["particles"]
    for zero in 0, 0.0, numpy.float64(0):  # a value, not a missing one
        judged = sphproof.judge(start, case="sod", time=zero, x0=zero)
        assert judged["time"] == 0 and any(one["evidence"] == "--x0" for one in judged["assumptions"]), judged
    refused(2, sphproof.judge, {"x": [1, 2], "rho": [1]}, case="sod")
    os.environ["SPHPROOF"] = program + "_that_is_nowhere"
    try:
        sphproof.run("sod")
        raise AssertionError("a program that is nowhere runs")
    except (OSError, sphproof.Error):
        os.environ["SPHPROOF"] = program


def forces():
    random = numpy.random.default_rng(7)
    x = (numpy.stack(numpy.meshgrid(*[numpy.arange(8)] * 2), -1).reshape(-1, 2) + 0.5 + 0.4 * random.random((64, 2))) / 8 % 1
    v, u = random.random((64, 2)), 1 + random.random(64)
    keys = dict(lo=0, hi=1, kernel="wendland_c4", gamma=1.4)
    first = sphproof.rates(x, v, 1 / 64, u, **keys)
    assert first["force"].shape == (64, 2) and first["rho"].shape == (64,)
    assert abs(first["force"].sum(0)).max() < 1e-12 and abs(first["force"]).max() > 1e-4
    order = random.permutation(64)
    second = sphproof.rates(x[order], v[order], 1 / 64, u[order], **keys)
    assert abs(second["force"] - first["force"][order]).max() < 1e-12
    walls = sphproof.rates(x, v, 1 / 64, u, boundary=("periodic", "reflecting"), balsara=True, viscosity="constant", **keys)
    settings = walls["document"]["settings"]
    assert settings["boundary"] == ["periodic", "reflecting"] and settings["balsara"] == "on", settings
    line = sphproof.rates(x[:8, 0], v[:8, 0], numpy.full(8, 0.1), u[:8], lo=0, hi=1)
    assert line["force"].shape == (8, 1)
    refused(2, sphproof.rates, x, v, -1, u, **keys)
    refused(2, sphproof.rates, x, v[:, 0], 1 / 64, u, **keys)


solutions(), runs(), forces()
print("the module is right")
