/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests whether this process can start a number of threads. If OpenMP's run-time library cannot
 * start a thread, it ends the program with an exit status that has another meaning here. */
#pragma once

#include "status.h"

/* Starts threads - 1 threads and ends them. STATUS_ENVIRONMENT: a limit on memory or on processes
 * forbids it; the message names the possible number. */
enum status threads_check(int threads, struct error *error);
