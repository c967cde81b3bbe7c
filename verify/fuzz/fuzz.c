/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE /* memfd_create */
#include "fuzz.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

static const double cpu_seconds_max = 1;

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

static double cpu_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    const double began = cpu_seconds();
    fuzz_one(bytes, size);
    FUZZ_PROMISE(cpu_seconds() - began < cpu_seconds_max);
    return 0;
}

volatile int *fuzz_was_broken;

void fuzz_broken(const char *file, int line, const char *promise)
{
    fprintf(stderr, "%s:%d: not so: %s\n", file, line, promise);
    if (fuzz_was_broken) *fuzz_was_broken = 1;
    abort();
}

const char *fuzz_file(const uint8_t *bytes, size_t size)
{
    static int file = -1;
    static char path[64];
    if (file < 0) {
        file = memfd_create("fuzz", MFD_CLOEXEC);
        snprintf(path, sizeof path, "/proc/self/fd/%d", file);
    }
    if (file < 0 || ftruncate(file, 0) || pwrite(file, bytes, size, 0) != (ssize_t)size) {
        perror("fuzz: no file in memory");
        exit(STATUS_ENVIRONMENT);
    }
    return path;
}

static char named[64];

static void forget_named(void)
{
    unlink(named);
}

const char *fuzz_named_file(const uint8_t *bytes, size_t size)
{
    static int file = -1;
    if (!*named) {
        snprintf(named, sizeof named, "%s/sphproof-fuzz.XXXXXX",
                 access("/dev/shm", W_OK) ? "." : "/dev/shm");
        file = mkstemp(named);
        atexit(forget_named);
    }
    if (file < 0 || ftruncate(file, 0) || pwrite(file, bytes, size, 0) != (ssize_t)size) {
        perror("fuzz: no file in memory");
        exit(STATUS_ENVIRONMENT);
    }
    return named;
}

char *fuzz_text(const uint8_t *bytes, size_t size)
{
    char *text = malloc(size + 1);
    if (!text) exit(STATUS_ENVIRONMENT);
    memcpy(text, bytes, size);
    text[size] = '\0';
    return text;
}

void fuzz_refused(enum status status, const struct error *error)
{
    FUZZ_PROMISE(status == STATUS_BAD_INPUT);
    FUZZ_PROMISE(error->status == status);
    FUZZ_PROMISE(error->message[0]);
    for (const char *c = error->message; *c; c++) FUZZ_PROMISE(!iscntrl((unsigned char)*c));
    json_t *text = json_string(error->message); /* NULL unless it is valid UTF-8 */
    FUZZ_PROMISE(text);
    json_decref(text);
}

void fuzz_plan(const struct run_settings *settings)
{
    struct run_settings few = *settings;
    struct run run;
    struct run_result result;
    struct error error = {0};
    char too_many[] = "n=64";
    char *const arguments[] = {too_many};
    if (settings_real(&few.settings, SETTING_n) > 64)
        FUZZ_PROMISE(!settings_apply(&few.settings, 1, arguments, &error));
    enum status status = run_resolve(&run, &few, &error);
    if (!status) status = run_explain(&run, &result, &error);
    if (status) fuzz_refused(status, &error);
}
