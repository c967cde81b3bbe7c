/* SPDX-License-Identifier: GPL-3.0-or-later
 * Richardson's extrapolation and the grid convergence index. */
#include <math.h>

#include "check.h"
#include "order.h"

typedef struct order_extrapolation extrapolate_function(const double spacing[3],
                                                        const double value[3], double exact);

struct extrapolate_subject {
    extrapolate_function *extrapolate;
};

static void measure_richardson(struct check_run *run, const void *subject)
{
    static const struct extrapolate_subject right = {order_extrapolate};
    extrapolate_function *extrapolate =
        (subject ? (const struct extrapolate_subject *)subject : &right)->extrapolate;
    const double nan = (double)NAN;
    /* NASA Glenn's worked example, to its printed digits. */
    struct order_extrapolation got =
        extrapolate((double[]){4, 2, 1}, (double[]){0.96178, 0.96854, 0.97050}, nan);
    check_measure(run, fabs(got.order - 1.786170), 5e-7, 5e-7, "NASA's example, order");
    check_measure(run, fabs(got.value - 0.9713003), 5e-8, 5e-8, "NASA's example, extrapolated");
    check_measure(run, fabs(100 * got.gci_fine - 0.103083), 5e-7, 5e-7, "NASA's example, GCI12");
    check_measure(run, fabs(100 * got.gci_coarse - 0.356249), 5e-7, 5e-7, "NASA's example, GCI23");

    const double ladders[][3] = {{0.09, 0.03, 0.01}, {0.1, 0.06, 0.025}, {1. / 99, 1. / 198, 1e-3}};
    const double orders[] = {0.6, 1, 2.3}, limit = 2.385, slope = -0.7;
    for (int l = 0; l < 3; l++)
        for (int p = 0; p < 3; p++) {
            double value[3];
            for (int i = 0; i < 3; i++) value[i] = limit + slope * pow(ladders[l][i], orders[p]);
            got = extrapolate(ladders[l], value, l ? limit : nan);
            check_measure(run, fabs(got.order - orders[p]), 1e-8, 1e-9,
                          "order %g of f0 + c h^p on spacings %g %g %g", orders[p], ladders[l][0],
                          ladders[l][1], ladders[l][2]);
            check_measure(run, fabs(got.value - limit), 1e-11, 1e-12, "its limit");
            check_measure(run, fabs(got.gci_fine * value[2] / 1.25 / fabs(limit - value[2]) - 1),
                          1e-8, 1e-9, "its GCI: 1.25 times the true error");
            check_measure(run, fabs(got.gci_coarse * value[1] / 1.25 / fabs(limit - value[1]) - 1),
                          1e-8, 1e-9, "its coarse GCI: 1.25 times the true error there");
        }
    static const struct {
        const char *what;
        enum order_class class;
        double value[3], exact;
    } cases[] = {
        {"oscillating", ORDER_OSCILLATING, {1, 2, 1.5}, (double)NAN},
        {"the same twice, then another", ORDER_OSCILLATING, {1, 1, 2}, (double)NAN},
        {"diverging", ORDER_DIVERGING, {1, 2, 4}, (double)NAN},
        {"diverging, though the exact value is known", ORDER_DIVERGING, {1, 2, 4}, -1},
        {"one NaN", ORDER_DIVERGING, {1, 2, (double)NAN}, (double)NAN},
        {"one NaN, coarsest", ORDER_DIVERGING, {(double)NAN, 2, 1}, (double)NAN},
        {"infinite", ORDER_DIVERGING, {1, 2, (double)INFINITY}, 3},
        {"no change", ORDER_FLOOR_LIMITED, {2.5, 2.5, 2.5}, 2.5},
        {"changes of round-off", ORDER_FLOOR_LIMITED, {2.5, 2.5 - 1e-15, 2.5 + 1e-15}, (double)NAN},
        {"exact value inside the GCI", ORDER_ASYMPTOTIC, {1.16, 1.04, 1.01}, 1.0005},
        {"exact value inside the GCI, errors grow", ORDER_DIVERGING, {0.9, 1.6, 2}, 0},
        {"converges to a floor", ORDER_FLOOR_LIMITED, {1.16, 1.04, 1.01}, 0.5},
        {"converges to a floor from below", ORDER_FLOOR_LIMITED, {0.84, 0.96, 0.99}, 1.5},
        {"errors fall, changes grow", ORDER_PREASYMPTOTIC, {7, 5, 2}, 1},
        {"errors fall, but not where changes say", ORDER_PREASYMPTOTIC, {2, 1.45, 1.2}, 0.85},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        got = extrapolate((double[]){4, 2, 1}, cases[k].value, cases[k].exact);
        check_measure(
            run, got.class != cases[k].class || isnan(got.value) != (got.class != ORDER_ASYMPTOTIC),
            0, 0, "%s: %s", cases[k].what, order_class_name(cases[k].class));
    }
}

static struct order_extrapolation ratio_two(const double spacing[3], const double value[3],
                                            double exact)
{
    (void)spacing;
    return order_extrapolate((double[]){4, 2, 1}, value, exact);
}

static struct order_extrapolation without_safety(const double spacing[3], const double value[3],
                                                 double exact)
{
    struct order_extrapolation e = order_extrapolate(spacing, value, exact);
    e.gci_fine /= 1.25;
    e.gci_coarse /= 1.25;
    return e;
}

static struct order_extrapolation wrong_way(const double spacing[3], const double value[3],
                                            double exact)
{
    struct order_extrapolation e = order_extrapolate(spacing, value, exact);
    e.value = 2 * value[2] - e.value;
    return e;
}

static struct order_extrapolation absolute_ratio(const double spacing[3], const double value[3],
                                                 double exact)
{
    const double mirrored[] = {value[1] - fabs(value[1] - value[0]), value[1],
                               value[1] + fabs(value[2] - value[1])};
    return order_extrapolate(spacing, value[1] > value[0] ? mirrored : value, exact);
}

/* Mutant: the change of the coarse pair with the ratio of the fine pair. */
static struct order_extrapolation coarse_as_fine(const double spacing[3], const double value[3],
                                                 double exact)
{
    struct order_extrapolation e = order_extrapolate(spacing, value, exact);
    e.gci_coarse *= expm1(e.order * log(spacing[0] / spacing[1])) /
                    expm1(e.order * log(spacing[1] / spacing[2]));
    return e;
}

static struct order_extrapolation exact_unread(const double spacing[3], const double value[3],
                                               double exact)
{
    (void)exact;
    return order_extrapolate(spacing, value, (double)NAN);
}

static const struct check_mutant richardson_mutants[] = {
    {"richardson_ratio_two", "every ratio taken for 2", &(struct extrapolate_subject){ratio_two}},
    {"gci_without_safety", "GCI without the factor 1.25",
     &(struct extrapolate_subject){without_safety}},
    {"richardson_sign", "extrapolated away from the limit",
     &(struct extrapolate_subject){wrong_way}},
    {"gci_coarse_ratio", "the coarse GCI with the fine ratio",
     &(struct extrapolate_subject){coarse_as_fine}},
    {"extrapolation_exact_unread", "what converges to a floor is called asymptotic",
     &(struct extrapolate_subject){exact_unread}},
    {"richardson_absolute", "oscillating values taken for converging",
     &(struct extrapolate_subject){absolute_ratio}},
    {0},
};

CHECK_DEFINE(norms, richardson_gci, 650,
             .property = "f0 + c h^p is extrapolated to f0; GCI = 1.25 times the estimated error",
             .measure = measure_richardson, .mutants = richardson_mutants);
