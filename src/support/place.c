/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "place.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "version.h"

/* True if the path exists; false also for paths that are too long. */
static bool try(char path[PLACE_LENGTH], const char *root, const char *folder, const char *name)
{
    const int length = snprintf(path, PLACE_LENGTH, "%s%s/%s", root, folder, name);
    return length > 0 && length < PLACE_LENGTH && access(path, R_OK) == 0;
}

bool place_find(const char *name, char path[PLACE_LENGTH])
{
    char self[PLACE_LENGTH];
    const ssize_t length = readlink("/proc/self/exe", self, sizeof self - 1);
    if (length > 0 && DATA_FROM_PROGRAM[0] != '/') {
        self[length] = '\0';
        *(strrchr(self, '/') + 1) = '\0';
        if (try(path, self, DATA_FROM_PROGRAM, name)) return true;
    }
    if (try(path, "", DATA_CONFIGURED, name)) return true;
    path[0] = '\0';
    return false;
}
