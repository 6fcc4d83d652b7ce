// SPDX-License-Identifier: MIT
//
// serial_port: the modem's serial port; the clock counts its bytes.

#pragma once

#include "clock.h"

#include <string>
#include <sys/types.h>

namespace XBeeAT {

class SerialPort {
public:
    explicit SerialPort(Clock& clock) : clock_(clock) {}
    ~SerialPort() { close(); }
    SerialPort(const SerialPort&) = delete;
    SerialPort& operator=(const SerialPort&) = delete;

    // Throws std::system_error, also if it is not a terminal or another process has opened it for
    // exclusive use.
    void open(const std::string& device);
    void close();
    int fd() const { return fd_; }
    // Work as the system's read and write do; never wait.
    ssize_t read(void* bytes, size_t room);
    ssize_t write(const void* bytes, size_t size);
    // Returns the number of bytes written but not sent yet: CTS is off, or the line is slower.
    size_t waiting() const;
    void drop(); // throws away the bytes that have arrived
    // Sets the rate, in baud.
    void setSpeed(int baud);

private:
    Clock& clock_;
    int fd_ = -1;
};

} // namespace XBeeAT
