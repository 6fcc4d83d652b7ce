// SPDX-License-Identifier: MIT
//
// system_slot: slot 0 shows the chip's identity, interrupt lines, the DDR3 page, bus errors and the cycle count.
//
// hdl/system/system.regs.json lists the registers.

`default_nettype none

module system_slot #(
    parameter SLOTS  = 3,         // populated slots, this one included
    parameter CLK_HZ = 100000000, // Hz
    parameter [32*SLOTS-1:0] CONTRACTS = {SLOTS{32'd0}} // hashes of the slots' registers, from slot 0 on
) (
    `include "slot_ports.vh"
    // interrupt lines of slots SLOTS-1..1, and the one to the processor
    input  wire [SLOTS-1:1] slot_irq_i,
    output wire             irq_o,
    // FSMC bridge
    output reg  [5:0]       page_o,         // DDR3 address bits 31..26
    input  wire             access_error_i, // one cycle
    input  wire             error_memory_i, // the error is of memory, and shown as 0x3FF
    input  wire [9:0]       error_addr_i,   // the register of the error, otherwise
    input  wire             error_write_i,
    input  wire             late_i
);
    `include "system_regs.vh"

    wire        reg_write, reg_read, own_irq;
    wire [3:0]  reg_addr;
    wire [31:0] reg_wdata;
    reg  [31:0] reg_rdata;

    reg [31:0] scratch, cycles_high_latched;
    reg [63:0] cycles;
    reg [9:0]  error_addr;
    reg        error_write, error_open;
    reg [31:0] contract;      // the hash of the requested slot
    wire [63:0] lines = {{(64-SLOTS){1'b0}}, slot_irq_i, own_irq};

    bus_wrapper #(
        .ID_VALUE (SYSTEM_ID_VALUE),
        .WORDS    (16'h1FF8),
        .EVENTS   (2)
    ) u_wrapper (
        `include "slot_connect.vh"
        .reg_write_o(reg_write), .reg_read_o(reg_read), .reg_addr_o(reg_addr),
        .reg_wdata_o(reg_wdata), .reg_rdata_i(reg_rdata),
        .event_i({late_i, access_error_i}), .irq_o(own_irq)
    );

    assign irq_o = |lines;

    // looked up on write, so that the read comes from a register
    reg [31:0] asked;
    integer    s;
    always @* begin
        asked = 32'd0;
        for (s = 0; s < SLOTS; s = s + 1)
            asked = asked | ({32{{26'd0, reg_wdata[5:0]} == s}} & CONTRACTS[32*s +: 32]);
    end

    always @* begin
        case (reg_addr)
            SYSTEM_SLOTS:      reg_rdata = SLOTS;
            SYSTEM_IRQ_LO:     reg_rdata = lines[31:0];
            SYSTEM_IRQ_HI:     reg_rdata = lines[63:32];
            SYSTEM_PAGE:       reg_rdata = {26'd0, page_o};
            SYSTEM_CLK_HZ:     reg_rdata = CLK_HZ;
            SYSTEM_ERROR_ADDR: reg_rdata = {15'd0, error_write, 6'd0, error_addr};
            SYSTEM_SCRATCH:    reg_rdata = scratch;
            SYSTEM_CYCLES_LO:  reg_rdata = cycles[31:0];
            SYSTEM_CYCLES_HI:  reg_rdata = cycles_high_latched;
            SYSTEM_CONTRACT:   reg_rdata = contract;
            default:           reg_rdata = 32'd0;
        endcase
    end

    wire clearing = bus_valid_i && bus_write_i && bus_addr_i == SYSTEM_EVENT && bus_wdata_i[0];

    always @(posedge clk_i) begin
        cycles <= cycles + 64'd1;
        if (reg_read && reg_addr == SYSTEM_CYCLES_LO)
            cycles_high_latched <= cycles[63:32];
        if (reg_write && reg_addr == SYSTEM_PAGE)
            page_o <= reg_wdata[5:0];
        if (reg_write && reg_addr == SYSTEM_CONTRACT)
            contract <= asked;
        if (reg_write && reg_addr == SYSTEM_SCRATCH)
            scratch <= reg_wdata;
        // The first error is kept until the event has been cleared; one that comes with the clear is new.
        if (access_error_i && (!error_open || clearing)) begin
            error_open  <= 1'b1;
            error_addr  <= error_memory_i ? 10'h3FF : error_addr_i;
            error_write <= error_write_i;
        end else if (clearing) begin
            error_open <= 1'b0;
        end
        if (rst_i) begin
            cycles      <= 64'd0;
            cycles_high_latched <= 32'd0;
            page_o      <= 6'd0;
            scratch     <= 32'd0;
            contract    <= CONTRACTS[31:0];
            error_open  <= 1'b0;
            error_addr  <= 10'd0;
            error_write <= 1'b0;
        end
    end

`ifdef FORMAL
    // Events, errors and the cycle count's latch follow the register table; without an access only the
    // cycle count moves, n in n clocks, which the simulator adds at once
    // (testbench/sim/quiet_span.cpp).
    reg past = 1'b0;
    (* anyseq *) reg begins; // a span
    reg [63:0] then;
    reg [15:0] n;
    reg        spans = 1'b0;
    (* hierconn *) wire [1:0] \u_wrapper.sticky , \u_wrapper.mask ;
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
            assert ({\u_wrapper.sticky , \u_wrapper.mask , cycles_high_latched, page_o, scratch, contract, error_open, error_addr, error_write} ==
                    $past({\u_wrapper.sticky , \u_wrapper.mask , cycles_high_latched, page_o, scratch, contract, error_open, error_addr, error_write}));
        cover (past && spans && n == 16'd9);
    end
    initial assume (rst_i);
    wire wrote = bus_valid_i && bus_write_i;
    always @(posedge clk_i) begin
        past <= 1'b1;
        if (past && $past(rst_i)) begin
            assert ({cycles, cycles_high_latched, page_o, scratch, error_open, error_addr, error_write} == 0);
            assert (contract == CONTRACTS[31:0]);
        end else if (past && !rst_i) begin
            // The place shown is that of the oldest error since the event was last clear.
            if ($past(access_error_i && (!error_open || clearing)))
                assert ({error_addr, error_write} == $past({error_addr_i | {10{error_memory_i}}, error_write_i}));
            else
                assert ({error_addr, error_write} == $past({error_addr, error_write}));
            assert (error_open == ($past(access_error_i) || $past(error_open && !clearing)));
            assert (\u_wrapper.sticky [1] == $past(late_i || (\u_wrapper.sticky [1] && !(wrote && bus_addr_i == SYSTEM_EVENT && bus_wdata_i[1]))));
            // The high word stays as it was when the low word was read.
            assert (cycles_high_latched == $past(reg_read && reg_addr == SYSTEM_CYCLES_LO ? cycles[63:32] : cycles_high_latched));
            assert (page_o == $past(wrote && bus_addr_i == SYSTEM_PAGE ? bus_wdata_i[5:0] : page_o));
            assert (scratch == $past(wrote && bus_addr_i == SYSTEM_SCRATCH ? bus_wdata_i : scratch));
            if ($past(wrote && bus_addr_i == SYSTEM_CONTRACT)) // 0 where there is no slot
                assert (contract == ((CONTRACTS >> {$past(bus_wdata_i[5:0]), 5'd0}) & 32'hFFFFFFFF));
            else
                assert ($stable(contract));
        end
        cover (past && !rst_i && $past(access_error_i && clearing && error_open));
    end
    always @* begin
        assert (!past || rst_i || error_open == \u_wrapper.sticky [0]); // so that the prover need not find it
        assert (irq_o == (|(\u_wrapper.sticky & \u_wrapper.mask ) || |slot_irq_i));
        if (bus_valid_i && !rst_i)
            assert (bus_error_o == (bus_addr_i > SYSTEM_CONTRACT));
        if (bus_valid_i && !bus_write_i && !rst_i)
            case (bus_addr_i)
                SYSTEM_ID:         assert (bus_rdata_o == SYSTEM_ID_VALUE);
                SYSTEM_EVENT:      assert (bus_rdata_o == {30'd0, \u_wrapper.sticky [1], error_open}); // both of one error
                SYSTEM_SLOTS:      assert (bus_rdata_o == SLOTS);
                SYSTEM_IRQ_LO:     assert (bus_rdata_o == {slot_irq_i[31:1], own_irq});
                SYSTEM_IRQ_HI:     assert (bus_rdata_o == {{(64-SLOTS){1'b0}}, slot_irq_i[SLOTS-1:32]});
                SYSTEM_PAGE:       assert (bus_rdata_o == {26'd0, page_o});
                SYSTEM_CLK_HZ:     assert (bus_rdata_o == CLK_HZ);
                SYSTEM_ERROR_ADDR: assert (bus_rdata_o == {15'd0, error_write, 6'd0, error_addr});
                SYSTEM_SCRATCH:    assert (bus_rdata_o == scratch);
                SYSTEM_CYCLES_LO:  assert (bus_rdata_o == cycles[31:0]);
                SYSTEM_CYCLES_HI:  assert (bus_rdata_o == cycles_high_latched);
                SYSTEM_CONTRACT:   assert (bus_rdata_o == contract);
                default: ;
            endcase
    end
`endif
endmodule
