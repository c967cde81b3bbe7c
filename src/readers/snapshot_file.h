/* SPDX-License-Identifier: GPL-3.0-or-later
 * Snapshots of any code: the contents of a file in the file's own units. Readers are a family: each
 * is one file in reader/ and one line in readers.def. Where a file does not state something, the
 * reader records what it assumed and the evidence for it. */
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
    SNAPSHOT_H, /* as the code writes it: support radius, scale length, 2 sigma ... */
    SNAPSHOT_AX,
    SNAPSHOT_DU = 14, /* du/dt */
    SNAPSHOT_COLUMNS
};
extern const char *const snapshot_column_names[SNAPSHOT_COLUMNS];

enum { SNAPSHOT_ROWS_MAX = 1 << 28, SNAPSHOT_NOTES_MAX = 24, SNAPSHOT_PARTS_MAX = 512 };

/* What was taken for true, and why. */
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
    size_t n;                         /* all rows: gas first */
    size_t gas;                       /* rows of gas */
    int dim;                          /* as the file says it, or as its positions vary */
    double *column[SNAPSHOT_COLUMNS]; /* n each; NULL: the file has none */
    double precision[2];              /* relative, of positions and of what is stored besides */
    struct snapshot_value time, gamma;
    bool impossible; /* it was refused for a value that no gas has: not finite, or not positive */
    bool boxed;      /* the file says how large its box is */
    bool placed;     /* the file says where its box begins: at corner[] */
    double box[3];   /* > 0 along the dimensions that it has */
    double corner[3];
    char case_name[256], boundary[64], keys[1024]; /* what snapshots of ours say; "" */
    int parts, part; /* files that the snapshot is spread over; this one's number */
    char kernel[48]; /* what the file calls its kernel; "" */
    double ratio;    /* support radius over h as the file says it; 0 */
    struct snapshot_notes notes;
};

struct snapshot_options {
    const char *map; /* column names of the user's, "rho=Density,u=Energy"; NULL: none */
    bool here;       /* HDF5 is read in this process, because the caller guards it already */
};

struct snapshot_source;

struct snapshot_reader {
    struct member member;
    /* Is it such a file? By its first bytes, or by what it has inside. */
    bool (*recognises)(const struct snapshot_source *source);
    /* Fills file, which is empty; status and message as those of snapshot_read. */
    enum status (*read)(const struct snapshot_source *source,
                        const struct snapshot_options *options, struct snapshot_file *file,
                        struct error *error);
};
extern const struct family snapshot_reader_family;

/* Reads path (and the other files of the same snapshot). STATUS_BAD_INPUT: what was found, and what
 * would help; a file that is none of these, is cut off or hostile; values that are not finite, and
 * masses, densities, widths and energies that are not positive (pressures may be below 0, and both
 * u and P may be missing: in liquids, see snapshot_check_gas). STATUS_ENVIRONMENT: no memory. Free
 * with snapshot_file_free, also after a failure. */
enum status snapshot_read(const char *path, const struct snapshot_options *options,
                          struct snapshot_file *file, struct error *error);
void snapshot_file_free(struct snapshot_file *file);

/* What the comments before the rows of a text table say: time, gamma, box, case, boundary, keys. No
 * columns, so that there is nothing to be freed. Errors as source_open's. */
enum status csv_comments(const char *path, struct snapshot_file *said, struct error *error);

/* STATUS_BAD_INPUT: it has neither u nor P, or a pressure below 0, which no gas has. */
enum status snapshot_check_gas(const char *path, struct snapshot_file *file, struct error *error);

/* ---- for readers ---- */

/* n zeros for a column; false: no memory, or more rows than SNAPSHOT_ROWS_MAX. */
bool snapshot_file_make(struct snapshot_file *file, enum snapshot_column column);

void snapshot_note(struct snapshot_notes *notes, const char *what, const char *value,
                   const char *format, ...) __attribute__((format(printf, 4, 5)));

/* Reads a box: one length for all directions, a length each, or LO:HI for each; false: none of
 * these. */
bool snapshot_take_box(const char *text, struct snapshot_file *file);

/* The length of the box along d where it is known and periodic, else 0. */
double snapshot_period(const struct snapshot_file *file, int d);

/* The column that a usual name stands for ("density", "v_x", "particle mass"), or -1. */
int snapshot_column_of(const char *name);
