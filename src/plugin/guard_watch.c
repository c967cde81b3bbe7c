/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include "clock.h"
#include "guard.h"
#include "guard_trace.h"

static volatile sig_atomic_t watched_process;

/* Forwards a signal to the working process, which removes its temporary files and ends. */
static void pass_on(int number)
{
    kill((pid_t)watched_process, number);
}

static void say(const struct watch *watch, const struct trace *seen, const char *what)
{
    char place[200];
    guard_place(seen, place, sizeof place);
    fprintf(stderr, "sphproof: %s %s%s\n", watch->subject, what, place);
}

/* The call of a thread in foreign code; NULL: none. */
static const struct trace *inside(const struct watch *watch)
{
    for (int t = 0; t < GUARD_TRACES; t++)
        if (watch->traces[t].inside) return &watch->traces[t];
    return NULL;
}

/* Ends this process in the same way as the child, unless foreign code is to blame. */
static _Noreturn void end_as(const struct watch *watch, int outcome)
{
    char what[120];
    const struct trace *guilty = inside(watch);
    if (guilty && WIFSIGNALED(outcome))
        snprintf(what, sizeof what, "crashes (%s)", strsignal(WTERMSIG(outcome)));
    else if (guilty)
        snprintf(what, sizeof what, "crashes or ends its process (exit status %d)",
                 WEXITSTATUS(outcome));
    const bool interrupted =
        WIFSIGNALED(outcome) && (WTERMSIG(outcome) == SIGINT || WTERMSIG(outcome) == SIGTERM ||
                                 WTERMSIG(outcome) == SIGHUP);
    if (guilty && !interrupted) {
        say(watch, guilty, what);
        _exit(STATUS_CHECK_FAILED);
    }
    if (WIFSIGNALED(outcome)) {
        signal(WTERMSIG(outcome), SIG_DFL);
        raise(WTERMSIG(outcome));
    }
    _exit(WIFEXITED(outcome) ? WEXITSTATUS(outcome) : STATUS_ENVIRONMENT);
}

/* For each thread the running call and the time at which it was first seen. */
struct calls {
    long number[GUARD_TRACES];
    double since[GUARD_TRACES];
};

static const struct trace *find_stuck(const struct watch *watch, struct calls *calls)
{
    const double time = clock_wall();
    for (int t = 0; t < GUARD_TRACES; t++) {
        const struct trace *seen = &watch->traces[t];
        if (!seen->inside || seen->calls != calls->number[t]) {
            calls->number[t] = seen->calls;
            calls->since[t] = time;
        } else if (time - calls->since[t] > GUARD_WATCH_LIMIT) {
            return seen;
        }
    }
    return NULL;
}

/* Ends the process, first with SIGTERM so that it can remove its temporary files. */
static _Noreturn void end_stuck(const struct watch *watch, const struct trace *stuck, pid_t pid)
{
    enum { ROUNDS = 100, ROUND_MS = 10 };
    char what[80];
    int outcome;
    snprintf(what, sizeof what, "has not come back for %d s: stands", GUARD_WATCH_LIMIT);
    say(watch, stuck, what);
    kill(pid, SIGTERM);
    for (int k = 0; k < ROUNDS && waitpid(pid, &outcome, WNOHANG) == 0; k++)
        poll(NULL, 0, ROUND_MS);
    kill(pid, SIGKILL);
    _exit(STATUS_CHECK_FAILED);
}

/* pipe: closed when the process ends. */
static _Noreturn void watch_over(const struct watch *watch, pid_t pid, int pipe)
{
    enum { ROUND_MS = 250, CLOSED_MS = 2 };
    static struct calls calls;
    const int numbers[] = {SIGINT, SIGTERM, SIGHUP};
    watched_process = (sig_atomic_t)pid;
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        if (signal(numbers[i], pass_on) == SIG_IGN) signal(numbers[i], SIG_IGN);
    for (;;) {
        int outcome;
        struct pollfd polled = {.fd = pipe, .events = POLLIN};
        if (poll(&polled, 1, ROUND_MS) > 0) poll(NULL, 0, CLOSED_MS);
        const pid_t ended = waitpid(pid, &outcome, WNOHANG);
        if (ended == pid) end_as(watch, outcome);
        if (ended < 0 && errno != EINTR) _exit(STATUS_ENVIRONMENT);
        const struct trace *stuck = find_stuck(watch, &calls);
        if (stuck) end_stuck(watch, stuck, pid);
    }
}

enum status guard_watch(const char *what, const char *path, struct error *error)
{
    static struct watch *mine;
    int ends[2];
    if (mine) { /* already watched */
        const size_t used = strlen(mine->subject);
        snprintf(mine->subject + used, sizeof mine->subject - used, ", %s %s", what, path);
        return STATUS_OK;
    }
    if (!(mine = guard_watch_make(error))) return error->status;
    if (pipe(ends)) return error_set(error, STATUS_ENVIRONMENT, "no pipe: %s", strerror(errno));
    snprintf(mine->subject, sizeof mine->subject, "%s %s", what, path);
    fflush(NULL);
    const pid_t parent = getpid(), pid = fork();
    if (pid < 0) return error_set(error, STATUS_ENVIRONMENT, "no process: %s", strerror(errno));
    if (pid > 0) {
        close(ends[1]);
        watch_over(mine, pid, ends[0]);
    }
    close(ends[0]);
    guard_end_with_parent();
    if (getppid() != parent) _exit(STATUS_ENVIRONMENT);
    pthread_atfork(NULL, NULL, guard_end_with_parent);
    guard_watched = mine;
    return STATUS_OK;
}
