// SPDX-License-Identifier: MIT
//
// camera_fifo: words from one clock to another. The pointers cross in Gray code, so that one bit at most changes
// between two samples of them.
//
// It has no reset: the clocks' resets come at different times, and one side alone must not start again.
// The pointers begin at 0 with the configuration; a reader that wants it empty takes what is in it.

`default_nettype none

module camera_fifo #(
    parameter WIDTH = 11,
    parameter LOG2  = 5   // 2**LOG2 words, 2..6
) (
    // writer
    input  wire             write_clk_i,
    input  wire             push_i,     // only while full_o is low
    input  wire [WIDTH-1:0] data_i,
    output wire             full_o,
    // reader
    input  wire             read_clk_i,
    input  wire             pop_i,      // only while empty_o is low
    output wire [WIDTH-1:0] data_o,     // valid while empty_o is low
    output wire             empty_o
);
    reg [WIDTH-1:0] words [0:(1<<LOG2)-1];
    reg [LOG2:0]    written, written_gray;            // writer's clock; one bit more than the address
    reg [LOG2:0]    taken, taken_gray;                // reader's clock
    reg [LOG2:0]    taken_maybe, taken_seen;          // taken_gray in the writer's clock
    reg [LOG2:0]    written_maybe, written_seen;      // written_gray in the reader's

    function [LOG2:0] gray(input [LOG2:0] binary);
        gray = binary ^ (binary >> 1);
    endfunction

    wire [LOG2:0] next_written = written + 1'b1;
    wire [LOG2:0] next_taken   = taken + 1'b1;

    // Full: the writer is a whole turn ahead, in Gray code the two upper bits differ and the others do not.
    assign full_o  = written_gray == {~taken_seen[LOG2:LOG2-1], taken_seen[LOG2-2:0]};
    assign empty_o = taken_gray == written_seen;
    assign data_o  = words[taken[LOG2-1:0]];

    initial begin
        {written, written_gray, taken_maybe, taken_seen} = {4*(LOG2+1){1'b0}};
        {taken, taken_gray, written_maybe, written_seen} = {4*(LOG2+1){1'b0}};
    end

    always @(posedge write_clk_i) begin
        taken_maybe <= taken_gray;
        taken_seen  <= taken_maybe;
        if (push_i) begin
            words[written[LOG2-1:0]] <= data_i;
            written      <= next_written;
            written_gray <= gray(next_written);
        end
    end

    always @(posedge read_clk_i) begin
        written_maybe <= written_gray;
        written_seen  <= written_maybe;
        if (pop_i) begin
            taken      <= next_taken;
            taken_gray <= gray(next_taken);
        end
    end

`ifdef FORMAL
    // Any two clocks: an edge of either, both or none at each step.
    (* gclk *) wire step;
    (* anyconst *) reg [LOG2:0] place;
    reg [WIDTH-1:0] value;
    reg             inside = 1'b0;
    reg             write_before = 1'b0, read_before = 1'b0, past = 1'b0;
    reg [LOG2:0]    gray_before = {(LOG2+1){1'b0}}, taken_before = {(LOG2+1){1'b0}};
    wire            write_edge = write_clk_i && !write_before, read_edge = read_clk_i && !read_before;
    wire [LOG2:0]   count = written - taken;

    function [LOG2:0] binary(input [LOG2:0] code);
        integer b;
        begin
            binary[LOG2] = code[LOG2];
            for (b = LOG2 - 1; b >= 0; b = b - 1)
                binary[b] = binary[b+1] ^ code[b];
        end
    endfunction
    wire [LOG2:0] w1 = binary(written_maybe), w2 = binary(written_seen);
    wire [LOG2:0] t1 = binary(taken_maybe), t2 = binary(taken_seen);
    wire [LOG2:0] held = written - t2; // as the writer sees it

    always @* begin
        assume (!(push_i && full_o));
        assume (!(pop_i && empty_o));
    end
    always @(posedge step) begin
        past         <= 1'b1;
        write_before <= write_clk_i;
        read_before  <= read_clk_i;
        gray_before  <= written_gray;
        taken_before <= taken_gray;
        // What belongs to a clock changes with its edges only.
        if (past && !write_edge) assume ($stable(push_i) && $stable(data_i));
        if (past && !read_edge)  assume ($stable(pop_i));
        if (!past) assume (!write_clk_i && !read_clk_i);
    end
    // The word with number `place`, wherever it is: it comes out as it went in.
    reg push_before = 1'b0, pop_before = 1'b0;
    reg [WIDTH-1:0] data_before;
    always @(posedge step) begin
        push_before <= push_i;
        pop_before  <= pop_i;
        data_before <= data_i;
    end
    reg [LOG2:0] written_before = {(LOG2+1){1'b0}}, read_place_before = {(LOG2+1){1'b0}};
    always @(posedge step) begin
        written_before    <= written;
        read_place_before <= taken;
        if (written != written_before && written_before == place) begin
            value  <= data_before;
            inside <= 1'b1;
        end else if (taken != read_place_before && read_place_before == place) begin
            inside <= 1'b0;
        end
    end
    always @* begin
        // One bit at most of what crosses changes at a time, and only where it is registered.
        assert ((gray_before ^ written_gray) == {(LOG2+1){1'b0}} ||
                ((gray_before ^ written_gray) & ((gray_before ^ written_gray) - 1'b1)) == {(LOG2+1){1'b0}});
        assert ((taken_before ^ taken_gray) == {(LOG2+1){1'b0}} ||
                ((taken_before ^ taken_gray) & ((taken_before ^ taken_gray) - 1'b1)) == {(LOG2+1){1'b0}});
        assert (written_gray == gray(written) && taken_gray == gray(taken));
        // Never more than fits; what the other side sees is behind the truth, never ahead of it.
        assert (count <= (1 << LOG2));
        assert (written - w1 <= written - w2 && written - w2 <= written - taken);
        assert (taken - t1 <= taken - t2 && held <= (1 << LOG2));
        // In order and unchanged.
        if (inside && read_place_before == place && written_before == written && taken == place && !empty_o)
            assert (data_o == value);
        cover (full_o);
        cover (!empty_o && taken[LOG2] && data_o != {WIDTH{1'b0}});
    end
`endif
endmodule
