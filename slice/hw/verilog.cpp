// SPDX-License-Identifier: MIT
//
// verilog: the wrapper over bus_registers: from words to ports with the interface's names.

#include "c/writer.h"
#include "hw/generator.h"
#include "hw/ports.h"
#include "hw/words.h"
#include <cstdio>

namespace hw {
namespace {

std::string mask(unsigned bits) {
    char text[16];
    std::snprintf(text, sizeof text, "16'h%04X", bits);
    return text;
}

std::string range(unsigned width) {
    return width == 1 ? "" : "[" + std::to_string(width - 1) + ":0] ";
}

std::string slice(const std::string& vector, unsigned lsb, unsigned width) {
    std::string low = std::to_string(lsb);
    return vector + "[" + (width == 1 ? low : std::to_string(lsb + width - 1) + ":" + low) + "]";
}

// The bits of bus_registers' vectors that hold a word.
unsigned base(unsigned word) {
    return 32 * (word - firstWord);
}

void ports(Writer& w, const Block& b) {
    auto list = wrapperPorts(b);
    for (const Port& p : list) {
        if (!p.group.empty())
            w.line("    // " + p.group);
        std::string kind = p.isOut ? "output wire " : "input  wire ";
        w.line("    " + kind + range(p.width) + p.name + (&p == &list.back() ? "" : ","));
    }
}

void parameters(Writer& w, const Block& b) {
    unsigned rw = 0, ro = b.hasLong() ? 1u << status : 0;
    std::string widths;
    for (const Word* word : b.words())
        (word->isOut ? ro : rw) |= 1u << word->number;
    if (b.memoryWord)
        rw |= 1u << b.memoryWord;
    for (unsigned n = slotWords; n-- > 0;) {
        unsigned width = 32;
        for (const Word* word : b.words())
            if (word->number == n)
                width = word->width();
        if (n && n == b.memoryWord)
            width = 32 - b.memoryLsb();
        widths += "6'd" + std::to_string(width) + (n ? ", " : "");
    }
    char id[16];
    std::snprintf(id, sizeof id, "32'h%08X", b.type << 16 | b.version);
    unsigned events = b.events() ? b.events() : 1;
    w.line("    bus_registers #(");
    w.line("        .ID_VALUE(" + std::string(id) + "), .EVENTS(" + std::to_string(events) +
           "), .RW(" + mask(rw) + "), .RO(" + mask(ro) + "), .WS(" + mask(1u << control) + "),");
    w.line("        .WIDTHS({" + widths + "})");
    w.line("    ) u_registers (");
    w.line("        .clk_i(clk_i), .rst_i(rst_i),");
    w.line("        .bus_valid_i(bus_valid_i), .bus_write_i(bus_write_i), "
           ".bus_addr_i(bus_addr_i),");
    w.line("        .bus_wdata_i(bus_wdata_i), .bus_ready_o(bus_ready_o), "
           ".bus_rdata_o(bus_rdata_o),");
    w.line("        .bus_error_o(bus_error_o),");
    w.line("        .value_o(value), .value_i(shown), .strobe_o(strobe), .wdata_o(wdata),");
    w.line("        .event_i(" + std::string(b.events() ? "done" : "1'b0") + "), .irq_o(irq_o)");
    w.line("    );");
}

// A binary constant with a bit for each call up to the last that has an event.
template <class Choose> std::string bits(const Block& b, Choose choose) {
    std::string text;
    for (unsigned bit = b.events(); bit-- > 0;)
        text += choose(b.calls[bit]) ? '1' : '0';
    return std::to_string(b.events()) + "'b" + text;
}

// busy from start to done; a start while busy, and a done without, are nothing.
void longCalls(Writer& w, const Block& b) {
    std::string n = std::to_string(b.events()), top = std::to_string(b.events() - 1);
    std::string done, refused;
    bool hasEvents = false;
    for (unsigned bit = b.events(); bit-- > 0;) {
        const Call& c = b.calls[bit];
        hasEvents |= c.isEvent;
        done += c.isLong ? c.name + "_done_i" : c.isEvent ? c.name + "_event_i" : "1'b0";
        refused += c.isLong ? c.name + "_refused_i" : "1'b0";
        if (bit)
            done += ", ", refused += ", ";
    }
    if (!b.hasLong()) {
        w.line("    wire [" + top + ":0] done = {" + done + "};");
        return;
    }
    w.line("    reg  [" + top + ":0] busy, refused;");
    w.line("    wire [" + top + ":0] timed = " + bits(b, [](const Call& c) { return c.isLong; }) +
           "; // operations that end by done");
    w.line("    wire [" + top + ":0] start = act[" + top + ":0] & ~busy;");
    if (hasEvents)
        w.line("    wire [" + top + ":0] event_bits = " +
               bits(b, [](const Call& c) { return c.isEvent; }) + "; // at any time");
    w.line("    wire [" + top + ":0] done  = {" + done + "} & " +
           (hasEvents ? "(busy | event_bits);" : "busy;"));
    w.line("    always @(posedge clk_i) begin");
    w.line("        busy    <= (busy & ~done) | (start & timed);");
    w.line("        refused <= (refused & ~done & ~start) | (done & {" + refused + "});");
    w.line("        if (core_rst) begin");
    w.line("            busy    <= " + n + "'d0;");
    w.line("            refused <= " + n + "'d0;");
    w.line("        end");
    w.line("    end");
}

void results(Writer& w, const Block& b) {
    unsigned next = 0; // bits of `shown` below it are assigned
    auto zero = [&](unsigned until) {
        if (next < until)
            w.line("    assign " + slice("shown", next, until - next) + " = " +
                   std::to_string(until - next) + "'d0;");
        next = until;
    };
    auto show = [&](unsigned lsb, unsigned width, const std::string& what) {
        zero(lsb);
        w.line("    assign " + slice("shown", lsb, width) + " = " + what + ";");
        next = lsb + width;
    };
    std::vector<const Word*> outs;
    for (const Word* word : b.words())
        if (word->isOut)
            outs.push_back(word);
    if (b.hasLong()) {
        show(base(status), b.events(), "busy");
        show(base(status) + refusedLsb, b.events(), "refused");
    }
    for (const Word* word : outs)
        for (const Piece& p : word->pieces) {
            std::string port;
            for (const Call& c : b.calls)
                for (const Word& own : c.words)
                    if (&own == word)
                        port = c.name + "_" + p.name + "_i";
            show(base(word->number) + p.lsb, p.width,
                 p.portWidth > 32 ? slice(port, p.portLsb, p.width) : port);
        }
    zero(32 * (slotWords - firstWord));
}

// Writes the address of a sequence. The buffers begin at a multiple of their size, so the offset
// takes the place of low bits and nothing is added.
void base(Writer& w, const Block& b, const Call& c, const Piece& p) {
    unsigned lsb = b.memoryLsb();
    w.line("    assign " + c.name + "_" + baseName(p) + "_o = {" +
           slice("value", base(b.memoryWord), 32 - lsb) + ", " + std::to_string(lsb) + "'d" +
           std::to_string(p.offset) + "};");
}

void calls(Writer& w, const Block& b) {
    for (const Call& c : b.calls) {
        w.line();
        w.line("    assign " + c.name + (c.isEvent ? "_taken_o = " : "_start_o = ") +
               slice(c.isLong ? "start" : "act", c.bit, 1) + ";");
        for (const Word& word : c.words)
            for (const Piece& p : word.pieces) {
                if (p.isCount)
                    base(w, b, c, p);
                if (word.isOut)
                    continue;
                std::string port = c.name + "_" + p.name + "_o";
                w.line("    assign " + (p.portWidth > 32 ? slice(port, p.portLsb, p.width) : port) +
                       " = " + slice("value", base(word.number) + p.lsb, p.width) + ";");
            }
    }
}

} // namespace

GeneratedFile verilogFile(const Block& b, const CFileNames& names) {
    Writer w;
    wrapperHead(w, b, names.base, "//");
    w.line("`default_nettype none");
    w.line();
    w.line("module " + b.name + "_wrapper (");
    ports(w, b);
    w.line(");");
    unsigned top = 32 * (slotWords - firstWord) - 1;
    std::string whole = "[" + std::to_string(top) + ":0]";
    w.line("    wire " + whole + " value, shown;");
    w.line("    wire [12:0]  strobe;");
    w.line("    wire [31:0]  wdata;");
    w.line("    wire [31:0]  act = wdata & {32{" + slice("strobe", control - firstWord, 1) + "}};");
    w.line();
    parameters(w, b);
    w.line();
    w.line("    // A clock after the write, from a register: the whole core hangs on it.");
    w.line("    reg core_rst;");
    w.line("    assign core_rst_o = core_rst;");
    w.line("    always @(posedge clk_i)");
    w.line("        core_rst <= rst_i || " + slice("act", resetBit, 1) + ";");
    if (b.events())
        longCalls(w, b);
    calls(w, b);
    w.line();
    results(w, b);
    w.line();
    w.line("    wire unused = &{1'b0, value, strobe, act" +
           std::string(b.hasLong() ? ", start" : "") + ", 1'b0};");
    w.line("endmodule");
    return {b.name + "_wrapper.v", w.text()};
}

} // namespace hw
