/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "source.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#ifdef HAVE_ZLIB
#include <zlib.h>
#endif

static const unsigned char hdf5_signature[8] = {0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'};

/* The signature of HDF5 is at byte 0 or, after a user block, at 512, 1024 ... */
static bool is_hdf5(int file)
{
    unsigned char start[sizeof hdf5_signature];
    for (off_t at = 0; pread(file, start, sizeof start, at) == (ssize_t)sizeof start;
         at = at ? 2 * at : 512)
        if (memcmp(start, hdf5_signature, sizeof start) == 0) return true;
    return false;
}

#ifndef HAVE_ZLIB
/* Plain files in place of zlib's. */
typedef FILE *gzFile;
#define gzdopen fdopen
#define gzclose fclose
static int gzread(gzFile from, void *to, unsigned n)
{
    const size_t got = fread(to, 1, n, from);
    return ferror(from) ? -1 : (int)got;
}
#endif

static enum status read_all(struct snapshot_source *source, gzFile from, struct error *error)
{
    enum { FIRST = 1 << 16 };
    for (;;) {
        const size_t chunk = source->size / 2 + FIRST;
        if (source->size >> 20 >= SOURCE_MEGABYTES_MAX)
            return error_set(error, STATUS_BAD_INPUT, "%.200s: too large; allowed: %d megabytes",
                             source->path, SOURCE_MEGABYTES_MAX);
        unsigned char *bytes = realloc(source->bytes, source->size + chunk + 1);
        if (!bytes)
            return error_set(error, STATUS_ENVIRONMENT, "no memory for %.200s", source->path);
        source->bytes = bytes;
        const int got = gzread(from, source->bytes + source->size, (unsigned)chunk);
        if (got < 0)
            return error_set(error, STATUS_BAD_INPUT,
                             "%.200s: cannot be read (damaged, if it is compressed)", source->path);
        source->size += (size_t)got;
        if (got == 0) break;
    }
    source->bytes[source->size] = 0;
    if (source->size == 0)
        return error_set(error, STATUS_BAD_INPUT, "%.200s: the file is empty", source->path);
    /* gives back the room of the last chunk, so that the sanitizers see a step beyond the end */
    unsigned char *bytes = realloc(source->bytes, source->size + 1);
    if (!bytes) return error_set(error, STATUS_ENVIRONMENT, "no memory for %.200s", source->path);
    source->bytes = bytes;
    return STATUS_OK;
}

enum status source_open(struct snapshot_source *source, const char *path, struct error *error)
{
    struct stat about = {0};
    *source = (struct snapshot_source){.path = path};
    const int file = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (file == -1)
        return error_set(error, STATUS_BAD_INPUT, "%.200s: cannot be read: %s", path,
                         strerror(errno));
    fstat(file, &about);
    if (!S_ISREG(about.st_mode)) {
        close(file);
        return error_set(error, STATUS_BAD_INPUT, "%.200s: is %s; allowed: a file", path,
                         S_ISDIR(about.st_mode) ? "a directory" : "no regular file");
    }
    if ((source->hdf5 = is_hdf5(file))) {
        close(file);
        return STATUS_OK;
    }
    gzFile from = gzdopen(file, "rb");
    if (!from) {
        close(file);
        return error_set(error, STATUS_ENVIRONMENT, "no memory for %.200s", path);
    }
    enum status status = read_all(source, from, error);
#ifndef HAVE_ZLIB
    if (!status && source->size >= 2 && source->bytes[0] == 0x1f && source->bytes[1] == 0x8b)
        status =
            error_set(error, STATUS_BAD_INPUT,
                      "%.200s: is compressed, which this program was built without: gunzip it, or "
                      "install zlib1g-dev (Debian) or zlib-devel (Fedora) and build again",
                      path);
#endif
    if (gzclose(from) && !status)
        status = error_set(error, STATUS_BAD_INPUT, "%.200s: is cut off", path);
    return status;
}

void source_free(struct snapshot_source *source)
{
    free(source->bytes);
}
