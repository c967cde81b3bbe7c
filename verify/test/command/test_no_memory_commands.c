/* SPDX-License-Identifier: GPL-3.0-or-later
 * Runs commands in which one allocation after the other fails. Each ends with exit status 4 and "no
 * memory", or does without that memory: then it prints the same as ever, except for "nan" in place
 * of figures or a check that fails for want of memory. It never crashes, prints less, or calls its
 * input bad. Argument, optional: how many allocations of each command fail. */
#include "test.h"

#include <ctype.h>

#include "command.h"
#include "failing_memory.h"
#include "own_folder.h"

enum { WORDS = 40, TEXT = 1 << 18, MANY = 1 << 28 };

static char usual[TEXT], printed[TEXT], errors[TEXT];
static int allocations; /* of the last command */

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

/* Runs a command of which the allocation of this number fails. Words are separated by blanks, or by
 * an underscore where a blank is part of a word. */
static int run(const char *line, int failing, char *to)
{
    char copy[500], *words[WORDS] = {"sphproof"}, *rest = copy;
    int n = 1;
    snprintf(copy, sizeof copy, "%s", line);
    for (char *word; n + 1 < WORDS && (word = strtok_r(rest, " ", &rest));) words[n++] = word;
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
    while ((text = strstr(text, "\"nan\""))) text++, count++;
    return count;
}

TEST(commands)
{
    static const char *const before[] = {
        "run sod n=40 t_end=0.02 --snapshot a.csv --json run.json --quiet",
        "run sod n=60 t_end=0.02 --snapshot b.csv --quiet",
        "ic gresho n=8^2 --format csv --out g.csv --quiet",
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
        "run rest_2d n=12^2 lattice=hexagonal t_end=0.005",
        "run sod n=20 t_end=0.01 --snapshot s.csv --checkpoint c.bin",
        "run kelvin_helmholtz_mode n=10^2 --explain",
        "stress few --list",
        "verify norms/error_norms --mutants --junit v.xml --json - --jobs 1",
        "baseline run.json --file base.json --accept --reason first",
    };
    char here[4096];
    const int most = test_word(1) ? atoi(test_word(1)) : 20;
    assert_non_null(getcwd(here, sizeof here));
    assert_int_equal(chdir(own_folder), 0);
    FILE *line = fopen("line.csv", "w");
    fputs("x,volume,f\n", line);
    for (int i = 0; i < 8; i++) fprintf(line, "%g,0.1,%d\n", 0.1 * i, i * i);
    fclose(line);
    FILE *code = fopen("code.ini", "w");
    fputs("[code]\nshell = yes\ncommand = cp @HERE@/a.csv @OUT@_1.csv\nsnapshot = @OUT@_*\n"
          "[case sod]\nn = 40 50 60 70\n[fault one]\ncommand = false\n",
          code);
    fclose(code);
    for (size_t c = 0; c < sizeof before / sizeof *before; c++)
        assert_int_equal(run(before[c], MANY, usual), 0);
    for (size_t c = 0; c < sizeof lines / sizeof *lines; c++) {
        const int status = run(lines[c], MANY, usual), all = allocations;
        printf("%s: status %d, %d allocations\n", lines[c], status, all);
        for (int k = 0; k < all; k += 1 + all / most) {
            const int now = run(lines[c], k, printed);
            const bool same = now == status && strcmp(printed, usual) == 0,
                       reported = now == STATUS_ENVIRONMENT ? strstr(errors, "mmory") != NULL
                                  : now == STATUS_OK        ? nans(printed) > nans(usual)
                                                            : strstr(printed, "mmory") != NULL;
            size_t at = 0;
            while (usual[at] && usual[at] == printed[at]) at++;
            if (!same && !reported)
                fail_msg("%s: allocation %d of %d: status %d: %s; prints %.60s, not %.60s",
                         lines[c], k, all, now, errors, printed + at, usual + at);
        }
    }
    assert_int_equal(chdir(here), 0);
}
