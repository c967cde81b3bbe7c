/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the reader of case files: what each line of a good file sets, and the whole message about a
 * bad one with file, line, key, value and what is allowed. */
#include "test.h"

#include "cases.h"
#include "problem_list.h"

#define HEAD                                                                                       \
    "[case]\ntitle = A tube\ndimension = 1\nreference = riemann\n[initial]\nkind = riemann\n"      \
    "left = 1 0 1\nright = 0.5 0 0.25\n[run]\nt_end = 0.125\nn = 300\n"

static enum status parse(struct case_file *file, const char *text, struct error *error)
{
    *error = (struct error){0};
    return case_parse(file, "some/folder/tube.v2.ini", text, strlen(text), error);
}

TEST(every_line_of_a_case)
{
    struct case_file file;
    struct error error;
    const char *text = HEAD "; a comment\n[measure]\nfields = density, pressure\nexact = velocity\n"
                            "window = -0.25 0.5\n"
                            "[converge]\nn = 10 2e1 6^2 100\ndensity_l1 = 0.75 1.25 2e-3\n"
                            "velocity_linf =  0.5\t1 3 known:  it jumps \n"
                            "[report]\nbench = no\nquick = 50\nnight = 200 400 800\n";
    if (parse(&file, text, &error)) fail_msg("%s", error.message);
    assert_string_equal(file.name, "tube.v2");
    assert_string_equal(file.title, "A tube");
    assert_int_equal(file.dimension, 1);
    assert_int_equal(file.settings.dim, 1);
    assert_true(settings_real(&file.settings, SETTING_t_end) == 0.125);
    assert_true(settings_real(&file.settings, SETTING_n) == 300);
    assert_true(file.settings.value[SETTING_right].real[2] == 0.25);
    assert_true(file.settings.value[SETTING_window].real[0] == -0.25 &&
                file.settings.value[SETTING_window].real[1] == 0.5);
    assert_int_equal(file.settings.value[SETTING_n].source, SOURCE_CASE);
    assert_int_equal(file.settings.value[SETTING_eta].source, SOURCE_FALLBACK);
    static const bool fields[] = {true, false, true, false}, exact[] = {false, true, false, false};
    for (size_t f = 0; f < FIELDS; f++)
        assert_true(file.fields[f] == fields[f] && file.exact[f] == exact[f]);
    static const size_t ladder[] = {10, 20, 36, 100}, night[] = {200, 400, 800};
    assert_int_equal(file.ladder_count, 4);
    assert_memory_equal(file.ladder, ladder, sizeof ladder);
    assert_int_equal(file.night_count, 3);
    assert_memory_equal(file.night, night, sizeof night);
    assert_true(file.quick_count == 1 && file.quick[0] == 50);
    assert_false(file.bench);
    assert_int_equal(file.gate_count, 2);
    const struct case_gate *a = &file.gates[0], *b = &file.gates[1];
    assert_true(a->field == FIELD_DENSITY && a->norm == NORM_L1 && !a->known.why[0]);
    assert_true(a->gate.low == 0.75 && a->gate.high == 1.25 && a->gate.bound == 2e-3);
    assert_true(b->field == FIELD_VELOCITY && b->norm == NORM_LINF);
    assert_true(b->gate.low == 0.5 && b->gate.high == 1 && b->gate.bound == 3);
    assert_string_equal(b->known.why, "it jumps");
    /* defaults */
    if (parse(&file, HEAD, &error)) fail_msg("%s", error.message);
    for (size_t f = 0; f < FIELDS; f++) assert_true(file.fields[f] && !file.exact[f]);
    assert_true(file.bench && file.gate_count == 0 && file.ladder_count == 0);
    assert_true(file.quick_count == 0 && file.night_count == 0);
}

/* The file is refused with its line number and this message. */
static void refused(const char *text, const char *message)
{
    struct case_file file;
    struct error error;
    assert_int_equal(parse(&file, text, &error), STATUS_BAD_INPUT);
    if (strcmp(error.message, message) != 0)
        fail_msg("'%s'\n   is not '%s'", error.message, message);
}

static void begins(const char *text, const char *message)
{
    struct case_file file;
    struct error error;
    assert_int_equal(parse(&file, text, &error), STATUS_BAD_INPUT);
    if (strncmp(error.message, message, strlen(message)) != 0)
        fail_msg("'%s'\n   does not begin '%s'", error.message, message);
}

#define AT(line) "some/folder/tube.v2.ini:" line ": "
#define FLAT                                                                                       \
    "[case]\ntitle = A vortex\ndimension = 2\nreference = gresho\n[domain]\nlo = 0\nhi = 1\n"      \
    "[initial]\nkind = gresho\n[run]\nt_end = 1\n"
#define ERROR_GATE      "order for shorter ladders, bound of the finest error"
#define KNOWN           "; `known: WHY` after them, if it is known to fail"
#define TWO_SIDES       " or LEAST:BOUND"
#define FUNCTIONAL_GATE ERROR_GATE TWO_SIDES KNOWN
#define ORDER_GATE      "least order, greatest order, bound; or "
#define GATE            ORDER_GATE ERROR_GATE TWO_SIDES KNOWN

/* The gate of a functional: the order that raises its bound, and the bound. */
TEST(functionals)
{
    struct case_file file;
    struct error error;
    if (parse(&file,
              FLAT "[converge]\nn = 64 100 144 256\npeak_velocity = 1 0.25 known: slow\n"
                   "velocity_l1 = 0.5 3\ndisc_error = 0 2e-2\n",
              &error))
        fail_msg("%s", error.message);
    assert_int_equal(file.gate_count, 3);
    const struct case_gate *a = &file.gates[0], *b = &file.gates[1], *c = &file.gates[2];
    assert_string_equal(a->functional, "peak_velocity");
    assert_true(a->gate.low == 1 && a->gate.bound == 0.25);
    assert_string_equal(a->known.why, "slow");
    assert_true(!b->functional && b->field == FIELD_VELOCITY && b->norm == NORM_L1);
    assert_true(b->gate.low == 0.5 && isinf(b->gate.high) && b->gate.bound == 3);
    assert_string_equal(c->functional, "disc_error");
    assert_true(c->gate.low == 0 && c->gate.bound == 2e-2 && !c->known.why[0]);
    assert_true(a->least == 0 && b->least == 0 && c->least == 0);
    if (parse(&file, FLAT "[converge]\ndisc_error = 0 2:3 known: slow\n", &error))
        fail_msg("%s", error.message);
    assert_true(a->gate.low == 0 && isinf(a->gate.high) && a->gate.bound == 3 && a->least == 2);
    assert_string_equal(a->known.why, "slow");
    refused(FLAT "[converge]\ndisc_error = 1 3 3\n",
            AT("13") "disc_error = 1 3 3; allowed: " FUNCTIONAL_GATE);
    refused(FLAT "[converge]\ndisc_error = 1 3:3\n",
            AT("13") "disc_error = 1 3:3; allowed: " FUNCTIONAL_GATE);
    refused(FLAT "[converge]\ndisc_error = 1 0:3\n",
            AT("13") "disc_error = 1 0:3; allowed: " FUNCTIONAL_GATE);
    refused(FLAT "[converge]\ndisc_error = 1 2:3:4\n",
            AT("13") "disc_error = 1 2:3:4; allowed: " FUNCTIONAL_GATE);
    refused(FLAT "[converge]\ndisc_error = 1:2 3\n",
            AT("13") "disc_error = 1:2 3; allowed: " FUNCTIONAL_GATE);
    refused(FLAT "[converge]\ndisc_error = -1 1:3\n",
            AT("13") "disc_error = -1 1:3; allowed: " FUNCTIONAL_GATE);
    refused(FLAT "[converge]\ndisc_error = 1 0\n",
            AT("13") "disc_error = 1 0; allowed: " FUNCTIONAL_GATE);
    refused(FLAT "[converge]\ndisc_error = -1 1\n",
            AT("13") "disc_error = -1 1; allowed: " FUNCTIONAL_GATE);
    refused(FLAT "[converge]\ndisc_error = 1 1\n\ndisc_error = 1 1\n",
            AT("15") "key disc_error is given twice, first in line 13");
    if (parse(&file,
              HEAD "[converge]\ndensity_l1 = 0.7 1.3 0.015:0.02\nvelocity_l1 = 0 1e-3:1\n"
                   "momentum = 0 1e-9\ncentre = 0 2\n",
              &error))
        fail_msg("%s", error.message);
    assert_true(a->gate.low == 0.7 && a->gate.high == 1.3 && a->gate.bound == 0.02);
    assert_true(a->least == 0.015 && b->least == 1e-3 && b->gate.bound == 1 && c->least == 0);
    assert_string_equal(c->functional, "momentum");
    assert_true(c->gate.bound == 1e-9 && file.gate_count == 4);
    refused(HEAD "[converge]\ndensity_l1 = 0.7 1.3 0.02:0.02\n",
            AT("13") "density_l1 = 0.7 1.3 0.02:0.02; allowed: " GATE);
    refused(HEAD "[converge]\ndensity_l1 = 0.7 1.3 0.02\n[compared]\ndensity_l1 = 1:2\n",
            AT("15") "density_l1 = 1:2; allowed: bound of the finest error, or none where there is "
                     "nothing to be measured" KNOWN);
    refused(FLAT "[converge]\n\nplateau = 1 1\n",
            AT("14") "key plateau and kind = gresho exclude each other");
    refused(HEAD "[converge]\nmean_pressure = 1 1\n",
            AT("13") "key mean_pressure in [converge] and dimension = 1 exclude each other");
    refused(HEAD "[converge]\nangular_momentum = 0 2\n",
            AT("13") "key angular_momentum in [converge] and dimension = 1 exclude each other");
    refused(HEAD "[converge]\nke_rebound = 0 2\n",
            AT("13") "key ke_rebound and kind = riemann exclude each other");
    if (parse(&file, FLAT "[converge]\nke_asymmetry = 0 1\nangular_momentum = 0 1\n", &error))
        fail_msg("%s", error.message);
}

/* Gates of compared schemes: a bound, and why they are known to fail. */
TEST(compared)
{
    struct case_file file;
    struct error error;
#define COMPARED                                                                                   \
    "bound of the finest error, or none where there is nothing to be measured; `known: WHY` "      \
    "after "                                                                                       \
    "them, if it is known to fail"
#define GATES "[converge]\nvelocity_l1 = 0.5 3 0.125\ndisc_error = 0 2e-2\n"
    if (parse(&file, FLAT GATES "[compared]\ndisc_error = 0.25\nvelocity_l1 = 0.5 known: noise\n",
              &error))
        fail_msg("%s", error.message);
    const struct case_gate *a = &file.gates[0], *b = &file.gates[1];
    assert_true(a->gate.bound == 0.125 && a->compared.bound == 0.5 && isinf(a->known.bound));
    assert_string_equal(a->compared.why, "noise");
    assert_true(b->gate.bound == 2e-2 && b->compared.bound == 0.25 && !*b->compared.why);
    assert_true(!*a->known.why && !*b->known.why);
    refused(FLAT GATES "[compared]\npressure_l1 = 1\n",
            AT("16") "key pressure_l1 in [compared] has no gate above, in [converge]");
    refused(FLAT GATES "[compared]\ndisc_error = 0 known: x\n",
            AT("16") "disc_error = 0 known: x; allowed: " COMPARED);
    refused(FLAT GATES "[compared]\ndisc_error = none\n",
            AT("16") "disc_error = none; allowed: " COMPARED);
    refused(FLAT GATES "[compared]\ndisc_error = none known:\n",
            AT("16") "disc_error = none known:; allowed: " COMPARED);
    refused(FLAT GATES "[compared]\ndisc_error = some known: x\n",
            AT("16") "disc_error = some known: x; allowed: " COMPARED);
    if (parse(&file, FLAT GATES "[compared]\ndisc_error = none known: it is torn\n", &error))
        fail_msg("%s", error.message);
    assert_true(isnan(b->compared.bound));
    assert_string_equal(b->compared.why, "it is torn");
    refused(FLAT GATES "[compared]\ndisc_error = 1\ndisc_error = 1\n",
            AT("17") "key disc_error is given twice, first in line 16");
    begins(FLAT GATES "[compared]\nn = 1\n", AT("16") "key n stands in the section [run]");
#undef GATES
#undef COMPARED
}

/* A separate bound for runs finer than the case's ladder. */
TEST(bounds_beyond_the_ladder)
{
    struct case_file file;
    struct error error;
#define BOUNDED FLAT "[converge]\nvelocity_l1 = 0.5 3 0.125\ndisc_error = 0 2e-2\n"
    if (parse(&file, BOUNDED "[finer]\ndisc_error = 0.25\n", &error)) fail_msg("%s", error.message);
    assert_true(file.gates[1].finer.bound == 0.25 && file.gates[0].finer.bound == 0);
    if (parse(&file, BOUNDED "[finer]\nvelocity_l1 = 0.25 2 0.5\n", &error))
        fail_msg("%s", error.message);
    const struct order_gate *gate = &file.gates[0].finer;
    assert_true(gate->low == 0.25 && gate->high == 2 && gate->bound == 0.5);
    static const char *const ordered[] = {"0.5",   "0.5 1",       "2 1 0.5",
                                          "1 2 0", "1 2 0.1:0.5", "1 2 0.5 known: x"};
    for (size_t k = 0; k < sizeof ordered / sizeof *ordered; k++) {
        char text[400], said[200];
        snprintf(text, sizeof text, "%s[finer]\nvelocity_l1 = %s\n", BOUNDED, ordered[k]);
        snprintf(said, sizeof said,
                 AT("16") "velocity_l1 = %s; allowed: least order, greatest "
                          "order, bound beyond the case's ladder",
                 ordered[k]);
        refused(text, said);
    }
    refused(BOUNDED "[finer]\npressure_l1 = 1\n",
            AT("16") "key pressure_l1 in [finer] has no gate above, in [converge]");
    refused(BOUNDED "[finer]\ndisc_error = 0\n",
            AT("16") "disc_error = 0; allowed: bound of the error beyond the case's ladder");
    refused(BOUNDED "[finer]\ndisc_error = 1 known: x\n",
            AT("16") "disc_error = 1 known: x; allowed: bound of the error beyond the case's "
                     "ladder");
    refused(BOUNDED "[finer]\ndisc_error = 1\ndisc_error = 1\n",
            AT("17") "key disc_error is given twice, first in line 16");
#undef BOUNDED
}

TEST(bad_lines)
{
    refused("", "some/folder/tube.v2.ini: the case file is empty");
    refused(HEAD "[measure]\nfields =\n", AT("13") "fields = ; allowed: names of fields");
    refused(HEAD "[measure]\nfields = , ,\n", AT("13") "fields = , ,; allowed: names of fields");
    begins(HEAD "[measure]\nfields = density mass\n", AT("13") "no field 'mass'");
    begins(HEAD "[measure]\nexact = densty\n",
           AT("13") "no field 'densty'; did you mean 'density'? allowed: density velocity");
    refused(HEAD "[converge]\nn = 10 20 30\n",
            AT("13") "n = 10 20 30; allowed: rising numbers of particles, at least four");
    refused(HEAD "[converge]\nn = 10 20 20 40\n",
            AT("13") "n = 10 20 20 40; allowed: rising numbers of particles, at least four");
    refused(HEAD "[converge]\nn = 3 20 30 40\n",
            AT("13") "n = 3 20 30 40; allowed: rising numbers of particles, at least four");
    refused(HEAD "[report]\nquick =\n", AT("13") "quick = ; allowed: rising numbers of particles");
    refused(HEAD "[report]\nnight = 10 2x\n",
            AT("13") "night = 10 2x; allowed: rising numbers of particles");
    refused(HEAD "[report]\nbench = maybe\n", AT("13") "bench = maybe; allowed: yes no");
    refused(HEAD "[converge]\ndensity_l1 = 1 1 1\n", AT("13") "density_l1 = 1 1 1; allowed: " GATE);
    refused(HEAD "[converge]\ndensity_l1 = 1 2 0\n", AT("13") "density_l1 = 1 2 0; allowed: " GATE);
    refused(HEAD "[converge]\ndensity_l1 = 1\n", AT("13") "density_l1 = 1; allowed: " GATE);
    refused(HEAD "[converge]\ndensity_l1 = -1 2\n", AT("13") "density_l1 = -1 2; allowed: " GATE);
    refused(HEAD "[converge]\ndensity_l1 = 1 2 3 known:\n",
            AT("13") "density_l1 = 1 2 3 known:; allowed: " GATE);
    refused(HEAD "[converge]\ndensity_l1 = 1 2 3\nvelocity_l1 = 1 2 3\n\ndensity_l1 = 1 2 3\n",
            AT("16") "key density_l1 is given twice, first in line 13");
    refused(HEAD "n = 400\n", AT("12") "key n is given twice, first in line 11");
    refused("[case]\ntitle = a\ntitle = b\n", AT("3") "key title is given twice, first in line 2");
    refused("[case]\ntitle =\n", AT("2") "title = ; allowed: a text");
    refused("[case]\ndimension = 4\n", AT("2") "dimension = 4; allowed: 1 2 3");
    refused("[case]\ndimension = 0\n", AT("2") "dimension = 0; allowed: 1 2 3");
    refused("[case]\ndimension = 12\n", AT("2") "dimension = 12; allowed: 1 2 3");
    begins("[case]\nreference = rieman\n",
           AT("2") "no reference 'rieman'; did you mean 'riemann'? allowed: ");
    refused("title = a\n", AT("1") "a key before the first section; allowed: [case] and the other "
                                   "sections");
    begins("[cases]\ntitle = a\n",
           AT("2") "no section 'cases'; did you mean 'case'? allowed: case "
                   "domain initial scheme run measure converge compared finer report");
    refused("[run]\neta = 2\n", AT("2") "key eta stands in the section [scheme], not in [run]");
    refused("[case]\nkernel = 2\n",
            AT("2") "key kernel stands in the section [scheme], not in [case]");
    refused("[case]\nskip = 2\n", AT("2") "key skip stands in the section [run], not in [case]");
    begins("[run]\nt_ned = 2\n", AT("2") "no key in [run] 't_ned'; did you mean 't_end'? allowed: "
                                         "gamma n t_end skip");
    begins("[case]\nfields = 2\n", AT("2") "no key in [case] 'fields'; allowed: title dimension "
                                           "reference");
    begins("[converge]\nm = 2\n", AT("2") "no key in [converge] 'm'");
    begins("[converge]\ndensity_l3 = 2\n",
           AT("2") "no key in [converge] 'density_l3'; did you mean 'density_l1'? allowed: n "
                   "density_l1");
    begins("[run]\nn = 2\n", AT("2") "n=2: allowed: an integer, or 64^2, from 4 to 10000000");
    refused("[case]\nwhat is this\n",
            AT("2") "not a line of a case file; allowed: [section], key = value, ; comment");
    refused("[case]\ntitle = \x01\n", AT("2") "byte 0x01 is not text; allowed: printable UTF-8");
    refused("[case]\ntitle = \xe9\n", AT("2") "byte 0xe9 is not text; allowed: printable UTF-8");
    refused("[case]\ntitle = \xc3", AT("2") "byte 0xc3 is not text; allowed: printable UTF-8");
    refused("[case]\n\r \n", AT("2") "byte 0x0d is not text; allowed: printable UTF-8");
}

TEST(whole_files)
{
    char text[600], line[200];
    struct case_file file;
    struct error error;
    refused("[case]\ntitle = a\ndimension = 1\n",
            "some/folder/tube.v2.ini: key reference is missing in [case]");
    refused("[case]\ntitle = a\nreference = riemann\n",
            "some/folder/tube.v2.ini: key dimension is missing in [case]");
    refused("[case]\ntitle = a\ndimension = 1\nreference = riemann\n[run]\nt_end = 1\n",
            "some/folder/tube.v2.ini: key kind is missing in [initial]");
    refused("[case]\ntitle = a\ndimension = 1\nreference = riemann\n[initial]\nkind = riemann\n"
            "left = 1 0 1\nright = 1 0 2\n",
            "some/folder/tube.v2.ini: key t_end is missing in [run]");
    refused("[case]\ntitle = a\ndimension = 1\nreference = riemann\n[initial]\nkind = riemann\n"
            "left = 1 0 1\n[run]\nt_end = 1\n",
            "some/folder/tube.v2.ini: key right is missing in [initial]");
    refused(HEAD "[initial]\nwaves = 2\n",
            AT("13") "key waves and kind = riemann exclude each other");
    refused(HEAD "[scheme]\nviscosity = none\nalpha = 2\n",
            AT("14") "alpha=2 and viscosity=none exclude each other: alpha needs viscosity "
                     "constant reconstructed fading projected");
    refused(HEAD "[scheme]\nsinc_n = 7\n", AT("13") "sinc_n=7 and kernel=quadratic_spline exclude "
                                                    "each other: sinc_n needs kernel sinc");
    refused(HEAD "[initial]\nseed = 2\n", AT("13") "seed=2 and lattice=uniform exclude each other: "
                                                   "seed needs lattice jittered random "
                                                   "glass, or jitter above 0");
    refused("[case]\ntitle = a\ndimension = 2\nreference = kelvin_helmholtz\n[domain]\nlo = 0\n"
            "hi = 1 2\n[initial]\nkind = kelvin_helmholtz\n[run]\nt_end = 1\n",
            AT("6") "lo, hi: the layers lie in a square box, and this one has sides of 1 and 2");
    refused("[case]\ntitle = a\ndimension = 1\nreference = simple_wave\n[initial]\nkind = riemann\n"
            "left = 1 0 1\nright = 1 0 2\n[run]\nt_end = 1\n",
            AT("4") "reference = simple_wave; allowed: riemann");
    /* a line may have 180 bytes, also with other line ends, and not one more */
    memset(line, 'x', sizeof line);
    line[180 - strlen("title = ")] = '\0';
    const char *rest = strstr(HEAD, "dimension");
    snprintf(text, sizeof text, "[case]\r\n \ttitle = %s\n%s", line, rest);
    refused(text, AT("2") "a line of more than 180 bytes");
    line[178 - strlen("title = ")] = '\0';
    snprintf(text, sizeof text, "[case]\r\n \ttitle = %s\n%s", line, rest);
    assert_int_equal(parse(&file, text, &error), STATUS_OK);
    assert_string_equal(file.title, line);
    strcpy(line + strlen(line) - 1, "\xc3\xa9x"); /* an e with an accent: two bytes */
    snprintf(text, sizeof text, "\xef\xbb\xbf[case]\ntitle = %s\n%s", line, rest);
    assert_int_equal(parse(&file, text, &error), STATUS_OK);
    assert_string_equal(file.title, line);
    memmove(line + 1, line, strlen(line) + 1);
    snprintf(text, sizeof text, "[case]\ntitle = x%s\n%s", line, rest);
    refused(text, AT("2") "a line of more than 180 bytes");
}

TEST(built_in_cases_are_sound)
{
    struct case_file file;
    struct error error;
    size_t n = 0;
    for (const struct case_builtin *b = case_builtins; b->name; b++, n++) {
        assert_int_equal(case_load(&file, b->name, &error), STATUS_OK);
        assert_string_equal(file.name, b->name);
        if (!problem_of(&file.settings)->liquid) /* a report studies every other case */
            assert_true(file.ladder_count >= 4 && file.gate_count >= 1);
    }
    assert_true(n >= 6);
}

/* Damaged case files never crash: the status is OK or there is a message. */
TEST(damaged_cases_are_survived)
{
    static const char noise[] = "\n[]=;:# \t\r0aZ.,-\"";
    unsigned random = 2385;
    size_t builtins = 1;
    while (case_builtins[builtins].name) builtins++;
    for (int round = 0; round < 4000; round++) {
        const struct case_builtin *builtin = &case_builtins[(size_t)round % builtins];
        const size_t length = strlen(builtin->text);
        char *text = strdup(builtin->text);
        assert_non_null(text);
        for (int k = 0; k < 1 + round % 5; k++) {
            random = random * 1664525u + 1013904223u;
            const size_t at = (random >> 8) % length;
            text[at] =
                random >> 30 ? noise[(random >> 4) % (sizeof noise - 1)] : (char)(random >> 5);
        }
        struct case_file file;
        struct error error = {0};
        const enum status status =
            case_parse(&file, "damaged.ini", text, length - (size_t)(round % 7 ? 0 : 40), &error);
        assert_true(status == STATUS_OK || status == STATUS_BAD_INPUT);
        if (status) assert_ptr_equal(strstr(error.message, "damaged.ini"), error.message);
        free(text);
    }
}
