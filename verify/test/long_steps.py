# SPDX-License-Identifier: GPL-3.0-or-later
"""long_steps.py SPHPROOF: a run of few and long steps prints its progress; the remaining time is estimated without
the time of its start."""
import contextlib
import os
import pty
import re
import subprocess

from script import expect, play, program


def main():
    lead, follow = pty.openpty()
    running = subprocess.Popen([program, "run", "rest_3d", "n=32^3", "t_end=0.2", "--threads", "1"], stderr=follow,
                               stdout=subprocess.PIPE, text=True)
    os.close(follow)
    text = b""
    with contextlib.suppress(OSError):  # the other side is closed
        while part := os.read(lead, 1 << 12):
            text += part
    os.close(lead)
    steps = re.search(r"(\d+) steps", running.communicate()[0])
    expect("long steps: few", steps and int(steps[1]) < 32, steps)
    shown = re.findall(rb"rest_3d: \S+ of 0.2 \((\d+) %\), \d+ s, (\d+) s left", text)
    expect("long steps: progress", shown and int(shown[-1][0]) > 50, text)


play(main)
