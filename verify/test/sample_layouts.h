/* SPDX-License-Identifier: GPL-3.0-or-later
 * All items that each HDF5 layout may hold, and what a reader must find. Include after cmocka.h and
 * where HAVE_HDF5 is defined. */
#pragma once

#include "expected_snapshot.h"
#include "sample_hdf5.h"
#include "snapshot_file.h"

enum { N = 12, ITEMS_MAX = 40 };

/* What an item of a layout means to its reader. */
enum meaning { COLUMN, TIME, GAMMA, BOX, BOX_ENDS, MASS, MASSES_OF_TYPES, COUNT, DIMENSION, PARTS };
enum more_meanings { RATIO = PARTS + 1, KERNEL, HFACT, TYPES, IGNORED };

struct field {
    const char *path;
    int meaning;
    enum snapshot_column column;
    bool needed;  /* required by the reader or by every snapshot */
    int width;    /* of a column or a list of numbers */
    double value; /* of a list; of a column the first value, which rises by 1 */
    const char *text;
};

struct layout {
    const char *name, *code;
    size_t count;
    struct field fields[24];
};

static const struct layout layouts[] = {
    {"gadget_hdf5",
     "GADGET or its kin",
     18,
     {{"PartType0/Coordinates", COLUMN, SNAPSHOT_X, true, 3, 0, NULL},
      {"PartType0/Velocities", COLUMN, SNAPSHOT_VX, true, 3, -5, NULL},
      {"PartType0/Masses", COLUMN, SNAPSHOT_M, false, 1, 20, NULL},
      {"PartType0/Density", COLUMN, SNAPSHOT_RHO, true, 1, 30, NULL},
      {"PartType0/InternalEnergy", COLUMN, SNAPSHOT_U, false, 1, 40, NULL},
      {"PartType0/Pressure", COLUMN, SNAPSHOT_P, false, 1, 50, NULL},
      {"PartType0/SmoothingLength", COLUMN, SNAPSHOT_H, false, 1, 60, NULL},
      {"PartType0/Acceleration", COLUMN, SNAPSHOT_AX, false, 3, -70, NULL},
      {"PartType0/RateOfChangeOfInternalEnergy", COLUMN, SNAPSHOT_DU, false, 1, -80, NULL},
      {"Header/Time", TIME, 0, false, 1, 3, NULL},
      {"Header/Gamma", GAMMA, 0, false, 1, 2, NULL},
      {"Header/BoxSize", BOX, 0, false, 3, 100, NULL},
      {"Header/MassTable", MASS, 0, false, 6, 7, NULL},
      {"Header/NumPart_ThisFile", COUNT, 0, false, 6, N, NULL},
      {"Header/Dimension", DIMENSION, 0, false, 1, 3, NULL},
      {"Header/NumFilesPerSnapshot", PARTS, 0, false, 1, 1, NULL},
      {"PartType1/Coordinates", IGNORED, 0, false, 3, 9, NULL},
      {"PartType0/ParticleIDs", IGNORED, 0, false, 1, 1, NULL}}},
    {"swift",
     "SWIFT",
     17,
     {{"PartType0/Coordinates", COLUMN, SNAPSHOT_X, true, 3, 0, NULL},
      {"PartType0/Velocities", COLUMN, SNAPSHOT_VX, true, 3, -5, NULL},
      {"PartType0/Masses", COLUMN, SNAPSHOT_M, false, 1, 20, NULL},
      {"PartType0/Densities", COLUMN, SNAPSHOT_RHO, true, 1, 30, NULL},
      {"PartType0/InternalEnergies", COLUMN, SNAPSHOT_U, false, 1, 40, NULL},
      {"PartType0/Pressures", COLUMN, SNAPSHOT_P, false, 1, 50, NULL},
      {"PartType0/SmoothingLengths", COLUMN, SNAPSHOT_H, false, 1, 60, NULL},
      {"PartType0/Accelerations", COLUMN, SNAPSHOT_AX, false, 3, -70, NULL},
      {"Header/Time", TIME, 0, false, 1, 3, NULL},
      {"HydroScheme/Adiabatic index", GAMMA, 0, false, 1, 2, NULL},
      {"HydroScheme/Kernel gamma", RATIO, 0, false, 1, 4, NULL},
      {"HydroScheme/Kernel function", KERNEL, 0, false, 0, 0, "Quartic spline (M5)"},
      {"Header/BoxSize", BOX, 0, false, 3, 100, NULL},
      {"Header/MassTable", MASS, 0, false, 6, 7, NULL},
      {"Header/NumPart_ThisFile", COUNT, 0, false, 6, N, NULL},
      {"HydroScheme/Dimension", DIMENSION, 0, false, 1, 3, NULL},
      {"Header/NumFilesPerSnapshot", PARTS, 0, false, 1, 1, NULL}}},
    {"sph_exa",
     "SPH-EXA",
     22,
     {{"Step#10/x", COLUMN, SNAPSHOT_X, true, 1, 0, NULL},
      {"Step#10/y", COLUMN, SNAPSHOT_X + 1, false, 1, 1, NULL},
      {"Step#10/z", COLUMN, SNAPSHOT_X + 2, false, 1, 2, NULL},
      {"Step#10/vx", COLUMN, SNAPSHOT_VX, true, 1, -5, NULL},
      {"Step#10/vy", COLUMN, SNAPSHOT_VX + 1, true, 1, -6, NULL},
      {"Step#10/vz", COLUMN, SNAPSHOT_VX + 2, true, 1, -7, NULL},
      {"Step#10/m", COLUMN, SNAPSHOT_M, false, 1, 20, NULL},
      {"Step#10/rho", COLUMN, SNAPSHOT_RHO, true, 1, 30, NULL},
      {"Step#10/u", COLUMN, SNAPSHOT_U, false, 1, 40, NULL},
      {"Step#10/p", COLUMN, SNAPSHOT_P, false, 1, 50, NULL},
      {"Step#10/h", COLUMN, SNAPSHOT_H, false, 1, 60, NULL},
      {"Step#10/ax", COLUMN, SNAPSHOT_AX, false, 1, -70, NULL},
      {"Step#10/ay", COLUMN, SNAPSHOT_AX + 1, false, 1, -71, NULL},
      {"Step#10/az", COLUMN, SNAPSHOT_AX + 2, false, 1, -72, NULL},
      {"Step#10/du", COLUMN, SNAPSHOT_DU, false, 1, -80, NULL},
      {"Step#10/time", TIME, 0, false, 1, 3, NULL},
      {"Step#10/gamma", GAMMA, 0, false, 1, 2, NULL},
      {"Step#10/box", BOX_ENDS, 0, false, 6, -8, NULL},
      {"Step#10/particleMass", MASS, 0, false, 1, 7, NULL},
      {"Step#2/x", IGNORED, 0, false, 1, 500, NULL},
      {"Step#9/time", IGNORED, 0, false, 1, 500, NULL},
      {"Step#x/time", IGNORED, 0, false, 1, 500, NULL}}},
    {"phantom_hdf5",
     "Phantom",
     12,
     {{"particles/xyz", COLUMN, SNAPSHOT_X, true, 3, 0, NULL},
      {"particles/vxyz", COLUMN, SNAPSHOT_VX, true, 3, -5, NULL},
      {"particles/u", COLUMN, SNAPSHOT_U, false, 1, 40, NULL},
      {"particles/pressure", COLUMN, SNAPSHOT_P, false, 1, 50, NULL},
      {"particles/h", COLUMN, SNAPSHOT_H, true, 1, 60, NULL},
      {"particles/density", COLUMN, SNAPSHOT_RHO, false, 1, 30, NULL},
      {"particles/itype", TYPES, 0, false, 1, 1, NULL},
      {"header/massoftype", MASSES_OF_TYPES, 0, true, 8, 7, NULL},
      {"header/hfact", HFACT, 0, true, 1, 3, NULL},
      {"header/time", TIME, 0, false, 1, 3, NULL},
      {"header/gamma", GAMMA, 0, false, 1, 2, NULL},
      {"particles/alpha", IGNORED, 0, false, 1, 1, NULL}}},
};
enum { LAYOUTS = sizeof layouts / sizeof *layouts };

/* ---- contents of the file ---- */

static const int types[N] = {1, -1, 2,  1, 3, 1,
                             1, -2, -1, 1, 1, 1}; /* Phantom's; negative: inactive */

static bool is_column(const struct field *f)
{
    return f->meaning == COLUMN || f->meaning == TYPES ||
           (f->meaning == IGNORED && !strstr(f->path, "time"));
}

/* The value of particle i along direction c. Positions along the three directions are distinct. */
static double planted(const struct field *f, int i, int c)
{
    static const int step[3] = {1, 5, 7};
    const int along = f->column < SNAPSHOT_VX && f->width == 1 ? (int)f->column : c;
    if (f->meaning == TYPES) return types[i];
    if (f->meaning == COLUMN && f->column < SNAPSHOT_VX) return (step[along] * i) % N + along;
    return f->value + i + 100 * c;
}

static struct item item_of(const struct layout *l, const struct field *f)
{
    struct item item = {.attribute = !is_column(f) && strcmp(l->name, "phantom_hdf5") != 0};
    snprintf(item.path, sizeof item.path, "%s", f->path);
    if (f->text) {
        item.stored = TEXT;
        snprintf(item.text, sizeof item.text, "%s", f->text);
    } else if (is_column(f)) {
        item.rank = f->width > 1 ? 2 : 1;
        item.shape[0] = N, item.shape[1] = (hsize_t)f->width;
        for (int i = 0; i < N; i++)
            for (int c = 0; c < f->width; c++) item.values[i * f->width + c] = planted(f, i, c);
    } else {
        item.rank = f->width > 1;
        item.shape[0] = (hsize_t)f->width;
        for (int c = 0; c < f->width; c++) item.values[c] = f->value + 3 * c;
        if (f->meaning == COUNT)
            for (int c = 1; c < f->width; c++) item.values[c] = 2 * N;
    }
    return item;
}

static size_t items_of(const struct layout *l, struct item *items)
{
    for (size_t k = 0; k < l->count; k++) items[k] = item_of(l, &l->fields[k]);
    return l->count;
}

/* ---- what must be read ---- */

static const struct field *field_of(const struct layout *l, const struct item *items, int meaning)
{
    for (size_t k = 0; k < l->count; k++)
        if (l->fields[k].meaning == meaning && items[k].path[0]) return &l->fields[k];
    return NULL;
}

/* The file's row of particle k: gas comes first. */
static int row_of(const struct layout *l, const struct item *items, int k)
{
    int order[N], n = 0;
    if (!field_of(l, items, TYPES)) return k;
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < N; i++)
            if ((abs(types[i]) == 1) == !pass) order[n++] = i;
    return order[k];
}

static double wanted(const struct layout *l, const struct item *items, const struct field *f, int k,
                     int c)
{
    const double shift = f->column < SNAPSHOT_VX && field_of(l, items, BOX_ENDS) ? 8 : 0;
    const int direction = f->width == 1 ? (int)f->column : c;
    const double corner = shift > 0 ? -8 + 6 * direction : 0;
    return planted(f, row_of(l, items, k), c) - corner;
}

static void is_number(const char *what, bool known, double got, const struct field *want)
{
    if (known != (want != NULL)) fail_msg("%s: known %d", what, known);
    if (want && got != want->value) fail_msg("%s: %g, not %g", what, got, want->value);
}

/* Compares a snapshot with the items; items with an empty path are missing. */
static void is_read(const struct layout *l, const struct item *items,
                    const struct snapshot_file *file)
{
    bool there[SNAPSHOT_COLUMNS] = {false};
    for (size_t k = 0; k < l->count; k++) {
        const struct field *f = &l->fields[k];
        if (f->meaning != COLUMN || !items[k].path[0]) continue;
        for (int c = 0; c < f->width; c++) {
            const double *column = file->column[f->column + (unsigned)c];
            there[f->column + (unsigned)c] = true;
            if (!column) fail_msg("%s: %s is not read", l->name, f->path);
            for (int i = 0; i < N; i++)
                if (column[i] != wanted(l, items, f, i, c))
                    fail_msg("%s: %s of %d: %g", l->name, f->path, i, column[i]);
        }
    }
    const struct field *mass = field_of(l, items, MASS),
                       *of_types = field_of(l, items, MASSES_OF_TYPES);
    for (int i = 0; i < N && !there[SNAPSHOT_M]; i++) {
        const int type = field_of(l, items, TYPES) ? abs(types[row_of(l, items, i)]) : 1;
        const double m = mass ? mass->value : of_types->value + 3 * (type - 1);
        assert_true(file->column[SNAPSHOT_M][i] == m);
        if (of_types && !there[SNAPSHOT_RHO]) {
            const double q = 3 / file->column[SNAPSHOT_H][i];
            assert_true(fabs(file->column[SNAPSHOT_RHO][i] / (m * q * q * q) - 1) <= 1e-15);
        }
    }
    there[SNAPSHOT_M] = true;
    there[SNAPSHOT_RHO] = true;
    for (int c = 0; c < SNAPSHOT_COLUMNS; c++)
        if (!there[c] != !file->column[c])
            fail_msg("%s: column %s", l->name, snapshot_column_names[c]);
    is_number("time", file->time.known, file->time.value, field_of(l, items, TIME));
    is_number("gamma", file->gamma.known, file->gamma.value, field_of(l, items, GAMMA));
    is_number("ratio", file->ratio > 0, file->ratio, field_of(l, items, RATIO));
    const struct field *kernel = field_of(l, items, KERNEL), *box = field_of(l, items, BOX);
    assert_string_equal(file->kernel, kernel ? kernel->text : "");
    assert_true(file->boxed == (box || field_of(l, items, BOX_ENDS)));
    for (int d = 0; d < 3 && file->boxed; d++) {
        assert_true(file->box[d] == (box ? 100 + 3 * d : 3));
        assert_true(file->corner[d] == 0);
    }
    assert_int_equal(file->n, N);
    assert_int_equal(file->gas, field_of(l, items, TYPES) ? N - 3 : N);
    assert_int_equal(file->parts, 1);
    assert_string_equal(file->layout, l->name);
    assert_string_equal(file->code, l->code);
}

/* Compares the snapshot's notes with the items. */
static void is_noted(const struct layout *l, const struct item *items,
                     const struct snapshot_file *file)
{
    const struct field *gamma = field_of(l, items, GAMMA), *dim = field_of(l, items, DIMENSION);
    const bool exa = strcmp(l->name, "sph_exa") == 0, swift = strcmp(l->name, "swift") == 0,
               phantom = strcmp(l->name, "phantom_hdf5") == 0;
    bool masses = false, density = false;
    char word[80] = "";
    for (size_t k = 0; k < l->count; k++) {
        if (l->fields[k].meaning == GAMMA) snprintf(word, sizeof word, "%s", items[k].path);
        masses = masses || (l->fields[k].column == SNAPSHOT_M && items[k].path[0]);
        density = density || (l->fields[k].column == SNAPSHOT_RHO && items[k].path[0]);
    }
    if (strcmp(l->name, "gadget_hdf5") == 0 && gamma) *strchr(word, '/') = ':';
    noted(file, "gamma", gamma ? "in the file" : NULL,
          swift     ? "HydroScheme/Adiabatic index, in float32 2"
          : phantom ? "its header"
                    : word);
    noted(file, "masses", masses || exa || phantom ? NULL : "from MassTable",
          "Header/MassTable[0] = 7");
    noted(file, "density", phantom && !density ? "m (hfact/h)^3" : NULL, "hfact = 3");
    noted(file, "step", exa ? "Step#10" : NULL, "the last one of the file");
    noted(file, "origin", field_of(l, items, BOX_ENDS) ? "lower corner of the box" : NULL,
          "(-8, -2, 4)");
    noted(file, "files", NULL, "");
    snprintf(word, sizeof word, "%d", file->dim);
    noted(file, "dimensions", word,
          dim || phantom ? "the file says so, and positions" : "positions differ along");
}

static struct snapshot_options here = {.here = true};

/* What is read of a file of n items; the caller frees it. */
static inline struct snapshot_file file_of(const struct item *items, size_t n, const char *what)
{
    struct snapshot_file file;
    struct error error = {0};
    char *path = path_of("a.hdf5");
    write_items(path, items, n);
    if (snapshot_read(path, &here, &file, &error)) fail_msg("%s: %s", what, error.message);
    return file;
}

static inline void reads(const struct layout *l, const struct item *items, const char *what)
{
    struct snapshot_file file = file_of(items, l->count, what);
    is_read(l, items, &file);
    is_noted(l, items, &file);
    snapshot_file_free(&file);
}

static inline void refuses(const struct layout *l, const struct item *items, const char *what,
                           const char *says)
{
    write_items(path_of("a.hdf5"), items, l->count);
    is_refused("a.hdf5", &here, what, says);
}
