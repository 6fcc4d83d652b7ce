// SPDX-License-Identifier: MIT
//
// npi_requester: makes random requests on the packed NPI ports of a memory controller, and compares
// the results with a reference memory.
//
// The memory executes accesses in the order of their acknowledgements (docs/memory.md), so each
// acknowledgement updates the reference memory. Every word that is read is compared with the
// reference at once; a difference throws an exception.

#pragma once

#include "random.h"
#include <cstring>
#include <deque>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

// Returns the bits lsb..lsb+width-1 of a Verilated module's packed port of any type. `width` is at
// most 64, and in a wide port the bits must lie within two of its 32-bit words.
template <class Port> uint64_t getBits(const Port& port, unsigned lsb, unsigned width) {
    uint64_t mask = width == 64 ? ~0ull : (1ull << width) - 1;
    if constexpr (std::is_integral_v<Port>) {
        return static_cast<uint64_t>(port) >> lsb & mask;
    } else {
        uint64_t value = port[lsb / 32] >> (lsb % 32);
        if (lsb % 32 + width > 32)
            value |= static_cast<uint64_t>(port[lsb / 32 + 1]) << (32 - lsb % 32);
        return value & mask;
    }
}

template <class Port> void setBits(Port& port, unsigned lsb, unsigned width, uint64_t value) {
    uint64_t mask = width == 64 ? ~0ull : (1ull << width) - 1;
    if constexpr (std::is_integral_v<Port>) {
        port = static_cast<Port>((port & ~(mask << lsb)) | (value & mask) << lsb);
    } else {
        for (unsigned done = 0; done < width;) {
            unsigned at = (lsb + done) % 32, step = width - done < 32 - at ? width - done : 32 - at;
            uint32_t part = step == 32 ? ~0u : (1u << step) - 1;
            auto& word = port[(lsb + done) / 32];
            word = (word & ~(part << at)) | (static_cast<uint32_t>(value >> done) & part) << at;
            done += step;
        }
    }
}

// Describes the traffic that one requester makes.
struct NpiTraffic {
    // probability, per cycle, of starting a request if no other request is waiting
    double ask = 1.0;
    double push = 1.0;   // probability, per cycle, of pushing the next word of a write
    double pop = 1.0;    // probability, per cycle, of popping a word that has arrived
    double writes = 0.5; // fraction of the requests that are writes
    unsigned minSize = 0, maxSize = 5;
    // largest number of words that may be requested and not popped yet; must not exceed the size of
    // the read FIFO, unless pop is 1 (rule 3)
    unsigned outstanding = 32;
    bool byteEnables = true; // true: byte enables are random; false: all bytes are written
    bool anyLineWord = true; // true: a read of a cache line may start at any of its words
    // true if each address follows the previous one, false if addresses are random
    bool sequential = false;
    uint32_t base = 0, bytes = 1 << 16; // part of the memory that this requester uses
    // random address bits above the size of the memory; the controller ignores them
    uint32_t above = 0;
};

template <class Module> class NpiRequesters {
public:
    struct Counters {
        uint64_t readWords = 0, writeWords = 0, requests = 0, latencySum = 0, reads = 0;
    };

    NpiRequesters(Module& top, unsigned ports, size_t bytes, uint64_t seed)
        : top_(top), reference_(bytes), ports_(ports), random_(seed) {
        for (unsigned p = 0; p < ports; ++p)
            ports_[p].number = p;
        drive();
    }

    NpiTraffic& traffic(unsigned port) { return ports_[port].traffic; }
    const Counters& counters(unsigned port) const { return ports_[port].counters; }
    std::vector<uint8_t>& reference() { return reference_; }
    // Starts no new requests; requests that have begun are completed.
    void stop() { stopped_ = true; }
    void go() { stopped_ = false; }
    bool idle() const {
        for (const Port& port : ports_)
            if (port.now.valid || port.ahead.valid || !port.expected.empty())
                return false;
        return true;
    }

    // Accepted requests in their order; recorded only if `log` is set.
    struct Accepted {
        uint32_t address;
        unsigned words;
        bool read;
    };
    std::vector<Accepted>* log = nullptr;

    void sample() {
        uint64_t acks = top_.npi_addr_ack_o;
        if (acks & (acks - 1))
            throw std::runtime_error("two acknowledgements in one cycle");
        for (Port& port : ports_) {
            takeWord(port);
            if (acks >> port.number & 1)
                acknowledged(port);
        }
        ++now_;
    }

    void drive() {
        for (Port& port : ports_) {
            if (!port.now.valid)
                std::swap(port.now, port.ahead);
            if (!port.now.valid)
                draw(port, port.now);
            if (port.now.valid && !port.now.read && !port.ahead.valid)
                draw(port, port.ahead);
            push(port);
            unsigned p = port.number;
            const Request& r = port.now;
            bool asks = r.ready() && (port.raised || !r.read || roomFor(port, r));
            if (asks && !port.raised) {
                port.raised = true;
                port.since = now_;
            }
            setBits(top_.npi_addr_req_i, p, 1, asks);
            setBits(top_.npi_addr_i, 32 * p, 32, r.address | r.above);
            setBits(top_.npi_rnw_i, p, 1, r.read);
            setBits(top_.npi_size_i, 4 * p, 4, r.size);
            setBits(top_.npi_rmw_i, p, 1, r.rmw);
            port.willing = random_.chance(port.traffic.pop);
            setBits(top_.npi_rd_pop_i, p, 1, 0);
        }
    }

    // Sets the pop inputs. They depend on the port's outputs in the same cycle, so this is called
    // when the outputs have settled.
    void pops() {
        for (Port& port : ports_) {
            port.popping =
                !top_.rst_i && port.willing && !getBits(top_.npi_rd_empty_o, port.number, 1);
            setBits(top_.npi_rd_pop_i, port.number, 1, port.popping);
        }
    }

private:
    struct Expected {
        uint64_t data, since;
        unsigned index;
        bool first;
    };
    struct Request {
        bool valid = false, read = false, rmw = false;
        uint32_t address = 0, above = 0;
        unsigned size = 0, words = 0, pushed = 0;
        std::vector<std::pair<uint64_t, uint8_t>> data; // words of a write, with byte enables
        bool ready() const { return valid && (read || pushed == words); }
    };
    struct Port {
        unsigned number = 0;
        NpiTraffic traffic;
        Counters counters;
        // `ahead` is the request after `now`; its write words may be pushed early
        Request now, ahead;
        bool raised = false, willing = false, popping = false;
        uint32_t next = 0; // next address, if the addresses are sequential
        uint64_t since = 0;
        std::deque<Expected> expected; // words that reads must return, in order
    };

    bool roomFor(const Port& port, const Request& r) const { // rule 3
        return port.expected.size() + r.words <= port.traffic.outstanding;
    }

    void draw(Port& port, Request& r) {
        if (stopped_ || !top_.npi_init_done_o || !random_.chance(port.traffic.ask))
            return;
        const NpiTraffic& t = port.traffic;
        r.valid = true;
        r.read = !random_.chance(t.writes);
        r.rmw = random_.chance(0.5);
        r.size = t.minSize + random_.below(t.maxSize - t.minSize + 1);
        r.words = 1u << r.size;
        r.pushed = 0;
        uint32_t bytes = r.words * 8;
        if (t.sequential) {
            port.next = (port.next + bytes - 1) / bytes * bytes % t.bytes;
            r.address = t.base + port.next;
            port.next += bytes;
        } else {
            r.address = t.base + random_.below(t.bytes / bytes) * bytes;
        }
        if (r.read && t.anyLineWord && (r.size == 1 || r.size == 2))
            r.address += random_.below(r.words) * 8;
        if (t.above)
            r.above = random_.next() & t.above;
        r.data.clear();
        if (!r.read)
            for (unsigned w = 0; w < r.words; ++w) {
                uint64_t data = uint64_t(random_.next()) << 32 | random_.next();
                r.data.emplace_back(data, t.byteEnables ? random_.next() & 0xFF : 0xFF);
            }
    }

    void push(Port& port) {
        unsigned p = port.number;
        Request& r = port.now.ready() ? port.ahead : port.now;
        bool pushes = r.valid && !r.read && r.pushed < r.words &&
                      !getBits(top_.npi_wr_almost_full_o, p, 1) &&
                      random_.chance(port.traffic.push);
        setBits(top_.npi_wr_push_i, p, 1, pushes);
        if (pushes) {
            setBits(top_.npi_wr_data_i, 64 * p, 64, r.data[r.pushed].first);
            setBits(top_.npi_wr_be_i, 8 * p, 8, r.data[r.pushed].second);
            ++r.pushed;
        }
    }

    void acknowledged(Port& port) {
        if (!port.raised)
            throw std::runtime_error(where(port) + "acknowledged without a request");
        Request& r = port.now;
        uint32_t from = r.address / (r.words * 8) * (r.words * 8);
        for (unsigned w = 0; w < r.words; ++w) {
            uint8_t* where = reference_.data() + from + 8 * w;
            if (r.read) {
                uint64_t value;
                std::memcpy(&value, where, 8);
                port.expected.push_back({value, port.since, w % 16, w == 0});
            } else {
                for (unsigned b = 0; b < 8; ++b)
                    if (r.data[w].second >> b & 1)
                        where[b] = static_cast<uint8_t>(r.data[w].first >> (8 * b));
            }
        }
        if (log)
            log->push_back({from, r.words, r.read});
        Counters& c = port.counters;
        ++c.requests;
        c.writeWords += r.read ? 0 : r.words;
        r.valid = port.raised = false;
    }

    void takeWord(Port& port) {
        if (!port.popping)
            return;
        if (port.expected.empty())
            throw std::runtime_error(where(port) + "a word arrived that was not requested");
        Expected e = port.expected.front();
        port.expected.pop_front();
        uint64_t data = getBits(top_.npi_rd_data_o, 64 * port.number, 64);
        uint64_t index = getBits(top_.npi_rd_word_o, 4 * port.number, 4);
        if (data != e.data || index != e.index)
            throw std::runtime_error(where(port) + "read " + std::to_string(data) +
                                     " at position " + std::to_string(index) + ", expected " +
                                     std::to_string(e.data) + " at position " +
                                     std::to_string(e.index));
        ++port.counters.readWords;
        if (e.first) {
            uint64_t latency = now_ - e.since;
            Counters& c = port.counters;
            ++c.reads;
            c.latencySum += latency;
        }
    }

    std::string where(const Port& port) const {
        return "cycle " + std::to_string(now_) + ", port " + std::to_string(port.number) + ": ";
    }

    Module& top_;
    std::vector<uint8_t> reference_;
    std::vector<Port> ports_;
    Random random_;
    bool stopped_ = false;
    uint64_t now_ = 0;
};
