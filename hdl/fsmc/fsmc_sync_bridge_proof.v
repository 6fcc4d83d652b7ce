// SPDX-License-Identifier: MIT
//
// fsmc_sync_bridge_proof: properties of fsmc_sync_bridge that the processor relies on; for formal
// verification only.
//
// A step is one clock. The pins have the levels that the first flip-flops sample; each synchroniser
// may see a change one clock late (cdc_bit). The memory (fsmc_memory, which is proven separately)
// and the slave of the register bus are unconstrained: they answer at any time with any value, or
// never. The assumptions are the rules for the processor in the header of fsmc_sync_bridge.
//
// - At the first sample of a strobe, NWAIT is active. Once it is inactive, it stays inactive until
//   the strobe rises. It becomes inactive within two time-outs plus the clocks between them.
// - Each write is carried out exactly once, with the address, data and byte lanes at the pins.
// - A read returns the data that the memory or the registers gave for the address at the pins, and
//   the data is stable from the end of the wait until the strobe rises.
// - Address and data of a write to a register are stable until the write has taken effect.
// With ABORTS = 1 the processor may end an access at any time, and the pins of address and data
// change with the strobe. Then a write is carried out at most once, with valid data.

`default_nettype none

`ifdef FORMAL
module fsmc_sync_bridge_proof #(
    parameter ABORTS = 0 // 1: the processor may end an access at any time
) (
    input wire        clk_i,
    // pins: the address is one of 8 halfwords, or an address after the last slot; a halfword has
    // two bits of data
    input wire        ne1_i,
    input wire        ne2_i,
    input wire        noe_n_i,
    input wire        nwe_n_i,
    input wire        beyond_i,
    input wire [2:0]  a_i,
    input wire [1:0]  d_i,
    input wire [1:0]  nbl_n_i,
    // slave
    input wire        ready_i,
    input wire        error_i,
    input wire [3:0]  rdata_i
);
    reg  rst = 1'b1;
    wire [24:0] a = {13'd0, beyond_i, 8'd0, a_i};
    wire [15:0] d = {14'd0, d_i};
    wire [15:0] d_out;
    wire        nwait_n, oe, access_error, error_memory, error_write, late;
    wire [9:0]  error_addr, bus_addr;
    wire        bus_valid, bus_write;
    wire [31:0] bus_wdata;

    fsmc_sync_bridge #(.TIMEOUT_LOG2(1)) u_bridge (
        .clk_i(clk_i), .rst_i(rst),
        .fsmc_a_i(a), .fsmc_d_i(d), .fsmc_d_o(d_out), .fsmc_d_oe_o(oe),
        .fsmc_ne_n_i({!ne2_i, !ne1_i}), .fsmc_noe_n_i(noe_n_i), .fsmc_nwe_n_i(nwe_n_i),
        .fsmc_nbl_n_i(nbl_n_i), .fsmc_nadv_n_i(1'b1), .fsmc_nwait_n_o(nwait_n),
        .page_i(6'd0), .access_error_o(access_error), .error_memory_o(error_memory),
        .error_addr_o(error_addr), .error_write_o(error_write), .late_o(late),
        .bus_valid_o(bus_valid), .bus_write_o(bus_write), .bus_addr_o(bus_addr),
        .bus_wdata_o(bus_wdata), .bus_ready_i(ready_i),
        .bus_rdata_i({14'd0, rdata_i[3:2], 14'd0, rdata_i[1:0]}), .bus_error_i(error_i),
        .npi_addr_ack_i(1'b0), .npi_wr_empty_i(1'b1), .npi_wr_almost_full_i(1'b0),
        .npi_rd_data_i(64'd0), .npi_rd_word_i(4'd0), .npi_rd_empty_i(1'b1), .npi_init_done_i(1'b1)
    );

    // Signals of the bridge. Yosys's command flatten connects these wires to the signals of the
    // same names.
    (* hierconn *) wire \u_bridge.active , \u_bridge.ready , \u_bridge.settled , \u_bridge.reading ,
        \u_bridge.seen , \u_bridge.seen_was , \u_bridge.busy , \u_bridge.answered ,
        \u_bridge.is_write , \u_bridge.is_register , \u_bridge.writes_memory ,
        \u_bridge.reg_write ;
    (* hierconn *) wire [24:0] \u_bridge.addr ;
    (* hierconn *) wire [15:0] \u_bridge.wdata , \u_bridge.mem_data , \u_bridge.reg_data ;
    (* hierconn *) wire [1:0] \u_bridge.be ;

    // ---- The processor
    wire [1:0] ne = {ne2_i, ne1_i};
    wire reads  = |ne && !noe_n_i, writes = |ne && !nwe_n_i;
    wire strobe = reads || writes;
    wire [42:0] bus = {~nbl_n_i, a, d};
    reg         past = 1'b0;
    // kind of the access: chip selects, read, write
    wire [3:0]  kind = {ne, reads, writes};
    reg  [3:0]  kind_was = 4'd0;
    // strobe_was: the strobe was low in the previous step; twice_was: in both previous steps
    reg         strobe_was = 1'b0, twice_was = 1'b0;
    reg  [2:0]  pause = 3'd4;        // steps since the last strobe rose, at most 4
    reg  [42:0] bus_was;
    reg         freed = 1'b0;        // NWAIT was inactive in the previous step of this access
    // done: the write was carried out; given: data that the read returned; is_given: the read has
    // returned its data; stuck: number of steps for which the access has waited
    reg         done = 1'b0;
    reg  [15:0] given;
    reg         is_given = 1'b0;
    reg  [5:0]  stuck = 6'd0;
    reg  [42:0] held; // value of `bus` in the last step in which the strobe was low
    reg         was_busy = 1'b0;
    reg  [42:0] write_was;

    always @* begin
        assume (!(ne1_i && ne2_i));
        assume (!(reads && writes));
        // While a strobe stays low, the kind of the access does not change.
        if (strobe && strobe_was)
            assume (kind == kind_was);
        // After a strobe, both strobes are high for four steps.
        if (strobe && !strobe_was)
            assume (pause[2]);
        // Address and data are stable, starting with the second step in which the strobe is low.
        if (strobe && twice_was)
            assume (bus == bus_was);
        // The strobe rises only after a step in which NWAIT was inactive.
        if (ABORTS == 0 && strobe_was && !freed)
            assume (strobe);
    end

    always @(posedge clk_i) begin
        past       <= 1'b1;
        rst        <= 1'b0;
        kind_was   <= kind;
        strobe_was <= strobe && !rst;
        twice_was  <= strobe && strobe_was;
        bus_was    <= bus;
        pause      <= strobe ? 3'd0 : pause[2] ? pause : pause + 3'd1;
        freed      <= strobe && nwait_n && !rst;
        stuck      <= strobe && !\u_bridge.ready && !rst ? stuck + 6'd1 : 6'd0;
        was_busy   <= \u_bridge.busy ;
        write_was  <= {\u_bridge.be , \u_bridge.addr , \u_bridge.wdata };
        if (strobe)
            held <= bus;
        done <= \u_bridge.writes_memory || \u_bridge.reg_write || (done && \u_bridge.seen );
        if (\u_bridge.answered && !\u_bridge.is_write )
            given <= \u_bridge.is_register ? \u_bridge.reg_data : \u_bridge.mem_data ;
        is_given <= \u_bridge.seen &&
            (is_given || (\u_bridge.answered && !\u_bridge.is_write ));
        if (rst)
            assume (!strobe);

        if (past && !rst) begin
            // A write is carried out at most once, with the data of the pins.
            if (\u_bridge.writes_memory || \u_bridge.reg_write ) begin
                assert (!done);
                assert ({\u_bridge.be , \u_bridge.addr , \u_bridge.wdata } == held);
                assert (\u_bridge.is_register == \u_bridge.reg_write );
            end
            if (was_busy && \u_bridge.busy )
                assert (write_was == {\u_bridge.be , \u_bridge.addr , \u_bridge.wdata });
            if (ABORTS == 0) begin
                // NWAIT is active in the first step of a strobe. Once inactive, it stays inactive
                // until the strobe rises.
                if (strobe && !strobe_was)
                    assert (!nwait_n);
                if (strobe && freed)
                    assert (nwait_n);
                // No access ends before it was answered, and the access that was carried out is the
                // access at the pins.
                assert (!(\u_bridge.seen_was && !\u_bridge.seen && !\u_bridge.ready ));
                if (strobe && nwait_n) begin
                    assert (\u_bridge.is_write == writes && \u_bridge.is_register == ne2_i);
                    assert (!writes || done);
                    assert (!reads || (is_given && d_out == given && \u_bridge.addr == a));
                end
                if (reads)
                    assert (oe);
                assert (!stuck[5]);
            end
        end
        cover (past && strobe && nwait_n && reads && ne1_i);
        cover (past && strobe && nwait_n && reads && ne2_i);
        cover (past && \u_bridge.writes_memory );
        cover (past && \u_bridge.reg_write );
    end
endmodule
`endif
