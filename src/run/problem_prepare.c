/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "problem_prepare.h"

#include <stdio.h>

#include "initial.h"
#include "problem_list.h"

static const enum setting vectors[] = {SETTING_lo,        SETTING_hi,      SETTING_boost,
                                       SETTING_direction, SETTING_gravity, SETTING_boundary};

/* Checks that vectors have one number, or one per direction. */
static enum status check_vectors(const struct settings *settings, int dim, struct error *error)
{
    for (size_t k = 0; k < sizeof vectors / sizeof *vectors; k++) {
        const int given = settings->value[vectors[k]].given;
        char text[SETTING_TEXT_MAX];
        if (given == 1 || given == dim) continue;
        settings_text(settings, vectors[k], text);
        return error_set(error, STATUS_BAD_INPUT,
                         "%s=\"%s\": one %s for all directions or one each is needed, and the "
                         "case has %d of them",
                         setting_keys[vectors[k]].name, text,
                         setting_keys[vectors[k]].family ? "word" : "number", dim);
    }
    return STATUS_OK;
}

static enum status check_box(const struct domain *domain, const struct settings *settings,
                             struct error *error)
{
    const double *window = settings->value[SETTING_window].real;
    for (int d = 0; d < domain->dim; d++)
        if (!(domain->lo[d] < domain->hi[d]))
            return error_set(error, STATUS_BAD_INPUT, "lo=%g hi=%g: lo < hi is needed",
                             domain->lo[d], domain->hi[d]);
    if (settings->value[SETTING_window].automatic ||
        (domain->lo[0] <= window[0] && window[0] < window[1] && window[1] <= domain->hi[0]))
        return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT,
                     "window=\"%g %g\": two rising numbers in the box [%g, %g] are needed",
                     window[0], window[1], domain->lo[0], domain->hi[0]);
}

/* Sets the boundaries of the box and checks that the problem allows them. */
static enum status choose_ends(struct prepared *p, struct settings *settings, struct error *error)
{
    const struct problem *problem = p->problem;
    struct setting_value *value = &settings->value[SETTING_boundary];
    const struct family *family = &scheme_boundary_family;
    bool alike = true;
    for (int d = 0; d < p->domain.dim; d++) {
        const struct problem_ends *ends = &problem->ends[d];
        const int asked = settings_choice_along(settings, SETTING_boundary, d);
        const unsigned allowed = ends->also | 1u << ends->usual;
        char names[80] = "";
        p->boundary[d] = value->automatic ? ends->usual : (enum boundary)asked;
        if (allowed & 1u << p->boundary[d]) continue;
        for (size_t k = 0, used = 0; k < family->n; k++)
            if (allowed & 1u << k)
                used += (size_t)snprintf(names + used, sizeof names - used, " %s",
                                         family->members[k]->name);
        return error_set(error, STATUS_BAD_INPUT,
                         "boundary=%s along %c and an initial state of kind %s exclude each other: "
                         "its solution would not hold; allowed:%s",
                         family->members[p->boundary[d]]->name, "xyz"[d], problem -> member.name,
                         names);
    }
    for (int d = 0; d < p->domain.dim; d++) {
        value->choices[d] = (int)p->boundary[d];
        alike &= p->boundary[d] == p->boundary[0];
    }
    value->given = alike ? 1 : p->domain.dim;
    for (int d = 0; d < p->domain.dim; d++)
        if (p->boost[d] != 0 && p->boundary[d] != BOUNDARY_PERIODIC)
            return error_set(error, STATUS_BAD_INPUT,
                             "boost=%g along %c and boundary=%s exclude each other: gas would be "
                             "carried out of the box",
                             p->boost[d], "xyz"[d], family -> members[p->boundary[d]] -> name);
    return STATUS_OK;
}

/* Sets gravity as asked; the problem may set an automatic one. */
static enum status choose_gravity(struct prepared *p, const struct settings *settings,
                                  struct error *error)
{
    if (settings->value[SETTING_gravity].automatic) return STATUS_OK;
    for (int d = 0; d < p->domain.dim; d++) {
        p->gravity[d] = settings_along(settings, SETTING_gravity, d);
        if (p->gravity[d] != 0 && !p->problem->heavy)
            return error_set(error, STATUS_BAD_INPUT,
                             "gravity=%g along %c and an initial state of kind %s exclude each "
                             "other: its solution knows no gravity",
                             p->gravity[d], "xyz"[d], p -> problem -> member.name);
    }
    return STATUS_OK;
}

/* Sets automatic shifting as the problem wishes; scheme_default checks what excludes it. */
static void choose_shifting(const struct prepared *p, struct settings *settings)
{
    struct setting_value *shifting = &settings->value[SETTING_shifting];
    if (!shifting->automatic) return;
    const bool wanted = p->problem->shifts || (p->problem->shifts_equal_masses &&
                                               settings_choice(settings, SETTING_equal_masses));
    bool closed = wanted && p->domain.dim > 1;
    for (int d = 0; d < p->domain.dim; d++)
        closed &= p->boundary[d] == BOUNDARY_PERIODIC || p->boundary[d] == BOUNDARY_REFLECTING;
    shifting->choice = closed ? SHIFTING_CLOSED : SHIFTING_NONE;
}

/* On for gas in 2D and 3D, off in 1D and for liquids; scheme_default handles schemes without
 * dissipation. Evaluations of other codes' particles have none unless asked. */
static void choose_conductivity(const struct prepared *p, struct settings *settings)
{
    struct setting_value *conductivity = &settings->value[SETTING_shock_conductivity];
    if (!conductivity->automatic) return;
    conductivity->real[0] = p->domain.dim > 1 && !p->problem->liquid ? 1 : 0;
}

/* Stores the values of automatic keys. */
static void write_back(const struct prepared *p, struct settings *settings)
{
    struct setting_value *gravity = &settings->value[SETTING_gravity];
    const double *g = p->gravity;
    gravity->given = g[0] == 0 && g[1] == 0 && g[2] == 0 ? 1 : p->domain.dim;
    for (int d = 0; d < gravity->given; d++) gravity->real[d] = g[d];
    settings->value[SETTING_window].real[0] = p->window.lo[0];
    settings->value[SETTING_window].real[1] = p->window.hi[0];
    settings->value[SETTING_window_radius].real[0] = p->window.radius;
}

/* Checks combinations of keys that do not belong to the problem. */
static enum status check_together(const struct prepared *p, const struct settings *settings,
                                  struct error *error)
{
    const struct problem *problem = p->problem;
    const int dim = p->domain.dim;
    if (!(dim >= problem->least_dim && dim <= problem->most_dim))
        return error_set(error, STATUS_BAD_INPUT,
                         "%s has no form in %d dimensions; allowed: %d to %d", problem->member.name,
                         dim, problem->least_dim, problem->most_dim);
    for (int i = 0; i < SETTINGS; i++) {
        if (settings->value[i].source != SOURCE_USER) continue;
        if (!problem_reads(problem, (enum setting)i))
            return error_set(error, STATUS_BAD_INPUT,
                             "key %s and an initial state of kind %s exclude each other: it has "
                             "no such thing",
                             setting_keys[i].name, problem->member.name);
        if (problem_foreign(settings, (enum setting)i))
            return error_set(error, STATUS_BAD_INPUT,
                             "key %s and dimension=%d exclude each other: it is for %s",
                             setting_keys[i].name, dim, dim > 1 ? "1" : "2 and 3");
    }
    if (check_vectors(settings, dim, error) || check_box(&p->domain, settings, error))
        return error->status;
    for (int d = 0; d < dim; d++)
        if (p->boost[d] != 0 && !problem->carried)
            return error_set(error, STATUS_BAD_INPUT,
                             "key boost and an initial state of kind %s exclude each other: it is "
                             "not periodic, and would be carried out of its window",
                             problem->member.name);
    return STATUS_OK;
}

bool problem_lays_particles(const struct problem *problem, enum setting key)
{
    for (size_t k = 0; k < problem->key_count; k++)
        if (problem->keys[k].key == key) return problem->keys[k].role == ROLE_PARTICLES;
    return key == SETTING_n || key == SETTING_lattice || key == SETTING_jitter ||
           key == SETTING_seed;
}

/* Particles of a file cannot be rearranged. */
static enum status check_file(const struct prepared *p, const struct settings *settings,
                              struct error *error)
{
    if (!settings->file[0]) return STATUS_OK;
    for (int i = 0; i < SETTINGS; i++)
        if (settings->value[i].source == SOURCE_USER &&
            problem_lays_particles(p->problem, (enum setting)i))
            return error_set(error, STATUS_BAD_INPUT,
                             "key %s and file=%.120s exclude each other: its particles are as they "
                             "are",
                             setting_keys[i].name, settings->file);
    return STATUS_OK;
}

/* Sets the default lattice and checks that the lattice exists in this dimension. */
static enum status choose_lattice(struct settings *settings, int dim, struct error *error)
{
    static const enum lattice usual[] = {LATTICE_UNIFORM, LATTICE_SQUARE, LATTICE_CUBIC};
    static const unsigned char dims[LATTICES] = {
        /* one bit per dimension */
        [LATTICE_UNIFORM] = 1, [LATTICE_CLUSTERED] = 1, [LATTICE_COINCIDENT] = 1,
        [LATTICE_SQUARE] = 2,  [LATTICE_CUBIC] = 4,     [LATTICE_HEXAGONAL] = 6,
        [LATTICE_FCC] = 4,     [LATTICE_BCC] = 4,       [LATTICE_JITTERED] = 6,
        [LATTICE_RANDOM] = 6,  [LATTICE_GLASS] = 6};
    struct setting_value *lattice = &settings->value[SETTING_lattice],
                         *jitter = &settings->value[SETTING_jitter];
    /* positions that follow the density cannot be on a lattice of one spacing */
    const bool follows = settings_choice(settings, SETTING_equal_masses) &&
                         problem_of(settings)->fill == initial_fill;
    if (lattice->automatic) lattice->choice = (int)(follows ? LATTICE_GLASS : usual[dim - 1]);
    if (jitter->automatic) jitter->real[0] = lattice->choice == LATTICE_JITTERED ? 0.2 : 0;
    if (follows && lattice->choice != LATTICE_GLASS && lattice->choice != LATTICE_RANDOM)
        return error_set(error, STATUS_BAD_INPUT,
                         "lattice=%s and equal_masses=yes exclude each other: particles of equal "
                         "masses stand closer where the gas is denser; allowed: glass random",
                         settings_lattice_family.members[lattice->choice]->name);
    if (dims[lattice->choice] & 1 << (dim - 1)) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT, "lattice=%s has no form in %d dimension%s",
                     settings_lattice_family.members[lattice->choice]->name, dim,
                     dim > 1 ? "s" : "");
}

static void set_domain(struct prepared *p, const struct settings *settings, int dim)
{
    p->domain.dim = p->window.dim = dim;
    for (int d = 0; d < dim; d++) {
        p->domain.lo[d] = p->window.lo[d] = settings_along(settings, SETTING_lo, d);
        p->domain.hi[d] = p->window.hi[d] = settings_along(settings, SETTING_hi, d);
        p->window.centre[d] = 0.5 * (p->domain.lo[d] + p->domain.hi[d]);
        p->boost[d] = settings_along(settings, SETTING_boost, d);
    }
    p->window.radius = settings_real(settings, SETTING_window_radius);
    if (settings->value[SETTING_window].automatic) return;
    p->window.lo[0] = settings->value[SETTING_window].real[0];
    p->window.hi[0] = settings->value[SETTING_window].real[1];
}

enum status problem_prepare_as(struct prepared *p, const struct problem *problem,
                               struct settings *settings, int dim, struct error *error)
{
    *p = (struct prepared){.problem = problem,
                           .walled = problem->liquid,
                           .gamma = settings_real(settings, SETTING_gamma)};
    settings->dim = dim;
    set_domain(p, settings, dim);
    if (check_together(p, settings, error) || check_file(p, settings, error) ||
        choose_lattice(settings, dim, error) || choose_ends(p, settings, error) ||
        choose_gravity(p, settings, error) || problem->prepare(p, settings, error))
        return error->status;
    choose_shifting(p, settings);
    choose_conductivity(p, settings);
    write_back(p, settings);
    return STATUS_OK;
}

enum status problem_prepare(struct prepared *p, struct settings *settings, int dim,
                            struct error *error)
{
    return problem_prepare_as(p, problem_of(settings), settings, dim, error);
}
