// SPDX-License-Identifier: MIT
//
// camera_alone: copies registers between the Verilated models of the chip and of the camera. Two
// tables of the models' signals, made from the headers that Verilator generates
// (state_members.awk), give the position of each signal.

#include "camera_alone.h"
#include "VCameraAlone.h"
#include "VCameraAlone___024root.h"
#include "VSoc.h"
#include "VSoc___024root.h"
#include "map_regs.h"
#include "mcb_model.h"
#include <algorithm>
#include <cstddef>
#include <cstring>
#include <map>
#include <string>
#include <vector>
#include <verilated.h>

// offsetof is allowed for these classes, because none of their base classes changes the layout
#pragma GCC diagnostic ignored "-Winvalid-offsetof"

// Generated functions that compute all signals from the registers.
void VSoc___024root___eval_settle(VSoc___024root* root);
void VCameraAlone___024root___eval_settle(VCameraAlone___024root* root);

namespace {

struct Member {
    size_t offset, size;
    const char* path;
};

const Member inAlone[] = {
#define MEMBER(name, path) \
    {offsetof(VCameraAlone___024root, name), sizeof(VCameraAlone___024root::name), path},
#include "sim_camera_members.inc"
#undef MEMBER
};

const Member inChip[] = {
#define MEMBER(name, path) {offsetof(VSoc___024root, name), sizeof(VSoc___024root::name), path},
#include "sim_soc_members.inc"
#undef MEMBER
};

struct Register {
    size_t alone, chip, size; // offsets and size
};

// Inputs of the model in one clock.
struct Inputs {
    uint64_t rdData;
    uint32_t pins;
    bool cmdFull, wrFull, rdEmpty, calibDone;
};

template <class Model> Inputs inputsOf(const Model& model) {
    return {model.mcb_rd_data_i,      model.core_pins_i,         model.mcb_cmd_full_i != 0,
            model.mcb_wr_full_i != 0, model.mcb_rd_empty_i != 0, model.mcb_calib_done_i != 0};
}

template <class Model> void setInputs(Model& model, const Inputs& inputs) {
    model.core_pins_i = inputs.pins;
    model.mcb_rd_data_i = inputs.rdData;
    model.mcb_cmd_full_i = inputs.cmdFull;
    model.mcb_wr_full_i = inputs.wrFull;
    model.mcb_rd_empty_i = inputs.rdEmpty;
    model.mcb_calib_done_i = inputs.calibDone;
}

unsigned char* bytesOf(void* root) {
    return static_cast<unsigned char*>(root);
}

bool begins(const std::string& path, const std::string& with) {
    return path.rfind(with, 0) == 0;
}

// Returns true for a signal that may be a register of a block in both models. Verilator may name a
// register that drives a port after the port, in the scope outside of the block.
bool isCopied(const std::string& path) {
    for (const char* block :
         {"soc.u_camera.", "soc.u_platform.u_memory.", "u_gate_memory.",
          "soc.__Vcellout__u_camera__", "soc.u_platform.__Vcellout__u_memory__"})
        if (begins(path, block))
            return true;
    return path.find('.') == std::string::npos && path != "ticked" && path != "low";
}

// Returns the path of a signal in a form that is the same in both models. Verilator marks a port of
// an instance by a prefix. In a generate block, it puts this prefix in front of the names of the
// blocks; here the prefix is moved behind them, to the name of the port.
std::string pathOf(const Member& member) {
    const std::string path = member.path, prefix = "__Vcellout__";
    const size_t scope = path.rfind('.') + 1;
    if (scope == 0 || !begins(path, prefix))
        return path;
    return path.substr(prefix.size(), scope - prefix.size()) + prefix + path.substr(scope);
}

bool isOfOtherPort(const std::string& path) {
    const std::string ports = "soc.u_platform.u_memory.u_arbiter.g_port[";
    return begins(path, ports) && !begins(path, ports + std::to_string(MAP_NPI_PORT_CAMERA) + "]");
}

// Returns true for words in the read FIFOs and for flags that only another port reads.
bool isReadByOthers(const std::string& path) {
    const std::string read = ".g_fifo.u_read.g_block.word", flag = ".u_fifo.full";
    return isOfOtherPort(path) &&
           (path.find(read) != std::string::npos || path.find(flag) == path.size() - flag.size());
}

// Returns the members that are registers: those that keep each value while all signals are
// computed. The other ones are wires.
template <size_t count, class Root>
std::map<std::string, const Member*> registersOf(const Member (&members)[count], Root* root,
                                                 void (*settle)(Root*)) {
    std::map<std::string, const Member*> found;
    const std::vector<unsigned char> before(bytesOf(root), bytesOf(root) + sizeof *root);
    for (const Member& member : members) {
        const std::string path = pathOf(member);
        if (!isCopied(path))
            continue;
        bool keeps = true;
        for (unsigned char value : {0, 1}) {
            bytesOf(root)[member.offset] = value;
            settle(root);
            keeps = keeps && bytesOf(root)[member.offset] == value;
            std::memcpy(bytesOf(root), before.data(), before.size());
        }
        if (keeps)
            found.emplace(path, &member);
    }
    return found;
}

} // namespace

struct CameraAlone::Parts {
    Parts(VSoc& soc, VerilatedContext* context) : chip(soc), alone(context) {}

    VSoc& chip;
    VCameraAlone alone;
    std::vector<Register> registers;
    bool isReady = false;
    std::vector<std::string> missing;  // registers that are only in one model
    uint64_t outputs = 0;              // values of others_o
    std::vector<unsigned char> marked; // state at mark()
    Inputs markedInputs{};
    bool isMarked = false;
    std::vector<Inputs> recorded; // inputs of the clocks since mark()

    void prepare();
    void toChip(const unsigned char* from, const Inputs& inputs);
};

// Finds the registers, and their places in both models. The models are complete if each register
// is in both. Exceptions are registers that only another memory port reads; they keep their state
// while nothing is pushed or popped.
void CameraAlone::Parts::prepare() {
    if (isReady)
        return;
    isReady = true;
    for (unsigned clock = 0; clock < 2; ++clock) { // until the constant inputs have been sampled
        alone.tick_i = !alone.tick_i;
        alone.eval();
    }
    std::map<std::string, const Member*> places;
    for (const Member& member : inChip)
        if (isCopied(pathOf(member)))
            places.emplace(pathOf(member), &member);
    const auto theirs = registersOf(inAlone, alone.rootp, VCameraAlone___024root___eval_settle);
    const auto ours = registersOf(inChip, chip.rootp, VSoc___024root___eval_settle);
    for (const auto& [path, member] : theirs) {
        const auto place = places.find(path);
        if (place == places.end() || place->second->size != member->size)
            missing.push_back(path);
        else
            registers.push_back({member->offset, place->second->offset, member->size});
    }
    for (const auto& [path, member] : ours)
        if (!theirs.count(path) && !isReadByOthers(path))
            missing.push_back(path);
}

CameraAlone::CameraAlone(VSoc& chip) {
#if !defined(ICESOC_TRACE) && !defined(ICESOC_COVERAGE)
    if (!*chip.contextp()->commandArgsPlusMatch("cdc_random"))
        parts_ = std::make_unique<Parts>(chip, chip.contextp());
#else
    (void)chip;
#endif
}

CameraAlone::~CameraAlone() {
    if (parts_)
        parts_->alone.final();
}

bool CameraAlone::exists() const {
    return parts_ && parts_->missing.empty();
}

std::vector<std::string> CameraAlone::missing() {
    if (!parts_)
        return {};
    parts_->prepare();
    return parts_->missing;
}

// If a pixel clock rises with the new inputs, eval() moves the camera's registers; so they are
// copied after it.
void CameraAlone::load() {
    Parts& p = *parts_;
    p.prepare();
    setInputs(p.alone, inputsOf(p.chip));
    p.alone.eval();
    for (const Register& r : p.registers)
        std::memcpy(bytesOf(p.alone.rootp) + r.alone, bytesOf(p.chip.rootp) + r.chip, r.size);
    VCameraAlone___024root___eval_settle(p.alone.rootp);
    p.outputs = p.alone.others_o;
    p.isMarked = false;
    p.recorded.clear();
}

bool CameraAlone::follows() {
    Parts& p = *parts_;
    setInputs(p.alone, inputsOf(p.chip));
    p.alone.tick_i = !p.alone.tick_i;
    p.alone.eval();
    return p.missing.empty() && p.alone.empty_o && p.alone.others_o == p.outputs &&
           std::all_of(p.registers.begin(), p.registers.end(), [&](const Register& r) {
               return std::memcmp(bytesOf(p.alone.rootp) + r.alone, bytesOf(p.chip.rootp) + r.chip,
                                  r.size) == 0;
           });
}

bool CameraAlone::clock(McbModel& memory) {
    Parts& p = *parts_;
    sampleMcb(p.alone, memory);
    driveMcb(p.alone, memory);
    p.alone.core_pins_i = p.chip.core_pins_i;
    p.alone.tick_i = !p.alone.tick_i;
    p.alone.eval();
    if (p.isMarked)
        p.recorded.push_back(inputsOf(p.alone));
    return p.alone.others_o == p.outputs;
}

void CameraAlone::mark() {
    Parts& p = *parts_;
    const unsigned char* state = bytesOf(p.alone.rootp);
    p.marked.assign(state, state + sizeof *p.alone.rootp);
    p.markedInputs = inputsOf(p.alone);
    p.isMarked = true;
    p.recorded.clear();
}

// As in load(), the registers are copied after the chip has seen the level of the pixel clock.
void CameraAlone::Parts::toChip(const unsigned char* from, const Inputs& inputs) {
    setInputs(chip, inputs);
    chip.eval();
    for (const Register& r : registers)
        std::memcpy(bytesOf(chip.rootp) + r.chip, from + r.alone, r.size);
    VSoc___024root___eval_settle(chip.rootp);
}

void CameraAlone::store() {
    parts_->toChip(bytesOf(parts_->alone.rootp), inputsOf(parts_->alone));
}

uint64_t CameraAlone::storeMarked() {
    parts_->toChip(parts_->marked.data(), parts_->markedInputs);
    return parts_->recorded.size();
}

void CameraAlone::repeat(uint64_t number) {
    setInputs(parts_->chip, parts_->recorded.at(number));
}
