/* SPDX-License-Identifier: GPL-3.0-or-later
 * Makes a temporary folder in the current one before the first test, and removes it after the last
 * one. Include after test.h. */
#pragma once

#include <unistd.h>

#include "output.h"

static char own_folder[] = "sphproof_tests_XXXXXX";

static inline int make_own_folder(void **state)
{
    (void)state;
    output_prepare_process(); /* no file gets the descriptor of a standard stream */
    return !mkdtemp(own_folder);
}

static inline int remove_own_folder(void **state)
{
    char command[64];
    (void)state;
    snprintf(command, sizeof command, "/bin/rm -r %s", own_folder);
    return system(command);
}

TEST_BETWEEN(make_own_folder, remove_own_folder);

/* The path of a file in the folder; the next call overwrites it. */
static inline char *path_of(const char *name)
{
    static char path[256];
    snprintf(path, sizeof path, "%s/%s", own_folder, name);
    return path;
}

/* The absolute path, for variables that must not depend on the working folder. */
static inline char *whole_path_of(const char *name)
{
    static char path[4500];
    char here[4096];
    snprintf(path, sizeof path, "%s/%s", getcwd(here, sizeof here) ? here : "", path_of(name));
    return path;
}
