/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares what `sphproof converge` prints of studies with random figures and verdicts, and their
 * JSON documents with seven digits, with data/drawn/converge.txt, byte for byte. verify/test/keep
 * renews that file. */
#include "test.h"

#include "drawn_document.h"
#include "printed.h"
#include "sample_study.h"
/* the command itself, because its static functions are tested */
#include "../../command/converge.c"

enum { STUDIES = 60, TEXT = 1 << 16 };

/* As after the start of a flow without an exact solution. */
static void forget_errors(struct study_result *result)
{
    for (size_t l = 0; l < result->level_count; l++)
        for (int f = 0; f < FIELDS; f++) result->levels[l].errors[f][NORM_L1] = (double)NAN;
}

/* One in five is not a number. */
static double figure(struct drawing *draw)
{
    return drawn_below(draw, 5) ? drawn_real(draw) : (double)NAN;
}

static void draw_gate(struct drawing *draw, struct study_order *order)
{
    order->status = (enum finding_status)drawn_below(draw, FINDING_SKIP + 1);
    order->gate = (struct order_gate){figure(draw), drawn_real(draw), drawn_real(draw)};
    order->least = drawn_below(draw, 2) ? drawn_real(draw) : 0;
    order->known = "a reason";
    snprintf(order->why, sizeof order->why, "%s", drawn_below(draw, 2) ? "it is so" : "");
}

static void draw_result(struct drawing *draw, struct study_result *result)
{
    static const double floors[] = {0, 9e-11, 1.1e-10, -9e-11, -1.1e-10, 0.01};
    for (int f = 0; f < FIELDS; f++) {
        const size_t only = drawn_below(draw, 3 * LEVELS); /* the one level with an error */
        for (size_t l = 0; l < result->level_count && only < LEVELS + 1; l++)
            if (l != only) result->levels[l].errors[f][NORM_L1] = (double)NAN;
        for (int m = 0; m < NORMS; m++) draw_gate(draw, &result->orders[f][m]);
    }
    for (size_t i = 0; i < result->functional_count; i++) {
        result->functionals[i].value = figure(draw), result->functionals[i].order = figure(draw);
        draw_gate(draw, &result->functional_errors[i]);
    }
    for (size_t k = 0; k < TRACE_FIGURES; k++) draw_gate(draw, &result->kept[k]);
    for (int k = 0; k < 2; k++) result->regions[k].n = drawn_below(draw, 2);
    result->floor_density = floors[drawn_below(draw, 6)];
    result->floor_gradient = floors[drawn_below(draw, 6)];
    result->floor_explains = drawn_below(draw, 2);
    result->scheme.kernel.unity_width = (double)drawn_below(draw, 3);
    result->still = figure(draw);
    result->still_status = (enum finding_status)drawn_below(draw, FINDING_FAIL + 1);
    for (int f = 0; f < FIELDS; f++)
        result->interpolation[f] = drawn_below(draw, 2) ? 0.01 * f : (double)NAN;
    strcpy(result->suspicion, drawn_below(draw, 3) ? "" : "too good");
    strcpy(result->message, drawn_below(draw, 2) ? "it is so" : "it is not");
    result->excluded = !drawn_below(draw, 6);
    if (!drawn_below(draw, 6)) {
        result->status = STATUS_BROKE_DOWN;
        result->level_count = drawn_below(draw, 3);
    }
    const size_t n = result->functional_count;
    if (drawn_below(draw, 2)) result->functional_exact[0] = (double)NAN;
    if (n < PROBLEM_FUNCTIONALS_MAX) { /* after the last: is not read */
        result->functional_names[n] = "none", result->functional_exact[n] = 1;
        result->functional_errors[n].fit.n = 4;
    }
}

TEST(printed_studies)
{
    static const char *const cases[] = {"sod", "gresho", "sound_wave", "noh_2d",
                                        "kelvin_helmholtz_mode"};
    static char text[TEXT];
    struct digests kept;
    digests_open(&kept, test_word(1), "converge.txt");
    for (size_t k = 0; k < STUDIES; k++) {
        struct drawing draw = {k, NULL};
        struct code_external external = {0};
        const struct options options = {.color = k % 3 == 0};
        char name[32];
        struct study study = made(
            cases[k / 5 % 5], k % 5 ? NULL : "kernel=cubic_spline,wendland_c2", 1 + k % 2, NULL);
        for (size_t c = 0; c < study.sweep.count; c++) {
            draw_result(&draw, &study.results[c]);
            if (problem_of(&study.settings.settings)->fieldless) forget_errors(&study.results[c]);
        }
        if (!drawn_below(&draw, 4)) study.settings.external = &external.base;
        strcpy(study.suspicion, drawn_below(&draw, 4) ? "" : "without effect");
        const struct printed printed = printed_begin();
        print_all(&study, &options);
        printed_end(&printed, text, sizeof text);
        snprintf(name, sizeof name, "study-%zu", k);
        digests_compare(&kept, name, text);
        json_t *document = json_object();
        study_add_json(&study, document);
        char *json = json_dumps(document, JSON_INDENT(1) | JSON_REAL_PRECISION(7));
        snprintf(name, sizeof name, "document-%zu", k);
        digests_compare(&kept, name, json);
        free(json);
        json_decref(document);
        study_free(&study);
    }
    digests_close(&kept);
}
