// SPDX-License-Identifier: MIT
//
// modem_at: finds the modem's baud rate and sets it up by AT commands, checking each reply.
//
// Steps (STATUS.STEP): 1 +++  2 MY  3 DH  4 DL  5 CH  6 ID  7 EE  8 KY (only with EE)  9 RO  10 D6
// 11 D7  12 AP  13 BD  14 CN. Step 1 is tried at the target rate, at 9600 (the factory's), then at all
// rates from BD 7 down and at 250,000. Any other command that is refused or not answered is sent
// twice again.

`default_nettype none

module modem_at #(
    parameter API = 0
) (
    input  wire        clk_i,
    input  wire        rst_i,
    // time waited, in units of a millisecond and a sixteenth
    output wire        clear_o,
    input  wire [11:0] time_i,
    // control
    input  wire        start_i,    // only while not busy
    output wire        busy_o,
    output reg         done_o,     // one cycle
    output reg         failed_o,   // one cycle
    output reg         retried_o,  // one cycle
    output reg  [3:0]  step_o,
    output reg  [3:0]  bd_o,       // baud rate in use
    // settings: the word at word_o, when it can be read
    output wire [4:0]  word_o,
    input  wire [31:0] word_i,
    input  wire        word_valid_i,
    // bytes to and from the modem
    output wire        tx_valid_o,
    output reg  [7:0]  tx_data_o,
    input  wire        tx_ready_i,
    input  wire        rx_valid_i,
    input  wire [7:0]  rx_data_i
);
    `include "modem_regs.vh"

    localparam [3:0] ENTER = 4'd1, MY = 4'd2, DL = 4'd4, CH = 4'd5, ID = 4'd6, EE = 4'd7, KY = 4'd8,
                     RO = 4'd9, BD = 4'd13, CN = 4'd14;
    localparam [3:0] FACTORY_BD = 4'd3, HIGHEST_BD = 4'd7;

    // One flip-flop a state: bit numbers.
    localparam IDLE = 0, WAIT_GUARD = 1, TEXT = 2, DIGITS = 3, RETURN = 4, WAIT_SILENCE = 5,
               WAIT_REPLY = 6, SETTLE = 7;
    localparam [7:0] ONE = 8'd1;

    reg [7:0] state;
    reg       fresh;     // sending: the prefix is to come; waiting: the line is not idle yet
    reg       steady;    // tx_data_o holds the character to send
    reg [1:0] index;     // character of the text
    reg [4:0] nibble;    // digit of the value, from the right
    reg       walks;     // of the rates tried: the target's and the factory's are done
    reg       tried;     // the target's is done
    reg [1:0] tries;
    reg       encrypts;
    reg       heard_o, heard_k; // of the reply: "O", "OK"
    reg       ok, refused;      // one cycle: the reply is complete
    reg       guarded;          // the guard time is over
    reg       late;             // OK may wait while received packets drain

    // About the step, a cycle late: the word with its value, first and last digit from the right.
    reg       entering, leaving, has_value, has_key;
    reg [3:0] value_word;
    reg [4:0] first_nibble;
    reg [2:0] last_nibble;
    always @(posedge clk_i) begin
        entering     <= step_o == ENTER;
        leaving      <= step_o == CN;
        has_key      <= step_o == KY;
        has_value    <= 1'b1;
        value_word   <= MODEM_NET;
        first_nibble <= 5'd7;
        last_nibble  <= 3'd0;
        case (step_o)
            MY: begin value_word <= MODEM_ADDR; first_nibble <= 5'd3; end
            DL: begin value_word <= MODEM_ADDR; last_nibble <= 3'd4; end
            CH: first_nibble <= 5'd1;
            ID: last_nibble <= 3'd4;
            EE: begin first_nibble <= 5'd2; last_nibble <= 3'd2; end
            KY: first_nibble <= 5'd31;
            BD: begin value_word <= MODEM_BAUD; first_nibble <= 5'd4; end
            default: has_value <= 1'b0;
        endcase
    end
    assign word_o = !state[DIGITS] ? {1'b0, MODEM_BAUD} // the rate and the guard time
                  : has_key ? {3'b100, ~nibble[4:3]} : {1'b0, value_word};

    wire [7:0] letter;
    wire       last_letter;
    modem_at_text #(.API(API)) u_text (
        .row_i(fresh ? 4'd0 : step_o), .index_i(index), .character_o(letter),
        .last_o(last_letter)
    );

    reg [3:0] value;
    always @* begin
        case (nibble[2:0])
            3'd0:    value = word_i[3:0];
            3'd1:    value = word_i[7:4];
            3'd2:    value = word_i[11:8];
            3'd3:    value = word_i[15:12];
            3'd4:    value = word_i[19:16];
            3'd5:    value = word_i[23:20];
            3'd6:    value = word_i[27:24];
            default: value = word_i[31:28];
        endcase
    end
    wire [7:0] digit = value < 4'd10 ? {4'h3, value} : {4'h4, 1'b0, value[2:0] - 3'd1};
    reg        last; // character of the text, or digit of the value

    wire sending = state[TEXT] || state[DIGITS] || state[RETURN];
    wire taken   = steady && tx_ready_i;
    wire [3:0] target_bd = {word_i[4], word_i[2:0]}; // 0..7, 8 for 0x3D090

    assign clear_o    = sending || fresh;
    assign busy_o     = !state[IDLE];
    assign tx_valid_o = steady;

    always @(posedge clk_i) begin
        done_o    <= 1'b0;
        failed_o  <= 1'b0;
        retried_o <= 1'b0;

        steady <= sending && !taken && (steady || word_valid_i);
        if (!steady) begin
            tx_data_o <= state[TEXT] ? letter : state[DIGITS] ? digit : 8'h0D;
            last      <= state[TEXT] ? last_letter
                                     : nibble[2:0] == last_nibble && (!has_key || nibble[4:3] == 2'd0);
            if (state[DIGITS])
                encrypts <= value[0]; // after step EE: its only digit
        end

        guarded <= !fresh && word_valid_i && time_i == word_i[MODEM_BAUD_GUARD_MS_LSB +: 12];
        late    <= !fresh && time_i[9];
        ok      <= rx_valid_i && rx_data_i == 8'h0D && heard_k;
        refused <= rx_valid_i && rx_data_i == 8'h0D && !heard_k && !entering;
        if (rx_valid_i) begin
            heard_o <= rx_data_i == "O";
            heard_k <= rx_data_i == "K" && heard_o;
        end
        if (state[RETURN] || state[WAIT_GUARD]) begin
            heard_o <= 1'b0;
            heard_k <= 1'b0;
        end

        if (!sending && tx_ready_i)
            fresh <= 1'b0;
        if (taken)
            index <= index + 2'd1;
        if (!state[TEXT] || (taken && last))
            index <= 2'd0;
        if (taken)
            nibble <= nibble - 5'd1;
        if (state[TEXT])
            nibble <= first_nibble;

        (* parallel_case *)
        case (1'b1)
            state[IDLE]: begin
                walks <= 1'b0;
                tried <= 1'b0;
                tries <= 2'd0;
                if (start_i) begin
                    fresh  <= 1'b1;
                    step_o <= ENTER;
                    state  <= ONE << WAIT_GUARD;
                end
            end
            state[WAIT_GUARD]: begin
                if (!tried && word_valid_i)
                    bd_o <= target_bd;
                if (guarded && !fresh)
                    state <= ONE << TEXT;
            end
            state[TEXT]: if (taken && last) begin
                fresh <= entering;
                if (!fresh)
                    state <= ONE << (entering ? WAIT_SILENCE : has_value ? DIGITS : RETURN);
            end
            state[DIGITS]: if (taken && last)
                state <= ONE << RETURN;
            state[RETURN]: if (taken)
                state <= ONE << WAIT_REPLY;
            // The modem changes its rate after CN's OK has left.
            state[SETTLE]: if (!fresh && time_i[4] && word_valid_i) begin
                bd_o   <= target_bd;
                done_o <= 1'b1;
                state  <= ONE << IDLE;
            end
            default: begin // WAIT_SILENCE, WAIT_REPLY
                if (state[WAIT_SILENCE] && guarded && !fresh) begin
                    fresh <= 1'b1;
                    state <= ONE << WAIT_REPLY;
                end
                if (ok) begin
                    tries <= 2'd0;
                    fresh <= 1'b1;
                    state <= ONE << (leaving ? SETTLE : TEXT);
                    if (!leaving)
                        step_o <= step_o == EE && !encrypts ? RO : step_o + 4'd1;
                end else if (state[WAIT_REPLY] && !fresh && (late || refused)) begin
                    tries     <= tries + 2'd1;
                    fresh     <= 1'b1;
                    retried_o <= 1'b1;
                    state     <= ONE << (entering ? WAIT_GUARD : TEXT);
                    if (entering) begin
                        tried <= 1'b1;
                        walks <= tried;
                        bd_o  <= !tried ? FACTORY_BD : !walks ? HIGHEST_BD : bd_o - 4'd1;
                    end
                    if (entering ? walks && bd_o[3] : tries == 2'd2) begin
                        failed_o  <= 1'b1;
                        retried_o <= 1'b0;
                        state     <= ONE << IDLE;
                    end
                end
            end
        endcase
        if (rst_i) begin
            state     <= ONE << IDLE;
            fresh     <= 1'b0;
            steady    <= 1'b0;
            step_o    <= 4'd0;
            bd_o      <= FACTORY_BD;
            done_o    <= 1'b0;
            failed_o  <= 1'b0;
            retried_o <= 1'b0;
        end
    end

`ifdef FORMAL
    reg past = 1'b0;
    initial assume (rst_i);
    reg [23:0] heard = 24'd0; // the last three characters since the command
    always @(posedge clk_i) begin
        past <= 1'b1;
        assume (!past || !start_i || state[IDLE]);
        if (state[RETURN] || state[WAIT_GUARD])
            heard <= 24'd0;
        else if (rx_valid_i)
            heard <= {heard[15:0], rx_data_i};
        if (past && !rst_i && !$past(rst_i)) begin
            // One state at a time; the step is one of the table.
            assert (state != 8'd0 && (state & (state - 8'd1)) == 8'd0);
            assert (step_o <= CN);
            // A step follows its predecessor, and only after "OK" and a return came.
            if (ok && (state[WAIT_SILENCE] || state[WAIT_REPLY]))
                assert (heard == {"OK", 8'h0D});
            if (step_o != $past(step_o))
                assert (($past(start_i) && step_o == ENTER) ||
                        ($past(ok) && (step_o == $past(step_o) + 4'd1 ||
                                       ($past(step_o) == EE && step_o == RO))));
            // The end is success after the last step, or failure, never both.
            assert (!(done_o && failed_o));
            if (done_o)
                assert ($past(state[SETTLE]) && step_o == CN);
            if (state[SETTLE] && !$past(state[SETTLE]))
                assert ($past(ok) && $past(step_o) == CN);
            if ($past(busy_o) && !busy_o)
                assert (done_o || failed_o);
            // Nothing is sent while silence is kept, and what is offered stays until it is taken.
            if (tx_valid_o)
                assert (sending || $past(sending));
            if ($past(tx_valid_o) && !$past(tx_ready_i))
                assert (tx_valid_o && $stable(tx_data_o));
        end
        cover (past && !rst_i && step_o == 4'd3);
        cover (past && !rst_i && retried_o && !entering);
        cover (past && !rst_i && state[DIGITS] && taken && last);
    end
`endif
endmodule
