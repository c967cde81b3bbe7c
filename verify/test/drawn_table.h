/* SPDX-License-Identifier: GPL-3.0-or-later
 * Writes text tables with random columns in every style, and tests what readers find in them.
 * Include after test.h. */
#pragma once

#include "draw.h"
#include "expected_snapshot.h"

enum { ROWS = 9, TEXT_MAX = 1 << 15, TYPE = SNAPSHOT_COLUMNS, OTHER };

struct table {
    size_t columns;
    int meaning[SNAPSHOT_COLUMNS + 3];
    char name[SNAPSHOT_COLUMNS + 3][40];
    double value[SNAPSHOT_COLUMNS + 3][ROWS];
    /* the style */
    char separator, exponent;
    bool splash, wide, plus, returns, mark, comments, open_end, saved; /* saved: by numpy */
    char head[1400];
};

/* Spellings of the columns' names in use. */
__attribute__((unused)) static const char *const spelt[SNAPSHOT_COLUMNS][7] = {
    {"x", "X", "pos_x", "Position x", "coordinates", "Pos", "position-x"},
    {"y", "Y", "pos_y", "PositionY", "Coordinates y", "posy", "Y"},
    {"z", "Z", "pos_z", "Position.Z", "coordinatesz", "posz", "Z"},
    {"vx", "v_x", "v", "Velocity", "velocities_x", "VelX", "velocity x"},
    {"vy", "v_y", "VY", "Velocity_y", "velocities_y", "VelY", "velocity y"},
    {"vz", "v_z", "VZ", "Velocity_z", "velocities_z", "VelZ", "velocity z"},
    {"m", "M", "mass", "Masses", "particle mass", "pmass", "Mass"},
    {"rho", "Rho", "density", "Densities", "dens", "RHO", "Density"},
    {"u", "U", "utherm", "internal energy", "InternalEnergies", "specific_internal_energy",
     "energy"},
    {"P", "p", "pressure", "Pressures", "pres", "Pressure", "pres"},
    {"h", "H", "hsml", "smoothing length", "SmoothingLengths", "Hsml", "h"},
    {"ax", "a_x", "acc_x", "acceleration x", "Acceleration", "Accelerations", "acc"},
    {"ay", "a_y", "acc_y", "acceleration y", "accelerations_y", "accy", "AY"},
    {"az", "a_z", "acc_z", "acceleration z", "accelerations_z", "accz", "AZ"},
    {"du", "du/dt", "dudt", "DU", "du_dt", "udot", "RateOfChangeOfInternalEnergy"}};

static inline struct table table_of(int dim, bool all)
{
    struct table t = {.separator = ',', .exponent = 'e'};
    for (int c = 0; c < OTHER + 1; c++) {
        const int axis = c < SNAPSHOT_M                        ? c % 3
                         : c >= SNAPSHOT_AX && c < SNAPSHOT_DU ? c - SNAPSHOT_AX
                                                               : 0;
        const bool optional = c >= SNAPSHOT_P;
        if (axis >= dim || (optional && !all && drawn(2))) continue;
        t.meaning[t.columns] = c;
        snprintf(t.name[t.columns], sizeof t.name[0], "%s",
                 c < SNAPSHOT_COLUMNS ? snapshot_column_names[c]
                 : c == TYPE          ? "itype"
                                      : "entropy");
        for (int i = 0; i < ROWS; i++) {
            const bool positive = c >= SNAPSHOT_M && c <= SNAPSHOT_H;
            const double value = ldexp(draw(1, 2), c < 3 ? (int)drawn(8) : (int)drawn(60) - 30);
            t.value[t.columns][i] = c == TYPE ? (drawn(2) ? 1 : (double)drawn(6) - 2)
                                              : (positive || drawn(2) ? value : -value);
        }
        t.columns++;
    }
    return t;
}

static inline void shuffle(struct table *t)
{
    for (size_t k = t->columns; k > 1; k--) {
        const size_t j = drawn((unsigned)k);
        struct table old = *t;
        t->meaning[k - 1] = old.meaning[j], t->meaning[j] = old.meaning[k - 1];
        memcpy(t->name[k - 1], old.name[j], sizeof old.name[0]);
        memcpy(t->name[j], old.name[k - 1], sizeof old.name[0]);
        memcpy(t->value[k - 1], old.value[j], sizeof old.value[0]);
        memcpy(t->value[j], old.value[k - 1], sizeof old.value[0]);
    }
}

static inline void random_style(struct table *t)
{
    t->separator = ",; "[drawn(3)];
    t->exponent = "eEdD"[drawn(4)];
    t->wide = drawn(2), t->plus = drawn(2), t->returns = drawn(2), t->mark = drawn(2);
    t->comments = drawn(2), t->open_end = drawn(2), t->saved = drawn(2);
}

static size_t put_number(char *text, const struct table *t, double value)
{
    char number[40];
    snprintf(number, sizeof number, t->plus ? "%+.16e" : "%.16e", value);
    *strchr(number, 'e') = t->exponent;
    return (size_t)sprintf(text, "%s", number);
}

/* Writes the table row by row; `word`, if given, replaces the number at (row, column). */
static size_t text_of(const struct table *t, char *text, int row, int column, const char *word)
{
    const char *end = t->returns ? "\r\n" : "\n", *gap = t->wide ? " \t " : "";
    char *at = text;
    if (t->mark && !t->splash) at += sprintf(at, "\xef\xbb\xbf");
    at += sprintf(at, "%s", t->head);
    if (t->comments && !t->splash) at += sprintf(at, "%s# a comment%s%s", gap, end, end);
    if (t->saved || t->splash) at += sprintf(at, "#");
    for (size_t c = 0; c < t->columns; c++)
        at += sprintf(at, "%s%s%s%.1s", t->splash ? "  " : gap, t->name[c], t->splash ? "" : gap,
                      c + 1 < t->columns && !t->splash ? &t->separator : "");
    at += sprintf(at, "%s", end);
    for (int i = 0; i < ROWS; i++) {
        if (t->comments && i % 3 == 1) at += sprintf(at, "%s%s# more%s", gap, end, end);
        for (size_t c = 0; c < t->columns; c++) {
            at += sprintf(at, "%s", gap);
            at += i == row && (int)c == column ? (size_t)sprintf(at, "%s", word)
                                               : put_number(at, t, t->value[c][i]);
            at += sprintf(at, "%s%.1s", gap, c + 1 < t->columns ? &t->separator : "");
        }
        if (i + 1 < ROWS || !t->open_end) at += sprintf(at, "%s", end);
    }
    return (size_t)(at - text);
}

static void is_read(const struct table *t, const struct snapshot_file *file)
{
    size_t order[ROWS], n = 0, gas = ROWS, columns = 0;
    const double *type = NULL;
    for (size_t c = 0; c < t->columns; c++)
        if (t->meaning[c] == TYPE) type = t->value[c];
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < ROWS; i++)
            if (!type ? !pass : (type[i] == 1) == !pass) order[n++] = i;
        if (!pass) gas = n;
    }
    assert_int_equal(file->n, ROWS);
    assert_int_equal(file->gas, gas);
    for (size_t c = 0; c < t->columns; c++) {
        if (t->meaning[c] >= SNAPSHOT_COLUMNS) continue;
        columns++;
        assert_non_null(file->column[t->meaning[c]]);
        for (size_t i = 0; i < ROWS; i++)
            if (file->column[t->meaning[c]][i] != t->value[c][order[i]])
                fail_msg("%s of %zu: %.17g", t->name[c], i, file->column[t->meaning[c]][i]);
    }
    for (int c = 0; c < SNAPSHOT_COLUMNS; c++) columns -= file->column[c] != NULL;
    assert_int_equal(columns, 0);
    assert_true(file->precision[0] < 1.2e-16 && file->precision[1] < 1.2e-16);
}

/* What is read of a text; the caller frees it. */
static inline struct snapshot_file file_of(const char *text, size_t size, const char *map)
{
    const struct snapshot_options options = {.map = map};
    struct snapshot_file file;
    struct error error = {0};
    put_bytes("a.txt", text, size);
    if (snapshot_read(path_of("a.txt"), &options, &file, &error))
        fail_msg("%s\n%s", error.message, text);
    return file;
}

static inline struct snapshot_file reads(const struct table *t, const char *map)
{
    static char text[TEXT_MAX];
    struct snapshot_file file = file_of(text, text_of(t, text, -1, -1, NULL), map);
    is_read(t, &file);
    return file;
}

static inline bool refuses(const char *text, size_t size, const char *map, const char *says)
{
    const struct snapshot_options options = {.map = map};
    put_bytes("a.txt", text, size);
    return is_refused("a.txt", &options, text, says);
}
