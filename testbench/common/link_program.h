// SPDX-License-Identifier: MIT
//
// link_program: offers the functions that a link layer calls (Link_Port) as virtual functions. A
// class that uses a link derives from LinkProgram, overrides the functions that it needs, and
// passes linkPort() and linkProgram() to the link's configuration.

#pragma once

extern "C" {
#include "link_port.h"
}

class LinkProgram {
public:
    LinkProgram() = default;
    LinkProgram(const LinkProgram&) = delete;
    LinkProgram& operator=(const LinkProgram&) = delete;

    // Returns the value for Link_Config.port; Link_Config.context is linkProgram().
    static const Link_Port* linkPort() {
        static const Link_Port port = {
            [](void* c, const U8* frame, U32 size) { return of(c).transmit(frame, size) ? 0 : 1; },
            [](void* c) { return of(c).random(); },
            [](void* c, int channel, const U8* data, U32 size) {
                return of(c).take(channel, data, size) ? 0 : 1;
            },
            [](void* c, int channel, int isOpen) { of(c).onChannel(channel, isOpen != 0); },
            [](void* c, Link_State state) { of(c).onState(state); },
            [](void* c, int channel, U32 tag, Link_Outcome outcome) {
                of(c).onOutcome(channel, tag, outcome);
            },
            [](void* c) { of(c).onWritable(); }};
        return &port;
    }
    void* linkProgram() { return this; }

protected:
    virtual ~LinkProgram() = default;

    // Sends a frame. Returns whether there was room.
    virtual bool transmit(const U8* frame, U32 size) = 0;
    virtual U32 random() = 0;
    // Accepts a message from the link. Returns false if the link must deliver the message again
    // later.
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
    static LinkProgram& of(void* context) { return *static_cast<LinkProgram*>(context); }
};
