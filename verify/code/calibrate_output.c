/* SPDX-License-Identifier: GPL-3.0-or-later
 * Results of calibrate as a code file and as JSON. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "buffer.h"
#include "calibrate.h"
#include "result.h"

static const char head[] = "; Bounds of the gates: `sphproof calibrate`";

/* ---- the code file ---- */

/* Reads NAME from a line [case NAME], in INI_TEXT_LINE bytes; "" for another section; false: the
 * line begins no section. */
static bool begins_section(const char *line, char name[INI_TEXT_LINE])
{
    char section[INI_TEXT_LINE];
    line += strspn(line, " \t");
    if (*line++ != '[') return false;
    snprintf(section, sizeof section, "%.*s", (int)strcspn(line, "]\n"), line);
    const char *of_case = code_section_name(section, "case");
    snprintf(name, INI_TEXT_LINE, "%s", of_case ? of_case : "");
    return true;
}

static bool is_gate(const char *line)
{
    line += strspn(line, " \t");
    const size_t length = strcspn(line, " \t=:\n");
    if (!length || strchr(";#", *line) || strncmp(line, "n", length) == 0) return false;
    for (int key = 0; key < CODE_KEYS; key++)
        if (strlen(code_keys[key].name) == length && !strncmp(code_keys[key].name, line, length))
            return false;
    return true;
}

/* Writes the floor, and the smallest change by a fault that the gate detects by error or order. */
static void add_note(const struct calibrate *calibrate, const struct calibrate_gate *gate,
                     struct buffer *to)
{
    buffer_format(to, " ; floor %.1e", gate->floor);
    if (gate->smallest >= 0)
        buffer_format(to, ", %.40s %.1e", calibrate->code->faults[gate->smallest].name,
                      gate->change[gate->smallest]);
    buffer_add(to, "\n");
}

static void add_gates(const struct calibrate *calibrate, const struct calibrate_case *one,
                      struct buffer *to)
{
    for (size_t g = 0; g < one->gate_count; g++) {
        const struct calibrate_gate *gate = &one->gates[g];
        if (isnan(gate->bound)) continue;
        buffer_format(to, "%s = ", gate->name);
        if (isfinite(gate->low))
            buffer_format(to, "%g %g ", gate->low, gate->high);
        else
            buffer_add(to, "0 ");
        if (gate->least > 0) buffer_format(to, "%.6g:", gate->least);
        buffer_format(to, "%.6g", gate->bound);
        add_note(calibrate, gate, to);
    }
}

static const struct calibrate_case *calibrated(const struct calibrate *calibrate, const char *name)
{
    for (size_t c = 0; c < calibrate->count; c++)
        if (*name && strcmp(calibrate->cases[c].of->file.asked, name) == 0)
            return &calibrate->cases[c];
    return NULL;
}

enum status calibrate_text(const struct calibrate *calibrate, char **text, struct error *error)
{
    const struct calibrate_case *one = NULL;
    struct buffer to = {0},
                  after = {0}; /* blank lines at the end of a section, and comments after them */
    char *bytes, name[INI_TEXT_LINE];
    size_t length;
    if (ini_text_load(calibrate->code->path, "code file", &bytes, &length, error))
        return error->status;
    buffer_format(&to, "%s, %zu runs of each case, %zu faults.\n", head, calibrate->runs,
                  calibrate->code->fault_count);
    for (const char *line = bytes, *end = bytes + length; line < end;) {
        const char *stop = memchr(line, '\n', (size_t)(end - line));
        const size_t size = (size_t)((stop ? stop : end) - line);
        char copy[2 * INI_TEXT_LINE] = "";
        memcpy(copy, line, size < sizeof copy ? size : sizeof copy - 1);
        const char first = copy[strspn(copy, " \t\r")];
        const bool section = begins_section(copy, name);
        line += size + (stop != NULL);
        if (strncmp(copy, head, sizeof head - 1) == 0 || (one && !section && is_gate(copy)))
            continue;
        if (section && one) add_gates(calibrate, one, &to);
        if (section) one = calibrated(calibrate, name);
        if (!first || (after.size && strchr(";#", first))) {
            buffer_format(&after, "%s\n", copy);
            continue;
        }
        if (after.size) buffer_add_bytes(&to, after.data, after.size);
        buffer_free(&after);
        after = (struct buffer){0};
        buffer_format(&to, "%s\n", copy);
    }
    if (one) add_gates(calibrate, one, &to);
    if (after.size) buffer_add_bytes(&to, after.data, after.size);
    buffer_free(&after);
    free(bytes);
    *text = buffer_take(&to);
    return *text ? STATUS_OK : error_set(error, STATUS_ENVIRONMENT, "no memory for a code file");
}

/* ---- JSON ---- */

static json_t *fault_list(const struct code *code, const bool *which)
{
    json_t *list = json_array();
    for (size_t f = 0; f < code->fault_count; f++)
        if (which[f]) json_array_append_new(list, json_string(code->faults[f].name));
    return list;
}

static json_t *gate_json(const struct code *code, const struct calibrate_gate *gate)
{
    const bool fault = gate->smallest >= 0;
    return result_object(
        "name=%s value=%g spread=%g floor=%g least=%g? bound=%g? order_low=%g? order_high=%g? "
        "smallest=%p change=%p sees=%p order_lost=%d? status=%s",
        gate->name, gate->value, gate->spread, gate->floor, gate->least, gate->bound, gate->low,
        gate->high, (void *)(fault ? json_string(code->faults[gate->smallest].name) : json_null()),
        (void *)(fault ? result_number(gate->change[gate->smallest]) : json_null()),
        (void *)fault_list(code, gate->sees), gate->order_lost, calibrate_sights[gate->sight]);
}

static json_t *fault_json(const struct calibrate *calibrate, const struct calibrate_case *one,
                          size_t f)
{
    const struct study_result *result = &one->studies[calibrate->runs + f].results[0];
    json_t *by = json_array();
    for (size_t g = 0; g < one->gate_count; g++)
        if (one->gates[g].sees[f]) json_array_append_new(by, json_string(one->gates[g].name));
    json_t *fault = result_object("name=%s status=%s gates=%p", calibrate->code->faults[f].name,
                                  one->breaks[f] ? "failed"
                                  : one->seen[f] ? "seen"
                                                 : "unseen",
                                  (void *)by);
    if (one->breaks[f]) result_add(fault, "message=%s", result->message);
    return fault;
}

void calibrate_add_json(const struct calibrate *calibrate, json_t *document)
{
    const struct code *code = calibrate->code;
    json_t *cases = json_array();
    for (size_t c = 0; c < calibrate->count; c++) {
        const struct calibrate_case *one = &calibrate->cases[c];
        json_t *gates = json_array(), *faults = json_array(), *ladder = json_array();
        for (size_t g = 0; g < one->gate_count; g++)
            json_array_append_new(gates, gate_json(code, &one->gates[g]));
        for (size_t f = 0; f < code->fault_count; f++)
            json_array_append_new(faults, fault_json(calibrate, one, f));
        for (size_t l = 0; l < one->of->file.ladder_count; l++)
            json_array_append_new(ladder, json_integer((json_int_t)one->of->file.ladder[l]));
        json_array_append_new(cases, result_object("case=%s n=%p gates=%p faults=%p trouble=%s",
                                                   one->of->file.asked, (void *)ladder,
                                                   (void *)gates, (void *)faults, one->trouble));
    }
    if (calibrate->count) {
        const struct run_external *external = &calibrate->cases[0].externals[0].base;
        external->describe(external, document);
    }
    result_add(document, "runs=%zu cases=%p", calibrate->runs, (void *)cases);
}
