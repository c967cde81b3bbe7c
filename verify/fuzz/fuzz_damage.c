/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fuzzes HDF5 files of real codes: bytes are changed or cut off. The HDF5 library does not survive
 * that, so that files are read in another process (guard.h). The reader must refuse the file or
 * give columns of valid numbers, and no result may come from a process that died. The bytes select
 * the file and the changes in all its variants; each variant has further changes of its own. */
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "fuzz.h"
#include "fuzz_read.h"
#include "guard.h"

#ifdef HAVE_HDF5
enum { VARIANTS = 32, FILES = 3, SIZE_MAX_READ = 1 << 18 };

static const char *const names[FILES] = {"gizmo_gresho2d_mfm_32.hdf5", "gizmo_sod1d_dsph_n396.hdf5",
                                         "swift_sod1d_sphenix_n396.hdf5"};

static struct file {
    size_t size;
    uint8_t bytes[SIZE_MAX_READ];
} files[FILES];

/* Shared with the process that reads the files. */
struct shared {
    volatile int next; /* variant */
    volatile int broken;
};

struct batch {
    const uint8_t *bytes;
    size_t size;
    struct shared *shared;
};

static void load_files(void)
{
    for (int k = 0; k < FILES; k++) {
        char path[4096];
        snprintf(path, sizeof path, "%s/%s", SNAPSHOTS, names[k]);
        FILE *file = fopen(path, "rb");
        FUZZ_PROMISE(file);
        files[k].size = fread(files[k].bytes, 1, SIZE_MAX_READ, file);
        FUZZ_PROMISE(files[k].size > 0 && files[k].size < SIZE_MAX_READ);
        fclose(file);
    }
}

/* Steele, Lea & Flood 2014, splitmix64. */
static uint64_t draw(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/* Half of all positions are in the first 4 KiB, where most of the metadata is. */
static size_t place_of(uint64_t bits, size_t size)
{
    const size_t near = size < 4096 ? size : 4096;
    return (size_t)(bits >> 8) % (bits & 1 ? near : size);
}

static void change(struct file *file, uint64_t bits, uint64_t value)
{
    static const uint8_t odd[] = {0, 1, 255, 128, 127, 2, 64, 8};
    const size_t at = place_of(bits, file->size), length = (size_t)1 << (bits >> 1 & 3);
    if ((bits & 0xf0) == 0xf0) file->size = at + 1;
    for (size_t k = 0; k < length && at + k < file->size; k++)
        file->bytes[at + k] = (uint8_t)(value & 1 ? odd[value >> 1 & 7] : value >> (8 * k + 4));
}

static void damage(const struct batch *batch, int variant, struct file *file)
{
    uint64_t state = (uint64_t)variant, bits = 0, value = 0;
    *file = files[(batch->size ? batch->bytes[0] : 0) % FILES];
    for (size_t at = 1; at + 12 <= batch->size; at += 12) {
        memcpy(&bits, batch->bytes + at, 6);
        memcpy(&value, batch->bytes + at + 6, 6);
        change(file, bits, value);
    }
    for (size_t at = 0; at < batch->size; at++) state = draw(&state) + batch->bytes[at];
    for (int changes = variant ? 1 + (int)(draw(&state) % 4) : 0; changes > 0; changes--) {
        bits = draw(&state);
        value = draw(&state);
        change(file, bits, value);
    }
}

static enum status read_batch(const void *context, json_t **reply, struct error *error)
{
    static struct file file;
    const struct batch *batch = context;
    const struct snapshot_options options = {.here = true};
    (void)reply, (void)error;
    guard_begun();
    fuzz_was_broken = &batch->shared->broken;
    while (batch->shared->next < VARIANTS) {
        const int variant = batch->shared->next++;
        damage(batch, variant, &file);
        const enum status status =
            fuzz_read(fuzz_named_file(file.bytes, file.size), &options, false);
        FUZZ_PROMISE(!status || variant || batch->size > 1); /* an undamaged file must be read */
    }
    return STATUS_OK;
}

void fuzz_one(const uint8_t *bytes, size_t size)
{
    enum { SECONDS = 60 };
    static struct shared *shared;
    if (!shared) {
        load_files();
        fuzz_named_file(files[0].bytes, files[0].size); /* so that this process removes it */
        shared =
            mmap(NULL, sizeof *shared, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
        FUZZ_PROMISE(shared != MAP_FAILED);
    }
    const struct batch batch = {bytes, size, shared};
    for (shared->next = 0; shared->next < VARIANTS;) {
        struct guard_verdict verdict;
        struct error error = {0};
        const enum status status = guard_run(read_batch, &batch, SECONDS, &verdict, &error);
        FUZZ_PROMISE(!status || verdict.reason[0]);
        FUZZ_PROMISE(!shared->broken);
        guard_free(&verdict);
    }
}

#else

void fuzz_one(const uint8_t *bytes, size_t size)
{
    (void)bytes, (void)size;
}
#endif
