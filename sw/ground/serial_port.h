// SPDX-License-Identifier: MIT
//
// serial_port: the serial port of the modem. Reports to the clock how many bytes it reads and
// writes.

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

    // Opens a device. Throws std::system_error if the device cannot be opened, is not a terminal,
    // or is in exclusive use by another process.
    void open(const std::string& device);
    void close();
    int fd() const { return fd_; } // -1 while the port is closed
    // Returns whether the device of the open port has disappeared.
    bool isGone() const;
    // Work like the system calls read and write; never wait.
    ssize_t read(void* bytes, size_t room);
    ssize_t write(const void* bytes, size_t size);
    // Returns the number of written bytes that are not on the line yet, because CTS is off or the
    // line is slower than the program.
    size_t waiting() const;
    void drop(); // drops the bytes that have arrived
    // Sets the baud rate.
    void setSpeed(int baud);

private:
    Clock& clock_;
    int fd_ = -1;
};

} // namespace XBeeAT
