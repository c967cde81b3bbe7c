/* SPDX-License-Identifier: GPL-3.0-or-later
 * Writes the manual pages and the completion of shells from the tables that --help prints:
 *
 *   manual DIR    sphproof.1, sphproof-COMMAND.1 ..., sphproof.bash, _sphproof (zsh), sphproof.fish
 */
#include <errno.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cases.h"
#include "command.h"
#include "kernel.h"
#include "operator.h"
#include "settings.h"
#include "version.h"

static bool failed;

static FILE *begin(const char *folder, const char *format, ...)
{
    char name[80], path[4096];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(name, sizeof name, format, arguments);
    va_end(arguments);
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *out = fopen(path, "w");
    if (out) return out;
    fprintf(stderr, "manual: %s: %s\n", path, strerror(errno));
    exit(STATUS_ENVIRONMENT);
}

static void end(FILE *out)
{
    failed = ferror(out) || fclose(out) || failed;
}

static size_t line_length(const char *text)
{
    return strcspn(text, "\n");
}

/* ---- manual pages ---- */

/* Writes `length` bytes as plain text of a manual page: dashes stay dashes, and no line is a
 * request. */
static void put_roff(FILE *out, const char *text, size_t length)
{
    for (size_t i = 0; i < length; i++) {
        const bool first = i == 0 || text[i - 1] == '\n';
        if (first && (text[i] == '.' || text[i] == '\'')) fputs("\\&", out);
        if (text[i] == '\\')
            fputs("\\e", out);
        else if (text[i] == '-')
            fputs("\\-", out);
        else
            fputc(text[i], out);
    }
}

static void put_options(FILE *out, const struct command_option *list)
{
    for (; list && list->name; list++) {
        fprintf(out, ".TP\n\\fB\\-\\-");
        put_roff(out, list->name, strlen(list->name));
        fprintf(out, "\\fR");
        if (list->argument) {
            fprintf(out, " \\fI");
            put_roff(out, list->argument, strlen(list->argument));
            fprintf(out, "\\fR");
        }
        fputc('\n', out);
        put_roff(out, list->help, strlen(list->help));
        fputc('\n', out);
    }
}

static void put_commands(FILE *out)
{
    for (size_t i = 0; i < command_count; i++) {
        fprintf(out, ".TP\n\\fBsphproof\\-%s\\fR(1)\n", command_table[i]->name);
        put_roff(out, command_table[i]->help, line_length(command_table[i]->help));
        fputc('\n', out);
    }
}

static void put_tail(FILE *out, const char *examples)
{
    fprintf(out, ".SH EXIT STATUS\n");
#define STATUS(name, code, text) fprintf(out, ".TP\n%d\n%s\n", code, text);
    STATUS_LIST(STATUS)
#undef STATUS
    if (!examples) return;
    fprintf(out, ".SH EXAMPLES\n.nf\n");
    put_roff(out, examples, strlen(examples));
    fprintf(out, "\n.fi\n");
}

static void write_page(const char *folder, const struct command *command)
{
    FILE *out = begin(folder, "sphproof-%s.1", command->name);
    const size_t first = line_length(command->help);
    fprintf(out, ".TH SPHPROOF\\-%s 1 \"\" \"sphproof %s\"\n.SH NAME\nsphproof\\-%s \\- ",
            command->name, VERSION, command->name);
    put_roff(out, command->help, first);
    fprintf(out, "\n.SH SYNOPSIS\n\\fBsphproof %s\\fR ", command->name);
    put_roff(out, command->synopsis, strlen(command->synopsis));
    fprintf(out, "\n.SH DESCRIPTION\n.nf\n");
    put_roff(out, command->help, strlen(command->help));
    fprintf(out, "\n.fi\n.SH OPTIONS\n");
    put_options(out, command->options);
    put_options(out, command_common);
    put_tail(out, command->examples);
    fprintf(out, ".SH SEE ALSO\n\\fBsphproof\\fR(1)\n");
    end(out);
}

static void write_first_page(const char *folder)
{
    FILE *out = begin(folder, "sphproof.1");
    fprintf(out,
            ".TH SPHPROOF 1 \"\" \"sphproof %s\"\n.SH NAME\nsphproof \\- verification and "
            "convergence of smoothed particle hydrodynamics\n.SH SYNOPSIS\n\\fBsphproof\\fR "
            "\\fICOMMAND\\fR [\\fIARGUMENT\\fR ...] [\\fIOPTION\\fR ...]\n.SH COMMANDS\n",
            VERSION);
    put_commands(out);
    fprintf(out, ".SH OPTIONS OF EVERY COMMAND\n");
    put_options(out, command_common);
    fprintf(out, ".SH KEYS OF A RUN\n");
    for (int i = 0; i < SETTINGS; i++) {
        char allowed[4096];
        setting_allowed(&setting_keys[i], allowed, sizeof allowed);
        fprintf(out, ".TP\n\\fB%s\\fR=", setting_keys[i].name);
        put_roff(out, setting_keys[i].fallback, strlen(setting_keys[i].fallback));
        fputc('\n', out);
        put_roff(out, setting_keys[i].meaning, strlen(setting_keys[i].meaning));
        fprintf(out, ";\n");
        put_roff(out, allowed, strlen(allowed));
        fputc('\n', out);
    }
    put_tail(out, NULL);
    end(out);
}

/* ---- completion ---- */

/* The kinds of words that an option's argument, or a command's, may be. */
enum words { WORDS_FILE, WORDS_CASE, WORDS_RUN, WORDS_KERNEL, WORDS_OPERATOR, WORDS_LISTED };

static enum words words_of(const char *argument)
{
    if (strncmp(argument, "CASE", 4) == 0) return WORDS_CASE;
    if (strcmp(argument, "K") == 0) return WORDS_KERNEL;
    if (strcmp(argument, "OP") == 0) return WORDS_OPERATOR;
    return strchr(argument, '|') &&
                   strcspn(argument, "ABCDEFGHIJKLMNOPQRSTUVWXYZ.") == strlen(argument)
               ? WORDS_LISTED
               : WORDS_FILE;
}

static enum words words_of_command(const struct command *command)
{
    if (strstr(command->synopsis, "KEY=VALUE")) return WORDS_RUN;
    return strncmp(command->synopsis, "NAME", 4) == 0 ? WORDS_KERNEL : WORDS_FILE;
}

static void put_family(FILE *out, const struct family *family)
{
    for (size_t i = 0; i < family->n; i++)
        fprintf(out, "%s%s", i ? " " : "", family->members[i]->name);
}

/* Writes the words, separated by blanks; nothing for files. */
static void put_words(FILE *out, enum words words, const char *listed)
{
    if (words == WORDS_CASE || words == WORDS_RUN)
        for (const struct case_builtin *b = case_builtins; b->name; b++)
            fprintf(out, "%s%s", b == case_builtins ? "" : " ", b->name);
    if (words == WORDS_RUN)
        for (int i = 0; i < SETTINGS; i++) fprintf(out, " %s=", setting_keys[i].name);
    if (words == WORDS_KERNEL) put_family(out, &kernel_family);
    if (words == WORDS_OPERATOR) put_family(out, &operator_family);
    for (; words == WORDS_LISTED && *listed; listed++) fputc(*listed == '|' ? ' ' : *listed, out);
}

static void put_command_names(FILE *out)
{
    for (size_t i = 0; i < command_count; i++)
        fprintf(out, "%s%s", i ? " " : "", command_table[i]->name);
}

static void put_option_names(FILE *out, const struct command_option *list)
{
    for (; list && list->name; list++) fprintf(out, " --%s", list->name);
}

/* Writes a branch for each option of the list whose argument is not simply a file. */
static void put_bash_arguments(FILE *out, const char *command, const struct command_option *list)
{
    for (; list && list->name; list++) {
        if (!list->argument) continue;
        fprintf(out, "    '%s --%s') words='", command, list->name);
        put_words(out, words_of(list->argument), list->argument);
        fprintf(out, "' files=%s; _sphproof_reply; return ;;\n",
                words_of(list->argument) == WORDS_FILE ? "1" : "");
    }
}

static void write_bash(const char *folder)
{
    FILE *out = begin(folder, "sphproof.bash");
    fprintf(out, "# Completion of sphproof for bash, made from the program's own tables.\n"
                 "_sphproof_reply() {\n"
                 "    COMPREPLY=($(compgen -W \"$words\" -- \"$cur\"))\n"
                 "    [ -z \"$files\" ] || COMPREPLY+=($(compgen -f -- \"$cur\"))\n"
                 "    case ${COMPREPLY[0]} in *=) compopt -o nospace 2>/dev/null ;; esac\n}\n"
                 "_sphproof() {\n"
                 "    local cur=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} "
                 "command=${COMP_WORDS[1]} words= files= key=\n"
                 "    COMPREPLY=()\n"
                 "    if [ \"$COMP_CWORD\" = 1 ]; then words='");
    put_command_names(out);
    put_option_names(out, command_common);
    fprintf(out, "'; _sphproof_reply; return; fi\n"
                 "    if [ \"$cur\" = = ]; then key=$before cur=\n"
                 "    elif [ \"$before\" = = ]; then key=${COMP_WORDS[COMP_CWORD-2]}; fi\n"
                 "    case $key in\n    '') ;;\n");
    for (int i = 0; i < SETTINGS; i++) {
        if (!setting_keys[i].family) continue;
        fprintf(out, "    %s) words='", setting_keys[i].name);
        put_family(out, setting_keys[i].family);
        fprintf(out, "'; _sphproof_reply; return ;;\n");
    }
    fprintf(out, "    *) files=1; _sphproof_reply; return ;;\n    esac\n"
                 "    case \"$command $before\" in\n");
    for (size_t i = 0; i < command_count; i++) {
        put_bash_arguments(out, command_table[i]->name, command_table[i]->options);
        put_bash_arguments(out, command_table[i]->name, command_common);
    }
    fprintf(out, "    esac\n    case $command in\n");
    for (size_t i = 0; i < command_count; i++) {
        fprintf(out, "    %s) words='", command_table[i]->name);
        put_words(out, words_of_command(command_table[i]), "");
        put_option_names(out, command_table[i]->options);
        put_option_names(out, command_common);
        fprintf(out, "' ;;\n");
    }
    fprintf(out, "    esac\n    case $cur in -*) ;; *) files=1 ;; esac\n    _sphproof_reply\n}\n"
                 "complete -F _sphproof sphproof\n");
    end(out);
}

/* Writes text in single quotes, for zsh and fish; for zsh special characters of descriptions are
 * escaped as well. */
static void put_quoted(FILE *out, const char *text, size_t length, bool zsh)
{
    for (size_t i = 0; i < length; i++)
        if (text[i] == '\'')
            fputs(zsh ? "'\\''" : "\\'", out);
        else if (zsh && strchr("[]:", text[i]))
            fprintf(out, "\\%c", text[i]);
        else
            fputc(text[i], out);
}

static void put_zsh_options(FILE *out, const struct command_option *list)
{
    for (; list && list->name; list++) {
        fprintf(out, " \\\n            '--%s[", list->name);
        put_quoted(out, list->help, strlen(list->help), true);
        fputc(']', out);
        if (list->argument) {
            const enum words words = words_of(list->argument);
            fputc(':', out);
            put_quoted(out, list->argument, strlen(list->argument), true);
            fputs(words == WORDS_FILE ? ":_files" : ":(", out);
            put_words(out, words, list->argument);
            if (words != WORDS_FILE) fputc(')', out);
        }
        fputc('\'', out);
    }
}

static void write_zsh(const char *folder)
{
    FILE *out = begin(folder, "_sphproof");
    fprintf(out, "#compdef sphproof\n# Completion of sphproof for zsh, made from the program's own "
                 "tables.\n_sphproof() {\n    local -a commands\n    commands=(");
    for (size_t i = 0; i < command_count; i++) {
        fprintf(out, "\n        '%s:", command_table[i]->name);
        put_quoted(out, command_table[i]->help, line_length(command_table[i]->help), true);
        fputc('\'', out);
    }
    fprintf(out, ")\n    if (( CURRENT == 2 )); then _describe command commands; return; fi\n"
                 "    local command=$words[2]\n    shift words; (( CURRENT-- ))\n"
                 "    case $command in\n");
    for (size_t i = 0; i < command_count; i++) {
        const enum words words = words_of_command(command_table[i]);
        fprintf(out, "    %s)\n        _arguments", command_table[i]->name);
        put_zsh_options(out, command_table[i]->options);
        put_zsh_options(out, command_common);
        fprintf(out, " \\\n            '*:argument:%s", words == WORDS_FILE ? "_files" : "(");
        put_words(out, words, "");
        fprintf(out, "%s' ;;\n", words == WORDS_FILE ? "" : ")");
    }
    fprintf(out, "    esac\n}\n_sphproof \"$@\"\n");
    end(out);
}

static void put_fish_options(FILE *out, const char *command, const struct command_option *list)
{
    for (; list && list->name; list++) {
        fprintf(out, "complete -c sphproof");
        if (command) fprintf(out, " -n '__fish_seen_subcommand_from %s'", command);
        fprintf(out, " -l %s", list->name);
        if (list->argument) {
            const enum words words = words_of(list->argument);
            fputs(words == WORDS_FILE ? " -r -F" : " -x -a '", out);
            put_words(out, words, list->argument);
            if (words != WORDS_FILE) fputc('\'', out);
        }
        fputs(" -d '", out);
        put_quoted(out, list->help, strlen(list->help), false);
        fputs("'\n", out);
    }
}

static void write_fish(const char *folder)
{
    FILE *out = begin(folder, "sphproof.fish");
    fprintf(out, "# Completion of sphproof for fish, made from the program's own tables.\n");
    for (size_t i = 0; i < command_count; i++) {
        const struct command *command = command_table[i];
        fprintf(out, "complete -c sphproof -f -n __fish_use_subcommand -a %s -d '", command->name);
        put_quoted(out, command->help, line_length(command->help), false);
        fputs("'\n", out);
        put_fish_options(out, command->name, command->options);
        if (words_of_command(command) == WORDS_FILE) continue;
        fprintf(out, "complete -c sphproof -n '__fish_seen_subcommand_from %s' -a '",
                command->name);
        put_words(out, words_of_command(command), "");
        fputs("'\n", out);
    }
    put_fish_options(out, NULL, command_common);
    end(out);
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: manual DIR\n");
        return STATUS_BAD_INPUT;
    }
    write_first_page(argv[1]);
    for (size_t i = 0; i < command_count; i++) write_page(argv[1], command_table[i]);
    write_bash(argv[1]), write_zsh(argv[1]), write_fish(argv[1]);
    return failed ? STATUS_ENVIRONMENT : STATUS_OK;
}
