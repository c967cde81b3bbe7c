/* SPDX-License-Identifier: GPL-3.0-or-later
 * Limits that the system sets for this process. */
#pragma once

/* Memory available to this process in bytes: that of the machine, or less if `ulimit -v` or a
 * control group (a container, a cluster's job) limits it. root: prefix of the control groups'
 * files; "" except in tests. */
double allowance_memory(const char *root);
