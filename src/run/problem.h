/* SPDX-License-Identifier: GPL-3.0-or-later
 * Problems in one, two and three dimensions: the initial state of a run and the exact solution for
 * its errors. Each problem is one file in problem/ and one line in problems.def. Code outside
 * problem/ depends only on the descriptor, never on a particular problem. Code units. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "field.h"
#include "settings.h"
#include "simulation.h"
#include "status.h"

enum { PROBLEM_OWN_BYTES = 4096, PROBLEM_FUNCTIONALS_MAX = 6, PROBLEM_REGIONS_MAX = 8 };

struct initial;

/* State of the gas at one position and time. */
struct problem_state {
    double rho, v[3], P, u;
};

/* A problem with the numbers of one run. Plain data that owns no memory and may be copied. */
struct prepared {
    const struct problem *problem;
    struct domain domain;
    struct window window; /* for errors; its centre is the middle of the domain */
    double boost[3];      /* added to all velocities; the solution and the window move with it */
    enum boundary boundary[3];
    bool walled;       /* particles beyond a non-periodic end are not part of the gas */
    double gravity[3]; /* acceleration; prepare may set an automatic one */
    double gamma;
    /* Private data of the problem, computed once by prepare (solved jumps, an eigenmode ...). */
    union {
        max_align_t align;
        unsigned char bytes[PROBLEM_OWN_BYTES];
    } own;
};

/* For the file of a problem with its own data, a struct TYPE: defines TYPE_of(p). */
#define PROBLEM_OWN(type)                                                                          \
    _Static_assert(sizeof(struct type) <= PROBLEM_OWN_BYTES, "the problem's own data fit");        \
    static const struct type *type##_of(const struct prepared *p)                                  \
    {                                                                                              \
        return (const struct type *)p->own.bytes;                                                  \
    }

/* The purpose of a problem's key. */
enum problem_role {
    ROLE_NEEDED,   /* defines the problem; a case file must give it */
    ROLE_OPTIONAL, /* defines the problem; has a default */
    ROLE_PARTICLES /* arranges the particles: the same problem, discretised differently */
};

/* A key that is read only by the problems that list it. */
struct problem_key {
    enum setting key;
    enum problem_role role;
};

/* A scalar of the state at any time of a run: a mean, a shock position, the amplitude of a mode.
 * Used for Richardson extrapolation. */
struct functional {
    const char *name;                          /* unique within the problem */
    bool (*present)(const struct prepared *p); /* NULL: exists with all settings */
    double (*measure)(const struct prepared *p, const struct snapshot *s);
    double (*exact)(const struct prepared *p,
                    double t); /* exact or from a reference; NULL or NaN: unknown */
};

/* An amplitude that grows like exp(rate t). The rate is measured during the run and becomes one
 * more functional of the result. */
struct growing {
    const char *name; /* of the rate */
    double (*amplitude)(const struct prepared *p, const struct snapshot *s);
    void (*during)(const struct prepared *p, double times[2]); /* interval of exponential growth */
    double (*rate)(const struct prepared *p);                  /* exact value */
};

/* Regions of the exact solution, for an error budget. */
struct regions {
    const char *names[PROBLEM_REGIONS_MAX + 1]; /* NULL-terminated */
    /* Index of the region at x in `names`; reach: numerical half-width of a wave there. */
    size_t (*at)(const struct prepared *p, const double x[3], double reach, double t);
    /* max |v - v0|/c in gas of the whole box that no wave has reached; NaN: too few particles. */
    double (*still)(const struct prepared *p, const struct snapshot *s);
};

/* Boundaries of one direction that keep the sample exact. {0}: periodic only. */
struct problem_ends {
    enum boundary usual; /* default */
    unsigned also;       /* other valid boundaries: PROBLEM_END(OPEN) | ... */
};
#define PROBLEM_END(name) (1u << BOUNDARY_##name)
#define PROBLEM_WALLS                                                                              \
    {                                                                                              \
        .also = PROBLEM_END(REFLECTING) | PROBLEM_END(FIXED)                                       \
    }

/* Flows whose velocity errors have azimuthal and radial parts: rotating around the middle of the
 * domain, or moving towards it or away from it. */
enum circular { CIRCULAR_NOT, CIRCULAR_ROUND, CIRCULAR_RADIAL };

/* Exact solutions of users (user_solution.h). A table is valid at one time only, a function at any
 * time, including the start. */
enum user_kind { USER_NOT, USER_TABLE, USER_FUNCTION };

struct problem {
    struct member member;  /* the key `kind` selects it by name */
    const char *reference; /* exact solution, by its name in case files */
    int least_dim, most_dim;
    bool carried; /* exact everywhere in the periodic box, so that a boost is allowed */
    enum circular circular;
    bool fieldless;           /* for t > 0 only functionals are known; there are no field errors */
    bool unknown[FIELDS];     /* fields without exact values; their samples are NaN */
    enum user_kind user;      /* who provides the sample */
    bool liquid;              /* weakly compressible: only for snapshots and runs of other codes */
    bool filed;               /* the particles always come from a file */
    bool heavy;               /* has a solution with gravity; no other problem allows gravity */
    bool steady;              /* the exact flow does not change with time, except for the boost */
    bool shifts;              /* closed gradients and particle shifting reduce the errors */
    bool shifts_equal_masses; /* they also do so with equal_masses=yes, where particles are
                                 disordered */
    bool smooth;              /* no jumps and no shocks while the solution holds */
    struct problem_ends ends[3];
    /* For a point explosion: energy over mass of the ball of radius r around the middle of the
     * window. The sample at t = 0 does not show this energy, and u is unbounded there later. Else
     * NULL. */
    double (*mean_energy)(const struct prepared *p, double r, double t);
    const struct problem_key *keys; /* in addition to those of every run; see PROBLEM_KEYS */
    size_t key_count;
    /* Checks the problem's keys, sets the automatic ones, and fills p->own. On entry domain, boost,
     * gamma, boundary and gravity are set, and a window, which prepare may replace unless the user
     * asked for one. STATUS_BAD_INPUT: the keys are invalid or give no exact solution. */
    enum status (*prepare)(struct prepared *p, struct settings *settings, struct error *error);
    /* The state at x and t: initial at t = 0, exact later. In a vacuum of the exact solution rho, P
     * and u are 0, and the velocity joins those at the edges of the vacuum. */
    void (*sample)(const struct prepared *p, const double x[3], double t,
                   struct problem_state *state);
    /* Makes the particles of the initial state, without perturbation and boost: see initial.h. */
    enum status (*fill)(const struct prepared *p, const struct settings *settings,
                        struct initial *initial, struct error *error);
    /* True if the sample at t is exact in the whole window: no wave from an image of the domain has
     * entered and no wave has broken. NULL: always. */
    bool (*holds)(const struct prepared *p, double t);
    /* Reports why the sample is not exact; longest: the last time at which it is. */
    enum status (*refuse)(const struct prepared *p, double t, double longest, struct error *error);
    /* Distance of x from the nearest wave, without boost; <= 0 where a wave has passed. NULL: no
     * wave has an edge. */
    double (*ahead)(const struct prepared *p, const double x[3], double t);
    /* NULL-terminated; at most PROBLEM_FUNCTIONALS_MAX including the growth rate. */
    const struct functional *functionals[PROBLEM_FUNCTIONALS_MAX + 1];
    const struct growing *growing; /* may be NULL */
    const struct regions *regions; /* may be NULL */
};

/* The members keys and key_count of a list of struct problem_key. */
#define PROBLEM_KEYS(...)                                                                          \
    .keys = (const struct problem_key[]){__VA_ARGS__},                                             \
    .key_count = sizeof((const struct problem_key[]){__VA_ARGS__}) / sizeof(struct problem_key)

void problem_sample(const struct prepared *p, const double x[3], double t,
                    struct problem_state *state);

/* The same at t = 0. */
void problem_sample_start(const struct prepared *p, const double x[3], struct problem_state *state);

/* The same at the position of particle i and the time of its snapshot. */
void problem_sample_particle(const struct prepared *p, const struct snapshot *s, size_t i,
                             struct problem_state *state);

/* True if the errors of the field are known. */
bool problem_knows(const struct problem *problem, enum field field);

/* A field of a state; velocity: along x. */
double problem_field(const struct problem_state *state, enum field field);

/* Means of a field at t over `bins` equal parts of the window, to 1e-10 (dim = 1). */
void problem_means(const struct prepared *p, enum field field, double t, size_t bins,
                   double *means);

/* STATUS_BAD_INPUT: the sample is not exact in the window at t; the message says why and until when
 * it is. */
enum status problem_check_time(const struct prepared *p, double t, struct error *error);

/* For prepare of a problem: checks that the key, "rho v P", is a valid state of particles. */
enum status problem_check_state(const struct settings *settings, enum setting key,
                                struct error *error);

/* For prepare of a problem in 2D: checks that the box is a square. */
enum status problem_check_square(const struct prepared *p, struct error *error);

/* Position and velocity of particle i without the boost. */
void problem_position(const struct prepared *p, const struct snapshot *s, size_t i, double x[3]);
void problem_velocity(const struct prepared *p, const struct snapshot *s, size_t i, double v[3]);

/* The part of the volume of particle i that lies in the window; a continuous function of the
 * position. The particle is a cube along the axes. Images in periodic directions count, too.
 * Nothing is cut off along a direction in which the window is as long as a box that gas cannot
 * leave. The surface of a disc or ball is taken as a plane normal to the radius. NaN: no
 * position. */
double problem_window_part(const struct prepared *p, const struct snapshot *s, size_t i);

/* Distance of x, as given by problem_position, from the window's centre. */
double problem_radius(const struct prepared *p, const double x[3]);

/* For prepare of a problem: the key `direction` as a unit vector, and the length of a wave along it
 * that fits the box once. Automatic: along x. */
enum status problem_direction(const struct prepared *p, struct settings *settings, double n[3],
                              double *length, struct error *error);

/* True if the run has azimuthal and radial errors: circular problems in 2D and 3D. */
bool problem_is_circular(const struct prepared *p);

/* Azimuthal and radial parts of a vector at x about the window's centre in 2D. In 3D the azimuthal
 * part is the magnitude of the part normal to the radius. Both are 0 at the centre itself. */
void problem_circular(const struct prepared *p, const double x[3], const double v[3],
                      double *azimuthal, double *radial);
