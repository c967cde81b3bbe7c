/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "suite_output.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "findings.h"
#include "result.h"
#include "value.h"

enum { MEMBER_LENGTH = 64, TEXT_LENGTH = 512, ALSO_SHOWN = 6 };

/* The failing figures of one check on one member. */
struct cause {
    const struct check *check;
    const struct figure *worst;
    double ratio;
    size_t figures, number;
    char member[MEMBER_LENGTH];
};

static void member_of(const char *subject, char member[MEMBER_LENGTH])
{
    size_t length = strcspn(subject, ",:");
    if (length >= MEMBER_LENGTH) length = MEMBER_LENGTH - 1;
    memcpy(member, subject, length);
    member[length] = '\0';
}

/* The part of a subject after the member. */
static const char *place_of(const char *subject)
{
    const char *place = subject + strcspn(subject, ",:");
    return *place ? place + 1 + strspn(place + 1, " ") : "";
}

static void take(struct cause *causes, size_t *count, const struct figure *figure)
{
    char member[MEMBER_LENGTH];
    size_t i = 0;
    member_of(figure->subject, member);
    while (i < *count &&
           (causes[i].check != figure->check || strcmp(causes[i].member, member) != 0))
        i++;
    struct cause *cause = &causes[i];
    if (i == *count) {
        *cause = (struct cause){.check = figure->check, .number = (*count)++, .ratio = -1};
        memcpy(cause->member, member, sizeof member);
    }
    const double ratio = finding_ratio(figure->value, figure->bound);
    if (ratio > cause->ratio) cause->ratio = ratio, cause->worst = figure;
    cause->figures++;
}

static int most_specific_first(const void *a, const void *b)
{
    const struct cause *x = a, *y = b;
    const int rank = x->check->rank - y->check->rank;
    if (rank) return rank;
    if (x->ratio != y->ratio) return x->ratio > y->ratio ? -1 : 1;
    return x->number < y->number ? -1 : 1;
}

/* "dw is not the derivative of w" or "normalisation off by 2e-05". */
static void say(const struct cause *cause, char *text, size_t size)
{
    if (cause->check->says)
        snprintf(text, size, "%s", cause->check->says);
    else
        snprintf(text, size, "%s off by %.2g", cause->check->name, cause->worst->value);
}

/* The headline of the member of causes[first], from its entries in causes[0..count-1]; other
 * members have headlines of their own. */
static json_t *headline(const struct cause *causes, size_t count, size_t first)
{
    const struct cause *main = &causes[first];
    const struct check *check = main->check;
    const struct figure *worst = main->worst;
    char text[TEXT_LENGTH], part[TEXT_LENGTH / 2], command[TEXT_LENGTH / 4], data[TEXT_LENGTH / 4];
    json_t *also = json_array();
    size_t figures = 0, said = 0;
    snprintf(text, sizeof text, "%s: ", main->member);
    for (size_t i = first; i < count; i++) {
        const struct cause *cause = &causes[i];
        if (strcmp(cause->member, main->member) != 0) continue;
        figures += cause->figures;
        if (i != first) json_array_append_new(also, json_string(cause->check->name));
        if (said >= 2) continue; /* the first failure and one more figure */
        const size_t used = strlen(text);
        say(cause, part, sizeof part);
        snprintf(text + used, sizeof text - used, "%s%s", said ? "; " : "", part);
        said++;
    }
    snprintf(command, sizeof command, "sphproof verify %s --details%s", check->group,
             check->slow ? " --slow" : "");
    snprintf(data, sizeof data, "%s-%s", check->group, check->name);
    return result_object("rank=%d group=%s check=%s member=%s headline=%s property=%s place=%s "
                         "value=%g bound=%g ratio=%g figures=%zu also=%p command=%s data=%s",
                         check->rank, check->group, check->name, main->member, text,
                         check->property, place_of(worst->subject), worst->value, worst->bound,
                         main->ratio, figures, (void *)also, command, data);
}

static json_t *missed(const struct mutant_outcome *outcome)
{
    char text[TEXT_LENGTH], command[TEXT_LENGTH / 4];
    const struct check *check = outcome->check;
    snprintf(text, sizeof text, "the check %s does not notice the fault %s (%s)", check->name,
             outcome->mutant->name, outcome->mutant->fault);
    snprintf(command, sizeof command, "sphproof verify %s --mutants", check->group);
    return result_object("rank=%d group=%s check=%s member=%s headline=%s property=%s place=%s "
                         "value=%g bound=%g command=%s",
                         AREA_DETECTION, check->group, check->name, outcome->mutant->name, text,
                         check->property, "", outcome->value, outcome->bound, command);
}

json_t *headline_list(const struct suite *suite)
{
    struct cause *causes = calloc(suite->failed, sizeof *causes);
    size_t count = 0;
    if (!causes) return NULL;
    for (size_t i = 0; i < suite->figure_count; i++)
        if (suite->figures[i].status == FINDING_FAIL) take(causes, &count, &suite->figures[i]);
    if (count) qsort(causes, count, sizeof *causes, most_specific_first);
    json_t *list = json_array();
    for (size_t i = 0; i < count; i++) {
        bool told = false;
        for (size_t k = 0; k < i; k++)
            told = told || strcmp(causes[k].member, causes[i].member) == 0;
        if (!told) json_array_append_new(list, headline(causes, count, i));
    }
    for (size_t i = 0; i < suite->outcome_count; i++)
        if (!suite->outcomes[i].detected) json_array_append_new(list, missed(&suite->outcomes[i]));
    free(causes);
    return list;
}

void headline_print(const json_t *headlines, FILE *stream, bool color)
{
    size_t i;
    const json_t *entry;
    json_array_foreach(headlines, i, entry) {
        const json_t *also = json_object_get(entry, "also");
        const double ratio = value_member(entry, "ratio");
        const size_t others = json_array_size(also);
        fprintf(stream, "%s%s%s\n", color ? "\033[1;31m" : "", value_text(entry, "headline"),
                color ? "\033[0m" : "");
        fprintf(stream, "    %s: got %.6g, bound %.3g", value_text(entry, "check"),
                value_member(entry, "value"), value_member(entry, "bound"));
        if (isfinite(ratio)) fprintf(stream, ", %.2g times over", ratio);
        if (*value_text(entry, "place")) fprintf(stream, ", at %s", value_text(entry, "place"));
        fprintf(stream, "\n    property: %s\n", value_text(entry, "property"));
        if (json_object_get(entry, "figures"))
            fprintf(stream, "    %lld failing figures",
                    (long long)json_integer_value(json_object_get(entry, "figures")));
        for (size_t k = 0; k < others && k < ALSO_SHOWN; k++)
            fprintf(stream, "%s%s",
                    k ? ", " : "; also: ", json_string_value(json_array_get(also, k)));
        if (others > ALSO_SHOWN) fprintf(stream, " and %zu more checks", others - ALSO_SHOWN);
        fprintf(stream, "%s    all of it: %s\n", json_object_get(entry, "figures") ? "\n" : "",
                value_text(entry, "command"));
    }
}
