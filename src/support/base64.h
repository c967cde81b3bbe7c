/* SPDX-License-Identifier: GPL-3.0-or-later
 * Bytes as base64, as data in a page are. Internal to pages. */
#pragma once

#include "buffer.h"

void base64_add(struct buffer *to, const unsigned char *bytes, size_t n);
