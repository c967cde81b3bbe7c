/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "family.h"

#include <string.h>

int family_index(const struct family *family, const char *name)
{
    for (size_t i = 0; i < family->n; i++)
        if (strcmp(family->members[i]->name, name) == 0) return (int)i;
    return -1;
}

const struct member *family_find(const struct family *family, const char *name)
{
    const int i = family_index(family, name);
    return i < 0 ? NULL : family->members[i];
}
