# SPDX-License-Identifier: GPL-3.0-or-later
"""matrices.py SPHPROOF: what `rates` and `run` say of the moment matrices, against sums over all pairs written
down here: condition numbers, angles between C x and x, and who has fallen back to the standard gradient."""
import csv
import json
import math
import os
import subprocess
import sys
import tempfile

PROGRAM = os.path.abspath(sys.argv[1])
DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), "data")


def sphproof(*words):
    done = subprocess.run([PROGRAM, *words, "--json", "-"], capture_output=True, text=True, timeout=60)
    if done.returncode != 0:
        sys.exit("%s: exit status %d\n%s" % (" ".join(words), done.returncode, done.stderr))
    return json.loads(done.stdout)


def eigenvalues(T):
    """Of a symmetric matrix, by Jacobi's rotations."""
    n, T = len(T), [row[:] for row in T]
    for _ in range(8):
        for p in range(n):
            for q in range(p + 1, n):
                angle = 0.5 * math.atan2(2 * T[p][q], T[q][q] - T[p][p])
                c, s = math.cos(angle), math.sin(angle)
                for k in range(n):
                    T[k][p], T[k][q] = c * T[k][p] - s * T[k][q], s * T[k][p] + c * T[k][q]
                for k in range(n):
                    T[p][k], T[q][k] = c * T[p][k] - s * T[q][k], s * T[p][k] + c * T[q][k]
    return [T[k][k] for k in range(n)]


def solve(T, b):
    """Gauss with pivots."""
    n, rows = len(T), [row[:] + [value] for row, value in zip(T, b)]
    for k in range(n):
        best = max(range(k, n), key=lambda r: abs(rows[r][k]))
        rows[k], rows[best] = rows[best], rows[k]
        for r in range(n):
            if r != k:
                factor = rows[r][k] / rows[k][k]
                rows[r] = [a - factor * b for a, b in zip(rows[r], rows[k])]
    return [rows[k][n] / rows[k][k] for k in range(n)]


def weight(gradient, q, dim):
    """The shape of Wendland's C2, for `corrected` -w'/q; a common factor changes nothing."""
    if q >= 1:
        return 0
    return 20 * (1 - q)**3 if gradient == "corrected" else (1 - q)**4 * (1 + 4 * q)


def brute_force(points, m, gradient):
    """(condition, angle) of each particle in the periodic unit box."""
    found = []
    for i, p in enumerate(points):
        dim, h, near = len(p["x"]), p["h"], []
        T = [[0.0] * dim for _ in range(dim)]
        for j, other in enumerate(points):
            x = [b - a for a, b in zip(p["x"], other["x"])]
            x = [d - round(d) for d in x]
            q = math.sqrt(sum(d * d for d in x)) / h
            if i == j or q >= 1:
                continue
            near.append(x)
            w = m[j] / other["rho"] * weight(gradient, q, dim)
            for a in range(dim):
                for b in range(dim):
                    T[a][b] += w * x[a] * x[b]
        values = eigenvalues(T)
        condition = max(values) / min(values) if min(values) > 0 else math.inf
        angles = []
        for x in near if condition <= 1000 else []:
            Cx = solve(T, x)
            dot = sum(a * b for a, b in zip(Cx, x))
            turn = sum((Cx[a] * x[b] - Cx[b] * x[a])**2 for a in range(dim) for b in range(a))
            angles.append(math.degrees(math.atan2(math.sqrt(turn), dot)))
        found.append((condition, max(angles, default=None)))
    return found


def near(got, expected, tolerance):
    if expected is None or got is None:
        return got == expected
    return abs(float(got) - expected) <= tolerance * abs(expected)


def summary(values):
    values = [v for v in values if v is not None]
    return {"max": max(values), "mean": sum(values) / len(values)} if values else {"max": None, "mean": None}


def judge(document, m, gradient, where):
    points = document["particles"]
    right = brute_force(points, m, gradient)
    used = [condition <= 1000 for condition, _ in right]
    for i, (p, (condition, angle)) in enumerate(zip(points, right)):
        small = condition > 1e6 and float(p["condition"]) > 1e6
        if not (small or near(p["condition"], condition, 1e-6)) or not near(p["angle"], angle, 1e-6):
            sys.exit("%s: particle %d: condition %r, angle %r, not %r, %r"
                     % (where, i, p["condition"], p["angle"], condition, angle))
    matrix = document["matrix"]
    expected = {"condition": summary(c for (c, _), u in zip(right, used) if u),
                "angle": summary(a for (_, a), u in zip(right, used) if u)}
    for name, both in expected.items():
        for which, value in both.items():
            if not near(matrix[name][which], value, 1e-6):
                sys.exit("%s: %s %s is %r, not %r" % (where, which, name, matrix[name][which], value))
    if matrix["fallen_back"] != used.count(False):
        sys.exit("%s: %r have fallen back, not %d" % (where, matrix["fallen_back"], used.count(False)))
    return used.count(False)


def particles(path):
    with open(path, newline="", encoding="utf-8", errors="surrogateescape") as f:
        return list(csv.DictReader(line for line in f if not line.startswith("#")))


def corrected():
    path = os.path.join(DATA, "rates_2d_particles.csv")
    m = [float(row["m"]) for row in particles(path)]
    judge(sphproof("rates", path, "lo=0", "hi=1", "kernel=wendland_c2", "eta=2.6", "gradient=corrected"), m,
          "corrected", "2D, corrected")
    assert sphproof("rates", path, "lo=0", "hi=1", "eta=2.6", "gradient=standard")["matrix"] is None


def flat(folder, dim):
    """Most particles nearly in a plane far from all others: they fall back, in `run` as in `rates`."""
    path = os.path.join(DATA, "rates_%dd_particles.csv" % dim)
    rows, pressed = particles(path), os.path.join(folder, "flat%d.csv" % dim)
    for row in rows:
        x = float(row["x"])
        row["x"] = repr(x if x < 0.2 else 0.6 + 1e-4 * (x - 0.6))
    with open(pressed, "w", newline="", encoding="utf-8", errors="surrogateescape") as f:
        writer = csv.DictWriter(f, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)
    scheme = ["gradient=ia", "kernel=wendland_c2", "eta=2.2", "h_method=newton", "h_tolerance=1e-14"]
    document = sphproof("rates", pressed, "lo=0", "hi=1", *scheme)
    count = judge(document, [float(row["m"]) for row in rows], "ia", "%dD, flat" % dim)
    assert 0 < count < len(rows), count
    case = os.path.join(folder, "flat%d.ini" % dim)
    with open(case, "w", encoding="utf-8", errors="surrogateescape") as f:
        f.write("[case]\ntitle = particles of a file\ndimension = %d\nreference = none\n[domain]\nlo = 0\nhi = 1\n"
                "[initial]\nkind = particles\nfile = %s\n[run]\ngamma = 1.4\nt_end = 1e-9\n" % (dim, os.path.basename(pressed)))
    run = sphproof("run", case, *scheme)["matrix"]
    if run["fallen_back"] != count or run["fallen_back_most"] != count:
        sys.exit("%dD: in a run %r have fallen back, not %d" % (dim, run, count))
    said = subprocess.run([PROGRAM, "run", case, *scheme], capture_output=True, text=True, timeout=60).stdout
    assert "%d of %d particles with the standard gradient" % (count, len(rows)) in said, said


def at_the_end(folder):
    """A run's figures are those of the state that it ends with."""
    for integrator in ("predicted_midpoint", "leapfrog", "rk2"):
        path = os.path.join(folder, "end.csv")
        scheme = ["gradient=ia", "viscosity=none", "kernel=wendland_c2", "eta=3", "h_method=newton",
                  "h_tolerance=1e-14", "energy=internal", "integrator=" + integrator]
        run = sphproof("run", "gresho", "n=10^2", "lattice=jittered", "jitter=0.2", "t_end=0.1", *scheme, "--snapshot",
                       path)
        gamma = repr(run["settings"]["gamma"])
        again = sphproof("rates", path, "lo=0", "hi=1", "gamma=" + gamma, *scheme)["matrix"]
        for name in ("condition", "angle"):
            for which in ("max", "mean"):
                if not near(run["matrix"][name][which], again[name][which], 1e-9):
                    sys.exit("%s: %s %s is %r, of its snapshot %r"
                             % (integrator, which, name, run["matrix"][name][which], again[name][which]))


def main():
    with tempfile.TemporaryDirectory() as folder:
        corrected()
        for dim in (2, 3):
            flat(folder, dim)
        at_the_end(folder)
    print("conditions, angles and who has fallen back: as sums over all pairs have them")


main()
