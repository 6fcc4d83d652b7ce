// SPDX-License-Identifier: MIT
//
// fuzz_minimal: libFuzzer target of the minimal link layer. The input is a little program:
// bytes for the receiver, with or without a good checksum, time, messages to send. Nothing may
// crash, hang, or write outside of its data, and no message may have an impossible size.
//
// An input byte names the step (mod 8), the next its argument n:
//   0     n bytes, unchanged
//   1, 2  a frame of n bytes, the session's epoch and checksum added
//   3     a data frame in order of n bytes, with flags and channel from the input
//   4     HELLO with nonce n
//   5     n ms pass
//   6     a message of n (large n: many) bytes on channel n mod 4, opened if need be; every fourth
//         closes it
//   7     the program takes messages (n even) or not

#include "fuzz_node.h"
#include <cstdint>

namespace {

void feed(Link* link, const Bytes& frame, U32 key, U32 now) {
    const Bytes bytes = checked(frame, key);
    Link_receive(link, bytes.data(), static_cast<U32>(bytes.size()), now);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    Node self;
    Link* link = self.link.get();
    Bytes large(LINK_MAX_MESSAGE, 0x5A);
    U32 now = 0xFFFFF000u;
    Link_init(link, &port, &self, 1440);
    feed(link, {0x84, LINK_VERSION, 0x20, 1, 2, 3, 4}, LINK_NO_SEED, now);
    for (size_t at = 0; at + 2 <= size;) {
        unsigned step = data[at] & 7, n = data[at + 1];
        at += 2;
        auto bytes = [&](size_t count) {
            count = count < size - at ? count : size - at;
            Bytes taken(data + at, data + at + count);
            at += count;
            return taken;
        };
        if (step == 0) {
            const Bytes raw = bytes(n);
            if (raw.empty())
                continue;
            Link_receive(link, raw.data(), static_cast<U32>(raw.size()), now);
        } else if (step <= 3) {
            auto frame = bytes(3 + n % (LINK_MAX_PAYLOAD + 1));
            if (frame.size() < 3)
                continue;
            frame[0] = static_cast<uint8_t>((step == 3 ? 0 : frame[0] & 0x80) | (frame.size() - 3));
            frame[2] = static_cast<uint8_t>((frame[2] & ~0x1C) | LINK_KEY_EPOCH(link->key) << 2);
            if (step == 3)
                frame[1] = link->receiveNext;
            now += 30000; // a silence, so that the frame is seen
            feed(link, frame, link->key, now);
        } else if (step == 4) {
            now += 30000;
            feed(link, {0x84, LINK_VERSION, 0x20, static_cast<uint8_t>(n), 2, 3, 4}, LINK_NO_SEED,
                 now);
        } else if (step == 5) {
            now += n * 1000u * (n & 1 ? 1u : 40u);
        } else if (step == 6) {
            int channel = static_cast<int>(n % 4);
            if (Link_send(link, channel, large.data(), n * 5u, n) == LINK_CLOSED)
                (void)Link_openChannel(link, channel);
            else if (n / 4 % 4 == 3)
                (void)Link_closeChannel(link, channel);
        } else {
            self.busy = n & 1;
            self.out.clear(); // before that the radio may have been full
        }
        Link_poll(link, now);
        (void)Link_deadline(link, now);
        for (const Bytes& frame : self.out)
            if (LINK_LENGTH(frame) + LINK_OVERHEAD != frame.size())
                __builtin_trap();
    }
    Link_stop(link, now);
    return 0;
}
