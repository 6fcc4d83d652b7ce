// SPDX-License-Identifier: MIT
//
// cpu_accesses: the part of CortexM3 that handles loads and stores outside of RAM, with wait
// cycles, the write buffer and faults, and the accesses by a debugger.

#include "bit_band.h"
#include "cortex_m3.h"
#include "unicorn_calls.h"
#include <cstdio>
#include <cstring>

namespace {
constexpr unsigned storeCycles = 14; // number of FSMC cycles for a store of one register word

std::string accessText(uint32_t address, unsigned bytes, const char* what) {
    char text[64];
    std::snprintf(text, sizeof text, "access of %u bytes to 0x%08X: ", bytes, address);
    return std::string(text) + what;
}

// Returns the size in bytes of the longest aligned access that can begin at an address.
unsigned accessSize(uint32_t address, uint32_t bytes) {
    return address % 4 == 0 && bytes >= 4 ? 4 : address % 2 == 0 && bytes >= 2 ? 2 : 1;
}
} // namespace

// Adds the cycles for which the last bus access made the processor wait.
void CortexM3::passWaited() {
    const unsigned waited = bus_.takeWaited();
    waited_ += waited;
    control_.pass(waited);
    attention_ = attention_ || exceptions_.deliverable();
}

// Carries out a store from the write buffer. If it fails, the fault is imprecise: it is reported
// later and without an address.
template <class Store> void CortexM3::store(uint32_t address, unsigned bytes, Store store) {
    try {
        store();
        passWaited();
    } catch (const CpuBus::Error& e) {
        (void)bus_.takeWaited();
        reportStoreFault(accessText(address, bytes, e.what()));
    } catch (...) {
        failure_ = std::current_exception();
    }
    attention_ = attention_ || failure_;
}

void CortexM3::drainStore() {
    const BufferedStore s = store_;
    store_.bytes = 0;
    if (s.bytes)
        store(s.address, s.bytes, [&] { bus_.write(s.address, s.bytes, s.value); });
}

template <class Access>
uint32_t CortexM3::guardedAccess(uint32_t address, unsigned bytes, Access access) {
    if (failure_ || synchronous_.number)
        return 0; // after an access that failed, the processor stops before the next instruction
    try {
        uint32_t value = 0;
        if (address >= 0xE0000000) {
            value = access(true);
            // A write to a system register may allow an exception that was blocked. DSB and ISB
            // after such a write take no additional cycles in this model.
            attention_ = attention_ || exceptions_.deliverable() || stopAsked_;
            return value;
        }
        drainStore();
        value = access(false);
        passWaited();
        return value;
    } catch (const CpuBus::Error& e) {
        (void)bus_.takeWaited();
        synchronous_ = {BusFault, SystemControl::preciseBus | SystemControl::bfarValid,
                        accessText(address, bytes, e.what())};
        control_.setFaultAddress(SystemControl::bfarValid, address);
    } catch (...) {
        failure_ = std::current_exception();
    }
    attention_ = true;
    uc_emu_stop(uc_);
    return 0;
}

uint32_t CortexM3::readBit(uint32_t address) {
    const BitBand at(address);
    uint32_t word = 0;
    if (at.isRam())
        (void)(onGuarded(at.word, 4, false) || readMemory(at.word, &word, 4));
    else
        word = onRead(at.word, 4);
    return at.get(word);
}

void CortexM3::writeBit(uint32_t address, uint32_t value) {
    const BitBand at(address);
    uint32_t word = 0;
    if (!at.isRam()) {
        onWrite(at.word, 4, at.set(onRead(at.word, 4), value));
    } else if (!onGuarded(at.word, 4, true) && readMemory(at.word, &word, 4)) {
        word = at.set(word, value);
        writeMemory(at.word, &word, 4);
    }
}

// Returns true if an unaligned access must be split into aligned accesses, as is done for memory.
// The result of an unaligned access to a device is unpredictable, so the model reports such an
// access as not modelled.
bool CortexM3::isSplit(uint32_t address, unsigned bytes) {
    if (address % bytes == 0 || address >= 0xE0000000)
        return false;
    if (address >= 0x40000000 && address < 0x60000000 && !failure_)
        failure_ = std::make_exception_ptr(
            NotModelled(accessText(address, bytes, "unaligned, to a device")));
    return true;
}

uint32_t CortexM3::onRead(uint32_t address, unsigned bytes) {
    if (BitBand::isAlias(address))
        return readBit(address);
    if (isSplit(address, bytes)) {
        uint32_t value = 0;
        for (unsigned done = 0, size; done < bytes; done += size) {
            size = accessSize(address + done, bytes - done);
            value |= onRead(address + done, size) << 8 * done;
        }
        return value;
    }
    return guardedAccess(address, bytes, [&](bool own) {
        return own ? control_.read(address, bytes) : bus_.read(address, bytes);
    });
}

void CortexM3::onWrite(uint32_t address, unsigned bytes, uint32_t value) {
    if (BitBand::isAlias(address))
        return writeBit(address, value);
    if (isSplit(address, bytes)) {
        for (unsigned done = 0, size; done < bytes; done += size) {
            size = accessSize(address + done, bytes - done);
            onWrite(address + done, size, value >> 8 * done);
        }
        return;
    }
    if (address < 0xE0000000 && control_.buffersStores() && !failure_ && !synchronous_.number) {
        drainStore();
        store_ = {address, value, bytes, cycles() + storeCycles};
        return;
    }
    guardedAccess(address, bytes, [&](bool own) {
        own ? control_.write(address, bytes, value) : bus_.write(address, bytes, value);
        return 0u;
    });
    if (address >= 0xE0000000 && control_.takeResetRequest())
        requestReset();
}

// Called before libunicorn stores to flash. The model undoes the store of libunicorn; only the
// result of the bus counts.
void CortexM3::onFlashWrite(uint32_t offset, unsigned bytes, uint32_t value) {
    flashWrites_.undo(memory_.flash());
    if (failure_ || synchronous_.number)
        return;
    drainStore();
    store(config_.flashBase + offset, bytes, [&] { bus_.writeFlash(offset, bytes, value); });
    flashWrites_.keep(memory_.flash(), offset, bytes);
}

void CortexM3::flashChanged(uint32_t offset, uint32_t bytes) {
    flashWrites_.changed(offset, bytes);
    attention_ = attention_ || flashWrites_.isStale();
}

bool CortexM3::onGuarded(uint32_t address, unsigned bytes, bool write) {
    // the store in the write buffer must be carried out first, because RAM is on the same bus
    drainStore();
    if (!control_.isForbidden(address, bytes, write) || synchronous_.number || isMpuOff())
        return false;
    synchronous_ = {MemManage, SystemControl::dataAccess | SystemControl::mmfarValid,
                    accessText(address, bytes, "the MPU forbids it")};
    control_.setFaultAddress(SystemControl::mmfarValid, address);
    attention_ = true;
    uc_emu_stop(uc_);
    return true;
}

// ---- accesses of a debugger outside memory: aligned data by word, other data by byte ----

bool CortexM3::debugRead(uint32_t address, void* data, uint32_t bytes) {
    return readMemory(address, data, bytes) ||
           debugAccess(address, static_cast<uint8_t*>(data), bytes, false);
}

bool CortexM3::debugWrite(uint32_t address, const void* data, uint32_t bytes) {
    const auto* from = static_cast<const uint8_t*>(data);
    std::vector<uint8_t> copy(from, from + bytes);
    return writeMemory(address, data, bytes) || debugAccess(address, copy.data(), bytes, true);
}

bool CortexM3::debugAccess(uint32_t address, uint8_t* data, uint32_t bytes, bool writes) {
    drainStore();
    try {
        for (unsigned size; bytes; data += size, address += size, bytes -= size) {
            size = accessSize(address, bytes);
            uint32_t value = 0;
            std::memcpy(&value, data, writes ? size : 0);
            if (address < 0xE0000000) {
                if (writes)
                    bus_.write(address, size, value);
                else
                    value = bus_.read(address, size);
                control_.pass(bus_.takeWaited());
            } else if (writes) {
                control_.write(address, size, value);
            } else {
                value = control_.read(address, size);
            }
            std::memcpy(data, &value, size);
        }
    } catch (const CpuBus::Error&) {
        (void)bus_.takeWaited();
    } catch (const NotModelled&) {
    }
    return bytes == 0;
}
