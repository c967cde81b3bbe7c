#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A small SPH code of its own, in 1D and 2D with periodic boxes: something to try `sphproof` on another code with.

  sphproof ic sod n=400 --format csv --out start.csv          (or --format gadget_hdf5, with h5py)
  sph.py start.csv out --t-end 0.2                            writes out_000.csv and out_001.csv
  sphproof judge out_001.csv --case sod

Equations: Springel & Hernquist (2002) with the internal energy and the density's own smoothing length, Monaghan's
(1997) viscosity with Balsara's (1995) factor, Wendland's C4 kernel (Dehnen & Aly 2012), leapfrog. h is the support
radius. --fault plants an error that a test of a code should find."""
import argparse

import numpy as np

ETA = {1: 3.2, 2: 3.6}  # support radius in particle spacings
COURANT, ALPHA = 0.2, 1.0
FAULTS = {"gamma": "gamma is 5 % too large", "first_order": "forward Euler steps", "viscosity": "twice the viscosity",
          "momentum": "one of the two forces of a pair is 0.01 % too large", "width": "twice the smoothing length"}


def kernel(q, dim):
    """w(q) and dw/dq of a support radius of 1."""
    a = np.maximum(1 - q, 0)
    if dim == 1:
        return 1.5 * a**5 * (1 + q * (5 + 8 * q)), -21 * q * a**4 * (1 + 4 * q)
    return 9 / np.pi * a**6 * (1 + q * (6 + 35 / 3 * q)), -9 / np.pi * 56 / 3 * q * a**5 * (1 + 5 * q)


def find_pairs(x, box, reach):
    """All i, j with |x_i - x_j| < reach, i = j among them, by a grid of cells."""
    n, dim = x.shape
    cells = np.maximum(np.floor(box / reach).astype(int), 1)
    cells[cells < 3] = 1
    at = np.minimum((x / box * cells).astype(int), cells - 1)
    strides = np.cumprod(np.append(1, cells[:-1]))
    order = np.argsort(at @ strides, kind="stable")
    begins = np.searchsorted((at @ strides)[order], np.arange(cells.prod() + 1))
    steps = np.array(np.meshgrid(*[[0] if c == 1 else [-1, 0, 1] for c in cells])).reshape(dim, -1).T
    found = []
    for step in steps:
        cell = ((at + step) % cells) @ strides
        count = begins[cell + 1] - begins[cell]
        i = np.repeat(np.arange(n), count)
        within = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
        j = order[begins[cell][i] + within]
        apart = x[i] - x[j]
        near = ((apart - box * np.round(apart / box))**2).sum(1) < reach**2
        found.append(np.stack([i[near], j[near]]))
    return np.concatenate(found, axis=1)


class Gas:
    """The state and the equations of motion; arrays have n x dim or n elements."""

    def __init__(self, x, v, m, u, box, gamma, fault):
        self.x, self.v, self.m, self.u, self.box = x, v, m, u, box
        self.dim, self.n, self.fault = x.shape[1], len(x), fault
        self.gamma = gamma * 1.05 if fault == "gamma" else gamma
        self.eta = ETA[self.dim] * (2 if fault == "width" else 1)
        self.alpha = ALPHA * (2 if fault == "viscosity" else 1)
        self.h = np.full(self.n, self.eta * (box.prod() / self.n)**(1 / self.dim))

    def sum(self, i, values):
        return np.bincount(i, values, self.n)

    def find_density(self):
        """Solves h_i = eta (m_i/rho_i)^(1/d) by Newton's method; computes the factors f_i of the equations of motion."""
        m, dim = self.m, self.dim
        for attempt in range(60):
            if attempt == 0 or self.h.max() > reach:
                reach = 1.1 * self.h.max()
                i, j = find_pairs(self.x, self.box, reach)
                apart = self.x[i] - self.x[j]
                apart -= self.box * np.round(apart / self.box)
                r = np.sqrt((apart**2).sum(1))
            w, dw = kernel(r / self.h[i], dim)
            rho = self.sum(i, m[j] * w) / self.h**dim
            slope = -(dim * rho + self.sum(i, m[j] * dw * r / self.h[i]) / self.h**dim) / self.h  # d rho/dh
            wanted = m * (self.eta / self.h)**dim
            change = (rho - wanted) / (slope + dim * wanted / self.h)
            if np.abs(change / self.h).max() < 1e-12:
                break
            self.h = np.clip(self.h - change, 0.7 * self.h, 1.4 * self.h)
        self.rho, self.f = rho, 1 / (1 + self.h / (dim * rho) * slope)
        keep = (i != j) & (r < np.maximum(self.h[i], self.h[j]))
        return i[keep], j[keep], apart[keep], r[keep]

    def balsara(self, i, j, apart, dv, slope):
        """|div v|/(|div v| + |curl v| + noise): 1 in 1D."""
        if self.dim == 1:
            return np.ones(self.n)
        div = np.abs(self.sum(i, self.m[j] * slope * (dv * apart).sum(1)) / self.rho)
        curl = np.abs(self.sum(i, self.m[j] * slope * (dv[:, 0] * apart[:, 1] - dv[:, 1] * apart[:, 0])) / self.rho)
        return div / (div + curl + 1e-4 * self.c / self.h)

    def rates(self, v, u):
        """dv/dt, du/dt, and the longest time step allowed."""
        i, j, apart, r = self.find_density()
        m, rho, h, dim = self.m, self.rho, self.h, self.dim
        pressure = (self.gamma - 1) * rho * u
        self.c = np.sqrt(self.gamma * pressure / rho)
        push = self.f * pressure / rho**2
        dv = v[i] - v[j]
        # W'/r with the smoothing lengths of i and of j
        own, other = (kernel(r / h[k], dim)[1] / (h[k]**(dim + 1) * r) for k in (i, j))
        switch = self.balsara(i, j, apart, dv, own)
        towards = np.minimum((dv * apart).sum(1) / r, 0)
        signal = self.c[i] + self.c[j] - 3 * towards
        viscosity = -self.alpha / 2 * signal * towards / (rho[i] + rho[j]) * (switch[i] + switch[j])
        viscosity *= (own + other) / 2
        force = -m[j] * (push[i] * own + push[j] * other + viscosity)
        if self.fault == "momentum":
            force[i < j] *= 1.0001
        dv_dt = np.stack([self.sum(i, force * apart[:, d]) for d in range(dim)], axis=1)
        du_dt = self.sum(i, m[j] * (push[i] * own + viscosity / 2) * (dv * apart).sum(1))
        fastest = np.full(self.n, 1e-300)
        np.maximum.at(fastest, i, signal)
        return dv_dt, du_dt, COURANT * (h / fastest).min()

    def run(self, time, t_end):
        a, du, limit = self.rates(self.v, self.u)
        while time < t_end:
            dt = min(limit, t_end - time)
            time = t_end if dt == t_end - time else time + dt
            if self.fault == "first_order":
                self.x = (self.x + dt * self.v) % self.box
                self.v, self.u = self.v + dt * a, self.u + dt * du
                a, du, limit = self.rates(self.v, self.u)
                continue
            v, u = self.v + dt / 2 * a, self.u + dt / 2 * du
            self.x = (self.x + dt * v) % self.box
            a, du, limit = self.rates(v + dt / 2 * a, u + dt / 2 * du)
            self.v, self.u = v + dt / 2 * a, u + dt / 2 * du
        return time


def read(path):
    """x relative to the lower corner of the box, v, m, u, box, gamma, time."""
    if path.endswith("5"):
        import h5py
        with h5py.File(path, "r") as file:
            head, gas = file["Header"].attrs, file["PartType0"]
            dim = int(head["Dimension"])
            x, v = gas["Coordinates"][:, :dim], gas["Velocities"][:, :dim]
            box = np.broadcast_to(head["BoxSize"], 3)[:dim].astype(float)
            return x, v, gas["Masses"][:], gas["InternalEnergy"][:], box, float(head["Gamma"]), float(head["Time"])
    with open(path, encoding="ascii") as file:
        lines = file.read().splitlines()
    said = dict(line[1:].split("=", 1) for line in lines if line[0] == "#")
    said = {key.strip(): value.strip() for key, value in said.items()}
    rows = np.array([[float(word) for word in line.split(",")] for line in lines[1:] if line[0] != "#"])
    columns = dict(zip(lines[0].split(","), rows.T))
    names = [name for name in "xyz" if name in columns]
    ends = np.array([side.split(":") for side in said["box"].split()], dtype=float)
    x = np.stack([columns[name] for name in names], axis=1) - ends[:, 0]
    v = np.stack([columns["v" + name] for name in names], axis=1)
    return x, v, columns["m"], columns["u"], ends[:, 1] - ends[:, 0], float(said["gamma"]), float(said["time"])


def write(path, gas, time):
    fields = {"Masses": gas.m, "Density": gas.rho, "InternalEnergy": gas.u, "SmoothingLength": gas.h}
    if path.endswith("5"):
        import h5py
        with h5py.File(path, "w") as file:
            count = np.array([gas.n, 0, 0, 0, 0, 0], dtype="u4")
            file.create_group("Header").attrs.update(
                NumPart_ThisFile=count, NumPart_Total=count, MassTable=np.zeros(6), NumFilesPerSnapshot=1, Time=time,
                BoxSize=gas.box if gas.dim > 1 else gas.box[0], Dimension=gas.dim)
            flat = ((0, 0), (0, 3 - gas.dim))
            part = file.create_group("PartType0")
            fields.update(Coordinates=np.pad(gas.x, flat), Velocities=np.pad(gas.v, flat), ParticleIDs=np.arange(gas.n))
            for name, values in fields.items():
                part[name] = values
        return
    with open(path, "w", encoding="ascii") as file:
        file.write({1: "x,vx", 2: "x,y,vx,vy"}[gas.dim] + ",m,rho,u,h\n# time = %.17g\n" % time)
        file.write("# box = " + " ".join("0:%.17g" % side for side in gas.box) + "\n")
        np.savetxt(file, np.column_stack([gas.x, gas.v, *fields.values()]), "%.17g", ",")


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("start", help="initial state, .csv or .hdf5 as `sphproof ic` writes it")
    words.add_argument("out", help="snapshots are OUT_000, OUT_001 with the ending of the start")
    words.add_argument("--t-end", type=float, required=True)
    words.add_argument("--gamma", type=float, help="instead of the file's")
    words.add_argument("--fault", choices=FAULTS, help="; ".join(k + ": " + v for k, v in FAULTS.items()))
    said = words.parse_args()
    x, v, m, u, box, gamma, time = read(said.start)
    gas, ending = Gas(x, v, m, u, box, said.gamma or gamma, said.fault), said.start[said.start.rindex("."):]
    gas.find_density()
    write(said.out + "_000" + ending, gas, time)
    write(said.out + "_001" + ending, gas, gas.run(time, said.t_end))


main()
