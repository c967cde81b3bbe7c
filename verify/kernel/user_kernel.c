/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "user_kernel.h"

#include <dlfcn.h>
#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "measure.h"
#include "pieces.h"

enum { PROBE_SECONDS = 20, PROBE_PASSED = 42, KNOTS_ROOM = 1 << 16 };

/* The functions of a plug-in; w and dw are there, the others may be NULL. */
struct functions {
    double (*w)(double q, int dim);
    double (*dw)(double q, int dim);
    double (*constant)(int dim);
    double (*dw_dh)(double r, double h, int dim);
    int (*knots)(int dim, double *knots);
    int (*class)(int dim);
    const char *(*name)(void);
};

static double shape_w(const struct kernel *kernel, double q, int dim)
{
    return kernel->plugin_w(q, dim);
}

static double shape_dw(const struct kernel *kernel, double q, int dim)
{
    return kernel->plugin_dw(q, dim);
}

bool user_kernel_is_path(const char *word)
{
    const size_t length = strlen(word);
    return strchr(word, '/') || (length > 3 && strcmp(word + length - 3, ".so") == 0);
}

static enum status open_library(struct user_kernel *user, const char *path, struct error *error)
{
    struct stat info;
    char plain[4096];
    if (stat(path, &info))
        return error_set(error, STATUS_BAD_INPUT, "kernel '%.200s': %s", path, strerror(errno));
    if (S_ISDIR(info.st_mode))
        return error_set(error, STATUS_BAD_INPUT,
                         "kernel '%.200s' is a directory; allowed: a shared object", path);
    /* without a slash dlopen would look in the system's directories */
    snprintf(plain, sizeof plain, "%s%s", strchr(path, '/') ? "" : "./", path);
    user->library = dlopen(plain, RTLD_NOW | RTLD_LOCAL);
    if (!user->library)
        return error_set(error, STATUS_BAD_INPUT, "kernel '%.150s' is no shared object: %.250s",
                         path, dlerror());
    return STATUS_OK;
}

/* Stores the function's address; POSIX promises that a data pointer can hold it. */
static void find(void *library, const char *symbol, void *function)
{
    void *address = dlsym(library, symbol);
    memcpy(function, &address, sizeof address);
}

static enum status find_functions(void *library, const char *path, struct functions *f,
                                  struct error *error)
{
    find(library, "sphproof_kernel_w", &f->w);
    find(library, "sphproof_kernel_dw", &f->dw);
    find(library, "sphproof_kernel_constant", &f->constant);
    find(library, "sphproof_kernel_dw_dh", &f->dw_dh);
    find(library, "sphproof_kernel_knots", &f->knots);
    find(library, "sphproof_kernel_class", &f->class);
    find(library, "sphproof_kernel_name", &f->name);
    if (f->w && f->dw) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT,
                     "kernel '%.200s' has no function sphproof_kernel_%s (see plugin.h)", path,
                     f->w ? "dw" : "w");
}

static void take_name(struct user_kernel *user, const char *path, const struct functions *f)
{
    const char *given = f->name ? f->name() : NULL;
    const char *slash = strrchr(path, '/');
    snprintf(user->name, sizeof user->name, "%s",
             given && given[0] ? given
             : slash           ? slash + 1
                               : path);
    for (char *c = user->name; *c; c++)
        if (*c < ' ' || *c > '~') *c = '_';
    char *end = strstr(user->name, ".so");
    if (!(given && given[0]) && end && end != user->name) *end = '\0';
    user->kernel.member = (struct member){user->name, "user's kernel", ""};
}

static int compare(const void *a, const void *b)
{
    double x, y;
    memcpy(&x, a, sizeof x);
    memcpy(&y, b, sizeof y);
    return (x > y) - (x < y);
}

/* Adds the knots of one dimension to the user's list; 0 and 1 are break points anyway. */
static enum status take_knots(struct user_kernel *user, const struct functions *f, int dim,
                              double *room, struct error *error)
{
    for (int i = 0; i < KNOTS_ROOM; i++) room[i] = (double)NAN;
    const int n = f->knots(dim, room);
    double last = -1;
    if (n < 0 || n > SPHPROOF_KERNEL_KNOTS_MAX)
        return error_set(error, STATUS_BAD_INPUT,
                         "kernel %s: sphproof_kernel_knots(%d) = %d; allowed: 0 to %d", user->name,
                         dim, n, SPHPROOF_KERNEL_KNOTS_MAX);
    for (int i = 0; i < n; i++) {
        if (!(room[i] > last && room[i] >= 0 && room[i] <= 1))
            return error_set(error, STATUS_BAD_INPUT,
                             "kernel %s: dim %d, knot %d of %d is %.17g; allowed: ascending values "
                             "between 0 and 1",
                             user->name, dim, i + 1, n, room[i]);
        last = room[i];
        if (last > 0 && last < 1) user->knots[user->kernel.knot_count++] = last;
    }
    return STATUS_OK;
}

/* The knots of all dimensions in one list: a superfluous one does no harm. */
static enum status take_all_knots(struct user_kernel *user, const struct functions *f,
                                  const int range[2], struct error *error)
{
    enum status status = STATUS_OK;
    double *room = malloc(KNOTS_ROOM * sizeof *room);
    user->knots = malloc((size_t)KERNEL_DIM_MAX * SPHPROOF_KERNEL_KNOTS_MAX * sizeof *user->knots);
    if (!room || !user->knots) status = error_set(error, STATUS_ENVIRONMENT, "no memory");
    for (int dim = range[0]; dim <= range[1] && !status; dim++)
        status = take_knots(user, f, dim, room, error);
    free(room);
    if (status) return status;
    struct kernel *kernel = &user->kernel;
    qsort(user->knots, (size_t)kernel->knot_count, sizeof *user->knots, compare);
    int n = 0;
    for (int i = 0; i < kernel->knot_count; i++)
        if (n == 0 || user->knots[i] - user->knots[n - 1] > 1e-12)
            user->knots[n++] = user->knots[i];
    kernel->knot_count = n;
    kernel->knots = user->knots;
    return STATUS_OK;
}

/* Finite everywhere, and something in it. */
static enum status probe_values(const struct kernel *kernel, int dim, struct error *error)
{
    enum { SAMPLES = 257 };
    double largest = 0;
    for (int i = 0; i <= SAMPLES; i++) {
        const double q = (double)i / SAMPLES;
        const double w = kernel->w(kernel, q, dim), dw = kernel->dw(kernel, q, dim);
        if (!isfinite(w) || !isfinite(dw))
            return error_set(error, STATUS_BAD_INPUT,
                             "kernel %s: dim %d, q = %.6g: w = %g, dw = %g; allowed: finite values",
                             kernel->member.name, dim, q, w, dw);
        largest = fmax(largest, fabs(w));
    }
    if (largest > 0) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT, "kernel %s: dim %d: w is 0 everywhere",
                     kernel->member.name, dim);
}

/* The class where none is declared; an undeclared jump of w itself counts against C0. */
static enum status take_class(struct user_kernel *user, const struct functions *f,
                              const struct pieces *pieces, struct error *error)
{
    struct kernel *kernel = &user->kernel;
    const int dim = pieces->dim;
    if (f->class) {
        kernel->smoothness[dim] = f->class(dim);
        if (kernel->smoothness[dim] < 0)
            return error_set(error, STATUS_BAD_INPUT,
                             "kernel %s: sphproof_kernel_class(%d) = %d; allowed: 0 or more",
                             user->name, dim, kernel->smoothness[dim]);
        return STATUS_OK;
    }
    struct measure_class class;
    measure_class(pieces, &class);
    kernel->smoothness[dim] = class.class > 0 ? class.class : 0;
    return STATUS_OK;
}

static enum status complete(struct user_kernel *user, const struct functions *f, int dim,
                            struct error *error)
{
    struct kernel *kernel = &user->kernel;
    struct pieces pieces;
    double floor = 0;
    if (probe_values(kernel, dim, error)) return error->status;
    if (f->constant) kernel->constant[dim] = f->constant(dim);
    if (pieces_find(&pieces, kernel, dim, error)) return error->status;
    if (!f->constant) kernel->constant[dim] = measure_constant(&pieces, &floor);
    enum status status = take_class(user, f, &pieces, error);
    pieces_free(&pieces);
    const double constant = kernel->constant[dim];
    if (!status && !(isfinite(constant) && constant > 0))
        status = error_set(error, STATUS_BAD_INPUT,
                           "kernel %s: the constant in %d dimensions is %g%s; allowed: above 0",
                           user->name, dim, constant, f->constant ? "" : " by quadrature");
    return status;
}

static enum status load(struct user_kernel *user, const char *path, int dim, struct error *error)
{
    const int range[2] = {dim ? dim : 1, dim ? dim : KERNEL_DIM_MAX};
    struct functions f;
    if (open_library(user, path, error)) return error->status;
    if (find_functions(user->library, path, &f, error)) return error->status;
    take_name(user, path, &f);
    user->kernel.w = shape_w;
    user->kernel.dw = shape_dw;
    user->kernel.plugin_w = f.w;
    user->kernel.plugin_dw = f.dw;
    user->kernel.plugin_dw_dh = f.dw_dh;
    user->found_constant = !f.constant;
    user->found_dh = !f.dw_dh;
    user->found_class = !f.class;
    user->found_knots = !f.knots;
    if (!f.knots)
        user->kernel.knot_count = -1;
    else if (take_all_knots(user, &f, range, error))
        return error->status;
    for (int d = range[0]; d <= range[1]; d++)
        if (complete(user, &f, d, error)) return error->status;
    return STATUS_OK;
}

/* Waits for the child; kills it when its time is over. Returns what waitpid tells, -1: killed. */
static int wait_for(pid_t child)
{
    const struct timespec pause = {0, 2000000};
    int outcome = 0;
    for (int i = 0; i < PROBE_SECONDS * 500; i++) {
        const pid_t done = waitpid(child, &outcome, WNOHANG);
        if (done == child) return outcome;
        if (done < 0 && errno != EINTR) return -1;
        nanosleep(&pause, NULL);
    }
    kill(child, SIGKILL);
    waitpid(child, &outcome, 0);
    return -1;
}

/* Foreign code may crash or never return: it does so in a child first. */
static enum status probe(const char *path, int dim, struct error *error)
{
    fflush(NULL);
    const pid_t child = fork();
    if (child < 0) return STATUS_OK; /* no process to spare: go on without */
    if (child == 0) {
        struct user_kernel user = {0};
        struct error ignored = {0};
        const struct rlimit no_core = {0, 0};
        setrlimit(RLIMIT_CORE, &no_core);
        load(&user, path, dim, &ignored);
        _exit(PROBE_PASSED);
    }
    const int outcome = wait_for(child);
    if (outcome == -1)
        return error_set(error, STATUS_BAD_INPUT,
                         "kernel '%.200s' does not return from its functions within %d s", path,
                         PROBE_SECONDS);
    if (WIFEXITED(outcome) && WEXITSTATUS(outcome) != PROBE_PASSED)
        return error_set(error, STATUS_BAD_INPUT, "kernel '%.200s' ends the process with exit(%d)",
                         path, WEXITSTATUS(outcome));
    if (WIFSIGNALED(outcome))
        return error_set(error, STATUS_BAD_INPUT, "kernel '%.200s' crashes: %s", path,
                         strsignal(WTERMSIG(outcome)));
    return STATUS_OK;
}

enum status user_kernel_load(struct user_kernel *user, const char *path, int dim,
                             struct error *error)
{
    *user = (struct user_kernel){0};
    if (probe(path, dim, error)) return error->status;
    const enum status status = load(user, path, dim, error);
    if (status) user_kernel_unload(user);
    return status;
}

void user_kernel_unload(struct user_kernel *user)
{
    free(user->knots);
    if (user->library) dlclose(user->library);
    *user = (struct user_kernel){0};
}
