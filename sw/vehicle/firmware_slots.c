/* SPDX-License-Identifier: MIT
 *
 * firmware_slots: finds the slots for firmware in the processor's flash, and the slots for
 * bitstreams in the FPGA's flash.
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
