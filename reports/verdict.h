/* SPDX-License-Identifier: GPL-3.0-or-later
 * The verdict on a report's results: what failed, by how much, and which command reproduces it. It
 * follows from the findings (findings.h); page, summary and JUnit file show it.
 *
 * results.json, a document of command "report" (each entry below is also what its own command
 * writes, see verify/schema; what a report has not is left out):
 *   mode            "quick" or "nightly"; "code" of other codes (--code)
 *   runs            [run documents, and "label", "reproduce", "profile": {"x", "density",
 *                   "velocity", "pressure", "exact_density", ... at the particles of the window,
 *                   "exact": {"x", "density", "velocity", "pressure"}}, "through_time": {"time",
 *                   "mass", "momentum", "energy"}: what has changed since the start, relative]
 *   studies         [converge documents, and "label", "reproduce"]
 *   verify          verify document
 *   trouble         [{"name", "message"}]: what gave no result, its process having crashed
 *   kernels         [kernel documents, and "reproduce"]
 *   bench           [bench documents, and "reproduce"]
 *   gradients       {"rows": [{flat: operator, ...}], "reproduce"}
 *   faults          what verify/test/faults.py wrote: "date", "git", "faults": [{"fault", "part",
 *                   "exit", "status": "pass", "fail" or "skip", "detail", "message",
 *                   "command"}]
 *   history         what verify/report/history.h tells: nights, since, trends, changes; what
 *                   survived before and breaks down since is a failure
 *   verdict         what verdict_make returned */
#pragma once

#include <jansson.h>

/* {"status": "pass" or "fail", "headline", "figures_passed", "figures_failed", "mutants",
 * "mutants_detected", "gates_passed", "gates_failed", "gates_smoke" (too coarse to judge),
 * "gates_undetermined" (the order's interval is wider than its gate), "gates_known" (fail as their
 * case says), "gates": what became of all of them in words, "runs", "broke_down", "faults",
 * "faults_right", "failures": [{"area", "name", "detail", "command"}]}. New reference, NULL: no
 * memory. */
json_t *verdict_make(const json_t *results);

/* The results with their verdict in a few lines of Markdown, for a pull request or a terminal.
 * Malloced; NULL: no memory. */
char *summary_text(const json_t *results);
