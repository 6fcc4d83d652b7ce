// SPDX-License-Identifier: MIT
//
// fsmc_bridge: the STM32's asynchronous SRAM bus to the register bus (NE2) and to DDR3 (NE1).
//
// NE2: 32-bit words as two halves, low half first. Reading the low half reads the word and keeps its
// high half; writing the low half keeps it, writing the high half writes the word. Byte lanes do not
// matter here.
// NE1: writes are posted into one 64-bit buffer and merged there; a read of another word, or a
// register access, writes it out first. Reads are served from the last 64-bit word read, which any
// write and any register access drops: after a register access, memory reads are fresh.
// NWAIT is low from the start of an access until it is done. The strobes must rest high for four
// clocks between accesses (ADDSET), so that the end of one is seen before the next begins.
// A target that does not answer within TIMEOUT clocks ends in access_error_o, never in NWAIT for ever.

`default_nettype none

module fsmc_bridge #(
    parameter TIMEOUT = 4095 // clocks, at most 4095
) (
    input  wire        clk_i,
    input  wire        rst_i,
    // FSMC pins
    input  wire [24:0] fsmc_a_i,     // halfword address: byte address bits 25..1
    input  wire [15:0] fsmc_d_i,
    output reg  [15:0] fsmc_d_o,
    output wire        fsmc_d_oe_o,
    input  wire [1:0]  fsmc_ne_n_i,  // bit 0 NE1, bit 1 NE2
    input  wire        fsmc_noe_n_i,
    input  wire        fsmc_nwe_n_i,
    input  wire [1:0]  fsmc_nbl_n_i,
    output wire        fsmc_nwait_n_o,
    // system slot
    input  wire [5:0]  page_i,
    output reg         access_error_o, // one cycle
    output reg  [9:0]  error_addr_o,
    output reg         error_write_o,
    // register bus
    output reg         bus_valid_o,
    output reg         bus_write_o,
    output wire [9:0]  bus_addr_o,
    output wire [31:0] bus_wdata_o,
    input  wire        bus_ready_i,
    input  wire [31:0] bus_rdata_i,
    input  wire        bus_error_i,
    // memory port
    output wire [31:0] npi_addr_o,
    output reg         npi_addr_req_o,
    input  wire        npi_addr_ack_i,
    output reg         npi_rnw_o,
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
    input  wire        npi_init_done_i
);
    localparam [2:0] WAIT_STROBE = 3'd0, // nothing selected, or not yet
                     SETTLE      = 3'd1, // address and data have been stable for a clock
                     DISPATCH    = 3'd2,
                     WRITE_OUT   = 3'd3, // the posted word goes to memory
                     FETCH       = 3'd4, // a word comes from memory
                     WAIT_BUS    = 3'd5,
                     WAIT_END    = 3'd6; // the processor has its answer

    // Pins are asynchronous to clk_i.
    reg [3:0] sync0, sync1;
    wire [1:0] ne = ~sync1[1:0];
    wire oe = !sync1[2], we = !sync1[3];
    wire strobe = |ne && (oe || we);

    reg [2:0]  state;
    reg        write, registers;      // the access under way
    reg [24:0] addr;
    reg [15:0] data;
    reg [1:0]  lanes;
    reg        done;
    reg [11:0] patience;

    // Posted write, and the last word read.
    reg [31:3] post_addr, line_addr;
    reg [63:0] post_data, line;
    reg [7:0]  post_be;
    reg        post_valid, line_valid;
    // Memory port: a read that was given up still comes back and is thrown away.
    reg        read_busy, read_stale;
    // Halves of register words.
    reg [9:0]  half_addr;
    reg [15:0] half;
    reg        half_read, half_write; // what `half` is

    wire [31:3] word_addr = {page_i, addr[24:2]};
    wire [1:0]  lane      = addr[1:0];
    wire [9:0]  reg_addr  = addr[10:1];
    wire        high_half = addr[0];
    wire        in_range  = addr[24:11] == 14'd0;
    wire        given_up  = patience == 12'd0;
    wire        port_free = !npi_addr_req_o && !read_busy && npi_init_done_i;

    wire active = !(&fsmc_ne_n_i) && !(fsmc_noe_n_i && fsmc_nwe_n_i);
    assign fsmc_nwait_n_o = !(active && !done);
    assign fsmc_d_oe_o    = !(&fsmc_ne_n_i) && !fsmc_noe_n_i;

    assign bus_addr_o  = reg_addr;
    assign bus_wdata_o = {data, half};

    reg push;
    assign npi_addr_o    = {npi_rnw_o ? line_addr : post_addr, 3'd0};
    assign npi_size_o    = 4'd0;
    assign npi_rmw_o     = 1'b0;
    assign npi_wr_data_o = post_data;
    assign npi_wr_be_o   = post_be;
    assign npi_wr_push_o = push;
    assign npi_wr_flush_o = 1'b0;
    assign npi_rd_flush_o = 1'b0;
    assign npi_rd_pop_o  = !npi_rd_empty_i;

    wire unused = &{1'b0, npi_wr_empty_i, npi_wr_almost_full_i, npi_rd_word_i, 1'b0};

    task fail;
        begin
            access_error_o <= 1'b1;
            error_addr_o   <= registers ? reg_addr : 10'h3FF;
            error_write_o  <= write;
        end
    endtask

    task answer(input [15:0] value);
        begin
            fsmc_d_o <= value;
            done     <= 1'b1;
            state    <= WAIT_END;
        end
    endtask

    always @(posedge clk_i) begin
        sync0 <= {fsmc_nwe_n_i, fsmc_noe_n_i, fsmc_ne_n_i};
        sync1 <= sync0;
        access_error_o <= 1'b0;
        push <= 1'b0;
        if (patience != 12'd0)
            patience <= patience - 12'd1;

        // Memory port: the request, then the word.
        if (npi_addr_ack_i) begin
            npi_addr_req_o <= 1'b0;
            if (!npi_rnw_o)
                post_valid <= 1'b0;
        end
        if (npi_rd_pop_o) begin
            read_busy  <= 1'b0;
            read_stale <= 1'b0;
            line       <= npi_rd_data_i;
            line_valid <= !read_stale;
        end

        case (state)
            WAIT_STROBE: begin
                done <= 1'b0;
                if (strobe)
                    state <= SETTLE;
            end
            SETTLE: begin
                // A strobe that is gone again was none: nothing has happened yet.
                state     <= strobe ? DISPATCH : WAIT_STROBE;
                write     <= we;
                registers <= ne[1];
                addr      <= fsmc_a_i;
                data      <= fsmc_d_i;
                lanes     <= ~fsmc_nbl_n_i;
                patience  <= TIMEOUT[11:0];
            end
            DISPATCH: begin
                if (registers) begin
                    line_valid <= 1'b0;
                    if (write && !high_half) begin
                        half       <= data;
                        half_addr  <= reg_addr;
                        half_write <= 1'b1;
                        half_read  <= 1'b0;
                        answer(16'd0);
                    end else if (!write && high_half && half_read && half_addr == reg_addr) begin
                        half_read <= 1'b0;
                        answer(half);
                    end else if (!in_range || (write && !(half_write && half_addr == reg_addr))) begin
                        fail;
                        answer(16'd0);
                    end else if (post_valid) begin
                        state <= WRITE_OUT;
                    end else begin
                        bus_valid_o <= 1'b1;
                        bus_write_o <= write;
                        half_write  <= 1'b0;
                        half_read   <= 1'b0;
                        state       <= WAIT_BUS;
                    end
                end else if (write) begin
                    if (post_valid && (post_addr != word_addr || npi_addr_req_o)) begin
                        state <= WRITE_OUT;
                    end else begin
                        line_valid <= 1'b0;
                        post_valid <= 1'b1;
                        post_addr  <= word_addr;
                        if (!post_valid)
                            post_be <= 8'd0;
                        post_be[{lane, 1'b0} +: 2] <= lanes | (post_valid ? post_be[{lane, 1'b0} +: 2] : 2'b00);
                        if (lanes[0])
                            post_data[{lane, 4'd0} +: 8] <= data[7:0];
                        if (lanes[1])
                            post_data[{lane, 4'd8} +: 8] <= data[15:8];
                        answer(16'd0);
                    end
                end else if (post_valid) begin
                    state <= WRITE_OUT;
                end else if (line_valid && line_addr == word_addr) begin
                    answer(line[{lane, 4'd0} +: 16]);
                end else if (port_free) begin
                    line_addr      <= word_addr;
                    line_valid     <= 1'b0;
                    npi_addr_req_o <= 1'b1;
                    npi_rnw_o      <= 1'b1;
                    read_busy      <= 1'b1;
                    state          <= FETCH;
                end else if (given_up) begin
                    fail;
                    answer(16'd0);
                end
            end
            WRITE_OUT: begin
                if (!post_valid) begin
                    state <= DISPATCH;
                end else if (given_up) begin
                    fail;
                    answer(16'd0);
                end else if (port_free) begin
                    npi_addr_req_o <= 1'b1;
                    npi_rnw_o      <= 1'b0;
                    push           <= 1'b1;
                end
            end
            FETCH: begin
                if (line_valid) begin
                    answer(line[{lane, 4'd0} +: 16]);
                end else if (given_up) begin
                    read_stale <= 1'b1;
                    fail;
                    answer(16'd0);
                end
            end
            WAIT_BUS: begin
                if (bus_ready_i || given_up) begin
                    bus_valid_o <= 1'b0;
                    if (bus_error_i || !bus_ready_i)
                        fail;
                    half      <= bus_rdata_i[31:16];
                    half_addr <= reg_addr;
                    half_read <= !write && !high_half;
                    answer(high_half ? bus_rdata_i[31:16] : bus_rdata_i[15:0]);
                end
            end
            default: begin
                if (!strobe) begin
                    done  <= 1'b0;
                    state <= WAIT_STROBE;
                end
            end
        endcase

        if (rst_i) begin
            sync0 <= 4'hF;
            sync1 <= 4'hF;
            state <= WAIT_STROBE;
            done  <= 1'b0;
            post_valid <= 1'b0;
            line_valid <= 1'b0;
            half_read  <= 1'b0;
            half_write <= 1'b0;
            read_busy  <= 1'b0;
            read_stale <= 1'b0;
            bus_valid_o    <= 1'b0;
            bus_write_o    <= 1'b0;
            npi_addr_req_o <= 1'b0;
            npi_rnw_o      <= 1'b0;
            access_error_o <= 1'b0;
            push <= 1'b0;
        end
    end
endmodule
