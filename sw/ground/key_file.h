// SPDX-License-Identifier: MIT
//
// key_file: reads the keys of the radio link from a file that only its owner may read. Each line is
//
//   [ADDRESS] KEY [NEXT]      KEY: 32 hexadecimal digits; NEXT: the key that follows it
//
// ADDRESS is written as 0x0001. A line without an address applies to every vehicle that is not
// listed. The line with 0xffff applies to calls to all vehicles. # begins a comment. Keys are never
// printed.

#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

namespace XBeeAT {

constexpr int everybody = 0xFFFF; // the address of all vehicles

using LinkKey = std::array<unsigned char, 16>;
// at most two keys, the next one before the current one; without keys, communication is unencrypted
using LinkKeys = std::vector<LinkKey>;

// Returns the content of a secret's file or pipe (/dev/fd/3). Throws std::runtime_error, with
// advice, if the file cannot be read, belongs to another user, or is accessible to others.
std::string readSecret(const std::string& path);

class KeyFile {
public:
    KeyFile() = default; // no keys: communication with every vehicle is unencrypted
    // Reads a key file. Throws std::runtime_error, with advice, if readSecret throws it or if a
    // line is invalid.
    explicit KeyFile(const std::string& path);

    // Returns the keys of a vehicle; throws std::runtime_error if the file has none.
    LinkKeys of(int address) const;

private:
    std::string path_;
    std::map<int, LinkKeys> keys_; // keys by address, or by `anyVehicle`
};

} // namespace XBeeAT
