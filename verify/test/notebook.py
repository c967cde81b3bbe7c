#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""notebook.py NOTEBOOK PROGRAM LIBRARY: the notebook has no outputs, and all of its cells run: in order by this
Python, and by Jupyter (nbconvert) if that is installed. Without matplotlib cells that plot are skipped, and that is
printed. Exit status 77 (skipped): no numpy, or this build makes no library."""
import json
import os
import shutil
import subprocess
import sys
import tempfile

PATH, PROGRAM, LIBRARY = map(os.path.abspath, sys.argv[1:4])


def has(module, python=sys.executable):
    return subprocess.run([python, "-c", "import " + module], capture_output=True, check=False).returncode == 0


def cells():
    with open(PATH, encoding="utf-8") as file:
        notebook = json.load(file)
    code = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    assert len(code) >= 6 and notebook["nbformat"] == 4
    for cell in code:
        assert not cell["outputs"] and cell["execution_count"] is None, "kept with outputs: %s" % cell["source"]
        assert ("plt." in "".join(cell["source"])) == ("plot" in cell["metadata"].get("tags", [])), cell["source"]
    return code


def plainly(code, plots):
    """Runs all cells, except those that plot if nothing can be plotted, and returns their number."""
    names, ran = {}, 0
    for cell in code:
        if plots or "plot" not in cell["metadata"].get("tags", []):
            exec(compile("".join(cell["source"]), "cell %d" % ran, "exec"), names)
            ran += 1
    assert names["order"] > 0 and names["good"]["exit_status"] == 0 and names["bad"]["exit_status"] == 1
    return ran


def by_jupyter(code):
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(["jupyter", "nbconvert", "--to", "notebook", "--execute", "--output-dir", folder, PATH],
                              capture_output=True, text=True, check=False, timeout=500)
        assert done.returncode == 0, done.stderr[-3000:]
        with open(os.path.join(folder, os.path.basename(PATH)), encoding="utf-8") as file:
            cells_ran = [cell for cell in json.load(file)["cells"] if cell["cell_type"] == "code"]
    assert len(cells_ran) == len(code) and all(cell["execution_count"] for cell in cells_ran)
    outputs = [output for cell in cells_ran for output in cell["outputs"]]
    assert not [output for output in outputs if output["output_type"] == "error"]
    pictures = [output for output in outputs if "image/png" in output.get("data", {})]
    assert len(pictures) == len([cell for cell in code if cell["metadata"].get("tags")]), len(pictures)
    return len(pictures)


def main():
    if not has("numpy") or not os.path.exists(LIBRARY):
        print("no numpy for %s (Debian: python3-numpy), or no library in this build" % sys.executable)
        sys.exit(77)
    os.environ.update(SPHPROOF=PROGRAM, SPHPROOF_LIBRARY=LIBRARY, MPLBACKEND="Agg", PYTHONDONTWRITEBYTECODE="1")
    sys.dont_write_bytecode = True
    os.chdir(os.path.dirname(PATH))
    code = cells()
    plots = has("matplotlib")
    print("by Python: %d of %d cells%s" % (plainly(code, plots), len(code), "" if plots else
                                           "; the others plot, and there is no matplotlib (Debian: python3-matplotlib)"))
    kernel = "/usr/bin/python3" if os.path.exists("/usr/bin/python3") else sys.executable  # Debian's Jupyter uses this Python
    if not shutil.which("jupyter") or not has("nbconvert, ipykernel", kernel):
        print("not by Jupyter, which is not here (Debian: jupyter-nbconvert, python3-ipykernel)")
    elif not has("numpy, matplotlib", kernel):
        print("not by Jupyter, whose Python has no numpy or no matplotlib")
    else:
        os.environ.pop("MPLBACKEND")
        print("by Jupyter: all cells, %d pictures" % by_jupyter(code))


main()
