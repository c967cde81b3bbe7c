/* SPDX-License-Identifier: GPL-3.0-or-later
 * Gradient league table and kernel certificates. */
#include <math.h>
#include <string.h>

#include "html.h"
#include "page_part.h"

/* A row of any flat object: strings, numbers, and true or false as words. */
static void flat_cell(struct buffer *to, const json_t *value)
{
    if (json_is_boolean(value)) {
        html_cell(to, json_is_true(value) ? "yes" : "no");
    } else if (json_is_null(value)) {
        html_cell(to, "—");
    } else if (json_is_string(value) && isnan(html_real(value)) &&
               strcmp(json_string_value(value), "nan")) {
        buffer_add(to, "<td>");
        html_words(to, json_string_value(value));
        buffer_add(to, "</td>");
    } else {
        html_cell_number(to, html_real(value));
    }
}

static void flat_head(struct buffer *to, const json_t *row)
{
    const char *name;
    const json_t *value;
    struct buffer columns = {0};
    json_object_foreach((json_t *)row, name, value)
    {
        if (columns.size) buffer_add(&columns, "|");
        if (json_is_number(value)) buffer_add(&columns, "#");
        html_words(&columns, name);
    }
    if (columns.data) html_table(to, "league", columns.data);
    buffer_free(&columns);
}

void page_gradients(struct page_writer *writer, const json_t *gradients)
{
    struct buffer *to = &writer->to;
    const json_t *rows = json_object_get(gradients, "rows"), *row, *value;
    const char *name;
    size_t i;
    buffer_add(to,
               "<section id=\"gradients\"><h2>Gradient operators: league table</h2>\n<p>What an "
               "operator gains in exactness on disordered points it pays for in conservation: "
               "an antisymmetric form keeps momentum to round-off, a linearly exact one does "
               "not.</p>\n");
    if (json_array_size(rows)) {
        flat_head(to, json_array_get(rows, 0));
        json_array_foreach(rows, i, row)
        {
            buffer_add(to, "<tr>");
            json_object_foreach((json_t *)row, name, value) flat_cell(to, value);
            buffer_add(to, "</tr>\n");
        }
        html_table_end(to);
    }
    html_command(to, "see it again:", html_string(gradients, "reproduce"));
    buffer_add(to, "</section>\n");
}

static void kernel_row(struct buffer *to, const json_t *kernel)
{
    const json_t *checks = json_object_get(kernel, "checks"), *check;
    size_t i, failed = 0;
    json_array_foreach(checks, i, check) failed += !strcmp(html_string(check, "status"), "fail");
    buffer_add(to, "<tr>");
    html_cell_code(to, html_string(kernel, "kernel"));
    html_cell_number(to, html_member(kernel, "dim"));
    buffer_format(to, "<td>C%.0f</td>", html_member(kernel, "class"));
    html_cell_number(to, fabs(1 - html_member(kernel, "normalisation")));
    html_cell_number(to, html_member2(kernel, "moments", "sigma"));
    const json_t *fourier = json_object_get(kernel, "fourier");
    html_cell_number(to, html_member(fourier, "min"));
    const json_t *negative = json_object_get(fourier, "first_negative_k");
    if (!json_is_number(negative))
        html_cell(to, "never");
    else
        html_cell_number(to, html_real(negative));
    buffer_format(to, "<td class=\"n\">%zu of %zu</td><td>", json_array_size(checks) - failed,
                  json_array_size(checks));
    html_status(to, failed ? "fail" : "pass");
    buffer_add(to, "</td>");
    html_cell_code(to, html_string(kernel, "reproduce"));
    buffer_add(to, "</tr>\n");
}

void page_kernels(struct page_writer *writer, const json_t *kernels)
{
    struct buffer *to = &writer->to;
    const json_t *kernel;
    size_t i;
    buffer_add(to,
               "<section id=\"kernels\"><h2>Kernel certificates</h2>\n<p>A kernel whose Fourier "
               "transform turns negative lets particles pair from some number of neighbours "
               "on; one that never does is safe at any.</p>\n");
    html_table(
        to, "kernels",
        "kernel|#dim|class|#1 − ∫W dV|#sigma/h|#least of the transform|#negative from kh|#hold||"
        "certificate");
    json_array_foreach(kernels, i, kernel) kernel_row(to, kernel);
    html_table_end(to);
    buffer_add(to, "</section>\n");
}
