#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs PySPH (Debian's package python3-pysph; pysph.readthedocs.io) from an initial state in text, in a periodic box.

  pysph_driver.py ic.csv out --t-end 0.2      writes out_000.csv and out_001.csv

Scheme: GasDScheme, the equations of Price & Monaghan (2005) with switches for viscosity and conductivity, and its
predictor-corrector integrator. PySPH compiles its equations at the first run of a scheme, and keeps them in ~/.compyle."""
import argparse
import tempfile

import numpy as np
from pysph.base.kernels import CubicSpline, QuinticSpline
from pysph.base.nnps import DomainManager
from pysph.base.utils import get_particle_array
from pysph.solver.application import Application
from pysph.sph.scheme import GasDScheme

KERNELS = {"cubic": (CubicSpline, 1.2), "quintic": (QuinticSpline, 1.2)}  # kernel, width in particle spacings


def read(path):
    """Columns by name, and the values of lines `# key = value`."""
    with open(path, encoding="ascii") as file:
        lines = file.read().splitlines()
    said = dict(line[1:].split("=", 1) for line in lines if line.startswith("#"))
    rows = np.array([line.split(",") for line in lines[1:] if not line.startswith("#")], dtype=float)
    return dict(zip(lines[0].split(","), rows.T)), {key.strip(): value.strip() for key, value in said.items()}


class Driver(Application):
    def initialize(self):
        self.columns, said = read(words.start)
        self.dim = 2 if "y" in self.columns else 1
        self.gamma = words.gamma or float(said["gamma"])
        self.ends = np.array([side.split(":") for side in said["box"].split()], dtype=float)
        self.volume = np.prod(self.ends[:, 1] - self.ends[:, 0])

    def create_domain(self):
        ends = dict(zip(("xmin", "xmax", "ymin", "ymax"), self.ends.flat))
        return DomainManager(periodic_in_x=True, periodic_in_y=self.dim > 1, **ends)

    def create_particles(self):
        given = self.columns
        spacing = (given["m"] / given["rho"])**(1 / self.dim)
        h = KERNELS[words.kernel][1] * spacing
        velocities = {ours: given[theirs] for ours, theirs in (("u", "vx"), ("v", "vy")) if theirs in given}
        positions = {name: given[name] for name in "xy" if name in given}
        positions["x"] = positions["x"] + words.shift * spacing
        fluid = get_particle_array(name="fluid", m=given["m"], rho=given["rho"], e=given["u"], p=given["P"], h=h, h0=h.copy(),
                                   **positions, **velocities)
        self.scheme.setup_properties([fluid])
        fluid.add_output_arrays(["gid"])
        return [fluid]

    def create_scheme(self):
        return GasDScheme(fluids=["fluid"], solids=[], dim=self.dim, gamma=self.gamma, kernel_factor=KERNELS[words.kernel][1],
                          alpha1=words.viscosity, alpha2=0.1, beta=2, update_alpha1=True, update_alpha2=True,
                          density_iteration_tolerance=1e-4, has_ghosts=True)

    def configure_scheme(self):
        spacing = (self.volume / len(self.columns["m"]))**(1 / self.dim)
        fastest = np.sqrt(self.gamma * (self.gamma - 1) * self.columns["u"].max())
        self.scheme.configure_solver(kernel=KERNELS[words.kernel][0](dim=self.dim), tf=words.t_end, dt=0.1 * spacing / fastest,
                                     adaptive_timestep=True, cfl=0.2, pfreq=10**9)

    def write(self, path, time):
        fluid = self.particles[0]
        names = {"x": "x", "y": "y", "vx": "u", "vy": "v", "m": "m", "rho": "rho", "u": "e", "P": "p", "h": "h"}
        if self.dim == 1:
            del names["y"], names["vy"]
        with open(path, "w", encoding="ascii") as file:
            file.write(",".join(names) + "\n# time = %.17g\n" % time)
            file.write("# box = " + " ".join("%.17g:%.17g" % tuple(side) for side in self.ends) + "\n")
            np.savetxt(file, np.column_stack([fluid.get(name) for name in names.values()]), "%.17g", ",")


parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("start", help="initial state, as `sphproof ic --format csv` writes it")
parser.add_argument("out", help="snapshots are OUT_000.csv and OUT_001.csv")
parser.add_argument("--t-end", type=float, required=True)
parser.add_argument("--kernel", choices=KERNELS, default="cubic")
parser.add_argument("--gamma", type=float, help="instead of the file's")
parser.add_argument("--viscosity", type=float, default=0.1, help="least alpha; 0.1 unless given")
parser.add_argument("--shift", type=float, default=0, help="a fault: particles start so many spacings farther along x")
words = parser.parse_args()
with tempfile.TemporaryDirectory() as folder:
    driver = Driver(output_dir=folder)
    driver.setup(["--directory", folder, "--disable-output"])
    driver.write(words.out + "_000.csv", 0)
    driver.solve()
    driver.write(words.out + "_001.csv", driver.solver.t)
