// SPDX-License-Identifier: MIT
//
// bus_window: the slot of an adapter for a third-party core; it shows eight words of the core at a
// time.
//
//   0..2  ID, EVENT, MASK (bus_wrapper); EVENT bit 0: the core's interrupt line was high,
//         bit 1: TIMEOUT, the core did not answer
//   3     PAGE rw: byte address in the core that word 8 accesses, a multiple of 32. If the core has
//         at most eight words, PAGE is always 0 and the words repeat
//   8..15 words of the core at PAGE + 0, 4, .. 28
//
// If the core does not answer within TIMEOUT clocks, or answers with an error, the access ends with
// an error. After a time-out the adapter may still wait for the end of the core's transfer; until
// then idle_i is low and no access starts.

`default_nettype none

`include "wrong_parameter.vh"

module bus_window #(
    parameter [31:0] ID_VALUE   = 32'd0,
    parameter        ADDR_WIDTH = 12,  // width of a byte address in the core, 3..32
    parameter        TIMEOUT    = 255  // time-out, clocks, 1..255
) (
    `include "slot_ports.vh"
    output wire                  irq_o,
    // to the adapter: busy_o stays high, and the other outputs stay stable, until done_i is high or
    // the access times out
    input  wire                  idle_i,
    output reg                   busy_o,
    output wire                  write_o,
    output wire [ADDR_WIDTH-1:0] addr_o,
    output wire [31:0]           wdata_o,
    input  wire                  done_i,
    input  wire                  error_i,
    input  wire [31:0]           rdata_i,
    // interrupt line of the core, a level in the clock domain clk_i
    input  wire                  irq_i
);
    generate
        if (ADDR_WIDTH < 3 || ADDR_WIDTH > 32 || TIMEOUT < 1 || TIMEOUT > 255) begin : g_refused
            `WRONG_PARAMETER("bus_window: ADDR_WIDTH is 3..32, TIMEOUT 1..255")
        end
    endgenerate

    localparam [3:0] PAGE = 4'd3;
    localparam WIDTH = ADDR_WIDTH > 5 ? ADDR_WIDTH : 6; // at least 6, so that `page` has a bit

    wire        own_ready, own_error, reg_write, reg_read;
    wire [31:0] own_rdata;
    wire [3:0]  reg_addr;
    wire [31:0] reg_wdata;
    reg  [WIDTH-1:5] page;
    reg  [7:0]  patience;

    wire window   = bus_addr_i[3];
    wire wanted   = bus_valid_i && window;
    wire given_up = wanted && patience == 8'd0;
    wire end_now  = wanted && ((busy_o && done_i) || given_up);
    wire [31:0] page_value;

    bus_wrapper #(.ID_VALUE(ID_VALUE), .WORDS(16'h0008), .EVENTS(2)) u_wrapper (
        .clk_i(clk_i), .rst_i(rst_i),
        .bus_valid_i(bus_valid_i && !window), .bus_write_i(bus_write_i), .bus_addr_i(bus_addr_i),
        .bus_wdata_i(bus_wdata_i), .bus_ready_o(own_ready), .bus_rdata_o(own_rdata),
        .bus_error_o(own_error),
        .reg_write_o(reg_write), .reg_read_o(reg_read), .reg_addr_o(reg_addr),
        .reg_wdata_o(reg_wdata), .reg_rdata_i(page_value),
        .event_i({given_up && !(busy_o && done_i), irq_i}), .irq_o(irq_o)
    );

    generate
        if (WIDTH == 32) begin : g_full
            assign page_value = {page, 5'd0};
        end else begin : g_part
            assign page_value = {{(32-WIDTH){1'b0}}, page, 5'd0};
        end
    endgenerate
    assign write_o = bus_write_i;
    wire [WIDTH-1:0] place = {page, bus_addr_i[2:0], 2'b00};
    assign addr_o  = place[ADDR_WIDTH-1:0];
    assign wdata_o = bus_wdata_i;

    wire good = busy_o && done_i && !error_i;
    assign bus_ready_o = window ? end_now : own_ready;
    assign bus_error_o = window ? !good : own_error;
    assign bus_rdata_o = window ? rdata_i & {32{good}} : own_rdata;

    always @(posedge clk_i) begin
        if (reg_write && reg_addr == PAGE && ADDR_WIDTH > 5)
            page <= reg_wdata[WIDTH-1:5];
        busy_o <= wanted && !end_now && (busy_o || idle_i);
        if (!wanted || end_now)
            patience <= TIMEOUT[7:0];
        else
            patience <= patience - 8'd1;
        if (rst_i) begin
            page     <= {(WIDTH-5){1'b0}};
            busy_o   <= 1'b0;
            patience <= TIMEOUT[7:0];
        end
    end

    wire unused = &{1'b0, reg_read, reg_wdata, place, 1'b0};

`ifdef FORMAL
    bus_rules #(.LIMIT(TIMEOUT + 1), .PATIENCE(TIMEOUT + 2)) u_rules (
        .clk_i(clk_i), .rst_i(rst_i), .valid_i(bus_valid_i), .write_i(bus_write_i),
        .addr_i({6'd0, bus_addr_i}), .wdata_i(bus_wdata_i), .ready_i(bus_ready_o),
        .rdata_i(bus_rdata_o), .error_i(bus_error_o));
    reg past = 1'b0;
    reg [15:0] used = 16'd0; // number of clocks for which the access has waited before this clock
    (* hierconn *) wire [1:0] \u_wrapper.event_i ;
    wire answered = busy_o && done_i;
    always @(posedge clk_i)
        used <= wanted && !bus_ready_o && !rst_i ? used + 16'd1 : 16'd0;
    initial assume (rst_i);
    always @(posedge clk_i) begin
        past <= 1'b1;
        if (past && !rst_i && !$past(rst_i) && $past(busy_o) && busy_o)
            assert ($past({write_o, addr_o}) == {write_o, addr_o});
        if (past && !rst_i && !$past(rst_i) && busy_o && !$past(busy_o))
            assert ($past(idle_i));
        if (past && !rst_i && !$past(rst_i) && ADDR_WIDTH > 5)
            assert (page ==
                    ($past(bus_valid_i && bus_write_i && bus_addr_i == PAGE) ?
                     $past(bus_wdata_i[WIDTH-1:5]) : $past(page)));
        if (past && $past(rst_i))
            assert (!busy_o && page == 0);
        cover (past && !rst_i && $past(given_up) && irq_o);
        cover (past && !rst_i && given_up && answered && !error_i);
    end
    always @* if (!rst_i) begin
        // a request to the adapter does not outlast the access
        assert (!busy_o || wanted);
        assert (patience + used == TIMEOUT);
        if (bus_valid_i && !bus_write_i && bus_addr_i == PAGE)
            assert (bus_rdata_o == page_value);
        assert (!busy_o ||
                (write_o == bus_write_i && addr_o == {page, bus_addr_i[2:0], 2'b00} &&
                 wdata_o == bus_wdata_i));
        // An access ends with the core's answer, which may be an error, or with a time-out, which
        // sets an event.
        if (wanted) begin
            assert (bus_ready_o == (answered || used == TIMEOUT));
            assert (bus_error_o == !(answered && !error_i));
            assert (bus_rdata_o == (bus_error_o ? 32'd0 : rdata_i));
        end
        assert (\u_wrapper.event_i == {wanted && used == TIMEOUT && !answered, irq_i});
        if (bus_valid_i && !window) begin
            // words 4..7 do not exist, so an access to them is an error
            assert (bus_ready_o && bus_error_o == bus_addr_i[2]);
            assert (bus_write_i || bus_addr_i != 4'd0 || bus_rdata_o == ID_VALUE);
        end
    end
`endif
endmodule
