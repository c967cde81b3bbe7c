/* SPDX-License-Identifier: GPL-3.0-or-later
 * HDF5 as GADGET's snapshots are laid out (Springel 2005): what yt, pynbody and ParaView read.
 * Header: NumPart_*, MassTable, Time, BoxSize (one number, or one each where sides differ),
 * Dimension, Gamma, Origin, and as text Case, Boundary and Keys (see snapshot_remarks.h);
 * PartType0: Coordinates (from the lower corner of the box, `Origin`, z = 0 in 2D), Velocities,
 * Masses, Density, InternalEnergy, Pressure, SmoothingLength (support radius), ParticleIDs (from 1,
 * in the order of the start). The file is made in memory and written as any other one. */
#include <stdlib.h>
#include <string.h>

#include "output.h"
#include "snapshot_remarks.h"
#include "snapshot_writer.h"

#ifdef HAVE_HDF5
#include <hdf5.h>

/* A file in memory; what failed stays false. */
struct image {
    hid_t file;
    bool good;
};

/* Of an identifier, or of what a call returns. */
static bool went_well(hid_t code)
{
    return code >= 0;
}

static void set_attribute(struct image *image, hid_t group, const char *name, hid_t type,
                          const void *values, hsize_t count)
{
    const hid_t space = count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &count, NULL);
    const hid_t attribute = H5Acreate2(group, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    image->good &= went_well(attribute) && went_well(H5Awrite(attribute, type, values));
    if (went_well(attribute)) H5Aclose(attribute);
    H5Sclose(space);
}

static void set_data(struct image *image, hid_t group, const char *name, hid_t type,
                     const void *values, hsize_t rows, hsize_t columns)
{
    const hsize_t shape[2] = {rows, columns};
    const hid_t space = H5Screate_simple(columns > 1 ? 2 : 1, shape, NULL);
    const hid_t data = H5Dcreate2(group, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    image->good &=
        went_well(data) && went_well(H5Dwrite(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values));
    if (went_well(data)) H5Dclose(data);
    H5Sclose(space);
}

/* What no attribute of GADGET's says: Case, Boundary and Keys. */
static void set_remarks(struct image *image, hid_t header, const struct run_result *result)
{
    static const struct {
        const char *key, *attribute;
    } names[] = {{"case", "Case"}, {"boundary", "Boundary"}, {"keys", "Keys"}};
    struct snapshot_remark remarks[SNAPSHOT_REMARKS];
    const size_t count = snapshot_remarks(result, remarks);
    for (size_t k = 0; k < count; k++)
        for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
            if (strcmp(remarks[k].key, names[i].key)) continue;
            const hid_t text = H5Tcopy(H5T_C_S1);
            H5Tset_size(text, strlen(remarks[k].value) + 1);
            set_attribute(image, header, names[i].attribute, text, remarks[k].value, 1);
            H5Tclose(text);
        }
}

enum { TYPES = 6 }; /* of particles, gas first */

static void set_header(struct image *image, const struct run_result *result)
{
    const struct domain *box = &result->problem.domain;
    const hid_t header = H5Gcreate2(image->file, "Header", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    const unsigned count[TYPES] = {(unsigned)result->n}, none[TYPES] = {0};
    const double masses[TYPES] = {0}, zero = 0, one = 1;
    const int files = 1, no = 0, yes = 1, dim = box->dim;
    double side[3] = {[2] = 1};
    hsize_t sides = 1;
    for (int d = 0; d < dim; d++) {
        side[d] = domain_length(box, d);
        if (side[d] != side[0]) sides = 3;
    }
    set_attribute(image, header, "NumPart_ThisFile", H5T_NATIVE_UINT, count, TYPES);
    set_attribute(image, header, "NumPart_Total", H5T_NATIVE_UINT, count, TYPES);
    set_attribute(image, header, "NumPart_Total_HighWord", H5T_NATIVE_UINT, none, TYPES);
    set_attribute(image, header, "MassTable", H5T_NATIVE_DOUBLE, masses, TYPES);
    set_attribute(image, header, "Time", H5T_NATIVE_DOUBLE, &result->time, 1);
    set_attribute(image, header, "BoxSize", H5T_NATIVE_DOUBLE, side, sides);
    set_attribute(image, header, "Origin", H5T_NATIVE_DOUBLE, box->lo, 3);
    set_attribute(image, header, "Gamma", H5T_NATIVE_DOUBLE, &result->problem.gamma, 1);
    set_attribute(image, header, "Dimension", H5T_NATIVE_INT, &dim, 1);
    set_attribute(image, header, "NumFilesPerSnapshot", H5T_NATIVE_INT, &files, 1);
    set_attribute(image, header, "Flag_DoublePrecision", H5T_NATIVE_INT, &yes, 1);
    static const char *const off[] = {"Flag_Sfr",        "Flag_Cooling", "Flag_Feedback",
                                      "Flag_StellarAge", "Flag_Metals",  "Flag_Entropy_ICs"};
    for (size_t k = 0; k < sizeof off / sizeof *off; k++)
        set_attribute(image, header, off[k], H5T_NATIVE_INT, &no, 1);
    static const char *const still[] = {"Redshift", "Omega0", "OmegaLambda"};
    for (size_t k = 0; k < sizeof still / sizeof *still; k++)
        set_attribute(image, header, still[k], H5T_NATIVE_DOUBLE, &zero, 1);
    set_attribute(image, header, "HubbleParam", H5T_NATIVE_DOUBLE, &one, 1);
    set_remarks(image, header, result);
    if (went_well(header)) H5Gclose(header);
}

static void set_gas(struct image *image, const struct run_result *result)
{
    const struct snapshot *s = &result->snapshot;
    const struct domain *box = &result->problem.domain;
    const hid_t gas = H5Gcreate2(image->file, "PartType0", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    double *vectors = calloc(6 * s->n, sizeof *vectors), *v = vectors + 3 * s->n;
    uint64_t *number = malloc(s->n * sizeof *number);
    image->good &= went_well(gas) && vectors && number;
    for (size_t i = 0; image->good && i < s->n; i++) {
        number[i] = i + 1;
        for (int d = 0; d < box->dim; d++) {
            vectors[3 * i + (size_t)d] = s->x[d][i] - box->lo[d];
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
    if (image->good) {
        set_data(image, gas, "Coordinates", H5T_NATIVE_DOUBLE, vectors, s->n, 3);
        set_data(image, gas, "Velocities", H5T_NATIVE_DOUBLE, v, s->n, 3);
        set_data(image, gas, "ParticleIDs", H5T_NATIVE_UINT64, number, s->n, 1);
        for (size_t k = 0; k < sizeof scalars / sizeof *scalars; k++)
            set_data(image, gas, scalars[k].name, H5T_NATIVE_DOUBLE, scalars[k].values, s->n, 1);
    }
    if (went_well(gas)) H5Gclose(gas);
    free(vectors);
    free(number);
}

static enum status write_hdf5(const struct run_result *result, const char *path,
                              struct error *error)
{
    struct image image = {.good = true};
    struct output output;
    void *bytes = NULL;
    size_t size = 0;
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_fapl_core(access, 1 << 20, 0); /* in memory, never on disk */
    image.file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, access);
    H5Pclose(access);
    if (went_well(image.file)) {
        set_header(&image, result);
        set_gas(&image, result);
        image.good &= went_well(H5Fflush(image.file, H5F_SCOPE_GLOBAL));
        const ssize_t needed = H5Fget_file_image(image.file, NULL, 0);
        if (needed > 0) size = (size_t)needed;
        bytes = malloc(size + 1);
        image.good &= size > 0 && bytes && H5Fget_file_image(image.file, bytes, size) > 0;
        H5Fclose(image.file);
    } else
        image.good = false;
    enum status status = image.good ? output_open(&output, path, error)
                                    : error_set(error, STATUS_ENVIRONMENT,
                                                "%.200s: HDF5 has no memory for it", path);
    if (!status) {
        fwrite(bytes, 1, size, output.stream); /* output_close sees what failed */
        status = output_close(&output, error);
    }
    free(bytes);
    return status;
}

#else

static enum status possible(const char *path, struct error *error)
{
    return error_set(error, STATUS_ENVIRONMENT,
                     "%.200s: built without HDF5 (Debian: libhdf5-dev); a snapshot in CSV needs "
                     "nothing",
                     path);
}

static enum status write_hdf5(const struct run_result *result, const char *path,
                              struct error *error)
{
    (void)result;
    return possible(path, error);
}

#endif

const struct snapshot_writer writer_hdf5 = {
    .member = {"hdf5", "HDF5 in GADGET's layout: .hdf5 .h5", "Springel 2005"},
    .endings = ".hdf5 .h5",
    .memory = 250, /* of a file that is made in memory */
#ifndef HAVE_HDF5
    .possible = possible,
#endif
    .write = write_hdf5,
};
