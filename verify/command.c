/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "command.h"

#include <stdio.h>
#include <string.h>

#define COMMAND(name) extern const struct command command_##name;
#include "commands.def"
#undef COMMAND

static const struct command *const commands[] = {
#define COMMAND(name) &command_##name,
#include "commands.def"
#undef COMMAND
};

int command_main(int argc, char **argv)
{
    struct options options = {.threads = 1};
    struct error error = {0};
    for (size_t i = 0; argc > 1 && i < sizeof commands / sizeof *commands; i++)
        if (strcmp(argv[1], commands[i]->name) == 0) {
            const enum status status = commands[i]->run(&options, argc - 2, argv + 2, &error);
            if (error.message[0]) fprintf(stderr, "sphproof: %s\n", error.message);
            return (int)status;
        }
    fprintf(stderr, "sphproof: no such command\n");
    return STATUS_BAD_INPUT;
}
