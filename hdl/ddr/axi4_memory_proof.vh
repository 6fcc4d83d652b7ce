// SPDX-License-Identifier: MIT
//
// axi4_memory_proof: each address is one descriptor of its words and its id; what is refused is said and writes nothing.
// Included at the foot of axi4_memory.v, only for the prover, beside axis_memory, which has its own.

    reg       past = 1'b0;
    // The write under way: its address was taken, its last beat not yet, as axis_memory has one at a time.
    reg       f_bad;
    (* hierconn *) wire [11:0]          \u_memory.read_bytes_i ;
    (* hierconn *) wire [11:0]          \u_memory.write_bytes_i ;
    (* hierconn *) wire [ADDR_BITS-1:0] \u_memory.read_base_i ;
    (* hierconn *) wire [ADDR_BITS-1:0] \u_memory.write_base_i ;
    (* hierconn *) wire [ID_BITS:0]     \u_memory.read_tag_i ;
    (* hierconn *) wire [ID_BITS:0]     \u_memory.write_tag_i ;
    (* hierconn *) wire [ID_BITS:0]     \u_memory.m_axis_tid_o ;
    (* hierconn *) wire [ID_BITS:0]     \u_memory.done_tag_o ;
    (* hierconn *) wire                 \u_memory.done_over_o ;
    (* hierconn *) wire [7:0]           \u_memory.s_axis_tkeep_i ;
    initial assume (rst_i);
    always @(posedge clk_i) begin
        past <= 1'b1;
        if (awvalid_i && awready_o)
            f_bad <= awlen_i > 8'd0 && !(awburst_i == 2'd1 && awsize_i == 3'd3);
        if (past && $past(awvalid_i && awready_o))
            assert (refusing == f_bad);
    end
    always @* begin
        assert (\u_memory.read_bytes_i == 12'd8 * ({4'd0, arlen_i} + 12'd1) && \u_memory.read_base_i == araddr_i);
        assert (\u_memory.write_bytes_i == 12'd8 * ({4'd0, awlen_i} + 12'd1) && \u_memory.write_base_i == awaddr_i);
        assert (\u_memory.read_tag_i [ID_BITS-1:0] == arid_i && \u_memory.write_tag_i [ID_BITS-1:0] == awid_i);
        assert (\u_memory.read_tag_i [ID_BITS] == (arlen_i > 8'd0 && !(arburst_i == 2'd1 && arsize_i == 3'd3)));
        assert (\u_memory.write_tag_i [ID_BITS] == (awlen_i > 8'd0 && !(awburst_i == 2'd1 && awsize_i == 3'd3)));
        assert (\u_memory.s_axis_tkeep_i == (refusing ? 8'd0 : wstrb_i));
        assert (rid_o == \u_memory.m_axis_tid_o [ID_BITS-1:0] && bid_o == \u_memory.done_tag_o [ID_BITS-1:0]);
        assert (rresp_o == (\u_memory.m_axis_tid_o [ID_BITS] ? 2'd2 : 2'd0));
        assert (bresp_o == (\u_memory.done_tag_o [ID_BITS] || \u_memory.done_over_o ? 2'd2 : 2'd0));
        cover (past && refusing && wvalid_i && wready_o);
    end
