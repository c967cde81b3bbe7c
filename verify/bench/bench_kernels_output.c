/* SPDX-License-Identifier: GPL-3.0-or-later
 * Costs of kernels and operators as a table and as JSON. */
#include <math.h>
#include <stdio.h>

#include "bench_kernels.h"
#include "bench_loops.h"
#include "result.h"

void bench_kernels_add_json(const struct bench_kernels *result, json_t *document)
{
    json_t *rows = json_array();
    for (size_t i = 0; i < result->count; i++) {
        const struct bench_kernel_row *row = &result->rows[i];
        const bool limit = isfinite(row->limit.ns_per_pair);
        json_array_append_new(
            rows, result_object(
                      "kernel=%s of=%s what=%s dim=%d pairs_per_particle=%g ns_per_particle=%g "
                      "share=%g? ns_per_pair=%g spread=%g ns_per_pair_generic=%g "
                      "ns_per_pair_limit=%p limit_over_this=%p error=%p",
                      row->kernel, row->on_cloud ? "operator" : "solver", row->what, row->dim,
                      row->pairs, row->ns_per_particle, row->share, row->specialised.ns_per_pair,
                      row->specialised.spread, row->generic.ns_per_pair,
                      (void *)(limit ? result_number(row->limit.ns_per_pair) : json_null()),
                      (void *)(limit ? result_number(row->limit.ns_per_pair /
                                                     row->specialised.ns_per_pair)
                                     : json_null()),
                      (void *)(row->on_cloud ? result_number(row->error) : json_null())));
    }
    json_object_set_new(document, "kernels", rows);
}

void bench_kernels_print(const struct bench_kernels *result, const struct table_style *style)
{
    printf("%s%-18s %-22s %3s %7s %9s %6s %9s %7s %10s %9s %7s %10s%s\n", style->bold, "kernel",
           "what", "dim", "pairs", "ns/part.", "share", "ns/pair", "spread", "generic", "limit",
           "of it", "error", style->end);
    for (size_t i = 0; i < result->count; i++) {
        const struct bench_kernel_row *row = &result->rows[i];
        char share[16] = "";
        if (!isnan(row->share)) snprintf(share, sizeof share, "%.0f%%", 100 * row->share);
        printf("%-18s %-22s %3d %7.3g %9.4g %6s %9.3g %6.0f%% %10.3g", row->kernel, row->what,
               row->dim, row->pairs, row->ns_per_particle, share, row->specialised.ns_per_pair,
               100 * row->specialised.spread, row->generic.ns_per_pair);
        if (isfinite(row->limit.ns_per_pair))
            printf(" %9.3g %6.0f%%", row->limit.ns_per_pair,
                   100 * row->limit.ns_per_pair / row->specialised.ns_per_pair);
        else
            printf(" %9s %7s", "-", "-");
        if (row->on_cloud) printf(" %10.2e", row->error);
        printf("\n");
    }
    printf("%sns: CPU time of one thread. step: whole steps of the 1D solver (sound wave, n = "
           "%d), its limit the same arithmetic\nwith neighbours known; density, matrix, force: "
           "these loops one by one. In 2D and 3D evaluation: search and sums of\n4096 jittered "
           "particles, h of the kernel's default; share: of the evaluation of its scheme "
           "(search and density:\nstandard; default: the solver's own scheme); limit of search: "
           "distances of all points in cells of that width; of\ndensity: arithmetic of the "
           "operator standard, of the matrix: of linear_exact, of the force: twice that of "
           "standard; of\nthe evaluation: the sum. Others: gradient operators on 4096 jittered "
           "points, search included, h = 2.4 spacings; their\nlimit is the same arithmetic on "
           "one contiguous array. generic: every choice and the kernel behind a pointer. "
           "error:\nrms of a smooth field's gradient error, times h/max|f|.%s\n",
           style->faint, BENCH_LOOPS_PARTICLES, style->end);
}
