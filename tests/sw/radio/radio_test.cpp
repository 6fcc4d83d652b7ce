// SPDX-License-Identifier: MIT
//
// radio_test: tests the radio driver with the real RTL: FSMC pins, bridge, arbiter, DDR3, modem
// controller, and the XBee model at the controller's UART. The driver runs in a task of the
// firmware's kernel, and time is simulated.

#include "../../support/link_end.h"
#include "uav_machine.h"
#include <gtest/gtest.h>

extern "C" {
#include "link.h"
#include "map_regs.h"
#include "modem_regs.h"
#include "radio.h"
#include "ucos_ii.h"
}

namespace {

constexpr int guardMs = 20; // guard time of both modems, ms; short, to make the tests short

XBee::Options quick(std::map<std::string, uint32_t> more, const std::string& key = "") {
    XBee::Options options;
    options.key = key;
    options.set = {{"GT", guardMs}};
    for (auto& [letters, value] : more)
        options.set[letters] = value;
    return options;
}

// One side of a link, which stores its messages. The function `send` sends a frame of this side,
// and returns 0 if the frame was accepted.
class MessageLink : public LinkEnd {
public:
    explicit MessageLink(std::function<int(const U8*, U32)> send, uint32_t seed)
        : send_(std::move(send)), random_(seed) {
        begin();
    }
    static void onPacket(void* c, const U8* bytes, U32 size) {
        Link_receive(static_cast<MessageLink*>(c)->link(), bytes, size,
                     OSTimeGet() * (1000000U / OS_TICKS_PER_SEC));
    }
    std::vector<std::vector<uint8_t>> received;

private:
    bool transmit(const U8* frame, U32 size) override { return send_(frame, size) == 0; }
    U32 random() override { return random_.next(); }
    bool take(int, const U8* data, U32 size) override {
        received.emplace_back(data, data + size);
        return true;
    }
    std::function<int(const U8*, U32)> send_;
    Random random_;
};

class Radio : public ::testing::Test {
protected:
    // `farKey` is the AES key of the far modem; without a key, nothing is encrypted.
    explicit Radio(const std::string& farKey = "")
        : far_(farLine_, air_,
               quick({{"BD", 7}, {"MY", 0}, {"DL", 1}, {"EE", farKey.empty() ? 0 : 1}}, farKey)) {}
    void SetUp() override {
        soc_.onTime([this](uint64_t now) {
            far_.advance(now);
            if (farLinkRuns_ && now >= nextPoll_) {
                nextPoll_ = now + 1'000'000;
                U32 us = static_cast<U32>(now / 1000);
                Link_receive(farPeer_.link(), farLine_.received.data(),
                             static_cast<U32>(farLine_.received.size()), us);
                farLine_.received.clear();
                Link_poll(farPeer_.link(), us);
            }
            return std::min(far_.nextEvent(), farLinkRuns_ ? nextPoll_ : never);
        });
        soc_.reset();
    }
    // Runs `body` as the only task.
    void run(std::function<void()> body) {
        static std::function<void()> task;
        static OS_STK stack[1024];
        bool done = false;
        task = [&] {
            body();
            done = true;
            OsHost::stop();
        };
        irqOn_ = false;
        UavMachine::Firmware firmware;
        firmware.start = [this](const FSMC_Port* port, void* context) {
            realPort_ = port;
            ASSERT_EQ(FSMC_init(port, context), FSMC_OK);
            OSTaskCreate([](void*) { task(); }, nullptr, &stack[1023], 5);
        };
        firmware.irqHandler = [] { (void)Radio_interrupt(); };
        firmware.irqEnabled = [this] { return irqOn_; };
        UavMachine machine(soc_, [&] { return static_cast<double>(soc_.now()) < 60e9; }, firmware);
        machine.run();
        ASSERT_TRUE(done) << "the task did not end within 60 simulated seconds";
    }
    Radio_Status init(uint8_t channel = 0, uint16_t pan = 0, const U8* key = nullptr,
                      Radio_OnAnswer onAnswer = nullptr, Radio_Baud baud = XBEE_BD_115200) {
        const XBeeInitTypeDef conf = {baud, 0x0001, 0x0000, channel, pan, guardMs, key, onAnswer};
        const Radio_Memory rings = {0x0000, 0x1000};
        Radio_Status status = xbeeInit(&conf, &rings);
        irqOn_ = status == RADIO_OK;
        return status;
    }
    // Hides bits of a controller's register from the driver, until FSMC_init is called.
    void hide(U32 word, U32 bits) {
        static const FSMC_Port* real;
        static FSMC_Port lying;
        static U32 hiddenAt, hidden;
        real = realPort_;
        lying = *real;
        hiddenAt = MAP_CONTROL_WINDOW + 64U * MAP_SLOT_MODEM + 4U * word;
        hidden = bits;
        lying.read32 = [](void* c, U32 address) {
            return real->read32(c, address) & ~(address == hiddenAt ? hidden : 0U);
        };
        ASSERT_EQ(FSMC_init(&lying, &soc_), FSMC_OK);
    }
    static U32 us() { return OSTimeGet() * (1000000U / OS_TICKS_PER_SEC); }
    // Runs the near link over the driver until `done` returns true.
    template <class Done> bool talk(Done done, int limitMs) {
        for (int i = 0; i < limitMs; ++i) {
            Radio_receive(nearPeer_.onPacket, &nearPeer_);
            Link_poll(nearPeer_.link(), us());
            if (done())
                return true;
            OSTimeDly(OS_TICKS_PER_SEC / 1000);
        }
        return done();
    }
    bool connect(int limitMs = 5000) {
        farLinkRuns_ = true;
        Link_start(nearPeer_.link(), us());
        return talk([&] { return nearPeer_.isUp() && farPeer_.isUp(); }, limitMs);
    }

    // Sends five messages in each direction at the same time; all their bytes are `byte`.
    void exchange(uint8_t byte) {
        const std::vector<uint8_t> message(700, byte);
        ASSERT_TRUE(connect());
        ASSERT_EQ(Link_openChannel(nearPeer_.link(), 0), LINK_OK);
        for (U32 tag = 0; tag < 5; ++tag)
            ASSERT_EQ(Link_send(nearPeer_.link(), 0, message.data(), 700, tag), LINK_OK);
        ASSERT_TRUE(talk([&] { return !farPeer_.received.empty(); }, 5000));
        for (U32 tag = 0; tag < 5; ++tag)
            ASSERT_EQ(Link_send(farPeer_.link(), 0, message.data(), 700, tag), LINK_OK);
        ASSERT_TRUE(
            talk([&] { return farPeer_.received.size() == 5 && nearPeer_.received.size() == 5; },
                 // a long limit, because the packets of the far side contain parts of two frames
                 20000));
        talk([] { return false; }, 100);
        EXPECT_EQ(nearPeer_.received[4], message);
        EXPECT_EQ(farPeer_.received[4], message);
        EXPECT_EQ(Radio_counters()->framingErrors, 0u);
    }

    RfChannel air_{testSeed()};
    HostLine farLine_;
    XBee far_;
    SocModel soc_{air_, quick({})};
    MessageLink nearPeer_{[](const U8* f, U32 n) { return Radio_transmit(nullptr, f, n); }, 11};
    MessageLink farPeer_{[this](const U8* f, U32 n) {
                             farLine_.send({f, f + n}, soc_.now());
                             return 0;
                         },
                         12};
    bool farLinkRuns_ = false, irqOn_ = false;
    uint64_t nextPoll_ = 0;
    const FSMC_Port* realPort_ = nullptr;
};

TEST_F(Radio, SetsTheModemUpAndZeroSelectsTheDefault) {
    run([&] { EXPECT_EQ(init(), RADIO_OK); });
    EXPECT_EQ(soc_.modem().parameter("CH"), 0x0Cu);
    EXPECT_EQ(soc_.modem().parameter("ID"), 0x3332u);
    run([&] { EXPECT_EQ(init(0x14, 0x1234), RADIO_OK); });
    EXPECT_EQ(soc_.modem().parameter("MY"), 0x0001u);
    EXPECT_EQ(soc_.modem().parameter("DL"), 0x0000u);
    EXPECT_EQ(soc_.modem().parameter("CH"), 0x14u);
    EXPECT_EQ(soc_.modem().parameter("ID"), 0x1234u);
    EXPECT_EQ(soc_.modem().parameter("BD"), 7u);
    EXPECT_FALSE(soc_.modem().inCommandMode());
}

TEST_F(Radio, AModemThatIsOffIsReported) {
    soc_.modem().power(false, 0);
    run([&] { EXPECT_EQ(init(), RADIO_NO_MODEM); });
}

TEST_F(Radio, ARefusedCommandIsReportedWithItsStep) {
    soc_.modem().refuseCommand("ID");
    run([&] { EXPECT_EQ(init(), RADIO_REFUSED); });
    EXPECT_EQ(Radio_failedStep(), 6u); // number of ATID in the table of docs/modem.md
}

TEST_F(Radio, ASlotWithoutAModemControllerIsReported) {
    run([&] {
        hide(MODEM_ID, 0xFFFF0000U);
        EXPECT_EQ(init(), RADIO_NO_DEVICE);
        ASSERT_EQ(FSMC_init(realPort_, &soc_), FSMC_OK);
    });
}

TEST_F(Radio, FramesAreSentInOrderAndAFullRingIsReported) {
    std::vector<uint8_t> sent;
    U32 copied = 0, full = 0, interrupts = 0;
    run([&] {
        ASSERT_EQ(init(), RADIO_OK);
        // discards bytes that the search for the baud rate has sent over the air
        farLine_.received.clear();
        copied = Radio_counters()->bytesCopiedOut;
        full = Radio_counters()->ringFull;
        interrupts = Radio_counters()->interrupts;
        Random random(testSeed());
        for (int i = 0; i < 60; ++i) {
            std::vector<uint8_t> frame(1 + random.below(100));
            for (auto& byte : frame)
                byte = static_cast<uint8_t>(random.next());
            while (Radio_transmit(nullptr, frame.data(), static_cast<U32>(frame.size())) != 0)
                OSTimeDly(1);
            sent.insert(sent.end(), frame.begin(), frame.end());
        }
        for (int i = 0; i < 2000 && farLine_.received.size() < sent.size(); ++i)
            OSTimeDly(OS_TICKS_PER_SEC / 1000);
        copied = Radio_counters()->bytesCopiedOut - copied;
        full = Radio_counters()->ringFull - full;
        interrupts = Radio_counters()->interrupts - interrupts;
    });
    EXPECT_EQ(farLine_.received, sent) << "seed " << testSeed();
    EXPECT_EQ(copied, sent.size()); // each byte was copied only once, into DDR3
    EXPECT_GT(full, 0u);
    EXPECT_EQ(interrupts, 0u) << "a packet that was sent causes no interrupt";
}

TEST_F(Radio, ALinkWorksInBothDirections) {
    air_.weather.perfect =
        true; // a modem that is as fast as its line, so no packet contains parts of two frames
    run([&] {
        ASSERT_EQ(init(), RADIO_OK);
        const U32 before = Radio_counters()->bytesCopiedIn;
        const uint64_t fromModem = soc_.modem().counters().bytesToHost;
        exchange(0x5A);
        EXPECT_EQ(Radio_counters()->bytesCopiedIn - before,
                  soc_.modem().counters().bytesToHost - fromModem);
        EXPECT_EQ(Link_statistics(nearPeer_.link())->bytesSkipped, 0u);
    });
}

TEST_F(Radio, ASleepingTaskLosesNoMessage) {
    run([&] {
        ASSERT_EQ(init(), RADIO_OK);
        ASSERT_TRUE(connect());
        ASSERT_EQ(Link_openChannel(farPeer_.link(), 0), LINK_OK);
        for (U32 i = 0; i < 30; ++i) {
            std::vector<uint8_t> message(300, static_cast<uint8_t>(i));
            ASSERT_EQ(Link_send(farPeer_.link(), 0, message.data(), 300, i), LINK_OK);
        }
        OSTimeDly(OS_TICKS_PER_SEC); // more packets arrive during this time than the ring can hold
        ASSERT_TRUE(talk([&] { return nearPeer_.received.size() == 30; }, 20000));
        for (size_t i = 0; i < 30; ++i)
            EXPECT_EQ(nearPeer_.received[i], std::vector<uint8_t>(300, static_cast<uint8_t>(i)));
        // RTS stopped the modem before the ring was full. (The modem itself then drops packets from
        // the air, and a packet may contain the end of one frame and the beginning of the next.)
        EXPECT_EQ(Radio_counters()->hardwareOverruns, 0u);
    });
}

const U8 key[16] = {0x00, 0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77,
                    0x88, 0x99, 0xAA, 0xBB, 0xCC, 0xDD, 0xEE, 0xFF};

class ApiRadio : public Radio {
protected:
    Radio_Status initApi(Radio_Baud baud = XBEE_BD_115200) {
        answers_.clear();
        return init(
            0, 0, nullptr, [](int isDelivered) { answers_ += isDelivered ? '+' : '-'; }, baud);
    }
    // Sends a packet, and waits until there are answers for this number of packets.
    void sendOne(size_t answers) {
        const U8 frame[3] = {'a', 'b', 'c'};
        ASSERT_EQ(Radio_transmit(nullptr, frame, 3), 0);
        for (int i = 0; i < 200 && answers_.size() < answers; ++i) {
            OSTimeDly(OS_TICKS_PER_SEC / 1000);
            Radio_receive([](void*, const U8*, U32) {}, nullptr);
        }
    }
    static std::string answers_;
};
std::string ApiRadio::answers_;

TEST_F(ApiRadio, ALinkWorksInBothDirections) {
    run([&] {
        ASSERT_EQ(initApi(), RADIO_OK);
        EXPECT_EQ(soc_.modem().parameter("AP"), 1u);
        exchange(0x7E);
        EXPECT_EQ(Radio_counters()->signal, 40u);
        EXPECT_EQ(Radio_counters()->hardwareOverruns, 0u);
    });
    EXPECT_GT(answers_.size(), 35u);
}

TEST_F(ApiRadio, EachPacketHasAStatusAndAMissingStatusCountsAsALoss) {
    air_.weather.perfect = true;
    run([&] {
        ASSERT_EQ(initApi(), RADIO_OK);
        const U32 delivered = Radio_counters()->delivered, lost = Radio_counters()->lost;
        // enough packets for the packet numbers to wrap around twice
        for (size_t i = 1; i <= 300; ++i)
            sendOne(i);
        EXPECT_EQ(answers_, std::string(300, '+'));
        const U8 frame[3] = {'a', 'b', 'c'};
        ASSERT_EQ(Radio_transmit(nullptr, frame, 3), 0);
        OSTimeDly(OS_TICKS_PER_SEC / 20);
        // discards the modem's frame, as if the line had damaged it
        FSMC_write(MAP_SLOT_MODEM, MODEM_RX_RELEASE, 1);
        sendOne(302);
        far_.power(false, soc_.now());
        sendOne(303);
        EXPECT_EQ(answers_.substr(300), "-+-");
        soc_.modem().power(false, soc_.now());
        sendOne(304);
        OSTimeDly(3 * OS_TICKS_PER_SEC); // packets without an answer count as lost after a time
        Radio_receive([](void*, const U8*, U32) {}, nullptr);
        EXPECT_EQ(answers_.substr(303), "-");
        sendOne(305);
        soc_.modem().power(true, soc_.now());
        // after a new set-up, packets that had no result yet never get one
        ASSERT_EQ(initApi(), RADIO_OK);
        far_.power(true, soc_.now());
        OSTimeDly(OS_TICKS_PER_SEC / 10);
        sendOne(1);
        EXPECT_EQ(answers_, "+");
        EXPECT_EQ(Radio_counters()->delivered - delivered, 302u);
        EXPECT_EQ(Radio_counters()->lost - lost, 3u);
    });
}

TEST_F(ApiRadio, WithoutApiModeALinkUsesTransparentMode) {
    for (bool isModem : {true, false})
        run([&] {
            if (isModem)
                soc_.modem().refuseCommand("AP1");
            else
                hide(MODEM_STATUS, MODEM_STATUS_API_MASK);
            ASSERT_EQ(initApi(RADIO_250000), RADIO_OK);
            EXPECT_FALSE(Radio_answers());
            EXPECT_EQ(soc_.modem().parameter("AP"), 0u);
            EXPECT_EQ(soc_.modem().parameter("BD"), 7u);
            ASSERT_TRUE(connect());
            ASSERT_EQ(Link_openChannel(nearPeer_.link(), 0), LINK_OK);
            const size_t before = farPeer_.received.size();
            ASSERT_EQ(Link_send(nearPeer_.link(), 0, key, 16, 0), LINK_OK);
            EXPECT_TRUE(talk([&] { return farPeer_.received.size() > before; }, 5000));
            EXPECT_EQ(answers_, "");
            Link_stop(nearPeer_.link(), us());
            soc_.modem().refuseCommand("");
            ASSERT_EQ(FSMC_init(realPort_, &soc_), FSMC_OK);
        });
}

TEST_F(ApiRadio, AModemThatRefusesBothModesIsReported) {
    run([&] {
        soc_.modem().refuseCommand("AP");
        EXPECT_EQ(initApi(RADIO_250000), RADIO_REFUSED);
        EXPECT_EQ(Radio_failedStep(), 13u) << "step 13 sends ATAP";
        soc_.modem().refuseCommand("");
        EXPECT_EQ(initApi(RADIO_250000), RADIO_OK) << "a second set-up must succeed";
        EXPECT_TRUE(Radio_answers());
    });
}

TEST_F(ApiRadio, EachPacketNamesItsSenderAndReachesItsTarget) {
    HostLine line;
    XBee stranger(line, air_, quick({{"BD", 7}, {"MY", 2}, {"DL", 1}}));
    soc_.onTime([&](uint64_t now) {
        far_.advance(now);
        stranger.advance(now);
        return now + 1'000'000;
    });
    std::map<U16, std::vector<uint8_t>> heard;
    run([&] {
        ASSERT_EQ(initApi(), RADIO_OK);
        farLine_.received.clear();
        line.received.clear();
        line.send({1, 2, 3}, soc_.now());
        OSTimeDly(OS_TICKS_PER_SEC / 20);
        farLine_.send({4, 5, 6}, soc_.now());
        OSTimeDly(OS_TICKS_PER_SEC / 20);
        Radio_receive(
            [](void* all, const U8* bytes, U32 size) {
                auto& h = *static_cast<std::map<U16, std::vector<uint8_t>>*>(all);
                h[Radio_source()].insert(h[Radio_source()].end(), bytes, bytes + size);
            },
            &heard);
        const U8 packet[] = {7, 8};
        for (U16 target : {U16(2), U16(0)}) {
            Radio_setTarget(target);
            EXPECT_EQ(Radio_transmit(nullptr, packet + (target == 0), 1), 0);
        }
        OSTimeDly(OS_TICKS_PER_SEC / 10);
    });
    EXPECT_EQ(heard, (std::map<U16, std::vector<uint8_t>>{{2, {1, 2, 3}}, {0, {4, 5, 6}}}));
    EXPECT_EQ(line.received, (std::vector<uint8_t>{7}));
    EXPECT_EQ(farLine_.received, (std::vector<uint8_t>{8}));
}

class EncryptedRadio : public Radio {
protected:
    EncryptedRadio() : Radio("00112233445566778899AABBCCDDEEFF") {}
    void limitFrames() {
        Link_limitFrame(nearPeer_.link(), LINK_MAX_ENCRYPTED);
        Link_limitFrame(farPeer_.link(), LINK_MAX_ENCRYPTED);
    }
};

TEST_F(EncryptedRadio, MessagesArriveInWholeFrames) {
    air_.weather.perfect = true; // a modem that is as fast as its line
    size_t longest = 0, packets = 0;
    air_.onPacket([&](uint64_t, const RfPacket& packet, RfChannel::Outcome) {
        longest = std::max(longest, packet.bytes.size());
        ++packets;
    });
    const std::vector<U8> message(2000, 'm');
    run([&] {
        limitFrames();
        ASSERT_EQ(init(0, 0, key), RADIO_OK);
        ASSERT_TRUE(connect());
        ASSERT_EQ(Link_openChannel(nearPeer_.link(), 0), LINK_OK);
        ASSERT_TRUE(talk([&] { return Link_statistics(nearPeer_.link())->framesSent > 2; }, 1000));
        talk([] { return false; }, 100);
        packets = 0;
        U32 before = Link_statistics(nearPeer_.link())->framesSent +
                     Link_statistics(farPeer_.link())->framesSent;
        ASSERT_EQ(Link_send(nearPeer_.link(), 0, message.data(), 2000, 0), LINK_OK);
        ASSERT_TRUE(talk([&] { return farPeer_.received.size() == 1; }, 5000));
        ASSERT_EQ(Link_send(farPeer_.link(), 0, message.data(), 2000, 0), LINK_OK);
        ASSERT_TRUE(talk([&] { return nearPeer_.received.size() == 1; }, 5000));
        talk([] { return false; }, 100);
        EXPECT_EQ(packets, Link_statistics(nearPeer_.link())->framesSent +
                               Link_statistics(farPeer_.link())->framesSent - before);
    });
    EXPECT_EQ(soc_.modem().key(), "00112233445566778899AABBCCDDEEFF");
    EXPECT_EQ(longest, 5 + 95u) << "on the air, with the cipher's five bytes";
    EXPECT_EQ(farPeer_.received[0], message);
    EXPECT_EQ(nearPeer_.received[0], message);
}

TEST_F(EncryptedRadio, ASessionNeedsTheSameKey) {
    static U8 other[16];
    std::copy(key, key + 16, other);
    other[15] ^= 1;
    for (const U8* ours : {static_cast<const U8*>(other), static_cast<const U8*>(nullptr)})
        run([&] {
            limitFrames();
            ASSERT_EQ(init(0, 0, ours), RADIO_OK);
            EXPECT_FALSE(connect(3000));
            Link_stop(nearPeer_.link(), us());
        });
    EXPECT_GT(far_.counters().packetsReceived, 3u)
        << "packets must arrive even if they cannot be read";
}

} // namespace
