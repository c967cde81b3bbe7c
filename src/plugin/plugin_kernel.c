/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plugin_kernel.h"

#include <ctype.h>
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cache.h"
#include "guard.h"
#include "measure.h"
#include "user_kernel.h"

enum { HASH_DIGITS = 16, PATH_SIZE = 200, NAME_SIZE = PATH_SIZE + 1 + HASH_DIGITS + 1 };

struct plugin {
    char path[PATH_SIZE], name[NAME_SIZE];
    struct kernel kernel;
    struct user_kernel user[KERNEL_DIM_MAX + 1]; /* loaded once per dimension */
};

static struct plugin plugins[KERNEL_PLUGINS_MAX];
static int plugin_count;
static plugin_certify *certificate; /* NULL: plug-ins are not allowed */
static bool any_certificate;

void plugin_allow(plugin_certify *certify, bool uncertified)
{
    certificate = certify;
    any_certificate = uncertified;
}

/* The hash at the end of PATH@HASH, or NULL. */
static const char *hash_of(const char *word)
{
    const char *at = strrchr(word, '@');
    if (!at || strlen(at + 1) != HASH_DIGITS) return NULL;
    for (const char *c = at + 1; *c; c++)
        if (!isxdigit((unsigned char)*c)) return NULL;
    return at + 1;
}

bool plugin_allowed(void)
{
    return certificate != NULL;
}

bool plugin_is_path(const char *word)
{
    const char *hash = hash_of(word);
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%.*s", (int)(hash ? hash - 1 - word : PATH_SIZE), word);
    return certificate && user_kernel_is_path(path);
}

static enum status hash_file(const char *path, char digits[HASH_DIGITS + 1], struct error *error)
{
    struct stat is;
    if (stat(path, &is) || access(path, R_OK))
        return error_set(error, STATUS_BAD_INPUT, "kernel '%s': %s", path, strerror(errno));
    if (!S_ISREG(is.st_mode))
        return error_set(error, STATUS_BAD_INPUT,
                         "kernel '%s' is no file; allowed: a shared object", path);
    snprintf(digits, HASH_DIGITS + 1, "%016" PRIx64, cache_hash_file(path));
    return STATUS_OK;
}

enum status plugin_find(const char *word, int *index, struct error *error)
{
    char digits[HASH_DIGITS + 1], path[PATH_SIZE], name[NAME_SIZE];
    const char *hash = hash_of(word);
    const size_t length = hash ? (size_t)(hash - 1 - word) : strlen(word);
    if (length >= sizeof path)
        return error_set(error, STATUS_BAD_INPUT,
                         "kernel '%.60s...': a path of %zu characters; allowed: up to %d", word,
                         length, PATH_SIZE - 1);
    snprintf(path, sizeof path, "%.*s", (int)length, word);
    if (hash_file(path, digits, error)) return error->status;
    if (hash && strcmp(hash, digits) != 0)
        return error_set(error, STATUS_BAD_INPUT,
                         "kernel '%s' is not the one that was meant: its content is %s, not %s",
                         path, digits, hash);
    snprintf(name, sizeof name, "%s@%s", path, digits);
    if ((*index = kernel_index(name)) >= 0) return STATUS_OK;
    if (plugin_count == KERNEL_PLUGINS_MAX)
        return error_set(error, STATUS_BAD_INPUT, "kernel '%s': allowed: up to %d plug-ins", path,
                         KERNEL_PLUGINS_MAX);
    struct plugin *plugin = &plugins[plugin_count];
    strcpy(plugin->path, path);
    strcpy(plugin->name, name);
    plugin->kernel.member = (struct member){plugin->name, "user's kernel", ""};
    if (guard_watch("kernel", plugin->path, error)) return error->status;
    plugin_count++;
    *index = kernel_add(&plugin->kernel);
    return STATUS_OK;
}

/* --- the certificate, in a child process ------------------------------------------------------ */

struct errand {
    const char *path;
    int dim;
};

/* ["name of a check that fails", ...] */
static enum status certify(const void *context, json_t **reply, struct error *error)
{
    const struct errand *errand = context;
    struct user_kernel user;
    enum status status = user_kernel_load(&user, errand->path, errand->dim, NULL, error);
    if (!status) {
        const struct terms terms = user_kernel_terms(&user, errand->dim);
        status = certificate(&user.kernel, errand->dim, &terms, reply, error);
        user_kernel_unload(&user);
    }
    return status;
}

/* The reason for refusing the plug-in, or "". */
static void find_faults(const struct guard_verdict *verdict, char *text, size_t size)
{
    size_t k;
    json_t *name;
    text[0] = '\0';
    json_array_foreach(verdict->reply, k, name) {
        const size_t used = strlen(text);
        if (!strstr(text, json_string_value(name)))
            snprintf(text + used, size - used, "%s%s",
                     used ? ", " : "checks that fail: ", json_string_value(name));
    }
    if (!text[0] && verdict->printed_bytes)
        snprintf(text, size, "it prints, which would mix with results: %.80s", verdict->printed);
}

static enum status check(const struct plugin *plugin, int dim, struct error *error)
{
    char faults[300];
    const struct errand errand = {plugin->path, dim};
    struct guard_verdict verdict;
    enum status status = guard_run(certify, &errand, GUARD_LIMIT, &verdict, error);
    if (!verdict.ended && verdict.reason[0])
        error_set(error, status, "kernel '%s' is refused: it %s", plugin->path, verdict.reason);
    if (!status) find_faults(&verdict, faults, sizeof faults);
    if (!status && faults[0] && any_certificate)
        fprintf(stderr, "sphproof: kernel '%s' is used although its certificate is refused: %s\n",
                plugin->path, faults);
    else if (!status && faults[0])
        status =
            error_set(error, STATUS_CHECK_FAILED,
                      "kernel '%s' is refused in dimension %d: %s (`sphproof kernel %s --dim %d` "
                      "shows all; --uncertified takes it nevertheless)",
                      plugin->path, dim, faults, plugin->path, dim);
    guard_free(&verdict);
    return status;
}

/* --- in this process -------------------------------------------------------------------------- */

/* The default eta gives the kernel the same standard deviation as the cubic spline at its default
 * eta (Dehnen & Aly 2012, section 2.4), rounded to three decimals. */
static double usual_eta(const struct kernel *kernel, int dim)
{
    struct kernel cubic;
    kernel_select(&cubic, "cubic_spline", 5, NULL);
    const double eta = (dim == 1 ? cubic.default_eta : cubic.cloud_eta) *
                       measure_deviation(&cubic, dim) / measure_deviation(kernel, dim);
    return isfinite(eta) ? round(1000 * eta) / 1000 : cubic.default_eta;
}

static enum status load(struct plugin *plugin, int dim, struct error *error)
{
    struct user_kernel *user = &plugin->user[dim];
    if (user_kernel_load(user, plugin->path, dim, NULL, error)) return error->status;
    struct kernel *kernel = &plugin->kernel, *loaded = &user->kernel;
    kernel->w = loaded->w;
    kernel->dw = loaded->dw;
    kernel->plugin_w = loaded->plugin_w;
    kernel->plugin_dw = loaded->plugin_dw;
    kernel->plugin_dw_dh = NULL; /* the certificate reports whether it agrees with w and dw */
    kernel->knot_count = loaded->knot_count;
    kernel->knots = loaded->knots;
    kernel->constant[dim] = loaded->constant[dim];
    kernel->smoothness[dim] = loaded->smoothness[dim];
    if (dim == 1)
        kernel->default_eta = usual_eta(loaded, dim);
    else
        kernel->cloud_eta = usual_eta(loaded, dim);
    return STATUS_OK;
}

/* Does nothing for built-in kernels. */
static enum status prepare(int index, int dim, struct error *error)
{
    struct plugin *plugin = plugins + index - (int)kernel_family.n;
    if (index < (int)kernel_family.n || plugin->user[dim].library) return STATUS_OK;
    if (check(plugin, dim, error)) return error->status;
    return load(plugin, dim, error);
}

enum status plugin_select(struct kernel *kernel, int index, int sinc_order, int dim,
                          struct error *error)
{
    if (prepare(index, dim, error)) return error->status;
    return kernel_select(kernel, kernel_family.members[index]->name, sinc_order, error);
}
