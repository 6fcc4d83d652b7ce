// SPDX-License-Identifier: MIT
//
// soc_state: finds the members of Verilator's class in a table made from its header
// (soc_members.awk).

#include "soc_state.h"
#include "VSoc___024root.h"
#include <cstddef>
#include <cstring>

#pragma GCC diagnostic ignored "-Winvalid-offsetof" // one class without bases that matter

namespace {

struct Member {
    size_t offset, size;
    const char* path;
};

const Member members[] = {
#define MEMBER(name, path) {offsetof(VSoc___024root, name), sizeof(VSoc___024root::name), path},
#include "soc_members.inc"
};

} // namespace

SocState::Image SocState::of(const VSoc___024root& root) {
    Image image(sizeof root);
    std::memcpy(image.data(), &root, image.size());
    return image;
}

std::vector<std::string> SocState::differences(const Image& a, const Image& b) {
    std::vector<std::string> paths;
    for (const Member& m : members)
        if (std::memcmp(a.data() + m.offset, b.data() + m.offset, m.size) != 0)
            paths.push_back(m.path);
    return paths;
}
