/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "snapshot_writer.h"

#include <stdio.h>
#include <string.h>

#define WRITER(name) extern const struct snapshot_writer writer_##name;
#include "writers.def"
#undef WRITER

static const struct member *const members[] = {
#define WRITER(name) &writer_##name.member,
#include "writers.def"
#undef WRITER
};

const struct family snapshot_writer_family = {
    "writers", "formats of snapshots that are written, by the ending of the file's name", members,
    sizeof members / sizeof *members};

static bool has_word(const char *list, const char *word)
{
    const size_t length = strlen(word);
    for (; *list; list += strspn(list, " ")) {
        const size_t n = strcspn(list, " ");
        if (n == length && strncmp(list, word, n) == 0) return true;
        list += n;
    }
    return false;
}

const struct snapshot_writer *snapshot_writer_of(const char *path, struct error *error)
{
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
    char allowed[128] = "";
    if (!dot) return &writer_csv;
    for (size_t k = 0; k < snapshot_writer_family.n; k++) {
        const struct snapshot_writer *writer =
            (const struct snapshot_writer *)snapshot_writer_family.members[k];
        const size_t used = strlen(allowed);
        if (has_word(writer->endings, dot)) return writer;
        snprintf(allowed + used, sizeof allowed - used, "%s%s", k ? " " : "", writer->endings);
    }
    error_set(error, STATUS_BAD_INPUT,
              "a snapshot '%.150s': ends in '%.20s'; allowed: %s, or no ending for csv", path, dot,
              allowed);
    return NULL;
}

double snapshot_writer_memory(const char *path)
{
    struct error error;
    const struct snapshot_writer *writer = snapshot_writer_of(path, &error);
    return writer ? writer->memory : 0;
}
