/* SPDX-License-Identifier: GPL-3.0-or-later
 * Text: a line with the names of the columns, x,vx,m,rho,u,P,h or in 2D and 3D x,y,vx,vy, ...;
 * comment lines `# KEY = VALUE` (see snapshot_writer.h); one line per particle in the initial
 * order. */
#include <stdio.h>

#include "output.h"
#include "snapshot_writer.h"

static enum status write_csv(const struct run_result *result, const char *path, struct error *error)
{
    const struct snapshot *s = &result->snapshot;
    struct output output;
    if (output_open(&output, path, error)) return error->status;
    const int dim = result->problem.domain.dim;
    const double *columns[12];
    int count = 0;
    for (int d = 0; d < dim; d++) columns[count++] = s->x[d];
    for (int d = 0; d < dim; d++) columns[count++] = s->v[d];
    const double *const rest[] = {s->m, s->rho, s->u, s->P, s->h};
    for (size_t k = 0; k < sizeof rest / sizeof *rest; k++) columns[count++] = rest[k];
    static const char *const names[] = {"x,vx", "x,y,vx,vy", "x,y,z,vx,vy,vz"};
    fprintf(output.stream, "%s,m,rho,u,P,h\n", names[dim - 1]);
    struct snapshot_remark remarks[SNAPSHOT_REMARKS];
    const size_t said = snapshot_remarks(result, remarks);
    for (size_t k = 0; k < said; k++)
        fprintf(output.stream, "# %s = %s\n", remarks[k].key, remarks[k].value);
    for (size_t i = 0; i < s->n; i++)
        for (int k = 0; k < count; k++)
            fprintf(output.stream, "%.17g%c", columns[k][i], k + 1 < count ? ',' : '\n');
    return output_close(&output, error);
}

const struct snapshot_writer writer_csv = {
    .member = {"csv", "text, a line a particle: .csv .txt .dat, or no ending", ""},
    .endings = ".csv .txt .dat",
    .write = write_csv,
};
