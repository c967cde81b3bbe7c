/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tables of text, made with random columns and written in every style: what is planted must be
 * read, to the last bit. What is spoilt at one place must be refused with that place. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <math.h>
#include <string.h>
#include <cmocka.h>

#include "made_notes.h"
#include "made_place.h"
#ifdef HAVE_ZLIB
#include <zlib.h>
#endif

enum { ROWS = 9, TEXT_MAX = 1 << 15, TYPE = SNAPSHOT_COLUMNS, OTHER };

static uint64_t seed = 26;
static unsigned drawn(unsigned below)
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (unsigned)(seed >> 33) % below;
}

static double uniform(void)
{
    return drawn(1u << 30) / (double)(1u << 30);
}

struct table {
    size_t columns;
    int meaning[SNAPSHOT_COLUMNS + 3];
    char name[SNAPSHOT_COLUMNS + 3][40];
    double value[SNAPSHOT_COLUMNS + 3][ROWS];
    /* the style */
    char separator, exponent;
    bool splash, wide, plus, returns, mark, comments, open_end, saved; /* saved: by numpy */
    char head[1400];
};

/* What people write, by the names of the columns. */
static const char *const spelt[SNAPSHOT_COLUMNS][7] = {
    {"x", "X", "pos_x", "Position x", "coordinates", "Pos", "position-x"},
    {"y", "Y", "pos_y", "PositionY", "Coordinates y", "posy", "Y"},
    {"z", "Z", "pos_z", "Position.Z", "coordinatesz", "posz", "Z"},
    {"vx", "v_x", "v", "Velocity", "velocities_x", "VelX", "velocity x"},
    {"vy", "v_y", "VY", "Velocity_y", "velocities_y", "VelY", "velocity y"},
    {"vz", "v_z", "VZ", "Velocity_z", "velocities_z", "VelZ", "velocity z"},
    {"m", "M", "mass", "Masses", "particle mass", "pmass", "Mass"},
    {"rho", "Rho", "density", "Densities", "dens", "RHO", "Density"},
    {"u", "U", "utherm", "internal energy", "InternalEnergies", "specific_internal_energy",
     "energy"},
    {"P", "p", "pressure", "Pressures", "pres", "Pressure", "pres"},
    {"h", "H", "hsml", "smoothing length", "SmoothingLengths", "Hsml", "h"},
    {"ax", "a_x", "acc_x", "acceleration x", "AX", "accx", "ax"},
    {"ay", "a_y", "acc_y", "acceleration y", "AY", "accy", "ay"},
    {"az", "a_z", "acc_z", "acceleration z", "AZ", "accz", "az"},
    {"du", "du/dt", "dudt", "DU", "du_dt", "dU/dt", "du"}};

static struct table table_of(int dim, bool all)
{
    struct table t = {.separator = ',', .exponent = 'e'};
    for (int c = 0; c < OTHER + 1; c++) {
        const int axis = c < SNAPSHOT_M                        ? c % 3
                         : c >= SNAPSHOT_AX && c < SNAPSHOT_DU ? c - SNAPSHOT_AX
                                                               : 0;
        const bool optional = c >= SNAPSHOT_P;
        if (axis >= dim || (optional && !all && drawn(2))) continue;
        t.meaning[t.columns] = c;
        snprintf(t.name[t.columns], sizeof t.name[0], "%s",
                 c < SNAPSHOT_COLUMNS ? snapshot_column_names[c]
                 : c == TYPE          ? "itype"
                                      : "entropy");
        for (int i = 0; i < ROWS; i++) {
            const bool positive = c >= SNAPSHOT_M && c <= SNAPSHOT_H;
            const double value = ldexp(1 + uniform(), (int)drawn(60) - 30);
            t.value[t.columns][i] = c == TYPE ? (double)(1 + drawn(2) * drawn(3))
                                              : (positive || drawn(2) ? value : -value);
        }
        t.columns++;
    }
    return t;
}

static void shuffle(struct table *t)
{
    for (size_t k = t->columns; k > 1; k--) {
        const size_t j = drawn((unsigned)k);
        struct table old = *t;
        t->meaning[k - 1] = old.meaning[j], t->meaning[j] = old.meaning[k - 1];
        memcpy(t->name[k - 1], old.name[j], sizeof old.name[0]);
        memcpy(t->name[j], old.name[k - 1], sizeof old.name[0]);
        memcpy(t->value[k - 1], old.value[j], sizeof old.value[0]);
        memcpy(t->value[j], old.value[k - 1], sizeof old.value[0]);
    }
}

static void random_style(struct table *t)
{
    t->separator = drawn(2) ? ',' : ' ';
    t->exponent = "eEdD"[drawn(4)];
    t->wide = drawn(2), t->plus = drawn(2), t->returns = drawn(2), t->mark = drawn(2);
    t->comments = drawn(2), t->open_end = drawn(2), t->saved = drawn(2);
}

static size_t put_number(char *text, const struct table *t, double value)
{
    char number[40];
    snprintf(number, sizeof number, t->plus ? "%+.16e" : "%.16e", value);
    *strchr(number, 'e') = t->exponent;
    return (size_t)sprintf(text, "%s", number);
}

/* Writes row by row; the number at (row, column) is word, where there is one. */
static size_t text_of(const struct table *t, char *text, int row, int column, const char *word)
{
    const char *end = t->returns ? "\r\n" : "\n", *gap = t->wide ? " \t " : "";
    char *at = text;
    if (t->mark && !t->splash) at += sprintf(at, "\xef\xbb\xbf");
    at += sprintf(at, "%s", t->head);
    if (t->comments && !t->splash) at += sprintf(at, "%s# a comment%s%s", gap, end, end);
    if (t->saved || t->splash) at += sprintf(at, "#");
    for (size_t c = 0; c < t->columns; c++)
        at += sprintf(at, "%s%s%s%.1s", t->splash ? "  " : gap, t->name[c], t->splash ? "" : gap,
                      c + 1 < t->columns && !t->splash ? &t->separator : "");
    at += sprintf(at, "%s", end);
    for (int i = 0; i < ROWS; i++) {
        if (t->comments && i % 3 == 1) at += sprintf(at, "%s%s# more%s", gap, end, end);
        for (size_t c = 0; c < t->columns; c++) {
            at += sprintf(at, "%s", gap);
            at += i == row && (int)c == column ? (size_t)sprintf(at, "%s", word)
                                               : put_number(at, t, t->value[c][i]);
            at += sprintf(at, "%s%.1s", gap, c + 1 < t->columns ? &t->separator : "");
        }
        if (i + 1 < ROWS || !t->open_end) at += sprintf(at, "%s", end);
    }
    return (size_t)(at - text);
}

static void put_file(const char *text, size_t size)
{
    FILE *out = fopen(path_of("a.txt"), "wb");
    assert_true(out && fwrite(text, 1, size, out) == size && fclose(out) == 0);
}

static void is_read(const struct table *t, const struct snapshot_file *file)
{
    size_t order[ROWS], n = 0, gas = ROWS, columns = 0;
    const double *type = NULL;
    for (size_t c = 0; c < t->columns; c++)
        if (t->meaning[c] == TYPE) type = t->value[c];
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < ROWS; i++)
            if (!type ? !pass : (type[i] == 1) == !pass) order[n++] = i;
        if (!pass) gas = n;
    }
    assert_int_equal(file->n, ROWS);
    assert_int_equal(file->gas, gas);
    for (size_t c = 0; c < t->columns; c++) {
        if (t->meaning[c] >= SNAPSHOT_COLUMNS) continue;
        columns++;
        assert_non_null(file->column[t->meaning[c]]);
        for (size_t i = 0; i < ROWS; i++)
            if (file->column[t->meaning[c]][i] != t->value[c][order[i]])
                fail_msg("%s of %zu: %.17g", t->name[c], i, file->column[t->meaning[c]][i]);
    }
    for (int c = 0; c < SNAPSHOT_COLUMNS; c++) columns -= file->column[c] != NULL;
    assert_int_equal(columns, 0);
    assert_true(file->precision[0] < 1.2e-16 && file->precision[1] < 1.2e-16);
}

static void reads(const struct table *t, const char *map, struct snapshot_file *file)
{
    static char text[TEXT_MAX];
    const struct snapshot_options options = {.map = map};
    struct error error = {0};
    put_file(text, text_of(t, text, -1, -1, NULL));
    if (snapshot_read(path_of("a.txt"), &options, file, &error))
        fail_msg("%s\n%s", error.message, text);
    is_read(t, file);
}

static void refuses(const char *text, size_t size, const char *map, const char *says)
{
    const struct snapshot_options options = {.map = map};
    struct snapshot_file file;
    struct error error = {0};
    put_file(text, size);
    const enum status status = snapshot_read(path_of("a.txt"), &options, &file, &error);
    snapshot_file_free(&file);
    if (status != STATUS_BAD_INPUT || !strstr(error.message, says))
        fail_msg("'%s' is not in: %s\n%s", says, error.message, text);
}

/* ---- styles ---- */

static void random_styles(void **state)
{
    (void)state;
    for (int draw = 0; draw < 300; draw++) {
        struct table t = table_of(1 + draw % 3, false);
        struct snapshot_file file;
        random_style(&t);
        if (draw % 2) shuffle(&t);
        for (size_t c = 0; c < t.columns; c++)
            if (t.meaning[c] == TYPE)
                for (int i = 0; i < 5; i++) t.value[c][i] = 1; /* at least four are gas */
        reads(&t, NULL, &file);
        assert_string_equal(file.layout, "csv");
        assert_string_equal(file.code, "unknown");
        snapshot_file_free(&file);
    }
}

/* Every column by every name, in any letters, with what is neither letter nor digit. */
static void spellings(void **state)
{
    (void)state;
    for (int c = 0; c < SNAPSHOT_COLUMNS; c++)
        for (int k = 0; k < 7; k++) {
            struct table t = table_of(3, true);
            struct snapshot_file file;
            t.columns -= 2; /* without types and entropy */
            snprintf(t.name[c], sizeof t.name[c], "%s", spelt[c][k]);
            reads(&t, NULL, &file);
            snapshot_file_free(&file);
        }
    static const char *const nobody[] = {"xx",   "rhoo",     "rh", "",   "velocity_w",
                                         "vxyz", "internal", "_",  "mas"};
    for (size_t k = 0; k < sizeof nobody / sizeof *nobody; k++)
        assert_int_equal(snapshot_column_of(nobody[k]), -1);
    char word[80] = "internalenergyinternalenergyinternalenergyinternalenergy";
    assert_int_equal(snapshot_column_of(word), -1);
    memset(word, ' ', 70), strcpy(word + 70, "u"); /* blanks take no room */
    assert_int_equal(snapshot_column_of(word), SNAPSHOT_U);
}

/* ---- lines that say what columns do not ---- */

static void remarks(void **state)
{
    static const struct {
        const char *head;
        bool timed, known, boxed;
        double time, gamma, box[3];
    } rows[] = {
        {"# time = 0.25\n# gamma = 1.5\n# box = 2e9\n",
         true,
         true,
         true,
         0.25,
         1.5,
         {2e9, 2e9, 2e9}},
        {"#time:0.25\r\n# gamma\t1.5 \t\r\n#box 2e9 3e9 4e9\r\n",
         true,
         true,
         true,
         0.25,
         1.5,
         {2e9, 3e9, 4e9}},
        {"# # time : 0.25\n# box = 2e9, 3e9\n", true, false, true, 0.25, 0, {2e9, 3e9, 0}},
        {"# time = 0.25\n# time = 0.5\n", true, false, false, 0.5, 0, {0}},
        {"# time = 0.25 s\n# gammas = 2\n# Box = 2\n# box = a\n", false, false, false, 0, 0, {0}},
        {"# box = 1 2 3 4\n# times = 2\n# gamma =\n# =\n#\n# 7\n", false, false, false, 0, 0, {0}},
        {"# gamma = 1e400\n# time = nan\n# a_very_long_key_indeed = 3\n",
         false,
         false,
         false,
         0,
         0,
         {0}},
    };
    (void)state;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        for (int dim = 1; dim <= 3; dim++) {
            struct table t = table_of(dim, true);
            struct snapshot_file file;
            t.columns -= 2;
            snprintf(t.head, sizeof t.head, "%s", rows[k].head);
            if (rows[k].boxed && rows[k].box[2] == 0 && dim > 2) continue;
            reads(&t, NULL, &file);
            assert_true(file.time.known == rows[k].timed && file.time.value == rows[k].time);
            assert_true(file.gamma.known == rows[k].known && file.gamma.value == rows[k].gamma);
            noted(&file, "gamma", rows[k].known ? "in the file" : NULL, "its line '");
            assert_true(file.boxed == rows[k].boxed);
            for (int d = 0; d < dim; d++) assert_true(file.box[d] == rows[k].box[d]);
            snapshot_file_free(&file);
        }
    /* corners, and what our own snapshots say, before the names of the columns or behind them */
    static const struct {
        const char *box;
        int count; /* of directions; 0: it is none */
        double corner[3], length[3];
    } ends[] = {{"-1:3", 1, {-1}, {4}},
                {"-1:3 0:0.5", 2, {-1, 0}, {4, 0.5}},
                {"-1:3, 0:0.5,\t2:2.25", 3, {-1, 0, 2}, {4, 0.5, 0.25}},
                {"-1:3 0:0.5 2:3 4:5", 0, {0}, {0}},
                {"-1:3 0", 0, {0}, {0}},
                {"1:a", 0, {0}, {0}},
                {":", 0, {0}, {0}}};
    for (size_t k = 0; k < sizeof ends / sizeof *ends; k++)
        for (int behind = 0; behind < 2; behind++) {
            static char text[TEXT_MAX], other[TEXT_MAX];
            struct table t = table_of(1, true);
            struct snapshot_file file;
            struct error error = {0};
            const struct snapshot_options plain = {0};
            char head[300];
            t.columns -= 2;
            snprintf(
                head, sizeof head,
                "# case = my tube.ini\n# boundary = open fixed\n# keys = n=3; eta=2\n# box = %s\n",
                ends[k].box);
            if (!behind) strcpy(t.head, head);
            size_t size = text_of(&t, text, -1, -1, NULL);
            const size_t line = (size_t)(strchr(text, '\n') + 1 - text);
            if (behind) { /* the names, what is said, the rows */
                memcpy(other, text, line);
                size_t at = line + (size_t)sprintf(other + line, "%s", head);
                memcpy(other + at, text + line, size - line);
                memcpy(text, other, size += at - line);
            }
            put_file(text, size);
            if (snapshot_read(path_of("a.txt"), &plain, &file, &error))
                fail_msg("%s", error.message);
            is_read(&t, &file);
            assert_string_equal(file.case_name, "my tube.ini");
            assert_string_equal(file.boundary, "open fixed");
            assert_string_equal(file.keys, "n=3; eta=2");
            assert_true(file.boxed == (ends[k].count > 0) && file.placed == file.boxed);
            for (int d = 0; d < ends[k].count; d++)
                assert_true(file.corner[d] == ends[k].corner[d] &&
                            file.box[d] == ends[k].length[d]);
            snapshot_file_free(&file);
        }
    static const char *const boxes[] = {"# box = 0\n", "# box = -1\n", "# box = 1 0\n",
                                        "# box = 1 2 -3\n"};
    for (int k = 0; k < 4; k++) { /* along the directions that there are */
        static char text[TEXT_MAX];
        struct table t = table_of(3, true);
        snprintf(t.head, sizeof t.head, "%s", boxes[k]);
        refuses(text, text_of(&t, text, -1, -1, NULL), NULL, "; allowed: above 0");
    }
    char longest[1300];
    for (int more = 0; more < 2; more++) { /* lines of 1200 letters and more say nothing */
        struct table t = table_of(1, true);
        struct snapshot_file file;
        t.columns -= 2;
        memset(longest, ' ', sizeof longest);
        memcpy(longest, "# time = 0.25", 13);
        longest[1199 + more] = '\0';
        snprintf(t.head, sizeof t.head, "%s\n", longest);
        reads(&t, NULL, &file);
        assert_true(file.time.known == !more);
        snapshot_file_free(&file);
    }
}

/* ---- columns by the user's names ---- */

static void maps(void **state)
{
    struct table t = table_of(1, true);
    struct snapshot_file file;
    static char text[TEXT_MAX];
    (void)state;
    t.columns -= 2;
    for (size_t c = 0; c < t.columns; c++) {
        struct table other = t;
        char map[80];
        snprintf(other.name[c], sizeof other.name[c], "some thing");
        snprintf(map, sizeof map, "%s=some thing", snapshot_column_names[t.meaning[c]]);
        reads(&other, map, &file);
        snapshot_file_free(&file);
    }
    struct table swapped = t; /* rho and P, each by the other's name */
    size_t rho = 0, P = 0;
    for (size_t c = 0; c < t.columns; c++) {
        if (t.meaning[c] == SNAPSHOT_RHO) rho = c;
        if (t.meaning[c] == SNAPSHOT_P) P = c;
    }
    strcpy(swapped.name[rho], "P"), strcpy(swapped.name[P], "rho");
    reads(&swapped, "rho=P,P=rho", &file);
    snapshot_file_free(&file);
    const size_t size = text_of(&t, text, -1, -1, NULL);
    refuses(text, size, "rho=Density", "has no column 'Density'; it has 'x' 'vx'");
    refuses(text, size, "rho=rh", "has no column 'rh'");
    refuses(text, size, "rho=rhoo", "has no column 'rhoo'");
    refuses(text, size, "rho", "NAME one of");
    refuses(text, size, "rho,P=P", "NAME one of");
    refuses(text, size, "density=rho", "NAME one of");
    refuses(text, size, "P=P,rho", "NAME one of");
    refuses(text, size, "=rho", "NAME one of");
    for (size_t c = 1; c < t.columns; c++) { /* called twice */
        struct table twice = t;
        char says[80];
        strcpy(twice.name[c], "X");
        snprintf(says, sizeof says, "columns 'x' and 'X' both look like x");
        refuses(text, text_of(&twice, text, -1, -1, NULL), NULL, says);
    }
    struct table unknown = t;
    strcpy(unknown.name[0], "entropy"), strcpy(unknown.name[1], "entropy");
    refuses(text, text_of(&unknown, text, -1, -1, NULL), NULL, "no x; found: m rho u P");
}

/* ---- faults at one place ---- */

static void spoilt(void **state)
{
    static const char *const words[] = {
        "hot",  "nan",  "inf", "-",     "1e400",
        "1..2", "0x10", "1e",  "\"1\"", "1.00000000000000000000000000000000000000000000001",
        "1;2"};
    static char text[TEXT_MAX];
    (void)state;
    for (int draw = 0; draw < 220; draw++) {
        struct table t = table_of(1 + draw % 3, true);
        char says[80];
        t.separator = draw % 2 ? ',' : ' ';
        t.wide = draw / 2 % 2, t.comments = draw / 4 % 2, t.returns = draw / 8 % 2;
        const int row = (int)drawn(ROWS), column = (int)drawn((unsigned)t.columns);
        const char *word = words[draw % (int)(sizeof words / sizeof *words)];
        snprintf(says, sizeof says, ":%d: column %d, '%s': no number",
                 2 + row + (t.comments ? 2 + 2 * ((row + 2) / 3) : 0), column + 1, t.name[column]);
        refuses(text, text_of(&t, text, row, column, word), NULL, says);
        if (t.separator == ',') refuses(text, text_of(&t, text, row, column, ""), NULL, says);
        const bool next = t.separator == ',' && column + 1 < (int)t.columns;
        if (next)
            snprintf(says, sizeof says, "column %d, '%s': no number", column + 2,
                     t.name[column + 1]);
        else
            snprintf(says, sizeof says, "more than %zu numbers", t.columns);
        refuses(text, text_of(&t, text, row, column, "1 2"), NULL, says);
    }
    for (int c = 0; c < 2; c++) { /* a line that is too short */
        struct table t = table_of(2, true);
        t.separator = c ? ',' : ' ', t.open_end = true;
        size_t size = text_of(&t, text, -1, -1, NULL);
        while (text[size - 1] != t.separator) size--;
        refuses(text, size, NULL, "no number (or a row that is too short)");
        refuses(text, size - 1, NULL, "no number (or a row that is too short)");
    }
}

static void heads(void **state)
{
    static const struct {
        const char *text, *says;
    } rows[] = {
        {"1,2\n3,4\n", "'1' is a number"},
        {"x,1\n3,4\n", "'1' is a number"},
        {"# time = 3\n1 2\n", "'3' is a number"},
        {"#\n1 2\n", "'1' is a number"},
        {"#  \n1 2\n", "no line with the names"},
        {"\n \t\n\r\n", "no line with the names"},
        {"# x vx\n", "no line with the names"},
        {"x,,m\n1,2,3\n", "of 1 to 47 letters"},
        {"x, ,m\n1,2,3\n", "of 1 to 47 letters"},
        {"x,\n1\n", "of 1 to 47 letters"},
        {"x,\r\n1\r\n", "of 1 to 47 letters"},
        {"x,vx\n1,2,\n", ":2: more than 2 numbers"},
        {"x,vx,m,rho,u\n", "0 gas particles"},
        {"x,vx,m,rho,u\n1,2,3,4,5\n2,2,3,4,5\n3,2,3,4,5\n", "3 gas particles; allowed: at least 4"},
        {"x,vx,m,rho,u\n1,2,3,4,5\n1,2,3,4,5\n1,2,3,4,5\n1,2,3,4,5\n",
         "all particles are at one place"},
        {"x\x01,vx\n1,2\n", "no snapshot that is read"},
        {"x\x7f,vx\n1,2\n", "no snapshot that is read"},
        {"\n\x1f\x7f", "no snapshot that is read"}};
    char text[8000] = "";
    (void)state;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        refuses(rows[k].text, strlen(rows[k].text), NULL, rows[k].says);
    for (int more = 0; more < 2; more++) { /* 64 columns, of 47 letters */
        size_t at = 0;
        for (int c = 0; c < 64 + more; c++)
            at += (size_t)sprintf(text + at, "%sc%d", c ? "," : "", c);
        at += (size_t)sprintf(text + at, "\n");
        refuses(text, at, NULL, more ? "at most 64" : "no x");
        memset(text, 'n', 47 + (size_t)more);
        at = 47 + (size_t)more + (size_t)sprintf(text + 47 + more, " x\n");
        refuses(text, at, NULL, more ? "of 1 to 47 letters" : "no vx");
    }
    memset(text, ' ', sizeof text); /* only its beginning is asked whether it is text */
    text[4096] = '\x01';
    refuses(text, 4097, NULL, "no x");
    text[4095] = '\x01';
    refuses(text, 4097, NULL, "no snapshot that is read");
}

/* ---- SPLASH ---- */

static void splash(void **state)
{
    static const struct {
        const char *head;
        bool timed;
    } rows[] = {
        {"# a.ascii, created by SPLASH: A tool\n# time:   unit\n#   2.5000000E-01   1.0E+00\n",
         true},
        {"# created by SPLASH\r\n# time:\r\n# 0.25\r\n", true},
        {"# created by SPLASH\n# time:\n#   hot\n", false},
        {"# created by SPLASH\n# times: a\n#   0.5\n", false},
        {"# created by SPLASH\n", false}};
    (void)state;
    for (int draw = 0; draw < 120; draw++) {
        struct table t = table_of(1 + draw % 3, draw % 2);
        struct snapshot_file file;
        const size_t k = (size_t)draw % (sizeof rows / sizeof *rows);
        random_style(&t);
        t.splash = true, t.saved = false, t.separator = ' ', t.exponent = 'E';
        for (size_t c = 0; c < t.columns; c++) {
            if (t.meaning[c] < SNAPSHOT_COLUMNS) strcpy(t.name[c], spelt[t.meaning[c]][drawn(7)]);
            if (t.meaning[c] == TYPE)
                for (int i = 0; i < 5; i++) t.value[c][i] = 1;
        }
        snprintf(t.head, sizeof t.head, "%s", rows[k].head);
        reads(&t, NULL, &file);
        assert_string_equal(file.layout, "splash");
        assert_string_equal(file.code, "unknown, through SPLASH");
        char value[40];
        snprintf(value, sizeof value, "%zu of %d rows", file.gas, ROWS);
        noted(&file, "gas", file.gas < ROWS ? value : NULL, "1 is gas as SPLASH numbers types");
        assert_true(file.time.known == rows[k].timed &&
                    file.time.value == (rows[k].timed ? 0.25 : 0));
        snapshot_file_free(&file);
    }
    static char text[TEXT_MAX];
    refuses("# created by SPLASH\n# x  vx\n1 hot\n", 33, NULL, ":3: column 2, 'vx'");
    size_t at = (size_t)sprintf(text, "# created by SPLASH\n#");
    for (int c = 0; c < 65; c++) at += (size_t)sprintf(text + at, "  c%d", c);
    at += (size_t)sprintf(text + at, "\n");
    refuses(text, at, NULL, "too many names");
    at = (size_t)sprintf(text, "# created by SPLASH\n#  ");
    memset(text + at, 'n', 48);
    refuses(text, at + 48, NULL, "too long ones");
    refuses(text, at + 47, NULL, "no x");
    /* not on the first line: a table like any other */
    refuses("# a table\n# created by SPLASH\nx,vx\n1,2\n", 39, NULL, "no m; found: x vx");
    refuses("created by SPLASH\n1\n", 20, NULL, "column 2, 'by'");
}

/* ---- compressed ---- */

static void compressed(void **state)
{
#ifdef HAVE_ZLIB
    static char text[TEXT_MAX], bytes[TEXT_MAX];
    struct table t = table_of(2, true);
    struct error error = {0};
    const struct snapshot_options plain = {0};
    struct snapshot_file file;
    (void)state;
    t.columns -= 2;
    const size_t size = text_of(&t, text, -1, -1, NULL);
    gzFile out = gzopen(path_of("a.txt"), "wb");
    assert_true(gzwrite(out, text, (unsigned)size) == (int)size && gzclose(out) == Z_OK);
    if (snapshot_read(path_of("a.txt"), &plain, &file, &error)) fail_msg("%s", error.message);
    is_read(&t, &file);
    snapshot_file_free(&file);
    FILE *in = fopen(path_of("a.txt"), "rb");
    const size_t packed = fread(bytes, 1, sizeof bytes, in);
    fclose(in);
    refuses(bytes, packed - 3, NULL, "");
    bytes[packed / 2] = (char)(bytes[packed / 2] ^ 1);
    refuses(bytes, packed, NULL, "");
#else
    (void)state;
    refuses("\x1f\x8b...", 5, NULL, "is compressed");
#endif
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_styles), cmocka_unit_test(spellings),  cmocka_unit_test(remarks),
        cmocka_unit_test(maps),          cmocka_unit_test(spoilt),     cmocka_unit_test(heads),
        cmocka_unit_test(splash),        cmocka_unit_test(compressed),
    };
    return cmocka_run_group_tests(tests, make_place, remove_place);
}
