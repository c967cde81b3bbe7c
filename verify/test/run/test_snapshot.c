/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a run writes as its snapshot in HDF5. */
#include "test.h"

#include "keyed.h"
#include "run.h"
#include "snapshot_file.h"

#ifdef HAVE_HDF5
#include <hdf5.h>

#include "made_place.h"

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
            const double at = d < box->dim ? s->x[d][i] - box->lo[d] : 0;
            assert_true(x[3 * i + (size_t)d] == at);
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
TEST(runs_are_written)
{
    static const struct {
        const char *name, *keys;
    } cases[] = {{"sod", "n=30 t_end=0.01"},
                 {"shear", "n=8^2 t_end=0.01"},
                 {"rest_2d", "n=12^2 hi=1.2,1.5"},
                 {"rest_3d", "n=8^3 t_end=0.01"}};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        const struct run run = keyed_run(cases[c].name, cases[c].keys);
        struct run_result result = keyed_result(&run);
        struct error error;
        if (run_write_snapshot(&result, path_of("run.hdf5"), &error))
            fail_msg("%s: %s", cases[c].name, error.message);
        const hid_t file = H5Fopen(path_of("run.hdf5"), H5F_ACC_RDONLY, H5P_DEFAULT);
        assert_true(file >= 0);
        header_is_of(file, &result);
        gas_is_of(file, &result);
        H5Fclose(file);
        run_free(&result);
    }
}

/* A snapshot has periods only if it has a box, and only along directions that are periodic. */
TEST(periods)
{
    static const struct {
        const char *boundary;
        double period[3];
    } rows[] = {{"", {2, 3, 5}},
                {"periodic", {2, 3, 5}},
                {"reflecting", {0, 0, 0}},
                {"periodic reflecting", {2, 0, 0}},
                {"open periodic fixed", {0, 3, 0}}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        for (int boxed = 0; boxed < 2; boxed++) {
            struct snapshot_file file = {.boxed = boxed, .box = {2, 3, 5}};
            strcpy(file.boundary, rows[k].boundary);
            for (int d = 0; d < 3; d++)
                assert_true(snapshot_period(&file, d) == boxed * rows[k].period[d]);
        }
}

#endif
