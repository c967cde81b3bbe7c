/* SPDX-License-Identifier: GPL-3.0-or-later
 * Snapshots in HDF5 in every layout that is read, written here with what codes leave out or say
 * otherwise; what must be refused, with the words that help; and what a run writes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "run.h"
#include "snapshot_file.h"

#ifdef HAVE_HDF5
#include <hdf5.h>

enum { N = 20 };
static char folder[] = "/tmp/sphproof_snapshot_XXXXXX";

static const char *path_of(const char *name)
{
    static char path[128];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static hid_t begin(const char *name)
{
    return H5Fcreate(path_of(name), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
}

static void group(hid_t file, const char *name)
{
    H5Gclose(H5Gcreate2(file, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
}

static void attribute(hid_t file, const char *at, const char *name, int n, const double *values)
{
    const hsize_t size = (hsize_t)n;
    const hid_t space = n == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &size, NULL);
    const hid_t self = H5Acreate_by_name(file, at, name, H5T_IEEE_F64LE, space, H5P_DEFAULT,
                                         H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(self, H5T_NATIVE_DOUBLE, values);
    H5Aclose(self);
    H5Sclose(space);
}

static void number(hid_t file, const char *at, const char *name, double value)
{
    attribute(file, at, name, 1, &value);
}

/* rows x columns, chunked and packed where there is room for it. */
static void dataset(hid_t file, const char *name, hid_t type, size_t rows, size_t columns,
                    const double *values)
{
    const hsize_t shape[2] = {rows, columns}, chunk[2] = {rows < 8 ? rows : 8, columns};
    const hid_t space = H5Screate_simple(columns > 1 ? 2 : 1, shape, NULL);
    const hid_t how = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(how, columns > 1 ? 2 : 1, chunk);
    H5Pset_shuffle(how);
    H5Pset_deflate(how, 4);
    const hid_t self = H5Dcreate2(file, name, type, space, H5P_DEFAULT, how, H5P_DEFAULT);
    H5Dwrite(self, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
    H5Dclose(self);
    H5Pclose(how);
    H5Sclose(space);
}

struct gas {
    double x[3 * N], v[3 * N], m[N], rho[N], u[N], h[N], type[N];
};

static struct gas gas(double first)
{
    struct gas g = {0};
    for (int i = 0; i < N; i++) {
        g.x[3 * i] = first + 0.05 * (i + 0.5);
        g.v[3 * i] = 0.125 * i;
        g.m[i] = 0.05, g.rho[i] = 1 + 0.01 * i, g.u[i] = 2.5, g.h[i] = 0.11;
        g.type[i] = i % 4 ? 1 : 4;
    }
    return g;
}

enum { NO_DENSITY = 1, NO_MASSES = 2, WRONG_ROWS = 4, A_NAN = 8, NO_VELOCITY = 16 };

/* A file of GADGET's kin, without its header. */
static hid_t gadget(const char *name, const char *particles, double first, int faults)
{
    struct gas g = gas(first);
    char path[64];
    const hid_t file = begin(name);
    group(file, "Header");
    group(file, particles);
    if (faults & A_NAN) g.u[7] = 0. / (g.type[1] - 1);
#define PUT(dataset_name, type, columns, values)                                                   \
    snprintf(path, sizeof path, "%s/%s", particles, dataset_name);                                 \
    dataset(file, path, type, N, columns, values)
    PUT("Coordinates", H5T_IEEE_F64LE, 3, g.x);
    if (!(faults & NO_VELOCITY)) {
        PUT("Velocities", H5T_IEEE_F32LE, 3, g.v);
    }
    if (!(faults & NO_MASSES)) {
        PUT("Masses", H5T_IEEE_F32BE, 1, g.m);
    }
    snprintf(path, sizeof path, "%s/Density", particles);
    if (!(faults & NO_DENSITY))
        dataset(file, path, H5T_IEEE_F32LE, faults & WRONG_ROWS ? N - 1 : N, 1, g.rho);
    PUT("InternalEnergy", H5T_IEEE_F32LE, 1, g.u);
    PUT("SmoothingLength", H5T_IEEE_F32LE, 1, g.h);
#undef PUT
    return file;
}

static void header(hid_t file, double time, double box)
{
    const double count[] = {N, 0, 0, 0, 0, 0};
    number(file, "Header", "Time", time);
    number(file, "Header", "BoxSize", box);
    attribute(file, "Header", "NumPart_ThisFile", 6, count);
}

static const struct snapshot_options plain;

static void reads(const char *name, struct snapshot_file *file)
{
    struct error error = {0};
    if (snapshot_read(path_of(name), &plain, file, &error)) fail_msg("%s", error.message);
}

static void refuses(const char *name, const char *word)
{
    struct snapshot_file file;
    struct error error = {0};
    const enum status status = snapshot_read(path_of(name), &plain, &file, &error);
    snapshot_file_free(&file);
    assert_int_equal(status, STATUS_BAD_INPUT);
    if (!strstr(error.message, word)) fail_msg("no '%s' in: %s", word, error.message);
}

static void gadget_says_little(void **state)
{
    struct snapshot_file file;
    const double table[2] = {0.25, 0}, box[3] = {1, 2, 3};
    (void)state;
    hid_t h = gadget("table.hdf5", "PartType0", 0, NO_MASSES);
    number(h, "Header", "Time", 0.5);
    attribute(h, "Header", "MassTable", 2, table);
    attribute(h, "Header", "BoxSize", 3, box);
    H5Fclose(h);
    reads("table.hdf5", &file);
    assert_int_equal(file.n, N);
    assert_int_equal(file.dim, 1);
    assert_true(file.boxed && file.box[1] == 2 && file.time.value == 0.5 && !file.gamma.known);
    assert_true(file.column[SNAPSHOT_M][N - 1] == 0.25);
    assert_true(file.column[SNAPSHOT_X][3] == 0.05 * 3.5 && file.column[SNAPSHOT_VX][8] == 1);
    assert_true(file.precision[0] < 1e-15 && file.precision[1] > 1e-8);
    snapshot_file_free(&file);
    h = gadget("nobox.hdf5", "PartType0", 0, 0);
    header(h, 0, 0);
    H5Fclose(h);
    reads("nobox.hdf5", &file);
    assert_false(file.boxed);
    snapshot_file_free(&file);
}

static void several_files(void **state)
{
    struct snapshot_file file;
    (void)state;
    for (int part = 0; part < 2; part++) {
        char name[32];
        snprintf(name, sizeof name, "snap_007.%d.hdf5", part);
        const hid_t h = gadget(name, "PartType0", part, 0);
        header(h, 0.5, 2);
        number(h, "Header", "NumFilesPerSnapshot", 2);
        H5Fclose(h);
    }
    reads("snap_007.0.hdf5", &file);
    assert_int_equal(file.n, 2 * N);
    assert_int_equal(file.gas, 2 * N);
    assert_true(file.column[SNAPSHOT_X][N] == 1 + 0.025);
    snapshot_file_free(&file);
    remove(path_of("snap_007.1.hdf5"));
    refuses("snap_007.0.hdf5", "snap_007.1.hdf5");
}

static void sph_exa_has_steps(void **state)
{
    struct snapshot_file file;
    const hid_t h = begin("exa.h5");
    const double box[6] = {-1, 1, -1, 1, -1, 1};
    (void)state;
    for (int step = 2; step < 11; step += 8) { /* Step#10 comes after Step#2 */
        struct gas g = gas(-1);
        char at[32], name[64];
        double x[N];
        snprintf(at, sizeof at, "Step#%d", step);
        group(h, at);
        number(h, at, "time", 0.1 * step);
        number(h, at, "gamma", 1.4);
        attribute(h, at, "box", 6, box);
        for (int i = 0; i < N; i++) x[i] = g.x[3 * i];
        const struct {
            const char *name;
            const double *values;
        } columns[] = {{"x", x}, {"vx", g.u}, {"m", g.m}, {"rho", g.rho}, {"u", g.u}, {"h", g.h}};
        for (size_t k = 0; k < sizeof columns / sizeof *columns; k++) {
            snprintf(name, sizeof name, "%s/%s", at, columns[k].name);
            dataset(h, name, H5T_IEEE_F64LE, N, 1, columns[k].values);
        }
    }
    H5Fclose(h);
    reads("exa.h5", &file);
    assert_string_equal(file.layout, "sph_exa");
    assert_true(file.time.value == 1 && file.gamma.value == 1.4 && file.box[0] == 2);
    assert_true(file.column[SNAPSHOT_X][0] > 0.02 && file.column[SNAPSHOT_X][0] < 0.03);
    snapshot_file_free(&file);
}

static void phantom_has_no_density(void **state)
{
    struct snapshot_file file;
    struct gas g = gas(0);
    const hid_t h = begin("phantom.h5");
    const double one = 0.3, mass[2] = {0.05, 7}, gamma = 1.4, hfact = 1.2;
    (void)state;
    for (int i = 0; i < N; i++) g.x[3 * i + 1] = 0.1 * (i % 3), g.x[3 * i + 2] = 0.1 * (i % 5);
    group(h, "header"), group(h, "particles");
    dataset(h, "header/time", H5T_IEEE_F64LE, 1, 1, &one);
    dataset(h, "header/gamma", H5T_IEEE_F64LE, 1, 1, &gamma);
    dataset(h, "header/hfact", H5T_IEEE_F64LE, 1, 1, &hfact);
    dataset(h, "header/massoftype", H5T_IEEE_F64LE, 2, 1, mass);
    dataset(h, "particles/xyz", H5T_IEEE_F64LE, N, 3, g.x);
    dataset(h, "particles/vxyz", H5T_IEEE_F64LE, N, 3, g.v);
    dataset(h, "particles/u", H5T_IEEE_F64LE, N, 1, g.u);
    dataset(h, "particles/h", H5T_IEEE_F32LE, N, 1, g.h);
    dataset(h, "particles/itype", H5T_STD_I8LE, N, 1, g.type);
    H5Fclose(h);
    reads("phantom.h5", &file);
    assert_string_equal(file.layout, "phantom_hdf5");
    assert_int_equal(file.gas, N - N / 4);
    assert_true(file.time.value == 0.3 && file.gamma.value == 1.4 && file.dim == 3);
    assert_true(file.column[SNAPSHOT_X][0] == 0.05 * 1.5); /* row 0 is no gas */
    const double ratio = 1.2 / (double)(float)0.11;
    assert_true(file.column[SNAPSHOT_RHO][3] / (0.05 * ratio * ratio * ratio) > 1 - 1e-6);
    assert_true(file.column[SNAPSHOT_RHO][3] / (0.05 * ratio * ratio * ratio) < 1 + 1e-6);
    snapshot_file_free(&file);
}

static void what_is_refused(void **state)
{
    static const struct {
        const char *name, *particles, *word;
        int faults;
        double redshift, parts, count, comoving;
    } cases[] = {
        {"density.hdf5", "PartType0", "holds no Density", NO_DENSITY, 0, 1, N, 0},
        {"velocity.hdf5", "PartType0", "holds no Velocities", NO_VELOCITY, 0, 1, N, 0},
        {"masses.hdf5", "PartType0", "no masses", NO_MASSES, 0, 1, N, 0},
        {"dark.hdf5", "PartType1", "dark matter only?", 0, 0, 1, N, 0},
        {"rows.hdf5", "PartType0", "19 x 1", WRONG_ROWS, 0, 1, N, 0},
        {"nan.hdf5", "PartType0", "u of particle 7", A_NAN, 0, 1, N, 0},
        {"redshift.hdf5", "PartType0", "comoving", 0, 1, 1, N, 0},
        {"said.hdf5", "PartType0", "comoving", 0, 0, 1, N, 1},
        {"parts.hdf5", "PartType0", "NumFilesPerSnapshot", 0, 0, 1e6, N, 0},
        {"part.hdf5", "PartType0", "one of 3 files", 0, 0, 3, N, 0},
        {"count.hdf5", "PartType0", "cut off or damaged", 0, 0, 1, N + 1, 0},
    };
    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const hid_t h = gadget(cases[k].name, cases[k].particles, 0, cases[k].faults);
        number(h, "Header", "Time", 0.5);
        number(h, "Header", "Redshift", cases[k].redshift);
        number(h, "Header", "NumFilesPerSnapshot", cases[k].parts);
        attribute(h, "Header", "NumPart_ThisFile", 1, &cases[k].count);
        if (cases[k].comoving > 0) number(h, "Header", "ComovingIntegrationOn", 1);
        H5Fclose(h);
        refuses(cases[k].name, cases[k].word);
    }
    hid_t h = gadget("dimension.hdf5", "PartType0", 0, 0);
    header(h, 0, 1);
    number(h, "Header", "Dimension", 2);
    H5Fclose(h);
    refuses("dimension.hdf5", "2 dimensions");
    h = begin("other.hdf5");
    group(h, "stuff");
    H5Fclose(h);
    refuses("other.hdf5", "stuff");
}

/* ---- what a run writes ---- */

static size_t attribute_of(hid_t file, const char *name, hid_t type, void *values)
{
    const hid_t self = H5Aopen_by_name(file, "Header", name, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t space = H5Aget_space(self);
    const hssize_t n = H5Sget_simple_extent_npoints(space);
    assert_true(self >= 0 && n <= 6 && H5Aread(self, type, values) >= 0);
    H5Sclose(space);
    H5Aclose(self);
    return (size_t)n;
}

static double number_of(hid_t file, const char *name)
{
    double value[6];
    assert_int_equal(attribute_of(file, name, H5T_NATIVE_DOUBLE, value), 1);
    return value[0];
}

/* columns: 0 for a plain list. */
static void data_of(hid_t file, const char *name, hid_t type, size_t n, size_t columns,
                    void *values)
{
    hsize_t shape[2] = {0};
    const hid_t self = H5Dopen2(file, name, H5P_DEFAULT), space = H5Dget_space(self);
    assert_int_equal(H5Sget_simple_extent_dims(space, shape, NULL), columns ? 2 : 1);
    assert_true(shape[0] == n && shape[1] == columns);
    assert_true(H5Dread(self, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0);
    H5Sclose(space);
    H5Dclose(self);
}

static void header_is_of(hid_t file, const struct run_result *run)
{
    const struct domain *box = &run->problem.domain;
    static const char *const none[] = {"Flag_Sfr",        "Flag_Cooling", "Flag_Feedback",
                                       "Flag_StellarAge", "Flag_Metals",  "Redshift",
                                       "Omega0",          "OmegaLambda"};
    static const char *const counts[] = {"NumPart_ThisFile", "NumPart_Total"};
    double side[6], lo[6], masses[6];
    unsigned count[6];
    const size_t sides = attribute_of(file, "BoxSize", H5T_NATIVE_DOUBLE, side);
    bool cube = true;
    for (int d = 0; d < box->dim; d++) cube &= domain_length(box, d) == domain_length(box, 0);
    assert_int_equal(sides, cube ? 1 : 3);
    assert_int_equal(attribute_of(file, "Origin", H5T_NATIVE_DOUBLE, lo), 3);
    for (size_t d = 0; d < (size_t)box->dim; d++) {
        assert_true(side[sides > 1 ? d : 0] == domain_length(box, (int)d));
        assert_true(lo[d] == box->lo[d]);
    }
    for (size_t k = 0; k < 2; k++) {
        assert_int_equal(attribute_of(file, counts[k], H5T_NATIVE_UINT, count), 6);
        for (size_t i = 0; i < 6; i++) assert_int_equal(count[i], i ? 0 : run->n);
    }
    assert_int_equal(attribute_of(file, "NumPart_Total_HighWord", H5T_NATIVE_UINT, count), 6);
    for (size_t i = 0; i < 6; i++) assert_int_equal(count[i], 0);
    assert_int_equal(attribute_of(file, "MassTable", H5T_NATIVE_DOUBLE, masses), 6);
    for (size_t i = 0; i < 6; i++) assert_true(masses[i] == 0);
    assert_true(number_of(file, "Time") == run->time);
    assert_true(number_of(file, "Gamma") == run->problem.gamma);
    assert_true(number_of(file, "Dimension") == box->dim);
    assert_true(number_of(file, "NumFilesPerSnapshot") == 1);
    assert_true(number_of(file, "Flag_DoublePrecision") == 1);
    assert_true(number_of(file, "HubbleParam") == 1);
    for (size_t k = 0; k < sizeof none / sizeof *none; k++)
        assert_true(number_of(file, none[k]) == 0);
}

static void gas_is_of(hid_t file, const struct run_result *run)
{
    const struct snapshot *s = &run->snapshot;
    const struct domain *box = &run->problem.domain;
    const struct {
        const char *name;
        const double *values;
    } lists[] = {{"PartType0/Masses", s->m},
                 {"PartType0/Density", s->rho},
                 {"PartType0/InternalEnergy", s->u},
                 {"PartType0/Pressure", s->P},
                 {"PartType0/SmoothingLength", s->h}};
    double *x = malloc(7 * s->n * sizeof *x), *v = x + 3 * s->n, *list = v + 3 * s->n;
    uint64_t *id = malloc(s->n * sizeof *id);
    assert_true(x && id);
    data_of(file, "PartType0/Coordinates", H5T_NATIVE_DOUBLE, s->n, 3, x);
    data_of(file, "PartType0/Velocities", H5T_NATIVE_DOUBLE, s->n, 3, v);
    data_of(file, "PartType0/ParticleIDs", H5T_NATIVE_UINT64, s->n, 0, id);
    for (size_t i = 0; i < s->n; i++) {
        assert_int_equal(id[i], i + 1);
        for (int d = 0; d < 3; d++) {
            const double place = d < box->dim ? s->x[d][i] - box->lo[d] : 0;
            assert_true(x[3 * i + (size_t)d] == place);
            assert_true(v[3 * i + (size_t)d] == (d < box->dim ? s->v[d][i] : 0));
        }
    }
    for (size_t k = 0; k < sizeof lists / sizeof *lists; k++) {
        data_of(file, lists[k].name, H5T_NATIVE_DOUBLE, s->n, 0, list);
        assert_memory_equal(list, lists[k].values, s->n * sizeof *list);
    }
    free(x);
    free(id);
}

/* In 1D, a plane that is no square, and space. */
static void runs_are_written(void **state)
{
    (void)state;
    static const struct {
        const char *name, *words[2];
    } cases[] = {{"sod", {"n=30", "t_end=0.01"}},
                 {"shear", {"n=8^2", "t_end=0.01"}},
                 {"rest_2d", {"n=12^2", "hi=1.2,1.5"}},
                 {"rest_3d", {"n=8^3", "t_end=0.01"}}};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        struct run_settings settings;
        struct run run;
        struct run_result result;
        struct error error = {0};
        if (run_prepare(&settings, cases[c].name, 2, (char *const *)(uintptr_t)cases[c].words,
                        &error) ||
            run_resolve(&run, &settings, &error) || run_execute(&run, &result, &error) ||
            run_write_snapshot(&result, path_of("run.hdf5"), &error))
            fail_msg("%s: %s", cases[c].name, error.message);
        const hid_t file = H5Fopen(path_of("run.hdf5"), H5F_ACC_RDONLY, H5P_DEFAULT);
        assert_true(file >= 0);
        header_is_of(file, &result);
        gas_is_of(file, &result);
        H5Fclose(file);
        run_free(&result);
    }
}

/* Only a box has periods, along the directions that the boundary does not close or open. */
static void periods(void **state)
{
    static const struct {
        const char *boundary;
        double period[3];
    } rows[] = {{"", {2, 3, 5}},
                {"periodic", {2, 3, 5}},
                {"reflecting", {0, 0, 0}},
                {"periodic reflecting", {2, 0, 0}},
                {"open periodic fixed", {0, 3, 0}}};
    (void)state;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        for (int boxed = 0; boxed < 2; boxed++) {
            struct snapshot_file file = {.boxed = boxed, .box = {2, 3, 5}};
            strcpy(file.boundary, rows[k].boundary);
            for (int d = 0; d < 3; d++)
                assert_true(snapshot_period(&file, d) == boxed * rows[k].period[d]);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(runs_are_written),
        cmocka_unit_test(gadget_says_little),
        cmocka_unit_test(several_files),
        cmocka_unit_test(sph_exa_has_steps),
        cmocka_unit_test(phantom_has_no_density),
        cmocka_unit_test(what_is_refused),
        cmocka_unit_test(periods),
    };
    char command[96];
    if (!mkdtemp(folder)) return 1;
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    snprintf(command, sizeof command, "rm -r %s", folder);
    return system(command) || failed;
}

#else

int main(void)
{
    puts("no HDF5");
    return 77; /* skipped */
}
#endif
