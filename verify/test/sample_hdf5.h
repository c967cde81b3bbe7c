/* SPDX-License-Identifier: GPL-3.0-or-later
 * Writes HDF5 files from a list of their items, in every form in which a code may store them.
 * Include after cmocka.h and where HAVE_HDF5 is defined. */
#pragma once

#include <hdf5.h>
#include <stdbool.h>

enum { ITEM_NUMBERS = 64 };

/* Types in which numbers and texts are stored. */
enum stored {
    F64,
    F32,
    F32_BIG,
    F80,
    F16,
    I64,
    I32_BIG,
    I8,
    TEXT,
    TEXT_VARIABLE,
    OPAQUE,
    TYPE,
    GROUP
};

/* A dataset, or an attribute of the group before the last '/'. */
struct item {
    char path[64]; /* "": the item is left out */
    bool attribute;
    enum stored stored;
    int rank; /* 0: a scalar */
    hsize_t shape[3];
    bool packed; /* chunked and compressed */
    double values[ITEM_NUMBERS];
    char text[48];  /* "" of variable length: none is written */
    size_t letters; /* of a text of fixed length that is 'k' throughout; 0: it is text[] */
};
enum { ITEM_LETTERS = 5000 };

static hid_t item_type(const struct item *item)
{
    const hid_t numbers[] = {H5T_IEEE_F64LE, H5T_IEEE_F32LE, H5T_IEEE_F32BE, H5T_NATIVE_LDOUBLE,
                             H5T_IEEE_F32LE, H5T_STD_I64LE,  H5T_STD_I32BE,  H5T_STD_I8LE};
    if (item->stored < TEXT) {
        const hid_t number = H5Tcopy(numbers[item->stored]);
        if (item->stored == F16 && (H5Tset_fields(number, 15, 10, 5, 0, 10) < 0 ||
                                    H5Tset_size(number, 2) < 0 || H5Tset_ebias(number, 15) < 0))
            fail_msg("no type of 16 bits");
        return number;
    }
    if (item->stored > TEXT_VARIABLE) return H5Tcreate(H5T_OPAQUE, 8);
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, item->stored == TEXT_VARIABLE ? H5T_VARIABLE
                      : item->letters               ? item->letters
                                                    : sizeof item->text);
    return type;
}

/* Opens or creates the group of a path, with all groups above it, even if nothing else is in
 * them. */
static hid_t group_of(hid_t file, const char *path, size_t length)
{
    char part[64];
    hid_t group = H5Gopen2(file, "/", H5P_DEFAULT);
    for (size_t k = 1; k <= length; k++) {
        if (k < length && path[k] != '/') continue;
        snprintf(part, sizeof part, "%.*s", (int)k, path);
        H5Gclose(group);
        group = H5Lexists(file, part, H5P_DEFAULT) > 0
                    ? H5Gopen2(file, part, H5P_DEFAULT)
                    : H5Gcreate2(file, part, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    }
    return group;
}

static void write_item(hid_t file, const struct item *item)
{
    const char *slash = strrchr(item->path, '/'), *name = slash ? slash + 1 : item->path;
    const hid_t group = group_of(file, item->path, slash ? (size_t)(slash - item->path) : 0);
    const hid_t type = item_type(item), how = H5Pcreate(H5P_DATASET_CREATE);
    const hid_t space =
        item->rank ? H5Screate_simple(item->rank, item->shape, NULL) : H5Screate(H5S_SCALAR);
    const char *text = item->text[0] ? item->text : NULL;
    char texts[ITEM_LETTERS];
    memset(texts, 'k', sizeof texts);
    for (size_t k = 0; k < 2 && !item->letters; k++) /* the same text twice, for an array of two */
        memcpy(texts + k * sizeof item->text, item->text, sizeof item->text);
    const hid_t memory = item->stored < TEXT ? H5T_NATIVE_DOUBLE : type;
    const void *values = item->stored < TEXT    ? (const void *)item->values
                         : item->stored == TEXT ? (const void *)texts
                                                : (const void *)&text;
    herr_t status = 0;
    if (item->stored == GROUP) {
        H5Gclose(group_of(file, item->path, strlen(item->path)));
    } else if (item->stored == TYPE) {
        status = H5Tcommit2(group, name, type, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    } else if (item->attribute) {
        const hid_t self = H5Acreate2(group, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
        status = H5Awrite(self, memory, values);
        H5Aclose(self);
    } else {
        const hsize_t piece[3] = {3, 1, 1};
        if (item->packed && item->rank) {
            H5Pset_chunk(how, item->rank, piece);
            H5Pset_shuffle(how);
            H5Pset_deflate(how, 4);
        }
        const hid_t self = H5Dcreate2(group, name, type, space, H5P_DEFAULT, how, H5P_DEFAULT);
        /* an array of texts is left empty, and so is one of more numbers than an item has */
        if (item->stored < TEXT ? !item->rank || item->shape[0] <= ITEM_NUMBERS : !item->rank)
            status = H5Dwrite(self, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
        H5Dclose(self);
    }
    if (status < 0) fail_msg("%s is not written", item->path);
    H5Sclose(space);
    H5Pclose(how);
    H5Tclose(type);
    H5Gclose(group);
}

static void write_items(const char *path, const struct item *items, size_t n)
{
    const hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(file >= 0);
    for (size_t k = 0; k < n; k++)
        if (items[k].path[0]) write_item(file, &items[k]);
    H5Fclose(file);
}
