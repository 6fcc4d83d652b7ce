// SPDX-License-Identifier: MIT
//
// ddr3_timing: computes when a DDR3 memory can execute each burst of 8 (BL8), from the state of its
// banks and rows and from the direction of the previous burst.
//
// All times are in memory clocks (tCK). Source of the figures: Micron 1Gb DDR3 SDRAM data sheet
// (MT41J64M16; 09005aef826aa906), "Speed Bins" and "Electrical Characteristics and AC Operating
// Conditions". Times in ns are rounded up to memory clocks of 2.5 ns, as the data sheet's note on
// tCK demands.

#pragma once

#include <algorithm>
#include <cstdint>

struct Ddr3Part {
    const char* name;
    unsigned rowBytes;   // size of a row (page), bytes: 1024 columns
    unsigned burstBytes; // BL8
    unsigned cl, cwl;    // read latency (CL) and write latency (CWL)
    unsigned tRCD, tRP, tRAS, tRC;
    unsigned tCCD, tRTP, tWR, tWTR, tRRD, tFAW;
    unsigned tRFC, tREFI;
};

// Speed grade -187E (DDR3-1066, 7-7-7), run as DDR3-800: CL 6, CWL 5; tRCD = tRP = 13.125 ns, tRAS
// = 37.5 ns, tRC = 50.625 ns, tWR = 15 ns, tRFC = 110 ns (1 Gb), tREFI = 7.8 us; tCCD = 4 CK, tRTP
// = tWTR = max(4 CK, 7.5 ns), tRRD = max(4 CK, 10 ns), tFAW = 50 ns for pages of 2 KiB, 40 ns for 1
// KiB.
constexpr Ddr3Part mt41j64m16{
    "MT41J64M16-187E at DDR3-800", 2048, 16, 6, 5, 6, 6, 15, 21, 4, 4, 6, 4, 4, 20, 44, 3120};

class Ddr3Timing {
public:
    // `refreshLater`: number of memory clocks by which each refresh is delayed. Without a delay, a
    // refresh begins tRP after the precharge of all banks.
    explicit Ddr3Timing(const Ddr3Part& part, unsigned refreshLater = 0)
        : part_(part), refreshLater_(refreshLater), nextRefresh_(part.tREFI) {}

    const Ddr3Part& part() const { return part_; }
    uint64_t rowHits = 0, rowMisses = 0, refreshes = 0, turnarounds = 0;

    unsigned bank(uint32_t address) const { return address / part_.rowBytes % banks; }
    uint32_t row(uint32_t address) const { return address / part_.rowBytes / banks; }

    bool isOpen(uint32_t address) const {
        const Bank& b = banks_[bank(address)];
        return b.open && b.row == row(address);
    }

    // Executes one burst at `at` or later, after all earlier bursts. Opens and closes rows and
    // refreshes as needed. Returns the clock of the burst's READ or WRITE command.
    uint64_t access(uint64_t at, bool read, uint32_t address) {
        at = refresh(at);
        Bank& b = banks_[bank(address)];
        uint32_t wanted = row(address);
        if (b.open && b.row == wanted) {
            ++rowHits;
        } else {
            ++rowMisses;
            activate(b, wanted, at);
        }
        uint64_t cas = std::max({at, b.activated + part_.tRCD, lastCas_ + part_.tCCD});
        if (anyCas_ && read != lastRead_) {
            ++turnarounds;
            // READ to WRITE: CL + tCCD + 2 - CWL; WRITE to READ: CWL + 4 + tWTR.
            cas = std::max(cas, lastCas_ + (read ? part_.cwl + 4 + part_.tWTR
                                                 : part_.cl + part_.tCCD + 2 - part_.cwl));
        }
        lastCas_ = cas;
        lastRead_ = read;
        anyCas_ = true;
        b.mayPrecharge =
            std::max(b.mayPrecharge, read ? cas + part_.tRTP : cas + part_.cwl + 4 + part_.tWR);
        return cas;
    }
    // Closes the bank after its last burst (auto-precharge).
    void autoPrecharge(uint32_t address) {
        Bank& b = banks_[bank(address)];
        b.open = false;
        b.mayActivate = std::max(b.mayActivate, precharge(b, 0) + part_.tRP);
    }
    // Executes a refresh at clock `at` or later, also before a refresh is due. Returns the clock in
    // which the refresh ends.
    uint64_t refreshNow(uint64_t at) {
        uint64_t start = at;
        for (Bank& b : banks_) { // precharge all
            if (b.open)
                start = std::max(start, precharge(b, at) + part_.tRP + refreshLater_);
            start = std::max(start, b.mayActivate);
            b.open = false;
        }
        for (Bank& b : banks_)
            b.mayActivate = start + part_.tRFC;
        ++refreshes;
        return start + part_.tRFC;
    }

private:
    static constexpr unsigned banks = 8;
    struct Bank {
        bool open = false;
        uint32_t row = 0;
        uint64_t activated = 0, mayPrecharge = 0, mayActivate = 0;
        bool used = false;
    };

    uint64_t precharge(const Bank& b, uint64_t at) const {
        return std::max({at, b.mayPrecharge, b.activated + part_.tRAS});
    }

    void activate(Bank& b, uint32_t row, uint64_t at) {
        uint64_t act = std::max(at, b.mayActivate);
        if (b.open)
            act = std::max(act, precharge(b, at) + part_.tRP);
        if (activations_ > 0) {
            act = std::max(
                {act, b.activated + (b.used ? part_.tRC : 0), lastActivated_ + part_.tRRD});
            if (activations_ >= 4) // at most four activates in any window of tFAW
                act = std::max(act, window_[activations_ % 4] + part_.tFAW);
        }
        window_[activations_++ % 4] = act;
        lastActivated_ = b.activated = act;
        b.open = b.used = true;
        b.row = row;
        b.mayPrecharge = 0;
    }

    // Executes the refreshes that are due before `at`. After a long idle time only the last of them
    // can still delay an access. Returns the clock from which accesses are possible.
    uint64_t refresh(uint64_t at) {
        if (at < nextRefresh_)
            return at;
        uint64_t missed = (at - nextRefresh_) / part_.tREFI;
        refreshes += missed;
        uint64_t due = nextRefresh_ + missed * part_.tREFI;
        nextRefresh_ = due + part_.tREFI;
        return std::max(at, refreshNow(due));
    }

    const Ddr3Part part_;
    const unsigned refreshLater_;
    Bank banks_[banks];
    uint64_t window_[4] = {}, activations_ = 0, lastActivated_ = 0;
    uint64_t lastCas_ = 0, nextRefresh_;
    bool lastRead_ = true, anyCas_ = false;
};
