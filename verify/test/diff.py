# SPDX-License-Identifier: GPL-3.0-or-later
"""diff.py SPHPROOF: `sphproof diff` knows the figures of every kind of document; a document does not differ from
itself, also if another tool has rewritten it; bad input is refused. (Verdicts on changed figures: verify/test/report;
`sphproof baseline`: the transcripts.)"""
import json
import os

from script import call, expect, json_of, play, write



def save(name, content):
    write(name, json.dumps(content))
    return name


def diff(old, new, *options):
    """Exit status, {path: verdict}."""
    done = call("diff", save("old.json", old), save("new.json", new), *options, "--json", "-")
    whole = json.loads(done.stdout) if done.stdout else {"figures": [], "problem": done.stderr, "summary": {}}
    return done.returncode, {f["path"]: f for f in whole["figures"]}, whole


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


def test_kinds():
    """Every kind of document is read, all its figures are known, and it does not differ from itself."""
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
             ["run", "gresho", "n=12^2", "t_end=1e-2"], ["verify", "norms"], ["stress", "few", "start"],
             ["converge", "sod", "--n", "40,60,80,120", "--vary", "kernel=cubic_spline,quartic_spline"])
    documents = [json_of(*words, status=None) for words in kinds]
    for document, words in zip(documents, kinds):
        got, figures, whole = diff(document, document)
        expect("%s with itself" % words, got == 0 and {f["verdict"] for f in figures.values()} == {"same"}, whole)
        expect("figures of %s" % words, len(figures) > 3, figures)
    test_rewritten(documents)
    for words in (["list"], ["run", "sod", "n=60", "--explain"]):
        document = json_of(*words, status=None)
        got, figures, whole = diff(document, document)
        expect("%s has no figures" % words, got == 1 and not figures, whole)


def test_bad_input(run):
    save("run.json", run)
    save("other.json", {"schema": "other/1", "command": "run"})
    with open("text.json", "w", encoding="ascii") as file:
        file.write('{"schema": "sphproof/1",')
    os.mkdir("folder")
    for words, said in ((["run.json", "folder"], "folder"), (["text.json", "run.json"], "text.json:1"),
                        (["other.json", "run.json"], "schema"), (["run.json", "run.json", "run.json"], "two")):
        done = call("diff", *words)
        expect("diff %s" % words, done.returncode == 2 and said in done.stderr and not done.stdout,
               (done.returncode, done.stderr))


play(test_kinds, lambda: test_bad_input(json_of("run", "sod", "n=60")))
