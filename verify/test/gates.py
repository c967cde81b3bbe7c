# SPDX-License-Identifier: GPL-3.0-or-later
"""gates.py SPHPROOF: tests gates on errors. The default scheme passes them at small sizes; schemes that are known
to be worse fail the gates that are named here, and no others."""
import json

from script import call, play, write



def gates(*words):
    """Exit status, and the status of each gate: {"growth_rate": "pass", "density_l1": "fail"}."""
    done = call("converge", *words, "--json", "-")
    assert done.returncode in (0, 1), done
    found = {}
    for order in json.loads(done.stdout)["orders"]:
        if order["gate"] is None:
            continue
        name = order["field"] if order["norm"] == "error" else "%s_%s" % (order["field"], order["norm"])
        found[name] = order["status"]
        if order["status"] == "fail" and order["gate"]["low"] == "-inf":
            assert "finest error" in order["why"], order
    return done.returncode, found


def passes(*words, **extra):
    """Errors are within the bounds; small ladders may be too coarse, or orders too uncertain, for a pass."""
    status, found = gates(*words)
    well = status == 0 and sorted(found) == sorted(extra["gates"])
    assert well and set(found.values()) <= {"pass", "smoke", "undetermined"}, \
        "%s: exit status %d, %s" % (" ".join(words), status, found)


def fails(*words, **extra):
    status, found = gates(*words)
    failed = sorted(name for name in found if found[name] == "fail")
    assert (status, failed) == (1, sorted(extra["gates"])), "%s: exit status %d, %s" % (" ".join(words), status, found)


def main():
    shear, mode = ["shear", "--n", "16^2,20^2,24^2,28^2"], ["kelvin_helmholtz_mode", "--n", "16^2,20^2,24^2,28^2"]
    stratified = ["rayleigh_taylor_mode", "--n", "288,392,512,800"]
    passes(*shear, gates=["shear_viscosity"])
    fails(*shear, "gradient=standard", gates=["shear_viscosity"])
    passes(*mode, gates=["growth_rate", "mode_error"])
    fails(*mode, "gradient=standard", gates=["growth_rate"])
    passes(*stratified, gates=["growth_rate", "mode_error"])
    fails(*stratified, "gradient=standard", gates=["growth_rate", "mode_error"])
    passes("sound_wave_2d", gates=["velocity_l1", "mode_amplitude"])
    passes("sedov_2d", gates=["pressure_l1", "shock_radius", "peak_density"])
    # faults of dissipation and of sums show at these sizes
    rest, blast = ["rest_3d", "--n", "8^3,9^3,10^3,11^3"], ["sedov_3d", "--n", "10^3,11^3,12^3,20^3"]
    passes(*rest, gates=["velocity_rms", "density_l1", "pressure_l1"])
    fails(*rest, "noise=0", gates=["density_l1", "velocity_rms"])
    passes(*blast, gates=["shock_radius", "peak_density", "pressure_l1", "velocity_l1",
                          "kinetic_energy", "outward_momentum", "thermal_radius", "asymmetry"])
    # a square whose particles have equal spacing does not change at all
    write("spacing.ini", "[case]\ntitle = A square\ndimension = 2\nreference = square\n[domain]\nlo = 0\nhi = 1\n"
          "[initial]\nkind = square\nequal_masses = no\n[run]\nt_end = 0.3\nn = 400\n"
          "[measure]\nexact = density velocity pressure internal_energy\n"
          "[converge]\nn = 12^2 16^2 20^2 24^2\nvelocity_rms = 0 1e-12\npressure_l1 = 0 4e-3\n")
    passes("./spacing.ini", gates=["velocity_rms", "pressure_l1"])
    fails("./spacing.ini", "volume_element=mass", gates=["velocity_rms", "pressure_l1"])
    # no gate without an exact value; a gate on a field's error alone, which no order excuses
    text = ("[case]\ntitle = A wave\ndimension = 2\nreference = simple_wave\n[domain]\nlo = 0\nhi = 1\n"
            "[initial]\nkind = sound_wave\nbackground = 1 0 1\ndirection = 1 0\namplitude = 0.01\n[run]\nt_end = 0.3\nn = 400\n[converge]\n"
            "n = 12^2 14^2 16^2 20^2\n")
    for bound, judged in ((1, passes), (1e-7, fails)):
        write("wave.ini", text + "velocity_l1 = 1 %g\n" % bound)
        judged("./wave.ini", gates=["velocity_l1"])


play(main)
