/* SPDX-License-Identifier: GPL-3.0-or-later
 * Settings of a run: one typed table of keys (settings.def), the values a case or a user gave, and
 * what `auto` stands for. */
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

/* COUNT: an integer that may be written 64^2. PATH: of the one file that a run may read. VECTOR,
 * CHOICES: one number or word for each direction, or one for all. */
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
    int count;  /* numbers of a SETTING_REALS, at most of VECTOR and CHOICES, else 1 */
    bool above; /* lo itself is not allowed */
    double lo, hi;
    const char *fallback;
    const struct family *family; /* of CHOICE and CHOICES */
    const char *unit, *meaning;
};

extern const struct setting_key setting_keys[SETTINGS];

enum setting_source { SOURCE_FALLBACK, SOURCE_CASE, SOURCE_USER };

struct setting_value {
    enum setting_source source;
    bool automatic;                 /* the user, the case or the fallback says auto */
    double real[SETTING_REALS_MAX]; /* INTEGER, COUNT, REAL: real[0] */
    int exponent;                   /* of a COUNT that was written as 64^2; 0: a plain number */
    int given;                      /* numbers in real, or choices; 0: a CHOICE */
    int choice;                     /* position in the family */
    int choices[SETTING_REALS_MAX]; /* of CHOICES */
};

struct settings {
    int dim; /* of the case; 0: not known yet */
    struct setting_value value[SETTINGS];
    char file[SETTING_TEXT_MAX]; /* the SETTING_PATH; "": none */
    int reference;               /* own_reference.h's number of a user's solution; 0: none */
};

enum lattice {
    LATTICE_UNIFORM, /* these three in 1D only */
    LATTICE_CLUSTERED,
    LATTICE_COINCIDENT,
    LATTICE_SQUARE, /* 2D; its form in 3D is called cubic */
    LATTICE_CUBIC,
    LATTICE_HEXAGONAL,
    LATTICE_FCC, /* these two in 3D only */
    LATTICE_BCC,
    LATTICE_JITTERED,
    LATTICE_RANDOM,
    LATTICE_GLASS,
    LATTICES
};
enum skip { SKIP_AUTO, SKIP_NONE };
enum parity { PARITY_SINUOUS, PARITY_VARICOSE };
extern const struct family settings_lattice_family, settings_skip_family;

/* Position of the key called name, or -1. */
int setting_find(const char *name);

/* "an integer from 3 to 12", "one of a b c" ...: what a value of this key may be. */
void setting_allowed(const struct setting_key *key, char *text, size_t size);

/* Refuses a number of particles that is written as 64^3 where the case has another dimension than
 * 3; exponent 0 stands for a plain number, dim 0 for a dimension that is not known yet. The message
 * begins with `before` and the text. */
enum status setting_check_power(const char *before, const char *text, int exponent, int dim,
                                struct error *error);

/* Everything at its fallback. */
void settings_init(struct settings *settings);

/* Reads text as the value of key. where (may be NULL) opens the message: "file:line". */
enum status settings_set(struct settings *settings, enum setting key, const char *text,
                         enum setting_source source, const char *where, struct error *error);

/* Applies KEY=VALUE arguments; of a key given twice the last value counts. */
enum status settings_apply(struct settings *settings, int n, char *const *arguments,
                           struct error *error);

/* The scheme that the keys stand for, checked in dim dimensions; its keys that are `auto` get their
 * values. (Those of the problem: problem_prepare. Both: run_resolve.) */
enum status settings_scheme(struct settings *settings, int dim, struct scheme *scheme,
                            struct error *error);

double settings_real(const struct settings *settings, enum setting key);

/* The number of a SETTING_VECTOR for a direction: its own, or the one that all have. */
double settings_along(const struct settings *settings, enum setting key, int direction);
int settings_choice(const struct settings *settings, enum setting key);
int settings_choice_along(const struct settings *settings, enum setting key, int direction);

/* The value as one would type it, full precision. */
void settings_text(const struct settings *settings, enum setting key, char text[SETTING_TEXT_MAX]);
