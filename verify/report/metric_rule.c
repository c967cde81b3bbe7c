/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "metric.h"

#include <string.h>

#define OUT RULE_LEFT_OUT, 0, 0, 0

static const struct metric_rule rules[] = {
    {"spread", "*", OUT}, /* of replicates: the noise of other figures */
    /* depends on timings, or sums figures that are judged one by one */
    {"cheapest estimate", "*", OUT}, /* estimate of the run that follows */
    {"comparison", "only_seed_survives", 0, METRIC_PART, 0, 0},
    {"comparison", "*", OUT},
    {"checks", "seconds", OUT}, /* among thousands some are always slow */
    {"", "limit_over_this seed_plain_over_this saves share skipped_fraction on_front", OUT},
    {"threads", "gain*", OUT},
    /* time, memory, work */
    {"", "wall_s seconds", 0, METRIC_TIMING, 3, 0}, /* other processes affect it */
    {"", "*_s cpu_s_* ns_* exponent figure_of_merit peak_rss_bytes bytes_per_particle", 0,
     METRIC_TIMING, 1.5, 0},
    {"", "steps particle_updates pair_interactions pairs_per_particle", 0, METRIC_COUNT, 0.01, 0},
    {"", "skipped_particle_updates without_slope without_viscosity without_conductivity", OUT},
    /* words */
    {"faults", "status", 0, METRIC_STATUS, 0, 0},
    {"faults", "*", OUT},
    {"score", "score", 0, METRIC_ORDER, 0.05, 0}, /* a new sample each night */
    {"score", "*", OUT},
    {"findings", "*", OUT}, /* names contain file names; the status sums them up */
    {"", "status", 0, METRIC_STATUS, 0, 0},
    {"kernel", "*", OUT},         /* of a snapshot: identified, not judged */
    {"", "foreign", OUT},         /* the status tells whether this passes */
    {"code", "exit_status", OUT}, /* the reason is compared instead */
    /* autopsies: the parts of an error grow and shrink with the error */
    {"power", "*", OUT},
    {"shares", "order",
     OUT}, /* compared for the sizes of parts, in reports only for the whole error */
    {"error", "order", 0, METRIC_ORDER, 0.05, 0},
    {"autopsies", "order", OUT},
    {"parts", "size", 0, METRIC_PART, 0.1, 1e-12},
    {"parts", "noise along", OUT},
    {"shares", "error", 0, METRIC_PART, 0.1, 1e-12},
    {"snapshots", "proved", OUT},
    {"levels", "noise_rms acceleration", OUT},
    {"levels", "regular own jittered density density_regular", 0, METRIC_PART, 0.1, 1e-12},
    {"", "from lost floor", OUT}, /* what is lost is derived from the orders */
    {"printed", "*", OUT},        /* printed by a plug-in; its status is compared */
    {"noise", "*", 0, METRIC_PART, 0.1, 1e-12},
    {"gates", "*", OUT}, /* bounds, and errors that are compared elsewhere */
    {"", "detected suspicion outcome state same_bits *_wave", 0, METRIC_STATUS, 0, 0},
    {"orders", "class", 0, METRIC_STATUS, 0, 0},
    /* errors and their parts */
    {"", "still", 0, METRIC_CHECK, 0, 1e-9},
    {"still_gas", "value", 0, METRIC_CHECK, 0, 1e-9},
    {"still_gas", "bound", 0, METRIC_NEUTRAL, 1e-9, 0},
    {"errors", "linf", 0, METRIC_PART, 1e-3, 1e-13}, /* a single particle at a jump */
    {"errors", "*", 0, METRIC_ERROR, 1e-3, 1e-13},
    {"budget", "*", 0, METRIC_PART, 1e-2, 1e-13},
    {"regions", "l1", 0, METRIC_PART, 1e-2, 1e-13},
    {"regions", "*", OUT},
    {"conservation", "*", 0, METRIC_ERROR, 0.1, 1e-12},
    {"regularity", "density gradient spread", 0, METRIC_PART, 0.1, 1e-12},
    {"regularity", "*", OUT}, /* nearest: better is neither more nor less; pairs are few */
    {"start", "*", 0, METRIC_PART, 0.1, 1e-12},
    {"matrix", "*", 0, METRIC_PART, 0.1, 1e-6}, /* condition of matrices; angles in degrees */
    {"floors lattice", "density gradient", 0, METRIC_CHECK, 0, 1e-13},
    {"floors", "*", OUT},
    {"checks", "value", 0, METRIC_CHECK, 0, 0},
    {"checks mutants", "*", OUT},
    {"skips", "*_fraction without_* asleep", OUT},
    {"skips", "difference", 0, METRIC_CHECK, 0, 1e-9},
    {"skips", "bound", 0, METRIC_NEUTRAL, 1e-9, 0},
    {"claims", "*", OUT}, /* about other schemes than the default */
    {"functionals", "exact gci* order", OUT},
    {"functionals", "reference", 0, METRIC_NEUTRAL, 1e-9, 1e-13},
    {"functionals", "*", 0, METRIC_EXACT, 0.05, 1e-13},
    {"", "error_over_signal", 0, METRIC_PART, 1e-3, 1e-13}, /* proportional to error */
    {"", "error", 0, METRIC_ERROR, 1e-3, 1e-13},
    {"", "error_spread", OUT},
    {"", "error_*", 0, METRIC_ERROR, 1e-2, 1e-12},
    {"", "*momentum_defect", 0, METRIC_ERROR, 0.1, 1e-12},
    {"", "order", 0, METRIC_ORDER, 0.02, 0},
    {"", "order_*", 0, METRIC_ORDER, 0.05, 0},
    {"", "exact_degree_*", 0, METRIC_ORDER, 0.5, 0},
    {"", "normalisation", 0, METRIC_EXACT, 1, 1e-12},
    /* maps of stability; the outcome judges a cell */
    {"cells", "measured", 0, METRIC_PART, 0.1, 1e-13},
    {"cells", "predicted", 0, METRIC_NEUTRAL, 1e-6, 1e-13},
    {"groups", "bound stable_below", 0, METRIC_NEUTRAL, 1e-9, 0},
    /* sums of figures that are judged one by one: one fault is one regression */
    {"verdict summary", "*", OUT},
    /* operators on clouds */
    {"rows", "neighbours", 0, METRIC_COUNT, 0.01, 0},
    {"rows", "condition", 0, METRIC_PART, 0.1, 0},
    /* no direction is better: exact solutions, kernels, gradients and rates of given particles */
    {"fourier", "*", 0, METRIC_NEUTRAL, 1e-6, 1e-13},
    {"speeds samples values moments gradients particles sums", "*", 0, METRIC_NEUTRAL, 1e-9, 1e-13},
    {"", "*_star *_star_left *_star_right mean_density signal constant self_term least_eta", 0,
     METRIC_NEUTRAL, 1e-9, 1e-13},
    {"", "class class_declared", 0, METRIC_NEUTRAL, 0, 0},
    {"", "pairing_neighbours", 0, METRIC_NEUTRAL, 1e-6, 0},
    {"points", "neighbours", 0, METRIC_NEUTRAL, 0, 0},
    {"points", "condition", 0, METRIC_NEUTRAL, 1e-6, 0},
    {"points", "h", 0, METRIC_NEUTRAL, 1e-9, 0},
    /* context: consequences of settings, uncertainties of other figures */
    {"precision resolution window", "*", OUT},
    {"", "expected_order negative underflow h spacing time gamma x0 dimension low high samples",
     OUT},
    {"", "spread replicates computations found rank", OUT},
};

/* True if the first `length` characters of a pattern fit the name. */
static bool fits(const char *pattern, size_t length, const char *name)
{
    const size_t own = strlen(name);
    if (pattern[0] == '*')
        return own + 1 >= length && !memcmp(name + own + 1 - length, pattern + 1, length - 1);
    if (pattern[length - 1] == '*') return !strncmp(name, pattern, length - 1);
    return own == length && !memcmp(name, pattern, length);
}

/* True if the path has this component outside brackets. */
static bool passes(const char *component, size_t length, const char *path)
{
    int depth = 0;
    bool start = true;
    for (const char *c = path; *c; c++) {
        if (start && depth == 0 && !strncmp(c, component, length) &&
            (c[length] == '.' || c[length] == '[' || !c[length]))
            return true;
        depth += (*c == '[') - (*c == ']');
        start = *c == '.';
    }
    return false;
}

/* True if `holds` for one of the words. */
static bool any_word(const char *words, bool (*holds)(const char *, size_t, const char *),
                     const char *of)
{
    for (size_t length; *words; words += length + strspn(words + length, " ")) {
        length = strcspn(words, " ");
        if (holds(words, length, of)) return true;
    }
    return false;
}

bool metric_passes(const char *path, const char *names)
{
    return any_word(names, passes, path);
}

const struct metric_rule *metric_rule(const char *path, const char *name)
{
    for (size_t i = 0; i < sizeof rules / sizeof *rules; i++) {
        const struct metric_rule *rule = &rules[i];
        if (any_word(rule->names, fits, name) &&
            (!*rule->inside || metric_passes(path, rule->inside)))
            return rule;
    }
    return NULL;
}
