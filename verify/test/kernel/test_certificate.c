/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares certificates of kernels with known results: exact second moments, sign and size of the
 * Fourier transform (computed independently in exact rational arithmetic), class, and onset of
 * pairing (Dehnen & Aly 2012, and relaxation runs). */
#include "test.h"

#include "certificate.h"

struct known {
    const char *name;
    int dim, class;
    double second;          /* sigma^2/h^2 */
    double first[2], least; /* interval of the first negative kappa, least value; 0: none */
    double pairs[2];        /* onset of pairing in neighbours; 0: none, -1: not measured */
};

static const struct known list[] = {
    {"quadratic_spline", 1, 1, 1. / 9, {9.42, 9.43}, -1.0e-2, {-1, -1}},
    {"cubic_spline", 1, 2, 1. / 12, {0, 0}, 0, {-1, -1}},
    {"cubic_spline", 2, 2, 31. / 392, {11.25, 11.5}, -6.405e-4, {18, 22}},
    {"cubic_spline", 3, 2, 3. / 40, {12.5, 12.75}, -5.991e-4, {50, 65}},
    {"quartic_spline", 1, 3, 1. / 15, {15.5, 15.75}, -4.837e-4, {-1, -1}},
    {"quartic_spline", 2, 3, 9759. / 152600, {20.75, 21}, -1.895e-4, {-1, -1}},
    {"quartic_spline", 3, 3, 23. / 375, {22.25, 22.5}, -7.856e-5, {60, 70}},
    {"quintic_spline", 1, 4, 1. / 18, {0, 0}, 0, {-1, -1}},
    {"quintic_spline", 2, 4, 2771. / 51624, {16.5, 16.75}, -2.494e-5, {45, 64}},
    {"quintic_spline", 3, 4, 7. / 135, {18.75, 19}, -2.149e-5, {185, 215}},
    {"wendland_c2", 1, 2, 2. / 21, {0, 0}, 0, {0, 0}},
    {"wendland_c2", 2, 2, 5. / 72, {0, 0}, 0, {0, 0}},
    {"wendland_c2", 3, 2, 1. / 15, {0, 0}, 0, {0, 0}},
    {"wendland_c4", 1, 4, 1. / 15, {0, 0}, 0, {0, 0}},
    {"wendland_c4", 2, 4, 7. / 132, {0, 0}, 0, {0, 0}},
    {"wendland_c4", 3, 4, 2. / 39, {0, 0}, 0, {0, 0}},
    {"wendland_c6", 1, 6, 2. / 39, {0, 0}, 0, {0, 0}},
    {"wendland_c6", 2, 6, 3. / 70, {0, 0}, 0, {0, 0}},
    {"wendland_c6", 3, 6, 1. / 24, {0, 0}, 0, {0, 0}},
    {"sinc", 1, 4, 0.053806, {14.5, 15.5}, -7e-5, {-1, -1}},
};

TEST(known_figures)
{
    for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
        const struct known *known = &list[i];
        struct kernel kernel;
        struct certificate certificate;
        assert_int_equal(kernel_select(&kernel, known->name, 5, NULL), STATUS_OK);
        assert_int_equal(certificate_measure(&certificate, &kernel, known->dim, NULL, NULL),
                         STATUS_OK);
        print_message("%s, dim %d\n", known->name, known->dim);
        assert_int_equal(certificate.failed, 0);
        assert_int_equal(certificate.class.class, known->class);
        near_relative(certificate.moments.second, known->second, kernel.order ? 1e-4 : 1e-14);
        if (known->first[0] > 0) {
            near_inside(certificate.fourier.first_negative, known->first[0], known->first[1]);
            near_relative(certificate.fourier.least, known->least, 0.12);
        } else {
            assert_true(isnan(certificate.fourier.first_negative));
            assert_true(certificate.fourier.least > -1e-13);
        }
        if (known->pairs[0] > 0)
            near_inside(certificate.pairing, known->pairs[0], known->pairs[1]);
        else if (known->pairs[0] == 0)
            assert_true(isnan(certificate.pairing));
        certificate_free(&certificate);
    }
}
