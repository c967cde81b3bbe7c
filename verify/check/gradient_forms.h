/* SPDX-License-Identifier: GPL-3.0-or-later
 * Gradient operators as subjects of checks: right ones, and right names with wrong flags. */
#pragma once

#include "check.h"
#include "gradient_study.h"

#define FORM(identifier, name, vectors, differs, corrects)                                         \
    __attribute__((unused)) static const struct operator_form identifier = {                       \
        .member = {name, "", ""},                                                                  \
        .pair_vector = vectors,                                                                    \
        .difference = differs,                                                                     \
        .corrected = corrects}
FORM(standard, "standard", VECTOR_GRADIENT, false, false);
FORM(difference, "standard_difference", VECTOR_GRADIENT, true, false);
FORM(ia, "ia", VECTOR_POSITION, false, true);
FORM(corrected, "corrected", VECTOR_GRADIENT, false, true);
FORM(linear_exact, "linear_exact", VECTOR_POSITION, true, true);
FORM(normalised, "normalised_corrected", VECTOR_NORMALISED, true, true);
/* normalised_corrected without subtracting f_i: shows the effect of sum V g = 0 */
FORM(normalised_plain, "normalised_corrected", VECTOR_NORMALISED, false, true);
/* wrong flags */
FORM(difference_without, "standard_difference", VECTOR_GRADIENT, false, false);
FORM(ia_without_matrix, "ia", VECTOR_POSITION, false, false);
FORM(corrected_without_matrix, "corrected", VECTOR_GRADIENT, false, false);
FORM(corrected_weight_of_ia, "corrected", VECTOR_POSITION, false, true);
FORM(linear_without_difference, "linear_exact", VECTOR_POSITION, false, true);
FORM(linear_without_matrix, "linear_exact", VECTOR_POSITION, true, false);
FORM(normalised_without_matrix, "normalised_corrected", VECTOR_NORMALISED, false, false);
FORM(corrected_without_normalisation, "normalised_corrected", VECTOR_GRADIENT, false, true);

/* The right subjects: every operator of the family. */
__attribute__((unused)) static void gradient_subjects(struct check_run *run)
{
    for (size_t i = 0; i < operator_family.n; i++) {
        const struct gradient_subject subject = {
            (const struct operator_form *)operator_family.members[i], NAIVE_NONE};
        check_subject(run, &subject, sizeof subject);
    }
}

#define SUBJECT(form, fault) (&(const struct gradient_subject){&(form), NAIVE_##fault})
