// SPDX-License-Identifier: MIT
//
// handshake_model: goes through all states of the secure link's handshake (docs/link.md) under
// attack.
//
// Two sides, each of which calls, answers, ends, and starts anew at any time (it was restarted, or
// hears nothing, or its nonce is too old); and the attacker of Dolev and Yao, who is the air: he
// may deliver every frame that was ever sent, at any time, to either side, as often as he likes, or
// never. He has no key: frames of his own have no good tag, so that only a side with a bug believes
// them. Keys follow from the two nonces of a session, one a direction, so the nonces name a frame.

#include <array>
#include <bitset>
#include <cstdint>
#include <cstring>
#include <gtest/gtest.h>
#include <string>
#include <unordered_map>
#include <vector>

namespace {

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

template <class... T> uint64_t packed(T... bytes) {
    uint64_t word = 0;
    ((word = word << 8 | bytes), ...);
    return word;
}

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
        size_t operator()(const State& s) const {
            size_t hash = std::hash<Frames>()(s.air);
            for (const Side& x : s.side)
                for (uint64_t v : {packed(x.nonce, x.drawn, x.begun, x.mine, x.peer, x.dataSent,
                                          x.dataTaken, x.pingsSent),
                                   packed(x.pingsSeen, x.pingsAnswered, x.lives, x.isUp,
                                          x.isAnswered, x.isUnconfirmed)}) {
                    hash = (hash ^ v) * 0x9E3779B97F4A7C15ull;
                    hash ^= hash >> 29;
                }
            return hash;
        }
    };
    struct Same {
        bool operator()(const State& a, const State& b) const {
            return std::memcmp(&a.side, &b.side, sizeof a.side) == 0 && a.air == b.air;
        }
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
    // The states seen, in their order, each with its predecessor.
    struct Search {
        std::unordered_map<State, uint32_t, Hash, Same> seen;
        std::vector<const State*> order;
        std::vector<std::pair<uint32_t, std::string>> from;
        uint32_t at = 0;
    };
    Search* search_ = nullptr;
};

// ---- what a side does ----

void HandshakeModel::draw(State& state, int who) const {
    Side& s = state.side[who];
    s.nonce = s.drawn < limits_.nonces ? uint8_t(who * int(mostNonces) + s.drawn++) : none;
    s.isAnswered = false;
}

// Only one of both sides, or silence, ends their session; an attack never does.
void HandshakeModel::end(State& state, int who, bool byAttack) {
    Side &s = state.side[who], &other = state.side[1 - who];
    if (!s.isUp)
        return;
    if (byAttack && other.isUp && other.mine == s.peer && other.peer == s.mine)
        fail("a session that both were in was ended");
    s.isUp = s.isUnconfirmed = false;
    s.mine = s.peer = s.dataSent = s.dataTaken = s.pingsSent = s.pingsSeen = s.pingsAnswered =
        s.lives = 0;
}

void HandshakeModel::begin(State& state, int who, uint8_t mine, uint8_t peer) {
    if (!isOwn(1 - who, peer))
        fail("a session with somebody who is not the peer");
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

// Each sign of life is one that the peer has given in this session.
void HandshakeModel::live(State& state, int who) {
    Side& s = state.side[who];
    unsigned given = 0;
    for (Kind kind : {Data, Ping, Answer})
        for (uint8_t number = 0; number < mostNumbers; ++number)
            given += state.air[indexOf({kind, s.peer, s.mine, number})];
    if (++s.lives > given)
        fail("the peer counts as there, and is not");
}

void HandshakeModel::act(const State& from, int who, int what) {
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
        name = "says good-bye";
        send(state, {Bye, s.mine, s.peer, 0});
        end(state, who, false);
        draw(state, who);
        break;
    default:
        if (s.drawn == limits_.nonces)
            return;
        name = "starts anew";
        end(state, who, false);
        draw(state, who);
    }
    reach(state, std::string(who ? "B " : "A ") + name);
}

void HandshakeModel::onHandshake(State& state, int who, const Frame& f) {
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
            send(state, {Hello, s.nonce, none, 1}); // from a side that is up
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

void HandshakeModel::onSession(State& state, int who, Frame f) {
    Side& s = state.side[who];
    const bool isReflected = bug_ == Bug::OneKeyForBoth && f.from == s.mine && f.to == s.peer;
    if (isReflected)
        std::swap(f.from, f.to); // the own frame, reflected
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

// ---- what the attacker does ----

void HandshakeModel::deliver(const State& from, int who, const Frame& f) {
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

void HandshakeModel::reach(const State& state, const std::string& by) {
    auto [it, isNew] = search_->seen.emplace(state, uint32_t(search_->order.size()));
    if (isNew) {
        search_->order.push_back(&it->first);
        search_->from.emplace_back(search_->at, by);
    }
    if (result_.fault.empty() || !result_.way.empty())
        return;
    result_.way = {by};
    for (uint32_t at = search_->at; at; at = search_->from[at].first)
        result_.way.insert(result_.way.begin(), search_->from[at].second);
}

HandshakeModel::Result HandshakeModel::explore() {
    Search search;
    search_ = &search;
    State first{};
    draw(first, 0);
    draw(first, 1);
    reach(first, "");
    for (; search.at < search.order.size() && result_.fault.empty(); ++search.at) {
        const State state = *search.order[search.at];
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
    result_.states = search.order.size();
    search_ = nullptr;
    return result_;
}

// ---- the tests ----

// Two nonces a side: one for a session, one for another before or after it.
constexpr HandshakeModel::Limits withData = {2, 1, 0}, withPings = {2, 0, 1}, both = {2, 1, 1};

TEST(HandshakeModel, KeepsItsPromisesInEveryState) {
    for (const auto& limits : {withData, withPings}) {
        const auto result = HandshakeModel(Bug::None, limits).explore();
        EXPECT_EQ(result.fault, "") << testing::PrintToString(result.way);
        EXPECT_TRUE(result.bothWereUp) << "or it promises little";
        EXPECT_EQ(result.dataArrived, limits.data > 0);
        std::printf("%llu states\n", static_cast<unsigned long long>(result.states));
    }
}

TEST(HandshakeModel, FindsEachBug) {
    const std::pair<Bug, const char*> bugs[] = {
        {Bug::NonceIsNotEchoed, "a nonce began two sessions"},
        {Bug::OneKeyForBoth, "data was taken that the peer has not sent"},
        {Bug::ResetIsNotAuthentic, "a session that both were in was ended"},
        {Bug::HelloEndsTheSession, "a session that both were in was ended"},
        {Bug::HelloMakesASession, "a session that the peer knows nothing of"},
        {Bug::ConfirmIsNotAuthentic, "a session with somebody who is not the peer"},
        {Bug::OwnNonceIsTaken, "a session with somebody who is not the peer"},
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
