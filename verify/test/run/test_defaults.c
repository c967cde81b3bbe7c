/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the values of `auto`: eta of every kernel and cfl of every integrator are those in the
 * tables of CONVENTIONS section 9, and other keys follow from their documented rules, for all such
 * schemes in 1D and 2D. Also tests which schemes are refused, at each limit. Argument:
 * CONVENTIONS.md. */
#include "test.h"

#include "integrator.h"
#include "keyed.h"

enum { ROWS = 32, CELL = 40 };

/* Up to five cells of a row of the first table whose header begins with a given word. */
struct row {
    char cell[5][CELL];
};
struct table {
    size_t n;
    struct row row[ROWS];
};
static struct table kernels, integrators;

static void read_table(struct table *table, const char *path, const char *first)
{
    char line[400], header[CELL];
    FILE *file = fopen(path, "r");
    bool inside = false;
    snprintf(header, sizeof header, "| %s |", first);
    assert_non_null(file);
    while (fgets(line, sizeof line, file)) {
        if (inside && line[0] != '|') break;
        if (inside && line[1] == ' ') {
            struct row *row = &table->row[table->n++];
            assert_true(table->n < ROWS);
            sscanf(line, "| %39[^|]| %39[^|]| %39[^|]| %39[^|]| %39[^|]|", row->cell[0],
                   row->cell[1], row->cell[2], row->cell[3], row->cell[4]);
            for (size_t i = 0; i < 5; i++) strtok(row->cell[i], " \n");
        }
        inside = inside || strncmp(line, header, strlen(header)) == 0;
    }
    fclose(file);
}

static const struct row *row_of(const struct table *table, const char *name)
{
    for (size_t i = 0; i < table->n; i++)
        if (strcmp(table->row[i].cell[0], name) == 0) return &table->row[i];
    fail_msg("%s is in no table of CONVENTIONS section 9", name);
    return NULL;
}

/* Evaluates "1.5", "0.8/eta" or "sinc_n/2". */
static double value_of(const char *cell, double eta, double sinc_n)
{
    if (strcmp(cell, "sinc_n/2") == 0) return sinc_n < 5 ? 2.5 : sinc_n / 2;
    char *end;
    const double value = strtod(cell, &end);
    assert_true(end != cell && (*end == '\0' || strcmp(end, "/eta") == 0));
    return *end ? value / eta : value;
}

/* The scheme of a case with these words; false if they exclude each other. */
static bool scheme_of(const struct run_settings *base, size_t n, const char *const *words,
                      struct run *run)
{
    struct run_settings settings = *base;
    struct error error = {0};
    assert_int_equal(
        settings_apply(&settings.settings, (int)n, (char *const *)(uintptr_t)words, &error),
        STATUS_OK);
    return run_resolve(run, &settings, &error) == STATUS_OK;
}

static void is(double got, double want, const struct run *run, const char *what)
{
    if (!(fabs(got - want) <= 1e-15 * want))
        fail_msg("%s is %.17g, not %.17g, with %s %s", what, got, want,
                 run->scheme.kernel.member.name, run->scheme.integrator->member.name);
}

/* Compares a scheme's defaults with those that the documentation states for auto. */
static void judge(const struct run *run, int dim)
{
    const struct scheme *s = &run->scheme;
    const char *kernel = s->kernel.member.name;
    const struct row *k = row_of(&kernels, kernel),
                     *i = row_of(&integrators, s->integrator->member.name);
    const bool midpoint = strcmp(i->cell[0], "predicted_midpoint") == 0, line = dim == 1,
               vanilla = s->formulation == FORMULATION_VANILLA_ICE,
               quadratic = strcmp(kernel, "quadratic_spline") == 0,
               standard = s->gradient == GRADIENT_STANDARD;
    const double eta = value_of(k->cell[line ? 1 : 2], 0, s->kernel.order);
    const double alpha = quadratic && midpoint && line ? 0.75 : 1;
    const double most = s->viscosity == VISCOSITY_TIME_DEPENDENT ? s->alpha_max : alpha;
    const bool far = midpoint && line && quadratic && standard && s->h_method == H_PREDICTED &&
                     s->volume_element == VOLUME_MASS && s->viscosity != VISCOSITY_NONE &&
                     most <= 0.75;
    const bool mu = midpoint && !line && s->viscosity != VISCOSITY_NONE &&
                    s->viscosity_form == VISCOSITY_FORM_MU;
    is(s->eta, eta, run, "eta");
    is(s->alpha, alpha, run, "alpha");
    is(s->beta, 2 * alpha, run, "beta");
    is(s->cfl, far ? 1.1 / eta : value_of(i->cell[line || mu ? 3 : 4], eta, 0), run, "cfl");
    assert_int_equal(s->energy, midpoint ? ENERGY_TOTAL : ENERGY_INTERNAL);
    assert_int_equal(s->h_method, midpoint && vanilla ? H_PREDICTED : H_NEWTON);
    assert_int_equal(s->pair_width, !midpoint || !vanilla                     ? PAIR_WIDTH_MEAN
                                    : s->viscosity == VISCOSITY_RECONSTRUCTED ? PAIR_WIDTH_HARMONIC
                                    : line && quadratic && standard           ? PAIR_WIDTH_MAX
                                                                              : PAIR_WIDTH_MEAN);
    const bool projected = s->viscosity == VISCOSITY_PROJECTED,
               sloped = projected || s->viscosity == VISCOSITY_RECONSTRUCTED;
    assert_int_equal(s->viscosity_form,
                     !line && sloped ? VISCOSITY_FORM_SIGNAL : VISCOSITY_FORM_MU);
    assert_int_equal(s->balsara, projected ? BALSARA_ON : BALSARA_OFF);
    assert_int_equal(s->integrator->order, atoi(i->cell[1]));
    assert_int_equal(s->integrator->evaluations, atoi(i->cell[2]));
}

/* Every kernel, integrator, gradient, formulation and viscosity in this number of dimensions. */
static void every_scheme(const char *name, int dim)
{
    const struct run_settings base = keyed_case(name, "");
    const struct family *families[] = {&kernel_family, &integrator_family, &scheme_gradient_family,
                                       &scheme_formulation_family, &scheme_viscosity_family};
    static const char *const keys[] = {"kernel", "integrator", "gradient", "formulation",
                                       "viscosity"};
    size_t counts[5], all = 1, allowed = 0;
    for (size_t f = 0; f < 5; f++)
        all *= counts[f] = f < 2 ? families[f]->n : scheme_members(families[f], dim);
    for (size_t c = 0; c < all; c++) {
        char words[5][64];
        const char *pointers[5];
        size_t left = c;
        for (size_t f = 0; f < 5; f++) {
            snprintf(words[f], sizeof words[f], "%s=%s", keys[f],
                     families[f]->members[left % counts[f]]->name);
            pointers[f] = words[f];
            left /= counts[f];
        }
        struct run run;
        if (!scheme_of(&base, 5, pointers, &run)) continue;
        judge(&run, dim);
        allowed++;
    }
    assert_true(2 * allowed > all);
}

TEST(defaults_in_1d)
{
    every_scheme("sod", 1);
}

TEST(defaults_in_2d)
{
    every_scheme("rest_2d", 2);
}

TEST(tables_name_every_member)
{
    assert_int_equal(kernels.n, kernel_family.n);
    assert_int_equal(integrators.n, integrator_family.n);
}

/* A scheme without keys, and choices that exclude long time steps. */
TEST(nothing_chosen)
{
    static const struct {
        const char *name, *kernel;
        enum gradient gradient;
        enum viscosity viscosity;
        enum volume_element element;
        int dim;
    } cases[] = {{"sod", "quadratic_spline", GRADIENT_STANDARD, VISCOSITY_CONSTANT, VOLUME_MASS, 1},
                 {"rest_2d", "wendland_c4", GRADIENT_IA, VISCOSITY_PROJECTED, VOLUME_NUMBER, 2},
                 {"rest_3d", "wendland_c4", GRADIENT_IA, VISCOSITY_PROJECTED, VOLUME_NUMBER, 3}};
    struct run run;
    for (size_t i = 0; i < 3; i++) {
        const struct run_settings base = keyed_case(cases[i].name, "");
        assert_true(scheme_of(&base, 0, NULL, &run));
        assert_string_equal(run.scheme.kernel.member.name, cases[i].kernel);
        assert_int_equal(run.scheme.gradient, cases[i].gradient);
        assert_int_equal(run.scheme.viscosity, cases[i].viscosity);
        assert_int_equal(run.scheme.volume_element, cases[i].element);
        judge(&run, cases[i].dim);
    }
    static const struct {
        const char *words[2];
        double spacings;
    } steps[] = {
        {{"alpha=0.75", "t_end=0.1"}, 1.1},
        {{"alpha=0.76", "t_end=0.1"}, 0.8},
        {{"alpha=0.3", "t_end=0.1"}, 1.1},
        {{"eta=1.6", "t_end=0.1"}, 0.8},
        {{"h_method=newton", "t_end=0.1"}, 0.8},
        {{"viscosity=none", "t_end=0.1"}, 0.8},
        {{"volume_element=energy", "alpha=0.5"}, 0.8},
        {{"viscosity=time_dependent", "alpha_max=0.7"}, 1.1},
        {{"viscosity=time_dependent", "alpha_max=0.8"}, 0.8},
        {{"kernel=cubic_spline", "alpha=0.5"}, 0.8},
        {{"gradient=ia", "alpha=0.5"}, 0.8},
        {{"shifting=closed", "t_end=0.1"}, 1}, /* the rest are in 2D */
        {{"shifting=closed", "viscosity_form=mu"}, 0.8},
    };
    const size_t count = sizeof steps / sizeof *steps;
    for (size_t i = 0; i < count; i++) {
        const struct run_settings base = keyed_case(i < count - 2 ? "sod" : "yee", "");
        assert_true(scheme_of(&base, 2, steps[i].words, &run));
        is(run.scheme.cfl * run.scheme.eta, steps[i].spacings, &run, steps[i].words[0]);
    }
}

/* shifting=auto: closed for these problems, unless a key excludes it. */
TEST(default_of_shifting)
{
    enum { KEYS = 2 };
    static const struct {
        const char *name, *keys[KEYS];
        enum shifting shifting;
    } rows[] = {
        {"gresho", {0}, SHIFTING_CLOSED},
        {"yee", {"boost=1", "lattice=hexagonal"}, SHIFTING_CLOSED},
        {"square", {"n=24^2"}, SHIFTING_CLOSED},
        {"noh_2d", {0}, SHIFTING_CLOSED},
        {"noh_3d", {"gradient=corrected"}, SHIFTING_CLOSED},
        {"sedov_2d", {"kernel=cubic_spline"}, SHIFTING_CLOSED},
        {"sedov_3d", {"gradient=blended"}, SHIFTING_CLOSED},
        {"gresho", {"boundary=reflecting"}, SHIFTING_CLOSED},
        {"gresho", {"boundary=fixed"}, SHIFTING_NONE},
        {"noh_2d", {"boundary=open"}, SHIFTING_NONE},
        {"noh_2d", {"boundary=periodic open"}, SHIFTING_NONE},
        {"gresho", {"shifting=fluxes"}, SHIFTING_FLUXES},
        {"gresho", {"shifting=none"}, SHIFTING_NONE},
        {"yee", {"gradient=standard"}, SHIFTING_NONE},
        {"yee", {"steps=local"}, SHIFTING_NONE},
        {"yee", {"integrator=rk2"}, SHIFTING_NONE},
        {"yee", {"energy=internal"}, SHIFTING_NONE},
        {"yee", {"formulation=lagrangian"}, SHIFTING_NONE},
        {"yee", {"volume_element=mass"}, SHIFTING_NONE},
        {"noh_1d", {0}, SHIFTING_NONE},
        {"sod_2d", {0}, SHIFTING_NONE},
        {"sod_2d", {"shifting=closed"}, SHIFTING_CLOSED},
        {"rest_3d", {0}, SHIFTING_NONE},
        {"kelvin_helmholtz", {0}, SHIFTING_NONE},
        {"kelvin_helmholtz", {"equal_masses=yes"}, SHIFTING_CLOSED},
        {"kelvin_helmholtz", {"equal_masses=yes", "gradient=standard"}, SHIFTING_NONE},
        {"rotation", {0}, SHIFTING_NONE},
        {"sound_wave_3d", {0}, SHIFTING_NONE},
        {"rayleigh_taylor_mode", {0}, SHIFTING_NONE},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const struct run_settings base = keyed_case(rows[k].name, "");
        struct run run;
        size_t n = 0;
        while (n < KEYS && rows[k].keys[n]) n++;
        assert_true(scheme_of(&base, n, rows[k].keys, &run));
        if (run.scheme.shifting != rows[k].shifting ||
            settings_choice(&run.settings, SETTING_shifting) != (int)rows[k].shifting)
            fail_msg("row %zu: %s", k, rows[k].name);
    }
}

/* shock_conductivity=auto: in gas that viscosity heats. */
TEST(default_of_shock_conductivity)
{
    static const struct {
        const char *name, *keys[2];
        double strength;
    } rows[] = {
        {"sedov_2d", {0}, 1},
        {"noh_3d", {"viscosity=constant", "gradient=standard"}, 1},
        {"gresho", {"alpha=0"}, 0},
        {"gresho", {"alpha=0", "beta=1"}, 1},
        {"sod_3d", {"viscosity=none"}, 0},
        {"sod_3d", {"viscosity=none", "shock_conductivity=3"}, 3},
        {"sod_2d", {"shock_conductivity=0"}, 0},
        {"sod", {0}, 0},
        {"taylor_green", {0}, 0},
        {"hydrostatic", {"shock_conductivity=1"}, 1},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const struct run_settings base = keyed_case(rows[k].name, "");
        struct run run;
        size_t n = 0;
        while (n < 2 && rows[k].keys[n]) n++;
        assert_true(scheme_of(&base, n, rows[k].keys, &run));
        if (run.scheme.shock_conductivity != rows[k].strength ||
            settings_real(&run.settings, SETTING_shock_conductivity) != rows[k].strength)
            fail_msg("row %zu: %s", k, rows[k].name);
    }
}

/* sinc: half of its exponent. */
TEST(default_of_sinc)
{
    const struct run_settings sod = keyed_case("sod", ""), rest = keyed_case("rest_2d", "");
    for (int n = 3; n <= 12; n++) {
        char word[32];
        struct run run;
        snprintf(word, sizeof word, "sinc_n=%d", n);
        const char *const words[] = {"kernel=sinc", word};
        for (int dim = 1; dim <= 2; dim++) {
            assert_true(scheme_of(dim == 1 ? &sod : &rest, 2, words, &run));
            is(run.scheme.eta, n < 5 ? 2.5 : n / 2., &run, word);
            assert_int_equal(run.scheme.kernel.smoothness[dim], n - 1);
        }
        assert_int_equal(run.scheme.kernel.stable_eta[0] > 0, n == 5);
        assert_int_equal(run.scheme.kernel.stable_eta[1] > 0, n == 5);
    }
}

/* --- refused choices -------------------------------------------------------------------------- */

/* A scheme of the case's dimension with one changed member is refused with this message. */
static void with(const struct scheme *scheme, int dim, size_t member, double value,
                 const char *said)
{
    struct scheme changed = *scheme;
    struct error error = {0};
    memcpy((char *)&changed + member, &value, sizeof value);
    assert_int_equal(scheme_check(&changed, dim, &error), said ? STATUS_BAD_INPUT : STATUS_OK);
    assert_string_equal(error.message, said ? said : "");
}

#define WITH(member, value, said) with(&s, dim, offsetof(struct scheme, member), value, said)

TEST(numbers_that_are_refused)
{
    for (int dim = 1; dim <= 3; dim++) {
        const struct run_settings base = keyed_case(dim == 1   ? "sod"
                                                    : dim == 2 ? "rest_2d"
                                                               : "rest_3d",
                                                    "");
        struct run run;
        assert_true(scheme_of(&base, 0, NULL, &run));
        struct scheme s = run.scheme;
        char said[200];
        const double least = kernel_least_eta(&s.kernel, dim);
        for (int k = 0; k < 4; k++) {
            const double eta[] = {least, -1, (double)NAN, (double)INFINITY};
            snprintf(said, sizeof said,
                     "eta = %g: h = eta (m/rho)^(1/%d) has no root with the kernel %s unless eta > "
                     "%.6g",
                     eta[k], dim, dim == 1 ? "quadratic_spline" : "wendland_c4", least);
            WITH(eta, eta[k], said);
        }
        WITH(eta, nextafter(least, 9), NULL);
        WITH(cfl, 0, "cfl = 0: cfl must be positive and finite");
        WITH(cfl, (double)NAN, "cfl = nan: cfl must be positive and finite");
        WITH(cfl, (double)INFINITY, "cfl = inf: cfl must be positive and finite");
        WITH(cfl, 1e-300, NULL);
        WITH(h_tolerance, nextafter(1e-15, 0),
             "h_tolerance = 1e-15: h_tolerance must be in [1e-15, 1e-2]");
        WITH(h_tolerance, nextafter(1e-2, 1),
             "h_tolerance = 0.01: h_tolerance must be in [1e-15, 1e-2]");
        WITH(h_tolerance, (double)NAN, "h_tolerance = nan: h_tolerance must be in [1e-15, 1e-2]");
        WITH(h_tolerance, 1e-15, NULL);
        WITH(h_tolerance, 1e-2, NULL);
        WITH(alpha, -1e-300, "alpha = -1e-300: alpha must be >= 0 and finite");
        WITH(alpha, (double)INFINITY, "alpha = inf: alpha must be >= 0 and finite");
        WITH(alpha, 0, NULL);
        WITH(beta, -1e-300, "beta = -1e-300: beta must be >= 0 and finite");
        WITH(beta, (double)INFINITY, "beta = inf: beta must be >= 0 and finite");
        WITH(beta, 0, NULL);
        WITH(alpha_u, 0.5,
             dim > 1 ? NULL
                     : "alpha_u=0.5 and dimension=1 exclude each other: conductivity is for 2 and "
                       "3 dimensions");
        WITH(shock_conductivity, 2,
             dim > 1 ? NULL
                     : "shock_conductivity=2 and dimension=1 exclude each other: conductivity is "
                       "for 2 and 3 dimensions");
        /* only for a viscosity that varies */
        const double alphas[][2] = {{-1e-300, 1}, {0.5, 0.25}, {0.5, (double)INFINITY}, {1, NAN}};
        for (int k = 0; k < 4; k++) {
            s.alpha_min = alphas[k][0], s.alpha_max = alphas[k][1];
            snprintf(said, sizeof said,
                     "alpha_min = %g, alpha_max = %g: 0 <= alpha_min <= alpha_max is needed",
                     s.alpha_min, s.alpha_max);
            s.viscosity = VISCOSITY_CONSTANT;
            WITH(cfl, 0.5, NULL);
            s.viscosity = VISCOSITY_TIME_DEPENDENT;
            WITH(cfl, 0.5, said);
            s.viscosity = VISCOSITY_CULLEN_DEHNEN;
            if (dim > 1) WITH(cfl, 0.5, said);
        }
        s.alpha_min = s.alpha_max = 0;
        WITH(cfl, 0.5,
             dim > 1 ? NULL
                     : "viscosity=cullen_dehnen and dimension=1 exclude each other: "
                       "it is for 2 and 3 dimensions");
    }
}

/* The lagrangian formulation allows pair_width=mean only. Families list members that exist in 1D
 * before those for 2D and 3D only. */
TEST(choices_that_are_refused)
{
    const struct run_settings base = keyed_case("sod", "");
    struct run run;
    struct error error = {0};
    assert_true(scheme_of(&base, 0, NULL, &run));
    struct scheme s = run.scheme;
    for (size_t k = 0; k < scheme_pair_width_family.n; k++) {
        const char *name = scheme_pair_width_family.members[k]->name;
        char said[200];
        s.pair_width = (enum pair_width)k;
        s.formulation = FORMULATION_VANILLA_ICE;
        assert_int_equal(scheme_check(&s, 1, &error), STATUS_OK);
        s.formulation = FORMULATION_LAGRANGIAN;
        snprintf(said, sizeof said,
                 "pair_width=%s and formulation=lagrangian exclude each other: the lagrangian form "
                 "needs both particles' own gradients",
                 name);
        const bool mean = strcmp(name, "mean") == 0;
        assert_int_equal(scheme_check(&s, 1, &error), mean ? STATUS_OK : STATUS_BAD_INPUT);
        if (!mean) assert_string_equal(error.message, said);
    }
    static const struct {
        const struct family *family;
        const char *key, *first_of_two;
        size_t at; /* offset of the member; 0: not in the scheme */
    } rows[] = {
        {&scheme_gradient_family, "gradient", "corrected", offsetof(struct scheme, gradient)},
        {&scheme_volume_element_family, "volume_element", "number",
         offsetof(struct scheme, volume_element)},
        {&scheme_viscosity_family, "viscosity", "cullen_dehnen",
         offsetof(struct scheme, viscosity)},
        {&scheme_viscosity_form_family, "viscosity_form", "signal",
         offsetof(struct scheme, viscosity_form)},
        {&scheme_balsara_family, "balsara", "on", offsetof(struct scheme, balsara)},
        {&scheme_shifting_family, "shifting", "fluxes", offsetof(struct scheme, shifting)},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const struct family *family = rows[k].family;
        const size_t in_line = scheme_members(family, 1);
        assert_string_equal(family->members[in_line]->name, rows[k].first_of_two);
        assert_int_equal(scheme_members(family, 2), family->n);
        assert_int_equal(scheme_members(family, 3), family->n);
        for (unsigned member = 0; rows[k].at && member < family->n; member++) {
            struct scheme changed = run.scheme;
            char said[200];
            memcpy((char *)&changed + rows[k].at, &member, sizeof member);
            snprintf(said, sizeof said,
                     "%s=%s and dimension=1 exclude each other: it is for 2 and 3 dimensions",
                     rows[k].key, family->members[member]->name);
            const bool line = member < in_line;
            assert_int_equal(scheme_check(&changed, 1, &error),
                             line ? STATUS_OK : STATUS_BAD_INPUT);
            if (!line) assert_string_equal(error.message, said);
        }
    }
    assert_int_equal(scheme_members(&scheme_formulation_family, 1), scheme_formulation_family.n);
}

static int read_tables(void **state)
{
    (void)state;
    read_table(&kernels, test_word(1), "kernel");
    read_table(&integrators, test_word(1), "integrator");
    return 0;
}

TEST_BETWEEN(read_tables, NULL);
