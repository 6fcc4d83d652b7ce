// SPDX-License-Identifier: MIT
//
// serial_port: the modem's serial port; what goes through it is told to the clock.

#ifndef GROUND_SERIAL_PORT_H
#define GROUND_SERIAL_PORT_H

#include "clock.h"

#include <sys/types.h>

namespace XBeeAT {

class SerialPort {
public:
    explicit SerialPort(Clock& clock) : clock_(clock) {}
    ~SerialPort() { close(); }
    SerialPort(const SerialPort&) = delete;
    SerialPort& operator=(const SerialPort&) = delete;

    bool open(const std::string& device); // false: errno says why
    void close();
    int fd() const { return fd_; }
    // As the system's, without waiting.
    ssize_t read(void* bytes, size_t room);
    ssize_t write(const void* bytes, size_t size);
    void drop(); // what has come by now
    // In baud; a file that is no terminal takes no notice.
    void setSpeed(int baud);

private:
    Clock& clock_;
    int fd_ = -1;
};

} // namespace XBeeAT

#endif
