/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gadget_binary.h"

GADGET_BINARY(gadget_binary_2, "2", true);
