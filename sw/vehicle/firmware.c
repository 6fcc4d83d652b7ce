/* SPDX-License-Identifier: MIT
 *
 * firmware: starts the kernel with the application and the watchdog task. This task has the lowest
 * priority. It therefore refreshes the watchdog only if no other task and no interrupt occupies the
 * processor permanently.
 */
#include "board.h"
#include "boot.h"
#include "firmware_slots.h"
#include "map_regs.h"
#include "program.h"
#include "provision.h"
#include "secrets.h"
#include "system_regs.h"
#include "uav.h"
#include "ucos_ii.h"

#define PRIO_WATCH 60U

#define WATCH_WORDS 128U

static OS_STK watchStack[WATCH_WORDS];

static void watchTask(void* argument) {
    (void)argument;
    for (;;) {
        Board_serveWatchdog();
        OSTimeDly(OS_TICKS_PER_SEC / 10U);
    }
}

void Program_onFpgaInterrupt(void) {
    UAV_irqHandler();
}

void Program_run(void) {
    UAV_Status status;
    OSInit();
    Secrets_start();
    UAV_useBoard(&secrets_board, 0);
    Firmware_useSlots();
    uav_wire = (U8)Board_isWired();
    Provision_listen();
    status = UAV_start(&board_fsmc, 0);
    if (status != UAV_NO_FPGA)
        FSMC_write(MAP_SLOT_SYSTEM, SYSTEM_SCRATCH, Boot_report());
    if (status == UAV_OK) {
        (void)OSTaskCreateExt(watchTask, 0, &watchStack[WATCH_WORDS - 1], PRIO_WATCH, 0, watchStack,
                              WATCH_WORDS, 0, OS_TASK_OPT_STK_CHK | OS_TASK_OPT_STK_CLR);
    } else {
        /* The watchdog is not refreshed here. It therefore resets the chip after a second, and the
         * chip tries again. */
        Boot_note(status == UAV_NO_KEY ? BOOT_NO_KEY : BOOT_NO_FPGA);
    }
    /* Interrupt routines call the kernel, so interrupts stay masked until the first task runs. */
    __asm__ volatile("cpsid i");
    Board_startInterrupts();
    OSStart();
}
