// SPDX-License-Identifier: MIT
//
// handshake_model: explores all states of the secure link's handshake (docs/link.md) under attack.
//
// The model has two sides and an attacker. Each side calls, answers, ends its session and restarts
// at any time (after a restart it may be silent, or have an old nonce). The attacker controls the
// air, as in the model of Dolev and Yao: he may deliver every frame that was ever sent, at any
// time, to either side, any number of times, or never. He has no key, so the frames that he makes
// have no valid tag, and only a side with a bug accepts them. A session has one key for each
// direction, and both depend on the two nonces; therefore a frame is identified by its nonces.

#include <bitset>
#include <cstdint>
#include <gtest/gtest.h>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace {

// Bugs that the model can put into both sides.
enum class Bug {
    None,
    // a HELLO-ACK is accepted even if it contains an earlier nonce of this side
    NonceIsNotEchoed,
    OneKeyForBoth,       // both directions use the same key
    ResetIsNotAuthentic, // an unauthenticated RST ends a session
    // a HELLO ends the session although its sender has not proved that it is present
    HelloEndsTheSession,
    HelloMakesASession, // a HELLO begins a session, without a CONFIRM
    ConfirmIsNotAuthentic,
    // a side accepts its own nonce, sent back by an attacker, as a nonce of the peer
    OwnNonceIsTaken,
    NonceServesTwice, // no new nonce is drawn when a session begins
    UnconfirmedCalls, // a side makes calls although its peer may not have begun the session yet
    OldDataIsTaken,   // the number of an earlier data frame is accepted again
    OldPingIsLife,    // a repeated PING counts as proof that the peer is present
    OldDataIsLife
};

class HandshakeModel {
public:
    struct Limits {
        // Limits for each side: number of nonces in total; number of data frames and of PINGs per
        // session.
        unsigned nonces, data, pings;
    };
    struct Result {
        std::string fault;            // rule that was violated first; "" if no rule was violated
        std::vector<std::string> way; // steps that led to the violation
        size_t states = 0;
        bool bothWereUp = false, dataArrived = false;
    };

    HandshakeModel(Bug bug, Limits limits) : bug_(bug), limits_(limits) {}

    // Visits every reachable state, breadth first, until a rule is violated.
    Result explore() {
        State first{};
        draw(first, 0);
        draw(first, 1);
        reach(first, "");
        for (; at_ < order_.size() && result_.fault.empty(); ++at_) {
            const State state = *order_[at_];
            for (int who : {0, 1}) {
                for (int what = 0; what < 5; ++what)
                    act(state, who, what);
                for (unsigned index = 0; index < state.air.size(); ++index)
                    if (state.air[index])
                        deliver(state, who, frameOf(index));
                if (bug_ == Bug::ConfirmIsNotAuthentic)
                    deliver(state, who, {Confirm, none, state.side[who].nonce, 0});
                if (bug_ == Bug::ResetIsNotAuthentic) {
                    State reset = state;
                    end(reset, who, true);
                    reach(reset, who ? "B gets RST" : "A gets RST");
                }
            }
        }
        result_.states = order_.size();
        return result_;
    }

private:
    // Largest number of nonces per side, and of frame numbers per kind of frame; and a nonce that
    // no side has.
    static constexpr unsigned mostNonces = 3, mostNumbers = 2;
    static constexpr uint8_t none = 2 * mostNonces;
    enum Kind { Hello, HelloAck, Confirm, Data, Ping, Answer, Bye, kinds };

    struct Frame {
        Kind kind;
        uint8_t from, to, number; // from and to: nonces of the sender and of the receiver
    };
    struct Side {
        // nonce for the next session, number of nonces drawn so far, and a bit mask of the nonces
        // with which a session began
        uint8_t nonce, drawn, begun;
        uint8_t mine, peer; // nonces of this side and of the peer in the current session
        uint8_t dataSent, dataTaken, pingsSent, pingsSeen, pingsAnswered, lives;
        bool isUp, isAnswered, isUnconfirmed, unused[2];
    };
    struct State {
        Side side[2];
        // set of all frames that have ever been sent
        std::bitset<kinds*(none + 1) * (none + 1) * mostNumbers> air;

        std::string_view bytes() const {
            static_assert(sizeof(State) == sizeof side + sizeof air, "no padding");
            return {reinterpret_cast<const char*>(this), sizeof *this};
        }
        bool operator==(const State& other) const { return bytes() == other.bytes(); }
    };
    struct Hash {
        size_t operator()(const State& s) const { return std::hash<std::string_view>()(s.bytes()); }
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
    void send(State& state, const Frame& frame) const { state.air.set(indexOf(frame)); }
    void fail(const std::string& rule) {
        if (result_.fault.empty())
            result_.fault = rule;
    }

    // ---- actions of a side ----

    void draw(State& state, int who) const {
        Side& s = state.side[who];
        s.nonce = s.drawn < limits_.nonces ? uint8_t(who * int(mostNonces) + s.drawn++) : none;
        s.isAnswered = false;
    }

    // Ends the session of a side. `byAttack` is false if the side itself ends the session, or has
    // received a valid BYE. Otherwise an attack may have ended it, which is a fault if the peer is
    // still in this session.
    void end(State& state, int who, bool byAttack) {
        Side &s = state.side[who], &other = state.side[1 - who];
        if (!s.isUp)
            return;
        if (byAttack && other.isUp && other.mine == s.peer && other.peer == s.mine)
            fail("a session that both were in was ended");
        s.isUp = s.isUnconfirmed = false;
        s.mine = s.peer = s.dataSent = s.dataTaken = s.pingsSent = s.pingsSeen = s.pingsAnswered =
            s.lives = 0;
    }

    void begin(State& state, int who, uint8_t mine, uint8_t peer) {
        if (!isOwn(1 - who, peer))
            fail("a session with a stranger");
        else if (!state.air[indexOf({HelloAck, peer, mine, 0})] &&
                 !state.air[indexOf({Confirm, peer, mine, 0})])
            fail("a session that the peer knows nothing of");
        end(state, who, true);
        Side& s = state.side[who];
        const unsigned bit = 1u << mine % mostNonces;
        if (s.begun & bit)
            fail("a nonce began two sessions");
        s.begun = uint8_t(s.begun | bit);
        s.isUp = true;
        s.mine = mine;
        s.peer = peer;
        if (bug_ == Bug::NonceServesTwice)
            s.isAnswered = true;
        else
            draw(state, who);
        const Side& other = state.side[1 - who];
        result_.bothWereUp =
            result_.bothWereUp || (other.isUp && other.mine == peer && other.peer == mine);
    }

    // Checks that each proof of presence was sent by the peer, in this session.
    void live(State& state, int who) {
        Side& s = state.side[who];
        unsigned given = 0;
        for (Kind kind : {Data, Ping, Answer})
            for (uint8_t number = 0; number < mostNumbers; ++number)
                given += state.air[indexOf({kind, s.peer, s.mine, number})];
        if (++s.lives > given)
            fail("the peer counts as there, and is not");
    }

    void act(const State& from, int who, int what) {
        State state = from;
        Side& s = state.side[who];
        const char* name = "";
        switch (what) {
        case 0:
            if (s.isUp || s.nonce == none)
                return;
            name = "calls";
            send(state, {Hello, s.nonce, none, 0});
            break;
        case 1:
            if (!s.isUp || s.dataSent == limits_.data)
                return;
            name = "sends data";
            send(state, {Data, s.mine, s.peer, s.dataSent++});
            break;
        case 2:
            if (!s.isUp || s.pingsSent == limits_.pings)
                return;
            name = "asks";
            send(state, {Ping, s.mine, s.peer, s.pingsSent++});
            break;
        case 3:
            if (!s.isUp)
                return;
            name = "ends the session";
            send(state, {Bye, s.mine, s.peer, 0});
            end(state, who, false);
            draw(state, who);
            break;
        default:
            if (s.drawn == limits_.nonces)
                return;
            name = "restarts";
            end(state, who, false);
            draw(state, who);
        }
        reach(state, std::string(who ? "B " : "A ") + name);
    }

    void onHandshake(State& state, int who, const Frame& f) {
        Side& s = state.side[who];
        const bool isSession = s.isUp && f.from == s.peer && f.to == s.mine;
        if (f.from == s.nonce && bug_ != Bug::OwnNonceIsTaken)
            return;
        if (f.kind == Hello) {
            if (s.isUp && f.from == s.peer) {
                if (s.isUnconfirmed)
                    send(state, {Confirm, s.mine, s.peer, 0});
                return;
            }
            if (s.nonce == none || (s.isUp && f.number))
                return;
            s.isAnswered = true;
            if (s.isUp && (!s.isUnconfirmed || bug_ == Bug::UnconfirmedCalls)) {
                // the last field is 1, which means that the sender has a session
                send(state, {Hello, s.nonce, none, 1});
                return;
            }
            send(state, {HelloAck, s.nonce, f.from, 0});
            if (bug_ == Bug::HelloEndsTheSession)
                end(state, who, true);
            if (bug_ == Bug::HelloMakesASession)
                begin(state, who, s.nonce, f.from);
        } else if (f.kind == HelloAck) {
            const bool isEcho =
                bug_ == Bug::NonceIsNotEchoed ? isOwn(who, f.to) : f.to == s.nonce && f.to != none;
            if (!isEcho)
                return;
            begin(state, who, f.to, f.from);
            s.isUnconfirmed = true;
            send(state, {Confirm, f.to, f.from, 0});
        } else if (!isSession && f.to == s.nonce && s.isAnswered) {
            begin(state, who, f.to, f.from);
        }
    }

    void onSession(State& state, int who, Frame f) {
        Side& s = state.side[who];
        const bool isReflected = bug_ == Bug::OneKeyForBoth && f.from == s.mine && f.to == s.peer;
        if (isReflected)
            std::swap(f.from, f.to); // a frame that this side has sent and that is reflected
        if (!s.isUp || f.from != s.peer || f.to != s.mine)
            return;
        s.isUnconfirmed = false;
        switch (f.kind) {
        case Data:
            if (f.number < s.dataTaken && bug_ == Bug::OldDataIsLife)
                live(state, who);
            if (f.number != s.dataTaken && bug_ != Bug::OldDataIsTaken)
                return;
            if (f.number < s.dataTaken)
                fail("data was taken twice");
            if (isReflected)
                fail("data was taken that the peer has not sent");
            s.dataTaken = uint8_t(f.number + 1);
            live(state, who);
            result_.dataArrived = true;
            break;
        case Ping:
            if (f.number >= s.pingsSeen || bug_ == Bug::OldPingIsLife)
                live(state, who);
            if (f.number >= s.pingsSeen) {
                s.pingsSeen = uint8_t(f.number + 1);
                send(state, {Answer, s.mine, s.peer, f.number});
            }
            break;
        case Answer:
            if (f.number >= s.pingsAnswered && f.number < s.pingsSent) {
                s.pingsAnswered = uint8_t(f.number + 1);
                live(state, who);
            }
            break;
        default:
            end(state, who, false);
            draw(state, who);
        }
    }

    // ---- actions of the attacker ----

    void deliver(const State& from, int who, const Frame& f) {
        State state = from;
        if (f.kind <= Confirm)
            onHandshake(state, who, f);
        else
            onSession(state, who, f);
        static const char* const names[] = {"HELLO", "HELLO-ACK", "CONFIRM", "DATA",
                                            "PING",  "answer",    "BYE"};
        auto nonce = [](uint8_t n) {
            return n == none ? std::string("-")
                             : (n < mostNonces ? "a" : "b") + std::to_string(n % mostNonces);
        };
        reach(state, std::string(who ? "B" : "A") + " gets " + names[f.kind] + "(" + nonce(f.from) +
                         ", " + nonce(f.to) + ") " + std::to_string(f.number));
    }

    void reach(const State& state, const std::string& by) {
        auto [it, isNew] = seen_.emplace(state, uint32_t(order_.size()));
        if (isNew) {
            order_.push_back(&it->first);
            from_.emplace_back(at_, by);
        }
        if (result_.fault.empty() || !result_.way.empty())
            return;
        result_.way = {by};
        for (uint32_t at = at_; at; at = from_[at].first)
            result_.way.insert(result_.way.begin(), from_[at].second);
    }

    const Bug bug_;
    const Limits limits_;
    Result result_;
    // indexes in order_ of all states found so far
    std::unordered_map<State, uint32_t, Hash> seen_;
    std::vector<const State*> order_; // states in the order of discovery
    // index of the state before each state, and the step between them
    std::vector<std::pair<uint32_t, std::string>> from_;
    // index of the state that is being examined
    uint32_t at_ = 0;
};

// ---- the tests ----

// Two nonces per side: one for the session, and one that is earlier or later.
constexpr HandshakeModel::Limits withData = {2, 1, 0}, withPings = {2, 0, 1}, both = {2, 1, 1};

TEST(HandshakeModel, HoldsItsPropertiesInEveryState) {
    for (const auto& limits : {withData, withPings}) {
        const auto result = HandshakeModel(Bug::None, limits).explore();
        EXPECT_EQ(result.fault, "") << testing::PrintToString(result.way);
        EXPECT_TRUE(result.bothWereUp)
            << "the model never reached a state in which both sides are up";
        EXPECT_EQ(result.dataArrived, limits.data > 0);
        std::printf("%llu states\n", static_cast<unsigned long long>(result.states));
    }
}

TEST(HandshakeModel, FindsEachSeededBug) {
    const std::pair<Bug, const char*> bugs[] = {
        {Bug::NonceIsNotEchoed, "a nonce began two sessions"},
        {Bug::OneKeyForBoth, "data was taken that the peer has not sent"},
        {Bug::ResetIsNotAuthentic, "a session that both were in was ended"},
        {Bug::HelloEndsTheSession, "a session that both were in was ended"},
        {Bug::HelloMakesASession, "a session that the peer knows nothing of"},
        {Bug::ConfirmIsNotAuthentic, "a session with a stranger"},
        {Bug::OwnNonceIsTaken, "a session with a stranger"},
        {Bug::NonceServesTwice, "a nonce began two sessions"},
        {Bug::UnconfirmedCalls, "a session that both were in was ended"},
        {Bug::OldDataIsTaken, "data was taken twice"},
        {Bug::OldPingIsLife, "the peer counts as there, and is not"},
        {Bug::OldDataIsLife, "the peer counts as there, and is not"}};
    for (const auto& [bug, fault] : bugs) {
        const auto result = HandshakeModel(bug, both).explore();
        EXPECT_EQ(result.fault, fault) << static_cast<int>(bug) << " after " << result.states
                                       << " states " << testing::PrintToString(result.way);
    }
}

} // namespace
