// SPDX-License-Identifier: MIT
//
// bus_wrapper: implements the first three words of every slot, and generates access strobes for the
// words of the block (docs/bus.md).
//
//   0  ID     ro   ID_VALUE
//   1  EVENT  w1c  sticky events; an event that arrives while it is cleared stays set
//   2  MASK   rw   1: the event drives irq_o
//   3..15          words of the block; bit w of WORDS is 1 if word w exists
//
// The block answers in the cycle of the access: it drives reg_rdata_i for reg_addr_o, and stores
// reg_wdata_o while reg_write_o is high.

`default_nettype none

module bus_wrapper #(
    parameter [31:0] ID_VALUE = 32'd0,
    parameter [15:0] WORDS    = 16'hFFF8,    // bit w: word w exists; bits 2..0 are ignored
    parameter        EVENTS   = 1,           // number of events, 1..32
    parameter [31:0] RAISED   = 32'hFFFFFFFF // bit e: event e can happen; other events stay 0
) (
    `include "slot_ports.vh"
    // access to the registers of the block
    output wire              reg_write_o,
    output wire              reg_read_o,
    output wire [3:0]        reg_addr_o,
    output wire [31:0]       reg_wdata_o,
    input  wire [31:0]       reg_rdata_i,
    // events; each is high for one cycle
    input  wire [EVENTS-1:0] event_i,
    output wire              irq_o
);
    localparam [3:0] ID = 4'd0, EVENT = 4'd1, MASK = 4'd2;

    reg [EVENTS-1:0] sticky, mask;

    wire own    = bus_addr_i > MASK;
    wire exists = !own || WORDS[bus_addr_i];
    wire write  = bus_valid_i && bus_write_i;
    wire [EVENTS-1:0] clear = {EVENTS{write && bus_addr_i == EVENT}} & bus_wdata_i[EVENTS-1:0];

    assign bus_ready_o = 1'b1;
    assign bus_error_o = !exists;
    assign reg_write_o = write && own && exists;
    assign reg_read_o  = bus_valid_i && !bus_write_i && own && exists;
    assign reg_addr_o  = bus_addr_i;
    assign reg_wdata_o = bus_wdata_i;
    assign irq_o       = |(sticky & mask);

    reg [31:0] first; // words 0..2
    always @* begin
        first = 32'd0;
        if (bus_addr_i == ID)
            first = ID_VALUE;
        if (bus_addr_i == EVENT)
            first[EVENTS-1:0] = sticky;
        if (bus_addr_i == MASK)
            first[EVENTS-1:0] = mask;
    end
    assign bus_rdata_o = first | (own && exists ? reg_rdata_i : 32'd0);

    always @(posedge clk_i) begin
        sticky <= ((sticky & ~clear) | event_i) & RAISED[EVENTS-1:0];
        if (write && bus_addr_i == MASK)
            mask <= bus_wdata_i[EVENTS-1:0];
        if (rst_i) begin
            sticky <= {EVENTS{1'b0}};
            mask   <= {EVENTS{1'b0}};
        end
    end

`ifdef FORMAL
    bus_rules #(.LIMIT(1)) u_rules (
        .clk_i(clk_i), .rst_i(rst_i), .valid_i(bus_valid_i), .write_i(bus_write_i),
        .addr_i({6'd0, bus_addr_i}), .wdata_i(bus_wdata_i), .ready_i(bus_ready_o),
        .rdata_i(bus_rdata_o), .error_i(bus_error_o));
    reg past = 1'b0;
    wire writes = bus_valid_i && bus_write_i;
    initial assume (rst_i);
    always @(posedge clk_i) begin
        past <= 1'b1;
        if (past && !$past(rst_i)) begin
            // No event is lost, even if it arrives while other events are cleared. The mask changes
            // only by writes.
            assert (sticky ==
                    (RAISED[EVENTS-1:0] &
                     (($past(sticky) &
                       ~($past(writes && bus_addr_i == EVENT) ? $past(bus_wdata_i[EVENTS-1:0]) :
                         {EVENTS{1'b0}}))
                                | $past(event_i))));
            assert (mask ==
                    ($past(writes && bus_addr_i == MASK) ? $past(bus_wdata_i[EVENTS-1:0]) :
                     $past(mask)));
        end
        if (past && $past(rst_i))
            assert ({sticky, mask} == {2*EVENTS{1'b0}});
        cover (past && !rst_i && irq_o && write && bus_addr_i == EVENT && |(event_i & clear));
    end
    always @* begin
        // An access to a word that does not exist is an error, and does not read or write a
        // register of the block.
        assert ({reg_write_o, reg_read_o} ==
                ({writes, bus_valid_i && !bus_write_i} & {2{bus_addr_i > MASK && !bus_error_o}}));
        assert (bus_error_o == (bus_addr_i > MASK && !WORDS[bus_addr_i]));
        // A read returns a word of the wrapper or of the block, or 0 if the word does not exist.
        if (bus_addr_i > MASK)
            assert (bus_rdata_o == (exists ? reg_rdata_i : 32'd0));
        else
            assert (bus_rdata_o ==
                    (bus_addr_i == ID ? ID_VALUE :
                     {{32-EVENTS{1'b0}}, bus_addr_i == EVENT ? sticky : mask}));
        assert (bus_ready_o);
        assert (irq_o == |(sticky & mask));
    end
`endif
`ifdef COVER_POINTS
    set_while_cleared: cover property (@(posedge clk_i) |(event_i & clear));
    masked: cover property (@(posedge clk_i) |sticky && !irq_o);
    no_such_word: cover property (@(posedge clk_i) bus_valid_i && !exists);
`endif
endmodule
