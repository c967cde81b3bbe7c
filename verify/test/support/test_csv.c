/* SPDX-License-Identifier: GPL-3.0-or-later
 * Reads random tables of numbers in every allowed style: each value must be found, with its line.
 * Tables with one fault must be refused with its position. */
#include "test.h"

#include <stdbool.h>

#include "csv.h"
#include "own_folder.h"

enum { ROWS_MAX = 600, COLUMNS = 5, TEXT_MAX = 1 << 17 };

static uint64_t seed = 26;
static unsigned drawn(unsigned below)
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (unsigned)(seed >> 33) % below;
}

struct table {
    size_t columns, rows;
    double value[COLUMNS][ROWS_MAX];
    size_t line[ROWS_MAX];
    char separator, exponent;
    bool wide, plus, returns, mark, comments, open_end;
    /* one value is replaced, at this position in the text */
    int row, column; /* row -1: a name; -2: none */
    const char *word;
    size_t at_line, at_character;
};

static struct table made(size_t rows)
{
    struct table t = {.columns = 1 + drawn(COLUMNS), .rows = rows, .row = -2};
    for (size_t c = 0; c < COLUMNS; c++)
        for (size_t i = 0; i < rows; i++)
            t.value[c][i] =
                ldexp(1 + drawn(1u << 30) / 1073741824., (int)drawn(60) - 30) * (drawn(2) ? 1 : -1);
    t.separator = ", \t"[drawn(3)], t.exponent = "eEdD"[drawn(4)];
    if (t.columns == 1) t.separator = ' ';
    t.wide = drawn(2), t.plus = drawn(2), t.returns = drawn(2), t.mark = drawn(2);
    t.comments = drawn(2), t.open_end = drawn(2);
    return t;
}

static const char *const names[COLUMNS] = {"x", "particle_mass", "\xce\xb1", "P!", "v1e5"};
static char text[TEXT_MAX];

static size_t put(struct table *t)
{
    const char *gap = t->wide ? " \t" : "", *end = t->returns ? "\r\n" : "\n";
    size_t line = 1;
    char *at = text;
    if (t->mark) at += sprintf(at, "\xef\xbb\xbf");
    if (t->comments) at += sprintf(at, "# a comment, 1%s%s%s", end, gap, end), line += 2;
    for (int i = -1; i < (int)t->rows; i++, line++) {
        const char *from = at;
        if (t->comments && i % 3 == 2)
            at += sprintf(at, "%s#%s%s", gap, end, end), line += 2, from = at;
        for (size_t c = 0; c < t->columns; c++) {
            at += sprintf(at, "%s", gap);
            if (i == t->row && (int)c == t->column) {
                t->at_line = line, t->at_character = (size_t)(at - from) + 1;
                at += sprintf(at, "%s", t->word);
            } else if (i < 0) {
                at += sprintf(at, "%s", names[c]);
            } else {
                char number[40];
                snprintf(number, sizeof number, t->plus ? "%+.16e" : "%.16e", t->value[c][i]);
                *strchr(number, 'e') = t->exponent;
                at += sprintf(at, "%s", number);
                t->line[i] = line;
            }
            at += sprintf(at, "%s%.1s", gap, c + 1 < t->columns ? &t->separator : "");
        }
        if (i + 1 < (int)t->rows || !t->open_end) at += sprintf(at, "%s", end);
    }
    return (size_t)(at - text);
}

static enum status reads(size_t size, struct csv *csv, struct error *error)
{
    FILE *out = fopen(path_of("t.csv"), "wb");
    assert_true(out && fwrite(text, 1, size, out) == size && fclose(out) == 0);
    *error = (struct error){0};
    return csv_read(path_of("t.csv"), csv, error);
}

static void refuses(size_t size, const char *says)
{
    struct csv csv;
    struct error error;
    const enum status status = reads(size, &csv, &error);
    if (status != STATUS_BAD_INPUT || !strstr(error.message, says))
        fail_msg("status %d: '%s' is not in: %s", (int)status, says, error.message);
    csv_free(&csv);
    assert_true(csv.columns == 0 && csv.rows == 0 && !csv.line && !csv.names[0] && !csv.values[0]);
}

static void refuses_text(const char *of, const char *says)
{
    const size_t n = strlen(of);
    memcpy(text, of, n);
    refuses(n, says);
}

TEST(every_style)
{
    static const size_t rows[] = {0, 1, 2, 255, 256, 257, 512, 513, 600, 7};
    for (int draw = 0; draw < 240; draw++) {
        struct table t = made(draw < 40 ? rows[draw % 10] : drawn(12));
        struct csv csv;
        struct error error;
        if (reads(put(&t), &csv, &error)) fail_msg("%s\n%s", error.message, text);
        assert_true(csv.columns == t.columns && csv.rows == t.rows);
        for (size_t c = 0; c < t.columns; c++) {
            assert_string_equal(csv.names[c], names[c]);
            assert_int_equal(csv_column(&csv, names[c]), c);
            for (size_t i = 0; i < t.rows; i++) assert_true(csv.values[c][i] == t.value[c][i]);
        }
        for (size_t i = 0; i < t.rows; i++) assert_int_equal(csv.line[i], t.line[i]);
        assert_int_equal(csv_column(&csv, "nobody"), -1);
        assert_int_equal(csv_column(&csv, ""), -1);
        csv_free(&csv);
    }
}

TEST(wrong_fields)
{
    static const char *const words[] = {"hot",  "nan", "inf", "-",     "1e400", "1..2",
                                        "0x10", "1e",  "1;2", "1d5e3", "d"};
    for (int draw = 0; draw < 154; draw++) {
        struct table t = made(3 + drawn(6));
        char says[600], *path = path_of("t.csv");
        t.row = (int)drawn((unsigned)t.rows), t.column = (int)drawn((unsigned)t.columns);
        t.word = words[draw % 11];
        size_t size = put(&t);
        snprintf(says, sizeof says, "%s:%zu:%zu: '%s' in column '%s' is not a number", path,
                 t.at_line, t.at_character, t.word, names[t.column]);
        refuses(size, says);
        if (t.separator == ',') { /* an empty field; two values in one field */
            t.word = "";
            size = put(&t);
            snprintf(says, sizeof says, ":%zu:", t.at_line);
            refuses(size, says);
            refuses(size, "is not a number");
        }
        t.word = t.separator == ',' ? "1,2" : "1 2";
        size = put(&t);
        snprintf(says, sizeof says, ":%zu:", t.at_line);
        refuses(size, says);
        snprintf(says, sizeof says, "more than %zu values; there are %zu columns", t.columns,
                 t.columns);
        refuses(size, says);
        t.row = -1; /* a name */
        t.word = "-1.5e3";
        size = put(&t);
        snprintf(says, sizeof says, "%s:%zu:%zu: '-1.5e3' is a number", path, t.at_line,
                 t.at_character);
        refuses(size, says);
        if (t.column) {
            t.word = "x";
            size = put(&t);
            snprintf(says, sizeof says, ":%zu:%zu: second column named 'x'", t.at_line,
                     t.at_character);
            refuses(size, says);
        }
        t.word = "\xff";
        size = put(&t);
        snprintf(says, sizeof says, ":%zu:%zu: the name of column %d is not UTF-8", t.at_line,
                 t.at_character, t.column + 1);
        refuses(size, says);
    }
}

TEST(faults_of_whole_files)
{
    static const struct {
        const char *text, *says;
    } rows[] = {{"", ":1:1: the file is empty"},
                {"\n# x\n  \t\n", ":4:1: the file is empty"},
                {"x,\n1,2\n", ":1:3: column 2 has no name"},
                {",x\n", ":1:1: column 1 has no name"},
                {"x,y\n1\n", ":2:1: 1 values; there are 2 columns"},
                {"x y z\n1 2\n", ":2:3: 2 values; there are 3 columns"},
                {"x,y\n1,2,\n", ":2:5: more than 2 values"},
                {"x\ty\n1\t2\t3\n", ":2:5: more than 2 values"},
                {"x\r,y\n", ":1:2: carriage return inside a line"},
                {"x,y\r\r\n", "carriage return inside a line"},
                {"x,y\n1,\x01\n", ":2:3: byte 1: a binary file? allowed: text"},
                {"x,y\n\x7f", ":2:1: byte 127: a binary file?"},
                {"x,y\n1,\x1f", ":2:3: byte 31: a binary file?"}};
    struct csv csv;
    struct error error;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        refuses_text(rows[k].text, rows[k].says);
    static const char *const good[] = {"x y \n 1 2 \n", "x\t y\t\n1 \t2\t\r\n", "x,y\n1 , 2",
                                       "\xef\xbb\xbf# c\nx,y\n1,2\n"};
    for (int k = 0; k < 4; k++) {
        memcpy(text, good[k], strlen(good[k]));
        if (reads(strlen(good[k]), &csv, &error)) fail_msg("%s", error.message);
        assert_true(csv.rows == 1 && csv.columns == 2 && csv.values[0][0] == 1 &&
                    csv.values[1][0] == 2);
        assert_string_equal(csv.names[0], "x");
        assert_string_equal(csv.names[1], "y");
        csv_free(&csv);
    }
    for (int more = 0; more < 2; more++) { /* 256 columns; a line of 65536 characters */
        size_t at = 0;
        for (int c = 0; c < 256 + more; c++)
            at += (size_t)sprintf(text + at, "%sc%d", c ? "," : "", c);
        if (more) {
            refuses(at, "too many columns; allowed: 256");
        } else {
            assert_int_equal(reads(at, &csv, &error), STATUS_OK);
            assert_int_equal(csv.columns, 256);
            csv_free(&csv);
        }
        memset(text, ' ', CSV_LINE_MAX + 1);
        memcpy(text, "x\n", 2);
        text[2 + CSV_LINE_MAX + more] = '\n';
        memset(text + 2, ' ', CSV_LINE_MAX + (size_t)more);
        text[2 + CSV_LINE_MAX - 1] = '7';
        at = 3 + CSV_LINE_MAX + (size_t)more;
        if (more) {
            refuses(at, ":2:65536: line too long; allowed: 65536 characters");
        } else {
            assert_int_equal(reads(at, &csv, &error), STATUS_OK);
            assert_true(csv.rows == 1 && csv.values[0][0] == 7);
            csv_free(&csv);
        }
    }
    char number[80]; /* the longest Fortran numbers */
    for (int more = 0; more < 2; more++) {
        snprintf(number, sizeof number, "x\n1.%0*dd1\n", 59 + more, 0);
        memcpy(text, number, strlen(number));
        const enum status status = reads(strlen(number), &csv, &error);
        assert_int_equal(status, more ? STATUS_BAD_INPUT : STATUS_OK);
        if (!more) assert_true(csv.values[0][0] == 10);
        csv_free(&csv);
    }
    assert_int_equal(csv_read(path_of("no/file"), &csv, &error), STATUS_BAD_INPUT);
    assert_non_null(strstr(error.message, "cannot be read"));
    csv_free(&csv);
    assert_int_equal(csv_read(own_folder, &csv, &error), STATUS_BAD_INPUT);
    assert_non_null(strstr(error.message, "is a directory; allowed: a CSV file"));
    csv_free(&csv);
}
