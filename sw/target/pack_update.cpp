// SPDX-License-Identifier: MIT
//
// pack_update: signs a firmware for both slots of a vehicle, or the next list of keys, fills the
// flash of a new vehicle, or writes a firmware's checksum.
//
// A package is, for each slot, the signed header (sw/update/slots.h) and the image linked for it. A
// list of keys is a header alone.

#include "elf_image.h"
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>
#include <limits>
#include <sodium.h>
#include <stdexcept>
#include <sys/stat.h>
#include <unistd.h>

extern "C" {
#include "flash.h"
#include "fpga.h"
#include "loader.h"
}

namespace {

using Bytes = std::vector<uint8_t>;

constexpr char usage[] =
    "Usage: pack_update image NEW.elf VERSION KEYFILE NEW.update\n"
    "       pack_update bitstream NEW.bit VERSION KEYFILE NEW.update\n"
    "       pack_update vehicle LOADER.elf FIRMWARE.elf VERSION KEYFILE FLASH.bin\n"
    "       pack_update fpga GOLDEN.bit VERSION KEYFILE FLASH.bin\n"
    "       pack_update public KEYFILE KEY.pub\n"
    "       pack_update keys NUMBER KEYFILE KEY.pub [SECOND.pub] NEW.update\n"
    "       pack_update stamp FIRMWARE.elf\n"
    "image, bitstream: signs firmware, or the FPGA's .bit or .bin, to be sent to a vehicle.\n"
    "vehicle: the flash of a new vehicle, with boot loader, public key and a confirmed firmware.\n"
    "fpga: the FPGA's, with the bitstream that is always there. KEYFILE is the private key, which "
    "is made,\n"
    "and kept from other users, if there is none. VERSION: 1 to 4294967294.\n"
    "public: writes a key's public half. keys: signs a vehicle's next list of public keys, which "
    "has one or\n"
    "two; NUMBER is the last one's and 1. A new vehicle's has number 1, KEYFILE's and --second's.\n"
    "stamp: writes a firmware's checksum into its file, as the build does.\n"
    "Behind these: --vendor N and --board N (1 and 1), which vehicle and image have in common;\n"
    "--second KEY.pub: a second key, of a new vehicle;\n"
    "--needs VERSION: of the bitstream that a firmware needs, or the firmware that a bitstream "
    "does.\n";

uint32_t board[2] = {1, 1}, needs = 0; // of the command line
std::string second;

[[noreturn]] void fail(const std::string& text) {
    throw std::runtime_error(text);
}

void save(const std::string& path, const Bytes& bytes) {
    std::ofstream out(path, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
    if (!out.flush())
        fail("cannot write '" + path + "'");
}

// Reads the private key of a file, which holds its seed.
struct Keys {
    explicit Keys(const std::string& path) {
        Bytes seed(crypto_sign_SEEDBYTES);
        std::ifstream in(path, std::ios::binary);
        if (in) {
            struct stat found{};
            if (stat(path.c_str(), &found) == 0 && (found.st_mode & 077))
                fail("others may read the private key '" + path + "': chmod 600 '" + path + "'");
            const Bytes file((std::istreambuf_iterator<char>(in)), {});
            if (file.size() != seed.size())
                fail("'" + path + "' is no private key: a file of " + std::to_string(seed.size()) +
                     " bytes is");
            seed = file;
        } else {
            randombytes_buf(seed.data(), seed.size());
            // It takes its name when it is complete: all trees of a user share it.
            std::string beside = path + ".XXXXXX";
            const int out = mkstemp(beside.data()); // mode 0600
            const bool made = out >= 0 &&
                              write(out, seed.data(), seed.size()) == ssize_t(seed.size()) &&
                              close(out) == 0 && link(beside.c_str(), path.c_str()) == 0;
            unlink(beside.c_str());
            if (!made)
                fail("cannot write the private key '" + path + "'");
            std::cout << "pack_update: made a new key pair: " << path
                      << " signs for vehicles that are filled with it\n";
        }
        crypto_sign_seed_keypair(open_.data(), secret.data(), seed.data());
    }
    Bytes open_ = Bytes(crypto_sign_PUBLICKEYBYTES), secret = Bytes(crypto_sign_SECRETKEYBYTES);
};

Bytes readPublic(const std::string& path) {
    Bytes key(crypto_sign_PUBLICKEYBYTES);
    std::ifstream in(path);
    std::string digits;
    size_t size = 0;
    in >> digits;
    if (sodium_hex2bin(key.data(), key.size(), digits.data(), digits.size(), nullptr, &size,
                       nullptr) != 0 ||
        size != key.size() || digits.size() != 2 * size)
        fail("'" + path + "' is no public key: pack_update public makes such a file");
    return key;
}

void savePublic(const std::string& key, const std::string& output) {
    const Bytes open = Keys(key).open_;
    std::string digits(2 * open.size() + 1, '\n');
    sodium_bin2hex(digits.data(), digits.size(), open.data(), open.size());
    digits.back() = '\n';
    save(output, {digits.begin(), digits.end()});
}

uint32_t versionOf(const std::string& text) {
    char* end = nullptr;
    const unsigned long long version = std::strtoull(text.c_str(), &end, 10);
    if (text.empty() || *end || version == 0 || version >= std::numeric_limits<uint32_t>::max())
        fail("version '" + text + "': give 1 to 4294967294");
    return static_cast<uint32_t>(version);
}

Bytes signedHeader(const Slots_Header& header, const Keys& keys) {
    Bytes bytes(sizeof header);
    std::memcpy(bytes.data(), &header, sizeof header);
    crypto_sign_detached(bytes.data() + SLOTS_SIGNED_BYTES, nullptr, bytes.data(),
                         SLOTS_SIGNED_BYTES, keys.secret.data());
    return bytes;
}

// A signed list of one or two public keys.
Bytes listOf(const std::vector<Bytes>& open, uint32_t number, const Keys& signer) {
    Slots_Header list{};
    list.magic = SLOTS_MAGIC;
    list.product = SLOTS_KEYS;
    list.version = number;
    std::copy(std::begin(board), std::end(board), list.board);
    std::fill(std::begin(list.digest), std::end(list.digest), uint8_t{0xFF}); // no key
    for (size_t i = 0; i < open.size(); ++i)
        std::copy(open[i].begin(), open[i].end(), list.digest + i * SLOTS_KEY_BYTES);
    return signedHeader(list, signer);
}

// The signed header of an image for a slot, and the image.
std::pair<Bytes, Bytes> sign(const Bytes& image, const Slots_Layout& layout, uint32_t slot,
                             uint32_t product, uint32_t version, const Keys& keys) {
    Slots_Header header{};
    const uint32_t base = Slots_at(&layout, slot) + SLOTS_IMAGE_AT,
                   room = layout.bytes - SLOTS_IMAGE_AT - (layout.hasGolden ? SLOTS_LOG_BYTES : 0);
    if (image.size() > room)
        fail("the image has " + std::to_string(image.size()) + " bytes, a slot has " +
             std::to_string(room));
    header.magic = SLOTS_MAGIC;
    header.product = product;
    header.version = version;
    header.bytes = static_cast<uint32_t>(image.size());
    header.base = base;
    std::copy(std::begin(board), std::end(board), header.board);
    header.needs = needs;
    crypto_hash_sha512(header.digest, image.data(), image.size());
    return {signedHeader(header, keys), image};
}

std::pair<Bytes, Bytes> sign(const ElfImage& elf, uint32_t slot, uint32_t version,
                             const Keys& keys) {
    const Bytes image = elf.movedTo(FLASH_BASE + Slots_at(&slots_firmware, slot) + SLOTS_IMAGE_AT);
    return sign(image, slots_firmware, slot, LOADER_PRODUCT, version, keys);
}

constexpr uint8_t sync[] = {0xAA, 0x99, 0x55, 0x66};

// Reads a bitstream from SLOTS_SYNC_AT bytes before its sync word on, without that word: the
// vehicle adds it.
Bytes readBitstream(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    const Bytes file((std::istreambuf_iterator<char>(in)), {});
    const auto end =
        file.begin() + static_cast<std::ptrdiff_t>(std::min<size_t>(file.size(), 4096));
    const auto found = std::search(file.begin(), end, std::begin(sync), std::end(sync));
    if (found == end)
        fail("'" + path +
             "' is no bitstream: a .bit or .bin by BitGen has a sync word, AA 99 55 66");
    Bytes bits(SLOTS_SYNC_AT, 0xFF);
    bits.insert(bits.end(), found, file.end());
    std::fill_n(bits.begin() + SLOTS_SYNC_AT, sizeof sync, uint8_t{0xFF});
    bits.resize((bits.size() + 3) / 4 * 4, 0xFF);
    return bits;
}

void packBitstream(const std::string& path, uint32_t version, const std::string& key,
                   const std::string& output) {
    auto [header, image] =
        sign(readBitstream(path), slots_fpga, 1, FPGA_PRODUCT, version, Keys(key));
    header.insert(header.end(), image.begin(), image.end());
    save(output, header);
}

// The header at address 0 sends the FPGA to slot 1, and if that fails to slot 0 (UG380, chapter 7).
void fillFpga(const std::string& path, uint32_t version, const std::string& key,
              const std::string& output) {
    Bytes flash(2 << 20, 0xFF);
    const uint32_t slots[2] = {Slots_at(&slots_fpga, 0), Slots_at(&slots_fpga, 1)},
                   next = slots[1] + SLOTS_IMAGE_AT, golden = slots[0] + SLOTS_IMAGE_AT,
                   read = 0x0300;                          // the flash's instruction
    const uint32_t words[] = {0xAA99, 0x5566,              // sync word
                              0x3261, next & 0xFFFF,       // GENERAL1
                              0x3281, read | next >> 16,   // GENERAL2
                              0x32A1, golden & 0xFFFF,     // GENERAL3
                              0x32C1, read | golden >> 16, // GENERAL4
                              0x30A1, 0x000E,              // CMD: IPROG
                              0x2000, 0x2000};             // no operation
    auto at = flash.begin() + SLOTS_SYNC_AT;
    for (uint32_t word : words) {
        *at++ = static_cast<uint8_t>(word >> 8);
        *at++ = static_cast<uint8_t>(word);
    }
    const auto [header, image] =
        sign(readBitstream(path), slots_fpga, 0, FPGA_PRODUCT, version, Keys(key));
    std::copy(header.begin(), header.end(), flash.begin() + slots[0]);
    std::copy(image.begin(), image.end(), flash.begin() + golden);
    std::copy(std::begin(sync), std::end(sync), flash.begin() + golden + SLOTS_SYNC_AT);
    const uint32_t isTrue = SLOTS_TRUE;
    std::memcpy(&flash[slots[0] + SLOTS_CONFIRMED], &isTrue, sizeof isTrue);
    save(output, flash);
}

void packImage(const std::string& elf, uint32_t version, const std::string& key,
               const std::string& output) {
    const ElfImage firmware(elf);
    const Keys keys(key);
    Bytes all;
    for (uint32_t slot = 0; slot < SLOTS_COUNT; ++slot) {
        const auto [header, image] = sign(firmware, slot, version, keys);
        all.insert(all.end(), header.begin(), header.end());
        all.insert(all.end(), image.begin(), image.end());
    }
    save(output, all);
}

void fillVehicle(const std::string& loader, const std::string& elf, uint32_t version,
                 const std::string& key, const std::string& output) {
    const ElfImage firmware(elf), boot(loader);
    const Keys keys(key);
    Bytes flash(1 << 20, 0xFF);
    const auto put = [&flash](size_t offset, const Bytes& bytes) {
        if (offset + bytes.size() > flash.size())
            fail("the boot loader does not fit into flash");
        std::copy(bytes.begin(), bytes.end(), flash.begin() + static_cast<std::ptrdiff_t>(offset));
    };
    for (const ElfImage::Segment& s : boot.segments())
        put(s.address - FLASH_BASE, s.bytes);
    std::vector<Bytes> open = {keys.open_};
    if (!second.empty())
        open.push_back(readPublic(second));
    put(SLOTS_KEYS_AT, listOf(open, 1, keys));
    const auto [header, image] = sign(firmware, 0, version, keys);
    put(Slots_at(&slots_firmware, 0), header);
    put(Slots_at(&slots_firmware, 0) + SLOTS_IMAGE_AT, image);
    const uint32_t isTrue = SLOTS_TRUE;
    for (uint32_t state : {SLOTS_READY, SLOTS_TRIED, SLOTS_CONFIRMED})
        std::memcpy(&flash[Slots_at(&slots_firmware, 0) + state], &isTrue, sizeof isTrue);
    save(output, flash);
}

} // namespace

int main(int argc, char** argv) {
    std::vector<std::string> word(argv + 1, argv + argc);
    try {
        while (word.size() > 2 && word[word.size() - 2].rfind("--", 0) == 0) {
            const std::string option = word[word.size() - 2];
            uint32_t* to = option == "--vendor"  ? &board[0]
                           : option == "--board" ? &board[1]
                           : option == "--needs" ? &needs
                                                 : nullptr;
            if (option == "--second")
                second = word.back();
            else if (!to)
                fail("there is no option '" + option + "'");
            else
                *to = versionOf(word.back());
            word.resize(word.size() - 2);
        }
        if (sodium_init() < 0)
            fail("libsodium does not start");
        if (word.size() == 5 && word[0] == "image")
            packImage(word[1], versionOf(word[2]), word[3], word[4]);
        else if (word.size() == 5 && word[0] == "bitstream")
            packBitstream(word[1], versionOf(word[2]), word[3], word[4]);
        else if (word.size() == 5 && word[0] == "fpga")
            fillFpga(word[1], versionOf(word[2]), word[3], word[4]);
        else if (word.size() == 3 && word[0] == "public")
            savePublic(word[1], word[2]);
        else if (word.size() == 2 && word[0] == "stamp")
            ElfImage(word[1]).stamp();
        else if ((word.size() == 5 || word.size() == 6) && word[0] == "keys") {
            std::vector<Bytes> open;
            for (size_t i = 3; i + 1 < word.size(); ++i)
                open.push_back(readPublic(word[i]));
            save(word.back(), listOf(open, versionOf(word[1]), Keys(word[2])));
        } else if (word.size() == 6 && word[0] == "vehicle")
            fillVehicle(word[1], word[2], versionOf(word[3]), word[4], word[5]);
        else {
            const bool asked = word.size() == 1 && word[0] == "--help";
            (asked ? std::cout : std::cerr) << usage;
            return asked ? 0 : 2;
        }
    } catch (const std::exception& e) {
        std::cerr << "pack_update: error: " << e.what() << "\n";
        return 1;
    }
    return 0;
}
