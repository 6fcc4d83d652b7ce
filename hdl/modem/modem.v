// SPDX-License-Identifier: MIT
//
// modem: XBee modem controller: AT set-up, packets from and to rings in DDR3, interrupts.
//
// Registers: hdl/modem/modem.regs.json. Behaviour: docs/modem.md.

`default_nettype none

module modem #(
    parameter CLK_HZ = 100000000 // Hz, a multiple of 1000
) (
    input  wire        clk_i,
    input  wire        rst_i,
    // register bus
    input  wire        bus_valid_i,
    input  wire        bus_write_i,
    input  wire [3:0]  bus_addr_i,
    input  wire [31:0] bus_wdata_i,
    output wire        bus_ready_o,
    output wire [31:0] bus_rdata_o,
    output wire        bus_error_o,
    output wire        irq_o,
    // memory port
    output wire [31:0] npi_addr_o,
    output wire        npi_addr_req_o,
    input  wire        npi_addr_ack_i,
    output wire        npi_rnw_o,
    output wire [3:0]  npi_size_o,
    output wire        npi_rmw_o,
    output wire [63:0] npi_wr_data_o,
    output wire [7:0]  npi_wr_be_o,
    output wire        npi_wr_push_o,
    input  wire        npi_wr_empty_i,
    input  wire        npi_wr_almost_full_i,
    output wire        npi_wr_flush_o,
    input  wire [63:0] npi_rd_data_i,
    input  wire [3:0]  npi_rd_word_i,
    output wire        npi_rd_pop_o,
    input  wire        npi_rd_empty_i,
    output wire        npi_rd_flush_o,
    input  wire        npi_init_done_i,
    // modem pins
    input  wire        modem_rxd_i, // from the modem
    output wire        modem_txd_o,
    input  wire        modem_cts_n_i,
    output wire        modem_rts_n_o,
    output wire        modem_reset_n_o
);
    `include "modem_regs.vh"

    localparam [31:0] MS_CLOCKS = CLK_HZ / 1000;

    wire        reg_write, reg_read;
    wire [3:0]  reg_addr;
    wire [31:0] reg_wdata;
    reg  [31:0] reg_rdata;

    reg         ready, reset_n, clear_pending;
    reg  [2:0]  bd;
    reg  [11:0] guard_ms;
    reg  [31:0] addresses;
    reg  [7:0]  channel;
    reg  [15:0] pan;
    reg  [31:7] tx_base, rx_base;
    reg  [7:0]  framing_errors, overruns, retries;
    reg  [1:0]  cts_sync;

    // Time
    reg  [16:0] ms_count;
    wire        ms_tick = ms_count == 17'd0;
    reg  [26:0] bit_phase;
    wire        bit_tick = bit_phase[26];
    wire [25:0] step;

    wire control   = reg_write && reg_addr == MODEM_CONTROL;
    wire configure = control && reg_wdata[MODEM_CONTROL_CONFIGURE_LSB];
    wire reset_modem = control && reg_wdata[MODEM_CONTROL_RESET_MODEM_LSB];

    // AT sequencer
    wire        at_busy, at_done, at_failed, at_retried, at_tx_valid;
    wire [3:0]  at_step;
    wire [2:0]  bd_now;
    wire [7:0]  at_tx_data;

    // UART
    wire        tx_ready, uart_valid, rx_valid, rx_error, rx_idle;
    wire [7:0]  uart_data, rx_data;

    // Packets
    wire        packet_tx_valid, tx_sent, rx_packet, rx_overrun, rx_get_valid, rx_hold;
    wire [7:0]  packet_tx_data;
    wire [4:0]  tx_free;
    wire [3:0]  tx_next, rx_get_buffer;
    wire [6:0]  rx_get_bytes;
    wire        put = reg_write && reg_addr == MODEM_TX_PUT;
    wire [7:0]  put_bytes = reg_wdata[7:0];
    wire        put_ok = put && ready && tx_free != 5'd0 && put_bytes != 8'd0 && put_bytes <= 8'd100;
    wire        release_ok = reg_write && reg_addr == MODEM_RX_RELEASE && rx_get_valid;
    wire        rings_reset = rst_i || reset_modem;

    wire        rd_req, rd_done, wr_req, wr_done;
    wire [31:0] rd_addr, wr_addr;
    wire [63:0] rd_data, wr_data;
    wire [7:0]  wr_be;

    assign modem_rts_n_o   = rx_hold;
    assign modem_reset_n_o = reset_n;
    assign uart_valid = at_busy ? at_tx_valid : packet_tx_valid;
    assign uart_data  = at_busy ? at_tx_data : packet_tx_data;
    assign npi_size_o = 4'd0;
    assign npi_rmw_o  = 1'b0;
    assign npi_wr_flush_o = 1'b0;
    assign npi_rd_flush_o = 1'b0;

    wire unused = &{1'b0, MS_CLOCKS[31:17], npi_wr_empty_i, npi_wr_almost_full_i, npi_rd_word_i, reg_read, 1'b0};

    bus_wrapper #(
        .ID_VALUE (MODEM_ID_VALUE),
        .WORDS    (16'h7FF8),
        .EVENTS   (6)
    ) u_wrapper (
        .clk_i(clk_i), .rst_i(rst_i),
        .bus_valid_i(bus_valid_i), .bus_write_i(bus_write_i), .bus_addr_i(bus_addr_i),
        .bus_wdata_i(bus_wdata_i), .bus_ready_o(bus_ready_o), .bus_rdata_o(bus_rdata_o),
        .bus_error_o(bus_error_o),
        .reg_write_o(reg_write), .reg_read_o(reg_read), .reg_addr_o(reg_addr),
        .reg_wdata_o(reg_wdata), .reg_rdata_i(reg_rdata),
        .event_i({put && !put_ok, rx_overrun, at_failed, at_done, rx_packet, tx_sent}),
        .irq_o(irq_o)
    );

    modem_baud #(.CLK_HZ(CLK_HZ)) u_baud (.bd_i(bd_now), .step_o(step));

    modem_uart_tx u_uart_tx (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(step),
        .valid_i(uart_valid), .data_i(uart_data), .ready_o(tx_ready), .txd_o(modem_txd_o)
    );

    modem_uart_rx u_uart_rx (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(step), .rxd_i(modem_rxd_i),
        .valid_o(rx_valid), .data_o(rx_data), .framing_error_o(rx_error), .idle_o(rx_idle)
    );

    modem_at u_at (
        .clk_i(clk_i), .rst_i(rst_i || reset_modem), .ms_tick_i(ms_tick),
        .start_i(configure && !at_busy && reset_n), .busy_o(at_busy), .done_o(at_done),
        .failed_o(at_failed), .retried_o(at_retried), .step_o(at_step), .bd_o(bd_now),
        .bd_i(bd), .guard_ms_i(guard_ms), .source_i(addresses[15:0]),
        .target_i(addresses[31:16]), .channel_i(channel), .pan_i(pan),
        .tx_valid_o(at_tx_valid), .tx_data_o(at_tx_data), .tx_ready_i(tx_ready),
        .rx_valid_i(rx_valid), .rx_data_i(rx_data)
    );

    modem_tx u_tx (
        .clk_i(clk_i), .rst_i(rings_reset), .enable_i(ready), .bit_tick_i(bit_tick),
        .base_i({tx_base, 7'd0}),
        .put_i(put_ok), .put_bytes_i(put_bytes[6:0]), .free_o(tx_free), .next_o(tx_next),
        .sent_o(tx_sent),
        .rd_req_o(rd_req), .rd_addr_o(rd_addr), .rd_done_i(rd_done), .rd_data_i(rd_data),
        .tx_valid_o(packet_tx_valid), .tx_data_o(packet_tx_data), .tx_ready_i(tx_ready),
        .cts_i(cts_sync[1])
    );

    modem_rx u_rx (
        .clk_i(clk_i), .rst_i(rings_reset), .bit_tick_i(bit_tick), .base_i({rx_base, 7'd0}),
        .rx_valid_i(rx_valid && ready), .rx_data_i(rx_data), .rx_error_i(rx_error && ready),
        .rx_idle_i(rx_idle),
        .wr_req_o(wr_req), .wr_addr_o(wr_addr), .wr_data_o(wr_data), .wr_be_o(wr_be),
        .wr_done_i(wr_done),
        .packet_valid_o(rx_get_valid), .packet_bytes_o(rx_get_bytes),
        .packet_buffer_o(rx_get_buffer), .release_i(release_ok), .packet_o(rx_packet),
        .overrun_o(rx_overrun), .almost_full_o(rx_hold)
    );

    modem_dma u_dma (
        .clk_i(clk_i), .rst_i(rst_i),
        .rd_req_i(rd_req), .rd_addr_i(rd_addr), .rd_done_o(rd_done), .rd_data_o(rd_data),
        .wr_req_i(wr_req), .wr_addr_i(wr_addr), .wr_data_i(wr_data), .wr_be_i(wr_be),
        .wr_done_o(wr_done),
        .npi_addr_o(npi_addr_o), .npi_addr_req_o(npi_addr_req_o),
        .npi_addr_ack_i(npi_addr_ack_i), .npi_rnw_o(npi_rnw_o),
        .npi_wr_data_o(npi_wr_data_o), .npi_wr_be_o(npi_wr_be_o),
        .npi_wr_push_o(npi_wr_push_o), .npi_rd_pop_o(npi_rd_pop_o),
        .npi_rd_data_i(npi_rd_data_i), .npi_rd_empty_i(npi_rd_empty_i),
        .npi_init_done_i(npi_init_done_i)
    );

    always @* begin
        case (reg_addr)
            MODEM_STATUS:   reg_rdata = {17'd0, bd_now, at_step, 4'd0, cts_sync[1],
                                         tx_free != 5'd16, at_busy || !reset_n, ready};
            MODEM_BAUD:     reg_rdata = {4'd0, guard_ms, 13'd0, bd};
            MODEM_ADDR:     reg_rdata = addresses;
            MODEM_NET:      reg_rdata = {pan, 8'd0, channel};
            MODEM_TX_BASE:  reg_rdata = {tx_base, 7'd0};
            MODEM_RX_BASE:  reg_rdata = {rx_base, 7'd0};
            MODEM_TX_STATE: reg_rdata = {20'd0, tx_next, 3'd0, tx_free};
            MODEM_RX_GET:   reg_rdata = {rx_get_valid, 19'd0, rx_get_buffer, 1'b0, rx_get_bytes};
            MODEM_ERRORS:   reg_rdata = {8'd0, retries, overruns, framing_errors};
            default:        reg_rdata = 32'd0;
        endcase
    end

    always @(posedge clk_i) begin
        ms_count  <= ms_tick ? MS_CLOCKS[16:0] - 17'd1 : ms_count - 17'd1;
        bit_phase <= {1'b0, bit_phase[25:0]} + {1'b0, step};
        cts_sync  <= {cts_sync[0], !modem_cts_n_i};

        if (reg_write)
            case (reg_addr)
                MODEM_BAUD: begin
                    bd       <= reg_wdata[2:0];
                    guard_ms <= reg_wdata[27:16];
                end
                MODEM_ADDR:    addresses <= reg_wdata;
                MODEM_NET: begin
                    channel <= reg_wdata[7:0];
                    pan     <= reg_wdata[31:16];
                end
                MODEM_TX_BASE: tx_base <= reg_wdata[31:7];
                MODEM_RX_BASE: rx_base <= reg_wdata[31:7];
                default: ;
            endcase

        if (configure)
            ready <= 1'b0;
        if (at_done)
            ready <= 1'b1;

        // The pulse lasts from one to two milliseconds; the modem asks for 200 ns.
        if (ms_tick) begin
            clear_pending <= reset_n;
            if (!clear_pending)
                reset_n <= 1'b1;
        end

        if (rx_error && ready && framing_errors != 8'hFF)
            framing_errors <= framing_errors + 8'd1;
        if (rx_overrun && overruns != 8'hFF)
            overruns <= overruns + 8'd1;
        if (at_retried && retries != 8'hFF)
            retries <= retries + 8'd1;

        if (reset_modem) begin
            ready         <= 1'b0;
            reset_n       <= 1'b0;
            clear_pending <= 1'b1;
        end
        if (rst_i || reset_modem) begin
            framing_errors <= 8'd0;
            overruns       <= 8'd0;
            retries        <= 8'd0;
        end
        if (rst_i) begin
            ms_count  <= 17'd0;
            bit_phase <= 27'd0;
            cts_sync  <= 2'b00;
            ready     <= 1'b0;
            reset_n   <= 1'b1;
            clear_pending <= 1'b0;
            bd        <= 3'd7;
            guard_ms  <= 12'd1000;
            addresses <= 32'd0;
            channel   <= 8'h0C;
            pan       <= 16'h3332;
            tx_base   <= 25'd0;
            rx_base   <= 25'd0;
        end
    end
endmodule
