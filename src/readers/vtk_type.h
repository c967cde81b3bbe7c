/* SPDX-License-Identifier: GPL-3.0-or-later
 * Types of numbers in VTK files, each with a name in legacy files and one in XML. */
#pragma once

#include "snapshot_file.h"

struct vtk_type {
    const char *legacy, *xml;
    char kind; /* real, signed or unsigned */
    size_t width;
};

/* The type of this name in either format; NULL: unknown. */
const struct vtk_type *vtk_type_of(const char *name);

/* swapped: opposite to native byte order. */
double vtk_number(const struct vtk_type *type, const unsigned char *bytes, bool swapped);

/* True if the column and the two that follow it are the components of a vector. */
bool vtk_is_vector(int column);

/* As snapshot_file_split, for numbers of this type, which is known. */
enum status vtk_columns(struct snapshot_file *file, int column, size_t columns, const double *table,
                        const char *type, const char *path, struct error *error);
