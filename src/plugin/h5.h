/* SPDX-License-Identifier: GPL-3.0-or-later
 * The HDF5 functions in use. The library and its some thirty dependencies are loaded only for a
 * file that needs them, because loading them took three quarters of the program's start time. */
#pragma once

#ifdef HAVE_HDF5
#include <hdf5.h>

#include "status.h"

#define H5_CALLS(X)                                                                                \
    X(Aclose)                                                                                      \
    X(Acreate2)                                                                                    \
    X(Aexists_by_name)                                                                             \
    X(Aget_space)                                                                                  \
    X(Aget_type)                                                                                   \
    X(Aopen_by_name)                                                                               \
    X(Aread) X(Awrite) X(Dclose) X(Dcreate2) X(Dget_space) X(Dget_type) X(Dopen2) X(Dread)         \
        X(Dwrite) X(Eset_auto2) X(Fclose) X(Fcreate) X(Fflush) X(Fget_file_image) X(Fopen)         \
            X(Gclose) X(Gcreate2) X(Iget_type) X(Lexists) X(Literate_by_name) X(Oclose)            \
                X(Oexists_by_name) X(Oopen) X(Pclose) X(Pcreate) X(Pset_fapl_core)                 \
                    X(Pset_obj_track_times) X(Sclose) X(Screate) X(Screate_simple)                 \
                        X(Sget_simple_extent_dims) X(Sget_simple_extent_ndims)                     \
                            X(Sget_simple_extent_npoints) X(Tclose) X(Tcopy) X(Tget_class)         \
                                X(Tget_fields) X(Tget_size) X(Tis_variable_str) X(Tset_size)       \
                                    X(free_memory) X(open)

/* Identifiers of types and property list classes, which are variables of the library. */
#define H5_IDENTIFIERS(X)                                                                          \
    X(P_CLS_DATASET_CREATE_ID_g)                                                                   \
    X(P_CLS_FILE_ACCESS_ID_g)                                                                      \
    X(T_C_S1_g)                                                                                    \
    X(T_NATIVE_DOUBLE_g)                                                                           \
    X(T_NATIVE_INT_g) X(T_NATIVE_SCHAR_g) X(T_NATIVE_UINT_g) X(T_NATIVE_UINT64_g)

/* h5.Fopen is H5Fopen. */
struct h5 {
#define CALL(name)       __typeof__(H5##name) *name;
#define IDENTIFIER(name) hid_t name;
    H5_CALLS(CALL)
    H5_IDENTIFIERS(IDENTIFIER)
#undef CALL
#undef IDENTIFIER
};

extern struct h5 h5;

/* Loads the library once; call it before any other function. STATUS_ENVIRONMENT: it cannot be
 * loaded. */
enum status h5_load(const char *path, struct error *error);

/* Macros such as H5F_ACC_RDONLY call H5open and H5check_version, which would require linking the
 * library. h5_load has called H5open already. */
#undef H5CHECK
#define H5CHECK
#undef H5OPEN
#define H5OPEN
#endif
