/* SPDX-License-Identifier: GPL-3.0-or-later
 * VTK XML, an unstructured grid with a vertex for each particle, which ParaView, VTK and meshio
 * read. Numbers are base64 of their bytes, so that no bit is lost. Points and velocity have three
 * components, 0 beyond the dimension. Other point data: mass, density, pressure, internal_energy,
 * smoothing_length (support radius) and particle_spacing, (m/rho)^(1/dim). Field data of the whole
 * run: TimeValue, gamma, ndims, box (lower and upper end along each direction), and case, boundary
 * and keys (see snapshot_writer.h) as character codes, since not all readers support strings. A
 * series is listed in a collection, F.pvd for F.vtu, with the time of each file. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base64.h"
#include "output.h"
#include "snapshot_writer.h"

static const char *const byte_order =
    __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? "LittleEndian" : "BigEndian";

/* The array follows its size in bytes, as in the file. */
struct grid {
    FILE *to;
    uint64_t *size;
    bool failed; /* no memory */
};

static void put(struct grid *grid, const char *type, const char *name, int components,
                uint64_t bytes)
{
    struct buffer text = {0};
    *grid->size = bytes;
    base64_add(&text, (const unsigned char *)grid->size, (size_t)bytes + sizeof *grid->size);
    grid->failed |= text.failed;
    fprintf(grid->to,
            "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" format=\"binary\">\n"
            "%s\n</DataArray>\n",
            type, name, components, text.failed ? "" : text.data);
    buffer_free(&text);
}

static void put_vectors(struct grid *grid, const char *name, size_t n, int dim,
                        const double *const columns[3])
{
    double *to = (double *)(grid->size + 1);
    for (size_t i = 0; i < n; i++)
        for (int d = 0; d < 3; d++) *to++ = d < dim ? columns[d][i] : 0;
    put(grid, "Float64", name, 3, 3 * n * sizeof *to);
}

static void put_points(struct grid *grid, const struct snapshot *s, int dim)
{
    double *to = (double *)(grid->size + 1);
    const struct {
        const char *name;
        const double *values;
    } scalars[] = {{"mass", s->m},
                   {"density", s->rho},
                   {"pressure", s->P},
                   {"internal_energy", s->u},
                   {"smoothing_length", s->h}};
    fprintf(grid->to, "<PointData Scalars=\"density\" Vectors=\"velocity\">\n");
    put_vectors(grid, "velocity", s->n, dim, s->v);
    for (size_t k = 0; k < sizeof scalars / sizeof *scalars; k++) {
        memcpy(to, scalars[k].values, s->n * sizeof *to);
        put(grid, "Float64", scalars[k].name, 1, s->n * sizeof *to);
    }
    for (size_t i = 0; i < s->n; i++) to[i] = pow(s->m[i] / s->rho[i], 1.0 / dim);
    put(grid, "Float64", "particle_spacing", 1, s->n * sizeof *to);
    fprintf(grid->to, "</PointData>\n<Points>\n");
    put_vectors(grid, "Points", s->n, dim, s->x);
    fprintf(grid->to, "</Points>\n");
}

static void put_cells(struct grid *grid, size_t n)
{
    enum { VERTEX = 1 };
    int64_t *to = (int64_t *)(grid->size + 1);
    fprintf(grid->to, "<Cells>\n");
    for (size_t i = 0; i < n; i++) to[i] = (int64_t)i;
    put(grid, "Int64", "connectivity", 1, n * sizeof *to);
    for (size_t i = 0; i < n; i++) to[i]++;
    put(grid, "Int64", "offsets", 1, n * sizeof *to);
    memset(to, VERTEX, n);
    put(grid, "UInt8", "types", 1, n);
    fprintf(grid->to, "</Cells>\n");
}

static void put_text(FILE *to, const struct snapshot_remark *remark)
{
    fprintf(to, "<DataArray type=\"UInt8\" Name=\"%s\" NumberOfTuples=\"%zu\" format=\"ascii\">",
            remark->key, strlen(remark->value));
    for (const char *c = remark->value; *c; c++) fprintf(to, "%d ", (unsigned char)*c);
    fprintf(to, "</DataArray>\n");
}

static void put_numbers(FILE *to, const char *type, const char *name, int n, const double *values)
{
    fprintf(to, "<DataArray type=\"%s\" Name=\"%s\" NumberOfTuples=\"%d\" format=\"ascii\">", type,
            name, n);
    for (int i = 0; i < n; i++) fprintf(to, "%.17g ", values[i]);
    fprintf(to, "</DataArray>\n");
}

static void put_fields(FILE *to, const struct run_result *result)
{
    const struct domain *domain = &result->problem.domain;
    const double dim = domain->dim;
    double ends[6];
    struct snapshot_remark remarks[SNAPSHOT_REMARKS];
    const size_t count = snapshot_remarks(result, remarks);
    for (int d = 0; d < domain->dim; d++)
        ends[2 * d] = domain->lo[d], ends[2 * d + 1] = domain->hi[d];
    fprintf(to, "<FieldData>\n");
    put_numbers(to, "Float64", "TimeValue", 1, &result->time);
    put_numbers(to, "Float64", "gamma", 1, &result->problem.gamma);
    put_numbers(to, "Int32", "ndims", 1, &dim);
    put_numbers(to, "Float64", "box", 2 * domain->dim, ends);
    for (size_t k = 0; k < count; k++)
        if (!strcmp(remarks[k].key, "case") || !strcmp(remarks[k].key, "boundary") ||
            !strcmp(remarks[k].key, "keys"))
            put_text(to, &remarks[k]);
    fprintf(to, "</FieldData>\n");
}

static enum status write_vtu(const struct run_result *result, const char *path, struct error *error)
{
    const struct snapshot *s = &result->snapshot;
    struct output output;
    struct grid grid = {.size = malloc(sizeof *grid.size + 3 * s->n * sizeof(double))};
    if (!grid.size) return error_set(error, STATUS_ENVIRONMENT, "no memory for %.200s", path);
    if (output_open(&output, path, error)) {
        free(grid.size);
        return error->status;
    }
    grid.to = output.stream;
    fprintf(grid.to,
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
            "byte_order=\"%s\" header_type=\"UInt64\">\n<UnstructuredGrid>\n",
            byte_order);
    put_fields(grid.to, result);
    fprintf(grid.to, "<Piece NumberOfPoints=\"%zu\" NumberOfCells=\"%zu\">\n", s->n, s->n);
    put_points(&grid, s, result->problem.domain.dim);
    put_cells(&grid, s->n);
    fprintf(grid.to, "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
    free(grid.size);
    if (!grid.failed) return output_close(&output, error);
    output_discard(&output);
    return error_set(error, STATUS_ENVIRONMENT, "no memory for %.200s", path);
}

/* Lists a file, unless it could not be written. */
static void list_file(struct buffer *to, const char *path, double time)
{
    const char *slash = strrchr(path, '/');
    struct stat about;
    if (stat(path, &about) || !S_ISREG(about.st_mode)) return;
    buffer_format(to, "<DataSet timestep=\"%.17g\" file=\"", time);
    buffer_escape(to, slash ? slash + 1 : path);
    buffer_add(to, "\"/>\n");
}

static enum status collect(const struct run_result *result, const struct snapshots *snapshots,
                           struct error *error)
{
    struct buffer text = {0}, name = {0};
    buffer_format(&text,
                  "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
                  "byte_order=\"%s\">\n<Collection>\n",
                  byte_order);
    for (size_t k = 0; k < snapshots->next; k++)
        list_file(&text, snapshots_path(snapshots, k).text, snapshots_time(snapshots, k));
    list_file(&text, snapshots->path, result->time);
    buffer_add(&text, "</Collection>\n</VTKFile>\n");
    buffer_add_bytes(&name, snapshots->path, strlen(snapshots->path) - strlen(".vtu"));
    buffer_add(&name, ".pvd");
    enum status status = STATUS_OK;
    if (text.failed || name.failed)
        status = error_set(error, STATUS_ENVIRONMENT, "no memory for the collection of %.200s",
                           snapshots->path);
    if (!status) status = output_text(name.data, text.data, error);
    buffer_free(&text), buffer_free(&name);
    return status;
}

const struct snapshot_writer writer_vtu = {
    .member = {"vtu", "XML of VTK, for ParaView; a series with a collection F.pvd: .vtu", ""},
    .endings = ".vtu",
    .memory = 90,
    .write = write_vtu,
    .collect = collect,
};
