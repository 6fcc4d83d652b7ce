// SPDX-License-Identifier: MIT
//
// verilog: generates the wrapper in Verilog. The wrapper contains a bus_registers and connects its
// words to ports named after the interface.

#include "hw/generator.h"
#include <map>

namespace hw {
namespace {

std::string mask(unsigned bits) {
    return "16'h" + hexDigits(bits, 4);
}

std::string slice(const std::string& vector, unsigned lsb, unsigned width) {
    std::string low = std::to_string(lsb);
    return vector + "[" + (width == 1 ? low : std::to_string(lsb + width - 1) + ":" + low) + "]";
}

// Returns the port that holds a field, or the bits of this port that the field occupies.
std::string portOf(const Word& word, const Piece& p) {
    std::string port = word.call + "_" + p.name + (word.isOut ? "_i" : "_o");
    return p.portWidth > 32 ? slice(port, p.portLsb, p.width) : port;
}

// Returns the index of the first bit of a word in the vectors of bus_registers.
unsigned base(unsigned word) {
    return 32 * (word % slotWords - firstWord);
}

// Returns the suffix of the signals of a page; page 0 has none.
std::string suffix(unsigned word) {
    return word < slotWords ? "" : std::to_string(word / slotWords);
}

void ports(Writer& w, const Block& b) {
    auto list = wrapperPorts(b);
    for (const Port& p : list) {
        if (!p.group.empty())
            w.line("    // " + p.group);
        std::string kind = p.isOut ? "output wire " : "input  wire ";
        w.line("    " + kind + verilogRange(p.width) + p.name + (&p == &list.back() ? "" : ","));
    }
}

// Writes the registers of one page, starting with word number `first`.
void registers(Writer& w, const Block& b, unsigned first) {
    unsigned rw = 0, ro = !first && b.hasLong() ? 1u << status : 0;
    std::map<unsigned, unsigned> widthOf;
    auto add = [&](unsigned& kind, unsigned number, unsigned width) {
        if (number / slotWords == first / slotWords) {
            kind |= 1u << number % slotWords;
            widthOf[number % slotWords] = width;
        }
    };
    for (const Word* word : b.words())
        add(word->isOut ? ro : rw, word->number, word->width());
    if (b.memoryWord)
        add(rw, b.memoryWord, 32 - b.memoryLsb());
    if (b.pageBits)
        add(rw, page, pageLsb + b.pageBits);
    std::string widths;
    for (unsigned n = slotWords; n-- > 0;)
        widths += "6'd" + std::to_string(widthOf.count(n) ? widthOf[n] : 32) + (n ? ", " : "");
    std::string id = "32'h" + hexDigits(first ? 0 : b.type << 16 | b.version, 8);
    unsigned events = !first && b.events() ? b.events() : 1;
    std::string n = std::to_string(first / slotWords);
    auto bus = [&](const std::string& name, const std::string& ofPage) {
        return "." + name + "(" + (b.pageBits ? ofPage : name) + ")";
    };
    w.line("    bus_registers #(");
    w.line("        .ID_VALUE(" + id + "), .EVENTS(" + std::to_string(events) + "), .RW(" +
           mask(rw) + "), .RO(" + mask(ro) + "), .WS(" + mask(first ? 0 : 1u << control) + "),");
    w.line("        .RAISED(32'h" + hexDigits(first ? 0 : b.raised(), 8) + "),");
    w.line("        .WIDTHS({" + widths + "})");
    w.line("    ) u_registers" + suffix(first) + " (");
    w.line("        .clk_i(clk_i), .rst_i(rst_i),");
    w.line("        " + bus("bus_valid_i", "bus_valid_i && here[" + n + "]") +
           ", .bus_write_i(bus_write_i), .bus_addr_i(bus_addr_i),");
    w.line("        .bus_wdata_i(bus_wdata_i), " + bus("bus_ready_o", "ready[" + n + "]") + ", " +
           bus("bus_rdata_o", "rdata[32*" + n + " +: 32]") + ",");
    w.line("        " + bus("bus_error_o", "error[" + n + "]") + ",");
    w.line("        .value_o(value{n}), .value_i(shown{n}), .strobe_o(strobe{n}), "
           ".wdata_o(wdata{n}),",
           {{"n", suffix(first)}});
    w.line("        .event_i(" + std::string(!first && b.events() ? "done" : "1'b0") + "), " +
           bus("irq_o", "irq[" + n + "]"));
    w.line("    );");
}

// Writes the registers of all pages: words 8..15 of the bus show one page.
void pages(Writer& w, const Block& b) {
    unsigned count = b.numbers() / slotWords;
    std::string top = "[" + std::to_string(count - 1) + ":0]", data;
    std::string at = slice("value", base(page) + pageLsb, b.pageBits);
    w.line("    wire " + top + " here, ready, error, irq;");
    w.line("    wire [" + std::to_string(32 * count - 1) + ":0] rdata;");
    for (unsigned p = 0; p < count; ++p) {
        std::string n = std::to_string(p);
        w.line("    assign here[" + n + "] = " + (p ? "bus_addr_i[3] && " : "!bus_addr_i[3] || ") +
               at + " == " + std::to_string(b.pageBits) + "'d" + n + ";");
        data += (p ? "\n                         | " : "") + ("({32{here[" + n + "]}}") +
                " & rdata[32*" + n + " +: 32])";
    }
    w.line("    assign bus_ready_o = &ready;");
    w.line("    assign bus_rdata_o = " + data + ";");
    w.line("    assign bus_error_o = !(|here) || |(here & error);");
    w.line("    assign irq_o = irq[0];");
    for (unsigned first = 0; first < b.numbers(); first += slotWords) {
        if (first) {
            Writer::Values n = {{"n", suffix(first)}, {"irq", first == slotWords ? ", irq" : ""}};
            w.line();
            w.line("    wire [415:0] value{n}, shown{n};", n);
            w.line("    wire [12:0]  strobe{n};", n);
            w.line("    wire [31:0]  wdata{n};", n);
            w.line("    wire unused{n} = &{1'b0, value{n}, strobe{n}, wdata{n}{irq}, 1'b0};", n);
        }
        registers(w, b, first);
    }
}

// Returns a binary constant with one bit for each used bit of EVENT; `choose` returns the value of
// each bit.
template <class Choose> std::string bits(const Block& b, Choose choose) {
    std::string text;
    for (unsigned bit = b.events(); bit-- > 0;)
        text += choose(b.calls[bit]) ? '1' : '0';
    return std::to_string(b.events()) + "'b" + text;
}

// Writes the busy bits. A call is busy from start to done. A start has no effect while the call is
// busy; a done has no effect while the call is not busy.
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
           "; // calls that end with done");
    w.line("    wire [" + top + ":0] start = act[" + top + ":0] & ~busy;");
    if (hasEvents)
        w.line("    wire [" + top + ":0] event_bits = " +
               bits(b, [](const Call& c) { return c.isEvent; }) + "; // may happen at any time");
    w.line("    wire [" + top + ":0] done  = {" + done + "} & " +
           (hasEvents ? "(busy | event_bits);" : "busy;"));
    w.line("    always @(posedge clk_i) begin");
    w.line("        busy    <= (busy & ~done) | (start & timed);");
    w.line("        refused <= timed & ((refused & ~done & ~start) | (done & {" + refused + "}));");
    w.line("        if (core_rst) begin");
    w.line("            busy    <= " + n + "'d0;");
    w.line("            refused <= " + n + "'d0;");
    w.line("        end");
    w.line("    end");
}

// Writes the read values of a page, starting with word number `first`.
void results(Writer& w, const Block& b, unsigned first) {
    std::string shown = "shown" + suffix(first);
    unsigned next = 0; // lowest bit of `shown` that has no assignment yet
    auto zero = [&](unsigned until) {
        if (next < until)
            w.line("    assign " + slice(shown, next, until - next) + " = " +
                   std::to_string(until - next) + "'d0;");
        next = until;
    };
    auto show = [&](unsigned lsb, unsigned width, const std::string& what) {
        zero(lsb);
        w.line("    assign " + slice(shown, lsb, width) + " = " + what + ";");
        next = lsb + width;
    };
    std::vector<const Word*> outs;
    for (const Word* word : b.words())
        if (word->isOut && word->number / slotWords == first / slotWords)
            outs.push_back(word);
    if (!first && b.hasLong()) {
        show(base(status), b.events(), "busy");
        show(base(status) + refusedLsb, b.events(), "refused");
    }
    for (const Word* word : outs)
        for (const Piece& p : word->pieces)
            show(base(word->number) + p.lsb, p.width, portOf(*word, p));
    zero(32 * (slotWords - firstWord));
}

// Writes the statement that computes the address of a sequence. A buffer is aligned to its size, so
// the offset replaces low address bits and no adder is needed.
void base(Writer& w, const Block& b, const Call& c, const Piece& p) {
    unsigned lsb = b.memoryLsb();
    w.line("    assign " + c.name + "_" + baseName(p) + "_o = {" +
           slice("value" + suffix(b.memoryWord), base(b.memoryWord), 32 - lsb) + ", " +
           std::to_string(lsb) + "'d" + std::to_string(p.offset) + "};");
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
                w.line("    assign " + portOf(word, p) + " = " +
                       slice("value" + suffix(word.number), base(word.number) + p.lsb, p.width) +
                       ";");
            }
    }
}

} // namespace

std::string verilogRange(unsigned width) {
    return width == 1 ? "" : "[" + std::to_string(width - 1) + ":0] ";
}

void wrapperHead(Writer& w, const Block& b, const std::string& mark) {
    w.line(mark + " Generated by slice2c from " + b.source + ".ice: do not edit.");
    w.line(mark);
    w.line(mark + " " + b.name + "_wrapper: registers of " + b.interface->id() +
           " (docs/hw-mapping.md), one slot.");
    w.line(mark);
    w.line(mark +
           " <operation>_start_o is high for one clock; then parameters are stable. Results must");
    w.line(mark + " be valid from the next clock, or from done, until the next start.");
    if (b.memoryWord)
        w.line(mark + " <..>_base_o: DDR3 byte address of a sequence, a multiple of 128; "
                      "<..>_count: elements.");
    w.line(mark +
           " <operation>_done_i ends an operation that takes time; refused_i is read with it.");
    w.line();
}

GeneratedFile verilogFile(const Block& b) {
    Writer w;
    wrapperHead(w, b, "//");
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
    b.pageBits ? pages(w, b) : registers(w, b, 0);
    w.line();
    w.line("    // One clock after the write; from a register, because it drives the whole core.");
    w.line("    reg core_rst;");
    w.line("    assign core_rst_o = core_rst;");
    w.line("    always @(posedge clk_i)");
    w.line("        core_rst <= rst_i || " + slice("act", resetBit, 1) + ";");
    if (b.events())
        longCalls(w, b);
    calls(w, b);
    w.line();
    for (unsigned first = 0; first < b.numbers(); first += slotWords)
        results(w, b, first);
    w.line();
    w.line("    wire unused = &{1'b0, value, strobe, act" +
           std::string(b.hasLong() ? ", start" : "") + ", 1'b0};");
    w.line("endmodule");
    return {b.name + "_wrapper.v", w.text()};
}

} // namespace hw
