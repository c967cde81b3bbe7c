/* SPDX-License-Identifier: GPL-3.0-or-later
 * Runs commands in which one allocation fails: the first one of each place in the program that
 * allocates; with an argument also the last one, and places differ by more of their callers. A
 * command then ends with exit status 4 and "no memory", or does without that memory: it prints the
 * same as ever, except for "nan" in place of figures or a check that fails for want of memory. It
 * never crashes, prints less, or calls its input bad. */
#include "test.h"

#include <ctype.h>
#include <execinfo.h>

#include "command.h"
#include "failing_memory.h"
#include "own_folder.h"

enum { WORDS = 40, TEXT = 1 << 18, MANY = 1 << 28, CALLERS = 4, FEW_CALLERS = 3, PLACES = 1 << 14 };

static char usual[TEXT], printed[TEXT], errors[TEXT];
static int allocations; /* of the last command */
static struct place {
    void *callers[CALLERS];
    int first, last; /* allocation in its command */
} places[PLACES];
static int place_count, reports; /* reports: commands that ended with "no memory" */

static void note_place(void)
{
    void *callers[2 + CALLERS] = {NULL}; /* note_place and the wrapper are the first two */
    struct place *place = places;
    backtrace(callers, 2 + (test_word(1) ? CALLERS : FEW_CALLERS));
    while (place < places + place_count &&
           memcmp(place->callers, callers + 2, sizeof place->callers))
        place++;
    if (place == places + place_count) {
        assert_true(place_count++ < PLACES);
        memcpy(place->callers, callers + 2, sizeof place->callers);
        place->first = MANY - left;
    }
    place->last = MANY - left;
}

/* Reads a file without numbers, the letter e and blanks: times differ from one run to the next. */
static void read_words(const char *path, char *to)
{
    FILE *file = fopen(path, "r");
    size_t n = 0;
    assert_non_null(file);
    for (int c; (c = fgetc(file)) != EOF && n + 1 < TEXT;)
        if (!isdigit(c) && !strchr("+-. e", c)) to[n++] = (char)c;
    to[n] = '\0';
    fclose(file);
}

/* Runs a command of which the allocation of this number fails. Words are separated by blanks, and
 * "~" is a blank in a word. */
static int run(const char *line, int failing, char *to)
{
    char copy[500], *words[WORDS] = {"sphproof"}, *rest = copy;
    int n = 1;
    snprintf(copy, sizeof copy, "%s", line);
    for (char *word; n + 1 < WORDS && (word = strtok_r(rest, " ", &rest));) {
        for (char *c = word; *c; c++)
            if (*c == '~') *c = ' ';
        words[n++] = word;
    }
    fflush(NULL);
    const int out = dup(1), err = dup(2);
    assert_non_null(freopen("output", "w", stdout));
    assert_non_null(freopen("errors", "w", stderr));
    left = failing;
    const int status = command_main(n, words);
    allocations = failing - left;
    left = -1;
    fflush(NULL);
    dup2(out, 1), dup2(err, 2);
    close(out), close(err);
    read_words("output", to);
    read_words("errors", errors);
    return status;
}

/* Number of figures that are NaN. */
static int nans(const char *text)
{
    int count = 0;
    while ((text = strstr(text, "nan"))) text++, count++;
    return count;
}

/* Runs a command, whose usual status and output are given, without one of its allocations,
 * the k-th of `all`. */
static void fail_allocation(const char *line, int usual_status, int k, int all)
{
    const int status = run(line, k, printed);
    const bool same = status == usual_status && strcmp(printed, usual) == 0,
               reported = status == STATUS_ENVIRONMENT ? strstr(errors, "mmory") != NULL
                          : status == STATUS_OK        ? nans(printed) > nans(usual)
                                                       : strstr(printed, "mmory") != NULL;
    size_t at = 0;
    while (usual[at] && usual[at] == printed[at]) at++;
    reports += status == STATUS_ENVIRONMENT && reported;
    if (!same && !reported)
        fail_msg("%s: allocation %d of %d: status %d: %s; prints %.60s, not %.60s", line, k, all,
                 status, errors, printed + at, usual + at);
}

TEST(commands)
{
    static const char *const before[] = {
        "run sod n=40 t_end=0.02 --snapshot a.csv --json run.json --quiet",
        "run sod n=60 t_end=0.02 --snapshot b.csv --quiet",
        "ic gresho n=8^2 --format csv --out g.csv --quiet",
        "ic gresho n=10^2 --format csv --out g10.csv --quiet",
        "ic gresho n=12^2 --format csv --out g12.csv --quiet",
        "ic gresho n=14^2 --format csv --out g14.csv --quiet",
    };
    static const char *const lines[] = {
        "list keys",
        "list cases --json -",
        "kernel cubic_spline --dim 2 --at 0,0.5,1.5 --samples 1000",
        "riemann 1 0 1 0.125 0 0.1 --sample -1:1:3 --json -",
        "gradient line.csv --operator ia --kernel cubic_spline --dim 1 --eta 2 --json -",
        "ic sod n=20 --format csv --out c.csv",
        "run sod n=20 t_end=0.005 --json -",
        "run gresho n=8^2 t_end=0.01 --snapshot s.csv",
        "run noh_3d n=6^3 --explain",
        "judge a.csv b.csv --case sod",
        "judge g.csv --case gresho --time 0 --json -",
        "rates g.csv --check g.csv",
        "diff run.json run.json",
        "converge sound_wave --n 10,14,20,28 t_end=0.005 --jobs 1 --cache kept",
        "compare a.csv b.csv",
        "bench sod --n 20 --list",
        "calibrate code.ini --runs 2 --list",
        "run sod n=40 t_end=0.02 --code code.ini --quiet",
        "verify norms/error_norms --jobs 1",
        "cache kept",
        "ic gresho n=8^2 --format gadget_binary --out g.gadget",
        "ic gresho n=8^2 --format vtu --out g.vtu",
#ifdef HAVE_HDF5
        "ic gresho n=8^2 --format swift --out g.hdf5",
        "judge g.hdf5 --case gresho --time 0",
#endif
        "judge g.vtu --case gresho --time 0",
        "judge a.csv --gates case --junit j.xml --json -",
        "judge a.csv --gate density_l1=1 --gate velocity_l1=1 --case sod",
        "run rest_2d n=12^2 lattice=hexagonal t_end=0.005",
        "run sod n=20 t_end=0.01 --snapshot s.csv --checkpoint c.bin",
        "run kelvin_helmholtz_mode n=10^2 --explain",
        "stress few --list",
        "verify norms/error_norms --mutants --junit v.xml --json - --jobs 1",
        "baseline run.json --file base.json --accept --reason first",
        "kernl",
        "run sodd",
        "run sod --plto",
        "verify norms/error_norm",
        "report --list --out report",
        "judge a.csv --case sod --html j.html --plot j.svg",
        "run sod n=20 t_end=0.01 --plot p.svg",
        "run gresho n=8^2 t_end=0.01 --plot p.svg",
        "run sod n=20 t_end=0.02 --snapshot-every 0.01 --snapshot s.csv --plot p.svg",
        "compare sod~n=20~t_end=0.01 sod~n=20~t_end=0.01~alpha=2 --draws 2 --html c.html",
        "autopsy gresho t_end=0 --rates g.csv g10.csv g12.csv g14.csv",
        "bench sod --n 20 --samples 1 --time 1e-6 --quiet",
        "bench sod --scaling --n 20,40 --samples 1 --time 1e-6 --quiet",
        "calibrate code.ini --runs 2 --out done.ini",
        "converge sound_wave --n 10,14,20,28 t_end=0.005 --vary gradient --jobs 2",
        "report --code code.ini --out codes", /* takes long: only with an argument */
    };
    char here[4096];
    assert_non_null(getcwd(here, sizeof here));
    assert_int_equal(chdir(own_folder), 0);
    FILE *line = fopen("line.csv", "w");
    fputs("x,volume,f\n", line);
    for (int i = 0; i < 8; i++) fprintf(line, "%g,0.1,%d\n", 0.1 * i, i * i);
    fclose(line);
    FILE *code = fopen("code.ini", "w");
    fputs("[code]\nshell = yes\ncommand = /bin/cp @HERE@/a.csv @OUT@_1.csv\nsnapshot = @OUT@_*\n"
          "[case sod]\nn = 40 50 60 70\n[fault one]\ncommand = false\n",
          code);
    fclose(code);
    for (size_t c = 0; c < sizeof before / sizeof *before; c++)
        assert_int_equal(run(before[c], MANY, usual), 0);
    char *path = strdup(getenv("PATH"));
    setenv("PATH", here, true); /* no gnuplot, which would take most of the time */
    run("report --code code.ini --out codes", MANY, usual); /* later ones say what has changed */
    setenv("PATH", path, true);
    const size_t count = sizeof lines / sizeof *lines - !test_word(1);
    for (size_t c = 0; c < count; c++) {
        const int known = place_count;
        setenv("PATH", strstr(lines[c], "report") ? here : path, true);
        at_each_call = note_place;
        const int status = run(lines[c], MANY, usual), all = allocations;
        at_each_call = NULL;
        printf("%s: status %d, %d allocations, %d new places\n", lines[c], status, all,
               place_count - known);
        for (const struct place *place = places + known; place < places + place_count; place++) {
            fail_allocation(lines[c], status, place->first, all);
            if (test_word(1) && place->last > place->first)
                fail_allocation(lines[c], status, place->last, all);
        }
    }
    assert_true(place_count > 200 && reports > 100); /* allocations did fail */
    free(path);
    assert_int_equal(chdir(here), 0);
}
