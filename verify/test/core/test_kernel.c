/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests kernels by name, their descriptors, the sinc family and plug-ins. (The checks `kernels`
 * test their shapes.) */
#include "test.h"

#include <float.h>

#include "kernel.h"

/* Constants of the sinc family to 20 digits: C_d = 1/(S_d int_0^1 q^(d-1) w dq), computed with
 * 30-digit quadrature. */
TEST(sinc_constants)
{
    static const struct {
        int n;
        double constant[3];
    } table[] = {
        {3, {1.3204067615855146693, 1.8029329635616995998, 2.543024706287487317}},
        {4, {1.5044300259623629285, 2.3212487016668555283, 3.671340133501082779}},
        {5, {1.6687074276752006088, 2.8415178549547171299, 4.9361012337810751454}},
        {6, {1.8184096022997400329, 3.3628399669940504812, 6.3235967154584231789}},
        {7, {1.9568044270299950325, 3.8847886978208098677, 7.8235947824926762916}},
        {8, {2.0861046973310268071, 4.4071386471917403853, 9.4280859270685373975}},
        {9, {2.2078880220587636682, 4.9297602451322068161, 11.130577191374307679}},
        {10, {2.3233247811635474574, 5.4525739966229006091, 12.925664474484781264}},
        {11, {2.433311055118789453, 5.9755285325568498336, 14.80875688094801237}},
        {12, {2.5385506833486641004, 6.49858922914027316, 16.775890095780287262}},
    };
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        struct kernel kernel;
        assert_int_equal(kernel_select(&kernel, "sinc", table[i].n, NULL), STATUS_OK);
        assert_int_equal(kernel.order, table[i].n);
        assert_int_equal(kernel.smoothness[0], 0);
        for (int g = 0; g < GRADIENTS; g++) /* limits are known for n = 5 in 1D only */
            assert_int_equal(kernel.stable_eta[g] != 0, table[i].n == 5 && g <= GRADIENT_IA);
        for (int dim = 1; dim <= 3; dim++) {
            assert_int_equal(kernel.smoothness[dim], table[i].n - 1);
            near_relative(pow(kernel_least_eta(&kernel, dim), dim), table[i].constant[dim - 1],
                          2e-14);
            const double want = table[i].constant[dim - 1];
            assert_true(fabs(kernel.constant[dim] - want) <= 1e-14 * want);
        }
    }
}

/* s^n and its derivative at small and large q against the series and the expansion at the edge. */
TEST(sinc_limits)
{
    struct kernel kernel;
    assert_int_equal(kernel_select(&kernel, "sinc", 5, NULL), STATUS_OK);
    assert_true(kernel.w(&kernel, 0, 1) == 1 && kernel.dw(&kernel, 0, 1) == 0);
    for (double q = 1e-300; q < 1e-2; q *= 10) {
        const double x = (M_PI * q) * (M_PI * q), n = 5;
        const double s = 1 - x / 6 * (1 - x / 20 * (1 - x / 42));
        const double ds = -M_PI * M_PI * q / 3 * (1 - x / 10 * (1 - x / 28 * (1 - x / 54)));
        assert_true(fabs(kernel.w(&kernel, q, 3) - pow(s, n)) <= 8 * DBL_EPSILON);
        const double want = n * pow(s, n - 1) * ds;
        assert_true(fabs(kernel.dw(&kernel, q, 3) - want) <= 8 * DBL_EPSILON * fabs(want));
    }
    for (double a = 0x1p-10; a > 0x1p-52; a /= 2) { /* q = 1 - a exactly */
        const double want = pow(a * (1 - (M_PI * a) * (M_PI * a) / 6) / (1 - a), 5);
        assert_true(fabs(kernel.w(&kernel, 1 - a, 3) - want) <= 1e-11 * want);
    }
    assert_true(kernel.w(&kernel, 1, 3) == 0 && kernel.dw(&kernel, 1, 3) == 0);
    assert_true(kernel.w(&kernel, 7, 3) == 0 && kernel.dw(&kernel, INFINITY, 3) == 0);
}

TEST(selected_kernels)
{
    for (size_t i = 0; i < kernel_family.n; i++) {
        struct kernel kernel;
        assert_int_equal(kernel_select(&kernel, kernel_family.members[i]->name, 5, NULL), 0);
        for (int dim = 1; dim <= KERNEL_DIM_MAX; dim++) {
            assert_true(kernel.constant[dim] > 0);
            assert_true(kernel.smoothness[dim] >= 0);
            assert_true(kernel_least_eta(&kernel, dim) > 1);
        }
        assert_true(kernel.default_eta > kernel_least_eta(&kernel, 1));
    }
    struct kernel kernel;
    struct error error = {0};
    assert_int_equal(kernel_select(&kernel, "cubic", 5, &error), STATUS_BAD_INPUT);
    assert_non_null(strstr(error.message, "'cubic'"));
    assert_non_null(strstr(error.message, "cubic_spline"));
    assert_non_null(strstr(error.message, "sinc"));
    for (int n = -1; n < 20; n++)
        assert_int_equal(kernel_select(&kernel, "sinc", n, &error),
                         n >= 3 && n <= 12 ? STATUS_OK : STATUS_BAD_INPUT);
    assert_non_null(strstr(error.message, "3 to 12"));
}

/* Each kernel's kind: the B-spline M_n, whose knots lie at 1 - 2k/n, or Wendland's of a class
 * C^k. */
static const struct {
    const char *name;
    int n, class;
} kinds[] = {
    {"quadratic_spline", 3, 1}, {"cubic_spline", 4, 2}, {"quartic_spline", 5, 3},
    {"quintic_spline", 6, 4},   {"wendland_c2", 0, 2},  {"wendland_c4", 0, 4},
    {"wendland_c6", 0, 6},      {"sinc", 0, 4},
};
enum { KINDS = sizeof kinds / sizeof *kinds };

/* The descriptor's knots and class are those of the kernel's kind; lattice sums of a spline are
 * exact from n/2 on, those of other kernels never. */
TEST(descriptors_of_kernels)
{
    assert_int_equal(kernel_family.n, KINDS);
    for (int k = 0; k < KINDS; k++) {
        struct kernel kernel;
        const int n = kinds[k].n, knots = n ? (n - 1) / 2 : 0;
        assert_int_equal(kernel_select(&kernel, kinds[k].name, 5, NULL), STATUS_OK);
        assert_int_equal(kernel.knot_count, knots);
        for (int i = 0; i < knots; i++)
            near_absolute(kernel.knots[i], (double)((n - 1) % 2 + 1 + 2 * i) / n, 1e-15);
        for (int dim = 1; dim <= KERNEL_DIM_MAX; dim++)
            assert_int_equal(kernel.smoothness[dim], kinds[k].class);
        assert_true(kernel.unity_width == n / 2.);
        for (int shift = 0; n && shift < 5; shift++) {
            double sum = 0;
            for (int j = -9; j <= 9; j++)
                sum += kernel_value(&kernel, fabs(j + 0.2 * shift), n / 2., 1);
            near_relative(sum, 1, 1e-14);
        }
        for (int g = 0; g < GRADIENTS; g++) /* declared to three decimals */
            near_below(fabs(1000 * kernel.stable_eta[g] - round(1000 * kernel.stable_eta[g])),
                       1e-11);
    }
}

/* Each kernel has the specialisations of its own shape; no other pair of functions has any. */
TEST(specialised_kernels)
{
    for (int k = 0; k < KINDS; k++) {
        struct kernel kernel, other;
        assert_int_equal(kernel_select(&kernel, kinds[k].name, 5, NULL), STATUS_OK);
        assert_int_equal(kernel_select(&other, kinds[(k + 1) % KINDS].name, 5, NULL), STATUS_OK);
        assert_int_equal(kernel_specialisation(&kernel), kernel_index(kinds[k].name));
        other.w = kernel.w;
        assert_int_equal(kernel_specialisation(&other), -1);
        kernel.w = NULL;
        assert_int_equal(kernel_specialisation(&kernel), -1);
    }
    assert_int_equal(kernel_index("cubic"), -1);
}

static double one(double q, int dim)
{
    (void)dim;
    return q < 1 ? 1 : 0;
}

static double plugin_shape(const struct kernel *kernel, double q, int dim)
{
    return kernel->plugin_w(q, dim);
}

static double plugin_dh(double r, double h, int dim)
{
    return 100 * r + 10 * h + dim;
}

/* The largest number of plug-ins is found by name after the built-in kernels, unchanged; their
 * constants are used even if they are 0. This test must be the last one, because plug-ins cannot be
 * removed. */
TEST(plugins_in_the_family)
{
    static struct kernel plugins[KERNEL_PLUGINS_MAX + 1];
    static char names[KERNEL_PLUGINS_MAX + 1][24];
    static const double knots[] = {0.3, 0.5};
    struct kernel cubic;
    assert_int_equal(kernel_select(&cubic, "cubic_spline", 5, NULL), STATUS_OK);
    for (int k = 0; k <= KERNEL_PLUGINS_MAX; k++) {
        snprintf(names[k], sizeof names[k], "guest_%d", k);
        plugins[k] = (struct kernel){.member = {names[k], "", ""},
                                     .w = plugin_shape,
                                     .plugin_w = one,
                                     .plugin_dw_dh = k ? plugin_dh : NULL,
                                     .constant = {0, 0, 1 / M_PI}};
        if (k == 5) /* not a plug-in: normalised between its knots */
            plugins[k] = (struct kernel){
                .member = {names[k], "", ""}, .w = cubic.w, .knot_count = 2, .knots = knots};
        assert_int_equal(kernel_add(&plugins[k]), k < KERNEL_PLUGINS_MAX ? KINDS + k : -1);
    }
    for (int k = 0; k <= KERNEL_PLUGINS_MAX; k++) {
        struct kernel kernel;
        const bool in = k < KERNEL_PLUGINS_MAX;
        assert_int_equal(kernel_index(names[k]), in ? KINDS + k : -1);
        assert_int_equal(kernel_select(&kernel, names[k], 5, NULL), in ? 0 : STATUS_BAD_INPUT);
        if (!in) continue;
        for (int dim = 1; dim <= 3 && k == 5; dim++)
            near_relative(kernel.constant[dim], cubic.constant[dim], 1e-14);
        if (k == 5) continue;
        assert_true(kernel.constant[1] == 0 && kernel.constant[2] == 1 / M_PI);
        assert_int_equal(kernel_specialisation(&kernel), -1);
        if (k) assert_true(kernel_dh(&kernel, 2, 3, 1) == 231);
    }
    assert_int_equal(kernel_family.n, KINDS);
    char said[256] = "no kernel 'cubic'; there are ";
    struct kernel kernel;
    struct error error;
    for (int k = 0; k < KINDS; k++)
        sprintf(said + strlen(said), "%s%s", k ? ", " : "", kernel_family.members[k]->name);
    assert_int_equal(kernel_select(&kernel, "cubic", 5, &error), STATUS_BAD_INPUT);
    assert_string_equal(error.message, said);
}
