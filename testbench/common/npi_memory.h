// SPDX-License-Identifier: MIT
//
// npi_memory: models the memory at one NPI port (docs/memory.md), with random stalls, for tests of
// single blocks. It checks that the requester obeys the rules of NPI, and throws an exception if a
// rule is broken.

#pragma once

#include "bench.h"
#include "random.h"
#include <deque>
#include <unordered_map>

template <class Module> class NpiMemory {
public:
    // `stall`: probability per cycle that an acknowledgement or the next read word is delayed, 0 to
    // 1.
    NpiMemory(Bench<Module>& bench, double stall, uint64_t seed)
        : top_(bench.top()), random_(seed), stall_(stall) {
        drive();
        bench.addModel([this] { sample(); }, [this] { drive(); });
    }

    uint8_t byte(uint32_t address) const {
        auto it = bytes_.find(address);
        return it == bytes_.end() ? 0 : it->second;
    }
    void setByte(uint32_t address, uint8_t value) { bytes_[address] = value; }
    template <class Bytes> void store(uint32_t address, const Bytes& bytes) {
        for (uint8_t byte : bytes)
            bytes_[address++] = byte;
    }
    std::vector<uint8_t> bytes(uint32_t address, size_t count) const {
        std::vector<uint8_t> list(count);
        for (uint8_t& each : list)
            each = byte(address++);
        return list;
    }
    void setStall(double stall) { stall_ = stall; }
    // Holds back all requests while `held` is true, like a memory that hangs.
    void hold(bool held) { held_ = held; }
    // Sets the probability per cycle that a word of an acknowledged write stays in the write FIFO,
    // as in a memory that is busy with other ports. With 0, all words leave the FIFO at the
    // acknowledgement.
    void setLinger(double linger) { linger_ = linger; }
    // Makes the write FIFO collect words: bytes that are enabled are stored in each cycle, and a
    // push completes a word (MERGE in npi_arbiter).
    void setMerge() { merge_ = true; }
    uint64_t reads() const { return reads_; }
    uint64_t writes() const { return writes_; }

private:
    static constexpr unsigned fifoWords = 32;

    struct Word {
        uint64_t data;
        // byte enables of the word (write), or index of the word in its transfer (read)
        uint8_t extra;
    };

    [[noreturn]] static void broken(const std::string& what) {
        throw std::runtime_error("NPI rule broken: " + what);
    }

    void sample() {
        if (top_.rst_i) {
            read_.clear();
            write_.clear();
            open_ = {};
            lingering_ = 0;
            ack_ = readValid_ = false;
            return;
        }
        if (linger_ == 0)
            lingering_ = 0;
        else if (lingering_ && !random_.chance(linger_))
            --lingering_;
        if (top_.npi_rd_pop_o) {
            if (!readValid_)
                broken("pop of an empty read FIFO");
            read_.pop_front();
            readValid_ = false;
        }
        if (top_.npi_wr_flush_o)
            write_.clear();
        if (top_.npi_rd_flush_o) {
            read_.clear();
            readValid_ = false;
        }
        if (!merge_)
            open_ = {top_.npi_wr_data_o, static_cast<uint8_t>(top_.npi_wr_be_o)};
        if (top_.npi_wr_push_o) {
            if (merge_ && !open_.extra)
                broken("push of a word without bytes");
            write_.push_back(open_);
            open_ = {};
        }
        if (merge_)
            storePart();
        if (write_.size() + lingering_ + (merge_ && open_.extra) > fifoWords)
            broken("push into a full write FIFO");
        sampleRequest();
        readValid_ = !read_.empty() && (readValid_ || !random_.chance(stall_));
    }

    void storePart() {
        for (unsigned b = 0; b < 8; ++b)
            if (top_.npi_wr_be_o >> b & 1) {
                uint64_t mask = uint64_t(0xFF) << (8 * b);
                open_.data = (open_.data & ~mask) | (top_.npi_wr_data_o & mask);
                open_.extra |= static_cast<uint8_t>(1u << b);
            }
    }

    void sampleRequest() {
        bool isNew = top_.npi_addr_req_o && !ack_;
        if (waiting_ && !top_.npi_addr_req_o)
            broken("request withdrawn before its acknowledgement");
        if (isNew) {
            if (waiting_ && (address_ != top_.npi_addr_o || isRead_ != bool(top_.npi_rnw_o) ||
                             size_ != top_.npi_size_o))
                broken("request changed before its acknowledgement");
            address_ = top_.npi_addr_o;
            isRead_ = top_.npi_rnw_o;
            size_ = top_.npi_size_o;
        } else if (ack_) {
            take(); // the memory acknowledges the request at this edge
        }
        waiting_ = isNew;
        ack_ = isNew && !held_ && !random_.chance(stall_);
        if (ack_)
            waiting_ = false;
    }

    void take() {
        if (size_ > 5)
            broken("size " + std::to_string(size_));
        unsigned words = 1u << size_;
        // a line read may start at any word of the cache line
        bool lineRead = isRead_ && (size_ == 1 || size_ == 2);
        if (address_ % (lineRead ? 8 : words * 8))
            broken("address not aligned to its size");
        address_ -= address_ % (words * 8);
        isRead_ ? takeRead(words) : takeWrite(words);
    }

    void takeRead(unsigned words) {
        ++reads_;
        for (unsigned w = 0; w < words; ++w)
            read_.push_back({load(address_ + 8 * w), static_cast<uint8_t>(w % 16)});
        if (read_.size() > fifoWords)
            broken("more words outstanding than the read FIFO holds");
    }

    void takeWrite(unsigned words) {
        ++writes_;
        if (write_.size() < words)
            broken("write requested before its data was pushed");
        for (unsigned w = 0; w < words; ++w) {
            Word word = write_.front();
            write_.pop_front();
            for (unsigned b = 0; b < 8; ++b)
                if (word.extra >> b & 1)
                    bytes_[address_ + 8 * w + b] = static_cast<uint8_t>(word.data >> (8 * b));
        }
        if (linger_ > 0)
            // these words still occupy the write FIFO, so later requests have less space
            lingering_ += words;
    }

    uint64_t load(uint32_t address) const {
        uint64_t value = 0;
        for (unsigned b = 0; b < 8; ++b)
            value |= uint64_t(byte(address + b)) << (8 * b);
        return value;
    }

    void drive() {
        top_.npi_init_done_i = 1;
        top_.npi_addr_ack_i = ack_;
        top_.npi_wr_empty_i = write_.empty() && !lingering_;
        top_.npi_wr_almost_full_i = write_.size() + lingering_ >= fifoWords;
        top_.npi_rd_empty_i = !readValid_;
        if (readValid_) {
            top_.npi_rd_data_i = read_.front().data;
            top_.npi_rd_word_i = read_.front().extra;
        }
    }

    Module& top_;
    Random random_;
    double stall_, linger_ = 0;
    bool held_ = false, ack_ = false, waiting_ = false, readValid_ = false, isRead_ = false;
    uint32_t address_ = 0;
    unsigned size_ = 0;
    size_t lingering_ = 0; // words of acknowledged writes that are still in the FIFO
    std::deque<Word> read_, write_;
    bool merge_ = false;
    Word open_{}; // word that the write FIFO collects
    std::unordered_map<uint32_t, uint8_t> bytes_;
    uint64_t reads_ = 0, writes_ = 0;
};
