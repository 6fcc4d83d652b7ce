// SPDX-License-Identifier: MIT
//
// ports: the head and the ports of a generated wrapper, for both languages.

#ifndef SLICE_HW_PORTS_H
#define SLICE_HW_PORTS_H

#include "hw/map.h"
#include "text/writer.h"

namespace hw {

struct Port {
    std::string name; // with _i or _o
    bool isOut = false;
    unsigned width = 1;
    std::string group; // of the first port of a group: the group's heading
};

std::vector<Port> wrapperPorts(const Block& b);
// Writes a wrapper's first comment; `mark` begins its lines.
void wrapperHead(Writer& w, const Block& b, const std::string& mark);

} // namespace hw

#endif
