// SPDX-License-Identifier: MIT
//
// program_trace: looks at each exception, and within the waveform at each instruction.

#include "program_trace.h"

namespace {
constexpr unsigned pendSv = 14;                 // in which each kernel switches tasks
constexpr uint64_t tenthOfASecond = 10'000'000; // clocks
constexpr uint64_t soon = 200'000; // an exception comes within these clocks: the tick is 100,000

// Returns the address of the pointer to the running task, uC/OS-II's or our kernel's; 0: the
// program has no kernel.
uint32_t kernelsPointer(const ElfImage& image) {
    for (const char* name : {"OSTCBCur", "os_running"})
        if (image.has(name))
            return image.symbol(name);
    return 0;
}

} // namespace

ProgramTrace::ProgramTrace(Stm32F2& stm32, std::function<uint64_t()> clocks)
    : stm32_(stm32), clocks_(std::move(clocks)), taskAddress_(kernelsPointer(*stm32.image())) {
    CortexM3& cpu = stm32.cpu();
    cpu.listener.entered = [this, &cpu](unsigned) {
        interrupt_ = stm32_.image()->functionAt(cpu.reg(CortexM3::Pc));
        look();
    };
    cpu.listener.left = [this](unsigned number) {
        interrupt_ = "-";
        if (number == pendSv && taskAddress_)
            switched();
        look();
    };
    if (window_.file.empty())
        return;
    file_.open(window_.file + ".program.vcd");
    if (!file_)
        throw std::runtime_error("cannot write '" + window_.file + ".program.vcd'");
    file_ << "$timescale 1 ps $end\n$scope module program $end\n";
    for (const char* name : {"task", "interrupt", "function"})
        file_ << "$var string 1 program." << name << ' ' << name << " $end\n";
    file_ << "$upscope $end\n$enddefinitions $end\n";
}

// A task that is seen for the first time continues at its first instruction.
void ProgramTrace::switched() {
    const CortexM3& cpu = stm32_.cpu();
    std::string& name = tasks_[cpu.word(taskAddress_)];
    if (name.empty())
        name = stm32_.image()->functionAt(cpu.word(cpu.reg(CortexM3::Psp) + 24));
    if (name != task_ && onTask)
        onTask(name);
    task_ = name;
}

void ProgramTrace::look() {
    const uint64_t now = clocks_();
    if (!file_.is_open())
        return;
    const bool near = now + soon >= window_.from && now <= window_.to;
    if (near != isNear_)
        stm32_.cpu().listener.instruction =
            near ? [this](uint32_t address) { lookAt(address); } : std::function<void(uint32_t)>();
    isNear_ = near;
    if (now + tenthOfASecond < window_.from || now > window_.to)
        return;
    write("task", task_);
    write("interrupt", interrupt_);
}

void ProgramTrace::lookAt(uint32_t address) {
    const uint64_t now = clocks_();
    if (now >= window_.from && now <= window_.to)
        write("function", stm32_.image()->functionAt(address));
}

void ProgramTrace::write(const char* row, const std::string& text) {
    std::string& last = written_[row];
    if (text == last || text.empty())
        return;
    const uint64_t time = 2 * clocks_() + 1;
    if (time != time_)
        file_ << '#' << (time_ = time) << '\n';
    file_ << 's' << (last = text) << " program." << row << '\n';
}
