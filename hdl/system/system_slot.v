// SPDX-License-Identifier: MIT
//
// system_slot: implements slot 0, with the chip's identity, the interrupt lines, the DDR3 page, bus
// errors and the cycle count.
//
// hdl/system/system.regs.json describes the registers.

`default_nettype none

module system_slot #(
    parameter SLOTS  = 3,         // number of slots in use, including this one
    parameter CLK_HZ = 100000000, // Hz
    // hash of each slot's register map, slot 0 first
    parameter [32*SLOTS-1:0] CONTRACTS = {SLOTS{32'd0}}
) (
    `include "slot_ports.vh"
    // interrupt lines of slots SLOTS-1..1, and the interrupt line to the processor
    input  wire [SLOTS-1:1] slot_irq_i,
    output wire             irq_o,
    // FSMC bridge
    output wire [5:0]       page_o,         // DDR3 address bits 31..26
    input  wire             access_error_i, // one cycle
    // the error belongs to an access to memory; it is reported with the register address 0x3FF
    input  wire             error_memory_i,
    // address of the register with the failed access; unused for a memory error
    input  wire [9:0]       error_addr_i,
    input  wire             error_write_i,
    input  wire             late_i
);
    `include "system_regs.vh"

    wire        own_irq, cycles_read, contract_write, error_open, clearing;
    reg [31:0] cycles_high_latched;
    reg [63:0] cycles;
    reg [9:0]  error_addr;
    reg        error_write;
    reg [31:0] contract;      // hash of the register map of the slot that software selected
    wire [63:0] lines = {{(64-SLOTS){1'b0}}, slot_irq_i, own_irq};
    wire [31:0] scratch;

    system_regs u_registers (
        `include "slot_connect.vh"
        .irq_o(own_irq),
        .bus_error_event_i(access_error_i), .late_event_i(late_i),
        .bus_error_pending_o(error_open), .bus_error_clear_o(clearing),
        .slots_i(SLOTS), .irq_lo_i(lines[31:0]), .irq_hi_i(lines[63:32]), .page_o(page_o),
        .clk_hz_i(CLK_HZ), .error_addr_word_i(error_addr), .error_addr_write_i(error_write),
        .scratch_o(scratch), .cycles_lo_read_o(cycles_read), .cycles_lo_i(cycles[31:0]),
        .cycles_hi_i(cycles_high_latched),
        .contract_write_o(contract_write), .contract_i(contract)
    );

    assign irq_o = |lines;

    // hash of the slot with the number being written to CONTRACT; the write stores the hash in the
    // register `contract`, which a read returns
    reg [31:0] asked;
    integer    s;
    always @* begin
        asked = 32'd0;
        for (s = 0; s < SLOTS; s = s + 1)
            asked = asked | ({32{{26'd0, bus_wdata_i[5:0]} == s}} & CONTRACTS[32*s +: 32]);
    end

    always @(posedge clk_i) begin
        cycles <= cycles + 64'd1;
        if (cycles_read)
            cycles_high_latched <= cycles[63:32];
        if (contract_write)
            contract <= asked;
        // The first error is stored until software clears its event. An error in the clock in which
        // the event is cleared counts as a new first error.
        if (access_error_i && (!error_open || clearing)) begin
            error_addr  <= error_memory_i ? 10'h3FF : error_addr_i;
            error_write <= error_write_i;
        end
        if (rst_i) begin
            cycles      <= 64'd0;
            cycles_high_latched <= 32'd0;
            contract    <= CONTRACTS[31:0];
            error_addr  <= 10'd0;
            error_write <= 1'b0;
        end
    end

    wire unused = &{1'b0, scratch, 1'b0};
`ifdef FORMAL
    // The registers themselves are proven in formal.system_regs. Without an access only the cycle
    // count changes, by n in n clocks. The simulator relies on this when it adds n clocks at once
    // (testbench/sim/quiet_span.cpp).
    reg past = 1'b0;
    (* anyseq *) reg begins; // a span
    reg [63:0] then;
    reg [15:0] n;
    reg        spans = 1'b0;
    (* hierconn *) wire [1:0] \u_registers.events , \u_registers.mask ;
    always @(posedge clk_i) begin
        n <= n + 16'd1;
        if (rst_i || &n)
            spans <= 1'b0;
        if (begins && !rst_i) begin
            spans <= 1'b1;
            then  <= cycles;
            n     <= 16'd1;
        end
        if (spans)
            assert (n != 16'd0 && cycles == then + {48'd0, n});
        if (past && !$past(rst_i || bus_valid_i || access_error_i || late_i))
            assert ({\u_registers.events , \u_registers.mask , scratch,
                     cycles_high_latched, page_o, contract, error_addr, error_write} ==
                    $past({\u_registers.events , \u_registers.mask , scratch,
                           cycles_high_latched, page_o, contract, error_addr, error_write}));
        cover (past && spans && n == 16'd9);
    end
    initial assume (rst_i);
    always @(posedge clk_i) begin
        past <= 1'b1;
        if (past && $past(rst_i)) begin
            assert ({cycles, cycles_high_latched, error_addr, error_write} == 0);
            assert (contract == CONTRACTS[31:0]);
        end else if (past && !rst_i) begin
            // The reported address belongs to the first error since the event was cleared.
            if ($past(access_error_i && (!error_open || clearing)))
                assert ({error_addr, error_write} ==
                        $past({error_addr_i | {10{error_memory_i}}, error_write_i}));
            else
                assert ({error_addr, error_write} == $past({error_addr, error_write}));
            // The high word keeps the value that it had when the low word was read.
            assert (cycles_high_latched == $past(
                bus_valid_i && !bus_write_i && bus_addr_i == SYSTEM_CYCLES_LO ?
                cycles[63:32] : cycles_high_latched));
            // The hash of the selected slot; 0 if this slot does not exist.
            if ($past(bus_valid_i && bus_write_i && bus_addr_i == SYSTEM_CONTRACT))
                assert (contract ==
                        ((CONTRACTS >> {$past(bus_wdata_i[5:0]), 5'd0}) & 32'hFFFFFFFF));
            else
                assert ($stable(contract));
        end
        cover (past && !rst_i && $past(access_error_i && clearing && error_open));
    end
    always @*
        assert (irq_o == (|(\u_registers.events & \u_registers.mask ) || |slot_irq_i));
`endif
endmodule
