// SPDX-License-Identifier: MIT
//
// direct_drive: the memory's own limit: the same requests, given to the memory model by a driver
// that loses no clock and never lacks words or room. The rest is the memory and its port.

#ifndef DIRECT_DRIVE_H
#define DIRECT_DRIVE_H

#include "mcb_model.h"
#include <cstddef>

// Clocks that the model needs for the requests, from the first command to the last word.
// Request: anything with address, words, read.
template <class Request> uint64_t directMcb(size_t bytes, const std::vector<Request>& requests) {
    McbModel memory(bytes);
    while (!memory.pins.calibDone)
        memory.cycle();
    size_t pushing = 0, issuing = 0; // requests whose words go next, whose command goes next
    unsigned pushed = 0, promised = 0;
    uint64_t words = 0, popped = 0, clocks = 0;
    for (const Request& r : requests)
        words += r.words;
    for (; popped + memory.wordsWritten < words; ++clocks) {
        McbModel::Pins& m = memory.pins;
        while (pushing < requests.size() && requests[pushing].read)
            ++pushing;
        bool push = pushing < requests.size() && !m.wrFull;
        const Request* next = issuing < requests.size() ? &requests[issuing] : nullptr;
        bool command =
            next && !m.cmdFull &&
            (next->read ? promised + next->words <= McbModel::dataDepth : pushing > issuing);
        m.rdEn = !m.rdEmpty;
        m.wrEn = push;
        m.wrMask = 0;
        m.cmdEn = command;
        if (m.rdEn) {
            --promised;
            ++popped;
        }
        if (push && ++pushed == requests[pushing].words) {
            pushed = 0;
            ++pushing;
        }
        if (command) {
            m.cmdInstr = next->read;
            m.cmdBl = static_cast<uint8_t>(next->words - 1);
            m.cmdByteAddr = next->address;
            promised += next->read ? next->words : 0;
            ++issuing;
        }
        memory.cycle();
    }
    return clocks;
}

#endif
