/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests `sphproof compare`: what it prints of given errors and times, which runs it draws, and
 * which sides it refuses to compare. (The transcripts test whole calls, snapshots and pages.) */
#include "test.h"

#include "printed.h"

/* the command itself, because its static functions are tested; progress is reported to this file */
#define progress_update reported_update
#define progress_end    reported_end
#include "compare.c"

static double reported;
static int reported_count, reported_ends;

void reported_update(struct progress *progress, double done, double total)
{
    assert_non_null(progress);
    reported = done / total, reported_count++;
}

void reported_end(struct progress *progress)
{
    assert_non_null(progress);
    reported_ends++;
}

static const char *values[3];
static struct options options = {
    .quiet = 1, .threads = 1, .command = &command_compare, .values = values};

/* ---- verdicts and tables ---- */

/* Errors in up to two figures and CPU times of the draws of a and b. */
static const struct {
    size_t draws, figures;
    bool snapshot[2];
    double a[2][4], b[2][4], cpu[2][4];
    const char *table, *times, *verdict;
} planted[] = {
    {1,
     1,
     {false, false},
     {{1}},
     {{1.25}},
     {{2}, {1}},
     "density              1.0000e+00   1.2500e+00                          +25.0 %  [.unknown]\n",
     "CPU time           b/a = 0.5 (0.5 to 0.5)\n",
     "a single draw does not tell how much of the difference is chance: density more by 25.0 % (1 "
     "draw)"},
    {1,
     2,
     {true, true},
     {{1}, {2}},
     {{0.5}, {2}},
     {{(double)NAN}, {(double)NAN}},
     "density              1.0000e+00   5.0000e-01                          -50.0 %  [.unknown]\n"
     "velocity             2.0000e+00   2.0000e+00                             +0 %  [.not "
     "told apart]\n",
     "",
     "a single draw does not tell how much of the difference is chance: density less by 50.0 %; no "
     "difference can be told in velocity (1 draw)"},
    {2,
     1,
     {false, false},
     {{1, 2}},
     {{1, 2}},
     {{1, 1}, {2, 3}},
     "density              1.4142e+00   1.4142e+00                +0 % (+0 to +0 %)  [.not "
     "told apart]\n",
     "CPU time           b/a = 2.5 (2 to 3)\n",
     "no difference can be told in density (2 draws)"},
    {2,
     1,
     {false, true},
     {{1, 2}},
     {{1.5, 2.9}},
     {{1, 1}, {(double)NAN, (double)NAN}},
     "density              1.4142e+00   2.0857e+00             +47 % (+2 to +114 %)  [-worse]\n",
     "",
     "b is worse in density by 47 % (2 to 114 %) (2 draws)"},
    {2,
     1,
     {true, false},
     {{1, 1}},
     {{1.5, 1.6}},
     {{(double)NAN, (double)NAN}, {1, 1}},
     "density              1.0000e+00   1.5492e+00            +55 % (-24 to +215 %)  [.not "
     "told apart]\n",
     "",
     "no difference can be told in density (2 draws)"},
    {3,
     1,
     {true, true},
     {{1, 1, 1}},
     {{1.5, 1.6, 1.55}},
     {{1, 1, 1}, {2, 3, 1}},
     "density              1.0000e+00   1.5495e+00             +55 % (+43 to +68 %)  [-worse]\n",
     "CPU time           b/a = 2 (1 to 3)\n",
     "b is worse in density by 55 % (43 to 68 %) (3 draws)"},
    {4,
     2,
     {false, false},
     {{1, 2, 3, 4}, {1, 1, 1, 1}},
     {{0.5, 1.01, 1.49, 2.02}, {2, 2.01, 1.99, 2.02}},
     {{4, 1, 2, 8}, {6, 3, 4, 12}},
     "density              2.2134e+00   1.1103e+00    -49.83 % (-50.68 to -48.97 %)  [+better]\n"
     "velocity             1.0000e+00   2.0050e+00     +100.5 % (+97.8 to +103.2 %)  [-worse]\n",
     "CPU time           b/a = 1.75 (1.5 to 3)\n",
     "b is better in density by 49.83 % (48.97 to 50.68 %); b is worse in velocity by 100.5 % "
     "(97.8 to 103.2 %) (4 draws); b takes 1.8 times the CPU time (1.5 to 3)"},
    {3,
     2,
     {false, false},
     {{1, 2, 3}, {0}},
     {{1, 2.5, 2.5}, {1, 1, 1}},
     {{1, 1, 0}, {3, 2, 1}},
     "density              1.8171e+00   1.8420e+00             +1 % (-51 to +110 %)  [.not "
     "told apart]\n",
     "CPU time           too short for this clock\n",
     "no difference can be told in density (3 draws)"},
    {2,
     2,
     {false, false},
     {{1, 1}, {1, 1}},
     {{40, 45}, {1.0000105, 1.00001}},
     {{1, 1}, {1, 1.5}},
     "density              1.0000e+00   4.2426e+01       +4143 % (+848 to +18893 %)  [-worse]\n"
     "velocity             1.0000e+00   1.0000e+00 +0.00102 % (+0.00039 to +0.00166 %)  [.not "
     "told apart]\n",
     "CPU time           b/a = 1.25 (1 to 1.5)\n",
     "b is worse in density by 4143 % (848 to 18893 %); no difference can be told in velocity (2 "
     "draws)"},
    {2,
     2,
     {false, false},
     {{1, 1}, {1, 1}},
     {{0.9, 0.9}, {0.9, 0.9}},
     {{1, 1}, {0.5, 0.6}},
     "density              1.0000e+00   9.0000e-01             -10 % (-10 to -10 %)  [+better]\n"
     "velocity             1.0000e+00   9.0000e-01             -10 % (-10 to -10 %)  [+better]\n",
     "CPU time           b/a = 0.55 (0.5 to 0.6)\n",
     "b is better in density by 10 % (10 to 10 %), velocity by 10 % (10 to 10 %) (2 draws)"},
    {2,
     1,
     {false, false},
     {{1, 1}},
     {{1.1, 1.1000000001}},
     {{1, 1}, {0.5, 1}},
     "density              1.0000e+00   1.1000e+00 +10.000000 % (+10.000000 to +10.000000 %)  "
     "[-worse]\n",
     "CPU time           b/a = 0.75 (0.5 to 1)\n",
     "b is worse in density by 10.000000 % (10.000000 to 10.000000 %) (2 draws)"},
    {4,
     1,
     {false, false},
     {{1, 1, 1, 1}},
     {{1, 1, 1, 1}},
     {{1, 1, 1, 1}, {0.5, 0.75, 0.9, 0.7}},
     "density              1.0000e+00   1.0000e+00                +0 % (+0 to +0 %)  [.not "
     "told apart]\n",
     "CPU time           b/a = 0.725 (0.5 to 0.9)\n",
     "no difference can be told in density (4 draws); b takes 0.72 times the CPU time (0.5 to "
     "0.9)"},
    {4,
     1,
     {false, false},
     {{1, 1, 1, 1}},
     {{1, 1, 1, 1}},
     {{1, 1, 1, 1}, {0.9, 1.5, 1.25, 1}},
     "density              1.0000e+00   1.0000e+00                +0 % (+0 to +0 %)  [.not "
     "told apart]\n",
     "CPU time           b/a = 1.12 (0.9 to 1.5)\n",
     "no difference can be told in density (4 draws)"},
    {4,
     1,
     {false, false},
     {{1, 1, 1, 1}},
     {{1, 1, 1, 1}},
     {{1, 1, 1, 1}, {1, 2, 1.5, 1.75}},
     "density              1.0000e+00   1.0000e+00                +0 % (+0 to +0 %)  [.not "
     "told apart]\n",
     "CPU time           b/a = 1.62 (1 to 2)\n",
     "no difference can be told in density (4 draws)"},
    {4,
     1,
     {false, false},
     {{1, 1, 1, 1}},
     {{1, 1, 1, 1}},
     {{1, 1, 1, 1}, {0.5, 1, 0.75, 0.6}},
     "density              1.0000e+00   1.0000e+00                +0 % (+0 to +0 %)  [.not "
     "told apart]\n",
     "CPU time           b/a = 0.675 (0.5 to 1)\n",
     "no difference can be told in density (4 draws)"},
    {3,
     1,
     {false, false},
     {{1, 1, 1, 1}},
     {{1, 1, 1, 1}},
     {{1, 1, 1}, {2, 3, 4}},
     "density              1.0000e+00   1.0000e+00                +0 % (+0 to +0 %)  [.not "
     "told apart]\n",
     "CPU time           b/a = 3 (2 to 4)\n",
     "no difference can be told in density (3 draws)"},
    {2,
     1,
     {false, false},
     {{1, 1}},
     {{1, 1.000023}},
     {{0, 1}, {0, 1}},
     "density              1.0000e+00   1.0000e+00    +0.001 % (-0.013 to +0.016 %)  [.not "
     "told apart]\n",
     "CPU time           too short for this clock\n",
     "no difference can be told in density (2 draws)"},
};

static void is_real(const json_t *object, const char *key, double value)
{
    const json_t *found = json_object_get(object, key);
    if (isnan(value))
        assert_true(!found || json_is_null(found) || !strcmp(json_string_value(found), "nan"));
    else if (json_real_value(found) != value)
        fail_msg("%s: %.17g", key, json_real_value(found));
}

static void is_text(const json_t *object, const char *key, const char *value)
{
    assert_string_equal(json_string_value(json_object_get(object, key)), value);
}

/* The JSON document has the values of the struct. */
static void is_document(const struct comparison *c, bool pictures)
{
    json_t *document = compare_json(c, pictures);
    const json_t *cpu = json_object_get(document, "cpu"),
                 *figures = json_object_get(document, "comparisons"),
                 *sides = json_object_get(document, "sides");
    is_text(document, "command", "compare");
    is_text(document, "case", "sod");
    is_text(document, "verdict", c->verdict);
    assert_int_equal(json_integer_value(json_object_get(document, "dim")), 1);
    assert_int_equal(json_integer_value(json_object_get(document, "draws")), c->draws);
    assert_true(json_is_null(cpu) == isnan(c->cpu));
    is_real(cpu, "ratio", c->cpu);
    is_real(cpu, "low", c->cpu_low);
    is_real(cpu, "high", c->cpu_high);
    assert_int_equal(json_array_size(figures), c->sides[0].count);
    for (size_t k = 0; k < c->sides[0].count; k++) {
        const json_t *one = json_array_get(figures, k);
        is_text(one, "name", c->sides[0].figures[k]);
        is_text(one, "verdict", paired_verdicts[c->of[k].verdict]);
        is_real(one, "a", c->of[k].a);
        is_real(one, "b", c->of[k].b);
        is_real(one, "change", c->of[k].change);
        is_real(one, "half", c->of[k].half);
        assert_true(json_is_null(json_object_get(one, "half")) == isnan(c->of[k].half));
        assert_int_equal(json_integer_value(json_object_get(one, "draws")), c->of[k].n);
    }
    assert_int_equal(json_array_size(sides), 2);
    for (size_t s = 0; s < 2; s++) {
        const json_t *one = json_array_get(sides, s), *first = json_object_get(one, "first");
        is_text(one, "name", c->sides[s].name);
        is_text(one, "of", c->sides[s].text);
        is_text(one, "kind", c->sides[s].is_snapshot ? "snapshot" : "runs");
        assert_true(json_is_object(json_object_get(one, "settings")));
        assert_int_equal(json_integer_value(json_object_get(first, "n")), 7 + s);
        assert_true(!!json_object_get(first, "profile") == pictures);
    }
    json_decref(document);
}

TEST(printed_verdicts)
{
    static const char *const names[] = {"density", "velocity"};
    static const char frame[] =
        "[*a]  its words, n=100\n[*b]  others, n=110\n\n"
        "[*error                         a            b                          b/a - 1  b is]\n%s"
        "[.geometric means, of fields L1, of values |found - exact|; the intervals hold all "
        "of the changes with 95 %% (Student, pairs of draws)]\n%s\n[*";
    static struct comparison c;
    static char text[4096], markup[4096], expected[4096];
    for (size_t row = 0; row < sizeof planted / sizeof *planted; row++) {
        memset(&c, 0, sizeof c);
        c.draws = planted[row].draws;
        for (int s = 0; s < 2; s++) {
            struct side *side = &c.sides[s];
            side->name = s ? "b" : "a", side->text = s ? "others" : "its words";
            side->is_snapshot = planted[row].snapshot[s], side->count = planted[row].figures;
            side->result = json_pack("{s:i, s:i}", "n", 7 + s, "profile", 3);
            for (size_t r = 0; r < c.draws; r++) {
                side->n[r] = 100 + 10 * (size_t)s + r;
                side->cpu_s[r] = planted[row].cpu[s][r];
                for (size_t k = 0; k < planted[row].figures; k++)
                    side->error[k][r] = s ? planted[row].b[k][r] : planted[row].a[k][r];
            }
        }
        for (size_t k = 0; k < planted[row].figures; k++) c.sides[0].figures[k] = (char *)names[k];
        strcpy(c.sides[0].first.asked.file.name, "sod"); /* the case of both sides */
        c.sides[0].first.asked.file.dimension = 1;
        c.sides[1].count = 0;
        conclude(&c);
        assert_string_equal(c.verdict, planted[row].verdict);
        for (size_t k = 0; k < planted[row].figures; k++) {
            const struct paired of =
                paired_compare(c.draws, planted[row].a[k], planted[row].b[k],
                               planted[row].snapshot[0] != planted[row].snapshot[1],
                               0.05 / (double)planted[row].figures);
            assert_int_equal(of.n, c.of[k].n);
            assert_true(of.half == c.of[k].half || (isnan(of.half) && isnan(c.of[k].half)));
        }
        for (int color = 0; color < 2; color++) {
            is_document(&c, color);
            snprintf(markup, sizeof markup, frame, planted[row].table, planted[row].times);
            printed_dress(markup, color, expected);
            options.color = color;
            const struct printed printed = printed_begin();
            print_all(&c, &options);
            printed_end(&printed, text, sizeof text);
            if (strncmp(text, expected, strlen(expected)) != 0)
                fail_msg("row %zu: got:\n%s\nand not:\n%s", row, text, expected);
            /* table_wrap leaves some blanks at the ends of lines */
            for (char *at = text; (at = strchr(at, '\n'));) *at = ' ';
            char *said = text + strlen(expected);
            assert_true(strncmp(said, c.verdict, strlen(c.verdict)) == 0);
            assert_string_equal(said + strlen(c.verdict) + 1, table_style(color).end);
        }
        for (int s = 0; s < 2; s++) json_decref(c.sides[s].result);
    }
}

/* ---- draws ---- */

static void take(struct comparison *c, const char *a, const char *b)
{
    const char *const texts[] = {a, b};
    struct error error = {0};
    memset(c, 0, sizeof *c);
    for (int s = 0; s < 2; s++) {
        c->sides[s].name = s ? "b" : "a", c->sides[s].text = texts[s];
        if (take_side(&c->sides[s], 1, &error)) fail_msg("%s: %s", texts[s], error.message);
    }
}

/* The draw has the errors of a run with its number of particles, or with this seed if it is above
 * 0. */
static void is_run(const struct comparison *c, int s, size_t r, double seed)
{
    const struct side *side = &c->sides[s];
    struct run_settings asked = side->asked;
    struct run run;
    struct run_result result;
    struct error error = {0};
    char text[32];
    snprintf(text, sizeof text, "%.0f", seed > 0 ? seed : (double)side->n[r]);
    assert_int_equal(settings_set(&asked.settings, seed > 0 ? SETTING_seed : SETTING_n, text,
                                  SOURCE_USER, NULL, &error),
                     STATUS_OK);
    assert_int_equal(run_resolve(&run, &asked, &error), STATUS_OK);
    assert_int_equal(run_execute(&run, &result, &error), STATUS_OK);
    assert_int_equal(result.n, side->n[r]);
    assert_true(side->cpu_s[r] >= 0); /* the test had set NaN */
    if (r == 0) assert_int_equal(json_integer_value(json_object_get(side->result, "n")), result.n);
    size_t k = 0;
    for (int f = 0; f < FIELDS; f++)
        if (problem_knows(result.problem.problem, (enum field)f)) {
            assert_string_equal(side->figures[k], field_family.members[f]->name);
            assert_true(side->error[k++][r] == result.errors[f].l1);
        }
    for (size_t i = 0; i < result.functional_count; i++)
        if (result.problem.problem->fieldless && isfinite(result.functionals[i].exact)) {
            assert_string_equal(side->figures[k], result.functionals[i].name);
            assert_true(side->error[k++][r] ==
                        fabs(result.functionals[i].value - result.functionals[i].exact));
        }
    assert_int_equal(side->count, k);
    assert_true(k > 0);
    run_free(&result);
}

/* The numbers of particles of the draws that are kept; each error is that of a run with this
 * number. */
TEST(numbers_of_particles_of_draws)
{
#define SHORT  " t_end=0.01"
#define COARSE " eta=1.5 kernel=cubic_spline t_end=0.001"
    static const struct {
        const char *a, *b;
        size_t asked, draws, n[2][9];
        double seed[2]; /* of the first draw; 0: n is drawn */
    } rows[] = {
        {"sod n=40" SHORT, "sod n=81 eta=3" SHORT, 3, 3, {{40, 44, 36}, {81, 85, 77}}, {0}},
        {"sod n=8" SHORT, "sod n=40" SHORT, 1, 1, {{8}, {40}}, {0}},
        {"gresho n=8^2" COARSE,
         "gresho n=81 alpha=0" COARSE,
         5,
         5,
         {{64, 81, 49, 100, 36}, {81, 100, 64, 121, 49}},
         {0}},
        {"gresho lattice=hexagonal n=100" COARSE,
         "gresho lattice=hexagonal n=100 alpha=0" COARSE,
         9,
         8,
         {{90, 120, 80, 132, 56, 168, 208, 36}, {90, 120, 80, 132, 56, 168, 208, 36}},
         {0}},
        {"gresho lattice=hexagonal n=100" COARSE,
         "gresho n=100" COARSE,
         9,
         9,
         {{90, 120, 80, 132, 56, 168, 56, 208, 36}, {100, 121, 81, 144, 64, 169, 49, 196, 36}},
         {0}},
        {"sound_wave n=10 jitter=0.1" SHORT,
         "sound_wave n=10" SHORT,
         3,
         3,
         {{10, 10, 10}, {10, 14, 6}},
         {1, 0}},
        {"sound_wave n=10" SHORT,
         "sound_wave n=10 jitter=0.1 seed=4" SHORT,
         3,
         3,
         {{10, 14, 6}, {10, 10, 10}},
         {0, 4}},
        {"sound_wave_3d n=7^3" COARSE,
         "sound_wave_3d n=343 alpha=0" COARSE,
         3,
         3,
         {{343, 512, 216}, {343, 512, 216}},
         {0}},
        {"gresho jitter=0.1 n=100" COARSE,
         "gresho lattice=hexagonal n=100" COARSE,
         7,
         7,
         {{100, 100, 100, 100, 100, 100, 100}, {90, 120, 80, 132, 56, 168, 56}},
         {1, 0}},
        {"kelvin_helmholtz n=10^2" COARSE,
         "kelvin_helmholtz n=10^2 jitter=0.1" COARSE,
         2,
         2,
         {{100, 121}, {100, 100}},
         {0, 1}},
    };
    static struct comparison c;
    struct error error = {0};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        take(&c, rows[k].a, rows[k].b);
        c.asked = rows[k].asked;
        for (size_t r = 0; r < c.asked; r++)
            c.sides[0].cpu_s[r] = c.sides[1].cpu_s[r] = (double)NAN;
        reported_count = reported_ends = 0;
        if (draw_all(&c, &options, &error)) fail_msg("%s", error.message);
        assert_true(reported_count == (int)(2 * rows[k].asked) && reported_ends == 1 &&
                    reported == 1);
        assert_int_equal(c.draws, rows[k].draws);
        for (int s = 0; s < 2; s++) {
            for (size_t r = 0; r < c.draws; r++) {
                assert_int_equal(c.sides[s].n[r], rows[k].n[s][r]);
                is_run(&c, s, r, rows[k].seed[s] > 0 ? rows[k].seed[s] + (double)r : 0);
            }
            json_decref(c.sides[s].result);
        }
    }
}

/* A draw repeats an earlier one if both sides have the same number of particles as there. */
TEST(draws_that_repeat_others)
{
    static const size_t n[2][5] = {{4, 9, 4, 4, 9}, {1, 2, 2, 1, 2}};
    static struct comparison c;
    take(&c, "sod", "sod");
    memcpy(c.sides[0].n, n[0], sizeof n[0]);
    memcpy(c.sides[1].n, n[1], sizeof n[1]);
    for (size_t r = 0; r < 5; r++) assert_int_equal(seen(&c, r), r > 2);
}

/* Draws that are refused: fewer than 4 particles; refused by the solver; an unknown case. */
TEST(refused_draws)
{
    static struct comparison c;
    struct error error = {0};
    take(&c, "gresho n=2^2", "gresho n=6^2");
    assert_int_equal(one_run(&c.sides[0], 2, 3, 0, &error), STATUS_BAD_INPUT);
    assert_non_null(strstr(error.message, "n=1:"));
    assert_int_equal(one_run(&c.sides[1], 0, 1, 0, &error), STATUS_BAD_INPUT);
    assert_non_null(strstr(error.message, "beyond half the box"));
}

/* ---- comparable sides ---- */

/* The test sets whether a is a snapshot: a snapshot has its case's settings, but for gamma and
 * time. */
TEST(sides_of_different_problems)
{
    static const struct {
        const char *a, *b;
        bool snapshot;
        const char *differs; /* NULL: may be compared */
    } rows[] = {
        {"sod", "sod kernel=cubic_spline eta=3 n=77 viscosity=none cfl=0.1", false, NULL},
        {"sod", "sod jitter=0.1 seed=3", false, NULL},
        {"sod", "sod grade=0.5", false, NULL},
        {"square", "square equal_masses=yes lattice=hexagonal", false, NULL},
        {"sod", "lax", false, "a is of the case sod in 1D, b of lax in 1D"},
        {"sod", "sod_2d", false, "a is of the case sod in 1D, b of sod_2d in 2D"},
        {"sod", "sod kind=sound_wave", false, "a has kind=riemann, b has kind=sound_wave"},
        {"sod", "sod gamma=1.5", false, "a has gamma=1.4, b has gamma=1.5"},
        {"sod", "sod t_end=0.1", false, "a has t_end=0.2, b has t_end=0.1"},
        {"sod", "sod lo=-2", false, "a has lo=-1, b has lo=-2"},
        {"sod", "sod hi=2", false, "a has hi=1, b has hi=2"},
        {"sod", "sod window=-0.1,0.1", false, "b has window=-0.1 0.1"},
        {"sod", "sod boundary=reflecting", false, "b has boundary=reflecting"},
        {"gresho", "gresho window_radius=0.1", false, "b has window_radius=0.1"},
        {"gresho", "gresho boost=1", false, "a has boost=0, b has boost=1"},
        {"hydrostatic", "hydrostatic gravity='0 -2'", false, "b has gravity=0 -2"},
        {"sod", "sod left='1 0 2'", false, "a has left=1 0 1, b has left=1 0 2"},
        {"sod", "sod right='1 0 2'", false, "b has right=1 0 2"},
        {"square", "square contrast=2", false, "a has contrast=4, b has contrast=2"},
        {"sound_wave", "sound_wave waves=2", false, "a has waves=1, b has waves=2"},
        {"sod", "sod lo=-2 left='1 0 2' boundary=reflecting", true, NULL},
        {"sod", "sod gamma=1.5", true, "a has gamma=1.4, b has gamma=1.5"},
        {"sod t_end=1000000", "sod t_end=999999", true, NULL},
        {"sod t_end=1000000", "sod t_end=999998", true, "a has t_end=1e+06, b has t_end=999998"},
        {"sod t_end=1000000", "sod t_end=999999", false, "a has t_end=1e+06, b has t_end=999999"},
    };
    static struct comparison c;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        for (int turned = 0; turned <= rows[k].snapshot; turned++) {
            struct error error = {0};
            take(&c, rows[k].a, rows[k].b);
            c.sides[turned].is_snapshot = rows[k].snapshot;
            assert_int_equal(check_problem(&c, &error), rows[k].differs ? STATUS_BAD_INPUT : 0);
            if (rows[k].differs && !strstr(error.message, rows[k].differs))
                fail_msg("%s, %s: %s", rows[k].a, rows[k].b, error.message);
        }
}

TEST(dimensions)
{
    static struct comparison c;
    struct error error = {0};
    take(&c, "sod", "sod");
    assert_int_equal(take_side(&c.sides[1], 3, &error), STATUS_OK);
    assert_int_equal(c.sides[1].asked.threads, 3);
    c.sides[1].first.asked.file.dimension = 2; /* a case file with the same name */
    assert_int_equal(check_problem(&c, &error), STATUS_BAD_INPUT);
    assert_non_null(strstr(error.message, "a is of the case sod in 1D, b of sod in 2D"));
}

TEST(longest_words)
{
    char text[12] = "12|45|78|01";
    strcpy(text, "12");
    say(text, 8, "%s", "3456789");
    assert_memory_equal(text, "1234567\0|01", 12);
}
