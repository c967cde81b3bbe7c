/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "threads.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

static pthread_mutex_t gate = PTHREAD_MUTEX_INITIALIZER;

/* Keeps all threads alive until all have started. */
static void *wait_at_gate(void *nothing)
{
    pthread_mutex_lock(&gate);
    pthread_mutex_unlock(&gate);
    return nothing;
}

enum status threads_check(int threads, struct error *error)
{
    int started = 0, reason = 0;
    if (threads < 2) return STATUS_OK;
    pthread_t *thread = calloc((size_t)threads, sizeof *thread);
    if (!thread) return error_set(error, STATUS_ENVIRONMENT, "no memory for %d threads", threads);
    pthread_mutex_lock(&gate);
    while (started < threads - 1 &&
           !(reason = pthread_create(&thread[started], NULL, wait_at_gate, NULL)))
        started++;
    pthread_mutex_unlock(&gate);
    for (int i = 0; i < started; i++) pthread_join(thread[i], NULL);
    free(thread);
    if (!reason) return STATUS_OK;
    return error_set(error, STATUS_ENVIRONMENT,
                     "--threads %d: cannot start them: %s; possible here: --threads %d", threads,
                     strerror(reason), started + 1);
}
