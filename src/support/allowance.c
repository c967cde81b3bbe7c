/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "allowance.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

enum { PATH_LENGTH = 4096, LINE_LENGTH = 1024 };

/* The number in a file; infinite if there is none ("max"). */
static double number_in(const char *path)
{
    double bytes;
    FILE *file = fopen(path, "r");
    if (!file) return HUGE_VAL;
    if (fscanf(file, "%lf", &bytes) != 1) bytes = HUGE_VAL;
    fclose(file);
    return bytes;
}

/* The least limit of a control group and its parents. In a container the path may be that of the
 * host; the container's own group is then the topmost one. */
static double least_of_groups(const char *root, const char *top, char *group, const char *file)
{
    char path[PATH_LENGTH];
    double least = HUGE_VAL;
    for (char *end = group + strlen(group); end; end = strrchr(group, '/')) {
        *end = '\0';
        snprintf(path, sizeof path, "%s/sys/fs/cgroup%s%s/%s", root, top, group, file);
        least = fmin(least, number_in(path));
    }
    return least;
}

/* Reads lines "number:controllers:/path"; version 2 has a single one, without controllers. */
static double of_groups(const char *root)
{
    char path[PATH_LENGTH], line[LINE_LENGTH];
    double least = HUGE_VAL;
    snprintf(path, sizeof path, "%s/proc/self/cgroup", root);
    FILE *file = fopen(path, "r");
    while (file && fgets(line, sizeof line, file)) {
        line[strcspn(line, "\n")] = '\0';
        char *controllers = strchr(line, ':');
        char *group = controllers ? strchr(controllers + 1, ':') : NULL;
        if (!group) continue;
        *group++ = '\0';
        if (strcmp(controllers, ":") == 0)
            least = fmin(least, least_of_groups(root, "", group, "memory.max"));
        else if (strcmp(controllers, ":memory") == 0)
            least = fmin(least, least_of_groups(root, "/memory", group, "memory.limit_in_bytes"));
    }
    if (file) fclose(file);
    return least;
}

double allowance_memory(const char *root)
{
    struct rlimit limit;
    const long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGESIZE);
    double bytes = pages > 0 && size > 0 ? (double)pages * (double)size : HUGE_VAL;
    if (!getrlimit(RLIMIT_AS, &limit) && limit.rlim_cur != RLIM_INFINITY)
        bytes = fmin(bytes, (double)limit.rlim_cur);
    return fmin(bytes, of_groups(root));
}
