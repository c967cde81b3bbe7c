/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>

#include "command.h"
#include "kernel.h"

static enum status run(const struct options *options, int n, char **arguments, struct error *error)
{
    (void)options, (void)n, (void)arguments, (void)error;
    for (size_t i = 0; i < kernel_family.n; i++)
        printf("%-20s %s\n", kernel_family.members[i]->name, kernel_family.members[i]->label);
    return STATUS_OK;
}

const struct command command_list = {"list", "[FAMILY]", "names of cases, kernels, ...", run};
