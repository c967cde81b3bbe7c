/* SPDX-License-Identifier: GPL-3.0-or-later
 * Wrong kernels. Those of the seed pages and of the seed program have their number there
 * (CONVENTIONS section 7); the others are typical mistakes. */
#include "kernel_mutants.h"

#include <math.h>

#include "kernel.h"

/* The correct kernels that the mutants change. */
#define KERNEL(name, ...)
#include "kernel/cubic_spline.h"
#include "kernel/quadratic_spline.h"
#include "kernel/quartic_spline.h"
#include "kernel/sinc.h"
#include "kernel/wendland_c2.h"
#undef KERNEL

#define CUBIC_CONSTANT                                                                             \
    {                                                                                              \
        0, 4. / 3, 40 / (7 * M_PI), 8 / M_PI                                                       \
    }
#define CUBIC_REST                                                                                 \
    .member = {"cubic_spline", "", ""}, .knot_count = 1, .knots = half, .smoothness = {0, 2, 2, 2}
#define CUBIC          .constant = CUBIC_CONSTANT, CUBIC_REST
#define CUBIC_SHAPE    .w = cubic_spline_w, .dw = cubic_spline_dw
#define WENDLAND_REST  .member = {"wendland_c2", "", ""}, .smoothness = {0, 2, 2, 2}
#define WENDLAND       .constant = {0, 5. / 4, 7 / M_PI, 21 / (2 * M_PI)}, WENDLAND_REST
#define WENDLAND_SHAPE .w = wendland_c2_w, .dw = wendland_c2_dw
#define UNUSED         (void)kernel, (void)q, (void)dim

static const double half[] = {0.5};

/* ---- gradients ---- */

static double outer_sign_dw(const struct kernel *kernel, double q, int dim)
{
    const double dw = cubic_spline_dw(kernel, q, dim);
    return q > 0.5 ? -dw : dw;
}
static const struct kernel outer_sign = {.w = cubic_spline_w, .dw = outer_sign_dw, CUBIC};

static double printed_dw(const struct kernel *kernel, double q, int dim)
{
    const double dw = wendland_c2_dw(kernel, q, dim);
    return dim == 1 ? dw / 3 : dw; /* -4 q (1-q)^2 */
}
static const struct kernel printed_wendland = {.w = wendland_c2_w, .dw = printed_dw, WENDLAND};

static double negative_dw(const struct kernel *kernel, double q, int dim)
{
    return -cubic_spline_dw(kernel, q, dim);
}
static const struct kernel gradient_sign = {.w = cubic_spline_w, .dw = negative_dw, CUBIC};

static double nearly_dw(const struct kernel *kernel, double q, int dim)
{
    const double a = 1 - q > 0 ? 1 - q : 0;
    return wendland_c2_dw(kernel, q, dim) - 1e-9 * q * a * a;
}
static const struct kernel gradient_ninth_digit = {.w = wendland_c2_w, .dw = nearly_dw, WENDLAND};

/* The total error vanishes, so that only differences over single intervals detect it. */
static double balanced_dw(const struct kernel *kernel, double q, int dim)
{
    return cubic_spline_dw(kernel, q, dim) + (q < 1 ? 1e-8 * sin(2 * M_PI * q) : 0);
}
static const struct kernel gradient_balanced = {.w = cubic_spline_w, .dw = balanced_dw, CUBIC};

/* ---- dW/dh ---- */

static double dh_with(double r, double h, int dim, double power, double d_term, double outer)
{
    const struct kernel cubic = {CUBIC_SHAPE, CUBIC};
    const double q = r / h, w = cubic_spline_w(&cubic, q, dim);
    double sum = d_term * w + q * cubic_spline_dw(&cubic, q, dim);
    if (q > 0.5 && q < 1 && outer > 0) sum = 2 * (1 - q) * (1 - q) * (1 + q);
    return -cubic.constant[dim] * pow(h, power) * sum;
}

static double dh_power(double r, double h, int dim)
{
    return dh_with(r, h, dim, -dim, dim, 0);
}
static const struct kernel seed_dh_power = {CUBIC_SHAPE, CUBIC, .plugin_dw_dh = dh_power};

static double dh_outer(double r, double h, int dim)
{
    return dh_with(r, h, dim, -dim - 1, dim, 1);
}
static const struct kernel seed_dh_outer = {CUBIC_SHAPE, CUBIC, .plugin_dw_dh = dh_outer};

static double dh_one_dimensional(double r, double h, int dim)
{
    return dh_with(r, h, dim, -dim - 1, 1, 0);
}
static const struct kernel dh_dimension = {CUBIC_SHAPE, CUBIC, .plugin_dw_dh = dh_one_dimensional};

/* ---- constants ---- */

static const struct kernel constant_359 = {
    CUBIC_SHAPE, CUBIC_REST,
    .constant = {0, 359. / 360 * 4 / 3, 359. / 360 * 40 / (7 * M_PI), 359. / 360 * 8 / M_PI}};
static const struct kernel constant_1d_only = {CUBIC_SHAPE, CUBIC_REST,
                                               .constant = {0, 4. / 3, 8 / M_PI, 40 / (7 * M_PI)}};
static const struct kernel constant_seventh_digit = {
    WENDLAND_SHAPE, WENDLAND_REST, .constant = {0, 1.25, 7 / M_PI, 21 / (2 * M_PI) + 2e-7}};
static const struct kernel constant_float = {
    CUBIC_SHAPE, CUBIC_REST,
    .constant = {0, (double)(4.f / 3), (double)(40.f / (7 * (float)M_PI)), 8 / M_PI}};
#define PI_11 3.1415926536
static const struct kernel constant_pi_11 = {CUBIC_SHAPE, CUBIC_REST,
                                             .constant = {0, 4. / 3, 40 / (7 * PI_11), 8 / PI_11}};
static const struct kernel sinc_other_order = {.member = {"sinc", "", ""},
                                               .w = sinc_w,
                                               .dw = sinc_dw,
                                               .order = 6,
                                               .smoothness = {0, 5, 5, 5},
                                               .constant = {0, 1.668713, 2.830487, 5.0}};

/* ---- shapes ---- */

static double coefficient_w(const struct kernel *kernel, double q, int dim)
{
    const double b = 0.6 - q > 0 ? 0.6 - q : 0;
    return quartic_spline_w(kernel, q, dim) - 0.01 * (b * b) * (b * b); /* 5.01 for 5 */
}
static double coefficient_dw(const struct kernel *kernel, double q, int dim)
{
    const double b = 0.6 - q > 0 ? 0.6 - q : 0;
    return quartic_spline_dw(kernel, q, dim) + 0.04 * (b * b * b);
}
static const struct kernel quartic_coefficient = {
    .member = {"quartic_spline", "", ""},
    .w = coefficient_w,
    .dw = coefficient_dw,
    .constant = {0, 3125. / 768, 46875 / (2398 * M_PI), 15625 / (512 * M_PI)},
    .knot_count = 2,
    .knots = (const double[]){0.2, 0.6},
    .smoothness = {0, 3, 3, 3},
    .unity_width = 2.5};

/* The shape of 2D and 3D with the constant of 1D. */
static double many_w(const struct kernel *kernel, double q, int dim)
{
    return wendland_c2_w(kernel, q, dim > 1 ? dim : 2);
}
static double many_dw(const struct kernel *kernel, double q, int dim)
{
    return wendland_c2_dw(kernel, q, dim > 1 ? dim : 2);
}
static const struct kernel wendland_shape = {.w = many_w, .dw = many_dw, WENDLAND};

static const double scaled_knot[] = {0.4995};
static double scaled_w(const struct kernel *kernel, double q, int dim)
{
    return cubic_spline_w(kernel, q / 0.999, dim);
}
static double scaled_dw(const struct kernel *kernel, double q, int dim)
{
    return cubic_spline_dw(kernel, q / 0.999, dim) / 0.999;
}
static const struct kernel support_0999 = {.member = {"cubic_spline", "", ""},
                                           .w = scaled_w,
                                           .dw = scaled_dw,
                                           .knot_count = 1,
                                           .knots = scaled_knot,
                                           .smoothness = {0, 2, 2, 2},
                                           .constant = {0, 4 / (3 * 0.999),
                                                        40 / (7 * M_PI * 0.999 * 0.999),
                                                        8 / (M_PI * 0.999 * 0.999 * 0.999)}};

static double unclamped_w(const struct kernel *kernel, double q, int dim)
{
    UNUSED;
    return q < 0.5 ? 1 - 6 * q * q * (1 - q) : 2 * (1 - q) * (1 - q) * (1 - q);
}
static double unclamped_dw(const struct kernel *kernel, double q, int dim)
{
    UNUSED;
    return q < 0.5 ? q * (18 * q - 12) : -6 * (1 - q) * (1 - q);
}
static const struct kernel support_unclamped = {.w = unclamped_w, .dw = unclamped_dw, CUBIC};

/* Truncated without a shift: exp(-4.5) = 1.1e-2 at the edge. */
static double gaussian_w(const struct kernel *kernel, double q, int dim)
{
    (void)kernel, (void)dim;
    return q < 1 ? exp(-4.5 * q * q) : 0;
}
static double gaussian_dw(const struct kernel *kernel, double q, int dim)
{
    return -9 * q * gaussian_w(kernel, q, dim);
}
static const struct kernel gaussian_unshifted = {.member = {"gaussian", "", ""},
                                                 .w = gaussian_w,
                                                 .dw = gaussian_dw,
                                                 .constant = {0, 1.20, 1.45, 1.74}};

static double early_w(const struct kernel *kernel, double q, int dim)
{
    UNUSED;
    const double a = 1 - q > 0 ? 1 - q : 0;
    return q < 0.49 ? 1 - 6 * q * q * (1 - q) : 2 * a * a * a;
}
static double early_dw(const struct kernel *kernel, double q, int dim)
{
    UNUSED;
    const double a = 1 - q > 0 ? 1 - q : 0;
    return q < 0.49 ? q * (18 * q - 12) : -6 * a * a;
}
static const double early_list[] = {0.49};
static const struct kernel knot_049 = {.member = {"cubic_spline", "", ""},
                                       .w = early_w,
                                       .dw = early_dw,
                                       .constant = CUBIC_CONSTANT,
                                       .knot_count = 1,
                                       .knots = early_list,
                                       .smoothness = {0, 2, 2, 2}};
static const struct kernel knot_declared_049 = {.member = {"cubic_spline", "", ""},
                                                CUBIC_SHAPE,
                                                .constant = CUBIC_CONSTANT,
                                                .knot_count = 1,
                                                .knots = early_list,
                                                .smoothness = {0, 2, 2, 2}};

/* w'' jumps by 1e-6 of its value at the knot; w and w' are continuous. */
static double kink_w(const struct kernel *kernel, double q, int dim)
{
    const double b = 0.5 - q > 0 ? 0.5 - q : 0;
    return cubic_spline_w(kernel, q, dim) + 6e-6 / 2 * b * b;
}
static double kink_dw(const struct kernel *kernel, double q, int dim)
{
    const double b = 0.5 - q > 0 ? 0.5 - q : 0;
    return cubic_spline_dw(kernel, q, dim) - 6e-6 * b;
}
static const struct kernel knot_second_derivative = {.w = kink_w, .dw = kink_dw, CUBIC};

static double step_w(const struct kernel *kernel, double q, int dim)
{
    return cubic_spline_w(kernel, q, dim) + (q < 0.5 ? 1e-11 : 0);
}
static const struct kernel knot_value = {.w = step_w, .dw = cubic_spline_dw, CUBIC};

/* q < 1/2 ... else q > 1/2: neither branch holds at the knot itself. */
static double hole_dw(const struct kernel *kernel, double q, int dim)
{
    return q == 0.5 ? 0 : cubic_spline_dw(kernel, q, dim);
}
static const struct kernel knot_hole = {.w = cubic_spline_w, .dw = hole_dw, CUBIC};

static double late_dh(double r, double h, int dim)
{
    const double q = r / h;
    return (q > 0.7 && q < 0.71 ? 1.001 : 1) * dh_with(r, h, dim, -dim - 1, dim, 0);
}
static const struct kernel dh_narrow = {CUBIC_SHAPE, CUBIC, .plugin_dw_dh = late_dh};

static double small_dh(double r, double h, int dim)
{
    return (h < 1e-3 ? 1.01 : 1) * dh_with(r, h, dim, -dim - 1, dim, 0);
}
static const struct kernel dh_small = {CUBIC_SHAPE, CUBIC, .plugin_dw_dh = small_dh};

/* A point between the nodes of any series, with a long decimal. */
static double flipped_dw(const struct kernel *kernel, double q, int dim)
{
    const double dw = cubic_spline_dw(kernel, q, dim);
    return q > 0.671234 && q < 0.671234 + 3e-4 ? -dw : dw;
}
static const struct kernel sign_narrow = {.w = cubic_spline_w, .dw = flipped_dw, CUBIC};

static double hole_w(const struct kernel *kernel, double q, int dim)
{
    return q > 0.37 && q < 0.37 + 1e-8 ? 0 : cubic_spline_w(kernel, q, dim);
}
static const struct kernel hole_narrow = {.w = hole_w, .dw = cubic_spline_dw, CUBIC};

static double bumpy_w(const struct kernel *kernel, double q, int dim)
{
    const double x = (q - 0.7234567) / 5e-4;
    return cubic_spline_w(kernel, q, dim) + 1e-9 * exp(-x * x);
}
static const struct kernel bump_narrow = {.w = bumpy_w, .dw = cubic_spline_dw, CUBIC};

/* w' jumps by 1e-7 and dw agrees with it; no knots are declared. */
static double slip_w(const struct kernel *kernel, double q, int dim)
{
    return cubic_spline_w(kernel, q, dim) + (q < 0.37 ? 1e-7 * (0.37 - q) : 0);
}
static double slip_dw(const struct kernel *kernel, double q, int dim)
{
    return cubic_spline_dw(kernel, q, dim) - (q < 0.37 ? 1e-7 : 0);
}
static const struct kernel slip = {.member = {"cubic_spline", "", ""},
                                   .w = slip_w,
                                   .dw = slip_dw,
                                   .constant = CUBIC_CONSTANT,
                                   .knot_count = -1};

/* The value depends on the call, not only on the arguments. */
static double moody_w(const struct kernel *kernel, double q, int dim)
{
    static unsigned calls;
    return cubic_spline_w(kernel, q, dim) * (calls++ % 1000 == 999 ? 1 + 1e-15 : 1);
}
static const struct kernel moody = {.w = moody_w, .dw = cubic_spline_dw, CUBIC};

static double tail_w(const struct kernel *kernel, double q, int dim)
{
    return q > 1.99 && q < 2.01 ? 1e-9 : cubic_spline_w(kernel, q, dim);
}
static const struct kernel support_tail = {.w = tail_w, .dw = cubic_spline_dw, CUBIC};

static const struct kernel class_overstated = {
    .member = {"quadratic_spline", "", ""},
    .w = quadratic_spline_w,
    .dw = quadratic_spline_dw,
    .constant = {0, 27. / 16, 81 / (13 * M_PI), 243 / (32 * M_PI)},
    .knot_count = 1,
    .knots = (const double[]){1. / 3},
    .smoothness = {0, 2, 2, 2}};

/* (1-q)^3: correctly normalised, but with a kink at the origin. */
static double peaked_w(const struct kernel *kernel, double q, int dim)
{
    UNUSED;
    return q < 1 ? (1 - q) * (1 - q) * (1 - q) : 0;
}
static double peaked_dw(const struct kernel *kernel, double q, int dim)
{
    UNUSED;
    return q < 1 ? -3 * (1 - q) * (1 - q) : 0;
}
static const struct kernel origin_kink = {.member = {"peaked", "", ""},
                                          .w = peaked_w,
                                          .dw = peaked_dw,
                                          .smoothness = {0, 2, 2, 2},
                                          .constant = {0, 2, 10 / M_PI, 15 / M_PI}};

/* (1-q)^3 (1+3q-18q^2): a negative lobe from q = 1/3 on. */
static double lobe_w(const struct kernel *kernel, double q, int dim)
{
    UNUSED;
    return q < 1 ? (1 - q) * (1 - q) * (1 - q) * (1 + 3 * q - 18 * q * q) : 0;
}
static double lobe_dw(const struct kernel *kernel, double q, int dim)
{
    UNUSED;
    return q < 1 ? (1 - q) * (1 - q) * (90 * q * q - 48 * q) : 0;
}
static const struct kernel negative_lobe = {.member = {"lobed", "", ""},
                                            .w = lobe_w,
                                            .dw = lobe_dw,
                                            .smoothness = {0, 2, 2, 2},
                                            .constant = {0, 20, 10, 10}};

static double single_w(const struct kernel *kernel, double q, int dim)
{
    return (double)(float)cubic_spline_w(kernel, q, dim);
}
static double single_dw(const struct kernel *kernel, double q, int dim)
{
    return (double)(float)cubic_spline_dw(kernel, q, dim);
}
static const struct kernel shape_float = {.w = single_w, .dw = single_dw, CUBIC};

/* The polynomial expanded about the origin: near the edge the rounding error is 1e-16 of the terms,
 * not of the value. */
static double expanded_w(const struct kernel *kernel, double q, int dim)
{
    UNUSED;
    return q < 1 ? 1 + q * q * (-10 + q * (20 + q * (-15 + q * 4))) : 0;
}
static const struct kernel shape_expanded = {.w = expanded_w, .dw = wendland_c2_dw, WENDLAND};

static const struct kernel unity_width_seed = {CUBIC_SHAPE, CUBIC, .unity_width = 2.4};

/* ---- what each property must reject ---- */

#define MUTANT(name, fault, kernel)                                                                \
    {                                                                                              \
        name, fault, &kernel                                                                       \
    }

#define OUTER_SIGN    MUTANT("seed_1_outer_branch", "cubic dW/dr, outer branch +6(1-q)^2", outer_sign)
#define PRINTED       MUTANT("seed_2_wendland_dr", "Wendland C2 1D dW/dr -4q(1-q)^2", printed_wendland)
#define DH_POWER      MUTANT("seed_8_dh_power", "cubic dW/dh with h^-d for h^-(d+1)", seed_dh_power)
#define DH_OUTER      MUTANT("seed_8_dh_outer", "cubic dW/dh with (1+q) for (1-4q)", seed_dh_outer)
#define DH_DIMENSION  MUTANT("dh_dimension", "dW/dh with w for d w", dh_dimension)
#define GRADIENT_SIGN MUTANT("kernel_gradient_sign", "dW/dr with the wrong sign", gradient_sign)
#define NINTH         MUTANT("kernel_gradient_1e-9", "dW/dr off by 1e-9", gradient_ninth_digit)
#define BALANCED      MUTANT("kernel_gradient_wave", "dW/dr off by a wave of 1e-8", gradient_balanced)
#define C_359         MUTANT("constant_359", "359 for 360 in a constant", constant_359)
#define C_1D          MUTANT("constant_1d_only", "constants of 2D and 3D exchanged", constant_1d_only)
#define C_SEVENTH                                                                                  \
    MUTANT("constant_seventh_digit", "3D constant off by 6e-8", constant_seventh_digit)
#define C_FLOAT       MUTANT("constant_float", "constants in single precision", constant_float)
#define C_PI          MUTANT("constant_pi_11", "pi to 11 digits in the constants", constant_pi_11)
#define C_SINC        MUTANT("sinc_other_order", "constants of sinc 5 with order 6", sinc_other_order)
#define COEFFICIENT   MUTANT("quartic_coefficient", "5.01 for 5 in the quartic", quartic_coefficient)
#define WENDLAND_1D   MUTANT("wendland_shape_1d", "2D shape with the 1D constant", wendland_shape)
#define SUPPORT_0999  MUTANT("support_0.999", "support 0.999 h, normalised", support_0999)
#define UNCLAMPED     MUTANT("support_unclamped", "polynomial goes on for q > 1", support_unclamped)
#define UNSHIFTED     MUTANT("gaussian_unshifted", "truncated Gaussian, W(h) > 0", gaussian_unshifted)
#define KNOT_HOLE     MUTANT("knot_hole", "dw = 0 at the knot itself", knot_hole)
#define DH_NARROW     MUTANT("dh_narrow", "dW/dh off by 1e-3 in a narrow range", dh_narrow)
#define TAIL          MUTANT("support_tail", "W = 1e-9 again around r = 2 h", support_tail)
#define KNOT_049      MUTANT("knot_0.49", "inner branch ends at q = 0.49", knot_049)
#define KNOT_DECLARED MUTANT("knot_declared_0.49", "knot 0.5 declared at 0.49", knot_declared_049)
#define KNOT_SECOND                                                                                \
    MUTANT("knot_second_derivative", "w'' jumps by 1e-6 at the knot", knot_second_derivative)
#define KNOT_VALUE  MUTANT("knot_value", "w jumps by 1e-11 at the knot", knot_value)
#define CLASS       MUTANT("class_overstated", "quadratic spline declared C2", class_overstated)
#define ORIGIN      MUTANT("origin_kink", "(1-q)^3: kink at the origin", origin_kink)
#define LOBE        MUTANT("negative_lobe", "W < 0 beyond q = 1/3", negative_lobe)
#define FLOAT       MUTANT("shape_float", "w and dw in single precision", shape_float)
#define EXPANDED    MUTANT("shape_expanded", "polynomial expanded about the origin", shape_expanded)
#define UNITY       MUTANT("unity_width_2.4", "exact lattice sums claimed at eta 2.4", unity_width_seed)
#define DH_SMALL    MUTANT("dh_small_h", "dW/dh off by 1 % for h < 1e-3", dh_small)
#define SIGN_NARROW MUTANT("sign_narrow", "dW/dr with the wrong sign on 3e-4 of q", sign_narrow)
#define HOLE_NARROW MUTANT("hole_narrow", "w = 0 on 1e-8 of q beyond 0.37", hole_narrow)
#define BUMP_NARROW MUTANT("bump_narrow", "a bump of 1e-9 in w, 1e-3 wide", bump_narrow)
#define SLIP        MUTANT("kink_undeclared", "w' jumps by 1e-7 where nobody declares a knot", slip)
#define MOODY       MUTANT("not_a_function", "w changes by 1e-15 in every 1000th call", moody)

typedef const struct check_mutant mutant_list[];
mutant_list kernel_mutants_normalisation = {C_359,  C_1D,        C_SEVENTH,   C_FLOAT, C_PI,
                                            C_SINC, COEFFICIENT, WENDLAND_1D, {0}};
mutant_list kernel_mutants_gradient_moment = {OUTER_SIGN, PRINTED, GRADIENT_SIGN, C_359, C_PI, {0}};
mutant_list kernel_mutants_width_integral = {DH_OUTER, DH_DIMENSION, UNSHIFTED, {0}};
mutant_list kernel_mutants_fundamental = {OUTER_SIGN, PRINTED,    NINTH,     BALANCED,
                                          KNOT_049,   KNOT_VALUE, UNSHIFTED, {0}};
mutant_list kernel_mutants_radial_derivative = {OUTER_SIGN, PRINTED,  GRADIENT_SIGN,
                                                NINTH,      BALANCED, {0}};
mutant_list kernel_mutants_width_derivative = {DH_NARROW,    DH_POWER, DH_OUTER, DH_SMALL,
                                               DH_DIMENSION, BALANCED, {0}};
mutant_list kernel_mutants_support = {UNSHIFTED, SUPPORT_0999, UNCLAMPED, TAIL, {0}};
mutant_list kernel_mutants_sign = {OUTER_SIGN, GRADIENT_SIGN, LOBE, {0}};
mutant_list kernel_mutants_continuity = {KNOT_HOLE,  KNOT_049, KNOT_DECLARED, KNOT_SECOND,
                                         KNOT_VALUE, CLASS,    ORIGIN,        UNSHIFTED,
                                         SLIP,       {0}};
mutant_list kernel_mutants_moments = {OUTER_SIGN, PRINTED, NINTH, UNSHIFTED, {0}};
mutant_list kernel_mutants_delta_limit = {C_359, C_FLOAT, COEFFICIENT, WENDLAND_1D, {0}};
mutant_list kernel_mutants_transform = {OUTER_SIGN, NINTH, C_SEVENTH, UNSHIFTED, {0}};
mutant_list kernel_mutants_lattice = {UNITY, COEFFICIENT, C_359, GRADIENT_SIGN, {0}};
mutant_list kernel_mutants_self_term = {DH_DIMENSION, DH_POWER, ORIGIN, {0}};
mutant_list kernel_mutants_round_off = {FLOAT, EXPANDED, {0}};
mutant_list kernel_mutants_between = {SIGN_NARROW, HOLE_NARROW, BUMP_NARROW, {0}};
mutant_list kernel_mutants_runs = {MOODY, {0}};
