/* SPDX-License-Identifier: MIT
 *
 * uav_os: locks, waits and signals of the operating system, for IceC and its endpoint.
 */
#pragma once

#include "xbee_endpoint.h"

extern const XBeeATEndpoint_Port uav_endpointPort;
void UAV_initEndpointOs(void);

extern const Ice_Os uav_iceOs;
void UAV_initIceOs(void);
