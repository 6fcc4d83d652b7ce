/* SPDX-License-Identifier: MIT
 *
 * fsmc_bank: BCR, BTR and BWTR of a bank from its settings.
 */
#include "fsmc_bank.h"
#include "fsmc_private.h"

#define BCR_MUXEN (1UL << 1)
#define BCR_PSRAM (1UL << 2)
#define BCR_NOR (1UL << 3 | 1UL << 6) /* MTYP 2, FACCEN */
#define BCR_BURSTEN (1UL << 8)
#define BCR_WAITPOL (1UL << 9)
#define BCR_WAITEN (1UL << 13)
#define BCR_EXTMOD (1UL << 14)
#define BCR_ASYNCWAIT (1UL << 15)
#define BCR_CBURSTRW (1UL << 19)
/* bank on, 16 bits, write enable; bit 7 is reserved and 1 */
#define BCR_ALWAYS (1UL << 0 | 1UL << 4 | 1UL << 7 | 1UL << 12)
#define BTR_LONGEST 0x0000FF1FUL /* fields that a synchronous access does not use */

typedef struct Values {
    U32 bcr, btr, bwtr;
} Values;

static int isExtended(Fsmc_Mode mode) {
    return mode >= FSMC_MODE_A && mode <= FSMC_MODE_D;
}

static int timingIsBad(const Fsmc_Bank* bank, const Fsmc_Timing* time, Fsmc_Mode mode) {
    int holds = bank->muxed || mode == FSMC_MODE_D;
    return time->addset > 15U || time->addhld > 15U || (holds && time->addhld == 0U) ||
           time->datast < (bank->wait ? 4U : 1U);
}

static int isBad(const Fsmc_Bank* bank) {
    if (bank->busturn > 15U)
        return 1;
    if (bank->mode == FSMC_MODE_BURST)
        return bank->clkdiv < 1U || bank->clkdiv > 15U || bank->latency < 2U || bank->latency > 17U;
    if (bank->mode > FSMC_MODE_BURST || timingIsBad(bank, &bank->read, bank->mode))
        return 1;
    return isExtended(bank->mode) &&
           (!isExtended(bank->writeMode) || timingIsBad(bank, &bank->write, bank->writeMode));
}

/* BTR or BWTR; ACCMOD 0..3 are modes A to D. */
static U32 timing(const Fsmc_Timing* time, U32 busturn, Fsmc_Mode mode) {
    U32 accmod = isExtended(mode) ? (U32)mode - (U32)FSMC_MODE_A : 0U;
    return time->addset | (U32)time->addhld << 4 | (U32)time->datast << 8 | busturn << 16 |
           accmod << 28;
}

static Values valuesOf(const Fsmc_Bank* bank) {
    Values v;
    v.bcr = (U32)BCR_ALWAYS;
    if (bank->muxed)
        v.bcr |= (U32)BCR_MUXEN;
    if (bank->waitHigh)
        v.bcr |= (U32)BCR_WAITPOL;
    v.bwtr = 0x0FFFFFFFUL; /* as after reset */
    if (bank->mode == FSMC_MODE_BURST) {
        v.bcr |= (U32)(BCR_PSRAM | BCR_BURSTEN | BCR_WAITEN | BCR_CBURSTRW);
        v.btr = (U32)BTR_LONGEST | (U32)bank->busturn << 16 | (U32)bank->clkdiv << 20 |
                (U32)(bank->latency - 2U) << 24;
        return v;
    }
    v.btr = timing(&bank->read, bank->busturn, bank->mode);
    if (bank->wait)
        v.bcr |= (U32)BCR_ASYNCWAIT;
    if (bank->mode == FSMC_MODE_1 || bank->mode == FSMC_MODE_A)
        v.bcr |= bank->psram ? (U32)BCR_PSRAM : 0U;
    else
        v.bcr |= (U32)BCR_NOR;
    if (isExtended(bank->mode)) {
        v.bcr |= (U32)BCR_EXTMOD;
        v.bwtr = timing(&bank->write, bank->busturn, bank->writeMode);
    }
    return v;
}

Fsmc_Status FSMC_initBanks(const Fsmc_Port* port, void* context, const Fsmc_Bank banks[2]) {
    U32 i;
    if (isBad(&banks[0]) || isBad(&banks[1]) || banks[1].mode == FSMC_MODE_BURST)
        return FSMC_BAD_SETTING;
    fsmc_port = port;
    fsmc_context = context;
    for (i = 0; i < 2U; ++i) {
        Values v = valuesOf(&banks[i]);
        U32 at = (U32)FSMC_REGISTERS + i * 8U;
        port->write32(context, at + 4U, v.btr);
        port->write32(context, at + 0x104U, v.bwtr);
        port->write32(context, at, v.bcr);
    }
    return fsmc_identify();
}
