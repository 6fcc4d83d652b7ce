// SPDX-License-Identifier: MIT
//
// npi_arbiter: PORTS memory ports with NPI semantics (docs/memory.md) on one command stream.
//
// Round robin. A write's words go to the back-end before its command; a read's command goes at once,
// and its words come back in the order of the commands. addr_ack is the order between ports.

`default_nettype none

module npi_arbiter #(
    parameter PORTS = 3 // 2..8
) (
    input  wire                clk_i,
    input  wire                rst_i,
    // ports, packed: port p in bits p, 64p+63..64p, ...
    input  wire [32*PORTS-1:0] npi_addr_i,
    input  wire [PORTS-1:0]    npi_addr_req_i,
    output reg  [PORTS-1:0]    npi_addr_ack_o,
    input  wire [PORTS-1:0]    npi_rnw_i,
    input  wire [4*PORTS-1:0]  npi_size_i,
    input  wire [64*PORTS-1:0] npi_wr_data_i,
    input  wire [8*PORTS-1:0]  npi_wr_be_i,
    input  wire [PORTS-1:0]    npi_wr_push_i,
    output wire [PORTS-1:0]    npi_wr_empty_o,
    output wire [PORTS-1:0]    npi_wr_almost_full_o,
    input  wire [PORTS-1:0]    npi_wr_flush_i,
    output wire [64*PORTS-1:0] npi_rd_data_o,
    output wire [4*PORTS-1:0]  npi_rd_word_o,
    input  wire [PORTS-1:0]    npi_rd_pop_i,
    output wire [PORTS-1:0]    npi_rd_empty_o,
    input  wire [PORTS-1:0]    npi_rd_flush_i,
    // back-end: a command of 1..16 words; write words come first
    output wire                cmd_valid_o,
    output wire                cmd_read_o,
    output wire [31:0]         cmd_addr_o,
    output wire [4:0]          cmd_words_o,
    input  wire                cmd_ready_i,
    output wire                wr_valid_o,
    output wire [63:0]         wr_data_o,
    output wire [7:0]          wr_be_o,
    input  wire                wr_ready_i,
    input  wire                rd_valid_i,
    input  wire [63:0]         rd_data_i,
    output wire                rd_ready_o
);
    localparam PORT_BITS = PORTS > 4 ? 3 : PORTS > 2 ? 2 : 1;

    localparam [1:0] WAIT_REQUEST = 2'd0, MOVE_WORDS = 2'd1, WAIT_COMMAND = 2'd2;

    reg [1:0]           state;
    reg [PORT_BITS-1:0] port;     // being served, and the last one served
    reg                 read;
    reg [31:0]          addr;
    reg [4:0]           words, left;

    // Who is next: the first requester after the one served last. The bit of an acknowledged request
    // is still up in the cycle of its acknowledgement.
    wire [PORTS-1:0] asking = npi_addr_req_i & ~npi_addr_ack_o;
    reg [PORT_BITS-1:0] next;
    integer i;
    always @* begin
        next = port;
        for (i = PORTS - 1; i >= 0; i = i - 1)
            if (asking[i])
                next = i[PORT_BITS-1:0];
        for (i = PORTS - 1; i >= 0; i = i - 1)
            if (asking[i] && i[PORT_BITS-1:0] > port)
                next = i[PORT_BITS-1:0];
    end

    // FIFOs of the ports.
    wire [71:0] wr_word [0:PORTS-1];
    wire [PORTS-1:0] wr_pop, rd_push, rd_almost_full;
    reg  [3:0] rd_index;
    genvar p;
    generate
        for (p = 0; p < PORTS; p = p + 1) begin : g_port
            localparam [PORT_BITS-1:0] ME = p;
            npi_fifo #(.WIDTH(72), .LOG2(5)) u_write (
                .clk_i(clk_i), .rst_i(rst_i || npi_wr_flush_i[p]),
                .push_i(npi_wr_push_i[p]),
                .data_i({npi_wr_be_i[8*p +: 8], npi_wr_data_i[64*p +: 64]}),
                .pop_i(wr_pop[p]), .data_o(wr_word[p]), .empty_o(npi_wr_empty_o[p]),
                .almost_full_o(npi_wr_almost_full_o[p])
            );
            npi_fifo #(.WIDTH(68), .LOG2(5)) u_read (
                .clk_i(clk_i), .rst_i(rst_i || npi_rd_flush_i[p]),
                .push_i(rd_push[p]), .data_i({rd_index, rd_data_i}),
                .pop_i(npi_rd_pop_i[p]),
                .data_o({npi_rd_word_o[4*p +: 4], npi_rd_data_o[64*p +: 64]}),
                .empty_o(npi_rd_empty_o[p]), .almost_full_o(rd_almost_full[p])
            );
            assign wr_pop[p]  = wr_valid_o && wr_ready_i && port == ME;
            assign rd_push[p] = rd_valid_i && rd_ready_o && back_port == ME;
        end
    endgenerate

    // Reads under way, in order: whose they are and how many words each.
    wire [PORT_BITS-1:0] back_port;
    wire [4:0] back_words;
    wire back_empty, back_almost_full;
    wire back_last = {1'b0, rd_index} + 5'd1 == back_words;
    npi_fifo #(.WIDTH(PORT_BITS + 5), .LOG2(4)) u_order (
        .clk_i(clk_i), .rst_i(rst_i),
        .push_i(cmd_valid_o && cmd_ready_i && read), .data_i({port, words}),
        .pop_i(rd_valid_i && rd_ready_o && back_last), .data_o({back_port, back_words}),
        .empty_o(back_empty), .almost_full_o(back_almost_full)
    );

    assign wr_valid_o  = state == MOVE_WORDS && !npi_wr_empty_o[port];
    assign {wr_be_o, wr_data_o} = wr_word[port];
    assign cmd_valid_o = state == WAIT_COMMAND && !(read && back_almost_full);
    assign cmd_read_o  = read;
    assign cmd_addr_o  = addr;
    assign cmd_words_o = words;
    assign rd_ready_o  = !back_empty;

    wire [2:0] next_size = npi_size_i[4*next +: 3];

    always @(posedge clk_i) begin
        npi_addr_ack_o <= {PORTS{1'b0}};
        case (state)
            WAIT_REQUEST: begin
                port  <= next;
                read  <= npi_rnw_i[next];
                addr  <= npi_addr_i[32*next +: 32];
                words <= 5'd1 << next_size;
                left  <= 5'd1 << next_size;
                if (|asking)
                    state <= npi_rnw_i[next] ? WAIT_COMMAND : MOVE_WORDS;
                else
                    port <= port;
            end
            MOVE_WORDS: if (wr_valid_o && wr_ready_i) begin
                left <= left - 5'd1;
                if (left == 5'd1)
                    state <= WAIT_COMMAND;
            end
            default: if (cmd_valid_o && cmd_ready_i) begin
                npi_addr_ack_o[port] <= 1'b1;
                state <= WAIT_REQUEST;
            end
        endcase
        if (rd_valid_i && rd_ready_o)
            rd_index <= back_last ? 4'd0 : rd_index + 4'd1;
        if (rst_i) begin
            state <= WAIT_REQUEST;
            port  <= 0;
            rd_index <= 4'd0;
            npi_addr_ack_o <= {PORTS{1'b0}};
        end
    end

    // A requester has room for what it reads (rule 3), and there is no size above 4.
    wire unused = &{1'b0, rd_almost_full, npi_size_i, 1'b0};
endmodule
