# SPDX-License-Identifier: GPL-3.0-or-later
"""A check for ReFrame 4 (https://reframe-hpc.readthedocs.io): a quick report, and a few of its figures.

    SPHPROOF=/path/to/sphproof reframe -C settings.py -c verify/examples/reframe_check.py -r

Tried here only as far as Python reads it: no ReFrame was at hand."""
import json
import os

import reframe as rfm
import reframe.utility.sanity as sn


@rfm.simple_test
class SphproofReport(rfm.RunOnlyRegressionTest):
    descr = "SPH: verification and convergence"
    valid_systems = ["*"]
    valid_prog_environs = ["*"]
    executable = os.environ.get("SPHPROOF", "sphproof")
    executable_opts = ["report", "--quick", "--quiet", "--out", "report", "--jobs", "${SLURM_CPUS_PER_TASK:-1}"]
    num_tasks = 1
    time_limit = "20m"
    keep_files = ["report/results.json", "report/summary.md"]

    @deferrable
    def results(self):
        with open(os.path.join(self.stagedir, "report", "results.json"), encoding="utf-8") as file:
            return json.load(file)

    @sanity_function
    def verdict(self):
        return sn.assert_eq(self.results()["verdict"]["status"], "pass")

    @performance_function("s")
    def seconds(self):
        return self.results()["seconds"]
