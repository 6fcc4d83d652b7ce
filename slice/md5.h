// SPDX-License-Identifier: MIT
//
// md5: the digest of RFC 1321, which Slice checksums are made of. Of no use for security.

#ifndef MD5_H
#define MD5_H

#include <array>
#include <cstdint>
#include <string>

std::array<uint8_t, 16> md5(const std::string& text);

#endif
