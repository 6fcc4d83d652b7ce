/* SPDX-License-Identifier: MIT
 *
 * firmware_slots: the board's part in updates: slots of the processor's and of the FPGA's flash.
 */
#include "firmware_slots.h"
#include "boot.h"
#include "fpga.h"
#include "loader.h"
#include "stm32f2.h"
#include "uav_backup.h"
#include "uav_update.h"

static void restart(void) {
    SCB_AIRCR = SCB_AIRCR_RESET;
}

void Firmware_useSlots(void) {
    UAV_Update *firmware = &uav_update[UAV_FIRMWARE], *bitstream = &uav_update[UAV_BITSTREAM];
    firmware->slots = Loader_slots(&firmware->running);
    firmware->product = LOADER_PRODUCT;
    bitstream->product = FPGA_PRODUCT;
    if (firmware->slots)
        bitstream->slots =
            Fpga_slots(firmware->slots, Boot_loadsFpga(), !UAV_isFlying(), &bitstream->running);
    uav_restart = restart;
}
