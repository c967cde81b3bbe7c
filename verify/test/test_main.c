/* SPDX-License-Identifier: GPL-3.0-or-later
 * The main of tests that have none. */
#include "test.h"

int main(void)
{
    return test_run(NULL, NULL);
}
