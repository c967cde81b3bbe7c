/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests snapshots in several files: parts are joined in the order of their numbers, wherever they
 * are, and refused if their headers differ. */
#include "test.h"

#ifdef HAVE_HDF5
#include <float.h>
#include <unistd.h>

#include "sample_layouts.h"

static const struct layout *const gadget = &layouts[0];
enum { PARTS_MOST = 4 };

/* The items of part k; the numbers of particles differ from part to part. */
static void part(int k, int parts, struct item *items)
{
    items_of(gadget, items);
    for (size_t i = 0; i < gadget->count; i++) {
        const struct field *f = &gadget->fields[i];
        if (f->meaning == COUNT) items[i].values[0] = N - k;
        if (f->meaning == PARTS) items[i].values[0] = parts;
        if (!is_column(f)) continue;
        items[i].shape[0] = (hsize_t)(N - k);
        for (int j = 0; j < N * f->width; j++) items[i].values[j] += 1000 * k;
    }
    for (size_t i = 0; i < gadget->count; i++)
        if (gadget->fields[i].meaning == BOX)
            for (int d = 0; d < 3; d++) items[i].values[d] = 9000 + d;
}

static void write_part(const char *name, const struct item *items)
{
    write_items(path_of(name), items, gadget->count);
}

static enum status read_parts(const char *name, struct snapshot_file *file, struct error *error)
{
    *error = (struct error){0};
    return snapshot_read(path_of(name), &here, file, error);
}

/* Particles are in the order of the file numbers, whatever the order of files in the folder. */
TEST(parts_in_every_order)
{
    int order[PARTS_MOST] = {0, 1, 2, 3};
    for (int parts = 1; parts <= PARTS_MOST; parts++)
        for (int turn = 0; turn < 6; turn++) {
            struct snapshot_file file;
            struct error error;
            struct item items[ITEMS_MAX];
            const int a = turn % parts, b = (turn / 2 + 1) % parts, swap = order[a];
            char name[32];
            for (int k = 0; k < PARTS_MOST && turn == 0; k++) order[k] = k;
            if (turn) order[a] = order[b], order[b] = swap;
            size_t n = 0;
            for (int k = 0; k < parts; k++) {
                snprintf(name, sizeof name, "run.05.%d.hdf5", k);
                part(order[k], parts, items);
                write_part(name, items);
                n += (size_t)(N - order[k]);
            }
            if (read_parts("run.05.0.hdf5", &file, &error)) fail_msg("%s", error.message);
            assert_true(file.n == n && file.gas == n && file.parts == parts);
            snprintf(name, sizeof name, "%d", parts);
            noted(&file, "files", parts > 1 ? name : NULL, "the header says so; read as one");
            size_t at = 0;
            for (int k = 0; k < parts; k++)
                for (int i = 0; i < N - order[k]; i++, at++)
                    for (size_t f = 0; f < gadget->count; f++)
                        for (int c = 0; c < gadget->fields[f].width; c++) {
                            const struct field *of = &gadget->fields[f];
                            if (of->meaning != COLUMN) continue;
                            assert_true(file.column[of->column + (unsigned)c][at] ==
                                        planted(of, i, c) + 1000 * order[k]);
                        }
            snapshot_file_free(&file);
        }
}

/* The header's total is that of all parts; 0 or a missing total is not checked. */
TEST(totals)
{
    for (int parts = 1; parts <= 2; parts++)
        for (int off = -1; off <= 2; off++) {
            struct snapshot_file file;
            struct error error;
            struct item items[ITEMS_MAX];
            const int all = parts == 1 ? N : 2 * N - 1;
            char name[32];
            for (int k = 0; k < parts; k++) {
                part(k, parts, items);
                struct item *total = &items[gadget->count];
                for (size_t i = 0; i < gadget->count; i++)
                    if (gadget->fields[i].meaning == COUNT) *total = items[i];
                snprintf(total->path, sizeof total->path, "Header/NumPart_Total");
                total->values[0] = off == 2 ? 0 : all + off;
                snprintf(name, sizeof name, "t.%d", k);
                write_items(path_of(name), items, gadget->count + 1);
            }
            const enum status status = read_parts("t.0", &file, &error);
            assert_int_equal(status, off == 0 || off == 2 ? STATUS_OK : STATUS_BAD_INPUT);
            if (status)
                assert_non_null(
                    strstr(error.message, parts == 1 ? "and it has" : "all parts have"));
            snapshot_file_free(&file);
        }
}

/* Parts of which one has a different item, or of our own snapshots a different corner of the box,
 * boundary or case, are not joined. */
TEST(parts_with_different_items)
{
    static const struct {
        const char *item, *says;
        bool gone;
        double value; /* of the first number, or of the one at `at` */
        int at;
    } rows[] = {{"Header/Time", "another time", false, 4, 0},
                {"Header/Time", "another time", true, 0, 0},
                {"Header/Gamma", "another gamma", false, 1.5, 0},
                {"Header/Gamma", "another gamma", true, 0, 0},
                {"Header/BoxSize", "another box", false, 9001, 0},
                {"Header/BoxSize", "another box", false, 9002, 1},
                {"Header/BoxSize", "another box", false, 9003, 2},
                {"Header/BoxSize", "another box", true, 0, 0},
                {"Header/Origin", "another box", false, -4, 0},
                {"Header/Origin", "another box", false, 41, 1},
                {"Header/Origin", "another box", false, 6, 2},
                {"Header/Origin", "another box", true, 0, 0},
                {"Header/Boundary", "another boundary", false, 0, 0},
                {"Header/Boundary", "another boundary", true, 0, 0},
                {"Header/Case", "another case", false, 0, 0},
                {"Header/Case", "another case", true, 0, 0},
                {"Header/Dimension", "another dimension", true, 0, 0},
                {"Header/NumPart_ThisFile", "cut off or damaged", false, 3, 0},
                {"Header/NumFilesPerSnapshot", "another number of files", false, 3, 0},
                {"PartType0/Masses", "m than the other parts", true, 0, 0},
                {"PartType0/Pressure", "P than the other parts", true, 0, 0},
                {"PartType0/Acceleration", "ax than the other parts", true, 0, 0}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        for (int which = 0; which < (rows[k].gone ? 3 : 2); which++) { /* 2: both parts lack it */
            struct snapshot_file file;
            struct error error;
            struct item items[2][ITEMS_MAX];
            char name[32];
            const size_t n = gadget->count + 3;
            for (int p = 0; p < 2; p++) {
                part(p, 2, items[p]);
                items[p][n - 3] =
                    (struct item){"Header/Case", true, TEXT, 0, {0}, false, {0}, "sedov", 0};
                items[p][n - 2] =
                    (struct item){"Header/Origin", true, F64, 1, {3}, false, {-3, 40, 5}, "", 0};
                items[p][n - 1] =
                    (struct item){"Header/Boundary", true, TEXT, 0, {0}, false, {0}, "open", 0};
            }
            for (size_t i = 0; i < 2 * n; i++) {
                struct item *item = &items[i % 2][i / 2];
                if (strcmp(item->path, rows[k].item) || which == 1 - (int)(i % 2)) continue;
                if (rows[k].gone)
                    item->path[0] = '\0';
                else if (item->stored == TEXT)
                    strcpy(item->text, "fixed");
                else
                    item->values[rows[k].at] = rows[k].value;
            }
            for (int p = 0; p < 2; p++) {
                snprintf(name, sizeof name, "s.%d", p);
                write_items(path_of(name), items[p], n);
            }
            const bool masses = strstr(rows[k].item, "Masses"); /* masses are in the table */
            const enum status status = read_parts("s.0", &file, &error);
            snapshot_file_free(&file);
            if (masses || which == 2) {
                assert_int_equal(status, STATUS_OK);
                continue;
            }
            const bool counted = strstr(rows[k].says, "than");
            if (counted && !strstr(error.message, which ? "has less " : "has more "))
                fail_msg("%s", error.message);
            if (status != STATUS_BAD_INPUT || !strstr(error.message, rows[k].says))
                fail_msg("%s of part %d: '%s' is not in: %s", rows[k].item, which, rows[k].says,
                         error.message);
            const bool own = strstr(rows[k].says, "cut off"); /* a fault of the file itself */
            assert_non_null(strstr(error.message, own && !which ? "s.0" : "s.1"));
        }
}

/* The precision is that of the coarsest part. */
TEST(precision)
{
    for (int which = 0; which < 2; which++) {
        struct snapshot_file file;
        struct error error;
        char name[32];
        for (int p = 0; p < 2; p++) {
            struct item items[ITEMS_MAX];
            part(p, 2, items);
            items[0].stored = p == which ? F32 : F64; /* positions */
            items[1].stored = p == which ? F64 : F32;
            snprintf(name, sizeof name, "p.%d.h5", p);
            write_part(name, items);
        }
        if (read_parts("p.0.h5", &file, &error)) fail_msg("%s", error.message);
        for (int k = 0; k < 2; k++) assert_true(file.precision[k] == (double)FLT_EPSILON / 2);
        snapshot_file_free(&file);
    }
}

TEST(names)
{
    static const struct {
        const char *first, *second, *says; /* says NULL: both are read */
    } rows[] = {{"a.0", "a.1", NULL},
                {"a.0.hdf5", "a.1.hdf5", NULL},
                {"a.05.0.hdf5", "a.05.1.hdf5", NULL},
                {"a.0b.0.hdf5", "a.0b.1.hdf5", NULL},
                {"d.0/a.0.hdf5", "d.0/a.1.hdf5", NULL},
                {"d.0.5/a.0.hdf5", "d.0.5/a.1.hdf5", NULL},
                {"c.0.hdf5", "c.2.hdf5", "c.1.hdf5: cannot be read"},
                {"c.1.hdf5", "c.2.hdf5", "one of 2 files of a snapshot; give the first"},
                {"c.hdf5", "d.hdf5", "give the first"},
                {"c.01.hdf5", "c.11.hdf5", "give the first"},
                {"d.0/c.hdf5", "d.1/c.hdf5", "give the first"},
                {"d.0.5/c.hdf5", "d.1.5/c.hdf5", "give the first"}};
    char command[300];
    snprintf(command, sizeof command, "cd %s && mkdir d.0 d.1 d.0.5 d.1.5", own_folder);
    assert_int_equal(system(command), 0);
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct snapshot_file file;
        struct error error;
        for (int p = 0; p < 2; p++) {
            struct item items[ITEMS_MAX];
            part(p, 2, items);
            write_part(p ? rows[k].second : rows[k].first, items);
        }
        const enum status status = read_parts(rows[k].first, &file, &error);
        if (status != (rows[k].says ? STATUS_BAD_INPUT : STATUS_OK) ||
            (rows[k].says && !strstr(error.message, rows[k].says)))
            fail_msg("%s: %s", rows[k].first, error.message);
        if (!status) assert_int_equal(file.n, 2 * N - 1);
        snapshot_file_free(&file);
    }
    char here_too[4096]; /* a path without folders */
    struct snapshot_file file;
    struct error error = {0};
    assert_true(getcwd(here_too, sizeof here_too) && chdir(own_folder) == 0);
    assert_int_equal(snapshot_read("a.0", &here, &file, &error), STATUS_OK);
    assert_true(file.n == 2 * N - 1 && chdir(here_too) == 0);
    snapshot_file_free(&file);
}

#endif
