/* SPDX-License-Identifier: MIT
 *
 * uav_keyring: the servant with which a ground station changes its key over the air.
 */
#pragma once

#include "icec.h"

/* Adds the servant "keys"; does nothing in firmware that is built without keys. */
void UAV_startKeyRing(Ice_ObjectAdapterPtr adapter);
