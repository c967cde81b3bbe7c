# SPDX-License-Identifier: GPL-3.0-or-later
"""diff.py SPHPROOF: verdicts of `sphproof diff` on documents whose figures are moved by known
amounts, on every kind of document, on reordered ones and on bad input; then `sphproof baseline`."""
import copy
import json
import os
import random
import subprocess
import sys
import tempfile

program = os.path.abspath(sys.argv[1])
faults = []


def sphproof(*words):
    return subprocess.run([program, *words], capture_output=True, text=True, timeout=60)


def expect(what, well, got=""):
    if not well:
        faults.append("%s: %s" % (what, got))


def save(name, document):
    with open(name, "w", encoding="utf-8") as file:
        json.dump(document, file)
    return name


def made_by(*words):
    done = sphproof(*words, "--json", "-")
    return json.loads(done.stdout)


def diff(old, new, *options):
    """Exit status, {path: verdict}."""
    done = sphproof("diff", save("old.json", old), save("new.json", new), *options, "--json", "-")
    document = json.loads(done.stdout) if done.stdout else {"figures": []}
    return done.returncode, {f["path"]: f for f in document["figures"]}, document


def moved(document, path, change):
    """A copy with one figure changed; path: keys and indices."""
    result = copy.deepcopy(document)
    inner = result
    for key in path[:-1]:
        inner = inner[key]
    inner[path[-1]] = change(inner[path[-1]])
    return result


def verdict(what, document, path, name, change, status, expected, *options):
    got, figures, _ = diff(document, moved(document, path, change), *options)
    seen = figures[name]["verdict"]
    expect(what, (got, seen) == (status, expected), (got, seen))
    others = [p for p, f in figures.items() if f["verdict"] != "same" and p != name]
    expect(what + ", the others", not others, others)


def times(factor):
    return lambda value: value * factor


def test_runs(run):
    l1, name = ["errors", "density", "l1"], "errors.density.l1"
    for factor, status, expected, options in (
            (1, 0, "same", ()), (1.0005, 0, "same", ()), (1.04, 0, "worse", ()), (1.06, 1, "worse", ()),
            (1.04, 1, "worse", ("--threshold", "1")), (1.5, 0, "worse", ("--threshold", "60")),
            (0.9, 0, "better", ()), (1e9, 1, "worse", ())):
        verdict("L1 times %g" % factor, run, l1, name, times(factor), status, expected, *options)
    verdict("NaN", run, l1, name, lambda v: "nan", 1, "worse")
    verdict("linf", run, ["errors", "density", "linf"], "errors.density.linf", times(2), 0, "worse")
    cost, cpu = ["cost", "cpu_s"], "cost.cpu_s"
    slow = moved(run, cost, lambda v: 1)
    for factor, expected in ((1.2, "same"), (2, "worse"), (1000, "worse"), (0.4, "better")):
        verdict("CPU times %g" % factor, slow, cost, cpu, times(factor), 0, expected)
    verdict("tiny times", run, cost, cpu, lambda v: 1e-5, 0, "same")
    pairs = ["cost", "pair_interactions"]
    verdict("more work", run, pairs, "cost.pair_interactions", times(2), 0, "worse")
    energy, name = ["conservation", "energy"], "conservation.energy"
    verdict("round-off", run, energy, name, lambda v: 9e-13, 0, "same")
    verdict("energy lost", run, energy, name, lambda v: 1e-6, 1, "worse")
    verdict("broke down", run, ["status"], "status", lambda v: "broke_down", 1, "worse")
    got, figures, document = diff(run, moved(run, ["case"], lambda v: "lax"))
    expect("two cases", got == 0 and document["problem"], document["problem"])
    expect("two cases", {f["verdict"] for f in figures.values()} == {"incomparable"}, figures)
    less = copy.deepcopy(run)
    del less["conservation"]
    got, figures, _ = diff(run, less)
    gone = figures["conservation.energy"]
    expect("missing figure", (gone["verdict"], gone["new"], got) == ("incomparable", None, 0), gone)


def test_studies(study):
    order = next(o for o in study["orders"] if (o["field"], o["norm"]) == ("density", "l1"))
    name = "orders[density, l1].order"
    place = ["orders", study["orders"].index(order), "order"]
    half = (order["high"] - order["low"]) / 2
    verdict("order within its interval", study, place, name, lambda v: v - half, 0, "same")
    verdict("order lost", study, place, name, lambda v: v - 2 * half, 1, "worse")
    verdict("order won", study, place, name, lambda v: v + 2 * half, 0, "better")
    gate = ["orders", place[1], "status"]
    failed = moved(study, gate, lambda v: "fail")
    passed = moved(study, gate, lambda v: "pass")
    expect("gate lost", diff(passed, failed)[0] == 1)
    expect("gate won", diff(failed, passed)[0] == 0)
    # replicates say how far an error may move by chance
    spread = copy.deepcopy(study)
    for level in spread["levels"]:
        level["replicates"] = 4
        level["spread"] = {"density": {"l1": 0.1}}
    level = ["levels", 0, "errors", "density", "l1"]
    name = "levels[n %d].errors.density.l1" % study["levels"][0]["n"]
    verdict("within the spread", spread, level, name, times(1.09), 0, "same")
    verdict("beyond the spread", spread, level, name, times(1.12), 1, "worse")
    verdict("no replicates", study, level, name, times(1.09), 1, "worse")
    shuffled = copy.deepcopy(study)
    for part in ("levels", "orders", "functionals"):
        random.Random(1).shuffle(shuffled[part])
    got, figures, _ = diff(study, shuffled)
    expect("reordered", got == 0 and {f["verdict"] for f in figures.values()} == {"same"}, figures)


def test_checks(verify):
    figure = next(i for i, c in enumerate(verify["checks"]) if c["value"] > 0 and c["floor"] > 0)
    check = verify["checks"][figure]
    name = "checks[%s, %s, %s]" % (check["group"], check["name"], check["subject"])
    value = ["checks", figure, "value"]
    verdict("a check's round-off", verify, value, name + ".value", lambda v: 9 * check["floor"], 0, "same")
    verdict("a check's value", verify, value, name + ".value", lambda v: 1e3 * check["bound"], 0, "worse")
    verdict("a check's failure", verify, ["checks", figure, "status"], name + ".status",
            lambda v: "fail", 1, "worse")
    there, elsewhere = (moved(verify, ["checks", figure, "subject"], lambda s: s + place)
                        for place in (", q 0.333333", ", q 0.564762"))
    _, figures, _ = diff(there, elsewhere)
    missing = [p for p, f in figures.items() if f["verdict"] != "same"]
    expect("the same figure, found at another place", not missing, missing)


def test_kinds():
    with open("cloud.csv", "w", encoding="ascii") as cloud:
        cloud.write("x,volume,f\n" + "".join("%g,0.1,%g\n" % (0.1 * i, i * i) for i in range(20)))
    kinds = (["list"], ["riemann", "1", "0", "1", "0.125", "0", "0.1", "--sample", "-1:1:5"],
             ["kernel", "cubic_spline", "--dim", "2", "--at", "0.1,0.5"],
             ["gradient", "cloud.csv", "--operator", "linear_exact", "--kernel", "cubic_spline", "--dim", "1",
              "--eta", "2"], ["run", "sod", "n=60", "--explain"])
    for words in kinds:
        document = made_by(*words)
        got, figures, _ = diff(document, document)
        expect("%s with itself" % words[0], got == 0 and {f["verdict"] for f in figures.values()} <= {"same"},
               figures)
        expect("figures of %s" % words[0], len(figures) > 3 or words[0] == "list" or len(words) == 4, figures)
    star = made_by(*kinds[1])
    verdict("a figure without better or worse", star, ["p_star"], "p_star", times(1.01), 0, "incomparable")


def test_bad_input(run, study):
    save("run.json", run)
    save("study.json", study)
    save("other.json", {"schema": "other/1", "command": "run"})
    with open("text.json", "w", encoding="ascii") as file:
        file.write('{"schema": "sphproof/1",')
    os.mkdir("folder")
    for words, said in ((["run.json"], "two result documents"), (["run.json", "missing.json"], "missing.json"),
                        (["run.json", "folder"], "folder"), (["text.json", "run.json"], "text.json:1"),
                        (["other.json", "run.json"], "schema"), (["run.json", "study.json"], "two commands"),
                        (["run.json", "run.json", "--threshold", "x"], "--threshold"),
                        (["run.json", "run.json", "--threshold", "-1"], "--threshold"),
                        (["run.json", "run.json", "run.json"], "two")):
        done = sphproof("diff", *words)
        expect("diff %s" % words, done.returncode == 2 and said in done.stderr and not done.stdout,
               (done.returncode, done.stderr))


def test_baseline(run):
    save("run.json", run)
    worse = save("worse.json", moved(run, ["errors", "density", "l1"], times(1.5)))

    def baseline(results, *words):
        return sphproof("baseline", results, "--file", "kept.json", *words)

    for words, said in (([], "no baseline"), (["--accept"], "reason"), (["--accept", "--reason", "  "], "reason"),
                        (["--reason", "because"], "--accept")):
        done = baseline("run.json", *words)
        expect("baseline %s" % words, done.returncode == 2 and said in done.stderr, done.stderr)
        expect("a baseline without a reason", not os.path.exists("kept.json"))
    done = baseline("run.json", "--accept", "--reason", "the first", "--quiet")
    expect("accepted", done.returncode == 0 and "the first" in done.stderr and not done.stdout, done)
    expect("as accepted", baseline("run.json").returncode == 0)
    with open("kept.json", encoding="utf-8") as file:
        before = file.read()
    done = baseline(worse)
    expect("worse than accepted", done.returncode == 1 and "exact" in done.stdout, done)
    with open("kept.json", encoding="utf-8") as file:
        expect("a comparison changes nothing", file.read() == before)
    l1 = run["errors"]["density"]["l1"]
    done = baseline(worse, "--accept", "--reason", "the second")
    line = next(l for l in done.stdout.splitlines() if l.endswith("errors.density.l1"))
    expect("old, new, exact", ["%.6g" % l1, "%.6g" % (1.5 * l1), "0"] == line.split()[1:4], line)
    expect("accepted again", baseline(worse).returncode == 0)
    with open("kept.json", encoding="utf-8") as file:
        reasons = [entry["reason"] for entry in json.load(file)["accepted"]]
    expect("every reason", reasons == ["the first", "the second"], reasons)
    expect("no baseline", sphproof("baseline", "run.json", "--file", "run.json").returncode == 2)


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        run = made_by("run", "sod", "n=60")
        study = made_by("converge", "sod", "--n", "40,60,80,120")
        test_runs(run)
        test_studies(study)
        test_checks(made_by("verify", "norms"))
        test_kinds()
        test_bad_input(run, study)
        test_baseline(run)
        os.chdir("/")
    print("\n".join(faults) or "diff and baseline are sound")
    return bool(faults)


sys.exit(main())
