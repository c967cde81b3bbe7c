/* SPDX-License-Identifier: GPL-3.0-or-later
 * Snapshots of any code: the contents of a file in the units of the file. Readers are a family:
 * each is one file in reader/ and one line in readers.def. What a file does not state is assumed,
 * and recorded with the evidence. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "family.h"
#include "status.h"

enum snapshot_column {
    SNAPSHOT_X, /* y and z follow */
    SNAPSHOT_VX = 3,
    SNAPSHOT_M = 6,
    SNAPSHOT_RHO,
    SNAPSHOT_U,
    SNAPSHOT_P,
    SNAPSHOT_H, /* as in the file: support radius, scale length, 2 sigma ... */
    SNAPSHOT_AX,
    SNAPSHOT_DU = 14, /* du/dt */
    SNAPSHOT_COLUMNS
};
extern const char *const snapshot_column_names[SNAPSHOT_COLUMNS];

enum { SNAPSHOT_ROWS_MAX = 1 << 28, SNAPSHOT_NOTES_MAX = 24, SNAPSHOT_PARTS_MAX = 512 };

/* Positions differ by rounding along directions whose extent over the greatest is at most this. */
#define SNAPSHOT_ROUNDING 1e-6

/* An assumption and its evidence. */
struct snapshot_note {
    char what[32], value[80], evidence[240];
};
struct snapshot_notes {
    size_t count;
    struct snapshot_note note[SNAPSHOT_NOTES_MAX];
};

struct snapshot_value {
    bool known;
    double value;
};

struct snapshot_file {
    char layout[64], code[80];
    size_t n;                         /* all rows, gas first */
    size_t gas;                       /* rows of gas */
    int dim;                          /* from the file, or from the variation of the positions */
    double *column[SNAPSHOT_COLUMNS]; /* n each; NULL: missing */
    double precision[2];              /* relative precision of positions and of other quantities */
    int digits; /* decimal digits of the other quantities, if a text has fewer than a double */
    struct snapshot_value time, gamma;
    bool impossible; /* refused for an impossible value: not finite, or not positive */
    bool boxed;      /* the file gives the size of the box */
    bool placed;     /* the file gives the lower corner of the box, corner[] */
    double box[3];   /* > 0 along the dimensions of the file */
    double corner[3];
    char case_name[256], boundary[64], keys[1024]; /* from snapshots of ours, else "" */
    int parts, part; /* number of files of the snapshot; index of this file */
    double total;    /* gas particles in all files by the header; 0: not given */
    char kernel[48]; /* name of the kernel in the file, or "" */
    double ratio;    /* support radius over h if stated in the file, else 0 */
    struct snapshot_notes notes;
};

struct snapshot_options {
    const char *map; /* column names from the user, "rho=Density,u=Energy"; NULL: none */
    bool here;       /* read HDF5 in this process, which the caller guards already */
};

struct snapshot_source;

struct snapshot_reader {
    struct member member;
    /* True if the file has this format, judged by its first bytes or its contents. */
    bool (*recognises)(const struct snapshot_source *source);
    /* Fills file, which is empty; status and message as for snapshot_read. */
    enum status (*read)(const struct snapshot_source *source,
                        const struct snapshot_options *options, struct snapshot_file *file,
                        struct error *error);
};
extern const struct family snapshot_reader_family;

/* Reads path (and the other files of the same snapshot). STATUS_BAD_INPUT: unknown format;
 * truncated or malicious file; values that are not finite; masses, densities, smoothing lengths or
 * energies that are not positive. Pressures may be negative, and u and P may both be missing, for
 * liquids; see snapshot_check_gas. The message says what was found and what would help.
 * STATUS_ENVIRONMENT: no memory. Free with snapshot_file_free, also after a failure. */
enum status snapshot_read(const char *path, const struct snapshot_options *options,
                          struct snapshot_file *file, struct error *error);
void snapshot_file_free(struct snapshot_file *file);

/* Reads the comments before the rows of a text table: time, gamma, box, case, boundary, keys. Reads
 * no columns, so that nothing must be freed. Errors as for source_open. */
enum status csv_comments(const char *path, struct snapshot_file *said, struct error *error);

/* STATUS_BAD_INPUT: neither u nor P, or a negative pressure. */
enum status snapshot_check_gas(const char *path, struct snapshot_file *file, struct error *error);

/* ---- for readers ---- */

/* Allocates a column of n zeros. STATUS_ENVIRONMENT: no memory, or more rows than
 * SNAPSHOT_ROWS_MAX. */
enum status snapshot_file_make(struct snapshot_file *file, enum snapshot_column column,
                               const char *path, struct error *error);

/* The same with this value in each row. */
enum status snapshot_file_fill(struct snapshot_file *file, enum snapshot_column column,
                               double value, const char *path, struct error *error);

/* The same for `columns` columns from this one on, with the numbers of a table of n rows. */
enum status snapshot_file_split(struct snapshot_file *file, enum snapshot_column column,
                                size_t columns, const double *table, const char *path,
                                struct error *error);

void snapshot_note(struct snapshot_notes *notes, const char *what, const char *value,
                   const char *format, ...) __attribute__((format(printf, 4, 5)));

/* Parses a box: one length for all directions, a length each, or LO:HI each; false: invalid. */
bool snapshot_take_box(const char *text, struct snapshot_file *file);

/* Length of the box along d if known and periodic, else 0. */
double snapshot_period(const struct snapshot_file *file, int d);

/* Where the unit of a name such as "x [cm]" or "P (erg)" begins, or the end of the name. */
const char *snapshot_unit(const char *name);

/* The column for a usual name ("density", "v_x", "particle mass"), or -1. */
int snapshot_column_of(const char *name);
