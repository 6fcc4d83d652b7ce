// SPDX-License-Identifier: MIT
//
// keys_test: tests the change of a key in the vehicle's key slots. The power is cut at every word
// that is written, and the ground station stops after every step.

#include "link_pair.h"
#include <array>
#include <gtest/gtest.h>

extern "C" {
#include "link_broadcast.h"
#include "uav_keys.h"
}

namespace {

using Key = std::array<U8, LINK_KEY_BYTES>;

constexpr Key oldKey = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16},
              newKey = {101, 102, 103, 104, 105, 106, 107, 108,
                        109, 110, 111, 112, 113, 114, 115, 116},
              foreignKey = {9};
constexpr U32 address = 0x1234;

// A vehicle (b) with key slots, and a ground station (a) with a key file.
class KeyedVehicle : public LinkPair {
public:
    explicit KeyedVehicle(uint64_t seed) : LinkPair(seed) {
        UAV_useBoard(&board, this);
        UAV_provide(address, oldKey.data());
        bootVehicle();
    }
    void bootVehicle() {
        cutAfter = never;
        isDead = false;
        b.boot();
        keys = UAV_giveKeys(0, b.link());
        b.start();
    }
    // Starts the ground's program with this key file. Returns true if a session was established in
    // time.
    bool meets(const std::vector<Key>& file, uint64_t patienceUs = 20'000'000) {
        a.boot();
        for (size_t slot = 0; slot < file.size(); ++slot)
            Link_setKey(a.link(), static_cast<int>(slot), file[slot].data(), LINK_GROUND | address);
        a.start();
        const U32 sessions = Link_statistics(b.link())->sessions;
        auto isOver = [&] { // the vehicle must also be in the new session
            UAV_confirmKey(0, b.link());
            return isDead || (bothUp() && Link_statistics(b.link())->sessions != sessions);
        };
        const bool isMet = until(isOver, patienceUs) && !isDead;
        UAV_confirmKey(0, b.link());
        return isMet && !isDead;
    }
    // Changes the key in the same way as sw/ground/clients/change_key.py, or does only the first
    // `steps` of the change. Returns the new content of the ground station's key file.
    std::vector<Key> change(int steps = 3) {
        const std::vector<Key> before = {oldKey}, both = {newKey, oldKey}, after = {newKey};
        if (steps < 1)
            return before;
        if (steps < 2 || !meets(before) || !UAV_setNextKey(0, b.link(), newKey.data()) || isDead)
            return both;
        return steps < 3 || !meets(after) || UAV_countKeys(0) != 1 ? both : after;
    }
    bool hasKey(const Key& wanted) {
        Key key{};
        for (int slot = 0; slot < int(BACKUP_SLOTS); ++slot)
            if (UAV_readKey(0, slot, key.data()) && key == wanted)
                return true;
        return false;
    }

    static constexpr unsigned never = ~0u;
    std::array<U32, BACKUP_WORDS> words{};
    unsigned stores = 0, cutAfter = never; // number of stores after which the power fails
    bool isDead = false;
    int keys = 0;

private:
    static KeyedVehicle& self(void* context) { return *static_cast<KeyedVehicle*>(context); }
    static constexpr UAV_Board board = {
        [](void*) -> U32 { return 4; },
        [](void* c, U32 word) -> U32 { return self(c).words.at(word); },
        [](void* c, U32 word, U32 value) {
            KeyedVehicle& v = self(c);
            v.isDead = v.isDead || v.stores++ == v.cutAfter;
            if (!v.isDead)
                v.words.at(word) = value;
        }};
};

TEST(Keys, AVehicleHasAKeyOrIsOpenOrNeither) {
    KeyedVehicle vehicle(1);
    EXPECT_EQ(UAV_countKeys(0), 1);
    EXPECT_FALSE(UAV_isOpen());
    UAV_provide(address, nullptr);
    EXPECT_EQ(UAV_countKeys(0), 0);
    EXPECT_TRUE(UAV_isOpen());
    vehicle.words = {}; // all words are lost because the battery was empty
    EXPECT_EQ(UAV_countKeys(0), 0);
    EXPECT_FALSE(UAV_isOpen());
}

TEST(Keys, TheAddressOfTheFirstGroundIsNotStored) {
    KeyedVehicle vehicle(1);
    for (const int isFlying : {0, 1}) {
        UAV_setFlying(isFlying);
        EXPECT_EQ(UAV_addressOf(0), 0u) << "flying: " << isFlying;
        EXPECT_EQ(UAV_isFlying(), isFlying);
    }
    EXPECT_EQ(UAV_address(), address);
}

TEST(Keys, ACorruptedSlotIsEmpty) {
    KeyedVehicle vehicle(1);
    for (U32 bit = 0; bit < 5 * 32; ++bit) {
        vehicle.words[bit / 32] ^= 1u << bit % 32;
        EXPECT_EQ(UAV_countKeys(0), 0) << bit;
        vehicle.words[bit / 32] ^= 1u << bit % 32;
    }
    EXPECT_EQ(UAV_countKeys(0), 1);
}

// A member of the group could send any sequence number, even one that is too high.
TEST(Keys, AHighSequenceNumberDoesNotBlockBroadcasts) {
    KeyedVehicle vehicle(1);
    const auto opens = [](const Key& key, U32 number) {
        U8 packet[LINK_MAX_FRAME] = {};
        return UAV_openBroadcast(packet, Link_sealBroadcast(packet, 5, key.data(), number)) == 5;
    };
    const U32 now = 115'000'000; // November 2026
    UAV_providePeer(UAV_GROUP, UAV_EVERYBODY, newKey.data());
    EXPECT_FALSE(opens(newKey, 0xFFFFFFFF))
        << "the highest number must be refused even if no number is known yet";
    UAV_setCallNumber(now);
    EXPECT_FALSE(opens(newKey, now))
        << "a call that was recorded before the vehicle joined must be refused";
    EXPECT_TRUE(opens(newKey, now + 1));
    EXPECT_FALSE(opens(newKey, 0xFFFFFFFF));
    EXPECT_FALSE(opens(newKey, now + 2 + UAV_MOST_AHEAD));
    EXPECT_TRUE(opens(newKey, now + 2));
    EXPECT_TRUE(opens(newKey, now + 2 + UAV_MOST_AHEAD))
        << "after a year without a call, the number must be accepted";
    EXPECT_FALSE(opens(newKey, now + 3));
    UAV_providePeer(UAV_GROUP, UAV_EVERYBODY, oldKey.data());
    UAV_setCallNumber(now + 3);
    EXPECT_FALSE(opens(oldKey, now + 3));
    EXPECT_TRUE(opens(oldKey, now + 4)) << "the group's new key starts at its own number";
}

TEST(Keys, TheGroupKeyOpensEachBroadcastOnceUntilTheVehicleIsProvisionedAgain) {
    KeyedVehicle vehicle(1);
    const auto opens = [](const Key& key, U32 number) {
        U8 packet[LINK_MAX_FRAME] = {};
        return UAV_openBroadcast(packet, Link_sealBroadcast(packet, 5, key.data(), number)) == 5;
    };
    EXPECT_FALSE(UAV_isOfGroup())
        << "a vehicle with a key and without the group key is not in the group";
    UAV_providePeer(UAV_GROUP, UAV_EVERYBODY, newKey.data());
    EXPECT_TRUE(UAV_isOfGroup());
    EXPECT_EQ(UAV_countKeys(0), 1);
    EXPECT_EQ(UAV_addressOf(UAV_OBSERVER), UAV_NO_PEER);
    EXPECT_FALSE(opens(oldKey, 77));
    EXPECT_TRUE(opens(newKey, 77));
    UAV_providePeer(UAV_GROUP, UAV_EVERYBODY, newKey.data());
    EXPECT_FALSE(opens(newKey, 77))
        << "a recorded call must be refused, even if the same key is provided again";
    EXPECT_TRUE(opens(newKey, 78));
    UAV_provide(address, nullptr);
    EXPECT_TRUE(UAV_isOfGroup()) << "a vehicle in open mode is in the group";
    EXPECT_FALSE(opens(newKey, 80));
    EXPECT_TRUE(opens(Key{}, 1));
    vehicle.words = {};
    EXPECT_FALSE(UAV_isOfGroup());
}

TEST(Keys, AfterAChangeTheOldKeyIsRejected) {
    KeyedVehicle vehicle(testSeed());
    EXPECT_EQ(vehicle.change(), std::vector<Key>{newKey});
    EXPECT_FALSE(vehicle.hasKey(oldKey));
    EXPECT_FALSE(vehicle.meets({oldKey}, 5'000'000));
    EXPECT_TRUE(vehicle.meets({newKey}));
    vehicle.bootVehicle();
    EXPECT_FALSE(vehicle.meets({oldKey}, 5'000'000));
    EXPECT_TRUE(vehicle.meets({newKey}));
}

TEST(Keys, ASecondGroundHasSeparateKeys) {
    KeyedVehicle vehicle(testSeed());
    EXPECT_EQ(UAV_addressOf(UAV_OBSERVER), UAV_NO_PEER);
    UAV_providePeer(UAV_OBSERVER, 0xF0, nullptr);
    EXPECT_EQ(UAV_addressOf(UAV_OBSERVER), UAV_NO_PEER)
        << "a vehicle with a key must not accept an observer without a key";
    UAV_providePeer(UAV_OBSERVER, 0xF0, foreignKey.data());
    EXPECT_EQ(UAV_addressOf(UAV_OBSERVER), 0xF0u);
    EXPECT_EQ(vehicle.change(), std::vector<Key>{newKey});
    Key key{};
    EXPECT_TRUE(UAV_readKey(1, 0, key.data()) && key == foreignKey);
    EXPECT_EQ(UAV_countKeys(1), 1);
    EXPECT_FALSE(UAV_isKey(foreignKey.data()))
        << "the observer's key must not permit access by the serial port";
    UAV_provide(address, nullptr);
    EXPECT_EQ(UAV_countKeys(1), 0);
    UAV_providePeer(UAV_OBSERVER, 0xF0, nullptr);
    EXPECT_EQ(UAV_addressOf(UAV_OBSERVER), 0xF0u)
        << "a vehicle in open mode accepts an observer without a key";
}

TEST(Keys, TheVehicleWithTheLowerAddressActsAsTheGround) {
    KeyedVehicle vehicle(testSeed());
    for (U32 fellow : {address - 1, address + 1}) {
        UAV_providePeer(UAV_VEHICLE, fellow, foreignKey.data());
        EXPECT_EQ(UAV_addressOf(UAV_VEHICLE), fellow);
        EXPECT_EQ(UAV_addressOf(UAV_OBSERVER), UAV_NO_PEER);
        EXPECT_EQ(UAV_hasGroundsPart(), fellow > address);
        vehicle.a.boot();
        vehicle.b.boot();
        UAV_giveKeys(UAV_VEHICLE, vehicle.b.link());
        Link_setKey(vehicle.a.link(), 0, foreignKey.data(),
                    fellow > address ? fellow : LINK_GROUND | address);
        EXPECT_TRUE(vehicle.connect());
    }
    UAV_providePeer(UAV_OBSERVER, 0xFFFE, newKey.data());
    EXPECT_EQ(UAV_addressOf(UAV_OBSERVER), 0xFFFEu)
        << "the observer must be accepted while the vehicle has a fellow";
    vehicle.a.boot();
    vehicle.b.boot();
    UAV_giveKeys(UAV_OBSERVER, vehicle.b.link());
    Link_setKey(vehicle.a.link(), 0, newKey.data(), LINK_GROUND | address);
    EXPECT_TRUE(vehicle.connect())
        << "a peer with the role of a ground station must connect, whatever its address";
    UAV_provide(address, oldKey.data());
    EXPECT_EQ(UAV_addressOf(UAV_VEHICLE), UAV_NO_PEER);
}

TEST(Keys, AGroundWithoutTheKeyIsRefused) {
    KeyedVehicle vehicle(testSeed());
    EXPECT_FALSE(vehicle.meets({}, 5'000'000)) << "a ground station without a key must be refused";
    EXPECT_FALSE(vehicle.meets({foreignKey}, 5'000'000));
    EXPECT_FALSE(UAV_setNextKey(0, vehicle.b.link(), newKey.data()))
        << "a key change without a session must be refused";
    EXPECT_TRUE(vehicle.meets({foreignKey, oldKey})) << "one correct key of two must be sufficient";
}

TEST(Keys, ASessionUnderTheOldKeyKeepsBothKeys) {
    KeyedVehicle vehicle(testSeed());
    vehicle.change(2);
    vehicle.bootVehicle();
    EXPECT_EQ(vehicle.keys, 2);
    ASSERT_TRUE(vehicle.meets({oldKey}));
    EXPECT_EQ(UAV_countKeys(0), 2);
    ASSERT_TRUE(vehicle.meets({newKey}));
    EXPECT_EQ(UAV_countKeys(0), 1);
    EXPECT_TRUE(vehicle.hasKey(newKey));
}

TEST(Keys, AnotherNextKeyReplacesThePreviousOne) {
    KeyedVehicle vehicle(testSeed());
    ASSERT_TRUE(vehicle.meets({oldKey}));
    EXPECT_TRUE(UAV_setNextKey(0, vehicle.b.link(), oldKey.data()));
    EXPECT_EQ(UAV_countKeys(0), 1);
    EXPECT_TRUE(UAV_setNextKey(0, vehicle.b.link(), foreignKey.data()));
    EXPECT_TRUE(UAV_setNextKey(0, vehicle.b.link(), newKey.data()));
    EXPECT_FALSE(vehicle.hasKey(foreignKey));
    EXPECT_TRUE(vehicle.hasKey(newKey) && vehicle.hasKey(oldKey));
}

TEST(Keys, AnAbortedChangeOfKeysLeavesAWorkingKey) {
    for (int steps = 0; steps <= 3; ++steps) {
        KeyedVehicle vehicle(testSeed());
        const std::vector<Key> file = vehicle.change(steps);
        vehicle.bootVehicle();
        EXPECT_TRUE(vehicle.meets(file)) << steps;
    }
}

TEST(Keys, APowerLossAtAnyWordLeavesAWorkingKey) {
    bool wasCut = true;
    for (unsigned cut = 0; wasCut; ++cut) {
        KeyedVehicle vehicle(testSeed());
        vehicle.cutAfter = vehicle.stores + cut;
        const std::vector<Key> file = vehicle.change();
        wasCut = vehicle.isDead;
        vehicle.bootVehicle();
        ASSERT_GE(vehicle.keys, 1) << "after " << cut << " words";
        ASSERT_TRUE(vehicle.meets(file)) << "after " << cut << " words";
        vehicle.bootVehicle();
        if (vehicle.hasKey(newKey)) { // removes the old key, as a complete change does
            ASSERT_TRUE(vehicle.meets({newKey})) << "after " << cut << " words";
            EXPECT_EQ(UAV_countKeys(0), 1) << "after " << cut << " words";
        }
        // a complete change must still be possible
        ASSERT_TRUE(vehicle.meets({newKey, oldKey})) << "after " << cut << " words";
        ASSERT_TRUE(UAV_setNextKey(0, vehicle.b.link(), newKey.data()));
        ASSERT_TRUE(vehicle.meets({newKey})) << "after " << cut << " words";
        EXPECT_EQ(UAV_countKeys(0), 1);
    }
}

} // namespace
