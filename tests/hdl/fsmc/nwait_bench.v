// SPDX-License-Identifier: MIT
//
// nwait_bench: runs the netlist of fsmc_bridge with random routing delays, and reports each time
// that NWAIT becomes active while the pins are stable.
//
// An FSMC in mode 1 reads and writes memory and registers at random and obeys NWAIT. Memory and
// slave answer after random times. nwait_test.py replaces the netlist's LUTs by delay_lut.

`timescale 1ps / 1ps

// A LUT of 0.2 ns; each input has a separate routing delay of 0.1 to 1.4 ns.
module delay_lut #(
    parameter NUMBER = 0, // number of this LUT, which selects its delays
    parameter [63:0] INIT = 0
) (
    input  wire I0, I1, I2, I3, I4, I5,
    output reg  O
);
    wire [5:0] i = {I5, I4, I3, I2, I1, I0};
    integer routes [0:5];
    integer seed, k;
    reg [5:0] arrived = 6'd0;
    wire value = INIT[arrived];
    initial begin
        if (!$value$plusargs("seed=%d", seed))
            seed = 1;
        seed = seed * 100003 + NUMBER;
        for (k = 0; k < 6; k = k + 1)
            routes[k] = 100 + $unsigned($random(seed)) % 1300;
        #1 arrived = i; // inputs that never change
        #1 O = value;
    end
    genvar p;
    generate
        for (p = 0; p < 6; p = p + 1) begin : g_pin
            always @(i[p]) arrived[p] <= #(routes[p]) i[p];
        end
    endgenerate
    always @(value) O <= #200 value;
endmodule

module nwait_bench;
    localparam HCLK = 8333, SETTLED = 14000; // ps

    reg         clk = 1'b0, rst = 1'b1;
    reg  [24:0] a = 25'd0;
    reg  [15:0] d = 16'd0;
    reg  [1:0]  ne_n = 2'b11, nbl_n = 2'b00;
    reg         noe_n = 1'b1, nwe_n = 1'b1;
    wire [15:0] q;
    wire        nwait_n, late;
    always #5000 clk = !clk;

    // ---- Memory: words in order; requests and answers after random times
    wire [31:0] npi_addr;
    wire        npi_req, npi_rnw, npi_push, npi_pop;
    wire [3:0]  npi_size;
    wire [63:0] npi_data;
    wire [7:0]  npi_be;
    reg         npi_ack = 1'b0, npi_empty = 1'b1;
    reg  [63:0] npi_answer = 64'd0;
    reg  [71:0] pushed [0:63]; // write FIFO; pushed[tail] is the word that it collects
    reg  [63:0] memory [0:1023];
    integer head = 0, tail = 0, to_come = 0, from = 0, rests = 0, seed, b;
    always @(posedge clk) begin
        if (npi_push) begin
            tail = tail + 1;
            pushed[tail % 64][71:64] = 8'd0;
        end
        for (b = 0; b < 8; b = b + 1)
            if (npi_be[b]) begin
                pushed[tail % 64][64+b]    = 1'b1;
                pushed[tail % 64][8*b +: 8] = npi_data[8*b +: 8];
            end
        if (npi_req && npi_ack) begin
            if (npi_rnw) begin
                to_come = 1 << npi_size;
                from    = npi_addr[12:3];
            end else begin
                for (b = 0; b < 8; b = b + 1)
                    if (pushed[head % 64][64+b])
                        memory[npi_addr[12:3]][8*b +: 8] = pushed[head % 64][8*b +: 8];
                head = head + 1;
            end
        end
        npi_empty <= #1000 1'b1;
        npi_ack   <= #1000 npi_req && !npi_ack && rests == 0;
        if (rests != 0)
            rests = rests - 1;
        else if (to_come != 0) begin
            npi_empty  <= #1000 1'b0;
            npi_answer <= #1000 memory[from];
            from    = (from + 1) % 1024;
            to_come = to_come - 1;
        end
        if (npi_req && npi_ack)
            rests = $unsigned($random(seed)) % 24;
    end

    // ---- Slave
    wire        bus_valid, bus_write;
    wire [9:0]  bus_addr;
    wire [31:0] bus_wdata;
    reg         bus_ready = 1'b0;
    reg  [31:0] registers [0:15];
    always @(posedge clk) begin
        bus_ready <= #1000 bus_valid && !bus_ready && $unsigned($random(seed)) % 4 == 0;
        if (bus_valid && bus_ready && bus_write)
            registers[bus_addr[3:0]] = bus_wdata;
    end

    fsmc_bridge u_fsmc_bridge (
        .clk_i(clk), .rst_i(rst), .fsmc_a_i(a), .fsmc_d_i(d), .fsmc_d_o(q), .fsmc_ne_n_i(ne_n),
        .fsmc_noe_n_i(noe_n), .fsmc_nwe_n_i(nwe_n), .fsmc_nbl_n_i(nbl_n), .fsmc_nadv_n_i(1'b1),
        .fsmc_nwait_n_o(nwait_n), .page_i(6'd0), .late_o(late), .bus_valid_o(bus_valid),
        .bus_write_o(bus_write), .bus_addr_o(bus_addr), .bus_wdata_o(bus_wdata),
        .bus_ready_i(bus_ready), .bus_rdata_i(registers[bus_addr[3:0]]), .bus_error_i(1'b0),
        .npi_addr_o(npi_addr), .npi_addr_req_o(npi_req), .npi_addr_ack_i(npi_ack),
        .npi_rnw_o(npi_rnw), .npi_size_o(npi_size), .npi_wr_data_o(npi_data),
        .npi_wr_be_o(npi_be), .npi_wr_push_o(npi_push), .npi_wr_empty_i(1'b1),
        .npi_wr_almost_full_i(1'b0), .npi_rd_data_i(npi_answer), .npi_rd_word_i(4'd0),
        .npi_rd_pop_o(npi_pop), .npi_rd_empty_i(npi_empty), .npi_init_done_i(1'b1)
    );

    // ---- while the pins are stable, NWAIT may be released, but must not be asserted
    time    moved = 0;
    integer glitches = 0, lates = 0, errors = 0, waits = 0;
    always @(a or d or ne_n or noe_n or nwe_n) moved = $time;
    always @(nwait_n)
        if ($time > moved + SETTLED && ne_n != 2'b11) begin
            if (nwait_n === 1'b0) begin
                glitches = glitches + 1;
                if (glitches < 6)
                    $display("glitch at %0d ps, %0d ps after the pins moved", $time, $time - moved);
            end else
                waits = waits + 1;
        end
    always @(posedge clk) if (!rst && late) lates = lates + 1;

    // ---- The FSMC: ADDSET 2, DATAST 4, BUSTURN 1
    task access(input write, input bank, input [24:0] address, input [15:0] data,
                output [15:0] result);
        integer patience;
        begin
            a = address;
            d = data;
            #1500 ne_n = bank ? 2'b01 : 2'b10;
            noe_n = write;
            #(2 * HCLK) nwe_n = !write;
            #HCLK patience = 3000;
            while (nwait_n !== 1'b1 && patience != 0) begin
                #HCLK patience = patience - 1;
            end
            if (patience == 0)
                errors = errors + 1;
            #(4 * HCLK) result = q;
            nwe_n = 1'b1;
            if (!write) begin
                noe_n = 1'b1;
                ne_n  = 2'b11;
            end
            #HCLK ne_n = 2'b11;
            noe_n = 1'b1;
            #(2 * HCLK);
        end
    endtask

    integer n, i, kind, steps, operations;
    reg [24:0] place;
    reg [15:0] model [0:4095], value, got, low;
    reg [31:0] words [0:15];
    initial begin
        pushed[0] = 72'd0;
        if (!$value$plusargs("seed=%d", seed))
            seed = 1;
        if (!$value$plusargs("operations=%d", operations))
            operations = 300;
        for (i = 0; i < 1024; i = i + 1)
            memory[i] = {4{16'd0}};
        for (i = 0; i < 4096; i = i + 1)
            model[i] = 16'd0;
        for (i = 0; i < 16; i = i + 1) begin
            registers[i] = 32'd0;
            words[i] = 32'd0;
        end
        #200000 rst = 1'b0;
        #100000 place = 25'd0;
        for (n = 0; n < operations; n = n + 1) begin
            kind  = $unsigned($random(seed)) % 8;
            steps = 1 + $unsigned($random(seed)) % 6;
            if (kind < 6)
                place = $unsigned($random(seed)) % 4096;
            if (kind < 3 || kind == 6) begin // reads, at a new address or at the next one
                for (i = 0; i < steps; i = i + 1) begin
                    access(1'b0, 1'b0, place, 16'd0, got);
                    if (got !== model[place[11:0]])
                        errors = errors + 1;
                    place = (place + 1) % 4096;
                end
            end else if (kind < 5 || kind == 7) begin // writes, at consecutive addresses or 9 apart
                for (i = 0; i < 2 * steps; i = i + 1) begin
                    value = $random(seed);
                    model[place[11:0]] = value;
                    access(1'b1, 1'b0, place, value, got);
                    place = (place + (kind == 7 ? 1 : 9)) % 4096;
                end
            end else begin // a register
                i = $unsigned($random(seed)) % 16;
                if (steps > 3) begin
                    words[i] = $random(seed);
                    access(1'b1, 1'b1, {20'd0, i[3:0], 1'b0}, words[i][15:0], got);
                    access(1'b1, 1'b1, {20'd0, i[3:0], 1'b1}, words[i][31:16], got);
                end else begin
                    access(1'b0, 1'b1, {20'd0, i[3:0], 1'b0}, 16'd0, low);
                    access(1'b0, 1'b1, {20'd0, i[3:0], 1'b1}, 16'd0, got);
                    if ({got, low} !== words[i])
                        errors = errors + 1;
                end
            end
        end
        $display("%0d operations, %0d waits, %0d glitches, %0d late, %0d errors", operations, waits,
                 glitches, lates, errors);
        $finish;
    end
endmodule
