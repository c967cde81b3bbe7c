/* SPDX-License-Identifier: GPL-3.0-or-later
 * What every test in C includes first: cmocka, with what it asks for, and TEST. A file of tests
 * needs neither a list of them nor main, unless something must be done before. */
#ifndef TEST_H
#define TEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

/* TEST(name) { ... } is a test without a state of cmocka's; it runs in its turn in the file. */
#define TEST(name)                                                                                 \
    static void name(void **state);                                                                \
    __attribute__((constructor)) static void test_add_##name(void)                                 \
    {                                                                                              \
        test_add(#name, name);                                                                     \
    }                                                                                              \
    static void name(__attribute__((unused)) void **state)

void test_add(const char *name, CMUnitTestFunction function);

/* For a main of one's own: runs all of them between two fixtures (or NULL); returns how many have
 * failed. */
int test_run(CMFixtureFunction before, CMFixtureFunction after);

#endif
