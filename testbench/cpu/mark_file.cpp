// SPDX-License-Identifier: MIT
//
// mark_file: value changes, one line each.

#include "mark_file.h"

namespace {
constexpr char exceptionId = '!', handlerId = '"', taskId = '#';
}

MarkFile::MarkFile(const std::string& path, Stm32F2& stm32, std::function<uint64_t()> now)
    : file_(path), stm32_(stm32), now_(std::move(now)), before_(stm32.cpu().listener) {
    if (!file_)
        throw std::runtime_error("cannot write '" + path + "'");
    file_ << "$timescale 1 ns $end\n$scope module cpu $end\n"
             "$var reg 8 ! exception $end\n$var string 1 \" handler $end\n$var reg 8 # task $end\n"
             "$upscope $end\n$enddefinitions $end\n";
    taskAddress_ = stm32.image()->symbol("OSPrioCur"); // a byte
    CortexM3& cpu = stm32.cpu();
    cpu.listener.entered = [this, &cpu](unsigned number) {
        at();
        mark(exceptionId, number, 8);
        name(handlerId, stm32_.image()->functionAt(cpu.reg(CortexM3::Pc)));
        if (before_.entered)
            before_.entered(number);
    };
    cpu.listener.left = [this](unsigned number) {
        at();
        mark(exceptionId, 0, 8);
        name(handlerId, "-");
        taskMayHaveChanged();
        if (before_.left)
            before_.left(number);
    };
}

MarkFile::~MarkFile() {
    stm32_.cpu().listener = before_;
}

void MarkFile::at() {
    if (now_() != time_)
        file_ << '#' << (time_ = now_()) << '\n';
}

void MarkFile::mark(char id, uint32_t value, unsigned bits) {
    file_ << 'b';
    for (unsigned b = bits; b-- > 0;)
        file_ << (value >> b & 1);
    file_ << ' ' << id << '\n';
}

void MarkFile::name(char id, const std::string& text) {
    file_ << 's' << text << ' ' << id << '\n';
}

void MarkFile::taskMayHaveChanged() {
    uint8_t task = 0;
    stm32_.cpu().readMemory(taskAddress_, &task, 1);
    if (task != task_)
        mark(taskId, task_ = task, 8);
}
