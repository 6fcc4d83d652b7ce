// SPDX-License-Identifier: MIT
//
// npi_fifo: first-in first-out in LUT RAM; its first word is on data_o while empty_o is 0.
//
// A push while full and a pop while empty are the user's errors; they are proven absent where used.

`default_nettype none

module npi_fifo #(
    parameter WIDTH = 72,
    parameter LOG2  = 5 // 2**LOG2 words
) (
    input  wire             clk_i,
    input  wire             rst_i, // also empties it
    input  wire             push_i,
    input  wire [WIDTH-1:0] data_i,
    input  wire             pop_i,
    output wire [WIDTH-1:0] data_o,
    output wire             empty_o,
    output wire             full_o
);
    reg [WIDTH-1:0] words [0:(1<<LOG2)-1];
    reg [LOG2:0] write_index, read_index;

    wire same    = write_index[LOG2-1:0] == read_index[LOG2-1:0];
    assign empty_o = same && write_index[LOG2] == read_index[LOG2];
    assign full_o  = same && write_index[LOG2] != read_index[LOG2];
    assign data_o  = words[read_index[LOG2-1:0]];

    always @(posedge clk_i) begin
        if (push_i) begin
            words[write_index[LOG2-1:0]] <= data_i;
            write_index <= write_index + 1'b1;
        end
        if (pop_i)
            read_index <= read_index + 1'b1;
        if (rst_i) begin
            write_index <= 0;
            read_index  <= 0;
        end
    end

`ifdef FORMAL
    reg past = 1'b0;
    initial assume (rst_i);
    // Any one word, wherever it is: it comes out as it went in, in its place.
    (* anyconst *) reg [LOG2:0] place;
    reg [WIDTH-1:0] value;
    reg inside = 1'b0;
    wire [LOG2:0] count = write_index - read_index;
    always @(posedge clk_i) begin
        past <= 1'b1;
        assume (!(push_i && full_o));
        assume (!(pop_i && empty_o));
        if (push_i && write_index == place) begin
            value  <= data_i;
            inside <= 1'b1;
        end
        if ((pop_i && read_index == place) || rst_i)
            inside <= 1'b0;
        if (past) begin
            assert (count <= (1 << LOG2));
            assert (empty_o == (count == 0));
            assert (full_o == (count == (1 << LOG2)));
            if (inside) begin
                assert ((place - read_index) < count);
                assert (words[place[LOG2-1:0]] == value);
            end
            if (inside && read_index == place)
                assert (data_o == value && !empty_o);
            cover (full_o);
            cover ($past(full_o) && !empty_o && inside);
        end
    end
`endif
endmodule
