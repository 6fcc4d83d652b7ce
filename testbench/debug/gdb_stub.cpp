// SPDX-License-Identifier: MIT
//
// gdb_stub: receives packets "$payload#checksum" from GDB and answers each of them (GDB manual,
// appendix E).

#include "gdb_stub.h"
#include <arpa/inet.h>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <system_error>
#include <unistd.h>

namespace {

// register numbers in the target description that follows
constexpr int xpsrNumber = 25, firstSystemNumber = 26;
constexpr int systemRegisters[] = {CortexM3::Msp,     CortexM3::Psp,       CortexM3::Primask,
                                   CortexM3::Basepri, CortexM3::Faultmask, CortexM3::Control};

std::string description() {
    std::string text = R"(<?xml version="1.0"?><!DOCTYPE target SYSTEM "gdb-target.dtd">)"
                       R"(<target version="1.0"><architecture>arm</architecture>)"
                       R"(<feature name="org.gnu.gdb.arm.m-profile">)";
    const auto reg = [&text](const std::string& name, const std::string& more = "") {
        text += "<reg name=\"" + name + "\" bitsize=\"32\"" + more + "/>";
    };
    for (int n = 0; n <= 12; ++n)
        reg("r" + std::to_string(n));
    reg("sp", R"( type="data_ptr")");
    reg("lr");
    reg("pc", R"( type="code_ptr")");
    reg("xpsr", R"( regnum="25")");
    text += R"(</feature><feature name="org.gnu.gdb.arm.m-system">)";
    reg("msp", R"( type="data_ptr" regnum="26")");
    reg("psp", R"( type="data_ptr")");
    for (const char* name : {"primask", "basepri", "faultmask", "control"})
        reg(name);
    return text + "</feature></target>";
}

std::string hexOf(const void* data, size_t bytes) {
    std::string text;
    for (size_t i = 0; i < bytes; ++i)
        for (unsigned shift : {4, 0})
            text += "0123456789abcdef"[static_cast<const uint8_t*>(data)[i] >> shift & 15];
    return text;
}

std::string bytesOf(const std::string& hex) {
    std::string bytes;
    for (size_t i = 0; i + 1 < hex.size(); i += 2)
        bytes += static_cast<char>(std::strtoul(hex.substr(i, 2).c_str(), nullptr, 16));
    return bytes;
}

uint32_t wordOf(const std::string& hex) {
    const std::string b = bytesOf(hex.substr(0, 8));
    uint32_t value = 0;
    std::memcpy(&value, b.data(), b.size());
    return value;
}

// Converts a register number of GDB to the register's number in CortexM3; returns -1 if CortexM3
// has no such register.
int registerOf(unsigned long number) {
    if (number <= 15)
        return static_cast<int>(number);
    if (number == xpsrNumber)
        return CortexM3::Xpsr;
    unsigned long n = number - firstSystemNumber;
    return number >= firstSystemNumber && n < std::size(systemRegisters) ? systemRegisters[n] : -1;
}

const std::string error = "E01";
constexpr int interrupt = 3; // Ctrl-C
// size of the longest packet, bytes, as reported in qSupported
constexpr size_t longestPacket = 0x4000;

} // namespace

GdbStub::GdbStub(uint16_t port) {
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    at.sin_port = htons(port);
    int on = 1;
    socklen_t size = sizeof at;
    listener_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    if (listener_ < 0 || bind(listener_, reinterpret_cast<sockaddr*>(&at), size) != 0 ||
        listen(listener_, 1) != 0 ||
        getsockname(listener_, reinterpret_cast<sockaddr*>(&at), &size) != 0)
        throw std::system_error(errno, std::generic_category(),
                                "cannot listen on port " + std::to_string(port));
    port_ = ntohs(at.sin_port);
}

GdbStub::~GdbStub() {
    if (connection_ >= 0)
        close(connection_);
    close(listener_);
}

bool GdbStub::accept(const std::function<bool()>& mayWait) {
    pollfd waiting{listener_, POLLIN, 0};
    while (mayWait())
        if (poll(&waiting, 1, 100) > 0) {
            connection_ = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
            int on = 1;
            setsockopt(connection_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
            return connection_ >= 0;
        }
    return false;
}

int GdbStub::nextByte() {
    uint8_t byte;
    ssize_t n;
    do
        n = recv(connection_, &byte, 1, 0);
    while (n < 0 && errno == EINTR);
    return n == 1 ? byte : -1;
}

bool GdbStub::receive(std::string& packet) {
    for (;;) {
        int c;
        do
            c = nextByte();
        while (c == '+' || c == '-' || c == interrupt);
        if (c != '$')
            return false; // the peer has disconnected or uses another protocol
        packet.clear();
        unsigned sum = 0;
        while ((c = nextByte()) >= 0 && c != '#') {
            if (packet.size() == longestPacket)
                return false;
            packet += static_cast<char>(c);
            sum += static_cast<unsigned>(c);
        }
        int high = nextByte(), low = nextByte();
        if (low < 0)
            return false;
        const std::string given{static_cast<char>(high), static_cast<char>(low)};
        bool good = std::strtoul(given.c_str(), nullptr, 16) == (sum & 0xFF);
        if (!noAcknowledgement_)
            (void)!::send(connection_, good ? "+" : "-", 1, MSG_NOSIGNAL);
        if (good)
            return true;
    }
}

void GdbStub::send(const std::string& payload) {
    uint8_t sum = 0;
    for (char c : payload)
        sum = static_cast<uint8_t>(sum + c);
    const std::string packet = "$" + payload + "#" + hexOf(&sum, 1);
    (void)!::send(connection_, packet.data(), packet.size(), MSG_NOSIGNAL);
}

bool GdbStub::wantsStop() {
    if (connection_ < 0) {
        pollfd waiting{listener_, POLLIN, 0};
        return poll(&waiting, 1, 0) > 0;
    }
    // Reads all bytes that have arrived, because other bytes may precede a Ctrl-C or the end of the
    // connection.
    char bytes[4096];
    const ssize_t n = recv(connection_, bytes, sizeof bytes, MSG_DONTWAIT);
    return n > 0 ? std::memchr(bytes, interrupt, static_cast<size_t>(n)) != nullptr
                 : n == 0 || (errno != EAGAIN && errno != EINTR);
}

bool GdbStub::serve(const Target& target, const std::function<bool()>& mayWait) {
    over_ = detached_ = false;
    while (accept(mayWait)) {
        noAcknowledgement_ = false;
        const bool talked = talks(target);
        close(connection_);
        connection_ = -1;
        served_ = served_ || talked;
        if (talked)
            break;
    }
    target.cpu.breakpoints.clear();
    return served_ && !over_;
}

// Sets the time-out for the next packet. The first packet must arrive within 2 s, because a
// debugger sends it at once; later packets have no time-out, because a debugger may be
// silent for hours.
void GdbStub::patient(bool on) {
    timeval limit{on ? 0 : 2, 0};
    setsockopt(connection_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
}

// Handles the packets of a connection until it ends. Returns false if the peer does not use GDB's
// protocol.
bool GdbStub::talks(const Target& target) {
    std::string packet;
    bool talked = false;
    patient(false);
    while (!over_ && !detached_) {
        if (receive(packet))
            send(answer(target, packet));
        else if (talked)
            detached_ = true; // the debugger has disconnected; the program continues
        else
            return false;
        talked = true;
        patient(true);
    }
    return true;
}

std::string GdbStub::answer(const Target& target, const std::string& packet) {
    const std::string rest = packet.empty() ? "" : packet.substr(1);
    switch (packet.empty() ? 0 : packet[0]) {
    case '?':
        return "T05";
    case 'g':
        return readRegisters(target, 0, CortexM3::Xpsr);
    case 'G':
        for (int r = 0; r <= CortexM3::Xpsr && rest.size() >= static_cast<size_t>(8 * r + 8); ++r)
            target.cpu.setReg(r, wordOf(rest.substr(static_cast<size_t>(8 * r))));
        target.changed();
        return "OK";
    case 'p': {
        int r = registerOf(std::strtoul(rest.c_str(), nullptr, 16));
        return r < 0 ? error : readRegisters(target, r, r);
    }
    case 'P': {
        char* end;
        int r = registerOf(std::strtoul(rest.c_str(), &end, 16));
        if (r < 0 || *end != '=')
            return error;
        target.cpu.setReg(r, wordOf(end + 1));
        target.changed();
        return "OK";
    }
    case 'm':
        return readMemory(target, rest);
    case 'M':
        target.changed();
        return writeMemory(target, rest);
    case 'Z':
    case 'z':
        return breakpoint(target, packet);
    case 'c':
        return resume(target, false);
    case 's':
        return resume(target, true);
    case 'b':
        return back(target, packet);
    case 'H':
    case 'T':
        return "OK";
    case 'D':
        detached_ = true;
        return "OK";
    case 'k':
        over_ = true;
        return "OK";
    case 'q':
    case 'Q':
        return query(target, packet);
    default:
        return ""; // not supported
    }
}

std::string GdbStub::query(const Target& target, const std::string& packet) {
    const std::string features = "qXfer:features:read:target.xml:", monitor = "qRcmd,";
    if (packet.rfind("qSupported", 0) == 0)
        return std::string("PacketSize=4000;qXfer:features:read+;QStartNoAckMode+") +
               (target.back ? ";ReverseStep+;ReverseContinue+" : "");
    if (packet == "QStartNoAckMode") {
        noAcknowledgement_ = true;
        return "OK";
    }
    if (packet.rfind("qAttached", 0) == 0)
        return "1";
    if (packet.rfind(features, 0) == 0) {
        unsigned offset = 0, length = 0;
        std::sscanf(packet.c_str() + features.size(), "%x,%x", &offset, &length);
        const std::string all = description();
        if (offset >= all.size())
            return "l";
        return (length >= all.size() - offset ? "l" : "m") + all.substr(offset, length);
    }
    if (packet.rfind(monitor, 0) == 0) {
        std::string command = bytesOf(packet.substr(monitor.size())), text;
        if (command == "reset") {
            target.reset();
            text = "reset\n";
        } else if (command == "info") {
            text = target.describe();
        } else {
            text = "monitor reset: power-on reset of the processor; monitor info: time, cycles, "
                   "last fault\n";
        }
        return hexOf(text.data(), text.size());
    }
    return "";
}

std::string GdbStub::readRegisters(const Target& target, int first, int last) {
    std::string text;
    for (int r = first; r <= last; ++r) {
        const uint32_t value = target.cpu.reg(r);
        text += hexOf(&value, sizeof value);
    }
    return text;
}

std::string GdbStub::readMemory(const Target& target, const std::string& arguments) {
    unsigned address = 0, length = 0;
    if (std::sscanf(arguments.c_str(), "%x,%x", &address, &length) != 2 || length > 0x1000)
        return error;
    std::string bytes(length, 0);
    if (!target.cpu.debugRead(address, bytes.data(), length))
        return error;
    return hexOf(bytes.data(), length);
}

std::string GdbStub::writeMemory(const Target& target, const std::string& arguments) {
    unsigned address = 0, length = 0;
    size_t colon = arguments.find(':');
    if (colon == std::string::npos ||
        std::sscanf(arguments.c_str(), "%x,%x", &address, &length) != 2)
        return error;
    std::string bytes = bytesOf(arguments.substr(colon + 1));
    const bool isHex =
        arguments.find_first_not_of("0123456789abcdefABCDEF", colon + 1) == std::string::npos;
    return isHex && bytes.size() == length && target.cpu.debugWrite(address, bytes.data(), length)
               ? "OK"
               : error;
}

std::string GdbStub::breakpoint(const Target& target, const std::string& packet) {
    unsigned kind = 0, address = 0;
    if (std::sscanf(packet.c_str() + 1, "%u,%x", &kind, &address) != 2 || kind > 1)
        return ""; // an empty answer: watchpoints are not supported, so the debugger steps instead
    if (packet[0] == 'Z')
        target.cpu.breakpoints.insert(address & ~1u);
    else
        target.cpu.breakpoints.erase(address & ~1u);
    return "OK";
}

std::string GdbStub::resume(const Target& target, bool singleStep) {
    CortexM3::Stop why = target.run(singleStep);
    const std::string edge = target.edge();
    if (!edge.empty())
        return "T05replaylog:" + edge + ";";
    if (target.isOver()) {
        over_ = true;
        return "W00"; // the answer if the program has ended
    }
    return why == CortexM3::Stop::Asked ? "T02" : "T05"; // SIGINT, SIGTRAP
}

// Handles "bs" and "bc", the commands for stepping and continuing backwards.
std::string GdbStub::back(const Target& target, const std::string& packet) {
    if (!target.back || (packet != "bs" && packet != "bc"))
        return "";
    target.back(packet == "bs");
    return "T05replaylog:begin;";
}
