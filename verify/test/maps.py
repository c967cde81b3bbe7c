# SPDX-License-Identifier: GPL-3.0-or-later
"""maps.py SPHPROOF: beside a picture of a run in 2D lie its data and the script that draws it again; the data are
the state's, row by row."""
import math
import os
import shutil
import subprocess
import sys
import tempfile

PROGRAM = os.path.abspath(sys.argv[1])
NAME = "a wave's map"  # a blank and a quote


def blocks(path):
    with open(path, encoding="utf-8", errors="surrogateescape") as f:
        parts = f.read().split("\n\n\n")
    return [[[float(x) for x in line.split()] for line in part.split("\n") if line and line[0] != "#"]
            for part in parts if part.strip()]


def main():
    if not shutil.which("gnuplot"):
        sys.exit(77)
    with tempfile.TemporaryDirectory() as folder:
        picture = os.path.join(folder, NAME + ".svg")
        subprocess.run([PROGRAM, "run", "sound_wave_2d", "n=16^2", "t_end=0", "--plot", picture, "--quiet"], check=True,
                       timeout=60)
        found = blocks(os.path.join(folder, NAME + ".dat"))
        assert len(found) == 5, "density, speed, error, particles and the exact curve: %d blocks" % len(found)
        particles, exact = found[3], found[4]
        assert len(particles) > 100 and len(exact) > 100, (len(particles), len(exact))
        # at the start both are the wave of the density, about 1
        mean, most = sum(point[1] for point in exact) / len(exact), max(point[1] for point in exact)
        assert math.isclose(mean, 1, rel_tol=1e-4) and math.isclose(most, 1.01, abs_tol=5e-4), (mean, most)
        for x, v in particles:
            near = min(exact, key=lambda point: abs(point[0] - x))
            assert abs(v - near[1]) <= 0.003, (x, v, near)
        density = found[0]
        assert len(density) == len(density[0]) == 16, "rows of cells: %d" % len(density)
        # the wave runs along x: rows are alike, columns are not
        for row in density:
            assert all(abs(a - b) <= 1e-6 for a, b in zip(row, density[0])), "rows differ"
        assert max(density[0]) - min(density[0]) > 1e-3 and math.isclose(sum(density[0]) / 16, 1, rel_tol=1e-3), density[0]
        size = os.path.getsize(picture)
        os.remove(picture)
        subprocess.run(["gnuplot", NAME + ".gp"], cwd=folder, check=True, timeout=60)
        with open(picture, encoding="utf-8") as f:
            again = f.read()
        assert "<svg" in again and again.count("<image") == 3 and "exact (line)" in again and len(again) > 0.3 * size, "drawn again: %d" % len(again)
        # of snapshots on the way a picture each, each with its time; on a line with a panel of the error
        film = os.path.join(folder, "film.svg")
        subprocess.run([PROGRAM, "run", "sod", "n=99", "t_end=0.1", "--snapshot", os.path.join(folder, "s.csv"),
                        "--snapshot-every", "0.04", "--plot", film, "--quiet"], check=True, timeout=60)
        for name, time in (("film_0000", "t = 0<"), ("film_0001", "t = 0.04<"), ("film_0002", "t = 0.08<"), ("film", "t = 0.1<")):
            with open(os.path.join(folder, name + ".svg"), encoding="utf-8") as f:
                picture = f.read()
            assert time in picture and "error of density" in picture, (name, time)
        assert not os.path.exists(os.path.join(folder, "film_0003.svg"))
        # where nothing is exact it says so
        subprocess.run([PROGRAM, "run", "kelvin_helmholtz", "n=16^2", "t_end=0.1", "--plot", film, "--quiet"], check=True, timeout=60)
        with open(film, encoding="utf-8") as f:
            assert "no exact solution, no error" in f.read()
    print("a map's data and script draw it again; a picture of each moment")


main()
