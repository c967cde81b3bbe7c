#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whose is an exported name? It says so itself.

  symbols.py SOURCE NM CC LIBRARY...    every symbol that a static library exports begins with the first word
                                        of its source file's name (cases.c: case_load, cases_of), or with the
                                        name of the file's folder (problem/riemann.c: problem_riemann)

The test first tries itself on a library with a name that breaks the rule."""
import os
import re
import subprocess
import sys
import tempfile

EXPORTED = set("TDRBVWCiI")


def sources(source):
    """path of every C file from the top, slashes as underscores: that path."""
    files = {}
    for layer in ("src", "reference", "reports", "cases", "verify"):
        for folder, _, names in os.walk(os.path.join(source, layer)):
            for name in names:
                path = os.path.relpath(os.path.join(folder, name), source)
                if name.endswith(".c"):
                    files[path.replace(os.sep, "_")] = path
    return files


def source_of(member, files):
    """The file that an object is made of; objects carry the end of its path, slashes as underscores."""
    name = re.sub(r"\.o(bj)?$", "", os.path.basename(member))
    found = [path for flat, path in files.items() if flat == name or flat.endswith("_" + name)]
    return min(found, key=len) if found else re.sub(r"^meson-generated_(\.\._)*", "", name)


def prefixes(path):
    """First words that its symbols may have: of the file, of its folder; one of cases is a case."""
    words = {os.path.basename(path).split(".")[0].split("_")[0], os.path.basename(os.path.dirname(path))}
    words |= {w[:-1] for w in words if w.endswith("s")} | {w[:-3] + "y" for w in words if w.endswith("ies")}
    return words - {""}


def exported(nm, library):
    """(object, symbol) of all that a library exports."""
    out = subprocess.run([nm, "-A", "--defined-only", "-g", library], capture_output=True, text=True)
    if out.returncode:
        sys.exit("%s %s: %s" % (nm, library, out.stderr.strip()))
    for line in out.stdout.splitlines():
        match = re.match(r".*[:\[/]([^:\[\]/]+\.o(?:bj)?)\]?:\s*[0-9a-fA-F]*\s+(\w)\s+(\S+)$", line)
        if match and match[2] in EXPORTED:
            # clang gives the dispatch of a static function over instruction sets a global name
            name = "" if match[3].endswith(".resolver") else match[3].split(".")[0]
            if name and not name.startswith("_"):
                yield match[1], name


def check(source, nm, libraries):
    files = sources(source)
    troubles, count = set(), 0
    for library in libraries:
        before = count
        for member, symbol in exported(nm, library):
            path = source_of(member, files)
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


if __name__ == "__main__":
    if len(sys.argv) < 5:
        sys.exit(__doc__)
    try_itself(sys.argv[2], sys.argv[3])
    troubles, count = check(sys.argv[1], sys.argv[2], sys.argv[4:])
    print("\n".join(troubles))
    print("%d exported symbols; %d under another's name" % (count, len(troubles)))
    sys.exit(bool(troubles))
