/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the readers of HDF5. Each layout is written from a list of all items that it may hold. Then
 * each item in turn is left out, stored in every other form (which must change nothing) or damaged
 * in every way (which must be refused or read as absent). */
#include "test.h"

#ifdef HAVE_HDF5
#include <fcntl.h>
#include <float.h>

#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include "sample_layouts.h"

#include "h5.h" /* after uses of the library's macros, which it changes */

TEST(missing_items)
{
    for (int a = 0; a < LAYOUTS; a++) {
        const struct layout *l = &layouts[a];
        struct item items[ITEMS_MAX];
        items_of(l, items);
        reads(l, items, "all");
        for (size_t k = 0; k < l->count; k++) {
            const char *name = strrchr(l->fields[k].path, '/') + 1;
            items_of(l, items);
            items[k].path[0] = '\0';
            if (l->fields[k].needed)
                refuses(l, items, l->fields[k].path, name);
            else if (l->fields[k].meaning == COLUMN && l->fields[k].column == SNAPSHOT_X + 1)
                refuses(l, items, l->fields[k].path, "has z but no y");
            else
                reads(l, items, l->fields[k].path);
        }
        /* particles without masses, with and without a mass in the header's table */
        items_of(l, items);
        for (size_t k = 0; k < l->count && !a; k++)
            if (l->fields[k].column == SNAPSHOT_M)
                items[k].path[0] = '\0';
            else if (l->fields[k].meaning == MASS)
                items[k].shape[0] = 1;
        reads(l, items, "a table of one mass");
        for (size_t k = 0; k < l->count && !a; k++)
            if (l->fields[k].meaning == MASS) items[k].values[0] = 0;
        if (!a)
            refuses(l, items, "a table of no mass",
                    "no PartType0/Masses, and Header/MassTable[0] = 0; allowed: above 0");
        items_of(l, items);
        bool named = false;
        for (size_t k = 0; k < l->count; k++)
            if (l->fields[k].column == SNAPSHOT_M) items[k].path[0] = '\0', named = true;
        for (size_t k = 0; k < l->count; k++)
            if (l->fields[k].meaning == MASS) items[k].path[0] = '\0';
        if (named)
            refuses(
                l, items, "no masses",
                a < 2 ? "no masses: no PartType0/Masses, and no Header/MassTable; allowed: above 0"
                      : "no masses: neither Step#10/m nor its attribute particleMass");
        /* both of two alternatives are missing */
        items_of(l, items);
        for (size_t k = 0; k < l->count; k++)
            if (l->fields[k].column == SNAPSHOT_U || l->fields[k].column == SNAPSHOT_P)
                items[k].path[0] = '\0';
        refuses(l, items, "no energies", "neither u nor P");
    }
}

/* The file may begin after a user block of 512 bytes or a power of 2 times that. */
TEST(file_after_a_user_block)
{
    static char bytes[1 << 16];
    struct item items[ITEMS_MAX];
    struct snapshot_file file;
    struct error error = {0};
    items_of(&layouts[0], items);
    for (size_t block = 512; block <= 4096; block *= 2) {
        write_items(path_of("a.hdf5"), items, layouts[0].count);
        FILE *of = fopen(path_of("a.hdf5"), "r+");
        assert_non_null(of);
        const size_t n = fread(bytes + block, 1, sizeof bytes - block, of);
        assert_true(n > 0 && n < sizeof bytes - block);
        memset(bytes, '#', block);
        rewind(of);
        assert_true(fwrite(bytes, 1, block + n, of) == block + n && fclose(of) == 0);
        if (snapshot_read(path_of("a.hdf5"), &here, &file, &error)) fail_msg("%s", error.message);
        is_read(&layouts[0], items, &file);
        snapshot_file_free(&file);
    }
}

static hid_t crash(const char *path, unsigned flags, hid_t how)
{
    (void)path, (void)flags, (void)how;
    abort();
}

TEST(reading_in_a_process)
{
    struct rlimit usual, none;
    struct snapshot_file file;
    struct error error = {0};
    struct item items[ITEMS_MAX];
    char folder[] = "TMPDIR=no_such_folder";
    here.here = false;
    missing_items(state);
    write_items(path_of("a.hdf5"), items, items_of(&layouts[0], items));
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &usual), 0);
    none = usual, none.rlim_cur = 1000;
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &none), 0);
    const enum status full = snapshot_read(path_of("a.hdf5"), &here, &file, &error);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &usual), 0);
    assert_int_equal(full, STATUS_ENVIRONMENT);
    if (!strstr(error.message, "no space for what")) fail_msg("%s", error.message);
    snapshot_file_free(&file);
    FILE *junk = fopen(path_of("junk.hdf5"), "wb");
    fputs("\x89HDF\r\n\x1a\n and no more", junk);
    fclose(junk);
    for (int k = 0; k < 2; k++) {
        const int next = open("/dev/null", O_RDONLY);
        close(next);
        here.here = k;
        assert_int_equal(snapshot_read(path_of("junk.hdf5"), &here, &file, &error),
                         STATUS_BAD_INPUT);
        const int still = open("/dev/null", O_RDONLY); /* no file stays open */
        close(still);
        assert_int_equal(still, next);
        if (!strstr(error.message, "begins as HDF5, but its library cannot open it"))
            fail_msg("%s", error.message);
        snapshot_file_free(&file);
    }
    here.here = false;
    const __typeof__(h5.Fopen) usual_open = h5.Fopen;
    h5.Fopen = crash;
    is_refused("a.hdf5", &here, "a crash",
               "damaged or hostile: the HDF5 library crashes (Aborted)");
    h5.Fopen = usual_open;
    const char *usual_folder = getenv("TMPDIR");
    putenv(folder);
    assert_int_equal(snapshot_read(path_of("a.hdf5"), &here, &file, &error), STATUS_ENVIRONMENT);
    if (!strstr(error.message, "no temporary file for what")) fail_msg("%s", error.message);
    snapshot_file_free(&file);
    if (usual_folder)
        setenv("TMPDIR", usual_folder, 1);
    else
        unsetenv("TMPDIR");
    here.here = true;
}

/* Numbers may be stored in any type and layout: what is read does not differ. */
TEST(other_forms)
{
    static const enum stored numbers[] = {F32, F32_BIG, F80, F16, I64, I32_BIG};
    for (int a = 0; a < LAYOUTS; a++) {
        const struct layout *l = &layouts[a];
        for (size_t k = 0; k < l->count; k++) {
            const struct field *f = &l->fields[k];
            struct item items[ITEMS_MAX];
            for (size_t s = 0; s < sizeof numbers / sizeof *numbers && !f->text; s++) {
                items_of(l, items);
                items[k].stored = numbers[s];
                reads(l, items, f->path);
            }
            items_of(l, items);
            items[k].packed = true;
            if (is_column(f)) reads(l, items, f->path);
            if (is_column(f) && f->width == 1) { /* N x 1 */
                items[k].rank = 2;
                items[k].shape[1] = 1;
                reads(l, items, f->path);
            }
            if (is_column(f)) continue;
            items_of(l, items);
            for (int form = 0; form < 8; form++) { /* an attribute or a dataset, in any shape */
                items[k].attribute = form % 2;
                if (f->text && !items[k].attribute) continue;
                if (f->width <= 1) items[k].rank = form / 2 % 3;
                if (f->width <= 1 && items[k].rank) items[k].shape[0] = items[k].shape[1] = 1;
                if (f->text) items[k].stored = form / 4 ? TEXT_VARIABLE : TEXT;
                reads(l, items, f->path);
            }
            items_of(l, items);
            items[k].shape[0]++; /* a list that is longer than what is taken of it */
            if (f->meaning == BOX || f->meaning == MASS) reads(l, items, f->path);
        }
    }
}

static double fault_of(int fault)
{
    const double faults[] = {(double)NAN, (double)INFINITY, (double)-INFINITY, 1e101, -1e101};
    return faults[fault];
}

/* True for Phantom's particles without a width, which are not counted. */
static bool is_dead(const struct layout *l, const struct field *f, double h)
{
    return strcmp(l->name, "phantom_hdf5") == 0 && f->column == SNAPSHOT_H && h <= 0;
}

static void allows(const struct item *items, size_t n)
{
    struct snapshot_file file;
    struct error error;
    write_items(path_of("a.hdf5"), items, n);
    if (read_gas("a.hdf5", &here, &file, &error)) fail_msg("%s", error.message);
    snapshot_file_free(&file);
}

/* Columns of another shape, columns of words, a group in place of a column, and impossible
 * values. */
TEST(damaged_columns)
{
    for (int a = 0; a < LAYOUTS; a++) {
        const struct layout *l = &layouts[a];
        for (size_t k = 0; k < l->count; k++) {
            const struct field *f = &l->fields[k];
            const bool first = f->column == SNAPSHOT_X && f->meaning == COLUMN,
                       vector = f->meaning == COLUMN &&
                                (f->column == SNAPSHOT_X || f->column == SNAPSHOT_VX ||
                                 f->column == SNAPSHOT_AX);
            struct item items[ITEMS_MAX];
            char says[80];
            if (!is_column(f) || f->meaning == IGNORED) continue;
            for (int more = -1; more < 2; more += 2) {
                items_of(l, items);
                items[k].shape[0] = (hsize_t)(N + more);
                /* the number of rows differs from that of the positions, or from the count in the
                 * header */
                snprintf(says, sizeof says, "%s has %d x %d numbers; allowed: %d x %s", f->path,
                         N + more, f->width, N, vector ? "1 to 3" : "1");
                refuses(l, items, f->path, first ? "allowed: 1" : says);
            }
            items_of(l, items);
            items[k].rank = 2;
            items[k].shape[1] = 4;
            refuses(l, items, f->path, "12 x 4");
            items[k].shape[1] = 2;
            if (!vector) refuses(l, items, f->path, "12 x 2");
            items[k].shape[1] = 4;
            items[k].shape[0] = 0;
            refuses(l, items, f->path, first ? "no particles" : "0 x 4");
            items[k].shape[0] = N, items[k].shape[1] = 0;
            refuses(l, items, f->path, "12 x 0");
            items[k].shape[0] = ((hsize_t)1 << 28) + 1, items[k].shape[1] = 1;
            refuses(l, items, f->path,
                    first ? "268435457 particles; allowed: up to 268435456" : "has 268435457 x 1");
            items[k].shape[0]--, items[k].shape[1] = 4;
            refuses(l, items, f->path, "has 268435456 x 4");
            items[k].rank = 3;
            items[k].shape[0] = N, items[k].shape[1] = items[k].shape[2] = 1;
            refuses(l, items, f->path, "no table of numbers, but numbers with 3 indices");
            items_of(l, items);
            static const char *const instead[] = {"text", "text", "something else",
                                                  "something else", "a group"};
            for (int form = TEXT; form <= GROUP; form++) {
                items[k].stored = (enum stored)form;
                snprintf(says, sizeof says, "%s no table of numbers, but %s",
                         first ? "no particles, or" : "is", instead[form - TEXT]);
                refuses(l, items, f->path, says);
            }
            if (f->meaning == TYPES) continue;
            for (int fault = 0; fault < 5; fault++)
                for (int c = 0; c < f->width; c++) {
                    items_of(l, items);
                    items[k].values[5 * f->width + c] = fault_of(fault);
                    if (is_dead(l, f, fault_of(fault))) continue;
                    snprintf(says, sizeof says, "%s of particle %d is",
                             snapshot_column_names[f->column + (unsigned)c],
                             field_of(l, items, TYPES) ? 3 : 5);
                    refuses(l, items, f->path, says);
                }
            for (int fault = 0; fault < 2; fault++) { /* 0 and a negative value */
                const bool above = f->column == SNAPSHOT_M || f->column == SNAPSHOT_RHO ||
                                   f->column == SNAPSHOT_H,
                           below = f->column == SNAPSHOT_U || f->column == SNAPSHOT_P;
                items_of(l, items);
                items[k].values[5 * f->width] = fault ? -DBL_MIN : 0;
                if (is_dead(l, f, 0)) continue;
                snprintf(says, sizeof says, "%s of particle %d is %s; allowed: %s",
                         snapshot_column_names[f->column], field_of(l, items, TYPES) ? 3 : 5,
                         fault ? "-2.22507e-308" : "0", above ? "above 0" : "0 or above");
                if (above || (below && fault))
                    refuses(l, items, f->path, says);
                else if (below)
                    allows(items, l->count);
            }
        }
    }
}

/* Changes the first byte of all compressed pieces of a file. */
static void damage_pieces(const char *path)
{
    static unsigned char bytes[1 << 16];
    FILE *of = fopen(path, "r+b");
    assert_non_null(of);
    const size_t n = fread(bytes, 1, sizeof bytes, of);
    int damaged = 0;
    for (size_t i = 0; i + 2 < n; i++)
        if (bytes[i] == 0x78 && bytes[i + 1] == 0x5e) bytes[i + 2] ^= 7, damaged++;
    rewind(of);
    assert_true(damaged > 0 && fwrite(bytes, 1, n, of) == n && fclose(of) == 0);
}

/* Damaged columns are refused; numbers of the header that cannot be read count as missing. */
TEST(damaged_pieces)
{
    for (int a = 0; a < LAYOUTS; a++)
        for (size_t k = 0; k < layouts[a].count; k++) {
            const struct field *f = &layouts[a].fields[k];
            struct item items[ITEMS_MAX];
            struct snapshot_file file;
            struct error error = {0};
            char says[120];
            if (f->meaning != BOX && (!is_column(f) || f->meaning == IGNORED)) continue;
            const size_t n = items_of(&layouts[a], items);
            items[k].packed = true, items[k].attribute = false;
            write_items(path_of("a.hdf5"), items, n);
            damage_pieces(path_of("a.hdf5"));
            const enum status status = snapshot_read(path_of("a.hdf5"), &here, &file, &error);
            snprintf(says, sizeof says, "%s cannot be read: damaged, or packed by", f->path);
            assert_int_equal(status, f->meaning == BOX ? STATUS_OK : STATUS_BAD_INPUT);
            if (status)
                assert_non_null(strstr(error.message, says));
            else
                assert_false(file.boxed);
            snapshot_file_free(&file);
        }
}

static int freed; /* texts of the library */
static __typeof__(h5.free_memory) usual_free;

static herr_t free_counted(void *memory)
{
    freed++;
    return usual_free(memory);
}

/* A text of the header is one text of less than 4096 letters, else it counts as missing. */
TEST(texts)
{
    usual_free = h5.free_memory;
    h5.free_memory = free_counted;
    static const struct {
        enum stored stored;
        int rank;
        hsize_t count;
        const char *text;
        size_t letters, length; /* length: of what is read */
    } rows[] = {{TEXT, 0, 1, "Quartic", 0, 7},   {TEXT, 1, 1, "Quartic", 0, 7},
                {TEXT, 1, 2, "Quartic", 0, 0},   {TEXT_VARIABLE, 0, 1, "Quartic", 0, 7},
                {TEXT_VARIABLE, 0, 1, "", 0, 0}, {TEXT, 0, 1, "", 47, 47},
                {TEXT, 0, 1, "", 4095, 47},      {TEXT, 0, 1, "", 4096, 0},
                {F64, 0, 1, "", 0, 0},           {TEXT, 0, 1, "Q\x1b[2J", 0, 5}};
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        struct item items[ITEMS_MAX];
        const size_t n = items_of(&layouts[1], items);
        for (size_t k = 0; k < n; k++)
            if (layouts[1].fields[k].meaning == KERNEL) {
                items[k].stored = rows[r].stored, items[k].rank = rows[r].rank;
                items[k].shape[0] = rows[r].count, items[k].letters = rows[r].letters;
                strcpy(items[k].text, rows[r].text);
            }
        freed = 0;
        struct snapshot_file file = file_of(items, n, rows[r].text);
        assert_int_equal(freed, rows[r].stored == TEXT_VARIABLE && rows[r].length);
        assert_int_equal(strlen(file.kernel), rows[r].length);
        assert_null(strchr(file.kernel, '\x1b'));
        assert_true(!rows[r].length || file.kernel[0] == (rows[r].letters ? 'k' : 'Q'));
        snapshot_file_free(&file);
    }
    h5.free_memory = usual_free;
}

/* In the header: text, an empty list, one that is too long, a value that is not a number. */
TEST(damaged_numbers)
{
    for (int a = 0; a < LAYOUTS; a++) {
        const struct layout *l = &layouts[a];
        for (size_t k = 0; k < l->count; k++) {
            const struct field *f = &l->fields[k];
            const char *name = strrchr(f->path, '/') + 1;
            struct item items[ITEMS_MAX];
            if (is_column(f) || f->text || f->meaning == IGNORED) continue;
            for (int form = 0; form < 4; form++) {
                static const hsize_t count[] = {1, 0, 4097, 7};
                items_of(l, items);
                items[k].attribute = !form, items[k].rank = form > 0,
                items[k].shape[0] = count[form];
                items[k].stored = form ? F64 : TEXT;
                if (form == 3 && f->meaning != BOX_ENDS) continue;
                if (f->needed) {
                    refuses(l, items, f->path, name);
                    continue;
                }
                struct snapshot_file file = file_of(items, l->count, f->path);
                assert_false(file.time.known && f->meaning == TIME);
                assert_false(file.boxed && (f->meaning == BOX || f->meaning == BOX_ENDS));
                snapshot_file_free(&file);
            }
            items_of(l, items);
            items[k].values[0] = (double)NAN;
            if (f->meaning == TIME) refuses(l, items, f->path, "time = nan");
            if (f->meaning == PARTS || f->meaning == COUNT || f->needed)
                refuses(l, items, f->path, name);
            items[k].values[0] = 0;
            if (f->meaning == PARTS || f->meaning == COUNT || f->needed)
                refuses(l, items, f->path, name);
            items[k].values[0] = SNAPSHOT_PARTS_MAX;
            if (f->meaning == PARTS) refuses(l, items, f->path, "one of 512 files");
            items[k].values[0] = SNAPSHOT_PARTS_MAX + 1;
            if (f->meaning == PARTS) refuses(l, items, f->path, "allowed: 1 to 512");
            items[k].values[0] = 2;
            if (f->meaning == PARTS) refuses(l, items, f->path, "one of 2 files");
            if (f->meaning == DIMENSION)
                refuses(l, items, f->path, "says that it has 2 dimensions");
            items[k].values[0] = N + 1;
            if (f->meaning == COUNT)
                refuses(l, items, f->path, "13 gas particles, PartType0 has 12");
        }
    }
}

#endif
