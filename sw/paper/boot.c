/* SPDX-License-Identifier: MIT
 *
 * boot: starts a program that consists of one main task and the radio task.
 */
#include "paper.h"
#include "uav.h"
#include "uav_cores.h"
#include "uav_modem.h"
#include "uav_os.h"
#include "uav_tasks.h"
#include "ucos_ii.h"

#define STACK_WORDS 1024

static OS_STK stack[STACK_WORDS], radioStack[STACK_WORDS];
static U8 irqEnabled;

/* Does nothing: the servant of this program polls the core, so it needs no interrupt. */
void UAV_coresInterrupt(const U32 lines[2]) {
    (void)lines;
}

int PAPER_irqEnabled(void) {
    return irqEnabled;
}

void PAPER_useRadio(Ice_CommunicatorPtr ic) {
    Ice_Communicator_setOs(ic, &uav_iceOs, 0);
    UAV_useRadio(ic);
    (void)OSTaskCreate(UAV_radioTask, 0, &radioStack[STACK_WORDS - 1], PRIO_RADIO);
}

void PAPER_start(const FSMC_Port* port, void* context) {
    irqEnabled = 0;
    uav_transparent = 1;
    if (FSMC_init(port, context) != FSMC_OK)
        return;
    UAV_initRadio();
    UAV_initIceOs();
    irqEnabled = 1;
    (void)OSTaskCreate(appMainTask, 0, &stack[STACK_WORDS - 1], PRIO_SERVER);
}
