// SPDX-License-Identifier: MIT
//
// passed_proxies: tries to read a proxy at each offset of the parameters, and collects the valid
// ones.

#include "passed_proxies.h"

namespace gateway {

namespace {

// size of the header of an encapsulation (size and encoding), bytes
constexpr size_t head = 6;
// length of the longest accepted name, bytes; up to this length, the encoded length has one byte
constexpr size_t longestName = 254;

// Reads bytes, starting at `at`. Clears isRight if all bytes are already read, or if a byte is
// outside its expected range.
struct Reader {
    const std::vector<Ice::Byte>& bytes;
    size_t at;
    bool isRight = true;

    unsigned byte(unsigned least, unsigned most) {
        const unsigned value = at < bytes.size() ? bytes[at] : 256;
        ++at;
        isRight = isRight && value >= least && value <= most;
        return isRight ? value : 0;
    }
    std::string text(unsigned least) {
        const size_t size = byte(least, longestName);
        isRight = isRight && size <= bytes.size() - at;
        if (!isRight)
            return "";
        at += size;
        return {bytes.begin() + std::ptrdiff_t(at - size), bytes.begin() + std::ptrdiff_t(at)};
    }
};

} // namespace

std::vector<Ice::Identity> passedProxies(const std::vector<Ice::Byte>& encapsulation) {
    std::vector<Ice::Identity> found;
    const bool hasVersions = encapsulation.size() > head && encapsulation[5] != 0;
    for (size_t begin = head; begin < encapsulation.size(); ++begin) {
        Reader in{encapsulation, begin};
        Ice::Identity id;
        id.name = in.text(1);
        id.category = in.text(0);
        for (const char c : id.name + id.category)
            in.isRight = in.isRight && (c < 0 || c >= ' ');
        // Without versions, a short name is rejected; otherwise a row of zeros would look like a
        // proxy.
        in.isRight = in.isRight && (hasVersions || id.name.size() > 3);
        if (in.byte(0, 1))
            in.text(0); // facet
        in.byte(0, 4);  // mode
        in.byte(0, 1);  // security
        if (hasVersions)
            for (const unsigned expected : {1U, 0U, 1U})
                in.byte(expected, expected);
        if (hasVersions)
            in.byte(0, 1);
        in.byte(0, 0); // endpoints
        in.byte(0, 0); // adapter
        if (in.isRight)
            found.push_back(id);
    }
    return found;
}

} // namespace gateway
