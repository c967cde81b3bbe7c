/* SPDX-License-Identifier: GPL-3.0-or-later
 * Certifies the plug-in kernels of examples/: right ones are accepted in all dimensions, subtle
 * faults are rejected by the property that they violate, and unusable ones are refused with a
 * message. The program's exit status follows. */
#include "test.h"

#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "certificate.h"
#include "guard.h"
#include "plugin_kernel.h"
#include "user_figures.h"
#include "user_kernel.h"

static char folder[4000]; /* the folder of the first module */

static int find_folder(void **state)
{
    (void)state;
    snprintf(folder, sizeof folder, "%s", test_word(2));
    char *slash = strrchr(folder, '/');
    if (slash) *slash = '\0';
    return 0;
}

static const char *path_of(const char *name)
{
    static char path[4096];
    snprintf(path, sizeof path, "%s/%s.so", folder, name);
    return path;
}

/* Certifies a plug-in that must be usable. Returns 1 if property `by` fails, or any if `by` is
 * NULL. */
static int rejected(const char *name, int dim, const char *by)
{
    struct user_kernel user;
    struct certificate certificate;
    struct error error = {0};
    int by_that = 0;
    if (user_kernel_load(&user, path_of(name), dim, NULL, &error)) fail_msg("%s", error.message);
    const struct terms terms = user_kernel_terms(&user, dim);
    assert_int_equal(certificate_measure(&certificate, &user.kernel, dim, &terms, NULL), STATUS_OK);
    assert_true(certificate.figures.count > 40);
    for (size_t i = 0; i < certificate.figures.count; i++) {
        const struct finding *figure = &certificate.figures.list[i];
        const bool fails = figure->status == FINDING_FAIL;
        if (fails && !by)
            print_error("%s, dim %d: %s: %g > %g, floor %g, %s\n", name, dim, figure->what,
                        figure->value, figure->bound, figure->floor, figure->subject);
        by_that |= by && fails && strcmp(figure->what, by) == 0;
    }
    const int failed = (int)certificate.failed;
    certificate_free(&certificate);
    user_kernel_unload(&user);
    return by ? by_that : failed;
}

TEST(right_kernels)
{
    static const char *const names[] = {"wendland_c8", "gaussian", "super_gaussian",
                                        "table",       "table_12", "faulty_NONE"};
    /* wendland_c8 and table in each dimension, others in one; the nightly test `plug-ins, looked at
     * closely` has all kernels in all dimensions */
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        for (int dim = 1; dim <= 3; dim++)
            if (i == 0 || i == 3 || (int)i % 3 + 1 == dim)
                assert_int_equal(rejected(names[i], dim, NULL), 0);
}

TEST(derived)
{
    struct user_kernel user;
    assert_int_equal(user_kernel_load(&user, path_of("wendland_c8"), 0, NULL, NULL), STATUS_OK);
    assert_true(user.found_constant && user.found_knots && user.found_dh && !user.found_class);
    near_relative(user.kernel.constant[1], 525. / 256, 1e-14); /* exact integrals */
    near_relative(user.kernel.constant[2], 40 / (3 * M_PI), 1e-14);
    near_relative(user.kernel.constant[3], 1785 / (64 * M_PI), 1e-14);
    assert_string_equal(user.kernel.member.name, "wendland_c8");
    user_kernel_unload(&user);
    char path[4200]; /* a file of another name */
    snprintf(path, sizeof path, "%s/other_%d.so", folder, (int)getpid());
    assert_int_equal(symlink("wendland_c8.so", path), 0);
    assert_int_equal(user_kernel_load(&user, path, 1, NULL, NULL), STATUS_OK);
    assert_string_equal(user.kernel.member.name, "wendland_c8");
    user_kernel_unload(&user);
    unlink(path);
    assert_int_equal(user_kernel_load(&user, path_of("table"), 2, NULL, NULL), STATUS_OK);
    assert_true(user.found_class && user.kernel.smoothness[2] == 2);
    assert_string_equal(user.kernel.member.name, "table");
    user_kernel_unload(&user);
}

TEST(subtle_faults)
{
    static const struct {
        const char *name;
        int dim;
        const char *by;
    } list[] = {
        {"faulty_CONSTANT_SEVENTH_DIGIT", 1, "normalisation"},
        {"faulty_CONSTANT_WRONG_IN_2D", 2, "normalisation"},
        {"faulty_DH_POWER", 3, "width_derivative"},
        {"faulty_DH_OUTER_BRANCH", 2, "width_derivative"},
        {"faulty_DW_ELEVENTH_DIGIT", 1, "radial_derivative"},
        {"faulty_DW_ELEVENTH_DIGIT", 3, "fundamental"},
        {"faulty_JUMP_AT_KNOT", 2, "continuity"},
        {"faulty_JUMP_IN_CURVATURE", 1, "continuity"},
        {"faulty_EXTRA_KNOT", 1, "continuity"},
        {"faulty_CLASS_OVERSTATED", 3, "continuity"},
        {"faulty_SUPPORT_SHORT", 2, "support"},
        {"faulty_BEYOND_EDGE", 1, "support"},
        {"faulty_WRONG_IN_3D", 3, "radial_derivative"},
        {"gaussian_unshifted", 1, "continuity"},
        {"gaussian_unshifted", 3, "support"},
    };
    for (size_t i = 0; i < sizeof list / sizeof *list; i++)
        if (!rejected(list[i].name, list[i].dim, list[i].by))
            fail_msg("%s, dim %d: accepted by %s", list[i].name, list[i].dim, list[i].by);
    assert_int_equal(rejected("faulty_WRONG_IN_3D", 2, NULL), 0);
    assert_int_equal(rejected("faulty_CONSTANT_WRONG_IN_2D", 1, NULL), 0);
}

static void refused(const char *path, const char *why)
{
    struct user_figures figures;
    struct error error = {0};
    assert_int_equal(user_figures_measure(&figures, path, &error), STATUS_BAD_INPUT);
    if (!strstr(error.message, why)) fail_msg("'%s' lacks '%s'", error.message, why);
}

TEST(unusable_modules)
{
    refused(path_of("faulty_NOT_A_NUMBER"), "finite");
    refused(path_of("faulty_CRASH"), "crashes");
    refused(path_of("faulty_EXIT"), "exit(0)");
    refused(path_of("gaussian_without_dw"), "sphproof_kernel_dw");
    refused(path_of("no_such_file"), "No such file");
    refused(folder, "directory");
    refused(test_word(1), ""); /* an executable is no shared object */
}

/* The same without a process in between, word by word. */
TEST(messages)
{
    static const struct {
        const char *fault, *says;
    } rows[] = {
        {"CONSTANT_NEGATIVE", "the constant in 1 dimensions is -1.33333; allowed: above 0"},
        {"CONSTANT_INFINITE", "the constant in 1 dimensions is inf; allowed: above 0"},
        {"KNOTS_TOO_MANY", "sphproof_kernel_knots(1) = 4097; allowed: 0 to 4096"},
        {"KNOTS_NEGATIVE", "sphproof_kernel_knots(1) = -1; allowed: 0 to 4096"},
        {"KNOTS_DESCENDING",
         "dim 1, knot 2 of 2 is 0.25; allowed: ascending values between 0 and 1"},
        {"KNOTS_EQUAL", "dim 1, knot 2 of 2 is 0.5; allowed: ascending values between 0 and 1"},
        {"KNOT_NEGATIVE", "dim 1, knot 1 of 1 is -0.001; allowed: ascending values between"},
        {"KNOT_BEYOND", "dim 1, knot 2 of 2 is 1.25; allowed: ascending values between 0"},
        {"KNOT_UNSET", "dim 1, knot 2 of 3 is 0.25; allowed: ascending values between 0 and 1"},
        {"CLASS_NEGATIVE", "sphproof_kernel_class(1) = -1; allowed: 0 or more"},
        {"ZERO", "dim 1: w is 0 everywhere"},
        {"NOT_A_NUMBER", "dim 1, q = 0.303502: w = "}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        char name[60], says[200];
        struct user_kernel user;
        struct error error = {0};
        snprintf(name, sizeof name, "faulty_%s", rows[k].fault);
        snprintf(says, sizeof says, "kernel %s: %s", name, rows[k].says);
        assert_int_equal(user_kernel_load(&user, path_of(name), 0, NULL, &error), STATUS_BAD_INPUT);
        if (strncmp(error.message, says, strlen(says)) != 0) fail_msg("%s", error.message);
        assert_null(user.library);
    }
}

static enum status no_certificate(const struct kernel *kernel, int dim, const struct terms *terms,
                                  json_t **failing, struct error *error)
{
    (void)kernel, (void)dim, (void)terms, (void)failing, (void)error;
    return STATUS_OK;
}

TEST(paths_of_modules)
{
    static const char *const paths[] = {"./a", "a.so", "a/", "a.so.so", "/"},
                             *const names[] = {"a", ".so", "aso", "a.s", "a.so.", "b.sox"},
                             *const hashed[] = {"a.so@0123456789abcDEF", "./a@0123456789abcdef"},
                             *const unhashed[] = {"a.so@0123456789abcde", "a.so@0123456789abcdefa",
                                                  "a.so@0123456789abcdeg", "a.so@", "a@b.s"};
    static const struct {
        const char *path, *name;
    } rows[] = {{"x/a.so", "a"},  {"a.so.1", "a"}, {"b.so/a", "a"},   {".so", ".so"},
                {"x/.so", ".so"}, {"a.c", "a.c"},  {"x/\x01.so", "?"}};
    char name[64], path[400];
    assert_false(plugin_allowed() || plugin_is_path("./a"));
    plugin_allow(no_certificate, false);
    assert_true(plugin_allowed());
    for (size_t k = 0; k < sizeof paths / sizeof *paths; k++)
        assert_true(user_kernel_is_path(paths[k]) && plugin_is_path(paths[k]));
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        assert_false(user_kernel_is_path(names[k]) || plugin_is_path(names[k]));
    for (size_t k = 0; k < sizeof hashed / sizeof *hashed; k++)
        assert_true(plugin_is_path(hashed[k]));
    for (size_t k = 0; k < sizeof unhashed / sizeof *unhashed; k++)
        assert_false(plugin_is_path(unhashed[k]));
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        user_kernel_file_name(rows[k].path, name, sizeof name);
        assert_string_equal(name, rows[k].name);
    }
    for (int k = 0; k < 5; k++) {
        struct error error = {0};
        char says[500];
        int index;
        if (k == 0)
            snprintf(path, sizeof path, "./%0197d", 0), /* as long as a path may be, and longer */
                snprintf(says, sizeof says, "kernel '%.200s': ", path);
        if (k == 1) snprintf(path, sizeof path, "./%0198d", 0);
        if (k == 1)
            snprintf(says, sizeof says,
                     "kernel '%.60s...': a path of 200 characters; allowed: up to 199", path);
        if (k == 2)
            snprintf(path, sizeof path, "%.300s", folder),
                snprintf(says, sizeof says, "kernel '%.300s' is no file; allowed: a shared", path);
        if (k == 3)
            snprintf(path, sizeof path, "%.300s@0123456789abcdef", path_of("table")),
                snprintf(says, sizeof says,
                         "kernel '%.300s' is not the one that was meant: its content is ",
                         path_of("table"));
        if (k == 4)
            snprintf(path, sizeof path, "./no"),
                snprintf(says, sizeof says, "kernel './no': No such");
        assert_int_equal(plugin_find(path, &index, &error), STATUS_BAD_INPUT);
        if (strncmp(error.message, says, strlen(says)) != 0) fail_msg("%s", error.message);
    }
    plugin_allow(NULL, false);
}

/* ---- work in a process of its own ---- */

static void print_on(void)
{
    for (;;) puts("on and on");
}

static void wait_on(void)
{
    for (;;) pause();
}

static void leave(void)
{
    exit(3);
}

static void stop(void)
{
    raise(SIGSTOP);
}

static void crash(void)
{
    raise(SIGFPE);
}

static void close_all(void)
{
    for (int file = 3; file < 100; file++) close(file);
}

static const struct work {
    size_t answered, printed;
    enum status status;
    bool begun;
    void (*end)(void);
    const char *reason; /* NULL: the work completes */
} works[] = {{0, 0, STATUS_OK, false, NULL, NULL},
             {1, 1, STATUS_OK, true, NULL, NULL},
             {26, 199, STATUS_CHECK_FAILED, true, NULL, NULL},
             {300000, 300000, STATUS_BAD_INPUT, false, NULL, NULL},
             {10000000, 200, STATUS_OK, true, NULL, NULL},
             {1, 0, STATUS_OK, true, print_on, "prints without end, more than 64 MB"},
             {1, 20, STATUS_OK, true, wait_on, "did not end within 0.25 s: stands"},
             {1, 20, STATUS_OK, false, leave, "ends the process with exit(3)"},
             {1, 20, STATUS_OK, true, stop, "has stopped itself"},
             {1, 20, STATUS_OK, false, crash, "crashes (Floating point exception)"},
             {1, 0, STATUS_OK, true, close_all, "closes or writes to files that are not its own"}};

static char letter(size_t i)
{
    return (char)('a' + i % 26);
}

static enum status perform(const void *context, json_t **reply, struct error *error)
{
    const struct work *work = context;
    char *text = calloc(work->answered + 1, 1);
    for (size_t i = 0; i < work->answered; i++) text[i] = letter(i);
    if (work->begun) guard_begun();
    for (size_t i = 0; i < work->printed; i++) fputc(letter(i), stdout);
    fflush(stdout);
    if (work->end) work->end();
    *reply = json_string(text);
    free(text);
    return work->status ? error_set(error, work->status, "said so") : STATUS_OK;
}

TEST(guarded)
{
    for (size_t k = 0; k < sizeof works / sizeof *works; k++) {
        const struct work *work = &works[k];
        struct guard_verdict verdict;
        struct error error = {0};
        const enum status status =
            guard_run(perform, work, work->end == wait_on ? 0.25 : 60, &verdict, &error);
        if (status != (!work->reason ? work->status
                       : work->begun ? STATUS_CHECK_FAILED
                                     : STATUS_BAD_INPUT))
            fail_msg("work %zu: %d", k, status);
        assert_true(verdict.begun == work->begun && verdict.ended == !work->reason);
        assert_string_equal(error.message, verdict.ended && status ? "said so" : "");
        if (work->reason && strncmp(verdict.reason, work->reason, strlen(work->reason)))
            fail_msg("work %zu %s", k, verdict.reason);
        if (work->end != print_on) {
            const size_t shown = work->printed < 199 ? work->printed : 199;
            assert_int_equal(verdict.printed_bytes, work->printed);
            assert_int_equal(strlen(verdict.printed), shown);
            for (size_t i = 0; i < shown; i++) assert_true(verdict.printed[i] == letter(i));
        }
        if (verdict.ended) {
            const char *text = json_string_value(verdict.reply);
            assert_int_equal(strlen(text), work->answered);
            for (size_t i = 0; i < work->answered; i++)
                if (text[i] != letter(i)) fail_msg("letter %zu", i);
        }
        guard_free(&verdict);
    }
}

static int held[2];

static enum status leave_another(const void *context, json_t **reply, struct error *error)
{
    (void)context, (void)reply, (void)error;
    if (fork() == 0) wait_on();
    return STATUS_OK;
}

/* A process that the work has started ends with it. */
TEST(nothing_remains)
{
    struct guard_verdict verdict;
    struct error error = {0};
    assert_int_equal(pipe(held), 0);
    assert_int_equal(guard_run(leave_another, NULL, 60, &verdict, &error), STATUS_OK);
    close(held[1]);
    struct pollfd polled = {.fd = held[0], .events = POLLIN};
    assert_int_equal(poll(&polled, 1, 10000), 1);
    assert_true(polled.revents & POLLHUP);
    close(held[0]);
    guard_free(&verdict);
}

/* Exit status of the program with these arguments (%s, at most twice, is the folder of the
 * plug-ins). Of `kernel`: transcripts and plugins.py. */
static int status_of(const char *arguments)
{
    char tail[4096], command[8192];
    snprintf(tail, sizeof tail, arguments, folder, folder);
    snprintf(command, sizeof command, "'%s' %s >/dev/null 2>&1", test_word(1), tail);
    return WEXITSTATUS(system(command));
}

TEST(verify_with_a_plug_in)
{
    assert_int_equal(status_of("verify kernels --quiet --kernel-plugin '%s/gaussian.so'"), 0);
    /* the whole group: failing.py */
    assert_int_equal(status_of("verify kernels/radial_derivative --quiet --failures '%s/failures' "
                               "--kernel-plugin '%s/faulty_WRONG_IN_3D.so'"),
                     1);
}

TEST_BETWEEN(find_folder, NULL);
