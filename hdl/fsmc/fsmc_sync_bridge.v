// SPDX-License-Identifier: MIT
//
// fsmc_sync_bridge: an alternative to fsmc_bridge with the same ports, which samples all pins with
// clk_i. No pin is a clock or an asynchronous clear, and the only paths from pin to pin are those
// from NE and NOE to NWAIT and to the output enable of the data bus.
//
// Use it on a board with timing that does not meet the constraints of fsmc_bridge. An access takes
// about twice as long, and the settings of the FSMC must satisfy these rules (docs/fsmc.md):
// - modes A, C or D, or the multiplexed mode, with NWAIT for reads and for writes
// - between accesses, NOE and NWE are both high for at least four clocks plus the delay of NWAIT
// - MUXED: NADV is low for at least two clocks, and the address is held for two more clocks
//
// An access begins when a strobe (NOE or NWE) has been sampled low for two clocks, and no earlier
// access to a register is in progress. Address, data and byte lanes are registered in this clock.
// As soon as the data of a read is available, or a write has been taken, `ready` goes high and ends
// the wait. `ready` goes low when the strobe has been sampled high. If the processor abandons a
// write before `ready` is high, the write is carried out completely or not at all.

`default_nettype none

module fsmc_sync_bridge #(
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

    // ---- Samples of the pins. A strobe counts only with a chip select.
    wire [1:0]  ne = ~fsmc_ne_n_i;
    wire [1:0]  reads, writes; // bit 0: memory (NE1), bit 1: registers (NE2)
    cdc_bit #(.WIDTH(4)) u_strobes (
        .clk_i(clk_i),
        .bit_async_i({ne & {2{!fsmc_noe_n_i}}, ne & {2{!fsmc_nwe_n_i}}}),
        .bit_sync_o({reads, writes})
    );
    wire [24:0] pins_addr;
    wire [15:0] pins_data;
    wire [1:0]  pins_be;
    cdc_copy #(.WIDTH(43)) u_pins (
        .clk_i(clk_i), .bus_async_i({~fsmc_nbl_n_i, fsmc_a_i, fsmc_d_i}),
        .bus_sync_o({pins_be, pins_addr, pins_data})
    );
    wire [24:0] address;
    generate
        if (MUXED != 0) begin : g_muxed
            // `pins_was` and nadv_n are samples of the pins from the same clock. `low` therefore
            // holds the value of the pins in the last clock with NADV low, which is the address.
            wire       nadv_n;
            reg [15:0] low, pins_was;
            cdc_bit #(.INITIAL(1'b1)) u_nadv (
                .clk_i(clk_i), .bit_async_i(fsmc_nadv_n_i), .bit_sync_o(nadv_n)
            );
            always @(posedge clk_i) begin
                pins_was <= pins_data;
                if (!nadv_n)
                    low <= pins_was;
            end
            wire unused = &{1'b0, pins_addr[15:0], 1'b0};
            assign address = {pins_addr[24:16], low};
        end else begin : g_plain
            wire unused = &{1'b0, fsmc_nadv_n_i, 1'b0};
            assign address = pins_addr;
        end
    endgenerate

    // ---- The access in progress.
    // active: the access has begun and is not answered yet.
    // ready: the access is answered, but its strobe has not been sampled high yet.
    // settled: the strobe was still low when address and data were sampled, so both are valid. The
    //   access is then carried out even if the processor abandons it. A read from memory does not
    //   wait for `settled`, because it has no side effect.
    // used: the access is a read from memory that has been answered; fsmc_memory reads ahead.
    reg         active, ready, settled, used, seen_was;
    reg         is_write, is_register;
    reg  [24:0] addr;
    reg  [15:0] wdata, rdata;
    reg  [1:0]  be;
    reg         reading; // a register is being read; high until the strobe has risen
    wire        seen   = |{reads, writes};
    wire        busy;       // a register is being written or read
    wire        begins = seen && seen_was && !active && !ready && !busy;

    wire        reg_done, same, found, room, expired;
    wire [15:0] mem_data, reg_data;
    wire        hit       = same && found;
    wire        mem_read  = active && !is_write && !is_register;
    wire        mem_write = active && settled && seen && is_write && !is_register;
    wire        reg_write = active && settled && seen && is_write && is_register;
    wire        reg_read  = active && settled && seen && !is_write && is_register;
    wire        waiting   = (mem_read && !hit) || (mem_write && !room);
    wire        excuse    = waiting && expired;
    wire        writes_memory = mem_write && (room || excuse);
    wire        answered  = (mem_read && (hit || excuse)) || writes_memory || reg_write ||
        (active && reading && reg_done);

    always @(posedge clk_i) begin
        seen_was <= seen;
        active   <= seen && (begins || (active && !answered));
        settled  <= seen && active;
        ready    <= seen && (ready || answered);
        used     <= seen && (used || (mem_read && hit));
        reading  <= seen && (reading || reg_read);
        if (begins) begin
            is_write    <= |writes;
            is_register <= reads[1] || writes[1];
            addr        <= address;
            wdata       <= pins_data;
            be          <= pins_be;
        end
        if (active)
            rdata <= is_register ? reg_data : mem_data;
        if (rst_i)
            {active, ready, settled, used, reading, seen_was} <= 6'd0;
    end

    // The processor samples NWAIT asynchronously. While NE is stable, NWAIT depends on one
    // flip-flop. No access waits while reset is active.
    wire waits = |ne && !ready && !rst_i;
    assign fsmc_nwait_n_o = (WAIT_HIGH != 0) ^ !waits;
    assign fsmc_d_o       = rdata;
    assign fsmc_d_oe_o    = |ne && !fsmc_noe_n_i;

    // ---- Time-out, as in fsmc_bridge
    wire reg_restart;
    fsmc_timeout #(.TIMEOUT_LOG2(TIMEOUT_LOG2)) u_fsmc_timeout (
        .clk_i(clk_i), .rst_i(rst_i), .restart_i(reg_restart && !waiting), .expired_o(expired)
    );

    // ---- Registers
    wire reg_error, reg_error_memory, error_of_write, reg_flush, mem_idle;
    fsmc_registers u_fsmc_registers (
        .clk_i(clk_i), .rst_i(rst_i),
        .wr_i(reg_write), .wr_addr_i(addr), .wr_data_i(wdata),
        .reading_i(reading), .rd_addr_i(addr), .rd_high_async_i(addr[0]),
        // In this bridge, the next two inputs are not pins but levels in the clock domain clk_i.
        // They rise when `reading` falls, which ends the read.
        .ne_n_async_i(!reading), .noe_n_async_i(!reading),
        .rd_done_o(reg_done), .rd_data_o(reg_data),
        .restart_o(reg_restart), .expired_i(expired),
        .busy_o(busy), .flush_o(reg_flush), .idle_i(mem_idle),
        .error_o(reg_error), .error_memory_o(reg_error_memory), .error_write_o(error_of_write),
        .bus_valid_o(bus_valid_o), .bus_write_o(bus_write_o), .bus_addr_o(bus_addr_o),
        .bus_wdata_o(bus_wdata_o), .bus_ready_i(bus_ready_i), .bus_rdata_i(bus_rdata_i),
        .bus_error_i(bus_error_i)
    );

    // ---- Memory
    wire wr_lost, more_room, safe;
    fsmc_memory #(.POST_LOG2(POST_LOG2), .BLOCK_LOG2(BLOCK_LOG2)) u_fsmc_memory (
        .clk_i(clk_i), .rst_i(rst_i), .page_i(page_i),
        .wr_i(writes_memory), .wr_addr_i(addr), .wr_data_i(wdata), .wr_be_i(be),
        .wr_lost_o(wr_lost), .room_o(room), .more_room_o(more_room),
        .rd_addr_async_i(addr), .rd_at_i(addr), .rd_used_i(used),
        .rd_miss_i(mem_read && !hit),
        .rd_same_o(same), .rd_found_o(found), .rd_safe_o(safe), .rd_data_o(mem_data),
        .flush_i(reg_flush), .drop_i(reg_write || reading), .idle_o(mem_idle),
        .npi_addr_o(npi_addr_o), .npi_addr_req_o(npi_addr_req_o), .npi_addr_ack_i(npi_addr_ack_i),
        .npi_rnw_o(npi_rnw_o), .npi_size_o(npi_size_o), .npi_wr_data_o(npi_wr_data_o),
        .npi_wr_be_o(npi_wr_be_o), .npi_wr_push_o(npi_wr_push_o), .npi_rd_data_i(npi_rd_data_i),
        .npi_rd_pop_o(npi_rd_pop_o), .npi_rd_empty_i(npi_rd_empty_i),
        .npi_init_done_i(npi_init_done_i)
    );
    assign npi_rmw_o      = 1'b0;
    assign npi_wr_flush_o = 1'b0;
    assign npi_rd_flush_o = 1'b0;

    // ---- Errors. late_o: an access ended before it was answered, or a write found no room.
    assign access_error_o = reg_error || reg_error_memory || excuse;
    assign error_memory_o = !reg_error;
    assign error_addr_o   = bus_addr_o;
    assign error_write_o  = reg_error ? error_of_write : is_write;
    assign late_o         = wr_lost || (seen_was && !seen && !ready);

    wire unused = &{1'b0, more_room, safe, npi_wr_empty_i, npi_wr_almost_full_i, npi_rd_word_i,
                    1'b0};
endmodule
