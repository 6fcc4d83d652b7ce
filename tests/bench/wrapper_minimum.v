// SPDX-License-Identifier: MIT
//
// wrapper_minimum: the generated wrapper of a new core (ip/template) as written by hand: the
// measure of generation's cost (make bench).

`default_nettype none

module wrapper_minimum (
    input  wire        clk_i,
    input  wire        rst_i,
    // register bus
    input  wire        bus_valid_i,
    input  wire        bus_write_i,
    input  wire [3:0]  bus_addr_i,
    input  wire [31:0] bus_wdata_i,
    output wire        bus_ready_o,
    output reg  [31:0] bus_rdata_o,
    output wire        bus_error_o,
    output wire        irq_o,
    // the core: ports as the wrapper's
    output reg         core_rst_o,
    output wire        set_offset_start_o,
    output wire [31:0] set_offset_offset_o,
    output wire        add_start_o,
    output wire [31:0] add_value_o,
    input  wire [31:0] add_result_i,
    output wire        sum_to_start_o,
    output wire [31:0] sum_to_count_o,
    input  wire [31:0] sum_to_result_i,
    input  wire        sum_to_done_i,
    input  wire        sum_to_refused_i
);
    reg [31:0] offset, value, count;
    reg [2:0]  mask;
    reg        event_done, busy, refused;

    wire write   = bus_valid_i && bus_write_i;
    wire control = write && bus_addr_i == 4'd3;
    wire done    = sum_to_done_i && busy;

    assign bus_ready_o         = 1'b1;
    assign bus_error_o         = bus_addr_i > 4'd9;
    assign irq_o               = event_done && mask[2];
    assign set_offset_start_o  = control && bus_wdata_i[0];
    assign add_start_o         = control && bus_wdata_i[1];
    assign sum_to_start_o      = control && bus_wdata_i[2] && !busy;
    assign set_offset_offset_o = offset;
    assign add_value_o         = value;
    assign sum_to_count_o      = count;

    always @* begin
        case (bus_addr_i)
            4'd0:    bus_rdata_o = 32'h53410100; // "SA", version 1.0
            4'd1:    bus_rdata_o = {29'd0, event_done, 2'd0};
            4'd2:    bus_rdata_o = {29'd0, mask};
            4'd4:    bus_rdata_o = {13'd0, refused, 15'd0, busy, 2'd0};
            4'd5:    bus_rdata_o = offset;
            4'd6:    bus_rdata_o = value;
            4'd7:    bus_rdata_o = add_result_i;
            4'd8:    bus_rdata_o = count;
            4'd9:    bus_rdata_o = sum_to_result_i;
            default: bus_rdata_o = 32'd0;
        endcase
    end

    always @(posedge clk_i) begin
        core_rst_o <= rst_i || (control && bus_wdata_i[31]);
        event_done <= (event_done && !(write && bus_addr_i == 4'd1 && bus_wdata_i[2])) || done;
        busy       <= (busy && !done) || sum_to_start_o;
        refused    <= (refused && !done && !sum_to_start_o) || (done && sum_to_refused_i);
        if (write && bus_addr_i == 4'd2)
            mask <= bus_wdata_i[2:0];
        if (write && bus_addr_i == 4'd5)
            offset <= bus_wdata_i;
        if (write && bus_addr_i == 4'd6)
            value <= bus_wdata_i;
        if (write && bus_addr_i == 4'd8)
            count <= bus_wdata_i;
        if (core_rst_o) begin
            busy    <= 1'b0;
            refused <= 1'b0;
        end
        if (rst_i) begin
            event_done <= 1'b0;
            mask       <= 3'd0;
            offset     <= 32'd0;
            value      <= 32'd0;
            count      <= 32'd0;
        end
    end
endmodule
