// SPDX-License-Identifier: MIT
//
// fuzz_link: fuzzes the full and the minimal link layer with libFuzzer. An input is a small
// program: bytes that the receiver gets, with or without a valid checksum, time, and messages to
// send. The full layer has a peer with a session; the minimal layer receives a HELLO. Nothing may
// crash, hang, or write out of bounds, and no frame or message may have an impossible size.
//
// Each step of the input has two bytes, its kind (mod 8) and its argument n:
//   0, 1  n bytes arrive, unchanged
//   2     a frame of n bytes arrives; the session's checksum (with a key: tag) is added
//   3     as 2; if it is a data frame, it has the expected number
//   4     as 2, but the frame is of the handshake; for the minimal layer, a HELLO with nonce n
//   5     n ms pass; the program accepts messages if n < 64, otherwise not
//   6     a message of n bytes (minimal layer: 5 n) is sent on channel n mod 4, which is opened if
//         necessary; n = 255, and in the minimal layer every fourth n, closes a channel instead
//   7     n frames of the peer arrive, and the radio of a minimal layer has room again
//
// With -DKEYED both sides have a key, and the fuzzer knows the key.

#include "link_program.h"
#include <cstdint>
#include <cstring>
#include <deque>
#include <memory>
#include <vector>

extern "C" {
#ifdef LINK_MINIMAL
#include "link_minimal.h"
#else
#include "link.h"
#include "link_codec_keyed.h"
#endif
}

namespace {

using Bytes = std::vector<uint8_t>;

#ifdef LINK_MINIMAL
constexpr bool isMinimal = true;
#else
constexpr bool isMinimal = false;
#endif

// A link with its program and its radio.
struct Node : LinkProgram {
    bool transmit(const U8* frame, U32 size) override {
        if (size < LINK_OVERHEAD || size > LINK_MAX_FRAME ||
            // each packet contains exactly one frame
            (isMinimal && size != LINK_LENGTH(frame) + LINK_OVERHEAD))
            __builtin_trap();
        if (out.size() > 50)
            return false;
        out.emplace_back(frame, frame + size);
        return true;
    }
    U32 random() override { return nonce = nonce * 1664525u + 1013904223u; }
    bool take(int channel, const U8* data, U32 size) override {
        if (size < 1 || size > LINK_MAX_MESSAGE || channel < 0 || channel >= LINK_CHANNELS)
            __builtin_trap();
        for (U32 i = 0; i < size; ++i)
            sum += data[i];
        return !busy;
    }
    void onChannel(int channel, bool isOpen) override {
        sum += static_cast<uint64_t>(channel) + isOpen;
    }
    void onState(Link_State state) override { sum += state; }
    void onOutcome(int, U32 tag, Link_Outcome) override { sum += tag; }
    void onWritable() override { ++sum; }

    std::unique_ptr<Link> link{new Link};
#ifndef LINK_MINIMAL
    std::unique_ptr<Link_Buffers> buffers{new Link_Buffers};
#endif
    std::deque<Bytes> out; // frames in transit
    uint32_t nonce = 1;
    // sum of all received bytes; computing it reads each byte, so a sanitizer detects bytes out of
    // bounds
    uint64_t sum = 0;
    bool busy = false;
};

const U8 key[LINK_KEY_BYTES] = {1, 2, 3};

class Machine {
public:
    Machine() {
        for (Node* n : {&a_, &b_}) {
#ifdef LINK_MINIMAL
            const Link_Config config = {Node::linkPort(), n->linkProgram(), 1440};
#else
            const Link_Config config = {Node::linkPort(), n->linkProgram(), 1440,
                                        LINK_USE(*n->buffers)};
#endif
            Link_init(n->link.get(), &config);
#ifdef KEYED
            Link_setKey(n->link.get(), 0, key, n == &a_ ? LINK_GROUND : 0);
#endif
            Link_start(n->link.get(), now_);
            n->nonce += 77;
        }
        if (isMinimal)
            feed(hello(1));
        for (int i = 0; i < 3 && !isMinimal; ++i) {
            pass(400);
            cross(a_, b_, 99);
            cross(b_, a_, 99);
        }
    }
    void run(const uint8_t* p, size_t size) {
        while (size >= 2) {
            const uint8_t step = p[0] & 7, n = p[1];
            p += 2;
            size -= 2;
            const size_t take = step < 5 && !(isMinimal && step == 4) ? (n < size ? n : size) : 0;
            Bytes bytes(p, p + take);
            p += take;
            size -= take;
            if (isMinimal && step > 1 && step < 5)
                now_ += 30000; // a pause, by which the receiver recognises the end of the frame
            if (step < 2)
                feed(bytes);
            else if (step < 5)
                feed(isMinimal && step == 4 ? hello(n) : frame(bytes, step));
            else if (step == 5)
                pass(n);
            else if (step == 6)
                send(n);
            else
                cross(b_, a_, n);
            a_.busy = n & 0x40 && step == 5;
            if (isMinimal) {
                Link_poll(a_.link.get(), now_);
                if (step == 7)
                    a_.out.clear();
            }
            (void)Link_deadline(a_.link.get(), now_);
        }
        a_.busy = false;
        pass(12000);
        Link_stop(a_.link.get(), now_);
    }

private:
#ifdef LINK_MINIMAL
    U32 sessionKey() const { return a_.link->key; }
    U32 expected() const { return a_.link->receiveNext; }
    U32 overhead() const { return LINK_OVERHEAD; }
    Bytes sealed(Bytes bytes, bool) const { return bytes; }
#else
    U32 sessionKey() const { return a_.link->session.handshake.present.key; }
    U32 expected() const { return a_.link->session.receiver.expected; }
    U32 overhead() const { return a_.link->pacing.env.codec->overhead; }
    // Returns the encrypted frame. HELLO uses a separate key. For the other frames of the
    // handshake, the key depends on the current nonce and on the peer's nonce, which the input
    // contains.
    Bytes sealed(Bytes bytes, bool isHandshake) const {
        const Link* link = a_.link.get();
        const U8* under = LINK_PEERS_KEY(&link->session.handshake.present, keys);
        Link_Keys keys;
        U32 kind = bytes[2] >> 5 & 7;
        U32 number = expected(), acked = 0;
        if (isHandshake) {
            kind = LINK_KIND_HELLO + kind % 3;
            bytes.resize(LINK_HEADER +
                         (kind == LINK_KIND_HELLO ? LINK_NONCE_BYTES : LINK_ANSWER_BYTES));
            bytes[0] = static_cast<uint8_t>(0x80 | (bytes.size() - LINK_HEADER));
            bytes[1] = LINK_VERSION;
            bytes[2] = static_cast<uint8_t>((bytes[2] & 3) | kind << 5);
            under = link->session.handshake.secrets[0].hello;
            if (kind != LINK_KIND_HELLO) {
                std::memcpy(&bytes[LINK_HEADER + 8], link->session.handshake.nonce,
                            LINK_NONCE_BYTES);
                link_deriveKeys(&link->session.handshake.secrets[0], &bytes[LINK_HEADER],
                                link->session.handshake.nonce, &keys);
                under = keys.bytes; // the key for frames from the vehicle, which is the peer
            }
        } else if (bytes[0] & LINK_CONTROL) {
            if (kind == LINK_KIND_ACK)
                number = link->session.sender.base;
            else if (kind == LINK_KIND_PING)
                number = bytes[2] & 1 ? link->session.liveness.pingsSent
                                      : link->session.liveness.pingsSeen;
            else if (kind >= LINK_KIND_PIGGYBACK && bytes.size() > LINK_HEADER)
                acked = link_extend(link->session.sender.base, bytes[LINK_HEADER]);
            if (kind == LINK_KIND_BYE)
                number = bytes[1];
        }
        number = link_extend(number, bytes[1]);
        const U32 header = bytes[0] | U32(bytes[1]) << 8 | U32(bytes[2]) << 16;
        bytes.resize(bytes.size() + LINK_TAG);
        link_encryptFrame(bytes.data(), header, under, number, acked);
        return bytes;
    }
#endif
    // Returns a frame that A accepts as a frame from its peer, if its content is valid.
    Bytes frame(Bytes bytes, int step) const {
        const bool isHandshake = step == 4;
        const size_t most = LINK_MAX_FRAME - overhead() + LINK_HEADER;
        if (bytes.size() < LINK_HEADER)
            return bytes;
        if (bytes.size() > most)
            bytes.resize(most);
        bytes[0] = static_cast<uint8_t>((bytes[0] & 0x80) | (bytes.size() - LINK_HEADER));
        if (step == 3 && !(bytes[0] & LINK_CONTROL))
            bytes[1] = static_cast<uint8_t>(expected());
        if (!isHandshake)
            bytes[2] = static_cast<uint8_t>((bytes[2] & ~0x1C) | LINK_KEY_EPOCH(sessionKey()) << 2);
        if (overhead() != LINK_OVERHEAD)
            return sealed(bytes, isHandshake);
        return checked(bytes, isHandshake ? LINK_NO_SEED : sessionKey());
    }
    static Bytes hello(uint8_t nonce) {
        return checked({0x84, LINK_VERSION, 0x20, nonce, 2, 3, 4}, LINK_NO_SEED);
    }
    // Returns the frame with a checksum appended.
    static Bytes checked(Bytes frame, U32 seed) {
        const U32 crc = link_crc(seed, frame.data(), static_cast<U32>(frame.size()));
        frame.push_back(static_cast<uint8_t>(crc >> 8));
        frame.push_back(static_cast<uint8_t>(crc));
        return frame;
    }
    void feed(const Bytes& bytes) {
        if (!bytes.empty())
            Link_receive(a_.link.get(), bytes.data(), static_cast<U32>(bytes.size()), now_);
    }
    void pass(unsigned ms) {
        for (unsigned i = 0; i < ms; i += 20) {
            now_ += 20000;
            Link_poll(a_.link.get(), now_);
            Link_poll(b_.link.get(), now_);
            cross(a_, b_, 1);
        }
    }
    void send(uint8_t n) {
        const Bytes message(isMinimal ? n * 5u : n, n);
        const U32 size = static_cast<U32>(message.size());
        if (Link_send(a_.link.get(), n % 4, message.data(), size, n) == LINK_CLOSED)
            Link_openChannel(a_.link.get(), n % 4);
        if (n == 255 || (isMinimal && n / 4 % 4 == 3))
            Link_closeChannel(a_.link.get(), n % 4);
    }
    void cross(Node& from, Node& to, unsigned count) {
        for (; count && !from.out.empty(); --count) {
            Bytes bytes = from.out.front();
            from.out.pop_front();
            Link_receive(to.link.get(), bytes.data(), static_cast<U32>(bytes.size()), now_);
        }
    }
    Node a_, b_;
    U32 now_ = 0xFFFFF000u;
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    Machine().run(data, size);
    return 0;
}
