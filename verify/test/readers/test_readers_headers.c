/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests headers of HDF5 snapshots: alternative names, boxes, dimensions, precision, comoving units,
 * and files that no reader knows. */
#include "test.h"

#ifdef HAVE_HDF5
#include <float.h>

#include "sample_layouts.h"

/* ---- other names and additional items of a layout ---- */

static struct item *item_called(struct item *items, const char *path)
{
    while (strcmp(items->path, path) != 0) items++;
    return items;
}

static void add_number(struct item *item, const char *path, double value)
{
    *item = (struct item){.attribute = true, .values = {value}};
    snprintf(item->path, sizeof item->path, "%s", path);
}

TEST(other_names)
{
    static const struct {
        int layout;
        const char *from, *to;
    } rows[] = {{0, "PartType0/SmoothingLength", "PartType0/Hsml"},
                {0, "PartType0/Acceleration", "PartType0/HydroAcceleration"},
                {0, "Header/Gamma", "Header/gamma"},
                {0, "Header/Gamma", "Parameters/Gamma"},
                {1, "HydroScheme/Dimension", "Header/Dimension"}};
    struct item items[ITEMS_MAX];
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        items_of(&layouts[rows[k].layout], items);
        snprintf(item_called(items, rows[k].from)->path, sizeof items->path, "%s", rows[k].to);
        reads(&layouts[rows[k].layout], items, rows[k].to);
    }
    /* the name of the code */
    for (int k = 0; k < 4; k++) {
        static const char *const codes[] = {"AREPO or GADGET-4", "GIZMO 2022", "SWIFT v1.0",
                                            "SWIFT"};
        struct layout l = layouts[k > 1];
        const size_t n = items_of(&l, items);
        l.code = codes[k];
        l.count = n + 1;
        l.fields[n] = (struct field){.path = "Config/x", .meaning = IGNORED};
        if (k < 2) {
            add_number(&items[n], k ? "Header/GIZMO_version" : "Config/x", 2022);
        } else {
            items[n] = (struct item){.attribute = true, .stored = TEXT};
            strcpy(items[n].path, "Code/Git Revision");
            strcpy(items[n].text, k == 2 ? "v1.0" : "unknown");
        }
        reads(&l, items, codes[k]);
    }
    struct layout l = layouts[0]; /* AREPO's */
    items_of(&l, items);
    strcpy(item_called(items, "Header/Gamma")->path, "Config/GAMMA");
    l.code = "AREPO or GADGET-4";
    reads(&l, items, "Config/GAMMA");
}

/* Runs in an expanding universe are refused, by their flag or else by redshift and time. */
TEST(comoving_runs_are_refused)
{
    static const struct {
        const char *path;
        double said, redshift, time;
        bool comoving;
    } rows[] = {{"Header/ComovingIntegrationOn", 1, 0, 3, true},
                {"Parameters/ComovingIntegrationOn", 1, 0, 3, true},
                {"Cosmology/Cosmological run", 1, 0, 3, true},
                {"Header/ComovingIntegrationOn", 0, 1, 0.5, false},
                {NULL, 0, 1, 0.5, true},
                {NULL, 0, 1, 0.5 * (1 + 9e-7), true},
                {NULL, 0, 1, 0.5 * (1 + 3e-6), false},
                {NULL, 0, 1, 3, false},
                {NULL, 0, 0, 1, false},
                {NULL, 0, -0.5, 2, false}};
    for (int a = 0; a < 2; a++)
        for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
            struct layout l = layouts[a];
            struct item items[ITEMS_MAX];
            const size_t n = items_of(&l, items);
            item_called(items, "Header/Time")->values[0] = rows[k].time;
            for (size_t f = 0; f < n; f++)
                if (l.fields[f].meaning == TIME) l.fields[f].value = rows[k].time;
            l.fields[n] = l.fields[n + 1] = (struct field){.path = "", .meaning = IGNORED};
            add_number(&items[n], rows[k].path ? rows[k].path : "", rows[k].said);
            add_number(&items[n + 1], "Header/Redshift", rows[k].redshift);
            l.count = n + 2;
            if (rows[k].comoving)
                refuses(&l, items, "an expanding box", "comoving");
            else
                reads(&l, items, "no expanding box");
        }
}

TEST(boxes)
{
    static const struct {
        int count;
        double box[3];
        bool boxed;
        double wanted[3];
    } rows[] = {{1, {20}, true, {20, 20, 20}},
                {3, {20, 21, 22}, true, {20, 21, 22}},
                {2, {20, 21}, true, {20, 21, 0}},
                {1, {0}, false, {0}},
                {1, {-1}, false, {0}},
                {1, {(double)NAN}, false, {0}},
                {1, {(double)INFINITY}, false, {0}},
                {3, {20, -1, 22}, true, {20, 0, 22}},
                {3, {20, (double)INFINITY, 22}, true, {20, 0, 22}}};
    struct item items[ITEMS_MAX];
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        items_of(&layouts[0], items);
        struct item *box = item_called(items, "Header/BoxSize");
        box->rank = rows[k].count > 1, box->shape[0] = (hsize_t)rows[k].count;
        memcpy(box->values, rows[k].box, sizeof rows[k].box);
        struct snapshot_file file = file_of(items, layouts[0].count, "a box");
        assert_true(file.boxed == rows[k].boxed);
        for (int d = 0; d < 3; d++) assert_true(file.box[d] == rows[k].wanted[d]);
        snapshot_file_free(&file);
    }
    for (int n = 2; n <= 3; n++) { /* the sides of our own initial states, all three */
        items_of(&layouts[0], items);
        item_called(items, "Header/BoxSize")->rank = 0;
        item_called(items, "Header/BoxSize")->values[0] = 20;
        items[layouts[0].count] =
            (struct item){"Header/Sides", true, F64, 1, {(hsize_t)n}, false, {20, 5, 3}, "", 0};
        struct snapshot_file file = file_of(items, layouts[0].count + 1, "sides");
        assert_true(file.box[0] == 20 && file.box[1] == (n < 3 ? 20 : 5) &&
                    file.box[2] == (n < 3 ? 20 : 3));
        snapshot_file_free(&file);
    }
    static const struct {
        int at;
        double value;
    } wrong[] = {{0, (double)NAN},      {1, -9}, {1, -8},
                 {1, (double)INFINITY}, {4, 7},  {5, (double)NAN}};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) { /* one wrong end suffices */
        items_of(&layouts[2], items);
        item_called(items, "Step#10/box")->values[wrong[k].at] = wrong[k].value;
        struct snapshot_file file = file_of(items, layouts[2].count, "a wrong end");
        assert_false(file.boxed);
        assert_true(file.column[0][0] == 0);
        snapshot_file_free(&file);
    }
}

/* A note names the first unit that is not 1. */
TEST(units)
{
    static const struct {
        const char *path;
        double unit;
        bool noted;
    } rows[] = {{"Units/Unit length in cgs (U_L)", 3.1e18, true},
                {"Units/Unit mass in cgs (U_M)", 0.9, true},
                {"Units/Unit time in cgs (U_t)", 1 + 2e-6, true},
                {"Units/Unit time in cgs (U_t)", 1 - 5e-7, false},
                {"Header/UnitLength_in_cm", 2, true},
                {"Parameters/UnitMass_in_g", 2, true},
                {"Header/UnitVelocity_In_CGS", 1e5, true},
                {"Header/UnitVelocity_In_CGS", 1, false},
                {"Header/Unit", 2, false}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct item items[ITEMS_MAX];
        const size_t n = items_of(&layouts[0], items);
        add_number(&items[n], rows[k].path, rows[k].unit);
        add_number(&items[n + 1], "Parameters/UnitVelocity_in_cm_per_s", 3);
        struct snapshot_file file = file_of(items, n + 1 + (k < 2), rows[k].path);
        noted(&file, "units", rows[k].noted ? "not converted" : NULL,
              strchr(rows[k].path, '/') + 1);
        snapshot_file_free(&file);
    }
}

/* Phantom's dead particles, whose h is not above 0, are left out; the box is used if it contains
 * all others. */
TEST(phantom)
{
    static const char *const ends[] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"};
    for (int dead = 0; dead < 3; dead++)
        /* the end that is missing, or that lies within the gas; 12: none; 13: all ends are at
         * particles; 14: one is infinitely far */
        for (int end = 0; end < 15; end++) {
            struct item items[ITEMS_MAX];
            size_t n = items_of(&layouts[3], items);
            struct item *h = item_called(items, "particles/h");
            if (dead) h->values[5] = dead == 1 ? 0 : -3;
            for (int k = 0; k < 6; k++) {
                char path[40];
                snprintf(path, sizeof path, "header/%s", ends[k]);
                add_number(&items[n], path, k % 2 ? 20 + k : -k);
                items[n].attribute = dead;
                if (end == k) items[n].path[0] = '\0';
                if (end == 6 + k) items[n].values[0] = 6;
                if (end == 13) items[n].values[0] = k / 2 + (k % 2 ? 11 : 0);
                if (end == 14 && k == 3) items[n].values[0] = (double)INFINITY;
                n++;
            }
            struct snapshot_file file = file_of(items, n, "Phantom");
            assert_int_equal(file.n, dead ? N - 1 : N);
            assert_int_equal(file.gas, dead ? N - 4 : N - 3);
            assert_true(file.boxed == (end == 12 || end == 13) && file.placed == file.boxed);
            noted(&file, "dead particles", dead ? "1 of 12 rows left out" : NULL,
                  "their h is not above 0");
            for (int d = 0; d < 3 && file.boxed; d++)
                assert_true(end == 13 ? file.corner[d] == d && file.box[d] == 11
                                      : file.corner[d] == -2 * d && file.box[d] == 21 + 4 * d);
            if (dead) assert_true(file.column[SNAPSHOT_X][3] == 6); /* after rows 0, 1, 3 */
            snapshot_file_free(&file);
        }
}

/* Of SPH-EXA's steps the last one is read, which may be the first; other names are no steps. */
TEST(first_step)
{
    static const char *const others[] = {"Step#/x", "Step#1a/x", "Step/x", "step#7/x"};
    struct item items[ITEMS_MAX];
    const size_t n = items_of(&layouts[2], items);
    size_t extra = 0;
    for (size_t k = 0; k < n; k++) {
        char name[40];
        if (strncmp(items[k].path, "Step#10/", 8) != 0)
            snprintf(items[k].path, sizeof items[k].path, "%s", others[extra++]);
        else {
            snprintf(name, sizeof name, "%s", items[k].path + 8);
            snprintf(items[k].path, sizeof items[k].path, "Step#0/%s", name);
        }
    }
    assert_int_equal(extra, 3);
    struct snapshot_file file = file_of(items, n, "the first step");
    noted(&file, "step", "Step#0", "the last one of the file");
    snapshot_file_free(&file);
}

/* Our own snapshots have the box's corner, from which positions count, and the name of the case. */
TEST(corner_of_the_box)
{
    for (int numbers = 0; numbers <= 4; numbers++) /* numbers in the corner; 4: without a box */
        for (int columns = 1; columns <= 3; columns += 2) {
            struct item items[ITEMS_MAX];
            size_t n = items_of(&layouts[0], items);
            const bool counts = numbers == 3;
            struct item *x = item_called(items, "PartType0/Coordinates");
            x->shape[1] = (hsize_t)columns;
            for (int i = 0; i < N * columns; i++) x->values[i] = (7 * i) % 13;
            item_called(items, "Header/Dimension")->path[0] = '\0';
            if (numbers == 4) item_called(items, "Header/BoxSize")->path[0] = '\0';
            items[n] = (struct item){"Header/Origin", true, F64, 1, {3}, false, {-3, 40, 5}, "", 0};
            items[n++].shape[0] = numbers && numbers < 4 ? (hsize_t)numbers : 3;
            if (!numbers) n--;
            items[n++] = (struct item){"Header/Case", true, TEXT, 0, {0}, false, {0}, "sod", 0};
            items[n++] =
                (struct item){"Header/Keys", true, TEXT, 0, {0}, false, {0}, "n=3; eta=4", 0};
            items[n++] =
                (struct item){"Header/Boundary", true, TEXT, 0, {0}, false, {0}, "open", 0};
            struct snapshot_file file = file_of(items, n, "a corner");
            assert_true(file.placed == counts);
            for (int d = 0; d < 3; d++) {
                const double corner = d ? d == 1 ? 40 : 5 : -3;
                assert_true(file.corner[d] == (counts && d < columns ? corner : 0));
                for (int i = 0; i < N && d < columns; i++)
                    assert_true(file.column[d][i] ==
                                (7 * (columns * i + d)) % 13 + (counts ? corner : 0));
            }
            assert_string_equal(file.case_name, "sod");
            assert_string_equal(file.keys, "n=3; eta=4");
            assert_string_equal(file.boundary, "open");
            snapshot_file_free(&file);
        }
}

/* The precision is that of the coarsest column except positions. */
TEST(precision)
{
    static const struct {
        enum stored stored;
        double precision;
    } rows[] = {{F80, DBL_EPSILON / 2}, {F32, (double)FLT_EPSILON / 2}, {F16, 0x1p-11}};
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++)
        for (size_t k = 0; k < layouts[0].count; k++) {
            const struct field *f = &layouts[0].fields[k];
            struct item items[ITEMS_MAX];
            const size_t n = items_of(&layouts[0], items);
            items[k].stored = rows[r].stored;
            struct snapshot_file file = file_of(items, n, f->path);
            const bool column = f->meaning == COLUMN, x = column && f->column < SNAPSHOT_VX;
            assert_true(file.precision[0] == (x ? rows[r].precision : DBL_EPSILON / 2));
            assert_true(file.precision[1] == (column && !x ? rows[r].precision : DBL_EPSILON / 2));
            snapshot_file_free(&file);
        }
}

/* The number of dimensions is that of the last direction along which positions vary, by more than
 * a millionth of the greatest extent, 2. */
static void dimensions_with_noise(double noise)
{
    for (int width = 1; width <= 3; width++)
        for (int planted = 0; planted < 1 << width; planted++)
            for (int v = 1; v <= 3; v++) {
                const int varies = planted && noise > 2e-6 ? (1 << width) - 1 : planted;
                struct snapshot_file file;
                struct error error = {0};
                struct item items[ITEMS_MAX];
                items_of(&layouts[0], items);
                item_called(items, "Header/Dimension")->path[0] = '\0';
                struct item *x = item_called(items, "PartType0/Coordinates"),
                            *velocity = item_called(items, "PartType0/Velocities");
                x->shape[1] = (hsize_t)width;
                velocity->shape[1] = (hsize_t)v;
                for (int i = 0; i < N; i++)
                    for (int d = 0; d < width; d++)
                        x->values[width * i + d] = planted >> d & 1
                                                       ? (i == N - 1 ? 7 : 5)
                                                       : 5 + (planted && i % 2 ? noise : 0);
                write_items(path_of("d.hdf5"), items, layouts[0].count);
                const enum status status = snapshot_read(path_of("d.hdf5"), &here, &file, &error);
                const int dim = varies == 1 ? 1 : varies == 3 ? 2 : varies == 7 ? 3 : 0;
                const int fixed = varies & 1 ? 1 : 0, beyond = varies & 2 && !fixed ? 1 : 2;
                char says[64];
                snprintf(says, sizeof says, "positions differ along %c but not along %c;",
                         "xyz"[beyond], "xyz"[fixed]);
                assert_int_equal(status, dim && v >= dim ? STATUS_OK : STATUS_BAD_INPUT);
                if (status)
                    assert_non_null(strstr(error.message, !varies ? "all particles are at one place"
                                                          : !dim  ? says
                                                          : v < 2 ? "no vy"
                                                                  : "no vz"));
                else
                    assert_true(file.dim == dim);
                snapshot_file_free(&file);
            }
}

TEST(dimensions)
{
    dimensions_with_noise(0);
    dimensions_with_noise(1.99e-6);
    dimensions_with_noise(2.01e-6);
}

/* The header states as many dimensions as positions have columns, or more. */
TEST(stated_dimensions)
{
    for (int said = 1; said <= 3; said++) {
        struct item items[ITEMS_MAX];
        const size_t n = items_of(&layouts[0], items);
        item_called(items, "Header/Dimension")->values[0] = said;
        item_called(items, "PartType0/Coordinates")->shape[1] = (hsize_t)said;
        struct snapshot_file file = file_of(items, n, "dimensions");
        assert_int_equal(file.dim, said);
        snapshot_file_free(&file);
    }
    for (int said = 2; said <= 3; said++) {
        struct item items[ITEMS_MAX];
        char says[80];
        items_of(&layouts[0], items);
        item_called(items, "Header/Dimension")->values[0] = said;
        item_called(items, "PartType0/Coordinates")->shape[1] = (hsize_t)said - 1;
        snprintf(says, sizeof says, "says that it has %d dimensions, but has no %c", said,
                 "xyz"[said - 1]);
        refuses(&layouts[0], items, "dimensions", says);
    }
    static const double others[] = {0, 4, (double)NAN}; /* none of these counts */
    for (int k = 0; k < 4; k++) {
        struct item items[ITEMS_MAX];
        struct layout l = layouts[0];
        items_of(&l, items);
        item_called(items, "Header/Dimension")->values[0] = k ? others[k - 1] : 1;
        for (size_t f = 0; f < l.count; f++)
            if (l.fields[f].meaning == DIMENSION) l.fields[f].meaning = IGNORED;
        if (k)
            reads(&l, items, "another number of dimensions");
        else
            refuses(&l, items, "dimensions",
                    "says that it has 1 dimensions, but positions differ along 3");
    }
}

/* ---- unknown files ---- */

TEST(unknown_files)
{
    static const struct {
        const char *paths[3], *says;
    } rows[] = {
        {{"stuff/a", "more/b"}, "it has: more stuff"},
        {{"Header/Time"}, "no gas (PartType0); it has: Header"},
        {{"Header/Time", "PartType1/x"}, "(dark matter only?)"},
        {{"Header/Time", "HydroScheme/x", "PartType1/x"}, "it has: Header HydroScheme PartType1"},
        {{"Header/Time", "PartType0/x"}, "PartType0 holds no Coordinates; it has: x"},
        {{"header/time"}, "it has: header"},
        {{"header/time", "particles/x"}, "particles holds no xyz; it has: x"},
        {{"Step#/x"}, "it has: Step#"},
        {{"Step#3x/x"}, "it has: Step#3x"},
        {{"Step#3/y"}, "Step#3 holds no x; it has: y"}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct item items[3] = {0};
        struct layout l = {.name = rows[k].says, .count = 3};
        for (int i = 0; i < 3 && rows[k].paths[i]; i++) {
            items[i].rank = 1, items[i].shape[0] = 5;
            strcpy(items[i].path, rows[k].paths[i]);
        }
        refuses(&l, items, rows[k].paths[0], rows[k].says);
    }
}

#endif
