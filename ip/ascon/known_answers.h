// SPDX-License-Identifier: MIT
//
// known_answers: provides inputs for tests, and the known answers of NIST SP 800-232. A test writes
// all its answers in the format of the published file; the SHA-256 of this text must equal the
// SHA-256 of the published file.

#pragma once

#include "ascon_model.h"
#include <array>
#include <cstdio>
#include <functional>
#include <openssl/sha.h>
#include <string>

// counted() and sixteen() return bytes that count up from `first`: counted() for messages,
// sixteen() for keys. hex() returns bytes as hexadecimal digits.
inline AsconBytes counted(uint8_t first, size_t size) {
    AsconBytes bytes(size);
    for (size_t i = 0; i < size; ++i)
        bytes[i] = static_cast<uint8_t>(first + i);
    return bytes;
}
inline AsconKey sixteen(uint8_t first) {
    AsconKey key;
    for (size_t i = 0; i < key.size(); ++i)
        key[i] = static_cast<uint8_t>(first + i);
    return key;
}
template <class Bytes> std::string hex(const Bytes& bytes) {
    std::string text;
    char digits[3];
    for (uint8_t b : bytes) {
        std::snprintf(digits, sizeof digits, "%02X", b);
        text += digits;
    }
    return text;
}

// SHA-256 of two files in github.com/ascon/ascon-c: crypto_aead/asconaead128,
// LWC_AEAD_KAT_128_128.txt (1089 answers) and crypto_hash/asconhash256, LWC_HASH_KAT_128_256.txt
// (1025 answers).
constexpr char aeadFile[] = "BBBC34692FE05E5FDA0A3B025585622AB3E3747495E5E3655B29AAE8C2A4BD33";
constexpr char hashFile[] = "B7D6FBC51362F0D62BC7E57B21F3E83242983434A7C92320A4956D915749DF17";

inline std::string sha256(const std::string& text) {
    std::array<uint8_t, SHA256_DIGEST_LENGTH> digest;
    SHA256(reinterpret_cast<const uint8_t*>(text.data()), text.size(), digest.data());
    return hex(digest);
}

// Returns the text of the published file of AEAD answers, computed by `seal`. `seal` uses the key
// 00 01 .. and the nonce 10 11 .., and returns the ciphertext followed by the tag.
inline std::string aeadAnswers(const std::function<AsconBytes(const AsconBytes& associated,
                                                              const AsconBytes& message)>& seal) {
    std::string text;
    int count = 0;
    for (size_t size = 0; size <= 32; ++size)
        for (size_t associatedSize = 0; associatedSize <= 32; ++associatedSize) {
            const AsconBytes associated = counted(0x30, associatedSize),
                             message = counted(0x20, size);
            text += "Count = " + std::to_string(++count) + "\nKey = " + hex(counted(0, 16)) +
                    "\nNonce = " + hex(counted(0x10, 16)) + "\nPT = " + hex(message) +
                    "\nAD = " + hex(associated) + "\nCT = " + hex(seal(associated, message)) +
                    "\n\n";
        }
    return sha256(text);
}

inline std::string hashAnswers(const std::function<AsconBytes(const AsconBytes& message)>& hash) {
    std::string text;
    for (size_t size = 0; size <= 1024; ++size)
        text += "Count = " + std::to_string(size + 1) + "\nMsg = " + hex(counted(0, size)) +
                "\nMD = " + hex(hash(counted(0, size))) + "\n\n";
    return sha256(text);
}
