// SPDX-License-Identifier: MIT
//
// options_test: link layers compiled with different options understand each other: windows, heads,
// riding acknowledgements, sizes.

#include "random.h"
#include <deque>
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

extern "C" {
#include "link.h"
}

namespace {

using Bytes = std::vector<uint8_t>;

// A variant's functions, and a Link of its size.
class Peer {
public:
    Peer(const std::string& variant, uint64_t seed) : random_(seed) {
        std::string path = VARIANTS + variant + ".so";
        library_ = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
        if (!library_)
            throw std::runtime_error(dlerror());
        load(init, "Link_init");
        load(start, "Link_start");
        load(poll, "Link_poll");
        load(receive, "Link_receive");
        load(send, "Link_send");
        load(open, "Link_openChannel");
        load(state, "Link_state");
        load(size, "LinkVariant_size");
        load(maxMessage, "LinkVariant_maxMessage");
        memory_.resize(size() / sizeof(uint64_t) + 1);
        static const Link_Port port = {
            [](void* c, const U8* f, U32 n) { return static_cast<Peer*>(c)->transmit(f, n); },
            [](void* c) { return static_cast<Peer*>(c)->random_.next(); },
            [](void* c, int, const U8* d, U32 n) {
                static_cast<Peer*>(c)->received.emplace_back(d, d + n);
                return 0;
            },
            [](void*, int, int) {},
            [](void*, Link_State) {},
            [](void* c, int, U32 tag, Link_Outcome o) { static_cast<Peer*>(c)->outcomes[tag] = o; },
            nullptr};
        init(link(), &port, this, 1440);
    }
    ~Peer() { dlclose(library_); }
    Peer(const Peer&) = delete;
    Peer& operator=(const Peer&) = delete;
    Link* link() { return reinterpret_cast<Link*>(memory_.data()); }
    bool isUp() { return state(link()) == LINK_STATE_UP; }

    decltype(&Link_init) init;
    decltype(&Link_start) start;
    decltype(&Link_poll) poll;
    decltype(&Link_receive) receive;
    decltype(&Link_send) send;
    decltype(&Link_openChannel) open;
    decltype(&Link_state) state;
    U32 (*size)();
    U32 (*maxMessage)();
    std::deque<std::pair<uint64_t, Bytes>> air;
    std::vector<Bytes> received;
    std::map<U32, Link_Outcome> outcomes;
    double loss = 0;
    uint64_t now = 0, free = 0;

private:
    template <class F> void load(F& f, const char* name) {
        f = reinterpret_cast<F>(dlsym(library_, name));
        if (!f)
            throw std::runtime_error(name);
    }
    int transmit(const U8* frame, U32 bytes) {
        if (free > now + 30000)
            return 1;
        free = std::max(free, now) + bytes * 90;
        if (!random_.chance(loss))
            air.emplace_back(free + 8000, Bytes(frame, frame + bytes));
        return 0;
    }
    Random random_;
    void* library_;
    std::vector<uint64_t> memory_;
};

using Names = std::pair<const char*, const char*>;

class Options : public ::testing::TestWithParam<Names> {
protected:
    template <class Done> bool until(Done done, uint64_t limitUs) {
        for (uint64_t end = now_ + limitUs; now_ < end; now_ += 1000) {
            for (auto [from, to] : {std::pair(&a_, &b_), std::pair(&b_, &a_)}) {
                to->now = now_;
                while (!from->air.empty() && from->air.front().first <= now_) {
                    Bytes bytes = from->air.front().second;
                    from->air.pop_front();
                    to->receive(to->link(), bytes.data(), static_cast<U32>(bytes.size()), 0, us());
                }
                to->poll(to->link(), us());
            }
            if (done())
                return true;
        }
        return false;
    }
    U32 us() const { return static_cast<U32>(now_); }
    Peer a_{GetParam().first, testSeed() * 2}, b_{GetParam().second, testSeed() * 2 + 1};
    uint64_t now_ = 0xFFFF0000;
};

TEST_P(Options, MessagesGoBothWaysThroughLoss) {
    a_.start(a_.link(), us());
    ASSERT_TRUE(until([&] { return a_.isUp() && b_.isUp(); }, 10'000'000));
    a_.loss = b_.loss = 0.1;
    a_.open(a_.link(), 1, us());
    Random random(testSeed());
    std::vector<Bytes> sent[2];
    U32 most = std::min(a_.maxMessage(), b_.maxMessage());
    const unsigned messages = 200;
    auto offer = [&](Peer& from, std::vector<Bytes>& list) {
        Bytes m(1 + random.below(random.below(20) ? 200 : most),
                static_cast<uint8_t>(random.next()));
        if (list.size() < messages &&
            from.send(from.link(), 1, m.data(), static_cast<U32>(m.size()),
                      static_cast<U32>(list.size()), us()) == LINK_OK)
            list.push_back(m);
    };
    EXPECT_TRUE(until(
        [&] {
            offer(a_, sent[0]);
            offer(b_, sent[1]);
            return a_.outcomes.size() == messages && b_.outcomes.size() == messages;
        },
        600'000'000));
    EXPECT_TRUE(b_.received == sent[0]) << "seed " << testSeed();
    EXPECT_TRUE(a_.received == sent[1]) << "seed " << testSeed();
}

TEST_P(Options, AMessageThatIsTooLongForThePeerIsReported) {
    U32 most = b_.maxMessage();
    if (a_.maxMessage() <= most)
        return; // it cannot be sent
    a_.start(a_.link(), us());
    ASSERT_TRUE(until([&] { return a_.isUp() && b_.isUp(); }, 10'000'000));
    a_.open(a_.link(), 0, us());
    Bytes m(most + 200, 7);
    a_.send(a_.link(), 0, m.data(), static_cast<U32>(m.size()), 5, us());
    EXPECT_TRUE(until([&] { return a_.outcomes.count(5) != 0; }, 20'000'000));
    EXPECT_EQ(a_.outcomes[5], LINK_UNKNOWN);
    EXPECT_TRUE(b_.received.empty());
    EXPECT_TRUE(until([&] { return a_.isUp() && b_.isUp(); }, 20'000'000));
}

INSTANTIATE_TEST_SUITE_P(Variants, Options,
                         ::testing::Values(Names{"full", "full"}, Names{"full", "smallest"},
                                           Names{"smallest", "full"}, Names{"smallest", "smallest"},
                                           Names{"full", "window8"}, Names{"window64", "full"},
                                           Names{"window8", "window64"},
                                           Names{"smallest", "window64"}));

TEST(LinkOptions, MemoryIsWhatTheDocumentationSays) {
    for (auto variant : {"full", "window8", "window64", "smallest"})
        std::printf("sizeof(Link), %s: %u bytes on this machine\n", variant,
                    Peer(variant, 1).size());
}

} // namespace
