// SPDX-License-Identifier: MIT
//
// npi_arbiter_proof: connects npi_arbiter_proof.v with the state of the arbiter's parts, for two
// ports.
// Included at the foot of npi_arbiter.v, only for the prover.

    localparam F_KIND = PORT_BITS + 4, F_ADDR = ADDR_WIDTH - 3, F_INDEXES = 2 * (FIFO_LOG2 + 1);
    (* hierconn *) wire [PORTS-1:0]                 \u_select.f_later ;
    (* hierconn *) wire [(F_KIND<<QUEUE_LOG2)-1:0]  \u_queue.f_kinds ;
    (* hierconn *) wire [(F_ADDR<<QUEUE_LOG2)-1:0]  \u_queue.f_addrs ;
    (* hierconn *) wire [4*QUEUE_LOG2-1:0]          \u_queue.f_places ;
    (* hierconn *) wire [4:0]                       \u_queue.f_moved ;
    (* hierconn *) wire [F_KIND:0]                  \u_queue.f_moving ;
    (* hierconn *) wire [(72<<FIFO_LOG2)-1:0]       \g_port[0].u_write.f_words , \g_port[1].u_write.f_words ;
    (* hierconn *) wire [F_INDEXES-1:0]             \g_port[0].u_write.f_indexes , \g_port[1].u_write.f_indexes ;
    (* hierconn *) wire [(68<<FIFO_LOG2)-1:0]       \g_port[0].g_fifo.u_read.f_words , \g_port[1].g_fifo.u_read.f_words ;
    (* hierconn *) wire [F_INDEXES-1:0]             \g_port[0].g_fifo.u_read.f_indexes , \g_port[1].g_fifo.u_read.f_indexes ;

    npi_arbiter_proof #(
        .PORTS(PORTS), .READ_FIFO(READ_FIFO), .BLOCK(BLOCK_RAM), .PORT_BITS(PORT_BITS),
        .ADDR_BITS(ADDR_WIDTH - 3), .FIFO_LOG2(FIFO_LOG2), .QUEUE_LOG2(QUEUE_LOG2)
    ) u_proof (
        .clk_i(clk_i), .rst_i(rst_i),
        .addr_i(npi_addr_i), .req_i(npi_addr_req_i), .ack_i(npi_addr_ack_o), .grant_i(grant),
        .rnw_i(npi_rnw_i), .size_i(npi_size_i), .wr_data_i(npi_wr_data_i), .wr_be_i(npi_wr_be_i),
        .wr_push_i(npi_wr_push_i), .wr_empty_i(npi_wr_empty_o), .wr_full_i(npi_wr_almost_full_o),
        .wr_flush_i(npi_wr_flush_i), .rd_data_i(npi_rd_data_o), .rd_word_i(npi_rd_word_o),
        .rd_pop_i(npi_rd_pop_i), .rd_empty_i(npi_rd_empty_o), .rd_flush_i(npi_rd_flush_i),
        .cmd_valid_i(cmd_valid_o), .cmd_read_i(cmd_read_o), .cmd_addr_i(cmd_word),
        .cmd_last_i(cmd_last_o), .cmd_ready_i(cmd_ready_i),
        .wr_valid_i(wr_valid_o), .out_data_i(wr_data_o), .out_be_i(wr_be_o), .wr_ready_i(wr_ready_i),
        .in_valid_i(rd_valid_i), .in_data_i(rd_data_i), .in_ready_i(rd_ready_o),
        .moving_i(\u_queue.f_moving ), .move_at_i(move_at), .later_i(\u_select.f_later ), .full_i(full),
        .wr_pop_i(move_at[PORTS-1:0] & {PORTS{wr_valid_o && wr_ready_i}}), .wr_heads_i(wr_datas), .wr_head_bes_i(wr_bes),
        .rd_push_i(back_at & {PORTS{rd_valid_i}} & back_free),
        .wr_indexes_i({\g_port[1].u_write.f_indexes , \g_port[0].u_write.f_indexes }),
        .rd_indexes_i({\g_port[1].g_fifo.u_read.f_indexes , \g_port[0].g_fifo.u_read.f_indexes }),
        .wr_words_i({\g_port[1].u_write.f_words , \g_port[0].u_write.f_words }),
        .rd_words_i({\g_port[1].g_fifo.u_read.f_words , \g_port[0].g_fifo.u_read.f_words }),
        .kinds_i(\u_queue.f_kinds ), .addrs_i(\u_queue.f_addrs ), .places_i(\u_queue.f_places ), .moved_i(\u_queue.f_moved ), .came_i(back_index)
    );
