# SPDX-License-Identifier: GPL-3.0-or-later
"""Generates mutants of constants that cannot be switched at run time: numbers in initialisers of static data, in
enumerators, in macros that are a number, and in macro calls at file scope (KERNEL, INTEGRATOR, KEY, ROW ...). Each is
compiled separately, see verify/mutants/score."""
import os
import re

# Capacities of text and paths: one byte more is not a fault.
CAPACITIES = re.compile(r"TEXT|PATH|BYTES|LABEL|WORD|NAME|LINE|BUFFER|_MAX$")
NUMBER = re.compile(r"(?<![\w.\"])(\d+\.?\d*(?:e[-+]?\d+)?|\.\d+)(?![\w.])")
TYPED = re.compile(r'"(\d+(?:\.\d+)?(?:e[-+]?\d+)?)"')


class Constant:
    """A number in a source's text, and its replacement."""

    number, function = 0, "-"  # without a switch

    def __init__(self, source, start, end, new, change):
        self.source, self.file, self.start, self.end, self.new = source, source.name, start, end, new
        self.line, self.text, self.change = source.line(start), source.text_at(start), change
        self.constant, self.ordinal = True, 0

    @property
    def key(self):
        return "%s | %s | %s | %d" % (self.file, self.text, self.change, self.ordinal)


def blank(text):
    """Comments, strings and characters as blanks of the same length."""
    return re.sub(r'/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'',
                  lambda m: re.sub(r"[^\n]", " ", m[0]), text, flags=re.S)


def closing(text, at):
    """The position of the bracket that closes the one at `at`."""
    depth = 0
    for i in range(at, len(text)):
        depth += (text[i] in "([{") - (text[i] in ")]}")
        if depth == 0:
            return i
    return len(text)


def regions(name, text):
    """(start, end, true for enumerators) of constant expressions in a text without comments and strings."""
    found = []
    for m in re.finditer(r"^#define (\w+)[ \t]+(\(?-?[\d.][^\n\\]*)$", text, flags=re.M):
        if not CAPACITIES.search(m[1]):
            found.append((m.start(2), m.end(2), False))
    code = re.sub(r"^#(?:[^\n\\]|\\\n|\\.)*", lambda m: re.sub(r"[^\n]", " ", m[0]), text, flags=re.M)
    at = 0
    while at < len(code):  # file scope
        c = code[at]
        if c == "{":
            before, end = code[code.rfind(";", 0, at) + 1:at].rstrip(), closing(code, at)
            if re.search(r"\benum(\s+\w+)?$", before):
                found.append((at, end, True))
            elif before.endswith("="):
                found.append((at, end, False))
            elif before.endswith(")"):
                for m in re.finditer(r"\bstatic const [^;{=]*=\s*\{", code[at:end]):
                    found.append((at + m.end() - 1, closing(code, at + m.end() - 1), False))
            at = end
        elif c == "(":
            end = closing(code, at)
            if re.search(r"(^|[;\n])\s*[A-Z][A-Z_]+$", code[:at]):
                found.append((at, end, False))
            at = end
        at += 1
    return found


def alternatives(code, enumerator):
    if "e" in code:
        return ["(%s * 10)" % code, "(%s / 10)" % code]
    if "." in code:
        return ["(%s * (1 + 1e-6))" % code] if float(code) else []
    return ["(%s + 1)" % code, "(%s - 1)" % code] if int(code) or enumerator else []


def typed(code):
    """The same for a number in a string."""
    if "e" in code:
        mantissa, _, power = code.partition("e")
        return ['"%se%d"' % (mantissa, int(power) + 1)]
    if "." in code:
        return ['"%s0001"' % code]
    return ['"%d"' % (int(code) + 1)] if int(code) else []


def is_capacity(name, texts):
    """True if all that a number is used for is the size of texts."""
    use = r"\bchar [^;(){}=*]*\[%s\](?!\[)|\bsnprintf\([^,;]*, %s," % (name, name)
    words = [len(re.findall(r"\b%s\b" % name, text)) for text in texts]
    sizes = [sum(len(re.findall(r"\b%s\b" % name, found)) for found in re.findall(use, text)) for text in texts]
    return sum(sizes) > 0 and sum(words) == 1 + sum(sizes)


def find(sources):
    """All constants of the judged sources (name: generate.Source) and of the lists that they include."""
    constants, texts = [], {name: blank(source.text) for name, source in sources.items()}
    for name in sorted(sources):
        source, plain = sources[name], texts[name]
        near = [plain] if name.endswith(".c") else texts.values()  # where an enumerator is known
        for start, end, enumerator in regions(name, plain):
            for m in NUMBER.finditer(plain, start, end):
                if plain[m.start() - 1] == "[" or plain[:m.start()].rstrip()[-1:] == "[":
                    continue
                named = re.findall(r"(\w+)\s*=[^=,]*$", plain[start:m.start()])
                if enumerator and named and (CAPACITIES.search(named[-1]) or is_capacity(named[-1], near)):
                    continue
                for new in alternatives(m[1], enumerator):
                    constants.append(Constant(source, m.start(), m.end(), new, "%s -> %s" % (m[1], new)))
            for m in TYPED.finditer(source.text, start, end) if name.endswith(".def") else ():
                for new in typed(m[1]):
                    constants.append(Constant(source, m.start(), m.end(), new, "%s -> %s" % (m[0], new)))
    seen = {}
    for c in constants:
        alike = c.file, c.text, c.change
        c.ordinal = seen[alike] = seen.get(alike, -1) + 1
    return constants


def readers(sources, name):
    """The files whose mutants a test reaches if it reads constants of this one: this file, files of the same
    name, and files that include it."""
    stem, base = os.path.splitext(name)[0], os.path.basename(name)
    return [n for n, s in sources.items() if n == name or os.path.splitext(n)[0] == stem
            or re.search(r'#include "(?:[\w/]+/)?%s"' % re.escape(base), s.text)]
