/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "test.h"

static struct CMUnitTest tests[64];
static size_t count;
static CMFixtureFunction first, last;
static int word_count;
static char **words;

void test_add(const char *name, CMUnitTestFunction function)
{
    if (count == sizeof tests / sizeof *tests) abort();
    tests[count++] = (struct CMUnitTest){name, function, NULL, NULL, NULL};
}

void test_between(CMFixtureFunction before, CMFixtureFunction after)
{
    first = before;
    last = after;
}

const char *test_word(int k)
{
    return k < word_count ? words[k] : NULL;
}

int main(int n, char **arguments)
{
    word_count = n;
    words = arguments;
    if (!count) return 77; /* skipped: this build lacks what is tested */
    return _cmocka_run_group_tests("tests", tests, count, first, last);
}
