// SPDX-License-Identifier: MIT
//
// fuzz_programs: fuzzes the bytes that a program with the plugin sends, with libFuzzer. The bytes
// arrive in pieces of any size on a socket, and the engine's ProgramConnection splits them into
// messages. Each message must be one that was sent, complete and in order. The replies must also be
// complete messages.
//
// If the lowest bit of the first byte is 1, the program is a server that the UAV has called. Each
// step then has two bytes, its kind (mod 8) and its argument n, and may be followed by data:
//   0, 1  the n bytes that follow are sent
//   2, 3  a message header of kind n mod 5 is sent, then the bytes that follow
//   4     the program gets an answer of n bytes
//   5     the program reads n bytes
//   6     the program sends nothing more
//   7     n tenths of a second pass

#include "ice_header.h"
#include "program_connection.h"
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <sys/socket.h>
#include <unistd.h>

namespace {

using XBeeAT::ProgramConnection;

constexpr U32 longest = 8192;

void expect(bool condition) {
    if (!condition)
        std::abort();
}

class FuzzedConnection {
public:
    explicit FuzzedConnection(bool isServer) {
        expect(socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, ends_) == 0);
        if (isServer) {
            stream_.call();
            stream_.accept(ends_[0], "a server");
        } else {
            stream_.want(ends_[0], "a client");
            stream_.open(now_);
        }
        validatesComeThrough_ = isServer;
    }
    ~FuzzedConnection() { close(ends_[1]); }
    FuzzedConnection(const FuzzedConnection&) = delete;
    FuzzedConnection& operator=(const FuzzedConnection&) = delete;

    void step(int what, size_t n, const U8* bytes, size_t left) {
        if (what == 2 || what == 3) {
            const size_t size = std::min(n, left);
            sendBytes(IceHeader::pack(n % 5, std::vector<U8>(size)).data(), IceHeader::bytes);
        }
        if (what < 4)
            sendBytes(bytes, std::min(n, left));
        else if (what == 4)
            answer(n);
        else if (what == 5)
            readSome(n);
        else if (what == 6)
            shutdown(ends_[1], SHUT_WR);
        else
            now_ += static_cast<U32>(n) * 100'000;
        run();
    }
    void finish() {
        (void)stream_.leave(now_);
        for (int i = 0; i < 300 && !stream_.is(ProgramConnection::State::Closed); ++i) {
            readSome(4096);
            now_ += 100'000;
            stream_.write(now_);
            (void)stream_.beat(now_);
        }
        expect(stream_.is(ProgramConnection::State::Closed));
    }

private:
    void sendBytes(const U8* bytes, size_t size) {
        const ssize_t count = send(ends_[1], bytes, size, MSG_NOSIGNAL);
        if (count > 0)
            sent_.insert(sent_.end(), bytes, bytes + count);
    }
    void answer(size_t n) {
        const auto message = IceHeader::pack(IceHeader::Reply, std::vector<U8>(n, 0x55));
        if (stream_.is(ProgramConnection::State::Open))
            (void)stream_.give(message.data(), static_cast<U32>(message.size()), now_);
    }
    void readSome(size_t n) {
        U8 bytes[4096];
        const ssize_t count = recv(ends_[1], bytes, std::min(n, sizeof bytes), MSG_DONTWAIT);
        if (count > 0)
            got_.insert(got_.end(), bytes, bytes + count);
        while (got_.size() >= IceHeader::bytes) {
            const size_t size = IceHeader::sizeOf(got_.data());
            expect(IceHeader::isValid(got_.data()) && size < 300);
            if (got_.size() < size)
                return;
            got_.erase(got_.begin(), got_.begin() + static_cast<std::ptrdiff_t>(size));
        }
    }
    // Does the work of the engine's thread for this program.
    void run() {
        if (!stream_.is(ProgramConnection::State::Open))
            return;
        pollfd p = stream_.interest(true);
        if (p.fd >= 0 && poll(&p, 1, 0) > 0) {
            if (p.revents & (POLLIN | POLLHUP))
                stream_.read(now_);
            if (p.revents & POLLOUT)
                stream_.write(now_);
        }
        for (;;) {
            const ProgramConnection::Next next = stream_.next(longest);
            skipValidates();
            if (next == ProgramConnection::Next::Senseless) {
                expect(!makesSense());
                return stream_.close();
            }
            if (next == ProgramConnection::Next::None)
                break;
            take();
        }
        (void)stream_.beat(now_);
        (void)stream_.silentUs(now_);
    }
    bool makesSense() const {
        return sent_.size() < IceHeader::bytes ||
               (IceHeader::sizeOf(sent_.data()) >= IceHeader::bytes &&
                IceHeader::sizeOf(sent_.data()) <= longest);
    }
    void skipValidates() {
        while (!validatesComeThrough_ && sent_.size() >= IceHeader::bytes && sent_[8] == 3 &&
               makesSense() && IceHeader::sizeOf(sent_.data()) <= sent_.size())
            sent_.erase(sent_.begin(), sent_.begin() + static_cast<std::ptrdiff_t>(
                                                           IceHeader::sizeOf(sent_.data())));
    }
    void take() {
        const size_t size = stream_.size();
        validatesComeThrough_ = validatesComeThrough_ && sent_[8] != 3;
        expect(size >= IceHeader::bytes && size <= longest && size <= sent_.size());
        expect(std::equal(sent_.begin(), sent_.begin() + static_cast<std::ptrdiff_t>(size),
                          stream_.data()));
        (void)stream_.isCall();
        stream_.taken(now_);
        sent_.erase(sent_.begin(), sent_.begin() + static_cast<std::ptrdiff_t>(size));
    }

    int ends_[2];
    U32 now_ = 0xFFFFF000u;
    bool validatesComeThrough_; // true if the first bytes are the greeting of a server
    std::vector<U8> sent_;      // bytes that were sent and that the engine has not yet processed
    std::vector<U8> got_;
    ProgramConnection stream_;
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    if (size == 0)
        return 0;
    FuzzedConnection world((data[0] & 1) != 0);
    for (size_t at = 1; at + 2 <= size;) {
        const int what = data[at] & 7;
        const size_t n = data[at + 1];
        at += 2;
        world.step(what, n, data + at, size - at);
        if (what < 4)
            at += std::min(n, size - at);
    }
    world.finish();
    return 0;
}
