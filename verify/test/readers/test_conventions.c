/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests how readers find a snapshot's kernel and the meaning of its h from its densities: for every
 * kernel and both sums, in 1D to 3D, periodic or not, and where densities do not suffice. */
#include "test.h"

#include "conventions.h"
#include "draw.h"
#include "measure.h"
#include "own_folder.h"
#include "snapshot_csv.h"

enum { MOST = 10000 };

static double storage[SNAPSHOT_COLUMNS][MOST];
static const double boxed[3] = {1, 1, 1}, open_box[3] = {0, 0, 0};

/* Particles at random in a unit box, with different widths; the last tenth is not gas. */
static struct snapshot_file scatter(int dim, size_t n, double h, double masses)
{
    struct snapshot_file file = {.dim = dim, .n = n, .gas = n - n / 10};
    for (int c = 0; c < SNAPSHOT_COLUMNS; c++)
        if (c < dim || (c >= SNAPSHOT_VX && c < SNAPSHOT_VX + dim) ||
            (c >= SNAPSHOT_M && c <= SNAPSHOT_H))
            file.column[c] = storage[c];
    for (size_t i = 0; i < n; i++) {
        for (int d = 0; d < dim; d++) storage[d][i] = draw(0, 1);
        for (int d = 0; d < dim; d++) storage[SNAPSHOT_VX + d][i] = draw(-1, 1);
        storage[SNAPSHOT_M][i] = (1 + draw(0, masses)) / (double)n;
        storage[SNAPSHOT_H][i] = h * draw(0.9, 1.1);
        storage[SNAPSHOT_U][i] = storage[SNAPSHOT_P][i] = 1;
    }
    return file;
}

static double apart(const struct snapshot_file *file, const double box[3], size_t i, size_t j)
{
    double squares = 0;
    for (int d = 0; d < file->dim; d++) {
        double x = fabs(file->column[d][i] - file->column[d][j]);
        if (box[d] > 0) x = fmin(x, box[d] - x);
        squares += x * x;
    }
    return sqrt(squares);
}

/* Densities as a code with this kernel computes them; the kernel's support is `ratio` h. */
static void sum_densities(const struct snapshot_file *file, const double box[3],
                          const struct kernel *kernel, double ratio, enum density_sum sum)
{
    for (size_t i = 0; i < file->n; i++) {
        const double H = ratio * file->column[SNAPSHOT_H][i];
        double rho = 0;
        for (size_t j = 0; j < file->n; j++) {
            const double r = apart(file, box, i, j);
            if (r < H)
                rho += file->column[SNAPSHOT_M][sum == DENSITY_MASSES ? j : i] *
                       kernel->w(kernel, r / H, file->dim);
        }
        rho *= kernel->constant[file->dim] / pow(H, file->dim);
        /* other particles say nothing about the gas's kernel */
        file->column[SNAPSHOT_RHO][i] = i < file->gas ? rho : 3 * rho;
    }
}

static struct kernel kernel_called(const char *name)
{
    struct kernel kernel;
    struct error error = {0};
    if (kernel_select(&kernel, name, 5, &error)) fail_msg("%s", error.message);
    return kernel;
}

static struct conventions found_in(const struct snapshot_file *file, const double box[3],
                                   const struct kernel *only, const struct width_meaning *meaning)
{
    static const struct width_meaning unknown;
    struct conventions found;
    struct error error = {0};
    assert_int_equal(
        conventions_find(file, box, only, meaning ? meaning : &unknown, &found, &error), STATUS_OK);
    for (size_t k = 1; k < found.count; k++)
        assert_true(found.candidate[k - 1].residual <= fmax(found.candidate[k].residual, 1e-9));
    return found;
}

static const size_t numbers[4] = {0, 120, 250, 400};
static const double widths[4] = {0, 0.08, 0.2, 0.4}; /* support radii */

static void is_found(const struct conventions *found, const char *name, double ratio,
                     enum density_sum sum)
{
    const struct convention *best = &found->candidate[0];
    if (!found->known || strcmp(best->kernel.member.name, name) != 0)
        fail_msg("%s: %s", name, found->why);
    near_relative(best->ratio, ratio, 1e-6);
    near_below(best->residual, 1e-7);
    assert_int_equal(best->sum, sum);
    assert_non_null(strstr(found->why, "summed again"));
    assert_null(strstr(found->why, name)); /* the second best is another kernel */
    assert_true(found->count <= 2 || strstr(found->why, "; the next kernel, "));
}

TEST(every_kernel)
{
    for (int dim = 1; dim <= 3; dim++)
        for (size_t k = 0; k < kernel_family.n; k++) {
            if (dim > 1 && k % 3 != (size_t)dim % 3) continue; /* all of them in 1D only */
            const char *name = kernel_family.members[k]->name;
            const struct kernel kernel = kernel_called(name);
            const enum density_sum sum = k % 2 ? DENSITY_NUMBER : DENSITY_MASSES;
            const double ratio = k == 0 ? 0.83 : k == 1 ? 4.5 : draw(0.9, 4);
            const double *box = dim > 1 || k % 3 ? boxed : open_box;
            const struct snapshot_file file = scatter(dim, numbers[dim], widths[dim] / ratio, 1);
            sum_densities(&file, box, &kernel, ratio, sum);
            const struct conventions found = found_in(&file, box, NULL, NULL);
            is_found(&found, name, ratio, sum);
            assert_int_equal(found.count, 2 * kernel_family.n);
            assert_true(found.tried && !found.same_masses && found.sample > 0);
            if (box == boxed) assert_int_equal(found.sample, CONVENTIONS_SAMPLE);
        }
}

/* Densities near ends that are not periodic are not compared: there may be walls, layers or a
 * vacuum. */
TEST(particles_near_ends_are_not_compared)
{
    const struct kernel kernel = kernel_called("cubic_spline");
    for (int dim = 1; dim <= 3; dim++)
        for (int across = 0; across < dim; across++)
            for (int far = 0; far < 2; far++) {
                double box[3] = {1, 1, 1};
                const struct snapshot_file file = scatter(dim, numbers[dim], 0.06, 0);
                box[across] = 0;
                sum_densities(&file, box, &kernel, 2, DENSITY_MASSES);
                double lo = 1, hi = 0;
                for (size_t i = 0; i < file.n; i++)
                    lo = fmin(lo, storage[across][i]), hi = fmax(hi, storage[across][i]);
                for (size_t i = 0; i < file.n; i++) {
                    const double gap = fmin(storage[across][i] - lo, hi - storage[across][i]);
                    if (gap <= (far ? 3.4 : 2.999) * storage[SNAPSHOT_H][i])
                        storage[SNAPSHOT_RHO][i] *= 1.5;
                }
                const struct conventions found = found_in(&file, box, &kernel, NULL);
                assert_true(found.known == !far);
                assert_int_equal(found.count, 1);
                assert_true(found.same_masses);
            }
    /* if no particle is that far inside, those more than h inside are compared, or else all */
    for (int margin = 0; margin < 2; margin++) {
        const struct snapshot_file file = scatter(1, 200, margin ? 0.4 : 0.9, 0);
        storage[0][0] = 0, storage[0][1] = 1;
        sum_densities(&file, open_box, &kernel, 1, DENSITY_MASSES);
        for (size_t i = 0; i < file.n && margin; i++)
            if (fmin(storage[0][i], 1 - storage[0][i]) <= storage[SNAPSHOT_H][i])
                storage[SNAPSHOT_RHO][i] *= 1.5;
        const struct conventions found = found_in(&file, open_box, &kernel, NULL);
        assert_true(found.known && found.sample > 0 && found.sample <= CONVENTIONS_SAMPLE);
        near_relative(found.candidate[0].ratio, 1, 1e-6);
    }
}

/* The outermost particle sets the end, wherever it is in the file: if it is far away, the next ones
 * are inside and are compared. */
TEST(the_outermost_particle)
{
    const struct kernel kernel = kernel_called("cubic_spline");
    for (int side = 0; side < 2; side++)
        for (int row = 0; row < 3; row++) { /* which row is far away: the first, the last, none */
            const struct snapshot_file file = scatter(1, numbers[1], 0.06, 0);
            if (row < 2) storage[0][row ? file.n - 1 : 0] = side ? 1.3 : -0.3;
            sum_densities(&file, open_box, &kernel, 2, DENSITY_MASSES);
            for (size_t i = 0; i < file.n; i++)
                if ((side ? 1 - storage[0][i] : storage[0][i]) < 0.12)
                    storage[SNAPSHOT_RHO][i] *= 1.5;
            assert_true(found_in(&file, open_box, &kernel, NULL).known == (row == 2));
        }
}

/* On a lattice any kernel fits; to random densities none fits; a kernel that nearly fits is not
 * known, and the message says how nearly it fits. */
TEST(unknown_kernels)
{
    const struct kernel kernel = kernel_called("wendland_c4");
    struct snapshot_file file;
    struct conventions found;
    for (size_t n = 60; n <= 100; n += 4) {
        file = scatter(1, n, 2. / (double)n, 0);
        for (size_t i = 0; i < n; i++)
            storage[0][i] = (double)i / (double)n, storage[SNAPSHOT_RHO][i] = 1,
            storage[SNAPSHOT_H][i] = 2. / (double)n;
        found = found_in(&file, boxed, NULL, NULL);
        assert_false(found.known);
        assert_non_null(strstr(found.why, "not 10 times more"));
    }
    for (size_t i = 0; i < file.n; i++) storage[SNAPSHOT_RHO][i] = draw(1, 2);
    found = found_in(&file, boxed, NULL, NULL);
    assert_false(found.known);
    assert_non_null(strstr(found.why, "no kernel's sum agrees with the density: the best, "));
    for (int worse = 0; worse < 2; worse++) { /* the limit is 1e-3 */
        file = scatter(2, 400, 0.15, 0);
        sum_densities(&file, boxed, &kernel, 1, DENSITY_MASSES);
        for (size_t i = 0; i < file.n; i++)
            storage[SNAPSHOT_RHO][i] *= 1 + (worse ? 1.3e-3 : 0.7e-3) * (draw(0, 1) < 0.5 ? 1 : -1);
        found = found_in(&file, boxed, &kernel, NULL);
        assert_true(found.known == !worse);
        near_inside(found.candidate[0].residual, worse ? 1.1e-3 : 0.5e-3, worse ? 1.4e-3 : 0.8e-3);
    }
    file.column[SNAPSHOT_H] = NULL;
    found = found_in(&file, boxed, NULL, NULL);
    assert_true(!found.known && !found.tried && found.count == 0);
    assert_string_equal(found.why, "the file has no smoothing lengths");
}

TEST(masses)
{
    static const size_t changed[] = {0, 1, 99};
    for (int more = 0; more < 2; more++)
        for (size_t k = 0; k < sizeof changed / sizeof *changed; k++) {
            const struct snapshot_file file = scatter(1, 100, 0.05, 0);
            storage[SNAPSHOT_M][changed[k]] *= 1 + (k % 2 ? -1 : 1) * (more ? 1.01e-6 : 0.99e-6);
            for (size_t i = 0; i < file.n; i++) storage[SNAPSHOT_RHO][i] = 1;
            assert_true(found_in(&file, boxed, NULL, NULL).same_masses == !more);
        }
}

/* If masses hardly differ both sums fit: the kernel is known, and named once. */
TEST(either_sum)
{
    const struct kernel kernel = kernel_called("quadratic_spline");
    const struct snapshot_file file = scatter(1, 120, 0.08, 0);
    for (size_t i = 0; i < file.n; i++) storage[SNAPSHOT_M][i] *= 1 + draw(-3e-6, 3e-6);
    sum_densities(&file, boxed, &kernel, 1, DENSITY_MASSES);
    for (size_t i = 0; i < file.n; i++) storage[SNAPSHOT_RHO][i] *= 1 + draw(-3e-6, 3e-6);
    const struct conventions found = found_in(&file, boxed, NULL, NULL);
    assert_true(found.known && found.any_sum && !found.same_masses);
    assert_string_equal(found.candidate[0].kernel.member.name, "quadratic_spline");
    assert_string_equal(found.candidate[1].kernel.member.name, "quadratic_spline");
    assert_null(strstr(found.why, "quadratic_spline"));
    assert_non_null(strstr(found.why, "; the next kernel, "));
}

/* A stated kernel or meaning of h is used, and the message says how well it fits. */
TEST(stated_conventions_are_used)
{
    const struct kernel cubic = kernel_called("cubic_spline"),
                        quintic = kernel_called("quintic_spline");
    const struct snapshot_file file = scatter(2, 400, 0.075, 1);
    sum_densities(&file, boxed, &cubic, 2, DENSITY_MASSES);
    struct conventions found = found_in(&file, boxed, &cubic, NULL); /* without a meaning of h */
    assert_int_equal(found.count, 2);
    near_relative(found.candidate[0].ratio, 2, 1e-6);
    assert_true(found.known);
    found = found_in(&file, boxed, &quintic, NULL);
    assert_false(found.known);
    found = found_in(&file, boxed, &cubic, &(struct width_meaning){.ratio = 2});
    assert_true(found.known && found.candidate[0].ratio == 2);
    near_below(found.candidate[0].residual, 1e-13);
    assert_non_null(strstr(found.why, "as given; density is summed again to "));
    found = found_in(&file, boxed, &cubic, &(struct width_meaning){.ratio = 2.5});
    assert_true(found.known && found.candidate[0].ratio == 2.5 &&
                found.candidate[0].residual > 0.01);
    found = found_in(&file, boxed, &cubic, &(struct width_meaning){.deviations = 2});
    near_relative(found.candidate[0].ratio, 1.778002, 1e-6);
    found = found_in(&file, boxed, NULL, &(struct width_meaning){.ratio = 2}); /* no kernel */
    assert_int_equal(found.count, 2 * kernel_family.n);
    is_found(&found, "cubic_spline", 2, DENSITY_MASSES);
    found =
        found_in(&file, boxed, NULL, &(struct width_meaning){.ratio = 6}); /* beyond those tried */
    for (size_t k = 0; k < found.count; k++) assert_true(found.candidate[k].ratio == 6);
    assert_int_equal(found.count, 2 * kernel_family.n);
    /* standard deviation of a B-spline of n pieces in 1D: sqrt(n/12) times the width of a piece */
    static const char *const splines[] = {"quadratic_spline", "cubic_spline", "quartic_spline",
                                          "quintic_spline"};
    for (int n = 3; n <= 6; n++) {
        const struct kernel spline = kernel_called(splines[n - 3]);
        near_relative(measure_deviation(&spline, 1), sqrt(n / 12.) * 2 / n, 1e-7);
    }
    near_relative(measure_deviation(&cubic, 2), 0.5 / 1.778002, 1e-6);
    near_relative(measure_deviation(&cubic, 3), 0.5 / 1.825742, 1e-6);
}

/* A sum over more than 4096 neighbours ends the search: smaller ratios are still found. */
TEST(too_many_neighbours_end_the_search)
{
    const struct kernel cubic = kernel_called("cubic_spline");
    struct snapshot_file file = scatter(1, MOST, 0.1, 0); /* with 4096 others up to 2.048 h */
    for (size_t i = 0; i < file.n; i++)
        storage[SNAPSHOT_H][i] = 0.1, storage[0][i] = (double)i / MOST;
    for (size_t i = 0; i < file.n; i++) storage[SNAPSHOT_RHO][i] = 1;
    struct conventions found =
        found_in(&file, boxed, &cubic, &(struct width_meaning){.ratio = 2.0475});
    assert_true(found.known && found.count == 1 && found.candidate[0].residual < 1e-3);
    found = found_in(&file, boxed, &cubic, &(struct width_meaning){.ratio = 2.0485});
    assert_true(!found.known && found.count == 0);
    assert_string_equal(found.why, "no sum is finite");
    for (size_t i = 0; i < file.n; i++) storage[SNAPSHOT_H][i] = 0.3; /* too many neighbours */
    found = found_in(&file, boxed, &cubic, NULL);
    assert_true(!found.known && found.count == 0);
}

/* ---- as columns ---- */

TEST(as_columns)
{
    for (int dim = 1; dim <= 3; dim++)
        for (int proved = 0; proved < 3; proved++) { /* 2: without h */
            const struct kernel kernel = kernel_called("quintic_spline");
            const struct snapshot_file made = scatter(dim, numbers[dim], widths[dim] / 3, 1);
            struct snapshot_file file;
            struct csv csv;
            struct error error = {0};
            char why[200] = "";
            sum_densities(&made, boxed, &kernel, 3, DENSITY_MASSES);
            FILE *out = fopen(path_of("c.csv"), "w");
            assert_non_null(out);
            fprintf(out, "# box = 1\nm,rho,u,%s", proved < 2 ? "h," : "");
            for (int d = 0; d < dim; d++) fprintf(out, "%c,v%c,a%c,", 'x' + d, 'x' + d, 'x' + d);
            fprintf(out, "du,itype\n");
            for (size_t i = 0; i < made.n; i++) {
                const double rho = storage[SNAPSHOT_RHO][i] * (proved == 1 ? 1 : draw(1, 2));
                fprintf(out, "%.17g,%.17g,2,", storage[SNAPSHOT_M][i], rho);
                if (proved < 2) fprintf(out, "%.17g,", storage[SNAPSHOT_H][i]);
                for (int d = 0; d < dim; d++)
                    fprintf(out, "%.17g,%.17g,%d,", storage[d][i], storage[SNAPSHOT_VX + d][i], d);
                fprintf(out, "7,%d\n", i < made.gas ? 1 : 2);
            }
            fclose(out);
            if (snapshot_csv(path_of("c.csv"), &file, &csv, why, &error))
                fail_msg("%s", error.message);
            assert_int_equal(csv.rows, made.gas);
            assert_int_equal(csv.columns, 3 * dim + 4 + (proved == 1));
            for (size_t i = 0; i < csv.rows; i++) assert_int_equal(csv.line[i], i + 1);
            for (size_t c = 0; c < csv.columns; c++) {
                const int at = snapshot_column_of(csv.names[c]);
                assert_string_equal(csv.names[c], snapshot_column_names[at]);
                assert_null(file.column[at]);
                for (size_t i = 0; i < csv.rows && at < SNAPSHOT_U && at != SNAPSHOT_RHO; i++)
                    assert_true(csv.values[c][i] == storage[at][i]);
                for (size_t i = 0; i < csv.rows; i++) {
                    if (at == SNAPSHOT_H) near_relative(csv.values[c][i], 3 * storage[at][i], 1e-6);
                    if (at >= SNAPSHOT_AX && at < SNAPSHOT_DU)
                        assert_true(csv.values[c][i] == at - SNAPSHOT_AX);
                    if (at == SNAPSHOT_DU) assert_true(csv.values[c][i] == 7);
                }
            }
            assert_non_null(strstr(why, proved == 1 ? "summed again"
                                        : proved    ? "no smoothing"
                                                    : "no kernel's sum"));
            csv_free(&csv);
            snapshot_file_free(&file);
        }
    struct snapshot_file file;
    struct csv csv;
    struct error error = {0};
    char why[200];
    assert_int_equal(snapshot_csv(path_of("none.csv"), &file, &csv, why, &error), STATUS_BAD_INPUT);
    csv_free(&csv);
    snapshot_file_free(&file);
}

/* Names of columns become ours, unless the file has ours too; as many unknown ones as fit are
 * listed. */
TEST(names_of_columns)
{
#define LONG "a_name_of_forty_letters_with_the_number_"
    static const struct {
        const char *head, *names, *unknown;
    } rows[] = {{"x,Density,Mass", "x,rho,m", ""},
                {"rho,Density,foo,pos,bar", "rho,Density,foo,x,bar", "foo bar"},
                {LONG "1," LONG "2," LONG "3," LONG "4," LONG "5",
                 LONG "1," LONG "2," LONG "3," LONG "4," LONG "5",
                 LONG "1 " LONG "2 " LONG "3 " LONG "4 a_name_of_forty_letters_with_th"}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct snapshot_file file;
        struct csv csv = {0};
        struct error error = {0};
        char unknown[200] = "nothing", names[300] = "";
        FILE *out = fopen(path_of("n.csv"), "w");
        assert_non_null(out);
        fprintf(out, "%s\n1,2,3%s\n", rows[k].head, k ? ",4,5" : "");
        fclose(out);
        if (snapshot_csv_named(path_of("n.csv"), &file, &csv, unknown, &error))
            fail_msg("%s", error.message);
        for (size_t c = 0; c < csv.columns; c++)
            snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s", c ? "," : "",
                     csv.names[c]);
        assert_string_equal(names, rows[k].names);
        assert_string_equal(unknown, rows[k].unknown);
        csv_free(&csv);
        snapshot_file_free(&file);
    }
    struct snapshot_file file;
    struct csv csv = {0};
    struct error error = {0};
    char unknown[200];
    FILE *out = fopen(path_of("n.csv"), "w");
    assert_non_null(out);
    fprintf(out, "# time = 0.2\n#\n# time = 0.1\nx,v\n1,2\n");
    fclose(out);
    assert_int_equal(snapshot_csv_named(path_of("n.csv"), &file, &csv, unknown, &error),
                     STATUS_BAD_INPUT);
    assert_non_null(strstr(error.message, ":3: '# time = 0.1'; allowed: one value, but line 1"));
    csv_free(&csv);
}

/* ---- notes ---- */

TEST(notes)
{
    struct snapshot_notes notes = {0};
    for (int k = 0; k < SNAPSHOT_NOTES_MAX + 2; k++)
        snapshot_note(&notes, "what", k % 2 ? "\x01" : "value", "%d\n%s", k, "evidence");
    assert_int_equal(notes.count, SNAPSHOT_NOTES_MAX);
    for (int k = 0; k < SNAPSHOT_NOTES_MAX; k++) {
        char evidence[40];
        snprintf(evidence, sizeof evidence, "%d", k);
        assert_string_equal(notes.note[k].what, "what");
        if (k % 2 == 0) assert_string_equal(notes.note[k].value, "value");
        assert_null(strchr(notes.note[k].value, '\x01'));
        assert_true(strncmp(notes.note[k].evidence, evidence, strlen(evidence)) == 0);
        assert_null(strchr(notes.note[k].evidence, '\n'));
        assert_non_null(strstr(notes.note[k].evidence, "evidence"));
    }
    struct snapshot_file file = {
        .n = SNAPSHOT_ROWS_MAX + (size_t)1, .box = {7, 7, 7}, .corner = {7, 7, 7}, .placed = true};
    assert_true(snapshot_take_box("2 1", &file) && !file.placed);
    assert_true(file.box[0] == 2 && file.box[1] == 1 && file.box[2] == 7);
    for (int d = 0; d < 3; d++) assert_true(file.corner[d] == 0);
    static const struct {
        const char *boundary;
        double period[3];
    } rows[] = {{"", {2, 1, 7}},
                {"periodic", {2, 1, 7}},
                {"open", {0}},
                {"periodic open", {2, 0, 0}},
                {"open periodic", {0, 1, 7}},
                {"periodic fixed periodic", {2, 0, 7}}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        for (int d = 0; d < 3; d++)
            for (int known = 0; known < 2; known++) {
                file.boxed = known;
                snprintf(file.boundary, sizeof file.boundary, "%s", rows[k].boundary);
                assert_true(snapshot_period(&file, d) == (known ? rows[k].period[d] : 0));
            }
    assert_int_equal(snapshot_file_make(&file, SNAPSHOT_X, "a", NULL), STATUS_ENVIRONMENT);
    assert_null(file.column[SNAPSHOT_X]);
}
