#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every row of the table "Adding things" in src/README.md holds: in a copy of the tree a member of each kind is
added by the file and the line that the row names, and nothing else; it must then build, be listed, run,
be checked and be part of a report. A fault put into it must be noticed where the checks judge it.

  adding.py SOURCE WORK [--sound] [WORD ...]   WORD: only rows whose name contains one of them

All rows share one copy and its three builds (-O0): with all that they add, with what some add to the oracle, and
with all faults, which --sound leaves out. Exit status 1: a row does not hold, or the table has a row without a test
here."""
import json
import os
import re
import shutil
import subprocess
import sys
import time


class Failed(Exception):
    pass


class Tree:
    """A copy of the tree with its build."""

    def __init__(self, source, work):
        self.root, self.folder = os.path.join(work, "tree"), os.path.join(work, "build")
        self.work, self.verified = work, {}
        shutil.rmtree(work, ignore_errors=True)
        shutil.copytree(source, self.root, ignore=shutil.ignore_patterns("build*", ".git", "out", "__pycache__"))

    def call(self, command, *status):
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd=self.work)
        if done.returncode not in (status or (0,)):
            raise Failed("%s\nexit status %d, expected %s:\n%s"
                         % (" ".join(command), done.returncode, status or 0, done.stdout[-4000:]))
        return done.stdout

    def build(self):
        if not os.path.exists(self.folder):
            self.call(["meson", "setup", self.folder, self.root, "-Doptimization=0", "-Dclones=false", "-Dtests=false"])
        self.call(["ninja", "-C", self.folder, "sphproof"])
        self.verified = {}

    def program(self, *words, status=0):
        return self.call([os.path.join(self.folder, "sphproof")] + list(words), status)

    # ---- changes ----

    def path(self, name):
        return os.path.join(self.root, name)

    def read(self, name):
        with open(self.path(name)) as f:
            return f.read()

    def write(self, name, text):
        with open(self.path(name), "w") as f:
            f.write(text)

    def new(self, name, text):
        if os.path.exists(self.path(name)):
            raise Failed("%s is there already" % name)
        self.write(name, text.lstrip("\n"))

    def append(self, name, line):
        self.write(name, self.read(name).rstrip("\n") + "\n" + line + "\n")

    def replace(self, name, old, new):
        text = self.read(name)
        if old not in text:
            raise Failed("%s has no '%s'" % (name, old))
        self.write(name, text.replace(old, new))

    # ---- what must be seen ----

    def listed(self, family, name):
        if not re.search(r"^  %s " % re.escape(name), self.program("list", family), re.M):
            raise Failed("`sphproof list %s` does not name %s" % (family, name))

    def checks(self, name):
        """The results of a check or of a group, as a list; computed once for each build."""
        if name not in self.verified:
            path = os.path.join(self.work, "verify.json")
            self.call([os.path.join(self.folder, "sphproof"), "verify", name, "--quiet", "--json", path, "--failures",
                       os.path.join(self.work, "failures")], 0, 1)
            with open(path) as f:
                self.verified[name] = json.load(f)["checks"]
        return self.verified[name]

    def seen(self, subject, name, status):
        """The results of this check for the subject with this status."""
        return [c for c in self.checks(name) if c["status"] == status and re.search(r"\b%s\b" % re.escape(subject), c["subject"])]

    def checked(self, subject, *names):
        """Each of these checks has measured the new member, and nothing fails."""
        for name in names:
            if not self.seen(subject, name, "pass"):
                raise Failed("verify %s has measured nothing on %s" % (name, subject))
            if self.seen("", name, "fail"):
                raise Failed("verify %s fails: %s" % (name, self.seen("", name, "fail")))

    def rejected(self, subject, name, other=""):
        """This check fails for the subject. Failures that name `other`, which has a fault of its own in this build,
        do not count."""
        if all(other in c["subject"].split() for c in self.seen(subject, name, "fail")):
            raise Failed("the fault of %s passed %s" % (subject, name))

    def skipped(self, subject, name):
        """This check skips the subject, because the oracle does not have its equations."""
        if not self.seen(subject, name, "skip"):
            raise Failed("%s does not skip %s" % (name, subject))

    def reported(self, pattern):
        names = "\n".join(line.split("\t")[3] for line in self.program("report", "--list").splitlines())
        if not re.search(pattern, names, re.M):
            raise Failed("a report would compute nothing that is called '%s'" % pattern)


# A row is a generator; the tree is built at each `yield`. The row adds a member, tests that checks measure it and adds
# it to the oracle, tests that and plants a fault, and tests that the fault is noticed.
ROWS = {}


def row(name):
    def add(test):
        ROWS[name] = test
        return test
    return add


@row("kernel")
def kernel(tree):
    tree.new("src/core/kernel/wendland_c8.h", r"""
/* SPDX-License-Identifier: GPL-3.0-or-later
 * Wendland C8: w = (1-q)^10 (1 + 10 q + 42 q^2 + 90 q^3 + 429/5 q^4). */
#ifndef KERNEL_WENDLAND_C8_H
#define KERNEL_WENDLAND_C8_H

static inline double wendland_c8_w(const struct kernel *kernel, double q, int dim)
{
    (void)kernel, (void)dim;
    const double a = 1 - q > 0 ? 1 - q : 0, a2 = a * a, a4 = a2 * a2;
    return a4 * a4 * a2 * (1 + q * (10 + q * (42 + q * (90 + q * (429. / 5)))));
}

static inline double wendland_c8_dw(const struct kernel *kernel, double q, int dim)
{
    (void)kernel, (void)dim;
    const double a = 1 - q > 0 ? 1 - q : 0, a2 = a * a, a4 = a2 * a2;
    return -26 * q * (a4 * a4 * a) * (1 + q * (9 + q * (159. / 5 + q * (231. / 5))));
}

#endif
KERNEL(wendland_c8, .member = {"wendland_c8", "Wendland C8", "Wendland 1995"},
       .constant = {0, 525. / 256, 40 / (3 * M_PI), 1785 / (64 * M_PI)}, .smoothness = {0, 8, 8, 8},
       .default_eta = 4)
""")
    tree.append("src/core/kernel/kernels.def", '#include "kernel/wendland_c8.h"')
    yield
    tree.listed("kernels", "wendland_c8")
    tree.program("kernel", "wendland_c8", "--dim", "3")
    tree.program("run", "sod", "kernel=wendland_c8", "n=100", "--quiet")
    tree.checked("wendland_c8", "kernels")
    tree.reported("^kernel wendland_c8, dim 2$")
    tree.reported("^stress limits: wendland_c8, ia$")
    yield
    tree.replace("src/core/kernel/wendland_c8.h", "40 / (3 * M_PI)", "40.001 / (3 * M_PI)")
    yield
    tree.rejected("wendland_c8", "kernels/normalisation")


@row("integrator")
def integrator(tree):
    tree.new("src/core/integrator/ralston.h", r"""
/* SPDX-License-Identifier: GPL-3.0-or-later
 * Ralston's second-order method: y1 = y + 2/3 dt L(y); y = y + dt (L(y) + 3 L(y1))/4. */
#ifndef INTEGRATOR_RALSTON_H
#define INTEGRATOR_RALSTON_H

#include "integrator/runge_kutta.h"

static enum status ralston_step(struct simulation *simulation, double dt, struct error *error)
{
    runge_kutta_begin(simulation);
    const enum status status = runge_kutta_stage(simulation, 0, 1, 2. / 3 * dt, error);
    return status ? status : runge_kutta_stage(simulation, 0.375, 0.625, 0.75 * dt, error);
}

#endif
INTEGRATOR(ralston, .member = {"ralston", "Runge-Kutta, least error bound", "Ralston 1962"}, .order = 2,
           .evaluations = 2, .cfl = 0.3, .ends_evaluated = true)
""")
    tree.append("src/core/integrator/integrators.def", '#include "integrator/ralston.h"')
    yield
    tree.listed("integrators", "ralston")
    tree.program("run", "sod", "integrator=ralston", "n=100", "--quiet")
    tree.checked("ralston", "hydro/integrator_order", "hydro/conservation", "hydro/stops")
    tree.skipped("ralston", "hydro/time_stepping")
    tree.skipped("ralston", "stability/steps")
    tree.reported("^stress steps: ralston, 2$")
    yield
    tree.replace("src/core/integrator/ralston.h", "0.375, 0.625, 0.75", "0.4, 0.6, 0.75")
    yield
    tree.rejected("ralston", "hydro/integrator_order")


@row("gradient operator (clouds)")
def operator(tree):
    line = ('OPERATOR(plain_corrected, VECTOR_GRADIENT, true, true, 2, 2, "gradient of the kernel, corrected", '
            '"Randles & Libersky 1996")')
    tree.append("src/cells/operators.def", line)
    yield
    tree.listed("operators", "plain_corrected")
    tree.checked("plain_corrected", "gradients/brute_force", "gradients/exactness", "gradients/fourier",
                 "gradients/invariance")
    tree.reported("^league of operators$")
    yield
    tree.replace("src/cells/operators.def", line, line.replace("true, true", "false, true"))
    yield
    tree.rejected("plain_corrected", "gradients/exactness")


def runs_in_all_dimensions(tree, choice):
    """The runs with a new choice differ from those with the default in each dimension."""
    for case, n in (("sod", "100"), ("gresho", "24^2"), ("sedov_3d", "10^3")):
        out = []
        for words in ([], [choice]):
            path = os.path.join(tree.work, "adding.csv")
            tree.program("run", case, "n=" + n, "t_end=0.002", "--quiet", "--snapshot", path, *words)
            with open(path) as f:
                out.append(f.read())
        if out[0] == out[1]:
            raise Failed("%s does not change the run of %s" % (choice, case))


@row("gradient of the equations of motion, 1D to 3D")
def gradient(tree):
    tree.new("src/core/gradient/mixed.h", r"""
/* SPDX-License-Identifier: GPL-3.0-or-later
 * As ia with the mean of W and -W'/q in place of W. */
#ifndef GRADIENT_MIXED_H
#define GRADIENT_MIXED_H

ALWAYS_INLINE double mixed_weight(double w, double slope)
{
    return 0.5 * (w + slope);
}

#endif
GRADIENT(mixed, .member = {"mixed", "as ia with the mean of W and -W'/q", ""}, .least_dim = 1, .weight = WEIGHT_BOTH)
""")
    # gradients that exist in 1D come first
    tree.replace("src/core/gradient/gradients.def", '#include "gradient/corrected.h"',
                 '#include "gradient/mixed.h"\n#include "gradient/corrected.h"')
    yield
    tree.listed("gradients", "mixed")
    runs_in_all_dimensions(tree, "gradient=mixed")
    tree.checked("mixed", "hydro/conservation", "hydro/specialised")
    tree.skipped("mixed", "hydro/rates")
    tree.reported("^checks of hydro$")
    tree.replace("verify/oracle/oracle.c", "    case GRADIENT_IA:\n", "    case GRADIENT_IA:\n    case GRADIENT_MIXED:\n")
    weight = "    return oracle->scheme.gradient == GRADIENT_CORRECTED"
    tree.replace("verify/oracle/oracle_matrix.c", weight,
                 "    if (oracle->scheme.gradient == GRADIENT_MIXED)\n"
                 "        return (oracle_W(oracle, r, h) - h * h * oracle_dW_dr(oracle, r, h) / r) / 2;\n" + weight)
    yield
    tree.checked("mixed", "hydro/rates")
    tree.replace("src/core/gradient/mixed.h", "(w + slope)", "(w + 1.01 * slope)")
    yield
    tree.rejected("mixed", "hydro/rates", "quadratic")


@row("artificial viscosity, 1D to 3D")
def viscosity(tree):
    tree.new("src/core/viscosity/quadratic.h", r"""
/* SPDX-License-Identifier: GPL-3.0-or-later
 * Quadratic in compression (von Neumann & Richtmyer 1950): constant without its linear term. */
#ifndef VISCOSITY_QUADRATIC_H
#define VISCOSITY_QUADRATIC_H

ALWAYS_INLINE struct viscosity_terms quadratic_viscous(const struct pair_numbers *numbers, const struct pair_side *i,
                                                      const struct pair_side *j, const struct viscosity_pair *pair)
{
    struct viscosity_terms terms = constant_viscous(numbers, i, j, pair);
    terms.alpha_half = 0;
    return terms;
}

#endif
VISCOSITY(quadratic, .member = {"quadratic", "quadratic in compression", "von Neumann & Richtmyer 1950"},
          .least_dim = 1, .parameters = "beta")
""")
    tree.replace("src/core/viscosity/viscosities.def", '#include "viscosity/cullen_dehnen.h"',
                 '#include "viscosity/quadratic.h"\n#include "viscosity/cullen_dehnen.h"')
    yield
    tree.listed("viscosities", "quadratic")
    runs_in_all_dimensions(tree, "viscosity=quadratic")
    tree.checked("viscosity quadratic", "hydro/conservation", "hydro/specialised")
    tree.skipped("quadratic", "hydro/rates")
    tree.reported("^checks of hydro$")
    fading = "    if (scheme->viscosity == VISCOSITY_FADING) c = "
    tree.replace("verify/oracle/oracle.c", "    case VISCOSITY_FADING:\n",
                 "    case VISCOSITY_FADING:\n    case VISCOSITY_QUADRATIC:\n")
    tree.replace("verify/oracle/oracle_pair.c", fading,
                 "    if (scheme->viscosity == VISCOSITY_QUADRATIC) c = 0;\n" + fading)
    yield
    tree.checked("viscosity quadratic", "hydro/rates")
    tree.replace("src/core/viscosity/quadratic.h", "alpha_half = 0;", "alpha_half *= 0.01;")
    yield
    tree.rejected("viscosity quadratic", "hydro/rates", "mixed")


@row("exact solution, for a problem to use")
def exact(tree):
    tree.new("reference/entropy_wave.h", r"""
/* SPDX-License-Identifier: GPL-3.0-or-later
 * An entropy wave: density is carried along, velocity and pressure are uniform. */
#ifndef REFERENCE_ENTROPY_WAVE_H
#define REFERENCE_ENTROPY_WAVE_H

/* rho0 (1 + amplitude sin(2 pi (x - v t)/length)). */
double entropy_wave_density(double rho0, double amplitude, double length, double v, double x, double t);

#endif
""")
    tree.new("reference/entropy_wave.c", r"""
/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "entropy_wave.h"

#include <math.h>

double entropy_wave_density(double rho0, double amplitude, double length, double v, double x, double t)
{
    return rho0 * (1 + amplitude * sin(2 * M_PI * (x - v * t) / length));
}
""")
    tree.replace("reference/meson.build", "  'simple_wave.c',\n", "  'entropy_wave.c',\n  'simple_wave.c',\n")
    yield  # a problem uses it


@row("problem: particles, exact solution, functionals")
def problem(tree):
    if not os.path.exists(tree.path("reference/entropy_wave.h")):
        next(exact(tree))
    tree.new("src/run/problem/entropy_wave.c", r"""
/* SPDX-License-Identifier: GPL-3.0-or-later
 * An entropy wave in a periodic box; particles in equal cells, whose masses carry the density. */
#include "entropy_wave.h"

#include "functional.h"
#include "initial.h"
#include "problem.h"

struct wave {
    double rho0, v0, P0, amplitude, length;
};

static enum status prepare(struct prepared *p, struct settings *settings, struct error *error)
{
    const double *gas = settings->value[SETTING_background].real;
    if (problem_check_state(settings, SETTING_background, error)) return error->status;
    *(struct wave *)p->own.bytes = (struct wave){
        gas[0], gas[1], gas[2], settings_real(settings, SETTING_amplitude),
        (p->domain.hi[0] - p->domain.lo[0]) / settings_real(settings, SETTING_waves)};
    return STATUS_OK;
}

static void sample(const struct prepared *p, const double x[3], double t, struct problem_state *state)
{
    const struct wave *w = (const struct wave *)p->own.bytes;
    const double rho = entropy_wave_density(w->rho0, w->amplitude, w->length, w->v0,
                                            x[0] - p->domain.lo[0], t);
    *state = (struct problem_state){.rho = rho, .v = {w->v0}, .P = w->P0, .u = w->P0 / ((p->gamma - 1) * rho)};
}

static enum status fill(const struct prepared *p, const struct settings *settings, struct initial *initial,
                        struct error *error)
{
    const size_t n = (size_t)settings_real(settings, SETTING_n);
    const double lo = p->domain.lo[0], cell = (p->domain.hi[0] - lo) / (double)n;
    if (initial_allocate(initial, 1, n, error)) return error->status;
    for (size_t i = 0; i < n; i++) {
        struct problem_state state;
        initial->x[0][i] = lo + ((double)i + 0.5) * cell;
        sample(p, (double[3]){initial->x[0][i]}, 0, &state);
        initial->m[i] = state.rho * cell;
        initial->v[0][i] = state.v[0];
        initial->u[i] = state.u;
        initial->rho[i] = state.rho;
    }
    return STATUS_OK;
}

const struct problem problem_entropy_wave = {
    .member = {"entropy_wave", "density that is carried along", ""},
    .reference = "entropy_wave",
    .least_dim = 1,
    .most_dim = 1,
    .smooth = true,
    PROBLEM_KEYS({SETTING_background, ROLE_NEEDED}, {SETTING_amplitude, ROLE_NEEDED}, {SETTING_waves, ROLE_OPTIONAL}),
    .prepare = prepare,
    .sample = sample,
    .fill = fill,
    .functionals = {&functional_mean_internal_energy, &functional_mean_pressure},
};
""")
    tree.append("src/run/problems.def", "PROBLEM(entropy_wave)")
    yield
    if "entropy_wave" not in tree.program("list", "keys"):
        raise Failed("`sphproof list keys` does not name the problem")
    path = os.path.join(tree.work, "wave.ini")
    with open(path, "w") as f:
        f.write(WAVE)
    out = os.path.join(tree.work, "run.json")
    tree.program("run", path, "n=64", "--quiet", "--json", out)
    with open(out) as f:
        errors = json.load(f)["errors"]["density"]
    if not 0 < errors["l1"] < 0.02:
        raise Failed("the error of density is %g" % errors["l1"])
    tree.program("converge", path, "--n", "32,48,64,96", "--quiet")


WAVE = """
[case]
title = An entropy wave
dimension = 1
reference = entropy_wave

[initial]
kind = entropy_wave
background = 1 0.5 1
amplitude = 0.2

[run]
t_end = 0.1
n = 64

[measure]
window = -1 1
fields = density velocity pressure internal_energy

[converge]
n = 32 48 64 96
"""


@row("format of snapshots that are written")
def writer(tree):
    csv = tree.read("src/run/writer/csv.c")
    tree.new("src/run/writer/table.c", csv.replace("_csv", "_table").replace('{"csv"', '{"table"')
             .replace('".csv .txt .dat"', '".table"').replace("','", "';'"))
    tree.append("src/run/writers.def", "WRITER(table)")
    yield
    tree.listed("writers", "table")
    path = os.path.join(tree.work, "s.table")
    tree.program("run", "sod", "n=64", "t_end=0", "--quiet", "--snapshot", path)
    with open(path) as f:
        if f.read().count(";") < 300:
            raise Failed("not written by the new member")


@row("format of initial states for other codes")
def start(tree):
    csv = tree.read("src/run/start/csv.c")
    tree.new("src/run/start/text.c", csv.replace("start_csv", "start_text").replace('{"csv"', '{"text"'))
    tree.append("src/run/starts.def", "START(text)")
    yield
    path = os.path.join(tree.work, "s.txt")
    tree.program("ic", "sod", "n=64", "--format", "text", "--out", path)
    with open(path) as f:
        if len(f.readlines()) < 64:
            raise Failed("not written by the new member")
    if ".table" not in tree.program("run", "sod", "--snapshot", "s.tables", status=2):
        raise Failed("the message does not name the new ending")


@row("case")
def case(tree):
    sod = tree.read("cases/sod.ini")
    tree.new("cases/weak_tube.ini", sod.replace("Sod's shock tube", "A weak shock tube")
             .replace("right = 0.125 0 0.1", "right = 0.5 0 0.5"))
    tree.replace("cases/meson.build", "  'lax.ini',\n", "  'lax.ini',\n  'weak_tube.ini',\n")
    yield
    tree.listed("cases", "weak_tube")
    tree.program("run", "weak_tube", "n=100", "--quiet")
    tree.reported("^profile of weak_tube$")
    tree.reported("^weak_tube, n = 396$")
    tree.reported("^work-precision of weak_tube$")
    yield
    tree.replace("cases/weak_tube.ini", "n = 450", "n = 450\nm = 3")
    yield
    tree.program("run", "weak_tube", status=2)


CHECK = r"""
/* SPDX-License-Identifier: GPL-3.0-or-later
 * Adding a check. */
#include "check.h"

#include <math.h>

static double half(double x)
{
    return x / 2;
}

static double third(double x)
{
    return x / 3;
}

struct halving {
    double (*half)(double x);
};

static void measure(struct check_run *run, const void *subject)
{
    static const struct halving right = {half};
    const struct halving *s = subject ? subject : &right;
    check_measure(run, fabs(2 * s->half(2.385) - 2.385), 1e-15, 0, "twice the half of 2.385");
}

static const struct check_mutant mutants[] = {
    {"third_for_half", "a third in place of the half", &(struct halving){third}},
    {0},
};

CHECK_DEFINE(norms, halves, 640, .property = "2 (x/2) = x", .measure = measure, .mutants = mutants);
"""


@row("check, with the mutants it must reject")
def check(tree):
    tree.new("verify/check/halves.c", CHECK)
    tree.append("verify/check/checks.def", "CHECK(halves, norms_halves)")
    yield
    tree.listed("checks", "halves")
    tree.listed("mutants", "third_for_half")
    tree.checked("2.385", "norms/halves")
    if "caught  third_for_half" not in tree.program("verify", "norms", "--mutants"):
        raise Failed("the mutant was not tried")
    tree.reported("^checks of norms$")
    yield
    tree.replace("verify/check/halves.c", "x / 3", "x / 2")
    yield
    if "vacuous" not in tree.program("verify", "norms/halves", "--mutants", "--failures",
                                     os.path.join(tree.work, "failures"), status=1):
        raise Failed("a check that rejects nothing was not called vacuous")


@row("source mutant")
def source_mutant(tree):
    tree.append("verify/mutants/mutants.txt", """
[src_norm_twice]
fault: twice L1, less the NaN
group: norms
file: src/statistics/norm.c
- %s
+ %s"""
                % (L1, L1.replace("=", "= 0.5 *", 1)))
    script = tree.path("verify/mutants/mutants.py")
    tree.call([sys.executable, script, "check", tree.root, os.path.join(tree.work, "mutants")])
    yield
    tree.checked("", "norms")
    yield
    yield  # last, because it leaves a program with the fault behind
    sys.path.insert(0, os.path.dirname(script))
    import mutants
    added = [m for m in mutants.read_list() if m.name == "src_norm_twice"]
    worker = object.__new__(mutants.Worker)  # uses the existing copy and build
    worker.tree, worker.build = tree.root, tree.folder
    worker.program = os.path.join(tree.folder, "sphproof")
    outcome = worker.judge(added[0])
    if outcome != "caught":
        raise Failed("the mutant was not noticed: %s" % outcome)


L1 = "    norms.l1 /= weight;"


@row("command")
def command(tree):
    tree.new("verify/command/greet.c", r"""
/* SPDX-License-Identifier: GPL-3.0-or-later
 * sphproof greet. */
#include <stdio.h>

#include "command.h"

static enum status run(const struct options *options, int n, char **arguments, struct error *error)
{
    if (n != 1) return command_usage(options, error, "whom?");
    if (options->speak) printf("hello, %s\n", arguments[0]);
    return STATUS_OK;
}

const struct command command_greet = {
    .name = "greet", .synopsis = "WHOM", .help = "says hello", .run = run, .examples = "sphproof greet you"};
""")
    tree.append("verify/command/commands.def", "COMMAND(greet)")
    yield
    if "greet" not in tree.program("--help"):
        raise Failed("`sphproof --help` does not name it")
    if tree.program("greet", "you") != "hello, you\n":
        raise Failed("it says something else")
    tree.program("greet", status=2)
    tree.program("greet", "--loud", "you", status=2)


def rows_of(readme):
    """The first column of the table, from src/README.md."""
    with open(readme) as f:
        section = f.read().split("## Adding things", 1)[1].split("\n## ", 1)[0]
    return [line.split("|")[1].strip() for line in section.split("\n")
            if line.startswith("| ") and not line.startswith("| what")]


def main():
    source, work, words = sys.argv[1], os.path.abspath(sys.argv[2]), sys.argv[3:]
    sound = words[:1] == ["--sound"]
    words = words[sound:]
    rows = rows_of(os.path.join(source, "src", "README.md"))
    bad = ["src/README.md has a row '%s' without a test" % r for r in rows if r not in ROWS]
    bad += ["there is a test of '%s', but no such row in src/README.md" % r for r in ROWS if r not in rows]
    began = time.monotonic()
    tree = Tree(source, work)
    going = {name: ROWS[name](tree) for name in ROWS if not words or any(w in name for w in words)}
    tried = len(going)
    for build in range(3 if sound else 4):
        if build:
            start = time.monotonic()
            tree.build()
            print("%-62s %6.1f s" % ("build %d" % build, time.monotonic() - start), flush=True)
        for name, steps in list(going.items()):
            start = time.monotonic()
            outcome = ""
            try:
                next(steps)
            except StopIteration:
                outcome = "ok"
            except Failed as failed:
                outcome = "FAILED"
                bad.append("%s: %s" % (name, failed))
            if outcome:
                del going[name]
            print("%-62s %6.1f s  %s" % (name, time.monotonic() - start, outcome), flush=True)
    if not sound:
        bad += ["%s wants another build" % name for name in going]
    print("%d rows, %d complaints; %.0f s" % (tried, len(bad), time.monotonic() - began))
    for text in bad:
        print("\n" + text)
    return 1 if bad or not tried else 0


sys.exit(main())
