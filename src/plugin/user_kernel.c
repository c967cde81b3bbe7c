/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "user_kernel.h"

#include <dlfcn.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "guard.h"
#include "list.h"
#include "measure.h"
#include "places.h"

enum { KNOTS_CAPACITY = 1 << 16 };

/* Functions of the plug-in; w and dw are required, the others may be NULL. */
static struct {
    double (*w)(double q, int dim);
    double (*dw)(double q, int dim);
    double (*constant)(int dim);
    double (*dw_dh)(double r, double h, int dim);
    int (*knots)(int dim, double *knots);
    int (*class)(int dim);
    int (*negative)(int dim);
    const char *(*name)(void);
} functions;

/* Each call is recorded so that a guarding process can report the call that failed. */
static double shape_w(const struct kernel *kernel, double q, int dim)
{
    guard_call("sphproof_kernel_w", q, (double)NAN, dim);
    const double w = kernel->plugin_w(q, dim);
    guard_back();
    return w;
}

static double shape_dw(const struct kernel *kernel, double q, int dim)
{
    guard_call("sphproof_kernel_dw", q, (double)NAN, dim);
    const double dw = kernel->plugin_dw(q, dim);
    guard_back();
    return dw;
}

static double width_slope(double r, double h, int dim)
{
    guard_call("sphproof_kernel_dw_dh", r, h, dim);
    const double dh = functions.dw_dh(r, h, dim);
    guard_back();
    return dh;
}

static void announce(const char *function, int dim)
{
    guard_call(function, (double)NAN, (double)NAN, dim);
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
    /* without a slash dlopen would search the system directories */
    snprintf(plain, sizeof plain, "%s%s", strchr(path, '/') ? "" : "./", path);
    announce("dlopen", 0);
    user->library = dlopen(plain, RTLD_NOW | RTLD_LOCAL);
    guard_back();
    if (!user->library)
        return error_set(error, STATUS_BAD_INPUT, "kernel '%.150s' is no shared object: %.250s",
                         path, dlerror());
    return STATUS_OK;
}

/* Stores the address of a function; POSIX guarantees that a data pointer can hold it. */
static void find(void *library, const char *symbol, void *function)
{
    void *address = dlsym(library, symbol);
    memcpy(function, &address, sizeof address);
}

static enum status find_functions(void *library, const char *path, struct error *error)
{
    find(library, "sphproof_kernel_w", &functions.w);
    find(library, "sphproof_kernel_dw", &functions.dw);
    find(library, "sphproof_kernel_constant", &functions.constant);
    find(library, "sphproof_kernel_dw_dh", &functions.dw_dh);
    find(library, "sphproof_kernel_knots", &functions.knots);
    find(library, "sphproof_kernel_class", &functions.class);
    find(library, "sphproof_kernel_negative", &functions.negative);
    find(library, "sphproof_kernel_name", &functions.name);
    if (functions.w && functions.dw) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT,
                     "kernel '%.200s' has no function sphproof_kernel_%s (see plugin.h)", path,
                     functions.w ? "dw" : "w");
}

void user_kernel_file_name(const char *path, char *name, size_t size)
{
    const char *slash = strrchr(path, '/');
    snprintf(name, size, "%s", slash ? slash + 1 : path);
    char *end = strstr(name, ".so");
    if (end && end != name) *end = '\0';
    status_clean(name);
}

static void take_name(struct user_kernel *user, const char *path)
{
    announce("sphproof_kernel_name", 0);
    const char *given = functions.name ? functions.name() : NULL;
    user_kernel_file_name(path, user->name, sizeof user->name);
    if (given && given[0]) snprintf(user->name, sizeof user->name, "%s", given);
    guard_back();
    for (char *c = user->name; *c; c++)
        if (*c < ' ' || *c > '~') *c = '_';
    user->kernel.member = (struct member){user->name, "user's kernel", ""};
}

/* Adds the knots of one dimension to the list; 0 and 1 are break points anyway. */
static enum status take_knots(struct user_kernel *user, int dim, double *found, struct error *error)
{
    for (int i = 0; i < KNOTS_CAPACITY; i++) found[i] = (double)NAN;
    announce("sphproof_kernel_knots", dim);
    const int n = functions.knots(dim, found);
    guard_back();
    double last = -1;
    if (n < 0 || n > SPHPROOF_KERNEL_KNOTS_MAX)
        return error_set(error, STATUS_BAD_INPUT,
                         "kernel %s: sphproof_kernel_knots(%d) = %d; allowed: 0 to %d", user->name,
                         dim, n, SPHPROOF_KERNEL_KNOTS_MAX);
    for (int i = 0; i < n; i++) {
        if (!(found[i] > last && found[i] >= 0 && found[i] <= 1))
            return error_set(error, STATUS_BAD_INPUT,
                             "kernel %s: dim %d, knot %d of %d is %.17g; allowed: ascending values "
                             "between 0 and 1",
                             user->name, dim, i + 1, n, found[i]);
        last = found[i];
        if (last > 0 && last < 1) user->knots[user->kernel.knot_count++] = last;
    }
    return STATUS_OK;
}

/* Collects the knots of all dimensions in one list; superfluous knots are harmless. */
static enum status take_all_knots(struct user_kernel *user, const int range[2], struct error *error)
{
    enum status status = STATUS_OK;
    double *found = malloc(KNOTS_CAPACITY * sizeof *found);
    user->knots = malloc((size_t)KERNEL_DIM_MAX * SPHPROOF_KERNEL_KNOTS_MAX * sizeof *user->knots);
    if (!found || !user->knots) status = error_set(error, STATUS_ENVIRONMENT, "no memory");
    for (int dim = range[0]; dim <= range[1] && !status; dim++)
        status = take_knots(user, dim, found, error);
    free(found);
    if (status) return status;
    struct kernel *kernel = &user->kernel;
    list_sort(user->knots, (size_t)kernel->knot_count);
    int n = 0;
    for (int i = 0; i < kernel->knot_count; i++)
        if (n == 0 || user->knots[i] - user->knots[n - 1] > 1e-12)
            user->knots[n++] = user->knots[i];
    kernel->knot_count = n;
    kernel->knots = user->knots;
    return STATUS_OK;
}

/* Checks that values are finite and not all zero. */
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

/* Sets the class if it is not declared; an undeclared jump of w itself counts against C0. */
static enum status take_class(struct user_kernel *user, const struct pieces *pieces,
                              struct error *error)
{
    struct kernel *kernel = &user->kernel;
    const int dim = pieces->dim;
    if (functions.class) {
        announce("sphproof_kernel_class", dim);
        kernel->smoothness[dim] = functions.class(dim);
        guard_back();
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

static enum status check_constant(const struct user_kernel *user, int dim, struct error *error)
{
    const double constant = user->kernel.constant[dim];
    if (isfinite(constant) && constant > 0) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT,
                     "kernel %s: the constant in %d dimensions is %g%s; allowed: above 0",
                     user->name, dim, constant, user->found_constant ? " by quadrature" : "");
}

/* Asks the plug-in for its declarations in dim dimensions. */
static enum status ask(struct user_kernel *user, int dim, struct error *error)
{
    if (probe_values(&user->kernel, dim, error)) return error->status;
    if (functions.negative) {
        announce("sphproof_kernel_negative", dim);
        user->negative[dim] = functions.negative(dim) != 0;
        guard_back();
    }
    if (!functions.constant) return STATUS_OK;
    announce("sphproof_kernel_constant", dim);
    user->kernel.constant[dim] = functions.constant(dim);
    guard_back();
    return check_constant(user, dim, error);
}

/* Determines what the plug-in does not declare. */
static enum status complete(struct user_kernel *user, int dim, struct error *error)
{
    struct kernel *kernel = &user->kernel;
    struct pieces pieces;
    if (pieces_find(&pieces, kernel, dim, &user->terms, error)) return error->status;
    if (!functions.constant) kernel->constant[dim] = measure_constant(&pieces);
    enum status status = take_class(user, &pieces, error);
    pieces_free(&pieces);
    return status ? status : check_constant(user, dim, error);
}

static void take_functions(struct user_kernel *user)
{
    user->kernel.w = shape_w;
    user->kernel.dw = shape_dw;
    user->kernel.plugin_w = functions.w;
    user->kernel.plugin_dw = functions.dw;
    user->kernel.plugin_dw_dh = functions.dw_dh ? width_slope : NULL;
    user->kernel.knot_count = functions.knots ? 0 : -1;
    user->found_constant = !functions.constant;
    user->found_dh = !functions.dw_dh;
    user->found_class = !functions.class;
    user->found_knots = !functions.knots;
}

static enum status load(struct user_kernel *user, const char *path, int dim, struct error *error)
{
    const int range[2] = {dim ? dim : 1, dim ? dim : KERNEL_DIM_MAX};
    if (open_library(user, path, error)) return error->status;
    if (find_functions(user->library, path, error)) return error->status;
    take_name(user, path);
    take_functions(user);
    if (functions.knots && take_all_knots(user, range, error)) return error->status;
    for (int d = range[0]; d <= range[1]; d++)
        if (ask(user, d, error)) return error->status;
    guard_begun();
    user->terms.constant_count = places_constants(path, &user->constants);
    user->terms.constants = user->constants;
    for (int d = range[0]; d <= range[1]; d++)
        if (complete(user, d, error)) return error->status;
    return STATUS_OK;
}

enum status user_kernel_load(struct user_kernel *user, const char *path, int dim,
                             const struct terms *terms, struct error *error)
{
    *user = (struct user_kernel){.terms = terms ? *terms : pieces_terms_usual};
    const enum status status = load(user, path, dim, error);
    if (status) user_kernel_unload(user);
    return status;
}

void user_kernel_unload(struct user_kernel *user)
{
    free(user->knots);
    free(user->constants);
    announce("dlclose", 0);
    if (user->library) dlclose(user->library);
    guard_back();
    *user = (struct user_kernel){0};
}

struct terms user_kernel_terms(const struct user_kernel *user, int dim)
{
    struct terms terms = user->terms;
    terms.negative = user->negative[dim];
    terms.class_found = user->found_class;
    return terms;
}
