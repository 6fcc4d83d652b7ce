// SPDX-License-Identifier: MIT
//
// modem_at_rows: table of the AT set-up, in block RAM. Each row of a step is one action of
// modem_at.
//
// A row contains flags and eight bits of data. The data is a character, or {word of the settings,
// nibble in the word}. A row without flags has no effect.

`default_nettype none
`include "shift_order.vh"

module modem_at_rows #(
    parameter API = 1
) (
    input  wire       clk_i,
    input  wire       clear_i, // the next row to read is row 0 of step_i
    input  wire [3:0] step_i,
    // row in the step; the rows are in the order of the states of a shift register
    input  wire [5:0] place_i,
    // flags of the row, valid one cycle later
    output wire       send_o,   // the action sends a character
    output wire       digit_o,  // the character is the hex digit of a nibble of the settings
    output wire       rate_o,   // changes to the target rate
    output wire       guard_o,  // waits for the guard time
    output wire       hear_o,   // waits for the answer: "OK" ends the step
    output wire       limit_o,  // half a second without an answer counts as a failure
    output wire       refuse_o, // any answer except "OK" also counts as a failure
    output wire       skip_o,   // skips the next step if the last digit was even
    output wire       settle_o, // waits until the modem has changed its rate, then ends the set-up
    output wire [7:0] data_o
);
    `include "modem_regs.vh"

    localparam [8:0] SEND = 9'd1,  DIGIT = 9'd2,  RATE   = 9'd4,  GUARD = 9'd8,
                     HEAR = 9'd16, LIMIT = 9'd32, REFUSE = 9'd64, SKIP  = 9'd128, SETTLE = 9'd256;
    localparam KEY = 8, RATE_OF = 14, LEAVE = 15; // numbers of steps; step 0 follows LEAVE
    // settings word that contains the rate and the guard time
    localparam [7:0] SETTINGS = {1'b0, MODEM_BAUD, 3'd0};

    // Returns the letters of the command after "AT": two letters, or three characters if the value
    // is constant.
    function [23:0] letters(input integer step);
        case (step)
            2:       letters = {8'd0, "MY"};
            3:       letters = "DH0";
            4:       letters = {8'd0, "DL"};
            5:       letters = {8'd0, "CH"};
            6:       letters = {8'd0, "ID"};
            7:       letters = {8'd0, "EE"};
            KEY:     letters = {8'd0, "KY"};
            // the modem waits up to three units of random time before each attempt
            9:       letters = "RN2";
            10:      letters = "RO3";
            11:      letters = "D61"; // the modem observes RTS
            12:      letters = "D71"; // the modem drives CTS
            13:      letters = API != 0 ? {8'd0, "AP"} : "AP0";
            RATE_OF: letters = {8'd0, "BD"};
            default: letters = {8'd0, "CN"};
        endcase
    endfunction
    function integer letter_count(input integer step);
        letter_count = letters(step) < 24'h10000 ? 2 : 3;
    endfunction
    // Returns the character of `text` that is followed by `left` characters.
    function [7:0] letter(input [23:0] text, input integer left);
        case (left)
            0:       letter = text[7:0];
            1:       letter = text[15:8];
            default: letter = text[23:16];
        endcase
    endfunction

    // Returns the number of hex digits in the value of a command. The digits are nibbles of the
    // settings, starting with the nibble that digit() returns. The key has four words.
    function integer digit_count(input integer step);
        case (step)
            2, 4, 6: digit_count = 4;
            5:       digit_count = 2;
            7:       digit_count = 1;
            13:      digit_count = API != 0 ? 1 : 0;
            KEY:     digit_count = 32;
            RATE_OF: digit_count = 5;
            default: digit_count = 0;
        endcase
    endfunction
    // Returns {word, nibble} of the digit that is followed by `left` digits.
    function [7:0] digit(input integer step, input [4:0] left);
        case (step)
            2:       digit = {1'b0, MODEM_ADDR, left[2:0]};
            4:       digit = {1'b0, MODEM_ADDR, 1'b1, left[1:0]};
            5:       digit = {1'b0, MODEM_NET, left[2:0]};
            6:       digit = {1'b0, MODEM_NET, 1'b1, left[1:0]};
            7:       digit = {1'b0, MODEM_NET, 3'd2};
            13:      digit = {1'b0, MODEM_NET, 3'd3};
            KEY:     digit = {3'b111, ~left[4:3], left[2:0]};
            default: digit = {1'b0, MODEM_BAUD, left[2:0]};
        endcase
    endfunction

    `SHIFT_ORDER(after, 6)

    (* rom_style = "block", ram_style = "block" *)
    reg [16:0] rows [0:1023];
    reg [5:0] at;
    integer i, k;
    initial begin
        for (i = 0; i < 1024; i = i + 1)
            rows[i] = 17'd0;
        // "+++" with a guard time before and after
        rows[64] = {GUARD | RATE, SETTINGS};
        at = after(6'd0);
        for (k = 0; k < 3; k = k + 1) begin
            rows[{4'd1, at}] = {SEND, "+"};
            at = after(at);
        end
        rows[{4'd1, at}] = {GUARD | HEAR, SETTINGS};
        at = after(at);
        rows[{4'd1, at}] = {HEAR | LIMIT, 8'd0};
        // "AT", letters, digits and carriage return, then the wait for the answer
        for (i = 2; i <= LEAVE; i = i + 1) begin
            rows[64*i] = {SEND, "A"};
            rows[64*i + 1] = {SEND, "T"};
            at = after(6'd1);
            for (k = letter_count(i) - 1; k >= 0; k = k - 1) begin
                rows[{i[3:0], at}] = {SEND, letter(letters(i), k)};
                at = after(at);
            end
            for (k = digit_count(i) - 1; k >= 0; k = k - 1) begin
                rows[{i[3:0], at}] = {SEND | DIGIT, digit(i, k[4:0])};
                at = after(at);
            end
            rows[{i[3:0], at}] = {SEND, 8'h0D};
            at = after(at);
            rows[{i[3:0], at}] =
                {HEAR | LIMIT | REFUSE | (i == KEY - 1 ? SKIP : 9'd0), 8'd0};
        end
        rows[0] = {SETTLE | RATE, SETTINGS};
    end

    reg [16:0] now;
    always @(posedge clk_i)
        if (clear_i)
            now <= 17'd0;
        else
            now <= rows[{step_i, place_i}];

    assign {settle_o, skip_o, refuse_o, limit_o, hear_o, guard_o, rate_o, digit_o, send_o, data_o} =
        now;
endmodule
