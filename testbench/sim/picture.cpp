// SPDX-License-Identifier: MIT
//
// picture: decodes pictures with stb_image, and handles two things that stb_image ignores: the
// orientation in a JPEG file (EXIF 2.3, tag 0x0112), and the maximum of a PNM file (netpbm's
// formats).

#include "picture.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <stdexcept>

#define STB_IMAGE_IMPLEMENTATION
#include <stb/stb_image.h>

namespace {

using Bytes = std::vector<uint8_t>;

// Reads numbers of a file; beyond its end returns 0.
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

// Returns the orientation in an EXIF block, which begins at `at` with a TIFF header; 1: upright.
int orientationAt(const Bytes& file, size_t at) {
    constexpr size_t tag = 0x0112, shortNumber = 3, entryBytes = 12;
    Reader in{file, file.size() > at && file[at] == 'I'};
    if (in.number(at + 2, 2) != 42)
        return 1;
    const size_t directory = at + in.number(at + 4, 4);
    const size_t count = in.number(directory, 2);
    for (size_t i = 0; i < count; ++i) {
        const size_t entry = directory + 2 + i * entryBytes;
        if (entry >= file.size())
            break;
        if (in.number(entry, 2) != tag || in.number(entry + 2, 2) != shortNumber)
            continue;
        const size_t value = in.number(entry + 8, 2);
        return value >= 1 && value <= 8 ? static_cast<int>(value) : 1;
    }
    return 1;
}

// Returns the orientation of a JPEG file by EXIF's numbers, 1 to 8; 1 for other files.
int orientationOf(const Bytes& file) {
    static const char name[] = "Exif\0"; // and a second 0
    constexpr size_t imageData = 0xFFDA, application1 = 0xFFE1;
    const Reader in{file};
    if (in.number(0, 2) != 0xFFD8)
        return 1;
    for (size_t at = 2; at + 4 <= file.size(); at += 2 + in.number(at + 2, 2)) {
        const size_t marker = in.number(at, 2);
        if (marker < 0xFF00 || marker == imageData)
            break;
        if (marker == application1 && at + 10 <= file.size() &&
            std::equal(name, name + sizeof name, file.begin() + std::ptrdiff_t(at) + 4))
            return orientationAt(file, at + 10);
    }
    return 1;
}

// Returns the value of white in a binary PNM file; 255 of other files.
int whiteOf(const Bytes& file) {
    if (file.size() < 2 || file[0] != 'P' || (file[1] != '5' && file[1] != '6'))
        return 255;
    std::string text(file.begin() + 2, file.begin() + std::min<long>(long(file.size()), 4096));
    std::string line, words;
    for (std::istringstream lines(text); std::getline(lines, line);)
        words += line.substr(0, line.find('#')) + " "; // without comments
    int width = 0, height = 0, white = 255;
    std::istringstream(words) >> width >> height >> white;
    return white > 0 ? white : 255;
}

// Returns the picture as EXIF's orientation means it.
Picture turned(const Picture& from, int orientation) {
    const bool isOnItsSide = orientation >= 5;
    Picture to;
    to.width = isOnItsSide ? from.height : from.width;
    to.height = isOnItsSide ? from.width : from.height;
    for (int y = 0; y < to.height; ++y)
        for (int x = 0; x < to.width; ++x) {
            // Position of `from`'s row 0 and column 0: 1 top left, 2 top right, 3 bottom right, 4
            // bottom left, 5 left top, 6 right top, 7 right bottom, 8 left bottom.
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

} // namespace

Picture readPicture(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    const Bytes file((std::istreambuf_iterator<char>(in)), {});
    if (!in.is_open() || in.bad() || file.empty())
        throw std::runtime_error("cannot read picture '" + path + "'");
    const int white = whiteOf(file), size = static_cast<int>(file.size());
    Picture picture;
    int channels = 0;
    const auto keep = [&](const auto* grey) {
        if (!grey)
            throw std::runtime_error("'" + path + "' is not a picture that can be read (" +
                                     stbi_failure_reason() + "): give a PNG, JPEG or PGM file");
        const size_t count = static_cast<size_t>(picture.width) * picture.height;
        for (size_t i = 0; i < count; ++i)
            picture.grey.push_back(
                static_cast<uint8_t>(std::min(255, (grey[i] * 255 + white / 2) / white)));
    };
    if (white > 255) {
        const std::unique_ptr<uint16_t, void (*)(void*)> grey(
            stbi_load_16_from_memory(file.data(), size, &picture.width, &picture.height, &channels,
                                     1),
            stbi_image_free);
        keep(grey.get());
    } else {
        const std::unique_ptr<uint8_t, void (*)(void*)> grey(
            stbi_load_from_memory(file.data(), size, &picture.width, &picture.height, &channels, 1),
            stbi_image_free);
        keep(grey.get());
    }
    const int orientation = orientationOf(file);
    return orientation == 1 ? picture : turned(picture, orientation);
}
