# SPDX-License-Identifier: GPL-3.0-or-later
"""diff.py SPHPROOF: verdicts of `sphproof diff` on documents whose figures are moved by known
amounts, on every kind of document, on reordered ones and on bad input. (What is compared at all, and
runs that break down: verify/test/report; `sphproof baseline`: the transcripts.)"""
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
    document = json.loads(done.stdout) if done.stdout else {"figures": [], "problem": done.stderr, "summary": {}}
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
    seen = figures.get(name, {"verdict": "not there"})["verdict"]
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
    k = [entry["name"] for entry in run["functionals"]].index("shock_position")
    verdict("nearer the exact position", run, ["functionals", k, "value"], "functionals[shock_position].value",
            lambda v: run["functionals"][k]["reference"], 0, "better")


def test_identity(stress):
    """Entries are found again by their settings: with one missing, or in another order, the others
    are compared with themselves."""
    cells = stress["cells"]
    got, figures, document = diff(stress, dict(stress, cells=cells[::-1]))
    expect("cells reversed", got == 0 and {f["verdict"] for f in figures.values()} == {"same"}, document["summary"])
    for gone in (0, len(cells) // 2):
        got, figures, _ = diff(stress, dict(stress, cells=cells[:gone] + cells[gone + 1:]))
        lost = [path for path, figure in figures.items() if figure["verdict"] != "same"]
        expect("a cell less", got == 1 and lost and all("cells[" in path for path in lost) and
               {figures[path]["verdict"] for path in lost} == {"vanished"} and
               len({path.rsplit("]", 1)[0] for path in lost}) == 1, lost)
    got, figures, _ = diff(stress, moved(stress, ["cells", 3, "settings", "n"], lambda v: "17"))
    seen = sorted(f["verdict"] for f in figures.values() if f["verdict"] != "same")
    expect("a cell of another n", got == 1 and set(seen) == {"new", "vanished"}, seen)
    ok = next(i for i, cell in enumerate(cells) if cell["outcome"] == "ok" and cell["measured"] is not None)
    broken = moved(moved(stress, ["cells", ok, "outcome"], lambda v: "broke_down"), ["cells", ok, "measured"],
                   lambda v: None)
    got, _, document = diff(stress, broken)
    expect("a cell that breaks down", got == 1 and document["summary"]["regressions"] == 1 and
           document["summary"]["vanished"] == 0, document["summary"])
    got, _, document = diff(broken, stress)
    expect("a cell that survives", got == 0 and document["summary"]["better"] == 1, document["summary"])


def test_alike():
    """Entries that nothing tells apart: the worst of each side, and their number."""
    def document(*values):
        figures = [{"group": "g", "name": "c", "subject": "s", "value": v, "bound": 1, "floor": 0,
                    "status": "pass" if v <= 1 else "fail"} for v in values]
        return {"schema": "sphproof/1", "command": "verify", "checks": figures}
    got, figures, _ = diff(document(0.1, 0.9, 0.2), document(0.9, 0.2, 0.1))
    name = "checks[g, c, s].value (3 alike)"
    expect("the same three", got == 0 and figures[name]["new"] == 0.9, figures)
    got, figures, _ = diff(document(0.1, 0.9, 0.2), document(0.9, 0.2))
    expect("two of three", got == 1 and figures[name]["verdict"] == "vanished", figures)
    got, figures, _ = diff(document(0.1, 0.9, 0.2), document(0.1, 7, 0.2))
    expect("one of three fails", got == 1 and figures["checks[g, c, s].status (3 alike)"]["regression"], figures)
    got, figures, _ = diff(document(0.1, 0.2), dict(document(0.1, 0.2), checks=[
        dict(figure, status="skip") for figure in document(0.1, 0.2)["checks"]]))
    expect("what passed is skipped", got == 1, figures)


def test_rewritten(documents):
    """Another tool writes 1.0 as 1, 1e30 with all its digits, keys in another order."""
    def rewritten(value):
        if isinstance(value, dict):
            return {key: rewritten(value[key]) for key in sorted(value, reverse=True)}
        if isinstance(value, list):
            return [rewritten(v) for v in value]
        return int(value) if isinstance(value, float) and value == int(value) else value
    for document in documents:
        got, figures, whole = diff(document, rewritten(document))
        expect("%s rewritten" % document["command"], got == 0 and
               {f["verdict"] for f in figures.values()} == {"same"}, whole)
    large = {"schema": "sphproof/1", "command": "bench", "points": [{"scheme": "s", "error": 1e30}]}
    got, _, whole = diff(large, rewritten(large))
    expect("a large integer", got == 0, whole)


def test_judged():
    """Snapshots judged, one and several: errors are compared, what was found about them is not."""
    for k, words in enumerate((["n=100"], ["n=100", "t_end=0.1"], ["n=150"])):
        made_by("run", "sod", *words, "--snapshot", "judged%d.csv" % k)
    for files, name in ((["judged0.csv"], "errors.density.l1"),
                        (["judged0.csv", "judged1.csv", "judged2.csv"], "snapshots[dim 1, n 100, time 0.2].errors.density.l1")):
        document = made_by("judge", *files, "--gate", "density_l1=1")
        place = ["snapshots", 0] if len(files) > 1 else []
        # the errors of the one with most particles stand at the top as well
        verdict("judged, an error", document, [*place, "errors", "density", "l1"], name, times(1.2), 1, "worse")
        verdict("judged, an error", document, [*place, "errors", "density", "l1"], name, times(0.8), 0, "better")
        same = moved(document, [*place, "kernel", "ratio"], times(2))
        same = moved(same, ["findings", 0, "name"], lambda v: "elsewhere/" + v)
        got, figures, whole = diff(document, moved(same, ["foreign"], lambda v: not v))
        expect("judged, what was found", got == 0 and figures, whole)
        got, _, whole = diff(document, moved(document, ["time"], times(2)))
        expect("judged at another time", got == 1 and "time" in whole["problem"], whole)
    got, figures, _ = diff(document, moved(document, ["status"], lambda v: "fail"))
    expect("judged and failed", got == 1 and figures["status"]["verdict"] == "worse", figures)


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
    none = moved(study, gate, lambda v: "none")
    expect("a gate that is no more", diff(passed, none)[0] == 1)


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
    """Every kind of document is read, all its figures are known, and differs in nothing from itself."""
    with open("cloud.csv", "w", encoding="ascii") as cloud:
        cloud.write("x,volume,f\n" + "".join("%g,0.1,%g\n" % (0.1 * i, i * i) for i in range(20)))
    kinds = (["riemann", "1", "0", "1", "0.125", "0", "0.1", "--sample", "-1:1:5"],
             ["kernel", "cubic_spline", "--dim", "2", "--at", "0.1,0.5"],
             ["gradient", "cloud.csv", "--operator", "linear_exact", "--kernel", "cubic_spline", "--dim", "1",
              "--eta", "2"],
             ["bench", "sod", "--n", "40,60", "--samples", "1", "--time", "1e-4"],
             ["bench", "--scaling", "--n", "50,100", "--samples", "1", "--time", "1e-4"],
             ["bench", "--kernels", "--vary", "kernel=cubic_spline", "--samples", "1", "--time", "1e-4"],
             ["run", "sedov_2d", "n=16^2", "t_end=1e-3"], ["run", "noh_3d", "n=12^3", "t_end=1e-3"],
             ["run", "gresho", "n=12^2", "t_end=1e-2"],
             ["converge", "sod", "--n", "40,60,80,120", "--vary", "kernel=cubic_spline,quartic_spline"])
    documents = [made_by(*words) for words in kinds]
    for document, words in zip(documents, kinds):
        got, figures, whole = diff(document, document)
        expect("%s with itself" % words, got == 0 and {f["verdict"] for f in figures.values()} == {"same"}, whole)
        expect("figures of %s" % words, len(figures) > 3, figures)
    test_rewritten(documents)
    for words in (["list"], ["run", "sod", "n=60", "--explain"]):
        document = made_by(*words)
        got, figures, whole = diff(document, document)
        expect("%s has no figures" % words, got == 1 and not figures, whole)
    star = documents[0]
    cloud = documents[2]
    verdict("a gradient", cloud, ["points", 3, "gradients", "f", 0], "points[x 0.3].gradients.f.x", times(1.01), 1,
            "incomparable")
    verdict("a figure without better or worse", star, ["p_star"], "p_star", times(1.01), 1, "incomparable")


def test_bad_input(run):
    save("run.json", run)
    save("other.json", {"schema": "other/1", "command": "run"})
    with open("text.json", "w", encoding="ascii") as file:
        file.write('{"schema": "sphproof/1",')
    os.mkdir("folder")
    for words, said in ((["run.json", "folder"], "folder"), (["text.json", "run.json"], "text.json:1"),
                        (["other.json", "run.json"], "schema"), (["run.json", "run.json", "run.json"], "two")):
        done = sphproof("diff", *words)
        expect("diff %s" % words, done.returncode == 2 and said in done.stderr and not done.stdout,
               (done.returncode, done.stderr))


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        run = made_by("run", "sod", "n=60")
        study = made_by("converge", "sod", "--n", "40,60,80,120")
        test_runs(run)
        test_identity(made_by("stress", "few", "start"))
        test_alike()
        test_judged()
        test_studies(study)
        test_checks(made_by("verify", "norms"))
        test_kinds()
        test_bad_input(run)
        os.chdir("/")
    print("\n".join(faults) or "diff is sound")
    return bool(faults)


sys.exit(main())
