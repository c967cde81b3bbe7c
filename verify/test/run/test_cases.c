/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests how cases are found: built-in ones by name, files by path; and refuses files that are not
 * case files. */
#include "test.h"

#include <sys/stat.h>

#include "cases.h"
#include "own_folder.h"

enum { LARGEST = 65536 };

/* Writes the built-in case of that name, padded with empty lines to this size. */
static void write_case(const char *path, const char *name, size_t bytes)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    for (const struct case_builtin *builtin = case_builtins; builtin->name; builtin++) {
        if (strcmp(builtin->name, name) != 0) continue;
        fputs(builtin->text, file);
        for (size_t i = strlen(builtin->text); i < bytes; i++) fputc('\n', file);
    }
    assert_int_equal(fclose(file), 0);
}

/* A word with a slash, or that ends in .ini, is a path; files are not searched by name. */
TEST(paths)
{
    struct case_file file;
    struct error error = {0};
    write_case(path_of("tube.ini"), "sod", 0);
    assert_int_equal(case_load(&file, path_of("tube.ini"), &error), STATUS_OK);
    assert_string_equal(file.name, "tube");
    write_case(path_of("tube"), "sod", 0);
    assert_int_equal(case_load(&file, path_of("tube"), &error), STATUS_OK);
    char *before = getcwd(NULL, 0);
    assert_int_equal(chdir(own_folder), 0);
    const enum status alone = case_load(&file, "tube.ini", &error),
                      bare = case_load(&file, "tube", &error),
                      dotted = case_load(&file, "tube.txt", &error);
    assert_int_equal(chdir(before), 0);
    free(before);
    assert_int_equal(alone, STATUS_OK);
    assert_int_equal(bare, STATUS_BAD_INPUT);
    assert_int_equal(dotted, STATUS_BAD_INPUT);
    unlink(path_of("tube"));
    unlink(path_of("tube.ini"));
}

static void refused(const char *name, const char *why)
{
    struct case_file file;
    struct error error = {0};
    char said[512];
    snprintf(said, sizeof said, "case file '%s': %s", name, why);
    assert_int_equal(case_load(&file, name, &error), STATUS_BAD_INPUT);
    assert_string_equal(error.message, said);
}

/* A case file is closed after reading, whichever file descriptor it gets. */
TEST(descriptors)
{
    struct case_file file;
    struct error error = {0};
    write_case(path_of("tube.ini"), "sod", 0);
    const int input = dup(STDIN_FILENO), next = dup(STDIN_FILENO);
    close(next);
    assert_int_equal(case_load(&file, path_of("tube.ini"), &error), STATUS_OK);
    const int after = dup(STDERR_FILENO);
    close(after);
    assert_true(next < 0 || after == next);
    close(STDIN_FILENO);
    const enum status status = case_load(&file, path_of("tube.ini"), &error);
    if (input >= 0) dup2(input, STDIN_FILENO), close(input);
    assert_int_equal(status, STATUS_OK);
    unlink(path_of("tube.ini"));
}

TEST(files_that_are_not_cases)
{
    refused(path_of("none.ini"), "No such file or directory");
    refused(path_of("."), "Is a directory");
    assert_int_equal(mkfifo(path_of("pipe.ini"), 0600), 0);
    refused(path_of("pipe.ini"), "not a regular file"); /* no process writes to it */
    unlink(path_of("pipe.ini"));
    /* the largest size allowed, and one byte more */
    struct case_file file;
    struct error error = {0};
    write_case(path_of("large.ini"), "sod", LARGEST);
    if (case_load(&file, path_of("large.ini"), &error)) fail_msg("%s", error.message);
    write_case(path_of("large.ini"), "sod", LARGEST + 1);
    refused(path_of("large.ini"), "larger than 64 KiB: not a case file");
    unlink(path_of("large.ini"));
    /* files of /proc have no size until they are read */
    struct stat is;
    if (stat("/proc/kallsyms", &is) == 0 && is.st_size == 0 && access("/proc/kallsyms", R_OK) == 0)
        refused("/proc/kallsyms", "larger than 64 KiB: not a case file");
    /* empty, and a single byte */
    char empty[512];
    for (int n = 0; n < 2; n++) {
        FILE *file_of = fopen(path_of("short.ini"), "w");
        assert_non_null(file_of);
        fputs(n ? "x" : "", file_of);
        fclose(file_of);
        char text[] = "x", said[512];
        case_parse(&file, path_of("short.ini"), text, (size_t)n, &error);
        snprintf(said, sizeof said, "%s", error.message);
        assert_int_equal(case_load(&file, path_of("short.ini"), &error), STATUS_BAD_INPUT);
        assert_string_equal(error.message, said);
        if (n) assert_string_not_equal(said, empty);
        snprintf(empty, sizeof empty, "%s", said);
    }
    unlink(path_of("short.ini"));
    /* messages about a file's contents name it */
    FILE *bad = fopen(path_of("bad.ini"), "w");
    assert_non_null(bad);
    fputs("[case]\nno such line\n", bad);
    fclose(bad);
    assert_int_equal(case_load(&file, path_of("bad.ini"), &error), STATUS_BAD_INPUT);
    assert_memory_equal(error.message, path_of("bad.ini:2"), strlen(path_of("bad.ini:2")));
    unlink(path_of("bad.ini"));
}

/* The message lists as many cases as fit. */
TEST(unknown_names)
{
    struct case_file file;
    struct error error = {0};
    char said[256], name[200];
    snprintf(said, sizeof said, "no case 'no_such_case'; allowed: %s %s ", case_builtins[0].name,
             case_builtins[1].name);
    assert_int_equal(case_load(&file, "no_such_case", &error), STATUS_BAD_INPUT);
    if (strncmp(error.message, said, strlen(said)) != 0) fail_msg("%s", error.message);
    assert_int_equal(case_load(&file, "sot", &error), STATUS_BAD_INPUT);
    assert_non_null(strstr(error.message, "no case 'sot'; did you mean 'sod'? allowed: "));
    memset(name, 'a', sizeof name - 1); /* too long for a path to a case */
    name[sizeof name - 1] = '\0';
    assert_int_equal(case_load(&file, name, &error), STATUS_BAD_INPUT);
    assert_memory_equal(error.message, "no case 'aaaa", 13);
}
