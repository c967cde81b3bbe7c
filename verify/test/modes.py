# SPDX-License-Identifier: GPL-3.0-or-later
"""modes.py SPHPROOF [real]: runs that start from growing modes.

The initial state is the requested mode; it grows at the rate of linear theory, and in proportion to its amplitude;
the two parities of a periodic layer do not mix; a boost changes nothing.

real: at 64 spacings per wavelength, by night. Gates of the default scheme there, also from a disturbed start; the two
viscosities and the two gradients differ as documented: with plain constant viscosity the mode is damped with any
gradient, and without it ia is nearer."""
import sys

from script import expect, json_of, play

CASE = "kelvin_helmholtz_mode"
STRATIFIED = "rayleigh_taylor_mode"
RATES = {"sinuous": 1.705572193, "varicose": 1.481793027}  # computed by two other methods


def run(*words, case=CASE, n="24^2"):
    document = json_of("run", case, "n=" + n, *words, timeout=900)
    return tuple({entry["name"]: entry[what] for entry in document["functionals"]} for what in ("value", "reference"))


def most(what, value, bound):
    expect(what, value <= bound, "%.3g, more than %.3g" % (value, bound))


def starts():
    """Right after the start, U = 1/2: on a lattice sums are nearly integrals."""
    for parity in RATES:
        values, _ = run("t_end=1e-9", "amplitude=2e-3", "parity=" + parity)
        most(parity + ": amplitude of the start", abs(values["mode_amplitude"] / 1e-3 - 1), 1e-5)
        most(parity + ": error of the start", values["mode_error"], 1e-3)
        most(parity + ": noise of the start", values["mode_noise"], 1e-3)
        most(parity + ": the other parity at the start", values["other_parity"], 1e-10)


def grows():
    """With 24 spacings per wavelength errors are some percent."""
    for parity, rate in RATES.items():
        values, exact = run("parity=" + parity, *(["t_end=1"] if parity == "varicose" else []))
        most(parity + ": its exact rate", abs(exact["growth_rate"] / rate - 1), 1e-8)
        most(parity + ": rate", abs(values["growth_rate"] / rate - 1), 0.15)
        most(parity + ": shape", values["mode_error"], 0.15)
        most(parity + ": the other parity", values["other_parity"], 1e-10)


def is_linear():
    """The damping by viscosity is not proportional to the amplitude, but is weaker than the growth."""
    ends = [run("t_end=0.5", "amplitude=" + amplitude, *more)[0]["mode_amplitude"] / float(amplitude)
            for amplitude, more in (("1e-4", []), ("1e-5", []), ("1e-4", ["boost=1 0.5"]))]
    most("a tenth of the amplitude", abs(ends[1] / ends[0] - 1), 1e-3)
    most("boosted", abs(ends[2] / ends[0] - 1), 1e-6)


def is_heavy():
    """Dense gas over thin gas: as above; in a box twice as high with half the gravity the growth takes twice as long."""
    values, exact = run("t_end=0.9", case=STRATIFIED, n="512")
    most("stratified: its exact rate", abs(exact["growth_rate"] / 1.170903153 - 1), 1e-8)
    most("stratified: rate", abs(values["growth_rate"] / 1.170903153 - 1), 0.15)
    most("stratified: shape", values["mode_error"], 0.2)
    values, _ = run("t_end=1e-9", case=STRATIFIED, n="1152")
    most("stratified: amplitude of the start", abs(values["mode_amplitude"] / 5e-4 - 1), 1e-5)
    most("stratified: error of the start", values["mode_error"], 1e-3)
    _, large = run("t_end=1e-9", "lo=0 -1", "hi=1 1", "gravity=0 -0.25", case=STRATIFIED, n="512")
    most("stratified, twice as large: rate", abs(2 * large["growth_rate"] / exact["growth_rate"] - 1), 1e-10)


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


play(*((is_accurate, gradients_differ) if sys.argv[2:] == ["real"] else (starts, grows, is_linear, is_heavy)))
