/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests `judge` on snapshots with planted values: noise, conserved sums, wrong initial states, and
 * limits beyond which a snapshot is far from the solution. */
#include "test.h"

#include "sample_snapshot.h"

/* ---- noise ---- */

/* The rms over the window, by volume, of the velocity components across the flow. */
TEST(transverse_noise)
{
    for (int dim = 1; dim <= 3; dim++)
        for (int only = 0; only <= dim; only++) { /* the component that is not 0; dim: all */
            const struct judge_request request = uniform_gas();
            double sum = 0, volume = 0;
            plant(dim, 0, boxes[dim]);
            for (int i = 0; i < N; i++) {
                gas.rho[i] = draw(1, 1.5);
                for (int d = 0; d < dim; d++)
                    if (only == d || only == dim) gas.v[d][i] = draw(-1e-3, 1e-3);
            }
            for (int i = 0; i < N; i++) {
                if (!(fabs(gas.x[0][i] - 1) <= 0.5)) continue;
                const double V = gas.m[i] / gas.rho[i];
                for (int d = 1; d < dim; d++) sum += V * gas.v[d][i] * gas.v[d][i];
                volume += V;
            }
            struct judged judged = judges(&request);
            if (dim == 1)
                assert_true(isnan(judged.transverse));
            else if (only == 0)
                assert_true(judged.transverse == 0);
            else
                near_relative(judged.transverse, sqrt(sum / volume), 1e-13);
            judge_free(&judged);
        }
    /* in a vortex the radial component */
    struct judge_request request = {.case_name = "gresho", .time = {true, 0}, .kernel = -1};
    plant(2, 0, "");
    for (int i = 0; i < N; i++) {
        gas.x[0][i] = gas.x[0][i] / 2 - 0.5, gas.x[1][i] -= 0.5;
        const double r = hypot(gas.x[0][i], gas.x[1][i]);
        for (int d = 0; d < 2; d++) gas.v[d][i] = 0.01 * gas.x[d][i] / r;
    }
    struct judged judged = judges(&request);
    near_relative(judged.transverse, 0.01, 1e-12);
    judge_free(&judged);
}

/* The spacing of particles in a slab of layers is the cube root of the volume per particle. Where
 * the box has no thickness, it follows from the particles' volumes, and from the particles' extent
 * where there is no box. */
TEST(spacing_of_a_slab)
{
    static const char *const asked[] = {NULL, "-0.5:0.5 -0.5:0.5 0:0.5", "-0.5:0.5 -0.5:0.5", NULL};
    static const double thick[] = {0.125, 0.5, 0.75, 0.75 / (0.9 * 0.8)};
    for (int k = 0; k < 4; k++) {
        const struct judge_request request = {
            .case_name = "gresho", .time = {true, 0}, .kernel = -1, .box = asked[k]};
        plant(3, 0, "# boundary = periodic periodic periodic\n");
        if (k == 0) strcat(gas.head, "# box = -0.5:0.5 -0.5:0.5 0:0.125\n");
        for (int i = 0; i < N; i++) {
            gas.x[0][i] = 0.9 * (gas.x[0][i] / 2 - 0.5), gas.x[1][i] = 0.8 * (gas.x[1][i] - 0.5);
            gas.x[2][i] *= 0.125;
            gas.m[i] = 0.75 / N;
        }
        struct judged judged = judges(&request);
        near_relative(judged.slab, thick[k], 1e-12);
        if (k < 3) near_relative(judged.result.spacing, cbrt(thick[k] / N), 1e-12);
        assert_string_equal(judged.file.boundary, "periodic periodic");
        judge_free(&judged);
    }
}

/* ---- sums ---- */

/* Momentum is not reported where walls, plates or gravity act; motion along with the case's gas
 * does not count. */
TEST(sums_of_any_box)
{
    enum { FEW = 5 };
    double x[3][FEW], v[3][FEW], m[FEW], u[FEW], rho[FEW], P[FEW];
    const struct snapshot s = {.n = FEW,
                               .x = {x[0], x[1], x[2]},
                               .v = {v[0], v[1], v[2]},
                               .m = m,
                               .u = u,
                               .rho = rho,
                               .P = P};
    struct run run = keyed_run("rest_3d", "");
    for (int k = 0; k < 60; k++) {
        struct prepared *p = &run.problem;
        struct conservation got = {0}, want = {0};
        const double shift[3] = {draw(-1, 1), draw(-1, 1), draw(-1, 1)};
        for (int d = 0; d < 3; d++) {
            p->boost[d] = draw(-1, 1);
            p->gravity[d] = draw(0, 1) < 0.3 ? draw(-2, 2) : 0;
            p->boundary[d] = (enum boundary)(k / (d ? 4 * d : 1) % 4);
        }
        for (int i = 0; i < FEW; i++) {
            m[i] = draw(1, 2), u[i] = draw(1, 2), rho[i] = 1, P[i] = 1;
            want.energy += m[i] * u[i];
            for (int d = 0; d < 3; d++) {
                const bool pushed = p->boundary[d] == BOUNDARY_REFLECTING ||
                                    p->boundary[d] == BOUNDARY_FIXED || p->gravity[d] != 0;
                x[d][i] = draw(-1, 1), v[d][i] = draw(-1, 1);
                want.energy +=
                    m[i] * (0.5 * v[d][i] * v[d][i] - p->gravity[d] * (x[d][i] + shift[d]));
                want.kinetic += 0.5 * m[i] * pow(v[d][i] - p->boost[d], 2);
                want.momentum[d] += pushed ? 0 : m[i] * v[d][i];
            }
        }
        judge_sum(p, &s, shift, &got);
        near_relative(got.kinetic, want.kinetic, 1e-13);
        near_absolute(got.energy, want.energy, 1e-13);
        for (int d = 0; d < 3; d++) near_absolute(got.momentum[d], want.momentum[d], 1e-13);
    }
}

TEST(sums)
{
    for (int dim = 1; dim <= 3; dim++)
        for (int shifted = 0; shifted < 2; shifted++) {
            const struct judge_request request = uniform_gas();
            struct conservation want = {0};
            plant(dim, 0, boxes[dim]);
            for (int d = 0; d < dim; d++) gas.x[d][1] -= 1e-6; /* the ends are the same position */
            for (int i = 0; i < N; i++) {
                gas.rho[i] = draw(1, 1.5), gas.u[i] = draw(2, 3);
                for (int d = 0; d < dim; d++) gas.v[d][i] = draw(-1e-2, 2e-2);
            }
            for (int i = 0; i < N; i++) {
                const double c = sqrt(1.4 * 0.4 * gas.u[i]), m = gas.m[i];
                double p[3] = {0}, r[3] = {0}, speed = 0, distance = 0, turning = 0;
                for (int d = 0; d < dim; d++) {
                    p[d] = m * gas.v[d][i];
                    r[d] = gas.x[d][i] - (d ? 0.5 : 1);
                    speed = hypot(speed, gas.v[d][i]), distance = hypot(distance, r[d]);
                    want.momentum[d] += p[d];
                }
                want.mass += m;
                want.energy += m * gas.u[i] + 0.5 * m * speed * speed;
                want.momentum_scale += m * speed;
                want.sound_scale += m * c;
                want.turning_scale += distance * m * c;
                if (dim == 1) continue;
                const double L[3] = {r[1] * p[2] - r[2] * p[1], r[2] * p[0] - r[0] * p[2],
                                     r[0] * p[1] - r[1] * p[0]};
                for (int d = 0; d < 3; d++)
                    want.angular_momentum[d] += L[d], turning = hypot(turning, L[d]);
                want.angular_scale += turning;
            }
            /* positions as in a periodic box with another origin, which judge wraps back */
            for (int i = 2; i < N && shifted; i++)
                if (gas.x[0][i] > 1.5) gas.x[0][i] -= 2;
            if (shifted) gas.x[0][0] = 0, gas.x[0][1] = 0;
            if (shifted) snprintf(gas.head, sizeof gas.head, "# box = 2 1 1\n");
            struct judged judged = judges(&request);
            const struct conservation *got = &judged.sums;
            if (!shifted) near_relative(got->turning_scale, want.turning_scale, 1e-13);
            near_relative(got->mass, want.mass, 1e-13);
            near_relative(got->energy, want.energy, 1e-13);
            near_relative(got->momentum_scale, want.momentum_scale, 1e-13);
            near_relative(got->sound_scale, want.sound_scale, 1e-13);
            for (int d = 0; d < 3; d++) {
                near_absolute(got->momentum[d], want.momentum[d], 1e-14);
                if (!shifted)
                    near_absolute(got->angular_momentum[d], want.angular_momentum[d], 1e-14);
            }
            if (!shifted && dim > 1) near_relative(got->angular_scale, want.angular_scale, 1e-13);
            if (dim == 1) assert_true(got->angular_scale == 0);
            judge_free(&judged);
        }
}

/* The sound speed and the internal energy of a liquid, whose u has no meaning, are the case's. */
TEST(sums_of_a_liquid)
{
    double x[2][1] = {{0.25}, {0.375}}, v[2][1] = {{0.5}, {0}}, m[] = {3}, rho[] = {1}, P[] = {1e9};
    const struct snapshot s = {
        .n = 1, .x = {x[0], x[1]}, .v = {v[0], v[1]}, .m = m, .u = P, .rho = rho, .P = P};
    const double nowhere[3] = {0};
    struct conservation got = {0};
    struct problem_state there;
    const struct run run = keyed_run("taylor_green", "");
    const double gamma = run.problem.gamma;
    problem_sample(&run.problem, (double[3]){0.25, 0.375}, 0, &there);
    judge_sum(&run.problem, &s, nowhere, &got);
    near_relative(got.sound_scale, 3 * sqrt(gamma * (gamma - 1) * there.u), 1e-13);
    near_relative(got.energy, 3 * (there.u + 0.5 * 0.25), 1e-13);
}

/* ---- starts ---- */

/* A tenth of the particles may be wrong without an explanation. */
TEST(a_tenth_may_be_wrong)
{
    for (int dim = 1; dim <= 3; dim++)
        for (int wrong = N / 10 - 1; wrong <= N / 10 + 1; wrong++) {
            struct judge_request request = uniform_gas();
            request.time.value = 0;
            plant(dim, 0, boxes[dim]);
            for (int i = 0; i < N; i++) {
                gas.m[i] = 2. / N;
                if (i < wrong) gas.u[i] *= draw(1.2, 2);
            }
            struct judged judged = judges(&request);
            assert_int_equal(judged.of_start.wrong, wrong);
            assert_true(!judged.of_start.explained && judged.foreign == (wrong > N / 10));
            judge_free(&judged);
        }
}

/* A mass that more than half of the particles have counts as right. */
TEST(most_frequent_mass_is_right)
{
    for (int alike = N / 2 - 1; alike <= N / 2 + 1; alike++) {
        struct judge_request request = uniform_gas();
        request.time.value = 0;
        plant(1, 0, "");
        for (int i = 0; i < N; i++) gas.x[0][i] *= 1.05; /* the case's masses are unknown */
        for (int i = 0; i < N; i++) gas.m[i] = (i % 2 ? draw(1, 1.9) : draw(2.1, 4)) / N;
        for (int i = N - alike; i < N; i++) gas.m[i] = 2. / N;
        struct judged judged = judges(&request);
        const double worst = judged.of_start.worst[START_MASS];
        if (alike > N / 2 ? !(worst > 0.1) : !isnan(worst)) fail_msg("%d: %g", alike, worst);
        judge_free(&judged);
    }
}

/* A code's own pressures, which do not follow from density and energy, are not judged. */
TEST(pressures_of_their_own)
{
    for (int own = N / 2 - 1; own <= N / 2; own++) {
        struct judge_request request = uniform_gas();
        request.time.value = 0;
        plant(1, 0, boxes[1]);
        gas.has_P = true;
        for (int i = 0; i < N; i++) gas.m[i] = 2. / N, gas.P[i] = i < own ? 1.1 : 1;
        struct judged judged = judges(&request);
        const double worst = judged.of_start.worst[START_PRESSURE];
        if (own < N / 2)
            near_relative(worst, 0.1, 1e-9);
        else
            assert_true(isnan(worst) && judged.of_start.wrong == 0);
        judge_free(&judged);
    }
}

/* Beside a jump a particle may have the state of the other side up to one spacing away. */
TEST(particles_beside_a_jump)
{
    static const double away[] = {0.2, 0.45, 0.99, 1.01}; /* in spacings */
    for (int k = 0; k < 4; k++) {
        const struct judge_request request = {
            .case_name = "sod", .time = {true, 0}, .kernel = -1, .boundary = "periodic"};
        plant(1, 0, "# box = 0:2\n");
        for (int i = 0; i < N; i++) {
            gas.x[0][i] = i == 77 ? 1 + away[k] * 2 / N : 2 * (i + 0.5) / N;
            const bool left = i == 77 || gas.x[0][i] < 1;
            gas.rho[i] = left ? 1 : 0.125, gas.u[i] = (left ? 1 : 0.1) / (0.4 * gas.rho[i]);
            gas.m[i] = gas.rho[i] * 2 / N;
        }
        struct judged judged = judges(&request);
        if (judged.of_start.wrong != (size_t)(k == 3))
            fail_msg("%d: %zu: %s", k, judged.of_start.wrong, judged.of_start.message);
        judge_free(&judged);
    }
}

/* The states of a tube with a jump at its middle, on a lattice in a periodic box. */
static void plant_jump(void)
{
    plant(1, 0, "# box = 0:2\n");
    for (int i = 0; i < N; i++) {
        gas.x[0][i] = 2 * (i + 0.5) / N;
        const bool left = gas.x[0][i] < 1;
        gas.rho[i] = left ? 1 : 0.125, gas.u[i] = left ? 2.5 : 2;
        gas.m[i] = gas.rho[i] * 2 / N;
    }
}

/* Particles beside a jump with energies between those of the two sides were moved. */
TEST(energies_across_a_jump)
{
    for (int side = -1; side <= 1; side += 2) {
        const struct judge_request request = {
            .case_name = "sod", .time = {true, 0}, .kernel = -1, .boundary = "periodic"};
        plant_jump();
        for (int k = 0; k < 3; k++) {
            const int i = side < 0 ? N / 2 - 1 - k : N / 2 + k;
            gas.x[0][i] = 1 + side * (0.1 + 0.4 * k) * 2 / N, gas.u[i] = 2.1 + 0.15 * k;
        }
        struct judged judged = judges(&request);
        if (judged.of_start.wrong || !strstr(judged.of_start.message, "the case's state to a s"))
            fail_msg("%d: %zu: %s", side, judged.of_start.wrong, judged.of_start.message);
        judge_free(&judged);
    }
}

/* In flows with jumps, particles that were moved by less than a spacing after they had got their
 * state are not wrong, unless one in 50 is wrong otherwise, or a pressure is. */
TEST(moved_particles)
{
    static const struct {
        double moved;  /* in spacings */
        int hot, fast; /* so many have a wrong energy, a wrong velocity */
        bool pressure, good;
    } rows[] = {{0, 0, 0, false, false},   {0, 0, 0, false, true},    {0.3, 0, 0, false, true},
                {0.3, 3, 0, false, true},  {0.3, 6, 0, false, false}, {0.3, 0, 3, false, true},
                {0.3, 0, 6, false, false}, {0.3, 0, 0, true, false},  {2.5, 0, 0, false, false}};
    double mass = 1; /* of the case, after the first row */
    const struct run run = keyed_run("noh_2d", "");
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const struct judge_request request = {
            .case_name = "noh_2d", .time = {true, 0}, .kernel = -1};
        plant(2, 0, "");
        const struct domain *box = &run.problem.domain;
        const double side = domain_length(box, 0);
        snprintf(gas.head, sizeof gas.head, "# box = %.17g:%.17g %.17g:%.17g\n", box->lo[0],
                 box->hi[0], box->lo[1], box->hi[1]);
        gas.has_P = true;
        for (int i = 0; i < N; i++) {
            struct problem_state s;
            /* not about the middle, where velocities differ by any amount */
            double x[3] = {box->lo[0] + side * draw(0.4, 0.6), box->lo[1] + side * draw(0.56, 0.68),
                           0};
            problem_sample(&run.problem, x, 0, &s);
            const double angle = draw(0, 2 * M_PI), by = rows[k].moved * side / sqrt(N);
            gas.x[0][i] = x[0] + by * cos(angle), gas.x[1][i] = x[1] + by * sin(angle);
            for (int d = 0; d < 2; d++) gas.v[d][i] = s.v[d];
            gas.m[i] = mass / N, gas.rho[i] = s.rho;
            gas.v[0][i] += i < rows[k].fast ? 2 : 0;
            gas.u[i] = s.u * (i < rows[k].hot ? 1.5 : 1);
            gas.P[i] = (run.problem.gamma - 1) * gas.rho[i] * gas.u[i];
        }
        if (rows[k].pressure) gas.P[77] *= 1.01;
        struct judged judged = judges(&request);
        mass = judged.start.mass;
        if ((judged.of_start.wrong == 0) != rows[k].good)
            fail_msg("row %zu: %zu wrong: %s", k, judged.of_start.wrong, judged.of_start.message);
        if (rows[k].good && k > 1)
            assert_non_null(strstr(judged.of_start.message, "the case's state to a spacing"));
        judge_free(&judged);
    }
}

/* In 1D a mass that fills the space between the neighbours is right, where spacings are graded. */
TEST(masses_of_graded_spacings)
{
    static const int at[] = {0, 200, N - 2, N - 1};
    for (size_t a = 0; a < 4; a++)
        for (int k = 0; k < 4; k++) {
            struct judge_request request = uniform_gas();
            double gap[N + 1], x = 0;
            request.time.value = 0;
            plant(1, 0, boxes[1]);
            for (int i = 0; i <= N; i++)
                gap[i] = i >= 20 && i < 170 ? 1 : 1 + 0.01 * ((i + 70) % N);
            for (int i = 0; i <= N; i++) x += gap[i];
            const double unit = 2 / x;
            x = 0;
            for (int i = 0; i < N; i++) x += gap[i] * unit, gas.x[0][i] = x;
            for (int i = 0; i < N; i++) {
                const double before = i ? gap[i] : gap[1], after = i < N - 1 ? gap[i + 1] : gap[i];
                const double factors[] = {1.045 * fmax(before, after), 1.055 * fmax(before, after),
                                          0.955 * fmin(before, after), 0.945 * fmin(before, after)};
                gas.m[i] = unit * (i == at[a] ? factors[k] : 0.5 * (before + after));
            }
            struct judged judged = judges(&request);
            if (judged.of_start.wrong != (size_t)(k % 2))
                fail_msg("%zu, %d: %zu: %s", a, k, judged.of_start.wrong, judged.of_start.message);
            judge_free(&judged);
        }
}

/* Where the total mass is not the case's, the mass that gives the case's total is right, although
 * most particles have another. */
TEST(most_masses_are_wrong)
{
    for (int k = 0; k < 3; k++) {
        struct judge_request request = uniform_gas();
        const int wrong = k == 0 ? N * 2 / 5 : k == 1 ? N * 3 / 5 : N;
        char says[120];
        request.time.value = 0;
        plant(1, 0, boxes[1]);
        for (int i = 0; i < N; i++) gas.x[0][i] = 2 * (i + 0.5) / N;
        for (int i = 0; i < N; i++) gas.m[i] = (i < wrong ? 3. : 2.) / N;
        struct judged judged = judges(&request);
        assert_int_equal(judged.of_start.wrong, wrong);
        assert_true(judged.of_start.explained && judged.foreign);
        snprintf(says, sizeof says, "(%d of %d) have the wrong mass", wrong, N);
        if (k == 2) snprintf(says, sizeof says, "all particles have the wrong mass: it is 1.5");
        assert_non_null(strstr(judged.of_start.message, says));
        assert_non_null(strstr(judged.of_start.message, "it is 1.5 times the case's"));
        judge_free(&judged);
    }
}

/* So is the volume that gives the case's total, in gas of two densities with equal volumes. */
TEST(most_volumes_are_wrong)
{
    const struct judge_request request = {
        .case_name = "sod", .time = {true, 0}, .kernel = -1, .boundary = "periodic"};
    plant_jump();
    for (int i = 0; i < N; i++)
        if (i % 5 < 3) gas.m[i] *= 1.5;
    struct judged judged = judges(&request);
    assert_int_equal(judged.of_start.wrong, N * 3 / 5);
    assert_non_null(strstr(judged.of_start.message, "it is 1.5 times the case's"));
    judge_free(&judged);
}

/* In gas of two densities each has a particle mass of its own; if the two differ by more than 15 %,
 * in a flow where they should not, those of fewer particles are wrong. (3: most particles of both
 * have too much, which the total mass shows.) */
TEST(masses_of_two_gases)
{
    double whole = 1.75;                    /* the case's total mass */
    for (int first = 0; first < 2; first++) /* the gas of particle 0: thin or dense */
        for (int k = 0; k < 4; k++) {
            struct judge_request request = {.case_name = "square", .time = {true, 0}, .kernel = -1};
            const double factor = k % 3 == 0 ? 1 : k == 1 ? 1.149 : 1.151;
            int dense = 0;
            plant(2, 0, "# box = 0:1 0:1\n# gamma = 1.6666666666666667\n");
            for (int i = 0; i < N; i++) {
                const bool inside = i == 0 ? first : i % 4 == 0;
                double at[2];
                do
                    for (int d = 0; d < 2; d++) at[d] = draw(0.01, 0.99);
                while ((fabs(at[0] - 0.5) < 0.24 && fabs(at[1] - 0.5) < 0.24) != inside ||
                       (!inside && fabs(at[0] - 0.5) < 0.26 && fabs(at[1] - 0.5) < 0.26));
                for (int d = 0; d < 2; d++) gas.x[d][i] = at[d];
                dense += inside;
                gas.rho[i] = inside ? 4 : 1, gas.u[i] = 1.5 * 2.5 / gas.rho[i];
                gas.m[i] = inside ? factor : 1;
            }
            for (int i = 0; i < N; i++) gas.m[i] *= whole / (N + (factor - 1) * dense);
            for (int i = 0; i < N && k == 3; i++) gas.m[i] *= i % 5 < 3 ? 1.5 : 1;
            struct judged judged = judges(&request);
            if (k == 0) whole = judged.start.mass;
            if (judged.of_start.wrong != (k == 2 ? (size_t)dense : k == 3 ? N * 3 / 5 : 0))
                fail_msg("%d, %d: %s", first, k, judged.of_start.message);
            if (k == 3)
                assert_non_null(strstr(judged.of_start.message, "it is 1.5 times the case's"));
            if (k == 2)
                assert_non_null(strstr(judged.of_start.message, "it is 1.151 times the case's"));
            judge_free(&judged);
        }
}

/* ---- far from the solution ---- */

/* A box may lack, or have in excess, 3 % of the case's mass, or one row of particles if that is
 * more. */
TEST(mass_of_the_box)
{
    for (int dim = 1; dim <= 3; dim++)
        for (int k = 0; k < 4; k++) {
            const struct judge_request request = uniform_gas();
            const double most = dim == 1 ? 0.03 : pow(N, -1. / dim), part = k % 2 ? 0.98 : 1.02;
            plant(dim, 0, boxes[dim]);
            for (int i = 0; i < N; i++) gas.m[i] = 2. / N * (1 + (k < 2 ? part : -part) * most);
            struct judged judged = judges(&request);
            assert_true(judged.foreign == (part > 1));
            assert_true(judged.foreign == !!strstr(judged.verdict, "its mass is"));
            judge_free(&judged);
        }
}

/* For uniform gas the limit is 0.2 of half the mean value, and for velocities of the sound speed.
 * (With 0.2 of the median as limit, our own gas at rest, whose pressure has 2 % of noise, would be
 * far.) */
TEST(limits_for_uniform_gas)
{
    static const struct {
        double rho, v, u;
        enum field field;
        double wrong; /* in units of the limit */
    } rows[] = {{0.0975, 0, 0, FIELD_DENSITY, 0.975},
                {0.1025, 0, 0, FIELD_DENSITY, 1.025},
                {0, 0.19, 0, FIELD_VELOCITY, 0.95},
                {0, 0.21, 0, FIELD_VELOCITY, 1.05},
                {0, 0, 0.0975, FIELD_INTERNAL_ENERGY, 0.975},
                {0, 0, -0.1025, FIELD_INTERNAL_ENERGY, 1.025}};
    for (int dim = 1; dim <= 3; dim++)
        for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
            struct judge_request request = uniform_gas();
            request.left = request.right = "2 0 1";
            plant(dim, 0, boxes[dim]);
            for (int i = 0; i < N; i++) {
                gas.m[i] = 4. / N;
                gas.rho[i] = 2 * (1 + rows[k].rho);
                gas.u[i] = 1.25 * (1 + rows[k].u) / (1 + rows[k].rho);
                gas.v[dim - 1][i] = rows[k].v * sqrt(0.7);
            }
            struct judged judged = judges(&request);
            near_relative(judged.wrong / 0.06, rows[k].wrong, 1e-6);
            assert_true(judged.foreign == (rows[k].wrong > 1));
            if (rows[k].rho > 0 || rows[k].v > 0)
                assert_int_equal(judged.wrong_field, rows[k].field);
            assert_true(!judged.foreign == !strstr(judged.verdict, "far from the solution"));
            judge_free(&judged);
        }
}

/* Gas ahead of all waves that moves by more than a tenth of the range of velocities: 3 % of the
 * window's particles may do so. */
TEST(gas_ahead_of_the_waves)
{
    for (int k = 0; k < 3; k++) {
        const struct judge_request request = {
            .case_name = "sod", .time = {true, 0.05}, .kernel = -1};
        const int moving = k == 0 ? 3 : 4;
        int inside = 0, moved = 0;
        double most = 0;
        plant(1, 0, "# box = 2\n");
        for (int i = 0; i < N; i++) gas.x[0][i] = 2 * (i + 0.5) / N;
        struct judged judged = judges(&request);
        const struct prepared problem = judged.run.problem;
        judge_free(&judged);
        for (int twice = 0; twice < 2; twice++)
            for (int i = 0; i < N; i++) {
                struct problem_state s;
                problem_sample(&problem, (double[3]){gas.x[0][i]}, 0.05, &s);
                gas.rho[i] = s.rho, gas.v[0][i] = s.v[0], gas.u[i] = s.u;
                gas.m[i] = s.rho * 2 / N;
                if (fabs(gas.x[0][i] - 1) > 0.5) continue;
                if (!twice) inside++, most = fmax(most, s.v[0]);
                if (twice && gas.x[0][i] > 1.3 && moved++ < moving)
                    gas.v[0][i] = (k == 2 ? 0.099 : 0.101) * most;
            }
        judged = judges(&request);
        near_relative(judged.wrong / 0.06,
                      k == 2 ? moving * 0.099 / inside / 0.2 : moving / (double)inside / 0.03,
                      1e-2);
        assert_true(judged.far == (k == 1));
        judge_free(&judged);
    }
}

/* Sod's tube, exact except for the same error everywhere: the median is that error. */
TEST(limits_for_a_tube)
{
    for (int field = 0; field < FIELDS; field++)
        for (int far = 0; far < 2; far++) {
            struct judge_request request = {.case_name = "sod", .time = {true, 0.2}, .kernel = -1};
            double range[2] = {INFINITY, -INFINITY};
            plant(1, 0, "# box = 2\n");
            for (int i = 2; i < N; i++) gas.x[0][i] = 2 * (i + 0.5) / N;
            gas.has_P = true;
            struct judged judged = judges(&request);
            const struct prepared problem = judged.run.problem;
            judge_free(&judged);
            for (int twice = 0; twice < 2; twice++) { /* the first pass finds the range */
                const double error = twice ? (range[1] - range[0]) * (far ? 0.062 : 0.058) : 0;
                for (int i = 0; i < N; i++) {
                    struct problem_state s;
                    problem_sample(&problem, (double[3]){gas.x[0][i]}, 0.2, &s);
                    gas.rho[i] = s.rho, gas.v[0][i] = s.v[0], gas.u[i] = s.u, gas.P[i] = s.P;
                    if (fabs(gas.x[0][i] - 1) <= 0.5) {
                        const double value = problem_field(&s, (enum field)field);
                        range[0] = fmin(range[0], value), range[1] = fmax(range[1], value);
                    }
                    double *of[] = {gas.rho, gas.v[0], gas.P, gas.u};
                    of[field][i] += i % 3 ? error : -0.9 * error;
                    if (i % 3 == 0 && i % 2) of[field][i] += 1.9 * error;
                    if (field == FIELD_PRESSURE) gas.P[3] *= 1 + 1e-9; /* as stored */
                }
            }
            judged = judges(&request);
            near_relative(judged.wrong / 0.06, far ? 0.062 / 0.06 : 0.058 / 0.06, 2e-3);
            assert_true(judged.far == far);
            assert_int_equal(judged.wrong_field, field);
            judge_free(&judged);
        }
}

/* A growing mode is judged by its amplitude, which may be off by half, or by its shape if that is
 * off by more than ten times the mode. */
TEST(limits_for_modes)
{
    static const struct {
        double amplitude, rough; /* of the mode; of rows that move up and down in turn, over it */
    } rows[] = {{1.49, 0}, {1.51, 0}, {0.51, 0}, {0.49, 0}, {1, 9}, {1, 11}, {1.7, 11}, {9, 2}};
    const struct run run = keyed_run("kelvin_helmholtz_mode", "");
    const double k = 2 * M_PI * settings_real(&run.settings, SETTING_waves);
    for (size_t row = 0; row < sizeof rows / sizeof *rows; row++) {
        const struct judge_request request = {.kernel = -1};
        double squares = 0;
        plant(2, 0, "# case = kelvin_helmholtz_mode\n# time = 0.8\n# box = 0:1 0:1\n");
        for (int i = 0; i < N; i++) {
            struct problem_state s;
            const double x[3] = {(i % 12 + 0.5) / 12, (i / 12 + 0.5) / 20};
            problem_sample(&run.problem, x, 0.8, &s);
            for (int d = 0; d < 2; d++) gas.x[d][i] = x[d], gas.v[d][i] = s.v[d];
            gas.rho[i] = gas.m[i] = s.rho, gas.u[i] = s.u, gas.m[i] /= N;
            squares += 2 * s.v[1] * s.v[1] / N;
        }
        for (int i = 0; i < N; i++)
            gas.v[1][i] = rows[row].amplitude *
                          (gas.v[1][i] + rows[row].rough * sqrt(squares) * (i / 12 % 2 ? 1 : -1) *
                                             sin(k * gas.x[0][i]));
        struct judged judged = judges(&request);
        const struct run_result *r = &judged.result;
        const struct run_functional *amplitude = &r->functionals[0], *shape = &r->functionals[1];
        assert_string_equal(shape->name, "mode_error");
        const double off = fabs(amplitude->value / amplitude->exact - 1) / 0.5;
        const bool by_shape = shape->value / 10 > fmax(1, off);
        near_relative(judged.wrong, 0.06 * (by_shape ? shape->value / 10 : off), 1e-12);
        assert_true(judged.far == (judged.wrong > 0.06));
        assert_true(by_shape == !!strstr(judged.verdict, "mode_error = "));
        for (size_t f = 0; f < r->functional_count; f++)
            if (strcmp(r->functionals[f].name, "growth_rate") == 0)
                near_relative(r->functionals[f].value,
                              r->functionals[f].exact +
                                  log(amplitude->value / amplitude->exact) / 0.8,
                              1e-12);
        judge_free(&judged);
    }
}

/* A median needs eight particles of the window that the flow has changed; the mean error counts a
 * third of it. */
TEST(fewest_particles_of_a_median)
{
    for (int k = 0; k < 4; k++) {
        const int few = k < 2 ? 7 : 8;
        const double error = k % 2 ? 0.03 : 0;
        struct judge_request request = {.case_name = "sod", .time = {true, 0.1}, .kernel = -1};
        const struct run run = keyed_run("sod", "");
        double least = INFINITY, most = 0;
        plant(1, -1, "# box = -1:1\n# boundary = periodic\n");
        gas.has_P = true;
        for (int i = 0; i < N; i++) {
            struct problem_state s;
            /* in the rarefaction; the others lie beyond the window */
            gas.x[0][i] = i < few ? -0.1 + 0.08 * (i + 0.5) / few : -0.9 + 0.3 * i / N;
            problem_sample(&run.problem, (double[3]){gas.x[0][i]}, 0.1, &s);
            gas.rho[i] = s.rho + (i < few ? error : 0), gas.v[0][i] = s.v[0];
            gas.P[i] = s.P, gas.u[i] = s.u, gas.m[i] = 1e-6 * gas.rho[i];
            if (i < few) least = fmin(least, s.rho), most = fmax(most, s.rho);
        }
        struct judged judged = judges(&request);
        const double range = fmax(most - least, 0.2 * most);
        if (error > 0)
            near_relative(judged.wrong, (few < 8 ? 0.3 : 1) * error / range, 1e-6);
        else
            near_absolute(judged.wrong, 0, 1e-12);
        judge_free(&judged);
    }
}

/* A field that varies by more than rounding has at least a fifth of its value as range, a uniform
 * one half of it. */
TEST(fields_that_hardly_vary)
{
    static const double amplitudes[] = {1e-7, 1e-11};
    for (int k = 0; k < 2; k++) {
        struct judge_request request = {.kernel = -1};
        char keys[40];
        snprintf(keys, sizeof keys, "amplitude=%g", amplitudes[k]);
        const struct run run = keyed_run("sound_wave", keys);
        plant(1, 0, "");
        snprintf(gas.head, sizeof gas.head,
                 "# case = sound_wave\n# keys = %s\n# time = 0.1\n# box = 1\n", keys);
        gas.has_P = true;
        for (int i = 0; i < N; i++) {
            struct problem_state s;
            gas.x[0][i] = (i + 0.5) / N;
            problem_sample(&run.problem, (double[3]){gas.x[0][i]}, 0.1, &s);
            gas.rho[i] = s.rho * 1.05, gas.v[0][i] = s.v[0], gas.P[i] = s.P, gas.u[i] = s.u;
            gas.m[i] = s.rho / N;
        }
        struct judged judged = judges(&request);
        assert_int_equal(judged.wrong_field, FIELD_DENSITY);
        near_relative(judged.wrong, 0.05 / (k ? 0.5 : 0.2), 1e-6);
        judge_free(&judged);
    }
}
