// SPDX-License-Identifier: MIT
//
// loop: a transport of IceC between two communicators of one process and one task.
//
// Proxies: "loop [-c n]"; n is 0 or 1 and selects one of the two connections of this side. Time is
// simulated: it passes only while a communicator waits and nothing else can happen. Without a peer,
// a message that is sent is only passed to `tap`, and the test calls `inject` to deliver messages.

#pragma once

#include <algorithm>
#include <deque>
#include <functional>
#include <vector>

extern "C" {
#include "icec.h"
}

using Bytes = std::vector<Ice_Byte>;

class Loop {
public:
    explicit Loop(Ice_Communicator& ic) : ic_(ic) {
        static const Ice_Endpoint endpoint = {
            "loop",
            [](void* c, Ice_Byte* buffer, Ice_Int ms, Ice_Event* e) {
                return of(c).receive(buffer, ms, e);
            },
            [](void* c, int n, const Ice_Byte* m, Ice_Int size) { return of(c).send(n, m, size); },
            [](void* c, const Ice_Byte* encoded, Ice_Int size, int* n) {
                return isLoop(encoded, size) ? of(c).connect(encoded[8] & 1, n) : ICE_NO_ENDPOINT;
            },
            [](void* c, int n) { of(c).close(n); },
            [](void*, const char*) { return ICE_OK; },
            [](void*, const char* options, Ice_OutputStreamPtr os) {
                if (ICEC_FULL && options && !Ice_areOptions(options, "c"))
                    os->failed = ICE_FAILED_MALFORMED;
                Ice_OutputStream_writeBlob(os, head, sizeof head);
                Ice_OutputStream_writeByte(
                    os, static_cast<Ice_Byte>(Ice_numberOption(options, 'c', 0)));
            },
            [](void*) {}, // nothing to do, because the only task is already awake
            [](void* c) { return of(c).nowMs(); },
            [](void*, const Ice_Byte* encoded, Ice_Int size, Ice_OutputStreamPtr text) {
                if (!isLoop(encoded, size))
                    return Ice_Bool{0};
                const char* printed = encoded[8] ? "loop -c 1" : "loop -c 0";
                Ice_OutputStream_writeBlob(text, reinterpret_cast<const Ice_Byte*>(printed), 9);
                return Ice_Bool{1};
            }};
        Ice_Communicator_setEndpoint(&ic, &endpoint, this);
    }
    Loop(const Loop&) = delete;
    Loop& operator=(const Loop&) = delete;

    // Connects two sides: each receives the messages that the other sends.
    void join(Loop& other) {
        peer_ = &other;
        other.peer_ = other.clock_ = this;
        other.first_ = 1;
    }
    // Queues an event, as if a peer had caused it.
    void inject(Ice_EventKind kind, int connection, const Bytes& message = {}) {
        events_.push_back({kind, connection, message});
        if (kind != ICE_EVENT_MESSAGE)
            open[connection] = kind == ICE_EVENT_OPENED;
    }
    U32 nowMs() const { return clock_->ownMs_; }

    bool open[ICE_CONNECTIONS] = {};
    bool silent = false; // true: without a peer, connections can be opened, but nothing answers
    // Called with every message that is sent.
    std::function<void(const Bytes& message)> tap;

private:
    struct Event {
        Ice_EventKind kind;
        int connection;
        Bytes message;
    };
    // Beginning of an encoded endpoint: type, size of the encapsulation, encoding 1.1. The number
    // of the connection follows.
    static constexpr Ice_Byte head[] = {0x50, 0x4C, 7, 0, 0, 0, 1, 1};

    static Loop& of(void* context) { return *static_cast<Loop*>(context); }
    static bool isLoop(const Ice_Byte* encoded, Ice_Int size) {
        return size == 9 && encoded[0] == head[0] && encoded[1] == head[1];
    }
    Ice_Status receive(Ice_Byte* buffer, Ice_Int timeoutMs, Ice_Event* event) {
        U32 begin = nowMs();
        while (events_.empty() && static_cast<Ice_Int>(nowMs() - begin) < timeoutMs) {
            // Runs the peer, unless the peer itself is waiting for this side.
            if (peer_ && !running_) {
                running_ = true;
                Ice_Status status = Ice_Communicator_poll(&peer_->ic_, 0);
                running_ = false;
                if (status == ICE_OK)
                    continue;
            }
            if (events_.empty())
                ++clock_->ownMs_;
        }
        if (!events_.empty()) {
            const Event& e = events_.front();
            std::copy(e.message.begin(), e.message.end(), buffer);
            *event = {e.kind, e.connection, static_cast<Ice_Int>(e.message.size())};
            events_.pop_front();
        }
        return ICE_OK;
    }
    Ice_Status send(int connection, const Ice_Byte* bytes, Ice_Int size) {
        Bytes message(bytes, bytes + size);
        if (!open[connection])
            return ICE_CONNECTION_LOST;
        if (tap)
            tap(message);
        if (!open[connection]) // `tap` has closed it
            return ICE_CONNECTION_LOST;
        if (peer_)
            peer_->inject(ICE_EVENT_MESSAGE, connection, message);
        return ICE_OK;
    }
    Ice_Status connect(int which, int* connection) {
        *connection = first_ + 2 * which;
        if (open[*connection])
            return ICE_OK;
        if (!peer_ && !silent)
            return ICE_CONNECTION_LOST;
        open[*connection] = true;
        if (peer_)
            peer_->inject(ICE_EVENT_OPENED, *connection);
        return ICE_OK;
    }
    void close(int connection) {
        // The peer may already have closed the connection. The event of this closing is then
        // discarded, because a new connection may now have the same number.
        for (Event& e : events_)
            if (e.kind == ICE_EVENT_CLOSED && e.connection == connection) {
                e.kind = ICE_EVENT_NONE;
                return;
            }
        if (open[connection] && peer_)
            peer_->inject(ICE_EVENT_CLOSED, connection);
        open[connection] = false;
    }

    Ice_Communicator& ic_;
    Loop *peer_ = nullptr, *clock_ = this;
    U32 ownMs_ = 0;
    // number of the first connection that this side opens; the second one has this number + 2
    int first_ = 0;
    bool running_ = false;
    std::deque<Event> events_;
};
