# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds mutants that cannot change any result. Part of verify/mutants/score.

The compiler finds some of them: those for which it makes the same code as for the original. The others are
listed with their reasons in FOLDER/equivalent.txt beside the sources, one a line below the name of their file:

  [FILE]
  function :: change :: reason
  function :: change :: part of the line :: reason

function: "-" at file scope; change: as the score names it; a part of the line where the function has the same
change elsewhere. A line that no mutant matches makes the score fail."""
import json
import os
import re
import shlex
import subprocess

NAME = "equivalent.txt"


class Broken(ValueError):
    """A line of a list that is not an entry; the text names file and line."""


class Entry:
    def __init__(self, file, function, change, part, reason):
        self.file, self.function, self.change, self.part, self.reason = file, function, change, part, reason

    def excuses(self, mutant):
        return (self.change == mutant.change and self.file == mutant.file and self.function == mutant.function
                and self.part in mutant.text)


def read(path, folder):
    entries, file = [], None
    with open(path, encoding="utf-8") as f:
        for number, line in enumerate(f, 1):
            line = line.strip()
            if not line or line.startswith("#"):
                continue
            named = re.match(r"\[([\w.]+)\]$", line)
            words = line.split(" :: ")
            if named:
                file = os.path.join(folder, named[1])
            elif file and len(words) in (3, 4) and all(words):
                entries.append(Entry(file, words[0], words[1], words[2] if len(words) == 4 else "", words[-1]))
            else:
                raise Broken("%s:%d: what is this? %s" % (path, number, line))
    return entries


def read_all(tree, judged):
    """The entries of all folders of a tree with judged sources."""
    entries = []
    for folder in sorted({os.path.dirname(name) for name in judged}):
        path = os.path.join(tree, folder, NAME)
        if os.path.exists(path):
            entries += read(path, folder)
    return entries


def not_applying(entries, found):
    """The entries that no mutant matches."""
    there = {}
    for m in found:
        there.setdefault((m.file, m.function, m.change), []).append(m.text)
    for e in entries:
        if not any(e.part in text for text in there.get((e.file, e.function, e.change), ())):
            yield "%s: %s :: %s%s" % (e.file, e.function, e.change, " :: " + e.part if e.part else "")


class Compiler:
    """Assembly of single sources, as a build without mutants compiles them, but with -O2."""

    def __init__(self, tree, build):
        self.tree, self.commands, self.originals = os.path.realpath(tree), {}, {}
        with open(os.path.join(build, "compile_commands.json")) as f:
            for entry in json.load(f):
                path = os.path.realpath(os.path.join(entry["directory"], entry["file"]))
                self.commands[os.path.relpath(path, self.tree)] = entry

    def assembly(self, name, text):
        """The assembly of a source with this text; None if it does not compile."""
        entry = self.commands[name]
        words = shlex.split(re.sub(r" -(o|MF|MQ) \S+", "", entry["command"]))
        words = [w for w in words if w not in ("-MD", "-c", entry["file"]) and not re.match("-[OgW]", w)]
        here = os.path.dirname(os.path.join(self.tree, name))
        done = subprocess.run(words + ["-O2", "-w", "-S", "-x", "c", "-iquote", here, "-o", "-", "-"],
                              input='# 1 "%s"\n%s' % (name, text), stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                              encoding="latin-1", cwd=entry["directory"])
        return None if done.returncode else done.stdout

    def same(self, source, start, end, new):
        """True if replacing start to end by this text leaves the code equal. Unknown, hence False, for a header."""
        name = source.name
        if name not in self.commands or new is None:
            return False
        if name not in self.originals:
            self.originals[name] = self.assembly(name, source.text)
        code = self.assembly(name, source.text[:start] + new + source.text[end:])
        return code is not None and code == self.originals[name]
