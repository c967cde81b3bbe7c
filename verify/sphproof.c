/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "command.h"

/* Is this `--threads 1`, where no thread waits for another? */
static bool one_thread(char *const *argument)
{
    const char *end = *argument + strlen("--threads"), *count = *end == '=' ? end + 1 : argument[1];
    return count && strcmp(count, "1") == 0;
}

/* Waiting threads of OpenMP spin for up to a scheduler's quantum, which on a busy machine costs
 * more than the work they wait for. How long is read from the environment before main begins; so,
 * where threads are asked for and the user says nothing, it is set and the program started anew. */
static void wait_briefly(int argc, char **argv)
{
    if (getenv("OMP_WAIT_POLICY") || getenv("GOMP_SPINCOUNT") || getenv("KMP_BLOCKTIME")) return;
    for (int i = 1; i < argc; i++)
        if ((strncmp(argv[i], "--threads", strlen("--threads")) == 0 && !one_thread(argv + i)) ||
            strcmp(argv[i], "--scaling") == 0) {
            setenv("GOMP_SPINCOUNT", "2000", 1);
            setenv("KMP_BLOCKTIME", "0", 1);
            execv("/proc/self/exe", argv); /* on failure: as it was */
            return;
        }
}

int main(int argc, char **argv)
{
    wait_briefly(argc, argv);
    return command_main(argc, argv);
}
