/* SPDX-License-Identifier: GPL-3.0-or-later
 * Settings of a run: one typed table of keys (settings.def), the values given by a case or a user,
 * and the values that `auto` stands for. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "scheme.h"
#include "status.h"

enum setting {
#define KEY(name, ...) SETTING_##name,
#include "settings.def"
#undef KEY
    SETTINGS
};

/* COUNT: an integer that may be written as 64^2. PATH: the one file that a run may read. VECTOR,
 * CHOICES: one number or word per direction, or one for all directions. */
enum setting_type {
    SETTING_INTEGER,
    SETTING_COUNT,
    SETTING_REAL,
    SETTING_CHOICE,
    SETTING_REALS,
    SETTING_VECTOR,
    SETTING_CHOICES,
    SETTING_PATH
};
enum { SETTING_REALS_MAX = 3, SETTING_TEXT_MAX = 256 };

struct setting_key {
    const char *name, *section; /* section of a case file */
    enum setting_type type;
    int count;  /* numbers of REALS, most numbers of VECTOR and CHOICES, else 1 */
    bool above; /* lo itself is excluded */
    double lo, hi;
    const char *fallback;
    const struct family *family; /* for CHOICE and CHOICES */
    const char *unit, *meaning;
};

extern const struct setting_key setting_keys[SETTINGS];

enum setting_source { SOURCE_FALLBACK, SOURCE_CASE, SOURCE_USER };

struct setting_value {
    enum setting_source source;
    bool automatic;                 /* the value is `auto` */
    double real[SETTING_REALS_MAX]; /* INTEGER, COUNT, REAL: real[0] */
    int exponent;                   /* of a COUNT written as 64^2; 0: a plain number */
    int given;                      /* numbers in real, or choices; 0: a CHOICE */
    int choice;                     /* index in the family */
    int choices[SETTING_REALS_MAX]; /* for CHOICES */
};

struct settings {
    int dim;     /* of the case; 0: not yet known */
    bool shared; /* with other schemes or another code, so that no key is refused for having no
                    effect here */
    struct setting_value value[SETTINGS];
    char file[SETTING_TEXT_MAX]; /* value of the SETTING_PATH; "": none */
    int reference;               /* number of a user's solution (user_solution.h); 0: none */
};

enum lattice {
    LATTICE_UNIFORM, /* this and the next two: 1D only */
    LATTICE_CLUSTERED,
    LATTICE_COINCIDENT,
    LATTICE_SQUARE, /* 2D; the 3D form is called cubic */
    LATTICE_CUBIC,
    LATTICE_HEXAGONAL,
    LATTICE_FCC, /* this and the next: 3D only */
    LATTICE_BCC,
    LATTICE_JITTERED,
    LATTICE_RANDOM,
    LATTICE_GLASS,
    LATTICES
};
enum skip { SKIP_AUTO, SKIP_NONE };
enum parity { PARITY_SINUOUS, PARITY_VARICOSE };
extern const struct family settings_lattice_family, settings_skip_family;

/* Index of the key with this name, or -1. */
int setting_find(const char *name);

/* STATUS_BAD_INPUT: no key has this name; the message is that of text_unknown. */
enum status setting_unknown(const char *where, const char *name, struct error *error);

/* Describes the allowed values of a key: "an integer from 3 to 12", "one of a b c" ... */
void setting_allowed(const struct setting_key *key, char *text, size_t size);

/* Refuses a number of particles written as 64^3 if the case is not in 3D. exponent 0: a plain
 * number; dim 0: the dimension is not yet known. The message begins with `before` and text. */
enum status setting_check_power(const char *before, const char *text, int exponent, int dim,
                                struct error *error);

/* Sets every key to its default. */
void settings_init(struct settings *settings);

/* Parses text as the value of key. The message begins with where ("file:line", may be NULL). */
enum status settings_set(struct settings *settings, enum setting key, const char *text,
                         enum setting_source source, const char *where, struct error *error);

/* Applies KEY=VALUE arguments; the last value of a key counts. */
enum status settings_apply(struct settings *settings, int n, char *const *arguments,
                           struct error *error);

/* Applies KEY=VALUE words with blanks between them. */
enum status settings_apply_words(struct settings *settings, const char *words, struct error *error);

/* The scheme for the settings, checked in dim dimensions; sets the automatic keys of the scheme.
 * problem_prepare does so for the problem, run_resolve for both. STATUS_BAD_INPUT as by
 * settings_refuse_unused, unless the settings are shared. */
enum status settings_scheme(struct settings *settings, int dim, struct scheme *scheme,
                            struct error *error);

/* True if particles are displaced at random, so that the seed matters. */
bool settings_random_start(const struct settings *settings);

/* False if the value of another key leaves this one without effect: a parameter of another
 * viscosity, sinc_n of another kernel, balsara_floor without a factor, grade_ratio of equal masses,
 * seed of a start that is not random. Automatic keys must have their values. */
bool settings_uses(const struct settings *settings, enum setting key);

/* Removes the keys that `settings` uses from those of the user in `left`. Keys that remain after
 * all schemes of a sweep have no effect on any; settings_refuse_unused refuses them. */
void settings_take_used(const struct settings *settings, struct settings *left);

/* STATUS_BAD_INPUT: the user gave a key that has no effect by settings_uses(). */
enum status settings_refuse_unused(const struct settings *settings, struct error *error);

double settings_real(const struct settings *settings, enum setting key);

/* The value of a SETTING_VECTOR in one direction. */
double settings_along(const struct settings *settings, enum setting key, int direction);
int settings_choice(const struct settings *settings, enum setting key);
int settings_choice_along(const struct settings *settings, enum setting key, int direction);

/* The value as a user would type it, with full precision. */
void settings_text(const struct settings *settings, enum setting key, char text[SETTING_TEXT_MAX]);
