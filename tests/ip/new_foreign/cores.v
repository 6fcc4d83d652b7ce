// SPDX-License-Identifier: MIT
//
// cores: third-party cores for tests, each in the style of other people.

// memory_words: four words with select and write enable; read data is valid LATE clocks later.
module memory_words #(parameter LATE = 0) (
    input         clk, rst,
    input         cs, we,
    input  [1:0]  address,
    input  [31:0] write_data,
    output [31:0] read_data
);
    reg  [31:0] words [0:3];
    wire [31:0] value [0:LATE];
    assign value[0]  = cs ? words[address] : 32'hBAD0BAD0;
    assign read_data = value[LATE];
    generate
        genvar i;
        for (i = 0; i < LATE; i = i + 1) begin : later
            reg [31:0] held;
            always @(posedge clk) held <= value[i];
            assign value[i+1] = held;
        end
    endgenerate
    always @(posedge clk)
        if (cs && we)
            words[address] <= write_data;
    wire unused = rst;
endmodule

// wb_words: a Wishbone core in the style of pipelined cores: it stalls each strobe for `stalls`
// clocks, and answers `late` clocks after it has taken the strobe, or in the same clock if `late`
// is 0. Without STALL it is a classic core, and counts both delays from the start of the strobe.
// Its addresses count bytes.
module wb_words (
    input             wb_clk_i, wb_rst_i,
    input             wb_cyc_i, wb_stb_i, wb_we_i,
    input      [3:0]  wb_adr_i,
    input      [3:0]  wb_sel_i,
    input      [31:0] wb_dat_i,
    output     [31:0] wb_dat_o,
    output            wb_ack_o, wb_stall_o,
    input      [2:0]  stalls, late
);
    reg  [31:0] words [0:3];
    reg  [3:0]  waited; // number of clocks since the strobe began
    reg         we;
    reg  [1:0]  word;
    wire        begins = wb_cyc_i && wb_stb_i && waited <= stalls;
    wire [1:0]  at     = begins ? wb_adr_i[3:2] : word;
    assign wb_stall_o = waited < stalls;
    assign wb_ack_o   = wb_cyc_i && (wb_stb_i || waited != 0) && waited == stalls + late;
    assign wb_dat_o   = wb_ack_o && &wb_sel_i ? words[at] : 32'hBAD0BAD0;
    always @(posedge wb_clk_i) begin
        waited <= wb_cyc_i && (wb_stb_i || waited != 0) && !wb_ack_o ? waited + 1 : 0;
        if (begins) begin
            {we, word} <= {wb_we_i, wb_adr_i[3:2]};
            if (wb_we_i && waited == stalls)
                words[at] <= wb_dat_i;
        end
        if (wb_rst_i)
            waited <= 0;
    end
endmodule

// axis_scale: multiplies samples of 16 bits. The core has AXI-Streams without tlast, and also a
// setting and a pin.
module axis_scale (
    input  wire        aclk,
    input  wire        aresetn,
    input  wire [7:0]  gain_factor,
    output reg         over, // high if a product was too large
    input  wire [15:0] s_axis_tdata,
    input  wire        s_axis_tvalid,
    output wire        s_axis_tready,
    output reg  [15:0] m_axis_tdata,
    output reg         m_axis_tvalid,
    input  wire        m_axis_tready
);
    wire [23:0] product = s_axis_tdata * gain_factor;
    assign s_axis_tready = !m_axis_tvalid || m_axis_tready;
    always @(posedge aclk) begin
        if (s_axis_tready) begin
            m_axis_tvalid <= s_axis_tvalid;
            m_axis_tdata  <= product[15:0];
            over          <= s_axis_tvalid ? |product[23:16] : over;
        end
        if (!aresetn) begin
            m_axis_tvalid <= 1'b0;
            over          <= 1'b0;
        end
    end
endmodule

// axis_twice: outputs each 64-bit word twice, with its byte enables, so that packets become longer.
module axis_twice (
    input  wire        clk,
    input  wire        rst,
    input  wire [63:0] in_tdata,
    input  wire [7:0]  in_tkeep,
    input  wire        in_tlast,
    input  wire        in_tvalid,
    output wire        in_tready,
    output wire [63:0] out_tdata,
    output wire [7:0]  out_tkeep,
    output wire        out_tlast,
    output wire        out_tvalid,
    input  wire        out_tready
);
    reg second;
    assign out_tdata  = in_tdata;
    assign out_tkeep  = second ? in_tkeep : 8'hFF;
    assign out_tlast  = in_tlast && second;
    assign out_tvalid = in_tvalid;
    assign in_tready  = out_tready && second;
    always @(posedge clk)
        if (rst)
            second <= 1'b0;
        else if (out_tvalid && out_tready)
            second <= !second;
endmodule

// req_words: a core with a request that must last until the grant, two clocks later. Word 3
// is never granted.
module req_words (
    input             clock, nrst,
    input             req, wr,
    input      [3:2]  where,
    input      [31:0] value,
    output reg [31:0] held,
    output reg        gnt
);
    reg [31:0] words [0:3];
    reg        seen;
    always @(posedge clock) begin
        seen <= req && !gnt;
        gnt  <= req && seen && !gnt && where != 2'd3;
        held <= words[where];
        if (req && wr)
            words[where] <= value;
        if (!nrst)
            {seen, gnt} <= 2'b00;
    end
endmodule

// wbs_names: a core with unusual names of Wishbone signals; the core is also a bus master. Its
// strobe and acknowledge are missing.
module wbs_names (
    input         wbs_clk, rst_ni, gate_clk_pad_i,
    input  [3:0]  clk_div,
    input         wbs_cyc_i, wbs_we_i,
    input  [2:0]  wbs_cti_i,
    input  [1:0]  wbs_adr_i,
    input  [31:0] wbs_dat_i,
    output [31:0] wbs_dat_o,
    output        intr, spare
);
    assign {wbs_dat_o, intr, spare} = 34'd0;
endmodule

// avalon_words: an Avalon-MM core in the style of pipelined slaves: it delays each request by
// `waits` clocks, and returns read data `late` clocks after it has taken the request, or in the
// same clock if `late` is 0.
module avalon_words (
    input             csi_clk, rsi_reset_n,
    input             avs_read, avs_write_n,
    input      [1:0]  avs_address,
    input      [31:0] avs_writedata,
    input      [3:0]  avs_byteenable,
    input      [3:0]  avs_burstcount,
    output     [31:0] avs_readdata,
    output            avs_waitrequest, avs_readdatavalid,
    input      [2:0]  waits, late
);
    reg  [31:0] words [0:3];
    reg  [2:0]  waited, left;
    reg  [1:0]  word;
    reg         reads;
    wire        takes = (avs_read || !avs_write_n) && !avs_waitrequest;
    assign avs_waitrequest   = waited < waits;
    assign avs_readdatavalid = late == 3'd0 ? takes && avs_read : reads && left == 3'd0;
    assign avs_readdata      = avs_readdatavalid ? words[late == 3'd0 ? avs_address : word]
                                                 : 32'hBAD0BAD0;
    always @(posedge csi_clk) begin
        waited <= (avs_read || !avs_write_n) && avs_waitrequest ? waited + 1 : 0;
        left   <= takes ? late - 1 : left - 1;
        reads  <= takes ? avs_read : reads && !avs_readdatavalid;
        if (takes)
            word <= avs_address;
        if (takes && !avs_write_n && &avs_byteenable && avs_burstcount == 4'd1)
            words[avs_address] <= avs_writedata;
        if (!rsi_reset_n) begin
            waited <= 0;
            reads  <= 0;
        end
    end
endmodule

// two_ways: reads and writes have separate addresses, requests that last one clock, and
// acknowledges. The core counts the writes.
module two_ways (
    input             up_clk, up_rstn,
    input             up_wreq, up_rreq,
    input      [2:0]  up_waddr, up_raddr,
    input      [31:0] up_wdata,
    output reg [31:0] up_rdata,
    output reg        up_wack, up_rack,
    output     [39:0] lane_rates
);
    reg [31:0] words [0:3];
    reg [31:0] writes;
    assign lane_rates = 40'd0;
    always @(posedge up_clk)
        if (!up_rstn) begin
            {up_wack, up_rack} <= 2'b00;
            writes             <= 32'd0;
        end else begin
            {up_wack, up_rack} <= {up_wreq, up_rreq};
            up_rdata           <= up_raddr[2] ? writes : words[up_raddr[1:0]];
            writes             <= writes + up_wreq;
            if (up_wreq && !up_waddr[2])
                words[up_waddr[1:0]] <= up_wdata;
        end
endmodule
