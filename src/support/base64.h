/* SPDX-License-Identifier: GPL-3.0-or-later
 * Bytes as base64, as data in a page are. Internal to pages. */
#ifndef SPHPROOF_BASE64_H
#define SPHPROOF_BASE64_H

#include "buffer.h"

void base64_add(struct buffer *to, const unsigned char *bytes, size_t n);

#endif
