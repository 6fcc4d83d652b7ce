// SPDX-License-Identifier: MIT
//
// serial_port: opens a terminal in raw mode, at any baud rate.

#include "serial_port.h"

#include <asm/termbits.h> // defines struct termios2, which allows any rate, including 111,111
#include <cerrno>
#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <system_error>
#include <unistd.h>

namespace XBeeAT {

namespace {

// Returns the process that has locked a file. The kernel releases the lock when the process ends.
int userOf(int fd) {
    struct flock lock{};
    lock.l_type = F_WRLCK;
    return fcntl(fd, F_GETLK, &lock) == 0 && lock.l_type != F_UNLCK ? lock.l_pid : 0;
}

bool isPty(int fd) {
    struct stat node{};
    return fstat(fd, &node) == 0 && major(node.st_rdev) >= 136 && major(node.st_rdev) <= 143;
}

} // namespace

void SerialPort::open(const std::string& device) {
    close();
    fd_ = ::open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    struct flock lock{};
    lock.l_type = F_WRLCK;
    std::string why;
    int error = fd_ < 0 ? errno : 0;
    if (!error && !isatty(fd_)) {
        error = ENOTTY;
        why = ": it is not a serial port";
    } else if (!error && fcntl(fd_, F_SETLK, &lock) != 0) {
        error = EBUSY;
        why = ": process " + std::to_string(userOf(fd_)) + " is using it";
    }
    if (!error) {
        // Exclusive mode also keeps out programs that do not check the lock, such as terminal
        // programs. It is not used for a pty, because the pty would stay in this mode if this
        // process were killed.
        if (!isPty(fd_))
            ioctl(fd_, TIOCEXCL);
        return;
    }
    close();
    throw std::system_error(error, std::generic_category(),
                            "cannot open serial port '" + device + "'" + why);
}

void SerialPort::close() {
    if (fd_ >= 0)
        ::close(fd_);
    fd_ = -1;
}

bool SerialPort::isGone() const {
    pollfd port{fd_, 0, 0};
    return fd_ >= 0 && poll(&port, 1, 0) > 0;
}

ssize_t SerialPort::read(void* bytes, size_t room) {
    ssize_t count = ::read(fd_, bytes, room);
    if (count > 0)
        clock_.hasRead(static_cast<size_t>(count));
    return count;
}

ssize_t SerialPort::write(const void* bytes, size_t size) {
    ssize_t count = ::write(fd_, bytes, size);
    if (count > 0)
        clock_.hasWritten(static_cast<size_t>(count));
    return count;
}

// For a pty, the system always reports an empty queue, so the simulator's number of waiting bytes
// is used.
size_t SerialPort::waiting() const {
    int queued = 0;
    ioctl(fd_, TIOCOUTQ, &queued);
    return static_cast<size_t>(queued) + clock_.waiting();
}

// Reads and drops the bytes that have arrived. TCFLSH cannot be used: clock.h requires a count of
// the bytes read.
void SerialPort::drop() {
    char bytes[256];
    while (read(bytes, sizeof bytes) > 0)
        ;
}

void SerialPort::setSpeed(int baud) {
    termios2 t{};
    if (ioctl(fd_, TCGETS2, &t) != 0)
        return;
    // An idle modem asserts CTS. If CTS is off, the wire is missing, and flow control is not
    // enabled.
    int lines = 0;
    const bool hasCts = ioctl(fd_, TIOCMGET, &lines) == 0 && (lines & TIOCM_CTS);
    t.c_iflag = 0;
    t.c_oflag = 0;
    t.c_lflag = 0;
    t.c_cflag = CS8 | CREAD | CLOCAL | BOTHER | BOTHER << IBSHIFT | (hasCts ? CRTSCTS : 0);
    t.c_ospeed = t.c_ispeed = static_cast<speed_t>(baud == 115200 ? 111111 : baud);
    t.c_cc[VMIN] = 0;
    t.c_cc[VTIME] = 0;
    ioctl(fd_, TCSETS2, &t);
}

} // namespace XBeeAT
