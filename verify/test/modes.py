# SPDX-License-Identifier: GPL-3.0-or-later
"""modes.py SPHPROOF: growing modes at 64 spacings per wavelength. They grow at the rate of linear theory, and in proportion
to their amplitude; a boost changes nothing; gates of the default scheme, also from a disturbed start; the two viscosities
and the two gradients differ as documented: with plain constant viscosity the mode is damped with any gradient, and without
it ia is nearer. (Initial states: test_mode; exact rates: verify exact; growth at small sizes: gates.py.)"""
from script import expect, json_of, play

CASE = "kelvin_helmholtz_mode"
STRATIFIED = "rayleigh_taylor_mode"


def run(*words, case=CASE, n="24^2"):
    document = json_of("run", case, "n=" + n, *words, timeout=900)
    return tuple({entry["name"]: entry[what] for entry in document["functionals"]} for what in ("value", "reference"))


def most(what, value, bound):
    expect(what, value <= bound, "%.3g, more than %.3g" % (value, bound))


def is_linear():
    """The damping by viscosity is not proportional to the amplitude, but is weaker than the growth."""
    ends = [run("t_end=0.5", "amplitude=" + amplitude, *more)[0]["mode_amplitude"] / float(amplitude)
            for amplitude, more in (("1e-4", []), ("1e-5", []), ("1e-4", ["boost=1 0.5"]))]
    most("a tenth of the amplitude", abs(ends[1] / ends[0] - 1), 1e-3)
    most("boosted", abs(ends[2] / ends[0] - 1), 1e-6)


def off(*words, **more):
    values, exact = run(*words, **more)
    return abs(values["growth_rate"] / exact["growth_rate"] - 1)


def is_accurate():
    coarse, fine = off(n="32^2"), off(n="64^2")
    most("shear", fine, 0.01)
    most("shear: half the spacing", 2 ** 1.8 * fine, coarse)
    most("shear, jitter", off("jitter=0.05", n="64^2"), 0.05)
    most("stratified", off(case=STRATIFIED, n="8192"), 0.01)


def gradients_differ():
    standard = off("gradient=standard", n="64^2")
    most("ia against standard", 2 * off(n="64^2"), standard)
    cubic = ["kernel=cubic_spline", "viscosity=constant"]
    most("constant viscosity, ia", 0.1, off(*cubic, "gradient=ia", n="64^2"))
    most("constant viscosity, standard", 0.1, off(*cubic, "gradient=standard", n="64^2"))


play(is_linear, is_accurate, gradients_differ)
