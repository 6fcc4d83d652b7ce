// SPDX-License-Identifier: MIT
//
// sampled_mcb: flip-flops behind the inputs from the MCB (sim_soc.v). Include it in a module with
// clk_i and mcb_ports.vh.

    reg [63:0] rd_data;
    reg        cmd_full, wr_full, rd_empty, calib_done;
    always @(posedge clk_i) begin
        rd_data    <= mcb_rd_data_i;
        cmd_full   <= mcb_cmd_full_i;
        wr_full    <= mcb_wr_full_i;
        rd_empty   <= mcb_rd_empty_i;
        calib_done <= mcb_calib_done_i;
    end
