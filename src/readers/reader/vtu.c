/* SPDX-License-Identifier: GPL-3.0-or-later
 * VTK XML with the particles as points of one piece (.vtu, .vtp), as written by sphproof, ParaView,
 * meshio and WriteVTK: numbers as text, base64 or appended, plain or compressed by zlib. Field data
 * apply to all particles: TimeValue or time, gamma, ndims, and in our own files also box, case,
 * boundary and keys. */
#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef HAVE_ZLIB
#include <zlib.h>
#endif

#include "fortran.h"
#include "text.h"
#include "text_table.h"
#include "vtk_type.h"

enum { WORD = 64, FIELD_MOST = 1200 };

struct vtk {
    const struct snapshot_source *source;
    struct error *error;
    bool swapped, compressed;     /* byte order; zlib */
    size_t head;                  /* bytes of a size field: 4 or 8 */
    const char *appended, *ended; /* after its '_'; NULL: none */
    bool raw;                     /* appended bytes are not base64 */
};

/* <NAME KEY="VALUE" ...>, or </NAME> */
struct tag {
    const char *name, *behind; /* the character after '>' */
    size_t length;             /* from the name up to '>' */
    bool closes;
};

struct array {
    char name[WORD], type[WORD];
    const char *at, *end;
    size_t components;
    bool text, raw;
};

/* Sets the error and returns false. */
__attribute__((format(printf, 2, 3))) static bool refuse(const struct vtk *vtk, const char *format,
                                                         ...)
{
    char what[300];
    va_list values;
    va_start(values, format);
    vsnprintf(what, sizeof what, format, values);
    va_end(values);
    error_set(vtk->error, STATUS_BAD_INPUT, "%.200s: XML of VTK: %s", vtk->source->path, what);
    return false;
}

static bool next_tag(const char *at, const char *end, struct tag *tag)
{
    while ((at = memchr(at, '<', (size_t)(end - at)))) {
        const char *stop = memchr(at, '>', (size_t)(end - at));
        if (!stop) return false;
        tag->closes = at[1] == '/';
        tag->name = at + 1 + tag->closes;
        tag->length = (size_t)(stop - tag->name);
        tag->behind = at = stop + 1;
        if (isalpha((unsigned char)tag->name[0])) return true;
    }
    return false;
}

static bool is_tag(const struct tag *tag, const char *name)
{
    const size_t n = strlen(name);
    return !strncmp(tag->name, name, n) && !isalnum((unsigned char)tag->name[n]);
}

/* The value of a key; "" if missing or longer than a word. */
static const char *value_of(const struct tag *tag, const char *key, char value[WORD])
{
    const size_t n = strlen(key);
    const char *at = tag->name, *end = at + tag->length;
    *value = '\0';
    for (;;) {
        const char *equals = memchr(at, '=', (size_t)(end - at));
        if (!equals || equals + 1 >= end) break;
        const char *stop = memchr(equals + 2, equals[1], (size_t)(end - equals - 2));
        if (!stop) break;
        const char *from = equals;
        while (from > at && isspace((unsigned char)from[-1])) from--;
        if ((size_t)(from - at) > n && !strncmp(from - n, key, n) &&
            isspace((unsigned char)from[-(long)n - 1]) && stop - equals - 2 < WORD) {
            snprintf(value, WORD, "%.*s", (int)(stop - equals - 2), equals + 2);
            return value;
        }
        at = stop;
    }
    return value;
}

/* ---- bytes ---- */

/* As malloc; sets the error if there is no memory. */
static void *allocate(const struct vtk *vtk, size_t size)
{
    void *memory = malloc(size);
    if (!memory)
        error_set(vtk->error, STATUS_ENVIRONMENT, "no memory for %.200s", vtk->source->path);
    return memory;
}

static int digit_of(char c)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char *found = c ? strchr(digits, c) : NULL;
    return found ? (int)(found - digits) : -1;
}

/* Decodes n bytes at array->at; *behind: position after them. False: the array is too short. */
static bool fetch(const struct array *array, size_t n, unsigned char *to, const char **behind)
{
    const size_t length = array->raw ? n : (n + 2) / 3 * 4;
    unsigned word = 0;
    if (length > (size_t)(array->end - array->at)) return false;
    const char *at = array->at;
    if (behind) *behind = at + length;
    if (array->raw) {
        memcpy(to, at, n);
        return true;
    }
    for (size_t k = 0, made = 0; made < n; k++) {
        const int digit = digit_of(at[k]);
        if (digit < 0) return false;
        word = word << 6 | (unsigned)digit;
        if (k % 4) to[made++] = (unsigned char)(word >> (6 - k % 4 * 2) & 255);
    }
    return true;
}

static uint64_t size_at(const struct vtk *vtk, const unsigned char *at)
{
    return fortran_unsigned(at, vtk->head, vtk->swapped);
}

#ifdef HAVE_ZLIB
/* Unpacks blocks; the array begins with their number, their size, the size of the last (0: equal)
 * and the compressed size of each. */
static bool unpack(const struct vtk *vtk, struct array array, size_t blocks, unsigned char *to,
                   size_t want)
{
    if (!blocks || blocks > want) return false;
    const size_t sizes = (3 + blocks) * vtk->head;
    unsigned char *head = allocate(vtk, sizes);
    if (!head || !fetch(&array, sizes, head, &array.at)) {
        free(head);
        return false;
    }
    const size_t left = (size_t)(array.end - array.at);
    const uint64_t block = size_at(vtk, head + vtk->head),
                   last = size_at(vtk, head + 2 * vtk->head);
    uint64_t *packed = allocate(vtk, blocks * sizeof *packed);
    bool well = packed != NULL;
    size_t all = 0, made = 0;
    for (size_t k = 0; well && k < blocks; k++) {
        packed[k] = size_at(vtk, head + (3 + k) * vtk->head);
        well = packed[k] <= left - all;
        all += packed[k];
    }
    unsigned char *bytes = well ? allocate(vtk, all) : NULL;
    well = bytes && fetch(&array, all, bytes, NULL);
    for (size_t k = 0, taken = 0; well && k < blocks; taken += packed[k++]) {
        const uint64_t full = k + 1 < blocks || !last ? block : last;
        uLongf size = (uLongf)(want - made);
        well =
            uncompress(to + made, &size, bytes + taken, (uLong)packed[k]) == Z_OK && size == full;
        made += size;
    }
    free(packed);
    free(head), free(bytes);
    return well && made == want;
}
#else
static bool unpack(const struct vtk *vtk, struct array array, size_t blocks, unsigned char *to,
                   size_t want)
{
    (void)array, (void)blocks, (void)to, (void)want;
    return refuse(vtk, "its numbers are packed by zlib, which this program was built without; "
                       "allowed: numbers that are not packed");
}
#endif

/* Reads the size and `want` bytes; `to` has space for both. */
static bool take_bytes(const struct vtk *vtk, const struct array *array, unsigned char *to,
                       size_t want)
{
    unsigned char head[sizeof(uint64_t)];
    if (!fetch(array, vtk->head, head, NULL)) return false;
    const uint64_t size = size_at(vtk, head);
    if (vtk->compressed) return unpack(vtk, *array, size, to + vtk->head, want);
    if (size != want)
        return refuse(vtk, "the array '%s' has %llu bytes; its points need %zu", array->name,
                      (unsigned long long)size, want);
    return fetch(array, vtk->head + want, to, NULL);
}

/* ---- numbers ---- */

static bool take_text(const struct vtk *vtk, const struct array *array, double *to, size_t n)
{
    const char *at = array->at;
    for (size_t i = 0; i < n; i++) {
        char word[WORD];
        size_t length = 0;
        while (isspace((unsigned char)*at)) at++; /* '<' ends the array */
        while (at < array->end && !isspace((unsigned char)*at) && length + 1 < sizeof word)
            word[length++] = *at++;
        word[length] = '\0';
        if (!text_table_number(word, to + i))
            return refuse(vtk, "the array '%s' has '%s' as number %zu of the %zu that it needs",
                          array->name, word, i + 1, n);
    }
    return true;
}

/* Reads n numbers. False: see error. */
static bool take_numbers(const struct vtk *vtk, const struct array *array, double *to, size_t n)
{
    const struct vtk_type *type = vtk_type_of(array->type);
    if (!type)
        return refuse(vtk,
                      "the array '%s' has numbers of the type '%s'; allowed: Float64, Float32, "
                      "and Int and UInt of 8 to 64 bits",
                      array->name, array->type);
    if (array->text) return take_text(vtk, array, to, n);
    unsigned char *bytes = allocate(vtk, type->width * n + vtk->head);
    bool well = bytes && take_bytes(vtk, array, bytes, type->width * n);
    for (size_t i = 0; well && i < n; i++)
        to[i] = vtk_number(type, bytes + vtk->head + i * type->width, vtk->swapped);
    free(bytes);
    if (!well && !vtk->error->status)
        refuse(vtk, "the array '%s' is cut off or damaged; its points need %zu numbers of type %s",
               array->name, n, array->type);
    return well;
}

/* ---- meaning of the arrays ---- */

static bool take_array(const struct vtk *vtk, const struct tag *tag, struct array *array)
{
    char format[WORD], number[WORD];
    double value;
    const char *end = (const char *)vtk->source->bytes + vtk->source->size;
    value_of(tag, "Name", array->name), value_of(tag, "type", array->type);
    value_of(tag, "format", format);
    array->components =
        text_real(value_of(tag, "NumberOfComponents", number), &value) && value >= 1 && value <= 9
            ? (size_t)value
            : 1;
    array->text = !strcmp(format, "ascii"), array->raw = false;
    array->at = tag->behind;
    array->end = memchr(array->at, '<', (size_t)(end - array->at));
    if (!array->end) return refuse(vtk, "the array '%s' is cut off: no tag ends it", array->name);
    if (!strcmp(format, "appended")) {
        const double most = vtk->appended ? (double)(vtk->ended - vtk->appended) : -1;
        if (!text_real(value_of(tag, "offset", number), &value) || value < 0 || value > most)
            return refuse(vtk,
                          "the array '%s' has the offset '%s'; allowed: 0 to %.0f, the length "
                          "of the appended data",
                          array->name, number, fmax(0, most));
        array->at = vtk->appended + (size_t)value, array->end = vtk->ended;
        array->raw = vtk->raw;
    } else if (!array->text && strcmp(format, "binary"))
        return refuse(vtk, "the array '%s' has the format '%s'; allowed: ascii, binary, appended",
                      array->name, format);
    while (!array->raw && array->at < array->end && isspace((unsigned char)*array->at)) array->at++;
    return true;
}

static bool take_points(const struct vtk *vtk, const struct array *array, int column,
                        struct snapshot_file *file)
{
    if (column < 0 || array->components > (vtk_is_vector(column) ? 3 : 1)) return true;
    for (int to = column; to < column + (int)array->components; to++)
        if (file->column[to])
            return refuse(vtk, "the array '%s' is a second one for %s; allowed: one", array->name,
                          snapshot_column_names[to]);
    double *all = allocate(vtk, file->n * array->components * sizeof *all);
    const bool well = all && take_numbers(vtk, array, all, file->n * array->components) &&
                      !vtk_columns(file, column, array->components, all, array->type,
                                   vtk->source->path, vtk->error);
    free(all);
    return well;
}

static void take_letters(const double *numbers, size_t n, char *to, size_t room)
{
    size_t used = 0;
    for (size_t i = 0; i < n && used + 1 < room; i++)
        if (numbers[i] >= ' ' && numbers[i] < 256) to[used++] = (char)(unsigned char)numbers[i];
    to[used] = '\0';
}

static bool take_field(const struct vtk *vtk, const struct tag *tag, const struct array *array,
                       struct snapshot_file *file)
{
    const struct {
        const char *name;
        struct snapshot_value *value; /* NULL: another number */
        char *text;                   /* NULL: numbers */
        size_t room;
    } known[] = {{.name = "TimeValue", .value = &file->time},
                 {.name = "TIME", .value = &file->time},
                 {.name = "time", .value = &file->time},
                 {.name = "gamma", .value = &file->gamma},
                 {.name = "ndims"},
                 {.name = "box"},
                 {"case", NULL, file->case_name, sizeof file->case_name},
                 {"keys", NULL, file->keys, sizeof file->keys},
                 {"boundary", NULL, file->boundary, sizeof file->boundary}};
    enum { KNOWN = sizeof known / sizeof *known };
    double numbers[FIELD_MOST], tuples = 1;
    char word[WORD];
    size_t k = 0;
    while (k < KNOWN && strcmp(known[k].name, array->name)) k++;
    if (k == KNOWN || !vtk_type_of(array->type)) return true;
    text_real(value_of(tag, "NumberOfTuples", word), &tuples);
    if (!(tuples >= 1 && tuples * (double)array->components <= FIELD_MOST))
        return refuse(vtk, "the field '%s' has %g x %zu numbers; allowed: 1 to %d", array->name,
                      tuples, array->components, FIELD_MOST);
    const size_t n = (size_t)tuples * array->components;
    if (!take_numbers(vtk, array, numbers, n)) return false;
    if (known[k].value == &file->gamma)
        snapshot_note(&file->notes, "gamma", "in the file", "its field gamma");
    if (known[k].value) {
        *known[k].value = (struct snapshot_value){true, numbers[0]};
    } else if (known[k].text) {
        take_letters(numbers, n, known[k].text, known[k].room);
    } else if (!strcmp(array->name, "ndims")) {
        if (numbers[0] == 1 || numbers[0] == 2 || numbers[0] == 3) file->dim = (int)numbers[0];
    } else {
        file->boxed = file->placed = n == 2 || n == 4 || n == 6;
        for (size_t d = 0; file->boxed && d < n / 2; d++) {
            file->corner[d] = numbers[2 * d], file->box[d] = numbers[2 * d + 1] - numbers[2 * d];
            if (!(file->box[d] > 0 && isfinite(file->box[d])))
                return refuse(vtk,
                              "the field 'box' goes from %g to %g; allowed: from the lower to "
                              "the upper end",
                              numbers[2 * d], numbers[2 * d + 1]);
        }
    }
    return true;
}

static bool begin(struct vtk *vtk, const struct tag *tag)
{
    char word[WORD];
    value_of(tag, "byte_order", word);
    vtk->swapped =
        !strcmp(word, __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? "BigEndian" : "LittleEndian");
    vtk->head = strcmp(value_of(tag, "header_type", word), "UInt64") ? 4 : 8;
    vtk->compressed = *value_of(tag, "compressor", word);
    if (vtk->compressed && strcmp(word, "vtkZLibDataCompressor"))
        return refuse(vtk, "the compressor '%s'; allowed: vtkZLibDataCompressor, or none", word);
    struct tag appended = *tag;
    const char *end = (const char *)vtk->source->bytes + vtk->source->size;
    while (next_tag(appended.behind, end, &appended))
        if (is_tag(&appended, "AppendedData")) {
            vtk->raw = !strcmp(value_of(&appended, "encoding", word), "raw");
            vtk->appended = memchr(appended.behind, '_', (size_t)(end - appended.behind));
            vtk->ended = end;
            if (!vtk->appended) return refuse(vtk, "AppendedData has no '_' before its bytes");
            vtk->appended++;
            break;
        }
    return true;
}

static bool take_tag(struct vtk *vtk, const struct tag *tag, const char **section,
                     struct snapshot_file *file)
{
    static const char *const sections[] = {"FieldData", "PointData", "Points",
                                           "CellData",  "Cells",     "Verts"};
    struct array array;
    char word[WORD];
    double n;
    if (is_tag(tag, "VTKFile") && !tag->closes) return begin(vtk, tag);
    if (is_tag(tag, "Piece") && !tag->closes) {
        if (file->n) return refuse(vtk, "has a second Piece; allowed: one with all points");
        /* zlib compresses by at most a factor of 1032 */
        const double most = (double)vtk->source->size * (vtk->compressed ? 1032 : 1);
        if (!text_real(value_of(tag, "NumberOfPoints", word), &n) || !(n >= 1) ||
            n > fmin(SNAPSHOT_ROWS_MAX, most) || n != floor(n))
            return refuse(vtk,
                          "NumberOfPoints = '%s'; allowed: 1 to %d, and no more than the file "
                          "has room for",
                          word, SNAPSHOT_ROWS_MAX);
        file->n = file->gas = (size_t)n;
    }
    for (size_t k = 0; k < sizeof sections / sizeof *sections; k++)
        if (is_tag(tag, sections[k])) *section = tag->closes ? "" : sections[k];
    if (!is_tag(tag, "DataArray") || tag->closes || !**section || **section == 'C') return true;
    if (!take_array(vtk, tag, &array)) return false;
    if (!strcmp(*section, "FieldData")) return take_field(vtk, tag, &array, file);
    if (!file->n)
        return refuse(vtk, "the array '%s' stands before any Piece; allowed: in one", array.name);
    if (!strcmp(*section, "Points")) return take_points(vtk, &array, SNAPSHOT_X, file);
    if (!strcmp(*section, "PointData"))
        return take_points(vtk, &array, snapshot_column_of(array.name), file);
    return true;
}

static bool recognises(const struct snapshot_source *source)
{
    char start[400];
    snprintf(start, sizeof start, "%.399s", source->hdf5 ? "" : (const char *)source->bytes);
    return start[strspn(start, " \t\r\n\xef\xbb\xbf")] == '<' && strstr(start, "<VTKFile");
}

static enum status read_vtu(const struct snapshot_source *source,
                            const struct snapshot_options *options, struct snapshot_file *file,
                            struct error *error)
{
    struct vtk vtk = {.source = source, .error = error};
    struct tag tag = {.behind = (const char *)source->bytes};
    static const char last[] = "</VTKFile>";
    const char *section = "", *end = tag.behind + source->size;
    (void)options;
    error->status = STATUS_OK;
    while (isspace((unsigned char)end[-1])) end--; /* it has a '<' */
    if ((size_t)(end - tag.behind) < strlen(last) || memcmp(end - strlen(last), last, strlen(last)))
        return error_set(error, STATUS_BAD_INPUT, "%.200s: is cut off: does not end with %s",
                         source->path, last);
    while (next_tag(tag.behind, vtk.appended ? vtk.appended : end, &tag))
        if (!take_tag(&vtk, &tag, &section, file)) return error->status;
    if (!file->n) {
        refuse(&vtk, "has no Piece; allowed: one, with points");
        return error->status;
    }
    snprintf(file->code, sizeof file->code, "unknown");
    return STATUS_OK;
}

const struct snapshot_reader reader_vtu = {
    {"vtu", "XML of VTK: points of one piece", ""}, recognises, read_vtu};
