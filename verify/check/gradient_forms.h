/* SPDX-License-Identifier: GPL-3.0-or-later
 * Operators as subjects of checks: right ones, and right names with wrong flags. */
#ifndef SPHPROOF_CHECK_GRADIENT_FORMS_H
#define SPHPROOF_CHECK_GRADIENT_FORMS_H

#include "gradient_study.h"

#define FORM(identifier, name, ...)                                                                \
    __attribute__((unused)) static const struct operator_form identifier = {{name, "", ""},        \
                                                                            __VA_ARGS__}
FORM(standard, "standard", VECTOR_GRADIENT, false, false);
FORM(difference, "standard_difference", VECTOR_GRADIENT, true, false);
FORM(ia, "ia", VECTOR_POSITION, false, true);
FORM(linear_exact, "linear_exact", VECTOR_POSITION, true, true);
FORM(normalised, "normalised_corrected", VECTOR_NORMALISED, true, true);
/* normalised_corrected without subtracting f_i: what sum V g = 0 does is seen */
FORM(normalised_plain, "normalised_corrected", VECTOR_NORMALISED, false, true);
/* wrong flags */
FORM(difference_without, "standard_difference", VECTOR_GRADIENT, false, false);
FORM(ia_without_matrix, "ia", VECTOR_POSITION, false, false);
FORM(linear_without_difference, "linear_exact", VECTOR_POSITION, false, true);
FORM(linear_without_matrix, "linear_exact", VECTOR_POSITION, true, false);
FORM(normalised_without_matrix, "normalised_corrected", VECTOR_NORMALISED, false, false);
FORM(corrected_without_normalisation, "normalised_corrected", VECTOR_GRADIENT, false, true);

#define SUBJECT(form, fault) (&(const struct gradient_subject){&(form), NAIVE_##fault})

#endif
