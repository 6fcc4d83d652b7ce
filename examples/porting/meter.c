/* SPDX-License-Identifier: MIT
 *
 * meter: the servant of the porting examples, and a call to the ground station. Neither depends on
 * the kernel or the transport.
 */
#include "meter.h"

static Ice_ObjectAdapter adapter;
static Demo_Meter meter;
static const char* kernelName;
static Ice_Int calls;

Ice_Status Demo_Meter_add(Demo_MeterPtr self, Ice_Int a, Ice_Int b, Ice_Int* result,
                          const Ice_Current* current) {
    (void)self;
    (void)current;
    ++calls;
    *result = a + b;
    return ICE_OK;
}

Ice_Status Demo_Meter_kernel(Demo_MeterPtr self, Ice_String* result, const Ice_Current* current) {
    (void)self;
    (void)current;
    *result = Ice_String_from(kernelName);
    return ICE_OK;
}

Ice_Status Meter_serve(Ice_CommunicatorPtr ic, const char* endpoints, const char* kernel) {
    Ice_Status status;
    kernelName = kernel;
    status = Ice_Communicator_createObjectAdapterWithEndpoints(ic, "Meters", endpoints, &adapter);
    if (status != ICE_OK)
        return status;
    Demo_Meter_init(&meter);
    status = Ice_ObjectAdapter_add(&adapter, (Ice_ObjectPtr)&meter, "meter");
    Ice_ObjectAdapter_activate(&adapter);
    return status;
}

Ice_Status Meter_report(Ice_CommunicatorPtr ic, const char* station) {
    Demo_StationPrx prx;
    Ice_Status status = Ice_Communicator_stringToProxy(ic, station, &prx);
    if (status != ICE_OK)
        return status;
    return Demo_StationPrx_report(&prx, Ice_String_from(kernelName), calls);
}
