# SPDX-License-Identifier: GPL-3.0-or-later
"""flows.py SPHPROOF: every case of 2D and 3D at a small size, with its default scheme.

Each must conserve, and come near to what some functionals are in the limit."""
import json
import os
import subprocess
import sys

SMALL = {"sod_2d": ["n=1400", "t_end=0.1"], "sod_3d": ["n=9216", "t_end=0.02"],
         "sound_wave_2d": ["n=16^2", "direction=1 1", "t_end=0.2"], "sound_wave_3d": ["n=10^3", "t_end=0.1"],
         "gresho": ["n=32^2", "t_end=0.3", "boost=0.5 0.25"], "yee": ["n=20^2", "t_end=1"],
         "kelvin_helmholtz": ["n=32^2", "t_end=0.5"], "kelvin_helmholtz_mode": ["n=24^2", "t_end=0.4"], "rayleigh_taylor_mode": ["n=512", "t_end=0.4"],
         "square": ["n=24^2", "t_end=0.2"],
         "rest_2d": ["n=16^2", "t_end=0.5"], "rest_3d": ["n=10^3", "t_end=0.1"],
         "sedov_2d": ["n=32^2"], "sedov_3d": ["n=14^3", "t_end=0.03"],
         "noh_2d": ["n=30^2", "t_end=0.3"], "noh_3d": ["n=10^3", "t_end=0.2"],
         "rotation": ["n=24^2"], "shear": ["n=24^2", "t_end=0.5", "direction=1 1"]}
# what a run's functionals come to in the limit, and how far from it they may be at this size
NEAR = {"sedov_2d": {"shock_radius": (0.4, 0.02)}, "rotation": {"disc_radius": (1.5811388, 0.01), "angular_speed": (0.4, 0.01)},
        "shear": {"shear_amplitude": (1, 0.05)}, "noh_2d": {"shock_radius": (0.1, 0.05)}}


def run(program, words):
    done = subprocess.run([program, "run", *words, "--json", "-"], capture_output=True, text=True, timeout=120)
    if done.returncode:
        sys.exit("%s: exit %d: %s" % (" ".join(words), done.returncode, done.stderr))
    return json.loads(done.stdout)


def faults(name, document):
    kept = document["conservation"]
    scalars = {entry["name"]: entry["value"] for entry in document["functionals"]}
    if document["status"] != "ok":
        yield "broke down"
    # gravity works along paths that steps cut short
    energy = 1e-12 if document["settings"]["gravity"] in (0, [0]) else 1e-6
    if not kept["momentum"] <= 1e-13 or not kept["energy"] <= energy or not kept["mass"] <= 1e-13:
        yield "does not conserve: %r" % kept
    if not kept["angular_momentum"] >= 0:
        yield "angular momentum %r" % kept["angular_momentum"]
    for key, (exact, allowed) in NEAR.get(name, {}).items():
        if not abs(scalars[key] - exact) <= allowed:
            yield "%s = %r, which should be %r" % (key, scalars[key], exact)


def main():
    program, bad, seen = os.path.abspath(sys.argv[1]), 0, 0
    listed = subprocess.run([program, "list", "cases", "--json", "-"], capture_output=True, text=True, check=True)
    for case in json.loads(listed.stdout)["families"]["cases"]:
        name = case["name"]
        plan = subprocess.run([program, "run", name, "--explain", "--json", "-"], capture_output=True, text=True,
                              check=True)
        if "boost" not in json.loads(plan.stdout)["settings"]:
            continue  # in 1D
        if "rho0" in json.loads(plan.stdout)["settings"]:
            continue  # a liquid, which is not run
        if name not in SMALL:
            sys.exit("%s: tell flows.py how large it shall be" % name)
        for fault in faults(name, run(program, [name, *SMALL[name]])):
            print("%s: %s" % (name, fault))
            bad += 1
        seen += 1
    print("%d cases in 2D and 3D, %d faults" % (seen, bad))
    return bad > 0 or seen < len(SMALL)


if __name__ == "__main__":
    sys.exit(main())
