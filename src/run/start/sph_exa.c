/* SPDX-License-Identifier: GPL-3.0-or-later
 * HDF5 for SPH-EXA (Cavelan et al. 2020), a single step in the layout of H5Part with everything
 * that a restart reads, so that both `--init FILE` and `--init FILE,1` work. The support radius is
 * 2 h; temperatures are those that its ideal gas converts to our energies; x_m1 is the displacement
 * of the previous step. */
#include <math.h>
#include <stdlib.h>

#include "hdf5_image.h"
#include "start_format.h"

static const double gas_constant = 8.317e7, ion_weight = 10, alpha_min = 0.05;

/* Half of the step allowed by its Courant number of 0.2. */
static double first_step(const struct run_result *result)
{
    const struct snapshot *s = &result->snapshot;
    double step = INFINITY;
    for (size_t i = 0; i < s->n; i++)
        step = fmin(step, 0.1 * s->h[i] / sqrt(result->problem.gamma * s->P[i] / s->rho[i]));
    return step;
}

static void set_attributes(struct hdf5_image *image, const struct run_result *result, double step)
{
    const struct prepared *p = &result->problem;
    const uint64_t one = 1, n = result->n;
    const double nothing = 0;
    double box[6];
    signed char periodic[3];
    for (int d = 0; d < 3; d++) {
        box[2 * d] = p->domain.lo[d], box[2 * d + 1] = p->domain.hi[d];
        periodic[d] = p->boundary[d] == BOUNDARY_PERIODIC;
    }
    hdf5_image_attribute(image, "iteration", HDF5_UINT64, &one, 1);
    hdf5_image_attribute(image, "numParticlesGlobal", HDF5_UINT64, &n, 1);
    hdf5_image_attribute(image, "time", HDF5_DOUBLE, &result->time, 1);
    hdf5_image_attribute(image, "minDt", HDF5_DOUBLE, &step, 1);
    hdf5_image_attribute(image, "minDt_m1", HDF5_DOUBLE, &step, 1);
    hdf5_image_attribute(image, "gravConstant", HDF5_DOUBLE, &nothing, 1);
    hdf5_image_attribute(image, "gamma", HDF5_DOUBLE, &p->gamma, 1);
    hdf5_image_attribute(image, "muiConst", HDF5_DOUBLE, &ion_weight, 1);
    hdf5_image_attribute(image, "box", HDF5_DOUBLE, box, 6);
    hdf5_image_attribute(image, "boundaryType", HDF5_CHAR, periodic, 3);
}

/* Writes a dataset: values times factor, plus number. scratch: n numbers. */
static void set_field(struct hdf5_image *image, const char *name, const double *values,
                      double factor, double number, size_t n, double *scratch)
{
    for (size_t i = 0; i < n; i++) scratch[i] = (values ? factor * values[i] : 0) + number;
    hdf5_image_data(image, name, HDF5_DOUBLE, scratch, n, 1);
}

static void set_fields(struct hdf5_image *image, const struct run_result *result, double step,
                       double *scratch)
{
    const struct snapshot *s = &result->snapshot;
    const double warm = (result->problem.gamma - 1) * ion_weight / gas_constant;
    const struct {
        const char *name;
        const double *values;
        double factor, number;
    } fields[] = {{"x", s->x[0], 1, 0},
                  {"y", s->x[1], 1, 0},
                  {"z", s->x[2], 1, 0},
                  {"h", s->h, 1, 0},
                  {"m", s->m, 1, 0},
                  {"vx", s->v[0], 1, 0},
                  {"vy", s->v[1], 1, 0},
                  {"vz", s->v[2], 1, 0},
                  {"rho", s->rho, 1, 0},
                  {"p", s->P, 1, 0},
                  {"u", s->u, 1, 0},
                  {"temp", s->u, warm, 0},
                  {"x_m1", s->v[0], step, 0},
                  {"y_m1", s->v[1], step, 0},
                  {"z_m1", s->v[2], step, 0},
                  {"du_m1", NULL, 0, 0},
                  {"alpha", NULL, 0, alpha_min}};
    for (size_t k = 0; k < sizeof fields / sizeof *fields; k++)
        set_field(image, fields[k].name, fields[k].values, fields[k].factor, fields[k].number, s->n,
                  scratch);
}

static enum status write_sph_exa(const struct run_result *result, const char *path,
                                 struct error *error)
{
    struct hdf5_image image;
    const double step = first_step(result);
    if (hdf5_image_possible(path, error)) return error->status;
    double *scratch = malloc(result->n * sizeof *scratch);
    if (!scratch) return error_set(error, STATUS_ENVIRONMENT, "no memory for %.200s", path);
    hdf5_image_begin(&image);
    hdf5_image_group(&image, "Step#0");
    set_attributes(&image, result, step);
    set_fields(&image, result, step, scratch);
    free(scratch);
    return hdf5_image_end(&image, path, error);
}

static const struct snapshot_writer writer = {.possible = hdf5_image_possible,
                                              .write = write_sph_exa};

const struct start_format start_sph_exa = {
    .member = {"sph_exa", "HDF5 for SPH-EXA, a step of H5Part; the support is 2 h",
               "Cavelan et al. 2020"},
    .writer = &writer,
    .h_over_support = 0.5,
    .dim = 3,
    .no_walls = true,
    .t_end = "sphexa --init FILE -s T (with a decimal point: a time)",
};
