/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests checkpoints: when they are written, and that a state is restored to the last bit or refused
 * with the reason. */
#include "test.h"

#include "cache.h"
#include "checkpoint.h"
#include "clock.h"
#include "own_folder.h"
#include "sample_simulation.h"

static char path[256], build[CHECKPOINT_WORD + 1];

static struct checkpoint usual(void)
{
    snprintf(path, sizeof path, "%s", path_of("state"));
    memset(build, 'b', CHECKPOINT_WORD); /* the longest build */
    return (struct checkpoint){
        .path = path, .build = build, .run = "{\"settings\": {\"n\": 40}}", .snapshot = 0.125};
}

/* A checkpoint is due this many seconds after it was last written, or after the first call. */
TEST(times_of_checkpoints)
{
    struct checkpoint checkpoint = {.every = 1000};
    const double before = clock_wall();
    assert_false(checkpoint_due(&checkpoint));
    assert_true(checkpoint.written >= before && checkpoint.written <= clock_wall());
    checkpoint.written -= 999;
    const double kept = checkpoint.written;
    assert_false(checkpoint_due(&checkpoint));
    assert_true(checkpoint.written == kept);
    checkpoint.written -= 2;
    assert_true(checkpoint_due(&checkpoint));
    assert_true(checkpoint.written >= before && checkpoint.written <= clock_wall());
    assert_false(checkpoint_due(&checkpoint));
    /* The clock counts from the start of the machine, so negative times are allowed. */
    checkpoint.written = -checkpoint.every;
    assert_true(checkpoint_due(&checkpoint));
    checkpoint = (struct checkpoint){.every = 0};
    assert_true(checkpoint_due(&checkpoint) && checkpoint_due(&checkpoint));
}

static void saved(struct simulation *simulation)
{
    struct checkpoint checkpoint = usual();
    struct growth growth = {.n = 3, .t = 0.5, .y = 2, .tt = 0.75, .ty = 4};
    checkpoint_save(&checkpoint, simulation, &growth);
    if (checkpoint.trouble.status) fail_msg("%s", checkpoint.trouble.message);
}

/* Restores a state; the error is the message of a run that starts from the file. */
static enum status loaded(struct checkpoint *checkpoint, struct simulation *simulation,
                          struct error *error)
{
    struct growth growth = {0};
    const enum status status = checkpoint_load(checkpoint, simulation, &growth, error);
    if (!status && access(path, F_OK) == 0) {
        assert_true(growth.n == 3 && growth.t == 0.5 && growth.y == 2 && growth.tt == 0.75 &&
                    growth.ty == 4);
        assert_true(checkpoint->snapshot == 0.125);
    }
    return status;
}

TEST(restored_run_continues)
{
    struct simulation *self = sample_simulation(40), *other = sample_simulation(40);
    struct checkpoint checkpoint = usual();
    struct error error = {0};
    unlink(path); /* without a file nothing happens */
    assert_int_equal(loaded(&checkpoint, other, &error), STATUS_OK);
    run_until(self, 0.05, NULL);
    saved(self);
    checkpoint.snapshot = -1;
    assert_int_equal(loaded(&checkpoint, other, &error), STATUS_OK);
    assert_true(same_state(self, other));
    run_until(self, 0.2, NULL);
    run_until(other, 0.2, NULL);
    assert_true(same_state(self, other));
    simulation_destroy(self);
    simulation_destroy(other);
}

static size_t read_all(char *bytes, size_t most)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    const size_t n = fread(bytes, 1, most, file);
    fclose(file);
    assert_true(n < most);
    return n;
}

static void write_all(const char *bytes, size_t n)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, n, file), n);
    fclose(file);
}

/* Asserts that a run, the usual one unless another is given, does not start from the file. */
static void refused(struct checkpoint checkpoint, const char *why)
{
    struct simulation *simulation = sample_simulation(40);
    struct error error = {0};
    char text[400];
    snprintf(text, sizeof text, "--resume '%s': %s", path, why);
    if (loaded(&checkpoint, simulation, &error) != STATUS_BAD_INPUT)
        fail_msg("not refused: %s", text);
    assert_string_equal(error.message, text);
    simulation_destroy(simulation);
}

TEST(damaged)
{
    static char bytes[1 << 16];
    struct simulation *self = sample_simulation(40);
    char head[200];
    saved(self);
    simulation_destroy(self);
    const size_t n = read_all(bytes, sizeof bytes);
    snprintf(head, sizeof head, "sphproof-checkpoint/1 %s\n%s\n", build, usual().run);
    assert_memory_equal(bytes, head, strlen(head));
    const size_t body = strlen(head);
    /* truncated; the last ones within the checksum */
    const size_t lengths[] = {body, body + 8, body + 9, (body + n) / 2, n - 8, n - 1};
    for (size_t k = 0; k < sizeof lengths / sizeof *lengths; k++) {
        write_all(bytes, lengths[k]);
        refused(usual(), "is damaged");
    }
    write_all(bytes, body - 1); /* the second line has no end */
    refused(usual(), "is damaged");
    const size_t places[] = {body, body + 1, (body + n) / 2, n - 9, n - 8, n - 1};
    for (size_t k = 0; k < sizeof places / sizeof *places; k++) {
        bytes[places[k]] = (char)(bytes[places[k]] ^ 4);
        write_all(bytes, n);
        refused(usual(), "is damaged");
        bytes[places[k]] = (char)(bytes[places[k]] ^ 4);
    }
    bytes[n] = 0;
    write_all(bytes, n + 1);
    refused(usual(), "is damaged");
    for (size_t k = 0; k < 2; k++) { /* the first line of another version, and an empty file */
        write_all(k ? "" : "sphproof-checkpoint/2 bbb\n", k ? 0 : 26);
        refused(usual(), "is no checkpoint, or of another version");
    }
    write_all(bytes, strlen("sphproof-checkpoint/1"));
    refused(usual(), "is no checkpoint, or of another version");
    write_all(bytes, n);
    struct checkpoint again = usual();
    struct error error = {0};
    self = sample_simulation(40);
    assert_int_equal(loaded(&again, self, &error), STATUS_OK);
    simulation_destroy(self);
}

/* Files with a correct checksum that are too short, or have another beginning. */
TEST(forged)
{
    enum { LINE = (1 << 16) - 1 };
    static char bytes[1 << 18];
    struct simulation *self = sample_simulation(40);
    char head[200];
    saved(self);
    const size_t n = read_all(bytes, sizeof bytes);
    snprintf(head, sizeof head, "sphproof-checkpoint/1 %s\n%s\n", build, usual().run);
    const size_t length = strlen(head), first = strcspn(head, "\n") + 1;
    /* empty, one byte, half of a state */
    const size_t bodies[] = {0, 1, (n - length) / 2};
    for (size_t k = 0; k < 3; k++) {
        const uint64_t sum = cache_hash(CACHE_HASH, bytes + length, bodies[k]);
        char kept[8];
        memcpy(kept, bytes + length + bodies[k], 8);
        memcpy(bytes + length + bodies[k], &sum, 8);
        write_all(bytes, length + bodies[k] + 8);
        refused(usual(), k ? "is damaged, or too large" : "is damaged");
        memcpy(bytes + length + bodies[k], kept, 8);
    }
    write_all(bytes, first); /* without a second line */
    refused(usual(), "is damaged");
    /* a valid state after a second line that is too long */
    memmove(bytes + first + LINE, bytes + length, n - length);
    memset(bytes + first, ' ', LINE);
    write_all(bytes, first + LINE + n - length);
    refused(usual(), "is damaged");
    simulation_destroy(self);
}

/* A file longer than one read; a fault in any part is detected. */
TEST(large_checkpoints)
{
    static char bytes[1 << 23];
    struct simulation *self = sample_simulation(8000);
    struct checkpoint checkpoint = usual();
    struct error error = {0};
    run_until(self, 1e-6, NULL);
    saved(self);
    const size_t n = read_all(bytes, sizeof bytes);
    assert_true(n > (1 << 20) + 1000);
    struct simulation *other = sample_simulation(8000);
    assert_int_equal(loaded(&checkpoint, other, &error), STATUS_OK);
    assert_true(same_state(self, other));
    simulation_destroy(self);
    simulation_destroy(other);
    for (int k = 0; k < 2; k++) {
        const size_t at = k ? n - 100 : 1000;
        bytes[at] = (char)(bytes[at] ^ 1);
        write_all(bytes, n);
        refused(usual(), "is damaged");
        bytes[at] = (char)(bytes[at] ^ 1);
    }
}

/* If a state is of another build or run, the message says what differs. */
TEST(checkpoints_of_other_runs)
{
    static const struct {
        const char *run, *why;
    } rows[] = {
        {"{\"settings\": {\"n\": 50}}", "n is 40 there, 50 here"},
        {"{\"settings\": {\"n\": 40, \"eta\": 1.5}}", "eta is nothing there, 1.5 here"},
        {"{\"case\": 1, \"settings\": {\"n\": 40}}", "its 'case' differs"},
        {"{\"case\": 1, \"settings\": {\"n\": 41}}", "n is 40 there, 41 here"},
    };
    struct simulation *self = sample_simulation(40);
    struct checkpoint checkpoint = usual();
    char why[200];
    saved(self);
    simulation_destroy(self);
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        checkpoint.run = rows[k].run;
        snprintf(why, sizeof why, "is of another run: %s", rows[k].why);
        refused(checkpoint, why);
    }
    /* if a key is repeated, the last value counts */
    checkpoint.run = "{\"settings\": {\"n\": 1, \"n\": 50}}";
    refused(checkpoint, "is of another run: n is 40 there, 50 here");
    self = sample_simulation(40);
    checkpoint_save(&checkpoint, self, &(struct growth){0});
    simulation_destroy(self);
    checkpoint.run = usual().run;
    refused(checkpoint, "is of another run: n is 50 there, 40 here");
    self = sample_simulation(40);
    saved(self);
    simulation_destroy(self);
    checkpoint.run = "{}"; /* with fewer settings */
    refused(checkpoint, "is of another run");
    checkpoint = usual();
    for (size_t k = 0; k < 2; k++) {
        checkpoint.build = k ? "bbb" : "cbb";
        refused(checkpoint,
                "was written by another build of the program, or where sin, exp and pow have other "
                "last bits: only the same one goes on to the last bit");
    }
}

/* The longest description of a run is accepted, and a longer one is refused. */
TEST(long_runs)
{
    enum { MOST = (1 << 16) - 2 }; /* the line's end and the terminating zero excluded */
    static char text[MOST + 2];
    for (size_t more = 0; more < 2; more++) {
        struct simulation *self = sample_simulation(40);
        struct checkpoint checkpoint = usual();
        struct growth growth = {.n = 3, .t = 0.5, .y = 2, .tt = 0.75, .ty = 4};
        struct error error = {0};
        memset(text, ' ', MOST + more);
        text[0] = '{', text[MOST + more - 1] = '}', text[MOST + more] = '\0';
        checkpoint.run = text;
        checkpoint_save(&checkpoint, self, &growth);
        assert_int_equal(checkpoint.trouble.status, STATUS_OK);
        if (more)
            refused(checkpoint, "is damaged");
        else
            assert_int_equal(loaded(&checkpoint, self, &error), STATUS_OK);
        simulation_destroy(self);
    }
}

/* A checkpoint that cannot be written sets `trouble`, and the next success clears it; a file that
 * cannot be opened is refused. */
TEST(checkpoints_that_cannot_be_written)
{
    struct simulation *self = sample_simulation(40);
    struct checkpoint checkpoint = usual();
    struct growth growth = {0};
    struct error error = {0};
    char beside[300];
    saved(self);
    snprintf(beside, sizeof beside, "%s", path_of("no/such"));
    checkpoint.path = beside;
    checkpoint_save(&checkpoint, self, &growth);
    assert_int_equal(checkpoint.trouble.status, STATUS_ENVIRONMENT);
    checkpoint.path = path;
    checkpoint_save(&checkpoint, self, &growth);
    assert_int_equal(checkpoint.trouble.status, STATUS_OK);
    assert_string_equal(checkpoint.trouble.message, "");
    snprintf(beside, sizeof beside, "%s/below", path);
    checkpoint.path = beside;
    assert_int_equal(checkpoint_load(&checkpoint, self, &growth, &error), STATUS_BAD_INPUT);
    assert_non_null(strstr(error.message, "below': Not a directory"));
    simulation_destroy(self);
}
