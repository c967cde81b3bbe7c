/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests what is refused of files that are read as a whole: too large ones, and any without memory.
 * The linker's --wrap redirects the calls of zlib and of realloc to this file, so that no large
 * file is needed, nor memory for it. */
#include "test.h"

#ifdef HAVE_ZLIB
#include <fcntl.h>
#include <zlib.h>

#include "expected_snapshot.h"
#include "source.h"

static bool opens;
static size_t left; /* bytes of the file; then it is damaged */

gzFile __real_gzdopen(int file, const char *mode);
gzFile __wrap_gzdopen(int file, const char *mode);
gzFile __wrap_gzdopen(int file, const char *mode)
{
    return opens ? __real_gzdopen(file, mode) : NULL;
}

int __wrap_gzread(gzFile from, void *to, unsigned size);
int __wrap_gzread(gzFile from, void *to, unsigned size)
{
    const size_t n = size < left ? size : left;
    (void)from, (void)to;
    left -= n;
    return n ? (int)n : -1;
}

/* Nothing is written into what it returns. */
void *__real_realloc(void *memory, size_t size);
void *__wrap_realloc(void *memory, size_t size);
void *__wrap_realloc(void *memory, size_t size)
{
    return __real_realloc(memory, size ? 1 : 0);
}

static void fails(enum status expected, const char *says)
{
    struct snapshot_source source;
    struct error error = {0};
    const int next = open("/dev/null", O_RDONLY);
    close(next);
    const enum status status = source_open(&source, path_of("a"), &error);
    source_free(&source);
    if (status != expected || !strstr(error.message, says)) fail_msg("%s", error.message);
    const int still = open("/dev/null", O_RDONLY); /* no file stays open */
    close(still);
    assert_int_equal(still, next);
}

TEST(files_as_a_whole)
{
    put_bytes("a", "text", 4);
    fails(STATUS_ENVIRONMENT, "no memory for ");
    opens = true;
    left = ((size_t)SOURCE_MEGABYTES_MAX << 20) - 1;
    fails(STATUS_BAD_INPUT, "cannot be read (damaged, if it is compressed)");
    left = (size_t)SOURCE_MEGABYTES_MAX << 20;
    fails(STATUS_BAD_INPUT, "too large; allowed: 2048 megabytes");
}
#endif
