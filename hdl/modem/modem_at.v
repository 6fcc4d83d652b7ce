// SPDX-License-Identifier: MIT
//
// modem_at: finds the baud rate of the modem, and configures the modem with AT commands. It checks
// the reply to each command.
//
// Steps (STATUS.STEP): 1 +++  2 MY  3 DH  4 DL  5 CH  6 ID  7 EE  8 KY (only with EE)  9 RN  10 RO
// 11 D6  12 D7  13 AP  14 BD  15 CN  0 the modem changes its rate. The table modem_at_rows contains
// the actions of each step, and this block executes them. Step 1 is tried at the target rate, then
// at 9600 (the factory setting), then at all rates from BD 7 down, and at last at 250,000. The wait
// for the answer to an attempt is also the guard time before the next attempt. Any other command
// that is rejected or not answered is repeated up to twice.

`default_nettype none
`include "count_up.vh"
`include "shift_order.vh"

module modem_at #(
    parameter API = 1 // 0: the modem is always in transparent mode
) (
    input  wire        clk_i,
    input  wire        rst_i,
    // time since clear_o was high, in units of 17/16 ms
    output wire        clear_o,
    input  wire [11:0] time_i,
    // control
    input  wire        start_i,    // starts the set-up; allowed only while busy_o is low
    // high together with start_i if a cable replaces the modem: the target rate is then used
    // without a set-up
    input  wire        wire_i,
    output reg         busy_o,
    output reg         done_o,     // one cycle
    output reg         failed_o,   // one cycle
    output reg         retried_o,  // one cycle
    output reg  [3:0]  step_o,
    output reg  [3:0]  bd_o,       // baud rate in use, as a code of modem_baud
    // settings: word_i is the word with index word_o, one clock later
    output wire [4:0]  word_o,
    input  wire [31:0] word_i,
    input  wire        word_valid_i,
    // bytes to and from the modem
    output wire        tx_valid_o,
    output wire [7:0]  tx_data_o,  // character to send; 0 while busy_o is low
    input  wire        tx_ready_i,
    input  wire        rx_valid_i,
    input  wire [7:0]  rx_data_i
);
    `include "modem_regs.vh"

    localparam [3:0] SETTLES = 4'd0, ENTER = 4'd1;
    localparam [3:0] FACTORY_BD = 4'd3, HIGHEST_BD = 4'd7;

    reg [5:0] place;    // row of the current step in the table modem_at_rows
    `SHIFT_ORDER(after, 6)
    `COUNT_UP(up, 4)
    reg       fresh;    // the line has not been idle yet, so the time has not started
    reg       steady;   // the character to send is available
    reg [3:0] value;    // last digit
    // tried: the command has failed; walks: it has failed more than once. In step 1, the first
    // failure selects 9600 baud, the second BD 7, and each further failure the next lower rate
    reg       tried, walks;
    reg       heard_o, heard_k; // heard_o: the reply ends with "O"; heard_k: it ends with "OK"
    // high for one cycle after a complete reply: ok if it was "OK", refused otherwise
    reg       ok, refused;
    // bit i: bits 3i+2..3i of time_i are equal to bits 3i+2..3i of the guard time
    reg [3:0] same;
    // the time is running and the guard time has been read, so `same` is valid
    reg       counts;

    wire       send, digit, rate, guard, hear, limit, refuse, skip, settle;
    wire [7:0] data;

    wire start  = start_i && !busy_o;
    wire taken  = steady && tx_ready_i;
    wire next   = taken || (guard && counts && &same);
    wire passed = hear && ok;
    wire missed = !passed && ((limit && time_i[9]) || (refuse && refused));
    wire ended  = settle && time_i[4];
    wire enters = limit && !refuse; // the current step is step 1 (+++)
    wire gives_up = missed && walks && (!enters || bd_o[3]);
    wire goes   = next || passed || missed || ended;

    modem_at_rows #(.API(API)) u_rows (
        .clk_i(clk_i), .clear_i(goes || !busy_o || rst_i), .step_i(step_o), .place_i(place),
        .send_o(send), .digit_o(digit), .rate_o(rate), .guard_o(guard), .hear_o(hear),
        .limit_o(limit), .refuse_o(refuse), .skip_o(skip), .settle_o(settle), .data_o(data)
    );

    // next lower rate; after the lowest rate, 250,000
    wire [3:0] lower =
        {bd_o[2:0] == 3'd0, bd_o[2] ^ (bd_o[1:0] == 2'd0), bd_o[1] ~^ bd_o[0], ~bd_o[0]};

    reg [3:0] nibble;
    always @* begin
        case (data[2:0])
            3'd0:    nibble = word_i[3:0];
            3'd1:    nibble = word_i[7:4];
            3'd2:    nibble = word_i[11:8];
            3'd3:    nibble = word_i[15:12];
            3'd4:    nibble = word_i[19:16];
            3'd5:    nibble = word_i[23:20];
            3'd6:    nibble = word_i[27:24];
            default: nibble = word_i[31:28];
        endcase
    end
    wire       letter = value[3] && (value[2] || value[1]); // A..F
    wire [7:0] hex    = {1'b0, letter, !letter, !letter, value[3] && !letter,
                         letter ? value[2] && (value[1] || value[0]) : value[2],
                         letter ? value[1] ~^ value[0] : value[1], value[0] ^ letter};

    assign word_o     = data[7:3];
    assign tx_valid_o = steady;
    assign tx_data_o  = digit ? hex : data;
    assign clear_o    = fresh;

    integer i;
    always @(posedge clk_i) begin
        done_o    <= ended;
        failed_o  <= gives_up;
        retried_o <= missed && !gives_up;

        fresh   <= goes || start || (fresh && (send || !tx_ready_i));
        steady  <= send && !taken && (steady || word_valid_i);
        counts <= !fresh && word_valid_i;
        for (i = 0; i < 4; i = i + 1)
            same[i] <= time_i[3*i +: 3] == word_i[MODEM_BAUD_GUARD_MS_LSB + 3*i +: 3];
        if (digit && !steady)
            value <= nibble;

        ok      <= rx_valid_i && rx_data_i == 8'h0D && heard_k;
        refused <= rx_valid_i && rx_data_i == 8'h0D && !heard_k && !fresh;
        if (rx_valid_i) begin
            heard_o <= rx_data_i == "O";
            heard_k <= rx_data_i == "K" && heard_o;
        end
        if (send) begin
            heard_o <= 1'b0;
            heard_k <= 1'b0;
        end

        if (next)
            place <= after(place);
        if (passed || missed || start)
            place <= {5'd0, missed && enters};
        if (passed) // after step EE without encryption, step KY is skipped
            step_o <= up(step_o) | {3'd0, skip && !value[0]};
        if (passed || start) begin
            tried <= 1'b0;
            walks <= 1'b0;
        end else if (missed) begin
            tried <= 1'b1;
            walks <= tried;
        end
        if (missed && enters)
            bd_o <= walks ? lower : tried ? HIGHEST_BD : FACTORY_BD;
        if (rate && word_valid_i)
            // rates 0..7 have the codes 0..7; code 8 stands for the value 0x3D090
            bd_o <= {word_i[4], word_i[2:0]};

        if (start) begin
            step_o <= wire_i ? SETTLES : ENTER;
            busy_o <= 1'b1;
        end
        if (ended || gives_up)
            busy_o <= 1'b0;
        if (rst_i) begin
            busy_o    <= 1'b0;
            steady    <= 1'b0;
            step_o    <= 4'd0;
            bd_o      <= FACTORY_BD;
            done_o    <= 1'b0;
            failed_o  <= 1'b0;
            retried_o <= 1'b0;
        end
    end

`ifdef FORMAL
    // Proves that each step ends only after an OK from the modem, and that the set-up ends after
    // the last step.
    localparam [3:0] EE = 4'd7, RN = 4'd9;
    reg past = 1'b0;
    initial assume (rst_i);
    reg [23:0] heard = 24'd0; // last three characters received since the command was sent
    always @(posedge clk_i) begin
        past <= 1'b1;
        if (send)
            heard <= 24'd0;
        else if (rx_valid_i)
            heard <= {heard[15:0], rx_data_i};
        if (past && !rst_i && !$past(rst_i)) begin
            // An action is performed only while busy_o is high, and never after the next step has
            // begun.
            assert (busy_o || !(send || rate || guard || hear || limit || settle));
            if ($past(goes || start))
                assert (!(send || rate || guard || hear || limit || settle) && fresh);
            // The steps follow each other in order. Each step ends only after "OK" and a carriage
            // return.
            if (passed)
                assert (heard == {"OK", 8'h0D});
            // A carriage return without "OK" is a rejection, unless it belongs to an earlier reply.
            assert (refused == $past(rx_valid_i && rx_data_i == 8'h0D && !heard_k && !fresh));
            if (hear) begin
                assert (!send);
                assert (!heard_o || heard[7:0] == "O");
                assert (!heard_k || heard[15:0] == "OK");
            end
            if (step_o != $past(step_o))
                assert (($past(start) && step_o == ($past(wire_i) ? SETTLES : ENTER)) ||
                        ($past(passed) && (step_o == $past(step_o) + 4'd1 ||
                                           ($past(step_o) == EE && step_o == RN))));
            // The set-up ends with success after the last step, or with failure, never both.
            assert (!(done_o && failed_o));
            if (done_o)
                assert ($past(settle) && step_o == SETTLES);
            if (settle)
                assert (step_o == SETTLES);
            if ($past(busy_o) && !busy_o)
                assert (done_o || failed_o);
            // Nothing is sent during the guard time, and an offered byte is stable until it is
            // taken.
            if (tx_valid_o)
                assert (send && !guard);
            if ($past(tx_valid_o) && !$past(tx_ready_i))
                assert (tx_valid_o && $stable(tx_data_o));
        end
        cover (past && !rst_i && step_o == 4'd3);
        cover (past && done_o && heard == 24'd0);
        cover (past && !rst_i && retried_o && !enters && step_o == 4'd2);
        cover (past && !rst_i && digit && taken);
    end
`endif
`ifdef COVER_POINTS
    tries_again: cover property (@(posedge clk_i) retried_o && !enters);
    tries_other_rate: cover property (@(posedge clk_i) missed && enters);
    given_up: cover property (@(posedge clk_i) failed_o);
    refused_by_modem: cover property (@(posedge clk_i) missed && refuse && refused);
    key_is_sent: cover property (@(posedge clk_i) passed && skip && value[0]);
    no_key: cover property (@(posedge clk_i) passed && skip && !value[0]);
`endif
endmodule
