/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "code_process.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include "clock.h"

void code_remove(const char *folder)
{
    char path[PATH_MAX];
    DIR *list = opendir(folder);
    for (struct dirent *entry; list && (entry = readdir(list));) {
        struct stat info;
        if (!strcmp(entry->d_name, ".") || !strcmp(entry->d_name, "..") ||
            snprintf(path, sizeof path, "%s/%s", folder, entry->d_name) >= (int)sizeof path)
            continue;
        if (!lstat(path, &info) && S_ISDIR(info.st_mode))
            code_remove(path);
        else
            unlink(path);
    }
    if (list) closedir(list);
    rmdir(folder);
}

/* ---- the program ---- */

static void take_stream(const char *name, int stream)
{
    const int file = open(name, O_WRONLY | O_CREAT | O_APPEND, 0666);
    if (file < 0 || dup2(file, stream) < 0) _exit(127);
    close(file);
}

static _Noreturn void become(const struct code_order *order)
{
    const int usual[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGXFSZ};
    setpgid(0, 0);
#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
    for (size_t i = 0; i < sizeof usual / sizeof *usual; i++) signal(usual[i], SIG_DFL);
    if (chdir(order->folder)) _exit(127);
    const int nothing = open("/dev/null", O_RDONLY);
    dup2(nothing, STDIN_FILENO);
    take_stream("stdout", STDOUT_FILENO);
    take_stream("stderr", STDERR_FILENO);
    execvp(order->words[0], (char *const *)order->words);
    dprintf(STDERR_FILENO, "cannot be started: %s: %s\n", order->words[0], strerror(errno));
    _exit(127);
}

/* ---- the supervising process ---- */

/* Bytes of memory of a process group; 0 if unknown. */
static double memory_of(pid_t group)
{
    double pages = 0;
    DIR *list = opendir("/proc");
    for (struct dirent *entry; list && (entry = readdir(list));) {
        char path[300], line[600];
        long resident = 0;
        int its_group = 0;
        if (strspn(entry->d_name, "0123456789") != strlen(entry->d_name)) continue;
        snprintf(path, sizeof path, "/proc/%s/stat", entry->d_name);
        FILE *file = fopen(path, "r");
        const char *rest = file && fgets(line, sizeof line, file) ? strrchr(line, ')') : NULL;
        if (file) fclose(file);
        if (!rest || sscanf(rest,
                            ") %*c %*d %d %*d %*d %*d %*u %*u %*u %*u %*u %*u %*u %*d %*d "
                            "%*d %*d %*d %*d %*u %*u %ld",
                            &its_group, &resident) != 2)
            continue;
        if (its_group == (int)group) pages += (double)resident;
    }
    if (list) closedir(list);
    return pages * (double)sysconf(_SC_PAGESIZE);
}

/* Ends orphaned processes, which are children of this process. */
static void end_children(void)
{
#ifdef __linux__
    char path[64];
    snprintf(path, sizeof path, "/proc/self/task/%ld/children", (long)getpid());
    FILE *file = fopen(path, "r");
    for (int child; file && fscanf(file, "%d", &child) == 1;) kill(child, SIGKILL);
    if (file) fclose(file);
#endif
}

static void end_all(pid_t group)
{
    enum { ROUNDS = 500, ROUND_MS = 2 };
    for (int round = 0; round < ROUNDS; round++) {
        kill(-group, SIGKILL);
        end_children();
        pid_t done;
        while ((done = waitpid(-1, NULL, WNOHANG)) > 0) continue;
        if (done < 0 && errno == ECHILD) return;
        poll(NULL, 0, ROUND_MS);
    }
}

static double seconds(struct timeval time)
{
    return (double)time.tv_sec + 1e-6 * (double)time.tv_usec;
}

/* Waits until the program has ended or exceeds a limit; life: a socket whose other end closes when
 * the waiting process ends. */
static bool wait_for(const struct code_order *order, pid_t program, int life,
                     struct code_outcome *outcome)
{
    const double began = clock_wall();
    int status = 0, round_ms = 1;
    for (;;) {
        struct pollfd polled = {.fd = life, .events = POLLIN};
        const bool orphaned = poll(&polled, 1, round_ms) > 0;
        for (pid_t done; (done = waitpid(-1, &status, WNOHANG)) > 0;)
            if (done == program) {
                outcome->exit = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
                outcome->wall_s = clock_wall() - began;
                return true;
            }
        outcome->wall_s = clock_wall() - began;
        if (outcome->wall_s > order->seconds) outcome->ending = CODE_LATE;
        if (isfinite(order->bytes) && memory_of(program) > order->bytes)
            outcome->ending = CODE_LARGE;
        if (orphaned || outcome->ending != CODE_ENDED) return !orphaned;
        if (round_ms < 50) round_ms++;
    }
}

/* waiting: a socket to the waiting process. */
static _Noreturn void watch_over(const struct code_order *order, int waiting)
{
    struct code_outcome outcome = {.ending = CODE_ENDED};
    struct rusage usage;
    setpgid(0, 0);
#ifdef __linux__
    prctl(PR_SET_CHILD_SUBREAPER, 1);
#endif
    for (int file = 3; file < 1024; file++)
        if (file != waiting) close(file);
    const pid_t program = fork();
    if (program == 0) become(order);
    if (program < 0) _exit(STATUS_ENVIRONMENT);
    setpgid(program, program);
    const bool wanted = wait_for(order, program, waiting, &outcome);
    end_all(program);
    if (!wanted && order->remove) code_remove(order->folder);
    getrusage(RUSAGE_CHILDREN, &usage);
    outcome.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
    const ssize_t sent = wanted ? write(waiting, &outcome, sizeof outcome) : 0;
    _exit(sent == (ssize_t)sizeof outcome ? 0 : STATUS_ENVIRONMENT);
}

/* ---- this process ---- */

static enum status no_process(struct error *error)
{
    return error_set(error, STATUS_ENVIRONMENT, "no process for another code: %s", strerror(errno));
}

enum status code_process(const struct code_order *order, struct code_outcome *outcome,
                         struct error *error)
{
    int ends[2]; /* of this and of the supervising process */
    size_t got = 0;
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends)) return no_process(error);
    for (int i = 0; i < 2; i++) fcntl(ends[i], F_SETFD, FD_CLOEXEC);
    fflush(NULL);
    const pid_t pid = fork();
    if (pid == 0) {
        close(ends[0]);
        watch_over(order, ends[1]);
    }
    if (pid < 0)
        no_process(error);
    else
        setpgid(pid, pid);
    close(ends[1]);
    while (pid > 0 && got < sizeof *outcome) {
        const ssize_t n = read(ends[0], (char *)outcome + got, sizeof *outcome - got);
        if (n == 0 || (n < 0 && errno != EINTR)) break;
        if (n > 0) got += (size_t)n;
    }
    close(ends[0]);
    while (pid > 0 && waitpid(pid, NULL, 0) < 0 && errno == EINTR) continue;
    if (pid < 0) return error->status;
    return got == sizeof *outcome
               ? STATUS_OK
               : error_set(error, STATUS_ENVIRONMENT, "the process that watches over %s has ended",
                           order->words[0]);
}
