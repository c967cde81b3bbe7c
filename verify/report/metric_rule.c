/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "metric.h"

#include <string.h>

#define OUT RULE_LEFT_OUT, 0, 0, 0

static const struct metric_rule rules[] = {
    /* depends on timings, or sums figures that are judged one by one */
    {"cheapest", "*", OUT},
    {"estimate", "*", OUT}, /* estimate of the run that follows */
    {"comparison", "only_seed_survives", 0, READING_PART, 0, 0},
    {"comparison", "*", OUT},
    {"checks", "seconds", OUT}, /* among thousands some are always slow */
    {"", "limit_over_this", OUT},
    {"", "seed_plain_over_this", OUT},
    {"", "saves", OUT},
    {"", "share", OUT},
    {"", "skipped_fraction", OUT},
    {"", "on_front", OUT},
    {"threads", "gain*", OUT},
    /* time, memory, work */
    {"", "wall_s", 0, READING_TIMING, 3, 0}, /* other processes affect it */
    {"", "*_s", 0, READING_TIMING, 1.5, 0},
    {"", "cpu_s_*", 0, READING_TIMING, 1.5, 0},
    {"", "seconds", 0, READING_TIMING, 3, 0},
    {"", "ns_*", 0, READING_TIMING, 1.5, 0},
    {"", "exponent", 0, READING_TIMING, 1.5, 0},
    {"", "figure_of_merit", 0, READING_TIMING, 1.5, 0},
    {"", "peak_rss_bytes", 0, READING_TIMING, 1.5, 0},
    {"", "bytes_per_particle", 0, READING_TIMING, 1.5, 0},
    {"", "steps", 0, READING_COUNT, 0.01, 0},
    {"", "particle_updates", 0, READING_COUNT, 0.01, 0},
    {"", "pair_interactions", 0, READING_COUNT, 0.01, 0},
    {"", "pairs_per_particle", 0, READING_COUNT, 0.01, 0},
    {"", "skipped_particle_updates", OUT},
    {"", "without_slope", OUT},
    {"", "without_viscosity", OUT},
    {"", "without_conductivity", OUT},
    /* words */
    {"faults", "status", 0, READING_STATUS, 0, 0},
    {"faults", "*", OUT},
    {"score", "score", 0, READING_ORDER, 0.05, 0}, /* a new sample each night */
    {"score", "*", OUT},
    {"findings", "*", OUT}, /* names contain file names; the status sums them up */
    {"", "status", 0, READING_STATUS, 0, 0},
    {"kernel", "*", OUT},         /* of a snapshot: identified, not judged */
    {"", "foreign", OUT},         /* the status tells whether this passes */
    {"code", "exit_status", OUT}, /* the reason is compared instead */
    /* autopsies: the parts of an error grow and shrink with the error */
    {"power", "*", OUT},
    {"shares", "order",
     OUT}, /* compared for the sizes of parts, in reports only for the whole error */
    {"error", "order", 0, READING_ORDER, 0.05, 0},
    {"autopsies", "order", OUT},
    {"parts", "size", 0, READING_PART, 0.1, 1e-12},
    {"parts", "noise", OUT},
    {"parts", "along", OUT},
    {"shares", "error", 0, READING_PART, 0.1, 1e-12},
    {"snapshots", "proved", OUT},
    {"levels", "noise_rms", OUT},
    {"levels", "acceleration", OUT},
    {"levels", "regular", 0, READING_PART, 0.1, 1e-12},
    {"levels", "own", 0, READING_PART, 0.1, 1e-12},
    {"levels", "jittered", 0, READING_PART, 0.1, 1e-12},
    {"levels", "density", 0, READING_PART, 0.1, 1e-12},
    {"levels", "density_regular", 0, READING_PART, 0.1, 1e-12},
    {"", "from", OUT},
    {"", "lost", OUT}, /* derived from the orders */
    {"", "floor", OUT},
    {"printed", "*", OUT}, /* printed by a plug-in; its status is compared */
    {"noise", "*", 0, READING_PART, 0.1, 1e-12},
    {"gates", "*", OUT}, /* bounds, and errors that are compared elsewhere */
    {"", "detected", 0, READING_STATUS, 0, 0},
    {"", "suspicion", 0, READING_STATUS, 0, 0},
    {"", "outcome", 0, READING_STATUS, 0, 0},
    {"", "state", 0, READING_STATUS, 0, 0},
    {"", "same_bits", 0, READING_STATUS, 0, 0},
    {"", "*_wave", 0, READING_STATUS, 0, 0},
    {"orders", "class", 0, READING_STATUS, 0, 0},
    /* errors and their parts */
    {"", "still", 0, READING_CHECK, 0, 1e-9},
    {"still_gas", "value", 0, READING_CHECK, 0, 1e-9},
    {"still_gas", "bound", 0, READING_NEUTRAL, 1e-9, 0},
    {"errors", "linf", 0, READING_PART, 1e-3, 1e-13}, /* a single particle at a jump */
    {"errors", "*", 0, READING_ERROR, 1e-3, 1e-13},
    {"budget", "*", 0, READING_PART, 1e-2, 1e-13},
    {"regions", "l1", 0, READING_PART, 1e-2, 1e-13},
    {"regions", "*", OUT},
    {"conservation", "*", 0, READING_ERROR, 0.1, 1e-12},
    {"regularity", "density", 0, READING_PART, 0.1, 1e-12},
    {"regularity", "gradient", 0, READING_PART, 0.1, 1e-12},
    {"regularity", "spread", 0, READING_PART, 0.1, 1e-12},
    {"regularity", "*", OUT}, /* nearest: better is neither more nor less; pairs are few */
    {"start", "*", 0, READING_PART, 0.1, 1e-12},
    {"matrix", "*", 0, READING_PART, 0.1, 1e-6}, /* condition of matrices; angles in degrees */
    {"floors", "density", 0, READING_CHECK, 0, 1e-13},
    {"floors", "gradient", 0, READING_CHECK, 0, 1e-13},
    {"floors", "*", OUT},
    {"lattice", "density", 0, READING_CHECK, 0, 1e-13},
    {"lattice", "gradient", 0, READING_CHECK, 0, 1e-13},
    {"checks", "value", 0, READING_CHECK, 0, 0},
    {"checks", "*", OUT},
    {"mutants", "*", OUT},
    {"skips", "*_fraction", OUT},
    {"skips", "without_*", OUT},
    {"skips", "asleep", OUT},
    {"skips", "difference", 0, READING_CHECK, 0, 1e-9},
    {"skips", "bound", 0, READING_NEUTRAL, 1e-9, 0},
    {"claims", "*", OUT}, /* about other schemes than the default */
    {"functionals", "extrapolated", 0, READING_EXACT, 0.05, 1e-13},
    {"functionals", "exact", OUT},
    {"functionals", "gci*", OUT},
    {"functionals", "order", OUT},
    {"functionals", "reference", 0, READING_NEUTRAL, 1e-9, 1e-13},
    {"functionals", "*", 0, READING_EXACT, 0.05, 1e-13},
    {"", "error_over_signal", 0, READING_PART, 1e-3, 1e-13}, /* proportional to error */
    {"", "error", 0, READING_ERROR, 1e-3, 1e-13},
    {"", "error_spread", OUT},
    {"", "error_*", 0, READING_ERROR, 1e-2, 1e-12},
    {"", "*momentum_defect", 0, READING_ERROR, 0.1, 1e-12},
    {"", "order", 0, READING_ORDER, 0.02, 0},
    {"", "order_*", 0, READING_ORDER, 0.05, 0},
    {"", "exact_degree_*", 0, READING_ORDER, 0.5, 0},
    {"", "normalisation", 0, READING_EXACT, 1, 1e-12},
    /* maps of stability; the outcome judges a cell */
    {"cells", "measured", 0, READING_PART, 0.1, 1e-13},
    {"cells", "predicted", 0, READING_NEUTRAL, 1e-6, 1e-13},
    {"groups", "bound", 0, READING_NEUTRAL, 1e-9, 0},
    {"groups", "stable_below", 0, READING_NEUTRAL, 1e-9, 0},
    /* sums of figures that are judged one by one: one fault is one regression */
    {"verdict", "*", OUT},
    {"summary", "*", OUT},
    /* operators on clouds */
    {"rows", "neighbours", 0, READING_COUNT, 0.01, 0},
    {"rows", "condition", 0, READING_PART, 0.1, 0},
    /* no direction is better: exact solutions, kernels, gradients and rates of given particles */
    {"speeds", "*", 0, READING_NEUTRAL, 1e-9, 1e-13},
    {"samples", "*", 0, READING_NEUTRAL, 1e-9, 1e-13},
    {"values", "*", 0, READING_NEUTRAL, 1e-9, 1e-13},
    {"moments", "*", 0, READING_NEUTRAL, 1e-9, 1e-13},
    {"fourier", "*", 0, READING_NEUTRAL, 1e-6, 1e-13},
    {"gradients", "*", 0, READING_NEUTRAL, 1e-9, 1e-13},
    {"particles", "*", 0, READING_NEUTRAL, 1e-9, 1e-13},
    {"sums", "*", 0, READING_NEUTRAL, 1e-9, 1e-13},
    {"", "*_star", 0, READING_NEUTRAL, 1e-9, 1e-13},
    {"", "*_star_left", 0, READING_NEUTRAL, 1e-9, 1e-13},
    {"", "*_star_right", 0, READING_NEUTRAL, 1e-9, 1e-13},
    {"", "mean_density", 0, READING_NEUTRAL, 1e-9, 1e-13},
    {"", "signal", 0, READING_NEUTRAL, 1e-9, 1e-13},
    {"", "expected_order", OUT},
    {"", "constant", 0, READING_NEUTRAL, 1e-9, 1e-13},
    {"", "class", 0, READING_NEUTRAL, 0, 0},
    {"", "class_declared", 0, READING_NEUTRAL, 0, 0},
    {"", "pairing_neighbours", 0, READING_NEUTRAL, 1e-6, 0},
    {"", "self_term", 0, READING_NEUTRAL, 1e-9, 1e-13},
    {"", "least_eta", 0, READING_NEUTRAL, 1e-9, 1e-13},
    {"points", "neighbours", 0, READING_NEUTRAL, 0, 0},
    {"points", "condition", 0, READING_NEUTRAL, 1e-6, 0},
    {"points", "h", 0, READING_NEUTRAL, 1e-9, 0},
    /* context: consequences of settings, uncertainties of other figures */
    {"precision", "*", OUT},
    {"resolution", "*", OUT},
    {"window", "*", OUT},
    {"", "negative", OUT},
    {"", "underflow", OUT},
    {"", "n", OUT},
    {"", "h", OUT},
    {"", "spacing", OUT},
    {"", "time", OUT},
    {"", "gamma", OUT},
    {"", "x0", OUT},
    {"", "dim", OUT},
    {"", "dimension", OUT},
    {"", "low", OUT},
    {"", "high", OUT},
    {"", "samples", OUT},
    {"", "spread", OUT},
    {"", "replicates", OUT},
    {"", "computations", OUT},
    {"", "found", OUT},
    {"", "failures", OUT},
    {"", "rank", OUT},
};

static bool fits(const char *pattern, const char *name)
{
    const size_t length = strlen(pattern), own = strlen(name);
    if (pattern[0] == '*')
        return own + 1 >= length && strcmp(name + own - (length - 1), pattern + 1) == 0;
    if (length && pattern[length - 1] == '*') return strncmp(name, pattern, length - 1) == 0;
    return strcmp(pattern, name) == 0;
}

bool metric_passes(const char *path, const char *name)
{
    const size_t length = strlen(name);
    int depth = 0;
    bool start = true;
    for (const char *c = path; *c; c++) {
        if (start && depth == 0 && strncmp(c, name, length) == 0 &&
            (c[length] == '.' || c[length] == '[' || !c[length]))
            return true;
        depth += (*c == '[') - (*c == ']');
        start = *c == '.';
    }
    return false;
}

const struct metric_rule *metric_rule(const char *path, const char *name)
{
    for (size_t i = 0; i < sizeof rules / sizeof *rules; i++) {
        const struct metric_rule *rule = &rules[i];
        if (fits(rule->name, name) && (!*rule->inside || metric_passes(path, rule->inside)))
            return rule;
    }
    return NULL;
}
