#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests that everything that comments and pages refer to exists.

  references.py SOURCE    in comments of the sources, in scripts and in pages: every equation and section of
                          src/CONVENTIONS.md that is cited, every file (`pair.h`, `src/line/*.c`), every name
                          after the word `see` (`see run_free`), every heading of a page ("Adding things" in
                          src/README.md), and every FILE in `WORD in FILE`, with the word in it

The test first tries itself on a small tree with one fault of each kind."""
import fnmatch
import os
import re
import sys
import tempfile

LAYERS = ("src", "reference", "reports", "verify", "cases")
TEXTS = (".c", ".h", ".def", ".py", ".sh", ".md", ".txt", ".ini", ".build", ".options")
SKIP = {os.path.join("reports", "out"), os.path.join("verify", "fuzz", "corpus")}
# files that the build or a run makes, that the system has, or that examples assume
FOREIGN = {"config.h", "version.h", "family_names.h", "cmocka.h", "summary.md", "my_kernel.c", "file.c", "cloud.csv", "mine.h",
           "particles.csv", "theirs.csv", "mine.csv", "out.csv", "kh.csv", "code.sh"}

COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.S)
# a file called *.c or *.h, or a path; capitals are placeholders (NAME.h, F.csv)
FILE = re.compile(r"(?<![\w/.<>*\[\]-])((?:[a-z_*][\w*.-]*/)*[a-z_*][\w*-]*\.(?:c|h|def|md|py|sh|csv))(?![\w(/.*]|->)")
NUMBER = r"\d+\.\d+"
CITED = re.compile(r"CONVENTIONS,?\s+eqs?\.\s+((?:%s)(?:(?:\s*,\s*|\s*,?\s+(?:and|to|or)\s+|\s*-\s*)%s)*)" % (NUMBER, NUMBER))
SECTION = re.compile(r"CONVENTIONS,?\s+sections?\s+(\d+)(?:\s+to\s+(\d+))?")
DEFINED = re.compile(r"^- \((%s)\) " % NUMBER, re.M)
EQUATION = re.compile(r"\beqs?\. (%s)" % NUMBER)
SEE = re.compile(r"\bsee\s+(?:also\s+)?`?([a-z]\w*_\w+)\b(?!\.)")
WORD_IN = re.compile(r"\bsee\s+([A-Z][A-Z_]+)\s+in\s+([\w/]+\.\w+)")
HEADING = re.compile(r"\"([A-Z][\w ,]+)\"\s+in\s+(?:the\s+|\w+/)README|README(?:\.md)?,?\s+\"([A-Z][\w ,]+)\"")


def unmarked(text):
    """The words of a comment in one line, without the stars and hashes of its lines."""
    return re.sub(r"\s*\n\s*(?:\*(?!/)|#)?\s*", " ", text)


def prose(path, text):
    if path.endswith((".c", ".h", ".def")):
        return " ".join(unmarked(c) for c in COMMENT.findall(text))
    return unmarked(text)


def code(path, text):
    return COMMENT.sub(" ", text) if path.endswith((".c", ".h", ".def")) else ""


def tree(source):
    """path: text, of every file that may refer to others or be referred to."""
    texts = {}
    for name in sorted(os.listdir(source)):
        if os.path.isfile(os.path.join(source, name)) and name.endswith(TEXTS):
            texts[name] = None
    for layer in LAYERS:
        for folder, _, names in os.walk(os.path.join(source, layer)):
            folder = os.path.relpath(folder, source)
            if any(folder == s or folder.startswith(s + os.sep) for s in SKIP):
                continue
            texts.update((os.path.join(folder, n), None) for n in names)
    for path in texts:
        if path.endswith(TEXTS):
            with open(os.path.join(source, path), errors="replace") as f:
                texts[path] = f.read()
    return texts


def there(reference, paths):
    """True if such a file exists: a whole path, the end of one, or a pattern of either."""
    parts = reference.count("/")
    for path in paths:
        end = "/".join(path.split("/")[-parts - 1:])
        if fnmatch.fnmatchcase(end, reference):
            return True
    return False


def numbers_of(cited):
    """The equations of a citation such as `5.1, 5.2 and 5.4` or `5.1-5.3`."""
    found = re.findall(NUMBER, cited)
    for first, last in re.findall(r"(%s)\s*(?:-|to)\s*(%s)" % (NUMBER, NUMBER), cited):
        section, low = first.split(".")
        if last.split(".")[0] == section:
            found += ["%s.%d" % (section, k) for k in range(int(low), int(last.split(".")[1]))]
    return found


def check(source):
    texts = tree(source)
    page = texts.get("src/CONVENTIONS.md") or ""
    equations = DEFINED.findall(page)
    sections = re.findall(r"^## (\d+)\.", page, re.M)
    headings = [h for p, t in texts.items() if p.endswith("README.md") for h in re.findall(r"^#+ (.*)$", t or "", re.M)]
    names = set(re.findall(r"\w+", " ".join(code(p, t) for p, t in texts.items() if t)))
    troubles = ["src/CONVENTIONS.md: equation %s stands there twice" % e
                for e in set(equations) if equations.count(e) > 1]
    me = os.path.join("verify", "test", "references.py")
    for path, text in sorted(texts.items()):
        if text is None or path == me:
            continue
        words = prose(path, text)
        cited = [n for c in CITED.findall(words) for n in numbers_of(c)]
        if path == "src/CONVENTIONS.md":
            cited += EQUATION.findall(words)
        troubles += ["%s: no equation %s in src/CONVENTIONS.md" % (path, n) for n in cited if n not in equations]
        troubles += ["%s: no section %s in src/CONVENTIONS.md" % (path, n)
                     for pair in SECTION.findall(words) for n in pair if n and n not in sections]
        if "CONVENTIONS" not in path:
            for word in re.findall(r"\b(PHYSICS|DIMENSIONS\.md|ACCURACY\.md)\b", words):
                troubles.append("%s: %s is no page of the project" % (path, word))
        for name in SEE.findall(words):
            if name not in names:
                troubles.append("%s: `see %s`: no such name" % (path, name))
        for word, file in WORD_IN.findall(words):
            if not any(word in (t or "") for p, t in texts.items() if p.endswith(file)):
                troubles.append("%s: `see %s in %s`: it is not there" % (path, word, file))
        for pair in HEADING.findall(words):
            heading = pair[0] or pair[1]
            if heading not in headings:
                troubles.append('%s: no heading "%s" in a README.md' % (path, heading))
        if path.endswith((".c", ".h", ".def", ".md")):
            for file in FILE.findall(words):
                if os.path.basename(file) not in FOREIGN and not there(file, texts):
                    troubles.append("%s: no file %s" % (path, file))
    return troubles, len(equations)


GOOD = {
    "README.md": "# Program\n## Adding things\nA kernel is a file in `src/core/kernel/NAME.h`; loops are `src/loop_*.c`.\n",
    "src/CONVENTIONS.md": "# Conventions\n## 1. Symbols\n- (1.1) P = 1\n- (1.2) eq. 1.1 again\n",
    "src/loop_one.c": "/* CONVENTIONS eq. 1.1, see add_up and README, \"Adding things\" */\nint add_up(void);\n",
    "src/two.h": "/* CONVENTIONS eqs. 1.1\n * and 1.2, section 1 of CONVENTIONS; loop_one.c */\n",
}
BAD = {  # text added to a file, and the expected message
    "an equation": ("src/two.h", "/* CONVENTIONS eqs. 1.1 to 1.3 */", "no equation 1.3"),
    "an equation of the page": ("src/CONVENTIONS.md", "as eq. 1.7 says", "no equation 1.7"),
    "an equation twice": ("src/CONVENTIONS.md", "- (1.1) P = 2", "twice"),
    "a section": ("src/two.h", "/* CONVENTIONS\n * section 4 */", "no section 4"),
    "a page": ("src/two.h", "/* see PHYSICS */", "PHYSICS is no page"),
    "a file": ("src/two.h", "/* as in loop_two.c */", "no file loop_two.c"),
    "a path": ("README.md", "see `src/line/loop_one.c`", "no file src/line/loop_one.c"),
    "a pattern": ("README.md", "see `src/pool_*.c`", "no file src/pool_*.c"),
    "a name": ("src/two.h", "/* see\n * take_away */", "no such name"),
    "a word in a file": ("src/two.h", "/* see REMARKS in loop_one.c */", "it is not there"),
    "a heading": ("src/two.h", "/* \"Removing things\" in the README */", "no heading"),
}


def plant(files, folder):
    for path, text in files.items():
        os.makedirs(os.path.join(folder, os.path.dirname(path)), exist_ok=True)
        with open(os.path.join(folder, path), "w") as f:
            f.write(text)


def try_itself():
    with tempfile.TemporaryDirectory() as folder:
        plant(GOOD, folder)
        troubles, _ = check(folder)
        assert not troubles, "a sound tree is refused: %s" % troubles
        for fault, (path, text, said) in BAD.items():
            plant({path: GOOD[path] + text + "\n"}, folder)
            troubles, _ = check(folder)
            assert any(said in t for t in troubles), "%s that does not exist is not found" % fault
            plant({path: GOOD[path]}, folder)
    return len(BAD)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    planted = try_itself()
    troubles, equations = check(sys.argv[1])
    print("\n".join(troubles))
    print("%d equations; %d planted faults found; %d references to what does not exist"
          % (equations, planted, len(troubles)))
    sys.exit(bool(troubles))
