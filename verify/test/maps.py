# SPDX-License-Identifier: GPL-3.0-or-later
"""maps.py SPHPROOF: a picture of a run in 2D comes with its data and the script that draws it again; a run with
snapshots has a picture of each. (Contents of scripts and data: the transcripts and test_map.)"""
import os
import shutil
import subprocess
import sys

from script import call, play, read

NAME = "a wave's map"  # a blank and a quote


def main():
    if not shutil.which("gnuplot"):
        sys.exit(77)
    call("run", "sound_wave_2d", "n=16^2", "t_end=0", "--plot", NAME + ".svg", "--quiet", status=0)
    size = os.path.getsize(NAME + ".svg")
    os.remove(NAME + ".svg")
    subprocess.run(["gnuplot", NAME + ".gp"], check=True, timeout=60)
    again = read(NAME + ".svg")
    assert "<svg" in again and again.count("<image") == 3 and "exact (line)" in again and len(again) > 0.3 * size, "drawn again: %d" % len(again)
    call("run", "sod", "n=99", "t_end=0.1", "--snapshot", "s.csv", "--snapshot-every", "0.04", "--plot", "film.svg", "--quiet", status=0)
    for name, time in (("film_0000", "t = 0<"), ("film_0001", "t = 0.04<"), ("film_0002", "t = 0.08<"), ("film", "t = 0.1<")):
        picture = read(name + ".svg")
        assert time in picture and "error of density" in picture, (name, time)
    assert not os.path.exists("film_0003.svg")


play(main)
