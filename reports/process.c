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

static void close_pair(const int pair[2])
{
    close(pair[READ]);
    close(pair[WRITE]);
}

/* Descriptors 0..2 may be closed in this program (`sphproof ... >&-`). The child's dup2 would
 * overwrite a pipe there, so pipes are moved above them. */
static bool make_pipe(int pair[2])
{
    if (pipe(pair)) return false;
    for (int k = 0; k < 2; k++) {
        int high = fcntl(pair[k], F_DUPFD_CLOEXEC, 3);
        close(pair[k]);
        pair[k] = high;
    }
    return pair[READ] >= 0 && pair[WRITE] >= 0;
}

static sigset_t broken_pipe(void)
{
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGPIPE);
    return set;
}

/* posix_spawn, not fork, since this process may have OpenMP threads. Returns an errno. */
static int start(struct process *child, char *const argv[], int file, const sigset_t *mask)
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
    const sigset_t pipe_signal = broken_pipe();
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, in[READ], 0);
    posix_spawn_file_actions_adddup2(&actions, out[WRITE], 1);
    posix_spawn_file_actions_adddup2(&actions, err[WRITE], 2);
    if (file >= 0) posix_spawn_file_actions_adddup2(&actions, file, 3);
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setsigmask(&attributes, mask);
    posix_spawnattr_setsigdefault(&attributes, &pipe_signal);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    pid_t pid;
    int code = posix_spawnp(&pid, argv[0], &actions, &attributes, argv, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    close(in[READ]);
    close(out[WRITE]);
    close(err[WRITE]);
    *child = (struct process){code ? 0 : pid, in[WRITE], out[READ], err[READ]};
    if (code) {
        close(child->in);
        close(child->out);
        close(child->err);
    }
    return code;
}

static void shut(int *descriptor)
{
    close(*descriptor);
    *descriptor = -1;
}

/* Reads the available data, which takes no time; closes the descriptor at the end of the file. */
static void drain(int *descriptor, struct buffer *into)
{
    char buffer[65536];
    ssize_t n = read(*descriptor, buffer, sizeof buffer);
    if (n > 0)
        buffer_add_bytes(into, buffer, (size_t)n);
    else
        shut(descriptor);
}

/* Removes the mark from the end of the output; false: not there yet. */
static bool marked(struct buffer *output, const char *mark)
{
    const size_t n = strlen(mark);
    if (output->size < n || memcmp(output->data + output->size - n, mark, n) != 0) return false;
    output->data[output->size -= n] = '\0';
    return true;
}

enum turn { ANSWERED, ENDED, OUT_OF_TIME, OUT_OF_MEMORY };

/* Writes and reads simultaneously, so that neither side blocks the other, until the mark. Without a
 * mark closes the input and reads to the end. */
static enum turn converse(struct process *child, const char *input, size_t size, const char *mark,
                          double end_time, struct buffer *output, struct buffer *errors)
{
    fcntl(child->in, F_SETFL, O_NONBLOCK);
    for (;;) {
        if (mark ? child->out < 0 : !size)
            shut(&child->in); /* it will not answer; all is written */
        if (child->in < 0 && child->out < 0 && child->err < 0) return ENDED;
        struct pollfd polled[3] = {{.fd = size ? child->in : -1, .events = POLLOUT},
                                   {.fd = child->out, .events = POLLIN},
                                   {.fd = child->err, .events = POLLIN}};
        double left = end_time - clock_wall();
        if (left <= 0) return OUT_OF_TIME;
        if (poll(polled, 3, (int)(1000 * left) + 1) < 0 && errno != EINTR) return OUT_OF_TIME;
        if (polled[0].revents) {
            const ssize_t n = write(child->in, input, size);
            if (n < 0) {
                shut(&child->in);
            } else {
                input += n;
                size -= (size_t)n;
            }
        }
        if (polled[2].revents) drain(&child->err, errors);
        if (polled[1].revents) drain(&child->out, output);
        if (output->failed) return OUT_OF_MEMORY;
        if (mark && marked(output, mark)) return ANSWERED;
    }
}

/* Waits for the process to end; returns its wait status. */
static int end(struct process *child)
{
    int status = 0;
    close(child->in);
    close(child->out);
    close(child->err);
    while (waitpid(child->pid, &status, 0) < 0 && errno == EINTR) continue;
    child->pid = 0;
    return status;
}

static enum process_status finish(struct process *child, const char *program, bool timely,
                                  int seconds, const struct buffer *errors, char *message, size_t n)
{
    if (!timely) kill(child->pid, SIGKILL);
    const int status = end(child);
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

enum process_status process_ask(struct process *process, char *const argv[], int file,
                                const char *input, size_t size, const char *mark, int seconds,
                                struct buffer *output, char *message, size_t n)
{
    const sigset_t pipe_signal = broken_pipe();
    sigset_t before, pending;
    sigpending(&pending);
    bool was_pending = sigismember(&pending, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &pipe_signal, &before);

    struct buffer errors = {0};
    enum process_status status = PROCESS_OK;
    const int code = process->pid ? 0 : start(process, argv, file, &before);
    if (code) {
        snprintf(message, n, "%s cannot be run: %s", argv[0], strerror(code));
        status = code == ENOENT || code == EACCES ? PROCESS_NOT_FOUND : PROCESS_FAILED;
    } else {
        const enum turn turn =
            converse(process, input, size, mark, clock_wall() + seconds, output, &errors);
        if (turn == OUT_OF_MEMORY) {
            process_end(process);
            snprintf(message, n, "no memory for what %s wrote", argv[0]);
            status = PROCESS_FAILED;
        } else if (turn != ANSWERED) {
            status = finish(process, argv[0], turn == ENDED, seconds, &errors, message, n);
        }
    }
    /* Removes a SIGPIPE that our own write raised before the mask is restored. */
    sigpending(&pending);
    int taken;
    if (!was_pending && sigismember(&pending, SIGPIPE)) sigwait(&pipe_signal, &taken);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    buffer_free(&errors);
    return status;
}

void process_end(struct process *process)
{
    if (!process->pid) return;
    kill(process->pid, SIGKILL); /* it may never end by itself */
    end(process);
}

enum process_status process_filter(char *const argv[], const char *input, size_t size, int seconds,
                                   struct buffer *output, char *message, size_t n)
{
    struct process process = {0};
    return process_ask(&process, argv, -1, input, size, NULL, seconds, output, message, n);
}
