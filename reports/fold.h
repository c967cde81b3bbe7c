/* SPDX-License-Identifier: GPL-3.0-or-later
 * Folded parts of a page: their HTML is compressed data (zlib, base64), which a small script in the
 * page inflates when a reader opens them. Without zlib they stand in the page as they are. Internal
 * to pages. */
#ifndef SPHPROOF_FOLD_H
#define SPHPROOF_FOLD_H

#include "buffer.h"

/* What was added to the buffer since `start` becomes a sealed part; it stands directly within a
 * <details> element, which opens it. */
void fold_seal(struct buffer *to, size_t start);

/* What was added since `start` is <section ...><h2>...</h2>...</section>: everything behind its
 * heading is folded and sealed. */
void fold_section(struct buffer *to, size_t start);

/* For the page's end: inflates what is opened, and what a link leads to. */
extern const char fold_script[];

#endif
