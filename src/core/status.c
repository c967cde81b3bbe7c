/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "status.h"

size_t status_printable(const char *at)
{
    const unsigned char *text = (const unsigned char *)at;
    static const struct {
        unsigned char first, last; /* range of the leading byte */
        unsigned char low, high;   /* range of the second byte */
        size_t length;
    } forms[] = {{' ', '~', 0, 0, 1},         {0xc2, 0xc2, 0xa0, 0xbf, 2},
                 {0xc3, 0xdf, 0x80, 0xbf, 2}, {0xe0, 0xe0, 0xa0, 0xbf, 3},
                 {0xe1, 0xec, 0x80, 0xbf, 3}, {0xed, 0xed, 0x80, 0x9f, 3},
                 {0xee, 0xef, 0x80, 0xbf, 3}, {0xf0, 0xf0, 0x90, 0xbf, 4},
                 {0xf1, 0xf3, 0x80, 0xbf, 4}, {0xf4, 0xf4, 0x80, 0x8f, 4}};
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
        if (text[0] < forms[i].first || text[0] > forms[i].last) continue;
        if (forms[i].length > 1 && (text[1] < forms[i].low || text[1] > forms[i].high)) return 0;
        for (size_t k = 2; k < forms[i].length; k++)
            if (text[k] < 0x80 || text[k] > 0xbf) return 0;
        return forms[i].length;
    }
    return 0;
}

void status_clean(char *text)
{
    for (char *c = text; *c;) {
        const size_t length = status_printable(c);
        if (!length) *c = *c == '\n' ? ' ' : '?';
        c += length ? length : 1;
    }
}
