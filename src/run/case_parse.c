/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cases.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ini_text.h"
#include "list.h"
#include "user_solution.h"
#include "problem.h"
#include "problem_list.h"
#include "problem_prepare.h"
#include "text.h"
#include "trace.h"

/* Keys of a case file that are not in setting_keys: SECTION, KEY. */
#define EXTRA_LIST(EXTRA)                                                                          \
    EXTRA(case, title)                                                                             \
    EXTRA(case, dimension)                                                                         \
    EXTRA(case, reference)                                                                         \
    EXTRA(measure, fields)                                                                         \
    EXTRA(measure, exact)                                                                          \
    EXTRA(converge, n)                                                                             \
    EXTRA(report, bench)                                                                           \
    EXTRA(report, quick)                                                                           \
    EXTRA(report, night)
#define EXTRA_SYMBOL(section, name) EXTRA_##name,
#define EXTRA_ENTRY(section, name)  {#section, #name},
enum extra { EXTRA_LIST(EXTRA_SYMBOL) EXTRAS };
static const struct {
    const char *section, *name;
} extras[EXTRAS] = {EXTRA_LIST(EXTRA_ENTRY)};
static const char *const sections[] = {"case",    "domain",   "initial",  "scheme", "run",
                                       "measure", "converge", "compared", "finer",  "report"};

struct parser {
    struct case_file *file;
    struct ini_text at;
    char where[256]; /* path and line of the present pair */
    char reference[64];
    /* line of the first occurrence */
    int seen_settings[SETTINGS], seen_extras[EXTRAS], seen_gates[CASE_GATES_MAX],
        seen_compared[CASE_GATES_MAX], seen_finer[CASE_GATES_MAX];
};

static void set_fields(struct parser *parser, const char *name, const char *value, bool *fields)
{
    char copy[INI_TEXT_LINE + 1], *rest = NULL;
    snprintf(copy, sizeof copy, "%s", value);
    memset(fields, 0, FIELDS * sizeof *fields);
    if (!value[strspn(value, " \t,")])
        ini_text_fail_value(&parser->at, name, value, "names of fields");
    for (char *word = strtok_r(copy, " \t,", &rest); word; word = strtok_r(NULL, " \t,", &rest)) {
        const int field = family_index(&field_family, word);
        if (field < 0) {
            text_unknown_member(parser->at.error, parser->where, "field", word, &field_family);
            parser->at.failed = true;
            return;
        }
        fields[field] = true;
    }
}

/* Increasing numbers of particles; order: enough for a fit of the order. */
static void set_ladder(struct parser *parser, const char *name, const char *value, bool order,
                       size_t *ladder, size_t *count)
{
    char copy[INI_TEXT_LINE + 1], *rest = NULL;
    const struct setting_key *key = &setting_keys[SETTING_n];
    const char *allowed =
        order ? "rising numbers of particles, at least four" : "rising numbers of particles";
    snprintf(copy, sizeof copy, "%s", value);
    for (char *word = strtok_r(copy, " \t,", &rest); word; word = strtok_r(NULL, " \t,", &rest)) {
        double n;
        int exponent;
        if (!text_count(word, &n, &exponent) || n < key->lo || n > key->hi ||
            *count == CASE_LADDER_MAX || (*count && n <= (double)ladder[*count - 1])) {
            ini_text_fail_value(&parser->at, name, value, allowed);
            return;
        }
        ladder[(*count)++] = (size_t)n;
    }
    if (*count < (order ? ORDER_LEVELS_MIN : 1))
        ini_text_fail_value(&parser->at, name, value, allowed);
}

static void set_flag(struct parser *parser, const char *name, const char *value, bool *flag)
{
    *flag = strcmp(value, "yes") == 0;
    if (!*flag && strcmp(value, "no") != 0) ini_text_fail_value(&parser->at, name, value, "yes no");
}

static void set_reference(struct parser *parser, const char *value)
{
    struct error reason;
    if (user_solution_is_named(value)) {
        snprintf(parser->reference, sizeof parser->reference, "%s", "");
        if (user_solution_load(value, parser->at.path, &parser->file->settings.reference, &reason))
            ini_text_fail(&parser->at, reason.message, "");
        return;
    }
    const char **names = NULL;
    size_t n = 0;
    bool known = false;
    for (size_t i = 0; i < problem_family.n && !known; i++) {
        const char *name = ((const struct problem *)problem_family.members[i])->reference;
        known = strcmp(name, value) == 0;
        if (list_grow(&names, n, sizeof *names)) names[n++] = name;
    }
    if (known) {
        snprintf(parser->reference, sizeof parser->reference, "%s", value);
    } else {
        text_unknown(parser->at.error, parser->where, "reference", value, names, n);
        parser->at.failed = true;
    }
    free(names);
}

static void set_extra(struct parser *parser, enum extra extra, const char *value)
{
    struct case_file *file = parser->file;
    if (!ini_text_first(&parser->at, &parser->seen_extras[extra], extras[extra].name)) return;
    switch (extra) {
    case EXTRA_title:
        if (!*value) ini_text_fail_value(&parser->at, "title", value, "a text");
        snprintf(file->title, sizeof file->title, "%s", value);
        return;
    case EXTRA_dimension:
        if (!(*value >= '1' && *value <= '3') || value[1])
            ini_text_fail_value(&parser->at, "dimension", value, "1 2 3");
        file->dimension = file->settings.dim = *value - '0';
        return;
    case EXTRA_reference:
        set_reference(parser, value);
        return;
    case EXTRA_fields:
        set_fields(parser, "fields", value, parser->file->fields);
        return;
    case EXTRA_exact:
        set_fields(parser, "exact", value, parser->file->exact);
        return;
    case EXTRA_n:
        set_ladder(parser, "n", value, true, file->ladder, &file->ladder_count);
        return;
    case EXTRA_quick:
        set_ladder(parser, "quick", value, false, file->quick, &file->quick_count);
        return;
    case EXTRA_night:
        set_ladder(parser, "night", value, false, file->night, &file->night_count);
        return;
    case EXTRA_bench:
        set_flag(parser, "bench", value, &file->bench);
        return;
    default:
        return;
    }
}

/* Finds what a gate of this name bounds: a field's norm such as "density_l1", a functional, or a
 * conservation figure. */
static bool find_subject(const char *name, struct case_gate *gate)
{
    const size_t figure = trace_figure(name);
    *gate =
        (struct case_gate){.functional = figure < TRACE_FIGURES ? trace_figures[figure]
                                                                : problem_functional_name(name)};
    for (int k = 0; k < FIELDS * NORMS && !gate->functional; k++) {
        char text[64];
        gate->field = (enum field)(k / NORMS), gate->norm = (enum norm)(k % NORMS);
        snprintf(text, sizeof text, "%s_%s", field_family.members[gate->field]->name,
                 field_norm_family.members[gate->norm]->name);
        if (strcmp(text, name) == 0) return true;
    }
    return gate->functional != NULL;
}

#define ORDER_GATE    "least order, greatest order, bound; or "
#define ERROR_GATE    "order for shorter ladders, bound of the finest error"
#define TWO_SIDES     " or LEAST:BOUND"
#define KNOWN_FAILURE "; `known: WHY` after them, if it is known to fail"

/* Splits a gate's value into the text before `known: WHY`, without trailing blanks, and WHY, "" if
 * there is none. False: the reason is missing or too long. */
static bool read_known(const char *value, char text[256], const char **why)
{
    static const char mark[] = "known:";
    const char *known = strstr(value, mark);
    *why = known ? known + strlen(mark) : "";
    snprintf(text, 256, "%.*s", known ? (int)(known - value) : -1, value);
    for (size_t n = strlen(text); n && text[n - 1] == ' '; n--) text[n - 1] = '\0';
    while (**why == ' ') ++*why;
    return !(known && !**why) && strlen(*why) < sizeof((struct case_weakness *)NULL)->why;
}

/* Reads the numbers of a gate's value, of which the last may be LEAST:BOUND (least 0: no lower
 * bound), and the reason of a known failure. False: invalid value. */
static bool read_gate(const char *value, size_t count, double *numbers, double *least,
                      const char **why)
{
    char text[256];
    *least = 0;
    if (!read_known(value, text, why)) return false;
    char *colon = strchr(text, ':'), *from = colon;
    if (colon) {
        while (from > text && !strchr(" \t,", from[-1])) from--;
        *colon = '\0';
        if (!text_real(from, least) || !(*least > 0) || strpbrk(colon + 1, " \t,")) return false;
        memmove(from, colon + 1, strlen(colon + 1) + 1);
    }
    return text_reals(text, " \t,", count, numbers) && numbers[count - 1] > *least;
}

/* Index of the gate with the subject of `of`; gate_count: none. */
static size_t find_gate(const struct case_file *file, const struct case_gate *of)
{
    size_t i = 0;
    while (i < file->gate_count &&
           (file->gates[i].functional != of->functional || file->gates[i].field != of->field ||
            file->gates[i].norm != of->norm))
        i++;
    return i;
}

static void add_gate(struct parser *parser, const char *name, struct case_gate gate,
                     const char *why)
{
    struct case_file *file = parser->file;
    const size_t there = find_gate(file, &gate);
    if (there < file->gate_count) {
        ini_text_first(&parser->at, &parser->seen_gates[there], name);
        return;
    }
    if (file->gate_count == CASE_GATES_MAX) {
        ini_text_fail(&parser->at, "too many gates", "");
        return;
    }
    parser->seen_gates[file->gate_count] = parser->at.line;
    gate.known.bound = INFINITY;
    snprintf(gate.known.why, sizeof gate.known.why, "%s", why);
    file->gates[file->gate_count++] = gate;
}

/* Reads `none known: WHY`: a scheme fails so that the error cannot be measured, for example because
 * there is no shock. */
static bool read_absence(const char *value, double *bound, const char **why)
{
    char text[256];
    *bound = (double)NAN;
    return read_known(value, text, why) && **why && strcmp(text, "none") == 0;
}

/* Sets the bound of the compared schemes: `BOUND` or `BOUND known: WHY`. */
static void set_compared(struct parser *parser, struct case_gate *gate, const char *name,
                         const char *value)
{
    struct case_weakness *compared = &gate->compared;
    const char *why;
    double least = 0;
    if (!read_absence(value, &compared->bound, &why) &&
        (!read_gate(value, 1, &compared->bound, &least, &why) || least > 0))
        ini_text_fail_value(&parser->at, name, value,
                            "bound of the finest error, or none where there is nothing to be "
                            "measured" KNOWN_FAILURE);
    else
        snprintf(compared->why, sizeof compared->why, "%s", why);
}

/* Sets the gate beyond the case's own ladder: a range of orders and a bound, or a bound alone, like
 * the gate itself. */
static void set_finer(struct parser *parser, struct case_gate *gate, const char *name,
                      const char *value)
{
    const bool ordered = isfinite(gate->gate.high);
    const char *why;
    double numbers[3] = {gate->gate.low, gate->gate.high}, least;
    if (!read_gate(value, ordered ? 3 : 1, ordered ? numbers : numbers + 2, &least, &why) ||
        least > 0 || *why || !(numbers[0] < numbers[1]))
        ini_text_fail_value(&parser->at, name, value,
                            ordered ? "least order, greatest order, bound beyond the case's ladder"
                                    : "bound of the error beyond the case's ladder");
    else
        gate->finer = (struct order_gate){numbers[0], numbers[1], numbers[2]};
}

/* Applies a key of [compared] or [finer] to the gate of the same name in [converge]. */
static void amend_gate(struct parser *parser, const char *section, const struct case_gate *of,
                       const char *name, const char *value)
{
    struct case_file *file = parser->file;
    const size_t i = find_gate(file, of);
    const bool finer = strcmp(section, "finer") == 0;
    char what[120];
    if (i == file->gate_count) {
        snprintf(what, sizeof what, "key %.40s in [%.10s] has no gate above, in [converge]", name,
                 section);
        ini_text_fail(&parser->at, what, "");
    } else if (ini_text_first(&parser->at, &(finer ? parser->seen_finer : parser->seen_compared)[i],
                              name)) {
        (finer ? set_finer : set_compared)(parser, &file->gates[i], name, value);
    }
}

/* Adds a gate whose subject is set. */
static void set_gate(struct parser *parser, struct case_gate gate, const char *name,
                     const char *value)
{
    double numbers[3];
    const char *why;
    if (!gate.functional && read_gate(value, 3, numbers, &gate.least, &why) &&
        numbers[0] < numbers[1])
        gate.gate = (struct order_gate){numbers[0], numbers[1], numbers[2]};
    else if (read_gate(value, 2, numbers, &gate.least, &why) && numbers[0] >= 0)
        gate.gate = (struct order_gate){numbers[0], INFINITY, numbers[1]};
    else {
        ini_text_fail_value(&parser->at, name, value,
                            gate.functional ? ERROR_GATE TWO_SIDES KNOWN_FAILURE
                                            : ORDER_GATE ERROR_GATE TWO_SIDES KNOWN_FAILURE);
        return;
    }
    add_gate(parser, name, gate, why);
}

/* Reports a key that is not allowed in its section: names its section, or the nearest known key. */
static void unknown(struct parser *parser, const char *section, const char *name)
{
    char what[120];
    const char *names[SETTINGS + EXTRAS];
    size_t n = 0;
    parser->at.failed = true;
    bool section_exists = false;
    for (size_t i = 0; i < sizeof sections / sizeof *sections; i++)
        section_exists |= strcmp(sections[i], section) == 0;
    if (!*section) {
        ini_text_fail(&parser->at, "a key before the first section",
                      "[case] and the other sections");
        return;
    }
    if (!section_exists) {
        text_unknown(parser->at.error, parser->where, "section", section, sections,
                     sizeof sections / sizeof *sections);
        return;
    }
    const int elsewhere = setting_find(name);
    if (elsewhere >= 0) {
        snprintf(what, sizeof what, "key %.40s stands in the section [%s], not in [%s]", name,
                 setting_keys[elsewhere].section, section);
        ini_text_fail(&parser->at, what, "");
        return;
    }
    for (int i = 0; i < SETTINGS; i++)
        if (strcmp(setting_keys[i].section, section) == 0) names[n++] = setting_keys[i].name;
    for (int i = 0; i < EXTRAS; i++)
        if (strcmp(extras[i].section, section) == 0) names[n++] = extras[i].name;
    if (strcmp(section, "converge") == 0 || strcmp(section, "compared") == 0 ||
        strcmp(section, "finer") == 0) {
        names[n++] = "density_l1";
        for (int k = 0; k < TRACE_FIGURES; k++) names[n++] = trace_figures[k];
    }
    snprintf(what, sizeof what, "key in [%.20s]", section);
    text_unknown(parser->at.error, parser->where, what, name, names, n);
}

/* Resolves a path relative to the case file. */
static const char *beside_case(const struct parser *parser, const char *value,
                               char path[2 * SETTING_TEXT_MAX])
{
    const char *slash = strrchr(parser->at.path, '/');
    if (!slash || *value == '/' || !*value) return value;
    snprintf(path, 2 * SETTING_TEXT_MAX, "%.*s%s", (int)(slash + 1 - parser->at.path),
             parser->at.path, value);
    return path;
}

static int take_pair(void *context, const char *section, const char *name, const char *value)
{
    struct parser *parser = context;
    struct case_gate gate;
    snprintf(parser->where, sizeof parser->where, "%.200s:%d", parser->at.path, parser->at.line);
    for (int i = 0; i < EXTRAS; i++)
        if (strcmp(extras[i].section, section) == 0 && strcmp(extras[i].name, name) == 0) {
            set_extra(parser, (enum extra)i, value);
            return 1;
        }
    const int key = setting_find(name);
    if (key >= 0 && strcmp(setting_keys[key].section, section) == 0) {
        char path[2 * SETTING_TEXT_MAX];
        if (setting_keys[key].type == SETTING_PATH) value = beside_case(parser, value, path);
        if (ini_text_first(&parser->at, &parser->seen_settings[key], name) &&
            settings_set(&parser->file->settings, (enum setting)key, value, SOURCE_CASE,
                         parser->where, parser->at.error))
            parser->at.failed = true;
    } else if (strcmp(section, "converge") == 0 && find_subject(name, &gate)) {
        set_gate(parser, gate, name, value);
    } else if ((strcmp(section, "compared") == 0 || strcmp(section, "finer") == 0) &&
               find_subject(name, &gate)) {
        amend_gate(parser, section, &gate, name, value);
    } else {
        unknown(parser, section, name);
    }
    return 1;
}

static enum status missing(struct parser *parser, const char *section, const char *name)
{
    return error_set(parser->at.error, STATUS_BAD_INPUT, "%.200s: key %s is missing in [%s]",
                     parser->at.path, name, section);
}

static enum status missing_key(struct parser *parser, enum setting key)
{
    return missing(parser, setting_keys[key].section, setting_keys[key].name);
}

/* Checks that all required keys are given, for every case and for the problem, and that no key
 * belongs to another problem only. */
static enum status check_keys(struct parser *parser)
{
    static const enum setting always[] = {SETTING_kind, SETTING_t_end};
    const struct settings *settings = &parser->file->settings;
    const struct problem *problem = problem_of(settings);
    for (int i = 0; i < EXTRA_fields; i++)
        if (!parser->seen_extras[i]) return missing(parser, extras[i].section, extras[i].name);
    for (size_t i = 0; i < sizeof always / sizeof *always; i++)
        if (!parser->seen_settings[always[i]]) return missing_key(parser, always[i]);
    for (size_t i = 0; i < problem->key_count; i++)
        if (problem->keys[i].role == ROLE_NEEDED && !parser->seen_settings[problem->keys[i].key])
            return missing_key(parser, problem->keys[i].key);
    for (int i = 0; i < SETTINGS; i++)
        if (parser->seen_settings[i] && problem_foreign(settings, (enum setting)i)) {
            char what[120];
            snprintf(what, sizeof what, "key %s and kind = %s exclude each other",
                     setting_keys[i].name, problem->member.name);
            parser->at.line = parser->seen_settings[i];
            return ini_text_fail(&parser->at, what, "");
        }
    return STATUS_OK;
}

/* Particles of a file may be judged by the solution of another problem. The case then has that
 * problem, with other particles. */
static void find_judge(struct parser *parser)
{
    struct settings *settings = &parser->file->settings;
    if (!problem_of(settings)->filed) return;
    for (size_t i = 0; i < problem_family.n; i++) {
        const struct problem *problem = (const struct problem *)problem_family.members[i];
        if (strcmp(problem->reference, parser->reference) != 0) continue;
        settings->value[SETTING_kind].choice = (int)i;
        return;
    }
}

/* Checks that a run of the case has each figure with a gate: functionals of its problem, in 2D or
 * 3D, since no order is determined for functionals in 1D; angular momentum in 2D or 3D; changes of
 * the kinetic energy in steady flows. All other conservation figures exist for every run. */
static enum status check_gates(struct parser *parser)
{
    const struct case_file *file = parser->file;
    const struct problem *problem = problem_of(&file->settings);
    for (size_t i = 0; i < file->gate_count; i++) {
        const char *figure = file->gates[i].functional;
        if (!figure) continue;
        const bool kept = trace_figure(figure) < TRACE_FIGURES;
        const bool has = kept ? problem->steady || strncmp(figure, "ke_", 3) != 0
                              : problem_functional(problem, figure) != NULL;
        const bool flat =
            file->dimension == 1 && (!kept || strcmp(figure, "angular_momentum") == 0);
        char what[120];
        parser->at.line = parser->seen_gates[i];
        if (!has)
            snprintf(what, sizeof what, "key %.40s and kind = %.40s exclude each other", figure,
                     problem->member.name);
        else if (flat)
            snprintf(what, sizeof what,
                     "key %.40s in [converge] and dimension = 1 exclude each other", figure);
        if (!has || flat) return ini_text_fail(&parser->at, what, "");
    }
    return STATUS_OK;
}

static enum status check_complete(struct parser *parser)
{
    if (!parser->file->settings.reference) find_judge(parser);
    if (check_keys(parser) || check_gates(parser)) return parser->at.error->status;
    const char *reference = problem_of(&parser->file->settings)->reference;
    if (parser->file->settings.reference || strcmp(parser->reference, reference) == 0)
        return STATUS_OK;
    parser->at.line = parser->seen_extras[EXTRA_reference];
    return ini_text_fail_value(&parser->at, "reference", parser->reference, reference);
}

/* Checks that the fields asked for have exact values; the default is all fields that have them. */
static enum status check_fields(struct parser *parser, const struct problem *problem)
{
    struct case_file *file = parser->file;
    for (int f = 0; f < FIELDS; f++) {
        char what[120];
        if (!file->fields[f] || !problem->unknown[f]) continue;
        file->fields[f] = false;
        if (!parser->seen_extras[EXTRA_fields]) continue;
        parser->at.line = parser->seen_extras[EXTRA_fields];
        snprintf(what, sizeof what, "fields: the reference says nothing of %s",
                 field_family.members[f]->name);
        return ini_text_fail(&parser->at, what, "");
    }
    return STATUS_OK;
}

/* Adds the path, and the line of the key: a reason begins with KEY or "key KEY". */
static enum status refuse(const struct parser *parser, const struct error *reason)
{
    const char *word = reason->message;
    char name[32], line[16] = "";
    if (strncmp(word, "key ", 4) == 0) word += 4;
    snprintf(name, sizeof name, "%.*s", (int)strcspn(word, " =:,"), word);
    const int key = setting_find(name);
    if (key >= 0 && parser->seen_settings[key])
        snprintf(line, sizeof line, ":%d", parser->seen_settings[key]);
    return error_set(parser->at.error, reason->status, "%.160s%s: %.330s", parser->at.path, line,
                     reason->message);
}

enum status case_parse(struct case_file *file, const char *path, const char *text, size_t length,
                       struct error *error)
{
    struct parser parser = {
        .file = file,
        .at = {
            .path = path, .kind = "case file", .rest = text, .end = text + length, .error = error}};
    const char *slash = strrchr(path, '/'), *base = slash ? slash + 1 : path;
    const char *dot = strrchr(base, '.');
    *file = (struct case_file){.fields = {true, true, true, true}, .bench = true};
    snprintf(file->name, sizeof file->name, "%.*s", dot ? (int)(dot - base) : (int)strlen(base),
             base);
    status_clean(file->name);
    settings_init(&file->settings);
    if (ini_text_read(&parser.at, take_pair, &parser) || check_complete(&parser))
        return error->status;
    struct settings trial = file->settings;
    for (int key = 0; key < SETTINGS; key++) /* checked like a user's keys */
        if (parser.seen_settings[key]) trial.value[key].source = SOURCE_USER;
    /* `judge` accepts tubes with non-periodic ends, which a run refuses */
    if (file->dimension == 1 && problem_reads(problem_of(&trial), SETTING_left))
        trial.value[SETTING_boundary].automatic = true;
    struct prepared problem;
    struct scheme scheme;
    struct error reason;
    if (problem_prepare(&problem, &trial, file->dimension, &reason) ||
        settings_scheme(&trial, file->dimension, &scheme, &reason))
        return refuse(&parser, &reason);
    return check_fields(&parser, problem.problem);
}

bool case_amend(struct case_file *file, struct ini_text *at, const char *name, const char *value)
{
    struct parser parser = {.file = file, .at = *at};
    struct case_gate gate;
    const bool ladder = strcmp(name, extras[EXTRA_n].name) == 0;
    if (!ladder && !find_subject(name, &gate)) return false;
    if (ladder) {
        file->ladder_count = 0;
        set_extra(&parser, EXTRA_n, value);
    } else {
        set_gate(&parser, gate, name, value);
        for (size_t i = 0; i < file->gate_count; i++) parser.seen_gates[i] = at->line;
        if (!parser.at.failed) check_gates(&parser);
    }
    at->failed = parser.at.failed;
    return true;
}
