# SPDX-License-Identifier: GPL-3.0-or-later
"""picture.py SOURCE SPHPROOF WORK [--report]: reports/picture makes the README's picture of a page. Missing tools and
failures are reported, and the existing picture stays. With --report the page is a whole report's, made here; else it
is judge's. Exit status 77: Chromium or ImageMagick is not installed, and only their absence was tested."""
import os
import shutil
import struct
import subprocess
import sys

source, program, work = map(os.path.abspath, sys.argv[1:4])
TOOLS = ("sh", "dirname", "id", "mktemp", "rm", "cp", "mv", "sed", "tail", "python3")
BROKEN = "#!/bin/sh\necho 'no display' >&2\nexit 1\n"


def picture(page, out, path, status):
    done = subprocess.run([os.path.join(source, "reports", "picture"), "--page", page, "--out=" + out], text=True, check=False,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env={**os.environ, "PATH": path}, timeout=300)
    assert done.returncode == status, (done.returncode, done.stdout)
    return done.stdout


def stand_in(name, text):
    path = os.path.join("tools", name)
    with open(path, "w", encoding="ascii") as file:
        file.write(text)
    os.chmod(path, 0o755)


def main():
    shutil.rmtree(work, ignore_errors=True)
    os.makedirs(os.path.join(work, "tools"))
    os.chdir(work)
    page, out, tools = os.path.join(work, "a päge.html"), os.path.join(work, "report.png"), os.path.join(work, "tools")
    for tool in TOOLS:
        os.symlink("/usr/bin/python3" if tool == "python3" and os.path.exists("/usr/bin/python3") else shutil.which(tool),
                   os.path.join("tools", tool))
    with open(page, "w", encoding="utf-8") as file:
        file.write("<h1>nothing yet</h1>")
    with open(out, "wb") as file:
        file.write(b"the one before")
    assert "needs chromium" in picture(page, out, tools, 4)
    stand_in("chromium", BROKEN)
    assert "apt-get install imagemagick" in picture(page, out, tools, 4)
    stand_in("convert", BROKEN)
    said = picture(page, out, tools, 4)
    assert "no display" in said and "made no picture of" in said, said
    assert "no page" in picture(page + "x", out, tools, 2)
    with open(out, "rb") as file:
        assert file.read() == b"the one before" and len(os.listdir(".")) == 3, os.listdir(".")
    if not any(map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))) or not any(map(shutil.which, ("convert", "magick"))):
        print("Chromium or ImageMagick is not here (Debian: chromium, imagemagick): only their absence was tried")
        sys.exit(77)
    if "--report" in sys.argv:
        subprocess.run([program, "report", "--quick", "--out", "report", "--quiet"], check=False)
        page = os.path.join("report", "index.html")
    else:
        subprocess.run([program, "run", "gresho", "n=24^2", "t_end=0.1", "--quiet", "--snapshot", "s.csv"], check=True)
        subprocess.run([program, "judge", "s.csv", "--html", page, "--quiet"], check=True)
    picture(page, out, os.environ["PATH"], 0)
    with open(out, "rb") as file:
        data = file.read()
    assert data[:8] == b"\x89PNG\r\n\x1a\n" and struct.unpack(">2I", data[16:24]) == (1120, 744), data[:24]
    assert 20000 < len(data) < 400000, "%d bytes: an empty screen, or colours that were not reduced" % len(data)
    print("%d bytes of today's page" % len(data))


main()
