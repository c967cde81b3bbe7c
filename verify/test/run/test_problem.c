/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests that every problem keeps the promises of problem.h with each of its cases: one walk over
 * its descriptor, its particles and its exact solution. The same walk must reject copies of
 * descriptors with one planted fault. */
#include "test.h"

#include "cases.h"
#include "functional.h"
#include "initial.h"
#include "problem.h"
#include "problem_list.h"
#include "problem_prepare.h"
#include "run.h"

/* The subject of a walk through the properties of a problem, and the first fault. */
struct walk {
    const struct problem *problem;
    struct settings settings;
    struct prepared p;
    struct initial initial;
    double sums; /* relative tolerance of sums over particles: their quadrature has an error */
    char fault[600];
};

static bool fault(struct walk *walk, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Records the first fault; always returns false. */
static bool fault(struct walk *walk, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    if (!walk->fault[0]) vsnprintf(walk->fault, sizeof walk->fault, format, list);
    va_end(list);
    return false;
}

static bool descriptor_is_whole(struct walk *walk)
{
    const struct problem *problem = walk->problem;
    const struct functional *const *f = problem->functionals;
    if (!problem->member.name[0] || !problem->member.label[0] || !problem->reference[0])
        return fault(walk, "no name, label or reference");
    if (!(1 <= problem->least_dim && problem->least_dim <= problem->most_dim &&
          problem->most_dim <= 3))
        return fault(walk, "dimensions %d to %d", problem->least_dim, problem->most_dim);
    if (!problem->prepare || !problem->sample || !problem->fill ||
        !problem->holds != !problem->refuse)
        return fault(walk, "a function is missing");
    for (size_t i = 0; i < problem->key_count; i++) {
        const enum setting key = problem->keys[i].key;
        if (!((int)key >= 0 && key < SETTINGS)) return fault(walk, "key %zu is unknown", i);
        if (strcmp(setting_keys[key].section, "initial") != 0 || key == SETTING_kind)
            return fault(walk, "key %s is not a problem's", setting_keys[key].name);
        for (size_t j = 0; j < i; j++)
            if (problem->keys[j].key == key)
                return fault(walk, "key %s twice", setting_keys[key].name);
    }
    for (size_t i = 0; f[i]; i++) {
        if (i == PROBLEM_FUNCTIONALS_MAX) return fault(walk, "too many functionals");
        if (!f[i]->name[0] || !f[i]->measure) return fault(walk, "functional %zu is not whole", i);
        for (size_t j = 0; j < i; j++)
            if (strcmp(f[i]->name, f[j]->name) == 0)
                return fault(walk, "functional %s twice", f[i]->name);
    }
    const struct growing *growing = problem->growing;
    if (growing && !(growing->name[0] && growing->amplitude && growing->during && growing->rate))
        return fault(walk, "what grows is not whole");
    return true;
}

/* ---- the initial state ---- */

static void place(const struct walk *walk, size_t i, double x[3])
{
    for (int d = 0; d < 3; d++) x[d] = d < walk->initial.dim ? walk->initial.x[d][i] : 0;
}

static bool differ(double a, double b, double scale)
{
    return !(fabs(a - b) <= 1e-13 * (fabs(a) + fabs(b) + scale));
}

/* Each particle lies in the domain and has the sample of its position. */
static bool particles_are_samples(struct walk *walk)
{
    const struct prepared *p = &walk->p;
    const struct initial *initial = &walk->initial;
    const double wanted = settings_real(&walk->settings, SETTING_n);
    if (initial->dim != p->domain.dim) return fault(walk, "particles in %dD", initial->dim);
    if (!(fabs((double)initial->n / wanted - 1) <= 0.2)) return fault(walk, "number of particles");
    for (size_t i = 0; i < initial->n; i++) {
        double x[3];
        struct problem_state s;
        place(walk, i, x);
        for (int d = 0; d < initial->dim; d++)
            if (!(x[d] >= p->domain.lo[d] && x[d] < p->domain.hi[d]))
                return fault(walk, "particle %zu is outside the domain", i);
        problem_sample_start(p, x, &s);
        const double c = sqrt(p->gamma * s.P / s.rho);
        if (!(initial->m[i] > 0 && s.rho > 0 && s.u > 0))
            return fault(walk, "particle %zu is not positive", i);
        if (differ(initial->rho[i], s.rho, 0) ||
            (!walk->problem->mean_energy && differ(initial->u[i], s.u, 0)) ||
            (!walk->problem->liquid && differ(s.P, (p->gamma - 1) * s.rho * s.u, 0)))
            return fault(walk, "particle %zu has another state than the sample", i);
        for (int d = 0; d < initial->dim; d++)
            if (differ(initial->v[d][i], s.v[d], c))
                return fault(walk, "particle %zu has another velocity than the sample", i);
    }
    return true;
}

enum { MASS, MOMENTUM, ENERGY = MOMENTUM + 3, SUMS };

static void add_sums(double sums[SUMS], double mass, const double v[3], double u)
{
    sums[MASS] += mass;
    for (int d = 0; d < 3; d++) {
        sums[MOMENTUM + d] += mass * v[d];
        sums[ENERGY] += 0.5 * mass * v[d] * v[d];
    }
    sums[ENERGY] += mass * u;
}

/* Integrals of the sample at t = 0, by midpoints; no jump lies inside of a cell. */
static void integrate(const struct prepared *p, double sums[SUMS])
{
    const int dim = p->domain.dim;
    const size_t side = dim == 1 ? 4096 : dim == 2 ? 256 : 40;
    size_t cells = 1;
    double volume = 1;
    for (int d = 0; d < dim; d++) {
        cells *= side;
        volume *= domain_length(&p->domain, d) / (double)side;
    }
    for (size_t i = 0; i < cells; i++) {
        double x[3] = {0};
        struct problem_state s;
        size_t rest = i;
        for (int d = 0; d < dim; d++, rest /= side)
            x[d] = p->domain.lo[d] +
                   ((double)(rest % side) + 0.5) * (domain_length(&p->domain, d) / (double)side);
        problem_sample_start(p, x, &s);
        add_sums(sums, s.rho * volume, s.v, s.u);
    }
}

static bool particles_carry_the_integrals(struct walk *walk)
{
    static const char *const names[SUMS] = {"mass", "momentum x", "momentum y", "momentum z",
                                            "energy"};
    const struct initial *initial = &walk->initial;
    double want[SUMS] = {0}, have[SUMS] = {0};
    integrate(&walk->p, want);
    for (size_t i = 0; i < initial->n; i++) {
        double v[3] = {0};
        for (int d = 0; d < initial->dim; d++) v[d] = initial->v[d][i];
        add_sums(have, initial->m[i], v, initial->u[i]);
    }
    const double momentum = sqrt(want[MASS] * want[ENERGY]);
    for (int k = 0; k < (walk->problem->mean_energy ? ENERGY : SUMS); k++) {
        const double scale = k == MASS || k == ENERGY ? fabs(want[k]) : momentum;
        if (!(fabs(have[k] - want[k]) <= walk->sums * scale))
            return fault(walk, "%s of the particles %.17g, of the sample %.17g", names[k], have[k],
                         want[k]);
    }
    return true;
}

static bool start_is_random_as_said(struct walk *walk)
{
    struct settings settings = walk->settings;
    struct error error;
    for (int shaken = 0; shaken < 2; shaken++) {
        struct initial one, two;
        settings.value[SETTING_jitter].automatic = false;
        settings.value[SETTING_jitter].real[0] = 0.1 * shaken;
        const bool random = settings_random_start(&settings);
        if (initial_create(&one, &walk->p, &settings, &error)) return fault(walk, "no particles");
        settings.value[SETTING_seed].real[0] += 1;
        if (initial_create(&two, &walk->p, &settings, &error)) return fault(walk, "no particles");
        const bool same = memcmp(one.x[0], two.x[0], one.n * sizeof(double)) == 0;
        initial_free(&one);
        initial_free(&two);
        if (same == random)
            return fault(walk, "the seed changes %s of a start that is %srandom",
                         same ? "nothing" : "particles", random ? "" : "not ");
    }
    return true;
}

/* ---- gates ---- */

static bool window_is_free(struct walk *walk)
{
    const struct prepared *p = &walk->p;
    const double t_end = settings_real(&walk->settings, SETTING_t_end);
    struct error error = {0}, late = {0};
    for (int d = 0; d < p->domain.dim; d++)
        if (!(p->window.lo[d] >= p->domain.lo[d] && p->window.lo[d] < p->window.hi[d] &&
              p->window.hi[d] <= p->domain.hi[d]))
            return fault(walk, "the window is not in the domain");
    if (problem_check_time(p, 0, &error) || problem_check_time(p, t_end, &error))
        return fault(walk, "not free at t_end = %g: %.300s", t_end, error.message);
    if (!walk->problem->holds) return true;
    if (!problem_check_time(p, 1e6, &error) || !problem_check_time(p, 1e30, &late))
        return fault(walk, "free for ever");
    if (!strstr(error.message, "t_end=1e+06") || !strstr(error.message, "allowed"))
        return fault(walk, "refused without saying what is allowed: %.300s", error.message);
    if (strcmp(strstr(error.message, "allowed"), strstr(late.message, "allowed")) != 0)
        return fault(walk, "a later end is allowed less: %.300s", late.message);
    return true;
}

/* A steady flow has its initial state at the end as well. */
static bool is_steady_as_said(struct walk *walk)
{
    const double t_end = settings_real(&walk->settings, SETTING_t_end);
    for (size_t i = 0; walk->problem->steady && i < walk->initial.n; i++) {
        double x[3];
        struct problem_state start, end;
        place(walk, i, x);
        problem_sample_start(&walk->p, x, &start);
        problem_sample(&walk->p, x, t_end, &end);
        for (int d = 0; d < walk->initial.dim; d++)
            if (differ(start.rho, end.rho, 0) || differ(start.v[d], end.v[d], 1))
                return fault(walk, "the flow is not steady");
    }
    return true;
}

/* Functionals and regions at t = 0, where all values are known. */
static bool start_is_measured(struct walk *walk)
{
    const struct prepared *p = &walk->p;
    const struct initial *initial = &walk->initial;
    const size_t n = initial->n;
    const struct regions *regions = walk->problem->regions;
    double *P = malloc(3 * n * sizeof *P), *h = P + n, *volume = h + n;
    double widest = 0;
    size_t count = 0;
    assert_non_null(P);
    for (size_t i = 0; i < n; i++) {
        P[i] = (p->gamma - 1) * initial->rho[i] * initial->u[i];
        volume[i] = initial->m[i] / initial->rho[i];
        h[i] = 2 * pow(volume[i], 1. / initial->dim);
        widest = fmax(widest, h[i]);
    }
    const struct snapshot s = {.n = n,
                               .x = {initial->x[0], initial->x[1], initial->x[2]},
                               .v = {initial->v[0], initial->v[1], initial->v[2]},
                               .m = initial->m,
                               .rho = initial->rho,
                               .u = initial->u,
                               .P = P,
                               .h = h,
                               .volume = volume};
    for (const struct functional *const *f = walk->problem->functionals; *f; f++) {
        if (((*f)->present && !(*f)->present(p)) || !(*f)->exact) continue;
        const double exact = (*f)->exact(p, 0), value = (*f)->measure(p, &s);
        if (isnan(exact)) continue; /* the exact value is unknown */
        if (!(fabs(value - exact) <= (exact == 0 ? widest : fmax(0.05, walk->sums) * fabs(exact))))
            fault(walk, "functional %s: %g of the particles, %g exactly", (*f)->name, value, exact);
    }
    while (regions && regions->names[count]) count++;
    for (size_t i = 0; i < n && count; i++) {
        double x[3];
        place(walk, i, x);
        for (int k = 0; k < 4; k++)
            if (regions->at(p, x, k * h[i], 0.1 * k) >= count)
                fault(walk, "particle %zu is in a region that has no name", i);
    }
    if (count && regions->still(p, &s) > 0) fault(walk, "still gas moves at t = 0");
    free(P);
    return !walk->fault[0];
}

static void walk_all(struct walk *walk, int dim)
{
    struct error error = {0};
    if (!descriptor_is_whole(walk)) return;
    if (problem_prepare_as(&walk->p, walk->problem, &walk->settings, dim, &error) ||
        walk->problem->fill(&walk->p, &walk->settings, &walk->initial, &error)) {
        fault(walk, "%s", error.message);
        return;
    }
    if (particles_are_samples(walk) && particles_carry_the_integrals(walk) &&
        start_is_random_as_said(walk) && window_is_free(walk) && is_steady_as_said(walk))
        start_is_measured(walk);
    initial_free(&walk->initial);
}

/* ---- every problem ---- */

/* Walks through a case with these keys (separated by |; keys of other problems are skipped).
 * `instead`, unless NULL, replaces its problem. */
static struct walk walk_case(const char *name, const char *keys, const struct problem *instead)
{
    struct walk walk = {.sums = 1e-12};
    struct case_file file;
    struct error error = {0};
    char text[128], *rest = NULL;
    if (case_load(&file, name, &error)) fail_msg("%s", error.message);
    walk.settings = file.settings;
    if (file.dimension > 1) walk.sums = 0.02; /* few points, kinks, masses of whole particles */
    if (strcmp(name, "noh_1d") == 0) walk.sums = 0.01; /* with odd n one particle is at rest */
    if (strcmp(name, "leblanc") == 0) walk.sums = 0.5; /* the light gas weighs half a particle */
    walk.problem = instead ? instead : problem_of(&walk.settings);
    snprintf(text, sizeof text, "%s", keys);
    for (char *key = strtok_r(text, "|", &rest); key; key = strtok_r(NULL, "|", &rest)) {
        const size_t length = strcspn(key, "=");
        char word[32];
        snprintf(word, sizeof word, "%.*s", (int)length, key);
        if (problem_foreign(&walk.settings, (enum setting)setting_find(word))) continue;
        assert_int_equal(settings_apply(&walk.settings, 1, &key, &error), STATUS_OK);
    }
    walk_all(&walk, file.dimension);
    return walk;
}

TEST(every_problem_of_every_case)
{
    static const char *const variants[] = {"n=400", "n=397|grade=0.5",
                                           "n=402|grade=0.3|mass_ratio=0.6",
                                           "n=400|background=1.3 -0.4 0.7|waves=3",
                                           "n=400|gamma=1.6667|amplitude=0.01|t_end=0.005"},
                             *const wide[] = {
                                 "n=4096", "n=3000|lattice=hexagonal|contrast=2",
                                 "n=4096|lattice=jittered|waves=2|amplitude=0.005|direction=1",
                                 "n=2500|equal_masses=yes|left=1 0.1 1.2|right=0.5 0.1 1"};
    for (const struct case_builtin *b = case_builtins; b->name; b++) {
        struct case_file file;
        struct error error;
        if (case_load(&file, b->name, &error)) fail_msg("%s", error.message);
        const bool line = file.dimension == 1;
        const size_t count = line ? sizeof variants / sizeof *variants : sizeof wide / sizeof *wide;
        for (size_t v = 0; v < count; v++) {
            const char *keys = line ? variants[v] : wide[v];
            const struct walk walk = walk_case(b->name, keys, NULL);
            if (walk.fault[0]) fail_msg("%s %s: %s", b->name, keys, walk.fault);
        }
    }
}

/* Also problems without a case, with all keys at their defaults. */
TEST(every_problem_by_itself)
{
    assert_int_equal(setting_keys[SETTING_kind].family->n, problem_family.n);
    for (size_t i = 0; i < problem_family.n; i++) {
        const struct problem *problem = (const struct problem *)problem_family.members[i];
        struct walk walk = {.problem = problem, .sums = problem->least_dim > 1 ? 0.02 : 1e-12};
        struct error error;
        /* the key `kind` lists problems in the same order */
        assert_string_equal(problem->member.name,
                            setting_keys[SETTING_kind].family->members[i]->name);
        if (problem->filed) continue; /* it has no particles of its own */
        settings_init(&walk.settings);
        assert_int_equal(settings_set(&walk.settings, SETTING_kind, problem->member.name,
                                      SOURCE_USER, NULL, &error),
                         STATUS_OK);
        /* a gamma for which the problem has a reference solution */
        const bool flat = strcmp(problem->member.name, "rotation") == 0;
        assert_int_equal(settings_set(&walk.settings, SETTING_gamma,
                                      flat ? "2" : "1.6666666666666667", SOURCE_USER, NULL, &error),
                         STATUS_OK);
        walk_all(&walk, problem->least_dim);
        if (walk.fault[0]) fail_msg("%s: %s", problem->member.name, walk.fault);
        for (size_t j = 0; j < i; j++)
            assert_string_not_equal(problem->member.name, problem_family.members[j]->name);
        for (const struct functional *const *f = problem->functionals; *f; f++)
            assert_string_equal(problem_functional_name((*f)->name), (*f)->name);
    }
    assert_null(problem_functional_name("no_such"));
}

/* ---- planted faults ---- */

static const struct problem *tube, *gresho; /* the correct ones */

static enum status heavy(const struct prepared *p, const struct settings *settings,
                         struct initial *initial, struct error *error)
{
    const enum status status = tube->fill(p, settings, initial, error);
    for (size_t i = 0; !status && i < initial->n; i++) initial->m[i] *= 1 + 1e-9;
    return status;
}

static enum status one_too_far(const struct prepared *p, const struct settings *settings,
                               struct initial *initial, struct error *error)
{
    const enum status status = tube->fill(p, settings, initial, error);
    for (size_t i = 1; !status && i < initial->n; i++)
        if (initial->rho[i] != initial->rho[i - 1]) {
            initial->u[i - 1] = initial->u[i];
            break;
        }
    return status;
}

/* Rotates in the opposite direction, with the same sums. */
static enum status backwards(const struct prepared *p, const struct settings *settings,
                             struct initial *initial, struct error *error)
{
    const enum status status = gresho->fill(p, settings, initial, error);
    for (size_t i = 0; !status && i < initial->n; i++) initial->v[1][i] *= -1;
    return status;
}

static void boosted(const struct prepared *p, const double x[3], double t,
                    struct problem_state *state)
{
    tube->sample(p, x, t, state);
    state->v[0] += 1e-6;
}

static bool for_ever(const struct prepared *p, double t)
{
    (void)p, (void)t;
    return true;
}

static bool never(const struct prepared *p, double t)
{
    (void)p;
    return t == 0;
}

static enum status seeded(const struct prepared *p, const struct settings *settings,
                          struct initial *initial, struct error *error)
{
    const enum status status = tube->fill(p, settings, initial, error);
    if (!status) initial->x[0][0] += 1e-12 * settings_real(settings, SETTING_seed);
    return status;
}

static double energy_for_pressure(const struct prepared *p, const struct snapshot *s)
{
    return functional_window_mean(p, s, s->u);
}

static size_t nowhere(const struct prepared *p, const double x[3], double reach, double t)
{
    (void)p, (void)reach, (void)t;
    return x[0] > 0.3 ? 5 : 0;
}

TEST(planted_faults_are_found)
{
    static const struct problem_key twice[] = {{SETTING_left, ROLE_NEEDED},
                                               {SETTING_left, ROLE_NEEDED}},
                                    scheme[] = {{SETTING_eta, ROLE_OPTIONAL}};
    struct functional wrong = functional_mean_pressure;
    tube = (const struct problem *)family_find(&problem_family, "riemann");
    struct regions unnamed = *tube->regions;
    wrong.measure = energy_for_pressure;
    unnamed.at = nowhere;
    struct problem faulty[11];
    const char *const words[] = {"mass of",     "another state", "velocity",      "free for ever",
                                 "not free at", "seed changes",  "twice",         "not a problem's",
                                 "functional",  "no name",       "shock_position"};
    for (size_t i = 0; i < 11; i++) faulty[i] = *tube;
    faulty[0].fill = heavy;
    faulty[1].fill = one_too_far;
    faulty[2].sample = boosted;
    faulty[3].holds = for_ever;
    faulty[4].holds = never;
    faulty[5].fill = seeded;
    faulty[6].keys = twice, faulty[6].key_count = 2;
    faulty[7].keys = scheme, faulty[7].key_count = 1;
    faulty[8].functionals[1] = &wrong;
    faulty[9].regions = &unnamed;
    faulty[10].functionals[1] = tube->functionals[2];
    for (size_t i = 0; i < 11; i++) {
        const struct walk walk = walk_case("sod", "n=400", &faulty[i]);
        if (!strstr(walk.fault, words[i]))
            fail_msg("fault %zu ('%s' expected): '%s'", i, words[i], walk.fault);
    }
    gresho = (const struct problem *)family_find(&problem_family, "gresho");
    struct problem turned = *gresho, flat = *gresho;
    turned.fill = backwards;
    assert_non_null(strstr(walk_case("gresho", "n=400", &turned).fault, "another velocity"));
    struct problem expanding = *(const struct problem *)family_find(&problem_family, "rotation");
    expanding.steady = true;
    assert_non_null(strstr(walk_case("rotation", "n=400", &expanding).fault, "not steady"));
    flat.least_dim = flat.most_dim = 3;
    assert_non_null(strstr(walk_case("gresho", "n=400", &flat).fault, "no form in 2 dimensions"));
}
