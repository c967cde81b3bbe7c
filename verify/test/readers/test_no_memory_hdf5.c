/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests that each HDF5 layout is refused with "no memory" at each allocation that fails, with
 * masses in a column and in the header. */
#include "test.h"

#ifdef HAVE_HDF5
#include "failing_memory.h"
#include "sample_layouts.h"

static enum status read_file(struct error *error)
{
    const struct snapshot_options options = {.here = true};
    struct snapshot_file file;
    const enum status status = snapshot_read(path_of("m.0.hdf5"), &options, &file, error);
    snapshot_file_free(&file);
    return status;
}

TEST(layouts_without_memory)
{
    for (size_t k = 0; k < LAYOUTS; k++)
        for (int header = 0; header < 2; header++) {
            struct item items[ITEMS_MAX];
            items_of(&layouts[k], items);
            for (size_t f = 0; header && f < layouts[k].count; f++)
                if (layouts[k].fields[f].column == SNAPSHOT_M) items[f].path[0] = '\0';
            write_items(path_of("m.0.hdf5"), items, layouts[k].count);
            without_memory(read_file, 3, true);
        }
}

TEST(parts_without_memory)
{
    struct item items[ITEMS_MAX];
    items_of(layouts, items);
    for (size_t f = 0; f < layouts->count; f++)
        if (layouts->fields[f].meaning == PARTS) items[f].values[0] = 2;
    write_items(path_of("m.0.hdf5"), items, layouts->count);
    write_items(path_of("m.1.hdf5"), items, layouts->count);
    without_memory(read_file, 10, true);
}
#endif
