#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Adding a kernel is one file and one line: in a copy of the tree, Wendland C8 is added so, and must
# be listed, run and checked; then its constant is spoilt, which the checks must notice.
#   test_add_kernel.sh SOURCE WORK
set -eu
source=$1 work=$2/add_kernel
rm -rf "$work"
mkdir -p "$work/tree"
(cd "$source" && tar -cf - --exclude './build*' --exclude ./.git --exclude ./reports/out .) |
    (cd "$work/tree" && tar -xf -)
cd "$work"

cat >tree/src/kernel/wendland_c8.h <<'KERNEL'
/* SPDX-License-Identifier: GPL-3.0-or-later
 * Wendland C8: w = (1-q)^10 (1 + 10 q + 42 q^2 + 90 q^3 + 429/5 q^4). */
#ifndef KERNEL_WENDLAND_C8_H
#define KERNEL_WENDLAND_C8_H

static inline double wendland_c8_w(const struct kernel *kernel, double q, int dim)
{
    (void)kernel, (void)dim;
    const double a = 1 - q > 0 ? 1 - q : 0, a2 = a * a, a4 = a2 * a2;
    return a4 * a4 * a2 * (1 + q * (10 + q * (42 + q * (90 + q * (429. / 5)))));
}

static inline double wendland_c8_dw(const struct kernel *kernel, double q, int dim)
{
    (void)kernel, (void)dim;
    const double a = 1 - q > 0 ? 1 - q : 0, a2 = a * a, a4 = a2 * a2;
    return -26 * q * (a4 * a4 * a) * (1 + q * (9 + q * (159. / 5 + q * (231. / 5))));
}

#endif
KERNEL(wendland_c8, .member = {"wendland_c8", "Wendland C8", "Wendland 1995"},
       .constant = {0, 525. / 256, 40 / (3 * M_PI), 1785 / (64 * M_PI)}, .smoothness = {0, 8, 8, 8},
       .default_eta = 4)
KERNEL
echo '#include "kernel/wendland_c8.h"' >>tree/src/kernels.def

meson setup build tree -Doptimization=0 -Dclones=false -Dslow=false >setup.log
ninja -C build sphproof >build.log || { tail -40 build.log; exit 1; }
echo "listed:" && build/sphproof list kernels | grep wendland_c8
echo "certified:" && build/sphproof kernel wendland_c8 --dim 3 | tail -n 1
echo "run:" && build/sphproof run sod kernel=wendland_c8 n=100 --quiet
echo "checked:" && build/sphproof verify kernels --quiet --json verify.json
grep -q '"subject": "wendland_c8, dim 2' verify.json

sed -i 's|40 / (3 \* M_PI)|40.001 / (3 * M_PI)|' tree/src/kernel/wendland_c8.h
ninja -C build sphproof >build.log
if build/sphproof verify kernels --quiet --failures failures 2>/dev/null; then
    echo "a wrong constant passed"
    exit 1
fi
echo "with a wrong constant: rejected"
