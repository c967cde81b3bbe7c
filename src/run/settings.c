/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "settings.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "plugin_kernel.h"
#include "integrator.h"
#include "text.h"
#include "viscosity.h"

#define MEMBERS(...)                                                                               \
    (const struct member *const[])                                                                 \
    {                                                                                              \
        __VA_ARGS__                                                                                \
    }
#define MEMBER(name, label, paper)                                                                 \
    &(const struct member)                                                                         \
    {                                                                                              \
        name, label, paper                                                                         \
    }

const struct family settings_lattice_family = {
    "lattices", "where particles start",
    MEMBERS(MEMBER("uniform", "1D: the centre of each particle's share of the gas", ""),
            MEMBER("clustered", "1D: in pairs, a tenth of the spacing apart", ""),
            MEMBER("coincident", "1D: in pairs at one place", ""),
            MEMBER("square", "2D: square lattice", "Kittel 2005"),
            MEMBER("cubic", "3D: simple cubic lattice", "Kittel 2005"),
            MEMBER("hexagonal", "2D, 3D: closest packing, in layers", "Kittel 2005"),
            MEMBER("fcc", "3D: face-centred cubic lattice", "Kittel 2005"),
            MEMBER("bcc", "3D: body-centred cubic lattice", "Kittel 2005"),
            MEMBER("jittered", "2D, 3D: square or cubic, each particle displaced at random", ""),
            MEMBER("random", "2D, 3D: quasi-random points", "Sobol 1967"),
            MEMBER("glass", "2D, 3D: random points that have pushed each other apart",
                   "Diehl et al. 2015")),
    LATTICES};
/* The choices of the key `kind`; problem_list.c maps them to problems. */
static const struct member *const kinds[] = {
#define PROBLEM(name) &(const struct member){#name, "", ""},
#include "problems.def"
#undef PROBLEM
};
static const struct family kind_family = {"problems", "initial states", kinds,
                                          sizeof kinds / sizeof *kinds};
static const struct family answer_family = {
    "answers", "no or yes", MEMBERS(MEMBER("no", "", ""), MEMBER("yes", "", "")), 2};
static const struct family parity_family = {
    "parities", "modes of a periodic shear layer",
    MEMBERS(MEMBER("sinuous", "the streams are displaced as a whole", "Drazin & Reid 1981"),
            MEMBER("varicose", "the streams get thinner and thicker", "Drazin & Reid 1981")),
    2};
const struct family settings_skip_family = {
    "skips", "work left out",
    MEMBERS(MEMBER("auto", "what no signal has reached, where the result allows it", ""),
            MEMBER("none", "every particle at every step", "")),
    2};

#define INTEGER    SETTING_INTEGER, 1
#define COUNT      SETTING_COUNT, 1
#define REAL       SETTING_REAL, 1
#define CHOICE     SETTING_CHOICE, 1
#define REALS(n)   SETTING_REALS, n
#define VECTOR     SETTING_VECTOR, SETTING_REALS_MAX
#define PATH       SETTING_PATH, 0
#define CHOICES    SETTING_CHOICES, SETTING_REALS_MAX
#define FROM(...)  false, __VA_ARGS__
#define ABOVE(...) true, __VA_ARGS__
const struct setting_key setting_keys[SETTINGS] = {
#define KEY(name, section, ...) {#name, section, __VA_ARGS__},
#include "settings.def"
#undef KEY
};

int setting_find(const char *name)
{
    for (int i = 0; i < SETTINGS; i++)
        if (strcmp(setting_keys[i].name, name) == 0) return i;
    return -1;
}

static bool may_be_auto(const struct setting_key *key)
{
    return strcmp(key->fallback, "auto") == 0 && key->family != &settings_skip_family;
}

void setting_allowed(const struct setting_key *key, char *text, size_t size)
{
    char what[24] = "a number";
    if (key->type == SETTING_INTEGER) snprintf(what, sizeof what, "an integer");
    if (key->type == SETTING_COUNT) snprintf(what, sizeof what, "an integer, or 64^2,");
    if (key->type == SETTING_REALS) snprintf(what, sizeof what, "%d numbers", key->count);
    if (key->type == SETTING_PATH) {
        snprintf(text, size, "the path of a file, of up to %d characters; nothing: no file",
                 SETTING_TEXT_MAX - 1);
        return;
    }
    if (key->type == SETTING_VECTOR) snprintf(what, sizeof what, "1, 2 or 3 numbers");
    if (key->type == SETTING_CHOICE || key->type == SETTING_CHOICES) {
        size_t used = (size_t)snprintf(text, size, "%s%s",
                                       key->type == SETTING_CHOICE ? "one of" : "1, 2 or 3 of",
                                       may_be_auto(key) ? " auto" : "");
        for (size_t i = 0; i < key->family->n && used < size; i++)
            used +=
                (size_t)snprintf(text + used, size - used, " %s", key->family->members[i]->name);
        if (used >= size && size > 4) memcpy(text + size - 5, " ...", 5); /* marks the truncation */
        return;
    }
    const bool tuple = key->type == SETTING_REALS;
    snprintf(text, size, "%s%s%s%s %s %.10g %s %.10g%s", what, tuple ? " (" : "",
             tuple ? key->unit : "", tuple ? ")" : "", key->above ? "above" : "from", key->lo,
             key->above ? "up to" : "to", key->hi, may_be_auto(key) ? ", or auto" : "");
}

void settings_init(struct settings *settings)
{
    struct error error;
    *settings = (struct settings){0};
    for (int i = 0; i < SETTINGS; i++)
        settings_set(settings, (enum setting)i, setting_keys[i].fallback, SOURCE_FALLBACK, NULL,
                     &error);
}

static enum status refuse(struct error *error, const char *where, const struct setting_key *key,
                          const char *text)
{
    char allowed[300], shown[64];
    text_printable(text, shown, sizeof shown);
    setting_allowed(key, allowed, sizeof allowed);
    return error_set(error, STATUS_BAD_INPUT, "%s%s%s=%s: allowed: %s", where ? where : "",
                     where ? ": " : "", key->name, shown, allowed);
}

enum status setting_check_power(const char *before, const char *text, int exponent, int dim,
                                struct error *error)
{
    if (exponent == 0 || dim < 2 || exponent == dim) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT,
                     "%s%.40s: the case has %d dimensions; allowed: %.*s^%d, or the number of all "
                     "particles",
                     before, text, dim, (int)strcspn(text, "^"), text, dim);
}

static bool in_range(const struct setting_key *key, double value)
{
    return (key->above ? value > key->lo : value >= key->lo) && value <= key->hi;
}

/* Lists the members of the family, and auto if allowed. */
static enum status unknown_choice(const struct setting_key *key, const char *where,
                                  const char *word, struct error *error)
{
    const char *names[64];
    size_t n = 0;
    if (may_be_auto(key)) names[n++] = "auto";
    for (size_t i = 0; i < key->family->n && n < sizeof names / sizeof *names; i++)
        names[n++] = key->family->members[i]->name;
    return text_unknown(error, where, key->name, word, names, n);
}

/* Sets given to 0 if there are no words or too many. */
static enum status read_choices(const struct setting_key *key, const char *text, const char *where,
                                struct setting_value *value, struct error *error)
{
    char words[SETTING_TEXT_MAX], *rest = words;
    const int length = snprintf(words, sizeof words, "%s", text);
    value->given = 0;
    for (char *word; length < SETTING_TEXT_MAX && (word = strtok_r(rest, " \t,", &rest));) {
        const int choice = family_index(key->family, word);
        if (choice < 0) return unknown_choice(key, where, word, error);
        if (value->given == key->count) {
            value->given = 0;
            return STATUS_OK;
        }
        value->choices[value->given++] = choice;
    }
    return STATUS_OK;
}

static enum status read_choice(enum setting which, const char *text, const char *where, int *choice,
                               struct error *error)
{
    const struct setting_key *key = &setting_keys[which];
    if (which == SETTING_kernel && plugin_is_path(text)) {
        struct error reason;
        if (!plugin_find(text, choice, &reason)) return STATUS_OK;
        return error_set(error, reason.status, "%s%s%s", where ? where : "", where ? ": " : "",
                         reason.message);
    }
    *choice = family_index(key->family, text);
    return *choice < 0 ? unknown_choice(key, where, text, error) : STATUS_OK;
}

/* A vector takes as many numbers as the text has. */
static bool read_numbers(const struct setting_key *key, const char *text,
                         struct setting_value *value)
{
    switch (key->type) {
    case SETTING_COUNT:
        return text_count(text, &value->real[0], &value->exponent);
    case SETTING_INTEGER:
        return text_integer(text, &value->real[0]);
    case SETTING_REAL:
        return text_real(text, &value->real[0]);
    case SETTING_REALS:
        return text_reals(text, " \t,", (size_t)key->count, value->real);
    default:
        for (value->given = 1; value->given <= key->count; value->given++)
            if (text_reals(text, " \t,", (size_t)value->given, value->real)) return true;
        return false;
    }
}

enum status settings_set(struct settings *settings, enum setting which, const char *text,
                         enum setting_source source, const char *where, struct error *error)
{
    const struct setting_key *key = &setting_keys[which];
    struct setting_value value = {.source = source, .given = key->count};
    bool good = false;
    if (may_be_auto(key) && strcmp(text, "auto") == 0) {
        value.automatic = true;
        if (key->family || key->type == SETTING_VECTOR) value.given = key->type != SETTING_CHOICE;
        settings->value[which] = value;
        return STATUS_OK;
    }
    switch (key->type) {
    case SETTING_CHOICE:
        if (read_choice(which, text, where, &value.choice, error)) return error->status;
        value.given = 0;
        good = true;
        break;
    case SETTING_PATH:
        good = strlen(text) < sizeof settings->file;
        if (good) snprintf(settings->file, sizeof settings->file, "%s", text);
        break;
    case SETTING_CHOICES:
        if (read_choices(key, text, where, &value, error)) return error->status;
        good = value.given > 0;
        break;
    default:
        good = read_numbers(key, text, &value);
    }
    for (int i = 0; i < value.given && good && !key->family; i++)
        good = in_range(key, value.real[i]);
    if (!good) return refuse(error, where, key, text);
    if (value.exponent) {
        char name[80];
        snprintf(name, sizeof name, "%s%s%s=", where ? where : "", where ? ": " : "", key->name);
        if (setting_check_power(name, text, value.exponent, settings->dim, error))
            return error->status;
    }
    settings->value[which] = value;
    return STATUS_OK;
}

enum status setting_unknown(const char *where, const char *word, struct error *error)
{
    const char *names[SETTINGS];
    for (int i = 0; i < SETTINGS; i++) names[i] = setting_keys[i].name;
    return text_unknown(error, where, "key", word, names, SETTINGS);
}

enum status settings_apply(struct settings *settings, int n, char *const *arguments,
                           struct error *error)
{
    for (int i = 0; i < n; i++) {
        char name[64];
        const char *equals = strchr(arguments[i], '=');
        if (!equals)
            return error_set(error, STATUS_BAD_INPUT,
                             "'%.60s': KEY=VALUE expected (`sphproof list keys` shows the keys)",
                             arguments[i]);
        snprintf(name, sizeof name, "%.*s", (int)(equals - arguments[i]), arguments[i]);
        const int key = setting_find(name);
        if (key < 0) return setting_unknown(NULL, name, error);
        if (settings_set(settings, (enum setting)key, equals + 1, SOURCE_USER, NULL, error))
            return error->status;
    }
    return STATUS_OK;
}

enum status settings_apply_words(struct settings *settings, const char *words, struct error *error)
{
    char *text = strdup(words), *rest = text;
    enum status status = text ? STATUS_OK : error_set(error, STATUS_ENVIRONMENT, "no memory");
    for (char *word; !status && (word = strtok_r(rest, " ", &rest));)
        status = settings_apply(settings, 1, &word, error);
    free(text);
    return status;
}

double settings_real(const struct settings *settings, enum setting key)
{
    return settings->value[key].real[0];
}

double settings_along(const struct settings *settings, enum setting key, int direction)
{
    const struct setting_value *value = &settings->value[key];
    return value->real[value->given > 1 ? direction : 0];
}

int settings_choice(const struct settings *settings, enum setting key)
{
    return settings->value[key].choice;
}

int settings_choice_along(const struct settings *settings, enum setting key, int direction)
{
    const struct setting_value *value = &settings->value[key];
    return value->choices[value->given > 1 ? direction : 0];
}

static bool has_parameter(int viscosity, enum setting key)
{
    const char *parameters = viscosity_of[viscosity].parameters, *name = setting_keys[key].name;
    const size_t length = strlen(name);
    for (const char *at = parameters; (at = strstr(at, name)); at += length)
        if ((at == parameters || at[-1] == ' ') && (at[length] == ' ' || !at[length])) return true;
    return false;
}

/* The key whose value decides whether a key is read; 0: none. */
static const enum setting decided_by[SETTINGS] = {
    [SETTING_sinc_n] = SETTING_kernel,         [SETTING_alpha] = SETTING_viscosity,
    [SETTING_beta] = SETTING_viscosity,        [SETTING_alpha_min] = SETTING_viscosity,
    [SETTING_alpha_max] = SETTING_viscosity,   [SETTING_noise] = SETTING_viscosity,
    [SETTING_balsara] = SETTING_viscosity,     [SETTING_viscosity_form] = SETTING_viscosity,
    [SETTING_balsara_floor] = SETTING_balsara, [SETTING_grade_ratio] = SETTING_grade,
    [SETTING_seed] = SETTING_lattice};

/* True if the key is read with this choice of the key that decides. */
static bool is_read_with(enum setting key, int choice)
{
    switch (decided_by[key]) {
    case SETTING_kernel:
        return strcmp(kernel_family.members[choice]->name, "sinc") == 0;
    case SETTING_viscosity:
        return has_parameter(choice, key);
    case SETTING_lattice:
        return choice >= LATTICE_JITTERED;
    default:
        return choice == BALSARA_ON;
    }
}

bool settings_random_start(const struct settings *settings)
{
    const enum lattice lattice = (enum lattice)settings_choice(settings, SETTING_lattice);
    const bool jittered = lattice == LATTICE_JITTERED && settings->value[SETTING_jitter].automatic;
    return !settings->file[0] && (settings_real(settings, SETTING_jitter) > 0 || jittered ||
                                  lattice == LATTICE_RANDOM || lattice == LATTICE_GLASS);
}

bool settings_uses(const struct settings *settings, enum setting key)
{
    const enum setting other = decided_by[key];
    if (!other) return true;
    if (other == SETTING_grade) return settings_real(settings, SETTING_grade) < 1;
    if (other == SETTING_lattice) return settings_random_start(settings);
    return settings_uses(settings, other) && is_read_with(key, settings_choice(settings, other));
}

void settings_take_used(const struct settings *settings, struct settings *left)
{
    for (int key = 0; key < SETTINGS; key++)
        if (settings_uses(settings, (enum setting)key)) left->value[key].source = SOURCE_CASE;
}

enum status settings_refuse_unused(const struct settings *settings, struct error *error)
{
    for (int i = 0; i < SETTINGS; i++) {
        const enum setting key = (enum setting)i;
        enum setting idle = key; /* the key itself, or an unused key that it depends on */
        if (settings->value[key].source != SOURCE_USER || settings_uses(settings, key)) continue;
        while (!settings_uses(settings, decided_by[idle])) idle = decided_by[idle];
        const enum setting other = decided_by[idle];
        char given[SETTING_TEXT_MAX], excludes[SETTING_TEXT_MAX], allowed[SETTING_TEXT_MAX] = "";
        const struct family *family = setting_keys[other].family;
        size_t used = 0;
        settings_text(settings, key, given);
        settings_text(settings, other, excludes);
        if (!family) snprintf(allowed, sizeof allowed, " below 1");
        for (int k = 0; family && k < (int)family->n && used < sizeof allowed; k++)
            if (is_read_with(idle, k))
                used += (size_t)snprintf(allowed + used, sizeof allowed - used, " %s",
                                         family->members[k]->name);
        return error_set(error, STATUS_BAD_INPUT,
                         "%s=%.40s and %s=%.80s exclude each other: %s needs %s%s%s",
                         setting_keys[key].name, given, setting_keys[other].name, excludes,
                         setting_keys[key].name, setting_keys[other].name, allowed,
                         key == SETTING_seed ? ", or jitter above 0" : "");
    }
    return STATUS_OK;
}

/* Members of the scheme that have the name of their key; OPEN: those that may be automatic. */
#define OPEN_CHOICES(X)                                                                            \
    X(gradient)                                                                                    \
    X(volume_element)                                                                              \
    X(viscosity)                                                                                   \
    X(viscosity_form) X(balsara) X(energy) X(pair_width) X(h_method) X(shifting)
#define OPEN_NUMBERS(X) X(eta) X(alpha) X(beta) X(cfl) X(shock_conductivity)
#define NUMBERS(X)      X(alpha_min) X(alpha_max) X(balsara_floor) X(noise) X(alpha_u) X(h_tolerance)

/* Reads the keys of the scheme; open: marks the automatic choices. */
static enum status read_scheme(const struct settings *settings, int dim, struct scheme *scheme,
                               struct scheme_open *open, struct error *error)
{
#define CHOICE_OF(key)   settings_choice(settings, SETTING_##key)
#define READ_CHOICE(key) .key = (enum key)CHOICE_OF(key),
#define READ_NUMBER(key) .key = settings_real(settings, SETTING_##key),
#define IS_OPEN(key)     .key = settings->value[SETTING_##key].automatic,
    const struct member *integrator = integrator_family.members[CHOICE_OF(integrator)];
    *scheme =
        (struct scheme){.formulation = (enum formulation)CHOICE_OF(formulation),
                        .steps = (enum time_steps)CHOICE_OF(steps),
                        .integrator = (const struct integrator *)integrator,
                        OPEN_CHOICES(READ_CHOICE) OPEN_NUMBERS(READ_NUMBER) NUMBERS(READ_NUMBER)};
    *open = (struct scheme_open){IS_OPEN(kernel) OPEN_CHOICES(IS_OPEN) OPEN_NUMBERS(IS_OPEN)};
    return plugin_select(&scheme->kernel, CHOICE_OF(kernel),
                         (int)settings_real(settings, SETTING_sinc_n), dim, error);
}

/* Stores the values of automatic keys. */
static void write_scheme(struct settings *settings, const struct scheme *scheme)
{
#define WRITE_CHOICE(key) settings->value[SETTING_##key].choice = (int)scheme->key;
#define WRITE_NUMBER(key) settings->value[SETTING_##key].real[0] = scheme->key;
    settings->value[SETTING_kernel].choice = kernel_index(scheme->kernel.member.name);
    OPEN_CHOICES(WRITE_CHOICE)
    OPEN_NUMBERS(WRITE_NUMBER)
}

enum status settings_scheme(struct settings *settings, int dim, struct scheme *scheme,
                            struct error *error)
{
    struct scheme_open open;
    if (read_scheme(settings, dim, scheme, &open, error)) return error->status;
    scheme_default(scheme, &open, dim);
    write_scheme(settings, scheme);
    const enum status status = scheme_check(scheme, dim, error);
    return status || settings->shared ? status : settings_refuse_unused(settings, error);
}

void settings_text(const struct settings *settings, enum setting which, char text[SETTING_TEXT_MAX])
{
    const struct setting_key *key = &setting_keys[which];
    const struct setting_value *value = &settings->value[which];
    if (key->type == SETTING_CHOICE) {
        snprintf(text, SETTING_TEXT_MAX, "%s", key->family->members[value->choice]->name);
        return;
    }
    int used =
        snprintf(text, SETTING_TEXT_MAX, "%s", key->type == SETTING_PATH ? settings->file : "");
    for (int i = 0; i < value->given; i++) {
        char number[32];
        if (key->family) {
            used += snprintf(text + used, (size_t)(SETTING_TEXT_MAX - used), "%s%s", i ? " " : "",
                             key->family->members[value->choices[i]]->name);
            continue;
        }
        /* the shortest text that reads back as the same number */
        for (int digits = 6; digits <= 17; digits++) {
            double back = NAN;
            snprintf(number, sizeof number, "%.*g", digits, value->real[i]);
            if (text_real(number, &back) && back == value->real[i]) break;
        }
        used +=
            snprintf(text + used, (size_t)(SETTING_TEXT_MAX - used), "%s%s", i ? " " : "", number);
    }
}
