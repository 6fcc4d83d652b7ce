// SPDX-License-Identifier: MIT
//
// xbee_crypt: encrypts payloads with AES-128 in counter mode as IEEE 802.15.4-2003 defines it
// (security suite AES-CTR, 7.6.2). Frame counter and key sequence counter, five bytes, precede the
// payload, so a packet has room for 95 bytes instead of 100. Integrity is not checked: with a
// wrong key the receiver gets random bytes, not an error.

#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <openssl/evp.h>
#include <stdexcept>
#include <string>
#include <vector>

struct XBeeCrypt {
    using Bytes = std::vector<uint8_t>;
    static constexpr size_t headBytes = 5;
    // Encrypts a payload. `key`: 32 hexadecimal digits, or "" for a key of zeros. `source`: serial
    // number of the sender.
    static Bytes encrypt(const std::string& key, uint64_t source, uint32_t counter,
                         const Bytes& plain) {
        Bytes packet = {static_cast<uint8_t>(counter >> 24), static_cast<uint8_t>(counter >> 16),
                        static_cast<uint8_t>(counter >> 8), static_cast<uint8_t>(counter), 0};
        Bytes secret = stream(key, firstBlock(source, packet.data()), plain.data(), plain.size());
        packet.insert(packet.end(), secret.begin(), secret.end());
        return packet;
    }
    // Returns the payload of a packet; empty if the packet is too short.
    static Bytes decrypt(const std::string& key, uint64_t source, const Bytes& packet) {
        if (packet.size() < headBytes)
            return {};
        return stream(key, firstBlock(source, packet.data()), packet.data() + headBytes,
                      packet.size() - headBytes);
    }

private:
    using Block = std::array<uint8_t, 16>;

    static Block keyOf(const std::string& digits) {
        Block key{};
        for (size_t i = 0; i < digits.size() / 2 && i < key.size(); ++i)
            key[i] = static_cast<uint8_t>(std::stoul(digits.substr(2 * i, 2), nullptr, 16));
        return key;
    }
    // Returns the first counter block: flags, address of the sender, frame counter, key sequence
    // counter, and number of the block, which starts with 1. Each number has its high byte first.
    static Block firstBlock(uint64_t source, const uint8_t* head) {
        Block block{0x82};
        for (size_t i = 0; i < 8; ++i)
            block[1 + i] = static_cast<uint8_t>(source >> (56 - 8 * i));
        for (size_t i = 0; i < headBytes; ++i)
            block[9 + i] = head[i];
        block[15] = 1;
        return block;
    }
    // Encrypts or decrypts; both are the same operation in counter mode.
    static Bytes stream(const std::string& key, const Block& block, const uint8_t* bytes,
                        size_t count) {
        std::unique_ptr<EVP_CIPHER_CTX, decltype(&EVP_CIPHER_CTX_free)> context(
            EVP_CIPHER_CTX_new(), &EVP_CIPHER_CTX_free);
        Bytes out(count);
        int size = 0;
        if (!context ||
            EVP_EncryptInit_ex(context.get(), EVP_aes_128_ctr(), nullptr, keyOf(key).data(),
                               block.data()) != 1 ||
            EVP_EncryptUpdate(context.get(), out.data(), &size, bytes, static_cast<int>(count)) !=
                1)
            throw std::runtime_error("OpenSSL has no AES-128-CTR");
        return out;
    }
};
