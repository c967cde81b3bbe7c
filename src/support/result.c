/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "result.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/utsname.h>
#include <time.h>
#include <unistd.h>

#include "output.h"
#include "version.h"

/* The processor's name if the system provides it (Linux), otherwise "". */
static void processor_name(char *name, size_t size)
{
    char line[256];
    FILE *file = fopen("/proc/cpuinfo", "r");
    *name = '\0';
    while (file && !*name && fgets(line, sizeof line, file)) {
        const char *colon = strchr(line, ':');
        if (strncmp(line, "model name", 10) == 0 && colon)
            snprintf(name, size, "%.*s", (int)strcspn(colon + 2, "\n"), colon + 2);
    }
    if (file) fclose(file);
}

static json_t *machine(void)
{
    struct utsname names = {0};
    char processor[256];
    uname(&names);
    processor_name(processor, sizeof processor);
    return json_pack("{s:s, s:s, s:s, s:I}", "system", names.sysname, "architecture", names.machine,
                     "processor", processor, "cores", (json_int_t)sysconf(_SC_NPROCESSORS_ONLN));
}

json_t *result_new(const char *command)
{
    char date[32];
    const time_t now = time(NULL);
    struct tm utc;
    strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%SZ", gmtime_r(&now, &utc));
    return json_pack("{s:s, s:s, s:s, s:s, s:s, s:s, s:o, s:s}", "schema", "sphproof/1", "command",
                     command, "version", VERSION, "git", VERSION_GIT, "compiler", VERSION_COMPILER,
                     "flags", VERSION_FLAGS, "machine", machine(), "date", date);
}

json_t *result_number(double value)
{
    if (isnan(value)) return json_string("nan");
    if (isinf(value)) return json_string(value > 0 ? "inf" : "-inf");
    return json_real(value);
}

json_t *result_number_or_null(double value)
{
    return isnan(value) ? json_null() : result_number(value);
}

json_t *result_numbers(const double *values, size_t n)
{
    json_t *array = json_array();
    for (size_t i = 0; i < n; i++) json_array_append_new(array, result_number(values[i]));
    return array;
}

/* Returns -1 if a value is NULL for lack of memory. */
static int add(json_t *object, const char *members, va_list values)
{
    int status = 0;
    for (const char *at = members; *at; at += strcspn(at, " "), at += *at == ' ') {
        char name[64];
        const char *kind = strchr(at, '%') + 1;
        json_t *value;
        snprintf(name, sizeof name, "%.*s", (int)strcspn(at, "="), at);
        if (*kind == 'g') {
            const double number = va_arg(values, double);
            value = kind[1] == '?' ? result_number_or_null(number) : result_number(number);
        } else if (*kind == 'd') {
            const int number = va_arg(values, int);
            value = kind[1] == '?' ? json_boolean(number) : json_integer(number);
        } else if (*kind == 'z')
            value = json_integer((json_int_t)va_arg(values, size_t));
        else if (*kind == 's')
            value = json_string(va_arg(values, const char *));
        else
            value = va_arg(values, void *);
        if (json_object_set_new(object, name, value)) status = -1;
    }
    return status;
}

void result_add(json_t *object, const char *members, ...)
{
    va_list values;
    va_start(values, members);
    add(object, members, values);
    va_end(values);
}

json_t *result_object(const char *members, ...)
{
    json_t *object = json_object();
    va_list values;
    va_start(values, members);
    const int status = add(object, members, values);
    va_end(values);
    if (!status) return object;
    json_decref(object);
    return NULL;
}

char *result_text(const json_t *document)
{
    return json_dumps(document, JSON_COMPACT | JSON_REAL_PRECISION(17));
}

enum status result_load(json_t **document, const char *path, struct error *error)
{
    json_error_t reason;
    struct stat is;
    *document = NULL;
    if (stat(path, &is))
        return error_set(error, STATUS_BAD_INPUT, "'%.200s': %s", path, strerror(errno));
    if (!S_ISREG(is.st_mode))
        return error_set(error, STATUS_BAD_INPUT, "'%.200s': not a regular file", path);
    /* other tools may write 1.0 as 1 and 1e30 with all its digits */
    *document = json_load_file(path, JSON_REJECT_DUPLICATES | JSON_DECODE_INT_AS_REAL, &reason);
    if (!*document)
        return error_set(error, STATUS_BAD_INPUT, "%.200s:%d: no result document: %.200s", path,
                         reason.line, reason.text);
    const char *schema = json_string_value(json_object_get(*document, "schema"));
    if (schema && strcmp(schema, "sphproof/1") == 0 &&
        json_is_string(json_object_get(*document, "command")))
        return STATUS_OK;
    json_decref(*document);
    *document = NULL;
    return error_set(error, STATUS_BAD_INPUT,
                     "'%.200s': no result document: \"schema\": \"sphproof/1\" and \"command\" "
                     "are needed",
                     path);
}

enum status result_write(const json_t *document, const char *path, struct error *error)
{
    struct output output;
    enum status status = output_open(&output, path, error);
    if (status) return status;
    errno = 0;
    if (json_dumpf(document, output.stream, JSON_INDENT(2) | JSON_REAL_PRECISION(17)) ||
        fputc('\n', output.stream) == EOF) {
        const int reason = errno ? errno : ENOSPC;
        if (output.stream == stdout) return output_close(&output, error);
        output_discard(&output);
        return error_set(error, STATUS_ENVIRONMENT, "cannot write '%s': %s", path,
                         strerror(reason));
    }
    return output_close(&output, error);
}
