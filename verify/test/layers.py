#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests which files include which, by reading the sources.

  layers.py SOURCE            the folders of src, reference, reports and verify, and their files, must include
                              each other without a circle, and a library only the core and those libraries that
                              its line in meson.build names, or that these name; of the solver's sums (src/line,
                              src/cells) only the headers in src/cells/include
  layers.py SOURCE --print    the graph, one library a line
  layers.py SOURCE --dot      the same for graphviz

A library is a folder with those inside it. What stands in src outside of the folders that meson.build names is
the core. The test first tries itself on small trees with faults."""
import os
import re
import sys
import tempfile

INSIDE = ("src/line/", "src/cells/")  # parts of the solver: included by themselves, by benchmarks of their loops, and by tests
SEE_INSIDE = ("src/core/",) + INSIDE + ("verify/bench/", "verify/test/")
CORE, PUBLIC = "src", "src/include"  # the solver; the installed headers: every library may include both
FOLDERS = ("src", "reference", "reports", "verify")
GENERATED = {"config.h", "family_names.h", "h5_soname.h", "version.h"}
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.M)
LAYER = re.compile(r"^\s*\['(\w+)', '([\w/]+)', \[([^\]]*)\]", re.M)

def allowed(source):
    """For each library's folder, the folders that it may include, from meson.build."""
    with open(os.path.join(source, "meson.build")) as f:
        layers = LAYER.findall(f.read())
    folder = {name: where for name, where, _ in layers}
    sees = {CORE: {PUBLIC}, PUBLIC: set()}
    for name, where, below in layers:
        sees[where] = {CORE, PUBLIC}
        for other in re.findall(r"\w+", below):
            sees[where] |= {folder[other]} | sees[folder[other]]
    return sees

def sources(source):
    files = []
    for top in FOLDERS:
        for folder, _, names in os.walk(os.path.join(source, top)):
            files += [os.path.relpath(os.path.join(folder, n), source) for n in names
                      if n.endswith((".c", ".h", ".def"))]
    return sorted(files)

def layer_of(file, layers):
    """The longest folder of a layer that contains the file; files below verify that are in no layer may include all."""
    found = [layer for layer in layers if file.startswith(layer + "/")]
    return max(found, key=len) if found else "/".join(file.split("/")[:2]) if file.startswith("verify/") else None

def includes(source, files, layers, troubles):
    """file: the files that it includes. A name is looked up in the including folder first."""
    graph = {}
    for file in files:
        with open(os.path.join(source, file)) as f:
            names = INCLUDE.findall(f.read())
        graph[file] = set()
        for name in names:
            at = [f for f in files if f.endswith("/" + name.replace("../", ""))]
            own = [f for f in at if layer_of(f, layers) == layer_of(file, layers)] or at
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
    """The graph of folders; edges between a folder and one inside it are left out."""
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
    files, sees = sources(source), allowed(source)
    graph = includes(source, files, sees, troubles)
    for what, found in ("files", circle(graph)), ("folders", circle(folders(graph))):
        if found:
            troubles.append("a circle of %s: %s" % (what, " -> ".join(found)))
    for file, others in graph.items():
        here = layer_of(file, sees)
        if here is None:
            troubles.append("%s stands in no folder that meson.build lists" % file)
        for other in others:
            if other.startswith(INSIDE) and "/include/" not in other and not file.startswith(SEE_INSIDE):
                troubles.append("%s includes %s, which is private to the solver" % (file, other))
            there = layer_of(other, sees)
            if there != here and (there not in sees or here in sees and there not in sees[here]):
                troubles.append("%s includes %s: upward" % (file, other))
    return troubles, graph, sees

def try_itself():
    """A valid small tree, then the same with one fault each, and the expected message."""
    sound = {"meson.build": "  ['low', 'src/low', [], []],\n  ['page', 'reports', ['low'], []],\n"
                            "  ['high', 'verify/high', ['low'], []],\n",
             "src/core/core.h": "", "src/include/sphproof/all.h": "", "reports/page.h": '#include "low.h"\n',
             "src/low/low.c": '#include "low.h"\n#include "core.h"\n#include "sphproof/all.h"\n', "src/low/low.h": "",
             "verify/high/high.c": '#include "low.h"\n#include "high.h"\n', "verify/high/high.h": "",
             "verify/test/test_high.c": '#include "high.h"\n'}
    faults = [({}, None),
              ({"src/low/low.h": '#include "high.h"\n'}, "upward"),
              ({"src/low/low.h": '#include "high.h"\n', "verify/high/high.h": '#include "low.h"\n'}, "circle of files"),
              ({"src/low/low.c": '#include "high.h"\n', "verify/high/high.c": '#include "low.h"\n'}, "circle of folders"),
              ({"src/line/a.h": '#include "b.h"\n', "src/line/c.h": "", "src/cells/b.h": '#include "c.h"\n'},
               "circle of folders"),
              ({"reports/page.h": '#include "high.h"\n'}, "upward"),
              ({"src/core/core.h": '#include "low.h"\n'}, "upward"),
              ({"verify/high/high.c": '#include "test.h"\n', "verify/test/test.h": ""}, "upward"),
              ({"verify/high/high.c": '#include "nowhere.h"\n'}, "no place"),
              ({"src/cells/include/grid.h": "", "verify/high/high.c": '#include "grid.h"\n'}, None),
              ({"src/cells/lanes.h": "", "verify/high/high.c": '#include "cells/lanes.h"\n'}, "private"),
              ({"reference/new.c": ""}, "no folder")]
    for fault, expected in faults:
        with tempfile.TemporaryDirectory() as tree:
            for path, text in {**sound, **fault}.items():
                path = os.path.join(tree, path)
                os.makedirs(os.path.dirname(path), exist_ok=True)
                with open(path, "w") as f:
                    f.write(text)
            troubles = judge(tree)[0]
        if bool(troubles) != bool(expected) or expected and not any(expected in t for t in troubles):
            sys.exit("layers.py does not notice its own fault %s: expected '%s', said %s"
                     % (fault, expected, troubles))

def main(source, how=""):
    try_itself()
    troubles, graph, sees = judge(source)
    for trouble in troubles:
        print(trouble)
    layers = {}
    for file, others in graph.items():
        layers.setdefault(layer_of(file, sees), set()).update(layer_of(o, sees) for o in others)
    edges = [(a, sorted(layers[a] - {a})) for a in sorted(layers)]
    if how == "--print":
        print("\n".join("%-18s %s" % (a, " ".join(b)) for a, b in edges))
    if how == "--dot":
        print("digraph layers {\n" + "\n".join('  "%s" -> "%s";' % (a, c) for a, b in edges for c in b) + "\n}")
    print("%d files, %d libraries and folders, %d faults" % (len(graph), len(layers), len(troubles)))
    return 1 if troubles else 0

if __name__ == "__main__":
    if not 2 <= len(sys.argv) <= 3:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
