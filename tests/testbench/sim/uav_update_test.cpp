// SPDX-License-Identifier: MIT
//
// uav_update_test: tests an update of the firmware's host build over the air. A part of the
// memory of this process serves as the vehicle's flash.

#include "ground.h"
#include "keys.h"
#include "uav_machine.h"
#include <cstring>
#include <gmock/gmock.h>
#include <lz4.h>

extern "C" {
#include "signature.h"
#include "uav_update.h"
}

namespace {

using Bytes = std::vector<uint8_t>;
constexpr uint32_t product = 77, imageBytes = 1024, half = imageBytes / 2;
bool restarted; // true if the firmware has requested a restart

struct Flash {
    static uint8_t* at(void* context, U32 offset) {
        return static_cast<Flash*>(context)->bytes.data() + offset;
    }
    Bytes bytes = Bytes(1 << 20, 0xFF);
    Slots_Port port{
        &slots_firmware,
        this,
        [](void* c, U32 offset, U8* to, U32 count) { std::copy_n(at(c, offset), count, to); },
        [](void* c, U32 offset) {
            std::fill_n(at(c, offset), slots_firmware.sectorBytes, uint8_t{0xFF});
            return 1;
        },
        [](void* c, U32 offset, const U8* from, U32 count) {
            for (U32 i = 0; i < count; ++i)
                at(c, offset)[i] &= from[i];
            return 1;
        },
        Signature_isGood,
        Signature_digest,
        reinterpret_cast<const Slots_Keys*>(bytes.data() + SLOTS_KEYS_AT),
        bytes.data()};
};

class UavUpdate : public ::testing::Test, protected GroundAndChip {
protected:
    void SetUp() override {
        const Slots_Header list = ours.list(1, ours, ours), running = headerOf(5, 0);
        std::memcpy(&flash.bytes[SLOTS_KEYS_AT], &list, sizeof list);
        std::memcpy(&flash.bytes[Slots_at(&slots_firmware, 0)], &running, sizeof running);
        Slots_set(&flash.port, 0, SLOTS_CONFIRMED);
        // the slot contains other data, so it must be erased first
        flash.bytes[Slots_at(&slots_firmware, 1) + 3] = 0;
        for (size_t i = 0; i < imageBytes; ++i)
            // both halves of the image have the same contents
            image[i] = static_cast<uint8_t>(i * i / 64);
        std::copy_n(image.begin(), half - 16, image.begin() + half);
        uav_update[UAV_FIRMWARE] = {&flash.port, 0, product};
        uav_restart = [] { restarted = true; };
        restarted = false;
        soc.reset();
    }
    void TearDown() override { uav_update[UAV_FIRMWARE] = uav_update[UAV_BITSTREAM] = {}; }

    Slots_Header headerOf(uint32_t version, uint32_t slot) {
        return Image(slots_firmware, product, version, slot, image, ours).header;
    }
    Bytes encoded(const Slots_Header& header) {
        Bytes bytes(1 + sizeof header, static_cast<uint8_t>(sizeof header));
        std::memcpy(&bytes[1], &header, sizeof header);
        return bytes;
    }
    static Bytes piece(uint32_t offset, uint32_t size, const Bytes& data) {
        Bytes bytes;
        const auto count = static_cast<uint32_t>(data.size());
        for (uint32_t number : {offset, size})
            for (int i = 0; i < 4; ++i)
                bytes.push_back(static_cast<uint8_t>(number >> 8 * i));
        bytes.push_back(255);
        for (int i = 0; i < 4; ++i)
            bytes.push_back(static_cast<uint8_t>(count >> 8 * i));
        bytes.insert(bytes.end(), data.begin(), data.end());
        return bytes;
    }
    // Returns the second half of the image, compressed with the first half as the dictionary.
    Bytes packedHalf() {
        LZ4_stream_t stream;
        LZ4_initStream(&stream, sizeof stream);
        LZ4_loadDict(&stream, reinterpret_cast<const char*>(image.data()), half);
        Bytes packed(half);
        packed.resize(static_cast<size_t>(
            LZ4_compress_fast_continue(&stream, reinterpret_cast<const char*>(&image[half]),
                                       reinterpret_cast<char*>(packed.data()), half, half, 1)));
        return packed;
    }
    // A call, and the first byte that its reply must have; 0xFF means any byte. Calls of getStatus
    // are repeated until the reply has this byte.
    struct Step {
        const char* operation;
        Bytes parameters;
        uint8_t wanted;
    };
    // Makes the calls one after the other, and continues until `over` returns true.
    void fly(const std::vector<Step>& steps, const std::function<bool()>& over) {
        size_t step = 0;
        int sent = 0;
        const auto isStatus = [&](size_t at) {
            return std::strcmp(steps[at].operation, "getStatus") == 0;
        };
        const auto script = [&] {
            if (ground.validated && step < steps.size() &&
                sent == static_cast<int>(ground.replies.size())) {
                if (sent) {
                    const uint8_t answer = ground.messages[sent].at(25);
                    const bool waits = isStatus(step) && answer != steps[step].wanted;
                    if (!waits) {
                        EXPECT_EQ(answer, steps[step].wanted) << "step " << step;
                    }
                    step += !waits;
                }
                if (step < steps.size())
                    ground.call(++sent, "update", steps[step].operation, isStatus(step) ? 2 : 0,
                                steps[step].parameters);
            }
            return (step == steps.size() && over()) || HasFailure();
        };
        EXPECT_TRUE(flies(soc, script, 4)) << "at step " << step;
    }

    Flash flash;
    Bytes image = Bytes(imageBytes);
};

// error numbers in Update.ice
enum : uint8_t { None, Foreign, Old, WrongSignature, Misplaced = 8 };
enum : uint8_t { Idle, Receiving = 3, Ready = 5 };

TEST_F(UavUpdate, AnImageArrivesInPiecesAndIsStarted) {
    const Bytes first(image.begin(), image.begin() + half), packed = packedHalf();
    ASSERT_LT(packed.size(), half / 4);
    fly({{"getStatus", {}, Idle},
         {"begin", encoded(headerOf(6, 1)), None},
         {"getStatus", {}, Receiving},
         // refused, because this compressed piece refers to the first half, which has not been sent
         // yet
         {"write", piece(half, half, packed), Misplaced},
         {"write", piece(0, half, first), None},
         {"write", piece(half, half + 4, packed), Misplaced},
         {"write", piece(half, half, packed), None},
         {"finish", {}, None},
         {"getStatus", {}, Ready}},
        [] { return restarted; });
    EXPECT_EQ(Slots_choose(&flash.port, product, 1), 1u);
    EXPECT_TRUE(std::equal(image.begin(), image.end(),
                           flash.bytes.begin() + Slots_at(&slots_firmware, 1) + SLOTS_IMAGE_AT));
}

TEST_F(UavUpdate, ARefusedImageChangesNothing) {
    const Bytes before = flash.bytes;
    Slots_Header changed = headerOf(6, 1);
    ++changed.bytes, changed.bytes += 3;
    fly({{"begin", encoded(headerOf(5, 1)), Old},
         {"begin", encoded(headerOf(6, 0)), Foreign},
         {"begin", {3, 1, 2, 3}, Foreign}, // these bytes are not a header
         {"begin", encoded(changed), None},
         {"getStatus", {}, Idle}},
        [] { return true; });
    EXPECT_EQ(ground.messages.rbegin()->second.at(26), WrongSignature);
    EXPECT_EQ(flash.bytes, before);
    EXPECT_FALSE(restarted);
}

TEST_F(UavUpdate, UnconfirmedFirmwareIsDroppedAfterAMinute) {
    std::fill_n(flash.bytes.begin() + Slots_at(&slots_firmware, 0) + SLOTS_CONFIRMED, 4,
                uint8_t{0xFF});
    EXPECT_TRUE(
        flies(soc, [] { return restarted; }, 2, [](UavMachine& machine) { machine.hurry(100); }));
    EXPECT_GT(static_cast<double>(soc.now()), 0.6e9);
}

TEST_F(UavUpdate, InFlightImagesAndKeysAreRefused) {
    struct Call {
        Ground::Call call;
        int status;
        const char* exception;
    };
    uav_update[UAV_BITSTREAM] = {&flash.port, 0, product};
    const Bytes key(17, 16), header = encoded(headerOf(6, 1)), data(half), before = flash.bytes;
    const std::vector<Call> calls = {
        {{"uav", "setFlightState", 2, {1}}, 0, ""},
        {{"update", "begin", 0, header}, 1, "::Update::InFlight"},
        {{"update", "write", 0, piece(0, half, data)}, 1, "::Update::InFlight"},
        {{"update", "finish", 0, {}}, 1, "::Update::InFlight"},
        {{"update", "confirm", 0, {}}, 1, "::Update::InFlight"},
        {{"fpga", "begin", 0, header}, 1, "::Update::InFlight"},
        {{"keys", "setNextKey", 2, key}, 1, "::Autopilot::InFlight"},
        {{"update", "getStatus", 2, {}}, 0, ""}};
    const std::vector<Call> landed = {{{"keys", "setNextKey", 2, key}, 1, "::Autopilot::InFlight"},
                                      {{"uav", "setFlightState", 2, {0}}, 0, ""},
                                      {{"keys", "setNextKey", 2, key}, 0, ""},
                                      {{"update", "begin", 0, header}, 0, ""}};
    // contents of the memory that the battery preserves
    SimulatedBoard::Words words = SimulatedBoard().words;
    for (const auto& list : {calls, landed}) {
        EXPECT_EQ(flash.bytes, before);
        std::vector<Ground::Call> made;
        for (const Call& call : list)
            made.push_back(call.call);
        soc.reset();
        ground.start();
        const auto script = ground.calling(made);
        UavMachine machine(soc, [&] { return !script() && within(4); });
        machine.board.words = words;
        machine.run();
        words = machine.board.words;
        ASSERT_EQ(ground.replies.size(), list.size());
        for (const auto& [id, status] : ground.replies) {
            const auto& message = ground.messages[id];
            const Call& call = list[static_cast<size_t>(id - 1)];
            EXPECT_EQ(status, call.status) << call.call.object << ' ' << call.call.operation;
            EXPECT_THAT(std::string(message.begin(), message.end()),
                        testing::HasSubstr(call.exception));
        }
    }
}

// "keys" is added last, so the adapter has room for all servants of the vehicle and of the cores.
TEST_F(UavUpdate, AVehicleWithBothKindsOfImagesAlsoServesKeys) {
    uav_update[UAV_BITSTREAM] = {&flash.port, 0, product};
    EXPECT_TRUE(flies(soc, ground.pinging(1, "keys"), 4));
    EXPECT_THAT(ground.replies, testing::ElementsAre(testing::Pair(1, 0)));
}

} // namespace
