// SPDX-License-Identifier: MIT
//
// link_end: one end of a link, for tests. A test derives a class from it and overrides functions of
// LinkProgram.

#pragma once

#include "link_program.h"
#include <memory>

extern "C" {
#include "link.h"
}

class LinkEnd : public LinkProgram {
public:
    virtual ~LinkEnd() = default;

    Link* link() const { return link_.get(); }
    bool isUp() const { return Link_state(link()) == LINK_STATE_UP; }
    const Link_Statistics& statistics() const { return *Link_statistics(link()); }

protected:
    // Starts the link without earlier state. `sixteenUs` is the time that 16 characters take on the
    // line, us; the default is for 111,111 baud.
    void begin(U32 sixteenUs = 1440) {
        const Link_Config config = {linkPort(), linkProgram(), sixteenUs, LINK_USE(*buffers_)};
        Link_init(link(), &config);
    }

private:
    std::unique_ptr<Link> link_{new Link};
    std::unique_ptr<Link_Buffers> buffers_{new Link_Buffers};
};
