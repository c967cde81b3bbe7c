/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the arrays of particles: they never overlap, ghosts included, and values stay when arrays
 * grow, are saved and restored, or follow a new order of the particles. Large pages are requested
 * exactly for arrays that are at least as long as one. */
#include "test.h"

#include <unistd.h>

#include "byte_buffer.h"
#include "pages.h"
#include "particles.h"

enum { ARRAYS_MOST = 80, LINE = 8 };

/* The arrays in use. */
static size_t list(const struct particles *a, double *arrays[ARRAYS_MOST])
{
    size_t count = 0;
#define SCALAR(name, use, meaning)                                                                 \
    if (a->uses & (use)) arrays[count++] = a->name;
#define VECTOR(name, use, meaning)                                                                 \
    for (int k = 0; k < 3; k++)                                                                    \
        if (a->name[k] && a->uses & (use)) arrays[count++] = a->name[k];
    PARTICLE_FIELDS(SCALAR, VECTOR)
#undef SCALAR
#undef VECTOR
    assert_true(count < ARRAYS_MOST);
    return count;
}

static struct particles made(int dim, ptrdiff_t n, ptrdiff_t ghosts)
{
    struct particles a;
    struct error error;
    if (particles_create(&a, dim, n, ghosts, &error)) fail_msg("%s", error.message);
    return a;
}

/* A different value for every element of every array. */
static double value(size_t k, ptrdiff_t i)
{
    return 1e4 * (double)(k + 1) + (double)i;
}

static void fill(const struct particles *a, ptrdiff_t ghosts)
{
    double *arrays[ARRAYS_MOST];
    const size_t count = list(a, arrays);
    for (size_t k = 0; k < count; k++)
        for (ptrdiff_t i = -ghosts; i < a->n + ghosts; i++) arrays[k][i] = value(k, i);
}

/* Arrays are filled up to the given number of ghosts, and zero beyond. */
static void filled(const struct particles *a, ptrdiff_t ghosts)
{
    double *arrays[ARRAYS_MOST];
    const size_t count = list(a, arrays);
    for (size_t k = 0; k < count; k++)
        for (ptrdiff_t i = -a->ghosts; i < a->n + a->ghosts; i++) {
            const bool inside = i >= -ghosts && i < a->n + ghosts;
            assert_true(arrays[k][i] == (inside ? value(k, i) : 0));
        }
}

TEST(arrays_do_not_overlap)
{
    for (int dim = 1; dim <= 3; dim++)
        for (ptrdiff_t n = 2; n < 40; n += 1 + n / 12)
            for (ptrdiff_t ghosts = 0; ghosts < 30; ghosts += 7) {
                struct particles a = made(dim, n, ghosts);
                double *arrays[ARRAYS_MOST];
                const size_t count = list(&a, arrays);
                assert_int_equal(count, 11 * dim + 33);
                assert_true(a.n == n && a.dim == dim);
                assert_true(a.ghosts == (ghosts + LINE - 1) / LINE * LINE);
                filled(&a, -n); /* all zero */
                fill(&a, a.ghosts);
                for (ptrdiff_t i = 0; i < n; i++) a.spare[i] = -1, a.id[i] = a.order[i] = 7;
                filled(&a, a.ghosts);
                for (size_t k = 0; k < count; k++) /* whole cache lines, an odd number of them */
                    assert_int_equal((uintptr_t)arrays[k] % (LINE * sizeof(double)), 0);
                const ptrdiff_t apart = arrays[1] - arrays[0];
                assert_int_equal(apart / LINE % 2, 1);
                assert_true(apart >= n + 2 * a.ghosts + LINE &&
                            apart < n + 2 * a.ghosts + 4 * LINE);
                particles_destroy(&a);
                assert_true(!a.block && !a.id && !a.order && a.n == 0);
            }
}

TEST(capacity_for_more_ghosts)
{
    for (ptrdiff_t ghosts = 8; ghosts < 60; ghosts += 9) {
        struct particles a = made(1, 21, 8);
        struct error error;
        fill(&a, 0);
        assert_int_equal(particles_grow_ghosts(&a, ghosts, &error), STATUS_OK);
        assert_int_equal(a.ghosts, (ghosts + LINE - 1) / LINE * LINE);
        filled(&a, 0);
        particles_destroy(&a);
    }
}

/* --- serialised ------------------------------------------------------------------------------- */

/* Only the arrays in use are serialised; the others stay as they are. */
TEST(serialised_arrays)
{
    static struct byte_buffer bag;
    for (int dim = 1; dim <= 3; dim++)
        for (ptrdiff_t n = 3; n < 300; n += 59)
            for (unsigned uses = USE_ALWAYS; uses < USE_ALL; uses = 5 * uses + 2) {
                struct particles a = made(dim, n, 16), b = made(dim, n, 8);
                double *from[ARRAYS_MOST], *to[ARRAYS_MOST];
                fill(&a, 16);
                a.uses = b.uses = uses;
                const size_t count = list(&a, from);
                assert_int_equal(count, particles_arrays(dim, uses));
                for (ptrdiff_t i = 0; i < n; i++) a.id[i] = (size_t)(2 * i + 1);
                struct serialiser out = {.bytes = buffer_put, .context = &bag},
                                  back = {.bytes = buffer_take, .context = &bag, .back = true};
                bag.used = bag.read = 0;
                particles_serialise(&a, &out);
                assert_false(out.failed);
                assert_int_equal(bag.used, sizeof(ptrdiff_t) + 8 * count * (size_t)(n + 32) +
                                               (size_t)n * sizeof(size_t));
                particles_serialise(&b, &back);
                assert_false(back.failed);
                assert_int_equal(bag.read, bag.used);
                assert_int_equal(b.ghosts, 16);
                list(&b, to);
                for (size_t k = 0; k < count; k++)
                    assert_memory_equal(to[k] - 16, from[k] - 16, 8 * (size_t)(n + 32));
                b.uses = USE_ALL & ~uses;
                const size_t others = list(&b, to);
                for (size_t k = 0; k < others; k++)
                    for (ptrdiff_t i = -16; i < n + 16; i++) assert_true(to[k][i] == 0);
                for (ptrdiff_t i = 0; i < n; i++) assert_int_equal(b.id[i], 2 * i + 1);
                particles_destroy(&a);
                particles_destroy(&b);
            }
}

static bool nothing(void *context, void *bytes, size_t n)
{
    (void)bytes, (void)n;
    return --*(int *)context > 0;
}

/* If reading a saved state fails, the particles stay as they are. */
TEST(failed_restore_changes_nothing)
{
    struct particles a = made(1, 9, 8);
    fill(&a, 8);
    for (int calls = 1; calls < 5; calls++) {
        int left = calls;
        struct serialiser back = {.bytes = nothing, .context = &left, .back = true};
        particles_serialise(&a, &back);
        assert_true(back.failed && left == 0);
        filled(&a, 8);
    }
    particles_destroy(&a);
}

/* --- order ------------------------------------------------------------------------------------ */

TEST(permutation_of_particles)
{
    for (int dim = 1; dim <= 3; dim++)
        for (ptrdiff_t n = 2; n < 200; n += 1 + n / 2) {
            struct particles a = made(dim, n, 8);
            double *arrays[ARRAYS_MOST];
            const size_t count = list(&a, arrays);
            fill(&a, 8);
            for (ptrdiff_t i = 0; i < n; i++)
                a.order[i] = (size_t)(n - 1 - i), a.id[i] = (size_t)(10 + i);
            a.order[0] = (size_t)(n - 2), a.order[1] = (size_t)(n - 1);
            size_t order[200];
            memcpy(order, a.order, (size_t)n * sizeof *order);
            a.uses = USE_ALL & ~USE_GRAD_H;
            particles_permute(&a);
            for (size_t k = 0; k < count; k++)
                for (ptrdiff_t i = -8; i < n + 8; i++) {
                    const bool stays = i < 0 || i >= n || arrays[k] == a.b || arrays[k] == a.grad_h;
                    assert_true(arrays[k][i] == value(k, stays ? i : (ptrdiff_t)order[i]));
                }
            for (ptrdiff_t i = 0; i < n; i++) assert_int_equal(a.id[i], 10 + order[i]);
            particles_destroy(&a);
        }
}

TEST(sizes_of_vectors)
{
    for (int dim = 1; dim <= 3; dim++) {
        struct particles a = made(dim, 9, 0);
        for (int k = 0; k < dim; k++)
            for (ptrdiff_t i = 0; i < 9; i++) a.v[k][i] = (k == 1 ? -2 : 1) * (double)(i + k - 3);
        for (ptrdiff_t i = 0; i < 9; i++) {
            const double y = dim > 1 ? -2 * (double)(i - 2) : 0, z = dim > 2 ? (double)(i - 1) : 0;
            const double x = (double)(i - 3), size = particles_norm(&a, a.v, i);
            assert_true(dim == 1 ? size == fabs(x) : size == sqrt(x * x + y * y + z * z));
        }
        particles_destroy(&a);
    }
}

/* --- pages ------------------------------------------------------------------------------------ */

/* 1 if the system's list of mappings says that large pages were requested at this address, 0 if
 * not, -1 if there is no such list. */
static int asked_for(uintptr_t address)
{
    FILE *file = fopen("/proc/self/smaps", "r");
    char text[512];
    bool here = false;
    int asked = -1;
    while (file && fgets(text, sizeof text, file)) {
        unsigned long begin, end;
        char mode;
        if (sscanf(text, "%lx-%lx %c", &begin, &end, &mode) == 3)
            here = address >= begin && address < end;
        else if (here && strncmp(text, "VmFlags:", 8) == 0)
            asked = strstr(text, " hg") != NULL;
    }
    if (file) fclose(file);
    return asked;
}

static void expect_pages(int dim, ptrdiff_t n, const char *array, bool asked)
{
    struct particles a = made(dim, n, 64);
    const double *first = strcmp(array, "x") == 0 ? a.x[0] : a.signal;
    /* for longer blocks test the address one large page further on, because the first large page
     * may begin after the start of the array */
    const int found = asked_for((uintptr_t)first + (n < (1 << 17) ? 0 : 1 << 21));
    particles_destroy(&a);
    if (found != asked) fail_msg("%d-D, %td particles, %s: %d", dim, n, array, found);
}

TEST(large_pages)
{
    if (access("/sys/kernel/mm/transparent_hugepage/enabled", R_OK) ||
        asked_for((uintptr_t)&state) < 0)
        skip();
    for (int dim = 1; dim <= 3; dim++) {
        expect_pages(dim, 1000, "x", false);
        expect_pages(dim, (1 << 18) - 500, "x", false);
        expect_pages(dim, 1 << 18, "x", true);
        expect_pages(dim, 1 << 19, "signal", true);
    }
    void *records = pages_allocate(PAGES_LARGE);
    const int asked = asked_for((uintptr_t)records);
    free(records);
    assert_true(asked && (uintptr_t)records % PAGES_LARGE == 0);
}
