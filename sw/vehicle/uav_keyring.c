/* SPDX-License-Identifier: MIT
 *
 * uav_keyring: the servant with which a ground station changes its key over the air.
 */
#include "uav_keyring.h"
#include "Autopilot.h"
#include "uav_keys.h"
#include "uav_links.h"

static Autopilot_KeyRing keys;

Ice_Status Autopilot_KeyRing_setNextKey(Autopilot_KeyRingPtr self, const Autopilot_ByteSeq* key,
                                        Ice_Bool* result,
                                        Autopilot_KeyRing_setNextKey_Exception* ex,
                                        const Ice_Current* current) {
    (void)self;
    if (UAV_isFlying()) {
        ex->type = Autopilot_KeyRing_setNextKey_InFlight;
        return ICE_USER_EXCEPTION;
    }
    *result = key->size == (Ice_Int)LINK_KEY_BYTES && UAV_nextKey(UAV_peerOf(current), key->data);
    return ICE_OK;
}

Ice_Status Autopilot_KeyRing_count(Autopilot_KeyRingPtr self, Ice_Int* result,
                                   const Ice_Current* current) {
    (void)self;
    *result = UAV_countKeys(UAV_peerOf(current));
    return ICE_OK;
}

void UAV_startKeyRing(Ice_ObjectAdapterPtr adapter) {
    Autopilot_KeyRing_init(&keys);
    (void)Ice_ObjectAdapter_add(adapter, (Ice_ObjectPtr)&keys, "keys");
}
