/* SPDX-License-Identifier: MIT
 *
 * fsmc_bank: makes BCR, BTR and BWTR of a bank from its settings.
 */
#include "fsmc_bank.h"
#include "fsmc_private.h"

#define BWTR_RESET 0x0FFFFFFFU

typedef struct Values {
    U32 bcr, btr, bwtr;
} Values;

static int isExtended(FSMC_Mode mode) {
    return mode >= FSMC_MODE_A && mode <= FSMC_MODE_D;
}

static int timingIsBad(const FSMC_Bank* bank, const FSMC_Timing* time, FSMC_Mode mode) {
    int holds = bank->muxed || mode == FSMC_MODE_D;
    return time->addset > 15U || time->addhld > 15U || (holds && time->addhld == 0U) ||
           time->datast < (bank->wait ? 4U : 1U);
}

static int isBad(const FSMC_Bank* bank) {
    if (bank->mode > FSMC_MODE_D || bank->busturn == 0U || bank->busturn > 15U ||
        timingIsBad(bank, &bank->read, bank->mode))
        return 1;
    return isExtended(bank->mode) &&
           (!isExtended(bank->writeMode) || timingIsBad(bank, &bank->write, bank->writeMode));
}

/* Returns a BTR or BWTR; its ACCMOD 0..3 are the modes A to D. */
static U32 timing(const FSMC_Timing* time, U32 busturn, FSMC_Mode mode) {
    U32 accmod = isExtended(mode) ? (U32)mode - (U32)FSMC_MODE_A : 0U;
    return BTR_ADDSET(time->addset) | BTR_ADDHLD(time->addhld) | BTR_DATAST(time->datast) |
           BTR_BUSTURN(busturn) | BTR_ACCMOD(accmod);
}

static Values valuesOf(const FSMC_Bank* bank) {
    Values v;
    v.bcr = BCR_ALWAYS;
    if (bank->muxed)
        v.bcr |= BCR_MUXEN;
    if (bank->waitHigh)
        v.bcr |= BCR_WAITPOL;
    v.bwtr = BWTR_RESET;
    v.btr = timing(&bank->read, bank->busturn, bank->mode);
    if (bank->wait)
        v.bcr |= BCR_ASYNCWAIT;
    if (bank->mode == FSMC_MODE_1 || bank->mode == FSMC_MODE_A)
        v.bcr |= bank->psram ? BCR_MTYP_PSRAM : 0U;
    else
        v.bcr |= BCR_MTYP_NOR | BCR_FACCEN;
    if (isExtended(bank->mode)) {
        v.bcr |= BCR_EXTMOD;
        v.bwtr = timing(&bank->write, bank->busturn, bank->writeMode);
    }
    return v;
}

FSMC_Status FSMC_initBanks(const FSMC_Port* port, void* context, const FSMC_Bank banks[2]) {
    U32 i;
    if (isBad(&banks[0]) || isBad(&banks[1]))
        return FSMC_BAD_SETTING;
    fsmc_port = port;
    fsmc_context = context;
    for (i = 0; i < 2U; ++i) {
        Values v = valuesOf(&banks[i]);
        port->write32(context, FSMC_BTR(i), v.btr);
        port->write32(context, FSMC_BWTR(i), v.bwtr);
        port->write32(context, FSMC_BCR(i), v.bcr);
    }
    return fsmc_identify();
}
