// SPDX-License-Identifier: MIT
//
// fuzz_gdb: fuzzes the GDB stub with libFuzzer. Nothing may crash or hang, whatever a debugger
// sends.
//
// Each line of an input is a packet, to which the frame and the checksum are added. A line that
// begins with ! is sent unchanged. The processor does not run: "continue" stops at once.

#include "gdb_stub.h"
#include <arpa/inet.h>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>
#include <utility>

namespace {

class Nobody : public CpuBus {
public:
    uint32_t read(uint32_t, unsigned) override { throw Error("no device at this address"); }
    void write(uint32_t, unsigned, uint32_t) override { throw Error("no device at this address"); }
    void pass(unsigned) override {}
    unsigned takeWaited() override { return 0; }
};

std::string framed(const std::string& line) {
    if (!line.empty() && line[0] == '!')
        return line.substr(1);
    unsigned sum = 0;
    for (char c : line)
        sum += static_cast<uint8_t>(c);
    const char* const digits = "0123456789abcdef";
    return "$" + line + "#" + digits[sum >> 4 & 15] + digits[sum & 15];
}

int connected(uint16_t port) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    to.sin_port = htons(port);
    const int fd = socket(AF_INET, SOCK_STREAM, 0);
    // A long run makes 500 connections per second, and may use up the ports of the machine for some
    // time; then connecting is repeated.
    while (connect(fd, reinterpret_cast<sockaddr*>(&to), sizeof to) != 0) {
        if (errno != EADDRNOTAVAIL) {
            perror("fuzz_gdb: cannot connect to the stub");
            abort();
        }
        usleep(10'000);
    }
    return fd;
}

} // namespace

// Unicorn 2.1 leaks 32 bytes, which must not be reported.
extern "C" const char* __lsan_default_suppressions() {
    return "leak:libunicorn\n";
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    static Nobody bus;
    static CortexM3 cpu(bus, CortexM3::Config(), {{0x60000000, 0x1000}});
    static GdbStub stub(0);
    const GdbStub::Target target{cpu,
                                 [](bool) { return CortexM3::Stop::Breakpoint; },
                                 [] {},
                                 [] { return false; },
                                 [] { return std::string("nothing\n"); },
                                 [](bool) {}};
    std::string bytes, line;
    for (size_t i = 0; i <= size; ++i)
        if (i == size || data[i] == '\n') {
            bytes += framed(line);
            line.clear();
        } else {
            line += static_cast<char>(data[i]);
        }
    const int fd = connected(stub.port());
    (void)!send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    shutdown(fd, SHUT_WR);
    bool isNew = true;
    stub.serve(target, [&] { return std::exchange(isNew, false); });
    const linger reset{1, 0}; // closes the connection by a reset, so that the port is free at once
    setsockopt(fd, SOL_SOCKET, SO_LINGER, &reset, sizeof reset);
    close(fd);
    return 0;
}
