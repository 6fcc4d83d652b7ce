// SPDX-License-Identifier: MIT
//
// memories_tb: three cores of the chip fill their buffers at once, then every word in DDR3 must
// hold what its owner wrote.

`timescale 1ns / 1ns
`default_nettype none

module memories_tb;
    `include "map_regs.vh"
    localparam BUFFERS = 32'h01000000, WORDS = 1 << 18; // DDR3 from BUFFERS on, 64-bit words

    reg         clk = 1'b0, rst = 1'b1;
    wire        cmd_en, wr_en;
    wire [2:0]  instr;
    wire [5:0]  bl;
    wire [29:0] byte_addr;
    wire [63:0] wr_data;
    always #5 clk = !clk;

    soc dut (
        .clk_i(clk), .rst_i(rst),
        .fsmc_a_i(25'd0), .fsmc_d_i(16'd0), .fsmc_ne_n_i(2'b11), .fsmc_noe_n_i(1'b1),
        .fsmc_nwe_n_i(1'b1), .fsmc_nbl_n_i(2'b11), .fsmc_nadv_n_i(1'b1),
        .modem_rxd_i(1'b1), .modem_cts_n_i(1'b0), .core_pins_i(32'd0),
        .mcb_cmd_en_o(cmd_en), .mcb_cmd_instr_o(instr), .mcb_cmd_bl_o(bl),
        .mcb_cmd_byte_addr_o(byte_addr), .mcb_cmd_full_i(1'b0),
        .mcb_wr_en_o(wr_en), .mcb_wr_data_o(wr_data), .mcb_wr_full_i(1'b0),
        .mcb_rd_data_i(64'd0), .mcb_rd_empty_i(1'b1), .mcb_calib_done_i(1'b1)
    );

    // DDR3 behind the MCB: data is pushed before its command.
    reg [63:0] memory [0:WORDS-1], pushed [0:255];
    reg [7:0]  head = 8'd0, tail = 8'd0;
    integer    i, at;
    always @(posedge clk) begin
        if (wr_en) begin
            pushed[head] = wr_data;
            head = head + 8'd1;
        end
        if (cmd_en && !instr[0])
            for (i = 0; i <= bl; i = i + 1) begin
                at = (byte_addr - BUFFERS) / 8 + i;
                if (at >= 0 && at < WORDS)
                    memory[at] = pushed[tail];
                tail = tail + 8'd1;
            end
    end

    task write(input [5:0] slot, input [3:0] word, input [31:0] data); begin
        @(negedge clk) force dut.bus_addr = {slot, word};
        force dut.bus_write = 1'b1;
        force dut.bus_wdata = data;
        @(negedge clk) force dut.bus_valid = 1'b1;
        @(negedge clk) force dut.bus_valid = 1'b0;
    end endtask

    // Starts a fill as the generated servant does: MEMORY is word 5, the value word 6, CONTROL word 3.
    task fill(input [5:0] slot, input [31:0] base, input integer log2, input [7:0] value); begin
        write(slot, 4'd5, base >> log2);
        write(slot, 4'd6, {24'd0, value});
        write(slot, 4'd3, 32'd1);
    end endtask

    integer wrong = 0, w;
    task check(input [31:0] base, input integer log2, input [7:0] value);
        for (w = 0; w < 1 << log2; w = w + 8)
            if (memory[(base - BUFFERS + w) / 8] !== {8{value}}) begin
                if (wrong == 0)
                    $display("0x%08X holds %h, not %h", base + w, memory[(base - BUFFERS + w) / 8], {8{value}});
                wrong = wrong + 1;
            end
    endtask

    initial begin
        force dut.bus_valid = 1'b0;
        repeat (10) @(negedge clk);
        rst = 1'b0;
        repeat (10) @(negedge clk);
        fill(MAP_SLOT_BIG, MAP_MEMORY_BIG, 14, 8'h4C);
        fill(MAP_SLOT_MIDDLE, MAP_MEMORY_MIDDLE, 12, 8'h4D);
        fill(MAP_SLOT_LITTLE, MAP_MEMORY_LITTLE, 7, 8'h53);
        repeat (10000) @(negedge clk);
        check(MAP_MEMORY_BIG, 14, 8'h4C);
        check(MAP_MEMORY_MIDDLE, 12, 8'h4D);
        check(MAP_MEMORY_LITTLE, 7, 8'h53);
        if (wrong == 0)
            $display("each has its own memory");
        else
            $display("%0d words are another core's", wrong);
        $finish;
    end
endmodule
