// SPDX-License-Identifier: MIT
//
// modem_at: finds the modem's baud rate and sets it up by AT commands, checking each reply.
//
// Steps (STATUS.STEP): 1 +++  2 MY  3 DH  4 DL  5 CH  6 ID  7 RO  8 BD  9 CN.
// Step 1 is tried at the target rate, at 9600 (the factory's), then at all rates from BD 7 down. Any
// other command that is refused or not answered is sent twice again.

`default_nettype none

module modem_at (
    input  wire        clk_i,
    input  wire        rst_i,
    input  wire        ms_tick_i,  // once a millisecond
    // control
    input  wire        start_i,
    output wire        busy_o,
    output reg         done_o,     // one cycle
    output reg         failed_o,   // one cycle
    output reg         retried_o,  // one cycle
    output reg  [3:0]  step_o,
    output reg  [2:0]  bd_o,       // baud rate in use
    // settings
    input  wire [2:0]  bd_i,
    input  wire [11:0] guard_ms_i,
    input  wire [15:0] source_i,
    input  wire [15:0] target_i,
    input  wire [7:0]  channel_i,
    input  wire [15:0] pan_i,
    // bytes to and from the modem
    output wire        tx_valid_o,
    output wire [7:0]  tx_data_o,
    input  wire        tx_ready_i,
    input  wire        rx_valid_i,
    input  wire [7:0]  rx_data_i
);
    localparam [3:0] ENTER = 4'd1, MY = 4'd2, DH = 4'd3, DL = 4'd4, CH = 4'd5, ID = 4'd6,
                     RO = 4'd7, BD = 4'd8, CN = 4'd9;
    localparam [11:0] REPLY_MS = 12'd500; // OK may wait while received packets drain
    localparam [2:0]  FACTORY_BD = 3'd3;

    localparam [12:0] SETTLE_MS = 13'd10; // the modem changes its rate after CN's OK has left

    localparam [2:0] IDLE = 3'd0, WAIT_GUARD = 3'd1, SEND = 3'd2, WAIT_REPLY = 3'd3, SETTLE = 3'd4;

    reg [2:0]  state;
    reg [12:0] ms;          // milliseconds left
    reg [3:0]  index;       // character of the command
    reg [3:0]  search;      // 0 target, 1 factory, 2..9 BD 7..0
    reg [1:0]  retries;
    reg [15:0] last;        // the last two characters of the reply

    // The command of a step: two letters, and `digits` hex digits of `value`, left aligned.
    reg [15:0] letters, value;
    reg [2:0]  digits;
    always @* begin
        letters = "MY";
        value   = 16'd0;
        digits  = 3'd4;
        case (step_o)
            MY:      begin letters = "MY"; value = source_i; end
            DH:      begin letters = "DH"; digits = 3'd1; end
            DL:      begin letters = "DL"; value = target_i; end
            CH:      begin letters = "CH"; value = {channel_i, 8'd0}; digits = 3'd2; end
            ID:      begin letters = "ID"; value = pan_i; end
            RO:      begin letters = "RO"; value = 16'h3000; digits = 3'd1; end
            BD:      begin letters = "BD"; value = {1'b0, bd_i, 12'd0}; digits = 3'd1; end
            default: begin letters = "CN"; digits = 3'd0; end
        endcase
    end

    wire [3:0]  nibble       = value[{2'd3 - index[1:0], 2'd0} +: 4]; // index counts from 4
    wire [7:0]  digit        = nibble < 4'd10 ? "0" + {4'd0, nibble} : "A" - 8'd10 + {4'd0, nibble};
    wire        entering     = step_o == ENTER;
    wire        is_last      = entering ? index == 4'd2 : index == {1'b0, digits} + 4'd4;

    reg [7:0] character;
    always @* begin
        case (index)
            4'd0:    character = "A";
            4'd1:    character = "T";
            4'd2:    character = letters[15:8];
            4'd3:    character = letters[7:0];
            default: character = is_last ? 8'h0D : digit;
        endcase
        if (entering)
            character = "+";
    end

    assign busy_o     = state != IDLE;
    assign tx_valid_o = state == SEND;
    assign tx_data_o  = character;

    // A guard time and a tenth: the modem's clock is not ours.
    wire [12:0] guard = {1'b0, guard_ms_i} + {4'd0, guard_ms_i[11:3]} + 13'd2;
    wire        ok    = rx_valid_i && rx_data_i == 8'h0D && last == "OK";
    wire        refused = rx_valid_i && rx_data_i == 8'h0D && last != "OK";
    wire        silent  = ms == 13'd0;

    always @(posedge clk_i) begin
        done_o    <= 1'b0;
        failed_o  <= 1'b0;
        retried_o <= 1'b0;
        if (ms_tick_i && !silent)
            ms <= ms - 13'd1;
        if (rx_valid_i)
            last <= {last[7:0], rx_data_i};
        case (state)
            IDLE: if (start_i) begin
                step_o  <= ENTER;
                search  <= 4'd0;
                bd_o    <= bd_i;
                retries <= 2'd0;
                ms      <= guard;
                state   <= WAIT_GUARD;
            end
            WAIT_GUARD: if (silent) begin
                index <= 4'd0;
                state <= SEND;
            end
            SEND: if (tx_ready_i) begin
                index <= index + 4'd1;
                if (is_last) begin
                    last  <= 16'd0;
                    ms    <= entering ? guard + {1'b0, REPLY_MS} : {1'b0, REPLY_MS};
                    state <= WAIT_REPLY;
                end
            end
            SETTLE: if (silent) begin
                done_o <= 1'b1;
                state  <= IDLE;
            end
            default: begin
                if (ok) begin
                    index   <= 4'd0;
                    retries <= 2'd0;
                    if (step_o == CN) begin
                        bd_o  <= bd_i;
                        ms    <= SETTLE_MS;
                        state <= SETTLE;
                    end else begin
                        step_o <= step_o + 4'd1;
                        state  <= SEND;
                    end
                end else if (entering ? silent : (refused || silent)) begin
                    index     <= 4'd0;
                    retries   <= retries + 2'd1;
                    retried_o <= 1'b1;
                    if (entering) begin
                        search <= search + 4'd1;
                        bd_o   <= search == 4'd0 ? FACTORY_BD : 3'd0 - search[2:0];
                        ms     <= guard;
                        state  <= WAIT_GUARD;
                    end else begin
                        state <= SEND;
                    end
                    if (entering ? search == 4'd9 : retries == 2'd2) begin
                        failed_o  <= 1'b1;
                        retried_o <= 1'b0;
                        state     <= IDLE;
                    end
                end
            end
        endcase
        if (rst_i) begin
            state     <= IDLE;
            step_o    <= 4'd0;
            bd_o      <= FACTORY_BD;
            ms        <= 13'd0;
            done_o    <= 1'b0;
            failed_o  <= 1'b0;
            retried_o <= 1'b0;
        end
    end
endmodule
