/* SPDX-License-Identifier: GPL-3.0-or-later
 * Types of numbers in VTK files, each with a name in legacy files and one in XML. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

struct vtk_type {
    const char *legacy, *xml;
    char kind; /* real, signed or unsigned */
    size_t width;
};

/* The type of this name in either format; NULL: unknown. */
const struct vtk_type *vtk_type_of(const char *name);

/* swapped: opposite to native byte order. */
double vtk_number(const struct vtk_type *type, const unsigned char *bytes, bool swapped);
