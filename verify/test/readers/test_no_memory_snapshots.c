/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests snapshots of any format, `judge` and the library in which one allocation after the other
 * fails: each reports "no memory". The argument is the folder of the fuzzers' examples. */
#include "test.h"

#include "failing_memory.h"
#include "sample_snapshot.h"
#include "snapshot_csv.h"
#include "sphproof/convergence.h"
#include "sphproof/gradients.h"
#include "sphproof/kernels.h"
#include "sphproof/rates.h"
#include "sphproof/simulations.h"

static const char *read_path;

static enum status read_file(struct error *error)
{
    const struct snapshot_options here = {.here = true};
    struct snapshot_file file;
    const enum status status = snapshot_read(read_path, &here, &file, error);
    snapshot_file_free(&file);
    return status;
}

TEST(formats_without_memory)
{
    static const char *const names[] = {
        "csv/table.csv",       "splash/splash.ascii",
        "gadget/one.gadget",   "gadget/two.gadget",
        "gadget/plain.gadget", "gadget/two_other.gadget",
        "phantom/big",         "vtu/text",
        "vtu/binary",          "vtu/appended",
        "vtu/packed",
    };
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        char path[4096];
        snprintf(path, sizeof path, "%s/%s", test_word(1), names[k]);
        read_path = path;
        without_memory(read_file, 3, true);
    }
}

static void write_file(const char *name, const char *text)
{
    FILE *out = fopen(path_of(name), "w");
    assert_non_null(out);
    fputs(text, out);
    assert_int_equal(fclose(out), 0);
}

TEST(vtk_without_memory)
{
    write_file("a.vtk",
               "# vtk DataFile Version 3.0\nparticles\nASCII\nDATASET POLYDATA\n"
               "POINTS 4 double\n0 0 0 1 0 0 2 0 0 3 0 0\nPOINT_DATA 4\nSCALARS rho double 1\n"
               "LOOKUP_TABLE default\n1 2 3 4\nVECTORS vel float\n0 0 0 1 0 0 0 0 0 1 0 0\nSCALARS "
               "m double\nLOOKUP_TABLE default\n1 1 1 1\n");
    read_path = path_of("a.vtk");
    without_memory(read_file, 6, true);
}

static enum status named(struct error *error)
{
    struct snapshot_file said;
    struct csv csv;
    char unknown[200];
    const enum status status = snapshot_csv_named(read_path, &said, &csv, unknown, error);
    csv_free(&csv);
    return status;
}

TEST(names_without_memory)
{
    write_file("n.csv", "x,density,colour\n1,2,3\n4,5,6\n");
    read_path = path_of("n.csv");
    without_memory(named, 6, true);
}

static int calls;

static void count_call(void)
{
    calls++;
}

/* Memory is asked for up to the most rows that are allowed. */
TEST(most_rows)
{
    for (int more = 0; more < 2; more++) {
        struct snapshot_file file = {.n = (size_t)SNAPSHOT_ROWS_MAX + (size_t)more};
        struct error error = {0};
        calls = 0;
        at_each_call = count_call;
        left = 0;
        const enum status status = snapshot_file_make(&file, SNAPSHOT_X, "a", &error);
        left = -1;
        at_each_call = NULL;
        assert_int_equal(status, STATUS_ENVIRONMENT);
        assert_int_equal(calls, !more);
    }
}

static enum status as_csv(struct error *error)
{
    struct snapshot_file file;
    struct csv csv;
    char why[200];
    const enum status status = snapshot_csv(read_path, &file, &csv, why, error);
    snapshot_file_free(&file);
    csv_free(&csv);
    return status;
}

static enum status judged(struct error *error)
{
    const struct judge_request request = uniform_gas();
    struct judged judged;
    const enum status status = judge_snapshot(read_path, &request, &judged, error);
    judge_free(&judged);
    return status;
}

TEST(judge_without_memory)
{
    for (int k = 0; k < 3; k++) { /* without u, without P, with both */
        plant(1, 0, "");          /* without a box the case's own initial state is not computed */
        gas.has_u = k != 0, gas.has_P = k != 1, gas.has_h = k == 2;
        for (int i = 0; i < N; i++) gas.h[i] = 0.004;
        read_path = put("a.csv");
        spared = 1; /* the case may lack its reference without an error */
        without_memory(judged, 10, true);
    }
    without_memory(as_csv, 20, true);
}

/* ---- the library ---- */

static enum status passed(enum sphproof_status status, const struct sphproof_error *theirs,
                          struct error *error)
{
    return status ? error_set(error, (enum status)status, "%s", theirs->message) : STATUS_OK;
}

static double shape_w(double q, int dim)
{
    (void)dim;
    return q < 1 ? (1 - q * q) * (1 - q * q) : 0;
}

static double shape_dw(double q, int dim)
{
    (void)dim;
    return q < 1 ? -4 * q * (1 - q * q) : 0;
}

static enum status kernels(struct error *error)
{
    const struct sphproof_shape shape = {
        .w = shape_w, .dw = shape_dw, .dim = 1, .smoothness = -1, .knot_count = -1};
    struct sphproof_kernel *kernel = NULL;
    struct sphproof_error theirs;
    enum sphproof_status status = sphproof_kernels_find("cubic_spline", &kernel, &theirs);
    assert_true(!kernel == !!status);
    sphproof_kernels_free(kernel);
    if (!status) {
        status = sphproof_kernels_own(&shape, &kernel, &theirs);
        assert_true(!kernel == !!status);
        sphproof_kernels_free(kernel);
    }
    return passed(status, &theirs, error);
}

static enum status setups(struct error *error)
{
    static const char *const keys[] = {"kernel=cubic_spline", NULL};
    double arrays[4][16], norms[16];
    struct sphproof_setup setup = {.dim = 1,
                                   .n = 16,
                                   .gamma = 1.4,
                                   .hi = {1},
                                   .x = {arrays[0]},
                                   .v = {arrays[1]},
                                   .m = arrays[2],
                                   .u = arrays[3],
                                   .keys = keys};
    const struct sphproof_rates rates = {.rho = norms};
    struct sphproof_simulation *simulation;
    struct sphproof_norms found;
    struct sphproof_error theirs;
    for (int i = 0; i < 16; i++)
        arrays[0][i] = (i + 0.5) / 16, arrays[1][i] = 0, arrays[2][i] = arrays[3][i] = 1. / 16;
    enum sphproof_status status = sphproof_rates_evaluate(&setup, &rates, &theirs);
    if (!status)
        status = sphproof_convergence_norms(16, NULL, arrays[0], arrays[1], &found, &theirs);
    if (!status) {
        status = sphproof_simulations_create(&setup, &simulation, &theirs);
        assert_true(!simulation == !!status);
        sphproof_simulations_free(simulation);
    }
    return passed(status, &theirs, error);
}

static bool no_gradients(void *context, const struct sphproof_cloud *cloud, const double *f,
                         double *const gradient[])
{
    (void)context, (void)f;
    for (size_t i = 0; i < cloud->n; i++) gradient[0][i] = 0;
    return true;
}

static enum status gradients(struct error *error)
{
    const struct sphproof_gradient_promise promise = {2, 0.85, 2.4, true, true, true, true};
    struct sphproof_error theirs;
    return passed(sphproof_gradients_check(no_gradients, NULL, 1, &promise, NULL, NULL, &theirs),
                  &theirs, error);
}

TEST(library_without_memory)
{
    without_memory(gradients, 20, false);
    without_memory(kernels, 2, true);
    without_memory(setups, 8, true);
}
