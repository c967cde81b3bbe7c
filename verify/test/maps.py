# SPDX-License-Identifier: GPL-3.0-or-later
"""maps.py SPHPROOF: beside a picture of a run in 2D lie its data and the script that draws it again; a run with snapshots
on the way has a picture of each. (What scripts and data say: the transcripts and test_map.)"""
import os
import shutil
import subprocess
import sys
import tempfile

PROGRAM = os.path.abspath(sys.argv[1])
NAME = "a wave's map"  # a blank and a quote


def text_of(path):
    with open(path, encoding="utf-8") as f:
        return f.read()


def main():
    if not shutil.which("gnuplot"):
        sys.exit(77)
    with tempfile.TemporaryDirectory() as folder:
        picture = os.path.join(folder, NAME + ".svg")
        subprocess.run([PROGRAM, "run", "sound_wave_2d", "n=16^2", "t_end=0", "--plot", picture, "--quiet"], check=True,
                       timeout=60)
        size = os.path.getsize(picture)
        os.remove(picture)
        subprocess.run(["gnuplot", NAME + ".gp"], cwd=folder, check=True, timeout=60)
        again = text_of(picture)
        assert "<svg" in again and again.count("<image") == 3 and "exact (line)" in again and len(again) > 0.3 * size, "drawn again: %d" % len(again)
        film = os.path.join(folder, "film.svg")
        subprocess.run([PROGRAM, "run", "sod", "n=99", "t_end=0.1", "--snapshot", os.path.join(folder, "s.csv"),
                        "--snapshot-every", "0.04", "--plot", film, "--quiet"], check=True, timeout=60)
        for name, time in (("film_0000", "t = 0<"), ("film_0001", "t = 0.04<"), ("film_0002", "t = 0.08<"), ("film", "t = 0.1<")):
            picture = text_of(os.path.join(folder, name + ".svg"))
            assert time in picture and "error of density" in picture, (name, time)
        assert not os.path.exists(os.path.join(folder, "film_0003.svg"))
    print("a map's data and script draw it again; a picture of each moment")


main()
