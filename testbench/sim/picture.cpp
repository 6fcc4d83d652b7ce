// SPDX-License-Identifier: MIT
//
// picture: decodes pictures with stb_image, and handles two properties that stb_image ignores: the
// orientation in a JPEG or PNG file (EXIF 2.3, tag 0x0112), and the largest sample value of a PNM
// file (netpbm's formats).

#include "picture.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>

// The other formats of stb_image are disabled: it accepts a truncated GIF file, and any bytes as a
// TGA file.
#define STBI_ONLY_JPEG
#define STBI_ONLY_PNG
#define STBI_ONLY_PNM
#define STB_IMAGE_IMPLEMENTATION
#include <stb/stb_image.h>

namespace {

using Bytes = std::vector<uint8_t>;

// Reads numbers from a file; reading beyond its end returns 0.
struct Reader {
    const Bytes& file;
    bool isLittle = false;

    size_t number(size_t at, int bytes) const {
        size_t value = 0;
        for (int i = 0; i < bytes; ++i) {
            const size_t from = at + static_cast<size_t>(isLittle ? bytes - 1 - i : i);
            value = value << 8 | (from < file.size() ? file[from] : 0);
        }
        return value;
    }
};

// Returns the orientation in an EXIF block, which begins at `at` with a TIFF header; returns 1
// (upright) if the block contains no orientation.
int orientationAt(const Bytes& file, size_t at) {
    constexpr size_t tag = 0x0112, entryBytes = 12;
    constexpr size_t shortNumber = 3, longNumber = 4; // types of an entry: 16 bits, 32 bits
    Reader in{file, file.size() > at && file[at] == 'I'};
    if (in.number(at + 2, 2) != 42)
        return 1;
    const size_t directory = at + in.number(at + 4, 4);
    const size_t count = in.number(directory, 2);
    for (size_t i = 0; i < count; ++i) {
        const size_t entry = directory + 2 + i * entryBytes;
        if (entry >= file.size())
            break;
        const size_t type = in.number(entry + 2, 2);
        if (in.number(entry, 2) != tag || (type != shortNumber && type != longNumber))
            continue;
        const size_t value = in.number(entry + 8, type == shortNumber ? 2 : 4);
        return value >= 1 && value <= 8 ? static_cast<int>(value) : 1;
    }
    return 1;
}

// Returns the orientation in the chunk eXIf of a PNG file (PNG, third edition).
int orientationOfPng(const Bytes& file) {
    constexpr size_t signatureBytes = 8, exif = 0x65584966;
    constexpr size_t otherBytes = 12; // size, type and checksum of a chunk
    const Reader in{file};
    for (size_t at = signatureBytes; at < file.size(); at += otherBytes + in.number(at, 4))
        if (in.number(at + 4, 4) == exif)
            return orientationAt(file, at + 8);
    return 1;
}

// Returns the EXIF orientation of a JPEG or PNG file, 1 to 8; returns 1 for other files.
int orientationOf(const Bytes& file) {
    static const char name[] = "Exif\0"; // name of the EXIF block: "Exif" and two zero bytes
    constexpr size_t imageData = 0xFFDA, application1 = 0xFFE1;
    const Reader in{file};
    if (in.number(0, 2) == 0x8950)
        return orientationOfPng(file);
    if (in.number(0, 2) != 0xFFD8)
        return 1;
    for (size_t at = 2; at + 4 <= file.size(); at += 2 + in.number(at + 2, 2)) {
        while (in.number(at, 2) == 0xFFFF) // bytes 0xFF may fill the space before a marker
            ++at;
        const size_t marker = in.number(at, 2);
        if (marker < 0xFF00 || marker == imageData)
            break;
        if (marker == application1 && at + 10 <= file.size() &&
            std::equal(name, name + sizeof name, file.begin() + std::ptrdiff_t(at) + 4))
            return orientationAt(file, at + 10);
    }
    return 1;
}

// The header of a binary PNM file.
struct PnmHeader {
    size_t white = 255; // sample value that means white
    size_t end = 0;     // offset of the first sample
    size_t bytes = 0;   // number of bytes of all samples
};

// Returns the header of a binary PNM file; returns the default header for any other file.
PnmHeader pnmHeader(const Bytes& file) {
    PnmHeader header;
    if (file.size() < 2 || file[0] != 'P' || (file[1] != '5' && file[1] != '6'))
        return header;
    size_t at = 2;
    const auto next = [&] { // reads the next number; a comment extends to the end of its line
        for (bool isComment = false; at < file.size(); ++at) {
            isComment = file[at] == '#' || (isComment && file[at] != '\n' && file[at] != '\r');
            if (!isComment && !std::isspace(file[at]))
                break;
        }
        size_t number = 0;
        for (; at < file.size() && std::isdigit(file[at]) && number < 65536; ++at)
            number = 10 * number + (file[at] - '0');
        return number;
    };
    const size_t width = next(), height = next();
    header.white = next();
    header.end = std::min(at + 1, file.size());
    header.bytes = width * height * (file[1] == '6' ? 3 : 1) * (header.white > 255 ? 2 : 1);
    return header;
}

// Converts a PNM file with samples of two bytes to samples of one byte, because stb_image reads the
// two bytes in the wrong order.
Bytes inBytes(const Bytes& file, const PnmHeader& header) {
    const std::string text(file.begin(), file.begin() + std::ptrdiff_t(header.end));
    const size_t white = text.rfind(std::to_string(header.white));
    const std::string first = text.substr(0, white) + "255\n";
    Bytes to(first.begin(), first.end());
    const Reader in{file};
    for (size_t at = header.end; at + 2 <= file.size(); at += 2)
        to.push_back(static_cast<uint8_t>(
            std::min<size_t>(255, (in.number(at, 2) * 255 + header.white / 2) / header.white)));
    return to;
}

// Returns the picture, turned upright according to its EXIF orientation.
Picture turned(const Picture& from, int orientation) {
    const bool isOnItsSide = orientation >= 5;
    Picture to;
    to.width = isOnItsSide ? from.height : from.width;
    to.height = isOnItsSide ? from.width : from.height;
    for (int y = 0; y < to.height; ++y)
        for (int x = 0; x < to.width; ++x) {
            // An orientation states where the first row and the first column of `from` are in the
            // upright picture: 1 top and left, 2 top and right, 3 bottom and right, 4 bottom and
            // left, 5 left and top, 6 right and top, 7 right and bottom, 8 left and bottom.
            const int a = isOnItsSide ? y : x, b = isOnItsSide ? x : y;
            const bool flipsA =
                orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8;
            const bool flipsB =
                orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7;
            to.grey.push_back(
                from.at(flipsA ? from.width - 1 - a : a, flipsB ? from.height - 1 - b : b));
        }
    return to;
}

// Returns the type of a file, determined by its first bytes.
std::string typeOf(const Bytes& file) {
    const auto begins = [&](const char* with) {
        return file.size() >= 4 && std::equal(with, with + std::strlen(with), file.begin(),
                                              [](char a, uint8_t b) { return uint8_t(a) == b; });
    };
    return begins("\xFF\xD8") ? "JPEG" : begins("\x89PNG") ? "PNG" : begins("P5") ? "PGM" : "";
}

// Returns the message for a file that stb_image rejects.
std::string rejected(const std::string& path, const Bytes& file, const char* reason) {
    const std::string type = typeOf(file);
    if (file.size() >= 2 && file[0] == 'P' && file[1] >= '1' && file[1] <= '4')
        return "'" + path + "': expected a binary PGM or PPM file (P5 or P6), got P" +
               char(file[1]) + ": save it again as PNG";
    if (type.empty())
        return "'" + path + "': expected a PNG, JPEG or PGM file";
    // stb_image reports why the last format that it tried failed; this format is PNG.
    const std::string why = type != "PNG" ? "" : reason && *reason ? reason : "no end";
    return "'" + path + "': the " + type + " file is damaged, cut or of an unusual kind" +
           (why.empty() ? "" : " (" + why + ")") + ": save it again as PNG";
}

} // namespace

Picture readPicture(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    if (std::filesystem::is_directory(path))
        throw std::runtime_error("cannot read picture '" + path + "': it is a folder");
    Bytes file((std::istreambuf_iterator<char>(in)), {});
    if (!in.is_open() || in.bad() || file.empty())
        throw std::runtime_error("cannot read picture '" + path + "'");
    PnmHeader header = pnmHeader(file);
    if (header.white == 0 || header.white > 65535)
        throw std::runtime_error("picture '" + path +
                                 "': expected a largest sample value of 1 to 65535, got " +
                                 std::to_string(header.white));
    if (header.bytes > file.size() - header.end) // stb_image would accept a file that is too short
        throw std::runtime_error("picture '" + path + "' is truncated: expected " +
                                 std::to_string(header.bytes) + " bytes of samples, got " +
                                 std::to_string(file.size() - header.end));
    if (header.white > 255) {
        file = inBytes(file, header);
        header.white = 255;
    }
    Picture picture;
    int channels = 0;
    const std::unique_ptr<uint8_t, void (*)(void*)> grey(
        stbi_load_from_memory(file.data(), static_cast<int>(file.size()), &picture.width,
                              &picture.height, &channels, 1),
        stbi_image_free);
    if (!grey || picture.width == 0 || picture.height == 0)
        throw std::runtime_error(rejected(path, file, grey ? "no pixels" : stbi_failure_reason()));
    const size_t count = static_cast<size_t>(picture.width) * picture.height;
    for (size_t i = 0; i < count; ++i)
        picture.grey.push_back(static_cast<uint8_t>(std::min<size_t>(
            255, (grey.get()[i] * size_t{255} + header.white / 2) / header.white)));
    const int orientation = orientationOf(file);
    return orientation == 1 ? picture : turned(picture, orientation);
}
