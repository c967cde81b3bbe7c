#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests that exported names begin with the name of their file or folder.

  symbols.py SOURCE NM CC LIBRARY...    every symbol that a static library exports begins with the first word
                                        of its source file's name (cases.c: case_load, cases_of), or with the
                                        name of the file's folder (problem/riemann.c: problem_riemann)

Files of a library must not use names of each other in a circle: of two that do, one holds a piece that
belongs below both.

Static functions that are compiled for several instruction sets (CLONES) have different names throughout the
libraries: clang gives the dispatch of each a global name, and two of the same name cannot be linked.

The test first tries itself on libraries with a name and a circle that break the rules."""
import functools
import os
import re
import subprocess
import sys
import tempfile

EXPORTED = set("TDRBVWCiI")


def sources(source):
    """path of every C file from the top, with slashes as underscores: that path."""
    files = {}
    for layer in ("src", "reference", "reports", "cases", "verify"):
        for folder, _, names in os.walk(os.path.join(source, layer)):
            for name in names:
                path = os.path.relpath(os.path.join(folder, name), source)
                if name.endswith(".c"):
                    files[path.replace(os.sep, "_")] = path
    return files


def source_of(member, files):
    """The file that an object is made of; the object's name ends with the file's path, with slashes as underscores."""
    name = re.sub(r"\.o(bj)?$", "", os.path.basename(member))
    found = [path for flat, path in files.items() if flat == name or flat.endswith("_" + name)]
    if found:
        return min(found, key=len)
    generated = re.sub(r"^meson-generated_(\.\._)*", "", name)
    folders = {os.path.dirname(path).replace(os.sep, "_") + "_" for path in files.values()}
    folder = max((f for f in folders if generated.startswith(f)), key=len, default="")
    return generated[len(folder):]


def prefixes(path):
    """First words that the symbols of a file may have: those of the file and its folder, also in the singular."""
    words = {os.path.basename(path).split(".")[0].split("_")[0], os.path.basename(os.path.dirname(path))}
    words |= {w[:-1] for w in words if w.endswith("s")} | {w[:-3] + "y" for w in words if w.endswith("ies")}
    return words - {""}


@functools.lru_cache(maxsize=None)
def names_of(nm, library, changed):
    """The output of nm for a library with this time of change."""
    out = subprocess.run([nm, "-A", "-g", library], capture_output=True, text=True)
    if out.returncode:
        sys.exit("%s %s: %s" % (nm, library, out.stderr.strip()))
    found = []
    for line in out.stdout.splitlines():
        match = re.match(r".*[:\[/]([^:\[\]/]+\.o(?:bj)?)\]?:\s*[0-9a-fA-F]*\s+(\w)\s+(\S+)$", line)
        if match and (match[2] in EXPORTED or match[2] == "U"):
            # clang gives the dispatch of a static function over instruction sets a global name
            name = "" if match[3].endswith(".resolver") else match[3].split(".")[0]
            if name and not name.startswith("_"):
                found.append((match[1], name, match[2] != "U"))
    return found


def symbols(nm, library):
    """(object, symbol, is it defined there?) of all global names of a library."""
    return names_of(nm, library, os.stat(library).st_mtime_ns)


def twice_cloned(nm, libraries):
    """Names that are compiled for several instruction sets in more than one object: name, objects."""
    homes = {}
    for library in libraries:
        out = subprocess.run([nm, "-A", library], capture_output=True, text=True, check=True)
        for member, name in re.findall(r"[:\[/]([^:\[\]/]+\.o(?:bj)?)\]?:\s*[0-9a-fA-F]*\s+i\s+(\S+)$",
                                       out.stdout, re.M):
            homes.setdefault(name.split(".")[0], set()).add(member)
    return {name: members for name, members in homes.items() if len(members) > 1}


def circles(source, nm, libraries):
    """Sets of files each of which reaches every other through the names that it uses."""
    files, paths, home, takes = sources(source), {}, {}, {}
    for library in libraries:
        for member, symbol, defined in symbols(nm, library):
            path = paths[member] = paths.get(member) or source_of(member, files)
            if defined:
                home[symbol] = path
            else:
                takes.setdefault(path, set()).add(symbol)
    below = {path: {home[s] for s in names if s in home} - {path} for path, names in takes.items()}
    reach = {}
    for path in below:
        seen, ahead = set(), [path]
        while ahead:
            for other in below.get(ahead.pop(), ()):
                if other not in seen:
                    seen.add(other)
                    ahead.append(other)
        reach[path] = seen
    return {frozenset(other for other in seen if path in reach.get(other, ()))
            for path, seen in reach.items() if path in seen}


def check(source, nm, libraries):
    files = sources(source)
    troubles, paths, count = set(), {}, 0
    for name, members in twice_cloned(nm, libraries).items():
        troubles.add("%s is compiled for several instruction sets in each of %s: clang cannot link two of one name"
                     % (name, " ".join(sorted(members))))
    for library in libraries:
        before = count
        for member, symbol, defined in symbols(nm, library):
            if not defined:
                continue
            path = paths[member] = paths.get(member) or source_of(member, files)
            count += 1
            if symbol.split("_")[0] not in prefixes(path):
                troubles.add("%s exports %s: allowed: %s"
                             % (path, symbol, " ".join(w + "_" for w in sorted(prefixes(path)))))
        if count == before:
            troubles.add("%s exports nothing that can be read" % library)
    return sorted(troubles), count


def try_itself(nm, cc):
    with tempfile.TemporaryDirectory() as folder:
        os.makedirs(os.path.join(folder, "src", "room"))
        for name, text in (("src/pies.c", "int pie_crust(void){return 1;}\nint pies_all = 1;\n"),
                           ("src/room/cake.c", "int room_cream(void){return 1;}\nint cake = 1;\n")):
            for fault in ("", "int broke_down(void){return 1;}\n"):
                with open(os.path.join(folder, name), "w") as f:
                    f.write(text + fault)
                lib = os.path.join(folder, "lib.a")
                if os.path.exists(lib):
                    os.remove(lib)
                member = os.path.join(folder, os.path.basename(name) + ".o")
                subprocess.run(cc.split() + ["-c", os.path.join(folder, name), "-o", member], check=True)
                subprocess.run(["ar", "rcs", lib, member], check=True)
                troubles, count = check(folder, nm, [lib])
                assert count >= 2, "symbols are not read"
                assert bool(fault) == bool(troubles), "%s: %s" % (name, troubles or "broke_down passes")
        clones = "__attribute__((target_clones(\"avx2\", \"default\"))) static int %s(int a){return a + 1;}\n" \
                 "int %s_used(int a){return %s(a);}\n"
        for other in ("knead", "roll"):
            made = []
            for name, inner in (("pies", "knead"), ("cakes", other)):
                path = os.path.join(folder, name + ".c")
                with open(path, "w") as f:
                    f.write(clones % (inner, name, inner))
                made.append(path + ".o")
                if subprocess.run(cc.split() + ["-c", path, "-o", made[-1]], capture_output=True).returncode:
                    break  # no clones on this processor
            else:
                lib = os.path.join(folder, other + ".a")
                subprocess.run(["ar", "rcs", lib] + made, check=True)
                assert bool(twice_cloned(nm, [lib])) == (other == "knead"), "clones of one name: %s" % other
        calls = {"low": "", "middle": "low", "top": "middle"}
        for fault in ("", "top"):
            calls["low"] = fault
            for name, other in calls.items():
                path = os.path.join(folder, "src", name + ".c")
                with open(path, "w") as f:
                    f.write("int %s(void);\nint %s(void){return %s;}\n" % (other or name, name, other + "()" if other else 1))
                subprocess.run(cc.split() + ["-c", path, "-o", os.path.join(folder, name + ".c.o")], check=True)
            lib = os.path.join(folder, "calls.a")
            subprocess.run(["ar", "rcs", lib] + [os.path.join(folder, name + ".c.o") for name in calls], check=True)
            found = circles(folder, nm, [lib])
            expected = {frozenset("src/%s.c" % name for name in calls)} if fault else set()
            assert found == expected, "circles: %s" % found


if __name__ == "__main__":
    if len(sys.argv) < 5:
        sys.exit(__doc__)
    try_itself(sys.argv[2], sys.argv[3])
    troubles, count = check(sys.argv[1], sys.argv[2], sys.argv[4:])
    troubles += ["a circle of files: %s" % " ".join(sorted(circle))
                 for circle in circles(sys.argv[1], sys.argv[2], sys.argv[4:])]
    print("\n".join(troubles))
    print("%d exported symbols; %d troubles" % (count, len(troubles)))
    sys.exit(bool(troubles))
