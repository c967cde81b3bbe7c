/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests that text tables in every style are read to the last bit. */
#include "test.h"

#include "drawn_table.h"
#ifdef HAVE_ZLIB
#include <zlib.h>
#endif

/* ---- styles ---- */

TEST(random_styles)
{
    for (int draw = 0; draw < 300; draw++) {
        struct table t = table_of(1 + draw % 3, false);
        random_style(&t);
        if (draw % 2) shuffle(&t);
        for (size_t c = 0; c < t.columns; c++)
            if (t.meaning[c] == TYPE)
                for (int i = 0; i < 5; i++) t.value[c][i] = 1; /* at least four are gas */
        struct snapshot_file file = reads(&t, NULL);
        assert_string_equal(file.layout, "csv");
        assert_string_equal(file.code, "unknown");
        snapshot_file_free(&file);
    }
}

/* Every column with every name, in any case, and with other characters between. */
TEST(spellings)
{
    for (int c = 0; c < SNAPSHOT_COLUMNS; c++)
        for (int k = 0; k < 7; k++) {
            struct table t = table_of(3, true);
            t.columns -= 2; /* without types and entropy */
            snprintf(t.name[c], sizeof t.name[c], "%s", spelt[c][k]);
            struct snapshot_file file = reads(&t, NULL);
            snapshot_file_free(&file);
        }
    static const char *const nobody[] = {"xx",   "rhoo",     "rh",      "",    "velocity_w",
                                         "vxyz", "internal", "_",       "mas", "[x]",
                                         "v[0]", "rho(x)",   "rhoo [g]"};
    static const struct {
        const char *name;
        int column;
    } units[] = {{"x [cm]", SNAPSHOT_X},
                 {"rho[g/cm^3]", SNAPSHOT_RHO},
                 {"v(x)", SNAPSHOT_VX},
                 {"P (erg)", SNAPSHOT_P},
                 {"vel (km/s)", SNAPSHOT_VX}};
    for (size_t k = 0; k < sizeof units / sizeof *units; k++)
        assert_int_equal(snapshot_column_of(units[k].name), units[k].column);
    for (size_t k = 0; k < sizeof nobody / sizeof *nobody; k++)
        assert_int_equal(snapshot_column_of(nobody[k]), -1);
    assert_int_equal(snapshot_column_of(&" (x)"[1]), SNAPSHOT_X); /* without a name */
    char word[80] = "internalenergyinternalenergyinternalenergyinternalenergy";
    assert_int_equal(snapshot_column_of(word), -1);
    memset(word, ' ', 70), strcpy(word + 70, "u"); /* blanks do not count */
    assert_int_equal(snapshot_column_of(word), SNAPSHOT_U);
}

/* Units beside names are not part of them; a note says that they are not converted. */
TEST(units)
{
    static const char *const said[] = {"such as (km/s):", "such as (pc):", "such as ():"};
    static const char *const heads[] = {"# x [kpc] rho [g cm^-3]  v (km/s) m P\n",
                                        "# x (pc),rho [g],v [km/s],m,P\n", "x [] rho v () m P\n"};
    for (size_t k = 0; k < 3; k++) {
        char text[400], mark = k == 1 ? ',' : ' ';
        int n = snprintf(text, sizeof text, "%s", heads[k]);
        for (int i = 0; i < 5; i++)
            n += snprintf(text + n, sizeof text - (size_t)n, "%d%c2%c3%c4%c5\n", i, mark, mark,
                          mark, mark);
        struct snapshot_file file = file_of(text, (size_t)n, NULL);
        assert_true(file.n == 5 && file.column[SNAPSHOT_X][4] == 4 &&
                    file.column[SNAPSHOT_RHO][4] == 2 && file.column[SNAPSHOT_VX][4] == 3 &&
                    file.column[SNAPSHOT_M][4] == 4 && file.column[SNAPSHOT_P][4] == 5);
        noted(&file, "units", "not converted", said[k]);
        snapshot_file_free(&file);
    }
}

/* A name may begin with a bracket, or with bytes like those of the mark before a text. */
TEST(odd_names)
{
    static const char *const heads[] = {"(a) ", "[0] ", "\xef\xbb\xaf ", "a,(b),", "(b),a,"};
    for (size_t k = 0; k < sizeof heads / sizeof *heads; k++) {
        const bool marked = strchr(heads[k], ',');
        char text[400];
        int n =
            snprintf(text, sizeof text, marked ? "%sx,v,m,rho,P\n" : "%sx v m rho P\n", heads[k]);
        for (int i = 0; i < 5; i++)
            n += snprintf(text + n, sizeof text - (size_t)n,
                          marked ? "8,9,%d,2,3,4,5\n" : "9 %d 2 3 4 5\n", i);
        struct snapshot_file file = file_of(text, (size_t)n, NULL);
        assert_true(file.column[SNAPSHOT_X][4] == 4 && file.column[SNAPSHOT_RHO][4] == 4);
        noted(&file, "units", NULL, "");
        snapshot_file_free(&file);
    }
}

/* ---- values in comments ---- */

#define ZEROS                                                                                      \
    "0000000000000000000000000000000000000000000" /* so many that with four letters more they are  \
                                                     47 */

TEST(values_in_comments)
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
        {"# box = 2e9 3e9 4e9\n# box = 2e9 3e9 4e9\n", false, false, true, 0, 0, {2e9, 3e9, 4e9}},
        {"# t = 0.25 gamma : 1.5\n# t = 0.25 gamma = 1.5\n", true, true, false, 0.25, 1.5, {0}},
        {"# # time : 0.25\n# box = 2e9, 3e9\n", true, false, true, 0.25, 0, {2e9, 3e9, 0}},
        {"# time = 0.2501\n# t = 0.25\n# time 0.25\n", true, false, false, 0.25, 0, {0}},
        {"# time = 0.25 s\n# gammas = 2\n# Box = 2\n# box = a\n", false, false, false, 0, 0, {0}},
        {"# box of 7\n# times = 2\n# gamma =\n# =\n#\n# 7\n", false, false, false, 0, 0, {0}},
        /* in the free text of a comment */
        {"# Sod at t = 0.25, Gamma: 3/2\n", true, true, false, 0.25, 1.5, {0}},
        {"#Time: 0.25  gamma=1.5 #\n# dt = 3; my_t = 4\n", true, true, false, 0.25, 1.5, {0}},
        {"# box = 2.0000000005e9\n# box = 2e9\n", false, false, true, 0, 0, {2e9, 2e9, 2e9}},
        {"# n = 7,TIME=0.25;T=0.25\n# t_end = 9\n", true, false, false, 0.25, 0, {0}},
        {"# at t = 0.25 s, gamma = 5/0\n# time = 1/2/3, gamma = /2\n",
         false,
         false,
         false,
         0,
         0,
         {0}},
        {"# t = 0.25 = a quarter\n", false, false, false, 0, 0, {0}},
        {"# at t = " ZEROS "0.25,\n# at gamma = " ZEROS "001.5,\n",
         true,
         false,
         false,
         0.25,
         0,
         {0}},
        {"# keys = gamma=1.5;t=3\n", false, false, false, 0, 0, {0}},
        {"# gamma = 1e400\n# time = nan\n# a_very_long_key_indeed = 3\n",
         false,
         false,
         false,
         0,
         0,
         {0}},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        for (int dim = 1; dim <= 3; dim++) {
            struct table t = table_of(dim, true);
            t.columns -= 2;
            snprintf(t.head, sizeof t.head, "%s", rows[k].head);
            if (rows[k].boxed && rows[k].box[2] == 0 && dim > 2) continue;
            struct snapshot_file file = reads(&t, NULL);
            assert_true(file.time.known == rows[k].timed && file.time.value == rows[k].time);
            assert_true(file.gamma.known == rows[k].known && file.gamma.value == rows[k].gamma);
            noted(&file, "gamma", rows[k].known ? "in the file" : NULL, "its line '");
            assert_true(file.boxed == rows[k].boxed);
            for (int d = 0; d < dim; d++) assert_true(file.box[d] == rows[k].box[d]);
            snapshot_file_free(&file);
        }
    /* corners and the notes of our own snapshots, before the names of the columns or after them */
    static const struct {
        const char *box;
        int count; /* number of directions; 0: invalid */
        double corner[3], length[3];
    } ends[] = {{"-1:3", 1, {-1}, {4}},
                {"-1:3 0:0.5", 2, {-1, 0}, {4, 0.5}},
                {"-1:3, 0:0.5,\t2:2.25", 3, {-1, 0, 2}, {4, 0.5, 0.25}},
                {"-1.000000001:2.999999999\n# box = -1:3", 1, {-1}, {4}},
                {":", 0, {0}, {0}}};
    for (size_t k = 0; k < sizeof ends / sizeof *ends; k++)
        for (int behind = 0; behind < 2; behind++) {
            static char text[TEXT_MAX], other[TEXT_MAX];
            struct table t = table_of(1, true);
            char head[300];
            t.columns -= 2;
            snprintf(head, sizeof head,
                     "# box\n# case\n# case = my tube.ini\n# case = my tube.ini\n# boundary = open "
                     "fixed\n# keys "
                     "= n=3; eta=2\n# box = %s\n",
                     ends[k].box);
            if (!behind) strcpy(t.head, head);
            size_t size = text_of(&t, text, -1, -1, NULL);
            const size_t line = (size_t)(strchr(text, '\n') + 1 - text);
            if (behind) { /* the names, the notes, the rows */
                memcpy(other, text, line);
                size_t at = line + (size_t)sprintf(other + line, "%s", head);
                memcpy(other + at, text + line, size - line);
                memcpy(text, other, size += at - line);
            }
            struct snapshot_file file = file_of(text, size, NULL);
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
    for (int more = 0; more < 2; more++) { /* a box of 160 characters or more is not read */
        struct table t = table_of(2, true);
        t.columns -= 2;
        snprintf(t.head, sizeof t.head, "# box = 0:1%*s\n", 156 + more, "0:2");
        if (more) {
            static char text[TEXT_MAX];
            refuses(text, text_of(&t, text, -1, -1, NULL), NULL, ":1: '# box = 0:1 ");
            continue;
        }
        struct snapshot_file file = reads(&t, NULL);
        assert_true(file.boxed && file.box[1] == 2);
        snapshot_file_free(&file);
    }
    static const char *const boxes[] = {"# box = 0\n",      "# box = 0 1 1\n",
                                        "# box = -1\n",     "# box = 1 0\n",
                                        "# box = 1 2 -3\n", "# box = 0:1 0:1 -1e308:1e308\n"};
    for (size_t k = 0; k < sizeof boxes / sizeof *boxes;
         k++) { /* only the directions of the particles count */
        static char text[TEXT_MAX];
        struct table t = table_of(3, true);
        snprintf(t.head, sizeof t.head, "%s", boxes[k]);
        refuses(text, text_of(&t, text, -1, -1, NULL), NULL, "; allowed: finite, above 0");
    }
    /* contradictions, with both lines, and values that our own snapshots never have */
    static const struct {
        const char *head, *says;
    } wrong[] = {
        {"# time = 0.2\n# time = 0.1\n", ":2: '# time = 0.1'; allowed: one value, but line 1"},
        {"#\n# time = 0.2\n#\n# Sod at t: 0.1\n", ":4: '# Sod at t: 0.1'; allowed: one value, but "
                                                  "line 2 says another"},
        {"# time = 0.2, t = 0.3\n", ":1: '# time = 0.2, t = 0.3'; allowed: one value, but line 1"},
        {"# gamma = 5/3\n# gamma = 1.4\n", ":2: '# gamma = 1.4'; allowed: one value, but line 1"},
        {"# box = 2\n# box = 2\n# box = 1\n", ":3: '# box = 1'; allowed: one value, but line 1"},
        {"# box = 2\n# box = 2 1\n", ":2: '# box = 2 1'; allowed: one value, but line 1"},
        {"# box = 0:2\n# box = 2\n", ":2: '# box = 2'; allowed: one value, but line 1"},
        {"# box = 0:2\n# box = -1:1\n", ":2: '# box = -1:1'; allowed: one value, but line 1"},
        {"# box = 2 3 4\n# box = 2 3 5\n", ":2: '# box = 2 3 5'; allowed: one value, but line 1"},
        {"# box = 2 3 4\n# box = 2 5 4\n", ":2: '# box = 2 5 4'; allowed: one value, but line 1"},
        {"# box = 0:2 0:2 0:2\n# box = 0:2 0:2 1:3\n", ":2: '# box = 0:2 0:2 1:3'; allowed: one"},
        {"# box = 0:2 0:2 0:2\n# box = 0:2 1:3 0:2\n", ":2: '# box = 0:2 1:3 0:2'; allowed: one"},
        {"# box = 2\n# box = 2.0000001\n", ":2: '# box = 2.0000001'; allowed: one value"},
        {"# box = 0:2\n# box = 1e-7:2.0000001\n", ":2: '# box = 1e-7:2.0000001'; allowed: one"},
        {"# box = 1 1e9\n# box = 1.5 1e9\n", ":2: '# box = 1.5 1e9'; allowed: one value"},
        {"# box = 0:1 0:1e9\n# box = 0.5:1.5 0:1e9\n", ":2: '# box = 0.5:1.5 0:1e9'; allowed"},
        {"# box = 0:2 0:1\n# box = 2 1\n", ":2: '# box = 2 1'; allowed: one value, but line 1"},
        {"# case = sod\n# case = lax\n", ":2: '# case = lax'; allowed: one value, but line 1"},
        {"# boundary = open\n# boundary = fixed\n", ":2: '# boundary = fixed'; allowed: one value"},
        {"# keys = n=3\n# keys = n=4\n", ":2: '# keys = n=4'; allowed: one value, but line 1"},
        {"# time = 0,2\n", ":1: '# time = 0,2'; allowed: a decimal point, such as 0.2"},
        {"#\n# Sod, gamma: 1,4; t = 3\n", ":2: '# Sod, gamma: 1,4; t = 3'; allowed: a decimal"},
        {"# box = 0,2\n", ":1: '# box = 0,2'; allowed: lengths such as 2 or 2 1 1"},
        {"# box = 0,5 1,5\n", ":1: '# box = 0,5 1,5'; allowed: lengths"},
        {"# box = 0:1,5\n", ":1: '# box = 0:1,5'; allowed: lengths"},
        {"# box = 1 2 3 4\n", ":1: '# box = 1 2 3 4'; allowed: lengths"},
        {"# box = -1:3 0:0.5 2:3 4:5\n", "allowed: lengths"},
        {"# box = -1:3 0\n", "allowed: lengths"},
        {"# box = 1:a\n", "allowed: lengths"},
    };
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        static char text[TEXT_MAX];
        struct table t = table_of(1, true);
        snprintf(t.head, sizeof t.head, "%s", wrong[k].head);
        refuses(text, text_of(&t, text, -1, -1, NULL), NULL, wrong[k].says);
    }
    static const struct {
        const char *head, *line; /* NULL: no note */
    } units[] = {{"#\n# time = 0.2 s\n# gamma = 2 g\n", "line 2"},
                 {"# Sod, gamma = 5/0\n", "line 1"},
                 {"# time = unknown\n", NULL},
                 {"# dt = 0,2 s\n", NULL}};
    for (size_t k = 0; k < sizeof units / sizeof *units; k++) {
        struct table t = table_of(1, true);
        t.columns -= 2;
        snprintf(t.head, sizeof t.head, "%s", units[k].head);
        struct snapshot_file file = reads(&t, NULL);
        noted(&file, "not taken", units[k].line, "allowed: a number, and no unit behind it");
        snapshot_file_free(&file);
    }
    char longest[1300];
    for (int more = 0; more < 2; more++) { /* comments of 1200 characters or more are not read */
        struct table t = table_of(1, true);
        t.columns -= 2;
        memset(longest, ' ', sizeof longest);
        memcpy(longest, "# time = 0.25", 13);
        longest[1199 + more] = '\0';
        snprintf(t.head, sizeof t.head, "%s\n", longest);
        struct snapshot_file file = reads(&t, NULL);
        assert_true(file.time.known == !more);
        snapshot_file_free(&file);
    }
}

/* ---- SPLASH ---- */

TEST(files_of_splash)
{
    static const struct {
        const char *head;
        bool timed;
    } rows[] = {
        {"# a.ascii, created by SPLASH: A tool\n# time:   unit\n#   2.5000000E-01   1.0E+00\n",
         true},
        {"# created by SPLASH\r\n# time:\r\n# 0.25\r\n", true},
        {"# created by SPLASH\n# time:\n#   hot\n", false},
        {"# created by SPLASH\n# time:\n#\n", false},
        {"# created by SPLASH\n# times: a\n#   0.5\n", false},
        {"# created by SPLASH\n", false}};
    for (int draw = 0; draw < 120; draw++) {
        struct table t = table_of(1 + draw % 3, draw % 2);
        const size_t k = (size_t)draw % (sizeof rows / sizeof *rows);
        random_style(&t);
        t.splash = true, t.saved = false, t.separator = ' ', t.exponent = 'E';
        for (size_t c = 0; c < t.columns; c++) {
            if (t.meaning[c] < SNAPSHOT_COLUMNS) strcpy(t.name[c], spelt[t.meaning[c]][drawn(7)]);
            if (t.meaning[c] == TYPE)
                for (int i = 0; i < 5; i++) t.value[c][i] = 1;
        }
        snprintf(t.head, sizeof t.head, "%s", rows[k].head);
        struct snapshot_file file = reads(&t, NULL);
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
    refuses("# created by SPLASH\n# x  vx \n1 hot\n", 34, NULL, ":3: column 2, 'vx'");
    size_t at = (size_t)sprintf(text, "# created by SPLASH\n#");
    for (int c = 0; c < 65; c++) at += (size_t)sprintf(text + at, "  c%d", c);
    at += (size_t)sprintf(text + at, "\n");
    refuses(text, at, NULL, "too many names");
    at = (size_t)sprintf(text, "# created by SPLASH\n#  ");
    memset(text + at, 'n', 48);
    refuses(text, at + 48, NULL, "too long ones");
    refuses(text, at + 47, NULL, "no x");
    /* not on the first line: an ordinary table */
    refuses("# a table\n# created by SPLASH\nx,vx\n1,2\n", 39, NULL, "no m; found: x vx");
    refuses("created by SPLASH\n1\n", 20, NULL, "column 2, 'by'");
}

/* ---- compressed ---- */

TEST(compressed_files)
{
#ifdef HAVE_ZLIB
    static char text[TEXT_MAX], bytes[TEXT_MAX];
    struct table t = table_of(2, true);
    struct error error = {0};
    const struct snapshot_options plain = {0};
    struct snapshot_file file;
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
    refuses(bytes, packed - 3, NULL, "a.txt: is cut off");
    bytes[packed / 2] = (char)(bytes[packed / 2] ^ 1);
    refuses(bytes, packed, NULL, "cannot be read (damaged, if it is compressed)");
#else
    refuses("\x1f\x8b...", 5, NULL, "is compressed");
#endif
}
