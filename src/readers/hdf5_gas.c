/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "hdf5_gas.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum status hdf5_gas(const struct snapshot_source *source, const char *group,
                     const struct hdf5_names *names, size_t n, struct snapshot_file *file,
                     struct error *error)
{
    char path[128], there[300];
    if (!hdf5_has(source, group)) {
        hdf5_names(source, "/", there, sizeof there);
        return error_set(error, STATUS_BAD_INPUT, "%.200s: no gas (%s); it has: %.200s%s",
                         source->path, group, there,
                         hdf5_has(source, "PartType1") ? " (dark matter only?)" : "");
    }
    for (size_t k = 0; k < n; k++) {
        const char *const *name = names[k].names;
        for (; *name; name++) {
            snprintf(path, sizeof path, "%s/%s", group, *name);
            if (hdf5_has(source, path)) break;
        }
        if (!*name && !names[k].needed) continue;
        if (!*name) {
            hdf5_names(source, group, there, sizeof there);
            return error_set(error, STATUS_BAD_INPUT, "%.200s: %s holds no %s; it has: %.200s",
                             source->path, group, names[k].names[0], there);
        }
        if (names[k].column == SNAPSHOT_X) {
            char kind[64];
            file->n = hdf5_rows(source, path);
            if (!file->n) {
                hdf5_kind(source, path, kind, sizeof kind);
                return error_set(error, STATUS_BAD_INPUT,
                                 "%.200s: %.80s: no particles, or no table of numbers, but %s; "
                                 "allowed: 1 or 2 indices",
                                 source->path, path, kind);
            }
            if (file->n > SNAPSHOT_ROWS_MAX)
                return error_set(error, STATUS_BAD_INPUT,
                                 "%.200s: %.80s: %zu particles; allowed: up to %d", source->path,
                                 path, file->n, SNAPSHOT_ROWS_MAX);
            file->gas = file->n;
        }
        if (hdf5_read(source, path, file, names[k].column, error)) return error->status;
    }
    return STATUS_OK;
}

struct snapshot_value hdf5_number(const struct snapshot_source *source, const char *group,
                                  const char *name)
{
    struct snapshot_value found = {0};
    found.known = hdf5_numbers(source, group, name, &found.value, 1) > 0;
    return found;
}

struct snapshot_value hdf5_first(const struct snapshot_source *source, const char *const *from,
                                 const char **used)
{
    struct snapshot_value found = {0};
    for (; *from && !found.known; from++) {
        char group[40];
        const char *colon = strchr(*from, ':');
        snprintf(group, sizeof group, "%.*s", (int)(colon - *from), *from);
        found = hdf5_number(source, group, colon + 1);
        *used = *from;
    }
    return found;
}

static bool comoving(const struct snapshot_source *source, const struct snapshot_file *file)
{
    static const char *const says[] = {"Header:ComovingIntegrationOn",
                                       "Parameters:ComovingIntegrationOn",
                                       "Cosmology:Cosmological run", NULL};
    const char *from;
    const struct snapshot_value said = hdf5_first(source, says, &from),
                                redshift = hdf5_number(source, "Header", "Redshift");
    if (said.known) return said.value != 0;
    return redshift.value > 0 && fabs(file->time.value * (1 + redshift.value) - 1) < 1e-6;
}

static enum status take_masses(const struct snapshot_source *source, struct snapshot_file *file,
                               struct error *error)
{
    char there[48] = "Header/MassTable";
    if (file->column[SNAPSHOT_M]) return STATUS_OK;
    const struct snapshot_value table = hdf5_number(source, "Header", "MassTable");
    const double mass = table.value;
    if (table.known) snprintf(there, sizeof there, "Header/MassTable[0] = %g", mass);
    if (!(mass > 0))
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: no masses: no PartType0/Masses, and %s%s; allowed: above 0",
                         source->path, table.known ? "" : "no ", there);
    snapshot_note(&file->notes, "masses", "from MassTable", "Header/MassTable[0] = %.9g", mass);
    return snapshot_file_fill(file, SNAPSHOT_M, mass, source->path, error);
}

static void take_box(const struct snapshot_source *source, struct snapshot_file *file)
{
    /* our own initial states have Sides, and BoxSize is the largest */
    int count = hdf5_numbers(source, "Header", "Sides", file->box, 3);
    if (count != 3) count = hdf5_numbers(source, "Header", "BoxSize", file->box, 3);
    for (int d = 0; d < 3; d++) {
        if (count == 1) file->box[d] = file->box[0];
        if (!count || !(file->box[d] > 0 && isfinite(file->box[d]))) file->box[d] = 0;
    }
    file->boxed = file->box[0] > 0;
}

/* Notes units other than 1, to which no column is converted. */
static void note_units(const struct snapshot_source *source, struct snapshot_file *file)
{
    static const char *const names[][5] = {
        {"Units:Unit length in cgs (U_L)", "Header:UnitLength_in_cm", "Parameters:UnitLength_in_cm",
         "Header:UnitLength_In_CGS", NULL},
        {"Units:Unit mass in cgs (U_M)", "Header:UnitMass_in_g", "Parameters:UnitMass_in_g",
         "Header:UnitMass_In_CGS", NULL},
        {"Units:Unit time in cgs (U_t)", "Header:UnitVelocity_in_cm_per_s",
         "Parameters:UnitVelocity_in_cm_per_s", "Header:UnitVelocity_In_CGS", NULL}};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        const char *from = "";
        const struct snapshot_value unit = hdf5_first(source, names[k], &from);
        if (!unit.known || fabs(unit.value - 1) < 1e-6) continue;
        snapshot_note(&file->notes, "units", "not converted",
                      "%s is %g: numbers are taken as they stand, in the units of the case", from,
                      unit.value);
        return;
    }
}

enum status hdf5_header(const struct snapshot_source *source, struct snapshot_file *file,
                        struct error *error)
{
    static const char *const dims[] = {"Header:Dimension", "HydroScheme:Dimension", NULL};
    const char *from;
    file->time = hdf5_number(source, "Header", "Time");
    const struct snapshot_value dim = hdf5_first(source, dims, &from),
                                part = hdf5_number(source, "Header", "NumFilesPerSnapshot"),
                                count = hdf5_number(source, "Header", "NumPart_ThisFile");
    if (comoving(source, file))
        return error_set(
            error, STATUS_BAD_INPUT,
            "%.200s: comoving units (a cosmological run: the file says so, or its time %g "
            "is 1/(1 + redshift)); allowed: runs in a box at rest",
            source->path, file->time.value);
    if (count.known && count.value != (double)file->n)
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: Header/NumPart_ThisFile says %g gas particles, PartType0 has "
                         "%zu: cut off or damaged",
                         source->path, count.value, file->n);
    if (part.known && !(part.value >= 1 && part.value <= SNAPSHOT_PARTS_MAX))
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: Header/NumFilesPerSnapshot = %g; allowed: 1 to %d", source->path,
                         part.value, SNAPSHOT_PARTS_MAX);
    if (part.known) file->parts = (int)part.value;
    file->total = hdf5_number(source, "Header", "NumPart_Total").value;
    if (dim.known && dim.value >= 1 && dim.value <= 3) file->dim = (int)dim.value;
    take_box(source, file);
    note_units(source, file);
    return take_masses(source, file, error);
}
