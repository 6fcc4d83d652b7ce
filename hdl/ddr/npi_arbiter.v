// SPDX-License-Identifier: MIT
//
// npi_arbiter: arbitrates between PORTS memory ports with NPI semantics (docs/memory.md) and sends
// one stream of commands to the memory.
//
// A request is acknowledged as soon as it has a place in the queue, at most one request per clock.
// The memory executes the requests of all ports in the order of their acknowledgements.

`default_nettype none

`include "wrong_parameter.vh"

module npi_arbiter #(
    parameter             PORTS      = 2, // number of ports, 2..8
    // one bit per port: 1 if the port is served before the other ports (npi_select)
    parameter [PORTS-1:0] URGENT     = 0,
    // maximum number of urgent requests in a row while other ports wait, 1..7
    parameter [2:0]       URGENT_RUN = 3'd3,
    // one bit per port: 1 if the port has a read FIFO. A port without a read FIFO must take each
    // word at once; otherwise all ports wait.
    parameter [PORTS-1:0] READ_FIFO  = {PORTS{1'b1}},
    // one bit per port: the port writes one byte per word and puts it on all eight lanes, so that
    // its write FIFO needs to store only one lane (npi_write_fifo)
    parameter [PORTS-1:0] BYTES      = 0,
    // one bit per port: the port writes words in parts, which its write FIFO collects
    // (npi_write_fifo). The port pushes a word after its last part.
    parameter [PORTS-1:0] MERGE      = 0,
    parameter             BLOCK_RAM  = 1,  // 1: FIFOs in block RAM; 0: in LUT RAM, which is one
                                           // clock faster
    parameter             ADDR_WIDTH = 27, // width of a byte address, 9..32 (27 for 128 MiB)
    // log2 of the FIFO depth in words: 5 as specified; less in proofs
    parameter             FIFO_LOG2  = 5,
    // log2 of the queue depth: 4 for 15 requests, because one place stays free; less in proofs
    parameter             QUEUE_LOG2 = 4
) (
    input  wire                clk_i,
    input  wire                rst_i,
    `include "npi_ports.vh"
    // back-end: commands of 1..32 words; the words of a write are passed before its command
    output wire                cmd_valid_o,
    output wire                cmd_read_o,
    output wire [ADDR_WIDTH-1:0] cmd_addr_o,
    output wire [4:0]          cmd_last_o, // number of words minus 1
    input  wire                cmd_ready_i,
    output wire                wr_valid_o,
    output wire [63:0]         wr_data_o,
    output wire [7:0]          wr_be_o,
    input  wire                wr_ready_i,
    input  wire                rd_valid_i,
    input  wire [63:0]         rd_data_i,
    output wire                rd_ready_o
);
    generate
        if (PORTS < 2 || PORTS > 8 || URGENT_RUN == 0 || ADDR_WIDTH < 9 ||
            ADDR_WIDTH > 32) begin : g_refused
            `WRONG_PARAMETER("npi_arbiter: PORTS is 2..8, URGENT_RUN 1..7, ADDR_WIDTH 9..32")
        end
    endgenerate

    localparam PORT_BITS = PORTS > 4 ? 3 : PORTS > 2 ? 2 : 1;

    // In the cycle in which a request is acknowledged, its bit in npi_addr_req_i is still high.
    wire             full, granted;
    wire [PORTS-1:0] choice;
    npi_select #(.PORTS(PORTS), .URGENT(URGENT), .URGENT_RUN(URGENT_RUN)) u_select (
        .clk_i(clk_i), .rst_i(rst_i),
        .req_i(npi_addr_req_i), .enable_i(!full), .choice_o(choice), .any_o(granted),
        .ack_o(npi_addr_ack_o)
    );

    // The address and size of the chosen request are an OR over all ports, so that all ports have
    // the same delay. For two ports one bit is enough to choose. If no request is granted, the
    // result is not used.
    wire [PORTS-1:0]    pick = PORTS == 2 ? {choice[PORTS-1:1], !choice[1]} : choice;
    reg [ADDR_WIDTH-1:0] addr;
    reg [2:0]           size;
    reg [PORT_BITS-1:0] port;
    integer i;
    always @* begin
        addr = {ADDR_WIDTH{1'b0}};
        size = 3'd0;
        port = {PORT_BITS{1'b0}};
        for (i = 0; i < PORTS; i = i + 1) begin
            addr = addr | (npi_addr_i[32*i +: ADDR_WIDTH] & {ADDR_WIDTH{pick[i]}});
            size = size | (npi_size_i[4*i +: 3] & {3{pick[i]}});
            port = port | (i[PORT_BITS-1:0] & {PORT_BITS{pick[i]}});
        end
    end
    // A read of a cache line may start at any of its words; rd_word is that word.
    wire line = size == 3'd1 || size == 3'd2;
    wire [ADDR_WIDTH-4:0] start = {addr[ADDR_WIDTH-1:5], addr[4] && size != 3'd2, addr[3] && !line};

    wire                 back_valid;
    wire [(1<<PORT_BITS)-1:0] move_at; // one-hot
    wire [PORT_BITS-1:0] move_port, back_port;
    wire [4:0]           back_index;
    wire [ADDR_WIDTH-4:0] cmd_word;
    npi_queue #(.PORT_BITS(PORT_BITS), .ADDR_BITS(ADDR_WIDTH - 3), .LOG2(QUEUE_LOG2)) u_queue (
        .clk_i(clk_i), .rst_i(rst_i),
        .push_i(granted), .push_port_i(port), .push_read_i(|(choice & npi_rnw_i)),
        .push_size_i(size), .push_addr_i(start), .full_o(full),
        .move_at_o(move_at), .move_port_o(move_port),
        .move_done_i(wr_valid_o && wr_ready_i),
        .cmd_valid_o(cmd_valid_o), .cmd_read_o(cmd_read_o), .cmd_addr_o(cmd_word),
        .cmd_last_o(cmd_last_o), .cmd_ready_i(cmd_ready_i),
        .back_valid_o(back_valid), .back_port_o(back_port), .back_index_o(back_index),
        .back_done_i(rd_valid_i && rd_ready_o)
    );
    assign cmd_addr_o = {cmd_word, 3'd0};

    // FIFOs of the ports.
    wire [64*PORTS-1:0] wr_datas;
    wire [8*PORTS-1:0]  wr_bes;
    wire [67:0]         rd_word = {back_index[3:0], rd_data_i};
    wire [PORTS-1:0]    back_at, back_free;
    genvar p;
    generate
        for (p = 0; p < PORTS; p = p + 1) begin : g_port
            localparam [PORT_BITS-1:0] ME = p;
            assign back_at[p] = back_valid && back_port == ME;
            npi_write_fifo #(
                .BYTES(BYTES[p]), .MERGE(MERGE[p]), .LOG2(FIFO_LOG2), .BLOCK(BLOCK_RAM)
            ) u_write (
                .clk_i(clk_i), .rst_i(rst_i || npi_wr_flush_i[p]),
                .push_i(npi_wr_push_i[p]),
                .data_i(npi_wr_data_i[64*p +: 64]), .be_i(npi_wr_be_i[8*p +: 8]),
                .pop_i(move_at[p] && wr_valid_o && wr_ready_i),
                .data_o(wr_datas[64*p +: 64]), .be_o(wr_bes[8*p +: 8]),
                .empty_o(npi_wr_empty_o[p]), .full_o(npi_wr_almost_full_o[p])
            );
            if (READ_FIFO[p]) begin : g_fifo
                wire rd_full; // a port must have room for the words of its reads (rule 3)
                npi_fifo #(.WIDTH(68), .LOG2(FIFO_LOG2), .BLOCK(BLOCK_RAM)) u_read (
                    .clk_i(clk_i), .rst_i(rst_i || npi_rd_flush_i[p]),
                    .push_i(rd_valid_i && back_at[p]), .store_i(1'b0), .data_i(rd_word),
                    .pop_i(npi_rd_pop_i[p]),
                    .data_o({npi_rd_word_o[4*p +: 4], npi_rd_data_o[64*p +: 64]}),
                    .empty_o(npi_rd_empty_o[p]), .full_o(rd_full)
                );
                assign back_free[p] = 1'b1;
                wire unused = &{1'b0, rd_full, 1'b0};
            end else begin : g_direct
                assign {npi_rd_word_o[4*p +: 4], npi_rd_data_o[64*p +: 64]} = rd_word;
                assign npi_rd_empty_o[p] = !(rd_valid_i && back_at[p]);
                assign back_free[p] = npi_rd_pop_i[p];
                wire unused = &{1'b0, npi_rd_flush_i[p], 1'b0};
            end
        end
    endgenerate

    reg [63:0] wr_data;
    reg [7:0]  wr_be;
    integer k;
    always @* begin
        wr_data = wr_datas[63:0];
        wr_be   = wr_bes[7:0];
        // There are two select signals, so that each of them drives only half of the loads.
        for (k = 1; k < PORTS; k = k + 1) begin
            if (move_port == k[PORT_BITS-1:0])
                wr_data[31:0] = wr_datas[64*k +: 32];
            if (move_at[k]) begin
                wr_data[63:32] = wr_datas[64*k+32 +: 32];
                wr_be          = wr_bes[8*k +: 8];
            end
        end
    end

    assign wr_valid_o = |(move_at[PORTS-1:0] & ~npi_wr_empty_o);
    assign wr_data_o  = wr_data;
    assign wr_be_o    = wr_be;
    assign rd_ready_o = |(back_at & back_free);

    // These inputs are not used, because byte enables replace read-modify-write, and because
    // transfers are aligned.
    wire unused =
        &{1'b0, npi_rmw_i, npi_size_i, npi_addr_i, addr[2:0], back_index[4], move_at, 1'b0};

`ifdef FORMAL
    `include "npi_arbiter_proof.vh"
`endif
`ifdef COVER_POINTS
    port_holds_up_back_end: cover property (@(posedge clk_i) rd_valid_i && |back_at && !rd_ready_o);
    write_waits_for_its_words: cover property (@(posedge clk_i) |move_at && !wr_valid_o);
    back_end_holds_words: cover property (@(posedge clk_i) wr_valid_o && !wr_ready_i);
`endif
endmodule
