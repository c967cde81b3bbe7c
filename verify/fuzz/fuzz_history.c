/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fuzzes the history file of earlier nights, for a report with one figure of each kind. */
#include <stdlib.h>

#include "fuzz.h"
#include "history.h"
#include "result.h"

static const char results_text[] =
    "{\"schema\": \"sphproof/1\", \"command\": \"report\", \"mode\": \"quick\", \"git\": \"b\","
    "\"date\": \"2026-01-01\", \"verdict\": {\"status\": \"pass\"}, \"verify\": {\"checks\": ["
    "{\"group\": \"kernels\", \"name\": \"unity\", \"status\": \"pass\", \"value\": 0.5, "
    "\"bound\": "
    "1}]}, \"studies\": [{\"case\": \"sod\", \"label\": \"default\", \"status\": \"pass\", "
    "\"orders\": {\"density\": {\"l1\": {\"order\": 0.9, \"half_width\": 0.1}}}, \"levels\": "
    "[{\"n\": 198, \"errors\": {\"density\": {\"l1\": 0.01}}}]}]}";
static json_t *results;

static void leave(void)
{
    json_decref(results);
}

void fuzz_one(const uint8_t *bytes, size_t size)
{
    json_t *history;
    struct error error = {0};
    if (!results) {
        results = json_loads(results_text, 0, NULL);
        FUZZ_PROMISE(results);
        atexit(leave);
    }
    FUZZ_PROMISE(!history_tell(results, fuzz_file(bytes, size), &history, &error));
    char *text = result_text(history);
    FUZZ_PROMISE(text && json_array_size(json_object_get(history, "nights")) >= 1);
    free(text);
    json_decref(history);
}
