/* SPDX-License-Identifier: MIT
 *
 * cases_rules: cases about things that the architecture forbids or restricts: exclusive accesses,
 * alignment, memory that must not be executed, bits that do not exist, and features that the model
 * does not have.
 */
#include "cpu_cases.h"

#define SCB_SCR REG(0xE000ED10UL)

static U32 word[128] __attribute__((aligned(512)));

void Case_exclusive(void) {
    U32 old, failed;
    Case_priority(0, 0x80);
#define TRY(between)                                                   \
    __asm__ volatile("ldrex %0, [%2]\n\t" between "strex %1, %0, [%2]" \
                     : "=&r"(old), "=&r"(failed)                       \
                     : "r"(word)                                       \
                     : "r3", "r4", "memory")
    TRY("");
    value[0] = failed;
    TRY("mov r3, #1\n\tldr r4, =0xE000E200\n\tstr r3, [r4]\n\tdsb\n\tisb\n\t");
    value[1] = failed;
    TRY("clrex\n\t");
    value[2] = failed;
}

static U32 faults;
static void noteAndSkip(void) {
    const U16 first = *(U16*)Case_frame[6];
    value[faults++] = SCB_CFSR;
    SCB_CFSR = 0xFFFFFFFFUL;
    Case_frame[6] += first >> 11 >= 0x1DU ? 4U : 2U;
}

void Case_unaligned(void) {
    const U32 at = (U32)word + 2U;
    SCB_SHCSR = SCB_SHCSR_FAULTS;
    Case_action[6] = noteAndSkip;
    __asm__ volatile("ldrd r0, r1, [%0]\n\t"
                     "strd r0, r1, [%0, #8]\n\t"
                     "mov r2, %0\n\tldmia r2, {r0, r1}\n\t"
                     "mov r2, %0\n\tstmia r2!, {r0, r1}\n\t"
                     "ldmdb.w %0, {r0, r1}\n\t"
                     "ldrex r0, [%0]\n\t"
                     "ldrexh r0, [%0]\n\tldr r0, [%0]\n\tldrh r0, [%0]" /* these accesses may be
                                                                         * unaligned */
                     :
                     : "r"(at)
                     : "r0", "r1", "r2", "memory");
    Case_say('.');
}

static void toCaller(void) {
    value[faults++] = SCB_CFSR;
    SCB_CFSR = 0xFFFFFFFFUL;
    Case_frame[6] = Case_frame[5] & ~1UL;
}

static void call(U32 at) {
    ((Action)(at | 1UL))();
}

#define BX_LR_TWICE 0x47704770UL

void Case_executeNever(void) {
    SCB_SHCSR = SCB_SHCSR_FAULTS;
    Case_action[4] = toCaller;
    word[0] = word[8] = word[16] = word[64] = BX_LR_TWICE;
    MPU_RBAR = (U32)word | 0x10UL;
    MPU_RASR = 1UL << 28 | 3UL << 24 | 4UL << 1 | 1UL; /* region of 32 bytes, execute never */
    MPU_CTRL = MPU_CTRL_ON;
    call((U32)word);
    call((U32)&word[8]);
    Case_say('1');
    MPU_RBAR = (U32)word | 0x11UL;
    MPU_RASR = 3UL << 24 | 8UL << 1 | 1UL; /* a region with a higher number, which has priority */
    call((U32)word);
    Case_say('2');
    /* region of 512 bytes, without the subregion of bytes 64..127 */
    MPU_RASR = 1UL << 28 | 2UL << 8 | 3UL << 24 | 8UL << 1 | 1UL;
    call((U32)&word[64]);
    call((U32)&word[16]);
    MPU_CTRL = 0;
    call(0x40000000UL); /* device memory can never be executed */
    Case_say('.');
}

void Case_basepriBits(void) {
#define BASEPRI(reg, given, n)                                 \
    __asm__ volatile("msr " reg ", %0" : : "r"((U32)(given))); \
    __asm__ volatile("mrs %0, basepri" : "=r"(value[n]))
    BASEPRI("basepri", 0x05, 0);
    BASEPRI("basepri", 0x57, 1);
    BASEPRI("basepri_max", 0x80, 2);
    BASEPRI("basepri_max", 0x05, 3);
    BASEPRI("basepri_max", 0x3F, 4);
    BASEPRI("basepri", 0, 5);
}

void Case_cycleCounter(void) {
    U32 start = DWT_CYCCNT;
    value[0] = DWT_CTRL;
    DWT_CTRL = 1; /* the write is ignored, because TRCENA is not set */
    __asm__ volatile("nop\n\tnop");
    value[1] = DWT_CYCCNT - start;
    DEMCR = 1UL << 24;
    value[2] = DWT_CYCCNT - start;
    DWT_CTRL = 1;
    DWT_CYCCNT = 100;
    value[3] = DWT_CYCCNT >= 100UL && DWT_CYCCNT < 120UL;
    value[4] = DWT_CTRL;
    DWT_CTRL = 0;
    start = DWT_CYCCNT;
    value[5] = DWT_CYCCNT - start;
}

void Case_tickRules(void) {
    SYST_RVR = 0;
    SYST_CVR = 0;
    SYST_CSR = 7; /* the counter stays at zero without a reload value */
    __asm__ volatile("nop\n\tnop\n\tnop");
    SYST_RVR = 999;
    value[0] = SYST_CVR > 900UL;
    SYST_CSR = 1; /* the eighth */
    value[1] = SYST_CVR > 900UL;
    SYST_CVR = 5;
    value[2] = SYST_CVR; /* after any write the counter is zero, until the next tick */
    SYST_CSR = 0;
    value[3] = SYST_CVR;
    SYST_CALIB = 1; /* the write is ignored, because the register is read-only */
    Case_say('.');
}

static void masked(void) {
    __asm__ volatile("cpsid i");
    NVIC_ISPR0 = 2;
    value[0] = SCB_ICSR & 0x1FFUL;
    value[1] = SCB_ICSR >> 22 & 1UL;
    value[2] = SCB_ICSR >> 12 & 0x1FFUL;
    __asm__ volatile("msr basepri, %0" : : "r"(0x40));
    /* 0, because BASEPRI masks the interrupt; PRIMASK would have no effect here */
    value[3] = SCB_ICSR >> 12 & 0x1FFUL;
    __asm__ volatile("msr basepri, %0" : : "r"(0));
    NVIC_ICPR(0) = 2;
    __asm__ volatile("cpsie i");
}

void Case_interruptState(void) {
    Case_priority(0, 0x80);
    Case_priority(1, 0x60);
    Case_action[16] = masked;
    Case_pend(0);
}

void Case_bitBand(void) {
    volatile U32* alias = (volatile U32*)(0x22000000UL + ((U32)word - 0x20000000UL) * 32UL);
    volatile U32* bits = word;
    bits[1] = 0x80;
    alias[3] = 1;
    value[0] = bits[0];
    value[1] = alias[3];
    value[2] = alias[32 + 7];
    alias[32 + 7] = 2; /* only bit 0 of the written value counts */
    value[3] = bits[1];
}

static void setThumb(void) {
    value[0] = SCB_CFSR;
    SCB_CFSR = 0xFFFFFFFFUL;
    Case_frame[6] = Case_frame[5] & ~1UL;
    Case_frame[7] |= 1UL << 24;
}
static void dropThumb(void) {
    Case_frame[7] &= ~(1UL << 24);
}

void Case_stackedState(void) { /* Returns from an exception to ARM state, which is an error. */
    SCB_SHCSR = SCB_SHCSR_FAULTS;
    Case_action[16] = dropThumb;
    Case_action[6] = setThumb;
    Case_priority(0, 0x80);
    __asm__ volatile("ldr r0, =0xE000E200\n\tmovs r1, #1\n\tadr r2, 1f\n\tmov lr, r2\n\t"
                     "str r1, [r0]\n\tdsb\n\tisb\n\tnop\n\t.align 2\n1:\n\tnop" ::
                         : "r0", "r1", "r2", "lr", "memory");
    Case_say('.');
}

static void setFaultmask(void) {
    __asm__ volatile("cpsid f\n\tmrs %0, faultmask\n\tmsr faultmask, %2\n\tmrs %1, faultmask"
                     : "=&r"(value[0]), "=&r"(value[1])
                     : "r"(1));
}

/* FAULTMASK is written in the handler of an NMI, where it must have no effect */
void Case_faultmaskIgnored(void) {
    Case_action[2] = setFaultmask;
    Case_priority(0, 0x80);
    SCB_ICSR = 1UL << 31;
    __asm__ volatile("dsb\n\tisb\n\tmrs %0, faultmask" : "=r"(value[2]));
    Case_pend(0);
    __asm__ volatile("cpsid f\n\tmrs %0, faultmask\n\tmsr faultmask, %1"
                     : "=&r"(value[3])
                     : "r"(0));
}

void Case_regionBits(void) { /* reserved bits of the MPU's registers are zero */
    MPU_RBAR = 0x20000015UL; /* VALID, region 5 */
    MPU_RASR = 0xFFFFFFFEUL;
    value[0] = MPU_RASR;
    value[1] = MPU_RBAR;
}

/* Uses features that the model does not have. */
void Case_byteOfRegister(void) {
    value[0] = *(volatile U8*)0xE000E010UL;
    Case_say('!');
}
void Case_unprivilegedLoad(void) {
    __asm__ volatile("ldrt r0, [%0]" : : "r"(word) : "r0");
    Case_say('!');
}
void Case_unprivilegedStore(void) {
    __asm__ volatile("strbt r0, [%0, #4]" : : "r"(word) : "memory");
    Case_say('!');
}
void Case_unprivileged(void) {
    __asm__ volatile("msr control, %0\n\tisb" : : "r"(1));
    Case_say('!');
}
void Case_sleepOnExit(void) {
    SCB_SCR = 2;
    Case_say('!');
}
void Case_waitForEvent(void) {
    __asm__ volatile("wfe");
    Case_say('!');
}
void Case_unknownRegister(void) {
    value[0] = REG(0xE000EDF0UL);
    Case_say('!');
}
void Case_noBackground(void) {
    MPU_CTRL = 1;
    Case_say('!');
}
void Case_alignmentTrap(void) {
    REG(0xE000ED14UL) = 8;
    Case_say('!');
}
