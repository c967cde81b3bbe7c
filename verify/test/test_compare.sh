#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# reports/compare in a clone: a tree against its own revision shows nothing; with a fault in a kernel
# the report turns red, the comparison names what the fault breaks, and nothing is left behind.
#   test_compare.sh SOURCE WORK
set -eu
source=$1 work=$2/compare
git -C "$source" rev-parse HEAD >/dev/null 2>&1 || exit 77
rm -rf "$work"
mkdir -p "$work"
git clone --quiet "$source" "$work/tree"
cd "$work/tree"
export BUILD="$work/build"

reports/compare >"$work/same.log" 2>&1 || { cat "$work/same.log"; exit 1; }
grep -q '^well: ' "$work/same.log"
# times may differ, nothing else
if grep '^worse' "$work/same.log" | grep -v '_s$\|seconds$\|ns_per_[a-z]*$\|merit$\|bytes$'; then exit 1; fi
grep -q '^## sphproof: All ' "$work/same.log"
echo "a tree against itself: the same"

sed -i 's|return -6 \* (a \* a - 4 \* (b \* b));|return -6.0006 * (a * a - 4 * (b * b));|' src/core/kernel/cubic_spline.h
git diff --quiet && { echo "the fault does not apply any more"; exit 1; }
if reports/compare >"$work/fault.log" 2>&1; then
    cat "$work/fault.log"
    echo "a wrong derivative is no regression"
    exit 1
fi
grep '^REGRESSION.*pass.*fail.*checks\[kernels.*cubic_spline' "$work/fault.log" | head -n 3
grep -q 'REGRESSION.*checks\[kernels.*cubic_spline' "$work/fault.log"
grep -q '^## sphproof: .* failure' "$work/fault.log"
grep -q '<h1>.* failure' "$work/build/compare/this/index.html"
! grep -q '<h1>All ' "$work/build/compare/this/index.html"
echo "a wrong derivative: named"

reports/compare no-such-revision 2>"$work/error.log" && exit 1
grep -q "no revision 'no-such-revision'" "$work/error.log"
[ "$(git worktree list | wc -l)" = 1 ]
[ -z "$(git status --porcelain | grep -v cubic_spline.h)" ]
[ "$(ls "$work/build/compare" | grep -c tree)" = 0 ]
echo "nothing is left behind"
