// SPDX-License-Identifier: MIT
//
// vhdl: generates the wrapper as a VHDL entity (VHDL-93 and later), for designs that are entirely
// in VHDL. The entity has the same ports as the Verilog wrapper, and behaves the same in each
// clock.

#include "front/symbols.h"
#include "hw/generator.h"
#include <algorithm>

namespace hw {
namespace {

std::string vectorType(unsigned width) {
    return "std_logic_vector(" + std::to_string(width - 1) + " downto 0)";
}

} // namespace

std::string vhdlType(unsigned width) {
    return width == 1 ? "std_logic" : vectorType(width);
}

void vhdlEntity(Writer& w, const std::string& name, const std::vector<Port>& ports,
                const std::string& package) {
    w.line("library ieee;");
    w.line("use ieee.std_logic_1164.all;");
    if (!package.empty())
        w.line("use work." + package + ".all;");
    w.line();
    w.line("entity " + name + " is");
    w.line("  port (");
    for (const Port& p : ports) {
        if (!p.group.empty())
            w.line("    -- " + p.group);
        w.line("    " + p.name + " : " + (p.isOut ? "out " : "in  ") + vhdlType(p.width) +
               (&p == &ports.back() ? "" : ";"));
    }
    w.line("  );");
    w.line("end entity;");
    w.line();
    w.line("architecture rtl of " + name + " is");
}

namespace {

std::string number(unsigned n) {
    return std::to_string(n);
}

// Returns `width` bits of a vector, starting at `lsb`; a single bit is a std_logic.
std::string slice(const std::string& vector, unsigned lsb, unsigned width) {
    return vector + "(" + (width == 1 ? "" : number(lsb + width - 1) + " downto ") + number(lsb) +
           ")";
}

std::string binary(unsigned value, unsigned width) {
    std::string bits;
    while (width-- > 0)
        bits += value >> width & 1 ? '1' : '0';
    return '"' + bits + '"';
}

std::string address(const Block& b, unsigned word) {
    return binary(word, 4 + b.pageBits);
}

// Returns the expression for the number of the word that the bus accesses.
std::string addressed(const Block& b) {
    return b.pageBits ? "place" : "bus_addr_i";
}

std::string hex(unsigned value) {
    return "X\"" + hexDigits(value, 8) + '"';
}

// Returns the port that holds a field, or the bits of this port that the field occupies.
std::string portOf(const Call& c, const Piece& p, bool isResult) {
    std::string port = c.name + "_" + p.name + (isResult ? "_i" : "_o");
    return p.portWidth > 32 ? slice(port, p.portLsb, p.width) : port;
}

unsigned eventBits(const Block& b) {
    return std::max(b.events(), 1u);
}

void signals(Writer& w, const Block& b) {
    w.line("  signal writes, core_rst : std_logic;");
    w.line("  signal act : std_logic_vector(31 downto 0); -- value written to CONTROL");
    w.line("  signal happened, event_bits, mask_bits : " + vectorType(eventBits(b)) + ";");
    if (b.pageBits) {
        w.line("  signal page : " + vectorType(pageLsb + b.pageBits) + ";");
        w.line("  signal place : " + vectorType(4 + b.pageBits) + "; -- page and word accessed");
    }
    if (b.memoryWord)
        w.line("  signal memory : " + vectorType(32 - b.memoryLsb()) + ";");
    for (const Word* word : b.words())
        if (!word->isOut)
            w.line("  signal " + lowerCase(word->name) + " : " + vectorType(word->width()) + ";");
    for (const Call& c : b.calls)
        if (c.isLong)
            w.line("  signal " + c.name + "_start, " + c.name + "_done, " + c.name + "_busy, " +
                   c.name + "_refused : std_logic;");
}

// Writes the signals that start and end calls, and the signal `happened`, which has one bit for
// each event and for each call that reports its end.
void events(Writer& w, const Block& b) {
    for (const Call& c : b.calls)
        if (c.isLong) {
            w.line("  " + c.name + "_start <= " + slice("act", c.bit, 1) + " and not " + c.name +
                   "_busy;");
            w.line("  " + c.name + "_done <= " + c.name + "_done_i and " + c.name + "_busy;");
        }
    for (unsigned bit = 0; bit < eventBits(b); ++bit) {
        std::string what = "'0'";
        if (bit < b.calls.size() && b.calls[bit].isLong)
            what = b.calls[bit].name + "_done";
        else if (bit < b.calls.size() && b.calls[bit].isEvent)
            what = b.calls[bit].name + "_event_i";
        w.line("  " + slice("happened", bit, 1) + " <= " + what + ";");
    }
    w.line("  irq_o <= '0' when (event_bits and mask_bits) = \"" + std::string(eventBits(b), '0') +
           "\" else '1';");
}

// Writes the busy bits. A call is busy from start to done. A start is ignored while the call is
// busy; a done is ignored while the call is not busy.
void longCalls(Writer& w, const Block& b) {
    w.line();
    w.line("  long_operations : process (clk_i)");
    w.line("  begin");
    w.line("    if rising_edge(clk_i) then");
    for (const Call& c : b.calls)
        if (c.isLong) {
            w.line("      {n}_busy <= ({n}_busy and not {n}_done) or {n}_start;", {{"n", c.name}});
            w.line("      {n}_refused <= ({n}_refused and not {n}_done and not {n}_start)",
                   {{"n", c.name}});
            w.line("        or ({n}_done and {n}_refused_i);", {{"n", c.name}});
        }
    w.line("      if core_rst = '1' then");
    for (const Call& c : b.calls)
        if (c.isLong) {
            w.line("        " + c.name + "_busy <= '0';");
            w.line("        " + c.name + "_refused <= '0';");
        }
    w.line("      end if;");
    w.line("    end if;");
    w.line("  end process;");
}

void registers(Writer& w, const Block& b) {
    auto written = [](unsigned width) { return "bus_wdata_i(" + number(width - 1) + " downto 0)"; };
    std::string from = written(eventBits(b));
    std::vector<std::string> cleared = {"event_bits", "mask_bits"};
    w.line();
    w.line("  registers : process (clk_i)");
    w.line("  begin");
    w.line("    if rising_edge(clk_i) then");
    w.line("      -- an event that arrives while it is cleared stays set");
    w.line("      event_bits <= event_bits or happened;");
    w.line("      if writes = '1' then");
    w.line("        case " + addressed(b) + " is");
    w.line("          when " + address(b, 1) + " => event_bits <= (event_bits and not " + from +
           ") or happened;");
    w.line("          when " + address(b, 2) + " => mask_bits <= " + from + ";");
    auto store = [&](unsigned word, const std::string& name, unsigned width) {
        w.line("          when " + address(b, word) + " => " + name + " <= " + written(width) +
               ";");
        cleared.push_back(name);
    };
    if (b.pageBits)
        store(page, "page", pageLsb + b.pageBits);
    if (b.memoryWord)
        store(b.memoryWord, "memory", 32 - b.memoryLsb());
    for (const Word* word : b.words())
        if (!word->isOut)
            store(word->number, lowerCase(word->name), word->width());
    w.line("          when others => null;");
    w.line("        end case;");
    w.line("      end if;");
    w.line("      if rst_i = '1' then");
    for (const std::string& name : cleared)
        w.line("        " + name + " <= (others => '0');");
    w.line("      end if;");
    for (unsigned bit = 0; bit < eventBits(b); ++bit)
        if (!(b.raised() >> bit & 1))
            w.line("      " + slice("event_bits", bit, 1) + " <= '0'; -- cannot happen");
    w.line("    end if;");
    w.line("  end process;");
}

// separator in a sensitivity list: one signal per line, because names may be long
const std::string nextSignal = ",\n                   ";

// Returns the lines of the case statement that selects the value read from each word. Appends the
// signals that these lines read to `signals`.
std::vector<std::string> shownWords(const Block& b, std::string& signals) {
    std::vector<std::string> lines;
    auto word = [&](unsigned n, const std::string& name) {
        lines.push_back("      when " + address(b, n) + " => -- " + name);
    };
    auto show = [&](unsigned lsb, unsigned width, const std::string& what) {
        lines.push_back("        " + slice("data", lsb, width) + " := " + what + ";");
    };
    auto vector = [&](unsigned width, const std::string& what) {
        lines.push_back("        data(" + number(width - 1) + " downto 0) := " + what + ";");
        signals += nextSignal + what;
    };
    word(0, "ID");
    lines.push_back("        data := " + hex(b.type << 16 | b.version) + ";");
    word(1, "EVENT");
    vector(eventBits(b), "event_bits");
    word(2, "MASK");
    vector(eventBits(b), "mask_bits");
    word(control, "CONTROL");
    lines.push_back("        null;");
    if (b.hasLong())
        word(status, "STATUS");
    for (const Call& c : b.calls)
        if (c.isLong) {
            show(c.bit, 1, c.name + "_busy");
            show(refusedLsb + c.bit, 1, c.name + "_refused");
            signals += nextSignal + c.name + "_busy" + nextSignal + c.name + "_refused";
        }
    if (b.pageBits) {
        word(page, "PAGE");
        vector(pageLsb + b.pageBits, "page");
    }
    if (b.memoryWord) {
        word(b.memoryWord, "MEMORY");
        vector(32 - b.memoryLsb(), "memory");
    }
    for (const Call& c : b.calls)
        for (const Word& own : c.words) {
            word(own.number, own.name);
            if (!own.isOut)
                vector(own.width(), lowerCase(own.name));
            else
                for (const Piece& p : own.pieces) {
                    show(p.lsb, p.width, portOf(c, p, true));
                    if (p.portLsb == 0)
                        signals += nextSignal + c.name + "_" + p.name + "_i";
                }
        }
    return lines;
}

void reads(Writer& w, const Block& b) {
    std::string list = addressed(b);
    std::vector<std::string> words = shownWords(b, list);
    w.line();
    w.line("  reads : process (" + list + ")");
    w.line("    variable data : std_logic_vector(31 downto 0);");
    w.line("  begin");
    w.line("    data := (others => '0');");
    w.line("    bus_error_o <= '0';");
    w.line("    case " + addressed(b) + " is");
    for (const std::string& line : words)
        w.line(line);
    w.line("      when others =>");
    w.line("        bus_error_o <= '1';");
    w.line("    end case;");
    w.line("    bus_rdata_o <= data;");
    w.line("  end process;");
}

void calls(Writer& w, const Block& b) {
    for (const Call& c : b.calls) {
        w.line();
        w.line("  " + c.name + (c.isEvent ? "_taken_o <= " : "_start_o <= ") +
               (c.isLong ? c.name + "_start" : slice("act", c.bit, 1)) + ";");
        for (const Word& word : c.words)
            for (const Piece& p : word.pieces) {
                // A buffer is aligned to its size, so the offset replaces low address bits and no
                // adder is needed.
                if (p.isCount)
                    w.line("  " + c.name + "_" + baseName(p) + "_o <= memory & " +
                           binary(p.offset, b.memoryLsb()) + "; -- " + number(p.offset) +
                           " bytes after the start of the first buffer");
                if (!word.isOut)
                    w.line("  " + portOf(c, p, false) +
                           " <= " + slice(lowerCase(word.name), p.lsb, p.width) + ";");
            }
    }
}

} // namespace

GeneratedFile vhdlFile(const Block& b) {
    Writer w;
    wrapperHead(w, b, "--");
    vhdlEntity(w, b.name + "_wrapper", wrapperPorts(b));
    signals(w, b);
    w.line("begin");
    w.line();
    w.line("  bus_ready_o <= '1';");
    w.line("  writes <= bus_valid_i and bus_write_i;");
    if (b.pageBits)
        w.line("  place <= " + slice("page", pageLsb, b.pageBits) +
               " & bus_addr_i when bus_addr_i(3) = '1' else " + binary(0, b.pageBits) +
               " & bus_addr_i;");
    w.line("  act <= bus_wdata_i when writes = '1' and " + addressed(b) + " = " +
           address(b, control) + " else " + hex(0) + ";");
    w.line("  -- One clock after the write; from a register, because it drives the whole core.");
    w.line("  core_rst_o <= core_rst;");
    w.line("  core_resets : process (clk_i)");
    w.line("  begin");
    w.line("    if rising_edge(clk_i) then");
    w.line("      core_rst <= rst_i or " + slice("act", resetBit, 1) + ";");
    w.line("    end if;");
    w.line("  end process;");
    events(w, b);
    registers(w, b);
    if (b.hasLong())
        longCalls(w, b);
    reads(w, b);
    calls(w, b);
    w.line();
    w.line("end architecture;");
    return {b.name + "_wrapper.vhd", w.text()};
}

} // namespace hw
