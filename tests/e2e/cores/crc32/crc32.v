// SPDX-License-Identifier: MIT
//
// crc32: computes the CRC-32 (as in zlib and Ethernet) of a buffer in DDR3, one byte per clock.

`default_nettype none

module crc32 (
    `include "slot_ports.vh"
    `include "memory_ports.vh"
    // interrupt
    output wire irq_o
);
    wire        core_rst, start;
    wire [31:0] base;
    wire [12:0] count;
    reg         busy, begun;
    reg  [12:0] left;  // bytes left
    reg  [2:0]  place; // index of the next byte in its word
    reg  [31:0] crc;
    wire        read_valid, read_idle;
    wire [63:0] read_data;
    // waits for read_idle, because a transfer of an aborted call may still be in progress
    wire        go   = busy && !begun && read_idle;
    wire        take = begun && read_valid;
    wire        done = begun && left == 13'd0;

    crc32_wrapper u_wrapper (
        `include "slot_connect.vh"
        .irq_o(irq_o), .core_rst_o(core_rst),
        .crc_start_o(start), .crc_data_base_o(base), .crc_data_count_o(count),
        .crc_result_i(~crc), .crc_done_i(done), .crc_refused_i(1'b0)
    );

    wire write_ready, write_idle;
    npi_stream u_stream (
        `include "memory_connect.vh"
        // rst_i instead of core_rst: requested words must be received even after a reset of the
        // core
        .clk_i(clk_i), .rst_i(rst_i),
        .read_start_i(go && !core_rst), .read_base_i(base[31:6]),
        .read_words_i({14'd0, left[12:3]} + {23'd0, |left[2:0]}), .read_stop_i(core_rst),
        .read_valid_o(read_valid), .read_data_o(read_data),
        .read_take_i(take && (place == 3'd7 || left == 13'd1)), .read_idle_o(read_idle),
        .write_start_i(1'b0), .write_base_i(26'd0), .write_valid_i(1'b0), .write_data_i(64'd0),
        .write_be_i(8'd0), .write_ready_o(write_ready), .write_flush_i(1'b0),
        .write_idle_o(write_idle));

    // Returns the CRC of a message that ends with the byte `value`; `old` is the CRC of the bytes
    // before it.
    function [31:0] with_byte(input [31:0] old, input [7:0] value);
        integer i;
        begin
            with_byte = old ^ {24'd0, value};
            for (i = 0; i < 8; i = i + 1)
                with_byte = with_byte >> 1 ^ (with_byte[0] ? 32'hEDB88320 : 32'd0);
        end
    endfunction

    always @(posedge clk_i) begin
        if (start) begin
            busy  <= 1'b1;
            left  <= count;
            place <= 3'd0;
            crc   <= 32'hFFFFFFFF;
        end
        if (go)
            begun <= 1'b1;
        if (take && !done) begin
            crc   <= with_byte(crc, read_data[8*place +: 8]);
            place <= place + 3'd1;
            left  <= left - 13'd1;
        end
        if (done || rst_i || core_rst) begin
            busy  <= 1'b0;
            begun <= 1'b0;
        end
    end

    wire unused = &{1'b0, base[5:0], write_ready, write_idle, 1'b0};
endmodule
