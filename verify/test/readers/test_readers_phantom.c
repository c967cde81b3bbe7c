/* SPDX-License-Identifier: GPL-3.0-or-later
 * Reads Phantom dumps written in every form: both byte orders, default numbers of 4 and 8 bytes,
 * arrays of any kind of real in any order, other particle types, dead particles, sinks. Every
 * written value must be read; files with missing or damaged items must be refused. */
#include "test.h"

#include <float.h>

#include "cut_records.h"
#include "draw.h"
#include "expected_snapshot.h"

enum { N = 14, BYTES = 1 << 16, KINDS = 8, ARRAYS = 10, VALUES = 12 };
enum { X, Y, Z, H, VX, VY, VZ, U, P, ALPHA }; /* the last is not read */
static const char *const tags[ARRAYS] = {"x",  "y",  "z", "h",        "vx",
                                         "vy", "vz", "u", "pressure", "alpha"};
static const int columns[ARRAYS] = {0, 1, 2, SNAPSHOT_H, 3, 4, 5, SNAPSHOT_U, SNAPSHOT_P, -1};
static const double types[N] = {1, -1, 2, 1, 1, 3, -1, 1, 1, -2, 1, 1, 1, 0}; /* 0: of no type */

struct dump {
    bool swapped;
    int bytes[KINDS];
    char name[101];
    double magic[4];
    struct {
        const char *tag; /* NULL: missing */
        int kind;
        double value;
    } value[VALUES];
    double array[ARRAYS][N];
    int kind[ARRAYS]; /* -1: missing */
    bool typed;
    int groups, rows; /* groups of arrays, the second of sinks; rows in the header */
    int masses;       /* behind the other values of kind 5, of types that no particle has */
};

static struct dump made(void)
{
    struct dump d = {.bytes = {4, 1, 2, 4, 8, 8, 4, 8}, .typed = true, .groups = 1, .rows = N};
    snprintf(d.name, sizeof d.name, "%-100s",
             "FT:Phantom:2021.0.0:63a3980 (hydro+1dust): 11/11/2021 15:52:02.3");
    const double magic[4] = {60769, 60878, 60878, 690706};
    memcpy(d.magic, magic, sizeof magic);
    for (int a = 0; a < ARRAYS; a++) {
        d.kind[a] = 5;
        for (int i = 0; i < N; i++)
            d.array[a][i] = a <= Z   ? ldexp(drawn(1 << 20), -20)
                            : a == H ? 0.5 + ldexp(drawn(1 << 10), -10)
                                     : 1 + ldexp(drawn(1 << 20), -20);
    }
    static const char *const named[VALUES] = {"massoftype", "massoftype", "massoftype", "hfact",
                                              "time",       "gamma",      "xmin",       "xmax",
                                              "ymin",       "ymax",       "zmin",       "zmax"};
    static const double numbers[VALUES] = {0.5, 0.25, 0.125, 1.25, 0.375, 1.5, -1, 2, -2, 3, 0, 1};
    for (int k = 0; k < VALUES; k++)
        d.value[k].tag = named[k], d.value[k].kind = 5, d.value[k].value = numbers[k];
    return d;
}

static unsigned char bytes[BYTES];
static size_t at, begun, lengths; /* lengths: where those of the arrays stand */

static void put(const struct dump *d, double value, int size, bool real)
{
    unsigned char word[8];
    const float half = (float)value;
    const int64_t whole = real ? 0 : (int64_t)value;
    if (real && size == 4)
        memcpy(word, &half, sizeof half);
    else if (real)
        memcpy(word, &value, sizeof value);
    else
        memcpy(word, &whole, sizeof whole); /* the test's machines are little-endian */
    for (int k = 0; k < size; k++) bytes[at++] = word[d->swapped ? size - 1 - k : k];
}

static void number(const struct dump *d, double value, int kind)
{
    put(d, value, d->bytes[kind], kind >= 5);
}

static void begin(void)
{
    begun = at;
    at += 4;
}

static void end(const struct dump *d)
{
    const size_t size = at - begun - 4, here = at;
    at = begun;
    put(d, (double)size, 4, false);
    at = here;
    put(d, (double)size, 4, false);
}

static void tag(const char *name)
{
    at += (size_t)sprintf((char *)bytes + at, "%-16s", name);
}

static void put_header(const struct dump *d)
{
    for (int kind = 0; kind < KINDS; kind++) {
        int n = kind == 0; /* an integer that is not read */
        const int masses = kind == 5 ? d->masses : 0;
        for (int k = 0; k < VALUES; k++) n += d->value[k].tag && d->value[k].kind == kind;
        n += masses;
        begin(), put(d, n, 4, false), end(d);
        if (!n) continue;
        begin();
        if (kind == 0) tag("nparttot");
        for (int k = 0; k < VALUES; k++)
            if (d->value[k].tag && d->value[k].kind == kind) tag(d->value[k].tag);
        for (int k = 0; k < masses; k++) tag("massoftype");
        end(d), begin();
        if (kind == 0) number(d, 99, kind);
        for (int k = 0; k < VALUES; k++)
            if (d->value[k].tag && d->value[k].kind == kind) number(d, d->value[k].value, kind);
        for (int k = 0; k < masses; k++) number(d, 9, kind);
        end(d);
    }
}

static size_t put_all(const struct dump *d)
{
    at = 0;
    begin();
    number(d, d->magic[0], 0), number(d, d->magic[1], 5), number(d, d->magic[2], 0);
    number(d, 1, 0), number(d, d->magic[3], 0);
    end(d), begin();
    at += (size_t)sprintf((char *)bytes + at, "%s", d->name);
    end(d);
    put_header(d);
    begin(), put(d, d->groups, 4, false), end(d);
    for (int g = 0; g < d->groups; g++) {
        begin();
        if (!g) lengths = at;
        put(d, g ? 2 : d->rows, 8, false);
        for (int kind = 0; kind < KINDS; kind++) {
            int n = kind == 1 && !g && d->typed;
            for (int a = 0; a < ARRAYS; a++) n += !g && d->kind[a] == kind;
            put(d, g ? kind == 5 : n, 4, false);
        }
        end(d);
    }
    for (int kind = 0; kind < KINDS; kind++) {
        if (kind == 1 && d->typed) {
            begin(), tag("itype"), end(d), begin();
            for (int i = 0; i < d->rows; i++) number(d, types[i % N], 1);
            end(d);
        }
        for (int a = 0; a < ARRAYS; a++) {
            if (d->kind[a] != kind) continue;
            begin(), tag(tags[a]), end(d), begin();
            for (int i = 0; i < d->rows; i++) number(d, d->array[a][i % N], kind);
            end(d);
        }
    }
    if (d->groups > 1) {
        begin(), tag("x"), end(d), begin();
        for (int i = 0; i < 2; i++) number(d, 777, 5);
        end(d);
    }
    return at;
}

static enum status read_bytes(size_t size, struct snapshot_file *file, struct error *error)
{
    static const struct snapshot_options plain = {0};
    put_bytes("dump_00000", bytes, size);
    return read_gas("dump_00000", &plain, file, error);
}

static void refuses(size_t size, const char *says)
{
    static const struct snapshot_options plain = {0};
    put_bytes("dump_00000", bytes, size);
    is_refused("dump_00000", &plain, "a dump", says);
}

static const double *value_of(const struct dump *d, const char *name)
{
    for (int k = 0; k < VALUES; k++)
        if (d->value[k].tag && strcmp(d->value[k].tag, name) == 0) return &d->value[k].value;
    return NULL;
}

static void is_read(const struct dump *d)
{
    struct snapshot_file file;
    struct error error;
    int row[N];
    size_t n = 0, gas = 0;
    double precision[2] = {0, 0};
    if (read_bytes(put_all(d), &file, &error)) fail_msg("%s", error.message);
    for (int pass = 0; pass < 2; pass++) {
        for (int i = 0; i < N; i++)
            if (d->array[H][i] > 0 && (!d->typed || fabs(types[i]) == 1) == !pass) row[n++] = i;
        if (!pass) gas = n;
    }
    assert_string_equal(file.layout, "phantom");
    assert_string_equal(file.code, "Phantom:2021.0.0:63a3980");
    assert_true(file.n == n && file.gas == gas && file.dim == 3);
    for (int a = 0; a < ARRAYS; a++) {
        if (columns[a] < 0) continue;
        const double *column = file.column[columns[a]];
        assert_true(!column == (d->kind[a] < 0));
        for (size_t i = 0; i < n && column; i++) assert_true(column[i] == d->array[a][row[i]]);
        if (column)
            precision[columns[a] > 2] =
                fmax(precision[columns[a] > 2],
                     (d->bytes[d->kind[a]] == 4 ? (double)FLT_EPSILON : DBL_EPSILON) / 2);
    }
    for (size_t i = 0; i < n; i++) {
        const double m = d->typed && types[row[i]] != 0 ? 1 / exp2(fabs(types[row[i]])) : 0.5,
                     q = 1.25 / d->array[H][row[i]];
        assert_true(file.column[SNAPSHOT_M][i] == m);
        assert_true(fabs(file.column[SNAPSHOT_RHO][i] / (m * q * q * q) - 1) < 1e-15);
    }
    for (int k = 0; k < 2; k++) assert_true(file.precision[k] == precision[k]);
    const double *time = value_of(d, "time"), *gamma = value_of(d, "gamma");
    assert_true(file.time.known == !!time && (!time || file.time.value == 0.375));
    assert_true(file.gamma.known == !!gamma && (!gamma || file.gamma.value == 1.5));
    bool boxed = true;
    static const char *const ends[3][2] = {{"xmin", "xmax"}, {"ymin", "ymax"}, {"zmin", "zmax"}};
    for (int k = 0; k < 3; k++) boxed = boxed && value_of(d, ends[k][0]) && value_of(d, ends[k][1]);
    for (int k = 0; k < 3 && boxed; k++)
        boxed = isfinite(*value_of(d, ends[k][1]) - *value_of(d, ends[k][0]));
    for (size_t i = 0; i < n && boxed; i++)
        for (int k = 0; k < 3 && boxed; k++)
            boxed = d->array[k][row[i]] >= *value_of(d, ends[k][0]) &&
                    d->array[k][row[i]] <= *value_of(d, ends[k][1]);
    assert_true(file.boxed == boxed && file.placed == boxed);
    for (int k = 0; k < 3 && boxed; k++)
        assert_true(file.corner[k] == *value_of(d, ends[k][0]) &&
                    file.box[k] == *value_of(d, ends[k][1]) - *value_of(d, ends[k][0]));
    snapshot_file_free(&file);
}

/* Moves an end of the box so far in that one particle alone is outside. */
static void put_inside(struct dump *d, int end)
{
    const bool upper = end % 2;
    double outermost = d->array[end / 2][0];
    for (int i = 1; i < N; i++) outermost = (upper ? fmax : fmin)(outermost, d->array[end / 2][i]);
    d->value[6 + end].value = outermost + (upper ? -1 : 1) * ldexp(1, -21);
}

TEST(every_form)
{
    for (int draw = 0; draw < 300; draw++) {
        struct dump d = made();
        d.swapped = draw % 2;
        d.bytes[0] = draw / 2 % 2 ? 4 : 8, d.bytes[5] = draw / 4 % 2 ? 4 : 8;
        for (int a = 0; a < ARRAYS; a++)
            d.kind[a] = a == ALPHA ? (int)drawn(KINDS) : 5 + (int)drawn(3);
        for (int k = 0; k < VALUES; k++) d.value[k].kind = k < 3 ? 5 : 5 + (int)drawn(3);
        d.typed = drawn(3), d.groups = 1 + (int)drawn(3);
        if (drawn(2)) d.array[H][drawn(N)] = -1;
        if (drawn(2)) d.array[H][drawn(N)] = 0;
        if (drawn(3) == 0) d.kind[U + (int)drawn(2)] = -1;
        if (drawn(4) == 0) d.value[4 + drawn(8)].tag = NULL;
        if (drawn(4) == 0) d.value[6 + drawn(6)].value = 0.5; /* too small for the gas, or empty */
        if (drawn(4) == 0) put_inside(&d, (int)drawn(6));
        if (drawn(8) == 0) d.value[6 + 2 * drawn(3)].value = (double)-INFINITY;
        if (drawn(8) == 0) d.value[7 + 2 * drawn(3)].value = (double)INFINITY;
        for (int a = X; a <= Y && drawn(2); a++) /* below 0, above the least ends of the box */
            for (int i = 0; i < N; i++) d.array[a][i] -= 1;
        if (drawn(8) == 0) d.masses = 70; /* more than are read */
        is_read(&d);
    }
}

TEST(missing_items)
{
    static const char *const says[ARRAYS] = {
        "need real arrays x, y, z and h; they have: itype y z h vx vy vz u pressure",
        "need real arrays x, y, z and h; they have: itype x z h vx",
        "need real arrays x, y, z and h; they have: itype x y h vx",
        "need real arrays x, y, z and h; they have: itype x y z vx",
        "no vx",
        "no vy",
        "no vz"};
    for (int a = 0; a < ARRAYS; a++) {
        struct dump d = made();
        d.kind[a] = -1;
        if (says[a])
            refuses(put_all(&d), says[a]);
        else
            is_read(&d);
    }
    for (int a = X; a <= H; a++) { /* integers of this name are no such array */
        struct dump d = made();
        d.kind[a] = 3 + a % 2;
        refuses(put_all(&d), "need real arrays x, y, z and h; they have: itype ");
    }
    for (int k = 0; k < 4; k++) {
        static const double wrong[] = {0, -1, (double)NAN};
        for (int w = 0; w < 3; w++) {
            struct dump d = made();
            d.value[k].value = wrong[w];
            if (k == 0 || k == 3)
                refuses(put_all(&d), k ? "its hfact is" : "massoftype begins with");
        }
        struct dump d = made();
        d.value[k].tag = NULL;
        if (k == 3) refuses(put_all(&d), "its hfact is no number");
        d = made();
        for (int j = 0; j < 3; j++) d.value[j].tag = k ? "mass" : "massoftypes";
        refuses(put_all(&d), "massoftype is no number");
    }
    struct dump d = made();
    const size_t size = put_all(&d); /* of two arrays of types the first counts */
    memcpy(bytes + size - (8 * N + 8) - 20, "itype", 5); /* in place of alpha */
    struct snapshot_file file;
    struct error error;
    assert_int_equal(read_bytes(size, &file, &error), STATUS_OK);
    assert_int_equal(file.gas, 10);
    snapshot_file_free(&file);
    d.kind[U] = d.kind[P] = -1;
    refuses(put_all(&d), "neither u nor P");
}

TEST(names)
{
    static const char *const kinds[] = {"ST:Phantom", "F :Phantom", "FX", "AT", "T"};
    for (int k = 0; k < 5; k++) {
        struct dump d = made();
        snprintf(d.name, sizeof d.name, "%-100s", kinds[k]);
        refuses(put_all(&d), "allowed: FT, full and with tags");
    }
    struct dump d = made();
    d.value[5].tag = "nblocks", d.value[5].kind = 0, d.value[5].value = 2;
    refuses(put_all(&d), "in 2 blocks");
    d.value[5].value = 1;
    is_read(&d);
    for (int k = 0; k < 4; k++) { /* files with another beginning are not Phantom's */
        d = made();
        d.magic[k] += 1;
        refuses(put_all(&d), "no snapshot that is read");
    }
    d = made();
    d.name[99] = '\0';
    refuses(put_all(&d), "damaged: record 2 at byte 32, the name, has 99 bytes; allowed: 100");
    d = made();
    d.rows = 0;
    refuses(put_all(&d), "0 particles");
    d.rows = 1;
    refuses(put_all(&d), "1 gas particles");
    d = made();
    d.groups = 0;
    refuses(put_all(&d), "0 groups of arrays, 0 particles; allowed: at least one group");
    static const struct {
        size_t behind; /* bytes behind the beginning of the lengths */
        double value;
        int size;
        const char *says;
    } rows[] = {{0, (1 << 28) + 1., 8, "1 groups of arrays, 2.68435e+08 particles; allowed: "},
                {0, 1 << 28, 8, "has 14 bytes; allowed: 268435456"},
                {8, -1, 4, "damaged: -1 arrays of one kind; allowed: 0 to "},
                {8 + 4 * (KINDS - 1), 1e6, 4, "damaged: 1e+06 arrays of one kind"}};
    d = made();
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const size_t size = put_all(&d);
        at = lengths + rows[k].behind;
        put(&d, rows[k].value, rows[k].size, false);
        refuses(size, rows[k].says);
    }
}

/* A file that ends early or has any byte changed is refused or read. */
TEST(damaged)
{
    for (int swapped = 0; swapped < 2; swapped++) {
        struct dump d = made();
        d.swapped = swapped;
        const size_t size = put_all(&d);
        for (size_t cut = 1; cut < size - 31; cut += 7) { /* the first record is whole */
            char says[120];
            say_cut(bytes, size - cut, d.swapped, says);
            refuses(size - cut, *says ? says : "cut off: record");
        }
        for (size_t k = 0; k < size; k += 1 + k / 60) {
            struct snapshot_file file;
            struct error error;
            put_all(&d);
            bytes[k] ^= 0x81;
            const enum status status = read_bytes(size, &file, &error);
            assert_true(status == STATUS_OK || status == STATUS_BAD_INPUT);
            snapshot_file_free(&file);
        }
        put_all(&d);
        bytes[size - 1] ^= 1, bytes[size - 4] ^= 1;
        refuses(size, "damaged: record");
        put_all(&d);       /* a count in the header */
        at = 32 + 108 + 4; /* after magic numbers, name and count of bytes */
        put(&d, 5000, 4, false);
        refuses(size, "5000 values of one kind");
        put_all(&d);
        at = 32 + 108 + 4; /* after magic numbers, name and count of bytes */
        put(&d, -1, 4, false);
        refuses(size, "-1 values of one kind");
    }
}
