// SPDX-License-Identifier: MIT
//
// modem_npi: shares one memory port between the receiver and the transmitter of the modem, with one
// memory access for each byte.
//
// Accesses of single bytes need no word buffers, and are cheap: both directions together need at
// most 22,000 accesses per second, which is below one percent of the memory bandwidth. Writes have
// priority, because the serial line does not wait. A write or read that has been accepted is
// completed even if its packet is dropped.

`default_nettype none

module modem_npi (
    input  wire        clk_i,
    input  wire        rst_i,
    // base address of a ring: the receive ring while wr_valid_i is high, otherwise the transmit
    // ring
    input  wire [31:11] base_i,
    input  wire        base_valid_i,
    // writes a byte; the address is {buffer, word in the buffer, byte in the word}
    input  wire        wr_valid_i,
    input  wire [10:3] wr_addr_i,
    input  wire [7:0]  wr_be_i,
    input  wire [7:0]  wr_data_i,
    output wire        wr_ready_o,   // accepted
    output wire        wr_busy_o,    // the memory has not yet acknowledged an accepted write
    // reads a byte; a read never completes if rd_valid_i was low for a cycle
    input  wire        rd_valid_i,
    input  wire [10:0] rd_addr_i,
    output wire        rd_done_o,    // high for one cycle: the data is valid
    output reg  [7:0]  rd_data_o,
    // memory port
    output wire [31:0] npi_addr_o,
    output wire        npi_addr_req_o,
    input  wire        npi_addr_ack_i,
    output wire        npi_rnw_o,
    output wire [63:0] npi_wr_data_o,
    output wire [7:0]  npi_wr_be_o,
    output wire        npi_wr_push_o,
    output wire        npi_rd_pop_o,
    input  wire [63:0] npi_rd_data_i,
    input  wire        npi_rd_empty_i,
    input  wire        npi_init_done_i
);
    localparam [1:0] IDLE = 2'd0, WRITE = 2'd1, READ = 2'd2, WAIT_WORD = 2'd3;

    (* fsm_encoding = "none" *) // one-hot states would take more flip-flops and LUTs
    reg [1:0]  state;
    reg [31:3] addr;
    reg        wanted; // rd_valid_i has been high since the read began

    wire start = state == IDLE && base_valid_i && npi_init_done_i;

    assign wr_ready_o     = start && wr_valid_i;
    assign wr_busy_o      = state == WRITE;
    assign rd_done_o      = npi_rd_pop_o && wanted && rd_valid_i;
    assign npi_addr_o     = {addr, 3'd0};
    assign npi_addr_req_o = state == WRITE || state == READ;
    assign npi_rnw_o      = state != WRITE;
    assign npi_wr_data_o  = {8{wr_data_i}};
    assign npi_wr_be_o    = wr_be_i;
    assign npi_wr_push_o  = wr_ready_o;
    assign npi_rd_pop_o   = state == WAIT_WORD && !npi_rd_empty_i;

    always @* begin
        case (rd_addr_i[2:0])
            3'd0:    rd_data_o = npi_rd_data_i[7:0];
            3'd1:    rd_data_o = npi_rd_data_i[15:8];
            3'd2:    rd_data_o = npi_rd_data_i[23:16];
            3'd3:    rd_data_o = npi_rd_data_i[31:24];
            3'd4:    rd_data_o = npi_rd_data_i[39:32];
            3'd5:    rd_data_o = npi_rd_data_i[47:40];
            3'd6:    rd_data_o = npi_rd_data_i[55:48];
            default: rd_data_o = npi_rd_data_i[63:56];
        endcase
    end

    always @(posedge clk_i) begin
        wanted <= rd_valid_i && (wanted || state == IDLE);
        case (state)
            IDLE: begin
                // the select input is wr_valid_i instead of `start && wr_valid_i`, because `start`
                // arrives later
                addr <= {base_i, wr_valid_i ? wr_addr_i[10:3] : rd_addr_i[10:3]};
                if (start && wr_valid_i)
                    state <= WRITE;
                else if (start && rd_valid_i)
                    state <= READ;
            end
            WRITE: if (npi_addr_ack_i)
                state <= IDLE;
            READ: if (npi_addr_ack_i)
                state <= WAIT_WORD;
            default: if (!npi_rd_empty_i)
                state <= IDLE;
        endcase
        if (rst_i)
            state <= IDLE;
    end

`ifdef FORMAL
    // Proves that pushed words and requests follow the rules of a memory port.
    reg past = 1'b0;
    initial assume (rst_i);
    reg [4:0] words = 5'd0; // words pushed and not yet acknowledged
    reg       owed  = 1'b0; // a word was requested and has not yet arrived
    always @(posedge clk_i) begin
        past <= 1'b1;
        // The memory acknowledges only requests, and returns a word only for an acknowledged read.
        assume (!npi_addr_ack_i || npi_addr_req_o);
        assume (npi_rd_empty_i || owed);
        if (npi_addr_req_o && npi_addr_ack_i && npi_rnw_o)
            owed <= 1'b1;
        else if (npi_rd_pop_o)
            owed <= 1'b0;
        words <= words + npi_wr_push_o - (npi_addr_req_o && npi_addr_ack_i && !npi_rnw_o);
        if (rst_i) begin
            words <= 5'd0;
            owed  <= 1'b0;
        end
        if (past && !rst_i && !$past(rst_i)) begin
            // A request and its address are stable until the request is acknowledged.
            if ($past(npi_addr_req_o) && !$past(npi_addr_ack_i))
                assert (npi_addr_req_o && $stable(npi_addr_o) && $stable(npi_rnw_o));
            // Before each write, exactly one word of data is pushed.
            assert (words == (state == WRITE));
            assert (owed == (state == WAIT_WORD));
            assert (!(npi_rd_pop_o && npi_rd_empty_i));
            // A read that was withdrawn is never completed, and a write that was accepted is
            // requested.
            if (rd_done_o)
                assert ($past(rd_valid_i) && rd_valid_i && $past(wanted));
            if ($past(wr_ready_o))
                assert (wr_busy_o);
            // Each request is for the right word of the ring, and enables only the addressed byte.
            if (npi_addr_req_o && !$past(npi_addr_req_o))
                assert (npi_addr_o ==
                        {$past(base_i), $past(wr_ready_o ? wr_addr_i : rd_addr_i[10:3]), 3'd0});
            assert (npi_wr_push_o == wr_ready_o && npi_wr_be_o == wr_be_i &&
                    npi_wr_data_o == {8{wr_data_i}});
            assert ({56'd0, rd_data_o} == (npi_rd_data_i >> {rd_addr_i[2:0], 3'd0} & 64'hFF));
        end
        cover (past && !rst_i && wr_busy_o && npi_addr_ack_i);
        cover (past && !rst_i && rd_done_o);
        cover (past && start && wr_valid_i && rd_valid_i); // reaches a write that is served before
                                                           // a read
        cover (past && !rst_i && npi_rd_pop_o && !rd_done_o);
    end
`endif
endmodule
