/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests how texts are made printable: every character of Unicode in UTF-8, every pair of bytes, and
 * invalid UTF-8. */
#include "test.h"

#include <stdbool.h>

#include "status.h"

static size_t encode(unsigned long code, char *text)
{
    unsigned char *c = (unsigned char *)text;
    const size_t length = code < 0x80 ? 1 : code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
    static const unsigned char first[] = {0, 0, 0xc0, 0xe0, 0xf0};
    for (size_t k = length; k-- > 1; code >>= 6) c[k] = 0x80 | (code & 0x3f);
    c[0] = (unsigned char)(first[length] | code);
    c[length] = 0;
    return length;
}

/* Characters that are not control characters stay; each byte of the others becomes a question mark,
 * and a line's end a blank. */
TEST(every_character)
{
    for (unsigned long code = 1; code < 0x140000; code++) {
        char text[8], want[8];
        const size_t length = encode(code, text);
        const bool control = code < 0x20 || (code >= 0x7f && code < 0xa0);
        const bool kept = !control && (code < 0xd800 || code > 0xdfff) && code < 0x110000;
        memcpy(want, text, sizeof text);
        if (!kept) memset(want, code == '\n' ? ' ' : '?', length);
        status_clean(text);
        if (memcmp(text, want, length + 1) != 0) fail_msg("U+%04lx is not '%s'", code, want);
    }
}

/* Two bytes and a letter: a character of two bytes, of one byte, or invalid. */
TEST(every_pair)
{
    for (int first = 1; first < 256; first++)
        for (int second = 1; second < 256; second++) {
            char text[] = {(char)first, (char)second, 'e', 0};
            char want[] = {(char)first, (char)second, 'e', 0};
            const bool both = first >= 0xc2 && first <= 0xdf && second >= 0x80 && second < 0xc0 &&
                              (first > 0xc2 || second >= 0xa0);
            for (int k = 0; k < 2 && !both; k++) {
                const unsigned char c = (unsigned char)want[k];
                if (c < 0x20 || c > 0x7e) want[k] = c == '\n' ? ' ' : '?';
            }
            status_clean(text);
            assert_memory_equal(text, want, sizeof want);
        }
}

/* Invalid UTF-8: truncated, longer than necessary, or with a byte that does not continue the
 * character. */
TEST(no_characters)
{
    static const char *const texts[][2] = {
        {"\xe2\x82\xac", "\xe2\x82\xac"}, /* the euro sign */
        {"\xe2\x82", "??"},
        {"\xe2", "?"},
        {"\xe2\x82x", "??x"},
        {"\xe2x\xac", "?x?"},
        {"\xe0\x9f\xbf", "???"}, /* longer than necessary */
        {"\xf0\x8f\xbf\xbf", "????"},
        {"\xc1\xbf", "??"},
        {"\xf0\x9f\x98\x80", "\xf0\x9f\x98\x80"},
        {"\xf0\x9f\x98", "???"},
        {"\xf0\x9f\x98y", "???y"},
        {"\xf0\x9fz\x80", "??z?"},
        {"\xf0\x9f\xc0\x80", "????"},
        {"\xf0\x9f\x98\x7f", "????"},
        {"\xf4\x90\x80\x80", "????"},
        {"\xf5\x80\x80\x80", "????"},
        {"\xe2\x82\xc0", "???"},
        {"a\xe2\x82\xac\nb\tc\x7f", "a\xe2\x82\xac b?c?"},
        {"", ""},
    };
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
        char text[32];
        strcpy(text, texts[k][0]);
        status_clean(text);
        assert_string_equal(text, texts[k][1]);
    }
}
