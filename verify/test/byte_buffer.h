/* SPDX-License-Identifier: GPL-3.0-or-later
 * A buffer in memory that a serialiser writes to and reads from. Include after test.h. */
#pragma once

#include "serialiser.h"

struct byte_buffer {
    unsigned char bytes[1 << 21];
    size_t used, read;
};

static inline bool buffer_put(void *context, void *bytes, size_t n)
{
    struct byte_buffer *kept = context;
    if (n > sizeof kept->bytes - kept->used) return false;
    memcpy(kept->bytes + kept->used, bytes, n);
    kept->used += n;
    return true;
}

static inline bool buffer_take(void *context, void *bytes, size_t n)
{
    struct byte_buffer *kept = context;
    if (n > kept->used - kept->read) return false;
    memcpy(bytes, kept->bytes + kept->read, n);
    kept->read += n;
    return true;
}
