// SPDX-License-Identifier: MIT
//
// modem: controls an XBee modem: sets it up with AT commands, sends packets from a ring in DDR3,
// stores received packets in another ring, and raises interrupts.
//
// The registers are described in hdl/modem/modem.regs.json, the behaviour in docs/modem.md.

`default_nettype none

module modem #(
    parameter CLK_HZ = 100000000, // frequency of clk_i in Hz, a multiple of 16000, at least 2 MHz
    // 1: software may select API frames (NET.API); 0: the modem is always in transparent mode
    parameter API    = 0
) (
    `include "slot_ports.vh"
    `include "memory_ports.vh"
    output wire        irq_o,
    // modem pins
    input  wire        modem_rxd_i, // pins of the modem
    output wire        modem_txd_o,
    input  wire        modem_cts_n_i,
    output wire        modem_rts_n_o,
    output wire        modem_reset_n_o
);
    `include "modem_regs.vh"

    // A bus access is answered one cycle later, so that no long path begins in the address
    // decoder of the bus.
    reg         turn;
    wire        set_configure, set_reset_modem, baud_write, net_write, settings_write;
    // Commands, one cycle after they are written; registers, because the paths from here are long.
    reg         configure, reset_modem, rings_reset;

    // Block RAM with the settings. Words 0..15 are the registers, including the ID; words 28..31
    // are the key. A word is available one clock after its index. If a processor access has set the
    // index, the word is not valid for other uses, because the processor may have written it in
    // that clock.
    (* ram_style = "block", no_rw_check *)
    reg  [31:0] words [0:31];
    reg  [1:0]  key_index;
    wire        key_write;
    wire [4:0]  at_word;
    wire [4:0]  ring_word;
    wire        at_busy;
    wire [4:0]  word_index = bus_valid_i ? {1'b0, bus_addr_i} :
                             at_word | (at_busy ? 5'd0 : ring_word);
    reg  [31:0] word;
    reg  [4:0]  word_at;
    reg         word_valid;
    always @(posedge clk_i) begin
        word       <= words[word_index];
        word_at    <= word_index;
        word_valid <= !bus_valid_i;
    end

    // Time
    wire        ms_tick, at_clear;
    wire [11:0] waited;
    wire        bit_tick; // eight ticks per bit time
    wire [3:0]  bd_now;

    reg         ready, reset_n, pulse_ends, encrypt, by_wire, frames;
    wire        api = API != 0 && frames;
    reg  [7:0]  framing_errors, overruns, retries;
    // events that have not been counted yet; one is counted per clock
    reg         framing_waits, retry_waits;
    wire        counts_retry = retry_waits && !rx_overrun;
    wire        counts_framing = framing_waits && !rx_overrun && !retry_waits;
    wire [8:0]  counted = {1'b0, rx_overrun  ? overruns :
                                 retry_waits ? retries : framing_errors} + 9'd1;
    wire        cts_n_sync;
    wire        cts = !cts_n_sync;
    cdc_bit #(.INITIAL(1'b1)) u_cts (
        .clk_i(clk_i), .bit_async_i(modem_cts_n_i), .bit_sync_o(cts_n_sync)
    );

    // AT sequencer
    wire        at_done, at_failed, at_retried, at_tx_valid;
    wire [3:0]  at_step;
    wire [7:0]  at_tx_data;

    // UART
    wire        tx_ready, uart_valid, rx_valid, rx_error, rx_idle;
    wire [7:0]  uart_data, rx_data;

    // Rings and packet blocks
    wire        packet_tx_valid, tx_sent, rx_push, rx_overrun;
    wire [7:0]  packet_tx_data;
    // Bytes between the packet blocks and the blocks for API frames. In transparent mode these
    // bytes come from the UART, and go to the UART.
    wire        body_valid, body_last, body_ready, in_valid, in_error, in_end, in_bad, silent;
    wire [7:0]  body_data;
    wire [4:0]  tx_free, rx_free;
    wire [3:0]  tx_next, tx_buffer, rx_next, rx_buffer;
    wire [6:0]  tx_bytes, rx_bytes;
    wire        tx_waits = !tx_free[4];
    wire        rx_waits = !rx_free[4];
    // High one clock after the ring has become full. This is early enough, because a waiting byte
    // is taken only two clocks after the end of a packet (`writes`). rx_full is a register, because
    // the path from it to the index of the settings word is long.
    reg         rx_full;
    // RTS is a flip-flop, because the modem may sample the pin at any time, and the output of a LUT
    // may glitch
    reg         rts_n;
    wire [7:0]  put_bytes;
    wire        put, rx_release;
    wire        put_ok   = put && ready && tx_free != 5'd0 && put_bytes != 8'd0 &&
                           put_bytes <= (api ? 8'd105 : 8'd100);
    wire        release_ok = rx_release && rx_waits;

    // Memory
    wire        rd_valid, rd_done, wr_valid, wr_ready, wr_busy;
    wire [6:0]  rd_index, wr_index;
    wire [7:0]  rd_data, wr_data, wr_be;

    assign bus_ready_o     = turn;
    assign modem_rts_n_o   = rts_n;
    assign modem_reset_n_o = reset_n;
    // at_tx_valid and packet_tx_valid are never both high: no packet is sent while the set-up runs.
    assign uart_valid = at_tx_valid || packet_tx_valid;
    assign uart_data  = at_tx_data | packet_tx_data;
    // `writes` selects the base address of the receive ring (1) or of the transmit ring (0) in the
    // settings. It is a register, because the index of the setting is on a long path. After a
    // change of ring, a memory access waits for one clock.
    reg writes;
    always @(posedge clk_i)
        writes <= wr_valid;
    assign ring_word  = writes ? {1'b0, MODEM_RX_BASE} : {1'b0, MODEM_TX_BASE};
    assign npi_size_o = 4'd0;
    assign npi_rmw_o  = 1'b0;
    assign npi_wr_flush_o = 1'b0;
    assign npi_rd_flush_o = 1'b0;

    wire unused_ready; // always 1
    wire unused = &{1'b0, npi_wr_empty_i, npi_wr_almost_full_i, npi_rd_word_i, unused_ready, 1'b0};

    modem_regs u_registers (
        .clk_i(clk_i), .rst_i(rst_i),
        .bus_valid_i(turn), .bus_write_i(bus_write_i), .bus_addr_i(bus_addr_i),
        .bus_wdata_i(bus_wdata_i), .bus_ready_o(unused_ready), .bus_rdata_o(bus_rdata_o),
        .bus_error_o(bus_error_o), .irq_o(irq_o),
        .tx_done_event_i(tx_sent), .rx_packet_event_i(rx_push), .configured_event_i(at_done),
        .configure_failed_event_i(at_failed), .rx_overrun_event_i(rx_overrun),
        .tx_refused_event_i(put && !put_ok),
        .status_api_i(API != 0),
        .status_ready_i(ready), .status_busy_i(at_busy || !reset_n), .status_tx_active_i(tx_waits),
        .status_cts_i(cts), .status_step_i(at_step), .status_bd_i(bd_now),
        .control_configure_o(set_configure), .control_reset_modem_o(set_reset_modem),
        .baud_write_o(baud_write), .net_write_o(net_write), .key_write_o(key_write),
        .tx_put_write_o(put), .tx_put_bytes_o(put_bytes), .rx_release_write_o(rx_release),
        .tx_state_free_i({3'd0, tx_free}), .tx_state_next_i({4'd0, tx_next}),
        .rx_get_bytes_i({1'b0, rx_bytes}), .rx_get_buffer_i({4'd0, rx_buffer}),
        .rx_get_valid_i(rx_waits),
        .errors_framing_i(framing_errors), .errors_overrun_i(overruns), .errors_retries_i(retries),
        .memory_write_o(settings_write), .memory_i(word)
    );

    modem_baud #(.CLK_HZ(CLK_HZ)) u_baud (
        .clk_i(clk_i), .rst_i(rst_i), .bd_i(bd_now), .tick_o(bit_tick)
    );

    modem_timer #(.CLK_HZ(CLK_HZ)) u_timer (
        .clk_i(clk_i), .rst_i(rst_i), .clear_i(at_clear),
        .tick_o(ms_tick), .time_o(waited)
    );

    modem_uart_tx u_uart_tx (
        .clk_i(clk_i), .rst_i(rst_i), .tick_i(bit_tick),
        .valid_i(uart_valid), .data_i(uart_data), .ready_o(tx_ready), .txd_o(modem_txd_o)
    );

    modem_uart_rx u_uart_rx (
        .clk_i(clk_i), .rst_i(rst_i), .tick_i(bit_tick), .rxd_i(modem_rxd_i),
        .valid_o(rx_valid), .data_o(rx_data), .framing_error_o(rx_error), .idle_o(rx_idle)
    );

    modem_at #(.API(API)) u_at (
        .clk_i(clk_i), .rst_i(rings_reset), .clear_o(at_clear), .time_i(waited),
        .start_i(configure && reset_n), .wire_i(by_wire), .busy_o(at_busy), .done_o(at_done),
        .failed_o(at_failed), .retried_o(at_retried), .step_o(at_step), .bd_o(bd_now),
        .word_o(at_word), .word_i(word), .word_valid_i(word_valid && word_at == at_word),
        .tx_valid_o(at_tx_valid), .tx_data_o(at_tx_data), .tx_ready_i(tx_ready),
        .rx_valid_i(rx_valid), .rx_data_i(rx_data)
    );

    modem_ring u_tx_ring (
        .clk_i(clk_i), .rst_i(rings_reset), .push_i(put_ok), .bytes_i(put_bytes[6:0]),
        .pop_i(tx_sent), .next_o(tx_next), .oldest_o(tx_buffer), .bytes_o(tx_bytes),
        .free_o(tx_free)
    );

    modem_ring u_rx_ring (
        .clk_i(clk_i), .rst_i(rings_reset), .push_i(rx_push), .bytes_i(wr_index),
        .pop_i(release_ok), .next_o(rx_next), .oldest_o(rx_buffer), .bytes_o(rx_bytes),
        .free_o(rx_free)
    );

    generate
        if (API != 0) begin : g_api
            wire frame_valid, frame_bad;

            modem_api_tx u_api_tx (
                .clk_i(clk_i), .rst_i(rings_reset || configure), .api_i(api),
                .valid_i(body_valid), .data_i(body_data), .last_i(body_last),
                .bytes_i(tx_bytes), .ready_o(body_ready), .cts_i(cts),
                .valid_o(packet_tx_valid), .data_o(packet_tx_data), .ready_i(tx_ready)
            );
            modem_api_rx u_api_rx (
                .clk_i(clk_i), .rst_i(rst_i || !ready || !api),
                .valid_i(rx_valid), .data_i(rx_data), .error_i(rx_error), .silent_i(silent),
                .valid_o(frame_valid), .end_o(in_end), .bad_o(frame_bad)
            );
            assign in_valid = api ? frame_valid : rx_valid && ready;
            // the set-up of the modem aborts the frame in progress
            assign in_bad   = frame_bad || (api && !ready);
        end else begin : g_transparent
            assign packet_tx_valid = body_valid;
            assign packet_tx_data  = body_data;
            assign body_ready      = tx_ready;
            assign in_valid        = rx_valid && ready;
            assign in_end          = 1'b0;
            assign in_bad          = 1'b0;
            wire unused_api = &{1'b0, body_last, silent, 1'b0};
        end
    endgenerate
    assign in_error = rx_error && ready && !api;

    modem_tx u_tx (
        .clk_i(clk_i), .rst_i(rings_reset), .enable_i(ready), .encrypt_i(encrypt), .api_i(api),
        .packet_valid_i(tx_waits), .packet_bytes_i(tx_bytes), .sent_o(tx_sent),
        .rd_valid_o(rd_valid), .rd_index_o(rd_index), .rd_done_i(rd_done), .rd_data_i(rd_data),
        .tx_valid_o(body_valid), .tx_data_o(body_data), .tx_ready_i(body_ready),
        .tx_last_o(body_last), .cts_i(cts)
    );

    modem_rx u_rx (
        .clk_i(clk_i), .rst_i(rings_reset), .tick_i(bit_tick), .api_i(api),
        .rx_valid_i(in_valid), .rx_data_i(rx_data), .rx_error_i(in_error),
        .rx_end_i(in_end), .rx_bad_i(in_bad), .silent_o(silent),
        .rx_idle_i(rx_idle && !modem_rts_n_o), // a pause that RTS causes does not end a packet
        .wr_valid_o(wr_valid), .wr_data_o(wr_data), .wr_index_o(wr_index), .wr_be_o(wr_be),
        .wr_ready_i(wr_ready), .wr_busy_i(wr_busy),
        .full_i(rx_full), .push_o(rx_push), .overrun_o(rx_overrun)
    );

    modem_npi u_npi (
        .clk_i(clk_i), .rst_i(rst_i),
        .base_i(word[31:11]),
        .base_valid_i(word_valid && word_at == ring_word && writes == wr_valid),
        .wr_valid_i(wr_valid), .wr_addr_i({rx_next, wr_index[6:3]}),
        .wr_be_i(wr_be), .wr_data_i(wr_data), .wr_ready_o(wr_ready), .wr_busy_o(wr_busy),
        .rd_valid_i(rd_valid), .rd_addr_i({tx_buffer, rd_index}),
        .rd_done_o(rd_done), .rd_data_o(rd_data),
        .npi_addr_o(npi_addr_o), .npi_addr_req_o(npi_addr_req_o),
        .npi_addr_ack_i(npi_addr_ack_i), .npi_rnw_o(npi_rnw_o),
        .npi_wr_data_o(npi_wr_data_o), .npi_wr_be_o(npi_wr_be_o),
        .npi_wr_push_o(npi_wr_push_o), .npi_rd_pop_o(npi_rd_pop_o),
        .npi_rd_data_i(npi_rd_data_i), .npi_rd_empty_i(npi_rd_empty_i),
        .npi_init_done_i(npi_init_done_i)
    );

    integer w;
    initial
        for (w = 0; w < 32; w = w + 1)
            words[w] = w == 0 ? MODEM_ID_VALUE : 32'd0;

    always @(posedge clk_i) begin
        turn       <= bus_valid_i && !turn && !rst_i;

        configure   <= set_configure && !rst_i;
        reset_modem <= set_reset_modem && !rst_i;
        rings_reset <= set_reset_modem || rst_i;
        rx_full  <= rx_free == 5'd0;
        rts_n    <= rx_free <= 5'd2;

        if (key_write || settings_write)
            words[{key_write, bus_addr_i[3:2], key_write ? key_index : bus_addr_i[1:0]}] <=
                bus_wdata_i;
        key_index <= key_index + {1'b0, key_write};
        if (net_write) begin
            encrypt <= bus_wdata_i[MODEM_NET_ENCRYPT_LSB];
            frames  <= bus_wdata_i[MODEM_NET_API_LSB];
        end
        if (baud_write)
            by_wire <= bus_wdata_i[MODEM_BAUD_WIRE_LSB];

        if (at_done)
            ready <= 1'b1;

        // The reset pulse lasts one to two milliseconds. The modem needs 200 ns.
        if (ms_tick) begin
            pulse_ends <= !reset_n;
            if (pulse_ends)
                reset_n <= 1'b1;
        end

        framing_waits <= (rx_error && ready) || (framing_waits && !counts_framing);
        retry_waits   <= at_retried || (retry_waits && !counts_retry);
        if (!counted[8] && rx_overrun)
            overruns <= counted[7:0];
        if (!counted[8] && counts_retry)
            retries <= counted[7:0];
        if (!counted[8] && counts_framing)
            framing_errors <= counted[7:0];

        if (configure || reset_modem) begin
            ready     <= 1'b0;
            key_index <= 2'd0;
        end
        if (reset_modem) begin
            reset_n    <= 1'b0;
            pulse_ends <= 1'b0;
        end
        if (rings_reset) begin
            framing_waits  <= 1'b0;
            retry_waits    <= 1'b0;
            framing_errors <= 8'd0;
            overruns       <= 8'd0;
            retries        <= 8'd0;
        end
        if (rst_i) begin
            ready      <= 1'b0;
            reset_n    <= 1'b1;
            pulse_ends <= 1'b0;
            key_index  <= 2'd0;
        end
    end
`ifdef COVER_POINTS
    put_refused: cover property (@(posedge clk_i) put && !put_ok);
    all_to_send: cover property (@(posedge clk_i) tx_free == 5'd0);
    all_received: cover property (@(posedge clk_i) rx_free == 5'd0);
    sends_and_receives: cover property (@(posedge clk_i) rd_valid && wr_valid);
    set_up_again_while_packets_wait: cover property (@(posedge clk_i) configure && tx_waits);
`endif
endmodule
