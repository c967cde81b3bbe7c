# SPDX-License-Identifier: GPL-3.0-or-later
"""Kills commands (kill -9) at random moments. Computations that they finished before are in the cache
afterwards, and are never repeated.

A kill before anything is finished tests nothing. So every second kill waits for one more finished computation than
before, however slow the machine is, and a command that ends before its kill starts anew with an empty cache."""
import contextlib
import glob
import os
import random
import shutil
import signal
import subprocess
import time

PATIENCE = 300  # seconds until one more computation must be finished


class Killed:
    def __init__(self):
        self.kills = 0    # while the command was still running
        self.halfway = 0  # when some of its computations were finished, but not all
        self.kept = 0     # finished computations, summed over the kills
        self.whole = 0    # times that the command ended before its kill
        self.wrong = []


def entries(cache):
    """Finished computations; an entry that is written again is another file."""
    return {name: os.stat(name).st_ino for name in glob.glob(os.path.join(cache, "*", "*.entry"))}


def lost(before, now):
    return ["%s was %s" % (name, "computed again" if name in now else "lost")
            for name, file in before.items() if now.get(name) != file]


def wait(child, cache, least, moment):
    """Waits until so many computations are finished, and then for a moment. Returns whether the command still runs."""
    until = time.monotonic() + PATIENCE
    while child.poll() is None and len(entries(cache)) < least and time.monotonic() < until:
        time.sleep(0.01)
    with contextlib.suppress(subprocess.TimeoutExpired):
        child.wait(moment)
    return child.poll() is None


def kill(command, cache, count, longest, look=lambda: None, fine=(0,), **options):
    """Kills the command `count` times, each time within `longest` seconds; look() is called after each kill. cache:
    the command's cache, which is emptied at the start."""
    done, generator, before = Killed(), random.Random(20240229), {}
    shutil.rmtree(cache, ignore_errors=True)
    while done.kills < count and done.whole < 4 * count and not done.wrong:
        at_random = (done.kills + done.whole) % 2
        child = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                 stderr=subprocess.PIPE, start_new_session=True, **options)
        alive = wait(child, cache, 0 if at_random else len(before) + 1, generator.uniform(0, longest))
        if alive:  # sometimes only the parent: results that its workers complete count, too
            (os.kill if generator.random() < 0.3 else os.killpg)(child.pid, signal.SIGKILL)
        said = child.stderr.read().decode(errors="replace")  # ends when the last of the workers ends
        child.stderr.close()
        child.wait()
        now = entries(cache)
        done.wrong += lost(before, now)
        look()
        if alive:
            done.kills += 1
            done.kept += len(now)
            done.halfway += bool(now)
            before = now
            continue
        done.whole += 1
        if child.returncode not in fine:
            done.wrong.append("exit %d: %s" % (child.returncode, said.strip()[-200:]))
        shutil.rmtree(cache, ignore_errors=True)
        before = {}
    if done.kills < count and not done.wrong:
        done.wrong.append("only %d kills of %d" % (done.kills, count))
    if not done.halfway:
        done.wrong.append("no kill came between two computations")
    return done, before
