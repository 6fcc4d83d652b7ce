/* SPDX-License-Identifier: MIT
 *
 * probe_servant: implements Probes::Probe with the registers of the core and its ring in DDR3,
 * which it accesses through the FSMC.
 */
#include "probe_servant.h"
#include "fsmc.h"
#include "probe_regs.h"

/* limit for the reads of STATUS; a few hundred reads take long enough to empty the FIFO */
#define STOP_READS 10000

static U32 get(const Probe_Core* self, U32 word) {
    return FSMC_read(self->core.slot, word);
}

static void set(const Probe_Core* self, U32 word, U32 value) {
    FSMC_write(self->core.slot, word, value);
}

static U32 changeBytes(const Probe_Core* self) {
    return ((get(self, PROBE_STATUS) & PROBE_STATUS_WORDS_MASK) >> PROBE_STATUS_WORDS_LSB) * 8U;
}

Hw_Status Probe_Core_init(Probe_Core* self, U32 slot, U32 memory, const Hw_Port* port,
                          void* context) {
    Hw_Status status = Hw_Core_init(&self->core, slot, PROBE_ID_VALUE, port, context);
    if (status != HW_OK)
        return status;
    if (memory & ((1U << PROBE_LOG2_BYTES) - 1U))
        return HW_UNALIGNED;
    self->core.memory = memory;
    set(self, PROBE_MASK, 0); /* all interrupts are masked, because callers poll the state */
    set(self, PROBE_BASE, memory);
    Probes_Probe_init(&self->servant);
    return HW_OK;
}

static Ice_Status stop(Probe_Core* self) {
    int i;
    set(self, PROBE_CONTROL, PROBE_CONTROL_STOP_MASK);
    for (i = 0; i < STOP_READS; ++i)
        if (!(get(self, PROBE_STATUS) & (PROBE_STATUS_RUNNING_MASK | PROBE_STATUS_DRAINING_MASK)))
            return ICE_OK;
    return ICE_TIMEOUT;
}

Ice_Status Probes_Probe_getState(Probes_ProbePtr servant, Probes_State* result,
                                 const Ice_Current* current) {
    const Probe_Core* self = (const Probe_Core*)servant;
    U32 status = get(self, PROBE_STATUS);
    (void)current;
    result->phase = status & PROBE_STATUS_DONE_MASK         ? Probes_done
                    : status & PROBE_STATUS_DRAINING_MASK   ? Probes_draining
                    : !(status & PROBE_STATUS_RUNNING_MASK) ? Probes_off
                    : status & PROBE_STATUS_TRIGGERED_MASK  ? Probes_triggered
                                                            : Probes_armed;
    result->names = (Ice_Int)get(self, PROBE_NAMES);
    result->clkHz = (Ice_Int)get(self, PROBE_CLK_HZ);
    result->words = (Ice_Byte)((status & PROBE_STATUS_WORDS_MASK) >> PROBE_STATUS_WORDS_LSB);
    result->next = (Ice_Int)get(self, PROBE_NEXT);
    result->wrapped = (status & PROBE_STATUS_WRAPPED_MASK) != 0;
    result->trigger =
        status & PROBE_STATUS_TRIGGERED_MASK ? (Ice_Int)get(self, PROBE_TRIGGER_AT) : -1;
    return ICE_OK;
}

Ice_Status Probes_Probe_arm(Probes_ProbePtr servant, Ice_Int mask, Ice_Int value, Ice_Bool edge,
                            Ice_Int after, const Ice_Current* current) {
    Probe_Core* self = (Probe_Core*)servant;
    Ice_Status status;
    if (after < 0 || (U32)after >= (1U << PROBE_LOG2_BYTES) / changeBytes(self))
        return Ice_Current_refuse(current, "after: expected less than the ring's changes");
    status = stop(self);
    if (status != ICE_OK)
        return status;
    set(self, PROBE_TRIGGER_BITS, (U32)mask);
    set(self, PROBE_TRIGGER_VALUE, (U32)value);
    set(self, PROBE_AFTER, (U32)after | (edge ? PROBE_AFTER_EDGE_MASK : 0));
    set(self, PROBE_CONTROL, PROBE_CONTROL_ARM_MASK);
    return ICE_OK;
}

Ice_Status Probes_Probe_stop(Probes_ProbePtr servant, const Ice_Current* current) {
    (void)current;
    return stop((Probe_Core*)servant);
}

Ice_Status Probes_Probe_read(Probes_ProbePtr servant, Ice_Int first, Ice_Int count,
                             Probes_Bytes* result, const Ice_Current* current) {
    Probe_Core* self = (Probe_Core*)servant;
    U32 size = changeBytes(self), changes = (1U << PROBE_LOG2_BYTES) / size;
    if (first < 0 || count < 0 || (U32)count > PROBE_READ_BYTES / size || (U32)first > changes ||
        (U32)count > changes - (U32)first)
        return Ice_Current_refuse(current, "expected changes in the ring, at most 4096 bytes");
    FSMC_readMemory(self->core.memory + (U32)first * size, self->bytes, (U32)count * size);
    result->data = self->bytes;
    result->size = (Ice_Int)((U32)count * size);
    return ICE_OK;
}
