/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests HDF5 snapshots: every attribute and array of the file. If any library call fails, neither a
 * file nor an open handle is left. The linker's --wrap makes calls of the C library fail
 * (meson.build). */
#include "test.h"

#include "own_folder.h"
#include "snapshot_writer.h"

extern const struct snapshot_writer writer_hdf5, writer_gadget_hdf5;

TEST(names)
{
    static const struct {
        const char *path, *writer; /* NULL: refused */
    } rows[] = {{"a.hdf5", "hdf5"},     {"a.h5", "hdf5"},    {"a/b.c.h5", "hdf5"}, {"a.csv", "csv"},
                {"a.vtu", "vtu"},       {"a.h5.csv", "csv"}, {"hdf5", "csv"},      {"", "csv"},
                {"-", "csv"},           {"a.b/c", "csv"},    {"a.txt", "csv"},     {"a.dat", "csv"},
                {"a.hdf5x", NULL},      {"a.vtk", NULL},     {"a.", NULL},         {"a.h", NULL},
                {"a.hdf5 .h5", "hdf5"}, {"a.VTU", NULL}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct error error = {0};
        const struct snapshot_writer *writer = snapshot_writer_of(rows[k].path, &error);
        assert_true(!writer == !rows[k].writer);
        if (writer)
            assert_string_equal(writer->member.name, rows[k].writer);
        else if (!strstr(error.message, "allowed: .csv .txt .dat .hdf5 .h5 .vtu, or no ending"))
            fail_msg("%s", error.message);
    }
}

/* ---- calls that fail ---- */

static long calls, refused; /* number of calls, and of the one that fails; 0: none */

#define WRAP(type, name, parameters, arguments, failure)                                           \
    type __real_##name parameters;                                                                 \
    type __wrap_##name parameters;                                                                 \
    type __wrap_##name parameters                                                                  \
    {                                                                                              \
        return ++calls == refused ? failure : __real_##name arguments;                             \
    }
WRAP(void *, calloc, (size_t a, size_t b), (a, b), NULL)
WRAP(void *, malloc, (size_t a), (a), NULL)

#ifdef HAVE_HDF5

#include "h5.h"

#define FAIL(type, name, parameters, arguments)                                                    \
    static type name##_fails parameters                                                            \
    {                                                                                              \
        return ++calls == refused ? -1 : H5##name arguments;                                       \
    }

FAIL(hid_t, Acreate2, (hid_t a, const char *b, hid_t c, hid_t d, hid_t e, hid_t f),
     (a, b, c, d, e, f))
FAIL(herr_t, Awrite, (hid_t a, hid_t b, const void *c), (a, b, c))
FAIL(hid_t, Dcreate2, (hid_t a, const char *b, hid_t c, hid_t d, hid_t e, hid_t f, hid_t g),
     (a, b, c, d, e, f, g))
FAIL(herr_t, Dwrite, (hid_t a, hid_t b, hid_t c, hid_t d, hid_t e, const void *f),
     (a, b, c, d, e, f))
FAIL(hid_t, Fcreate, (const char *a, unsigned b, hid_t c, hid_t d), (a, b, c, d))
FAIL(herr_t, Fflush, (hid_t a, H5F_scope_t b), (a, b))
FAIL(ssize_t, Fget_file_image, (hid_t a, void *b, size_t c), (a, b, c))
FAIL(hid_t, Gcreate2, (hid_t a, const char *b, hid_t c, hid_t d, hid_t e), (a, b, c, d, e))

static long unclosed; /* dataspaces and property lists, which the library does not count */

#define COUNT(type, name, parameters, arguments, step)                                             \
    static type name##_counts parameters                                                           \
    {                                                                                              \
        unclosed += step;                                                                          \
        return H5##name arguments;                                                                 \
    }
COUNT(hid_t, Screate, (H5S_class_t a), (a), 1)
COUNT(hid_t, Screate_simple, (int a, const hsize_t *b, const hsize_t *c), (a, b, c), 1)
COUNT(herr_t, Sclose, (hid_t a), (a), -1)
COUNT(hid_t, Pcreate, (hid_t a), (a), 1)
COUNT(herr_t, Pclose, (hid_t a), (a), -1)

/* Replaces the library's functions. */
static void take_their_place(void)
{
    h5.Acreate2 = Acreate2_fails;
    h5.Awrite = Awrite_fails;
    h5.Dcreate2 = Dcreate2_fails;
    h5.Dwrite = Dwrite_fails;
    h5.Fcreate = Fcreate_fails;
    h5.Fflush = Fflush_fails;
    h5.Fget_file_image = Fget_file_image_fails;
    h5.Gcreate2 = Gcreate2_fails;
    h5.Screate = Screate_counts;
    h5.Screate_simple = Screate_simple_counts;
    h5.Sclose = Sclose_counts;
    h5.Pcreate = Pcreate_counts;
    h5.Pclose = Pclose_counts;
}

/* The number of open objects: also files, groups, arrays and attributes. */
static long open_things(void)
{
    return (long)H5Fget_obj_count((hid_t)H5F_OBJ_ALL, H5F_OBJ_ALL) + unclosed;
}

/* ---- a state ---- */

enum { N = 5 };
static double of[11][N + 1]; /* x, v, m, rho, u, P, h; one more after the last */

static struct run_result made(int dim, bool cube)
{
    for (int k = 0; k < 11; k++)
        for (int i = 0; i <= N; i++) of[k][i] = 1 + k + 0.125 * i;
    struct run_result result = {.n = N, .time = 0.375};
    result.problem.gamma = 1.625;
    result.problem.domain = (struct domain){dim, {-0.5, 0.25, 0.75}, {1.5, 2.25, 2.75}};
    if (!cube) result.problem.domain.hi[dim - 1] += 1;
    result.snapshot = (struct snapshot){.n = N,
                                        .x = {of[0], of[1], of[2]},
                                        .v = {of[3], of[4], of[5]},
                                        .m = of[6],
                                        .rho = of[7],
                                        .u = of[8],
                                        .P = of[9],
                                        .h = of[10]};
    for (int d = dim; d < 3; d++) result.snapshot.x[d] = result.snapshot.v[d] = NULL;
    return result;
}

/* ---- contents of the file ---- */

/* count: 0 for an attribute that is not an array. */
static void attribute(hid_t file, const char *name, H5T_class_t class, size_t bytes, int count,
                      const double *want)
{
    const hid_t self = H5Aopen_by_name(file, "Header", name, H5P_DEFAULT, H5P_DEFAULT);
    if (self < 0) fail_msg("no %s", name);
    const hid_t type = H5Aget_type(self), space = H5Aget_space(self);
    double values[8];
    assert_true(H5Tget_class(type) == class && H5Tget_size(type) == bytes);
    assert_int_equal(H5Sget_simple_extent_ndims(space), count > 0);
    assert_int_equal(H5Sget_simple_extent_npoints(space), count ? count : 1);
    assert_true(H5Aread(self, H5T_NATIVE_DOUBLE, values) >= 0);
    for (int i = 0; i < (count ? count : 1); i++)
        if (values[i] != want[i]) fail_msg("%s: %g, not %g", name, values[i], want[i]);
    H5Tclose(type);
    H5Sclose(space);
    H5Aclose(self);
}

static void one(hid_t file, const char *name, double want)
{
    attribute(file, name, H5T_FLOAT, 8, 0, &want);
}

static void flag(hid_t file, const char *name, double want)
{
    attribute(file, name, H5T_INTEGER, 4, 0, &want);
}

/* An array of `width` columns, 1 or 3; columns[d] NULL: zeros. */
static void array(hid_t file, const char *name, H5T_class_t class, int width,
                  const double *const columns[3], const double lo[3])
{
    char path[64];
    snprintf(path, sizeof path, "PartType0/%s", name);
    const hid_t self = H5Dopen2(file, path, H5P_DEFAULT);
    if (self < 0) fail_msg("no %s", name);
    const hid_t type = H5Dget_type(self), space = H5Dget_space(self);
    hsize_t shape[2] = {0, 1};
    double values[3 * N];
    assert_true(H5Tget_class(type) == class && H5Tget_size(type) == 8);
    assert_int_equal(H5Sget_simple_extent_ndims(space), width > 1 ? 2 : 1);
    H5Sget_simple_extent_dims(space, shape, NULL);
    assert_true(shape[0] == N && shape[1] == (hsize_t)width);
    assert_true(H5Dread(self, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0);
    for (int i = 0; i < N; i++)
        for (int d = 0; d < width; d++) {
            const double want = columns[d] ? columns[d][i] - lo[d] : 0;
            if (values[width * i + d] != want)
                fail_msg("%s %d: %g, not %g", name, i, values[width * i + d], want);
        }
    H5Tclose(type);
    H5Sclose(space);
    H5Dclose(self);
}

static hsize_t members(hid_t file, const char *group)
{
    H5G_info_t info;
    assert_true(H5Gget_info_by_name(file, group, &info, H5P_DEFAULT) >= 0);
    return info.nlinks;
}

TEST(whole_files)
{
    for (int k = 0; k < 12; k++) {
        const int dim = 1 + k % 6 / 2;
        const bool cube = k % 2 || dim == 1, gadget = k < 6; /* GADGET-4 refuses three sizes */
        const struct run_result result = made(dim, k % 2);
        const struct snapshot *s = &result.snapshot;
        struct error error;
        char path[256];
        snprintf(path, sizeof path, "%s", path_of("s.hdf5"));
        const struct snapshot_writer *writer = gadget ? &writer_gadget_hdf5 : &writer_hdf5;
        assert_int_equal(writer->write(&result, path, &error), STATUS_OK);
        const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
        assert_true(file >= 0 && members(file, "/") == 2 && members(file, "Header") == 0);
        const double count[6] = {N}, none[6] = {0}, *lo = result.problem.domain.lo;
        attribute(file, "NumPart_ThisFile", H5T_INTEGER, 4, 6, count);
        attribute(file, "NumPart_Total", H5T_INTEGER, 4, 6, count);
        attribute(file, "NumPart_Total_HighWord", H5T_INTEGER, 4, 6, none);
        attribute(file, "MassTable", H5T_FLOAT, 8, 6, none);
        one(file, "Time", 0.375);
        double side[3] = {2, dim > 1 ? 2 : 1, dim > 2 ? 2 : 1};
        if (k % 2 == 0) side[dim - 1] = 3;
        if (cube || !gadget)
            attribute(file, "BoxSize", H5T_FLOAT, 8, cube ? 0 : 3, side);
        else
            one(file, "BoxSize", 3), attribute(file, "Sides", H5T_FLOAT, 8, 3, side);
        attribute(file, "Origin", H5T_FLOAT, 8, 3, lo);
        one(file, "Gamma", 1.625);
        flag(file, "Dimension", dim);
        flag(file, "NumFilesPerSnapshot", 1);
        flag(file, "Flag_DoublePrecision", 1);
        flag(file, "Flag_Sfr", 0);
        flag(file, "Flag_Cooling", 0);
        flag(file, "Flag_Feedback", 0);
        flag(file, "Flag_StellarAge", 0);
        flag(file, "Flag_Metals", 0);
        one(file, "Redshift", 0);
        one(file, "Omega0", 0);
        one(file, "OmegaLambda", 0);
        one(file, "HubbleParam", 1);
        static const double zero[3] = {0}, number[N] = {1, 2, 3, 4, 5};
        const double *const numbers[3] = {number};
        array(file, "Coordinates", H5T_FLOAT, 3, s->x, lo);
        array(file, "Velocities", H5T_FLOAT, 3, s->v, zero);
        array(file, "ParticleIDs", H5T_INTEGER, 1, numbers, zero);
        static const char *const scalars[] = {"Masses", "Density", "InternalEnergy", "Pressure",
                                              "SmoothingLength"};
        for (int q = 0; q < 5; q++)
            array(file, scalars[q], H5T_FLOAT, 1, (const double *const[3]){of[6 + q]}, zero);
        assert_int_equal(members(file, "PartType0"), 8);
        H5Fclose(file);
        unlink(path);
    }
}

/* If any call fails there is no file, and nothing stays open. */
TEST(failures)
{
    const struct run_result result = made(2, false);
    struct error error = {0};
    char path[256];
    snprintf(path, sizeof path, "%s", path_of("f.h5"));
    assert_int_equal(writer_hdf5.possible(path, &error), STATUS_OK);
    take_their_place();
    const long open = open_things();
    calls = refused = 0;
    assert_int_equal(writer_hdf5.write(&result, path, &error), STATUS_OK);
    const long all = calls;
    assert_true(all > 50 && open_things() == open);
    unlink(path);
    for (long k = 1; k <= all; k++) {
        calls = 0, refused = k;
        error = (struct error){0};
        const enum status status = writer_hdf5.write(&result, path, &error);
        refused = 0;
        if (status != STATUS_ENVIRONMENT || !error.message[0] || access(path, F_OK) == 0)
            fail_msg("call %ld of %ld: status %d", k, all, (int)status);
        assert_int_equal(open_things(), open);
    }
    assert_int_equal(writer_hdf5.write(&result, path_of("no/such/folder.h5"), &error),
                     STATUS_ENVIRONMENT);
    assert_int_equal(open_things(), open);
}
#else
TEST(whole_files) {}

TEST(failures)
{
    struct run_result result = {0};
    struct error error = {0};
    assert_int_equal(writer_hdf5.possible("a.h5", &error), STATUS_ENVIRONMENT);
    assert_int_equal(writer_hdf5.write(&result, "a.h5", &error), STATUS_ENVIRONMENT);
    assert_non_null(strstr(error.message, "a.h5: built without HDF5"));
}
#endif
