/* SPDX-License-Identifier: GPL-3.0-or-later
 * sphproof list: the names that can be used, one line each. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cases.h"
#include "check_registry.h"
#include "code_file.h"
#include "command.h"
#include "integrator.h"
#include "kernel.h"
#include "list.h"
#include "operator.h"
#include "place.h"
#include "problem_list.h"
#include "result.h"
#include "settings.h"
#include "snapshot_file.h"
#include "snapshot_writer.h"
#include "start_format.h"
#include "stress.h"
#include "table.h"
#include "text.h"

enum { ALLOWED_MAX = 4096 };

static bool no_memory; /* for a member of a family that is made */

/* Adds a member to a family that is made at run time, from a registry whose entries are others. */
static void add(struct family *family, const char *name, const char *label, const char *paper)
{
    const struct member **members = (const struct member **)family->members;
    struct member *member = malloc(sizeof *member);
    char *copy = strdup(label);
    if (!member || !copy || !list_grow(&members, family->n, sizeof *members)) {
        free(member), free(copy);
        no_memory = true;
        return;
    }
    *member = (struct member){name, copy, paper};
    members[family->n++] = member;
    family->members = members;
}

static void add_cases(struct family *family)
{
    struct case_file file;
    struct error error;
    for (const struct case_builtin *builtin = case_builtins; builtin->name; builtin++)
        add(family, builtin->name,
            case_load(&file, builtin->name, &error) ? error.message : file.title, "");
}

static void add_keys(struct family *family)
{
    for (int i = 0; i < SETTINGS; i++)
        add(family, setting_keys[i].name, setting_keys[i].meaning, "");
}

static void add_keys_of_codes(struct family *family)
{
    char label[256];
    for (int i = 0; i < CODE_KEYS; i++) {
        const struct code_key_text *key = &code_keys[i];
        snprintf(label, sizeof label, "%s: %s%s%s%s", key->meaning, key->allowed,
                 *key->fallback ? " [" : "", key->fallback, *key->fallback ? "]" : "");
        add(family, key->name, label, "");
    }
}

static void add_checks(struct family *family)
{
    for (size_t i = 0; i < check_registry_count; i++)
        add(family, check_registry[i]->name, check_registry[i]->property, "");
}

static void add_mutants(struct family *family)
{
    for (size_t i = 0; i < check_registry_count; i++)
        for (const struct check_mutant *m = check_registry[i]->mutants; m && m->name; m++)
            add(family, m->name, m->fault, "");
}

static void add_stress_groups(struct family *family)
{
    for (size_t i = 0; i < stress_group_count; i++) {
        const struct member *member = &stress_groups[i].member;
        add(family, member->name, member->label, member->paper);
    }
}

static const struct family words_of_codes = {
    "code_words", "@WORDS@ of a code file's commands and templates", code_words, CODE_WORDS};

/* Each entry is a family, or one that `add` fills once. */
static struct {
    const struct family *family;
    void (*add)(struct family *family);
    struct family made;
} lists[] = {
    {.add = add_cases, .made = {.name = "cases", .title = "built-in cases"}},
    {.family = &problem_family},
    {.family = &kernel_family},
    {.family = &scheme_gradient_family},
    {.family = &operator_family},
    {.family = &scheme_formulation_family},
    {.family = &scheme_volume_element_family},
    {.family = &integrator_family},
    {.family = &scheme_viscosity_family},
    {.family = &scheme_viscosity_form_family},
    {.family = &scheme_balsara_family},
    {.family = &settings_lattice_family},
    {.family = &scheme_energy_family},
    {.family = &scheme_pair_width_family},
    {.family = &scheme_h_method_family},
    {.family = &field_family},
    {.family = &field_norm_family},
    {.family = &snapshot_reader_family},
    {.family = &snapshot_writer_family},
    {.family = &start_format_family},
    {.add = add_checks, .made = {.name = "checks", .title = "checks of `sphproof verify`"}},
    {.add = add_mutants,
     .made = {.name = "mutants", .title = "wrong variants that the checks must reject"}},
    {.add = add_stress_groups, .made = {.name = "stress", .title = "groups of `sphproof stress`"}},
    {.add = add_keys, .made = {.name = "keys", .title = "keys of a run: KEY=VALUE"}},
    {.add = add_keys_of_codes,
     .made = {.name = "code_keys", .title = "keys of a code file (--code)"}},
    {.family = &words_of_codes},
};
enum { LISTS = sizeof lists / sizeof *lists };

/* Makes the families that are listed; chosen < 0: all. */
static void make_families(int chosen)
{
    for (int i = 0; i < LISTS; i++) {
        if (lists[i].family || (chosen >= 0 && i != chosen)) continue;
        lists[i].add(&lists[i].made);
        lists[i].family = &lists[i].made;
    }
}

static void print_family(const struct family *family, const struct table_style *style)
{
    printf("%s%s%s: %s\n", style->bold, family->name, style->end, family->title);
    for (size_t i = 0; i < family->n; i++)
        printf("  %-26s %s\n", family->members[i]->name, family->members[i]->label);
}

static void print_key(const struct setting_key *key, const struct table_style *style)
{
    char allowed[ALLOWED_MAX];
    setting_allowed(key, allowed, sizeof allowed);
    printf("  %s%s%s [%s]%s%s\n", style->bold, key->name, style->end, key->fallback,
           *key->unit ? " in " : "", key->unit);
    table_wrap("      ", key->meaning);
    table_wrap("      ", allowed);
}

/* Prints the table of keys in the README. */
static void print_keys_markdown(void)
{
    printf("| key | default | unit | allowed | meaning |\n|---|---|---|---|---|\n");
    for (int i = 0; i < SETTINGS; i++) {
        char allowed[ALLOWED_MAX];
        const struct setting_key *key = &setting_keys[i];
        setting_allowed(key, allowed, sizeof allowed);
        printf("| `%s` | `%s` | %s | %s | %s |\n", key->name, key->fallback, key->unit, allowed,
               key->meaning);
    }
}

static json_t *family_json(const struct family *family)
{
    json_t *list = json_array();
    for (size_t i = 0; i < family->n; i++) {
        const struct member *member = family->members[i];
        json_t *item =
            result_object("name=%s label=%s paper=%s", member->name, member->label, member->paper);
        const int key = strcmp(family->name, "keys") == 0 ? setting_find(member->name) : -1;
        if (key >= 0) {
            char allowed[ALLOWED_MAX];
            setting_allowed(&setting_keys[key], allowed, sizeof allowed);
            result_add(item, "default=%s unit=%s allowed=%s", setting_keys[key].fallback,
                       setting_keys[key].unit, allowed);
        }
        json_array_append_new(list, item);
    }
    return list;
}

/* The files that were installed with the program, and their paths. */
static json_t *where(bool speak)
{
    static const char *const names[] = {"cases", "sphproof-1.schema.json"};
    json_t *list = json_object();
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char path[PLACE_LENGTH];
        const bool found = place_find(names[i], path);
        if (speak) printf("%-24s %s\n", names[i], found ? path : "not installed");
        json_object_set_new(list, names[i], found ? json_string(path) : json_null());
    }
    return list;
}

static enum status choose(const char *word, int *chosen, struct error *error)
{
    const char *names[LISTS];
    for (int i = 0; i < LISTS; i++) {
        names[i] = lists[i].family ? lists[i].family->name : lists[i].made.name;
        if (strcmp(word, names[i]) == 0) *chosen = i;
    }
    return *chosen < 0 ? text_unknown(error, "list", "family", word, names, LISTS) : STATUS_OK;
}

static enum status run(const struct options *options, int n, char **arguments, struct error *error)
{
    int chosen = -1;
    const struct table_style style = table_style(options->color);
    const bool markdown = options_value(options, "markdown"),
               places = options_value(options, "where");
    if (n > 1) return command_usage(options, error, "one family at a time");
    if (n == 1 && choose(arguments[0], &chosen, error)) return error->status;
    if (!places) make_families(chosen);
    if (no_memory) return error_set(error, STATUS_ENVIRONMENT, "list: no memory");
    const bool only_keys = n == 1 && strcmp(arguments[0], "keys") == 0;
    if (markdown && !only_keys)
        return command_usage(options, error, "--markdown goes with `list keys` only");
    if (places && n) return command_usage(options, error, "--where stands alone");
    json_t *families = json_object(), *installed = places ? where(options->speak) : NULL;
    for (int i = 0; i < LISTS && !places; i++) {
        const struct family *family = lists[i].family;
        if (chosen >= 0 && i != chosen) continue;
        if (options->speak && !only_keys) print_family(family, &style);
        json_object_set_new(families, family->name, family_json(family));
    }
    for (int i = 0; i < SETTINGS && only_keys && options->speak && !markdown; i++)
        print_key(&setting_keys[i], &style);
    if (markdown && options->speak) print_keys_markdown();
    json_t *document = result_new("list");
    json_object_set_new(document, "families", families);
    if (places) json_object_set_new(document, "installed", installed);
    return options_write(options, document, error);
}

static const struct command_option own_options[] = {
    {"markdown", NULL, "the keys as a table for a README"},
    {"where", NULL, "print the folders of the installed cases and of the schema of results"},
    {NULL, NULL, NULL},
};

const struct command command_list = {
    .name = "list",
    .synopsis = "[FAMILY]",
    .help =
        "the names of cases, kernels, gradients, keys ..., one line each\n"
        "FAMILY: cases problems kernels gradients operators formulations volume_elements\n"
        "integrators viscosities viscosity_forms balsara_factors lattices energies pair_widths\n"
        "h_methods fields norms snapshots writers formats checks mutants stress keys\n"
        "code_keys code_words",
    .run = run,
    .options = own_options,
    .examples = "sphproof list\nsphproof list kernels\nsphproof list keys",
};
