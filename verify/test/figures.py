#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""figures.py PROGRAM SOURCE   tests that documents show the tables of reports/figures/measure, and no other figures

On the tree: `measure --text` finds no fault, and sentences around the tables have no figures of their own. On a
small tree, with a program that answers at once: measure prints, renews and checks, and reports each of a list of
faults. The nightly run calls `measure --check` on the tree itself."""
import contextlib
import importlib.machinery
import importlib.util
import io
import os
import re
import shutil
import sys
import tempfile

PROGRAM, SOURCE = sys.argv[1:]
LOADER = importlib.machinery.SourceFileLoader("measure", os.path.join(SOURCE, "reports", "figures", "measure"))
sys.dont_write_bytecode = True
MEASURE = importlib.util.module_from_spec(importlib.util.spec_from_loader("measure", LOADER))
LOADER.exec_module(MEASURE)

# a decimal fraction, a power of ten, a percentage, or a number after ±
FIGURE = re.compile(r"\d+\.\d+|\d+e-?\d{1,2}(?!\d)|\d+ ?%|± ?\d")


def measure(*arguments):
    """Exit status and all output."""
    said = io.StringIO()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
        try:
            status = MEASURE.main(list(arguments))
        except SystemExit as left:
            status = left.code
    return status, said.getvalue()


def prose(text):
    """The text without tables, code, headings and cited equations."""
    text = re.sub(r"^\|.*$|^    .*$|^#.*$|^!\[.*$", "", text, flags=re.M)
    text = re.sub(r"```.*?```|`[^`]*`|\]\([^)]*\)|<!--.*?-->", "", text, flags=re.S)
    return re.sub(r"CONVENTIONS eq\. [\d.]+|SPH as textbooks", "", text)


def free_figures(name, text):
    return ["%s: a figure that no command prints: %s" % (name, match.group(0)) for match in FIGURE.finditer(prose(text))]


def on_the_tree():
    status, said = measure("--text", "--source", SOURCE)
    troubles = [] if status == 0 else [said]
    texts = {}
    for name in ("cases/README.md", "reports/precision/README.md"):
        with open(os.path.join(SOURCE, name), encoding="utf-8") as file:
            texts[name] = file.read()
    precision = texts["reports/precision/README.md"]
    texts["reports/precision/README.md"] = precision.replace("2.8 GHz", "")  # a clock rate is no result
    for name, text in texts.items():
        troubles += free_figures(name, text)
    # texts with a fault
    if not free_figures("", "The error is 0.017 here.") or not free_figures("", "It gains 5 %.") or \
            free_figures("", "`eta=3.6` around 48^2, see CONVENTIONS eq. 4.8."):
        troubles.append("figures in sentences are not distinguished from keys")
    return troubles


TABLES = """# a small one
table small | keys
column error | sod n=10..14/2 | density_l1
text remark
row (default) | | | plain
row = | left="2 0 1" | | %s
table seeds | keys
column amplitude | wave n=16^2 seed=1..4 | mode_amplitude
column quiet | wave quiet=yes n=16^2 seed=1..4 | error mode_amplitude
bound bound
row `wave` | jitter=0.1 |
"""
PAGE = "<!-- reports/figures/measure small -->\n<!-- end -->\n<!-- reports/figures/measure seeds -->\n<!-- end -->\n"
# A program that answers at once. FAULT changes its results.
STUB = """#!/bin/sh
n=0; seed=0; error=
for word; do case $word in n=*) n=${word#n=}; n=${n%%^2};; seed=*) seed=${word#seed=};; quiet=*) error=1e-15;; esac; done
value=0.02$n; [ $seed = 0 ] || value=0.1$seed
test -z "$error" || value=1e-15
FAULT
echo "{\\"case\\": \\"$2\\", \\"status\\": \\"ok\\", \\"n\\": $n, \\"errors\\": {\\"density\\": {\\"l1\\": $value}}," \\
     "\\"functionals\\": [{\\"name\\": \\"mode_amplitude\\", \\"value\\": $value, \\"reference\\": 0}]}"
"""


def small_tree(folder, fault=""):
    """Options of measure for a tree with two tables, one page and a program."""
    os.makedirs(os.path.join(folder, "cases"))
    with open(os.path.join(folder, "cases", "wave.ini"), "w", encoding="ascii") as file:
        file.write("[converge]\nmode_amplitude = 1 0.25 known: why\n")
    program(folder, fault)
    write(folder, "page.md", PAGE)
    write(folder, "tables.txt", TABLES % "other")
    return ["--source", folder, "--tables", os.path.join(folder, "tables.txt"), "--jobs", "1", "--program",
            os.path.join(folder, "program")]


def program(folder, fault):
    path = os.path.join(folder, "program")
    write(folder, "program", STUB.replace("%%", "%").replace("FAULT", fault))
    os.chmod(path, 0o755)


def write(folder, name, text):
    with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
        file.write(text)


def read(folder, name):
    with open(os.path.join(folder, name), encoding="utf-8") as file:
        return file.read()


# A change of the small tree after its figures were stored: file (None: the program), old, new; the call of
# measure, and its message with exit status 1 or 2.
FAULTS = {
    "a wrong mean in a document": ("page.md", "0.0212", "0.0312", "--check", "kept 0.0312 ± 0.0002 (3), new 0.0212 ± 0.0002 (3)"),
    "a wrong deviation in a document": ("page.md", "± 0.0002", "± 0.0008", "--check", "kept 0.0212 ± 0.0008"),
    "a wrong number of draws in a document": ("page.md", "(3)", "(5)", "--check", "kept 0.0212 ± 0.0002 (5)"),
    "no figure in a document": ("page.md", "0.0212 ± 0.0002 (3)", "0.0212", "--text", "not measured"),
    "a row that is missing": ("page.md", "| `wave` ", "| `other` ", "--text", "table seeds differs"),
    "a block of no table": ("page.md", "measure small", "measure smell", "--text", "there is no table smell"),
    "a block without an end": ("page.md", "<!-- end -->\n<!-- reports/figures/measure seeds", "<!-- reports/figures/measure seeds",
                               "--text", "no end"),
    "a table that no document shows": ("page.md", PAGE.split("\n")[2], "<!-- -->", "--text", "no document shows"),
    "a row that says another thing": ("tables.txt", "plain", "changed", "--text", "table small differs"),
    "two rows of one name": ("tables.txt", "row = | left=\"2 0 1\" | | other", "row (default) | left=\"2 0 1\" | | plain", "--text",
                             "the same headings"),
    "an error that has grown": (None, "", "[ $seed != 0 ] || value=0.03$n", "--check", "kept 0.0212"),
    "an error that is no number": (None, "", "value='\"nan\"'", "--check", ""),
    "draws that are all the same": (None, "", "value=0.0212", "--check", "all draws are the same"),
    "draws that scatter more": (None, "", "[ $n != 10 ] || value=0.0205; [ $n != 14 ] || value=0.0219", "--check", "kept 0.0212"),
    "numbers of particles that are the same": (None, "", "[ $seed != 0 ] || n=12", "--check", "same number of particles"),
    "a run that breaks down": (None, "", "[ $n != 12 ] || { echo '{\"status\": \"broke_down\", \"n\": 12}'; exit 3; }", "--check",
                               "breaks down"),
    "a program that fails": (None, "", "exit 2", "--check", "exit 2"),
    "two draws": ("tables.txt", "10..14/2", "10..12/2", "--text", "less than three draws"),
    "no range": ("tables.txt", "10..14/2", "10", "--text", "is the draws"),
    "a value that there is not": ("tables.txt", "density_l1", "density_l7", "--check", "no density_l7"),
    "a gate that there is not": ("cases/wave.ini", "mode_amplitude", "velocity_l1", "--text", "no gate"),
    "a column too many": ("tables.txt", "| plain", "| plain | more", "--text", "tables.txt:5: not a line"),
}


def on_a_small_tree(folder):
    troubles = []
    tree = os.path.join(folder, "tree")
    options = small_tree(tree)
    status, said = measure("--text", *options)
    if status != 1 or "not measured" not in said:
        troubles.append("figures that are not measured: exit %s, %s" % (status, said))
    for arguments in (["--update"], ["--text"], ["--check"]):
        status, said = measure(*arguments, *options)
        if status:
            troubles.append("%s: exit %s\n%s" % (arguments, status, said))
    page = read(tree, "page.md")
    for row in ("| keys | error | remark |", "| (default) | 0.0212 ± 0.0002 (3) | plain |", "| `left=\"2 0 1\"` | 0.0212 ",
                "| `wave` | 0.125 ± 0.013 (4) | below 1e-12 (4) | 0.25 |"):
        if row not in page.replace("0.1250", "0.125"):
            troubles.append("no row %s in\n%s" % (row, page))
    # stored figures are not measured again without an option
    program(tree, "exit 2")
    for arguments, wanted in ((["--update"], 0), (["small"], 0), (["--update", "--again"], 4)):
        status, said = measure(*arguments, *options)
        if status != wanted:
            troubles.append("%s: exit %s, not %d\n%s" % (arguments, status, wanted, said))
    for arguments in (["--check", "--text"], ["--again"], ["no_table"], []):
        status, said = measure(*arguments, *options)
        if status != 2:
            troubles.append("%s: exit %s, not 2\n%s" % (arguments, status, said))
    program(tree, "")
    for name, (file, old, new, how, says) in FAULTS.items():
        copy = os.path.join(folder, "copy")
        shutil.rmtree(copy, ignore_errors=True)
        shutil.copytree(tree, copy)
        if file is None:
            program(copy, new)
        else:
            text = read(copy, file)
            if old not in text:
                troubles.append("%s: no '%s' in\n%s" % (name, old, text))
            write(copy, file, text.replace(old, new, 1))
        status, said = measure(how, *[option.replace(tree, copy) for option in options])
        if status not in (1, 2, 4) or says not in said:
            troubles.append("%s: exit %s, and it does not say '%s'\n%s" % (name, status, says, said))
    return troubles


def with_the_program(folder):
    """A shock tube and an order, as measured by the program itself."""
    write(folder, "tables.txt", "table real | keys\ncolumn error | sod n=40..60/10 t_end=0.05 |\n"
                                "row L1 | | density_l1\nrow order | --n 30,40,50,60 --replicates 1 | order density_l1\n")
    write(folder, "tables.txt", read(folder, "tables.txt").replace("row order |", "table order | keys\ncolumn order | sod t_end=0.05 |\nrow order |"))
    write(folder, "page.md", "<!-- reports/figures/measure real -->\n<!-- end -->\n<!-- reports/figures/measure order -->\n<!-- end -->\n")
    options = ["--source", folder, "--tables", os.path.join(folder, "tables.txt"), "--jobs", "1", "--program", PROGRAM]
    troubles = []
    for arguments in (["--update"], ["--check"]):
        status, said = measure(*arguments, *options)
        if status:
            troubles.append("%s: exit %s\n%s" % (arguments, status, said))
    if len(re.findall(r"\d ± \d[\d.]* \([34]\) \|", read(folder, "page.md"))) != 2:
        troubles.append(read(folder, "page.md"))
    return troubles


with tempfile.TemporaryDirectory() as work:
    os.makedirs(os.path.join(work, "real"))
    ALL = on_a_small_tree(work) + with_the_program(os.path.join(work, "real")) + on_the_tree()
for trouble in ALL:
    print(trouble)
if ALL:
    sys.exit("%d troubles" % len(ALL))
print("%d faults are reported; the documents show what is kept" % len(FAULTS))
