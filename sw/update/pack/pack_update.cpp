// SPDX-License-Identifier: MIT
//
// pack_update: makes signed packages for a vehicle: firmware for both of its slots, or a new list
// of keys. It also writes the flash contents of a new vehicle, and the checksum of a firmware.
//
// A package contains, for each slot, the signed header (sw/update/slots.h) and the image that is
// linked for this slot. A package with a list of keys contains only a header.

#include "elf_image.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <functional>
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

uint32_t board[2] = {1, 1}, needs = 0; // values of the options --board and --needs
std::string second;
bool isUnchecked = false;

[[noreturn]] void fail(const std::string& text) {
    throw std::runtime_error(text);
}

// Throws if an output file is also an input, because a private key would then be overwritten.
void checkOutput(const std::string& output, const std::vector<std::string>& inputs) {
    namespace fs = std::filesystem;
    for (const std::string& input : inputs) {
        // if a file does not exist, `equivalent` sets an error, which is ignored
        std::error_code none;
        if (input.empty() || output.empty())
            continue; // these options do not name files
        if (fs::absolute(input).lexically_normal() == fs::absolute(output).lexically_normal() ||
            fs::equivalent(input, output, none))
            fail("'" + output + "': expected an output file that is not also an input");
    }
}

void save(const std::string& path, const Bytes& bytes) {
    std::ofstream out(path, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
    if (!out.flush())
        fail("cannot write '" + path + "'");
}

// Reads the seed of a private key. Returns false if the file does not exist.
bool readSeed(const std::string& path, Bytes& seed) {
    // O_NONBLOCK, because opening a pipe would otherwise wait for a writer
    const int in = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (in < 0 && errno == ENOENT)
        return false;
    if (in < 0)
        fail("cannot read the private key '" + path + "': " + std::strerror(errno));
    struct stat found{};
    const bool isFile = fstat(in, &found) == 0 && S_ISREG(found.st_mode);
    const bool isWhole = isFile && found.st_size == off_t(seed.size()) &&
                         read(in, seed.data(), seed.size()) == ssize_t(seed.size());
    close(in);
    if (!isFile)
        fail("the private key '" + path + "': expected a regular file");
    if (found.st_mode & 077)
        fail("other users may read the private key '" + path + "': chmod 600 '" + path + "'");
    if (!isWhole)
        fail("'" + path + "' is not a private key: expected " + std::to_string(seed.size()) +
             " bytes, got " + std::to_string(found.st_size));
    return true;
}

// A private key, which is read from a file that contains its seed. If the file does not exist,
// creates a key and the file.
struct Keys {
    explicit Keys(const std::string& path) {
        Bytes seed(crypto_sign_SEEDBYTES);
        if (!readSeed(path, seed)) {
            randombytes_buf(seed.data(), seed.size());
            // The file gets its final name only when it is complete: all source trees of a user
            // share this file, so several runs may use it at the same time.
            std::string temporary = path + ".XXXXXX";
            const int out = mkstemp(temporary.data()); // mode 0600
            const bool made = out >= 0 &&
                              write(out, seed.data(), seed.size()) == ssize_t(seed.size()) &&
                              close(out) == 0 && link(temporary.c_str(), path.c_str()) == 0;
            const int why = errno;
            unlink(temporary.c_str());
            if (made)
                std::cout << "pack_update: created a new key pair: " << path
                          << " signs images for vehicles whose flash was filled with this key\n";
            else if (why != EEXIST ||
                     !readSeed(path, seed)) // another process has created the file in the meantime
                fail("cannot write the private key '" + path + "'");
        }
        crypto_sign_seed_keypair(open_.data(), secret.data(), seed.data());
    }
    Bytes open_ = Bytes(crypto_sign_PUBLICKEYBYTES), secret = Bytes(crypto_sign_SECRETKEYBYTES);
};

Bytes readPublic(const std::string& path) {
    Bytes key(crypto_sign_PUBLICKEYBYTES);
    if (std::filesystem::exists(path) && !std::filesystem::is_regular_file(path))
        fail("the public key '" + path + "' is not a regular file");
    std::ifstream in(path);
    std::string digits;
    size_t size = 0;
    in >> digits;
    if (sodium_hex2bin(key.data(), key.size(), digits.data(), digits.size(), nullptr, &size,
                       nullptr) != 0 ||
        size != key.size() || digits.size() != 2 * size)
        fail("'" + path + "': expected a public key, as written by pack_update public");
    return key;
}

void savePublic(const std::string& key, const std::string& output) {
    const Bytes open = Keys(key).open_;
    std::string digits(2 * open.size() + 1, '\n');
    sodium_bin2hex(digits.data(), digits.size(), open.data(), open.size());
    digits.back() = '\n';
    save(output, {digits.begin(), digits.end()});
}

// Converts a version number; only digits are allowed. (std::stoull would also accept spaces and a
// sign.)
uint32_t versionOf(const std::string& text) {
    const bool isNumber = !text.empty() && text.size() <= 10 &&
                          text.find_first_not_of("0123456789") == std::string::npos;
    const unsigned long long version = isNumber ? std::stoull(text) : 0;
    if (version == 0 || version >= std::numeric_limits<uint32_t>::max())
        fail("version: expected 1 to 4294967294, got '" + text + "'");
    return static_cast<uint32_t>(version);
}

Bytes signedHeader(const Slots_Header& header, const Keys& keys) {
    Bytes bytes(sizeof header);
    std::memcpy(bytes.data(), &header, sizeof header);
    crypto_sign_detached(bytes.data() + SLOTS_SIGNED_BYTES, nullptr, bytes.data(),
                         SLOTS_SIGNED_BYTES, keys.secret.data());
    return bytes;
}

// Returns a signed list that contains one or two public keys.
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

// Returns the signed header for an image in a slot, and the image.
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

// Reads the words of a bitstream that follow its sync word (UG380, tables 5-23 to 5-30).
class Packets {
public:
    Packets(const Bytes& file, size_t at) : file_(file), at_(at) {}
    // Skips to the end of the last packet, which is the command DESYNC. Returns false if this
    // packet is missing.
    bool toDesync() {
        while (at_ + 2 <= file_.size()) {
            const uint32_t head = word(), type = head >> 13, reg = head >> 5 & 63;
            if (type == 1 && (head >> 11 & 3) == 0)
                continue; // skips a no-operation word
            if ((type != 1 && type != 2) || (head >> 11 & 3) != write)
                return false;
            size_t words = head & 31;
            if (type == 2)
                words = size_t{word()} << 16 | word();
            if (reg == fdri)
                words += 2; // this packet has two more words, which contain its CRC
            if (words > (file_.size() - std::min(at_, file_.size())) / 2)
                return false;
            const bool isCommand = type == 1 && reg == cmd && words == 1;
            if (isCommand && word() == desync)
                return true;
            at_ += 2 * (words - isCommand);
        }
        return false;
    }
    // Returns the number of bytes that follow in the file, not counting no-operation words and
    // erased flash.
    size_t rest() {
        size_t end = file_.size();
        while (at_ + 2 <= end && file_[at_] == 0x20 && file_[at_ + 1] == 0)
            at_ += 2;
        while (end > at_ && (file_[end - 1] == 0xFF ||
                             (end - at_ >= 2 && file_[end - 2] == 0x20 && file_[end - 1] == 0)))
            end -= file_[end - 1] == 0xFF ? 1 : 2;
        return end - at_;
    }

private:
    enum : uint32_t { write = 2, fdri = 3, cmd = 5, desync = 13 };
    uint32_t word() {
        at_ += 2;
        return at_ <= file_.size() ? uint32_t{file_[at_ - 2]} << 8 | file_[at_ - 1] : 0;
    }
    const Bytes& file_;
    size_t at_;
};

// Throws if a bitstream is incomplete, or if other bytes follow it. With an incomplete bitstream,
// the vehicle's FPGA would hang. BitGen appends no bytes.
void checkWhole(const std::string& path, const Bytes& file, size_t at) {
    Packets packets(file, at);
    if (!packets.toDesync())
        fail("'" + path +
             "' is truncated or damaged: expected a bitstream that ends with the command DESYNC, "
             "got " +
             std::to_string(file.size()) + " bytes without it");
    if (const size_t rest = packets.rest())
        fail("'" + path + "' has " + std::to_string(rest) +
             " bytes after the end of the bitstream: expected none");
}

// Throws if the number of bytes in a .bit file differs from field 'e' in its header (the format of
// Xilinx's BitGen).
void checkHeader(const std::string& path, const Bytes& file) {
    const auto number = [&](size_t at, size_t bytes) {
        size_t value = 0;
        for (size_t i = 0; i < bytes; ++i)
            value = value << 8 | (at + i < file.size() ? file[at + i] : 0);
        return value;
    };
    if (number(0, 2) != 9)
        return; // a .bin file has no header
    size_t at = 13;
    for (; at + 3 <= file.size() && file[at] >= 'a' && file[at] < 'e'; at += 3 + number(at + 1, 2))
        ;
    if (at + 5 > file.size() || file[at] != 'e')
        return;
    const size_t follow = file.size() - at - 5;
    if (number(at + 1, 4) != follow)
        fail("'" + path + "': expected " + std::to_string(number(at + 1, 4)) +
             " bytes of bitstream, as its header states, got " + std::to_string(follow));
}

// Reads a bitstream, from SLOTS_SYNC_AT bytes before its sync word. The sync word is replaced by
// erased flash; the vehicle writes it later.
Bytes readBitstream(const std::string& path) {
    const Bytes file = readBytes("bitstream", path);
    const auto end =
        file.begin() + static_cast<std::ptrdiff_t>(std::min<size_t>(file.size(), 4096));
    const auto found = std::search(file.begin(), end, std::begin(sync), std::end(sync));
    if (found == end)
        fail("'" + path +
             "': expected a .bit or .bin file from BitGen, got no sync word (AA 99 55 66)");
    if (!isUnchecked) {
        checkHeader(path, file);
        checkWhole(path, file, static_cast<size_t>(found - file.begin()) + sizeof sync);
    }
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

// Writes the contents of the FPGA's flash for a new vehicle. The header at address 0 makes the FPGA
// load slot 1; if this fails, the FPGA loads slot 0 (UG380, chapter 7).
void fillFpga(const std::string& path, uint32_t version, const std::string& key,
              const std::string& output) {
    Bytes flash(2 << 20, 0xFF);
    const uint32_t slots[2] = {Slots_at(&slots_fpga, 0), Slots_at(&slots_fpga, 1)},
                   next = slots[1] + SLOTS_IMAGE_AT, golden = slots[0] + SLOTS_IMAGE_AT,
                   read = 0x0300;                          // read command of the flash
    const uint32_t words[] = {0xAA99, 0x5566,              // sync word
                              0x3261, next & 0xFFFF,       // GENERAL1
                              0x3281, read | next >> 16,   // GENERAL2
                              0x32A1, golden & 0xFFFF,     // GENERAL3
                              0x32C1, read | golden >> 16, // GENERAL4
                              0x30A1, 0x000E,              // CMD: IPROG
                              0x2000, 0x2000};             // no-operation words
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
    CLI::App app{
        "Signs firmware and bitstreams that are sent to a vehicle, and makes the flash contents\n"
        "of a new vehicle. KEYFILE is the private key; if it does not exist, it is created,\n"
        "readable only by you. VERSION is 1 to 4294967294; a vehicle only accepts a higher\n"
        "version than its confirmed one.",
        "pack_update"};
    std::vector<std::string> word;
    const auto add = [&](const char* name, const char* names, int least, int most, const char* what,
                         const std::function<void()>& run) {
        CLI::App* command = app.add_subcommand(name, what)->fallthrough();
        command->add_option("words", word, names)->required()->expected(least, most);
        command->callback([&, run] {
            std::vector<std::string> inputs(word.begin(), word.end() - 1);
            if (!second.empty())
                inputs.push_back(second);
            checkOutput(word.back(), inputs);
            run();
        });
    };
    const auto number = [&](const char* name, uint32_t& to, const char* what) {
        app.add_option_function<std::string>(
            name, [&to](const std::string& text) { to = versionOf(text); }, what);
    };
    add("image", "NEW.elf VERSION KEYFILE NEW.update", 4, 4, "signs firmware",
        [&] { packImage(word[0], versionOf(word[1]), word[2], word[3]); });
    add("bitstream", "NEW.bit VERSION KEYFILE NEW.update", 4, 4,
        "signs a bitstream of the FPGA, a .bit or .bin file",
        [&] { packBitstream(word[0], versionOf(word[1]), word[2], word[3]); });
    add("vehicle", "LOADER.elf FIRMWARE.elf VERSION KEYFILE FLASH.bin", 5, 5,
        "makes the flash of a new vehicle: boot loader, public key, confirmed firmware",
        [&] { fillVehicle(word[0], word[1], versionOf(word[2]), word[3], word[4]); });
    add("fpga", "GOLDEN.bit VERSION KEYFILE FLASH.bin", 4, 4,
        "makes the flash of the FPGA, with the golden bitstream, which is never replaced",
        [&] { fillFpga(word[0], versionOf(word[1]), word[2], word[3]); });
    add("public", "KEYFILE KEY.pub", 2, 2, "writes the public key of a private key",
        [&] { savePublic(word[0], word[1]); });
    add("keys", "NUMBER KEYFILE KEY.pub [SECOND.pub] NEW.update", 4, 5,
        "signs the next list of public keys; NUMBER is the previous list's number plus 1 (1 "
        "for a new vehicle)",
        [&] {
            std::vector<Bytes> open;
            std::transform(word.begin() + 2, word.end() - 1, std::back_inserter(open), readPublic);
            save(word.back(), listOf(open, versionOf(word[0]), Keys(word[1])));
        });
    add("stamp", "FIRMWARE.elf", 1, 1,
        "writes the checksum of a firmware into its file; the build does this",
        [&] { ElfImage(word[0]).stamp(); });
    number("--vendor", board[0],
           "vendor of the board, which must match the vehicle's, 1 to 4294967294 (default 1)");
    number("--board", board[1],
           "type of the board, which must match the vehicle's, 1 to 4294967294 (default 1)");
    number("--needs", needs,
           "lowest version of the bitstream that a firmware needs, or of the firmware that a "
           "bitstream needs (default: any)");
    app.add_option("--second", second,
                   "file with the second public key of a new vehicle (default: none)");
    app.add_flag("--unchecked", isUnchecked,
                 "sign a bitstream even if it is truncated or has bytes after its end");
    app.footer("examples:\n"
               "  pack_update image uav.elf 7 update.key new.update\n"
               "  pack_update bitstream chip.bit 7 update.key --needs 5 new.update\n"
               "  pack_update vehicle loader.elf uav.elf 1 update.key flash.bin");
    app.require_subcommand(1);
    try {
        if (sodium_init() < 0)
            fail("libsodium cannot be initialised");
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) ? 2 : 0;
    } catch (const std::exception& e) {
        std::cerr << "pack_update: error: " << e.what() << "\n";
        return 1;
    }
    return 0;
}
