// SPDX-License-Identifier: MIT
//
// registers_test: tests Hw::Registers, the servant for the registers of any core; IceC's proxies
// call it.

#include "Vmy_port_slot.h"
#include "Vmy_requests_slot.h"
#include "core_slot.h"
#include "icec_pair.h"
#include <gmock/gmock.h>
#include <optional>
extern "C" {
#include "fsmc.h"
#include "hw_registers.h"
#include "map_regs.h"
#include "my_port_regs.h"
#include "my_requests_regs.h"
#include "system_regs.h"
}

namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// A core in its slot, with its servant and a proxy.
template <class Module> class Served {
public:
    template <size_t N> Served(U32 id, const Hw_Register (&table)[N]) {
        EXPECT_EQ(
            Hw_Registers_Core_init(&core_, coreSlot, id, table, Ice_Int(N), &slot_.port, &slot_),
            HW_OK);
        slot_.interrupt_ = [this] {
            ++interrupts_;
            Hw_Registers_Core_interrupt(&core_);
        };
        here_->loop.join(there_->loop);
        auto* servant = reinterpret_cast<Ice_ObjectPtr>(&core_.servant);
        EXPECT_EQ(Ice_ObjectAdapter_add(&there_->adapter, servant, "core"), ICE_OK);
        EXPECT_EQ(Ice_Communicator_stringToProxy(&here_->ic, "core:loop", &prx_), ICE_OK);
    }
    U32 get(const char* name) {
        Ice_Long value = {0, 0};
        Hw_Registers_get_Exception e;
        reason_ = check(Hw_RegistersPrx_get(&prx_, Ice_String_from(name), &value, &e), e);
        EXPECT_EQ(value.high, 0);
        return value.low;
    }
    void set(const char* name, U32 value, S32 high = 0) {
        Ice_Long v = {value, high};
        Hw_Registers_set_Exception e;
        reason_ = check(Hw_RegistersPrx_set(&prx_, Ice_String_from(name), v, &e), e);
    }
    // Begins a call of `wait`. The reply sets `answer_` to the names of the events.
    void wait(Ice_Int ms) {
        answer_.reset();
        call_.completed = [](Hw_Registers_wait_Async* call) {
            auto& self = *static_cast<Served*>(call->context);
            self.reason_ = check(call->status, call->exception);
            self.answer_.emplace();
            for (Ice_Int i = 0; call->status == ICE_OK && i < call->result.size; ++i)
                self.answer_->push_back(str(call->result.data[i]));
        };
        call_.context = this;
        EXPECT_EQ(Hw_RegistersPrx_wait_async(&prx_, ms, &call_), ICE_OK);
        settle();
    }
    // Advances time and calls the servant, as the firmware's task does, until the servant needs no
    // more calls.
    void poll() {
        for (U32 next; (next = Hw_Registers_Core_poll(&core_, slot_.nowMs(&slot_))) != HW_NEVER;)
            slot_.wait(&slot_, 0, next + 1);
        settle();
    }
    void settle() {
        while (Ice_Communicator_poll(&there_->ic, 0) == ICE_OK ||
               Ice_Communicator_poll(&here_->ic, 0) == ICE_OK)
            ;
    }

    CoreSlot<Module> slot_;
    Hw_Registers_Core core_;
    Ice_ObjectPrx prx_;
    std::string reason_; // reason in the exception of the last call
    std::optional<std::vector<std::string>> answer_;
    int interrupts_ = 0;

private:
    template <class Exception> static std::string check(Ice_Status status, const Exception& e) {
        EXPECT_TRUE(status == ICE_OK || status == ICE_USER_EXCEPTION) << status;
        return status == ICE_USER_EXCEPTION ? str(e.u.RegisterError.reason) : "";
    }
    std::unique_ptr<Side> here_ = std::make_unique<Side>(), there_ = std::make_unique<Side>();
    Hw_Registers_wait_Async call_{};
};

class Port : public Served<Vmy_port_slot> {
    static constexpr Hw_Register table[] = {MY_PORT_TABLE};

public:
    Port() : Served(MY_PORT_ID_VALUE, table) {}
};

// Tests with fields and accesses that generated descriptions of third-party cores do not have.
class Requests : public Served<Vmy_requests_slot> {
    static constexpr Hw_Register table[] = {MY_REQUESTS_TABLE,
                                            {{3, "ALL"}, Hw_rw, 8, 0, 32, 0},
                                            {{7, "ALL.LOW"}, Hw_rw, 8, 0, 4, 0},
                                            {{8, "ALL.HIGH"}, Hw_rw, 8, 4, 28, 0},
                                            {{3, "ACT"}, Hw_ws, 9, 0, 32, 0}};

public:
    Requests() : Served(MY_REQUESTS_ID_VALUE, table) {}
};

TEST(HwRegisters, RegistersAreAccessibleByNameAndByteAddress) {
    Port core;
    core.set("DRIVEN", 0xA5);
    EXPECT_EQ(core.slot_.bench_.top().port_out_o, 0xA5);
    core.slot_.bench_.top().port_in_i = 0x42;
    EXPECT_EQ(core.get("LEVELS"), 0x42u);
    EXPECT_EQ(core.get("0x0"), 0x42u);
    EXPECT_EQ(core.get("0x4"), 0xA5u);
    core.set("0x24", 0x5A); // the core uses only the low bits of the address
    EXPECT_EQ(core.slot_.bench_.top().port_out_o, 0x5A);
    EXPECT_EQ(core.get("PAGE"), 0x20u);
    EXPECT_EQ(core.get("DRIVEN"), 0x5Au);
    EXPECT_EQ(core.get("ID"), MY_PORT_ID_VALUE);
    EXPECT_EQ(core.reason_, "");
}

TEST(HwRegisters, TheListContainsAllRegistersAndFields) {
    Port core;
    Hw_RegisterSeq list;
    ASSERT_EQ(Hw_RegistersPrx_list(&core.prx_, &list), ICE_OK);
    std::vector<std::string> names;
    for (Ice_Int i = 0; i < list.size; ++i)
        names.push_back(str(list.data[i].name));
    EXPECT_THAT(names, ElementsAre("ID", "ID.VERSION", "ID.TYPE", "EVENT", "EVENT.CORE",
                                   "EVENT.TIMEOUT", "MASK", "MASK.CORE", "MASK.TIMEOUT", "PAGE",
                                   "PAGE.ADDRESS", "LEVELS", "DRIVEN"));
    const Hw_Register& last = list.data[list.size - 1];
    EXPECT_EQ(last.access, Hw_rw);
    EXPECT_EQ(std::make_tuple(last.word, last.lsb, last.width, last.page),
              std::make_tuple(9, 0, 8, 0));
}

TEST(HwRegisters, WritingAFieldDoesNotChangeItsNeighbours) {
    Requests core;
    core.set("ALL", 0xFFFFFFFF);
    core.set("ALL.LOW", 5);
    EXPECT_EQ(core.get("ALL"), 0xFFFFFFF5u);
    core.set("ALL.HIGH", 0x123);
    EXPECT_EQ(core.get("ALL"), 0x1235u);
    EXPECT_EQ(core.get("ALL.HIGH"), 0x123u);
    EXPECT_EQ(core.reason_, "");
}

TEST(HwRegisters, ErrorsListTheValidNames) {
    Requests core;
    core.get("LEVEL");
    EXPECT_EQ(core.reason_,
              "unknown name 'LEVEL'; expected the byte address of a word of the core, 0x0 to 60 in "
              "hexadecimal, or ID, ID.VERSION, ID.TYPE, EVENT, EVENT.CORE, EVENT.TIMEOUT, "
              "MASK, MASK.CORE, MASK.TIMEOUT, PAGE, PAGE.ADDRESS, REG0, REG1, REG2, REG3, ALL, "
              "ALL.LOW, ALL.HIGH, ACT");
    for (const char* name : {"0x2", "0x40", "0x", "0xG", "0x100000000", "", "REG"}) {
        core.get(name);
        EXPECT_THAT(core.reason_, HasSubstr(std::string("unknown name '") + name + "'"));
    }
    core.set("ID", 1);
    EXPECT_EQ(core.reason_, "ID is ro: it can be read only");
    core.get("ACT");
    EXPECT_EQ(core.reason_, "ACT is ws: a write acts, and there is nothing to read");
    core.set("ALL.LOW", 16);
    EXPECT_EQ(core.reason_, "ALL.LOW takes 0 to 15");
    core.set("ALL", 0, 1);
    EXPECT_EQ(core.reason_, "ALL takes 0 to 4294967295");
    core.set("ALL", 0, -1);
    EXPECT_EQ(core.reason_, "ALL takes 0 to 4294967295");
    core.get(std::string(1000, 'x').c_str());
    EXPECT_EQ(core.reason_.size(), sizeof core.core_.reason - 1);
    EXPECT_EQ(core.reason_.substr(core.reason_.size() - 5), "xx...");
}

TEST(HwRegisters, AnUnansweredAccessIsAnException) {
    Requests core;
    core.get("0xC");
    EXPECT_EQ(core.reason_, "0xC: the core does not answer, or refuses the address");
    core.set("REG3", 1);
    EXPECT_EQ(core.reason_, "REG3: the core does not answer, or refuses the address");
    core.set("REG2", 7);
    EXPECT_EQ(core.get("REG2"), 7u);
    EXPECT_EQ(core.reason_, "");
    core.wait(0);
    core.poll();
    EXPECT_THAT(*core.answer_, ElementsAre("TIMEOUT"));
}

TEST(HwRegisters, WaitReturnsPendingAndNewEvents) {
    Port core;
    core.wait(100);
    EXPECT_FALSE(core.answer_);
    core.set("DRIVEN", 1); // other calls are handled while this call waits
    core.slot_.bench_.top().port_in_i = 0x80;
    core.poll();
    ASSERT_TRUE(core.answer_);
    EXPECT_THAT(*core.answer_, ElementsAre("CORE"));
    // The line from the core stays high. It must cause only one interrupt per `wait`, and the next
    // `wait` must return the event again.
    EXPECT_EQ(core.interrupts_, 1);
    core.slot_.wait(&core.slot_, 0, 5);
    EXPECT_EQ(core.interrupts_, 1);
    core.slot_.bench_.top().port_in_i = 0;
    core.wait(100);
    core.poll();
    EXPECT_THAT(*core.answer_, ElementsAre("CORE"));
    core.wait(20);
    core.poll();
    EXPECT_THAT(*core.answer_, IsEmpty());
    EXPECT_EQ(core.interrupts_, 2);
}

TEST(HwRegisters, OneCallMayWaitForALimitedTime) {
    Port core;
    for (Ice_Int ms : {-1, 600001}) {
        core.wait(ms);
        EXPECT_EQ(core.reason_, "wait takes 0 to 600000 ms");
    }
    core.wait(50);
    Hw_NameSeq events;
    Hw_Registers_wait_Exception e;
    Ice_ObjectPrx other = core.prx_;
    ASSERT_EQ(Hw_RegistersPrx_wait(&other, 10, &events, &e), ICE_USER_EXCEPTION);
    EXPECT_EQ(str(e.u.RegisterError.reason), "another call waits already");
    core.poll();
    EXPECT_THAT(*core.answer_, IsEmpty());
}

TEST(HwRegisters, AnotherCoreInTheSlotIsRefused) {
    CoreSlot<Vmy_port_slot> slot;
    Hw_Registers_Core core;
    EXPECT_EQ(Hw_Registers_Core_init(&core, coreSlot, MY_PORT_ID_VALUE + 1, nullptr, 0, &slot.port,
                                     &slot),
              HW_WRONG_CORE);
}

// Checks that different hashes of registers in chip and firmware are detected. In the system slot
// of this chip, the hash of a slot is 17 times its number.
struct Chip {
    U32 slot = 0;
    static U32 read(void* context, U32 address) {
        if (address == MAP_CONTROL_WINDOW + 4 * SYSTEM_ID)
            return SYSTEM_ID_VALUE;
        return address == place ? static_cast<Chip*>(context)->slot * 17 : 0;
    }
    static void write(void* context, U32 address, U32 value) {
        if (address == place)
            static_cast<Chip*>(context)->slot = value;
    }
    static constexpr U32 place = MAP_CONTROL_WINDOW + 4 * (16 * MAP_SLOT_SYSTEM + SYSTEM_CONTRACT);
};

TEST(Contracts, AMismatchedSlotIsFound) {
    static const FSMC_Port port = {[](void*, U32) -> U8 { return 0; },
                                   [](void*, U32, U8) {},
                                   [](void*, U32) -> U16 { return 0; },
                                   [](void*, U32, U16) {},
                                   Chip::read,
                                   Chip::write};
    static const Hw_Contract built[] = {{{6, "system"}, 0, 0, 0},
                                        {{3, "one"}, 2, 0, 34},
                                        {{3, "two"}, 3, 0, 52},
                                        {{5, "three"}, 63, 0, 63 * 17}};
    Chip chip;
    Hw_Contract found[4];
    ASSERT_EQ(FSMC_init(&port, &chip), FSMC_OK);
    Hw_Contracts_read(found, built, 4);
    EXPECT_TRUE(Hw_Contracts_hold(found, 4, 0));
    EXPECT_TRUE(Hw_Contracts_hold(found, 4, 2));
    EXPECT_FALSE(Hw_Contracts_hold(found, 4, 3));
    EXPECT_TRUE(Hw_Contracts_hold(found, 4, 63));
    EXPECT_FALSE(Hw_Contracts_hold(found, 4, 4)) << "this slot is not in the list";
    EXPECT_EQ(found[2].chip, 51);
    EXPECT_EQ(found[2].firmware, 52);
    EXPECT_STREQ(found[2].block.data, "two");
}

} // namespace
