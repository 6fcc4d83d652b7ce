// SPDX-License-Identifier: MIT
//
// link_end: one end of a link for tests. A test derives from it and overrides the functions it
// needs.

#pragma once

#include <memory>

extern "C" {
#include "link.h"
}

class LinkEnd {
public:
    LinkEnd() = default;
    virtual ~LinkEnd() = default;
    LinkEnd(const LinkEnd&) = delete;
    LinkEnd& operator=(const LinkEnd&) = delete;

    Link* link() const { return link_.get(); }
    bool isUp() const { return Link_state(link()) == LINK_STATE_UP; }
    const Link_Statistics& statistics() const { return *Link_statistics(link()); }

protected:
    // Begins without earlier state. `sixteenUs`: time of 16 characters on the line, us; default:
    // for 111,111 baud.
    void begin(U32 sixteenUs = 1440) {
        static const Link_Port port = {
            [](void* end, const U8* frame, U32 size) {
                return of(end).transmit(frame, size) ? 0 : 1;
            },
            [](void* end) { return of(end).random(); },
            [](void* end, int channel, const U8* data, U32 size) {
                return of(end).take(channel, data, size) ? 0 : 1;
            },
            [](void* end, int channel, int isOpen) { of(end).onChannel(channel, isOpen != 0); },
            [](void* end, Link_State state) { of(end).onState(state); },
            [](void* end, int channel, U32 tag, Link_Outcome outcome) {
                of(end).onOutcome(channel, tag, outcome);
            },
            [](void* end) { of(end).onWritable(); }};
        const Link_Config config = {&port, this, sixteenUs, LINK_USE(*buffers_)};
        Link_init(link(), &config);
    }

    // Sends a frame. Returns whether there was room.
    virtual bool transmit(const U8* frame, U32 size) = 0;
    virtual U32 random() = 0;
    // Takes a message. Returns false if the link must deliver it again later.
    virtual bool take(int channel, const U8* data, U32 size) {
        (void)channel, (void)data, (void)size;
        return true;
    }
    virtual void onChannel(int channel, bool isOpen) { (void)channel, (void)isOpen; }
    virtual void onState(Link_State state) { (void)state; }
    virtual void onOutcome(int channel, U32 tag, Link_Outcome outcome) {
        (void)channel, (void)tag, (void)outcome;
    }
    virtual void onWritable() {}

private:
    static LinkEnd& of(void* end) { return *static_cast<LinkEnd*>(end); }
    std::unique_ptr<Link> link_{new Link};
    std::unique_ptr<Link_Buffers> buffers_{new Link_Buffers};
};
