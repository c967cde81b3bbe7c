/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "child.h"

#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

enum { PIPES = 2, PART = 4096 };

/* Starts the program with standard output and error connected to the pipes. */
static int start(const char *const *words, int pipes[PIPES][2], pid_t *pid)
{
    posix_spawn_file_actions_t files;
    posix_spawnattr_t how;
    sigset_t usual;
    sigemptyset(&usual);
    sigaddset(&usual, SIGPIPE); /* ignored by this program */
    posix_spawn_file_actions_init(&files);
    posix_spawnattr_init(&how);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", 0, 0);
    for (int i = 0; i < PIPES; i++) {
        posix_spawn_file_actions_adddup2(&files, pipes[i][1], i ? STDERR_FILENO : STDOUT_FILENO);
        posix_spawn_file_actions_addclose(&files, pipes[i][0]);
        posix_spawn_file_actions_addclose(&files, pipes[i][1]);
    }
    posix_spawnattr_setsigdefault(&how, &usual);
    posix_spawnattr_setflags(&how, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
    const int reason = posix_spawnp(pid, words[0], &files, &how, (char *const *)words, environ);
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&how);
    return reason;
}

/* Reads both pipes to the end. false: no memory. */
static bool listen_to(int pipes[PIPES][2], struct child_said *said)
{
    char part[PART];
    size_t length = 0, complained = 0;
    struct pollfd polls[PIPES] = {{.fd = pipes[0][0], .events = POLLIN},
                                  {.fd = pipes[1][0], .events = POLLIN}};
    while (polls[0].fd >= 0 || polls[1].fd >= 0) {
        if (poll(polls, PIPES, -1) < 0) continue; /* interrupted */
        for (int i = 0; i < PIPES; i++) {
            if (polls[i].fd < 0 || !polls[i].revents) continue;
            const ssize_t got = read(polls[i].fd, part, sizeof part);
            if (got < 0 && errno == EINTR) continue;
            if (got <= 0) {
                polls[i].fd = -1;
                continue;
            }
            size_t n = (size_t)got;
            if (i == 1) {
                const size_t left = sizeof said->complaint - 1 - complained;
                if (n > left) n = left;
                memcpy(said->complaint + complained, part, n);
                complained += n;
                continue;
            }
            char *grown = realloc(said->output, length + n + 1);
            if (!grown) return false;
            said->output = grown;
            memcpy(grown + length, part, n);
            grown[length += n] = '\0';
        }
    }
    return true;
}

enum status child_run(const char *const *words, struct child_said *said, struct error *error)
{
    int pipes[PIPES][2] = {{-1, -1}, {-1, -1}}, reason = 0, ended = 0;
    pid_t pid = 0;
    bool heard = true;
    *said = (struct child_said){.output = calloc(1, 1)};
    if (!said->output) return error_set(error, STATUS_ENVIRONMENT, "no memory for %s", words[0]);
    for (int i = 0; i < PIPES && !reason; i++) reason = pipe(pipes[i]) ? errno : 0;
    if (!reason) reason = start(words, pipes, &pid);
    for (int i = 0; i < PIPES; i++)
        if (pipes[i][1] >= 0) close(pipes[i][1]);
    if (!reason) {
        heard = listen_to(pipes, said);
        while (waitpid(pid, &ended, 0) < 0 && errno == EINTR) continue;
    }
    for (int i = 0; i < PIPES; i++)
        if (pipes[i][0] >= 0) close(pipes[i][0]);
    if (reason || !heard) {
        child_free(said);
        return error_set(error, STATUS_ENVIRONMENT, "%s: %s", words[0],
                         heard ? strerror(reason) : "no memory for what it says");
    }
    said->exit = WIFSIGNALED(ended) ? 128 + WTERMSIG(ended) : WEXITSTATUS(ended);
    said->complaint[strcspn(said->complaint, "\n")] = '\0'; /* keeps the first line */
    status_clean(said->complaint);
    return STATUS_OK;
}

void child_free(struct child_said *said)
{
    free(said->output);
    said->output = NULL;
}
