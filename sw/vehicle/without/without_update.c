/* SPDX-License-Identifier: MIT
 *
 * without_update: functions for a vehicle without updates over the air (ICESOC_UPDATE=OFF).
 */
#include "uav_update.h"

void UAV_startUpdate(Ice_ObjectAdapterPtr adapter) {
    (void)adapter;
}
