// SPDX-License-Identifier: MIT
//
// fsmc_bridge: connects the 16-bit FSMC bus of an STM32 to DDR3 (NE1) and to the register bus
// (NE2). The bus cycles are described in docs/fsmc.md.
//
// The bridge supports asynchronous accesses in modes 1, A, 2, B, C and D. NWAIT depends on the pins
// combinationally. NWAIT is low while the data of a read is not available, or while a write finds
// no room. Every access waits until the previous write has been transferred to clk_i, and until a
// previous register write has taken effect. If an access has waited for 2**TIMEOUT_LOG2 clocks, the
// bridge ends the wait and raises access_error_o, so that NWAIT is never low for ever.

`default_nettype none

module fsmc_bridge #(
    parameter MUXED        = 0, // 1: the data pins carry address bits 15..0 while NADV is low
    parameter WAIT_HIGH    = 0, // 1: NWAIT is active high (WAITPOL = 1)
    parameter TIMEOUT_LOG2 = 12,
    parameter POST_LOG2    = 4, // POST_LOG2 and BLOCK_LOG2: see fsmc_memory
    parameter BLOCK_LOG2   = 3
) (
    `include "memory_ports.vh"
    input  wire        clk_i,
    input  wire        rst_i,
    // FSMC pins
    input  wire [24:0] fsmc_a_i,     // halfword address, which is bits 25..1 of the byte address
    input  wire [15:0] fsmc_d_i,
    output wire [15:0] fsmc_d_o,
    output wire        fsmc_d_oe_o,
    input  wire [1:0]  fsmc_ne_n_i,  // bit 0 is NE1, bit 1 is NE2
    input  wire        fsmc_noe_n_i,
    input  wire        fsmc_nwe_n_i,
    input  wire [1:0]  fsmc_nbl_n_i,
    input  wire        fsmc_nadv_n_i,
    output wire        fsmc_nwait_n_o,
    // system slot
    input  wire [5:0]  page_i,
    output wire        access_error_o, // high for one cycle: an access ended with an error
    // 1: the error occurred in an access to memory; 0: in an access to a register
    output wire        error_memory_o,
    // word address of the register, if the access was to a register
    output wire [9:0]  error_addr_o,
    output wire        error_write_o,
    // high for one cycle: the processor ended an access while NWAIT was active
    output wire        late_o,
    // register bus
    output wire        bus_valid_o,
    output wire        bus_write_o,
    output wire [9:0]  bus_addr_o,
    output wire [31:0] bus_wdata_o,
    input  wire        bus_ready_i,
    input  wire [31:0] bus_rdata_i,
    input  wire        bus_error_i
);
    fsmc_parameter_rules #(
        .MUXED(MUXED), .WAIT_HIGH(WAIT_HIGH), .TIMEOUT_LOG2(TIMEOUT_LOG2), .POST_LOG2(POST_LOG2),
        .BLOCK_LOG2(BLOCK_LOG2)
    ) u_fsmc_parameter_rules ();

    // ---- Pins
    wire ne1 = !fsmc_ne_n_i[0], ne2 = !fsmc_ne_n_i[1];
    wire [24:0] address;
    generate
        if (MUXED != 0) begin : g_muxed
            reg [15:0] low;
            always @(posedge fsmc_nadv_n_i)
                if (!(&fsmc_ne_n_i))
                    low <= fsmc_d_i;
            wire unused = &{1'b0, fsmc_a_i[15:0], 1'b0};
            assign address = {fsmc_a_i[24:16], low};
        end else begin : g_plain
            wire unused = &{1'b0, fsmc_nadv_n_i, 1'b0};
            assign address = fsmc_a_i;
        end
    endgenerate

    wire        wr_async, wr_sync, taken, writing;
    wire [1:0]  taken_ne, taken_be, seen;
    wire [24:0] taken_addr, at;
    wire [15:0] taken_data;
    wire        hit_safe, room, more_room, busy, reg_done, hit_seen, safe_seen, excuse;
    wire [15:0] mem_data, reg_data;
    wire        mem_reading = seen[0];
    // high after the time-out has ended the wait of the current access
    reg         excused_read, excused_write;

    wire        same, found, counts, holds1, holds2; // inputs of the gate that drives NWAIT
    wire        hit = same && found;

    // `clear` and `clear_sync` are high when the previous write has been transferred and no
    // register access is in progress. `clear` is used for NWAIT, `clear_sync` for decisions in
    // clk_i.
    wire clear      = !wr_async && !busy;
    wire clear_sync = !wr_sync && !busy;

    // A write happens when NWE rises while NE is low, as in an SRAM. This edge registers address,
    // data and byte lanes, which the STM32 holds for one more HCLK. If the processor aborts an
    // access, NE rises before NWE, and nothing is written. NWE has no minimum high time. `taken` is
    // high for one cycle, two to three clocks after the edge. The next edge may arrive as soon as
    // cdc_bus has copied the write, which takes two clocks (20 ns) plus the skew of the paths. The
    // FSMC needs at least 33.3 ns from edge to edge, so 13 ns are left for this skew.
    wire [1:0]  ne = ~fsmc_ne_n_i;
    // write that the last edge of NWE has registered; wr_async is high from this edge until a clock
    // after `taken`
    wire [44:0] held;
    cdc_bus #(.WIDTH(45)) u_write (
        .src_clk_i(fsmc_nwe_n_i), .src_valid_i(|ne),
        .src_data_i({ne, ~fsmc_nbl_n_i, address, fsmc_d_i}),
        .src_data_o(held), .pending_sync_o(wr_sync), .pending_async_o(wr_async),
        .dst_clk_i(clk_i), .dst_valid_o(taken),
        .dst_data_o({taken_ne, taken_be, taken_addr, taken_data})
    );
    wire wr_ne2_async = wr_async && held[44];

    // A register read enters the synchroniser only after the previous write has been transferred;
    // otherwise the read could overtake the write if a synchroniser is late. A memory read does not
    // wait, because a write discards the read buffer.
    wire [1:0] reads = ne & {!fsmc_noe_n_i && !wr_async, !fsmc_noe_n_i};
    cdc_bit #(.WIDTH(5), .TOGETHER(3)) u_access (
        .clk_i(clk_i),
        .bit_async_i({reads, ne[0] && !fsmc_nwe_n_i, hit && clear, hit_safe && clear}),
        .bit_sync_o({seen, writing, hit_seen, safe_seen})
    );
    // copy of the address; valid one clock after `seen` rises
    cdc_copy #(.WIDTH(25)) u_at (.clk_i(clk_i), .bus_async_i(address), .bus_sync_o(at));

    always @(posedge clk_i or posedge fsmc_noe_n_i)
        if (fsmc_noe_n_i)
            excused_read <= 1'b0;
        else if (excuse)
            excused_read <= 1'b1;
    always @(posedge clk_i or posedge fsmc_nwe_n_i)
        if (fsmc_nwe_n_i)
            excused_write <= 1'b0;
        else if (excuse)
            excused_write <= 1'b1;

    // ---- Time-out of accesses to memory. After the time-out, excused_read or excused_write goes
    // high and ends the wait of the access. It stays high until the strobe of the access rises.
    // fsmc_registers handles the time-out of accesses to registers.
    wire reg_restart, expired;
    wire waiting = (mem_reading && !hit_seen) || (writing && !room);
    assign excuse = expired && clear_sync && waiting && !excused_read && !excused_write;

    fsmc_timeout #(.TIMEOUT_LOG2(TIMEOUT_LOG2)) u_fsmc_timeout (
        .clk_i(clk_i), .rst_i(rst_i), .restart_i(reg_restart && (busy || !waiting)),
        .expired_o(expired)
    );

    // ---- NWAIT depends on NE and NOE. Until NOE falls, an access counts as a write, so that NWAIT
    // is valid one address phase before the data phase of a write begins. No access waits while
    // reset is active, even without a clock.
    //
    // The processor samples NWAIT asynchronously, so NWAIT must not glitch while the pins are
    // stable. While they are stable, NWAIT depends on flip-flops, on `hit` and on `wr_async`. The
    // last two are functions of flip-flops, and do not glitch (fsmc_memory, cdc_pending). If
    // several of these signals change at one clock edge, they change in the same direction, or have
    // no effect on the access (fsmc_bridge_proof). The last gate is one LUT.
    // tests/hdl/fsmc/nwait_test.py simulates the netlist with random delays.
    //
    // `room` does not take a write into account while the write is still in transfer. The next
    // write then needs room for both writes; roomy_for_both was counted before the first of them
    // was posted. `roomy` is 0 in the clock after a write, because `room` is not up to date in that
    // clock. `roomy` therefore does not fall in the clock in which the transfer ends.
    reg       roomy;
    reg [1:0] roomy_for_both;
    always @(posedge clk_i) begin
        roomy          <= room && !taken;
        roomy_for_both <= {roomy_for_both[0], more_room};
    end
    wire write_room = (roomy && !wr_async) || roomy_for_both[1];
    wire write_ok1  = !busy && !wr_ne2_async && (write_room || excused_write);
    assign holds1 = !rst_i && !(fsmc_noe_n_i ? write_ok1 : excused_read && clear);
    assign holds2 = ne2 && !rst_i && !(fsmc_noe_n_i ? clear : reg_done);
    assign counts = !fsmc_noe_n_i && clear; // a hit in the read buffer ends the wait
    fsmc_nwait #(.WAIT_HIGH(WAIT_HIGH)) u_fsmc_nwait (
        .ne1_i(ne1), .holds1_i(holds1), .counts_i(counts), .same_i(same), .found_i(found),
        .holds2_i(holds2), .nwait_n_o(fsmc_nwait_n_o)
    );
    assign fsmc_d_o       = ne2 ? reg_data : mem_data;
    assign fsmc_d_oe_o    = (ne1 || ne2) && !fsmc_noe_n_i;

    // ---- Registers
    wire reg_error, reg_error_memory, reg_write, reg_flush, mem_idle;
    wire reg_access = (taken && taken_ne[1]) || seen[1];
    fsmc_registers u_fsmc_registers (
        .clk_i(clk_i), .rst_i(rst_i),
        .wr_i(taken && taken_ne[1]), .wr_addr_i(taken_addr), .wr_data_i(taken_data),
        .reading_i(seen[1]), .rd_addr_i(at), .rd_high_async_i(address[0]),
        .ne_n_async_i(fsmc_ne_n_i[1]), .noe_n_async_i(fsmc_noe_n_i),
        .rd_done_o(reg_done), .rd_data_o(reg_data),
        .restart_o(reg_restart), .expired_i(expired),
        .busy_o(busy), .flush_o(reg_flush), .idle_i(mem_idle),
        .error_o(reg_error), .error_memory_o(reg_error_memory), .error_write_o(reg_write),
        .bus_valid_o(bus_valid_o), .bus_write_o(bus_write_o), .bus_addr_o(bus_addr_o),
        .bus_wdata_o(bus_wdata_o), .bus_ready_i(bus_ready_i), .bus_rdata_i(bus_rdata_i),
        .bus_error_i(bus_error_i)
    );

    // ---- Memory
    wire wr_lost;
    fsmc_memory #(.POST_LOG2(POST_LOG2), .BLOCK_LOG2(BLOCK_LOG2)) u_fsmc_memory (
        .clk_i(clk_i), .rst_i(rst_i), .page_i(page_i),
        .wr_i(taken && taken_ne[0]), .wr_addr_i(taken_addr), .wr_data_i(taken_data),
        .wr_be_i(taken_be),
        .wr_lost_o(wr_lost), .room_o(room), .more_room_o(more_room),
        .rd_addr_async_i(address), .rd_at_i(at), .rd_used_i(mem_reading && hit_seen),
        // A register access may still wait for its answer here. No fetch begins during this time.
        .rd_miss_i(mem_reading && !hit_seen && !wr_sync && !reg_flush && !bus_valid_o),
        .rd_same_o(same), .rd_found_o(found), .rd_safe_o(hit_safe), .rd_data_o(mem_data),
        .flush_i(reg_flush), .drop_i(reg_access), .idle_o(mem_idle),
        .npi_addr_o(npi_addr_o), .npi_addr_req_o(npi_addr_req_o), .npi_addr_ack_i(npi_addr_ack_i),
        .npi_rnw_o(npi_rnw_o), .npi_size_o(npi_size_o), .npi_wr_data_o(npi_wr_data_o),
        .npi_wr_be_o(npi_wr_be_o), .npi_wr_push_o(npi_wr_push_o), .npi_rd_data_i(npi_rd_data_i),
        .npi_rd_pop_o(npi_rd_pop_o), .npi_rd_empty_i(npi_rd_empty_i),
        .npi_init_done_i(npi_init_done_i)
    );

    assign npi_rmw_o      = 1'b0;
    assign npi_wr_flush_o = 1'b0;
    assign npi_rd_flush_o = 1'b0;

    // ---- Errors
    reg reading_d, excuse_was; // `excuse` one clock later; registered, because it arrives late
    always @(posedge clk_i) excuse_was <= excuse;
    assign access_error_o = reg_error || reg_error_memory || excuse_was;
    assign error_memory_o = !reg_error;
    assign error_addr_o   = bus_addr_o;
    assign error_write_o  = reg_error ? reg_write : !reading_d;

    // ---- late_o detects a processor that ignores NWAIT. It reports a write without room, and a
    // read that ended too early. A read ended in time if its data was safe (rd_safe_o) in the
    // second clock of its address, or was valid in two successive clocks after that. The first
    // clock of an address does not count, because the pins may have changed during this clock.
    // Reads of different addresses may follow each other without a pause that the clock can detect.
    reg [1:0] at_was, at_before, good;
    reg       second, early;
    wire moved  = at_was != at_before;
    wire starts = mem_reading && (moved || !reading_d);
    assign late_o = wr_lost || (reading_d && (starts || !mem_reading) && early);
    always @(posedge clk_i) begin
        {at_before, at_was} <= {at_was, at[1:0]};
        reading_d <= mem_reading && !rst_i;
        second    <= starts;
        good      <= {hit_seen && good[0] && reading_d, hit_seen};
        early     <= !starts && (second ? !safe_seen : early && !good[1]);
    end

    wire unused = &{1'b0, held[43:0], npi_wr_empty_i, npi_wr_almost_full_i, npi_rd_word_i, 1'b0};
`ifdef COVER_POINTS
    wire waits = fsmc_nwait_n_o == (WAIT_HIGH != 0);
    read_excused: cover property (@(posedge clk_i) excuse && mem_reading);
    write_excused: cover property (@(posedge clk_i) excuse && !mem_reading);
    does_not_look_at_nwait: cover property (@(posedge clk_i) late_o);
    memory_read_waits: cover property (@(posedge clk_i) ne1 && !fsmc_noe_n_i && waits);
    memory_write_waits: cover property (@(posedge clk_i) ne1 && !fsmc_nwe_n_i && waits);
    register_waits: cover property (@(posedge clk_i) ne2 && waits);
    memory_write: cover property (@(posedge clk_i) taken && taken_ne[0]);
    register_write: cover property (@(posedge clk_i) taken && taken_ne[1]);
    next_access_while_write_is_handed_on: cover property (@(posedge clk_i) wr_async && |ne &&
            !fsmc_noe_n_i);
    half_a_halfword: cover property (@(posedge clk_i) taken && taken_be != 2'b11);
`endif
endmodule
