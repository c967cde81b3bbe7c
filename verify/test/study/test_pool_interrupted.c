/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests parallel computations while a thousand signals a second arrive in their processes and in
 * the one that waits for them: long replies are complete, and dead processes are noticed. */
#include "test.h"

#include <signal.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#include "pool.h"

enum { LETTERS = 1000003 };

static void nothing(int number)
{
    (void)number;
}

/* A timer interrupts every system call that waits. */
static void interrupt_often(long us)
{
    const struct sigaction action = {.sa_handler = nothing};
    const struct itimerval often = {{0, us}, {0, us}};
    assert_int_equal(sigaction(SIGALRM, &action, NULL), 0);
    assert_int_equal(setitimer(ITIMER_REAL, &often, NULL), 0);
}

static void pause_ms(int ms)
{
    struct timespec rest = {0, ms * 1000000L};
    while (nanosleep(&rest, &rest)) continue;
}

/* The sequence of characters does not repeat, so that no part can stand for another one. */
static char letter(size_t i)
{
    return (char)('!' + 2 + i * i % 57);
}

static enum status long_text(const void *context, json_t **document, struct error *error)
{
    (void)context, (void)error;
    char *text = malloc(LETTERS + 1);
    for (size_t i = 0; i < LETTERS; i++) text[i] = letter(i);
    text[LETTERS] = '\0';
    *document = json_string(text);
    free(text);
    interrupt_often(1000);
    return STATUS_OK;
}

/* The reply ends long before the process dies. */
static enum status closes_and_dies(const void *context, json_t **document, struct error *error)
{
    (void)context, (void)document, (void)error;
    for (int file = 3; file < 64; file++) close(file);
    pause_ms(30);
    raise(SIGKILL);
    return STATUS_OK;
}

/* The pipe fills up during this pause. */
static void rest(void *context, const char *what, size_t done, size_t total, double share)
{
    (void)context, (void)what, (void)done, (void)total, (void)share;
    pause_ms(4);
}

TEST(replies_come_whole)
{
    struct pool pool = {0};
    struct error error;
    const struct pool_settings settings = {.jobs = 2, .progress = rest};
    assert_int_equal(pool_add(&pool, "a", "a", 1, long_text, NULL), 0);
    assert_int_equal(pool_add(&pool, "b", "b", 1, long_text, NULL), 1);
    assert_int_equal(pool_add(&pool, "c", "c", 1, closes_and_dies, NULL), 2);
    interrupt_often(1000);
    const enum status status = pool_run(&pool, &settings, &error);
    interrupt_often(0);
    assert_int_equal(status, STATUS_OK);
    for (int k = 0; k < 2; k++) {
        const struct pool_job *job = &pool.jobs[k];
        const char *text = json_string_value(job->document);
        if (!text) fail_msg("%s", job->error.message);
        assert_true(job->done && !job->crashed);
        assert_int_equal(strlen(text), LETTERS);
        for (size_t i = 0; i < LETTERS; i++)
            if (text[i] != letter(i)) fail_msg("letter %zu is another one", i);
    }
    assert_true(pool.jobs[2].done && pool.jobs[2].crashed);
    assert_int_equal(pool.jobs[2].error.status, STATUS_BROKE_DOWN);
    pool_free(&pool);
}
