/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "code_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "code_check.h"
#include "gates.h"
#include "list.h"
#include "text.h"
#include "trace.h"

/* ---- reading ---- */

struct parser {
    struct code *code;
    struct ini_text at;
    json_t *seen;           /* "SECTION/KEY": line */
    struct code_way *way;   /* of the current section; NULL: before the first */
    struct code_case *of;   /* of [case NAME]; NULL: another section */
    struct case_file given; /* the case without the code's own keys */
    bool gates, ladder;     /* [case NAME] sets its own */
};

static enum status unknown_section(struct parser *parser, const char *section)
{
    static const char *const names[] = {"code", "case NAME", "fault NAME"};
    char where[CODE_PATH];
    snprintf(where, sizeof where, "%.200s:%d", parser->at.path, parser->at.line);
    parser->at.failed = true;
    return text_unknown(parser->at.error, where, "section", section, names, 3);
}

/* Adjusts the case's gates to the end of the code's own ladder. */
static void end_case(struct parser *parser)
{
    struct code_case *of = parser->of;
    parser->of = NULL;
    if (!of || parser->gates) return;
    for (size_t g = 0; g < of->file.gate_count; g++) {
        of->file.gates[g].least = 0; /* the least error is that of our scheme */
        if (parser->ladder)
            of->file.gates[g].gate = gates_at(&parser->given, &parser->given.gates[g],
                                              of->file.ladder[of->file.ladder_count - 1]);
    }
}

static void begin_case(struct parser *parser, const char *name)
{
    struct code *code = parser->code;
    struct error reason;
    char path[CODE_PATH], what[120];
    const bool is_path = strchr(name, '/') || strstr(name, ".ini");
    for (size_t c = 0; c < code->case_count; c++)
        if (strcmp(code->cases[c].file.asked, name) == 0) {
            snprintf(what, sizeof what, "[case %.80s] is given twice", name);
            ini_text_fail(&parser->at, what, "");
            return;
        }
    if (is_path && !code_beside(code, name, strlen(name), path)) path[0] = '\0';
    if (case_load(&parser->given, is_path ? path : name, &reason)) {
        parser->at.failed = true;
        error_set(parser->at.error, reason.status, "%.200s:%d: %.280s", parser->at.path,
                  parser->at.line, reason.message);
        return;
    }
    if (!list_grow(&code->cases, code->case_count, sizeof *code->cases)) {
        parser->at.failed = true;
        error_set(parser->at.error, STATUS_ENVIRONMENT, "no memory for %.200s", parser->at.path);
        return;
    }
    parser->of = &code->cases[code->case_count++];
    *parser->of = (struct code_case){.file = parser->given};
    snprintf(parser->of->file.asked, sizeof parser->of->file.asked, "%s", name);
    parser->way = &parser->of->way;
    parser->gates = parser->ladder = false;
}

static void begin_fault(struct parser *parser, const char *name)
{
    struct code *code = parser->code;
    char what[120];
    snprintf(what, sizeof what, "[fault %.60s]", name);
    if (code->fault_count == CODE_FAULTS_MAX) {
        ini_text_fail(&parser->at, what, "16 faults");
        return;
    }
    struct code_fault *fault = &code->faults[code->fault_count++];
    snprintf(fault->name, sizeof fault->name, "%s", name);
    parser->way = &fault->way;
}

const char *code_section_name(const char *section, const char *kind)
{
    const size_t length = strlen(kind);
    const bool is = strncmp(section, kind, length) == 0 && section[length] == ' ';
    return is && section[length + 1] ? section + length + 1 : NULL;
}

/* inih knows names of up to 49 characters. */
static void begin_section(struct parser *parser, const char *section)
{
    const char *of_case = code_section_name(section, "case"),
               *of_fault = code_section_name(section, "fault");
    end_case(parser);
    if (strlen(section) > 48)
        ini_text_fail(&parser->at, "a section's name is too long", "48 characters");
    else if (strcmp(section, "code") == 0)
        parser->way = &parser->code->way;
    else if (of_case)
        begin_case(parser, of_case);
    else if (of_fault)
        begin_fault(parser, of_fault);
    else
        unknown_section(parser, section);
}

/* The first gate of the code's own replaces those of the case. */
static bool take_own(struct parser *parser, const char *name, const char *value)
{
    struct case_file *file = &parser->of->file;
    struct case_file kept = *file;
    const bool ladder = strcmp(name, "n") == 0;
    if (!ladder && !parser->gates) file->gate_count = 0;
    if (!case_amend(file, &parser->at, name, value)) {
        *file = kept;
        return false;
    }
    parser->ladder = parser->ladder || ladder;
    parser->gates = parser->gates || !ladder;
    return true;
}

static void unknown_key(struct parser *parser, const char *section, const char *name)
{
    const char *names[CODE_KEYS + 2 + TRACE_FIGURES];
    char where[CODE_PATH], what[120];
    size_t n = 0;
    for (int key = parser->way != &parser->code->way; key < CODE_KEYS; key++)
        names[n++] = code_keys[key].name;
    if (parser->of) names[n++] = "n", names[n++] = "density_l1";
    for (int k = 0; parser->of && k < TRACE_FIGURES; k++) names[n++] = trace_figures[k];
    snprintf(where, sizeof where, "%.200s:%d", parser->at.path, parser->at.line);
    snprintf(what, sizeof what, "key in [%.60s]", section);
    parser->at.failed = true;
    text_unknown(parser->at.error, where, what, name, names, n);
}

/* True if the section has not set this key before; else fails. */
static bool first(struct parser *parser, const char *section, const char *name)
{
    char path[2 * INI_TEXT_LINE];
    snprintf(path, sizeof path, "%s/%s", section, name);
    int line = (int)json_integer_value(json_object_get(parser->seen, path));
    json_object_set_new(parser->seen, path, json_integer(parser->at.line));
    return ini_text_first(&parser->at, &line, name);
}

static int take_pair(void *context, const char *section, const char *name, const char *value)
{
    struct parser *parser = context;
    if (!name) {
        begin_section(parser, section);
        return 1;
    }
    if (!parser->way) {
        ini_text_fail(&parser->at, "a key before the first section",
                      "[code], [case NAME] and [fault NAME]");
        return 1;
    }
    int key = parser->way != &parser->code->way; /* the title is the code's */
    while (key < CODE_KEYS && strcmp(code_keys[key].name, name) != 0) key++;
    if (!first(parser, section, name)) return 1;
    if (key < CODE_KEYS) {
        snprintf(parser->way->value[key], sizeof parser->way->value[key], "%s", value);
        parser->way->line[key] = parser->at.line;
        code_check_value(parser->code, &parser->at, (enum code_key)key, value);
    } else if (!parser->of || !take_own(parser, name, value)) {
        unknown_key(parser, section, name);
    }
    return 1;
}

/* Fills unset keys of a section from [code]. */
static void complete(struct code_way *way, const struct code_way *from)
{
    for (int key = 0; key < CODE_KEYS; key++)
        if (!way->line[key]) {
            way->line[key] = from->line[key];
            memcpy(way->value[key], from->value[key], sizeof way->value[key]);
        }
}

/* Refuses a fault that changes nothing. */
static enum status check_fault(struct parser *parser, const struct code_fault *fault)
{
    bool says = false;
    for (int key = 0; key < CODE_KEYS; key++) says |= fault->way.line[key] > 0;
    if (!says)
        return error_set(parser->at.error, STATUS_BAD_INPUT,
                         "%.200s: [fault %.60s] has no key; allowed: those of [code] that differ, "
                         "such as command",
                         parser->at.path, fault->name);
    return STATUS_OK;
}

static enum status finish(struct parser *parser)
{
    static const enum code_key needed[] = {CODE_command, CODE_snapshot};
    struct code *code = parser->code;
    end_case(parser);
    if (!code->case_count)
        return error_set(parser->at.error, STATUS_BAD_INPUT,
                         "%.200s: no [case NAME]; allowed: a section for each case that the code "
                         "can run",
                         parser->at.path);
    for (size_t c = 0; c < code->case_count; c++) {
        struct code_way *way = &code->cases[c].way;
        complete(way, &code->way);
        for (size_t k = 0; k < sizeof needed / sizeof *needed; k++)
            if (!way->line[needed[k]])
                return error_set(parser->at.error, STATUS_BAD_INPUT,
                                 "%.200s: key %s is missing in [code] or [case %.60s]",
                                 parser->at.path, code_keys[needed[k]].name,
                                 code->cases[c].file.asked);
    }
    for (size_t f = 0; f < code->fault_count; f++)
        if (check_fault(parser, &code->faults[f])) return parser->at.error->status;
    return STATUS_OK;
}

/* Without a title, takes the file's name. */
static void take_title(struct code *code)
{
    const char *slash = strrchr(code->path, '/'), *base = slash ? slash + 1 : code->path;
    if (code->way.line[CODE_title]) return;
    code->way.line[CODE_title] = 1;
    snprintf(code->way.value[CODE_title], sizeof code->way.value[CODE_title], "%.*s",
             (int)strcspn(base, "."), base);
}

static enum status take_folder(struct code *code, struct error *error)
{
    char *real = realpath(code->path, NULL);
    const size_t length = real ? strlen(real) : CODE_PATH;
    if (real) *strrchr(real, '/') = '\0';
    if (length < CODE_PATH) snprintf(code->folder, sizeof code->folder, "%s", real);
    free(real);
    return length < CODE_PATH
               ? STATUS_OK
               : error_set(error, STATUS_BAD_INPUT, "%.200s: the path is too long", code->path);
}

enum status code_load(struct code *code, const char *path, struct error *error)
{
    char *text;
    size_t length;
    *code = (struct code){.case_count = 0};
    if (ini_text_load(path, "code file", &text, &length, error)) return error->status;
    snprintf(code->path, sizeof code->path, "%s", path);
    struct parser parser = {.code = code,
                            .seen = json_object(),
                            .at = {.path = path,
                                   .kind = "code file",
                                   .rest = text,
                                   .end = text + length,
                                   .error = error,
                                   .sections = true}};
    enum status status = take_folder(code, error);
    if (!status) status = ini_text_read(&parser.at, take_pair, &parser);
    if (!status) take_title(code);
    if (!status) status = finish(&parser);
    json_decref(parser.seen);
    free(text);
    if (status) code_free(code);
    return status;
}

void code_with_fault(const struct code_case *of, const struct code_fault *fault,
                     struct code_case *faulty)
{
    *faulty = (struct code_case){of->file, fault->way};
    complete(&faulty->way, &of->way);
}

void code_free(struct code *code)
{
    free(code->cases);
    code->cases = NULL;
    code->case_count = 0;
}

const struct code_case *code_case_of(const struct code *code, const char *name, struct error *error)
{
    const char **names = calloc(code->case_count, sizeof *names);
    for (size_t c = 0; c < code->case_count; c++) {
        const struct code_case *of = &code->cases[c];
        if (strcmp(of->file.asked, name) == 0) {
            free(names);
            return of;
        }
        if (names) names[c] = of->file.asked;
    }
    if (names)
        text_unknown(error, code->path, "section [case] of", name, names, code->case_count);
    else
        error_set(error, STATUS_ENVIRONMENT, "no memory for the names of cases");
    free(names);
    return NULL;
}
