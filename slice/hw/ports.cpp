// SPDX-License-Identifier: MIT
//
// ports: names and directions.

#include "hw/ports.h"
#include "hw/words.h"

namespace hw {

std::vector<Port> wrapperPorts(const Block& b) {
    std::vector<Port> list = {{"clk_i", false, 1, "clock, reset"},
                              {"rst_i", false, 1, ""},
                              {"bus_valid_i", false, 1, "register bus"},
                              {"bus_write_i", false, 1, ""},
                              {"bus_addr_i", false, 4, ""},
                              {"bus_wdata_i", false, 32, ""},
                              {"bus_ready_o", true, 1, ""},
                              {"bus_rdata_o", true, 32, ""},
                              {"bus_error_o", true, 1, ""},
                              {"irq_o", true, 1, "interrupt"},
                              {"core_rst_o", true, 1, "the core's reset"}};
    for (const Call& c : b.calls) {
        if (c.isEvent)
            list.push_back({c.name + "_event_i", false, 1, "event " + c.operation->name});
        else
            list.push_back({c.name + "_start_o", true, 1, c.operation->name});
        for (const Word& w : c.words)
            for (const Piece& p : w.pieces)
                if (p.portLsb == 0) {
                    if (p.isCount)
                        list.push_back({c.name + "_" + baseName(p) + "_o", true, 32, ""});
                    list.push_back({c.name + "_" + p.name + (w.isOut ? "_i" : "_o"), !w.isOut,
                                    p.portWidth, ""});
                }
        if (c.isEvent)
            list.push_back({c.name + "_taken_o", true, 1, ""});
        if (c.isLong) {
            list.push_back({c.name + "_done_i", false, 1, ""});
            list.push_back({c.name + "_refused_i", false, 1, ""});
        }
    }
    return list;
}

} // namespace hw
