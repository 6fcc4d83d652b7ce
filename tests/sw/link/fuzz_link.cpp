// SPDX-License-Identifier: MIT
//
// fuzz_link: libFuzzer target of the link layer. The input is a little program: bytes for the
// receiver, with or without a good checksum, time, messages to send. There are two links: one gets
// all of it, the other is its peer, so that a session comes up first. Nothing may crash, hang, or
// write outside of its data.
//
// An input byte names the step (mod 8), the next its argument n:
//   0, 1  n bytes, unchanged
//   2, 3  a frame of n bytes, checksum (under a key: tag) of the session added
//   4     the same, of the handshake
//   5     n ms pass
//   6     a message of n bytes is sent on channel n mod 4, opened if need be
//   7     n frames of the peer's come through
//
// With -DKEYED both have a key, and the fuzzer knows it.

#include "fuzz_node.h"
#include <cstdint>
#include <cstring>

namespace {

const U8 key[LINK_KEY_BYTES] = {1, 2, 3};

class Machine {
public:
    Machine() {
        for (Node* n : {&a_, &b_}) {
            Link_init(n->link.get(), &port, n, 1440);
#ifdef KEYED
            Link_setKey(n->link.get(), 0, key);
#endif
            Link_start(n->link.get(), now_);
            n->nonce += 77;
        }
        for (int i = 0; i < 3; ++i) {
            pass(400);
            cross(a_, b_, 99);
            cross(b_, a_, 99);
        }
    }
    void run(const uint8_t* p, size_t size) {
        while (size >= 2) {
            uint8_t step = p[0] & 7, n = p[1];
            p += 2;
            size -= 2;
            size_t take = step < 5 ? (n < size ? n : size) : 0;
            Bytes bytes(p, p + take);
            p += take;
            size -= take;
            if (step < 2)
                feed(bytes);
            else if (step < 5)
                feed(frame(bytes, step == 4));
            else if (step == 5)
                pass(n);
            else if (step == 6)
                send(n);
            else
                cross(b_, a_, n);
            a_.busy = n & 0x40 && step == 5;
        }
        a_.busy = false;
        pass(12000);
    }

private:
    // A frame that A takes for its peer's if its contents make sense.
    Bytes frame(Bytes bytes, bool isHandshake) const {
        const size_t most = LINK_MAX_FRAME - a_.link->overhead + LINK_HEADER;
        if (bytes.size() < LINK_HEADER)
            return bytes;
        if (bytes.size() > most)
            bytes.resize(most);
        bytes[0] = static_cast<uint8_t>((bytes[0] & 0x80) | (bytes.size() - LINK_HEADER));
        if (a_.link->overhead != LINK_OVERHEAD)
            return sealed(bytes, isHandshake);
        return checked(bytes, isHandshake ? LINK_NO_SEED : a_.link->session.key);
    }
    // The same under a key. A HELLO is under its own; the others of the handshake are for the
    // nonce of now, from a peer whose nonce is in the input.
    Bytes sealed(Bytes bytes, bool isHandshake) const {
        const Link* link = a_.link.get();
        const U8* under = link->session.keys.receive;
        Link_Keys keys;
        U32 kind = bytes[2] >> 5 & 7;
        U32 number = link->receiver.next, acked = 0;
        if (isHandshake) {
            kind = LINK_KIND_HELLO + kind % 3;
            bytes.resize(LINK_HEADER + (kind == LINK_KIND_HELLO ? 8 : 16));
            bytes[0] = static_cast<uint8_t>(0x80 | (bytes.size() - LINK_HEADER));
            bytes[1] = LINK_VERSION;
            bytes[2] = static_cast<uint8_t>((bytes[2] & 3) | kind << 5);
            under = link->secrets.hello[0];
            if (kind != LINK_KIND_HELLO) {
                std::memcpy(&bytes[LINK_HEADER + 8], link->handshake.nonce, LINK_NONCE_BYTES);
                link_deriveKeys(key, link->handshake.nonce, &bytes[LINK_HEADER], &keys);
                under = keys.receive;
            }
        } else {
            bytes[2] =
                static_cast<uint8_t>((bytes[2] & ~0x1C) | LINK_KEY_EPOCH(link->session.key) << 2);
            if (bytes[0] & LINK_CONTROL) {
                if (kind == LINK_KIND_ACK)
                    number = link->sender.base;
                else if (kind == LINK_KIND_PING)
                    number = bytes[2] & 1 ? link->watch.pingsSent : link->watch.pingsSeen;
                else if (kind >= LINK_KIND_PIGGYBACK && bytes.size() > LINK_HEADER)
                    acked = link_extend(link->sender.base, bytes[LINK_HEADER]);
                if (kind == LINK_KIND_BYE)
                    number = bytes[1];
            }
        }
        number = link_extend(number, bytes[1]);
        const U32 header = bytes[0] | U32(bytes[1]) << 8 | U32(bytes[2]) << 16;
        bytes.resize(bytes.size() + LINK_TAG);
        link_protect(bytes.data(), header, under, number, acked);
        return bytes;
    }
    void feed(const Bytes& bytes) {
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
        Bytes message(n, n);
        Link_Status status = Link_send(a_.link.get(), n % 4, message.data(), n, n);
        if (status == LINK_CLOSED)
            Link_openChannel(a_.link.get(), n % 4);
        if (n == 255)
            Link_closeChannel(a_.link.get(), 3);
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
