/* SPDX-License-Identifier: GPL-3.0-or-later
 * HDF5 in the layout of GADGET's snapshots (Springel 2005), which yt, pynbody and ParaView read.
 * Header: NumPart_*, MassTable, Time, BoxSize (one number, or one per direction if sides differ;
 * for GADGET-4, which refuses three, the largest side, and then Sides has all of them), Dimension,
 * Gamma, Origin, and as text Case, Boundary and Keys (see snapshot_writer.h). PartType0:
 * Coordinates (from the lower corner of the box, `Origin`; z = 0 in 2D), Velocities, Masses,
 * Density, InternalEnergy, Pressure, SmoothingLength (support radius), ParticleIDs (from 1, in the
 * initial order). */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "hdf5_image.h"
#include "snapshot_writer.h"

/* Metadata without an attribute in GADGET: Case, Boundary and Keys. */
static void set_remarks(struct hdf5_image *image, const struct run_result *result)
{
    static const struct {
        const char *key, *attribute;
    } names[] = {{"case", "Case"}, {"boundary", "Boundary"}, {"keys", "Keys"}};
    struct snapshot_remark remarks[SNAPSHOT_REMARKS];
    const size_t count = snapshot_remarks(result, remarks);
    for (size_t k = 0; k < count; k++)
        for (size_t i = 0; i < sizeof names / sizeof *names; i++)
            if (!strcmp(remarks[k].key, names[i].key))
                hdf5_image_text(image, names[i].attribute, remarks[k].value);
}

enum { TYPES = 6 }; /* particle types, gas first */

static void set_header(struct hdf5_image *image, const struct run_result *result, bool one_size)
{
    const struct domain *box = &result->problem.domain;
    const unsigned count[TYPES] = {(unsigned)result->n}, none[TYPES] = {0};
    const double masses[TYPES] = {0}, zero = 0, one = 1;
    const int files = 1, no = 0, yes = 1, dim = box->dim;
    double side[3] = {[2] = 1}, largest = 0;
    size_t sides = 1;
    for (int d = 0; d < dim; d++) {
        side[d] = domain_length(box, d);
        largest = fmax(largest, side[d]);
        if (side[d] != side[0]) sides = 3;
    }
    hdf5_image_group(image, "Header");
    hdf5_image_attribute(image, "NumPart_ThisFile", HDF5_UINT, count, TYPES);
    hdf5_image_attribute(image, "NumPart_Total", HDF5_UINT, count, TYPES);
    hdf5_image_attribute(image, "NumPart_Total_HighWord", HDF5_UINT, none, TYPES);
    hdf5_image_attribute(image, "MassTable", HDF5_DOUBLE, masses, TYPES);
    hdf5_image_attribute(image, "Time", HDF5_DOUBLE, &result->time, 1);
    hdf5_image_attribute(image, "BoxSize", HDF5_DOUBLE, one_size ? &largest : side,
                         one_size ? 1 : sides);
    if (one_size && sides > 1) hdf5_image_attribute(image, "Sides", HDF5_DOUBLE, side, sides);
    hdf5_image_attribute(image, "Origin", HDF5_DOUBLE, box->lo, 3);
    hdf5_image_attribute(image, "Gamma", HDF5_DOUBLE, &result->problem.gamma, 1);
    hdf5_image_attribute(image, "Dimension", HDF5_INT, &dim, 1);
    hdf5_image_attribute(image, "NumFilesPerSnapshot", HDF5_INT, &files, 1);
    hdf5_image_attribute(image, "Flag_DoublePrecision", HDF5_INT, &yes, 1);
    static const char *const off[] = {"Flag_Sfr",        "Flag_Cooling", "Flag_Feedback",
                                      "Flag_StellarAge", "Flag_Metals",  "Flag_Entropy_ICs"};
    for (size_t k = 0; k < sizeof off / sizeof *off; k++)
        hdf5_image_attribute(image, off[k], HDF5_INT, &no, 1);
    static const char *const still[] = {"Redshift", "Omega0", "OmegaLambda"};
    for (size_t k = 0; k < sizeof still / sizeof *still; k++)
        hdf5_image_attribute(image, still[k], HDF5_DOUBLE, &zero, 1);
    hdf5_image_attribute(image, "HubbleParam", HDF5_DOUBLE, &one, 1);
    set_remarks(image, result);
}

static void set_gas(struct hdf5_image *image, const struct run_result *result)
{
    const struct snapshot *s = &result->snapshot;
    const struct domain *box = &result->problem.domain;
    double *vectors = calloc(6 * s->n, sizeof *vectors), *v = vectors ? vectors + 3 * s->n : NULL;
    uint64_t *number = malloc(s->n * sizeof *number);
    image->good &= vectors && number;
    for (size_t i = 0; image->good && i < s->n; i++) {
        number[i] = i + 1;
        for (int d = 0; d < box->dim; d++) {
            vectors[3 * i + (size_t)d] = domain_offset(box, d, s->x[d][i]);
            v[3 * i + (size_t)d] = s->v[d][i];
        }
    }
    const struct {
        const char *name;
        const double *values;
    } scalars[] = {{"Masses", s->m},
                   {"Density", s->rho},
                   {"InternalEnergy", s->u},
                   {"Pressure", s->P},
                   {"SmoothingLength", s->h}};
    hdf5_image_group(image, "PartType0");
    if (image->good) {
        hdf5_image_data(image, "Coordinates", HDF5_DOUBLE, vectors, s->n, 3);
        hdf5_image_data(image, "Velocities", HDF5_DOUBLE, v, s->n, 3);
        hdf5_image_data(image, "ParticleIDs", HDF5_UINT64, number, s->n, 1);
        for (size_t k = 0; k < sizeof scalars / sizeof *scalars; k++)
            hdf5_image_data(image, scalars[k].name, HDF5_DOUBLE, scalars[k].values, s->n, 1);
    }
    free(vectors);
    free(number);
}

static enum status write_image(const struct run_result *result, const char *path, bool one_size,
                               struct error *error)
{
    struct hdf5_image image;
    if (hdf5_image_possible(path, error)) return error->status;
    hdf5_image_begin(&image);
    set_header(&image, result, one_size);
    set_gas(&image, result);
    return hdf5_image_end(&image, path, error);
}

static enum status write_hdf5(const struct run_result *result, const char *path,
                              struct error *error)
{
    return write_image(result, path, false, error);
}

static enum status write_gadget(const struct run_result *result, const char *path,
                                struct error *error)
{
    return write_image(result, path, true, error);
}

const struct snapshot_writer writer_hdf5 = {
    .member = {"hdf5", "HDF5 in GADGET's layout: .hdf5 .h5", "Springel 2005"},
    .endings = ".hdf5 .h5",
    .from_corner = true,
    .memory = 250, /* for the file image in memory */
    .possible = hdf5_image_possible,
    .write = write_hdf5,
};

/* Of initial states alone. */
extern const struct snapshot_writer writer_gadget_hdf5;
const struct snapshot_writer writer_gadget_hdf5 = {
    .from_corner = true,
    .possible = hdf5_image_possible,
    .write = write_gadget,
};
