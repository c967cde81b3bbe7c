/* SPDX-License-Identifier: GPL-3.0-or-later
 * Base64 encoding, for data in pages and in XML of VTK. */
#pragma once

#include "buffer.h"

void base64_add(struct buffer *to, const unsigned char *bytes, size_t n);
