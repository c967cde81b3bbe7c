/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "vtk_type.h"

#include <math.h>
#include <string.h>

#include "fortran.h"

static const struct vtk_type types[] = {
    {"double", "Float64", 'r', 8},      {"float", "Float32", 'r', 4},
    {"char", "Int8", 's', 1},           {"unsigned_char", "UInt8", 'u', 1},
    {"short", "Int16", 's', 2},         {"unsigned_short", "UInt16", 'u', 2},
    {"int", "Int32", 's', 4},           {"vtkIdType", "Int32", 's', 4},
    {"unsigned_int", "UInt32", 'u', 4}, {"long", "Int64", 's', 8},
    {"vtktypeint64", "Int64", 's', 8},  {"unsigned_long", "UInt64", 'u', 8}};

const struct vtk_type *vtk_type_of(const char *name)
{
    for (size_t k = 0; k < sizeof types / sizeof *types; k++)
        if (!strcmp(types[k].legacy, name) || !strcmp(types[k].xml, name)) return &types[k];
    return NULL;
}

double vtk_number(const struct vtk_type *type, const unsigned char *bytes, bool swapped)
{
    return type->kind == 'r'   ? fortran_real(bytes, type->width, swapped)
           : type->kind == 's' ? fortran_integer(bytes, type->width, swapped)
                               : (double)fortran_unsigned(bytes, type->width, swapped);
}

bool vtk_is_vector(int column)
{
    return column == SNAPSHOT_X || column == SNAPSHOT_VX || column == SNAPSHOT_AX;
}

enum status vtk_columns(struct snapshot_file *file, int column, size_t columns, const double *table,
                        const char *type, const char *path, struct error *error)
{
    const struct vtk_type *of = vtk_type_of(type);
    double *precision = &file->precision[column != SNAPSHOT_X];
    *precision = fmax(*precision, of->kind == 'r' && of->width == 4 ? 6e-8 : 1.2e-16);
    return snapshot_file_split(file, (enum snapshot_column)column, columns, table, path, error);
}
