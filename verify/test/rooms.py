#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Who includes whom, read from the sources.

  rooms.py SOURCE            the folders of src, reference, reports and verify, and their files, must include
                             each other without a circle, and a room of verify only those that its line in
                             verify/meson.build names, or that these name
  rooms.py SOURCE --print    the graph, one folder a line
  rooms.py SOURCE --dot      the same for graphviz

A folder and those inside it are one room (src/kernel is a family of src), but the folders inside it may not
include each other in a circle either. The test first tries itself on small trees with faults."""
import os
import re
import sys
import tempfile

LAYERS = {"src": set(), "reference": set(), "reports": set()}  # of these each knows nobody
BESIDE = {"verify/test", "verify/fuzz", "verify/examples", "verify/mutants", "verify/package", "verify"}  # see all, seen by nobody
GENERATED = {"config.h", "kernel_names.h", "version.h"}
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.M)
ROOM = re.compile(r"^\s*\['(\w+)', \[([^\]]*)\]", re.M)


def allowed(source):
    """For each room the rooms it may see: verify's as its meson.build lists them."""
    sees = dict(LAYERS)
    with open(os.path.join(source, "verify", "meson.build")) as f:
        lines = ROOM.findall(f.read())
    for name, below in lines:
        sees["verify/" + name] = set(LAYERS)
        for other in re.findall(r"\w+", below):
            other = "verify/" + other
            sees["verify/" + name] |= {other} | sees[other]
    return sees


def sources(source):
    files = []
    for layer in list(LAYERS) + ["verify"]:
        for folder, _, names in os.walk(os.path.join(source, layer)):
            files += [os.path.relpath(os.path.join(folder, n), source) for n in names
                      if n.endswith((".c", ".h", ".def"))]
    return sorted(files)


def room_of(file):
    parts = file.split("/")
    return "/".join(parts[:2]) if parts[0] == "verify" and len(parts) > 2 else parts[0]


def includes(source, files, troubles):
    """file: the files that it includes. A name belongs to the folder that has it, its own first."""
    graph = {}
    for file in files:
        with open(os.path.join(source, file)) as f:
            names = INCLUDE.findall(f.read())
        graph[file] = set()
        for name in names:
            at = [f for f in files if f.endswith("/" + name)]
            own = [f for f in at if room_of(f) == room_of(file)] or at
            if name in GENERATED:
                continue
            if len(own) != 1:
                troubles.append("%s includes \"%s\", which stands at %s"
                                % (file, name, " and ".join(own) or "no place"))
            graph[file].update(own)
    return graph


def circle(graph):
    """Some circle as a list of nodes, or None."""
    state, path = {}, []

    def visit(node):
        state[node] = "open"
        path.append(node)
        for other in sorted(graph.get(node, ())):
            if state.get(other) == "open":
                return path[path.index(other):] + [other]
            if other not in state:
                found = visit(other)
                if found:
                    return found
        state[node] = "done"
        path.pop()
        return None

    for node in sorted(graph):
        found = visit(node) if node not in state else None
        if found:
            return found
    return None


def folders(graph):
    """The graph of folders; what a folder and one inside it have with each other is left out."""
    result = {}
    for file, others in graph.items():
        a = os.path.dirname(file)
        for other in others:
            b = os.path.dirname(other)
            if not (a + "/").startswith(b + "/") and not (b + "/").startswith(a + "/"):
                result.setdefault(a, set()).add(b)
    return result


def judge(source):
    troubles = []
    files = sources(source)
    graph, sees = includes(source, files, troubles), allowed(source)
    for what, found in ("files", circle(graph)), ("folders", circle(folders(graph))):
        if found:
            troubles.append("a circle of %s: %s" % (what, " -> ".join(found)))
    for file, others in graph.items():
        room = room_of(file)
        if room not in sees and room not in BESIDE:
            troubles.append("%s: verify/meson.build lists no room '%s'" % (file, room))
        for other in others:
            there = room_of(other)
            if there != room and (there in BESIDE or room in sees and there not in sees[room]):
                troubles.append("%s includes %s: upward" % (file, other))
    return troubles, graph


def try_itself():
    """A sound small tree, then the same with a fault: what the judge must say about it."""
    sound = {"src/core.h": "", "reports/page.h": "", "reference/wave.h": "",
             "verify/meson.build": "  ['low', [], []],\n  ['high', ['low'], []],\n",
             "verify/low/low.c": '#include "low.h"\n#include "core.h"\n', "verify/low/low.h": "",
             "verify/high/high.c": '#include "low.h"\n#include "high.h"\n', "verify/high/high.h": "",
             "verify/test/test_high.c": '#include "high.h"\n'}
    faults = [({}, None),
              ({"verify/low/low.h": '#include "high.h"\n'}, "upward"),
              ({"verify/low/low.h": '#include "high.h"\n', "verify/high/high.h": '#include "low.h"\n'},
               "circle of files"),
              ({"verify/low/low.c": '#include "high.h"\n', "verify/high/high.c": '#include "low.h"\n'},
               "circle of folders"),
              ({"src/line/a.h": '#include "b.h"\n', "src/line/c.h": "", "src/cells/b.h": '#include "c.h"\n'},
               "circle of folders"),
              ({"reports/page.h": '#include "core.h"\n'}, "upward"),
              ({"src/core.h": '#include "wave.h"\n'}, "upward"),
              ({"verify/high/high.c": '#include "test.h"\n', "verify/test/test.h": ""}, "upward"),
              ({"verify/high/high.c": '#include "nowhere.h"\n'}, "no place"),
              ({"verify/new/new.c": ""}, "no room")]
    for fault, expected in faults:
        with tempfile.TemporaryDirectory() as tree:
            for path, text in {**sound, **fault}.items():
                path = os.path.join(tree, path)
                os.makedirs(os.path.dirname(path), exist_ok=True)
                with open(path, "w") as f:
                    f.write(text)
            troubles = judge(tree)[0]
        if bool(troubles) != bool(expected) or expected and not any(expected in t for t in troubles):
            sys.exit("rooms.py does not notice its own fault %s: expected '%s', said %s"
                     % (fault, expected, troubles))


def main(source, how=""):
    try_itself()
    troubles, graph = judge(source)
    for trouble in troubles:
        print(trouble)
    rooms = {}
    for file, others in graph.items():
        rooms.setdefault(room_of(file), set()).update(room_of(o) for o in others)
    edges = [(a, sorted(rooms[a] - {a})) for a in sorted(rooms)]
    if how == "--print":
        print("\n".join("%-18s %s" % (a, " ".join(b)) for a, b in edges))
    if how == "--dot":
        print("digraph rooms {\n" + "\n".join('  "%s" -> "%s";' % (a, c) for a, b in edges for c in b) + "\n}")
    print("%d files, %d rooms, %d faults" % (len(graph), len(rooms), len(troubles)))
    return 1 if troubles else 0


if __name__ == "__main__":
    if not 2 <= len(sys.argv) <= 3:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
