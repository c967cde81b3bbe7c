/* SPDX-License-Identifier: GPL-3.0-or-later
 * Can this process have so many threads? OpenMP's run-time library ends the program where it cannot
 * start one, with an exit status that means something else here. */
#pragma once

#include "status.h"

/* Starts threads - 1 threads and ends them. STATUS_ENVIRONMENT: a limit on memory or on the number
 * of processes forbids it; the message says how many there can be. */
enum status threads_check(int threads, struct error *error);
