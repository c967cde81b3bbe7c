/* SPDX-License-Identifier: GPL-3.0-or-later
 * The first header of every test in C: cmocka and what it needs, usual headers of the standard
 * library, comparisons of numbers, and TEST, which makes lists of tests and main superfluous. */
#pragma once

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "near.h"

/* TEST(name) { ... } defines a test without a state of cmocka's; tests run in the order of the
 * file. */
#define TEST(name)                                                                                 \
    static void name(void **state);                                                                \
    __attribute__((constructor)) static void test_add_##name(void)                                 \
    {                                                                                              \
        test_add(#name, name);                                                                     \
    }                                                                                              \
    static void name(__attribute__((unused)) void **state)

/* Functions (or NULL) that run before the first test of the file and after the last one. */
#define TEST_BETWEEN(before, after)                                                                \
    __attribute__((constructor)) static void test_add_between(void)                                \
    {                                                                                              \
        test_between(before, after);                                                               \
    }                                                                                              \
    void test_between(CMFixtureFunction first, CMFixtureFunction last)

void test_add(const char *name, CMUnitTestFunction function);
void test_between(CMFixtureFunction before, CMFixtureFunction after);

/* The k-th argument of the test program, from 1; NULL: there is none. */
const char *test_word(int k);
