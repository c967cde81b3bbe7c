/* SPDX-License-Identifier: GPL-3.0-or-later
 * The kinds of cells of the stress test, each from its own file. */
#pragma once

#include <jansson.h>

#include "run.h"
#include "stress_cell.h"

/* {"predicted", "measured", "outcome", "reason"}; not a number: null. New reference. */
json_t *stress_outcome(double predicted, double measured, const char *outcome, const char *reason);

/* The kind of breakdown in a run's message, in few words. */
const char *stress_outcome_breakdown(const char *message);

/* Cells with a single run: against the exact solution, or of a still box for a long time. */

/* Stops a run after its budget of steps. */
struct stress_watch {
    uint64_t budget;
    double first_step, last_step, last_time; /* mean time steps of the first and last 32 */
    bool out_of_steps;
};

/* The stress_outcome of a run that has ended, or was stopped. */
typedef json_t *stress_judge_run(const struct stress_cell *cell, const struct run_result *result,
                                 const struct stress_watch *watch);

/* The outcome of a run that broke down, did not notice a breakdown, or exhausted its steps
 * (measured is then shown); NULL: none of these. */
json_t *stress_unsound(const struct run_result *result, const struct stress_watch *watch,
                       double measured);

/* Appends to the first `used` characters of a reason what the run has not conserved, each with ";
 * "; returns the length. */
enum { STRESS_REASON = 768 };
int stress_conserved(const struct run_result *result, char reason[STRESS_REASON], int used);

/* Runs a cell; refused settings are an outcome. */
enum status stress_execute(const struct stress_cell *cell, stress_judge_run *judge,
                           json_t **document, struct error *error);

/* Computes a cell of kind STRESS_RUN or STRESS_DRIFT: its stress_outcome. */
enum status stress_run(const struct stress_cell *cell, json_t **document, struct error *error);

/* Cells in 2D and 3D: every case with several schemes, relaxation of disordered gas, lattices
 * against linear theory, time steps. */

/* A column for each built-in case in 2D and 3D, at its smallest size; expensive ones only at
 * night. */
const struct stress_entry *stress_clouds(void);

/* STRESS_CLOUD: a run; measured is the share of particles whose next neighbour is nearer than half
 * a spacing. STRESS_LATTICE: growth of noise, predicted and measured. STRESS_CLOUD_STEP: the
 * largest time step, by the lattice's greatest frequency and by noise runs. */
enum status stress_cloud(const struct stress_cell *cell, json_t **document, struct error *error);

/* STRESS_LATTICE: a growth rate below this, in c/dx, counts as none. */
extern const double stress_cloud_slowest;

/* Cells of linear theory: the eigenvalues (stability.h), and the same limits from runs of the
 * solver on a lattice with noise of 1e-6 spacings. Computes a cell of kind STRESS_LIMIT,
 * STRESS_STEP or STRESS_PAIRING: its stress_outcome. */
enum status stress_linear(const struct stress_cell *cell, json_t **document, struct error *error);

/* Growth rate of the fastest wave over eta, for every kernel and gradient: {"eta": [...], "rows":
 * [{"kernel", "gradient", "growth": [...]}]}. New reference. */
json_t *stress_linear_atlas(void);

/* Noise runs: whether a slightly disturbed lattice at rest stays at rest. */

/* Sets a number of the settings, as a user's key would. */
void stress_noise_set(struct run_settings *settings, enum setting key, double value);

/* Rms speed over the sound speed after `time` spacings/c in gas of density and pressure 1 in a box
 * of size 1; INFINITY if the run broke down, which growing noise finally causes. */
double stress_noise_after(struct run_settings settings, double time);

/* True if the noise has doubled by that time. */
bool stress_noise_grows(const struct run_settings *settings, double time);

/* Cells on the growth of round-off: a run, and the same run from a slightly displaced start.
 * Computes a cell of kind STRESS_AMPLIFY. Measured: the largest relative change of an error norm
 * (L1, L2 of every field) over that of the start, 1e-13 of the spacing. */
enum status stress_amplify(const struct stress_cell *cell, json_t **document, struct error *error);

/* Shock tubes drawn at random, the same ones every time: columns of a map.
 * Entries of the case sod (ratios of density to 1e3, of pressure to 1e5), most of them for the
 * night, ending with a NULL label; they live as long as the program. Not for two threads at once.
 */
const struct stress_entry *stress_tubes(void);
