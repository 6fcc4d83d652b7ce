/* SPDX-License-Identifier: MIT
 *
 * cpu_cases: programs for the CPU model's tests. Each says what happens by letters: interrupt n enters as a
 * small letter and leaves as a large one ('a' is interrupt 0), other handlers have letters of their own.
 */
#include "stm32f2.h"

#define STIR REG(0xE000EF00UL)
#define NVIC_ISPR0 REG(0xE000E200UL)
#define DWT_CYCCNT REG(0xE0001004UL)
#define SCB_HFSR REG(0xE000ED2CUL)
#define SCB_CCR REG(0xE000ED14UL)
#define PENDSVSET (1UL << 28)

typedef void (*Vector)(void);
typedef void (*Action)(void);

extern void stack_top(void);
extern U32 data_begin[], data_end[], data_load[], bss_begin[], bss_end[];

void Reset_Handler(void);
void Handler(void);
void Handler_run(U32 *frame, U32 number, U32 excReturn);
void Case_stack(void);
void Case_work(void);
U32 Work_asm(U32 rounds);

volatile U32 selected __attribute__((section(".noinit"))); /* the case; written by the test */
volatile U32 boots __attribute__((section(".noinit")));
char said[128];
U32 value[8]; /* what a case found out */
static U32 at;
static Action action[16 + 4]; /* of exceptions, called by their handlers */
static U32 *frameNow;         /* the frame of the exception under way */

static void say(char c) {
    said[at++] = c;
}

void Handler_run(U32 *frame, U32 number, U32 excReturn) {
    static const char names[] = "..nhmuf....s..pt";
    char small = number < 16U ? names[number] : (char)('a' + number - 16U);
    say(small);
    frameNow = frame;
    value[7] = excReturn;
    if (action[number])
        action[number]();
    if (number >= 16U)
        say((char)(small - 32));
}

void __attribute__((naked)) Handler(void) {
    __asm__ volatile("tst lr, #4\n\t"
                     "ite eq\n\t"
                     "mrseq r0, msp\n\t"
                     "mrsne r0, psp\n\t"
                     "mrs r1, ipsr\n\t"
                     "mov r2, lr\n\t"
                     "push {r3, lr}\n\t"
                     "bl Handler_run\n\t"
                     "pop {r3, pc}");
}

static void priority(U32 irq, U32 value8) {
    NVIC_IPR(irq) = (U8)value8;
    NVIC_ISER(0) = 1UL << irq;
}

static void pend(U32 irq) {
    NVIC_ISPR0 = 1UL << irq;
    __asm__ volatile("dsb\n\tisb");
}

static void pend0(void) {
    pend(0);
}
static void pend1(void) {
    pend(1);
}
static void pend12(void) {
    pend(2);
    pend(1);
}
static void pendSwitch(void) {
    SCB_ICSR = PENDSVSET;
}

static void nesting(void) {
    priority(0, 0x80);
    priority(1, 0x40);
    action[16] = pend1;
    pend(0);
}

static void samePriority(void) {
    priority(0, 0x80);
    priority(1, 0x80);
    action[16] = pend1;
    pend(0);
}

static void lowestNumberFirst(void) {
    priority(0, 0x40);
    priority(1, 0x80);
    priority(2, 0x80);
    action[16] = pend12;
    pend(0);
}

static void subPriority(void) { /* PRIGROUP 6: bit 7 preempts, bits 6..4 only order */
    SCB_AIRCR = 0x05FA0000UL | 6UL << 8;
    priority(0, 0x70);
    priority(1, 0x50);
    priority(2, 0x40);
    action[16] = pend12;
    pend(0);
    SCB_AIRCR = 0x05FA0000UL;
}

static void primask(void) {
    priority(0, 0x80);
    __asm__ volatile("cpsid i");
    pend(0);
    say('1');
    /* The handler sees r0 as it was when interrupts were enabled: not one instruction later. */
    __asm__ volatile("mov r0, #5\n\tcpsie i\n\tmov r0, #6\n\tmov r0, #7" ::: "r0");
    say('2');
}

static void saveR0(void) {
    value[0] = frameNow[0];
}

static void primaskExact(void) {
    action[16] = saveR0;
    primask();
}

static void basepri(void) {
    priority(0, 0x80);
    priority(1, 0x40);
    __asm__ volatile("msr basepri, %0" : : "r"(0x50));
    pend(0);
    say('1');
    pend(1);
    say('2');
    __asm__ volatile("msr basepri, %0" : : "r"(0));
    say('3');
}

static void faultmask(void) {
    priority(0, 0x00);
    __asm__ volatile("cpsid f");
    pend(0);
    say('1');
    __asm__ volatile("cpsie f");
    say('2');
}

static void switchLast(void) {
    SCB_SHPR(14) = 0xF0;
    priority(0, 0x80);
    priority(1, 0xF0);
    action[16] = pendSwitch;
    action[17] = 0;
    pend(0);
    __asm__ volatile("isb");
}

static void svcNumber(void) {
    value[0] = ((U8 *)frameNow[6])[-2];
}

static void supervisorCall(void) {
    action[11] = svcNumber;
    __asm__ volatile("svc #42");
    say('.');
}

static U32 tickAt[4], ticks;
static void noteTick(void) {
    if (ticks < 4U)
        tickAt[ticks++] = DWT_CYCCNT;
}

static void systick(void) {
    action[15] = noteTick;
    SYST_RVR = 999;
    SYST_CVR = 0;
    SYST_CSR = 7;
    while (ticks < 4U)
        __asm__ volatile("wfi");
    SYST_CSR = 0;
    value[0] = tickAt[1] - tickAt[0];
    value[1] = tickAt[3] - tickAt[2];
}

static void sleepMasked(void) { /* WFI wakes, though PRIMASK keeps the interrupt from being taken */
    SYST_RVR = 99;
    SYST_CVR = 0;
    __asm__ volatile("cpsid i");
    SYST_CSR = 7;
    __asm__ volatile("wfi");
    say('w');
    SYST_CSR = 0;
    __asm__ volatile("cpsie i");
    say('.');
}

/* Goes on behind the instruction that failed. */
static void skip(void) {
    U16 first = *(U16 *)frameNow[6];
    value[0] = SCB_CFSR;
    value[1] = SCB_BFAR;
    value[2] = SCB_HFSR;
    value[3] = SCB_MMFAR;
    SCB_CFSR = 0xFFFFFFFFUL;
    frameNow[6] += first >> 11 >= 0x1DU ? 4U : 2U;
}

static void busFault(void) {
    SCB_SHCSR = SCB_SHCSR_FAULTS;
    action[5] = skip;
    value[4] = REG(0x60000010UL);
    say('.');
}

static void noMemory(void) {
    SCB_SHCSR = SCB_SHCSR_FAULTS;
    action[5] = skip;
    REG(0x10000000UL) = 1;
    say('.');
    *(volatile U32 *)selected = 1; /* selected is small: flash is not written like this */
    say('.');
}

static void escalation(void) {
    action[3] = skip;
    value[4] = REG(0x60000010UL);
    say('.');
}

static void undefinedInstruction(void) {
    SCB_SHCSR = SCB_SHCSR_FAULTS;
    action[6] = skip;
    __asm__ volatile("udf #7");
    say('.');
}

static void toLr(void) {
    value[0] = SCB_CFSR;
    frameNow[6] = frameNow[5] & ~1UL;
    frameNow[7] |= 1UL << 24;
}

static void armState(void) {
    SCB_SHCSR = SCB_SHCSR_FAULTS;
    action[6] = toLr;
    __asm__ volatile("ldr r0, =Reset_Handler\n\tbic r0, r0, #1\n\tblx r0" ::
                         : "r0", "lr", "r1", "r2", "r3", "r12");
    say('.');
}

static void failAgain(void) {
    value[4] = REG(0x60000010UL);
}

static void lockUp(void) {
    action[3] = failAgain;
    value[4] = REG(0x60000010UL);
}

static U32 guarded[32] __attribute__((aligned(64)));

static void guard(void) {
    SCB_SHCSR = SCB_SHCSR_FAULTS;
    action[4] = skip;
    MPU_RBAR = (U32)&guarded[8] | 0x10UL;
    MPU_RASR = 1UL << 28 | 5UL << 24 | 4UL << 1 | 1UL;
    MPU_CTRL = MPU_CTRL_ON;
    ((volatile U32 *)guarded)[7] = 1;
    say((char)('0' + ((volatile U32 *)guarded)[8]));
    ((volatile U32 *)guarded)[8] = 1;
    say('.');
    ((volatile U32 *)guarded)[16] = 1;
    MPU_CTRL = 0;
    say('.');
}

static void noteStacks(void) {
    U32 msp, psp;
    __asm__ volatile("mrs %0, msp\n\tmrs %1, psp" : "=r"(msp), "=r"(psp));
    value[0] = (U32)frameNow - psp;
    value[1] = msp != psp;
}

static U32 processStack[64];

static void process(void) {
    U32 control;
    priority(0, 0x80);
    priority(1, 0x40);
    action[16] = noteStacks;
    action[17] = 0;
    __asm__ volatile("msr psp, %1\n\tmov %0, #2\n\tmsr control, %0\n\tisb\n\t"
                     "ldr r0, =0xE000E200\n\tmovs r1, #1\n\tstr r1, [r0]\n\tdsb\n\tisb\n\t"
                     "mrs %0, control\n\tmovs r0, #0\n\tmsr control, r0\n\tisb"
                     : "=&r"(control)
                     : "r"(&processStack[63])
                     : "r0", "r1", "memory");
    value[2] = control;
    value[3] = value[7]; /* EXC_RETURN */
}

static void alignment(void) { /* a stack pointer that is a multiple of 4 only is put right, and back */
    U32 before, after;
    priority(0, 0x80);
    action[16] = noteStacks;
    __asm__ volatile(
        "sub sp, sp, #4\n\tmov %0, sp\n\tldr r0, =0xE000E200\n\tmovs r1, #1\n\tstr r1, [r0]\n\t"
        "dsb\n\tisb\n\tmov %1, sp\n\tadd sp, sp, #4"
        : "=&r"(before), "=&r"(after)
        :
        : "r0", "r1", "memory");
    value[2] = after - before;
    value[3] = (U32)frameNow & 7UL;
}

static void cycles(void) {
    U32 start;
#define MEASURE(n, code)                                               \
    start = DWT_CYCCNT;                                                \
    __asm__ volatile(code ::: "r0", "r1", "r2", "r3", "cc", "memory"); \
    value[n] = DWT_CYCCNT - start;
    MEASURE(0, "")
    MEASURE(1, "nop\n\tnop\n\tnop\n\tnop\n\tnop\n\tnop\n\tnop\n\tnop\n\tnop\n\tnop")
    MEASURE(2, "ldr r0, [sp]\n\tldr r0, [sp]")
    MEASURE(3, "push {r0-r3}\n\tpop {r0-r3}")
    MEASURE(4, "b 1f\n\tnop\n1:")
    MEASURE(5, "movs r0, #0\n\tcbz r0, 1f\n\tnop\n1:")
    MEASURE(6, "movs r0, #1\n\tcmp r0, #2\n\titte eq\n\tmoveq r0, #3\n\tmoveq r0, #4\n\tmovne r0, #5")
}

static void resetRequest(void) {
    if (boots++ == 0) {
        SCB_AIRCR = SCB_AIRCR_RESET;
        for (;;)
            say('!');
    }
    say('r');
}

/* Something with loops, IT blocks, multiple loads, calls and products: interrupted anywhere, it comes out
 * the same. */
static U32 mix(U32 a, U32 b) {
    return (a ^ b) * 2654435761UL + (a >> 7 | b << 25);
}

U32 Work_asm(U32 rounds) {
    U32 result = 0, i, words[8];
    for (i = 0; i < 8U; ++i)
        words[i] = i * 77U;
    for (i = 0; i < rounds; ++i) {
        __asm__ volatile(
            "ldm %1, {r0-r5}\n\tcmp r0, r1\n\tittee lo\n\taddlo r0, r0, r5\n\tsublo r2, r2, r1\n\t"
            "addhs r3, r3, r0\n\teorhs r4, r4, r2\n\tadcs r5, r5, r0\n\tstm %1, {r0-r5}\n\t"
            "it vs\n\tmvnvs %0, %0\n\tadds %0, %0, r4\n\tudiv r0, r5, r3\n\teor %0, %0, r0"
            : "+r"(result)
            : "r"(words)
            : "r0", "r1", "r2", "r3", "r4", "r5", "cc", "memory");
        result = mix(result, words[i & 7U]);
        words[6] += result % 13U;
    }
    return result;
}

void Case_work(void) {
    priority(0, 0x80);
    priority(1, 0x40);
    action[16] = 0;
    value[0] = Work_asm(6);
}

static const Action cases[] = {nesting,      samePriority, lowestNumberFirst,
                               subPriority,  primaskExact, basepri,
                               faultmask,    switchLast,   supervisorCall,
                               systick,      sleepMasked,  busFault,
                               noMemory,     escalation,   undefinedInstruction,
                               armState,     lockUp,       guard,
                               process,      alignment,    cycles,
                               resetRequest, Case_work,    pend0};

__attribute__((section(".vectors"), used)) static const Vector vectors[20] = {
    stack_top, Reset_Handler, Handler, Handler, Handler, Handler, Handler, 0,       0,       0,
    0,         Handler,       Handler, 0,       Handler, Handler, Handler, Handler, Handler, Handler};

void Reset_Handler(void) {
    U32 *to;
    const U32 *from = data_load;
    for (to = data_begin; to < data_end;)
        *to++ = *from++;
    for (to = bss_begin; to < bss_end;)
        *to++ = 0;
    cases[selected]();
    __asm__ volatile("bkpt #1");
}
