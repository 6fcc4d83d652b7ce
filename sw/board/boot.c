/* SPDX-License-Identifier: MIT
 *
 * boot: determines why the firmware was started, checks the image's checksum, and records faults.
 */
#include "boot.h"
#include "board.h"
#include "fsmc.h"
#include "map_regs.h"
#include "stm32f2.h"
#include "system_regs.h"

#define MAGIC 0x1CE50C01UL

/* symbols that firmware.ld defines; the word at image_end is the checksum */
extern U32 image_begin[], image_end[];

Boot_Record boot_record __attribute__((section(".noinit")));
static Boot_Reason reason;
static U32 detail;

void Boot_begin(void) {
    U32 flags = RCC_CSR;
    if (flags & RCC_CSR_PORRST || boot_record.magic != MAGIC) {
        static const Boot_Record empty;
        boot_record = empty;
        boot_record.magic = MAGIC;
        reason = BOOT_POWER_ON;
    } else if (boot_record.reason) {
        reason = (Boot_Reason)boot_record.reason;
        detail = boot_record.task;
        boot_record.reason = 0;
    } else {
        reason = flags & RCC_CSR_IWDGRST ? BOOT_WATCHDOG : BOOT_SOFTWARE;
    }
    ++boot_record.starts;
    RCC_CSR |= RCC_CSR_RMVF;
}

int Boot_imageIsSound(void) {
    const U32* at;
    RCC_AHB1ENR |= RCC_AHB1ENR_CRC;
    CRC_CR = 1;
    for (at = image_begin; at < image_end; ++at)
        CRC_DR = *at;
    return CRC_DR == *image_end;
}

int Boot_loadsFpga(void) {
    return reason == BOOT_POWER_ON || reason == BOOT_NO_FPGA;
}

U32 Boot_report(void) {
    return BOOT_REPORT_MARK << 24 | (boot_record.starts & 0xFFU) << 16 | (U32)reason << 8 |
           (detail & 0xFFU);
}

void Boot_note(Boot_Reason why) {
    boot_record.reason = (U32)why;
    boot_record.task = Board_task();
}

void Boot_fail(Boot_Reason why, U32 pc, U32 lr, U32 address) {
    Boot_note(why);
    boot_record.pc = pc;
    boot_record.lr = lr;
    boot_record.address = address;
    boot_record.status = SCB_CFSR;
    __asm__ volatile("dsb"); /* the record must be in memory before the reset */
    SCB_AIRCR = SCB_AIRCR_RESET;
    for (;;)
        ;
}

void Boot_refuse(void) {
    reason = BOOT_IMAGE_CORRUPT;
    detail = 0;
    if (FSMC_init(&board_fsmc, 0) == FSMC_OK)
        FSMC_write(MAP_SLOT_SYSTEM, SYSTEM_SCRATCH, Boot_report());
    for (;;)
        __asm__ volatile("wfi");
}
