// SPDX-License-Identifier: MIT
//
// fsmc_bridge_proof: proves the properties at the pins of fsmc_bridge that the processor relies on;
// for formal verification only.
//
// Time advances in steps. The clock and the pins may change in each step, so that every ratio and
// phase is covered. The memory (fsmc_memory, which is proven separately) and the slave of the
// register bus are unconstrained: they may answer at any time with any value, or never.
//
// - NWAIT ends within two time-outs plus the delay of the synchronisers.
// - Once NWAIT is inactive during a register access, it stays inactive and the data stays stable.
// - NWAIT does not glitch while the pins are stable: g_nwait.
// - A register write continues only after the previous write has been transferred and no register
//   access is in progress. The time-out of the bridge ends only the waits of accesses to memory,
//   however short the time-out is.
// With WORDS = 1 the module proves instead that 32-bit register words are atomic
// (fsmc_words_proof). With LATE = 1 this proof is bounded. With LATE = 0 it is inductive, and its
// invariant counts the clocks of the synchronisers.

`default_nettype none

`ifdef FORMAL
module fsmc_bridge_proof #(
    parameter MUXED        = 0,
    parameter WAIT_HIGH    = 0,
    parameter TIMEOUT_LOG2 = 1,
    parameter WORDS        = 0, // 1: proves only that 32-bit words are atomic (fsmc_words_proof)
    // 1: each synchroniser may take the input value of the previous clock
    parameter LATE         = WORDS == 0
) (
    input wire        clk_i,
    // pins: the address selects one of 8 halfwords or, with beyond_i, a halfword after the last
    // slot; a halfword has two bits of data
    input wire        ne1_i,
    input wire        ne2_i,
    input wire        noe_n_i,
    input wire        nwe_n_i,
    input wire        nadv_n_i, // used only if MUXED is 1
    input wire        beyond_i,
    input wire [2:0]  a_i,
    input wire [1:0]  d_i,
    input wire [1:0]  nbl_n_i,
    // slave
    input wire        ready_i,
    input wire        error_i,
    input wire [3:0]  rdata_i
);
    (* gclk *) wire step;
    reg  rst = 1'b1;
    wire [24:0] a = {13'd0, beyond_i, 8'd0, a_i};
    wire [15:0] d = MUXED != 0 && !nadv_n_i ? a[15:0] : {14'd0, d_i};
    wire [15:0] d_out;
    wire        nwait_pin, nwait_n = nwait_pin ^ (WAIT_HIGH != 0);
    wire        oe, access_error, error_write, late;
    wire [9:0]  error_addr, bus_addr;
    wire        bus_valid, bus_write, error_memory;
    wire [31:0] bus_wdata;
    wire [31:0] bus_rdata = {14'd0, rdata_i[3:2], 14'd0, rdata_i[1:0]};

    fsmc_bridge #(.MUXED(MUXED), .WAIT_HIGH(WAIT_HIGH), .TIMEOUT_LOG2(TIMEOUT_LOG2)) u_fsmc_bridge (
        .clk_i(clk_i), .rst_i(rst),
        .fsmc_a_i(a), .fsmc_d_i(d), .fsmc_d_o(d_out), .fsmc_d_oe_o(oe),
        .fsmc_ne_n_i({!ne2_i, !ne1_i}), .fsmc_noe_n_i(noe_n_i), .fsmc_nwe_n_i(nwe_n_i),
        .fsmc_nbl_n_i(nbl_n_i), .fsmc_nadv_n_i(nadv_n_i), .fsmc_nwait_n_o(nwait_pin),
        .page_i(6'd0), .access_error_o(access_error), .error_memory_o(error_memory),
        .error_addr_o(error_addr),
        .error_write_o(error_write), .late_o(late),
        .bus_valid_o(bus_valid), .bus_write_o(bus_write), .bus_addr_o(bus_addr),
        .bus_wdata_o(bus_wdata), .bus_ready_i(ready_i), .bus_rdata_i(bus_rdata),
        .bus_error_i(error_i),
        .npi_addr_ack_i(1'b0), .npi_wr_empty_i(1'b1), .npi_wr_almost_full_i(1'b0),
        .npi_rd_data_i(64'd0), .npi_rd_word_i(4'd0), .npi_rd_empty_i(1'b1), .npi_init_done_i(1'b1)
    );

    // Internal signals of the bridge. Yosys's command flatten connects these wires to the
    // signals of the same names.
    (* hierconn *) wire \u_fsmc_bridge.clear , \u_fsmc_bridge.excuse , \u_fsmc_bridge.same ,
        \u_fsmc_bridge.found , \u_fsmc_bridge.wr_async , \u_fsmc_bridge.busy ,
        \u_fsmc_bridge.roomy , \u_fsmc_bridge.excused_read , \u_fsmc_bridge.excused_write ,
        \u_fsmc_bridge.reg_access , \u_fsmc_bridge.taken , \u_fsmc_bridge.room ,
        \u_fsmc_bridge.more_room ,
        \u_fsmc_bridge.u_fsmc_registers.done_ne ,
        \u_fsmc_bridge.u_fsmc_registers.done_noe ;
    (* hierconn *) wire [1:0] \u_fsmc_bridge.roomy_for_both ;
    (* hierconn *) wire [1:0] \u_fsmc_bridge.taken_ne ;
    (* hierconn *) wire [24:0] \u_fsmc_bridge.taken_addr ;
    (* hierconn *) wire [15:0] \u_fsmc_bridge.taken_data ;
    (* hierconn, init = 1'b0 *) // flatten drops the initial value of a joined wire
                   wire \u_fsmc_bridge.u_write.u_cdc_pulse.turned ,
        \u_fsmc_bridge.u_write.u_cdc_pulse.u_cdc_bit.bit_meta ,
        \u_fsmc_bridge.u_write.u_cdc_pulse.turned_sync ,
        \u_fsmc_bridge.u_write.u_cdc_pulse.last ,
        \u_fsmc_bridge.u_write.u_cdc_pulse.earlier ;
    (* hierconn *) wire [44:0] \u_fsmc_bridge.held ;
    (* hierconn, init = 5'd0 *) wire [4:0] \u_fsmc_bridge.u_access.bit_meta ,
        \u_fsmc_bridge.u_access.bit_sync ;
    (* hierconn *) wire \u_fsmc_bridge.u_fsmc_registers.flushing ,
        \u_fsmc_bridge.u_fsmc_registers.give ,
        \u_fsmc_bridge.u_fsmc_registers.answering ,
        \u_fsmc_bridge.u_fsmc_registers.half_read ,
        \u_fsmc_bridge.u_fsmc_registers.half_write ,
        \u_fsmc_bridge.u_fsmc_registers.asked_high ,
        \u_fsmc_bridge.u_fsmc_registers.given_up ,
        \u_fsmc_bridge.u_fsmc_registers.seen ;
    (* hierconn, init = 1'b0 *) wire \u_fsmc_bridge.u_fsmc_registers.u_done.bit_meta ,
        \u_fsmc_bridge.u_fsmc_registers.u_done.bit_sync ;
    (* hierconn *) wire [31:0] \u_fsmc_bridge.u_fsmc_registers.word ;
    (* hierconn *) wire \u_fsmc_bridge.u_write.u_cdc_pulse.u_cdc_bit.late ,
        \u_fsmc_bridge.u_fsmc_registers.u_done.late ;
    (* hierconn *) wire [4:0] \u_fsmc_bridge.u_access.late ;
    (* anyseq *) reg late_write, late_done, late_access;
    assign \u_fsmc_bridge.u_write.u_cdc_pulse.u_cdc_bit.late = late_write && LATE != 0;
    assign \u_fsmc_bridge.u_fsmc_registers.u_done.late = late_done && LATE != 0;
    assign \u_fsmc_bridge.u_access.late = {5{late_access && LATE != 0}};
    wire clear = \u_fsmc_bridge.clear , excuse = \u_fsmc_bridge.excuse ;
    // `turns` contains the flip-flops of cdc_pulse through which the toggle of a write moves: first
    // the flip-flop clocked by NWE, then the flip-flops clocked by clk_i, in order.
    wire [4:0]  turns = {\u_fsmc_bridge.u_write.u_cdc_pulse.turned ,
        \u_fsmc_bridge.u_write.u_cdc_pulse.u_cdc_bit.bit_meta ,
        \u_fsmc_bridge.u_write.u_cdc_pulse.turned_sync ,
        \u_fsmc_bridge.u_write.u_cdc_pulse.last ,
        \u_fsmc_bridge.u_write.u_cdc_pulse.earlier };
    wire [44:0] taken = \u_fsmc_bridge.held ; // write that the last edge of NWE has registered
    wire [42:0] copy  =
        {\u_fsmc_bridge.taken_ne , \u_fsmc_bridge.taken_addr , \u_fsmc_bridge.taken_data };

    // ---- Pins in the previous step, and what has happened in the current access
    reg        past = 1'b0, was_clk = 1'b1, was_ne1 = 1'b0, was_ne2 = 1'b0, was_noe = 1'b1,
        was_nwe = 1'b1;
    reg        was_beyond = 1'b0, was_nwait = 1'b1;
    reg [2:0]  was_a = 3'd0;
    reg [1:0]  was_d = 2'd0, was_nbl = 2'd0, was_out = 2'd0;
    reg [2:0]  resets = 3'd0; // clocks of reset so far, counted up to 2
    reg        let_go = 1'b0; // NWAIT was inactive in an earlier step of this access
    reg [2:0]  rest = 3'd0;   // clocks since the last edge of NWE, or since an access was aborted
    reg [1:0]  calm = 2'd0;   // clocks since NWAIT became inactive in this access
    // number of clocks after which a synchroniser has certainly sampled a stable level
    localparam [1:0] CALM = LATE != 0 ? 2'd3 : 2'd2;
    reg        latched = 1'b0; // NADV was low in an earlier step of this access
    reg        held = 1'b0;   // the strobe of a write has risen, and NE has not risen yet
    reg        given_up = 1'b0; // the previous access was aborted
    wire clock    = past && clk_i && !was_clk;
    wire selected = ne1_i || ne2_i, was_selected = was_ne1 || was_ne2;
    wire strobe   = !noe_n_i || !nwe_n_i, was_strobe = !was_noe || !was_nwe;
    wire access   = selected && strobe, was_access = was_selected && was_strobe;
    wire same     = {ne1_i, ne2_i, beyond_i, a_i} == {was_ne1, was_ne2, was_beyond, was_a};
    // the strobe rises before NE, as at the end of a write
    wire ended    = was_access && !strobe && selected;
    wire wrote    = was_access && !was_nwe && ended;
    wire gives_up = was_access && !selected && (was_noe || calm != CALM);

    always @(posedge step) begin
        past <= 1'b1;
        {was_clk, was_ne1, was_ne2, was_noe, was_nwe} <= {clk_i, ne1_i, ne2_i, noe_n_i, nwe_n_i};
        {was_beyond, was_a, was_d, was_nbl, was_nwait, was_out} <=
            {beyond_i, a_i, d_i, nbl_n_i, nwait_n, d_out[1:0]};
        if (clock && resets != 3'd2)
            resets <= resets + 3'd1;
        rst <= resets < 3'd2;
        latched <= selected && (latched || !nadv_n_i);
        if (!access || !nwait_n) begin
            let_go <= 1'b0;
            calm   <= 2'd0;
        end else if (was_access) begin
            let_go <= 1'b1;
            if (clock && calm != CALM)
                calm <= calm + 2'd1;
        end
        held <= (wrote || held) && selected;
        if (wrote || gives_up)
            rest <= 3'd0;
        else if (clock && rest != 3'd7)
            rest <= rest + 3'd1;
        given_up <= gives_up || (given_up && !access);
    end

    always @* begin
        // Reset lasts two clocks. Meanwhile the pins are idle.
        assume (past || (clk_i && !selected));
        assume (!rst || (!selected && !strobe));
        // The processor uses one bank and one strobe at a time. A strobe falls while its bank is
        // selected, or in the same step as NE. The address is stable.
        assume (!(ne1_i && ne2_i) && (noe_n_i || nwe_n_i));
        assume (!(was_selected && selected) || same);
        assume (!(was_access && strobe) || {noe_n_i, nwe_n_i} == {was_noe, was_nwe});
        assume (selected || was_selected || !strobe || was_strobe);
        assume (!(was_access && !nwe_n_i && access) || (d_i == was_d && nbl_n_i == was_nbl));
        assume (!wrote || (d_i == was_d && nbl_n_i == was_nbl));
        // A multiplexed address is latched before the strobe falls.
        assume (!strobe || nadv_n_i);
        assume (MUXED == 0 || !access || latched);
        // A write strobe may rise only after NWAIT was inactive. If NE rises first, the access is
        // aborted, and the strobe stays inactive for some clocks.
        assume (!wrote || let_go);
        assume (!(was_strobe && !was_selected) || !strobe || !selected);
        assume (!held || !strobe);
        // In a read, NE and NOE rise together, at least two clocks after NWAIT became inactive (4
        // HCLK in the FSMC).
        assume (!ended || wrote);
        // Two edges of NWE are at least three clocks apart (fsmc_bridge). After an aborted access,
        // the distance is at least four clocks.
        assume (!wrote || rest >= 3'd3);
        assume (!(given_up && access) || rest >= 3'd4);
    end

    // ---- NWAIT
    localparam [7:0] BOUND = 4 * ((1 << TIMEOUT_LOG2) + 1) + 14;
    generate
        if (WORDS == 0) begin : g_nwait
            reg [7:0] waited = 8'd0;
            always @(posedge step) begin
                if (!access || nwait_n)
                    waited <= 8'd0;
                else if (clock && waited != 8'hFF)
                    waited <= waited + 8'd1;
                assert (waited < BOUND);
            end
            // clocks since the last access to memory, up to 7; a late synchroniser may still see
            // this access
            reg [2:0] since_ne1 = 3'd7;
            always @(posedge step)
                if (ne1_i && strobe)
                    since_ne1 <= 3'd0;
                else if (clock && since_ne1 != 3'd7)
                    since_ne1 <= since_ne1 + 3'd1;
            // While the pins are stable, NWAIT is a monotonic function of these levels: a level
            // that is 1 contributes to the end of the wait, or has no effect. Several levels may
            // change at one clock edge, and their changes arrive in any order. NWAIT does not
            // glitch if all of them rise, or all of them fall. It also does not glitch if the
            // rising levels alone and the falling levels alone lead to the same NWAIT.
            wire [2:0] rooms = {\u_fsmc_bridge.roomy && !\u_fsmc_bridge.wr_async ,
                \u_fsmc_bridge.roomy_for_both [1], \u_fsmc_bridge.excused_write };
            wire [7:0] levels = {\u_fsmc_bridge.same && \u_fsmc_bridge.found ,
                \u_fsmc_bridge.excused_read ,
                !\u_fsmc_bridge.wr_async , !(\u_fsmc_bridge.wr_async && taken[44]),
                !\u_fsmc_bridge.busy , |rooms,
                \u_fsmc_bridge.u_fsmc_registers.done_ne ,
                \u_fsmc_bridge.u_fsmc_registers.done_noe };
            // the two inputs of the first bit of `rooms`
            wire [1:0] parts = {\u_fsmc_bridge.roomy , !\u_fsmc_bridge.wr_async };
            reg  [7:0] was_levels = 8'd0;
            reg  [2:0] was_rooms = 3'd0;
            reg  [1:0] was_parts = 2'd0;
            reg        was_rst = 1'b1, was_drops = 1'b0, was_writes = 1'b0, was_room = 1'b0,
                was_more = 1'b0, dropped = 1'b0;
            function ends_wait(input [7:0] l, input ne2, input noe_n);
                ends_wait = noe_n ? (ne2 ? l[5] && l[3] : l[4] && l[3] && l[2]) :
                            ne2 ? l[1] && l[0] : (l[7] || l[6]) && l[5] && l[3];
            endfunction
            wire [7:0] both = levels & was_levels, either = levels | was_levels;
            // the levels that have an effect on this access
            wire [7:0] mask = noe_n_i ? (ne2_i ? 8'b00101000 : 8'b00011100) :
                              ne2_i ? 8'b00000011 : 8'b11101000;
            wire [7:0] rise = levels & ~was_levels & mask, fall = was_levels & ~levels & mask;
            // an access that was in progress in the previous step, with the same pins
            wire still = past && !rst && !was_rst && access && was_access && same &&
                {noe_n_i, nwe_n_i} == {was_noe, was_nwe};
            always @(posedge step) begin
                {was_levels, was_rooms, was_rst} <= {levels, rooms, rst};
                was_parts <= parts;
                // The following assumptions are proven elsewhere. fsmc_memory: while the address is
                // stable, only a write or a register access discards data. fsmc_post: only a write
                // uses room, and room for three halfwords leaves room for two in the next clock.
                was_writes <= \u_fsmc_bridge.taken && \u_fsmc_bridge.taken_ne [0];
                was_drops  <= \u_fsmc_bridge.reg_access || \u_fsmc_bridge.taken ;
                was_room   <= \u_fsmc_bridge.room ;
                was_more   <= \u_fsmc_bridge.more_room ;
                assume (!still || !(was_levels[7] && !levels[7]) || was_drops);
                if (clock)
                    dropped <= was_drops;
                assume (!levels[7] || !(clock ? was_drops : dropped));
                assume (!was_room || \u_fsmc_bridge.room || (clock && was_writes));
                assume (!was_more || \u_fsmc_bridge.more_room || (clock && was_writes));
                assume (\u_fsmc_bridge.room || !(was_more || \u_fsmc_bridge.more_room ));
            end
            always @* if (past) begin
                assert (rst || !selected || nwait_n == ends_wait(levels, ne2_i, noe_n_i));
                // The OR of `rooms` does not glitch, for the same reason.
                if (still && ne1_i && noe_n_i) begin
                    assert ((rooms & ~was_rooms) == 3'd0 || (was_rooms & ~rooms) == 3'd0 ||
                            (rooms & was_rooms) != 3'd0);
                    assert (parts != ~was_parts || ^parts == 1'b0 ||
                            (rooms[1:0] & was_rooms[1:0]) != 2'd0);
                end
                if (still)
                    assert (rise == 8'd0 || fall == 8'd0 || ends_wait(both, ne2_i, noe_n_i) ==
                            ends_wait(either, ne2_i, noe_n_i));
                cover (still && !was_nwait && nwait_n && !noe_n_i && ne1_i);
            end
            always @(posedge step) if (past) begin
                if (ne2_i && access && let_go)
                    assert (nwait_n);
                if (ne2_i && access && let_go && !noe_n_i)
                    assert (d_out[1:0] == was_out);
                assert (rst || !excuse || since_ne1 <= 3'd3);
                assert (!(ne2_i && !nwe_n_i && nwait_n) || clear);
                assert (oe == (selected && !noe_n_i));
                cover (waited > 8'd8 && was_access && access && nwait_n);
            end
        end else begin : g_words
            `include "fsmc_words_proof.vh"
        end
    endgenerate
endmodule
`endif
