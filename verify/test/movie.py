# SPDX-License-Identifier: GPL-3.0-or-later
"""movie.py SPHPROOF: `run --snapshot-every T --plot F.gif` (or .mp4) has a picture of each moment in order; a missing
or failing ffmpeg is reported, and no partial file is left. A stand-in for ffmpeg keeps its input for the test; the
real one makes movies if it is installed."""
import os
import re
import shutil
import struct
import sys

from script import call, play

KEEPS = '#!/bin/sh\nfor last; do :; done\n[ "$1" = -version ] || exec cat >"${last#file:}"\n'
FAILS = '#!/bin/sh\n[ "$1" = -version ] && exit\ncat >/dev/null\necho "no such codec" >&2\nexit 3\n'


def run(path, *words, status=0):
    return call("run", *words, "--quiet", status=status, env={**os.environ, "PATH": path} if path else None).stderr


def tools(name, script):
    os.makedirs(name)
    for tool in ("gnuplot", "sh", "cat"):
        os.symlink(shutil.which(tool), os.path.join(name, tool))
    if script:
        with open(os.path.join(name, "ffmpeg"), "w", encoding="ascii") as file:
            file.write(script)
        os.chmod(os.path.join(name, "ffmpeg"), 0o755)
    return os.path.abspath(name)


def sizes(path):
    """Sizes of the pictures that the encoder got, in order."""
    with open(path, "rb") as file:
        data = file.read()
    assert data.startswith(b"\x89PNG") and data.endswith(b"IEND\xaeB`\x82")
    return [struct.unpack(">2I", data[m.end() + 8:m.end() + 16]) for m in re.finditer(rb"\x89PNG\r\n\x1a\n", data)]


def main():
    if not shutil.which("gnuplot"):
        print("no gnuplot here: no pictures, no movies")
        sys.exit(77)
    none, keeps, fails = tools("none", None), tools("keeps", KEEPS), tools("fails", FAILS)
    series = ["--snapshot", "s.csv", "--snapshot-every", "0.04"]
    said = run(none, "sod", "n=64", *series, "--plot", "m.gif", status=4)
    assert "made by ffmpeg (Debian, Ubuntu: package ffmpeg" in said and not os.path.exists("s_0000.csv"), said
    said = run(keeps, "sod", "n=64", "--plot", "m.gif", status=2)
    assert "needs --snapshot-every TIME" in said, said
    said = run(fails, "sod", "n=64", "t_end=0.1", *series, "--plot", "m.mp4", "--json", "m.json", status=4)
    assert "status 3: no such codec" in said and os.path.exists("m.json") and os.path.exists("s_0002.csv"), said
    assert not [name for name in os.listdir(".") if name.startswith("m.mp4") or "tmp" in name], os.listdir(".")
    run(keeps, "sod", "n=64", "t_end=0.1", *series, "--plot", "a movie.gif")
    found = sizes("a movie.gif")
    assert len(found) == 4 and len(set(found)) == 1, found
    run(keeps, "gresho", "n=16^2", "t_end=0.05", *series, "--plot", "g.mp4")  # the initial density is uniform
    found = sizes("g.mp4")
    assert len(found) == 3 and len(set(found)) == 1, found
    if not shutil.which("ffmpeg"):
        print("by a stand-in only: ffmpeg is not here (Debian: ffmpeg)")
        return
    run(None, "sod", "n=64", "t_end=0.1", *series, "--plot", "real.gif")
    run(None, "gresho", "n=16^2", "t_end=0.05", *series, "--plot", "it's real.mp4")
    with open("real.gif", "rb") as file:
        data = file.read()
    assert data[:6] == b"GIF89a" and data.count(b"\x21\xf9\x04") == 4, (data[:6], data.count(b"\x21\xf9\x04"))
    with open("it's real.mp4", "rb") as file:
        data = file.read()
    assert data[4:8] == b"ftyp" and b"moov" in data and len(data) > 5000, data[:12]


play(main)
