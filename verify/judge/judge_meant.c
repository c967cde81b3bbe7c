/* SPDX-License-Identifier: GPL-3.0-or-later
 * Finds the case to which a snapshot belongs if it does not fit the one named. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "judge.h"
#include "problem_list.h"
#include "text.h"

/* Two cases whose misfits differ by less are equally good; the cases' end times decide. */
static const double alike = 1e-3;
/* A case that is also far is named only if its misfit is below this fraction of that of the case
 * asked for. */
static const double much_nearer = 0.3;

/* True if the file's box is as long as the case's, apart from particles that do not reach its ends.
 * A tube may have any length. */
static bool same_box(const struct judged *judged, const struct settings *of_case)
{
    const struct settings *of_file = &judged->run.settings;
    const double margin = judged->file.boxed ? 1e-6 : 0.15;
    if (problem_reads(problem_of(of_case), SETTING_left)) return true;
    for (int d = 0; d < judged->file.dim; d++) {
        const double length =
            settings_along(of_case, SETTING_hi, d) - settings_along(of_case, SETTING_lo, d);
        const double found =
            settings_along(of_file, SETTING_hi, d) - settings_along(of_file, SETTING_lo, d);
        if (!(fabs(found - length) <= margin * length)) return false;
    }
    return true;
}

enum { JUDGE_MEANT = 240 };

struct candidate {
    const char *name;
    double wrong, late; /* |time - t_end| over t_end */
    enum field field;
    bool fieldless, far;
};

/* Candidates that fit come first; among them, those with comparable fields come before those judged
 * by one value. */
static bool nearer(const struct candidate *a, const struct candidate *b)
{
    if (!b->name) return true;
    if (a->far != b->far) return b->far;
    if (a->fieldless != b->fieldless) return b->fieldless;
    if (fabs(a->wrong - b->wrong) > alike * b->wrong) return a->wrong < b->wrong;
    return a->late < b->late;
}

/* True if the gas has about the mass and energy of the case's initial state, or that is unknown. */
static bool same_content(const struct judged *judged)
{
    const struct conservation *is = &judged->sums, *was = &judged->start;
    return !(was->mass > 0) ||
           (fabs(is->mass / was->mass - 1) < 0.1 && fabs(is->energy / was->energy - 1) < 0.2);
}

/* Judges the snapshot as this case; false if the box, gas or dimension does not match, or nothing
 * can be compared. */
static bool try_case(const char *path, const struct judge_request *request,
                     const struct case_file *file, struct candidate *found)
{
    struct judge_request as = *request;
    struct judged judged;
    struct error ignored = {0};
    as.case_name = found->name, as.left = as.right = NULL;
    const bool fits = !judge_as(path, &as, true, &judged, &ignored) &&
                      same_box(&judged, &file->settings) && judged.case_gamma == 0 &&
                      same_content(&judged);
    if (fits) {
        const double t_end = settings_real(&file->settings, SETTING_t_end);
        found->far = judged.far, found->wrong = judged.wrong, found->field = judged.wrong_field;
        found->late = fabs(judged.file.time.value - t_end) / t_end;
        found->fieldless = judged.run.problem.problem->fieldless;
    }
    const bool compared =
        fits && (!found->fieldless || (!found->far && judged.result.functional_count &&
                                       isfinite(judged.result.functionals[0].exact)));
    judge_free(&judged);
    return compared;
}

/* Tries all other built-in cases that match the dimension, box, gamma and time of a snapshot that
 * is far from the case asked for, or that could not be judged as that case (sound: false). meant: a
 * question with figures, or a statement that no case is near; "" if a snapshot that could not be
 * judged fits none. */
static void find_meant(const char *path, const struct judge_request *request, struct judged *judged,
                       bool sound, char meant[JUDGE_MEANT])
{
    struct candidate best = {0};
    const char *asked = request->case_name ? request->case_name : judged->file.case_name;
    meant[0] = '\0';
    if (!request->time.known && !judged->file.time.known) return; /* without a time no case fits */
    for (const struct case_builtin *c = case_builtins; c->name; c++) {
        struct case_file file;
        struct error ignored = {0};
        struct candidate found = {.name = c->name};
        if (strcmp(c->name, asked) == 0 || case_load(&file, c->name, &ignored) ||
            file.dimension != judged->file.dim || problem_of(&file.settings)->liquid ||
            !try_case(path, request, &file, &found))
            continue;
        if (nearer(&found, &best)) best = found;
    }
    const bool fields = sound && !judged->run.problem.problem->fieldless;
    if (best.far && !(fields && best.wrong < much_nearer * judged->wrong)) best.name = NULL;
    if (!best.name && sound)
        snprintf(meant, JUDGE_MEANT, "none of our other cases in %dD is near either",
                 judged->file.dim);
    if (!best.name) return;
    if (!best.far) snprintf(judged->meant, sizeof judged->meant, "%s", best.name);
    char how[80] = "its value is the case's", here[40] = "";
    if (!best.fieldless)
        snprintf(how, sizeof how, "%s off by %.2g of its range",
                 field_family.members[best.field]->name, best.wrong);
    if (fields && !best.fieldless)
        snprintf(here, sizeof here, ", against %.2g here", judged->wrong);
    snprintf(meant, JUDGE_MEANT,
             best.far ? "nearer, though far as well, is %s (%s%s)" : "did you mean %s? (%s%s)",
             best.name, how, here);
}

enum status judge_snapshot(const char *path, const struct judge_request *request,
                           struct judged *judged, struct error *error)
{
    char meant[JUDGE_MEANT];
    const enum status status = judge_as(path, request, false, judged, error);
    const bool other =
        judged->far || judged->silent || (judged->foreign && judged->case_gamma == 0);
    if (status == STATUS_BAD_INPUT ? !judged->file.n
                                   : status || !other || judged->of_start.explained)
        return status;
    find_meant(path, request, judged, !status, meant);
    if (meant[0] && status)
        text_add(error->message, sizeof error->message, "; %s", meant);
    else if (meant[0])
        text_add(judged->verdict, sizeof judged->verdict, "; %s", meant);
    return status;
}
