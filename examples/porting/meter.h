/* SPDX-License-Identifier: MIT
 *
 * meter: the parts that all porting examples share: the servant, and a call to the ground station.
 */
#ifndef METER_H
#define METER_H

#include "Meter.h"
#include "Station.h"

/* Creates an adapter with these endpoints, and adds the servant "meter" to the adapter. `kernel` is
 * the string that the operation Meter.kernel returns; the pointer must stay valid. */
Ice_Status Meter_serve(Ice_CommunicatorPtr ic, const char* endpoints, const char* kernel);

/* Calls Station.report of the ground station, with the name of the kernel and the number of calls
 * of Meter.add so far. */
Ice_Status Meter_report(Ice_CommunicatorPtr ic, const char* station);

#endif
