// SPDX-License-Identifier: MIT
//
// handshake_model: goes through all states of the secure link's handshake (docs/link.md) under
// attack.
//
// Two sides, each of which calls, answers, ends, and starts anew at any time (it was restarted, or
// hears nothing, or its nonce is too old); and the attacker of Dolev
// and Yao, who is the air: he may deliver every frame that was ever sent, at any time, to either
// side, as often as he likes, or never. He has no key: frames of his own have no good tag, so that
// only a side with a bug believes them. Keys follow from the two nonces of a session, one a
// direction, so the nonces name a frame.

#ifndef HANDSHAKE_MODEL_H
#define HANDSHAKE_MODEL_H

#include <array>
#include <bitset>
#include <cstdint>
#include <string>
#include <vector>

// The bugs that a side may have.
enum class Bug {
    None,
    NonceIsNotEchoed,    // HELLO-ACK counts for any nonce that the side once had
    OneKeyForBoth,       // the directions' keys are the same
    ResetIsNotAuthentic, // anybody's RST ends a session
    HelloEndsTheSession, // at once, before its sender has proved that he lives
    HelloMakesASession,  // without a CONFIRM
    ConfirmIsNotAuthentic,
    OwnNonceIsTaken,  // reflected
    NonceServesTwice, // is not drawn anew when a session begins
    UnconfirmedCalls, // a side calls while up, though its peer may not be in the session yet
    OldDataIsTaken,   // a number counts again
    OldPingIsLife,    // heard again, it shows that the peer is there
    OldDataIsLife
};

class HandshakeModel {
public:
    struct Limits {
        unsigned nonces, data, pings; // of a side; that a side sends in a session
    };
    struct Result {
        std::string fault;            // the first rule that was broken; none: ""
        std::vector<std::string> way; // the steps that led to it
        uint64_t states = 0;
        bool bothWereUp = false, dataArrived = false;
    };

    HandshakeModel(Bug bug, Limits limits) : bug_(bug), limits_(limits) {}
    // Visits every state that can be reached, breadth first, until a rule is broken.
    Result explore();

private:
    static constexpr unsigned mostNonces = 3, mostNumbers = 2; // of a side; of a kind of frame
    static constexpr uint8_t none = 2 * mostNonces;            // a nonce that nobody has
    enum Kind { Hello, HelloAck, Confirm, Data, Ping, Answer, Bye, kinds };
    using Frames = std::bitset<kinds*(none + 1) * (none + 1) * mostNumbers>;

    struct Frame {
        Kind kind;
        uint8_t from, to, number; // nonces of its sender and of its receiver
    };
    struct Side {
        uint8_t nonce, drawn, begun; // for the next session; how many; a bit each that began one
        uint8_t mine, peer;          // nonces of the present session
        uint8_t dataSent, dataTaken, pingsSent, pingsSeen, pingsAnswered, lives;
        bool isUp, isAnswered, isUnconfirmed;
    };
    struct State {
        std::array<Side, 2> side;
        Frames air; // all frames ever sent
    };
    struct Hash {
        size_t operator()(const State& state) const;
    };
    struct Same {
        bool operator()(const State& a, const State& b) const;
    };

    static unsigned indexOf(const Frame& f) {
        return ((f.kind * (none + 1u) + f.from) * (none + 1u) + f.to) * mostNumbers + f.number;
    }
    static Frame frameOf(unsigned index) {
        const unsigned from = index / mostNumbers / (none + 1u);
        return {Kind(from / (none + 1u)), uint8_t(from % (none + 1u)),
                uint8_t(index / mostNumbers % (none + 1u)), uint8_t(index % mostNumbers)};
    }
    static bool isOwn(int who, uint8_t nonce) { return nonce / mostNonces == unsigned(who); }
    void draw(State& state, int who) const;
    void send(State& state, const Frame& frame) const { state.air.set(indexOf(frame)); }
    void end(State& state, int who, bool byAttack);
    void begin(State& state, int who, uint8_t mine, uint8_t peer);
    void live(State& state, int who);
    void act(const State& state, int who, int what);
    void deliver(const State& state, int who, const Frame& frame);
    void onHandshake(State& state, int who, const Frame& frame);
    void onSession(State& state, int who, Frame frame);
    void reach(const State& state, const std::string& by);
    void fail(const std::string& rule) {
        if (result_.fault.empty())
            result_.fault = rule;
    }

    Bug bug_;
    Limits limits_;
    Result result_;
    struct Search;
    Search* search_ = nullptr;
};

#endif
