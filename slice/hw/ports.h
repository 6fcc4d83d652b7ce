// SPDX-License-Identifier: MIT
//
// ports: the ports of a generated wrapper, for both languages.

#ifndef SLICE_HW_PORTS_H
#define SLICE_HW_PORTS_H

#include "hw/map.h"

namespace hw {

struct Port {
    std::string name; // with _i or _o
    bool isOut = false;
    unsigned width = 1;
    std::string group; // of the first port of a group: what it belongs to
};

std::vector<Port> wrapperPorts(const Block& b);

} // namespace hw

#endif
