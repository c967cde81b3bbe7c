/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plan.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "gradient.h"
#include "integrator.h"
#include "simulation.h"
#include "viscosity.h"

struct plan plan_make(const struct scheme *scheme, int dim, bool skip, bool specialised)
{
    const struct viscosity_descriptor *viscosity = &viscosity_of[scheme->viscosity];
    const bool matrix = gradient_of[scheme->gradient].weight != WEIGHT_NONE;
    return (struct plan){
        .dim = dim,
        .sums = sums_find(dim),
        .specialised = specialised,
        .newton = scheme->h_method == H_NEWTON,
        .energy_sum = scheme->volume_element == VOLUME_ENERGY,
        .grad_h = scheme->formulation == FORMULATION_LAGRANGIAN,
        .matrix = matrix,
        .own_gradient = !matrix && (scheme->pair_width == PAIR_WIDTH_MEAN ||
                                    scheme->formulation == FORMULATION_LAGRANGIAN),
        .slope = viscosity_needs_slope(scheme->viscosity) || scheme->balsara == BALSARA_ON,
        .balsara = scheme->balsara == BALSARA_ON,
        .viscosity = !viscosity->none,
        .alpha = viscosity->evolve,
        .jump = viscosity->find_goal,
        .local = scheme->steps == STEPS_LOCAL,
        .shift = scheme->shifting != SHIFTING_NONE,
        .closed = scheme->shifting == SHIFTING_CLOSED,
        .sleep = skip,
        .quiet = skip,
        .signal_pass = scheme->integrator->signal_pass,
    };
}

struct plan plan_of_setup(const struct setup *setup)
{
    struct plan plan = plan_make(&setup->scheme, setup->dim, setup->skip, !setup->generic);
    for (int k = 0; k < setup->dim; k++) plan.gravity |= setup->gravity[k] != 0;
    plan.sleep &= !plan.gravity; /* no particle is at rest */
    return plan;
}

struct writer {
    struct plan_line *lines;
    size_t count, max;
};

static void line(struct writer *writer, const char *pass, bool runs, const char *why_runs,
                 const char *why_not)
{
    if (writer->count++ >= writer->max) return;
    struct plan_line *next = &writer->lines[writer->count - 1];
    next->pass = pass;
    next->runs = runs;
    snprintf(next->why, sizeof next->why, "%s", runs ? why_runs : why_not);
}

/* Adds a sentence to the warnings. */
__attribute__((format(printf, 3, 4))) static void warn(char *text, size_t size, const char *format,
                                                       ...)
{
    const size_t used = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    if (used + 2 < size) {
        const int n = snprintf(text + used, size - used, "%s", used ? "; " : "");
        vsnprintf(text + used + n, size - used - (size_t)n, format, arguments);
    }
    va_end(arguments);
}

static void find_warnings(const struct scheme *scheme, int dim, char *text, size_t size)
{
    /* known in 1D */
    const double unity = dim == 1 ? scheme->kernel.unity_width : 0, eta = scheme->eta;
    const double limit = dim == 1 ? scheme->kernel.stable_eta[scheme->gradient] : 0;
    const double off = unity > 0 ? fabs(eta / unity - fmax(1, round(eta / unity))) * unity : 0;
    text[0] = '\0';
    if (off > 0.03 * eta)
        warn(text, size,
             "eta = %g is off the partition-of-unity widths of %s (multiples of %g): errors will "
             "level off at the lattice-sum floor",
             eta, scheme->kernel.member.name, unity);
    if (limit > 0 && eta > limit)
        warn(
            text, size,
            "eta = %g is beyond %g, where %s with gradient=%s turns linearly unstable: noise grows "
            "unless viscosity hides it",
            eta, limit, scheme->kernel.member.name,
            scheme_gradient_family.members[scheme->gradient]->name);
    if (scheme->energy == ENERGY_TOTAL && viscosity_of[scheme->viscosity].none)
        warn(text, size,
             "energy=total: should the flow get cold (u << v^2), U = E - p^2/2m loses digits");
}

/* Explains the neighbour search. */
static void explain_neighbours(const struct setup *setup, struct writer *writer)
{
    static const char *const ghosts[] = {
        [BOUNDARY_PERIODIC] = "periodic images, so that no loop knows of a boundary",
        [BOUNDARY_OPEN] = "copies far away, so that no loop knows of a boundary",
        [BOUNDARY_REFLECTING] = "mirror images in the walls, so that no loop knows of a boundary",
        [BOUNDARY_FIXED] = "copies far away; the layers are particles whose state is kept",
    };
    bool walls = false;
    if (setup->dim == 1) {
        line(writer, "order", true,
             "neighbours are a contiguous range; sorted anew only if particles cross", "");
        line(writer, "ghost copies", true, ghosts[setup->boundary[0]], "");
        return;
    }
    for (int k = 0; k < setup->dim; k++) walls |= setup->boundary[k] == BOUNDARY_REFLECTING;
    line(writer, "neighbour lists", true,
         "a grid of cells and a list for each particle, made anew where particles have moved", "");
    line(writer, "mirror images", walls, "boundary=reflecting: particles near a wall",
         "no reflecting wall");
}

size_t plan_explain(const struct setup *setup, struct plan_line *lines, size_t max, char *warnings,
                    size_t warnings_size)
{
    const struct scheme *scheme = &setup->scheme;
    const struct plan plan = plan_of_setup(setup);
    struct writer writer = {lines, 0, max};
    explain_neighbours(setup, &writer);
    line(&writer, "smoothing length by Newton", plan.newton,
         "h = eta m/rho to h_tolerance at every evaluation",
         "h_method=predicted: 1/h extrapolated from the last two density sums, each with a Newton "
         "step");
    line(&writer, "density sum", true, plan.newton ? "inside the Newton iteration" : "one a step",
         "");
    line(&writer, "energy sum", plan.energy_sum, "volume_element=energy: P from the sum of U",
         "pressure from density");
    line(&writer, "grad-h factors", plan.grad_h, "formulation=lagrangian",
         "formulation=vanilla_ice has none");
    line(&writer, "moment matrix", plan.matrix, "gradients by the inverse of sum V x x^T W",
         "gradient=standard needs none");
    line(&writer, "velocity gradient", plan.slope,
         plan.balsara ? "for the Balsara factor of the viscosity"
         : plan.jump  ? "for the switch of the viscosity"
                      : "for the midpoint velocities of the viscosity",
         "no viscosity needs it");
    line(&writer, "pair forces", true,
         setup->dim == 1 ? "half loop, antisymmetric fluxes"
                         : "most pairs once, for both particles, opposite to the last bit",
         "");
    line(&writer, "artificial viscosity", plan.viscosity, "inside the pair loop", "viscosity=none");
    line(&writer, "evolution of alpha", plan.alpha || plan.jump,
         plan.jump ? "viscosity=cullen_dehnen, once a step, with the gradient of the acceleration"
                   : "viscosity=time_dependent, with div v",
         "alpha is constant");
    line(&writer, "signal speed", plan.signal_pass,
         "the integrator changes velocities after the last force", "comes with the pair forces");
    if (setup->dim > 1) {
        line(&writer, "local steps", plan.local,
             "each particle takes its own, by powers of two, and a pair the shorter one of its two "
             "particles",
             "steps=global: all particles take the shortest one");
        line(&writer, "conductivity", scheme_conducts(scheme), "inside the pair loop",
             "alpha_u=0, shock_conductivity=0");
        line(&writer, "gravity", plan.gravity, "added to the forces", "gravity=0");
        line(&writer, "particle shifting", plan.shift,
             scheme->shifting == SHIFTING_CLOSED
                 ? "shifting=closed: pair gradients are closed, and mass, momentum and energy "
                   "exchanged inside the pair loop"
                 : "shifting=fluxes: mass, momentum and energy are exchanged inside the pair loop",
             "shifting=none: particles move with the flow");
    }
    line(&writer, "sleep", plan.sleep,
         "skip=auto: no sums where no signal has been; acts as a start changed by 1e-11, in 2D and "
         "3D by up to 1e-8",
         plan.gravity ? "gravity: no particle is at rest"
                      : "skip=none: every particle at every step");
    line(&writer, "final state", !scheme->integrator->ends_evaluated,
         "density and equation of state once more at t_end", "the last evaluation was at t_end");
    if (warnings && warnings_size) find_warnings(scheme, setup->dim, warnings, warnings_size);
    return writer.count;
}
