/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "process.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "clock.h"

extern char **environ;

enum { READ, WRITE };

struct child {
    pid_t pid;
    int in, out, err; /* our ends */
};

static void close_pair(int pair[2])
{
    for (int k = 0; k < 2; k++)
        if (pair[k] >= 0) close(pair[k]);
}

/* Descriptors 0..2 may be closed in this program (`sphproof ... >&-`): a pipe that lands there
 * would be overwritten by the child's dup2, so pipes are moved above them. */
static bool make_pipe(int pair[2])
{
    if (pipe(pair)) return false;
    for (int k = 0; k < 2; k++) {
        int high = fcntl(pair[k], F_DUPFD_CLOEXEC, 3);
        close(pair[k]);
        pair[k] = high;
    }
    return pair[0] >= 0 && pair[1] >= 0;
}

/* posix_spawn rather than fork: this process may hold OpenMP threads. Returns an errno. */
static int start(struct child *child, char *const argv[], const sigset_t *mask)
{
    int in[2] = {-1, -1}, out[2] = {-1, -1}, err[2] = {-1, -1};
    if (!make_pipe(in) || !make_pipe(out) || !make_pipe(err)) {
        int code = errno;
        close_pair(in);
        close_pair(out);
        close_pair(err);
        return code;
    }
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    sigset_t pipe_signal;
    sigemptyset(&pipe_signal);
    sigaddset(&pipe_signal, SIGPIPE);
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, in[READ], 0);
    posix_spawn_file_actions_adddup2(&actions, out[WRITE], 1);
    posix_spawn_file_actions_adddup2(&actions, err[WRITE], 2);
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setsigmask(&attributes, mask);
    posix_spawnattr_setsigdefault(&attributes, &pipe_signal);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    int code = posix_spawnp(&child->pid, argv[0], &actions, &attributes, argv, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    close(in[READ]);
    close(out[WRITE]);
    close(err[WRITE]);
    child->in = in[WRITE];
    child->out = out[READ];
    child->err = err[READ];
    if (code) {
        close(child->in);
        close(child->out);
        close(child->err);
    }
    return code;
}

/* Reads what is there; closes the descriptor at its end. */
static void drain(int *descriptor, struct buffer *into)
{
    char buffer[65536];
    ssize_t n = read(*descriptor, buffer, sizeof buffer);
    if (n > 0) {
        buffer_add_bytes(into, buffer, (size_t)n);
    } else if (n == 0 || (errno != EINTR && errno != EAGAIN)) {
        close(*descriptor);
        *descriptor = -1;
    }
}

/* Writes and reads at once, so that neither side waits for the other. False: out of time. */
static bool converse(struct child *child, const char *input, size_t size, double end,
                     struct buffer *output, struct buffer *errors)
{
    fcntl(child->in, F_SETFL, O_NONBLOCK);
    while (child->in >= 0 || child->out >= 0 || child->err >= 0) {
        struct pollfd polled[3] = {
            {child->in, POLLOUT, 0}, {child->out, POLLIN, 0}, {child->err, POLLIN, 0}};
        double left = end - clock_wall();
        if (left <= 0) return false;
        if (poll(polled, 3, (int)(1000 * left) + 1) < 0 && errno != EINTR) return false;
        if (polled[0].revents) {
            ssize_t n = size ? write(child->in, input, size) : 0;
            if (n > 0) {
                input += n;
                size -= (size_t)n;
            }
            if (!size || (n < 0 && errno != EAGAIN && errno != EINTR)) {
                close(child->in);
                child->in = -1;
            }
        }
        if (polled[1].revents) drain(&child->out, output);
        if (polled[2].revents) drain(&child->err, errors);
    }
    return true;
}

static enum process_status finish(struct child *child, const char *program, bool timely,
                                  int seconds, const struct buffer *errors, char *message, size_t n)
{
    int *ends[] = {&child->in, &child->out, &child->err};
    for (size_t k = 0; k < 3; k++)
        if (*ends[k] >= 0) close(*ends[k]);
    if (!timely) kill(child->pid, SIGKILL);
    int status = 0;
    while (waitpid(child->pid, &status, 0) < 0 && errno == EINTR) continue;
    const char *words = errors->data ? errors->data : "";
    while (*words == '\n' || *words == ' ') words++;
    if (!timely)
        snprintf(message, n, "%s gave no answer in %d s and was stopped", program, seconds);
    else if (WIFSIGNALED(status))
        snprintf(message, n, "%s was ended by signal %d: %s", program, WTERMSIG(status), words);
    else if (WEXITSTATUS(status) == 127)
        snprintf(message, n, "%s cannot be run%s%s", program, *words ? ": " : "", words);
    else if (WEXITSTATUS(status))
        snprintf(message, n, "%s ended with status %d: %s", program, WEXITSTATUS(status), words);
    else
        return PROCESS_OK;
    if (!timely) return PROCESS_TOO_SLOW;
    return WIFEXITED(status) && WEXITSTATUS(status) == 127 ? PROCESS_NOT_FOUND : PROCESS_FAILED;
}

enum process_status process_filter(char *const argv[], const char *input, size_t size, int seconds,
                                   struct buffer *output, char *message, size_t n)
{
    sigset_t pipe_signal, before, pending;
    sigemptyset(&pipe_signal);
    sigaddset(&pipe_signal, SIGPIPE);
    sigpending(&pending);
    bool was_pending = sigismember(&pending, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &pipe_signal, &before);

    struct child child;
    struct buffer errors = {0};
    enum process_status status;
    int code = start(&child, argv, &before);
    if (code) {
        snprintf(message, n, "%s cannot be run: %s", argv[0], strerror(code));
        status = code == ENOENT || code == EACCES ? PROCESS_NOT_FOUND : PROCESS_FAILED;
    } else {
        bool timely = converse(&child, input, size, clock_wall() + seconds, output, &errors);
        status = finish(&child, argv[0], timely, seconds, &errors, message, n);
        if (status == PROCESS_OK && output->failed) {
            snprintf(message, n, "no memory for what %s wrote", argv[0]);
            status = PROCESS_FAILED;
        }
    }
    /* A SIGPIPE that our own write raised is taken away before the mask is restored. */
    sigpending(&pending);
    int taken;
    if (!was_pending && sigismember(&pending, SIGPIPE)) sigwait(&pipe_signal, &taken);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    buffer_free(&errors);
    return status;
}
