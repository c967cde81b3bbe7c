/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the messages about text tables with one fault, which name its position, about wrong
 * mappings of columns, and about legacy VTK files that are refused; and legacy VTK files that are
 * read. */
#include "test.h"

#include <fcntl.h>
#include <float.h>
#include <sys/stat.h>
#include <unistd.h>

#include "drawn_table.h"

/* ---- columns that the user maps ---- */

TEST(user_defined_names)
{
    struct table t = table_of(1, true);
    struct snapshot_file file;
    static char text[TEXT_MAX];
    t.columns -= 2;
    for (size_t c = 0; c < t.columns; c++) {
        struct table other = t;
        char map[80];
        snprintf(other.name[c], sizeof other.name[c], "some thing");
        snprintf(map, sizeof map, "%s=some thing", snapshot_column_names[t.meaning[c]]);
        file = reads(&other, map);
        snapshot_file_free(&file);
    }
    /* the map overrides a column's own name, before or after it */
    for (size_t c = 0; c < t.columns; c++)
        for (int before = 0; before < 2; before++) {
            struct table beside = t;
            const size_t guessed = before ? t.columns : c, meant = before ? c : t.columns;
            char map[80];
            beside.columns++;
            strcpy(beside.name[guessed], t.name[c]), strcpy(beside.name[meant], "some thing");
            beside.meaning[guessed] = OTHER, beside.meaning[meant] = t.meaning[c];
            for (int i = 0; i < ROWS; i++) {
                beside.value[guessed][i] = t.value[c][i];
                beside.value[meant][i] = 1.25 * t.value[c][i];
            }
            snprintf(map, sizeof map, "%s=some thing", snapshot_column_names[t.meaning[c]]);
            file = reads(&beside, map);
            snapshot_file_free(&file);
        }
    struct table swapped = t; /* rho and P exchange names */
    size_t rho = 0, P = 0;
    for (size_t c = 0; c < t.columns; c++) {
        if (t.meaning[c] == SNAPSHOT_RHO) rho = c;
        if (t.meaning[c] == SNAPSHOT_P) P = c;
    }
    strcpy(swapped.name[rho], "P"), strcpy(swapped.name[P], "rho");
    file = reads(&swapped, "rho=P,P=rho");
    snapshot_file_free(&file);
    const size_t size = text_of(&t, text, -1, -1, NULL);
    refuses(text, size, "rho=Density", "has no column 'Density'; it has 'x' 'vx'");
    refuses(text, size, "rho=rh", "has no column 'rh'");
    refuses(text, size, "rho=", "has no column ''");
    refuses(text, size, "rho=rhoo", "has no column 'rhoo'");
    refuses(text, size, "u=u,rho=Den,P=P", "has no column 'Den'; it has");
    refuses(text, size, "rho=rho,rho=P", "--map rho=rho,rho=P: names rho twice; allowed: once");
    refuses(text, size, "rho", "NAME one of");
    refuses(text, size, "rho,P=P", "NAME one of");
    refuses(text, size, "density=rho", "NAME one of");
    refuses(text, size, "P=P,rho", "NAME one of");
    refuses(text, size, "=rho", "NAME one of");
    for (size_t c = 1; c < t.columns; c++) { /* two columns with one name */
        struct table twice = t;
        char says[80];
        strcpy(twice.name[c], "X");
        snprintf(says, sizeof says, "columns 'x' and 'X' both look like x");
        refuses(text, text_of(&twice, text, -1, -1, NULL), NULL, says);
        if (t.meaning[c] != OTHER) continue;
        file = reads(&twice, "x=x"); /* the map says which one is meant */
        snapshot_file_free(&file);
    }
    struct table typed = table_of(1, true);
    strcpy(typed.name[0], "itype");
    refuses(text, text_of(&typed, text, -1, -1, NULL), NULL, "two columns are called 'itype'");
    char map[80], says[80]; /* messages quote the beginning of long names */
    for (int more = 0; more < 2; more++) {
        snprintf(map, sizeof map, "rho=%0*d", 40 + more, 0);
        snprintf(says, sizeof says, "has no column '%040d'; it has", 0);
        refuses(text, text_of(&t, text, -1, -1, NULL), map, says);
    }
    struct table unknown = t;
    strcpy(unknown.name[0], "entropy"), strcpy(unknown.name[1], "entropy");
    refuses(text, text_of(&unknown, text, -1, -1, NULL), NULL, "no x; found: m rho u P");
}

/* ---- one wrong value ---- */

TEST(wrong_numbers)
{
    static const char *const words[] = {
        "hot",  "nan",  "inf", "-",     "1e400",
        "1..2", "0x10", "1e",  "\"1\"", "1.0000000000000000000000000000000000000000000001",
        "1;2"};
    static char text[TEXT_MAX];
    for (int draw = 0; draw < 220; draw++) {
        struct table t = table_of(1 + draw % 3, true);
        char says[160];
        t.separator = draw % 2 ? ',' : ' ';
        t.wide = draw / 2 % 2, t.comments = draw / 4 % 2, t.returns = draw / 8 % 2;
        const int row = (int)drawn(ROWS), column = (int)drawn((unsigned)t.columns);
        const char *word = words[draw % (int)(sizeof words / sizeof *words)];
        const int length = snprintf(says, sizeof says, ":%d: column %d, '%s': no number",
                                    2 + row + (t.comments ? 2 + 2 * ((row + 2) / 3) : 0),
                                    column + 1, t.name[column]);
        snprintf(says + length, sizeof says - (size_t)length, ": '%.47s'", word);
        const bool impossible = word == words[1] || word == words[2] || word == words[4];
        assert_true(refuses(text, text_of(&t, text, row, column, word), NULL, says) == impossible);
        says[length] = '\0';
        if (t.separator == ',') refuses(text, text_of(&t, text, row, column, ""), NULL, says);
        const bool next = t.separator == ',' && column + 1 < (int)t.columns;
        if (next)
            snprintf(says, sizeof says, "column %d, '%s': no number", column + 2,
                     t.name[column + 1]);
        else
            snprintf(says, sizeof says, "more than %zu numbers", t.columns);
        refuses(text, text_of(&t, text, row, column, "1 23"), NULL, says);
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

/* Of any particle, including the first and the last. */
TEST(values)
{
    static char text[TEXT_MAX];
    struct table t = table_of(3, true);
    t.columns -= 2;
    for (size_t c = 0; c < t.columns; c++)
        for (int row = 0; row < ROWS; row += ROWS - 1)
            for (int sign = -1; sign <= 1; sign += 2) {
                struct table wrong = t;
                char says[80];
                wrong.value[c][row] = sign * 1e100;
                snprintf(says, sizeof says,
                         "%s of particle %d is %s; allowed: ", snapshot_column_names[t.meaning[c]],
                         row, sign < 0 ? "-1e+100" : "1e+100");
                assert_true(refuses(text, text_of(&wrong, text, -1, -1, NULL), NULL, says));
            }
    for (size_t c = 0; c < t.columns; c++) {
        if (t.meaning[c] == SNAPSHOT_P) {
            struct table wrong = t;
            wrong.value[c][ROWS - 1] = -1;
            assert_true(
                refuses(text, text_of(&wrong, text, -1, -1, NULL), NULL, "P of particle 8"));
        }
        if (t.meaning[c] == SNAPSHOT_VX) t.value[c][0] = 9.9e99;
    }
    struct snapshot_file file = reads(&t, NULL);
    assert_true(file.precision[0] == DBL_EPSILON / 2 && file.precision[1] == DBL_EPSILON / 2);
    snapshot_file_free(&file);
}

/* The number with the most digits decides, of positions and of fields; zeros behind it count, those
 * before it and the exponent do not. Up to four digits are exact, and more than 15 are a double. */
TEST(digits)
{
    static const char *const written[] = {"1.5",
                                          "-0.00250",
                                          "1.2500e+10",
                                          ".001234",
                                          "12345",
                                          "-0.123450",
                                          "1.234567d-07",
                                          "1.00000000000000",
                                          "1.000000000000000",
                                          "0.12345678901234567"};
    static const int digits[] = {2, 3, 5, 4, 5, 6, 7, 15, 16, 17};
    enum { WRITTEN = sizeof digits / sizeof *digits };
    char text[400];
    for (int a = 0; a < WRITTEN; a++)
        for (int b = 0; b < WRITTEN; b++) {
            const char *form = a % 2 ? "%s%s,0,1,1,1,1\n0.2,%s,1,1,1,1\n0.3,0,1,1,%s,1\n"
                                     : "%s%s,0,1,1,1,1\n0.2,0,1,1,%s,1\n0.3,0,1,1,%s,1\n";
            const int n = snprintf(
                text, sizeof text, form, "x,vx,m,rho,u,other\n0.1,0,1,1,1,1.2345678\n", written[a],
                written[b] + (written[b][0] == '-'), written[a] + (written[a][0] == '-'));
            struct snapshot_file file = file_of(text, (size_t)n, NULL);
            for (int k = 0; k < 2; k++) {
                const int most = digits[k && digits[b] > digits[a] ? b : a];
                const bool fewer = most > 4 && most < 16;
                assert_true(
                    fabs(file.precision[k] - (fewer ? 5 * pow(10, -most) : DBL_EPSILON / 2)) <=
                    1e-12 * file.precision[k]);
                if (k) assert_int_equal(file.digits, fewer ? most : 0);
            }
            snapshot_file_free(&file);
        }
}

TEST(no_files)
{
    static const struct snapshot_options plain;
    static const struct {
        const char *name, *says;
    } rows[] = {{"nothing", "nothing: cannot be read: No such file"},
                {"folder", "folder: is a directory; allowed: a file"},
                {"queue", "queue: is no regular file; allowed: a file"},
                {"empty", "empty: the file is empty"}};
    assert_int_equal(mkdir(path_of("folder"), 0700), 0);
    assert_int_equal(mkfifo(path_of("queue"), 0600), 0);
    fclose(fopen(path_of("empty"), "w"));
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct snapshot_file file;
        struct error error = {0};
        const int next = open("/dev/null", O_RDONLY);
        close(next);
        const enum status status = snapshot_read(path_of(rows[k].name), &plain, &file, &error);
        snapshot_file_free(&file);
        if (status != STATUS_BAD_INPUT || !strstr(error.message, rows[k].says))
            fail_msg("status %d: %s", (int)status, error.message);
        const int still = open("/dev/null", O_RDONLY); /* no file stays open */
        close(still);
        assert_int_equal(still, next);
    }
}

TEST(wrong_headers)
{
    static const struct {
        const char *text, *says;
    } rows[] = {
        {"1,2\n3,4\n", "'1' is a number"},
        {"a,b\n1,2\n", "no x; found: nothing (in text, --map x=NAME"},
        {"x,1\n3,4\n", "'1' is a number"},
        {"# time = 3\n1 2\n", "'3' is a number"},
        {"#\n1 2\n", "no line with the names"},
        {"1 2\n3 4\n", "'1' is a number"},
        {"#  \n1 2\n", "no line with the names"},
        {"\xef\xbb\xbf", "no line with the names"},
        {"# vtk DataFile Version 3.0\na\nASCII\nPOINTS 1 int\n1 2 3\n", "no vx; found: x y z"},
        {"\n \t\n\r\n", "no line with the names"},
        {"# x vx\n", "no line with the names"},
        {"x,,m\n1,2,3\n", "of 1 to 47 letters"},
        {"x, ,m\n1,2,3\n", "of 1 to 47 letters"},
        {"x,\n1\n", "of 1 to 47 letters"},
        {"x,\r\n1\r\n", "of 1 to 47 letters"},
        {"x,vx\n1,2,\n", ":2: more than 2 numbers"},
        {"x,vx,m,rho,u\n", "0 gas particles"},
        {"x,vx,m,rho,u\n1,2,3,4,5\n2,2,3,4,5\n3,2,3,4,5\n", "3 gas particles; allowed: at least 4"},
        {"x,z,vx,m,rho,u\n1,2,3,4,5,6\n2,2,3,4,5,6\n3,2,3,4,5,6\n4,2,3,4,5,6\n",
         "has z but no y; found: x z vx"},
        {"x,vx,m,rho,u\n1,2,3,4,5\n1,2,3,4,5\n1,2,3,4,5\n1,2,3,4,5\n",
         "all particles are at one place"},
        {"x\x01,vx\n1,2\n", "no snapshot that is read"},
        {"x\x7f,vx\n1,2\n", "no snapshot that is read"},
        {"\n\x1f\x7f", "no snapshot that is read"}};
    char text[8000] = "";
    memset(text, '#', 5000); /* a NUL beyond the first 4096 bytes does not make a file binary */
    refuses(text, 5001, NULL, "no line with the names");
    static const char *const needed[] = {"x", "vx", "m", "rho"}; /* each of these is required */
    for (int k = 0; k < 4; k++) {
        char says[80], head[40];
        snprintf(says, sizeof says, "no %s; found:", needed[k]);
        snprintf(head, sizeof head, "%s%s%s%su\n1 1 1 1\n", k == 0 ? "" : "x ", k == 1 ? "" : "vx ",
                 k == 2 ? "" : "m ", k == 3 ? "" : "rho ");
        refuses(head, strlen(head), NULL, says);
        snprintf(says, sizeof says, "--map %s=NAME tells its column", needed[k]);
        refuses(head, strlen(head), NULL, says);
    }
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        refuses(rows[k].text, strlen(rows[k].text), NULL, rows[k].says);
    for (int more = 0; more < 2; more++) { /* 64 columns; names of 47 characters */
        size_t at = 0;
        for (int c = 0; c < 64 + more; c++)
            at += (size_t)sprintf(text + at, "%sc%d", c ? "," : "", c);
        at += (size_t)sprintf(text + at, "\n");
        refuses(text, at, NULL, more ? "at most 64" : "no x");
        memset(text, 'n', 47 + (size_t)more);
        at = 47 + (size_t)more + (size_t)sprintf(text + 47 + more, " x\n");
        refuses(text, at, NULL, more ? "of 1 to 47 letters" : "no vx");
    }
    memset(text, ' ', sizeof text); /* only the beginning decides whether a file is text */
    text[4096] = '\x01';
    refuses(text, 4097, NULL, "no x");
    text[4095] = '\x01';
    refuses(text, 4097, NULL, "no snapshot that is read");
}

/* ---- legacy VTK files ---- */

#define HEAD  "# vtk DataFile Version 3.0\nparticles\n"
#define ASCII HEAD "ASCII\n"
#define THREE ASCII "DATASET POLYDATA\nPOINTS 3 double\n0 0 0 1 0 0 2 0 0\n"
#define DATA  THREE "POINT_DATA 3\n"

TEST(legacy_vtk)
{
    static const struct snapshot_options plain;
    static const struct {
        const char *text, *says;
    } rows[] = {
        {HEAD "TEXT\n", "the third line is neither ASCII nor BINARY: TEXT"},
        {ASCII "DATASET RECTILINEAR_GRID\n",
         "allowed: POLYDATA or UNSTRUCTURED_GRID, not RECTILINEAR_GRID"},
        {ASCII "", "has no POINTS"},
        {ASCII "POINTS 0 double\n", "allowed: one set of points, not POINTS"},
        {THREE "POINTS 3 double\n0 0 0 1 0 0 2 0 0\n", "allowed: one set of points, not POINTS"},
        {ASCII "POINTS 1.5 double\n1 2 3\n", "allowed: one set of points, not POINTS"},
        {ASCII "POINTS 4000000000 double\n", "allowed: one set of points, not POINTS"},
        {ASCII "POINTS -1 double\n", "allowed: one set of points, not POINTS"},
        {ASCII "POINTS 200000000 double\n", "allowed: one set of points, not POINTS"},
        {HEAD "BINARY\nPOINTS 3 double", "is cut off in POINTS"},
        {HEAD "BINARY\nPOINTS 3 double\n12345678", "is cut off in POINTS"},
        {ASCII "POINTS 3 real\n1 2 3\n", "numbers of an unknown type: real"},
        {ASCII "POINTS 2 double\n1 2 3 4 5\n",
         "is cut off, or has no number where one is due, in POINTS"},
        {ASCII "POINTS 2 double\n1 2 3 4 5 x\n",
         "is cut off, or has no number where one is due, in POINTS"},
        {THREE "POINT_DATA 2\n", "another number than of points has POINT_DATA"},
        {THREE "POINT_DATA x\n", "no number that the file has room for stands behind POINT_DATA"},
        {THREE "TENSORS a double\n", "an unknown word: TENSORS"},
        {DATA "SCALARS rho double 5\n", "1 to 4 components are allowed for rho"},
        {DATA "SCALARS rho double 0\n", "1 to 4 components are allowed for rho"},
        {DATA "SCALARS rho double\n1 1 1\n", "no LOOKUP_TABLE stands behind SCALARS rho"},
        {DATA "SCALARS rho double\nLOOKUP_TABLE default\n1 1\n",
         "is cut off, or has no number where one is due, in rho"},
        {DATA "FIELD a 1\nrho 1 2 double\n1 1\n",
         "another number of tuples than of points has rho"},
        {DATA "FIELD a 1\nrho 10 3 double\n1 1\n", "more than 9 components has rho"},
        {DATA "FIELD a 1\nodd 9 1 double\n1 2 3 4 5 6 7 8\n",
         "is cut off, or has no number where one is due, in odd"},
        {DATA "FIELD a 2\nrho 1 3 double\n1 1 1\ndensity 1 3 double\n1 1 1\n",
         "there are two arrays for density"},
        {DATA "FIELD a x\n", "no number that the file has room for stands behind FIELD"},
        {DATA "FIELD a 1\nrho x 3 double\n",
         "no number that the file has room for stands behind rho"},
        {DATA "FIELD a 1\nrho 1 x double\n",
         "no number that the file has room for stands behind rho"},
        {THREE "VERTICES x\n", "no number that the file has room for stands behind cells"},
        {THREE "VERTICES 1 x\n", "no number that the file has room for stands behind cells"},
        {THREE "VERTICES 2 1\nOFFSETS int\n0 1\n3\n", "CONNECTIVITY stands behind OFFSETS, not 3"},
        {THREE "VERTICES 2 1\nOFFSETS int\n0 x\n",
         "is cut off, or has no number where one is due, in cells"},
        {THREE "CELL_TYPES x\n", "no number that the file has room for stands behind cells"},
        {THREE "CELL_TYPES 3\n1 1\n", "is cut off, or has no number where one is due, in cells"},
        {ASCII "FIELD a 1\nTimeValue 1 1 word\n1\n", "numbers of an unknown type: word"},
        {THREE "a_word_of_so_many_letters_that_no_name_of_an_array_has_room_for_it_in_what_this_"
               "reader_keeps_of_it_and_of_which_the_message_has_the_first_63\n",
         "an unknown word: a_word_of_so_many_letters_that_no_name_of_an_array_has_room_for"}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct snapshot_file file;
        struct error error = {0};
        char says[400];
        put_bytes("a.txt", rows[k].text, strlen(rows[k].text));
        snprintf(says, sizeof says, "%s: legacy VTK: %s", path_of("a.txt"), rows[k].says);
        const enum status status = snapshot_read(path_of("a.txt"), &plain, &file, &error);
        snapshot_file_free(&file);
        assert_string_equal(error.message, says);
        assert_int_equal(status, STATUS_BAD_INPUT);
    }
    refuses(THREE, strlen(THREE), "x=y", "--map is for text; this is vtk, whose names are known");
}

static struct snapshot_file reads_vtk(const char *text, size_t size)
{
    struct snapshot_file file = file_of(text, size, NULL);
    for (int i = 0; i < 4; i++)
        assert_true(file.column[SNAPSHOT_X][i] == i && file.column[SNAPSHOT_VX][i] == 3 * i &&
                    file.column[SNAPSHOT_M][i] == 7 && file.column[SNAPSHOT_RHO][i] == 5 + i);
    return file;
}

/* Sections that say nothing of the particles are skipped, wherever they stand; a FIELD may give the
 * time. */
TEST(legacy_vtk_sections)
{
    static const struct {
        const char *before, *between, *behind; /* the points, and their data */
        bool timed;
    } rows[] = {
        {"FIELD a 1\nTimeValue 1 1 double\n0.25\n", "", "", true},
        {"FIELD a 1\nTIME 1 1 float\n0.25\n", "", "", true},
        {"FIELD a 2\nTimeValue 1 2 double\n7 8\nTIME 1 1 double\n0.25\n", "", "", true},
        {"FIELD a 1\nTimeValue 2 1 double\n7 8\n", "", "", false},
        {"FIELD a 1\nTime 1 1 int\n3\n", "LINES 1 3\n2 0 1\n", "", false},
        {"", "CELL_DATA 1\nFIELD a 1\nTIME 1 1 int\n3\n", "", false},
        {"", "CELL_DATA 1\nSCALARS rho int\nLOOKUP_TABLE a\n3\n", "", false},
        {"FIELD a 0\n", "VERTICES 0 0\n", "", false},
        {"", "",
         "FIELD b 2\nodd 1 4 int\n1 2 3 4\nMETADATA\nINFORMATION 0\n\neven 1 4 int\n5 5 5 5\n",
         false},
        {"", "METADATA\nINFORMATION 1\nNAME a\n\n", "NORMALS n int\n0 0 1 0 0 1 0 0 1 0 0 1\n",
         false},
        {"", "", "SCALARS m int 2\nLOOKUP_TABLE a\n1 2 3 4 5 6 7 8\n", false},
        {"", "", "SCALARS a int 4\nLOOKUP_TABLE a\n1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16\n",
         false},
        {"", "", "FIELD b 2\nvel 1 4 int\n1 2 3 4\nodd 9 1 int\n1 2 3 4 5 6 7 8 9\n", false},
        {"", "", "METADATA\nat the end\n", false},
        {"", "", "CELL_DATA 5\nwhatever", false}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        char text[1000];
        const int n =
            snprintf(text, sizeof text,
                     ASCII "%sDATASET POLYDATA\nPOINTS 4 int\n0 0 0 1 0 0 2 0 0 3 0 0\n%s"
                           "POINT_DATA 4\nVECTORS v int\n0 0 0 3 0 0 6 0 0 9 0 0\nSCALARS rho int\n"
                           "LOOKUP_TABLE a\n5 6 7 8\nFIELD a 1\nm 1 4 int\n7 7 7 7\n%s",
                     rows[k].before, rows[k].between, rows[k].behind);
        struct snapshot_file file = reads_vtk(text, (size_t)n);
        assert_true(file.time.known == rows[k].timed &&
                    (!rows[k].timed || file.time.value == 0.25));
        snapshot_file_free(&file);
    }
}

/* Binary numbers of every type, by two of them: the one whose bits are all set, and 5. */
TEST(legacy_vtk_types)
{
    static const struct {
        const char *name;
        size_t width;
        double all_set;
    } types[] = {{"char", 1, -1},         {"unsigned_char", 1, 255},
                 {"short", 2, -1},        {"unsigned_short", 2, 65535},
                 {"int", 4, -1},          {"unsigned_int", 4, 4294967295.},
                 {"vtkIdType", 4, -1},    {"long", 8, -1},
                 {"vtktypeint64", 8, -1}, {"unsigned_long", 8, 18446744073709551615.}};
    for (size_t k = 0; k < sizeof types / sizeof *types; k++) {
        char text[1000];
        size_t n = (size_t)sprintf(text, HEAD "BINARY\nDATASET POLYDATA\nPOINTS 4 char\n");
        for (int i = 0; i < 12; i++) text[n++] = (char)(i % 3 ? 0 : i / 3);
        n += (size_t)sprintf(text + n, "\nPOINT_DATA 4\nVECTORS v char\n");
        for (int i = 0; i < 12; i++) text[n++] = (char)(i % 3 ? 0 : i);
        n +=
            (size_t)sprintf(text + n, "\nFIELD a 3\nrho 1 4 char\n%c%c%c%c\nm 1 4 char\n%c%c%c%c\n",
                            5, 6, 7, 8, 7, 7, 7, 7);
        n += (size_t)sprintf(text + n, "du 1 4 %s\n", types[k].name);
        for (size_t i = 0; i < 4 * types[k].width; i++)
            text[n++] = (char)(i < types[k].width ? 255 : (i + 1) % types[k].width ? 0 : 5);
        struct snapshot_file file = reads_vtk(text, n);
        for (int i = 0; i < 4; i++)
            assert_true(file.column[SNAPSHOT_DU][i] == (i ? 5 : types[k].all_set));
        assert_true(file.precision[0] == 1.2e-16 && file.precision[1] == 1.2e-16);
        snapshot_file_free(&file);
    }
}
