/* SPDX-License-Identifier: GPL-3.0-or-later
 * Draws random results for all computations of a report from data/drawn/pieces.json; some of them
 * break down. */
#pragma once

#include "drawn_document.h"
#include "pool.h"
#include "report_piece.h"
#include "settings.h"

static inline const json_t *template_of(const json_t *template, const char *job)
{
    const char *const kinds[][2] = {{"checks of", "verify"},
                                    {"kernel ", "kernel"},
                                    {"league", "league"},
                                    {"work-precision", "bench"},
                                    {"profile", "profiled"}};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (strncmp(job, kinds[i][0], strlen(kinds[i][0])) == 0)
            return json_object_get(template, kinds[i][1]);
    return json_object_get(template, "run");
}

/* Sets the number of particles of a result to that in the job's name or, for profiles, settings. */
static inline void set_size(struct pool_job *job)
{
    const char *named = strstr(job->name, ", n = ");
    const struct report_piece *piece = job->context;
    if (!named && strncmp(job->name, "profile", 7) != 0) return;
    const double n = named ? atof(named + 6) : settings_real(&piece->run.settings, SETTING_n);
    json_object_set_new(job->document, "n", json_integer((json_int_t)n));
    json_object_set_new(job->document, "spacing", json_real(1 / n));
}

static inline void drawn_pieces(struct drawing *draw, struct pool *pool, size_t sound)
{
    pool->found = 3;
    for (size_t i = 0; i < pool->count; i++) {
        struct pool_job *job = &pool->jobs[i];
        const json_t *kind = template_of(draw->template, job->name);
        const bool checks = kind == json_object_get(draw->template, "verify");
        job->done = true;
        if (!drawn_below(draw, sound) && !checks) {
            error_set(&job->error, STATUS_BROKE_DOWN, "job %zu broke down", i);
            job->crashed = true;
        } else {
            job->document = drawn_document(draw, kind);
            set_size(job);
        }
    }
}
