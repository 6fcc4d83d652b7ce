// SPDX-License-Identifier: MIT
//
// fsmc_registers: 32-bit words of the register bus in two halves of 16 bits, low half first, each word in one piece.
//
// Reading the low half reads the word and keeps its high half; writing the low half keeps it, writing
// the high half writes the word. A high half alone is read afresh; written alone it is an error.
// Writes are posted: busy_o is high from the cycle after wr_i until the word has been written, and
// every other access waits for that. Before a transfer all memory writes are flushed.
// Time that has expired ends the wait for a slave with an error; a memory that does not take the writes
// in time is reported, and the transfer goes on.

`default_nettype none

module fsmc_registers (
    input  wire        clk_i,
    input  wire        rst_i,
    // writes: one cycle; address and data stay until the next
    input  wire        wr_i,
    input  wire [24:0] wr_addr_i, // halfword
    input  wire [15:0] wr_data_i,
    // reads: until the pin ends the access
    input  wire        reading_i,
    input  wire [24:0] rd_addr_i,
    input  wire        ended_i,   // pins, asynchronous
    output wire        rd_done_o, // rd_data_o is this access's; falls with ended_i
    output wire [15:0] rd_data_o,
    // time: counted while busy, from zero with each cycle of restart_o
    output wire        restart_o,
    input  wire        expired_i,
    // order with memory
    output wire        busy_o,
    output wire        flush_o,
    input  wire        idle_i,
    // errors, one cycle
    output reg         error_o,
    output reg         error_memory_o,
    output wire        error_write_o,
    // register bus
    output reg         bus_valid_o,
    output reg         bus_write_o,
    output reg  [9:0]  bus_addr_o,
    output wire [31:0] bus_wdata_o,
    input  wire        bus_ready_i,
    input  wire [31:0] bus_rdata_i,
    input  wire        bus_error_i
);
    localparam [1:0] IDLE    = 2'd0,
                     FLUSH   = 2'd1, // memory takes what was posted
                     BUS     = 2'd2, // the slave answers
                     ANSWER  = 2'd3; // the processor ends its read

    reg [1:0]  state;
    reg [31:0] word;       // last read; its low half also what was written
    reg        half_read, half_write; // which half of bus_addr_o's word is kept in it
    reg        given_up;   // the read has ended early: nobody takes its answer
    reg        give, done, seen;
    reg [1:0]  done_s;

    wire [24:0] addr   = wr_i ? wr_addr_i : rd_addr_i;
    wire in_range      = addr[24:11] == 14'd0;
    wire same          = addr[10:1] == bus_addr_o;

    assign rd_done_o     = done;
    assign rd_data_o     = rd_addr_i[0] ? word[31:16] : word[15:0];
    assign busy_o        = state != IDLE;
    wire   bus_next      = idle_i || expired_i;
    assign restart_o     = state == IDLE || (flush_o && bus_next);
    assign flush_o       = state == FLUSH;
    assign bus_wdata_o   = {wr_data_i, word[15:0]};
    assign error_write_o = bus_write_o;

    // Set by the clock, cleared by the pins: the next read may begin a few nanoseconds later.
    always @(posedge clk_i or posedge ended_i)
        if (ended_i)
            done <= 1'b0;
        else if (give && !given_up)
            done <= 1'b1;

    always @(posedge clk_i) begin
        done_s   <= {done_s[0], done};
        error_o  <= 1'b0;
        error_memory_o <= 1'b0;
        give     <= 1'b0;
        if (wr_i && state != IDLE)
            error_o <= 1'b1; // written without looking at NWAIT: lost
        if (!reading_i)
            given_up <= 1'b1;

        case (state)
            IDLE: begin
                seen <= 1'b0;
                if (wr_i || reading_i) begin
                    given_up    <= wr_i;
                    bus_addr_o  <= addr[10:1];
                    bus_write_o <= wr_i;
                    half_read   <= 1'b0;
                    half_write  <= 1'b0;
                    if (wr_i && !addr[0]) begin
                        word[15:0] <= wr_data_i;
                        half_write <= 1'b1;
                    end else if (!wr_i && addr[0] && half_read && same) begin
                        give  <= 1'b1;
                        state <= ANSWER;
                    end else if (!in_range || (wr_i && !(half_write && same))) begin
                        error_o <= 1'b1;
                        if (!wr_i) begin
                            word  <= 32'd0;
                            give  <= 1'b1;
                            state <= ANSWER;
                        end
                    end else begin
                        state <= FLUSH;
                    end
                end
            end
            FLUSH: begin
                error_memory_o <= expired_i && !idle_i;
                if (bus_next) begin
                    bus_valid_o <= 1'b1;
                    state       <= BUS;
                end
            end
            BUS: begin
                if (bus_ready_i || expired_i) begin
                    bus_valid_o <= 1'b0;
                    error_o     <= bus_error_i || !bus_ready_i;
                    if (!bus_write_o)
                        word <= bus_rdata_i;
                    give        <= !bus_write_o;
                    half_read   <= !bus_write_o && !rd_addr_i[0] && !given_up;
                    state       <= bus_write_o ? IDLE : ANSWER;
                end
            end
            default: begin
                seen <= seen || done_s[1];
                if (given_up || (seen && !done_s[1]))
                    state <= IDLE;
            end
        endcase

        if (rst_i) begin
            state <= IDLE;
            give        <= 1'b0;
            done_s      <= 2'b00;
            half_read   <= 1'b0;
            half_write  <= 1'b0;
            bus_valid_o <= 1'b0;
            bus_write_o <= 1'b0;
            error_o     <= 1'b0;
            error_memory_o <= 1'b0;
        end
    end
endmodule
