/* SPDX-License-Identifier: GPL-3.0-or-later
 * No viscosity. */
#ifndef VISCOSITY_NONE_H
#define VISCOSITY_NONE_H

ALWAYS_INLINE struct viscosity_terms none_viscous(const struct pair_numbers *numbers,
                                                  const struct pair_side *i,
                                                  const struct pair_side *j,
                                                  const struct viscosity_pair *pair)
{
    (void)numbers, (void)i, (void)j, (void)pair;
    return (struct viscosity_terms){.scale = 1};
}

#endif
VISCOSITY(none, .member = {"none", "none", ""}, .least_dim = 1, .parameters = "", .none = true)
