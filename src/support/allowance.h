/* SPDX-License-Identifier: GPL-3.0-or-later
 * What the system lets this process have. */
#pragma once

/* Bytes of memory: of the machine, less where `ulimit -v` or a control group (a container, a job of
 * a cluster) allows less. Of control groups as they stand below the folder root: "" but in tests.
 */
double allowance_memory(const char *root);
