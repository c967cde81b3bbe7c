/* SPDX-License-Identifier: GPL-3.0-or-later
 * VTK XML for TrixiParticles and ParaView; the field data contain gamma, box and boundary. */
#include "start_format.h"

extern const struct snapshot_writer writer_vtu;

const struct start_format start_vtu = {
    .member = {"vtu", "XML of VTK, for TrixiParticles and ParaView", ""},
    .writer = &writer_vtu,
    .gamma = "the equation of state of the driver",
    .box = "the periodic box of the driver",
    .boundary = "the driver",
    .t_end = "tspan of the driver",
};
