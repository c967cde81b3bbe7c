# SPDX-License-Identifier: GPL-3.0-or-later
"""schema.py SPHPROOF SCHEMA: tests result documents against the committed JSON Schema.

A validator of the part of JSON Schema (2020-12) that the schema uses; a word that it does not know
is an error, so that nothing in the schema goes unchecked. `diff`, too, must know each kind of document: it finds no
difference between a document and the same one as another tool writes it."""
import json
import os
import re
import subprocess
import sys
import tempfile

TYPES = {"object": dict, "array": list, "string": str, "null": type(None), "boolean": bool}


def is_type(value, name):
    if isinstance(name, list):
        return any(is_type(value, one) for one in name)
    if name in ("number", "integer"):
        number = isinstance(value, (int, float)) and not isinstance(value, bool)
        return number and (name == "number" or isinstance(value, int))
    return isinstance(value, TYPES[name])


class Validator:
    """faults(value, schema, path) yields a text for each violation."""

    def __init__(self, root):
        self.root = root

    def faults(self, value, schema, path="$"):
        for word, rule in schema.items():
            yield from getattr(self, "do_" + word.replace("$", ""))(value, rule, schema, path)

    def valid(self, value, schema):
        return not any(True for _ in self.faults(value, schema))

    def nothing(self, value, rule, schema, path):
        return ()

    do_title = do_description = do_defs = do_schema = do_then = do_else = nothing

    def do_ref(self, value, rule, schema, path):
        target = self.root
        for part in rule.lstrip("#/").split("/"):
            target = target[part]
        return self.faults(value, target, path)

    def do_type(self, value, rule, schema, path):
        if not is_type(value, rule):
            yield "%s: %r is no %s" % (path, value, rule)

    def do_const(self, value, rule, schema, path):
        if value != rule:
            yield "%s: %r is not %r" % (path, value, rule)

    def do_enum(self, value, rule, schema, path):
        if not any(value == one and type(value) is type(one) for one in rule):
            yield "%s: %r is none of %r" % (path, value, rule)

    def do_pattern(self, value, rule, schema, path):
        if isinstance(value, str) and not re.search(rule, value):
            yield "%s: %r does not match %s" % (path, value, rule)

    def do_minimum(self, value, rule, schema, path):
        if is_type(value, "number") and not value >= rule:
            yield "%s: %r < %r" % (path, value, rule)

    def do_minItems(self, value, rule, schema, path):
        if isinstance(value, list) and len(value) < rule:
            yield "%s: fewer than %d items" % (path, rule)

    def do_maxItems(self, value, rule, schema, path):
        if isinstance(value, list) and len(value) > rule:
            yield "%s: more than %d items" % (path, rule)

    def do_required(self, value, rule, schema, path):
        for name in rule:
            if isinstance(value, dict) and name not in value:
                yield "%s: no %s" % (path, name)

    def do_dependentRequired(self, value, rule, schema, path):
        for name, needed in rule.items():
            if isinstance(value, dict) and name in value:
                yield from self.do_required(value, needed, schema, path)

    def do_properties(self, value, rule, schema, path):
        for name, sub in rule.items():
            if isinstance(value, dict) and name in value:
                yield from self.faults(value[name], sub, "%s.%s" % (path, name))

    def do_additionalProperties(self, value, rule, schema, path):
        for name in value if isinstance(value, dict) else ():
            if name in schema.get("properties", {}):
                continue
            if rule is False:
                yield "%s: %s is not expected" % (path, name)
            elif rule is not True:
                yield from self.faults(value[name], rule, "%s.%s" % (path, name))

    def do_items(self, value, rule, schema, path):
        for i, item in enumerate(value if isinstance(value, list) else ()):
            yield from self.faults(item, rule, "%s[%d]" % (path, i))

    def do_allOf(self, value, rule, schema, path):
        for sub in rule:
            yield from self.faults(value, sub, path)

    def do_anyOf(self, value, rule, schema, path):
        if not any(self.valid(value, sub) for sub in rule):
            yield "%s: %r fits no alternative" % (path, value)

    def do_if(self, value, rule, schema, path):
        return self.faults(value, schema.get("then" if self.valid(value, rule) else "else", {}), path)


SNAPSHOTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "data", "snapshots", "")
BRIEF = ["--time", "1e-5", "--samples", "2"]
COMMANDS = [
    ["list"],
    ["list", "keys"],
    ["list", "--where"],
    ["run", "sod", "n=60"],
    ["run", "sound_wave", "n=32", "t_end=0.1"],
    ["run", "sod", "n=60", "--explain"],
    ["run", "gresho", "n=16^2", "t_end=0.05", "boost=1 0.5"],
    ["run", "gresho", "n=16^2", "t_end=0.05", "window_radius=0.4"],
    ["run", "kelvin_helmholtz", "n=20^2", "t_end=0.05"],
    ["run", "rest_3d", "n=10^3", "t_end=0.02"],
    ["run", "sound_wave_2d", "n=16^2", "t_end=0.05", "direction=2 1", "--explain"],
    ["converge", "yee", "--n", "10^2,12^2,14^2,16^2", "t_end=0.2"],
    ["run", "two_rarefactions", "n=60", "cfl=50"],
    ["rates", "sod", "n=60"],
    ["autopsy", "sound_wave", "--n", "10,14,20,28", "t_end=0.1"],
    ["autopsy", "yee", "--n", "10^2,12^2,14^2,16^2", "t_end=0.2"],
    ["autopsy", "gresho", "--rates", SNAPSHOTS + "swift_gresho2d_minimal_32.hdf5"],
    ["judge", SNAPSHOTS + "gizmo_sod1d_dsph_n198.gadget1", "--case", "sod", "--gate", "density_l1=1"],
    ["compare", "sod n=40", "sod n=40 kernel=cubic_spline", "--draws", "2"],
    ["compare", "gresho n=10^2 t_end=0.01", "gresho n=10^2 t_end=0.01", "--draws", "1"],
    ["converge", "sod", "--n", "20,40,60,80", "t_end=0.1"],
    ["converge", "sod", "--n", "20,40,60,80", "t_end=0.05", "--vary", "gradient"],
    ["bench", "--n", "20,40", "t_end=0.05", "--vary", "gradient", *BRIEF],
    ["bench", "--kernels", "--vary", "kernel=cubic_spline", *BRIEF],
    ["bench", "--skips", "sod", "n=90", "t_end=0.05", *BRIEF],
    ["bench", "--steps", "kelvin_helmholtz", "n=16^2", "t_end=0.05", *BRIEF],
    ["bench", "--skips", "sound_wave", "n=24", "t_end=0.1", *BRIEF],
    ["bench", "--scaling", "--n", "20,40,60,80", "t_end=0.02", *BRIEF],
    ["bench", "sound_wave", "--n", "24,16", "--vary", "eta=1.5,0.1", *BRIEF],
    ["riemann", "1", "0", "1", "0.125", "0", "0.1", "--sample", "-1:1:5", "--time", "0.1"],
    ["riemann", "1", "-5", "0.4", "1", "5", "0.4"],
    ["kernel", "cubic_spline", "--dim", "2", "--at", "0.5"],
    ["kernel", "verify/examples/hostile_prints.so", "--dim", "2", "--at", "0.5"],
    ["kernel", "verify/examples/hostile_abort_in_dh.so", "--dim", "2", "--at", "0.5"],
    ["stress", "few", "blasts"],
    ["stress", "steps"],
]


def rewritten(value):
    """Another tool writes 1.0 as 1, 1e30 with all its digits, keys in another order."""
    if isinstance(value, dict):
        return {key: rewritten(value[key]) for key in sorted(value, reverse=True)}
    if isinstance(value, list):
        return [rewritten(v) for v in value]
    return int(value) if isinstance(value, float) and value == int(value) else value


def differences(program, folder, document, figures):
    """What `diff` finds between a document and itself; without figures there is nothing to compare."""
    for name, content in ("old.json", document), ("new.json", rewritten(document)):
        with open(os.path.join(folder, name), "w", encoding="ascii") as text:
            json.dump(content, text)
    done = subprocess.run([program, "diff", "old.json", "new.json", "--json", "-"], capture_output=True, text=True, cwd=folder)
    verdicts = [figure["verdict"] for figure in json.loads(done.stdout)["figures"]] if done.stdout else []
    well = set(verdicts) == {"same"} if figures else not verdicts
    return [] if well and done.returncode == (0 if figures else 1) else ["diff: %d, %s %s" % (done.returncode, set(verdicts), done.stderr)]


def main():
    program, path = map(os.path.abspath, sys.argv[1:])
    with open(path, encoding="ascii") as text:
        schema = json.load(text)
    validator, bad = Validator(schema), 0
    with tempfile.TemporaryDirectory() as folder:
        for words in COMMANDS:
            # plug-ins are beside the program
            words = [os.path.join(os.path.dirname(program), w) if w.endswith(".so") else w for w in words]
            done = subprocess.run([program, *words, "--json", "-"], capture_output=True, text=True,
                                  cwd=folder, timeout=60)
            try:
                document = json.loads(done.stdout, parse_constant=lambda c: 1 / 0)
                faults = list(validator.faults(document, schema))
            except (ValueError, ZeroDivisionError) as error:
                faults = ["no JSON (exit %d): %s; %s" % (done.returncode, error, done.stderr)]
            for fault in faults[:5]:
                print("%s: %s" % (" ".join(words), fault))
            if not faults and words[0] != "compare":
                figures = words[0] != "list" and "--explain" not in words
                faults = differences(program, folder, document, figures)
                for fault in faults:
                    print("%s: %s" % (" ".join(words), fault))
            bad += bool(faults)
            # the validator must be able to fail: each document without one of its parts is wrong
            for name in () if faults else ("schema", "machine", "date"):
                broken = {key: part for key, part in document.items() if key != name}
                if validator.valid(broken, schema):
                    print("%s: a document without %s is accepted" % (" ".join(words), name))
                    bad += 1
        large = {"schema": "sphproof/1", "command": "bench", "points": [{"scheme": "s", "error": 1e30}]}
        for fault in differences(program, folder, large, True):
            print("a large integer: %s" % fault)
            bad += 1
    # faults, score: written by verify/test/faults.py, verify/mutants/score
    known = subprocess.run([program, "--help"], capture_output=True, text=True, check=True).stdout
    for command in schema["properties"]["command"]["enum"]:
        if command not in ("faults", "score") and not re.search(r"^ +%s " % command, known, flags=re.M):
            print("the schema has documents of '%s', a command that there is not" % command)
            bad += 1
    print("%d documents, %d wrong" % (len(COMMANDS), bad))
    return bad > 0


if __name__ == "__main__":
    sys.exit(main())
