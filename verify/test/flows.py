# SPDX-License-Identifier: GPL-3.0-or-later
"""flows.py SPHPROOF: tests every case in 2D and 3D at a small size, with its default scheme.

Each must conserve, and be near the limit of some functionals."""
from script import expect, json_of, play

SMALL = {"sod_2d": ["n=1400", "t_end=0.1"], "sod_3d": ["n=9216", "t_end=0.02"],
         "sound_wave_2d": ["n=16^2", "direction=1 1", "t_end=0.2"], "sound_wave_3d": ["n=10^3", "t_end=0.1"],
         "gresho": ["n=32^2", "t_end=0.3", "boost=0.5 0.25"], "yee": ["n=20^2", "t_end=1"],
         "kelvin_helmholtz": ["n=32^2", "t_end=0.5"], "kelvin_helmholtz_mode": ["n=24^2", "t_end=0.4"], "rayleigh_taylor_mode": ["n=512", "t_end=0.4"],
         "square": ["n=24^2", "t_end=0.2"],
         "rest_2d": ["n=16^2", "t_end=0.5"], "rest_3d": ["n=10^3", "t_end=0.1"],
         "sedov_2d": ["n=32^2"], "sedov_3d": ["n=14^3", "t_end=0.03"],
         "noh_2d": ["n=30^2", "t_end=0.3"], "noh_3d": ["n=10^3", "t_end=0.2"],
         "rotation": ["n=24^2"], "shear": ["n=24^2", "t_end=0.5", "direction=1 1"]}
# exact values of functionals, and tolerances at this size
NEAR = {"sedov_2d": {"shock_radius": (0.4, 0.02)}, "rotation": {"disc_radius": (1.5811388, 0.01), "angular_speed": (0.4, 0.01)},
        "shear": {"shear_amplitude": (1, 0.05)}, "noh_2d": {"shock_radius": (0.1, 0.05)}}


def judge(name):
    document = json_of("run", name, *SMALL[name])
    kept = document["conservation"]
    scalars = {entry["name"]: entry["value"] for entry in document["functionals"]}
    expect("%s: status" % name, document["status"] == "ok", document["status"])
    # time steps of finite length give the work of gravity only approximately
    energy = 1e-12 if document["settings"]["gravity"] in (0, [0]) else 1e-6
    expect("%s: does not conserve" % name,
           kept["momentum"] <= 1e-13 and kept["energy"] <= energy and kept["mass"] <= 1e-13, kept)
    expect("%s: angular momentum" % name, kept["angular_momentum"] >= 0, kept["angular_momentum"])
    for key, (exact, allowed) in NEAR.get(name, {}).items():
        expect("%s: %s" % (name, key), abs(scalars[key] - exact) <= allowed, "%r, not %r" % (scalars[key], exact))


def every_case():
    settings = {case["name"]: json_of("run", case["name"], "--explain")["settings"]
                for case in json_of("list", "cases")["families"]["cases"]}
    # in 1D there is no boost, and liquids, which have a rho0, are not run
    names = {name for name, keys in settings.items() if "boost" in keys and "rho0" not in keys}
    expect("cases whose size flows.py says", names == set(SMALL), names ^ set(SMALL))
    for name in sorted(names & set(SMALL)):
        judge(name)


play(every_case)
