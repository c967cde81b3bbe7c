/* SPDX-License-Identifier: GPL-3.0-or-later
 * sphproof gradient: applies an operator to the columns of a user's points, and checks gradients
 * that another code computed on them. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "plugin_kernel.h"
#include "point_cloud.h"
#include "result.h"
#include "text.h"

enum { DIM_MAX = 3, ROWS_SHOWN = 20, SINC_ORDER = 5, CHECKS_MAX = 64 };

struct request {
    const char *path;
    int dim;
    double eta, h, tolerance;
    const char *checks; /* COLUMN=dx[,dy,dz], one per line, or NULL */
    bool boxed;
    double lo[DIM_MAX], hi[DIM_MAX];
    struct kernel kernel;
    struct operator_settings settings;
};

struct answer {
    double *memory, *gradient[CSV_COLUMNS_MAX * DIM_MAX];
    struct operator_point *point;
};

struct judgement {
    const double *column;         /* the field whose gradient is judged */
    size_t field;                 /* its index in the fields */
    const double *given[DIM_MAX]; /* columns of the file */
    size_t judged, failed, worst; /* points; the worst one's row */
    double departure, bound;      /* relative, at the worst point */
};

struct judgements {
    size_t count;
    struct judgement of[CHECKS_MAX];
};

/* ---- input ---- */

/* Reads --box: "0:1" for all directions, or one such pair for each. */
static enum status take_box(const struct options *options, struct request *r, struct error *error)
{
    const char *text = options_value(options, "box");
    if (!text) return STATUS_OK;
    char copy[strlen(text) + 1], *rest = strcpy(copy, text), *pair = NULL;
    const bool each = strchr(text, ',');
    bool sound = true;
    for (int a = 0; a < r->dim && sound; a++) {
        double ends[2];
        if (each || !a) pair = strsep(&rest, ",");
        sound = pair && text_reals(pair, ":", 2, ends) && ends[0] < ends[1];
        if (sound) r->lo[a] = ends[0], r->hi[a] = ends[1];
    }
    if (!sound || rest)
        return error_set(error, STATUS_BAD_INPUT,
                         "gradient: --box '%.60s': allowed with --dim %d: LO:HI for all directions "
                         "or one for each, separated by commas, LO below HI",
                         text, r->dim);
    r->boxed = true;
    return STATUS_OK;
}

static enum status take_request(const struct options *options, int n, char **arguments,
                                struct request *r, struct error *error)
{
    const char *name = options_value(options, "operator");
    const char *kernel = options_value(options, "kernel"), *dim = options_value(options, "dim");
    double number;
    int index;
    if (n != 1) return command_usage(options, error, "one cloud is needed, %d given", n);
    if (!name || !kernel || !dim)
        return command_usage(options, error, "--operator, --kernel and --dim are needed");
    r->path = arguments[0];
    r->settings = (struct operator_settings){
        .form = (const struct operator_form *)family_find(&operator_family, name),
        .kernel = &r->kernel,
        .threads = options->threads};
    if (!r->settings.form)
        return text_unknown_member(error, "gradient", "operator", name, &operator_family);
    if (!text_integer(dim, &number) || !(number >= 1 && number <= DIM_MAX))
        return error_set(error, STATUS_BAD_INPUT, "gradient: --dim '%.40s': allowed: 1, 2, 3", dim);
    r->dim = (int)number;
    if (options_kernel(options, &index, error) ||
        plugin_select(&r->kernel, index, SINC_ORDER, r->dim, error))
        return error->status;
    r->tolerance = 1e-9;
    if (options_positive(options, "eta", &r->eta, error) ||
        options_positive(options, "h", &r->h, error) ||
        options_positive(options, "tolerance", &r->tolerance, error))
        return error->status;
    if (r->eta > 0 && r->h > 0)
        return error_set(error, STATUS_BAD_INPUT,
                         "gradient: --eta and --h exclude each other: both set the support radius");
    if (take_box(options, r, error)) return error->status;
    r->checks = options_value(options, "check");
    if (!r->checks && options_value(options, "tolerance"))
        return error_set(error, STATUS_BAD_INPUT, "gradient: --tolerance belongs to --check");
    return STATUS_OK;
}

/* NULL: there is no such column. */
static const double *column_of(const struct point_cloud *pc, const char *name)
{
    for (size_t k = 0; k < pc->fields; k++)
        if (strcmp(pc->name[k], name) == 0) return pc->field[k];
    return NULL;
}

/* Reads COLUMN=dx[,dy,dz], length characters of text. */
static enum status take_check(const struct request *r, const struct point_cloud *pc,
                              const char *check, size_t length, struct judgement *j,
                              struct error *error)
{
    char text[1024];
    const int shown = (int)fmin((double)length, 60);
    if (length >= sizeof text)
        return error_set(error, STATUS_BAD_INPUT, "gradient: --check is too long");
    memcpy(text, check, length);
    text[length] = '\0';
    char *rest = text;
    const char *judged = strsep(&rest, "=");
    if (!rest)
        return error_set(error, STATUS_BAD_INPUT,
                         "gradient: --check '%.*s': allowed: COLUMN=dx[,dy,dz]", shown, check);
    bool sound = true;
    for (int a = 0; a < r->dim && sound; a++) {
        const char *name = strsep(&rest, ",");
        const double *column = name ? column_of(pc, name) : NULL;
        if (name && !column)
            return text_unknown(error, "gradient: --check", "column", name, pc->name, pc->fields);
        sound = column;
        j->given[a] = column;
        for (int b = 0; b < a; b++) sound = sound && j->given[b] != column;
    }
    if (!sound || rest)
        return error_set(error, STATUS_BAD_INPUT,
                         "gradient: --check '%.*s': allowed with --dim %d: %d distinct columns "
                         "after the '='",
                         shown, check, r->dim, r->dim);
    j->column = column_of(pc, judged);
    return j->column
               ? STATUS_OK
               : text_unknown(error, "gradient: --check", "column", judged, pc->name, pc->fields);
}

static bool is_given(const struct judgements *all, int dim, const double *column)
{
    for (size_t c = 0; c < CHECKS_MAX; c++)
        for (int a = 0; a < dim; a++)
            if (all->of[c].given[a] == column) return true;
    return false;
}

/* Removes the columns of given gradients from the fields to differentiate. */
static enum status leave_out_given(const struct request *r, struct point_cloud *pc,
                                   struct judgements *all, struct error *error)
{
    size_t kept = 0;
    for (size_t l = 0; l < pc->fields; l++) {
        const bool given = is_given(all, r->dim, pc->field[l]);
        for (size_t c = 0; c < CHECKS_MAX; c++) {
            if (all->of[c].column != pc->field[l]) continue;
            if (given)
                return error_set(error, STATUS_BAD_INPUT,
                                 "gradient: --check: '%.40s' cannot be judged, and be a gradient "
                                 "itself",
                                 pc->name[l]);
            all->of[c].field = kept;
        }
        if (given) continue;
        pc->field[kept] = pc->field[l], pc->name[kept++] = pc->name[l];
    }
    pc->fields = kept;
    return STATUS_OK;
}

static enum status take_checks(const struct request *r, struct point_cloud *pc,
                               struct judgements *all, struct error *error)
{
    for (const char *rest = r->checks; rest;) {
        const size_t length = strcspn(rest, "\n");
        if (all->count == CHECKS_MAX)
            return error_set(error, STATUS_BAD_INPUT, "gradient: --check: at most %d", CHECKS_MAX);
        if (take_check(r, pc, rest, length, &all->of[all->count], error)) return error->status;
        for (size_t c = 0; c < all->count; c++)
            if (all->of[c].column == all->of[all->count].column)
                return error_set(error, STATUS_BAD_INPUT,
                                 "gradient: --check '%.60s': this column is judged twice", rest);
        all->count++;
        rest = rest[length] ? rest + length + 1 : NULL;
    }
    return leave_out_given(r, pc, all, error);
}

/* Refuses positions outside the box, which are more likely a wrong box than intended. */
static enum status place_in_box(const struct request *r, struct point_cloud *pc,
                                struct error *error)
{
    struct points *points = &pc->cloud.points;
    points->periodic = r->boxed;
    for (int a = 0; a < r->dim && r->boxed; a++) {
        points->lo[a] = r->lo[a], points->hi[a] = r->hi[a];
        for (size_t i = 0; i < points->n; i++)
            if (!(points->x[a][i] >= r->lo[a] && points->x[a][i] <= r->hi[a]))
                return error_set(error, STATUS_BAD_INPUT,
                                 "%.200s:%zu: %c = %.17g is not in the box from %.10g to %.10g",
                                 r->path, pc->csv.line[i], "xyz"[a], points -> x[a][i], r -> lo[a],
                                 r -> hi[a]);
    }
    return STATUS_OK;
}

/* ---- work ---- */

static enum status compute(const struct request *r, const struct point_cloud *pc,
                           struct answer *answer, struct error *error)
{
    const size_t n = pc->cloud.points.n, columns = pc->fields * (size_t)r->dim;
    answer->memory = malloc(columns * n * sizeof(double));
    answer->point = calloc(n, sizeof *answer->point);
    if (!answer->memory || !answer->point)
        return error_set(error, STATUS_ENVIRONMENT, "no memory for gradients of %zu points", n);
    for (size_t c = 0; c < columns; c++) answer->gradient[c] = answer->memory + c * n;
    return operator_apply(&r->settings, &pc->cloud, pc->fields, pc->field, answer->gradient,
                          answer->point, NULL, error);
}

/* |given - ours| <= bound max(|ours|, 1e-4 max|f|/h), bound = tolerance + 1e-15 condition: two
 * right codes differ by round-off, which is relative to f/h and grows with the condition number. */
static void judge(const struct request *r, const struct point_cloud *pc,
                  const struct answer *answer, struct judgement *j)
{
    const size_t dim = (size_t)r->dim;
    double largest = 0, worst = -HUGE_VAL;
    for (size_t i = 0; i < pc->cloud.points.n; i++)
        largest = fmax(largest, fabs(pc->field[j->field][i]));
    for (size_t i = 0; i < pc->cloud.points.n; i++) {
        double difference = 0, ours = 0;
        for (size_t a = 0; a < dim; a++) {
            const double g = answer->gradient[j->field * dim + a][i];
            difference = hypot(difference, j->given[a][i] - g);
            ours = hypot(ours, g);
        }
        if (isnan(ours)) continue; /* no gradient of ours to compare with */
        const double condition = answer->point[i].condition;
        const double bound = r->tolerance + (r->settings.form->corrected ? 1e-15 * condition : 0);
        const double scale = fmax(ours, 1e-4 * largest / pc->h[i]);
        const double departure = scale > 0 ? difference / scale : difference > 0 ? HUGE_VAL : 0;
        j->judged++;
        j->failed += !(departure <= bound) ? 1u : 0u;
        if (departure / bound > worst) {
            worst = departure / bound;
            j->worst = i, j->departure = departure, j->bound = bound;
        }
    }
}

/* ---- output ---- */

static const char *state_text(enum operator_state state)
{
    static const char *const texts[] = {"ok", "too few neighbours", "ill-conditioned matrix",
                                        "singular matrix", "overflow"};
    return texts[state];
}

static void print_row(const struct request *r, const struct point_cloud *pc,
                      const struct answer *answer, size_t i)
{
    printf("%7zu", i + 1);
    for (int a = 0; a < r->dim; a++) printf(" %13.6g", pc->cloud.points.x[a][i]);
    printf(" %6u %10.3g", answer->point[i].neighbours, answer->point[i].condition);
    for (size_t c = 0; c < pc->fields * (size_t)r->dim; c++)
        printf(" %16.9g", answer->gradient[c][i]);
    printf("%s%s\n", answer->point[i].state ? "  " : "",
           answer->point[i].state ? state_text(answer->point[i].state) : "");
}

static void print_flagged(const struct request *r, const struct point_cloud *pc,
                          const struct answer *answer)
{
    size_t flagged = 0;
    for (size_t i = 0; i < pc->cloud.points.n; i++) {
        const struct operator_point *point = &answer->point[i];
        if (!point->state || flagged++ >= ROWS_SHOWN) continue;
        printf("flagged: row %zu (%s:%zu) at (", i + 1, r->path, pc->csv.line[i]);
        for (int a = 0; a < r->dim; a++) printf("%s%.9g", a ? ", " : "", pc->cloud.points.x[a][i]);
        printf("): %s: %u within h = %.6g, itself included; condition %.3g\n",
               state_text(point->state), point->neighbours, pc->h[i], point->condition);
    }
    if (flagged > ROWS_SHOWN) printf("flagged: %zu more\n", flagged - ROWS_SHOWN);
    printf("%zu of %zu points flagged\n", flagged, pc->cloud.points.n);
}

static void print_answer(const struct request *r, const struct point_cloud *pc,
                         const struct answer *answer)
{
    const size_t n = pc->cloud.points.n;
    printf("%s, %s, %dD, %zu points\n", r->settings.form->member.name, r->kernel.member.name,
           r->dim, n);
    printf("neighbours: points within h, itself included; condition: of the operator's matrix\n\n");
    printf("%7s", "row");
    for (int a = 0; a < r->dim; a++) printf(" %13c", "xyz"[a]);
    printf(" %6s %10s", "neighb", "condition");
    for (size_t k = 0; k < pc->fields; k++)
        for (int a = 0; a < r->dim; a++) {
            char name[24];
            snprintf(name, sizeof name, "d%.9s/d%c", pc->name[k], "xyz"[a]);
            printf(" %16s", name);
        }
    printf("\n");
    for (size_t i = 0; i < n && i < ROWS_SHOWN; i++) print_row(r, pc, answer, i);
    if (n > ROWS_SHOWN) printf("    ... %zu more; all of them with --json FILE\n", n - ROWS_SHOWN);
    printf("\n");
    print_flagged(r, pc, answer);
}

static void print_judgement(const struct point_cloud *pc, const struct judgement *j)
{
    printf("\ngiven gradient of %s: %s: %zu of %zu points depart by more than their bound\n",
           pc->name[j->field], j->failed ? "FAIL" : "pass", j->failed, j->judged);
    if (j->judged)
        printf("worst: row %zu, |given - ours| = %.3g max(|ours|, 1e-4 max|f|/h), bound %.3g\n",
               j->worst + 1, j->departure, j->bound);
}

/* null where there is no gradient */
static json_t *vector(int dim, double *const *values, size_t i)
{
    json_t *array = json_array();
    for (int a = 0; a < dim; a++) json_array_append_new(array, result_number_or_null(values[a][i]));
    return array;
}

static json_t *points_json(const struct request *r, const struct point_cloud *pc,
                           const struct answer *answer)
{
    json_t *points = json_array();
    for (size_t i = 0; i < pc->cloud.points.n; i++) {
        const struct operator_point *point = &answer->point[i];
        json_t *gradients = json_object();
        for (size_t k = 0; k < pc->fields; k++)
            json_object_set_new(gradients, pc->name[k],
                                vector(r->dim, answer->gradient + k * (size_t)r->dim, i));
        json_array_append_new(
            points, result_object("x=%p h=%g gradients=%p neighbours=%d condition=%g state=%s",
                                  (void *)vector(r->dim, (double *const *)pc->csv.values, i),
                                  pc->h[i], (void *)gradients, (int)point->neighbours,
                                  point->condition, operator_state_name(point->state)));
    }
    return points;
}

static json_t *box_json(const struct request *r)
{
    json_t *box = json_array();
    for (int a = 0; a < r->dim; a++)
        json_array_append_new(
            box, json_pack("[o, o]", result_number(r->lo[a]), result_number(r->hi[a])));
    return box;
}

static enum status write_answer(const struct options *options, const struct request *r,
                                const struct point_cloud *pc, const struct answer *answer,
                                const struct judgements *all, struct error *error)
{
    json_t *content =
        result_object("operator=%s kernel=%s dim=%d points=%p", r->settings.form->member.name,
                      r->kernel.member.name, r->dim, (void *)points_json(r, pc, answer));
    json_t *judgements = json_array();
    for (size_t c = 0; c < all->count; c++) {
        const struct judgement *j = &all->of[c];
        json_array_append_new(
            judgements,
            result_object(
                "column=%s status=%s judged=%d failed=%d worst_row=%d departure=%g bound=%g",
                pc->name[j->field], j->failed ? "fail" : "pass", (int)j->judged, (int)j->failed,
                (int)j->worst + 1, j->departure, j->bound));
    }
    if (all->count) json_object_set(content, "judgements", judgements);
    json_decref(judgements);
    if (r->boxed) json_object_set_new(content, "box", box_json(r));
    return options_write_members(options, content, error);
}

/* ---- the command ---- */

static enum status run(const struct options *options, int n, char **arguments, struct error *error)
{
    struct request request = {0};
    struct point_cloud pc = {0};
    struct answer answer = {0};
    struct judgements judgements = {0};
    bool failed = false;
    enum status status = take_request(options, n, arguments, &request, error);
    if (!status)
        status = point_cloud_read(request.path, request.dim, request.eta, request.h, &pc, error);
    if (!status) status = take_checks(&request, &pc, &judgements, error);
    if (!status) status = place_in_box(&request, &pc, error);
    if (!status) status = compute(&request, &pc, &answer, error);
    if (!status) {
        for (size_t c = 0; c < judgements.count; c++) {
            judge(&request, &pc, &answer, &judgements.of[c]);
            failed = failed || judgements.of[c].failed;
        }
        if (options->speak) print_answer(&request, &pc, &answer);
        for (size_t c = 0; options->speak && c < judgements.count; c++)
            print_judgement(&pc, &judgements.of[c]);
        if (options->json)
            status = write_answer(options, &request, &pc, &answer, &judgements, error);
        if (!status && failed) status = STATUS_CHECK_FAILED;
    }
    free(answer.memory), free(answer.point);
    point_cloud_free(&pc);
    return status;
}

static const struct command_option own_options[] = {
    {"operator", "OP",
     "standard, standard_difference, ia, corrected, linear_exact or normalised_corrected"},
    {"kernel", "K", "kernel; see `sphproof list kernels`"},
    {"dim", "D", "1, 2 or 3"},
    {"eta", "E", "support radius h = eta volume^(1/dim) at each point"},
    {"h", "H", "the same support radius h for all points"},
    {"box", "LO:HI[,LO:HI ...]",
     "the cloud is periodic, with this box in all directions or in each"},
    {"check", "COLUMN=dx[,dy,dz] ...",
     "compare these columns with the gradient of COLUMN; may be repeated"},
    {"tolerance", "T",
     "tolerance of --check, relative to max(|gradient|, 1e-4 max|f|/h) (default 1e-9)"},
    {NULL, NULL, NULL},
};

const struct command command_gradient = {
    .name = "gradient",
    .synopsis = "CLOUD.csv --operator OP --kernel K --dim D (--eta E | --h H)",
    .help = "gradients of the columns of a point cloud\n"
            "The file holds columns x[,y,z],volume, then one column a field, and optionally h\n"
            "(support radius), which wins over --eta and --h; separated by commas or blanks, "
            "Fortran's\n"
            "1.0D0 is a number. Points with too few neighbours or an\n"
            "ill-conditioned matrix are named; where no inverse exists the gradient is nan (JSON:\n"
            "null). With --check the exit status is 1 if a given gradient departs from ours.",
    .run = run,
    .options = own_options,
    .examples =
        "sphproof gradient cloud.csv --operator linear_exact --kernel wendland_c2 --dim 2 --eta 3\n"
        "sphproof gradient cloud.csv --operator ia --kernel cubic_spline --dim 1 --h 0.1 --json -\n"
        "sphproof gradient cloud.csv --operator standard --kernel cubic_spline --dim 2 --eta 2.4 "
        "--check f=fx,fy\n"
        "sphproof gradient cloud.csv --operator ia --kernel cubic_spline --dim 2 --eta 2.4 --box "
        "0:1,0:2 "
        "--check f=fx,fy --check g=gx,gy",
};
