// SPDX-License-Identifier: MIT
//
// modem_at_text: the letters of the AT commands. Row 0 is the prefix, the others are modem_at's steps.

`default_nettype none

module modem_at_text #(
    parameter API = 0 // the modem's mode: 0 transparent, 1 API frames
) (
    input  wire [3:0] row_i,
    input  wire [1:0] index_i,
    output wire [7:0] character_o,
    output wire       last_o
);
    reg [23:0] text; // two or three characters, from the left
    always @* begin
        case (row_i)
            4'd0:    text = {"AT", 8'd0};
            4'd1:    text = "+++";
            4'd2:    text = {"MY", 8'd0};
            4'd3:    text = "DH0";
            4'd4:    text = {"DL", 8'd0};
            4'd5:    text = {"CH", 8'd0};
            4'd6:    text = {"ID", 8'd0};
            4'd7:    text = {"EE", 8'd0};
            4'd8:    text = {"KY", 8'd0};
            4'd9:    text = "RO3";
            4'd10:   text = "D61"; // the modem heeds RTS
            4'd11:   text = "D71"; // and drives CTS
            4'd12:   text = API != 0 ? "AP1" : "AP0";
            4'd13:   text = {"BD", 8'd0};
            default: text = {"CN", 8'd0};
        endcase
    end

    assign character_o = index_i == 2'd0 ? text[23:16] : index_i == 2'd1 ? text[15:8] : text[7:0];
    assign last_o      = index_i == 2'd2 || (index_i == 2'd1 && text[7:0] == 8'd0);
endmodule
