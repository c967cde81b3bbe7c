/* SPDX-License-Identifier: GPL-3.0-or-later
 * Reads VTK XML documents in every form of the format (numbers as text, base64, raw and appended;
 * both byte orders and sizes of sizes) to the bit. A document with one fault must be refused with a
 * message that says what was found and what is allowed. */
#include "test.h"

#include "drawn_table.h"
#ifdef HAVE_ZLIB
#include <zlib.h>
#endif

enum { ARRAYS = 6, BYTES_MAX = 1 << 14 };
enum form { TEXT, BASE64, APPENDED, FORMS };

static const struct {
    const char *name;
    enum snapshot_column column;
    size_t components;
} arrays[ARRAYS] = {{"Points", SNAPSHOT_X, 3},   {"velocity", SNAPSHOT_VX, 3},
                    {"mass", SNAPSHOT_M, 1},     {"density", SNAPSHOT_RHO, 1},
                    {"pressure", SNAPSHOT_P, 1}, {"smoothing length", SNAPSHOT_H, 1}};

struct document {
    enum form form;
    bool big, wide, single, base64; /* base64: encoding of appended bytes */
    bool odd;                       /* valid attributes that no known writer uses */
    int ends;                       /* numbers of the box: two per direction */
    double value[ARRAYS][3 * ROWS];
    char text[BYTES_MAX], appended[BYTES_MAX];
    size_t length, bytes;
};

static struct document made(void)
{
    struct document d = {.form = (enum form)drawn(FORMS), .ends = 6};
    d.big = drawn(2), d.wide = drawn(2), d.single = drawn(2), d.base64 = drawn(2);
    d.odd = drawn(2);
    for (int a = 0; a < ARRAYS; a++)
        for (size_t i = 0; i < arrays[a].components * ROWS; i++) {
            const double value = ldexp(draw(1, 2), (int)drawn(20) - 10);
            d.value[a][i] = d.single ? (double)(float)value : value;
        }
    return d;
}

__attribute__((format(printf, 2, 3))) static void add(struct document *d, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    d->length += (size_t)vsnprintf(d->text + d->length, sizeof d->text - d->length, format, values);
    va_end(values);
}

static size_t put(const struct document *d, unsigned char *to, const void *number, size_t size)
{
    for (size_t k = 0; k < size; k++)
        to[k] = ((const unsigned char *)number)[d->big ? size - 1 - k : k];
    return size;
}

/* Base64 of n bytes. Returns its length. */
static size_t encode(const unsigned char *bytes, size_t n, char *to)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    size_t made = 0;
    for (size_t k = 0; k < n; k += 3) {
        unsigned word = 0;
        for (size_t j = k; j < k + 3; j++) word = word << 8 | (j < n ? bytes[j] : 0u);
        for (size_t j = 0; j < 4; j++)
            to[made++] = k + j > n ? '=' : digits[word >> (18 - 6 * j) & 63];
    }
    return made;
}

/* An array as in the file: the number of bytes, then the bytes. Returns the length. */
static size_t packed(const struct document *d, int a, bool base64, char *to)
{
    unsigned char bytes[BYTES_MAX / 2] = {0};
    const size_t numbers = arrays[a].components * ROWS;
    const uint64_t large = numbers * (d->single ? 4 : 8);
    const uint32_t small = (uint32_t)large;
    size_t n = d->wide ? put(d, bytes, &large, 8) : put(d, bytes, &small, 4);
    for (size_t i = 0; i < numbers; i++) {
        const float half = (float)d->value[a][i];
        n += d->single ? put(d, bytes + n, &half, 4) : put(d, bytes + n, &d->value[a][i], 8);
    }
    if (base64) return encode(bytes, n, to);
    memcpy(to, bytes, n);
    return n;
}

static void attribute(struct document *d, const char *name, const char *value)
{
    static const char *const others[] = {"RangeMin", "NickName", "subtype", "noformat"};
    const char quote = d->odd && drawn(2) ? '\'' : '"';
    if (d->odd && drawn(2))
        add(d, "\n%s=%c%s%c", others[drawn(4)], quote, drawn(2) ? "Int8" : "", quote);
    add(d, " %s%s=%c%s%c", name, d->odd && drawn(2) ? " " : "", quote, value, quote);
}

static void attribute_number(struct document *d, const char *name, size_t value)
{
    char number[24];
    snprintf(number, sizeof number, "%zu", value);
    attribute(d, name, number);
}

static void add_array(struct document *d, int a)
{
    static const char *const formats[FORMS] = {"ascii", "binary", "appended"};
    add(d, "<DataArray");
    attribute(d, "type", d->single ? "Float32" : "Float64");
    attribute(d, "Name", arrays[a].name);
    attribute_number(d, "NumberOfComponents", arrays[a].components);
    attribute(d, "format", formats[d->form]);
    if (d->form == APPENDED) {
        attribute_number(d, "offset", d->bytes);
        add(d, "/>\n");
        d->bytes += packed(d, a, d->base64, d->appended + d->bytes);
        return;
    }
    add(d, ">\n ");
    if (d->form == BASE64) d->length += packed(d, a, true, d->text + d->length);
    for (size_t i = 0; d->form == TEXT && i < arrays[a].components * ROWS; i++)
        add(d, "%.17g ", d->value[a][i]);
    add(d, "</DataArray>\n");
}

/* Text as character codes, where invalid codes are skipped; nine as components. */
static const struct {
    const char *name, *numbers;
    int count;
} fields[] = {{"boundary", "111 112 101 110", 4},
              {"keys", "110 61 51", 3},
              {"case", "115 31 111 256 32 100 255 31 31", 9},
              {"box", "-1 4000 -1 4000 -1 4000", 6},
              {"ndims", "3", 1},
              {"gamma", "1.5", 1},
              {"TimeValue", "0.25", 1},
              {"another", "7", 1}};

static void write_out(struct document *d)
{
    static const char *const times[] = {"TimeValue", "TIME", "time"};
    const char *time = times[drawn(3)];
    add(d, "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" byte_order=\"%s\"%s>\n",
        d->big ? "BigEndian" : "LittleEndian", d->wide ? " header_type=\"UInt64\"" : "");
    add(d, "<UnstructuredGrid><FieldData>\n");
    for (size_t k = 0; k < sizeof fields / sizeof *fields; k++)
        add(d,
            "<DataArray type=\"Float64\" Name=\"%s\" NumberOf%s=\"%d\" "
            "format=\"ascii\">%s</DataArray>\n",
            strcmp(fields[k].name, "TimeValue") ? fields[k].name : time,
            fields[k].count == 9 ? "Components" : "Tuples",
            strcmp(fields[k].name, "box") ? fields[k].count : d->ends, fields[k].numbers);
    add(d,
        "<DataArray type=\"String\" Name=\"case\" format=\"ascii\">9</DataArray>\n"); /* no number
                                                                                       */
    add(d, "</FieldData><Piece NumberOfPoints=\"%d\">\n<Points>", ROWS);
    add_array(d, 0);
    add(d, "</Points><PointData>\n");
    for (int a = 1; a < ARRAYS; a++) add_array(d, a);
    add(d, "</PointData>");
    if (d->odd) add(d, "<DataArray type=\"Int8\" Name=\"mass\" format=\"octal\"/>"); /* nobody's */
    add(d, "<Verts><DataArray format=\"ascii\"/></Verts></Piece></UnstructuredGrid>\n");
    if (d->form == APPENDED) {
        add(d, "<AppendedData encoding=\"%s\">\n _", d->base64 ? "base64" : "raw");
        memcpy(d->text + d->length, d->appended, d->bytes);
        d->length += d->bytes;
        add(d, "\n</AppendedData>\n");
    }
    add(d, "</VTKFile>\n");
}

TEST(every_form)
{
    for (int draw = 0; draw < 200; draw++) {
        struct document d = made();
        d.ends = 1 + (int)drawn(6);
        write_out(&d);
        struct snapshot_file file = file_of(d.text, d.length, NULL);
        assert_int_equal(file.n, ROWS);
        for (int a = 0; a < ARRAYS; a++)
            for (size_t c = 0; c < arrays[a].components; c++)
                for (size_t i = 0; i < ROWS; i++)
                    assert_true(file.column[(size_t)arrays[a].column + c][i] ==
                                d.value[a][i * arrays[a].components + c]);
        assert_true(file.time.known && file.time.value == 0.25);
        assert_true(file.gamma.known && file.gamma.value == 1.5);
        noted(&file, "gamma", "in the file", "its field gamma");
        const bool boxed = d.ends % 2 == 0;
        assert_true(file.boxed == boxed && file.placed == boxed);
        for (int a = 0; a < 3 && boxed; a++) {
            assert_true(file.corner[a] == (2 * a < d.ends ? -1 : 0));
            assert_true(file.box[a] == (2 * a < d.ends ? 4001 : 0));
        }
        assert_int_equal(file.dim, 3);
        assert_string_equal(file.case_name, "so d\xff");
        assert_string_equal(file.keys, "n=3");
        assert_string_equal(file.boundary, "open");
        assert_true((file.precision[1] > 1e-8) == d.single);
        snapshot_file_free(&file);
    }
}

/* ---- forms that are written by hand ---- */

/* Four particles whose array du is appended, as it is or, with a head > 0, as base64 of so many
 * bytes and of the rest; the other arrays are text. */
static void reads_appended(const char *attributes, const char *type, const unsigned char *bytes,
                           size_t size, size_t head, const double *du)
{
    char text[4000];
    const char *array = "<DataArray type=\"Float64\" format=\"ascii\" Name=";
    int n = snprintf(text, sizeof text,
                     "<VTKFile %s><Piece NumberOfPoints=\"4\">\n<Points>%s\"p\">0 1 2 3"
                     "</DataArray></Points><PointData>%s\"v\">1 1 1 1</DataArray>%s\"m\">1 1 1 1"
                     "</DataArray>%s\"rho\">1 1 1 1</DataArray><DataArray type=\"%s\" Name=\"du\" "
                     "format=\"appended\" offset=\"0\"/></PointData></Piece>\n"
                     "<AppendedData encoding=\"%s\"> < _",
                     attributes, array, array, array, array, type, head ? "base64" : "raw");
    size_t length = (size_t)n + (head ? encode(bytes, head, text + n) : 0);
    if (head) length += encode(bytes + head, size - head, text + length);
    if (!head) memcpy(text + n, bytes, size), length += size;
    strcpy(text + length, "</AppendedData></VTKFile>");
    if (!du) {
        refuses(text, length + 25, NULL, "the array 'du' is cut off or damaged; its points need 4");
        return;
    }
    struct snapshot_file file = file_of(text, length + 25, NULL);
    for (int i = 0; i < 4; i++) assert_true(file.column[SNAPSHOT_DU][i] == du[i]);
    snapshot_file_free(&file);
}

/* Numbers of every type, by two of them: the one whose bits are all set, and 5. */
TEST(types_of_numbers)
{
    static const struct {
        const char *name;
        size_t width;
        double all_set;
    } types[] = {{"Int8", 1, -1},  {"UInt8", 1, 255},
                 {"Int16", 2, -1}, {"UInt16", 2, 65535},
                 {"Int32", 4, -1}, {"UInt32", 4, 4294967295.},
                 {"Int64", 8, -1}, {"UInt64", 8, 18446744073709551615.}};
    for (size_t k = 0; k < sizeof types / sizeof *types; k++)
        for (int big = 0; big < 2; big++) {
            const size_t width = types[k].width;
            unsigned char bytes[40] = {0};
            bytes[big ? 3 : 0] = (unsigned char)(4 * width);
            memset(bytes + 4, 255, width);
            for (size_t i = 1; i < 4; i++) bytes[4 + i * width + (big ? width - 1 : 0)] = 5;
            const double all = types[k].all_set, du[] = {all, 5, 5, 5};
            reads_appended(big ? "byte_order='BigEndian'" : "byte_order='LittleEndian'",
                           types[k].name, bytes, 4 + 4 * width, 0, du);
        }
}

#ifdef HAVE_ZLIB
/* Compressed numbers in blocks of all sizes; one wrong size is a refusal. */
TEST(compressed_blocks)
{
    static const double du[] = {1.25, -2.5, 3, 4};
    static const struct {
        size_t blocks, size;                   /* of all blocks but the last */
        int said_blocks, said_size, said_last; /* added to what is said */
        int said_packed;                       /* of the last block */
        bool refused;
    } rows[] = {
        {1, 32, 0, 0, 0, 0, false},   {2, 16, 0, 0, 0, 0, false}, {2, 24, 0, 0, 0, 0, false},
        {32, 1, 0, 0, 0, 0, false},   {2, 24, 0, 1, 0, 0, true},  {2, 24, 0, 0, 1, 0, true},
        {2, 24, 0, 0, -8, 0, true},   {2, 24, -1, 0, 0, 0, true}, {2, 24, 31, 0, 0, 0, true},
        {2, 24, 0, 0, 0, 1000, true}, {2, 24, 0, 0, 0, -1, true}, {3, 16, 0, 0, 0, 0, true}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        for (int form = 0; form < 4; form++) {
            const bool wide = form % 2;
            unsigned char bytes[1400] = {0}, *at = bytes, packed[1000];
            size_t all = 0;
            uint64_t head[40] = {rows[k].blocks, rows[k].size, 32 % rows[k].size};
            for (size_t b = 0; b < rows[k].blocks; b++) {
                const size_t from = b * rows[k].size < 32 ? b * rows[k].size : 32,
                             size = 32 - from < rows[k].size ? 32 - from : rows[k].size;
                uLongf room = sizeof packed - all;
                assert_int_equal(
                    compress(packed + all, &room, (const unsigned char *)du + from, size), Z_OK);
                head[3 + b] = room, all += room;
            }
            head[0] += (uint64_t)rows[k].said_blocks, head[1] += (uint64_t)rows[k].said_size;
            head[2] += (uint64_t)rows[k].said_last;
            head[2 + rows[k].blocks] += (uint64_t)rows[k].said_packed;
            for (size_t b = 0; b < 3 + rows[k].blocks; b++, at += wide ? 8 : 4)
                memcpy(at, &head[b], wide ? 8 : 4); /* the test's machines are little-endian */
            memcpy(at, packed, all);
            reads_appended(wide ? "compressor='vtkZLibDataCompressor' header_type='UInt64'"
                                : "compressor='vtkZLibDataCompressor'",
                           "Float64", bytes, (size_t)(at - bytes) + all,
                           form / 2 ? (size_t)(at - bytes) : 0, rows[k].refused ? NULL : du);
        }
}
#endif

/* ---- one fault ---- */

#define ZEROS "000000000000000000000000000000000000000000000000000000000000" /* 60 of them */

static const struct {
    enum form form;
    const char *old, *new, *says;
} faults[] = {
    {TEXT, "NumberOfPoints=\"9\"", "NumberOfPoints=\"1e8\"", "NumberOfPoints = '1e8'; allowed: 1"},
    {TEXT, "NumberOfPoints=\"9\"", "NumberOfPoints=\"1e5\"", "NumberOfPoints = '1e5'; allowed: 1"},
    {TEXT, "NumberOfPoints=\"9\"", "NumberOfPoints=\"0\"", "NumberOfPoints = '0'; allowed: 1"},
    {TEXT, "NumberOfPoints=\"9\"", "NumberOfPoints=\"2.5\"", "NumberOfPoints = '2.5'"},
    {TEXT, "NumberOfPoints=\"9\"", "NumberOfPoints=>9>", "NumberOfPoints = ''; allowed: 1"},
    {TEXT, "NumberOfPoints=\"9\"", "NumberOfPoints=\"1\"", "1 gas particles; allowed: at least 4"},
    {TEXT, "NumberOfPoints=\"9\"", "NumberOfPoints=\"10\"",
     "'Points' has '' as number 28 of the 30"},
    {TEXT, "format=\"ascii\">\n ", "format=\"ascii\">\n hot ",
     "'Points' has 'hot' as number 1 of the 27"},
    {TEXT, "format=\"ascii\">\n ", "format=\"ascii\">\n " ZEROS "0000 ",
     "'Points' has '" ZEROS "000' as number 1 of the 27"},
    {TEXT, "\"Float64\" Name=\"mass\"", "\"Float16\" Name=\"mass\"",
     "'mass' has numbers of the type 'Float16'; allowed: Float64"},
    {TEXT, "Name=\"mass\"", "Name=\"density\"", "'density' is a second one for rho; allowed: one"},
    {TEXT, "Name=\"mass\"", "Name=\"weight\"", "no m; found"},
    {TEXT, "Name=\"mass\" NumberOfComponents=\"1\"", "Name=\"mass\" NumberOfComponents=\"2\"",
     "no m; found"},
    {TEXT, "format=\"ascii\">\n ", "format=\"octal\">\n ",
     "'Points' has the format 'octal'; allowed: ascii"},
    {TEXT, "<Piece ", "<Pieces ", "'Points' stands before any Piece"},
    {TEXT, "</Piece>", "</Piece><Piece NumberOfPoints=\"9\">", "a second Piece; allowed: one"},
    {TEXT, "byte_order=", "compressor=\"vtkLZ4DataCompressor\" byte_order=",
     "'vtkLZ4DataCompressor'; allowed: vtkZLibDataCompressor"},
    {TEXT, "4000 -1 4000 -1", "-1 -1 4000 -1", "'box' goes from -1 to -1"},
    {TEXT, "4000 -1 4000 -1", "4000 5 3 -1", "'box' goes from 5 to 3"},
    {TEXT, "4000 -1 4000 -1", "4000 -1e308 1e308 -1", "'box' goes from -1e+308 to 1e+308"},
    {TEXT, "ascii\">3<", "ascii\">1<", "says that it has 1 dimensions"},
    {TEXT, "ascii\">3<", "ascii\">2<", "says that it has 2 dimensions"},
    {TEXT, "Components=\"3\"", "Components=\"10\"", "has no y"}, /* as one */
    {TEXT, "Components=\"3\"", "Components=\"0\"", "has no y"},
    {TEXT, "Components=\"3\"", "Components=\"4\"", "no x; found"},
    {TEXT, "Components=\"3\"", "Components=\"9\"", "no x; found"},
    {TEXT, "\"case\" NumberOfComponents=\"9\"",
     "\"case\" NumberOfTuples=\"200\" NumberOfComponents=\"9\"",
     "'case' has 200 x 9 numbers; allowed: 1 to 1200"},
    {TEXT, "\"box\" NumberOfTuples=\"6\"", "\"box\" NumberOfTuples=\"0\"",
     "'box' has 0 x 1 numbers; allowed: 1 to"},
    {TEXT, "\"box\" NumberOfTuples=\"6\"", "\"box\" NumberOfTuples=\"1200\"",
     "'box' has '' as number 7 of the 1200"},
    {TEXT, "\"box\" NumberOfTuples=\"6\"", "\"box\" NumberOfTuples=\"1e9\"", "1e+09 x 1 numbers"},
    {TEXT, "</VTKFile>", "</VTKFil>", "is cut off: does not end with </VTKFile>"},
    {TEXT, "</VTKFile>", "<Points><DataArray Name=\"q\" </VTKFile>",
     "'q' is cut off: no tag ends it"},
    {BASE64, "NumberOfPoints=\"9\"", "NumberOfPoints=\"8\"",
     "'Points' has 216 bytes; its points need 192"},
    {BASE64, "\"Float64\" Name=\"velocity\"", "\"Int8\" Name=\"velocity\"",
     "has 216 bytes; its points need 27"},
    {BASE64, "AAAA", "A*AA", "'Points' is cut off or damaged"},
    {APPENDED, "offset=\"0\"", "offset=\"1000000\"",
     "'Points' has the offset '1000000'; allowed: 0 to"},
    {APPENDED, "offset=\"0\"", "offset=\"-1\"", "'Points' has the offset '-1'; allowed: 0 to"},
    {TEXT, "format=\"ascii\">\n ", "format=\"appended\" offset=\"0\">\n ",
     "'Points' has the offset '0'; allowed: 0 to 0, the length"},
    /* a word that is too long, and one of the largest length */
    {APPENDED, "offset=\"0\"", "offset=\"" ZEROS "0000\"", "'Points' has the offset ''"},
    {APPENDED, "offset=\"0\"", "offset=\"-" ZEROS "01\"", "'Points' has the offset '-0"},
    {APPENDED, "offset=\"0\"", "offset=\"4\"", "bytes; its points need 216"},
    {APPENDED, "\n _", "\n ", "AppendedData has no '_'"},
};

static void replace(struct document *d, const char *old, const char *new)
{
    char *const at = strstr(d->text, old);
    if (!at) return;
    const size_t from = strlen(old), to = strlen(new), begin = (size_t)(at - d->text);
    memmove(at + to, at + from, d->length - begin - from);
    memcpy(at, new, to);
    d->length += to - from;
    d->text[d->length] = '\0';
}

TEST(one_fault)
{
    for (size_t k = 0; k < sizeof faults / sizeof *faults; k++) {
        struct document d = made();
        d.form = faults[k].form, d.single = d.big = d.wide = d.odd = false, d.base64 = true;
        write_out(&d);
        const size_t before = d.length;
        char old[BYTES_MAX];
        memcpy(old, d.text, before);
        replace(&d, faults[k].old, faults[k].new);
        if (d.length == before && memcmp(old, d.text, before) == 0)
            fail_msg("fault %zu does not apply", k);
        refuses(d.text, d.length, NULL, faults[k].says);
    }
}

/* There may be as many points as bytes in the file, or 1032 times as many if they are compressed;
 * appended data may begin anywhere in it. */
TEST(limits)
{
    for (int k = 0; k < 4; k++) {
        char text[300], says[80];
        size_t n = 0;
        for (int pass = 0; pass < 2; pass++) /* the first for the length */
            n = (size_t)sprintf(
                text,
                "<VTKFile compressor='%s'><Piece NumberOfPoints='%06zu'><Points><DataArray "
                "format='ascii' type='Float64' Name='p'/></Points></Piece></VTKFile>",
                k / 2 ? "vtkZLibDataCompressor" : "", (k / 2 ? 1032 * n : n) + (size_t)k % 2);
        snprintf(says, sizeof says, "NumberOfPoints = '%06zu'; allowed",
                 (k / 2 ? 1032 * n : n) + (size_t)k % 2);
        refuses(text, n, NULL, k % 2 ? says : "'p' has '' as number 1 of the");
        n = (size_t)sprintf(
            text,
            "<VTKFile><Piece NumberOfPoints='4'><Points><DataArray type='Float64' Name='p' "
            "format='appended' offset='%d'/></Points></Piece><AppendedData encoding='raw'>_"
            "</AppendedData></VTKFile>",
            25 + k % 2);
        struct snapshot_file file; /* the error of another file is overwritten */
        struct error error = {.status = STATUS_ENVIRONMENT, .message = "old"};
        const struct snapshot_options plain = {0};
        put_bytes("a.txt", text, n);
        assert_int_equal(snapshot_read(path_of("a.txt"), &plain, &file, &error), STATUS_BAD_INPUT);
        assert_null(strstr(error.message, "old"));
        snapshot_file_free(&file);
        refuses(text, n, NULL,
                k % 2 ? "'p' has the offset '26'; allowed: 0 to 25" : "'p' is cut off or damaged");
    }
    refuses("<VTKFile></VTKFile>", 19, NULL, "VTK: has no Piece; allowed: one, with points");
}

/* Text is cut where it would not fit. */
TEST(long_text)
{
    for (int more = -1; more < 2; more++) {
        struct document d = made();
        char new[400], want[80];
        int n = sprintf(new, "\"%d\" format=\"ascii\">", 63 + more);
        for (int i = 0; i < 63 + more; i++) n += sprintf(new + n, "%d ", 'a' + i % 26);
        for (int i = 0; i < 63; i++) want[i] = (char)(i < 63 + more ? 'a' + i % 26 : 0);
        want[63] = '\0';
        d.form = TEXT;
        write_out(&d);
        replace(&d, "\"4\" format=\"ascii\">111 112 101 110", new);
        struct snapshot_file file = file_of(d.text, d.length, NULL);
        assert_string_equal(file.boundary, want);
        snapshot_file_free(&file);
    }
}

/* A document may end anywhere. */
TEST(truncated_documents)
{
    refuses("<VTKFile", 8, NULL, "is cut off: does not end with </VTKFile>");
    for (int draw = 0; draw < 100; draw++) {
        struct document d = made();
        write_out(&d);
        const size_t length = 300 + drawn((unsigned)d.length - 312);
        refuses(d.text, length, NULL, "is cut off");
    }
}
