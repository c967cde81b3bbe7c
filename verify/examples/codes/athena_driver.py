#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs Athena++ (https://www.athena-astro.app), a grid code, from an initial state of particles as text.

  athena_driver.py PROGRAM PARAMETERS ic.csv out      writes out_000.csv and out_001.csv, with a line for each cell

PROGRAM is Athena++ with HDF5 and the problem generator from_array. In 2D particles lie on a square lattice, and each
becomes a cell; in 1D the mass, momentum and energy of a particle are spread evenly over the interval between its
neighbours in the same gas, and summed over as many cells of equal size."""
import subprocess
import sys

import h5py
import numpy as np

program, parameters, start, out = sys.argv[1:5]


def read(path):
    """Columns by name, and the values of lines `# key = value`."""
    with open(path, encoding="ascii") as file:
        lines = file.read().splitlines()
    said = dict(line[1:].split("=", 1) for line in lines if line.startswith("#"))
    rows = np.array([line.split(",") for line in lines[1:] if not line.startswith("#")], dtype=float)
    return dict(zip(lines[0].split(","), rows.T)), {key.strip(): value.strip() for key, value in said.items()}


def spread(x, u, ends):
    """The share of each particle in each cell: a sparse matrix as lists of cell, particle, share."""
    order = np.argsort(x)
    x, u, n, length = x[order], u[order], len(x), ends[1] - ends[0]
    gap = (np.roll(x, -1) - x) % length
    same = np.isclose(u, np.roll(u, -1))
    before, after = np.where(np.roll(same, 1), np.roll(gap, 1), np.inf), np.where(same, gap, np.inf)
    width = np.minimum(before, after)
    edges = np.linspace(ends[0], ends[1], n + 1)
    shares = np.zeros((n, n))
    for i in range(n):
        for shift in -length, 0, length:
            low, high = x[i] - width[i] / 2 + shift, x[i] + width[i] / 2 + shift
            shares[:, order[i]] += np.clip(np.minimum(edges[1:], high) - np.maximum(edges[:-1], low), 0, None) / width[i]
    return shares


columns, said = read(start)
gamma = float(said["gamma"])
ends = np.array([side.split(":") for side in said["box"].split()], dtype=float)
dim, n = len(ends), len(columns["x"])
v = [columns.get(name, np.zeros(n)) for name in ("vx", "vy", "vz")]
energy = columns["u"] + 0.5 * sum(component**2 for component in v)
cons = columns["m"] * np.array([np.ones(n), *v, energy])  # conserved quantities of each particle
if dim == 1:
    shape = [n]
    cells = cons @ spread(columns["x"], columns["u"], ends[0]).T
else:
    shape = [len(np.unique(np.round(columns[name], 12))) for name in "xy"]
    assert shape[0] * shape[1] == n, "in 2D particles have to stand on a square lattice"
    cells = cons[:, np.lexsort((np.round(columns["x"], 12), np.round(columns["y"], 12)))]
volume = np.prod(ends[:, 1] - ends[:, 0]) / n
with h5py.File("cells.hdf5", "w") as file:
    file["cons"] = cells.reshape(5, 1, 1, shape[1] if dim > 1 else 1, shape[0]) / volume
mesh = ["mesh/nx%d=%d" % (d + 1, shape[d]) for d in range(dim)]
mesh += ["mesh/x%d%s=%.17g" % (d + 1, end, ends[d][k]) for d in range(dim) for k, end in enumerate(("min", "max"))]
subprocess.run([program, "-i", parameters, *mesh], check=True)
for number in 0, 1:
    path = "athena.block0.out1.%05d.tab" % number
    with open(path, encoding="ascii") as file:
        time = float(file.readline().split("time=")[1].split()[0])
    rows = np.loadtxt(path)
    x, (rho, pressure), velocity = rows[:, 1:2 * dim:2], rows[:, 2 * dim:2 * dim + 2].T, rows[:, 2 * dim + 2:3 * dim + 2]
    with open("%s_%03d.csv" % (out, number), "w", encoding="ascii") as file:
        file.write(("x,vx" if dim == 1 else "x,y,vx,vy") + ",m,rho,u,P\n# time = %.17g\n" % time)
        file.write("# box = " + " ".join("%.17g:%.17g" % tuple(side) for side in ends) + "\n")
        np.savetxt(file, np.column_stack([x, velocity, rho * volume, rho, pressure / (gamma - 1) / rho, pressure]), "%.17g", ",")
