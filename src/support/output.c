/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "output.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Names of the existing temporaries, accessible to a signal handler. */
enum { SLOTS = 16 };
static struct {
    volatile sig_atomic_t used;
    char name[PATH_MAX];
} slots[SLOTS];

static volatile sig_atomic_t guarded; /* process group that an interrupt ends, or 0 */

static void interrupted(int number)
{
    if (guarded) kill(-(pid_t)guarded, SIGKILL);
    for (int i = 0; i < SLOTS; i++)
        if (slots[i].used) unlink(slots[i].name);
    signal(number, SIG_DFL);
    raise(number);
}

void output_guard(int group)
{
    guarded = group;
}

static int slot_take(const char *name)
{
    for (int i = 0; i < SLOTS; i++)
        if (!slots[i].used && strlen(name) < sizeof slots[i].name) {
            strcpy(slots[i].name, name);
            slots[i].used = 1;
            return i;
        }
    return -1;
}

static void output_forget(struct output *output)
{
    if (output->slot >= 0) slots[output->slot].used = 0;
    free(output->path);
    free(output->temporary);
    *output = (struct output){.slot = -1};
}

static enum status cannot_write(const char *path, int reason, struct error *error)
{
    return error_set(error, STATUS_ENVIRONMENT, "cannot write '%s': %s", path, strerror(reason));
}

/* The file that path refers to after following links; a copy of path if it does not exist yet. */
static char *resolve(const char *path)
{
    char *real = realpath(path, NULL);
    return real ? real : strdup(path);
}

static char *temporary_beside(const char *path)
{
    static unsigned count;
    const char *slash = strrchr(path, '/');
    const int folder = slash ? (int)(slash - path + 1) : 0;
    const size_t size = strlen(path) + 48;
    char *name = malloc(size);
    if (name)
        snprintf(name, size, "%.*s.%s.%ld.%u.part", folder, path, path + folder, (long)getpid(),
                 count++);
    return name;
}

enum status output_open(struct output *output, const char *path, struct error *error)
{
    *output = (struct output){.slot = -1};
    if (strcmp(path, "-") == 0) {
        output->stream = stdout;
        return STATUS_OK;
    }
    struct stat info;
    const int exists = stat(path, &info) == 0;
    if (!*path) return cannot_write(path, ENOENT, error);
    if (exists && S_ISDIR(info.st_mode)) return cannot_write(path, EISDIR, error);
    if (exists && access(path, W_OK) != 0) return cannot_write(path, errno, error);
    output->given = path;
    if (!(output->path = resolve(path))) return cannot_write(path, ENOMEM, error);
    if (exists && !S_ISREG(info.st_mode)) {
        output->stream = fopen(path, "w");
    } else if ((output->temporary = temporary_beside(output->path))) {
        output->slot = slot_take(output->temporary);
        const int file = open(output->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file >= 0) output->stream = fdopen(file, "w");
    }
    if (!output->stream) {
        const int reason = errno;
        output_forget(output);
        return cannot_write(path, reason, error);
    }
    return STATUS_OK;
}

/* The reason why writing to standard output failed. If an earlier write failed, its errno is lost;
 * a closed pipe can still be detected, and the next write fails again. */
static int stdout_reason(int reason)
{
    struct pollfd polled = {.fd = STDOUT_FILENO, .events = POLLOUT};
    if (reason && reason != EIO) return reason;
    if (poll(&polled, 1, 0) == 1 && (polled.revents & POLLERR)) return EPIPE;
    return write(STDOUT_FILENO, "\n", 1) < 0 ? errno : EIO;
}

enum status output_close(struct output *output, struct error *error)
{
    if (!output->stream) return STATUS_OK;
    int reason = 0;
    errno = 0;
    if (fflush(output->stream) || ferror(output->stream)) reason = errno ? errno : EIO;
    if (output->stream == stdout) {
        output->stream = NULL;
        if (reason) reason = stdout_reason(reason);
        /* a closed pipe is not an error; see output_finish_process */
        return reason && reason != EPIPE ? cannot_write("standard output", reason, error)
                                         : STATUS_OK;
    }
    /* part of a long write failed without a reason: the next write fails again and sets it */
    if (reason == EIO && write(fileno(output->stream), "", 1) < 0) reason = errno;
    if (fclose(output->stream) && !reason) reason = errno;
    if (!reason && output->temporary && rename(output->temporary, output->path)) reason = errno;
    if (reason && output->temporary) unlink(output->temporary);
    const enum status status = reason ? cannot_write(output->given, reason, error) : STATUS_OK;
    output_forget(output);
    return status;
}

enum status output_text(const char *path, const char *text, struct error *error)
{
    struct output output;
    const enum status status = output_open(&output, path, error);
    if (status) return status;
    fputs(text, output.stream); /* output_close reports errors */
    return output_close(&output, error);
}

void output_discard(struct output *output)
{
    if (!output->stream) return;
    if (output->stream != stdout) {
        fclose(output->stream);
        if (output->temporary) unlink(output->temporary);
    }
    output_forget(output);
}

enum status output_probe(const char *path, struct error *error)
{
    struct stat info;
    /* opening a pipe would wait for a reader */
    if (stat(path, &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode))
        return access(path, W_OK) == 0 ? STATUS_OK : cannot_write(path, errno, error);
    struct output output;
    const enum status status = output_open(&output, path, error);
    output_discard(&output);
    return status;
}

enum status output_folder(const char *path, struct error *error)
{
    char part[PATH_MAX];
    if (snprintf(part, sizeof part, "%s", path) >= (int)sizeof part)
        return error_set(error, STATUS_BAD_INPUT, "the path '%.60s...' is too long", path);
    for (char *c = part + (*part != '\0');; c++) {
        if (*c != '/' && *c) continue;
        const char kept = *c;
        struct stat is;
        *c = '\0';
        if (mkdir(part, 0777) && !(errno == EEXIST && !stat(part, &is) && S_ISDIR(is.st_mode)))
            return error_set(error, STATUS_ENVIRONMENT, "cannot make the folder '%s': %s", part,
                             strerror(errno));
        *c = kept;
        if (!kept) return STATUS_OK;
    }
}

FILE *output_temporary(void)
{
    const char *folder = getenv("TMPDIR");
    char path[PATH_MAX];
    if (!folder || !*folder) return tmpfile();
    if (snprintf(path, sizeof path, "%s/sphproof.XXXXXX", folder) >= (int)sizeof path) {
        errno = ENAMETOOLONG;
        return NULL;
    }
    const int file = mkstemp(path);
    if (file < 0) return NULL;
    unlink(path);
    FILE *stream = fdopen(file, "w+b");
    if (!stream) close(file);
    return stream;
}

void output_prepare_process(void)
{
    /* Replaces closed standard streams by ones that fail, so that no data file gets their numbers.
     */
    const int modes[3] = {O_WRONLY, O_RDONLY, O_WRONLY};
    for (int i = 0; i < 3; i++)
        if (fcntl(i, F_GETFD) < 0 && open("/dev/null", modes[i]) != i) return;
    signal(SIGPIPE, SIG_IGN);
#ifdef SIGXFSZ
    signal(SIGXFSZ, SIG_IGN);
#endif
    const int numbers[] = {SIGINT, SIGTERM, SIGHUP};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        if (signal(numbers[i], interrupted) == SIG_IGN) signal(numbers[i], SIG_IGN);
}

enum status output_finish_process(struct error *error)
{
    errno = 0;
    if (!fflush(stdout) && !ferror(stdout)) return STATUS_OK;
    const int reason = stdout_reason(errno);
    return reason == EPIPE ? STATUS_OK : cannot_write("standard output", reason, error);
}
