/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "start_format.h"

GADGET_BINARY(gadget_binary_2, "2", true);
