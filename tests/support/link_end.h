// SPDX-License-Identifier: MIT
//
// link_end: one end of a link for tests. A test derives from it and overrides LinkProgram's
// functions.

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
    // Begins without earlier state. `sixteenUs`: time of 16 characters on the line, us; default:
    // for 111,111 baud.
    void begin(U32 sixteenUs = 1440) {
        const Link_Config config = {linkPort(), linkProgram(), sixteenUs, LINK_USE(*buffers_)};
        Link_init(link(), &config);
    }

private:
    std::unique_ptr<Link> link_{new Link};
    std::unique_ptr<Link_Buffers> buffers_{new Link_Buffers};
};
