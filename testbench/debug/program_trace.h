// SPDX-License-Identifier: MIT
//
// program_trace: records over time which task, interrupt and function the Cortex-M3 runs.
//
// If the environment requests a waveform (wave_window.h), this class writes three rows of text to
// WAVE.program.vcd. Their time unit is half a clock, as in the waveform of the RTL, and
// join_waves.sh combines the two files. Functions are recorded from WAVE_FROM to WAVE_TO. Tasks and
// interrupts are recorded starting a tenth of a second before WAVE_FROM.

#pragma once

#include "cortex_m3.h"
#include "elf_image.h"
#include "wave_window.h"
#include <fstream>
#include <map>

class ProgramTrace {
public:
    // Observes `cpu`, which runs the program `image`; both must exist as long as this object.
    // `clocks` returns the number of clocks of the fabric that have passed.
    ProgramTrace(CortexM3& cpu, const ElfImage& image, std::function<uint64_t()> clocks)
        : cpu_(cpu), image_(image), clocks_(std::move(clocks)),
          taskAddress_(kernelsPointer(image)) {
        cpu.listener.entered = [this](unsigned) {
            interrupt_ = image_.functionAt(cpu_.reg(CortexM3::Pc));
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
    ProgramTrace(const ProgramTrace&) = delete;
    ProgramTrace& operator=(const ProgramTrace&) = delete;

    // Called at each task switch with the name of the task, which is the name of the task's
    // function.
    std::function<void(const std::string& name)> onTask;

private:
    // number of the exception PendSV, in which both kernels switch tasks
    static constexpr unsigned pendSv = 14;
    static constexpr uint64_t tenthOfASecond = 10'000'000; // clocks
    // longest time between two exceptions, clocks; the kernel's tick occurs every 100,000 clocks
    static constexpr uint64_t soon = 200'000;

    // Returns the address of the variable that points to the running task (in uC/OS-II or in our
    // kernel); 0 if the program has no kernel.
    static uint32_t kernelsPointer(const ElfImage& image) {
        for (const char* name : {"OSTCBCur", "os_running"})
            if (image.has(name))
                return image.symbol(name);
        return 0;
    }

    // Handles a task switch. When a task runs for the first time, its saved PC is the start of its
    // function; the task gets the name of this function.
    void switched() {
        std::string& name = tasks_[cpu_.word(taskAddress_)];
        if (name.empty())
            name = image_.functionAt(cpu_.word(cpu_.reg(CortexM3::Psp) + 24));
        if (name != task_ && onTask)
            onTask(name);
        task_ = name;
    }
    void look() {
        const uint64_t now = clocks_();
        if (!file_.is_open())
            return;
        const bool near = now + soon >= window_.from && now <= window_.to;
        if (near != isNear_)
            cpu_.listener.instruction = near ? [this](uint32_t address) { lookAt(address); }
                                             : std::function<void(uint32_t)>();
        isNear_ = near;
        if (now + tenthOfASecond < window_.from || now > window_.to)
            return;
        write("task", task_);
        write("interrupt", interrupt_);
    }
    void lookAt(uint32_t address) {
        const uint64_t now = clocks_();
        if (now >= window_.from && now <= window_.to)
            write("function", image_.functionAt(address));
    }
    void write(const char* row, const std::string& text) {
        std::string& last = written_[row];
        if (text == last || text.empty())
            return;
        const uint64_t time = 2 * clocks_() + 1;
        if (time != time_)
            file_ << '#' << (time_ = time) << '\n';
        file_ << 's' << (last = text) << " program." << row << '\n';
    }

    CortexM3& cpu_;
    const ElfImage& image_;
    std::function<uint64_t()> clocks_;
    const WaveWindow window_;
    std::ofstream file_;
    // address of the kernel's pointer to the running task; 0 if the program has no kernel
    uint32_t taskAddress_;
    // names of the tasks; the key is the value of the kernel's pointer
    std::map<uint32_t, std::string> tasks_;
    std::string task_, interrupt_ = "-";
    std::map<std::string, std::string> written_; // last text written in each row
    uint64_t time_ = ~0ull;
    bool isNear_ = false; // true if the recorded window has begun or begins soon
};
