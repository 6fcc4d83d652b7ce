// SPDX-License-Identifier: MIT
//
// axis_filter: sends a buffer through a core with one AXI-Stream input and one AXI-Stream output,
// of 8, 16, 32 or 64 bits, and writes the core's output to another buffer (`./icesoc core foreign
// --bus axis`).
//
// An operation ends with the core's tlast. If the core has no tlast (LAST 0), it ends after as many
// output beats as input beats. An operation with 0 bytes is refused. If the output is longer than
// the buffer, the part that fits into the buffer is written, and the operation is reported as
// refused.

`default_nettype none

module axis_filter #(
    parameter WIDTH     = 8,   // data width of the core's input and output, bits: 8, 16, 32 or 64
    parameter BYTE_BITS = 11,  // width of byte counts, 7..32
    parameter ROOM      = 1024, // size of the target buffer, bytes; a multiple of 8
    parameter LAST      = 1    // 0: the output of the core has no tlast
) (
    `include "memory_ports.vh"
    input  wire                 clk_i,
    input  wire                 rst_i,
    // the operation
    input  wire                 core_rst_i, // aborts the operation
    input  wire                 start_i,
    input  wire [31:0]          source_i,   // byte address of the source, a multiple of 64
    input  wire [BYTE_BITS-1:0] bytes_i,    // number of bytes; a multiple of WIDTH / 8, unless the
                                            // core uses tkeep
    input  wire [31:0]          target_i,
    output wire                 done_o,     // high for one clock at the end of an operation
    output wire                 refused_o,  // with done
    output wire [BYTE_BITS-1:0] bytes_o,    // number of output bytes, valid starting with done_o
    // stream to the core
    output wire                 m_axis_tvalid_o,
    input  wire                 m_axis_tready_i,
    output wire [WIDTH-1:0]     m_axis_tdata_o,
    output wire [WIDTH/8-1:0]   m_axis_tkeep_o,
    output wire                 m_axis_tlast_o,
    // stream from the core
    input  wire                 s_axis_tvalid_i,
    output wire                 s_axis_tready_o,
    input  wire [WIDTH-1:0]     s_axis_tdata_i,
    input  wire [WIDTH/8-1:0]   s_axis_tkeep_i,
    input  wire                 s_axis_tlast_i
);
    // number of bytes per beat, and of beats per word
    localparam KEEP = WIDTH / 8, BEATS = 64 / WIDTH;
    localparam [31:0] BYTES_OF_BEAT = KEEP, BEATS_OF_WORD = BEATS;
    localparam [3:0]  LAST_BEAT = BEATS_OF_WORD[3:0] - 4'd1;
    localparam [BYTE_BITS-1:0] STEP = BYTES_OF_BEAT[BYTE_BITS-1:0];

    localparam WORD_BITS = BYTE_BITS - 2; // width of word counts

    // the operation has not begun, because transfers of an earlier, aborted operation are still in
    // progress
    reg         waiting;
    reg         writing; // the output is being written to memory
    // closing: the last word was taken, and the rest of its burst is being filled; closed: the
    // module waits until this burst is in memory
    reg         closing, closed;
    reg         empty, over; // refused
    reg  [BYTE_BITS-1:0] left; // number of bytes that have not been sent to the core
    // number of bytes that were written; while `waiting` is high, the size of the next operation
    reg  [BYTE_BITS-1:0] bytes;
    wire        read_idle, write_idle, write_ready, word_valid;
    wire [63:0] word;
    wire        go        = waiting && read_idle && write_idle && !core_rst_i;
    wire        word_last = left <= {{(BYTE_BITS-4){1'b0}}, 4'd8};
    wire [7:0]  word_keep = word_last &&
        left[2:0] != 3'd0 ? 8'hFF >> (4'd8 - {1'b0, left[2:0]}) : 8'hFF;
    wire        word_ready;

    // ---- splits each word from memory into beats ----
    reg  [3:0]  beat;
    // byte enables of the bytes after this beat
    wire [7:0]  rest    = word_keep >> KEEP * beat >> KEEP;
    wire        is_last = beat == LAST_BEAT || rest == 8'd0;
    wire        sent    = m_axis_tvalid_o && m_axis_tready_i;
    wire [63:0] shifted = word >> WIDTH * beat;
    wire [7:0]  kept    = word_keep >> KEEP * beat;
    assign m_axis_tvalid_o = word_valid;
    assign m_axis_tdata_o  = shifted[WIDTH-1:0];
    assign m_axis_tkeep_o  = kept[KEEP-1:0];
    assign m_axis_tlast_o  = word_last && is_last;
    assign word_ready      = m_axis_tready_i && is_last;

    // ---- joins beats into words ----
    reg  [3:0]  place;
    reg         full;      // the word is complete
    reg         ends;      // the complete word is the last word of the packet
    reg  [63:0] out;
    reg  [7:0]  out_keep;
    // number of bytes that a core without tlast must still output
    reg  [BYTE_BITS-1:0] awaited;
    wire        room      = bytes != ROOM[BYTE_BITS-1:0];
    wire        out_ready = writing && (write_ready || !room);
    wire        given     = full && out_ready;
    wire        came = s_axis_tvalid_i && s_axis_tready_o;
    wire        last = LAST != 0 ? s_axis_tlast_i : awaited <= STEP;
    assign s_axis_tready_o = !full || out_ready;

    reg [3:0] out_bytes; // number of bytes up to the last byte enabled by tkeep
    integer b;
    always @* begin
        out_bytes = 4'd0;
        for (b = 0; b < 8; b = b + 1)
            if (out_keep[b])
                out_bytes = b[3:0] + 4'd1;
    end
    always @(posedge clk_i) begin
        if (sent)
            beat <= is_last ? 4'd0 : beat + 4'd1;
        if (given) begin
            full     <= 1'b0;
            out_keep <= 8'd0;
            over     <= over || !room;
            if (room)
                bytes <= bytes + {{(BYTE_BITS-4){1'b0}}, ends ? out_bytes : 4'd8};
            writing  <= !ends;
        end
        if (came) begin
            for (b = 0; b < BEATS; b = b + 1)
                if ({28'd0, place} == b) begin
                    out[WIDTH*b +: WIDTH]   <= s_axis_tdata_i;
                    out_keep[KEEP*b +: KEEP] <= s_axis_tkeep_i;
                end
            place   <= last || place == LAST_BEAT ? 4'd0 : place + 4'd1;
            full    <= last || place == LAST_BEAT;
            ends    <= last;
            awaited <= awaited - STEP;
        end
        empty <= start_i && bytes_i == {BYTE_BITS{1'b0}};
        if (start_i) begin
            waiting <= bytes_i != {BYTE_BITS{1'b0}};
            awaited <= bytes_i;
            bytes   <= bytes_i;
        end
        if (word_valid && word_ready)
            left <= word_last ? {BYTE_BITS{1'b0}} : left - {{(BYTE_BITS-4){1'b0}}, 4'd8};
        if (go) begin
            waiting <= 1'b0;
            writing <= 1'b1;
            left    <= bytes;
            bytes   <= {BYTE_BITS{1'b0}};
            over    <= 1'b0;
        end
        closing <= given && ends;
        closed  <= closing || (closed && !write_idle);
        if (core_rst_i || rst_i) begin
            waiting  <= 1'b0;
            writing  <= 1'b0;
            closing  <= 1'b0;
            closed   <= 1'b0;
            empty    <= 1'b0;
            left     <= {BYTE_BITS{1'b0}};
            beat     <= 4'd0;
            place    <= 4'd0;
            full     <= 1'b0;
            out_keep <= 8'd0;
        end
    end
    assign done_o    = empty || (closed && write_idle);
    assign refused_o = empty || over;
    assign bytes_o   = bytes;

    wire write = writing && full && room && !core_rst_i;
    wire flush = closing || core_rst_i;
    npi_stream #(.WORD_BITS(WORD_BITS)) u_stream (
        `include "memory_connect.vh"
        // rst_i instead of core_rst_i: words that were requested must be taken even after
        // core_rst_i
        .clk_i(clk_i), .rst_i(rst_i),
        .read_start_i(go), .read_base_i(source_i[31:6]),
        .read_words_i({1'b0, bytes[BYTE_BITS-1:3]} + {{(WORD_BITS-1){1'b0}}, |bytes[2:0]}),
        .read_stop_i(core_rst_i), .read_valid_o(word_valid), .read_data_o(word),
        .read_take_i(word_valid && word_ready), .read_idle_o(read_idle),
        .write_start_i(go), .write_base_i(target_i[31:6]),
        .write_valid_i(write), .write_data_i(out), .write_be_i(out_keep),
        .write_ready_o(write_ready),
        .write_flush_i(flush), .write_idle_o(write_idle)
    );

    wire unused = &{1'b0, shifted, kept, source_i[5:0], target_i[5:0], 1'b0};

`ifdef FORMAL
    // Proves that each word is split into beats and beats are joined into words, once and in order,
    // and that the module keeps the rules of npi_stream. npi_stream is proven separately; here it
    // is removed, and only the properties that its proof shows are assumed.
    reg past = 1'b0;
    reg [3:0] f_sent;  // number of beats of the current word that the core has taken
    reg [3:0] f_size;  // number of beats in the current word
    reg [3:0] f_count; // number of output beats that have not been passed to npi_stream
    // one lane of a word, chosen by the prover, and its bytes as they arrived
    (* anyconst *) reg [3:0] f_lane;
    reg [WIDTH-1:0] f_data;
    reg [KEEP-1:0]  f_keep;
    // number of bytes of the operation, and number of those bytes that have arrived
    reg [BYTE_BITS-1:0] f_bytes = 0, f_came = 0;
    reg [WORD_BITS-1:0] f_left = 0;   // number of words that npi_stream must still deliver
    // number of words that were passed to npi_stream in this operation
    reg [WORD_BITS-1:0] f_written = 0;
    wire [3:0] f_place = given ? 4'd0 : f_count; // position of the arriving beat in its word
    wire       f_rst   = rst_i || core_rst_i;
    integer f;
    initial assume (rst_i);
    always @* begin
        f_size = 4'd0;
        for (f = 0; f < 8; f = f + KEEP)
            f_size = f_size + {3'd0, word_keep[f]};
        assume (!word_valid || f_left != 0);
        assume (!read_idle || f_left == 0);
        // no operation is started during another operation
        assume (!start_i || !(waiting || writing || closing || closed));
        assume ((bytes_i & (STEP - 1'b1)) == {BYTE_BITS{1'b0}});
        assume ({28'd0, f_lane} < BEATS);
    end
    always @(posedge clk_i) begin
        past    <= !f_rst;
        f_sent  <= f_rst || (word_valid && word_ready) ? 4'd0 : f_sent + {3'd0, sent};
        f_count <= f_rst ? 4'd0 : f_place + {3'd0, came};
        f_came  <= start_i ? {BYTE_BITS{1'b0}} :
            f_came + (came && f_came != f_bytes ? STEP : {BYTE_BITS{1'b0}});
        if (start_i)
            f_bytes <= bytes_i;
        if (came && f_place == f_lane)
            {f_data, f_keep} <= {s_axis_tdata_i, s_axis_tkeep_i};
        if (f_rst)
            f_left <= 0;
        else if (go)
            f_left <= {1'b0, f_bytes[BYTE_BITS-1:3]} + {{(WORD_BITS-1){1'b0}}, |f_bytes[2:0]};
        else
            f_left <= f_left - {{(WORD_BITS-1){1'b0}}, word_valid && word_ready};
        if (go)
            f_written <= 0;
        else if (write && write_ready)
            f_written <= f_written + 1'b1;
        if (past && !f_rst) begin
            // npi_stream keeps its word stable until it is taken
            if ($past(word_valid && !word_ready))
                assume (word_valid && $stable(word));
            if ($past(m_axis_tvalid_o && !m_axis_tready_i))
                assert (m_axis_tvalid_o &&
                        $stable({m_axis_tdata_o, m_axis_tkeep_o, m_axis_tlast_o}));
            if ($past(full && !out_ready))
                assert (full && $stable({out, out_keep, ends}));
            if ($past(came))
                assert (full == ($past(last) || f_count == BEATS) && ends == $past(last));
            if ($past(start_i))
                assert (waiting == (f_bytes != 0) && !writing &&
                        (waiting ? !empty : done_o && refused_o));
            else
                assert (!empty && waiting == $past(waiting && !go) &&
                        writing == $past(go || (writing && !(given && ends))));
            // The operation ends when its last burst is filled up and in memory.
            assert (closing == $past(given && ends) &&
                    (!done_o || empty || $past(closing || closed)));
            // The number of bytes is correct: each word before the last word counts completely; in
            // the last word, the bytes up to the last enabled byte count.
            if ($past(given && ends))
                assert (over || bytes == $past(bytes) + $past(out_bytes));
        end
    end
    always @* if (past && !f_rst) begin
        // Rules of npi_stream: the module starts npi_stream only when it is idle, and passes no
        // word together with a start or a flush. npi_stream writes every word for which the buffer
        // has room.
        assert (!go || (read_idle && write_idle && !write && !flush));
        assert (!flush || !write);
        assert ({2'd0, waiting} + {2'd0, writing} + {2'd0, closing} + {2'd0, closed} <= 3'd1);
        assert (!(writing || closing || closed) || bytes <= ROOM);
        assert (!writing || bytes == {f_written, 3'd0});
        assert (!(writing && over) || !room);
        // There are as many words as the bytes need; the last word contains the remaining bytes.
        assert (f_left == {1'b0, left[BYTE_BITS-1:3]} + |left[2:0]);
        assert (!waiting || bytes == f_bytes);
        assert (!word_valid ||
                (word_last == (f_left == 1) &&
                 f_size == (word_last ? left >> $clog2(KEEP) : 8 / KEEP)));
        // Splitting: all beats of a word are sent. The word is removed from the input in the clock
        // in which its last beat is sent.
        assert (beat == f_sent && m_axis_tvalid_o == word_valid);
        if (word_valid) begin
            assert (f_sent < f_size && word_ready == (m_axis_tready_i && f_sent + 4'd1 == f_size));
            assert (m_axis_tdata_o == word[WIDTH*f_sent +: WIDTH] &&
                    m_axis_tkeep_o == word_keep[KEEP*f_sent +: KEEP]);
            assert (m_axis_tlast_o == (word_last && f_sent + 4'd1 == f_size));
        end
        // Joining: each beat is at its position, and bytes after the last beat are not enabled.
        assert ({28'd0, f_count} <= BEATS &&
                (full ? place == 4'd0 && f_count != 4'd0 : place == f_count && place <= LAST_BEAT));
        assert (f_lane >= f_count ? out_keep[KEEP*f_lane +: KEEP] == 0
                                  : out[WIDTH*f_lane +: WIDTH] == f_data &&
                                      out_keep[KEEP*f_lane +: KEEP] == f_keep);
        assert (s_axis_tready_o == (!full || out_ready));
        cover (sent && f_size == BEATS - 1 && m_axis_tlast_o);
        cover (came && last && f_came != f_bytes);
        cover (over && done_o);
        cover (done_o && !refused_o && bytes == 3);
        cover (given && ends && f_count == BEATS - 1 && came);
    end
    // Without tlast, the packet ends with the last beat that the core must output.
    always @* if (past && !f_rst && LAST == 0 && f_came != f_bytes) begin
        assert (awaited == f_bytes - f_came);
        assert (last == (f_bytes - f_came == STEP));
    end
`endif
`ifdef COVER_POINTS
    filter_is_given_up: cover property (@(posedge clk_i) core_rst_i && word_valid);
    filter_core_holds_up: cover property (@(posedge clk_i) m_axis_tvalid_o && !m_axis_tready_i);
`endif
endmodule
