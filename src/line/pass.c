/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pass.h"

#include "line.h"
#include "specialise.h"
#include "team.h"

static void tally_add(struct tally *all, const struct tally *own)
{
    if (own->without_root < all->without_root) all->without_root = own->without_root;
    if (own->reach > all->reach) all->reach = own->reach;
    all->short_of_ghosts |= own->short_of_ghosts;
    all->crossings += own->crossings;
    all->rate = largest(all->rate, own->rate);
    all->pairs += own->pairs;
    all->without_viscosity += own->without_viscosity;
    all->without_slope += own->without_slope;
}

struct tally pass_all(struct simulation *simulation, range_pass *pass)
{
    const struct line *line = line_of(simulation);
    const ptrdiff_t count = line->range_count;
    struct tally all = {.without_root = PTRDIFF_MAX};
    if (simulation->team.size == 1 || count < WORTH_A_THREAD) {
        for (ptrdiff_t b = 0; b < count; b++) pass(simulation, &line->ranges[b], &all);
        return all;
    }
#pragma omp parallel num_threads(simulation->team.size)
    {
        struct tally own = {.thread = team_thread(), .without_root = PTRDIFF_MAX};
#pragma omp for schedule(static) nowait
        for (ptrdiff_t b = 0; b < count; b++) pass(simulation, &line->ranges[b], &own);
#pragma omp critical(tally)
        tally_add(&all, &own);
    }
    return all;
}
