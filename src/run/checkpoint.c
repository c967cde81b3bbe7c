/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "checkpoint.h"

#include <errno.h>
#include <jansson.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cache.h"
#include "clock.h"
#include "output.h"

/* The file has this string and the build in the first line, the run in the second, then the state
 * and the checksum. */
static const char magic[] = "sphproof-checkpoint/1";
enum { HEAD_MAX = 1 << 16 };

bool checkpoint_due(struct checkpoint *checkpoint)
{
    const double now = clock_wall();
    if (!checkpoint->begun) checkpoint->written = now;
    checkpoint->begun = true;
    if (now < checkpoint->written + checkpoint->every) return false;
    checkpoint->written = now;
    return true;
}

/* A file and the hash of all bytes read or written so far. */
struct stream {
    FILE *file;
    uint64_t sum;
};

static bool put(void *context, void *bytes, size_t n)
{
    struct stream *stream = context;
    stream->sum = cache_hash(stream->sum, bytes, n);
    return fwrite(bytes, 1, n, stream->file) == n;
}

static bool get(void *context, void *bytes, size_t n)
{
    struct stream *stream = context;
    if (fread(bytes, 1, n, stream->file) != n) return false;
    stream->sum = cache_hash(stream->sum, bytes, n);
    return true;
}

void checkpoint_save(struct checkpoint *checkpoint, struct simulation *simulation,
                     struct growth *growth)
{
    struct output output;
    checkpoint->trouble = (struct error){0};
    if (output_open(&output, checkpoint->path, &checkpoint->trouble)) return;
    struct stream stream = {.file = output.stream, .sum = CACHE_HASH};
    struct serialiser serialiser = {.bytes = put, .context = &stream};
    fprintf(output.stream, "%s %s\n%s\n", magic, checkpoint->build, checkpoint->run);
    SERIALISE(&serialiser, *growth);
    SERIALISE(&serialiser, checkpoint->snapshot);
    if (checkpoint->trace) SERIALISE(&serialiser, *checkpoint->trace);
    simulation_serialise(simulation, &serialiser);
    fwrite(&stream.sum, sizeof stream.sum, 1, output.stream);
    output_close(&output, &checkpoint->trouble); /* reports failures */
}

/* Reads one line without the newline; false if it does not end within `size`. */
static bool line_of(FILE *file, char *line, size_t size)
{
    if (!fgets(line, (int)size, file)) return false;
    char *end = strchr(line, '\n');
    if (end) *end = '\0';
    return end;
}

static enum status refuse(const struct checkpoint *checkpoint, const char *why, struct error *error)
{
    return error_set(error, STATUS_BAD_INPUT, "--resume '%.200s': %s", checkpoint->path, why);
}

/* Names the key that differs between two runs, with values if it is a setting. */
static enum status other_run(const struct checkpoint *checkpoint, const char *there,
                             struct error *error)
{
    json_t *a = json_loads(there, 0, NULL), *b = json_loads(checkpoint->run, 0, NULL);
    json_t *mine = json_object_get(b, "settings"), *value;
    char why[300] = "is of another run";
    const char *key;
    json_object_foreach(b, key, value)
        if (!json_equal(value, json_object_get(a, key)))
            snprintf(why, sizeof why, "is of another run: its '%.40s' differs", key);
    json_object_foreach(mine, key, value) {
        const json_t *other = json_object_get(json_object_get(a, "settings"), key);
        if (json_equal(value, other)) continue;
        char *was = json_dumps(other, JSON_ENCODE_ANY), *is = json_dumps(value, JSON_ENCODE_ANY);
        snprintf(why, sizeof why, "is of another run: %.40s is %.80s there, %.80s here", key,
                 was ? was : "nothing", is ? is : "nothing");
        free(was);
        free(is);
    }
    json_decref(a);
    json_decref(b);
    return refuse(checkpoint, why, error);
}

static enum status check_head(const struct checkpoint *checkpoint, FILE *file, struct error *error)
{
    char first[sizeof magic + CHECKPOINT_WORD + 2];
    char *run = malloc(HEAD_MAX);
    enum status status = STATUS_OK;
    if (!run) return error_set(error, STATUS_ENVIRONMENT, "no memory to resume");
    if (!line_of(file, first, sizeof first) || strncmp(first, magic, strlen(magic)) != 0)
        status = refuse(checkpoint, "is no checkpoint, or of another version", error);
    else if (strcmp(first + strlen(magic) + 1, checkpoint->build) != 0)
        status = refuse(checkpoint,
                        "was written by another build of the program, or where sin, exp and pow "
                        "have other last bits: only the same one goes on to the last bit",
                        error);
    else if (!line_of(file, run, HEAD_MAX))
        status = refuse(checkpoint, "is damaged", error);
    else if (strcmp(run, checkpoint->run) != 0)
        status = other_run(checkpoint, run, error);
    free(run);
    return status;
}

/* Checks the remaining bytes of the file against the checksum. */
static enum status check_bytes(const struct checkpoint *checkpoint, FILE *file, struct error *error)
{
    enum { PART = 1 << 20 };
    struct stream stream = {.file = file, .sum = CACHE_HASH};
    uint64_t sum;
    const long begin = ftell(file);
    if (fseek(file, 0, SEEK_END)) return refuse(checkpoint, "is damaged", error);
    char *part = malloc(PART);
    if (!part) return error_set(error, STATUS_ENVIRONMENT, "no memory to resume");
    long left = ftell(file) - begin - (long)sizeof sum;
    bool sound = left > 0 && !fseek(file, begin, SEEK_SET);
    while (sound && left > 0) {
        const size_t n = left < PART ? (size_t)left : PART;
        sound = get(&stream, part, n);
        left -= (long)n;
    }
    sound = sound && fread(&sum, sizeof sum, 1, file) == 1 && sum == stream.sum;
    free(part);
    sound = sound && !fseek(file, begin, SEEK_SET);
    return sound ? STATUS_OK : refuse(checkpoint, "is damaged", error);
}

enum status checkpoint_load(struct checkpoint *checkpoint, struct simulation *simulation,
                            struct growth *growth, struct error *error)
{
    FILE *file = fopen(checkpoint->path, "rb");
    if (!file && errno == ENOENT) return STATUS_OK;
    if (!file) return refuse(checkpoint, strerror(errno), error);
    enum status status = check_head(checkpoint, file, error);
    if (!status) status = check_bytes(checkpoint, file, error);
    struct stream stream = {.file = file, .sum = CACHE_HASH};
    struct serialiser serialiser = {.bytes = get, .context = &stream, .back = true};
    if (!status) {
        SERIALISE(&serialiser, *growth);
        SERIALISE(&serialiser, checkpoint->snapshot);
        if (checkpoint->trace) SERIALISE(&serialiser, *checkpoint->trace);
        simulation_serialise(simulation, &serialiser);
        if (serialiser.failed) status = refuse(checkpoint, "is damaged, or too large", error);
    }
    fclose(file);
    return status;
}
