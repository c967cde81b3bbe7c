/* SPDX-License-Identifier: GPL-3.0-or-later
 * Reads GADGET binaries with random particles of all types, written in every form: formats 1 and 2,
 * both byte orders, words of 4 and 8 bytes, masses in the header or in a block, missing blocks.
 * Every written value must be read, and damaged files must be refused. */
#include "test.h"

#include "cut_records.h"
#include "drawn_gadget.h"

TEST(every_form)
{
    for (int draw = 0; draw < 400; draw++) {
        struct binary b = made(1 + draw % 3);
        b.tagged = draw % 2, b.swapped = draw / 2 % 2;
        b.extra = drawn(3);
        if (drawn(4) == 0)
            b.box = (const double[]){0, -1, 1.1 * SIDE,
                                     2.5 * SIDE}[drawn(4)]; /* or one that is not full */
        if (drawn(4) == 0) b.parts = 0;
        b.there[ID] = !b.tagged || drawn(2);
        b.there[ACCE] = b.tagged && drawn(2); /* without its name the block cannot be recognised */
        b.there[HSML] = drawn(3) || !b.tagged;
        b.width[ACCE] = b.width[VEL];
        if (b.tagged && drawn(3) == 0) b.rows[ACCE] = b.rows[POS]; /* rows for all particles */
        is_read(&b, "a draw");
    }
    for (int all = 0; all < 2; all++) { /* as many words of 4 bytes for all as of 8 for the gas */
        struct binary b = made(1);
        for (int t = 0; t < TYPES; t++) b.count[t] = t < 2 ? 8 : 0, b.table[t] = 100;
        for (int k = POS; k <= ID; k++) b.rows[k] = 16;
        for (int k = U; k <= HSML; k++) b.rows[k] = 8;
        b.rows[ACCE] = all ? 16 : 8, b.width[VEL] = b.width[ACCE] = all ? 4 : 8;
        b.there[MASS] = false;
        is_read(&b, "as many other particles");
    }
    struct binary b = made(2);
    b.box = (double)INFINITY;
    is_read(&b, "an infinite box");
    b.there[HSML] = b.there[ACCE] = b.tagged = false; /* so that densities are the last block */
    b.box = SIDE;
    is_read(&b, "without widths");
    b.there[ID] = false;
    is_read(&b, "without numbers of particles");
    struct snapshot_file file; /* what stands behind the densities is too long for widths */
    struct error error;
    if (read_bytes(put_block(put_all(&b), &b, ACCE), &file, &error)) fail_msg("%s", error.message);
    assert_true(file.column[SNAPSHOT_RHO] && !file.column[SNAPSHOT_H] && !file.column[SNAPSHOT_AX]);
    snapshot_file_free(&file);
}

TEST(missing_blocks)
{
    static const char *const says[BLOCKS] = {
        "; the record has 0", "; the record has 0", NULL, "no block 'MASS'",
        "neither u nor P",    "no block 'RHO '",    NULL, NULL};
    for (int k = 0; k < BLOCKS; k++)
        for (int draw = 0; draw < 4; draw++) {
            struct binary b = made(1 + draw % 3);
            b.table[0] = 0; /* so that its mass is in a block */
            b.rows[MASS] = 0;
            for (int t = 0; t < TYPES; t++) b.rows[MASS] += b.table[t] > 0 ? 0 : b.count[t];
            for (size_t i = 0; i < b.rows[MASS]; i++) b.value[MASS][i] = 1;
            b.there[MASS] = true;
            b.there[k] = false;
            if (says[k])
                refuses(put_all(&b), tags[k], says[k]);
            else
                is_read(&b, tags[k]);
            b.there[k] = true; /* the block has one row too many */
            const size_t each = is_vector(k) ? 3 : 1, n = b.rows[k]++,
                         size = (n + 1) * each * (size_t)b.width[k];
            char words[120];
            if (k <= VEL)
                snprintf(words, sizeof words,
                         "%s of %zu particles take %zu or %zu bytes; the record has %zu",
                         k ? "velocities" : "positions", n, 12 * n, 24 * n, size);
            else
                snprintf(words, sizeof words, "block '%s' has %zu bytes; allowed: %zu or %zu",
                         tags[k], size, 4 * each * n, 8 * each * n);
            if (k == ID)
                is_read(&b, tags[k]);
            else
                refuses(put_all(&b), tags[k], words);
        }
    struct binary b = made(1); /* all have masses in the table: no block is needed */
    for (int t = 0; t < TYPES; t++) b.table[t] = 2;
    b.there[MASS] = false;
    is_read(&b, "masses in the table");
}

/* Files that end early at any byte, and files with a wrong count or name at their beginning. */
TEST(truncated_files)
{
    for (int form = 0; form < 4; form++) {
        struct binary b = made(1);
        b.tagged = form % 2, b.swapped = form / 2;
        b.there[HSML] = b.there[ACCE] = !b.tagged; /* whole only with its last block */
        const size_t size = put_all(&b), head = b.tagged ? 280 : 264;
        for (size_t cut = 1; cut + head < size; cut += 1 + cut / 8) {
            char says[120] = "";
            if (!b.tagged) say_cut(bytes, size - cut, b.swapped, says);
            refuses(size - cut, "cut off", says);
        }
        for (int wrong = 0; wrong < 3 && b.tagged; wrong++) { /* counts, or the first name */
            if (wrong < 2) put_count(wrong ? 12 : 0, &b, 9);
            if (wrong == 2) bytes[7] = 'X';
            refuses(size, "no beginning", "no snapshot that is read");
            put_all(&b);
        }
        if (b.tagged) { /* with a header that is too short */
            memmove(bytes + 272, bytes + 276, size - 276);
            put_count(16, &b, 252);
            put_count(272, &b, 252);
            refuses(size - 4, "a short header", "the first of 252 bytes; allowed: a header of 256");
            put_all(&b);
        }
        if (!b.tagged) refuses(head - 1, "less than a header", "no snapshot that is read");
        refuses(head, "a header alone",
                "1 records, the first of 256 bytes; allowed: a header of 256 bytes");
        for (size_t at = head - 4; at < size; at += at < head ? 1 : 1 + at % 97) {
            put_all(&b);
            bytes[at] ^= 0x40;
            struct snapshot_file file;
            struct error error;
            const enum status status = read_bytes(size, &file, &error);
            assert_true(status == STATUS_OK || status == STATUS_BAD_INPUT);
            snapshot_file_free(&file);
        }
        put_all(&b);
        bytes[size - 4] ^= 1, bytes[size - 1] ^= 1; /* the lowest byte in either byte order */
        size_t records = 1, last = 0;
        char words[80];
        for (int k = 0; k < BLOCKS; k++)
            if (b.there[k])
                records++, last = b.rows[k] * (is_vector(k) ? 3 : 1) * (size_t)b.width[k];
        snprintf(words, sizeof words, "damaged: record %zu at byte %zu begins with %zu and ends",
                 records, size - last - 8, last);
        refuses(size, "a wrong count", words);
    }
}

TEST(headers)
{
    static const struct {
        const char *says;
        int count; /* the type whose count changes; -1: none */
        uint32_t to;
        int mass;
        double mass_to, time, redshift;
        uint32_t parts;
        bool fits;
    } rows[] = {
        {"no gas: 3 particles of other types (dark matter only?)", 0, 0, -1, 0, 1, 0, 1, false},
        {"header: 536870912 particles of type 2", 2, 1u << 29, -1, 0, 1, 0, 1, false},
        {"positions of 268435", 2, 1u << 28, -1, 0, 1, 0, 1, false},
        {"header: 268435457 particles of type 0", 0, (1u << 28) + 1, -1, 0, 1, 0, 1, false},
        {"of type 5, of mass nan", -1, 0, 5, (double)NAN, 1, 0, 1, false},
        {"of type 0, of mass -1", -1, 0, 0, -1, 1, 0, 1, false},
        {"of type 3, of mass inf", -1, 0, 3, (double)INFINITY, 1, 0, 1, false},
        {"header: time nan", -1, 0, -1, 0, (double)NAN, 0, 1, false},
        {"header: time inf", -1, 0, -1, 0, (double)INFINITY, 0, 1, false},
        {"header: time 1, 513 files", -1, 0, -1, 0, 1, 0, 513, false},
        {"header: time 1, -1 files", -1, 0, -1, 0, 1, 0, UINT32_MAX, false},
        {"one of 512 files", -1, 0, -1, 0, 1, 0, 512, false},
        {"comoving units (redshift 1 at time 0.5)", -1, 0, -1, 0, 0.5, 1, 1, false},
        {"comoving", -1, 0, -1, 0, 0.5 * (1 + 9e-7), 1, 1, false},
        {"", -1, 0, -1, 0, 0.5 * (1 + 2e-6), 1, 1, true},
        {"", -1, 0, -1, 0, 1, 0, 1, true},
        {"", -1, 0, -1, 0, 2, -0.5, 1, true}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct binary b = made(1);
        for (int t = 1; t < TYPES; t++) b.count[t] = t == 1 ? 3 : 0, b.table[t] = 1;
        b.rows[POS] = b.rows[VEL] = b.rows[ID] = b.count[0] + 3;
        b.table[0] = 0, b.rows[MASS] = b.count[0], b.there[MASS] = true;
        for (size_t i = 0; i < b.rows[MASS]; i++) b.value[MASS][i] = 1;
        if (rows[k].count >= 0) b.count[rows[k].count] = rows[k].to;
        if (rows[k].mass >= 0) b.table[rows[k].mass] = rows[k].mass_to;
        b.time = rows[k].time, b.redshift = rows[k].redshift, b.parts = rows[k].parts;
        if (rows[k].fits)
            is_read(&b, "a header");
        else
            refuses(put_all(&b), "a header", rows[k].says);
    }
}

TEST(no_gas)
{
    struct binary b = made(1);
    for (int t = 0; t < TYPES; t++) b.count[t] = t == 4;
    struct snapshot_file file;
    struct error error;
    assert_int_equal(read_bytes(put_all(&b), &file, &error), STATUS_BAD_INPUT);
    const char *end = strstr(error.message, ": no gas: ");
    assert_string_equal(end ? end : error.message, ": no gas: 1 particles of other types");
    snapshot_file_free(&file);
}

/* Format 1 has no names: exactly one assignment of the blocks must be plausible. */
TEST(inferred_blocks)
{
    static const struct {
        int block;
        double factor; /* applied to all values of the block */
        bool fits;
    } rows[] = {{RHO, 1, true},       {RHO, 1.9, true},   {RHO, 2.1, false},   {RHO, 0.55, true},
                {RHO, 0.45, false},   {RHO, -1, false},   {U, -1, false},      {U, 0, false},
                {MASS, -1, false},    {MASS, 1.9, true},  {MASS, 2.1, false},  {MASS, 0.55, true},
                {MASS, 0.45, false},  {HSML, 14.9, true}, {HSML, 15.1, false}, {HSML, 0.151, true},
                {HSML, 0.149, false}, {HSML, -1, false},  {U, 1e31, false},    {U, 1e-31, false},
                {U, 1e29, true},      {U, 1e-29, true}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        for (int which = 0; which < 6; which++) {
            const int dim = 1 + which % 3;
            const double unit = which < 3 ? 1 : dim < 3 ? 0x1p-50 : 0x1p-30; /* of lengths */
            struct binary b = made(dim);
            b.tagged = b.there[ACCE] = false;
            b.table[0] = 0, b.there[MASS] = true;
            b.box *= unit;
            for (size_t i = 0; i < 3 * b.rows[POS]; i++) b.value[POS][i] *= unit;
            b.rows[MASS] = 0;
            for (int t = 0; t < TYPES; t++) b.rows[MASS] += b.table[t] > 0 ? 0 : b.count[t];
            for (size_t i = 0; i < MOST; i++) { /* widths of twice the spacing */
                b.value[RHO][i] = 1, b.value[MASS][i] = pow(unit * SIDE, dim) / b.count[0];
                const double spacing = pow(b.value[MASS][i], 1. / dim);
                b.value[HSML][i] = 2 * spacing;
            }
            for (int w = MASS; w <= HSML; w++) b.width[w] = 8;
            for (size_t i = 0; i < MOST; i++) b.value[rows[k].block][i] *= rows[k].factor;
            if (rows[k].block == RHO) /* widths follow the spacing */
                for (size_t i = 0; i < MOST; i++)
                    b.value[HSML][i] = 2 * pow(b.value[MASS][i] / fabs(b.value[RHO][i]), 1. / dim);
            if (rows[k].block == MASS)
                for (size_t i = 0; i < MOST; i++)
                    b.value[HSML][i] = 2 * pow(fabs(b.value[MASS][i]), 1. / dim);
            if (rows[k].fits)
                is_read(&b, "plausible");
            else
                refuses(put_all(&b), "implausible", "none fit as masses, energies");
        }
    struct binary b = made(1);
    b.tagged = false;
    for (int k = ID; k < BLOCKS; k++) b.there[k] = false;
    refuses(put_all(&b), "nothing but positions and velocities", "of 3 records none fit");
    b.there[VEL] = false;
    refuses(put_all(&b), "positions alone", "2 records, the first of 256 bytes");
    b = made(1); /* the same blocks twice */
    b.tagged = b.there[ACCE] = false;
    for (int t = 0; t < TYPES; t++) b.table[t] = t ? 1 : 0;
    b.rows[MASS] = b.count[0], b.there[MASS] = true;
    for (size_t i = 0; i < MOST; i++) {
        b.value[RHO][i] = 1.5, b.value[MASS][i] = (double)SIDE / b.count[0];
        b.value[HSML][i] = 2 * b.value[MASS][i];
    }
    b.width[MASS] = b.width[U] = b.width[RHO] = b.width[HSML] = 8;
    size_t size = put_all(&b);
    for (int k = MASS; k <= HSML; k++) size = put_block(size, &b, k);
    refuses(size, "twice", "more than one choice fits");
    b = made(1); /* u and rho again, without widths: the choice with widths counts */
    b.tagged = b.there[ACCE] = b.there[MASS] = false;
    for (int t = 0; t < TYPES; t++) b.table[t] = t ? 1 : 1.5 * SIDE / b.count[0];
    for (size_t i = 0; i < MOST; i++) b.value[U][i] *= 10;
    struct snapshot_file file;
    struct error error;
    size = put_block(put_block(put_all(&b), &b, U), &b, RHO);
    if (read_bytes(size, &file, &error)) fail_msg("%s", error.message);
    assert_non_null(file.column[SNAPSHOT_H]);
    snapshot_file_free(&file);
}

TEST(records)
{
    for (int more = 0; more < 2; more++) {
        struct binary b = made(2);
        b.there[MASS] = true;
        size_t blocks = 1;
        for (int k = 0; k < BLOCKS; k++) blocks += b.there[k];
        b.extra = 64 - blocks + (size_t)more;
        if (b.table[0] > 0 && b.rows[MASS] == 0) b.value[MASS][0] = 1;
        if (more)
            refuses(put_all(&b), "many records", "more than 64 records");
        else
            is_read(&b, "64 records");
    }
    struct binary b = made(1); /* of two blocks with one name the first counts */
    size_t size = put_all(&b);
    for (size_t i = 0; i < MOST; i++) b.value[RHO][i] *= 2;
    put_block(size, &b, RHO);
    const size_t all = put_block(size, &b, RHO);
    struct snapshot_file file;
    struct error error;
    assert_int_equal(read_bytes(all, &file, &error), STATUS_OK);
    assert_true(file.column[SNAPSHOT_RHO][3] == b.value[RHO][3] / 2);
    snapshot_file_free(&file);
    assert_int_equal(read_bytes(put_count(put_count(all, &b, 0), &b, 0), &file, &error), STATUS_OK);
    snapshot_file_free(&file); /* with an empty record at its end */
    b = made(1);               /* a message names as many blocks as it has room for */
    b.there[MASS] = b.there[RHO] = false, b.extra = 40;
    char names[300] = "no block 'RHO '; it has: 'POS ' 'VEL ' 'ID  '";
    for (int k = 3; k < 28; k++) strcat(names, k == 3 ? " 'M  ~'" : " 'MINE'");
    for (int t = 0; t < TYPES; t++) b.table[t] = 1;
    size = put_all(&b);
    unsigned char *mine = bytes;
    while (memcmp(mine, "MINE", 4) != 0) mine++;
    mine[1] = 127, mine[2] = 1, mine[3] = '~'; /* the first two are no letters */
    assert_int_equal(read_bytes(size, &file, &error), STATUS_BAD_INPUT);
    const char *block = strstr(error.message, "no block");
    assert_string_equal(block ? block : error.message, names);
    snapshot_file_free(&file);
    b.extra = 0; /* and no more than there are */
    b.there[MASS] = b.there[ID] = b.there[U] = b.there[HSML] = b.there[ACCE] = false;
    assert_int_equal(read_bytes(put_all(&b), &file, &error), STATUS_BAD_INPUT);
    block = strstr(error.message, "no block");
    assert_string_equal(block ? block : error.message, "no block 'RHO '; it has: 'POS ' 'VEL '");
    snapshot_file_free(&file);
    /* a block may itself be 8 bytes long */
    bytes[put_count(0, &b, 7)] = 1;
    refuses(300, "seven bytes", "no snapshot that is read");
}
