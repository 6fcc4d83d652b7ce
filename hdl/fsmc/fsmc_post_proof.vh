// SPDX-License-Identifier: MIT
//
// fsmc_post_proof: every halfword that fsmc_post accepts reaches the memory, in order; only for the prover (formal.fsmc_post).

    // `place` is the halfword under observation, any; others may write there while nothing waits.
    (* anyconst *) reg [ADDR_BITS-1:0] place;
    (* anyseq *) reg foreign;
    (* anyseq *) reg [WIDTH-1:0] foreign_data;
    reg [WIDTH-1:0] memory, newest; // the memory's value there; the value written there last
    localparam HALF = WIDTH / 2, DEPTH = 1 << LOG2;
    reg past = 1'b0;
    wire [1:0] place_lane = place[1:0];
    // The model of the port's write FIFO keeps, of every word, the halfword under observation and its byte enables.
    reg [WIDTH+1:0] fifo [0:DEPTH-1];
    wire [WIDTH+1:0] open_half = {push_be_o[2*place_lane +: 2], push_data_o[WIDTH*place_lane +: WIDTH]};
    always @(posedge clk_i)
        if (push_o)
            fifo[tail] <= open_half;

    // `after` is the memory's value after each word that waits has been written, oldest first; the open word is
    // the last of them.
    wire [WIDTH*(DEPTH+1)-1:0] after;
    assign after[WIDTH-1:0] = memory;
    genvar q;
    generate
        for (q = 0; q < DEPTH; q = q + 1) begin : g_after
            wire [LOG2-1:0] at = head + q;
            wire closed = q < count;
            wire [WORD-1:0] addr_ram = addrs[at];
            wire [WIDTH+1:0] half_ram = fifo[at];
            wire [WORD-1:0] addr = closed ? addr_ram : open_addr;
            wire [WIDTH-1:0] data;
            wire [1:0] be;
            assign {be, data} = closed ? half_ram : open_half;
            wire hits = (closed || (q == count && open)) && addr == place[ADDR_BITS-1:2];
            assign after[WIDTH*(q+1) +: HALF] = hits && be[0] ? data[HALF-1:0] : after[WIDTH*q +: HALF];
            assign after[WIDTH*(q+1)+HALF +: HALF] = hits && be[1] ? data[WIDTH-1:HALF] : after[WIDTH*q+HALF +: HALF];
        end
    endgenerate
    wire [WIDTH-1:0] final_value = after[WIDTH*DEPTH +: WIDTH];
    wire [WIDTH-1:0] head_data;
    wire [1:0] head_be;
    assign {head_be, head_data} = fifo[head];

    reg more_was = 1'b0, more = 1'b0; // a clock ago, and two
    always @(posedge clk_i) begin
        past <= 1'b1;
        {more, more_was} <= {more_was, more_room_o && past};
        if (past)
            assume (!rst_i && $stable(place));
        else
            assume (rst_i && !wr_i && !foreign && !word_taken_i);
        assume (!word_taken_i || word_valid_o);
        assume (!foreign || (idle_o && !wr_i));

        if (accept && wr_addr_i == place)
            newest <= {wr_be_i[1] ? wr_data_i[WIDTH-1:HALF] : newest[WIDTH-1:HALF],
                         wr_be_i[0] ? wr_data_i[HALF-1:0] : newest[HALF-1:0]};
        if (word_taken_i && word_addr_o == place[ADDR_BITS-1:2])
            memory <= {head_be[1] ? head_data[WIDTH-1:HALF] : memory[WIDTH-1:HALF],
                         head_be[0] ? head_data[HALF-1:0] : memory[HALF-1:0]};
        if (foreign) begin
            memory <= foreign_data;
            newest <= foreign_data;
        end
        if (rst_i)
            newest <= memory;

        if (past && !rst_i) begin
            assert (final_value == newest);
            // Two writes may come before the processor can see that there is no room.
            assert (!wr_lost_o || !$past(room_o));
            assert (!(wr_lost_o && more)); // or three
            // A word that has all its bytes does not wait for another, or for a flush.
            assert (push_o || !(open && push_be_o == 8'hFF && count != DEPTH - 1));
            // The oldest word does not change until it is taken.
            if ($past(word_valid_o && !word_taken_i && !rst_i))
                assert (word_valid_o && $stable(word_addr_o));
        end
        cover (past && wr_lost_o);
        cover (past && !$past(idle_o) && idle_o && memory != $past(memory));
    end
