/* SPDX-License-Identifier: GPL-3.0-or-later
 * Problems: what a run starts from and what it is judged by, in one, two and three dimensions. Each
 * is one file in problem/ and one line in problems.def; nothing outside of problem/ asks which one
 * a run has, only what its descriptor says. Code units throughout. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "field.h"
#include "settings.h"
#include "simulation.h"
#include "status.h"

enum { PROBLEM_OWN_BYTES = 4096, PROBLEM_FUNCTIONALS_MAX = 6, PROBLEM_REGIONS_MAX = 8 };

struct initial;

/* The gas at one place and time. */
struct problem_state {
    double rho, v[3], P, u;
};

/* A problem with the numbers of one run. Plain data: it may be copied, and owns no
 * memory. */
struct prepared {
    const struct problem *problem;
    struct domain domain;
    struct window window; /* where errors are measured; its centre: the middle of the domain */
    double boost[3];      /* added to all velocities: the solution and the window move along */
    enum boundary boundary[3];
    bool walled;       /* particles beyond ends that are not periodic are none of the gas */
    double gravity[3]; /* acceleration; prepare may set it where the key is automatic */
    double gamma;
    /* What the problem works out once and then works with (solved jumps, an eigenmode ...). */
    union {
        max_align_t align;
        unsigned char bytes[PROBLEM_OWN_BYTES];
    } own;
};

/* What a key of a problem is for. */
enum problem_role {
    ROLE_NEEDED,   /* says which problem it is, and a case file has to give it */
    ROLE_OPTIONAL, /* the same, with a fallback */
    ROLE_PARTICLES /* how particles are laid: the same problem, solved otherwise */
};

/* A key that only those problems read that name it. */
struct problem_key {
    enum setting key;
    enum problem_role role;
};

/* A scalar of a state, at any time of a run: a mean, the place of a shock, the amplitude of a mode.
 * What Richardson's extrapolation is for. */
struct functional {
    const char *name;                          /* no other of the problem has it */
    bool (*present)(const struct prepared *p); /* NULL: with all settings */
    double (*measure)(const struct prepared *p, const struct snapshot *s);
    double (*exact)(const struct prepared *p,
                    double t); /* or from a reference; NULL, NaN: unknown */
};

/* An amplitude that grows like exp(rate t): the rate is measured through the run, and is one more
 * functional of its result. */
struct growing {
    const char *name; /* of the rate */
    double (*amplitude)(const struct prepared *p, const struct snapshot *s);
    void (*during)(const struct prepared *p, double times[2]); /* it grows like that */
    double (*rate)(const struct prepared *p);                  /* exact */
};

/* Parts of the exact solution, for an error budget. */
struct regions {
    const char *names[PROBLEM_REGIONS_MAX + 1]; /* ends with NULL */
    /* Position among the names of what is at x; reach: numerical width of a wave there. */
    size_t (*at)(const struct prepared *p, const double x[3], double reach, double t);
    /* max |v - v0|/c in gas of the whole box that no wave has reached; NaN: too few particles. */
    double (*still)(const struct prepared *p, const struct snapshot *s);
};

/* What may be at both ends of a direction so that the sample stays exact. {0}: periodic only. */
struct problem_ends {
    enum boundary usual; /* unless a case or the user says otherwise */
    unsigned also;       /* PROBLEM_END(OPEN) | ... : what else is sound */
};
#define PROBLEM_END(name) (1u << BOUNDARY_##name)

/* Flows with azimuthal and radial errors: round the middle of the domain, and to it or from it. */
enum circular { CIRCULAR_NOT, CIRCULAR_ROUND, CIRCULAR_RADIAL };

/* Solutions of users (own_reference.h); only functions know other times, the start too. */
enum own_kind { OWN_NOT, OWN_TABLE, OWN_FUNCTION };

struct problem {
    struct member member;  /* in cases: kind = NAME */
    const char *reference; /* exact solution, as case files name it */
    int least_dim, most_dim;
    bool carried; /* exact everywhere in the periodic box, so that it may be boosted */
    enum circular circular;
    bool fieldless;       /* of t > 0 only functionals are known: there are no errors of fields */
    bool unknown[FIELDS]; /* nor of these, although others are known; their samples are NaN */
    enum own_kind own;    /* whose its sample is */
    bool liquid;          /* weakly compressible: for snapshots and runs of other codes only */
    bool filed;           /* its particles come from a file, always */
    bool heavy;           /* it takes gravity: any other has no solution in it */
    bool steady; /* the exact flow is the same at all times, but for where the boost carries it */
    bool shifts; /* closed gradients and particle shifting make its errors smaller */
    bool shifts_equal_masses; /* they do with equal_masses=yes, whose particles are in disorder */
    bool smooth;              /* neither jumps nor shocks, for as long as it is solved */
    struct problem_ends ends[3];
    /* NULL, but where energy starts in the middle of the window: the sample at t = 0 does not show
     * it, and later u has no bound there. Energy over mass of the ball of radius r round it. */
    double (*mean_energy)(const struct prepared *p, double r, double t);
    const struct problem_key *keys; /* its own, beside those of every run */
    size_t key_count;
    /* Checks its own keys, gives those that are automatic a value, fills p->own; domain, boost,
     * gamma, boundary and gravity are there, and a window which it may replace unless the user
     * asked for one. STATUS_BAD_INPUT: what is wrong with them, or why nothing is exact. */
    enum status (*prepare)(struct prepared *p, struct settings *settings, struct error *error);
    /* The state at x and t: the initial one at t = 0, the exact one after that. Where the exact gas
     * is a vacuum: rho, P and u 0, and a velocity that joins its edges. */
    void (*sample)(const struct prepared *p, const double x[3], double t,
                   struct problem_state *state);
    /* Particles of the initial state, undisturbed and without boost: see initial.h. */
    enum status (*fill)(const struct prepared *p, const struct settings *settings,
                        struct initial *initial, struct error *error);
    /* Is the sample at t exact in the whole window: no wave from an image of the domain has come
     * in, none has broken? NULL: always. */
    bool (*holds)(const struct prepared *p, double t);
    /* Says why it does not; longest: the last time at which it does. */
    enum status (*refuse)(const struct prepared *p, double t, double longest, struct error *error);
    /* How far ahead of the nearest wave x lies, without boost; <= 0 where one has been. NULL: no
     * wave has an edge. */
    double (*ahead)(const struct prepared *p, const double x[3], double t);
    /* Does the start depend on the seed? */
    bool (*random)(const struct settings *settings);
    /* Ends with NULL; with the rate of what grows at most PROBLEM_FUNCTIONALS_MAX. */
    const struct functional *functionals[PROBLEM_FUNCTIONALS_MAX + 1];
    const struct growing *growing; /* NULL: nothing grows */
    const struct regions *regions; /* NULL: none */
};

void problem_sample(const struct prepared *p, const double x[3], double t,
                    struct problem_state *state);

/* Are there errors of that field? */
bool problem_knows(const struct problem *problem, enum field field);

/* A field of a state; velocity: along x. */
double problem_field(const struct problem_state *state, enum field field);

/* Means of a field over each of bins equal parts of the window at t, to 1e-10 (dim = 1). */
void problem_means(const struct prepared *p, enum field field, double t, size_t bins,
                   double *means);

/* STATUS_BAD_INPUT where the sample is not exact in the window at t: why, and up to when it is. */
enum status problem_check_time(const struct prepared *p, double t, struct error *error);

/* For a problem's prepare: is key, "rho v P", a state that particles can have? */
enum status problem_check_state(const struct settings *settings, enum setting key,
                                struct error *error);

/* Position and velocity of particle i, without what the boost has done. */
void problem_place(const struct prepared *p, const struct snapshot *s, size_t i, double x[3]);
void problem_velocity(const struct prepared *p, const struct snapshot *s, size_t i, double v[3]);

/* How much of the volume of particle i lies in the window; continuous in its position. The particle
 * is a cube along the axes; where the box is periodic its images count, too, and along a direction
 * in which the window is as long as a box that gas cannot leave nothing is cut. The surface of a
 * disc or a ball cuts a cube as a plane across the radius does. NaN: it is nowhere. */
double problem_window_part(const struct prepared *p, const struct snapshot *s, size_t i);

/* Distance from the window's centre of a place as problem_place gives it. */
double problem_radius(const struct prepared *p, const double x[3]);

/* For a problem's prepare: the key direction as a unit vector, and the length of a wave that runs
 * so and fits the box once. Where it is automatic: along x. */
enum status problem_direction(const struct prepared *p, struct settings *settings, double n[3],
                              double *length, struct error *error);

/* Has a run azimuthal and radial errors? Those of circular problems in 2D and 3D. */
bool problem_is_circular(const struct prepared *p);

/* Parts along the circle round the window's centre, and away from it, of a vector at x in a plane;
 * in space the first is the size of the part across the radius. At the centre itself: 0. */
void problem_circular(const struct prepared *p, const double x[3], const double v[3],
                      double *azimuthal, double *radial);
