/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "snapshot_file.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "text.h"

const char *const snapshot_column_names[SNAPSHOT_COLUMNS] = {
    "x", "y", "z", "vx", "vy", "vz", "m", "rho", "u", "P", "h", "ax", "ay", "az", "du"};

/* Usual names of each column in lower case, reduced to letters and digits, without a unit in
 * brackets. */
static const char *const called[SNAPSHOT_COLUMNS] = {
    "x pos posx position positionx positions coordinates coordinatesx",
    "y posy positiony coordinatesy",
    "z posz positionz coordinatesz",
    "vx v vel velx velocity velocityx velocities velocitiesx",
    "vy vely velocityy velocitiesy",
    "vz velz velocityz velocitiesz",
    "m mass masses particlemass pmass",
    "rho dens density densities rhop",
    "u internalenergy internalenergies specificinternalenergy energy thermalenergy utherm",
    "p pres pressure pressures press",
    "h hsml smoothinglength smoothinglengths",
    "ax acc accx acceleration accelerationx accelerations accelerationsx",
    "ay accy accelerationy accelerationsy",
    "az accz accelerationz accelerationsz",
    "du dudt udot rateofchangeofinternalenergy",
};

const char *snapshot_unit(const char *name)
{
    const char *unit = name + strcspn(name, "[(");
    const bool is_unit =
        *unit == '[' ? !isdigit((unsigned char)unit[1]) : *unit && unit > name && unit[-1] == ' ';
    return is_unit ? unit : name + strlen(name);
}

/* True if the letters and digits from name to end are this word, which a blank may end. */
static bool is_called(const char *name, const char *end, const char *word)
{
    for (; name < end; name++)
        if (isalnum((unsigned char)*name) && tolower((unsigned char)*name) != *word++) return false;
    return strchr(" ", *word);
}

int snapshot_column_of(const char *name)
{
    const char *end = snapshot_unit(name);
    for (int c = 0; c < SNAPSHOT_COLUMNS; c++)
        for (const char *word = called[c]; *word; word += strspn(word, " ")) {
            if (is_called(name, end, word)) return c;
            word += strcspn(word, " ");
        }
    return -1;
}

enum status snapshot_file_make(struct snapshot_file *file, enum snapshot_column column,
                               const char *path, struct error *error)
{
    free(file->column[column]);
    file->column[column] = file->n > SNAPSHOT_ROWS_MAX ? NULL : calloc(file->n, sizeof(double));
    return file->column[column]
               ? STATUS_OK
               : error_set(error, STATUS_ENVIRONMENT, "no memory for %.200s", path);
}

enum status snapshot_file_fill(struct snapshot_file *file, enum snapshot_column column,
                               double value, const char *path, struct error *error)
{
    const enum status status = snapshot_file_make(file, column, path, error);
    for (size_t i = 0; !status && i < file->n; i++) file->column[column][i] = value;
    return status;
}

enum status snapshot_file_split(struct snapshot_file *file, enum snapshot_column column,
                                size_t columns, const double *table, const char *path,
                                struct error *error)
{
    for (size_t c = 0; c < columns; c++) {
        if (snapshot_file_make(file, (enum snapshot_column)(column + c), path, error))
            return error->status;
        for (size_t i = 0; i < file->n; i++) file->column[column + c][i] = table[i * columns + c];
    }
    return STATUS_OK;
}

void snapshot_file_free(struct snapshot_file *file)
{
    for (int c = 0; c < SNAPSHOT_COLUMNS; c++) free(file->column[c]), file->column[c] = NULL;
}

bool snapshot_take_box(const char *text, struct snapshot_file *file)
{
    double numbers[3], ends[2];
    char copy[160], *rest = copy;
    int count = 0;
    file->placed = false;
    for (int d = 0; d < 3; d++) file->corner[d] = 0;
    if (!strchr(text, ':')) {
        if (text_real(text, numbers)) {
            for (int d = 0; d < 3; d++) file->box[d] = numbers[0];
            return true;
        }
        count = text_reals(text, " \t,", 3, numbers)   ? 3
                : text_reals(text, " \t,", 2, numbers) ? 2
                                                       : 0;
        for (int d = 0; d < count; d++) file->box[d] = numbers[d];
        return count > 0;
    }
    if (strlen(text) >= sizeof copy) return false;
    strcpy(copy, text);
    for (char *word; (word = strtok_r(rest, " \t,", &rest)); count++) {
        if (count == 3 || !text_reals(word, ":", 2, ends)) return false;
        file->corner[count] = ends[0], file->box[count] = ends[1] - ends[0];
    }
    return file->placed = true;
}

double snapshot_period(const struct snapshot_file *file, int d)
{
    const char *word = file->boundary; /* one word, or one per direction */
    for (int k = 0; k < d; k++) {
        const char *next = strchr(word, ' ');
        if (!next) break;
        word = next + 1;
    }
    const bool periodic = !*word || strncmp(word, "periodic", strlen("periodic")) == 0;
    return file->boxed && periodic ? file->box[d] : 0;
}

void snapshot_note(struct snapshot_notes *notes, const char *what, const char *value,
                   const char *format, ...)
{
    if (notes->count == SNAPSHOT_NOTES_MAX) return;
    struct snapshot_note *note = &notes->note[notes->count++];
    va_list arguments;
    snprintf(note->what, sizeof note->what, "%s", what);
    snprintf(note->value, sizeof note->value, "%s", value);
    va_start(arguments, format);
    vsnprintf(note->evidence, sizeof note->evidence, format, arguments);
    va_end(arguments);
    status_clean(note->value);
    status_clean(note->evidence);
}
