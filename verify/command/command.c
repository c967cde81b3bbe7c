/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "command.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "plugin_kernel.h"
#include "certificate.h"
#include "output.h"
#include "settings.h"
#include "text.h"
#include "threads.h"
#include "version.h"

#define COMMAND(name) extern const struct command command_##name;
#include "commands.def"
#undef COMMAND

const struct command *const command_table[] = {
#define COMMAND(name) &command_##name,
#include "commands.def"
#undef COMMAND
};
enum { COMMANDS = sizeof command_table / sizeof *command_table, THREADS_MAX = 1024 };
const size_t command_count = COMMANDS;

const struct command_option command_common[] = {
    {"json", "FILE|-", "write the result document (with - nothing else goes to standard output)"},
    {"threads", "T", "threads, 1 to 1024 (default 1); results do not depend on it"},
    {"quiet", NULL, "print neither tables nor progress"},
    {"uncertified", NULL, "use a plug-in kernel although its certificate is refused"},
    {"color", "auto|always|never", "colours in tables (default auto; NO_COLOR is respected)"},
    {"help", NULL, "this help; after a command, that command's (also: sphproof help COMMAND)"},
    {"version", NULL, "version, git revision and compiler"},
    {NULL, NULL, NULL},
};

/* The parsed command line. */
struct line {
    struct options options;
    const char *color;
    bool help, version, uncertified;
    int n; /* arguments, command's name not counted */
    char **arguments;
    char **owned; /* texts of repeated options */
    int owned_count;
};

static size_t count(const struct command_option *list)
{
    size_t n = 0;
    while (list && list[n].name) n++;
    return n;
}

static const struct command_option *find(const struct command_option *list, const char *name,
                                         size_t length)
{
    for (; list && list->name; list++)
        if (strlen(list->name) == length && strncmp(list->name, name, length) == 0) return list;
    return NULL;
}

/* next: the following word, or NULL. */
static enum status unknown_option(const struct options *options, const char *word, const char *next,
                                  struct error *error)
{
    const char *name = word + strspn(word, "-"), *value = strchr(name, '=');
    char key[40];
    snprintf(key, sizeof key, "%.*s", (int)strcspn(name, "="), name);
    if (options->command && strstr(options->command->synopsis, "KEY=VALUE") &&
        setting_find(key) >= 0)
        return error_set(error, STATUS_BAD_INPUT,
                         "%s: '%.*s%s' is a key, not an option; write it as %s=%.80s",
                         options->command->name, (int)(name - word), word, key, key,
                         value                                 ? value + 1
                         : next && strncmp(next, "--", 2) != 0 ? next
                                                               : "VALUE");
    const struct command_option *const lists[] = {
        options->command ? options->command->options : NULL, command_common};
    const size_t most = count(lists[0]) + count(lists[1]);
    char names[most][40];
    const char *list[most];
    size_t n = 0;
    for (size_t l = 0; l < 2; l++)
        for (size_t i = 0; i < count(lists[l]); i++, n++) {
            snprintf(names[n], sizeof names[n], "--%s", lists[l][i].name);
            list[n] = names[n];
        }
    return text_unknown(error, options->command ? options->command->name : NULL, "option", word,
                        list, n);
}

static enum status apply_common(struct line *line, const char *name, const char *value,
                                struct error *error)
{
    double number;
    switch (name[0]) {
    case 'j':
        line->options.json = value;
        break;
    case 'q':
        line->options.quiet = true;
        break;
    case 'h':
        line->help = true;
        break;
    case 'u':
        line->uncertified = true;
        break;
    case 'v':
        line->version = true;
        break;
    case 'c':
        if (strcmp(value, "auto") && strcmp(value, "always") && strcmp(value, "never"))
            return error_set(error, STATUS_BAD_INPUT, "--color '%.40s': allowed: auto always never",
                             value);
        line->color = value;
        break;
    case 't':
        if (!text_integer(value, &number) || !(number >= 1 && number <= THREADS_MAX))
            return error_set(error, STATUS_BAD_INPUT,
                             "--threads '%.40s': allowed: an integer from 1 to %d", value,
                             THREADS_MAX);
        line->options.threads = (int)number;
        break;
    default:
        break;
    }
    return STATUS_OK;
}

/* Appends the value of a repeated option as a line. */
static enum status join(struct line *line, const char **slot, const char *value,
                        struct error *error)
{
    const size_t size = strlen(*slot) + strlen(value) + 2;
    char *text = malloc(size);
    if (!text) return error_set(error, STATUS_ENVIRONMENT, "no memory");
    snprintf(text, size, "%s\n%s", *slot, value);
    line->owned[line->owned_count++] = text;
    *slot = text;
    return STATUS_OK;
}

/* Takes the option at argv[*i]; moves *i to its last word. */
static enum status take_option(struct line *line, char **argv, int *i, struct error *error)
{
    const char *word = strcmp(argv[*i], "-h") == 0 ? "--help" : argv[*i];
    const char *next = argv[*i + 1]; /* NULL after the last */
    if (word[1] != '-') return unknown_option(&line->options, word, next, error);
    const size_t length = strcspn(word + 2, "=");
    const struct command *command = line->options.command;
    const struct command_option *own = command ? find(command->options, word + 2, length) : NULL;
    const struct command_option *option = own ? own : find(command_common, word + 2, length);
    if (!option) return unknown_option(&line->options, word, next, error);
    const char *value = word[2 + length] == '=' ? word + 3 + length : NULL;
    if (!option->argument) {
        if (value)
            return error_set(error, STATUS_BAD_INPUT, "--%s takes no argument", option->name);
        value = "";
    } else if (!value) {
        const bool dashes = strcmp(option->argument, COMMAND_OPTIONS) == 0;
        if (!next || (!dashes && strncmp(next, "--", 2) == 0))
            return error_set(error, STATUS_BAD_INPUT, "--%s needs an argument: --%s %s",
                             option->name, option->name, option->argument);
        value = argv[++*i];
    }
    if (!own) return apply_common(line, option->name, value, error);
    const char **slot = &line->options.values[own - command->options];
    const char *more = option->argument ? strstr(option->argument, " ...") : NULL;
    if (*slot && !(more && !more[4])) {
        const bool list = option->argument && strstr(option->argument, ",...");
        return error_set(error, STATUS_BAD_INPUT, "--%s is given twice%s%s", option->name,
                         list ? "; allowed: once, as " : "", list ? option->argument : "");
    }
    if (*slot) return join(line, slot, value, error);
    *slot = value;
    return STATUS_OK;
}

static enum status find_command(const char *word, struct options *options, struct error *error)
{
    const char *names[COMMANDS];
    for (size_t i = 0; i < COMMANDS; i++) {
        names[i] = command_table[i]->name;
        if (strcmp(word, names[i]) != 0) continue;
        options->command = command_table[i];
        options->values = calloc(count(command_table[i]->options), sizeof *options->values);
        return options->values ? STATUS_OK : error_set(error, STATUS_ENVIRONMENT, "no memory");
    }
    return text_unknown(error, NULL, "command", word, names, COMMANDS);
}

static enum status parse(struct line *line, int argc, char **argv, struct error *error)
{
    enum status status = STATUS_OK;
    bool options_end = false;
    for (int i = 1; i < argc && !status; i++) {
        char *word = argv[i];
        double number;
        if (i == 1 && strcmp(word, "help") == 0)
            line->help = true;
        else if (!options_end && strcmp(word, "--") == 0)
            options_end = true;
        else if (!options_end && word[0] == '-' && word[1] && !text_real(word, &number))
            status = take_option(line, argv, &i, error);
        else if (!line->options.command)
            status = find_command(word, &line->options, error);
        else
            line->arguments[line->n++] = word;
    }
    return status;
}

/* The help of an option, broken between words into lines that end before this column. */
enum { OPTION_INDENT = 28, LINE_END = 100 };

static void print_options(const struct command_option *list)
{
    for (; list && list->name; list++) {
        char left[64];
        snprintf(left, sizeof left, "--%s%s%s", list->name, list->argument ? " " : "",
                 list->argument ? list->argument : "");
        int column = printf("  %-26s", left);
        for (const char *word = list->help; *word; word += strspn(word, " ")) {
            const int length = (int)strcspn(word, " ");
            if (column + 1 + length > LINE_END) {
                printf("\n");
                column = printf("%*s", OPTION_INDENT, "");
            }
            column += printf(" %.*s", length, word);
            word += length;
        }
        printf("\n");
    }
}

static void print_help(const struct command *command)
{
    if (command) {
        printf("usage: sphproof %s %s\n\n%s\n", command->name, command->synopsis, command->help);
        printf("\noptions:\n");
        print_options(command->options);
    } else {
        printf("sphproof: verification and convergence of SPH\n\nusage: sphproof COMMAND "
               "[ARGUMENT ...] [OPTION ...]\n\ncommands:\n");
        for (size_t i = 0; i < COMMANDS; i++)
            printf("  %-10s %.*s\n", command_table[i]->name,
                   (int)strcspn(command_table[i]->help, "\n"), command_table[i]->help);
    }
    printf("\noptions of every command:\n");
    print_options(command_common);
    printf("\nexit status:\n");
#define STATUS(name, code, text) printf("  %d  %s\n", code, text);
    STATUS_LIST(STATUS)
#undef STATUS
    const char *examples = command ? command->examples
                                   : "sphproof list\nsphproof run sod\nsphproof run sod n=800 "
                                     "kernel=cubic_spline gradient=ia\nsphproof run --help";
    if (examples) printf("\nexamples:\n");
    for (const char *e = examples; e && *e; e += strcspn(e, "\n"), e += *e == '\n')
        printf("  %.*s\n", (int)strcspn(e, "\n"), e);
}

static void resolve_streams(struct line *line)
{
    struct options *options = &line->options;
    const char *no_color = getenv("NO_COLOR"), *terminal = getenv("TERM");
    options->speak = !options->quiet && !(options->json && strcmp(options->json, "-") == 0);
    options->color = strcmp(line->color, "always") == 0 ||
                     (strcmp(line->color, "auto") == 0 && isatty(STDOUT_FILENO) &&
                      !(no_color && *no_color) && terminal && strcmp(terminal, "dumb") != 0);
}

static enum status execute(struct line *line, int argc, char **argv, struct error *error)
{
    enum status status = parse(line, argc, argv, error);
    const struct options *options = &line->options;
    if (status) return status;
    if (line->version) {
        printf("sphproof %s (%s), %s\n", VERSION, VERSION_GIT, VERSION_COMPILER);
        return STATUS_OK;
    }
    if (line->help) {
        print_help(options->command);
        return STATUS_OK;
    }
    if (!options->command)
        return error_set(error, STATUS_BAD_INPUT,
                         "no command given; `sphproof --help` lists the commands");
    resolve_streams(line);
    plugin_allow(certificate_failing, line->uncertified);
    if (options->json && (status = output_probe(options->json, error))) return status;
    if ((status = threads_check(options->threads, error))) return status;
    line->options.count = line->n;
    line->options.arguments = line->arguments;
    return options->command->run(options, line->n, line->arguments, error);
}

int command_main(int argc, char **argv)
{
    struct error error = {0};
    output_prepare_process();
    struct line line = {.options = {.threads = 1}, .color = "auto"};
    line.arguments = calloc((size_t)argc, sizeof *line.arguments);
    line.owned = calloc((size_t)argc, sizeof *line.owned);
    enum status status = line.arguments && line.owned
                             ? execute(&line, argc, argv, &error)
                             : error_set(&error, STATUS_ENVIRONMENT, "no memory");
    const enum status flushed = output_finish_process(&error);
    if (flushed) status = flushed;
    if (error.message[0] && status) fprintf(stderr, "sphproof: %s\n", error.message);
    for (int i = 0; i < line.owned_count; i++) free(line.owned[i]);
    free(line.owned), free(line.arguments), free(line.options.values);
    return (int)status;
}
