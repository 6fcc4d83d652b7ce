// SPDX-License-Identifier: MIT
//
// pty_line: connects the modem's serial side to a pseudo-terminal.

#include "serial_line.h"
#include <algorithm>
// for struct termios2 and TCGETS2, which contain the actual speed, including custom speeds
#include <asm/termbits.h>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <fcntl.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <system_error>
#include <unistd.h>

namespace {

constexpr uint64_t pollNs = 500'000; // interval between two reads of the pty, ns
// shorter interval between two reads, ns, for a program that counts its bytes, so that no byte is
// late
constexpr uint64_t countedPollNs = 100'000;
// maximum number of reads in one call; after that, counted bytes that have not arrived are
// considered read
constexpr int patience = 20'000;

void makeRaw(int fd) {
    termios2 settings{};
    if (ioctl(fd, TCGETS2, &settings) != 0)
        throw std::system_error(errno, std::generic_category(),
                                "cannot read the settings of a pty");
    settings.c_iflag &= ~(IGNBRK | BRKINT | PARMRK | ISTRIP | INLCR | IGNCR | ICRNL | IXON);
    settings.c_oflag &= ~OPOST;
    settings.c_lflag &= ~(ECHO | ECHONL | ICANON | ISIG | IEXTEN);
    settings.c_cflag = (settings.c_cflag & ~(CSIZE | PARENB)) | CS8;
    if (ioctl(fd, TCSETS2, &settings) != 0)
        throw std::system_error(errno, std::generic_category(), "cannot switch a pty to raw mode");
}

} // namespace

PtyLine::PtyLine() {
    master_ = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    char name[128];
    if (master_ < 0 || grantpt(master_) != 0 || unlockpt(master_) != 0 ||
        ptsname_r(master_, name, sizeof name) != 0)
        throw std::system_error(errno, std::generic_category(), "cannot open a pty");
    path_ = name;
    keeper_ = open(name, O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (keeper_ < 0)
        throw std::system_error(errno, std::generic_category(), "cannot open " + path_);
    makeRaw(keeper_);
}

PtyLine::~PtyLine() {
    close(keeper_);
    close(master_);
}

bool PtyLine::speedFits() const {
    termios2 settings{};
    if (ioctl(keeper_, TCGETS2, &settings) != 0)
        return true;
    double modem = 1e9 / bitNs_;
    return std::fabs(settings.c_ospeed - modem) <= 0.045 * modem;
}

// Reads all bytes that the program has written. The kernel needs a moment to move bytes from one
// end of the pty to the other, so this reads again until the counted bytes have arrived.
void PtyLine::readAhead(uint64_t now) {
    uint64_t counter = count_.keeper ? count_.keeper() : 0;
    if (counter != counter_)
        fetched_ = 0;
    counter_ = counter;
    int looks = 0;
    for (; counter && looks < patience; ++looks) {
        uint8_t bytes[512];
        ssize_t count = read(master_, bytes, sizeof bytes);
        if (count > 0) {        // possibly bytes of an earlier program
            if (ahead_.empty()) // the wire was idle until now
                rxFree_ = std::max(rxFree_, static_cast<double>(now));
            ahead_.insert(ahead_.end(), bytes, bytes + count);
            fetched_ += static_cast<uint64_t>(count);
        } else if (fetched_ >= count_.fromProgram()) {
            break;
        } else {
            sched_yield();
        }
    }
    if (looks == patience) // the missing bytes were read during the previous program's session
        fetched_ = std::max(fetched_, count_.fromProgram());
}

size_t PtyLine::fetch(uint8_t* bytes, size_t room) {
    if (ahead_.empty() && !counter_)
        return static_cast<size_t>(std::max<ssize_t>(read(master_, bytes, room), 0));
    size_t count = std::min(room, ahead_.size());
    std::copy_n(ahead_.begin(), count, bytes);
    ahead_.erase(ahead_.begin(), ahead_.begin() + static_cast<ptrdiff_t>(count));
    return count;
}

void PtyLine::readHost(uint64_t now) {
    uint8_t bytes[64];
    // Reads only as many bytes as the wire could have carried until now; flow control applies to
    // the remaining bytes.
    if (!counter_)
        rxFree_ = std::max(rxFree_, static_cast<double>(now) - lookBack());
    size_t room = 0;
    while (room < sizeof bytes &&
           rxFree_ + (static_cast<double>(room) + 1) * 10 * bitNs_ <= static_cast<double>(now))
        ++room;
    if (room == 0)
        return;
    size_t count = fetch(bytes, room);
    if (count == 0)
        return;
    bool fits = speedFits();
    for (size_t i = 0; i < count; ++i) {
        rxFree_ += 10 * bitNs_;
        if (fits)
            client_->fromHost(bytes[i], now);
        else if (i % 2)
            client_->framingError(now);
        else
            client_->fromHost(static_cast<uint8_t>(bytes[i] ^ 0xA5), now);
    }
}

void PtyLine::writeHost(uint64_t now) {
    if (!counter_)
        txFree_ = std::max(txFree_, static_cast<double>(now) - lookBack());
    bool fits = speedFits();
    uint8_t byte;
    while (unwritten_.size() < 4096 && txFree_ + 10 * bitNs_ <= static_cast<double>(now)) {
        txIdle_ = !client_->nextToHost(byte);
        if (txIdle_)
            break;
        txFree_ += 10 * bitNs_;
        unwritten_.push_back(fits ? byte : static_cast<uint8_t>(byte ^ 0x5A));
    }
    if (unwritten_.empty())
        return;
    ssize_t count = write(master_, unwritten_.data(), unwritten_.size());
    if (count <= 0)
        return;
    unwritten_.erase(unwritten_.begin(), unwritten_.begin() + count);
    if (counter_)
        count_.toProgram(counter_, static_cast<size_t>(count));
}

void PtyLine::advance(uint64_t now) {
    if (now < nextPoll_)
        return;
    readAhead(now);
    nextPoll_ = now + (counter_ ? countedPollNs : pollNs);
    if (cts_)
        readHost(now);
    else
        rxFree_ = std::max(rxFree_, static_cast<double>(now));
    writeHost(now);
}

void PtyLine::wake(uint64_t now) {
    if (txFree_ < static_cast<double>(now) && (txIdle_ || !counter_))
        txFree_ = static_cast<double>(now);
    txIdle_ = false;
}
