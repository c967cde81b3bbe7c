/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "table.h"

#include <stdio.h>
#include <string.h>

struct table_style table_style(bool color)
{
    static const struct table_style plain = {"", "", "", "", ""};
    static const struct table_style coloured = {"\033[1m", "\033[2m", "\033[32m", "\033[31m",
                                                "\033[0m"};
    return color ? coloured : plain;
}

void table_wrap(const char *indentation, const char *text)
{
    const size_t width = 100 - strlen(indentation);
    while (*text) {
        size_t length = strlen(text);
        if (length > width) {
            length = width;
            while (length > 0 && text[length] != ' ') length--;
            if (length == 0) length = strcspn(text, " ");
        }
        printf("%s%.*s\n", indentation, (int)length, text);
        text += length;
        text += strspn(text, " ");
    }
}
