// SPDX-License-Identifier: MIT
//
// bus_registers: implements a complete slot of 16 words that is described by parameters: the three
// words of the wrapper, and the words of the block.
//
// Each kind of word has a mask with one bit for each of the words 3..15. A word has at most one
// kind; an access to a word without a kind is an error. WIDTHS has 6 bits for each word: bits above
// this width read as 0 and are not stored.
//   RW   value_o is the written value; a reset sets it to 0
//   RO   a read returns value_i
//   W1C  bits that value_i sets stay set until 1 is written to them; a bit that is set and cleared
//        at the same time stays set
//   WS   a write only acts through strobe_o and wdata_o; a read returns 0
// strobe_o is high for each write to a word, in the cycle of the write. wdata_o is then valid, and
// value_o still has the old value. Word w is at bit 32*(w-3) of the vectors and at bit w-3 of
// strobe_o.

`default_nettype none

module bus_registers #(
    parameter [31:0] ID_VALUE = 32'd0,
    parameter        EVENTS   = 1,        // number of events, 1..32
    parameter [31:0] RAISED   = 32'hFFFFFFFF, // bit e: event e can happen; other events stay 0
    parameter [15:0] RW       = 16'h0000,
    parameter [15:0] RO       = 16'h0000,
    parameter [15:0] W1C      = 16'h0000,
    parameter [15:0] WS       = 16'h0000,
    parameter [95:0] WIDTHS   = {16{6'd32}} // width of word w in bits 6w+5..6w, 1..32
) (
    `include "slot_ports.vh"
    // the block
    output wire [32*13-1:0]  value_o,
    input  wire [32*13-1:0]  value_i,
    output wire [12:0]       strobe_o,
    output wire [31:0]       wdata_o,
    input  wire [EVENTS-1:0] event_i, // events; each is high for one cycle
    output wire              irq_o
);
    wire        reg_write, reg_read;
    wire [3:0]  reg_addr;
    reg  [31:0] rdata;

    bus_wrapper #(.ID_VALUE(ID_VALUE), .WORDS(RW | RO | W1C | WS), .EVENTS(EVENTS),
                  .RAISED(RAISED)) u_wrapper (
        `include "slot_connect.vh"
        .reg_write_o(reg_write), .reg_read_o(reg_read), .reg_addr_o(reg_addr),
        .reg_wdata_o(wdata_o), .reg_rdata_i(rdata),
        .event_i(event_i), .irq_o(irq_o)
    );

    wire [32*13-1:0] shown; // read value of each word
    genvar w;
    generate
        for (w = 3; w < 16; w = w + 1) begin : g_word
            localparam [5:0] WIDTH = WIDTHS[6*w +: 6];
            localparam LSB = 32 * (w - 3);
            assign strobe_o[w-3] = (RW[w] || W1C[w] || WS[w]) && reg_write && reg_addr == w;
            if (RW[w] || W1C[w]) begin : g_stored
                reg [WIDTH-1:0] value;
                if (RW[w]) begin : g_rw
                    always @(posedge clk_i)
                        if (rst_i)
                            value <= {WIDTH{1'b0}};
                        else if (strobe_o[w-3])
                            value <= wdata_o[WIDTH-1:0];
                end else begin : g_w1c
                    always @(posedge clk_i)
                        if (rst_i)
                            value <= {WIDTH{1'b0}};
                        else
                            value <= (value & ~(wdata_o[WIDTH-1:0] & {WIDTH{strobe_o[w-3]}}))
                                     | value_i[LSB +: WIDTH];
                end
                assign value_o[LSB +: WIDTH] = value;
                assign shown[LSB +: WIDTH]   = value;
                if (WIDTH < 32) begin : g_pad
                    assign value_o[LSB+WIDTH +: 32-WIDTH] = {(32-WIDTH){1'b0}};
                    assign shown[LSB+WIDTH +: 32-WIDTH]   = {(32-WIDTH){1'b0}};
                end
            end else begin : g_plain
                assign value_o[LSB +: 32] = 32'd0;
                assign shown[LSB +: 32]   = RO[w] ?
                    value_i[LSB +: 32] & (32'hFFFFFFFF >> (6'd32 - WIDTH)) : 32'd0;
            end
        end
    endgenerate

    integer i;
    always @* begin
        rdata = 32'd0;
        for (i = 3; i < 16; i = i + 1)
            if ({28'd0, reg_addr} == i)
                rdata = shown[32*(i-3) +: 32];
    end

    wire unused = &{1'b0, reg_read, value_i, 1'b0};

`ifdef FORMAL
    reg past = 1'b0;
    initial assume (rst_i);
    always @(posedge clk_i)
        past <= 1'b1;
    genvar f;
    generate
        for (f = 3; f < 16; f = f + 1) begin : g_formal
            localparam LSB = 32 * (f - 3);
            wire [31:0] bits = 32'hFFFFFFFF >> (6'd32 - WIDTHS[6*f +: 6]);
            wire [31:0] now  = value_o[LSB +: 32];
            always @(posedge clk_i) if (past && $past(rst_i)) begin
                if (RW[f] || W1C[f])
                    assert (now == 32'd0);
            end else if (past && !rst_i) begin
                if (RW[f])
                    assert (now == ($past(strobe_o[f-3]) ? $past(wdata_o) & bits : $past(now)));
                if (W1C[f])
                    assert (now ==
                            (bits & (($past(now) & ~($past(strobe_o[f-3]) ? $past(wdata_o) : 32'd0))
                                            | $past(value_i[LSB +: 32]))));
            end
            always @* begin
                assert (strobe_o[f-3] ==
                        (bus_valid_i && bus_write_i && bus_addr_i == f &&
                         (RW[f] || W1C[f] || WS[f])));
                if (bus_valid_i && !bus_write_i && bus_addr_i == f)
                    assert (bus_rdata_o ==
                            (RW[f] || W1C[f] ? now : RO[f] ? value_i[LSB +: 32] & bits : 32'd0));
            end
        end
    endgenerate
    // The registers EVENT and MASK.
    reg  [EVENTS-1:0] seen, masked;
    wire [EVENTS-1:0] cleared = {EVENTS{bus_valid_i && bus_write_i && bus_addr_i == 4'd1}} &
        bus_wdata_i[EVENTS-1:0];
    always @(posedge clk_i) begin
        seen <= rst_i ? {EVENTS{1'b0}} : ((seen & ~cleared) | event_i) & RAISED[EVENTS-1:0];
        if (rst_i)
            masked <= {EVENTS{1'b0}};
        else if (bus_valid_i && bus_write_i && bus_addr_i == 4'd2)
            masked <= bus_wdata_i[EVENTS-1:0];
    end
    wire [15:0] words = RW | RO | W1C | WS | 16'h0007;
    always @* begin
        assert (strobe_o == 13'd0 || wdata_o == bus_wdata_i);
        assert (bus_ready_o && bus_error_o == !words[bus_addr_i]);
        assert (!past || irq_o == |(seen & masked));
    end
    always @(posedge clk_i)
        cover (past && !rst_i && $past(|strobe_o) && irq_o);
`endif
endmodule
