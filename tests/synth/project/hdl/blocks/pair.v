// SPDX-License-Identifier: MIT
//
// pair: a counter that addresses a store; a design for tests with more than one instance.

`default_nettype none

module pair (
    input  wire       clk_i,
    input  wire       rst_i,
    input  wire       write_i,
    input  wire [5:0] data_i,
    output reg  [5:0] data_o
);
    wire [4:0] place;
    wire [5:0] word;
    counter #(.WIDTH(5)) u_counter (
        .clk_i(clk_i), .rst_i(rst_i), .enable_i(write_i), .count_o(place)
    );
    store u_store (
        .clk_i(clk_i), .write_i(write_i), .write_addr_i(place), .data_i(data_i),
        .read_addr_i(~place), .data_o(word)
    );
    always @(posedge clk_i) begin
        data_o <= word ^ {6{place[4]}};
    end
endmodule
