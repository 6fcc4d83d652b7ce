/* SPDX-License-Identifier: MIT
 *
 * uav_os: locks, waits and signals for IceC and its endpoint, implemented with the operating
 * system.
 */
#pragma once

#include "xbee_endpoint.h"

extern const XBeeATEndpoint_Port uav_endpointPort;
void UAV_initEndpointOs(void);

extern const Ice_Os uav_iceOs;
void UAV_initIceOs(void);
