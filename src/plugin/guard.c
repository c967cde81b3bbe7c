/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "guard.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "clock.h"
#include "guard_trace.h"
#include "output.h"
#include "result.h"

/* ---- in the child process ---- */

enum { TICKS = 4, MEMORY = 1 << 29 };

/* Called several times per second of CPU time; ends the process if a call takes too long. */
static void tick(int number)
{
    static long calls;
    static int ticks;
    const struct trace *now = &guard_watched->traces[0];
    (void)number;
    ticks = now->inside && now->calls == calls ? ticks + 1 : 0;
    calls = now->calls;
    if (ticks <= TICKS * GUARD_CALL_LIMIT) return;
    guard_watched->stuck = 1;
    raise(SIGKILL);
}

/* Limits memory to current use plus half a GiB (sanitizers have reserved much by now). Does nothing
 * if current use is unknown. */
static void limit_memory(void)
{
    unsigned long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    const int known = file && fscanf(file, "%lu", &pages) == 1;
    if (file) fclose(file);
    if (!known) return;
    struct rlimit memory;
    if (getrlimit(RLIMIT_AS, &memory)) return;
    const rlim_t most = (rlim_t)pages * (rlim_t)sysconf(_SC_PAGESIZE) + MEMORY;
    if (memory.rlim_cur == RLIM_INFINITY || memory.rlim_cur > most) memory.rlim_cur = most;
    setrlimit(RLIMIT_AS, &memory);
}

static void prepare(pid_t parent, int printed)
{
    const int usual[] = {SIGABRT, SIGBUS,  SIGFPE,  SIGILL, SIGSEGV,
                         SIGINT,  SIGTERM, SIGQUIT, SIGHUP, SIGPIPE};
    const struct rlimit no_core = {0, 0};
    const struct itimerval period = {{0, 1000000 / TICKS}, {0, 1000000 / TICKS}};
    setpgid(0, 0);
    guard_end_with_parent();
    if (getppid() != parent) _exit(0); /* the parent has already ended */
    for (size_t i = 0; i < sizeof usual / sizeof *usual; i++) signal(usual[i], SIG_DFL);
    setrlimit(RLIMIT_CORE, &no_core);
    limit_memory();
    const int nothing = open("/dev/null", O_RDONLY);
    dup2(nothing, STDIN_FILENO);
    dup2(printed, STDOUT_FILENO);
    dup2(printed, STDERR_FILENO);
    signal(SIGPROF, tick);
    setitimer(ITIMER_PROF, &period, NULL);
}

static _Noreturn void child(guard_work *work, const void *context, pid_t parent, int answer,
                            int printed)
{
    json_t *reply = NULL;
    struct error error = {0};
    prepare(parent, printed);
    const enum status status = work(context, &reply, &error);
    fflush(NULL);
    json_t *document =
        result_object("status=%d message=%s reply=%p", (int)status, status ? error.message : "",
                      (void *)(reply ? reply : json_null()));
    char *text = document ? result_text(document) : NULL;
    const size_t length = text ? strlen(text) : 0;
    guard_watched->complete = 1;
    for (size_t sent = 0; sent < length;) {
        const ssize_t n = write(answer, text + sent, length - sent);
        if (n < 0 && errno != EINTR) break;
        if (n > 0) sent += (size_t)n;
    }
    _exit(0);
}

/* ---- in the parent process ---- */

/* Data received through a pipe; beyond `most` bytes only counted. */
struct stream {
    int file;
    char *text;
    size_t length, capacity, most, seen;
    bool failed; /* no memory */
};

static void take(struct stream *stream, const char *bytes, size_t n)
{
    stream->seen += n;
    if (n > stream->most - stream->length) n = stream->most - stream->length;
    if (stream->length + n > stream->capacity) {
        const size_t capacity = 2 * stream->capacity + n;
        char *text = realloc(stream->text, capacity);
        stream->failed = stream->failed || !text;
        if (!text) return;
        stream->text = text;
        stream->capacity = capacity;
    }
    if (n) memcpy(stream->text + stream->length, bytes, n);
    stream->length += n;
}

/* Reads the available data; false if there was none. */
static bool drain(struct stream *stream)
{
    static char bytes[1 << 16];
    const ssize_t n = read(stream->file, bytes, sizeof bytes);
    if (n > 0) take(stream, bytes, (size_t)n);
    return n > 0;
}

enum ending { ENDED, TOO_LATE, TOO_MUCH };
enum { STREAM_MAX = 1 << 26 }; /* bytes of an answer, and of what is printed */

/* Reads both pipes until the process ends, or ends it; other processes may hold the pipes open. */
static enum ending listen_to(pid_t pid, double limit, struct stream *streams, int *outcome)
{
    enum { WAIT_MS = 20 };
    const double until = clock_wall() + limit;
    enum ending ending = ENDED;
    for (bool over = false; !over;) {
        struct pollfd polls[2];
        for (int i = 0; i < 2; i++)
            polls[i] = (struct pollfd){.fd = streams[i].file, .events = POLLIN};
        if (poll(polls, 2, WAIT_MS) > 0 && (polls[0].revents | polls[1].revents) & POLLHUP) {
            const struct timespec pause = {0, 2000000}; /* poll no longer waits on such a pipe */
            nanosleep(&pause, NULL);
        }
        const pid_t done = waitpid(pid, outcome, WNOHANG | WUNTRACED);
        for (int i = 0; i < 2; i++)
            while (drain(&streams[i]) && streams[i].seen <= STREAM_MAX) continue;
        over = done == pid && !WIFSTOPPED(*outcome);
        const bool much = streams[1].seen > STREAM_MAX, late = clock_wall() >= until;
        if (over || (done != pid && !much && !late)) continue;
        ending = done == pid ? ENDED : much ? TOO_MUCH : TOO_LATE; /* ENDED: it was stopped */
        kill(pid, SIGKILL);
        int ignored;
        while (waitpid(pid, &ignored, 0) < 0 && errno == EINTR) continue;
        over = true;
    }
    kill(-pid, SIGKILL); /* its own child processes */
    return ending;
}

static void explain(struct guard_verdict *verdict, const struct watch *seen, enum ending ending,
                    double limit, int outcome)
{
    char where[200];
    guard_place(&seen->traces[0], where, sizeof where);
    char *text = verdict->reason;
    const size_t size = sizeof verdict->reason;
    if (seen->stuck)
        snprintf(text, size, "does not return within %d s%s", GUARD_CALL_LIMIT, where);
    else if (ending == TOO_LATE)
        snprintf(text, size, "did not end within %g s: stands%s", limit, where);
    else if (ending == TOO_MUCH)
        snprintf(text, size, "prints without end, more than %d MB%s", STREAM_MAX >> 20, where);
    else if (WIFSTOPPED(outcome))
        snprintf(text, size, "has stopped itself%s", where);
    else if (WIFSIGNALED(outcome))
        snprintf(text, size, "crashes (%s)%s", strsignal(WTERMSIG(outcome)), where);
    else if (seen->complete)
        snprintf(text, size, "closes or writes to files that are not its own: no result");
    else
        snprintf(text, size, "ends the process with exit(%d)%s", WEXITSTATUS(outcome), where);
    status_clean(text);
}

/* Parses the reply, if valid; sets the status of the work. */
static bool take_answer(struct guard_verdict *verdict, const struct stream *answer,
                        enum status *status, struct error *error)
{
    int number = -1;
    const char *message = "";
    json_t *reply = NULL;
    json_t *document = answer->text ? json_loadb(answer->text, answer->length, 0, NULL) : NULL;
    if (document && !json_unpack(document, "{s:i, s:s, s:o}", "status", &number, "message",
                                 &message, "reply", &reply)) {
        *status = (enum status)number;
        if (*status) error_set(error, *status, "%s", message);
        verdict->reply = json_is_null(reply) ? NULL : json_incref(reply);
        verdict->ended = true;
    }
    json_decref(document);
    return verdict->ended;
}

static void take_printed(struct guard_verdict *verdict, const struct stream *printed)
{
    const size_t most = sizeof verdict->printed - 1;
    const size_t n = printed->length < most ? printed->length : most;
    if (n) memcpy(verdict->printed, printed->text, n);
    for (size_t i = 0; i < n; i++)
        if (!verdict->printed[i]) verdict->printed[i] = '?';
    verdict->printed[n] = '\0';
    status_clean(verdict->printed);
    verdict->printed_bytes = printed->seen;
}

static enum status watch(pid_t pid, double limit, struct stream *streams,
                         struct guard_verdict *verdict, struct error *error)
{
    enum status status = STATUS_OK;
    int outcome = 0;
    output_guard(pid);
    const enum ending ending = listen_to(pid, limit, streams, &outcome);
    output_guard(0);
    const bool sound = ending == ENDED && WIFEXITED(outcome) && WEXITSTATUS(outcome) == 0 &&
                       guard_watched->complete;
    verdict->begun = guard_watched->begun;
    take_printed(verdict, &streams[1]);
    if (sound && streams[0].failed)
        return error_set(error, STATUS_ENVIRONMENT, "no memory for the answer of a process");
    if (sound && take_answer(verdict, &streams[0], &status, error)) return status;
    explain(verdict, guard_watched, ending, limit, outcome);
    return verdict->begun ? STATUS_CHECK_FAILED : STATUS_BAD_INPUT;
}

static enum status start(guard_work *work, const void *context, double limit,
                         struct guard_verdict *verdict, struct error *error)
{
    int answer[2], printed[2];
    if (pipe(answer)) return error_set(error, STATUS_ENVIRONMENT, "no pipe: %s", strerror(errno));
    if (pipe(printed)) {
        close(answer[0]), close(answer[1]);
        return error_set(error, STATUS_ENVIRONMENT, "no pipe: %s", strerror(errno));
    }
    fflush(NULL);
    const pid_t parent = getpid(), pid = fork();
    if (pid == 0) child(work, context, parent, answer[1], printed[1]);
    const int reason = errno;
    struct stream streams[2] = {{.file = answer[0], .most = STREAM_MAX},
                                {.file = printed[0], .most = sizeof verdict->printed}};
    close(answer[1]), close(printed[1]);
    for (int i = 0; i < 2; i++)
        fcntl(streams[i].file, F_SETFL, fcntl(streams[i].file, F_GETFL) | O_NONBLOCK);
    enum status status;
    if (pid < 0) {
        status = error_set(error, STATUS_ENVIRONMENT, "no process: %s", strerror(reason));
    } else {
        setpgid(pid, pid);
        status = watch(pid, limit, streams, verdict, error);
    }
    for (int i = 0; i < 2; i++) close(streams[i].file), free(streams[i].text);
    return status;
}

enum status guard_run(guard_work *work, const void *context, double limit,
                      struct guard_verdict *verdict, struct error *error)
{
    struct watch *before = guard_watched, *mine = guard_watch_make(error);
    *verdict = (struct guard_verdict){0};
    if (!mine) return STATUS_ENVIRONMENT;
    guard_watched = mine;
    const enum status status = start(work, context, limit, verdict, error);
    guard_watched = before;
    munmap(mine, sizeof *mine);
    return status;
}

void guard_free(struct guard_verdict *verdict)
{
    json_decref(verdict->reply);
    verdict->reply = NULL;
}
