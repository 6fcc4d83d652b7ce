/* SPDX-License-Identifier: MIT
 *
 * meter: what the porting examples share: the servant, and the call to the ground.
 */
#ifndef METER_H
#define METER_H

#include "Meter.h"
#include "Station.h"

/* Creates the adapter of `endpoints` and adds the servant "meter" to it. `kernel` is the answer of
 * the operation of that name; it must stay valid. */
Ice_Status Meter_serve(Ice_CommunicatorPtr ic, const char* endpoints, const char* kernel);

/* Calls the ground's Station.report with the number of calls so far. */
Ice_Status Meter_report(Ice_CommunicatorPtr ic, const char* station);

#endif
