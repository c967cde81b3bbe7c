/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the memory limit that is read from folders like those of Linux control groups. */
#include "test.h"

#include "allowance.h"
#include "own_folder.h"

static void put(const char *folder, const char *name, const char *text)
{
    char path[300];
    struct output output;
    struct error error;
    snprintf(path, sizeof path, "%s/%s", own_folder, folder);
    assert_int_equal(output_folder(path, &error), STATUS_OK);
    snprintf(path, sizeof path, "%s/%s/%s", own_folder, folder, name);
    assert_int_equal(output_open(&output, path, &error), STATUS_OK);
    fputs(text, output.stream);
    assert_int_equal(output_close(&output, &error), STATUS_OK);
}

static void same(double bytes, double expected)
{
    near_relative(bytes, expected, 1e-15);
}

TEST(nested_control_groups)
{
    const double all = allowance_memory("nowhere");
    assert_true(all > 1e8);
    put("proc/self", "cgroup", "0::/jobs/7/step\n");
    same(allowance_memory(own_folder), all); /* no file there sets a limit */
    put("sys/fs/cgroup/jobs/7/step", "memory.max", "max\n");
    same(allowance_memory(own_folder), all);
    put("sys/fs/cgroup/jobs", "memory.max", "40000000\n");
    same(allowance_memory(own_folder), 4e7);
    put("sys/fs/cgroup/jobs/7", "memory.max", "30000000\n");
    same(allowance_memory(own_folder), 3e7);
    put("sys/fs/cgroup/jobs/7/step", "memory.max", "50000000\n");
    same(allowance_memory(own_folder), 3e7);
    put("sys/fs/cgroup", "memory.max", "20000000\n"); /* the limit of a container */
    same(allowance_memory(own_folder), 2e7);
}

TEST(control_groups_version_1)
{
    const double all = allowance_memory("nowhere");
    put("proc/self", "cgroup", "9:name=systemd:/\n4:memory:/jobs/8\n3:cpuset:/jobs/7\n");
    put("sys/fs/cgroup/memory/jobs/8", "memory.limit_in_bytes", "9223372036854771712\n");
    same(allowance_memory(own_folder), all);
    put("sys/fs/cgroup/memory/jobs", "memory.limit_in_bytes", "10000000\n");
    same(allowance_memory(own_folder), 1e7);
    put("proc/self", "cgroup", "4:memory:/a/path/of/the/host\n");
    same(allowance_memory(own_folder), all);
    put("sys/fs/cgroup/memory", "memory.limit_in_bytes", "15000000\n");
    same(allowance_memory(own_folder), 1.5e7);
}
