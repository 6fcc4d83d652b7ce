// SPDX-License-Identifier: MIT
//
// fsmc_bridge_tb: a test bench that another project could have for the installed bridge: it writes
// a register through the FSMC pins, reads it back, and prints PASS.

`timescale 1ns / 1ps
`default_nettype none

module fsmc_bridge_tb;
    reg         clk = 0, rst = 1;
    reg  [24:0] a = 0;
    reg  [15:0] d = 0;
    reg  [1:0]  ne_n = 2'b11;
    reg         noe_n = 1, nwe_n = 1;
    wire [15:0] q;
    wire        nwait_n, valid, write;
    wire [9:0]  addr;
    wire [31:0] wdata;
    reg  [31:0] word = 0; // register 5 of the user's project
    reg  [15:0] low, high;

    always #5 clk = !clk;
    always @(posedge clk)
        if (valid && write && addr == 10'd5)
            word <= wdata;

    fsmc_bridge u_bridge (
        .npi_addr_o(), .npi_addr_req_o(), .npi_addr_ack_i(1'b0), .npi_rnw_o(), .npi_size_o(),
        .npi_rmw_o(), .npi_wr_data_o(), .npi_wr_be_o(), .npi_wr_push_o(), .npi_wr_empty_i(1'b1),
        .npi_wr_almost_full_i(1'b0), .npi_wr_flush_o(), .npi_rd_data_i(64'd0),
        .npi_rd_word_i(4'd0), .npi_rd_pop_o(), .npi_rd_empty_i(1'b1), .npi_rd_flush_o(),
        .npi_init_done_i(1'b1),
        .clk_i(clk), .rst_i(rst), .fsmc_a_i(a), .fsmc_d_i(d), .fsmc_d_o(q), .fsmc_d_oe_o(),
        .fsmc_ne_n_i(ne_n), .fsmc_noe_n_i(noe_n), .fsmc_nwe_n_i(nwe_n), .fsmc_nbl_n_i(2'b00),
        .fsmc_nadv_n_i(1'b1), .fsmc_nwait_n_o(nwait_n), .page_i(6'd0), .access_error_o(),
        .error_memory_o(), .error_addr_o(), .error_write_o(), .late_o(),
        .bus_valid_o(valid), .bus_write_o(write), .bus_addr_o(addr), .bus_wdata_o(wdata),
        .bus_ready_i(valid), .bus_rdata_i(word), .bus_error_i(1'b0));

    task write_half(input [24:0] at, input [15:0] value);
        begin
            a = at; d = value; ne_n = 2'b01;
            #20 nwe_n = 0;
            #100 wait (nwait_n);
            #20 nwe_n = 1;
            #10 ne_n = 2'b11;
            #60 ;
        end
    endtask

    task read_half(input [24:0] at, output [15:0] value);
        begin
            a = at; ne_n = 2'b01;
            #20 noe_n = 0;
            #100 wait (nwait_n);
            #20 value = q;
            noe_n = 1; ne_n = 2'b11;
            #60 ;
        end
    endtask

    initial begin
        #100 rst = 0;
        #100 ;
        write_half(25'd10, 16'hBEEF);
        write_half(25'd11, 16'hCAFE);
        read_half(25'd10, low);
        read_half(25'd11, high);
        if ({high, low} === 32'hCAFEBEEF && word === 32'hCAFEBEEF)
            $display("PASS");
        else
            $display("FAIL: expected cafebeef, got %h, register %h", {high, low}, word);
        $finish;
    end

    initial #100000 begin
        $display("FAIL: no answer within 100 us");
        $finish;
    end
endmodule
