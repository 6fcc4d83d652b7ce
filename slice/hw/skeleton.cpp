// SPDX-License-Identifier: MIT
//
// skeleton: generates a first version of a core in Verilog or VHDL, which answers every call with
// zeros, and a test that makes all calls. `./icesoc core new` uses it; afterwards the author edits
// the files.

#include "c/context.h"
#include "hw/generator.h"
#include <algorithm>
#include <cctype>
#include <sstream>

namespace hw {
namespace {

// Returns the ports of a core that are not connected to its wrapper: the memory port
// (docs/memory.md) and the pins.
std::vector<Port> ownPorts(const Block& b) {
    std::vector<Port> list;
    if (b.memoryBytes)
        list = {{"npi_addr_o", true, 32, "memory port"},
                {"npi_addr_req_o", true, 1, ""},
                {"npi_addr_ack_i", false, 1, ""},
                {"npi_rnw_o", true, 1, ""},
                {"npi_size_o", true, 4, ""},
                {"npi_rmw_o", true, 1, ""},
                {"npi_wr_data_o", true, 64, ""},
                {"npi_wr_be_o", true, 8, ""},
                {"npi_wr_push_o", true, 1, ""},
                {"npi_wr_empty_i", false, 1, ""},
                {"npi_wr_almost_full_i", false, 1, ""},
                {"npi_wr_flush_o", true, 1, ""},
                {"npi_rd_data_i", false, 64, ""},
                {"npi_rd_word_i", false, 4, ""},
                {"npi_rd_pop_o", true, 1, ""},
                {"npi_rd_empty_i", false, 1, ""},
                {"npi_rd_flush_o", true, 1, ""},
                {"npi_init_done_i", false, 1, ""}};
    for (const Pin& p : b.pins)
        list.push_back({p.name, p.isOut(), p.width, &p == &b.pins.front() ? "pins" : ""});
    return list;
}

// Returns the ports of the wrapper on the slot's side (if `ofSlot`) or on the core's side.
std::vector<Port> portsOf(const Block& b, bool ofSlot) {
    std::vector<Port> list = wrapperPorts(b);
    auto core = std::find_if(list.begin(), list.end(),
                             [](const Port& p) { return p.name == "core_rst_o"; });
    return ofSlot ? std::vector<Port>(list.begin(), core) : std::vector<Port>(core, list.end());
}

std::string signalOf(const Port& p) {
    return p.name.substr(0, p.name.size() - 2);
}

bool isDone(const Port& p) {
    return p.call && p.call->isLong && p.name == p.call->name + "_done_i";
}

void head(Writer& w, const Block& b, const char* comment) {
    std::string c = comment;
    w.line(c + " SPDX-License-Identifier: MIT");
    w.line(c);
    w.line(c + " " + b.name + ": answers every call of " + b.interface->id() +
           " with zeros; registers by the generated " + b.name + "_wrapper.");
    w.line();
}

// Verilog code of a core that does not use its memory port yet. It connects two streams of words,
// for reading and writing the core's buffers, which make no requests. The code declares signals
// named npi_..., so no operation may have a name that begins with npi_.
const char npiStream[] =
    R"(    // The buffers in DDR3 as two idle streams of words (docs/memory.md, npi_stream).
    wire        npi_read_start = 1'd0, npi_read_take = 1'd0;
    wire [31:0] npi_read_base = 32'd0, npi_write_base = 32'd0;
    wire [23:0] npi_read_words = 24'd0;
    wire        npi_write_start = 1'd0, npi_write_valid = 1'd0, npi_write_flush = 1'd0;
    wire [63:0] npi_write_data = 64'd0;
    wire [63:0] npi_read_data;
    wire [7:0]  npi_write_be = 8'hFF;
    wire        npi_read_valid, npi_read_idle, npi_write_ready, npi_write_idle;

    npi_stream u_stream (
        `include "memory_connect.vh"
        .clk_i(clk_i), .rst_i(rst_i), // not core_rst: requested words must be taken
        .read_start_i(npi_read_start), .read_base_i(npi_read_base[31:6]),
        .read_words_i(npi_read_words), .read_stop_i(core_rst), .read_valid_o(npi_read_valid),
        .read_data_o(npi_read_data), .read_take_i(npi_read_take), .read_idle_o(npi_read_idle),
        .write_start_i(npi_write_start), .write_base_i(npi_write_base[31:6]),
        .write_valid_i(npi_write_valid), .write_data_i(npi_write_data), .write_be_i(npi_write_be),
        .write_ready_o(npi_write_ready), .write_flush_i(npi_write_flush || core_rst),
        .write_idle_o(npi_write_idle)
    );
    wire npi_unused = &{1'b0, npi_read_base[5:0], npi_read_data,
                        npi_read_valid, npi_read_idle, npi_write_base[5:0], npi_write_ready,
                        npi_write_idle, 1'b0};)";

// The same code in VHDL. npiSignals contains the declarations of the signals.
const char npiSignals[] =
    R"(  -- The buffers in DDR3 as two idle streams of words (docs/memory.md, npi_stream).
  signal npi_read_start, npi_read_take, npi_read_valid, npi_read_idle : std_logic;
  signal npi_write_start, npi_write_valid, npi_write_ready : std_logic;
  signal npi_write_flush, npi_write_idle : std_logic;
  signal npi_read_base, npi_write_base : std_logic_vector(31 downto 0);
  signal npi_read_words : std_logic_vector(23 downto 0);
  signal npi_read_data, npi_write_data : std_logic_vector(63 downto 0);
  signal npi_write_be : std_logic_vector(7 downto 0);)";
const char npiStatements[] =
    R"(  npi_read_start <= '0';
  npi_read_take <= '0';
  npi_read_base <= (others => '0');
  npi_read_words <= (others => '0');
  npi_write_start <= '0';
  npi_write_valid <= '0';
  npi_write_base <= (others => '0');
  npi_write_data <= (others => '0');
  npi_write_be <= (others => '1');
  npi_write_flush <= core_rst;

  u_stream : npi_stream
    port map (
      npi_addr_o => npi_addr_o, npi_addr_req_o => npi_addr_req_o,
      npi_addr_ack_i => npi_addr_ack_i, npi_rnw_o => npi_rnw_o, npi_size_o => npi_size_o,
      npi_rmw_o => npi_rmw_o, npi_wr_data_o => npi_wr_data_o, npi_wr_be_o => npi_wr_be_o,
      npi_wr_push_o => npi_wr_push_o, npi_wr_empty_i => npi_wr_empty_i,
      npi_wr_almost_full_i => npi_wr_almost_full_i, npi_wr_flush_o => npi_wr_flush_o,
      npi_rd_data_i => npi_rd_data_i, npi_rd_word_i => npi_rd_word_i,
      npi_rd_pop_o => npi_rd_pop_o, npi_rd_empty_i => npi_rd_empty_i,
      npi_rd_flush_o => npi_rd_flush_o, npi_init_done_i => npi_init_done_i,
      clk_i => clk_i, rst_i => rst_i, -- not core_rst: requested words must be taken
      read_start_i => npi_read_start, read_base_i => npi_read_base(31 downto 6),
      read_words_i => npi_read_words, read_stop_i => core_rst, read_valid_o => npi_read_valid,
      read_data_o => npi_read_data, read_take_i => npi_read_take, read_idle_o => npi_read_idle,
      write_start_i => npi_write_start, write_base_i => npi_write_base(31 downto 6),
      write_valid_i => npi_write_valid, write_data_i => npi_write_data,
      write_be_i => npi_write_be, write_ready_o => npi_write_ready,
      write_flush_i => npi_write_flush, write_idle_o => npi_write_idle);
)";

void lines(Writer& w, const char* text) {
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);)
        w.line(line);
}

std::string zeroed(const std::string& name, const Port& p) {
    return "  " + name + " <= " + (p.width == 1 ? "'0'" : "(others => '0')") + ";";
}

} // namespace

GeneratedFile verilogSkeleton(const Block& b) {
    Writer w;
    head(w, b, "//");
    w.line("`default_nettype none");
    w.line();
    w.line("module " + b.name + " (");
    w.line("    `include \"slot_ports.vh\"");
    if (b.memoryBytes)
        w.line("    `include \"memory_ports.vh\"");
    w.line(std::string("    output wire irq_o") + (b.pins.empty() ? "" : ","));
    for (const Pin& p : b.pins)
        w.line(std::string("    ") + (p.isOut() ? "output wire " : "input  wire ") +
               verilogRange(p.width) + p.name + (&p == &b.pins.back() ? "" : ","));
    w.line(");");
    std::string unused, connections;
    for (const Port& p : portsOf(b, false)) {
        std::string name = signalOf(p);
        if (isDone(p))
            w.line("    reg  " + name + ";");
        else
            w.line("    wire " + verilogRange(p.width) + name +
                   (p.isOut ? "" : " = " + std::to_string(p.width) + "'d0") + ";");
        if (p.isOut)
            unused += name + ", ";
        connections += ",\n        ." + p.name + "(" + name + ")";
    }
    w.line();
    w.line("    " + b.name + "_wrapper u_wrapper (");
    w.line("        `include \"slot_connect.vh\"");
    w.line("        .irq_o(irq_o)" + connections);
    w.line("    );");
    for (const Port& p : portsOf(b, false))
        if (isDone(p)) {
            w.line();
            w.line("    always @(posedge clk_i)");
            w.line("        " + signalOf(p) + " <= " + p.call->name + "_start && !core_rst;");
        }
    w.line();
    if (b.memoryBytes)
        lines(w, npiStream);
    for (const Pin& p : b.pins) {
        if (p.isOut())
            w.line("    assign " + p.name + " = " + std::to_string(p.width) + "'d0;");
        else
            unused += p.name + ", ";
    }
    w.line("    wire unused = &{1'b0, " + unused + "1'b0};");
    w.line("endmodule");
    return {b.name + ".v", w.text()};
}

GeneratedFile vhdlSkeleton(const Block& b) {
    Writer w;
    head(w, b, "--");
    std::vector<Port> outer = portsOf(b, true), own = ownPorts(b);
    outer.insert(outer.end(), own.begin(), own.end());
    vhdlEntity(w, b.name, outer, b.memoryBytes ? "npi_stream_pkg" : "");
    std::string connections;
    std::vector<std::string> zeros, dones;
    for (const Port& p : portsOf(b, false)) {
        std::string name = signalOf(p);
        w.line("  signal " + name + " : " + vhdlType(p.width) + ";");
        connections += std::string(",\n      ") + p.name + " => " + name;
        if (isDone(p))
            dones.push_back("      " + name + " <= " + p.call->name + "_start and not core_rst;");
        else if (!p.isOut)
            zeros.push_back(zeroed(name, p));
    }
    for (const Pin& p : b.pins)
        if (p.isOut())
            zeros.push_back(zeroed(p.name, {p.name, true, p.width, ""}));
    if (b.memoryBytes)
        lines(w, npiSignals);
    w.line("begin");
    w.line();
    w.line("  u_wrapper : entity work." + b.name + "_wrapper");
    w.line("    port map (");
    w.line("      clk_i => clk_i, rst_i => rst_i,");
    w.line(
        "      bus_valid_i => bus_valid_i, bus_write_i => bus_write_i, bus_addr_i => bus_addr_i,");
    w.line("      bus_wdata_i => bus_wdata_i, bus_ready_o => bus_ready_o, bus_rdata_o => "
           "bus_rdata_o,");
    w.line("      bus_error_o => bus_error_o, irq_o => irq_o" + connections + ");");
    w.line();
    if (!zeros.empty()) {
        for (const std::string& line : zeros)
            w.line(line);
        w.line();
    }
    if (!dones.empty()) {
        w.line("  ends : process (clk_i)");
        w.line("  begin");
        w.line("    if rising_edge(clk_i) then");
        for (const std::string& line : dones)
            w.line(line);
        w.line("    end if;");
        w.line("  end process;");
        w.line();
    }
    if (b.memoryBytes) {
        lines(w, npiStatements);
        w.line();
    }
    w.line("end architecture;");
    return {b.name + ".vhd", w.text()};
}

namespace {

// Returns the number of elements that the test gives to a sequence: 4, or the maximum if that is
// lower. Returns 0 for other types.
unsigned shown(const Call& c, const Type& type, const std::string& value) {
    if (isSequence(type))
        for (const Word& word : c.words)
            for (const Piece& p : word.pieces)
                if (p.isCount && !word.isOut && p.name == value + "_count")
                    return std::min(p.most, 4u);
    return 0;
}

} // namespace

GeneratedFile testSkeleton(const Block& b) {
    Writer w;
    w.line("// SPDX-License-Identifier: MIT");
    w.line("//");
    w.line("// " + b.name + "_test: calls every operation of the core.");
    w.line();
    w.line("#include \"V" + b.name + "_slot.h\"");
    w.line("#include \"" + b.name + "_proxy.h\"");
    for (const Call& c : b.calls) {
        if (c.isEvent)
            continue;
        std::string name = c.operation->name, arguments;
        name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
        w.function("TEST(" + b.interface->name + "Core, Answers" + name + ")", {}, [&] {
            w.line(b.interface->name + "Proxy<V" + b.name + "_slot> core;");
            for (const Slot& s : inVariables(*c.operation)) {
                if (unsigned count = shown(c, *s.type, s.value)) {
                    const Declaration& list = *s.type->declaration;
                    bool hasRoom = statedMaximum(list) > 0;
                    if (!hasRoom)
                        w.line(cVariable(list.element, s.value + "Elements") + "[" +
                               std::to_string(count) + "]{};");
                    w.line(cVariable(*s.type, s.value) + "{" + std::to_string(count) + ", " +
                           (hasRoom ? "{}" : s.value + "Elements") + "};");
                } else {
                    w.line(cVariable(*s.type, s.value) + "{};");
                }
                arguments +=
                    (arguments.empty() ? "" : ", ") + (isByPointer(*s.type) ? s.pointer : s.value);
            }
            for (const Field& p : c.operation->parameters)
                if (p.isOut) {
                    std::string out = cParameter(*c.operation, p);
                    w.line(cVariable(p.type, out) + "{};");
                    arguments += (arguments.empty() ? "&" : ", &") + out;
                }
            std::string call = "core." + cIdentifier(c.operation->name) + "(" + arguments + ")";
            bool isList = isSequence(c.operation->result);
            w.line(isList ? "EXPECT_EQ(" + call + ".size, 0);" : call + ";");
            for (const Field& p : c.operation->parameters)
                if (p.isOut && isSequence(p.type))
                    w.line("EXPECT_EQ(" + cParameter(*c.operation, p) + ".size, 0);");
        });
    }
    return {b.name + "_test.cpp", w.text()};
}

} // namespace hw
