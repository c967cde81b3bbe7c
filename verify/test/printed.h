/* SPDX-License-Identifier: GPL-3.0-or-later
 * Captures what a function prints on standard output, and compares texts some of whose words are
 * coloured. */
#pragma once

#include <unistd.h>

#include "output.h"
#include "table.h"

struct printed {
    int before;
    FILE *file;
};

static inline struct printed printed_begin(void)
{
    fflush(stdout);
    const struct printed printed = {dup(1), output_temporary()};
    assert_non_null(printed.file);
    dup2(fileno(printed.file), 1);
    return printed;
}

static inline void printed_end(const struct printed *printed, char *text, size_t size)
{
    fflush(stdout);
    dup2(printed->before, 1);
    close(printed->before);
    rewind(printed->file);
    text[fread(text, 1, size - 1, printed->file)] = '\0';
    fclose(printed->file);
}

/* Expands expected text: "[-worse]" is worse in the colour of bad news; + good, . faint, * bold. */
static inline void printed_dress(const char *of, bool color, char *text)
{
    const struct table_style style = table_style(color);
    bool dressed = false;
    for (; *of; of++)
        if (*of == '[' && of[1] && strchr("-+.*", of[1]))
            of++, dressed = true,
                  text = stpcpy(text, *of == '-'   ? style.bad
                                      : *of == '+' ? style.good
                                      : *of == '.' ? style.faint
                                                   : style.bold);
        else if (*of == ']' && dressed)
            dressed = false, text = stpcpy(text, style.end);
        else
            *text++ = *of;
    *text = '\0';
}
