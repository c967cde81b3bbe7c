/* SPDX-License-Identifier: GPL-3.0-or-later
 * The claim about pairing: its runs can be made, by day and by night, and the verdict follows from
 * figures, here made up ones: of Wendland functions and of the other kernels. */
#include "test.h"

#include <math.h>
#include <string.h>
/* after the four that it needs */

#include "pairing.h"
#include "value.h"

struct planned {
    struct pairing pairing;
    struct pool pool;
    json_t *kernels; /* what theory says: Wendland functions never, others from 20 neighbours */
    bool one_broken; /* the first run with a Wendland function, beside what all others find */
};

static bool is_wendland(const char *text)
{
    return strstr(text, "wendland") != NULL;
}

static void plan(struct planned *planned, bool nightly)
{
    struct error error;
    *planned = (struct planned){.kernels = json_array()};
    if (pairing_plan(&planned->pairing, nightly, &planned->pool, &error))
        fail_msg("%s", error.message);
    for (size_t k = 0; k < kernel_family.n; k++)
        for (int dim = 2; dim <= 3; dim++) {
            const char *name = kernel_family.members[k]->name;
            const bool never = is_wendland(name);
            json_array_append_new(
                planned->kernels,
                json_pack("{s:s, s:i, s:{s:o}, s:o}", "kernel", name, "dim", dim, "fourier",
                          "first_negative_kh", never ? json_null() : json_real(12),
                          "pairing_neighbours", never ? json_null() : json_real(20)));
        }
}

static void free_all(struct planned *planned)
{
    pairing_free(&planned->pairing);
    pool_free(&planned->pool);
    json_decref(planned->kernels);
}

/* Share in pairs of every run of the one kind of kernel, and of the other. */
static void invent(struct planned *planned, double wendland, double others)
{
    bool broken = !planned->one_broken;
    for (size_t i = 0; i < planned->pool.count; i++) {
        const bool of_first = is_wendland(planned->pool.jobs[i].key);
        const double paired = of_first && !broken ? 9 : of_first ? wendland : others;
        broken = broken || of_first;
        json_decref(planned->pool.jobs[i].document);
        planned->pool.jobs[i].document =
            json_pack("{s:s, s:{s:f, s:f}}", "status", paired <= 1 ? "ok" : "broke_down",
                      "regularity", "paired", paired, "nearest", 1 - paired);
    }
}

static void expect(struct planned *planned, double wendland, double others, const char *claim,
                   const char *of_wendland, const char *of_others)
{
    invent(planned, wendland, others);
    json_t *judged = pairing_judge(&planned->pairing, &planned->pool, planned->kernels);
    json_t *one, *ladder;
    size_t c, l, runs = 0;
    json_array_foreach(judged, c, one) {
        if (!strstr(value_text(one, "verdict"), claim))
            fail_msg("'%s', not '%s'", value_text(one, "verdict"), claim);
        json_array_foreach(json_object_get(one, "ladders"), l, ladder) {
            const char *wanted =
                is_wendland(value_text(ladder, "kernel")) ? of_wendland : of_others;
            if (!strstr(value_text(ladder, "verdict"), wanted))
                fail_msg("'%s', not '%s'", value_text(ladder, "verdict"), wanted);
            runs += json_array_size(json_object_get(ladder, "paired"));
        }
    }
    assert_int_equal(runs, planned->pool.count);
    assert_true(c >= 2);
    json_decref(judged);
}

/* What a run would have found that broke down is not known: the claim is not shown by the others.
 */
static void judge_one_broken(struct planned *planned)
{
    invent(planned, 0, 0.3);
    json_t *judged = pairing_judge(&planned->pairing, &planned->pool, planned->kernels);
    json_t *standard = json_array_get(judged, 0), *ladder;
    size_t l, broken = 0;
    assert_string_equal(value_text(standard, "verdict"), "not shown: runs broke down");
    json_array_foreach(json_object_get(standard, "ladders"), l, ladder)
        broken +=
            !strcmp(value_text(ladder, "verdict"), "no pairs in 4 of 5 runs, others broke down");
    assert_int_equal(broken, 1);
    json_decref(judged);
}

TEST(verdicts_follow_from_figures)
{
    struct planned planned;
    plan(&planned, false);
    expect(&planned, 0, 0.3, "holds", "no pairs up to", "pairs from");
    expect(&planned, 0.01, 0.011, "holds", "no pairs up to", "pairs from");
    expect(&planned, 0.02, 0.3, "does not hold: wendland_c2 in 2D has 2.0 % in pairs",
           "against its transform", "pairs from");
    expect(&planned, 0, 0, "not shown", "no pairs up to", "no pairs up to");
    expect(&planned, 9, 0.3, "not shown", "all runs broke down", "pairs from");
    expect(&planned, 0, 9, "not shown", "no pairs up to", "all runs broke down");
    planned.one_broken = true;
    judge_one_broken(&planned);
    free_all(&planned);
}

TEST(runs_can_be_made)
{
    struct planned planned;
    plan(&planned, true);
    assert_true(planned.pool.count >= 200);
    expect(&planned, 0, 0.3, "holds", "no pairs up to", "pairs from");
    free_all(&planned);
}
