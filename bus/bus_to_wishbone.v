// SPDX-License-Identifier: MIT
//
// bus_to_wishbone: connects a slot to a core with a Wishbone slave; it is a 32-bit Wishbone B4
// master, classic or pipelined (Wishbone B4, OpenCores 2010, chapters 3 and 5). bus_window.v
// describes the words and events.
//
// There is one transfer at a time. ERR ends the access with an error. After RTY the transfer is
// repeated. If the slot times out, it ends the cycle by setting CYC low.

`default_nettype none

module bus_to_wishbone #(
    parameter [31:0] ID_VALUE   = 32'd0,
    parameter        ADDR_WIDTH = 12,  // width of a byte address in the core, 3..32
    parameter        TIMEOUT    = 255, // time-out, clocks, 1..255
    // 0: classic; 1: pipelined, in which STB_O stays high until STALL_I is low
    parameter        PIPELINED  = 0
) (
    `include "slot_ports.vh"
    output wire                  irq_o,
    // Wishbone master
    output wire                  wb_cyc_o,
    output wire                  wb_stb_o,
    output wire                  wb_we_o,
    output wire [ADDR_WIDTH-1:0] wb_adr_o, // byte address; bits 1..0 are 0
    output wire [3:0]            wb_sel_o,
    output wire [31:0]           wb_dat_o,
    input  wire [31:0]           wb_dat_i,
    input  wire                  wb_ack_i,
    input  wire                  wb_err_i,
    input  wire                  wb_rty_i,
    input  wire                  wb_stall_i, // not used in classic mode
    // interrupt line of the core, a level in the clock domain clk_i
    input  wire                  irq_i
);
    wire busy;
    reg  accepted; // the core has taken the strobe (pipelined mode)
    reg  pause;    // CYC is low for one clock after RTY

    bus_window #(.ID_VALUE(ID_VALUE), .ADDR_WIDTH(ADDR_WIDTH), .TIMEOUT(TIMEOUT)) u_window (
        `include "slot_connect.vh"
        .irq_o(irq_o),
        .idle_i(1'b1), .busy_o(busy), .write_o(wb_we_o), .addr_o(wb_adr_o), .wdata_o(wb_dat_o),
        .done_i(wb_cyc_o && (wb_ack_i || wb_err_i)), .error_i(wb_err_i), .rdata_i(wb_dat_i),
        .irq_i(irq_i)
    );

    assign wb_cyc_o = busy && !pause;
    assign wb_stb_o = wb_cyc_o && !accepted;
    assign wb_sel_o = 4'hF;

    always @(posedge clk_i) begin
        accepted <= PIPELINED != 0 && wb_cyc_o && !wb_ack_i && !wb_err_i && !wb_rty_i
                    && (accepted || !wb_stall_i);
        pause    <= wb_cyc_o && wb_rty_i && !wb_ack_i && !wb_err_i;
        // When an access has ended, even by a time-out, the next access starts a new cycle.
        if (rst_i || (bus_valid_i && bus_ready_o)) begin
            accepted <= 1'b0;
            pause    <= 1'b0;
        end
    end

    wire unused = &{1'b0, wb_stall_i, 1'b0};

`ifdef RULES // the rules are included in proofs and in tests of cores
    // Checks of the Wishbone B4 handshakes of a master that has one transfer at a time. The numbers
    // come from the rules in the standard (B4, 2010). The slave is assumed to follow its rules.
    reg past = 1'b0;
    reg outstanding = 1'b0; // a strobe was taken and has not been answered yet (pipelined mode)
    // 1: the cycle may end in the next clock without an answer
    wire abort  = !bus_valid_i || bus_ready_o;
    wire answer = wb_ack_i || wb_err_i || wb_rty_i;
    wire taken  = wb_stb_o && (PIPELINED == 0 ? answer : !wb_stall_i);
    always @(posedge clk_i) begin
        past <= past || rst_i;
        outstanding <= PIPELINED != 0 && !rst_i && wb_cyc_o && !answer && !abort &&
            (outstanding || taken);
    end

`ifdef FORMAL
    always @* if (!rst_i) begin
// in simulation the checks are made at clock edges, because combinational signals have glitches
`else
    always @(posedge clk_i) if (past && !rst_i) begin
`endif
        assert (!wb_stb_o || wb_cyc_o);              // 3.25: CYC is high while STB is high
        assert (!(wb_stb_o && outstanding));      // at most one transfer at a time
        assume (wb_ack_i + wb_err_i + wb_rty_i <= 1); // 3.45: at most one of ACK, ERR and RTY is
                                                      // high
        // 3.55: outside a cycle the slave may keep its answer signals high, so they are not checked
        // there.
        if (PIPELINED != 0 && wb_cyc_o && !outstanding && !taken)
            // 3.35: the slave answers only after it has taken the strobe
            assume (!answer);
    end
    always @(posedge clk_i) begin
        if (past && $past(rst_i))
            assert (!wb_cyc_o && !wb_stb_o);       // 3.20: a reset ends all cycles
        if (past && !rst_i && !$past(rst_i)) begin
            // Rule 3.60: the signals that belong to a strobe are stable until the strobe is taken.
            if ($past(wb_stb_o && !taken && !abort)) begin
                assert (wb_stb_o && wb_cyc_o);
                assert (wb_we_o == $past(wb_we_o) && wb_adr_o == $past(wb_adr_o));
                assert (!wb_we_o || wb_dat_o == $past(wb_dat_o));
            end
            // after a strobe was taken, the cycle continues until the answer
            if ($past(PIPELINED != 0 && wb_cyc_o && (outstanding || taken) && !answer && !abort))
                assert (wb_cyc_o);
        end
    end
`endif
`ifdef FORMAL
    // Each access that succeeds has had exactly one strobe taken, and returns the answer to this
    // strobe unchanged.
    always @* if (!rst_i && bus_valid_i && bus_addr_i[3] && bus_ready_o && !bus_error_o) begin
        assert (wb_cyc_o && wb_ack_i && !wb_err_i && bus_rdata_o == wb_dat_i);
        assert (wb_we_o == bus_write_i && wb_adr_o[4:2] == bus_addr_i[2:0]);
        assert (wb_stb_o || outstanding);
    end
    always @* if (!rst_i) begin // an access to a word of the window writes the complete word
        assert (wb_sel_o == 4'hF && wb_adr_o[1:0] == 2'd0);
        assert (!wb_cyc_o || (bus_valid_i && bus_addr_i[3]));
        if (bus_valid_i && bus_addr_i[3] && wb_cyc_o)
            assert (bus_ready_o || !(wb_ack_i || wb_err_i)); // an answer ends the access
    end
    reg retry = 1'b0;
    always @(posedge clk_i)
        retry <= !rst_i && wb_cyc_o && wb_rty_i && !wb_ack_i && !wb_err_i &&
            !(bus_valid_i && bus_ready_o);
    always @* if (!rst_i) begin
        assert (!(retry && wb_cyc_o)); // CYC is low for a clock after RTY
        assert (!accepted || (busy && !pause));
        assert (accepted == outstanding);
        cover (bus_valid_i && bus_ready_o && !bus_error_o && bus_addr_i[3] &&
               accepted == (PIPELINED != 0));
        cover (bus_valid_i && bus_ready_o && wb_err_i && wb_cyc_o);
        cover (pause);
    end
`endif
endmodule
