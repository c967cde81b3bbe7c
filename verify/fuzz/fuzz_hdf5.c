/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fuzzes HDF5 files of every layout, made in memory. Four bytes each change a dataset or attribute
 * of a valid file: left out, of another type, shape, storage or value, or replaced by a link or a
 * group. The files are read in this process, so that coverage includes the readers. fuzz_damage.c
 * has files that the library itself may not survive. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "fuzz.h"
#include "fuzz_read.h"

#ifdef HAVE_HDF5
#include <hdf5.h>

enum { ROWS = 8, NUMBERS_MAX = 1 << 13, ITEMS_MAX = 20, LAYOUTS = 4, SOUND_SIZE_MAX = 1 << 16 };

/* A dataset (columns > 0) or an attribute (-columns numbers) and its value. */
struct item {
    const char *group, *name;
    int columns;
    double value; /* of all elements; 0 in a dataset: positions between 0 and 1 */
};

static const struct item gadget[] = {
    {"PartType0", "Coordinates", 3, 0},
    {"PartType0", "Velocities", 3, 0.5},
    {"PartType0", "Masses", 1, 0.125},
    {"PartType0", "Density", 1, 1},
    {"PartType0", "InternalEnergy", 1, 2.5},
    {"PartType0", "SmoothingLength", 1, 0.5},
    {"PartType0", "Pressure", 1, 1},
    {"PartType0", "Acceleration", 3, 0.5},
    {"Header", "Time", -1, 0.2},
    {"Header", "BoxSize", -1, 1},
    {"Header", "NumPart_ThisFile", -6, 8},
    {"Header", "NumFilesPerSnapshot", -1, 1},
    {"Header", "MassTable", -6, 0.125},
    {"Header", "Dimension", -1, 3},
    {"Header", "GIZMO_version", -1, 2022},
    {"Header", "ComovingIntegrationOn", -1, 0},
    {"Config", "GAMMA", -1, 1.4},
};
static const struct item swift[] = {
    {"PartType0", "Coordinates", 3, 0},
    {"PartType0", "Velocities", 3, 0.5},
    {"PartType0", "Masses", 1, 0.125},
    {"PartType0", "Densities", 1, 1},
    {"PartType0", "InternalEnergies", 1, 2},
    {"PartType0", "SmoothingLengths", 1, 0.25},
    {"PartType0", "Pressures", 1, 1},
    {"Header", "Time", -1, 0.2},
    {"Header", "BoxSize", -3, 1},
    {"Header", "NumPart_ThisFile", -7, 8},
    {"Header", "Dimension", -1, 3},
    {"HydroScheme", "Adiabatic index", -1, 1.4},
    {"HydroScheme", "Kernel gamma", -1, 1.9},
    {"HydroScheme", "Kernel function", -1, 1},
    {"Code", "Git Revision", -1, 1},
};
static const struct item sph_exa[] = {
    {"Step#1", "x", 1, 0},      {"Step#1", "y", 1, 0},       {"Step#1", "z", 1, 0},
    {"Step#1", "vx", 1, 0.5},   {"Step#1", "vy", 1, 0.5},    {"Step#1", "vz", 1, 0.5},
    {"Step#1", "m", 1, 0.125},  {"Step#1", "rho", 1, 1},     {"Step#1", "u", 1, 2.5},
    {"Step#1", "h", 1, 0.25},   {"Step#1", "time", -1, 0.2}, {"Step#1", "gamma", -1, 1.4},
    {"Step#1", "box", -6, 0.5}, {"Step#0", "x", 1, 0},
};
static const struct item phantom[] = {
    {"particles", "xyz", 3, 0},   {"particles", "vxyz", 3, 0.5},
    {"particles", "u", 1, 2.5},   {"particles", "h", 1, 0.25},
    {"particles", "itype", 1, 1}, {"header", "massoftype", -1, 0.125},
    {"header", "hfact", -1, 1.2}, {"header", "time", -1, 0.2},
    {"header", "gamma", 1, 1.4},  {"particles", "density", 1, 1},
};
static const struct {
    const struct item *items;
    size_t n;
} layouts[LAYOUTS] = {{gadget, sizeof gadget / sizeof *gadget},
                      {swift, sizeof swift / sizeof *swift},
                      {sph_exa, sizeof sph_exa / sizeof *sph_exa},
                      {phantom, sizeof phantom / sizeof *phantom}};

/* A change of an item from four bytes; a first byte below 128 leaves the item unchanged. */
struct change {
    unsigned how, shape, storage, value;
};
enum { AS_IT_IS = 0, LEFT_OUT, OTHER_TYPE, LOOP_LINK, LOST_LINK, FOREIGN_LINK, GROUP, ROOT, HOWS };

static struct change next_change(const uint8_t **bytes, size_t *size)
{
    uint8_t four[4] = {0};
    const size_t n = *size < 4 ? *size : 4;
    if (n) memcpy(four, *bytes, n);
    *bytes += n, *size -= n;
    if (four[0] < 128) return (struct change){0};
    return (struct change){four[0], four[1], four[2], four[3]};
}

static hid_t type_of(unsigned which)
{
    const hid_t types[] = {H5T_NATIVE_DOUBLE, H5T_IEEE_F32LE, H5T_IEEE_F64BE,     H5T_STD_I8LE,
                           H5T_STD_U64BE,     H5T_STD_I32LE,  H5T_NATIVE_LDOUBLE, H5T_UNIX_D32BE};
    const unsigned n = sizeof types / sizeof *types;
    if (which % 16 < n) return H5Tcopy(types[which % 16]);
    if (which % 16 == n) return H5Tcreate(H5T_OPAQUE, 1 + which / 16);
    if (which % 16 == n + 1) return H5Tarray_create2(H5T_NATIVE_FLOAT, 1, (const hsize_t[]){2});
    if (which % 16 == n + 2) return H5Tvlen_create(H5T_NATIVE_DOUBLE);
    const hid_t text = H5Tcopy(H5T_C_S1);
    H5Tset_size(text, which % 16 == n + 3 ? H5T_VARIABLE : 1 + 7 * (which / 16));
    return text;
}

static void fill(const struct item *item, const struct change *change, size_t n, double *numbers)
{
    static const double odd[] = {0, -1,   NAN,  INFINITY, 1e300, 1e-300, 8, 7,
                                 2, 0.25, 1e19, -0.0,     513,   3,      1, 0.5};
    for (size_t i = 0; i < n; i++)
        numbers[i] = item->value != 0 || item->columns < 0
                         ? item->value
                         : (double)((i * 37 + i / 3 * 11) % 101) / 101;
    if (!(change->value & 1) || !n) return;
    const double value = odd[change->value >> 4];
    for (size_t i = change->value & 2 ? 0 : n / 2; i < (change->value & 2 ? n : n / 2 + 1); i++)
        numbers[i] = value;
}

static hid_t space_of(const struct item *item, const struct change *change, size_t *n)
{
    static const hsize_t rows[] = {ROWS, ROWS - 1, ROWS + 1, 0, 1, 300, 4, ROWS};
    const int columns = item->columns < 0 ? -item->columns : item->columns;
    hsize_t size[4] = {item->columns < 0 ? (hsize_t)columns : rows[change->shape >> 5],
                       (hsize_t)columns, 2, 2};
    int rank = item->columns > 1 ? 2 : 1;
    if (change->shape & 1) rank = (int)(change->shape >> 1 & 3);
    if (change->shape & 8) size[1] = change->shape >> 5;
    if (item->columns < 0 && change->shape & 16) size[0] = change->shape >> 5;
    *n = 1;
    for (int k = 0; k < rank; k++) *n *= (size_t)size[k];
    return rank ? H5Screate_simple(rank, size, NULL) : H5Screate(H5S_SCALAR);
}

static hid_t storage_of(const struct change *change, hid_t space)
{
    const hid_t storage = H5Pcreate(H5P_DATASET_CREATE);
    hsize_t size[4];
    const int rank = H5Sget_simple_extent_dims(space, size, NULL);
    for (int k = 0; k < rank; k++) size[k] = 1 + size[k] / (1 + (change->storage >> 6));
    if (change->storage & 1 && rank > 0) H5Pset_chunk(storage, rank, size);
    if (change->storage & 2) H5Pset_shuffle(storage);
    if (change->storage & 4) H5Pset_deflate(storage, 1);
    if (change->storage & 8) H5Pset_fletcher32(storage);
    if (change->storage & 16) H5Pset_layout(storage, H5D_COMPACT);
    return storage;
}

static void put_numbers(hid_t group, const struct item *item, const struct change *change)
{
    static double numbers[NUMBERS_MAX];
    static char texts[NUMBERS_MAX];
    size_t n = 0;
    const bool other = change->how % HOWS == OTHER_TYPE;
    const hid_t type = type_of(other ? change->how >> 3 : 0), space = space_of(item, change, &n);
    const H5T_class_t class = H5Tget_class(type);
    const bool numeric = class == H5T_FLOAT || class == H5T_INTEGER;
    const void *data = numeric ? (const void *)numbers : texts;
    if (n > NUMBERS_MAX / 64) n = 0;
    fill(item, change, n, numbers);
    memset(texts, 'a', sizeof texts);
    const hid_t from = numeric ? H5T_NATIVE_DOUBLE : type;
    const bool writes =
        n && (numeric || (class == H5T_STRING && !H5Tis_variable_str(type)) || class == H5T_OPAQUE);
    if (item->columns < 0) {
        const hid_t self = H5Acreate2(group, item->name, type, space, H5P_DEFAULT, H5P_DEFAULT);
        if (self >= 0 && writes) H5Awrite(self, from, data);
        if (self >= 0) H5Aclose(self);
    } else {
        const hid_t storage = storage_of(change, space);
        const hid_t self =
            H5Dcreate2(group, item->name, type, space, H5P_DEFAULT, storage, H5P_DEFAULT);
        if (self >= 0 && writes && !(change->storage & 32))
            H5Dwrite(self, from, H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
        if (self >= 0) H5Dclose(self);
        H5Pclose(storage);
    }
    H5Sclose(space);
    H5Tclose(type);
}

static void take_item(hid_t file, const struct item *item)
{
    char own[64];
    snprintf(own, sizeof own, "/%s/%s", item->group, item->name);
    if (item->columns < 0)
        H5Adelete_by_name(file, item->group, item->name, H5P_DEFAULT);
    else
        H5Ldelete(file, own, H5P_DEFAULT);
}

static void put_item(hid_t file, const struct item *item, const struct change *change)
{
    const unsigned how = change->how % HOWS;
    if (H5Lexists(file, item->group, H5P_DEFAULT) <= 0 && how == ROOT)
        H5Lcreate_hard(file, "/", file, item->group, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t group = H5Lexists(file, item->group, H5P_DEFAULT) > 0
                            ? H5Oopen(file, item->group, H5P_DEFAULT)
                            : H5Gcreate2(file, item->group, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    if (group < 0) return;
    char own[64];
    snprintf(own, sizeof own, "/%s/%s", item->group, item->name);
    switch (how) {
    case LEFT_OUT:
    case ROOT:
        break;
    case LOOP_LINK:
        H5Lcreate_soft(own, group, item->name, H5P_DEFAULT, H5P_DEFAULT);
        break;
    case LOST_LINK:
        H5Lcreate_soft(change->value & 1 ? "/nowhere/at/all" : "/PartType0/Density", group,
                       item->name, H5P_DEFAULT, H5P_DEFAULT);
        break;
    case FOREIGN_LINK:
        H5Lcreate_external("no_such_file.hdf5", "/", group, item->name, H5P_DEFAULT, H5P_DEFAULT);
        break;
    case GROUP: {
        const hid_t self = H5Gcreate2(group, item->name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
        if (self >= 0) H5Gclose(self);
        break;
    }
    default:
        put_numbers(group, item, change);
    }
    H5Oclose(group);
}

/* The file that the bytes describe: layout, format, changes of items. */
struct plan {
    size_t layout;
    bool latest;
    struct change change[ITEMS_MAX];
};

static struct plan plan_of(const uint8_t *bytes, size_t left)
{
    struct plan plan = {0};
    const unsigned first = left ? *bytes : 0;
    plan.layout = first % LAYOUTS;
    plan.latest = first & 64;
    if (left) bytes++, left--;
    for (size_t k = 0; k < layouts[plan.layout].n; k++) plan.change[k] = next_change(&bytes, &left);
    return plan;
}

static void write_sound(const struct plan *plan, const char *path)
{
    const struct change none = {0};
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    if (plan->latest) H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
    const hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, access);
    FUZZ_PROMISE(file >= 0);
    for (size_t k = 0; k < layouts[plan->layout].n; k++)
        put_item(file, &layouts[plan->layout].items[k], &none);
    H5Fclose(file);
    H5Pclose(access);
}

/* The path of the valid file of this layout and format, which is created once. */
static const char *sound_file(const struct plan *plan)
{
    static struct {
        size_t size;
        uint8_t bytes[SOUND_SIZE_MAX];
    } sound[LAYOUTS][2], *self;
    self = &sound[plan->layout][plan->latest];
    if (!self->size) {
        const char *path = fuzz_named_file(NULL, 0);
        write_sound(plan, path);
        FILE *file = fopen(path, "rb");
        FUZZ_PROMISE(file);
        self->size = fread(self->bytes, 1, sizeof self->bytes, file);
        FUZZ_PROMISE(self->size < sizeof self->bytes);
        fclose(file);
    }
    return fuzz_named_file(self->bytes, self->size);
}

/* True if the first item of a group replaces the group itself. */
static bool group_is_root(const struct plan *plan, size_t k)
{
    const struct item *items = layouts[plan->layout].items;
    size_t first = 0;
    while (strcmp(items[first].group, items[k].group) != 0) first++;
    return plan->change[first].how % HOWS == ROOT;
}

/* Applies the changes to a valid file, which is several times as fast as to write a new one. */
static void make_changes(hid_t file, const struct plan *plan)
{
    const struct item *items = layouts[plan->layout].items;
    const size_t n = layouts[plan->layout].n;
    for (size_t k = 0; k < n; k++)
        if (group_is_root(plan, k)) H5Ldelete(file, items[k].group, H5P_DEFAULT);
    for (size_t k = 0; k < n; k++) {
        const bool anew = group_is_root(plan, k);
        if (!anew && !plan->change[k].how) continue;
        if (!anew) take_item(file, &items[k]);
        put_item(file, &items[k], &plan->change[k]);
    }
}

void fuzz_one(const uint8_t *bytes, size_t size)
{
    const struct snapshot_options options = {.here = true};
    const struct plan plan = plan_of(bytes, size);
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    /* keeps a megabyte of freed memory for the next file, where the library keeps 64 kB */
    H5set_free_list_limits(-1, -1, -1, -1, -1, -1);
    const char *path = sound_file(&plan);
    const hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
    FUZZ_PROMISE(file >= 0);
    make_changes(file, &plan);
    /* the file stays open, because readers then open it in half the time */
    const enum status status = fuzz_read(path, &options, false);
    FUZZ_PROMISE(size > 1 || !status); /* an unchanged file must be read */
    H5Fclose(file);
    /* readers close everything that they open */
    FUZZ_PROMISE(H5Fget_obj_count((hid_t)H5F_OBJ_ALL, H5F_OBJ_ALL) == 0);
}

#else

void fuzz_one(const uint8_t *bytes, size_t size)
{
    (void)bytes, (void)size;
}
#endif
