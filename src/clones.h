/* SPDX-License-Identifier: GPL-3.0-or-later
 * Attributes of the stamped loops. */
#ifndef SPHPROOF_CLONES_H
#define SPHPROOF_CLONES_H

#define ALWAYS_INLINE static inline __attribute__((always_inline))
#define CLONES

#endif
