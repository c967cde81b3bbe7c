#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests verify/mutants/score on a tree of one page, whose mutants that survive are known.

  score.py SCORE WORK

Exit status 77 (skipped): libclang's Python module is not installed."""
import importlib.machinery
import json
import os
import re
import shutil
import subprocess
import sys
import types

TREE = {
    "meson.build": """project('tiny', 'c', default_options: ['c_std=gnu17'])
subdir('src')
test('tiny', executable('test_tiny', 'test_tiny.c', link_with: tiny, include_directories: 'src'), suite: 'quick')
""",
    "src/meson.build": "tiny = static_library('tiny', 'tiny.c')\n",
    "src/tiny.h": """double tiny_area(double a, double b);
int tiny_sum(int n);
double tiny_never(double a, double b);
double tiny_close(double a);
int tiny_set(int *to);
double tiny_weight(int i);
int tiny_first(const void *a, const void *b);
int tiny_least(int n, int m);
void tiny_clear(char **texts, int n);
double tiny_rules(double a, double b);
double tiny_heap(int n);
""",
    "src/tiny.c": """#include "tiny.h"
static const double close = 1e-9;
double tiny_area(double a, double b)
{
    return a * b; /* a test sees whether this is right */
}
int tiny_sum(int n)
{
    int sum = 0;
    for (int i = 0; i < n; i++)
        sum += i;
    if (sum > 5) return sum; return 5;
}
double tiny_never(double a, double b)
{
    return a - b; /* nobody calls it */
}
double tiny_close(double a)
{
    return a > 2 * close ? a : 0;
}
int tiny_set(int *to)
{
    *to = 7;
    if (*to != 7)
        return 1;
    return 0;
}
static const double weights[] = {0.5, 2.5};
double tiny_weight(int i)
{
    return weights[i];
}
int tiny_first(const void *a, const void *b)
{
    return *(const int *)a < *(const int *)b ? -1 : 1;
}
int tiny_least(int n, int m)
{
    return n < m ? n : m;
}
#include <stdlib.h>
void tiny_clear(char **texts, int n)
{
    for (int i = 0; i < n; i++)
        if (texts[i]) free(texts[i]);
}
#include <math.h>
#include <poll.h>
#include <stdio.h>
enum { WIDE = 40, COUNT = 3, MANY = 31 };
static const double limit = 3.5;
static const double used = 4.25;
static double mean(double p, double q)
{
    return fabs(p - q) * (p + q);
}
static double slope(double p, double q)
{
    return fabs(q) * (p + q);
}
double tiny_rules(double a, double b)
{
    double x[COUNT] = {0}, y[COUNT] = {0, 0}, sum = slope(a, b) + mean(b, a) + y[1];
    if (a > limit && b < used) sum += used;
    char word[WIDE], words[MANY][WIDE] = {"4"};
    for (int all = 0; all < COUNT; all++) x[all] = a;
    for (int some = 0; some < COUNT; some++)
        if (a > b) sum += x[some];
    poll(NULL, 0, 77);
    if (snprintf(word, WIDE, "at %g", 1.75 * sum) > 0) sum += words[1][0];
    return snprintf(word, WIDE, "%s", words[0]) > 0 ? sum : 0;
}
double tiny_heap(int n)
{
    double *x = calloc(n, sizeof *x), all = 0;
    for (int each = 0; each < n; each++) all += x[each];
    free(x);
    return all >= 0;
}
""",
    "test_tiny.c": """#include "tiny.h"
int main(void)
{
    int set = 0;
    if (tiny_area(3, 4) != 12 || tiny_sum(5) != 10 || tiny_set(&set) != 0 || set != 7 ||
        tiny_weight(0) != 0.5 || !tiny_heap(3)) return 1;
    return tiny_close(3e-9) > 0 ? 0 : 2;
}
""",
}
LISTED = """# why
[tiny.c]
tiny_never :: a - b -> + :: nobody calls it
"""


def main(score, work):
    sys.path.insert(0, os.path.dirname(score))
    import generate
    try:
        generate.load_libclang()
    except SystemExit as missing:
        print(missing)
        return 77
    shutil.rmtree(work, ignore_errors=True)
    tree, failures = os.path.join(work, "tree"), []
    for name, text in TREE.items():
        write(os.path.join(tree, name), text)

    def expect(what, is_so):
        if not is_so:
            failures.append(what)

    def run(*words, code=1):
        done = subprocess.run([sys.executable, score, "--source", tree, "--work", os.path.join(work, "work"), "--json",
                               os.path.join(work, "score.json")] + list(words), stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True)
        expect("exit status %d, not %d, of %s:\n%s" % (done.returncode, code, words, done.stdout), done.returncode == code)
        if code == 2:
            return done.stdout, {}
        with open(os.path.join(work, "score.json")) as f:
            return done.stdout, json.load(f)

    sys.path.insert(0, os.path.dirname(score))
    import trial
    checks = trial.checks_of(os.path.join(os.path.dirname(score), "..", "check"))
    expect("checks are tried one at a time: %s" % checks, len(checks.get("hydro", ())) > 10 and len(checks.get("exact", ())) > 4)

    said, first = run()
    entry = [f for f in first["files"] if f["file"] == "src/tiny.c"][0]
    survivors = {s["change"]: s for s in first["survivors"]}
    expect("every mutant is killed, listed or survives", entry["mutants"] == entry["killed"] + entry["listed"] + entry["survived"])
    for change in ("a * b -> /", "sum += i -> -=", "*to = 7; -> ;", "close = 1e-9 -> * 10", "7 -> 7 + 1"):
        expect("'%s' is generated" % change, change in said)
        expect("'%s' is noticed:\n%s" % (change, said), change not in survivors or survivors[change]["line"] == 25)
    expect("nobody comes past tiny_never", survivors.get("a - b -> +", {}).get("why") == "no test comes by")
    expect("of > and >= where both give 5 the compiler makes the same code",
           "sum > 5 -> >=" in said and "sum > 5 -> >=" not in survivors)
    for change in ("*(const int *)a < *(const int *)b -> <=", "n < m -> <="):
        expect("of two that are equal either is taken: '%s'" % change, change not in said)
    expect("no number that was computed is a decimal limit", "a > 2 * close -> <" in said and "a > 2 * close -> >=" not in said)
    expect("what only frees is left to the sanitizers", "texts" not in said)
    expect("but not the greater of two", "n < m -> >" in survivors)
    for change, wanted in (("mean(b, a) -> exchanged", False), ("slope(a, b) -> exchanged", True), ("all < COUNT -> <=", False),
                           ("some < COUNT -> <=", True), ("77 -> ", False), ("NULL, 0, 77); -> ;", False),
                           ("sum) > 0 -> >=", False), ("words[0]) > 0 -> >=", True), ("40 -> ", False), ("31 -> ", True), ("0 -> 1e-6 (", True), ("limit = 3.5 -> * 1.1", True),
                           ("limit = 3.5 -> * (1", False), ("used = 4.25 -> * (1", True), ("1.75 -> 1.75 * 1.1", True),
                           ("1.75 -> 1.75 * (1", False)):
        expect("what can change nothing is not generated, and all else is: '%s'" % change, (change in said) == wanted)
    line = 1 + TREE["src/tiny.c"][:TREE["src/tiny.c"].index("x[COUNT] = {0}")].count("\n")
    expect("of lists of zeros only longer ones are changed", 
           len(re.findall("^ *\\d+/.*tiny.c:%d: 0 -> 1e-6" % line, said, flags=re.M)) == 2)
    expect("a factor of 10 the other way is noticed by nobody",
           survivors.get("close = 1e-9 -> / 10", {}).get("why") == "no test fails: 1 of 1 that come by")
    expect("a constant in an initialiser is compiled singly and noticed",
           "0.5 -> (0.5 * (1 + 1e-6))" in said and "0.5 -> (0.5 * (1 + 1e-6))" not in survivors)
    expect("one that nobody reads survives",
           survivors.get("2.5 -> (2.5 * (1 + 1e-6))", {}).get("why") == "no test fails: 1 of 1 that come by")
    expect("what is 5 where 10 is more", any(s["line"] == 12 for s in first["survivors"]))

    if shutil.which("clang"):
        expect("no test alone sees what is read beyond a block of memory", "each < n -> <=" in survivors)
        shutil.copytree(os.path.join(work, "work"), os.path.join(work, "work.copy"), symlinks=True)
        said, third = run("--sanitize", "--work", os.path.join(work, "work.copy"))
        gone = survivors.keys() - {s["change"] for s in third["survivors"]}
        expect("the sanitizers do, of this and nothing else: %s" % gone, gone == {"each < n -> <=", "[each] -> + 1"})
    again, second = run()
    expect("what stands in the record is not run again", not re.search(r"^ *\d+/\d+ ", again, flags=re.M))
    expect("and the score is the same", second["files"] == first["files"])
    reasons = os.path.join(tree, "src/equivalent.txt")
    write(reasons, LISTED)
    said, listed = run()
    expect("a listed one does not count as a survivor", listed["files"][0]["listed"] == entry["listed"] + 1 and
           listed["files"][0]["survived"] == entry["survived"] - 1)
    for old, new in ("- b", "- c"), ("tiny_never", "tiny_sum"), (":: nobody", ":: a + b :: nobody"):
        write(reasons, LISTED.replace(old, new))
        said, listed = run()
        expect("one that does not apply is said: " + said,
               "does not apply any more" in said and listed["files"][0]["listed"] == entry["listed"])
    write(reasons, LISTED.replace("tiny.c", "other.c"))
    expect("so is one of a file that is not there", "does not apply any more" in run()[0])
    expect("unless other files alone are asked for", "does not apply any more" not in run("--only", "src/tiny.c")[0])
    write(reasons, LISTED.replace(" :: nobody", ", for nobody"))
    expect("a broken list is refused by its line", "equivalent.txt:3" in run(code=2)[0])
    os.remove(reasons)

    in_rounds(expect, score)
    with open(os.path.join(tree, "meson.build"), "a") as f:
        f.write("test('never', executable('test_never', 'test_never.c', link_with: tiny, include_directories: 'src'), suite: 'quick')\n")
    write(os.path.join(tree, "test_never.c"), '#include "tiny.h"\nint main(void) { return tiny_never(5, 2) != 3; }\n')
    said, more = run("--tests", "tiny|never", "--again", "survived")
    expect("a test that is new notices what survived before: " + said,
           "a - b -> +" not in {s["change"] for s in more["survivors"]})
    expect("what the tree has no more is not in the copy", not os.path.exists(reasons.replace(tree, os.path.join(work, "work", "tree"))))
    parts = [run("--shard", "%d/3" % i)[1]["chosen"] for i in (1, 2, 3)]
    expect("shards are all of it", sum(parts) == first["generated"])
    expect("a sample is no larger than asked for", run("--sample", "7", "--seed", "3")[1]["chosen"] == 7)
    stable_draw(expect, score)
    near_to_constants(expect, score)
    failing_thread(expect)
    sound_without(expect)
    expect("a shard that is none is refused", "I/N" in run("--shard", "4/3", code=2)[0])
    hidden = os.path.join(work, "hidden", "clang")
    write(os.path.join(hidden, "__init__.py"), "raise ImportError('hidden')\n")
    without = subprocess.run([sys.executable, score, "--source", tree, "--work", os.path.join(work, "other")],
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                             env=dict(os.environ, PYTHONPATH=os.path.dirname(hidden)))
    expect("without libclang it says what to install: " + without.stdout,
           without.returncode == 4 and "python3-clang" in without.stdout)
    for failure in failures:
        print("not so: " + failure)
    return 1 if failures else 0


def load(score):
    """The command as a module: its name has no suffix."""
    return importlib.machinery.SourceFileLoader("score", score).load_module()


def stable_draw(expect, score):
    """Draws twenty of a hundred mutants; then with one line less, and others before it."""
    choose = load(score).choose

    def drawn(names, seed):
        found = [types.SimpleNamespace(key=n, file=n) for n in names]
        asked = types.SimpleNamespace(only="", seed=seed, budget=float("inf"), sample=20)
        return [m.key for m in choose(found, asked, {})]

    names = ["m%d" % i for i in range(100)]
    first, gone = drawn(names, 1), drawn(names, 1)[7]
    less = [n for n in drawn(["new"] + [n for n in reversed(names) if n != gone], 1) if n != "new"]
    expect("a draw by another seed is another", len(first) == 20 and drawn(names, 2) != first)
    expect("a draw stands where lines come and go: %s, %s" % (first, less), less[:19] == [n for n in first if n != gone])


def near_to_constants(expect, score):
    """The tests near a file's constants are those that reach its mutants; for a file without other mutants all tests."""
    drawn = [types.SimpleNamespace(number=1, file="a.h"), types.SimpleNamespace(number=2, file="b.c"),
             types.SimpleNamespace(number=0, file="a.h"), types.SimpleNamespace(number=0, file="c.h")]
    judge = types.SimpleNamespace(reached={1: {"one"}, 2: {"two"}})
    sources = {n: types.SimpleNamespace(text="") for n in ("a.h", "b.c", "c.h")}
    near = load(score).near_of(sources, drawn, judge)
    expect("near to constants: %s" % near, near["a.h"] == {"one"} and near["c.h"] == {"one", "two"})


def failing_thread(expect):
    import trial

    def fail_at(worker):
        if worker == 1:
            raise OSError("gone")

    try:
        trial.in_threads(fail_at, 2)
        failed = False
    except OSError:
        failed = True
    expect("what goes wrong in a thread is reported", failed)


def sound_without(expect):
    """A mutant of a constant is compiled in the build itself: whether the test that notices it passes without it is
    tried in a copy of the build made before."""
    import trial
    asked = []
    table = types.SimpleNamespace(build="/build", environment={}, units={"t": {"seconds": 1, "failed": "", "reached": [], "differs": []}},
                                  place=lambda worker: (("/build", "/copy"), "/scratch"),
                                  sound=lambda unit, place, scratch: asked.append(place) or True)
    judge = trial.Judge(table, {}, 9)
    judge.admit([types.SimpleNamespace(name="t", key="k", command=[])])
    judge.built = lambda unit: True
    usual, trial.run_unit = trial.run_unit, lambda *_: ("exit status 1", 0)
    m = types.SimpleNamespace(number=0, constant=True, key="m", file="f", line=1, change="1 -> 2")
    entry = judge.judge(m, {"t"}, None, 0)
    trial.run_unit = usual
    expect("a constant that a test notices is killed: %s" % entry, entry["outcome"] == "killed")
    expect("its test is sound without it: %s" % asked, asked == [("/build", "/copy")])


def in_rounds(expect, score):
    """Cheap tests come first; mutants that they notice are not tried again, and survivors are reported once."""
    import trial
    table = trial.Table.__new__(trial.Table)
    table.build = "/build"
    table.units = {"dear": {"seconds": 7}, "cheap": {"seconds": 0.2}, "middling": {"seconds": 1}}
    units = [types.SimpleNamespace(name=n, command=["python3" if n == "script" else "/build/test"])
             for n in ("dear", "cheap", "middling", "new", "script")]
    expect("cheap tests, and new ones that are no scripts, come first, then what is dearer",
           [[u.name for u in r] for r in table.in_rounds(units)] == [["cheap", "new"], ["middling", "script"], ["dear"]])
    asked, reported, admitted = [], [], []

    def judge_one(m, near, before, worker):
        asked.append((m.key, len(admitted)))
        return {"outcome": "killed" if m.key in admitted else "survived"}

    table = types.SimpleNamespace(copy_builds=lambda workers: None, find=lambda units, workers, over: units)
    judge = types.SimpleNamespace(table=table, admit=admitted.extend, judge=judge_one)

    class Mutant:
        def __init__(self, key):
            self.key, self.file = key, "f"

    mutants = [Mutant(k) for k in ("a", "b", "c")]
    command = load(score)
    command.try_all(mutants, [["a"], ["b"]], judge, lambda: {"f": set()}, {},
                    lambda m, entry: reported.append((m.key, entry["outcome"])), 1, lambda: float("inf"))
    expect("what the first round notices is not asked in the second: %s" % asked,
           asked == [("a", 1), ("b", 1), ("c", 1), ("b", 2), ("c", 2)])
    expect("each is reported once: %s" % reported, reported == [("a", "killed"), ("b", "killed"), ("c", "survived")])
    left, reported[:] = iter([9, 9, 9, -1] + [-1] * 99), []
    command.try_all(mutants, [["x"], ["y"]], judge, lambda: {"f": set()}, {},
                    lambda m, entry: reported.append((m.key, entry["outcome"])), 1, lambda: next(left))
    expect("when the time is over, those that were asked are reported: %s" % reported, 1 <= len(reported) < 3)


def write(path, text):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w") as f:
        f.write(text)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    sys.exit(main(os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])))
