/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "hdf5_file.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "h5.h"

enum { HEADER_NUMBERS_MAX = 4096, HEADER_TEXT_MAX = 4096 };

static hid_t file_of(const struct snapshot_source *source)
{
    return (hid_t)(intptr_t)source->file;
}

enum status hdf5_open(struct snapshot_source *source, struct error *error)
{
    const hid_t file = h5.Fopen(source->path, H5F_ACC_RDONLY, H5P_DEFAULT);
    if (file < 0)
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: begins as HDF5, but its library cannot open it: cut off or "
                         "damaged",
                         source->path);
    source->file = (void *)(intptr_t)file;
    return STATUS_OK;
}

void hdf5_close(struct snapshot_source *source)
{
    if (source->file) h5.Fclose(file_of(source));
    source->file = NULL;
}

/* H5Oexists_by_name fails if a parent group is missing. */
bool hdf5_has(const struct snapshot_source *source, const char *path)
{
    char part[strlen(path) + 1];
    for (size_t length = strcspn(path, "/");; length += 1 + strcspn(path + length + 1, "/")) {
        memcpy(part, path, length);
        part[length] = '\0';
        if (h5.Lexists(file_of(source), part, H5P_DEFAULT) <= 0) return false;
        if (!path[length]) break;
    }
    return h5.Oexists_by_name(file_of(source), path, H5P_DEFAULT) > 0;
}

struct names {
    char *text;
    size_t size, length;
    const char *prefix; /* NULL: all */
    double number;      /* of the last name */
};

static herr_t add_name(hid_t group, const char *name, const H5L_info_t *info, void *context)
{
    struct names *names = context;
    (void)group, (void)info;
    if (names->prefix) {
        const size_t length = strlen(names->prefix);
        char *end;
        if (strncmp(name, names->prefix, length) != 0) return 0;
        const double number = strtod(name + length, &end);
        if (end == name + length || *end || !(number > names->number)) return 0;
        names->number = number;
        snprintf(names->text, names->size, "%s", name);
        return 0;
    }
    names->length += (size_t)snprintf(names->text + names->length, names->size - names->length,
                                      "%s%s", names->length ? " " : "", name);
    return names->length >= names->size; /* full: stop the iteration */
}

void hdf5_names(const struct snapshot_source *source, const char *group, char *text, size_t size)
{
    struct names names = {.text = text, .size = size};
    hsize_t at = 0;
    *text = '\0';
    h5.Literate_by_name(file_of(source), group, H5_INDEX_NAME, H5_ITER_INC, &at, add_name, &names,
                        H5P_DEFAULT);
}

bool hdf5_last(const struct snapshot_source *source, const char *group, const char *prefix,
               char *name, size_t size)
{
    struct names names = {.text = name, .size = size, .prefix = prefix, .number = -1};
    hsize_t at = 0;
    h5.Literate_by_name(file_of(source), group, H5_INDEX_NAME, H5_ITER_INC, &at, add_name, &names,
                        H5P_DEFAULT);
    return names.number >= 0;
}

static bool is_number(hid_t type)
{
    const H5T_class_t class = h5.Tget_class(type);
    return (class == H5T_INTEGER || class == H5T_FLOAT) &&
           h5.Tget_size(type) <= sizeof(long double);
}

/* An attribute, or a dataset used in its place, with its type and space. */
struct entry {
    bool attribute;
    hid_t self, type, space;
    hssize_t count;
};

static void close_entry(struct entry *e)
{
    if (e->type >= 0) h5.Tclose(e->type);
    if (e->space >= 0) h5.Sclose(e->space);
    if (e->self >= 0) e->attribute ? h5.Aclose(e->self) : h5.Dclose(e->self);
}

/* False: missing, or more numbers than a header has. Close with close_entry. (Calls of the library
 * with a handle that is negative fail.) */
static bool open_entry(const struct snapshot_source *source, const char *group, const char *name,
                       struct entry *e)
{
    char path[256];
    snprintf(path, sizeof path, "%s/%s", group, name);
    if (!hdf5_has(source, group)) return false;
    e->attribute = h5.Aexists_by_name(file_of(source), group, name, H5P_DEFAULT) > 0;
    if (!e->attribute && !hdf5_has(source, path)) return false;
    if (e->attribute) {
        e->self = h5.Aopen_by_name(file_of(source), group, name, H5P_DEFAULT, H5P_DEFAULT);
        e->type = h5.Aget_type(e->self), e->space = h5.Aget_space(e->self);
    } else {
        e->self = h5.Dopen2(file_of(source), path, H5P_DEFAULT);
        e->type = h5.Dget_type(e->self), e->space = h5.Dget_space(e->self);
    }
    e->count = h5.Sget_simple_extent_npoints(e->space);
    if (e->count >= 1 && e->count <= HEADER_NUMBERS_MAX) return true;
    close_entry(e);
    return false;
}

static bool read_entry(const struct entry *e, hid_t type, void *values)
{
    return (e->attribute ? h5.Aread(e->self, type, values)
                         : h5.Dread(e->self, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values)) >= 0;
}

int hdf5_numbers(const struct snapshot_source *source, const char *group, const char *name,
                 double *values, int max)
{
    struct entry e;
    int count = 0;
    if (!open_entry(source, group, name, &e)) return 0;
    double all[HEADER_NUMBERS_MAX];
    if (is_number(e.type) && read_entry(&e, h5.T_NATIVE_DOUBLE_g, all)) {
        count = (int)e.count;
        memcpy(values, all, (size_t)(count < max ? count : max) * sizeof *values);
    }
    close_entry(&e);
    return count;
}

void hdf5_text(const struct snapshot_source *source, const char *group, const char *name,
               char *text, size_t size)
{
    struct entry e;
    char *all = NULL, fixed[HEADER_TEXT_MAX] = "";
    *text = '\0';
    if (!open_entry(source, group, name, &e)) return;
    const bool is_text = e.count == 1 && h5.Tget_class(e.type) == H5T_STRING,
               variable = is_text && h5.Tis_variable_str(e.type) > 0;
    const size_t length = h5.Tget_size(e.type);
    if (variable && read_entry(&e, e.type, &all) && all) {
        snprintf(text, size, "%s", all);
        h5.free_memory(all);
    } else if (is_text && !variable && length < sizeof fixed && read_entry(&e, e.type, fixed)) {
        snprintf(text, size, "%s", fixed);
    }
    status_clean(text);
    close_entry(&e);
}

struct dataset {
    hid_t self, type, space;
    hsize_t shape[2];
};

static void close_dataset(struct dataset *d)
{
    if (d->type >= 0) h5.Tclose(d->type);
    if (d->space >= 0) h5.Sclose(d->space);
    if (d->self >= 0) h5.Dclose(d->self);
}

static bool open_dataset(const struct snapshot_source *source, const char *path, struct dataset *d)
{
    d->shape[1] = 1;
    d->self = h5.Dopen2(file_of(source), path, H5P_DEFAULT);
    d->type = h5.Dget_type(d->self), d->space = h5.Dget_space(d->self);
    const int rank = h5.Sget_simple_extent_ndims(d->space);
    if (is_number(d->type) && (rank == 1 || rank == 2)) {
        h5.Sget_simple_extent_dims(d->space, d->shape, NULL);
        return true;
    }
    close_dataset(d);
    return false;
}

void hdf5_kind(const struct snapshot_source *source, const char *path, char *text, size_t size)
{
    const hid_t self = h5.Oopen(file_of(source), path, H5P_DEFAULT);
    const hid_t type = h5.Dget_type(self), space = h5.Dget_space(self);
    if (is_number(type))
        snprintf(text, size, "numbers with %d indices", h5.Sget_simple_extent_ndims(space));
    else
        snprintf(text, size, "%s",
                 h5.Iget_type(self) == H5I_GROUP     ? "a group"
                 : h5.Tget_class(type) == H5T_STRING ? "text"
                                                     : "something else");
    if (type >= 0) h5.Tclose(type);
    if (space >= 0) h5.Sclose(space);
    if (self >= 0) h5.Oclose(self);
}

size_t hdf5_rows(const struct snapshot_source *source, const char *path)
{
    struct dataset d;
    if (!open_dataset(source, path, &d)) return 0;
    close_dataset(&d);
    return (size_t)d.shape[0];
}

static void set_precision(struct snapshot_file *file, enum snapshot_column column, hid_t type)
{
    double *precision = &file->precision[column >= SNAPSHOT_VX];
    size_t other, digits = DBL_MANT_DIG;
    if (h5.Tget_class(type) == H5T_FLOAT)
        h5.Tget_fields(type, &other, &other, &other, &other, &digits);
    *precision = fmax(*precision, fmax(DBL_EPSILON, ldexp(1, -(int)digits)) / 2);
}

static enum status take(const struct dataset *d, const struct snapshot_source *source,
                        const char *path, struct snapshot_file *file, enum snapshot_column column,
                        struct error *error)
{
    const size_t columns = (size_t)d->shape[1];
    const size_t most = column == SNAPSHOT_X || column == SNAPSHOT_VX || column == SNAPSHOT_AX;
    if (d->shape[0] != file->n || columns < 1 || columns > (most ? 3 : 1))
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: %.80s has %zu x %zu numbers; allowed: %zu x %s", source->path,
                         path, (size_t)d->shape[0], columns, file->n, most ? "1 to 3" : "1");
    double *all = malloc(columns * file->n * sizeof *all);
    enum status status = STATUS_OK;
    if (!all)
        status = error_set(error, STATUS_ENVIRONMENT, "no memory for %.200s", source->path);
    else if (h5.Dread(d->self, h5.T_NATIVE_DOUBLE_g, H5S_ALL, H5S_ALL, H5P_DEFAULT, all) < 0)
        status = error_set(error, STATUS_BAD_INPUT,
                           "%.200s: %.80s cannot be read: damaged, or packed by a filter that is "
                           "not installed",
                           source->path, path);
    if (!status) status = snapshot_file_split(file, column, columns, all, source->path, error);
    set_precision(file, column, d->type);
    free(all);
    return status;
}

enum status hdf5_read(const struct snapshot_source *source, const char *path,
                      struct snapshot_file *file, enum snapshot_column column, struct error *error)
{
    struct dataset d;
    char kind[64];
    if (!open_dataset(source, path, &d)) {
        hdf5_kind(source, path, kind, sizeof kind);
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: %.80s is no table of numbers, but %s; allowed: 1 or 2 indices",
                         source->path, path, kind);
    }
    const enum status status = take(&d, source, path, file, column, error);
    close_dataset(&d);
    return status;
}
