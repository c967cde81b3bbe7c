/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the layout of the records that passes over pairs read. The checks `clouds rates` and
 * `clouds hostile` compare the sums over pairs with the oracle. */
#include "test.h"

#include "draw.h"

#include "cells/pairs.h"

/* The fields of a record follow each other in the order of their names with the number of values in
 * `values`; the record's size is rounded up to whole groups. */
static void expect_layout(const struct lanes_layout *layout, const int values[RECORD_FIELDS])
{
    int used = 0;
    for (int field = 0; field < RECORD_FIELDS; field++) {
        assert_int_equal(layout->offset[field], values[field] ? used : 0);
        used += values[field];
    }
    assert_int_equal(layout->used, used);
    assert_int_equal(layout->size, (used + GATHER_GROUP - 1) / GATHER_GROUP * GATHER_GROUP);
}

/* Records hold the fields that their passes read, and no others. */
TEST(records_of_pairs)
{
    struct kernel kernel;
    assert_int_equal(kernel_select(&kernel, "cubic_spline", 5, NULL), STATUS_OK);
    for (int dim = 2; dim <= 3; dim++)
        for (int trial = 0; trial < 200; trial++) {
            struct cells_method method = {.box.dim = dim,
                                          .kernel = &kernel,
                                          .gradient = (enum gradient)(int)draw(0, GRADIENTS),
                                          .viscosity = (enum viscosity)(int)draw(0, VISCOSITIES),
                                          .formulation = draw(0, 1) < 0.5 ? FORMULATION_LAGRANGIAN
                                                                          : FORMULATION_VANILLA_ICE,
                                          .energy_element = draw(0, 1) < 0.5,
                                          .velocity_gradient = draw(0, 1) < 0.5,
                                          .balsara = draw(0, 1) < 0.5,
                                          .conductivity = draw(0, 1) < 0.5 ? 0.1 : 0,
                                          .threads = 1};
            const bool blended = method.gradient == GRADIENT_BLENDED,
                       lagrangian = method.formulation == FORMULATION_LAGRANGIAN,
                       projected = method.viscosity == VISCOSITY_PROJECTED,
                       sloped = projected || method.viscosity == VISCOSITY_RECONSTRUCTED,
                       jumps = method.viscosity == VISCOSITY_CULLEN_DEHNEN,
                       dissipates = method.viscosity != VISCOSITY_NONE || method.conductivity > 0;
            const int symmetric = dim == 2 ? 3 : 6;
            struct cells *cells = cells_create(&method, 8);
            assert_non_null(cells);
            expect_layout(&cells->density,
                          (int[RECORD_FIELDS]){[RECORD_POSITION] = dim,
                                               [RECORD_WEIGHT] = 1,
                                               [RECORD_ENERGY] = method.energy_element});
            expect_layout(
                &cells->matrix,
                (int[RECORD_FIELDS]){[RECORD_POSITION] = dim,
                                     [RECORD_WEIGHT] = 1,
                                     [RECORD_VELOCITY] = method.velocity_gradient ? dim : 0,
                                     [RECORD_H] = blended});
            expect_layout(
                &cells->force,
                (int[RECORD_FIELDS]){
                    [RECORD_POSITION] = dim,
                    [RECORD_WEIGHT] = dissipates || lagrangian,
                    [RECORD_VELOCITY] = dim,
                    [RECORD_H_INVERSE] = 1,
                    [RECORD_VOLUME] = 1,
                    [RECORD_PRESSURE] = 1,
                    [RECORD_SOUND] = 1,
                    [RECORD_DENSITY] = dissipates,
                    [RECORD_ALPHA] = jumps || method.viscosity == VISCOSITY_TIME_DEPENDENT,
                    [RECORD_BALSARA] = method.balsara,
                    [RECORD_HEAT] = method.conductivity > 0,
                    [RECORD_LAGRANGIAN] = lagrangian ? 3 : 0,
                    [RECORD_MATRIX] = method.gradient == GRADIENT_STANDARD ? 0 : symmetric,
                    [RECORD_STEEP] = blended,
                    [RECORD_SLOPE] = sloped ? dim * dim : 0,
                    [RECORD_PROJECTOR] = projected ? symmetric : 0});
            expect_layout(&cells->shift, jumps ? (int[RECORD_FIELDS]){[RECORD_POSITION] = dim,
                                                                      [RECORD_WEIGHT] = 1,
                                                                      [RECORD_VELOCITY] = dim,
                                                                      [RECORD_H_INVERSE] = 1,
                                                                      [RECORD_VOLUME] = 1,
                                                                      [RECORD_SOUND] = 1,
                                                                      [RECORD_ACCELERATION] = dim}
                                               : (int[RECORD_FIELDS]){0});
            assert_true(method.gradient != GRADIENT_CORRECTED ||
                        cells->matrix.geometry == LANES_DIRECTION);
            cells_destroy(cells);
        }
}
