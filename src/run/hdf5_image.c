/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "hdf5_image.h"

#include <stdlib.h>
#include <string.h>

#include "output.h"

#ifdef HAVE_HDF5
#include "h5.h"

enum status hdf5_image_possible(const char *path, struct error *error)
{
    return h5_load(path, error);
}

/* True for a valid identifier, or for a status of success. */
static bool went_well(hid_t code)
{
    return code >= 0;
}

static hid_t type_of(enum hdf5_type type)
{
    const hid_t types[] = {[HDF5_CHAR] = h5.T_NATIVE_SCHAR_g,
                           [HDF5_INT] = h5.T_NATIVE_INT_g,
                           [HDF5_UINT] = h5.T_NATIVE_UINT_g,
                           [HDF5_UINT64] = h5.T_NATIVE_UINT64_g,
                           [HDF5_DOUBLE] = h5.T_NATIVE_DOUBLE_g};
    return types[type];
}

void hdf5_image_begin(struct hdf5_image *image)
{
    const hid_t access = h5.Pcreate(h5.P_CLS_FILE_ACCESS_ID_g);
    h5.Pset_fapl_core(access, 1 << 20, 0); /* in memory, no file on disk */
    image->file = h5.Fcreate("image", H5F_ACC_TRUNC, H5P_DEFAULT, access);
    image->group = -1;
    image->good = went_well(image->file);
    h5.Pclose(access);
}

void hdf5_image_group(struct hdf5_image *image, const char *name)
{
    if (went_well(image->group)) h5.Gclose(image->group);
    image->group = h5.Gcreate2(image->file, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    image->good &= went_well(image->group);
}

static void set_attribute(struct hdf5_image *image, const char *name, hid_t type,
                          const void *values, hsize_t count)
{
    const hid_t space = count == 1 ? h5.Screate(H5S_SCALAR) : h5.Screate_simple(1, &count, NULL);
    const hid_t attribute = h5.Acreate2(image->group, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    image->good &= went_well(attribute) && went_well(h5.Awrite(attribute, type, values));
    if (went_well(attribute)) h5.Aclose(attribute);
    h5.Sclose(space);
}

void hdf5_image_attribute(struct hdf5_image *image, const char *name, enum hdf5_type type,
                          const void *values, size_t count)
{
    set_attribute(image, name, type_of(type), values, count);
}

void hdf5_image_text(struct hdf5_image *image, const char *name, const char *text)
{
    const hid_t type = h5.Tcopy(h5.T_C_S1_g);
    h5.Tset_size(type, strlen(text) + 1);
    set_attribute(image, name, type, text, 1);
    h5.Tclose(type);
}

void hdf5_image_data(struct hdf5_image *image, const char *name, enum hdf5_type type,
                     const void *values, size_t rows, size_t columns)
{
    const hsize_t shape[2] = {rows, columns};
    const hid_t space = h5.Screate_simple(columns > 1 ? 2 : 1, shape, NULL);
    const hid_t timeless = h5.Pcreate(h5.P_CLS_DATASET_CREATE_ID_g);
    h5.Pset_obj_track_times(timeless, false);
    const hid_t data =
        h5.Dcreate2(image->group, name, type_of(type), space, H5P_DEFAULT, timeless, H5P_DEFAULT);
    image->good &= went_well(data) &&
                   went_well(h5.Dwrite(data, type_of(type), H5S_ALL, H5S_ALL, H5P_DEFAULT, values));
    if (went_well(data)) h5.Dclose(data);
    h5.Pclose(timeless);
    h5.Sclose(space);
}

/* Contents of the file; NULL after a failure. */
static void *bytes_of(struct hdf5_image *image, size_t *size)
{
    if (went_well(image->group)) h5.Gclose(image->group);
    image->good = image->good && went_well(h5.Fflush(image->file, H5F_SCOPE_GLOBAL));
    const ssize_t needed = image->good ? h5.Fget_file_image(image->file, NULL, 0) : 0;
    void *bytes = needed > 0 ? malloc((size_t)needed) : NULL;
    if (bytes && h5.Fget_file_image(image->file, bytes, (size_t)needed) <= 0)
        free(bytes), bytes = NULL;
    if (went_well(image->file)) h5.Fclose(image->file);
    *size = (size_t)needed;
    return bytes;
}

enum status hdf5_image_end(struct hdf5_image *image, const char *path, struct error *error)
{
    struct output output;
    size_t size;
    void *bytes = bytes_of(image, &size);
    if (!bytes)
        return error_set(error, STATUS_ENVIRONMENT, "%.200s: HDF5 has no memory for it", path);
    enum status status = output_open(&output, path, error);
    if (!status) {
        fwrite(bytes, 1, size, output.stream); /* output_close reports failures */
        status = output_close(&output, error);
    }
    free(bytes);
    return status;
}

#else

enum status hdf5_image_possible(const char *path, struct error *error)
{
    return error_set(error, STATUS_ENVIRONMENT,
                     "%.200s: built without HDF5 (Debian: libhdf5-dev); a snapshot in CSV needs "
                     "nothing",
                     path);
}

void hdf5_image_begin(struct hdf5_image *image)
{
    *image = (struct hdf5_image){-1, -1, false};
}

void hdf5_image_group(struct hdf5_image *image, const char *name)
{
    (void)image, (void)name;
}

void hdf5_image_attribute(struct hdf5_image *image, const char *name, enum hdf5_type type,
                          const void *values, size_t count)
{
    (void)image, (void)name, (void)type, (void)values, (void)count;
}

void hdf5_image_text(struct hdf5_image *image, const char *name, const char *text)
{
    (void)image, (void)name, (void)text;
}

void hdf5_image_data(struct hdf5_image *image, const char *name, enum hdf5_type type,
                     const void *values, size_t rows, size_t columns)
{
    (void)image, (void)name, (void)type, (void)values, (void)rows, (void)columns;
}

enum status hdf5_image_end(struct hdf5_image *image, const char *path, struct error *error)
{
    (void)image;
    return hdf5_image_possible(path, error);
}

#endif
