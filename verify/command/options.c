/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>

#include "command.h"

const char *options_value(const struct options *options, const char *name)
{
    const struct command_option *list = options->command->options;
    for (size_t i = 0; list && list[i].name; i++)
        if (strcmp(list[i].name, name) == 0) return options->values[i];
    return NULL;
}
