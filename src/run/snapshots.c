/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "snapshots.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Steps before a snapshot's time at which the state is saved: a run makes its last two steps equal
 * and prepares them in the step before. */
static const double steps_aside = 4;

/* In intervals; a snapshot closer to the end than this is the final one. */
static const double round_off = 1e-9;

enum status snapshots_check(const struct snapshots *snapshots, double t_end, struct error *error)
{
    const double every = snapshots->every;
    if (every > 0 && every <= t_end && t_end / every <= SNAPSHOTS_MOST) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT, "allowed: a time from t_end/%d to t_end = %.6g",
                     SNAPSHOTS_MOST, t_end);
}

size_t snapshots_count(const struct snapshots *snapshots, double t_end)
{
    return (size_t)ceil(t_end / snapshots->every * (1 - round_off));
}

double snapshots_time(const struct snapshots *snapshots, size_t number)
{
    return (double)number * snapshots->every;
}

struct snapshots_path snapshots_path(const struct snapshots *snapshots, size_t number)
{
    const char *slash = strrchr(snapshots->path, '/'), *dot = strrchr(snapshots->path, '.');
    const size_t length = strlen(snapshots->path);
    const size_t stem = dot && (!slash || dot > slash) ? (size_t)(dot - snapshots->path) : length;
    struct snapshots_path path;
    snprintf(path.text, sizeof path.text, "%.*s_%04zu%s", (int)stem, snapshots->path,
             number % SNAPSHOTS_MOST, snapshots->path + stem);
    return path;
}

double snapshots_memory(int dim, double n)
{
    static const double kept[] = {0, 180, 350, 480}; /* bytes of a particle's state, measured */
    return n * kept[dim];
}

void snapshots_begin(struct snapshots *snapshots, double time, double last, double t_end)
{
    const double over = fmax(time, last);
    snapshots->count = snapshots_count(snapshots, t_end);
    snapshots->next = (size_t)(over / snapshots->every);
    while (over > 0 && snapshots_time(snapshots, snapshots->next) <= over) snapshots->next++;
}

double snapshots_last(const struct snapshots *snapshots)
{
    return snapshots->next ? snapshots_time(snapshots, snapshots->next - 1) : -1;
}

/* A buffer that is written or read; with bytes = NULL the bytes are only counted. */
struct buffer {
    unsigned char *bytes;
    size_t used;
};

static bool put(void *context, void *bytes, size_t n)
{
    struct buffer *buffer = context;
    if (buffer->bytes) memcpy(buffer->bytes + buffer->used, bytes, n);
    buffer->used += n;
    return true;
}

static bool get(void *context, void *bytes, size_t n)
{
    struct buffer *buffer = context;
    memcpy(bytes, buffer->bytes + buffer->used, n);
    buffer->used += n;
    return true;
}

bool snapshots_keep(struct snapshots *snapshots, struct simulation *simulation, double time,
                    double stop)
{
    struct rates rates;
    struct error error;
    struct buffer buffer = {0};
    struct serialiser serialiser = {.bytes = put, .context = &buffer};
    if (snapshots->next >= snapshots->count) return false;
    simulation_rates(simulation, &rates);
    snapshots->reach = fmin(stop, time + steps_aside * rates.furthest);
    if (snapshots_time(snapshots, snapshots->next) > snapshots->reach) return false;
    simulation_serialise(simulation, &serialiser);
    buffer = (struct buffer){.bytes = malloc(buffer.used)};
    if (buffer.bytes) {
        simulation_serialise(simulation, &serialiser);
        snapshots->state = buffer.bytes;
        return true;
    }
    error_set(&error, STATUS_ENVIRONMENT, "no memory for a snapshot at t = %.9g",
              snapshots_time(snapshots, snapshots->next++));
    snapshots_fail(snapshots, &error);
    return false;
}

void snapshots_return(struct snapshots *snapshots, struct simulation *simulation)
{
    struct buffer buffer = {.bytes = snapshots->state};
    struct serialiser serialiser = {.bytes = get, .context = &buffer, .back = true};
    simulation_serialise(simulation, &serialiser);
}

void snapshots_go_on(struct snapshots *snapshots)
{
    free(snapshots->state);
    snapshots->state = NULL;
}

void snapshots_fail(struct snapshots *snapshots, const struct error *error)
{
    if (!snapshots->trouble.status) snapshots->trouble = *error;
}
