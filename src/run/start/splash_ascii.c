/* SPDX-License-Identifier: GPL-3.0-or-later
 * ASCII with the header that SPLASH writes (Price 2007). SPLASH converts it to files for Phantom,
 * NDSPMHD or GADGET; h is half of the support radius. */
#include <string.h>

#include "output.h"
#include "start_format.h"

enum { WIDTH = 24, COLUMNS = 11 };

static void put_names(FILE *to, const char *const *names, int count)
{
    fprintf(to, "# ");
    for (int k = 0; k < count; k++) fprintf(to, "%-*s", WIDTH, names[k]);
    fprintf(to, "\n");
}

static void put_head(FILE *to, const struct run_result *result)
{
    fprintf(
        to,
        "# %s: in the form of files created by SPLASH, by sphproof\n#\n# time:             time "
        "unit ()\n# %.17g %.17g\n#\n# npart:          gas\n# %zu\n#\n",
        *result->case_name ? result->case_name : "particles", result->time, 1., result->n);
}

static enum status write_splash(const struct run_result *result, const char *path,
                                struct error *error)
{
    static const char *const x[] = {"x", "y", "z"}, *const v[] = {"v_x", "v_y", "v_z"};
    const struct snapshot *s = &result->snapshot;
    const int dim = result->problem.domain.dim;
    const char *names[COLUMNS];
    const double *columns[COLUMNS];
    int count = 0;
    struct output output;
    for (int d = 0; d < dim; d++) names[count] = x[d], columns[count++] = s->x[d];
    names[count] = "particle mass", columns[count++] = s->m;
    names[count] = "h", columns[count++] = s->h;
    names[count] = "density", columns[count++] = s->rho;
    for (int d = 0; d < dim; d++) names[count] = v[d], columns[count++] = s->v[d];
    names[count] = "u", columns[count++] = s->u;
    names[count] = "pressure", columns[count++] = s->P;
    if (output_open(&output, path, error)) return error->status;
    put_head(output.stream, result);
    put_names(output.stream, names, count);
    for (size_t i = 0; i < s->n; i++)
        for (int k = 0; k < count; k++)
            fprintf(output.stream, "%*.16e%s", WIDTH, columns[k][i], k + 1 < count ? "" : "\n");
    return output_close(&output, error);
}

static const struct snapshot_writer writer = {.write = write_splash};

const struct start_format start_splash_ascii = {
    .member = {"splash_ascii",
               "ASCII of SPLASH, which makes Phantom's dumps of it; the support is 2 h",
               "Price 2007"},
    .writer = &writer,
    .h_over_support = 0.5,
    .gamma = "Phantom: gamma in the .setup file, or in the dump's header",
    .dimension = "Phantom and SPH-EXA: always 3",
    .box = "Phantom: xmin to zmax in the dump's header",
    .boundary = "Phantom: make PERIODIC=yes",
    .t_end = "Phantom: tmax in the .in file",
};
