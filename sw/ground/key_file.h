// SPDX-License-Identifier: MIT
//
// key_file: reads the keys of the radio link from a file that only its owner may read. Each line is
//
//   [ADDRESS] KEY [NEXT]      KEY: 32 hexadecimal digits; NEXT: the key that follows it
//
// The line without an address (0x0001) is used for every vehicle without a line, and the line of
// 0xffff for calls to all vehicles; # begins a comment. Keys are never printed.

#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

namespace XBeeAT {

constexpr int everybody = 0xFFFF; // the address of all vehicles

using LinkKey = std::array<unsigned char, 16>;
using LinkKeys = std::vector<LinkKey>; // at most two, the next one first; empty: unencrypted

// Returns the content of a secret's file or pipe (/dev/fd/3). Throws std::runtime_error, with
// advice, if it cannot be read, belongs to another user, or is accessible to others.
std::string readSecret(const std::string& path);

class KeyFile {
public:
    KeyFile() = default; // without keys: communication with every vehicle is unencrypted
    // Reads a file. Throws std::runtime_error, with advice, if readSecret does or if a line is
    // invalid.
    explicit KeyFile(const std::string& path);

    // Returns the keys of a vehicle; throws std::runtime_error if the file has none.
    LinkKeys of(int address) const;

private:
    std::string path_;
    std::map<int, LinkKeys> keys_; // keys by address, or by `anyVehicle`
};

} // namespace XBeeAT
