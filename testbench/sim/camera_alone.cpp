// SPDX-License-Identifier: MIT
//
// camera_alone: copies registers between the Verilated models of the chip, of the camera and of the
// memory. Tables of the models' signals (model_state.h) give the position of each signal.

#include "camera_alone.h"
#include "VCameraAlone.h"
#include "VMemoryAlone.h"
#include "VSoc.h"
#include "map_regs.h"
#include "mcb_model.h"
#include "model_state.h"
#include <algorithm>
#include <cstddef>
#include <cstring>
#include <map>
#include <string>
#include <vector>
#include <verilated.h>

extern const ModelState VSoc_state, VCameraAlone_state, VMemoryAlone_state;

// Generated functions: eval_settle computes all signals from the registers; eval does what the
// model's eval() does, without the work for initial blocks and messages.
void VSoc___024root___eval_settle(VSoc___024root* root);
void VCameraAlone___024root___eval_settle(VCameraAlone___024root* root);
void VMemoryAlone___024root___eval_settle(VMemoryAlone___024root* root);
void VCameraAlone___024root___eval(VCameraAlone___024root* root);
void VMemoryAlone___024root___eval(VMemoryAlone___024root* root);

namespace {

struct Register {
    size_t alone, chip, size; // offsets and size
};

// Inputs from the MCB in one clock.
struct McbInputs {
    uint64_t rdData;
    bool cmdFull, wrFull, rdEmpty, calibDone;

    bool operator==(const McbInputs& o) const {
        return rdData == o.rdData && cmdFull == o.cmdFull && wrFull == o.wrFull &&
               rdEmpty == o.rdEmpty && calibDone == o.calibDone;
    }
};

struct Inputs {
    McbInputs mcb;
    uint32_t pins;
};

template <class Model> McbInputs mcbInputsOf(const Model& model) {
    return {model.mcb_rd_data_i, model.mcb_cmd_full_i != 0, model.mcb_wr_full_i != 0,
            model.mcb_rd_empty_i != 0, model.mcb_calib_done_i != 0};
}

template <class Model> void setMcbInputs(Model& model, const McbInputs& inputs) {
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
    if (path.empty())
        return false;
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
std::string pathOf(const ModelMember& member) {
    const std::string path = member.path, prefix = "__Vcellout__";
    const size_t scope = path.rfind('.') + 1;
    if (scope == 0 || !begins(path, prefix))
        return path;
    return path.substr(prefix.size(), scope - prefix.size()) + prefix + path.substr(scope);
}

// Returns true for a flip-flop behind an input of sim_camera.v.
bool isOfInputs(const std::string& path) {
    return path.find('.') == std::string::npos;
}

bool isOfOtherPort(const std::string& path) {
    const std::string ports = "soc.u_platform.u_memory.u_arbiter.g_port[";
    return begins(path, ports) && !begins(path, ports + std::to_string(MAP_NPI_PORT_CAMERA) + "]");
}

bool isReadWord(const std::string& path) {
    return path.find(".g_fifo.u_read.g_block.word") != std::string::npos;
}

// Returns true for words in the read FIFOs and for flags that only another port reads.
bool isReadByOthers(const std::string& path) {
    const std::string flag = ".u_fifo.full";
    return isOfOtherPort(path) &&
           (isReadWord(path) || path.find(flag) == path.size() - flag.size());
}

// Returns the members that are registers: those that keep each value while all signals are
// computed. The other ones are wires.
template <class Root>
std::map<std::string, const ModelMember*> registersOf(const ModelState& state, Root* root,
                                                      void (*settle)(Root*)) {
    std::map<std::string, const ModelMember*> found;
    const std::vector<unsigned char> before(bytesOf(root), bytesOf(root) + state.size);
    for (const ModelMember& member : state) {
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
    Parts(VSoc& soc, VerilatedContext* context)
        : chip(soc), camera(context, VCameraAlone_state), memory(context, VMemoryAlone_state) {}

    // One of the small models, and its registers in the chip.
    template <class Model> struct Block {
        Block(VerilatedContext* context, const ModelState& of) : model(context), state(of) {}

        Model model;
        const ModelState& state;
        std::vector<Register> registers;
        std::vector<unsigned char> marked; // state at mark()

        void copyFrom(VSoc& chip) {
            for (const Register& r : registers)
                std::memcpy(bytesOf(model.rootp) + r.alone, bytesOf(chip.rootp) + r.chip, r.size);
        }
        // Copies the current state, or the state at mark().
        void copyTo(VSoc& chip, bool isMarked) {
            const unsigned char* from = isMarked ? marked.data() : bytesOf(model.rootp);
            for (const Register& r : registers)
                std::memcpy(bytesOf(chip.rootp) + r.chip, from + r.alone, r.size);
        }
        bool equals(VSoc& chip) {
            return std::all_of(registers.begin(), registers.end(), [&](const Register& r) {
                return std::memcmp(bytesOf(model.rootp) + r.alone, bytesOf(chip.rootp) + r.chip,
                                   r.size) == 0;
            });
        }
        void mark() {
            const unsigned char* now = bytesOf(model.rootp);
            marked.assign(now, now + state.size);
        }
        // Computes one clock; in the first one, the model also runs its initial blocks.
        void tick() {
            model.tick_i = !model.tick_i;
            model.eval();
        }
        // Computes a later clock quickly; `eval` is the function that evaluates the model.
        template <class Root> void tick(void (*eval)(Root*)) {
            model.tick_i = !model.tick_i;
            eval(model.rootp);
        }
    };

    VSoc& chip;
    Block<VCameraAlone> camera;
    Block<VMemoryAlone> memory;
    bool isReady = false;
    std::vector<std::string> missing; // registers that are in the chip or in a small model only
    bool requests = false;            // the camera uses its memory port
    uint64_t cameraOutputs = 0, memoryOutputs = 0; // values of others_o
    bool hasMemoryMoved = false;                   // the memory has changed since mark()
    Inputs markedInputs{};
    bool isMarked = false;
    std::vector<Inputs> recorded; // inputs of the clocks since mark()

    void prepare();
    void passPortToCamera();
    void passPortToMemory();
    void step(bool memoryMoves);
    Inputs inputs() const { return {mcbInputsOf(memory.model), camera.model.core_pins_i}; }
    bool areOutputsSame() const {
        return camera.model.others_o == cameraOutputs && memory.model.others_o == memoryOutputs;
    }
    void toChip(const Inputs& inputs, bool isMarked);
};

// Finds the registers, and their places in the models. The models are complete if each register is
// in the chip and in one of the small models. Exceptions are registers that only another memory
// port reads; they keep their state while nothing is pushed or popped.
void CameraAlone::Parts::prepare() {
    if (isReady)
        return;
    isReady = true;
    for (unsigned clock = 0; clock < 2; ++clock) { // until the constant inputs have been sampled
        camera.tick();
        memory.tick();
    }
    std::map<std::string, const ModelMember*> places;
    for (const ModelMember& member : VSoc_state)
        if (isCopied(pathOf(member)))
            places.emplace(pathOf(member), &member);
    auto ours = registersOf(VSoc_state, chip.rootp, VSoc___024root___eval_settle);
    const auto find = [&](const auto& theirs, std::vector<Register>& registers) {
        for (const auto& [path, member] : theirs) {
            const auto place = places.find(path);
            if (place == places.end() && isReadWord(path)) // the camera does not read
                continue;
            if (place == places.end() || place->second->size != member->size)
                missing.push_back(path);
            else
                registers.push_back({member->offset, place->second->offset, member->size});
            ours.erase(path);
        }
    };
    auto inCameraOnly =
        registersOf(camera.state, camera.model.rootp, VCameraAlone___024root___eval_settle);
    for (auto at = inCameraOnly.begin(); at != inCameraOnly.end();) // flip-flops of sim_camera.v
        at = isOfInputs(at->first) ? inCameraOnly.erase(at) : std::next(at);
    find(inCameraOnly, camera.registers);
    find(registersOf(memory.state, memory.model.rootp, VMemoryAlone___024root___eval_settle),
         memory.registers);
    for (const auto& [path, member] : ours)
        if (!isReadByOthers(path))
            missing.push_back(path);
}

void CameraAlone::Parts::passPortToCamera() {
    VCameraAlone& to = camera.model;
    const VMemoryAlone& from = memory.model;
    to.npi_addr_ack_i = from.npi_addr_ack_o;
    to.npi_wr_empty_i = from.npi_wr_empty_o;
    to.npi_wr_almost_full_i = from.npi_wr_almost_full_o;
    to.npi_rd_data_i = from.npi_rd_data_o;
    to.npi_rd_word_i = from.npi_rd_word_o;
    to.npi_rd_empty_i = from.npi_rd_empty_o;
}

void CameraAlone::Parts::passPortToMemory() {
    VMemoryAlone& to = memory.model;
    const VCameraAlone& from = camera.model;
    to.npi_addr_i = from.npi_addr_o;
    to.npi_addr_req_i = from.npi_addr_req_o;
    to.npi_rnw_i = from.npi_rnw_o;
    to.npi_size_i = from.npi_size_o;
    to.npi_rmw_i = from.npi_rmw_o;
    to.npi_wr_data_i = from.npi_wr_data_o;
    to.npi_wr_be_i = from.npi_wr_be_o;
    to.npi_wr_push_i = from.npi_wr_push_o;
    to.npi_wr_flush_i = from.npi_wr_flush_o;
    to.npi_rd_pop_i = from.npi_rd_pop_o;
    to.npi_rd_flush_i = from.npi_rd_flush_o;
    VMemoryAlone___024root___eval(to.rootp);
}

// Computes one clock. The memory is first, because the camera's model samples the outputs that the
// memory has after the edge (sim_camera.v). A memory that does not move need not be evaluated, and
// need not see the camera's outputs while they contain no request.
void CameraAlone::Parts::step(bool memoryMoves) {
    if (memoryMoves) {
        memory.tick(VMemoryAlone___024root___eval);
        hasMemoryMoved = true;
        passPortToCamera();
    }
    camera.tick(VCameraAlone___024root___eval);
    if (requests || camera.model.requests_o)
        passPortToMemory();
    requests = camera.model.requests_o;
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
    if (!parts_)
        return;
    parts_->camera.model.final();
    parts_->memory.model.final();
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
    setMcbInputs(p.memory.model, mcbInputsOf(p.chip));
    p.memory.copyFrom(p.chip);
    VMemoryAlone___024root___eval_settle(p.memory.model.rootp);
    p.camera.model.core_pins_i = p.chip.core_pins_i;
    p.camera.model.from_cores_i = p.chip.camera_from_o;
    p.passPortToCamera();
    p.camera.tick(VCameraAlone___024root___eval);
    p.camera.copyFrom(p.chip);
    VCameraAlone___024root___eval_settle(p.camera.model.rootp);
    p.passPortToMemory();
    p.requests = p.camera.model.requests_o;
    p.cameraOutputs = p.camera.model.others_o;
    p.memoryOutputs = p.memory.model.others_o;
    p.hasMemoryMoved = true;
    p.isMarked = false;
    p.recorded.clear();
}

bool CameraAlone::follows() {
    Parts& p = *parts_;
    setMcbInputs(p.memory.model, mcbInputsOf(p.chip));
    p.camera.model.core_pins_i = p.chip.core_pins_i;
    p.step(true);
    p.passPortToMemory();
    return p.missing.empty() && p.memory.model.empty_o && p.areOutputsSame() &&
           p.camera.equals(p.chip) && p.memory.equals(p.chip);
}

bool CameraAlone::clock(McbModel& mcb) {
    Parts& p = *parts_;
    sampleMcb(p.memory.model, mcb);
    const McbModel::Pins& pins = mcb.pins;
    const McbInputs now = {pins.rdData, pins.cmdFull, pins.wrFull, pins.rdEmpty, pins.calibDone};
    const bool hasChanged = !(now == mcbInputsOf(p.memory.model));
    if (hasChanged)
        setMcbInputs(p.memory.model, now);
    p.camera.model.core_pins_i = p.chip.core_pins_i;
    p.step(hasChanged || !p.memory.model.still_o);
    if (p.isMarked)
        p.recorded.push_back({now, p.chip.core_pins_i});
    return p.areOutputsSame();
}

void CameraAlone::mark() {
    Parts& p = *parts_;
    p.camera.mark();
    if (p.hasMemoryMoved)
        p.memory.mark();
    p.hasMemoryMoved = false;
    p.markedInputs = p.inputs();
    p.isMarked = true;
    p.recorded.clear();
}

// As in load(), the registers are copied after the chip has seen the level of the pixel clock.
void CameraAlone::Parts::toChip(const Inputs& inputs, bool isMarked) {
    setMcbInputs(chip, inputs.mcb);
    chip.core_pins_i = inputs.pins;
    chip.eval();
    camera.copyTo(chip, isMarked);
    memory.copyTo(chip, isMarked);
    VSoc___024root___eval_settle(chip.rootp);
}

void CameraAlone::store() {
    parts_->toChip(parts_->inputs(), false);
}

uint64_t CameraAlone::storeMarked() {
    parts_->toChip(parts_->markedInputs, true);
    return parts_->recorded.size();
}

void CameraAlone::repeat(uint64_t number) {
    const Inputs& inputs = parts_->recorded.at(number);
    setMcbInputs(parts_->chip, inputs.mcb);
    parts_->chip.core_pins_i = inputs.pins;
}
