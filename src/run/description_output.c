/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run_output.h"

#include <math.h>
#include <stdio.h>

#include "result.h"

json_t *description_json(const struct description_sums *sums)
{
    if (isnan(sums->condition_max) && sums->fallen_back == 0) return json_null();
    return json_pack("{s:{s:o, s:o}, s:{s:o, s:o}, s:I}", "condition", "max",
                     result_number_or_null(sums->condition_max), "mean",
                     result_number_or_null(sums->condition_mean), "angle", "max",
                     result_number_or_null(sums->angle_max), "mean",
                     result_number_or_null(sums->angle_mean), "fallen_back",
                     (json_int_t)sums->fallen_back);
}

void description_text(const struct description_sums *sums, size_t n, char text[DESCRIPTION_TEXT])
{
    int used = 0;
    text[0] = '\0';
    if (!isnan(sums->condition_max))
        used =
            snprintf(text, DESCRIPTION_TEXT,
                     "condition number %.3g (mean %.3g); angle between C x and x %.3g deg (mean "
                     "%.3g)",
                     sums->condition_max, sums->condition_mean, sums->angle_max, sums->angle_mean);
    if (sums->fallen_back > 0)
        snprintf(text + used, DESCRIPTION_TEXT - (size_t)used,
                 "%s%zu of %zu particles with the standard gradient instead", used ? "; " : "",
                 sums->fallen_back, n);
}
