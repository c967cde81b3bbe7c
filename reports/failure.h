/* SPDX-License-Identifier: GPL-3.0-or-later
 * The list of failures, the most specific cause first: a wrong kernel fails its own checks, then
 * those of the gradients made of it, of whole runs, of orders of convergence; read in this order
 * the first failure names it. */
#ifndef SPHPROOF_FAILURE_H
#define SPHPROOF_FAILURE_H

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

/* Less is shown first. Checks say their own rank, all of which are below that of a mutant that no
 * check has noticed; what is no check comes behind it. */
enum { FAILURE_RANK_MISSED = 1000 };

/* Begins as {0}; failure_take ends it. No memory: failed is set, failure_take returns NULL. */
struct failure_list {
    struct failure *list;
    size_t count, room;
    bool failed;
};

/* Texts are copied; one that is NULL stands for no memory. */
void failure_add(struct failure_list *failures, const char *area, const char *name,
                 const char *detail, const char *command);

/* A figure of a check. A check is listed once, by the figure farthest beyond its bound (excess:
 * value over bound); the others are counted. Its name in the list is "group: check". */
void failure_add_check(struct failure_list *failures, const json_t *figure, double excess,
                       const char *detail, const char *command);

/* [{"area", "name", "detail", "command"}], checks with their "subject": a new reference; frees the
 * list. */
json_t *failure_take(struct failure_list *failures);

#endif
