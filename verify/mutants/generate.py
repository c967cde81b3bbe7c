# SPDX-License-Identifier: GPL-3.0-or-later
"""Generates mutants: finds every operator, constant, index, sign, order of arguments, statement and
returned status of the judged files with libclang (Debian: python3-clang), and writes alternatives
into a copy of the tree, which an environment variable switches on (schemata.h).

single.py makes those that cannot be switched (numbers in initialisers, enumerators, arguments of
macros at file scope): each is compiled separately."""
import bisect
import collections
import glob
import itertools
import json
import os
import re
import shlex
import subprocess
import sys

# The judged files, as paths from the top of the tree.
JUDGED = ("src/", "reference/", "verify/command/", "verify/judge/", "verify/library/", "verify/report/", "src/run/",
          "src/readers/", "src/statistics/", "verify/study/", "verify/suite/", "src/support/cache.c",
          "src/support/csv.c", "reports/")
PURE = set("""fabs sqrt cbrt pow exp expm1 log log1p log10 sin cos tan atan2 atan hypot floor ceil round fmin fmax
fma isfinite isnan lround largest least power labs abs""".split())
SWAPPED_CALLS = {"fmin": "fmax", "fmax": "fmin", "fminl": "fmaxl", "fmaxl": "fminl", "least": "largest", "largest": "least"}
# Comparisons of strings are taken as tests of equality.
COMMUTE = {"fmin", "fmax", "fminl", "fmaxl", "least", "largest", "hypot", "strcmp", "strncmp", "memcmp", "json_equal",
           "calloc", "page_allocate", "fwrite", "swap"}
ALLOCATIONS = {"malloc", "calloc", "realloc"}  # a larger block changes nothing
WAITS = {"poll", "nanosleep"}  # the last argument of poll is a time; how long a process waits changes no result
SAID = ("reports/", "verify/command/")  # numbers are printed with three digits, or drawn
ARITHMETIC = {"+": "-", "-": "+", "*": "/", "/": "*"}
COMPARE = {"<": ("<=", ">"), ">": (">=", "<"), "<=": ("<", ">="), ">=": (">", "<="), "==": ("!=",), "!=": ("==",),
           "&&": ("||",), "||": ("&&",)}
BITS = {"&": "|", "|": "&", "<<": ">>", ">>": "<<", "%": "*"}
ASSIGN = {"+=": "-=", "-=": "+=", "*=": "/=", "/=": "*=", "&=": "|=", "|=": "&=", "%=": "+="}
# A call that frees is the business of sanitizers, and one that prints that of messages; one that only waits is nobody's.
DROPPED_BY_NOBODY = re.compile(r"^(\w*free\w*|fclose|closedir|close_entry|close_dataset|posix_spawn\w*_destroy|json_decref|H5\w+close|h5\.\w*[cC]lose|nanosleep|poll\(NULL|\(void\))\b|^\(void\)")


def refuse(text, code=4):
    print("score: " + text, file=sys.stderr)
    sys.exit(code)


def load_libclang():
    try:
        import clang.cindex as cindex
    except ImportError:
        sys.path.append("/usr/lib/python3/dist-packages")  # a python of one's own does not look there
        try:
            import clang.cindex as cindex
        except ImportError:
            refuse("libclang's Python module is missing (Debian: apt-get install python3-clang)")
    try:
        cindex.Index.create()
    except cindex.LibclangError:
        found = sorted(glob.glob("/usr/lib/llvm-*/lib/libclang*.so*"))
        if not found:
            refuse("libclang is missing (Debian: apt-get install python3-clang)")
        cindex.Config.set_library_file(found[-1])
    return cindex


class Site:
    """A range of a file, and its replacement."""

    def __init__(self, start, end, how, alternative, change, pure, function):
        self.start, self.end, self.how, self.alternative = start, end, how, alternative
        self.change, self.pure, self.function = change, pure, function
        self.number = 0

    @property
    def new(self):
        """The replacement in the mutant's text, if it is a piece of text."""
        return {"value": "(%s)" % self.alternative, "statement": "(void)0", "jump": ";"}.get(self.how)


WORD = re.compile(r"\b[a-zA-Z_]\w*|(?<![\w.])[0-9.]+(?:e-?[0-9]+)?")


def is_decimal(word):
    """True for a number that is no short binary fraction."""
    return word[0] in ".0123456789" and word != "." and float(word) * 1024 % 1 != 0


class Source:
    """One judged file: its text and the sites in it."""

    def __init__(self, tree, name):
        self.name = name
        with open(os.path.join(tree, name), encoding="utf-8") as f:
            self.text = f.read()
        self.bytes = self.text.encode()
        if len(self.bytes) != len(self.text):  # offsets of clang are bytes
            self.text = self.bytes.decode("latin-1")
        self.sites, self.seen, self.macros = [], set(), []
        self.compared = collections.defaultdict(set)  # by name: whether it stands in a comparison, of all its uses
        constants = re.findall(r"^#define (\w+)\s[\s\\]*([0-9.]+(?:e-?[0-9]+)?)\b", self.text, flags=re.M)
        for line in re.findall(r"^static const double ([^;{]*);", self.text, flags=re.M):
            constants += re.findall(r"(\w+) = ([0-9.]+(?:e-?[0-9]+)?)(?:,|$)", line)
        self.decimals = {name for name, value in constants if is_decimal(value)}

    def line(self, offset):
        return self.text.count("\n", 0, offset) + 1

    def text_at(self, offset):
        """The line at this offset, without its indentation."""
        start = self.text.rfind("\n", 0, offset) + 1
        return self.text[start:self.text.find("\n", offset)].strip()

    def only_compares(self, site):
        """True for a millionth more of a constant that stands in comparisons alone, as for a number there."""
        return (site.how == "constant" and site.change.endswith("(1 + 1e-6)")
                and self.compared[site.change.split(" =")[0]] == {True})

    def add(self, start, end, how, alternative, change, pure, function="-"):
        key = (start, end, alternative)
        if key not in self.seen:
            self.seen.add(key)
            self.sites.append(Site(start, end, how, alternative, change, pure, function))


def flat(text):
    """The text on one line without comments: an alternative must not move lines."""
    return " ".join(re.sub(r"/\*.*?\*/", " ", text, flags=re.S).replace("\\\n", " ").split())


class Walker:
    """Finds the sites of the sources in one translation unit."""

    def __init__(self, cindex, tree, sources, done):
        self.c, self.tree, self.sources, self.done = cindex, tree, sources, done
        self.kind = cindex.CursorKind
        self.returns = self.spans = None
        self.either, self.in_allocation, self.compared, self.printed = set(), False, False, False
        self.decimals = set().union(*(source.decimals for name, source in sources.items() if name.endswith(".h")))

    def file_of(self, cursor):
        f = cursor.location.file
        return os.path.relpath(os.path.realpath(f.name), self.tree) if f else None

    def unit(self, unit, skip):
        for cursor in unit.cursor.get_children():
            if cursor.kind == self.kind.MACRO_INSTANTIATION:
                source = self.sources.get(self.file_of(cursor))
                if source:
                    source.macros.append((cursor.extent.start.offset, cursor.extent.end.offset))
        self.spans = None
        for cursor in unit.cursor.get_children():
            name = self.file_of(cursor)
            source = self.sources.get(name)
            if not source or name in skip:
                continue
            self.source, self.text = source, source.text
            if source.macros is not self.spans:
                self.spans = source.macros
                spans = sorted(set(self.spans))
                self.starts = [a for a, b in spans]
                self.reach = list(itertools.accumulate((b for a, b in spans), max))
            if cursor.kind == self.kind.FUNCTION_DECL and cursor.is_definition():
                self.function, self.compares = cursor.spelling, self.is_comparison(cursor)
                self.returns = cursor.result_type.get_canonical().spelling
                self.returns_bool = cursor.result_type.get_canonical().kind == self.c.TypeKind.BOOL
                for child in cursor.get_children():
                    if child.kind == self.kind.COMPOUND_STMT:
                        self.statement(child)
            elif cursor.kind == self.kind.VAR_DECL:
                self.constant(cursor)

    # --- helpers ---

    def span(self, cursor):
        return cursor.extent.start.offset, cursor.extent.end.offset

    def in_macro(self, cursor):
        a, b = self.span(cursor)
        at = bisect.bisect_right(self.starts, a)
        return at > 0 and b <= self.reach[at - 1]

    def here(self, cursor):
        e = cursor.extent
        return e.start.file and e.end.file and e.start.file.name == e.end.file.name

    def code(self, cursor):
        a, b = self.span(cursor)
        return flat(self.text[a:b])

    def pure(self, cursor):
        """True if the expression can be evaluated twice, whatever its operands are."""
        k = self.kind
        for c in cursor.walk_preorder():
            if c.kind == k.CALL_EXPR and c.spelling not in PURE:
                return False
            if c.kind in (k.COMPOUND_ASSIGNMENT_OPERATOR, k.StmtExpr):
                return False
            if c.kind == k.UNARY_OPERATOR and re.search(r"\+\+|--", self.code(c)):
                return False
            if c.kind == k.BINARY_OPERATOR and self.operator(c)[0] == "=":
                return False
        return True

    def scalar(self, cursor):
        t, k = cursor.type.get_canonical().kind, self.c.TypeKind
        if t in (k.DOUBLE, k.FLOAT, k.LONGDOUBLE):
            return "real"
        if t in (k.INT, k.UINT, k.LONG, k.ULONG, k.LONGLONG, k.ULONGLONG, k.SHORT, k.USHORT, k.CHAR_S, k.CHAR_U,
                 k.SCHAR, k.UCHAR, k.BOOL, k.ENUM):
            return "integer"
        return "pointer" if t == k.POINTER else None

    def operator(self, cursor):
        """Operator, left and right operand of a binary expression."""
        children = list(cursor.get_children())
        if len(children) != 2:
            return "", None, None
        between = self.text[self.span(children[0])[1]:self.span(children[1])[0]]
        return flat(between).strip("() "), children[0], children[1]

    def add(self, cursor, alternative, change=None, pure=False, how="value"):
        a, b = self.span(cursor)
        self.source.add(a, b, how, alternative, change or "%s -> %s" % (self.code(cursor), alternative), pure,
                        self.function)

    # --- mutants without effect on a result ---

    def is_comparison(self, function):
        """True for a comparison for qsort: only the sign of its result matters, and equal elements may have any
        order."""
        types = [a.type.get_canonical().spelling for a in function.get_arguments()]
        return types == ["const void *"] * 2 and function.result_type.spelling == "int"

    def chooses(self, condition, one, other):
        """Excludes < for <= where the condition selects one of two values, as in a < b ? a : b: equal values are the
        same."""
        for c in condition.walk_preorder():
            op, left, right = self.operator(c) if c.kind == self.kind.BINARY_OPERATOR else ("", None, None)
            if op in ("<", ">", "<=", ">=") and {self.code(left), self.code(right)} == {one, other}:
                self.either.add(self.span(c))

    def boundary_shows(self, cursor, op, left, right):
        """False if < in place of <=, or > in place of >=, has no effect: a computed number is never exactly 0.1 or
        1e-3 of another number, which are no short binary fractions."""
        handle = left.type.spelling == "hid_t" and op in ("<", ">=")  # none is 0
        if re.match(r'snprintf\([^"]*"[^%"]', self.code(left)) and self.code(right) == "0":
            return False  # it has printed the letter that its format begins with
        words = WORD.findall(self.code(left) + " " + self.code(right))
        decimal = "real" in (self.scalar(left), self.scalar(right)) and any(
            is_decimal(word) or word in self.source.decimals or word in self.decimals for word in words)
        return not (self.compares or handle or decimal or self.span(cursor) in self.either)

    def always(self, cursor):
        """What is evaluated wherever a statement or expression is, without what only the address is taken of."""
        k, children = self.kind, list(cursor.get_children())
        if cursor.kind in (k.FOR_STMT, k.CXX_UNARY_EXPR) or cursor.kind == k.UNARY_OPERATOR and self.code(cursor)[:1] == "&":
            return
        if (cursor.kind in (k.COMPOUND_STMT, k.IF_STMT, k.WHILE_STMT, k.SWITCH_STMT, k.CONDITIONAL_OPERATOR)
                or cursor.kind == k.BINARY_OPERATOR and self.operator(cursor)[0] in ("&&", "||")):
            children = children[:1]
        yield cursor
        for child in children:
            yield from self.always(child)

    def bare(self, cursor):
        """An expression without parentheses and conversions."""
        while cursor.kind in (self.kind.UNEXPOSED_EXPR, self.kind.PAREN_EXPR) and len(list(cursor.get_children())) == 1:
            cursor = next(cursor.get_children())
        return cursor

    def overruns(self, condition, body):
        """Excludes <= for < where a loop goes on as long as i < N, and its next step begins with a[i] of N elements: the
        address sanitizer, which the tests are also run with (verify/run --full), stops behind the last one."""
        k = self.kind
        if condition.kind == k.BINARY_OPERATOR and self.operator(condition)[0] == "&&":
            _, condition, body = self.operator(condition)
        op, i, bound = self.operator(condition) if condition.kind == k.BINARY_OPERATOR else ("", None, None)
        if op != "<":
            return
        of, number = self.bare(bound).referenced, self.code(bound)
        if of and of.kind == k.ENUM_CONSTANT_DECL:
            number = str(of.enum_value)
        for c in self.always(body):
            array, index = c.get_children() if c.kind == k.ARRAY_SUBSCRIPT_EXPR else (c, c)
            name, array = self.code(array), self.bare(array)
            if (self.code(index) == self.code(i) and array.kind == k.DECL_REF_EXPR and array.referenced.kind == k.VAR_DECL
                    and array.type.kind == self.c.TypeKind.CONSTANTARRAY != c.type.kind
                    and (number == str(array.type.element_count)
                         or self.code(bound) == "sizeof %s / sizeof *%s" % (name, name))):
                self.either.add(self.span(condition))

    def form(self, cursor, other):
        """An expression as nested tuples in which operands that commute are sorted; other: names instead of names."""
        k, cursor = self.kind, self.bare(cursor)
        if cursor.kind == k.DECL_REF_EXPR:
            return other.get(cursor.spelling, cursor.spelling)
        children = list(cursor.get_children())
        op = (self.operator(cursor)[0] if cursor.kind == k.BINARY_OPERATOR else
              self.code(cursor)[:1] if cursor.kind == k.UNARY_OPERATOR else cursor.spelling)
        forms = [self.form(c, other) for c in children] or [self.code(cursor)]
        sign = op == "fabs" and self.bare(children[-1])
        if sign and sign.kind == k.BINARY_OPERATOR and self.operator(sign)[0] == "-":
            forms = [self.form(c, other) for c in sign.get_children()]
        if op in ("+", "*", "==", "!=", "&&", "||", "hypot", *SWAPPED_CALLS) or sign:
            forms.sort(key=repr)
        return (str(cursor.kind), cursor.type.spelling, op, *forms)

    def symmetric(self, declared, at):
        """True for a function that returns an expression in which parameters number `at` and at + 1 commute."""
        known = declared and declared.get_definition()
        body = list(known.get_children())[-1:] if known else []
        statements = [s for b in body if b.kind == self.kind.COMPOUND_STMT for s in b.get_children()]
        if [s.kind for s in statements] != [self.kind.RETURN_STMT] or self.file_of(known) not in self.sources:
            return False
        one, two = [a.spelling for a in known.get_arguments()][at:at + 2]
        value, text = next(statements[0].get_children()), self.text
        self.text = self.sources[self.file_of(known)].text
        same = self.form(value, {}) == self.form(value, {one: two, two: one})
        self.text = text
        return same

    def is_first_letter(self, cursor):
        """True for text[0] as a test for an empty text."""
        base, index = cursor.get_children()
        a, b = self.span(cursor)
        return (self.code(index) == "0" and self.code(cursor) == self.code(base) + "[0]"
                and cursor.type.get_canonical().kind == self.c.TypeKind.CHAR_S
                and re.match(r"\s*(\)|&&|\|\||\?)", self.text[b:b + 80]) is not None)

    # --- statements ---

    def only_frees(self, cursor):
        k, children = self.kind, list(cursor.get_children())
        if cursor.kind == k.COMPOUND_STMT:
            return bool(children) and all(self.only_frees(c) for c in children)
        if cursor.kind == k.FOR_STMT or cursor.kind == k.IF_STMT and len(children) == 2:
            return self.only_frees(children[-1])
        return cursor.kind.is_expression() and DROPPED_BY_NOBODY.match(self.code(cursor)) is not None

    def statement(self, cursor):
        k = self.kind
        if not self.here(cursor) or self.in_macro(cursor) or self.only_frees(cursor):
            return
        if cursor.kind == k.COMPOUND_STMT:
            for child in cursor.get_children():
                self.statement(child)
        elif cursor.kind == k.DECL_STMT:
            for child in cursor.get_children():
                self.declaration(child)
        elif cursor.kind in (k.IF_STMT, k.WHILE_STMT, k.SWITCH_STMT, k.DO_STMT):
            children = list(cursor.get_children())
            where = len(children) - 1 if cursor.kind == k.DO_STMT else 0
            if cursor.kind == k.IF_STMT and children[1].kind == k.BINARY_OPERATOR:
                op, to, value = self.operator(children[1])
                if op == "=":
                    self.chooses(children[0], self.code(to), self.code(value))
            for i, child in enumerate(children):
                if i == where:
                    self.condition(child, cursor.kind == k.IF_STMT)
                else:
                    self.statement(child)
        elif cursor.kind == k.FOR_STMT:
            self.loop(cursor)
        elif cursor.kind in (k.CASE_STMT, k.DEFAULT_STMT, k.LABEL_STMT):
            children = list(cursor.get_children())
            if children:
                self.statement(children[-1])
        elif cursor.kind == k.RETURN_STMT:
            self.returned(cursor)
        elif cursor.kind in (k.BREAK_STMT, k.CONTINUE_STMT):
            self.jump(cursor)
        elif cursor.kind.is_expression():
            self.dropped(cursor)
            self.expression(cursor)
        else:
            for child in cursor.get_children():
                self.statement(child)

    def declaration(self, cursor):
        if cursor.kind != self.kind.VAR_DECL:
            return
        if cursor.storage_class == self.c.StorageClass.STATIC:
            return
        begin = cursor.location.offset
        end, depth = self.span(cursor)[1], 0
        for at in range(begin, end):
            ch = self.text[at]
            depth += (ch in "([{") - (ch in ")]}")
            if ch == "=" and depth == 0:
                break
        else:
            return
        for child in cursor.get_children():
            if child.kind.is_expression() and self.span(child)[0] > at:
                self.expression(child)

    def loop(self, cursor):
        a, _ = self.span(cursor)
        before = self.text[:a].rstrip()
        line = before[before.rfind("\n") + 1:]
        while line.strip() and not line.lstrip().startswith("#") and before[:-len(line)].rstrip(" ").endswith("\\\n"):
            before = before[:-len(line)].rstrip("\n")
            line = before[before.rfind("\n") + 1:] + line
        parallel = line.lstrip().startswith("#pragma omp") and " simd" not in line
        children = list(cursor.get_children())
        body = children[-1]
        if not parallel:
            for child in children[:-1]:
                self.overruns(child, body)
                if child.kind == self.kind.DECL_STMT:
                    self.statement(child)
                elif child.kind.is_expression():
                    self.condition(child, False)
        self.statement(body)

    def jump(self, cursor):
        a, b = self.span(cursor)
        word = self.text[a:b]
        end = self.text.find(";", b)
        if not self.text[b:end].strip():
            self.source.add(a, end + 1, "jump", word, "%s; -> ;" % word, False, self.function)

    def returned(self, cursor):
        children = list(cursor.get_children())
        if not children:
            a, b = self.span(cursor)
            self.source.add(a, self.text.find(";", b) + 1, "jump", "return", "return; -> ;", False,
                            self.function)
            return
        value = children[0]
        code = self.code(value)
        if self.returns == "enum status" and code not in ("STATUS_OK", "0"):
            self.add(value, "(enum status)0", "return %s -> STATUS_OK" % code)
        if self.returns_bool and value.kind != self.kind.BINARY_OPERATOR and not code.startswith("!"):
            self.add(value, "!(%s)" % code, "return %s -> !" % code)
        self.expression(value)

    def dropped(self, cursor):
        code = self.code(cursor)
        if not DROPPED_BY_NOBODY.match(code):
            self.add(cursor, "", "%s; -> ;" % code, how="statement")

    def condition(self, cursor, negate):
        k = self.kind
        inner = cursor
        while inner.kind in (k.UNEXPOSED_EXPR, k.PAREN_EXPR) and len(list(inner.get_children())) == 1:
            inner = list(inner.get_children())[0]
        if negate and inner.kind in (k.DECL_REF_EXPR, k.MEMBER_REF_EXPR, k.CALL_EXPR, k.ARRAY_SUBSCRIPT_EXPR):
            self.add(cursor, "!(%s)" % self.code(cursor))
        self.expression(cursor)

    # --- expressions ---

    def expression(self, cursor, real=False):
        """real: the value is converted to floating point."""
        k = self.kind
        if not self.here(cursor) or self.in_macro(cursor):
            return
        children = list(cursor.get_children())
        if cursor.kind == k.UNEXPOSED_EXPR and len(children) == 1:
            self.expression(children[0], self.scalar(cursor) == "real")
            return
        if cursor.kind in (k.INTEGER_LITERAL, k.FLOATING_LITERAL):
            self.number(cursor, real or cursor.kind == k.FLOATING_LITERAL)
            return
        if cursor.kind == k.CXX_UNARY_EXPR or self.code(cursor).startswith("sizeof"):
            return
        if cursor.kind == k.BINARY_OPERATOR:
            self.binary(cursor)
        elif cursor.kind == k.COMPOUND_ASSIGNMENT_OPERATOR:
            op, left, right = self.operator(cursor)
            if op in ASSIGN and self.scalar(left) in ("real", "integer"):
                self.add(cursor, "(%s %s (%s))" % (self.code(left), ASSIGN[op], self.code(right)),
                         "%s %s %s -> %s" % (self.code(left), op, self.code(right), ASSIGN[op]))
        elif cursor.kind == k.UNARY_OPERATOR:
            self.unary(cursor, children)
        elif cursor.kind == k.CALL_EXPR:
            self.call(cursor, children)
        elif cursor.kind == k.ARRAY_SUBSCRIPT_EXPR and len(children) == 2:
            if self.is_first_letter(cursor):
                return
            index = children[1]
            if not re.match(r"^\d+$", self.code(index)) and self.scalar(index) == "integer" and not self.in_macro(index):
                self.add(index, "(%s) + 1" % self.code(index), "[%s] -> + 1" % self.code(index),
                         self.pure(index))
        elif cursor.kind == k.CONDITIONAL_OPERATOR and len(children) == 3:
            self.chooses(children[0], self.code(children[1]), self.code(children[2]))
            self.condition(children[0], True)
            for child in children[1:]:
                self.expression(child, self.scalar(cursor) == "real")
            return
        elif cursor.kind == k.COMPOUND_LITERAL_EXPR:  # not the size in (double[3]){x}
            for child in children:
                if child.kind == k.INIT_LIST_EXPR:
                    self.expression(child)
            return
        elif cursor.kind == k.INIT_LIST_EXPR:
            for child in children if self.code(cursor) != "{0}" else ():  # {0} clears all members
                a, b = self.span(child)
                if self.text[a - 1] == "[" and re.match(r"\]\s*=[^=]", self.text[b:b + 4]):
                    continue
                self.initialised(child)
            return
        if cursor.kind == k.DECL_REF_EXPR:
            self.source.compared[cursor.spelling].add(self.compared)
        outer = self.in_allocation, self.compared, self.printed
        if cursor.kind == k.CALL_EXPR:
            self.in_allocation = self.in_allocation or cursor.spelling in ALLOCATIONS
            self.compared = self.compared and cursor.spelling in PURE
            self.printed = cursor.spelling != "result_add" and any(
                re.match('"[^"]*%', self.code(a)) for a in cursor.get_arguments())
        elif cursor.kind == k.BINARY_OPERATOR:
            self.compared = self.compared or self.operator(cursor)[0] in ("<", ">", "<=", ">=")
        if cursor.kind == k.CALL_EXPR and cursor.spelling in WAITS:
            children.pop()
        handle = self.compared and children and children[0].type.spelling == "hid_t"  # only the sign of a handle is compared
        for child in children:
            if child.kind.is_expression() and not (handle and self.code(child) == "0"):
                self.expression(child)
        self.in_allocation, self.compared, self.printed = outer

    def initialised(self, cursor):
        """A member of a compound literal: clang has .name = value as an expression around the value."""
        a, b = self.span(cursor)
        if self.text[a] in ".[":
            children = [c for c in cursor.get_children() if c.kind.is_expression()]
            if children and "=" in self.text[a:self.span(children[-1])[0]]:
                self.expression(children[-1])
            return
        self.expression(cursor)

    def number(self, cursor, real):
        a, b = self.span(cursor)
        code = self.text[a:b]
        if not re.match(r"^[0-9.]", code) or code.startswith("0x"):
            return
        if not real:
            if not self.in_allocation and not (self.compares and code == "1"):
                self.add(cursor, "%s + 1" % code, pure=True)
            if code != "0":
                self.add(cursor, "%s - 1" % code, pure=True)
        elif float(code.rstrip("fFlL")) == 0:
            before, after = self.text[:a].rstrip(), self.text[b:].lstrip()
            if not (before.endswith(("<", ">", "=")) and not re.search(r"[^=!<>]=$", before)) and after[:1] not in "<>":
                self.add(cursor, "1e-6", pure=True)
        elif "e" in code.lower():
            if float(code.rstrip("fFlL")) > 1e-100:  # smaller numbers only avoid a division by 0
                factor = "1000" if self.compared else "10"
                self.add(cursor, "%s * %s" % (code, factor), pure=True)
                self.add(cursor, "%s / %s" % (code, factor), pure=True)
        elif self.compared:  # a limit that is off by a millionth affects only values at the limit
            self.add(cursor, ("%s + 1" if float(code.rstrip("fFlL")) % 1 == 0 else "%s * 2") % code, pure=True)
        else:
            self.add(cursor, "%s * %s" % (code, "1.1" if self.printed or self.source.name.startswith(SAID) else "(1 + 1e-6)"), pure=True)

    def binary(self, cursor):
        op, left, right = self.operator(cursor)
        if not left:
            return
        a, b = self.code(left), self.code(right)
        types = self.scalar(left), self.scalar(right)
        pure = self.pure(cursor)
        new = []
        if op in ARITHMETIC and "pointer" not in types and None not in types:
            new = ["+" if op == "*" and self.scalar(cursor) == "integer" else ARITHMETIC[op]]
            pure = pure and not (new[0] == "/" and self.scalar(cursor) == "integer")
        elif op in ("+", "-") and types == ("pointer", "integer"):
            new, pure = [ARITHMETIC[op]], False
        elif op in COMPARE:
            new = COMPARE[op] if len(COMPARE[op]) == 1 or self.boundary_shows(cursor, op, left, right) else COMPARE[op][1:]
            if op in ("&&", "||"):
                pure = False
        elif op in BITS:
            new = [BITS[op]]
        for other in new:
            self.add(cursor, "(%s) %s (%s)" % (a, other, b), "%s %s %s -> %s" % (a, op, b, other), pure)

    def unary(self, cursor, children):
        code = self.code(cursor)
        if not children:
            return
        inner = self.code(children[0])
        if code.startswith("-") and not code.startswith("--"):
            self.add(cursor, "(%s)" % inner, pure=self.pure(cursor))
        elif code.startswith("!"):
            self.add(cursor, "!!(%s)" % inner, "%s -> without !" % code)
        elif code.startswith(("++", "--")) or code.endswith(("++", "--")):
            new = code.replace("++", "\0").replace("--", "++").replace("\0", "--")
            self.add(cursor, new)

    def call(self, cursor, children):
        name = cursor.spelling
        arguments = list(cursor.get_arguments())
        home = cursor.referenced and cursor.referenced.location.file
        if name in SWAPPED_CALLS and (name[0] == "f" or home and home.name.endswith("specialise.h")):
            code = self.code(cursor)
            self.add(cursor, code.replace(name, SWAPPED_CALLS[name], 1),
                     "%s -> %s" % (code, SWAPPED_CALLS[name]), self.pure(cursor))
        declared = cursor.referenced
        fixed = len(list(declared.get_arguments())) if declared and declared.kind == self.kind.FUNCTION_DECL else 99
        if name in COMMUTE or name in WAITS:
            return
        for at, (one, two) in enumerate(zip(arguments[:fixed], arguments[1:fixed])):
            if not (self.here(one) and self.here(two)):
                continue
            kinds = one.type.get_canonical(), two.type.get_canonical()
            same = kinds[0].spelling == kinds[1].spelling or (
                self.scalar(one) == self.scalar(two) and self.scalar(one) in ("real", "integer"))
            texts = self.code(one), self.code(two)
            if same and texts[0] != texts[1] and kinds[0].spelling != "enum status" and not self.symmetric(declared, at):
                (a, b), (c, d) = self.span(one), self.span(two)
                begin, end = self.span(cursor)
                if not begin <= a < b <= c < d <= end:
                    continue
                code = flat(self.text[begin:a] + self.text[c:d] + self.text[b:c] + self.text[a:b] + self.text[d:end])
                self.add(cursor, code, "%s(%s, %s) -> exchanged" % (name, *texts), self.pure(cursor))

    # --- constants at file scope ---

    def constant(self, cursor):
        """static const double a = 1e-9; becomes a variable that is set before main."""
        if (cursor.semantic_parent.kind != self.kind.TRANSLATION_UNIT or self.in_macro(cursor)
                or self.scalar(cursor) != "real" or not cursor.is_definition()):
            return
        a, b = self.span(cursor)
        found = re.match(r"static const double (\w+) = (.*)$", flat(self.text[a:b]))
        end = self.text.find(";", b)
        if not found or self.text[b:end].strip() or "," in found[2]:
            return
        name, value = found.groups()
        if re.search(r"\d", value):
            factors = ("* 10", "/ 10") if "e" in value else ("* (1 + 1e-6)", "* 1.1", "/ 1.1")
            for factor in factors:
                self.source.add(a, end + 1, "constant", "(%s) %s" % (value, factor),
                                "%s = %s -> %s" % (name, value, factor), False)


def clang_arguments(entry):
    words, kept, skip = shlex.split(entry["command"]), [], False
    for word in words[1:]:
        if skip:
            skip = False
        elif word in ("-o", "-MF", "-MQ", "-include"):
            skip = True
        elif re.match(r"-(I|D|std|isystem)", word):
            if word.startswith("-I"):
                word = "-I" + os.path.normpath(os.path.join(entry["directory"], word[2:]))
            kept.append(word)
    return [w for w in kept if not w.startswith("-D_FORTIFY")]


def resources(cindex):
    """The headers of clang, wherever libclang is installed."""
    found = sorted(glob.glob("/usr/lib/llvm-*/lib/clang/*/include") + glob.glob("/usr/lib/clang/*/include"))
    if found:
        return ["-isystem", found[-1]]
    gcc = subprocess.run(["gcc", "-print-file-name=include"], stdout=subprocess.PIPE, text=True).stdout.strip()
    return ["-isystem", gcc]


def judged_files(tree, judged=JUDGED):
    names = []
    for folder, _, files in os.walk(tree):
        for name in files:
            path = os.path.relpath(os.path.join(folder, name), tree)
            if path.endswith((".c", ".h", ".def")) and path.startswith(tuple(judged)):
                names.append(path)
    return sorted(names)


def find(tree, build, judged=JUDGED):
    """The sources, with their sites, of a tree that is configured in `build`."""
    cindex = load_libclang()
    tree = os.path.realpath(tree)
    sources = {name: Source(tree, name) for name in judged_files(tree, judged)}
    with open(os.path.join(build, "compile_commands.json")) as f:
        entries = json.load(f)
    walker, done, index, specialisations = Walker(cindex, tree, sources, set()), set(), cindex.Index.create(), set()
    for entry in entries:
        path = os.path.realpath(os.path.join(entry["directory"], entry["file"]))
        name = os.path.relpath(path, tree)
        specialisation = re.match(r"src/(loop_\w+?|shapes)_[a-z]+\w*\.c$", os.path.relpath(path, os.path.realpath(build)))
        if name not in sources and not (specialisation and judged == JUDGED):
            continue
        if specialisation and specialisation[1] in specialisations and not specialisation[0].startswith("src/shapes"):
            continue  # one specialisation of each kind, one for each kernel
        specialisations.add(specialisation and specialisation[1])
        unit = index.parse(path, args=clang_arguments(entry) + resources(cindex) + ["-w"],
                           options=cindex.TranslationUnit.PARSE_DETAILED_PROCESSING_RECORD)
        bad = [d for d in unit.diagnostics if d.severity >= cindex.Diagnostic.Error]
        if bad:
            refuse("libclang does not understand %s: %s" % (name, bad[0].spelling))
        walker.unit(unit, done)
        seen = {os.path.relpath(os.path.realpath(i.include.name), tree) for i in unit.get_includes()}
        # headers whose contents depend on the includer are read again
        done |= {s for s in seen if s in sources and s.endswith(".h")}
        done.add(name)
    number = 0
    kept = []
    for name in sorted(sources):
        source = sources[name]
        source.sites = [s for s in source.sites if not source.only_compares(s)]
        source.sites.sort(key=lambda s: (s.start, -s.end))
        for site in nested(source.sites):
            number += 1
            site.number = number
            kept.append(site)
        source.sites = [s for s in source.sites if s.number]
    return sources


def nested(sites):
    """Sites that are nested or disjoint; a site that overlaps another one is dropped."""
    stack, good = [], []
    for site in sites:
        while stack and stack[-1].end <= site.start:
            stack.pop()
        if stack and site.end > stack[-1].end:
            continue
        if not stack or (stack[-1].start, stack[-1].end) != (site.start, site.end):
            stack.append(site)
        good.append(site)
    return good


def rewrite(source, active):
    """The text of a source with the alternatives of these numbers."""
    text, sites = source.text, [s for s in source.sites if s.number in active]
    if not sites:
        return text

    def render(start, end, inner):
        out, at, i = [], start, 0
        while i < len(inner):
            site = inner[i]
            same = [s for s in inner[i:] if (s.start, s.end) == (site.start, site.end)]
            within = [s for s in inner[i:] if s.start >= site.start and s.end <= site.end and s not in same]
            out.append(text[at:site.start])
            out.append(wrap(same, render(site.start, site.end, within)))
            at = site.end
            i += len(same) + len(within)
        out.append(text[at:end])
        return "".join(out)

    def wrap(same, original):
        for s in same:
            if s.how == "value" and s.pure:
                original = "SCHEMATA_VALUE(%d, (%s), (%s))" % (s.number, s.alternative, original)
            elif s.how == "value":
                original = "(SCHEMATA_ON(%d) ? (%s) : (%s))" % (s.number, s.alternative, original)
            elif s.how == "statement":
                original = "(SCHEMATA_ON(%d) ? (void)0 : (void)(%s))" % (s.number, original)
            elif s.how == "jump":
                original = "{ if (!SCHEMATA_ON(%d)) %s }" % (s.number, original)
            elif s.how == "constant":
                name = re.search(r"(\w+)\s*=", text[s.start:s.end])[1]
                original = (original.replace("const ", "", 1) +
                            " __attribute__((constructor)) static void schemata_%d(void) "
                            "{ if (SCHEMATA_ON(%d)) %s = %s; }" % (s.number, s.number, name, s.alternative))
        return original

    out = render(0, len(text), sites)
    # Loops are scalar, because a specialisation calls its body, whose copies with many alternatives compile for
    # minutes.
    out = re.sub(r'_Pragma\("omp simd[^"]*"\)', "", out)
    out = re.sub(r"#pragma omp simd.*(\\\n.*)*", lambda m: "\n" * m[0].count("\n"), out)
    return re.sub(r"^ALWAYS_INLINE", "static", out, flags=re.M) if source.name.endswith(".c") and len(sites) > 40 else out
