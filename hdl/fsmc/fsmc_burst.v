// SPDX-License-Identifier: MIT
//
// fsmc_burst: synchronous bursts of PSRAM (NE1, FSMC_CLK) to halfword writes and reads in clk_i.
//
// FSMC_CLK runs only during a burst; NE1 high ends it and resets that side. The edge with NADV low takes
// the address (and NWE low: a write); data is on LATENCY edges later (BTR.DATLAT + 2) and on every edge
// from there. NWAIT is one edge ahead (BCR.WAITCFG = 0): low at an edge, the next edge has no data.
// Writes go through a queue of 16 with its Gray-coded counts; a burst's reads through one of 8 that
// begins anew with each burst: `tag` tells FSMC_CLK that the counts are this burst's.

`default_nettype none

module fsmc_burst #(
    parameter MUXED   = 0, // 1: address bits 15..0 come on the data pins
    parameter LATENCY = 5  // edges from the address to the first data, 4..17
) (
    input  wire        clk_i,
    input  wire        rst_i,
    // FSMC pins
    input  wire        fsmc_clk_i,
    input  wire [24:0] fsmc_a_i,   // halfword address
    input  wire [15:0] fsmc_d_i,
    output reg  [15:0] fsmc_d_o,
    input  wire        fsmc_ne_n_i, // NE1: resets this side
    input  wire        selected_i,  // NE1 is low
    input  wire        fsmc_nwe_n_i,
    input  wire        fsmc_nadv_n_i,
    input  wire [1:0]  fsmc_nbl_n_i,
    output reg         fsmc_nwait_n_o,
    // accesses that must come first are under way: no write is accepted
    input  wire        busy_i,
    // writes, in clk_i: the oldest of the queue
    output wire        wr_valid_o,
    output wire [24:0] wr_addr_o,
    output wire [15:0] wr_data_o,
    output wire [1:0]  wr_be_o,
    input  wire        wr_ready_i,
    // reads, in clk_i: the halfword wanted next
    output wire        rd_valid_o,
    output reg  [24:0] rd_addr_o,
    input  wire [15:0] rd_data_i,
    input  wire        rd_ready_i
);
    // ---- FSMC_CLK: address, then beats.
    localparam [4:0] FIRST = LATENCY[4:0];
    reg        rst_q;      // resets the other side, without glitches
    always @(posedge clk_i)
        rst_q <= rst_i;
    reg [1:0]  busy_s;
    reg        begun, write, nwait_was;
    reg [4:0]  edges;      // since the address; stays at FIRST
    reg [24:0] addr, wr_addr;
    reg        request;    // toggles with each read burst
    wire       takes_address = selected_i && !begun && !fsmc_nadv_n_i;
    wire [24:0] pin_addr;
    generate
        if (MUXED != 0) begin : g_muxed
            wire unused = &{1'b0, fsmc_a_i[15:0], 1'b0};
            assign pin_addr = {fsmc_a_i[24:16], fsmc_d_i};
        end else begin : g_plain
            assign pin_addr = fsmc_a_i;
        end
    endgenerate

    // The write queue, its FSMC_CLK side.
    reg [42:0] queue [0:15];
    reg [4:0]  wq_count, wq_gray;                 // written
    reg [4:0]  rq_count, rq_gray, rq_s0, rq_s1;   // taken, as seen from FSMC_CLK
    wire [4:0] wq_next = wq_count + 5'd1;
    wire [4:0] rq_seen = {rq_s1[4], ^rq_s1[4:3], ^rq_s1[4:2], ^rq_s1[4:1], ^rq_s1[4:0]};
    wire [4:0] queued  = wq_count - rq_seen;
    wire       accept  = begun && write && edges == FIRST && nwait_was;

    // The read queue, its FSMC_CLK side.
    reg [15:0] words [0:7];
    reg [3:0]  pushed, pushed_gray, pushed_s0, pushed_s1;
    reg [3:0]  popped, popped_gray;
    reg        tag, tag_s0, tag_s1;
    reg [15:0] stage;
    wire       there = tag_s1 == request && pushed_s1 != popped_gray;
    wire       ahead = begun && !write && edges >= FIRST - 5'd2; // the edge after next has data
    wire [3:0] popped_next = popped + 4'd1;

    always @(posedge fsmc_clk_i or posedge fsmc_ne_n_i)
        if (fsmc_ne_n_i) begin
            begun     <= 1'b0;
            write     <= 1'b0;
            edges     <= 5'd0;
            nwait_was <= 1'b0;
            fsmc_nwait_n_o <= 1'b0;
            popped      <= 4'd0;
            popped_gray <= 4'd0;
        end else begin
            nwait_was <= fsmc_nwait_n_o;
            if (takes_address) begin
                begun <= 1'b1;
                write <= !fsmc_nwe_n_i;
                edges <= 5'd1;
            end else if (begun && edges != FIRST) begin
                edges <= edges + 5'd1;
            end
            // Two more may be accepted before this is seen, and one is under way.
            fsmc_nwait_n_o <= begun && (write ? queued <= 5'd12 && !busy_s[1] : ahead && there);
            if (ahead && there) begin
                popped      <= popped_next;
                popped_gray <= popped_next ^ {1'b0, popped_next[3:1]};
            end
        end

    always @(posedge fsmc_clk_i) begin
        if (takes_address) begin
            addr    <= pin_addr;
            wr_addr <= pin_addr;
        end
        busy_s   <= {busy_s[0], busy_i};
        stage    <= words[popped[2:0]];
        fsmc_d_o <= stage;
        if (accept) begin
            queue[wq_count[3:0]] <= {wr_addr, ~fsmc_nbl_n_i, fsmc_d_i};
            wr_addr <= wr_addr + 25'd1;
        end
        {tag_s1, tag_s0}       <= {tag_s0, tag};
        {pushed_s1, pushed_s0} <= {pushed_s0, pushed_gray};
    end
    always @(posedge fsmc_clk_i or posedge rst_q)
        if (rst_q) begin
            request  <= 1'b0;
            wq_count <= 5'd0;
            wq_gray  <= 5'd0;
            {rq_s1, rq_s0} <= 10'd0;
        end else begin
            if (takes_address && fsmc_nwe_n_i)
                request <= !request;
            if (accept) begin
                wq_count <= wq_next;
                wq_gray  <= wq_next ^ {1'b0, wq_next[4:1]};
            end
            {rq_s1, rq_s0} <= {rq_s0, rq_gray};
        end

    // ---- clk_i: takes writes, and fills the read queue as long as the burst lasts.
    reg [4:0] wq_s0, wq_s1;
    wire [4:0] rq_next = rq_count + 5'd1;
    assign wr_valid_o = wq_s1 != rq_gray;
    assign {wr_addr_o, wr_be_o, wr_data_o} = queue[rq_count[3:0]];

    reg [2:0] request_s;                 // a clock behind ended_s, which changes with it
    reg [1:0] ended_s;
    reg [3:0] popped_g0, popped_g1;
    reg       known, reading;            // the request that is being served
    wire      begins = request_s[2] != known;
    wire [3:0] pushed_next = pushed + 4'd1;
    wire [3:0] popped_seen = {popped_g1[3], ^popped_g1[3:2], ^popped_g1[3:1], ^popped_g1[3:0]};
    wire [3:0] held = pushed - popped_seen;
    assign rd_valid_o = reading && !ended_s[1] && !begins && tag == known && held < 4'd8;
    wire      push = rd_valid_o && rd_ready_i;

    always @(posedge clk_i) begin
        {wq_s1, wq_s0} <= {wq_s0, wq_gray};
        request_s <= {request_s[1:0], request};
        ended_s   <= {ended_s[0], !begun};
        {popped_g1, popped_g0} <= {popped_g0, popped_gray};
        if (wr_valid_o && wr_ready_i) begin
            rq_count <= rq_next;
            rq_gray  <= rq_next ^ {1'b0, rq_next[4:1]};
        end
        if (push) begin
            words[pushed[2:0]] <= rd_data_i;
            pushed      <= pushed_next;
            pushed_gray <= pushed_next ^ {1'b0, pushed_next[3:1]};
            rd_addr_o   <= rd_addr_o + 25'd1;
        end
        if (ended_s[1])
            reading <= 1'b0;
        if (begins) begin
            known     <= request_s[2];
            reading   <= 1'b1;
            rd_addr_o <= addr;
            pushed      <= 4'd0;
            pushed_gray <= 4'd0;
        end else begin
            tag <= known; // the counts have been zero for a clock
        end
        if (rst_i) begin
            {wq_s1, wq_s0} <= 10'd0;
            rq_count  <= 5'd0;
            rq_gray   <= 5'd0;
            request_s <= 3'd0;
            known     <= 1'b0;
            tag       <= 1'b0;
            reading   <= 1'b0;
            pushed      <= 4'd0;
            pushed_gray <= 4'd0;
        end
    end
endmodule
