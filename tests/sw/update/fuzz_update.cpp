// SPDX-License-Identifier: MIT
//
// fuzz_update: fuzzes the boot loader's choice of a slot, and the receiver of images, with
// libFuzzer. Headers, states and log in flash contain any bytes, and calls come in any order.
// Nothing may be read or written outside the flash. In the running slot, only states may be
// written. The chosen slot must contain an image that is complete, signed and for this vehicle.
//
// If the lowest bit of the first byte is 1, slot 0 is golden, as for the FPGA. Then each step has
// two bytes, its kind (mod 8) and its argument n:
//   0 the first n bytes of the input are written into slots or log, at offset 64 n
//   1 an image of version n exists
//   2 an update to version n begins; if n > 127, a new list of keys arrives
//   3 a piece of the update arrives, with 4 n bytes if n is even, or n bytes if n is odd
//   4 the update is finished
//   5 the image is confirmed
//   6 the receiver works
//   7 the power was cut
// The header of steps 1 and 2 is correct except for n / 8 % 4 bytes: for each of these, the next
// two bytes of the input are its position and its value. The header is signed after this change if
// n / 32 is even.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

extern "C" {
#include "receiver.h"
}

namespace {

using Bytes = std::vector<uint8_t>;

constexpr U32 product = 7, imageBytes = 0x200;
constexpr U32 syncWord = 0x665599AA;
// key: index of the key that signs received images; filling: value of all bytes of these images
constexpr uint8_t key = 1, filling = 0x5A;

void expect(bool condition) {
    if (!condition)
        std::abort();
}

// Replacements for the digest and for the signature, which depend on the first byte of a key; they
// are so simple that an input can contain valid ones.
uint64_t sumOf(const uint8_t* bytes, size_t count) {
    uint64_t sum = 0xCBF29CE484222325;
    for (size_t i = 0; i < count; ++i)
        sum = (sum ^ bytes[i]) * 0x100000001B3;
    return sum;
}

void sign(Slots_Header& header) {
    const uint64_t sum = sumOf(reinterpret_cast<const uint8_t*>(&header), SLOTS_SIGNED_BYTES) ^ key;
    std::memcpy(header.signature, &sum, sizeof sum);
}

class FuzzedVehicle {
public:
    FuzzedVehicle(const uint8_t* data, size_t size) : at_(data), end_(data + size) {
        layout_ = {0x1000, 0x800, 0x400, SLOTS_READY, SLOTS_TRUE, 0, size ? *at_++ & 1U : 0U};
        if (layout_.hasGolden) {
            layout_.readyAt = SLOTS_IMAGE_AT + SLOTS_SYNC_AT;
            layout_.ready = syncWord;
        }
        Slots_Keys& first = *reinterpret_cast<Slots_Keys*>(&flash_[SLOTS_KEYS_AT]);
        first.list = keysOf(1);
        first.isComplete = SLOTS_TRUE;
        port_.keys = &first;
        port_.mapped = layout_.hasGolden ? nullptr : flash_.data();
        put(0, 1);
    }
    void run() {
        boot();
        while (end_ - at_ >= 2) {
            const unsigned what = *at_++ & 7, n = *at_++;
            step(what, n);
        }
        boot();
    }

private:
    static FuzzedVehicle& of(void* context) { return *static_cast<FuzzedVehicle*>(context); }
    Bytes take(size_t count) {
        count = std::min(count, static_cast<size_t>(end_ - at_));
        at_ += count;
        return Bytes(at_ - count, at_);
    }
    Slots_Header headerOf(U32 slot, U32 version, U32 bytes) {
        Slots_Header header{};
        header.magic = SLOTS_MAGIC;
        header.product = product;
        header.version = version;
        header.bytes = bytes;
        header.base = Slots_at(&layout_, slot) + SLOTS_IMAGE_AT;
        std::memcpy(header.board, board, sizeof board);
        return header;
    }
    Slots_Header keysOf(U32 version) {
        Slots_Header list = headerOf(0, version, 0);
        list.product = SLOTS_KEYS;
        list.digest[0] = static_cast<uint8_t>(version);
        list.digest[SLOTS_KEY_BYTES] = key;
        return list;
    }
    void harm(Slots_Header& header, unsigned n) {
        for (unsigned i = 0; i < n / 8 % 4; ++i) {
            const Bytes change = take(2);
            if (change.size() == 2)
                reinterpret_cast<uint8_t*>(&header)[change[0] % sizeof header] ^= change[1];
        }
        if (n / 32 % 2 == 0)
            sign(header);
    }
    void put(U32 slot, U32 version) {
        uint8_t* to = &flash_[Slots_at(&layout_, slot)];
        std::fill_n(to, layout_.bytes, uint8_t{0xFF});
        std::memcpy(to + layout_.readyAt, &layout_.ready, 4);
        Slots_Header header = headerOf(slot, version, imageBytes);
        digest(read, this, header.base, header.bytes, header.digest);
        harm(header, version);
        std::memcpy(to, &header, sizeof header);
    }
    void step(unsigned what, unsigned n) {
        if (what == 0) {
            const Bytes bytes = take(n);
            const size_t to = 64 * n % 0x2000;
            std::copy(bytes.begin(), bytes.end(), flash_.begin() + static_cast<ptrdiff_t>(to));
        } else if (what == 1) {
            put(n & 1, n);
        } else if (what == 2) {
            Slots_Header header = n > 127 ? keysOf(Slots_keys(&port_)->version + 1)
                                          : headerOf(receiver_.slot, n, imageBytes);
            const uint64_t sum = sumOf(Bytes(imageBytes, filling).data(), imageBytes);
            if (n <= 127)
                std::memcpy(header.digest, &sum, sizeof sum);
            harm(header, n);
            Receiver_begin(&receiver_, &header);
        } else if (what == 3) {
            const U32 offset = end_ > at_ && *at_ & 1 ? *at_ * 0x01010101U : receiver_.received;
            const Bytes piece(n % 2 ? n : 4 * n, filling);
            Receiver_write(&receiver_, offset, piece.data(), static_cast<U32>(piece.size()));
        } else if (what == 4) {
            Receiver_finish(&receiver_);
        } else if (what == 5) {
            Receiver_confirm(&receiver_);
        } else if (what == 6) {
            for (int steps = 0; Receiver_work(&receiver_); ++steps)
                expect(steps < 10);
        } else {
            boot();
        }
    }
    void boot() {
        // no slot counts as running while the loader chooses one, because it may write the states
        // of both
        runs_ = SLOTS_NONE;
        U32 slot = 0;
        if (layout_.hasGolden) {
            Slots_settleFpga(&port_, flash_[0] & 1);
            (void)Slots_isLoadable(&port_, product);
            slot = Slots_is(&port_, 1, SLOTS_READY) ? 1 : 0;
        } else {
            slot = Slots_choose(&port_, product, 1);
            if (slot != SLOTS_NONE)
                expectGood(slot);
            else
                put(slot = 0, 1); // by wire
        }
        runs_ = slot;
        Receiver_init(&receiver_, &port_, product, slot);
    }
    void expectGood(U32 slot) {
        Slots_Header header, wanted;
        std::memcpy(&header, &flash_[Slots_at(&layout_, slot)], sizeof header);
        wanted = headerOf(slot, header.version, header.bytes);
        expect(std::memcmp(&header, &wanted, offsetof(Slots_Header, needs)) == 0);
        expect(header.bytes <= layout_.bytes - SLOTS_IMAGE_AT);
        expect(Slots_isSigned(&port_, Slots_keys(&port_), &header));
        digest(read, this, header.base, header.bytes, wanted.digest);
        expect(std::memcmp(header.digest, wanted.digest, sizeof wanted.digest) == 0);
    }

    // ---- the flash ----
    static void read(void* context, U32 offset, U8* bytes, U32 count) {
        const Bytes& flash = of(context).flash_;
        expect(offset <= flash.size() && count <= flash.size() - offset);
        std::copy_n(&flash[offset], count, bytes);
    }
    void mayWrite(U32 offset, U32 count) const {
        const U32 running = layout_.at + runs_ * layout_.bytes;
        const bool isState = offset % layout_.bytes >= SLOTS_READY &&
                             offset % layout_.bytes + count <= SLOTS_IMAGE_AT;
        expect(offset <= flash_.size() && count <= flash_.size() - offset);
        expect(offset + count <= SLOTS_KEYS_AT || offset >= SLOTS_KEYS_AT + sizeof(Slots_Keys));
        expect(isState || offset + count <= running || offset >= running + layout_.bytes);
    }
    static int erase(void* context, U32 offset) {
        FuzzedVehicle& self = of(context);
        self.mayWrite(offset, self.layout_.sectorBytes);
        std::fill_n(&self.flash_[offset], self.layout_.sectorBytes, uint8_t{0xFF});
        return 1;
    }
    static int program(void* context, U32 offset, const U8* bytes, U32 count) {
        of(context).mayWrite(offset, count);
        expect(count % 4 == 0 && count && offset / 256 == (offset + count - 1) / 256);
        for (U32 i = 0; i < count; ++i)
            of(context).flash_[offset + i] &= bytes[i];
        return 1;
    }
    static int isSigned(const U8* signature, const U8* message, U32 bytes, const U8* by) {
        const uint64_t sum = sumOf(message, bytes) ^ *by;
        return std::memcmp(signature, &sum, sizeof sum) == 0;
    }
    static void digest(Slots_Read read, void* context, U32 offset, U32 bytes, U8* digest) {
        Bytes all(bytes);
        read(context, offset, all.data(), bytes);
        const uint64_t sum = sumOf(all.data(), bytes);
        std::memset(digest, 0, SLOTS_DIGEST_BYTES);
        std::memcpy(digest, &sum, sizeof sum);
    }

    static constexpr U32 board[2] = {7, 3};
    const uint8_t *at_, *end_;
    Slots_Layout layout_;
    Slots_Port port_{&layout_, this, read, erase, program, isSigned, digest, nullptr, nullptr};
    Bytes flash_ = Bytes(SLOTS_KEYS_AT + SLOTS_LISTS * sizeof(Slots_Keys), 0xFF);
    U32 runs_ = SLOTS_NONE;
    Receiver receiver_{};
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    FuzzedVehicle(data, size).run();
    return 0;
}
