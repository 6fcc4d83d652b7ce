// SPDX-License-Identifier: MIT
//
// speed_tb: the vision core on frames whose pixels are computed from their address, for Icarus.
// speed_tb.vhd and speed.cpp do the same in VHDL and for Verilator. +frames=n

`timescale 1ns / 1ps
`default_nettype none

module speed_tb;
    `include "vision_regs.vh"
    localparam WIDTH = 256, HEIGHT = 64;

    reg clk = 1'b0, rst = 1'b1;
    always #5 clk = ~clk;

    reg         bus_valid = 1'b0;
    reg  [3:0]  bus_addr = 4'd0;
    reg  [31:0] bus_wdata = 32'd0;
    wire [31:0] npi_addr;
    wire        npi_req, npi_rnw, npi_pop, irq;
    reg         npi_ack = 1'b0;
    reg  [31:0] at = 32'd0, next_at = 32'd0;
    integer     left = 0, next_left = 0, frames, frame, clocks = 0, words;

    function [7:0] pixel(input [31:0] address);
        pixel = {address[4:0] ^ address[12:8], 3'd0} + (address[5] ^ address[10] ? 8'd90 : 8'd0);
    endfunction
    wire [63:0] data = {pixel(at + 7), pixel(at + 6), pixel(at + 5), pixel(at + 4),
                        pixel(at + 3), pixel(at + 2), pixel(at + 1), pixel(at)};

    vision u_vision (
        .clk_i(clk), .rst_i(rst), .bus_valid_i(bus_valid), .bus_write_i(1'b1), .bus_addr_i(bus_addr),
        .bus_wdata_i(bus_wdata), .bus_ready_o(), .bus_rdata_o(), .bus_error_o(), .irq_o(irq),
        .npi_addr_o(npi_addr), .npi_addr_req_o(npi_req), .npi_addr_ack_i(npi_ack), .npi_rnw_o(npi_rnw),
        .npi_size_o(), .npi_rmw_o(), .npi_wr_data_o(), .npi_wr_be_o(), .npi_wr_push_o(),
        .npi_wr_empty_i(1'b1), .npi_wr_almost_full_i(1'b0), .npi_wr_flush_o(),
        .npi_rd_data_i(data), .npi_rd_word_i(4'd0), .npi_rd_pop_o(npi_pop),
        .npi_rd_empty_i(left == 0), .npi_rd_flush_o(), .npi_init_done_i(1'b1)
    );

    always @(posedge clk) begin
        clocks <= clocks + 1;
        npi_ack <= npi_req && !npi_ack && (!npi_rnw || next_left == 0);
        if (npi_pop && left > 1) begin
            at   <= at + 8;
            left <= left - 1;
        end else if (npi_pop) begin
            at        <= next_at;
            left      <= next_left;
            next_left <= 0;
        end
        if (npi_ack && npi_rnw) begin
            if (left == 0 || (npi_pop && left == 1 && next_left == 0)) begin
                at   <= npi_addr;
                left <= 16;
            end else begin
                next_at   <= npi_addr;
                next_left <= 16;
            end
        end
    end

    task write(input [3:0] word, input [31:0] value);
        begin
            bus_valid = 1'b1;
            bus_addr  = word;
            bus_wdata = value;
            @(posedge clk) #1;
            bus_valid = 1'b0;
        end
    endtask

    initial begin
        if (!$value$plusargs("frames=%d", frames))
            frames = 1;
        repeat (4) @(posedge clk);
        #1 rst = 1'b0;
        write(VISION_MASK, 3);
        write(VISION_THRESHOLD, 20);
        write(VISION_FRAME_BASE, 0);
        write(VISION_FRAME_SIZE, HEIGHT << 16 | WIDTH);
        write(VISION_RESULT_BASE, 32'h100000);
        write(VISION_RESULT_MAX, 0);
        for (frame = 0; frame < frames; frame = frame + 1) begin
            write(VISION_EVENT, 3);
            write(VISION_CONTROL, 1);
            while (!irq)
                @(posedge clk) #1;
        end
        $display("clocks %0d", clocks);
        $finish;
    end
endmodule
