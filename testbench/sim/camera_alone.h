// SPDX-License-Identifier: MIT
//
// camera_alone: simulates only the camera core and the memory while the rest of the chip would not
// change. Each of the two blocks has a small Verilated model (sim_camera.v, sim_memory.v). A
// picture takes hundreds of thousands of clocks, and the small models need a fraction of the time
// that the model of the whole chip needs. The memory is only evaluated while it has a clock: the
// clock stops soon after each word that the camera writes (rests.vh).
//
// The state of the registers of both blocks is copied from the chip to the small models (load), and
// back (store). The small models may compute clocks alone if they have followed the chip for one
// clock (follows), and if in this clock neither the rest of the chip nor the outputs of the two
// blocks to the rest have changed. The next state of the rest depends only on its state and its
// inputs, so it does not change until one of these outputs does. Then clock() returns false.

#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

class McbModel;
class VSoc;

class CameraAlone {
public:
    explicit CameraAlone(VSoc& chip);
    ~CameraAlone();

    // Returns false if the chip has no camera, or if every clock of the chip must be evaluated for
    // another reason: a waveform, coverage, or random delays of synchronisers.
    bool exists() const;
    // Returns the registers that are only in the chip, or only in a small model. The small models
    // can then not be used.
    std::vector<std::string> missing();

    // Copies the state of the chip, which has just been evaluated.
    void load();
    // Computes the clock that the chip has computed since load(). Returns true if all registers
    // are as in the chip, and the outputs to the rest of the chip have not changed.
    bool follows();
    // Computes one clock, with the pins in the chip's core_pins_i. Returns false if an output to
    // the rest of the chip has changed; the clock is then complete.
    bool clock(McbModel& memory);

    // Records the state and, from now on, the inputs.
    void mark();
    // Copies the state to the chip.
    void store();
    // Copies the recorded state to the chip, and the first recorded inputs. Returns the number of
    // clocks since mark().
    uint64_t storeMarked();
    // Sets the chip's inputs as in the clock with this number after mark().
    void repeat(uint64_t number);

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};
