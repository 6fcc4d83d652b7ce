// SPDX-License-Identifier: MIT
//
// ascon: computes Ascon-AEAD128 and Ascon-Hash256 (NIST SP 800-232) for buffers in DDR3, with one
// round per clock. Registers: ascon.regs.json. Page: README.md.
//
// State, key and message are processed in 64-bit words. Byte n of memory is in bits 8n+7..8n, as in
// the standard.

`default_nettype none

module ascon (
    `include "slot_ports.vh"
    `include "memory_ports.vh"
    output wire        irq_o,
    output wire        idle_o // high while no job is in progress
);
    `include "ascon_regs.vh"

    // Initial values by sections 4 and 5 of the standard. They contain the version, the numbers of
    // rounds, the size of the tag or digest in bits, and the rate.
    localparam [63:0] IV_AEAD = 64'h00001000_808C0001, IV_HASH = 64'h00000801_00CC0002;
    localparam [3:0]  TWELVE_ROUNDS = 4'd0, EIGHT_ROUNDS = 4'd4, LAST_ROUND = 4'd11;
    // kind of data that a pass processes
    localparam [1:0]  ASSOCIATED = 2'd0, MESSAGE = 2'd1, WIPE = 2'd2;
    localparam [3:0]  WAIT_FOR_START = 4'd0, ROUNDS = 4'd1, FIRST_WORDS = 4'd2, ADD_KEY = 4'd3,
                      LOAD_SIZE = 4'd4, SEPARATE = 4'd5, LOAD_TARGET = 4'd6, LOAD_SOURCE = 4'd7,
                      WORD = 4'd8, FINAL_KEY = 4'd9, LOAD_TAG = 4'd10, TAG_WORD = 4'd11,
                      DIGEST = 4'd12, FLUSH = 4'd13, DRAIN = 4'd14, CLEAR = 4'd15;

    reg [3:0]   state, after;   // after: state that follows the rounds
    // Flags: one for each of the states ROUNDS, WORD, LOAD_SOURCE, LOAD_TAG, TAG_WORD, DIGEST and
    // WAIT_FOR_START (idle). They are flip-flops because of their high fan-out, or because memory
    // waits for them. busy is !idle.
    reg         in_rounds, in_word, in_source, in_tag, in_tag_word, in_digest, idle, busy;
    // keyed: the operand is a word of the key; from_memory: the operand is a word from memory
    reg         keyed, from_memory;
    // the operand is ciphertext, so it replaces the word of the state instead of being added
    reg         deciphers;
    reg [1:0]   pass;
    reg         decrypt, hash;
    // state of Ascon, S4 .. S0; 0 while idle, except that S4 and S3 may hold the nonce
    reg [319:0] s;
    reg [127:0] key;
    // number of 32-bit words of the key, and of the nonce, that have been written, 0 to 4
    reg [2:0]   key_words, nonce_words;
    // high for one clock after a word of the key was written; key_words increases one clock later
    reg         key_came;
    reg [3:0]   round;
    reg [23:0]  left;           // bytes left
    // flags in state WORD. few: fewer than eight bytes are left; none: no byte is left, so the word
    // is only padding
    reg         few, none;
    // index of the word in its block, tag or digest; in the states ADD_KEY and FINAL_KEY, 1 and 2
    // select a half of the key
    reg [1:0]   index;
    reg         differs, valid, aborted, wipe;
    // clear: s becomes 0; acting: bus accesses wait, because `clear` or a command takes effect
    reg         clear, acting;
    // one bit per register, in the order of put_job: the value of the register is misaligned or too
    // large
    reg [5:0]   bad;

    // ---- registers ----
    wire        control, put_key, nonce, ready, drained, done, refused;
    wire [4:0]  command;        // value written to CONTROL, delayed by one clock
    // write pulses of AD_SIZE, SIZE, AD_BASE, SOURCE, TARGET and TAG, in this order
    wire [5:0]  put_job;
    wire [31:0] setting;        // value of the register that the current state reads
    reg  [2:0]  wanted;

    ascon_regs u_registers (
        .clk_i(clk_i), .rst_i(rst_i),
        .bus_valid_i(bus_valid_i && !acting), .bus_write_i(bus_write_i), .bus_addr_i(bus_addr_i),
        .bus_wdata_i(bus_wdata_i), .bus_ready_o(ready), .bus_rdata_o(bus_rdata_o),
        .bus_error_o(bus_error_o), .irq_o(irq_o),
        .done_event_i(done), .refused_event_i(refused),
        .control_write_o(control),
        .control_encrypt_o(command[ASCON_CONTROL_ENCRYPT_LSB]),
        .control_decrypt_o(command[ASCON_CONTROL_DECRYPT_LSB]),
        .control_hash_o(command[ASCON_CONTROL_HASH_LSB]),
        .control_abort_o(command[ASCON_CONTROL_ABORT_LSB]),
        .control_forget_o(command[ASCON_CONTROL_FORGET_LSB]),
        .status_busy_i(!idle), .status_valid_i(valid), .status_aborted_i(aborted),
        .key_write_o(put_key), .nonce_write_o(nonce),
        .ad_size_write_o(put_job[0]), .size_write_o(put_job[1]), .ad_base_write_o(put_job[2]),
        .source_write_o(put_job[3]), .target_write_o(put_job[4]), .tag_write_o(put_job[5]),
        .busy_i(!idle), .ram_addr_i(wanted), .ram_o(setting));

    // Commands pass through flip-flops, because FORGET drives 448 flip-flops. They take effect one
    // clock after their write, and no bus access can take place in between.
    wire start   = idle && |command[2:0] && command[4:3] == 2'd0;
    wire aead    = !command[ASCON_CONTROL_HASH_LSB];
    wire go      = start && bad == 6'd0 && (!aead || (key_words[2] && nonce_words[2]));
    wire abort   = command[ASCON_CONTROL_ABORT_LSB];
    wire forget  = command[ASCON_CONTROL_FORGET_LSB] && idle;
    wire put_nonce = nonce && !nonce_words[2];
    assign refused = start && !go;
    assign bus_ready_o = ready && !acting;

    // clears the state; `drained` also ends the pass that overwrites a message with zeros
    wire clears  = (go && !aead) || forget || (idle && abort) || drained;
    always @(posedge clk_i) begin
        clear   <= rst_i || clears;
        acting  <= rst_i || clears || control;
    end

    // ---- memory ----
    always @* case (state)
        LOAD_SIZE:   wanted = pass == ASSOCIATED ? ASCON_AD_SIZE[2:0] : ASCON_SIZE[2:0];
        LOAD_TARGET: wanted = ASCON_TARGET[2:0];
        LOAD_SOURCE: wanted = pass == ASSOCIATED ? ASCON_AD_BASE[2:0] : ASCON_SOURCE[2:0];
        default:     wanted = ASCON_TAG[2:0];
    endcase

    wire        read_valid, read_idle, write_ready, write_idle;
    wire [63:0] read_data;
    // high if both streams were idle one clock ago. It is out of date in the clock after a start or
    // a word; no state reads it in that clock.
    reg         both_idle;
    wire [23:0] words = in_tag ? 24'd2 : {3'd0, left[23:3]} + {23'd0, |left[2:0]};

    // Byte enables of this word: all eight bytes, or only the bytes that are left. A 1 bit, the
    // padding, follows the last byte.
    wire        last = in_word && few;
    wire [7:0]  be   = last ? ~(8'hFF << left[2:0]) : 8'hFF;
    wire [63:0] pad  = last ? 64'd1 << {left[2:0], 3'd0} : 64'd0;
    wire [63:0] mask = {{8{be[7]}}, {8{be[6]}}, {8{be[5]}}, {8{be[4]}},
                        {8{be[3]}}, {8{be[2]}}, {8{be[1]}}, {8{be[0]}}};

    reg  writes; // high if this pass writes its results to memory; loaded before the first word
    wire reads  = !pass[1] && !none;
    wire step   = in_word && (!reads || read_valid) && (!writes || none || write_ready);
    wire tag_step    = in_tag_word && (decrypt ? read_valid : write_ready);
    wire digest_step = in_digest && write_ready;

    npi_stream #(.ADDR_BITS(32), .WORD_BITS(24)) u_stream (
        `include "memory_connect.vh"
        .clk_i(clk_i), .rst_i(rst_i),
        .read_start_i(in_source || (in_tag && decrypt && both_idle)),
        .read_base_i(setting[31:6]), .read_words_i(words),
        .read_stop_i(state == FLUSH), .read_valid_o(read_valid), .read_data_o(read_data),
        .read_take_i((step && reads) || (tag_step && decrypt)), .read_idle_o(read_idle),
        .write_start_i((state == LOAD_TARGET || (in_tag && !decrypt)) && both_idle),
        .write_base_i(setting[31:6]),
        .write_valid_i((step && writes && !none) || (tag_step && !decrypt) || digest_step),
        .write_data_i(sum), .write_be_i(be),
        .write_ready_o(write_ready), .write_flush_i(state == FLUSH || state == FINAL_KEY),
        .write_idle_o(write_idle)
    );
    assign idle_o         = idle && both_idle && read_idle && write_idle;

    // ---- 320-bit state: each clock performs a round, or adds an operand to one word ---- The
    // operand is a word of the message, the key, the nonce or a constant. While decrypting, the
    // ciphertext replaces the word of the state; `added` is then the sum of both. `added` is a
    // separate net, which saves 72 LUTs.
    wire        use_iv   = state == FIRST_WORDS && index == 2'd0;
    wire [63:0] operand  = (from_memory ? read_data : 64'd0) | (busy ? 64'd0 : {2{bus_wdata_i}}) |
                           (keyed && index[0] ? key[63:0] : 64'd0) |
                           (keyed && index[1] ? key[127:64] : 64'd0) |
                           (use_iv && !hash ? IV_AEAD : 64'd0) |
                           (use_iv && hash ? IV_HASH : 64'd0) |
                           {state == SEPARATE, 63'd0};
    wire        second   = index[0] && !hash;
    wire [63:0] chosen   = in_tag_word ? (second ? s[319:256] : s[255:192])
                                       : second ? s[127:64] : s[63:0];
    // Result: encrypted or decrypted bytes, a word of the tag or its difference from the expected
    // tag, or a word of the digest.
    wire [63:0] sum      = chosen ^ operand;
    (* keep *) wire [63:0] added    = ((deciphers ? sum : operand) & mask) ^ pad;

    // Each bit of `takes` selects a half of a 64-bit word of s; `added` is added to the selected
    // halves.
    wire absorbs = step && !pass[1];
    wire [9:0] takes = {{2{(state == ADD_KEY && index[1]) || state == SEPARATE}} |
                            {put_nonce && nonce_words[1:0] == 2'd3,
                             put_nonce && nonce_words[1:0] == 2'd2},
                        {2{(state == ADD_KEY && index[0]) || (state == FINAL_KEY && index[1])}} |
                            {put_nonce && nonce_words[1:0] == 2'd1,
                             put_nonce && nonce_words[1:0] == 2'd0},
                        {2{(state == FIRST_WORDS && index == 2'd2) ||
                           (state == FINAL_KEY && index[0])}},
                        {2{(state == FIRST_WORDS && index == 2'd1) || (absorbs && index[0])}},
                        {2{use_iv || (absorbs && !index[0])}}};

    wire [319:0] permuted;
    ascon_round u_round (.state_i(s), .round_i(round), .state_o(permuted));
    integer h;
    always @(posedge clk_i) begin
        for (h = 0; h < 10; h = h + 1)
            if (in_rounds || takes[h])
                s[32*h +: 32] <= in_rounds ? permuted[32*h +: 32] :
                                             s[32*h +: 32] ^ added[32*(h & 1) +: 32];
        if (clear)
            s <= 320'd0;
        if (put_key)
            key <= {bus_wdata_i, key[127:32]};
        if (rst_i || forget)
            key <= 128'd0;
    end

    // ---- control ----
    assign drained = state == DRAIN && both_idle;
    assign done    = drained && !wipe;

    task enter(input [3:0] to);
        begin
            state     <= to;
            in_rounds <= to == ROUNDS;
            in_word   <= to == WORD;
            in_source <= to == LOAD_SOURCE;
            in_tag    <= to == LOAD_TAG;
            in_tag_word <= to == TAG_WORD;
            in_digest <= to == DIGEST;
            idle      <= to == WAIT_FOR_START;
            busy      <= to != WAIT_FOR_START;
            keyed     <= to == FIRST_WORDS || to == ADD_KEY || to == FINAL_KEY;
            from_memory <= (to == WORD && !pass[1]) || (to == TAG_WORD && decrypt);
            deciphers <= to == WORD && pass[0] && decrypt;
        end
    endtask

    integer b;
    always @(posedge clk_i) begin
        few  <= left[23:3] == {20'd0, step};
        none <= left[23:3] == {20'd0, step} && left[2:0] == 3'd0;
        case (state)
            WAIT_FOR_START: if (go) begin
                decrypt <= aead && command[ASCON_CONTROL_DECRYPT_LSB] &&
                           !command[ASCON_CONTROL_ENCRYPT_LSB];
                hash    <= !aead;
                pass    <= aead ? ASSOCIATED : MESSAGE;
                round   <= TWELVE_ROUNDS;
                index   <= 2'd0;
                after   <= FIRST_WORDS;
                // hashing begins with s = 0, so CLEAR removes a nonce from s
                enter(aead ? FIRST_WORDS : CLEAR);
                differs <= 1'b0;
                valid   <= 1'b0;
                aborted <= 1'b0;
            end
            FIRST_WORDS: begin
                index <= index + 2'd1;
                after <= hash ? LOAD_SIZE : ADD_KEY;
                if (hash || index[1]) begin
                    index <= 2'd1;
                    enter(ROUNDS);
                end
            end
            ROUNDS: begin
                round <= round + 4'd1;
                if (round == LAST_ROUND)
                    enter(after);
            end
            ADD_KEY: begin
                index <= {index[0], 1'b0};
                if (index[1])
                    enter(pass == MESSAGE ? LOAD_TAG : LOAD_SIZE);
            end
            LOAD_SIZE: begin
                left  <= setting[23:0];
                index <= 2'd0;
                enter(pass == ASSOCIATED ? LOAD_SOURCE : LOAD_TARGET);
            end
            SEPARATE: begin
                pass  <= MESSAGE;
                enter(LOAD_SIZE);
            end
            LOAD_TARGET: if (both_idle)
                enter(pass == WIPE ? WORD : LOAD_SOURCE);
            // No wait is needed in LOAD_SOURCE, because the stream has been idle since LOAD_TARGET
            // or since the start.
            LOAD_SOURCE: enter(pass == ASSOCIATED && left == 24'd0 ? SEPARATE : WORD);
            WORD: if (step) begin
                left  <= last ? 24'd0 : left - 24'd8;
                index <= hash || pass == WIPE ? 2'd0 : {1'b0, last || !index[0]};
                round <= hash ? TWELVE_ROUNDS : EIGHT_ROUNDS;
                after <= !last ? WORD : hash ? DIGEST : SEPARATE;
                if (pass == WIPE)
                    enter(last ? FLUSH : WORD);
                else if (last && !hash && pass == MESSAGE)
                    enter(FINAL_KEY);
                else if (last || hash || index[0])
                    enter(ROUNDS);
            end
            FINAL_KEY: begin
                index <= {index[0], index[1]};
                round <= TWELVE_ROUNDS;
                after <= ADD_KEY;
                if (index[1])
                    enter(ROUNDS);
            end
            LOAD_TAG: if (both_idle)
                enter(TAG_WORD);
            TAG_WORD: if (tag_step) begin
                index <= 2'd1;
                if (decrypt) begin
                    differs <= differs || sum != 64'd0;
                    valid   <= index[0] && !differs && sum == 64'd0;
                    wipe    <= index[0] && (differs || sum != 64'd0);
                end
                if (index[0])
                    enter(FLUSH);
            end
            DIGEST: if (digest_step) begin
                index <= index + 2'd1;
                round <= TWELVE_ROUNDS;
                after <= DIGEST;
                enter(index == 2'd3 ? FLUSH : ROUNDS);
            end
            FLUSH: enter(DRAIN);
            DRAIN: if (drained) begin
                wipe  <= 1'b0;
                pass  <= wipe ? WIPE : ASSOCIATED;
                after <= WAIT_FOR_START;
                enter(wipe ? LOAD_SIZE : CLEAR);
            end
            default: enter(after); // CLEAR
        endcase
        if (abort && !idle && pass != WIPE && state != FLUSH && state != DRAIN &&
            state != CLEAR) begin
            aborted <= 1'b1;
            valid   <= 1'b0;
            wipe    <= decrypt && pass == MESSAGE;
            enter(FLUSH);
        end

        both_idle <= read_idle && write_idle;
        writes    <= pass[1] || (pass[0] && !hash);
        key_came  <= put_key && !rst_i;
        if (key_came && !key_words[2])
            key_words <= key_words + 3'd1;
        if (put_nonce)
            nonce_words <= nonce_words + 3'd1;
        if (go || forget || (idle && abort))
            nonce_words <= 3'd0;
        if (forget)
            key_words <= 3'd0;
        for (b = 0; b < 6; b = b + 1)
            if (put_job[b])
                bad[b] <= b < 2 ? |bus_wdata_i[31:24] : |bus_wdata_i[5:0];
        if (rst_i) begin
            enter(WAIT_FOR_START);
            pass        <= ASSOCIATED;
            key_words   <= 3'd0;
            nonce_words <= 3'd0;
            bad         <= 6'd0;
            valid       <= 1'b0;
            aborted     <= 1'b0;
            wipe        <= 1'b0;
        end
    end

`ifdef FORMAL
    // Invariants for formal.idle_ascon: the flags agree with the state, and the stream is idle
    // without a job and before the first LOAD_SOURCE.
    (* hierconn *) wire [23:0] \u_stream.to_give ; // signals of u_stream
    (* hierconn *) wire [5:0]  \u_stream.outstanding ;
    (* hierconn *) wire [2:0]  \u_stream.filled , \u_stream.bursts ;
    (* hierconn *) wire        \u_stream.request ;
    reg past = 1'b0;
    always @(posedge clk_i)
        past <= !rst_i;
    wire to_source = after == ADD_KEY || after == LOAD_SIZE;
    wire before = state == FIRST_WORDS || state == ADD_KEY || state == LOAD_SIZE || in_source ||
                  (in_rounds && to_source);
    wire at_first = idle || state == CLEAR || (pass == ASSOCIATED && before);
    always @* if (past && !rst_i) begin
        assert (in_rounds == (state == ROUNDS) && in_word == (state == WORD));
        assert (in_source == (state == LOAD_SOURCE) && in_tag == (state == LOAD_TAG));
        assert (in_tag_word == (state == TAG_WORD) && in_digest == (state == DIGEST));
        assert (idle == (state == WAIT_FOR_START) && busy == !idle);
        assert (keyed == (state == FIRST_WORDS || state == ADD_KEY || state == FINAL_KEY));
        assert (pass <= WIPE);
        assert (!in_word || from_memory == (pass != WIPE));
        assert (!in_word || deciphers == (pass == MESSAGE && decrypt));
        assert (!in_rounds || to_source || after == WORD || after == SEPARATE || after == DIGEST);
        assert (state != CLEAR || after == WAIT_FOR_START ||
                (after == FIRST_WORDS && pass == MESSAGE));
        assert (!at_first || (\u_stream.to_give == 24'd0 && \u_stream.outstanding == 6'd0 &&
                              \u_stream.filled == 3'd0 && \u_stream.bursts == 3'd0 &&
                              !\u_stream.request ));
    end
`endif
`ifdef COVER_POINTS
    refused_job: cover property (@(posedge clk_i) refused);
    wrong_tag: cover property (@(posedge clk_i)
        tag_step && decrypt && index[0] && (differs || sum != 64'd0));
    aborted_with_plaintext_out: cover property (@(posedge clk_i)
        abort && decrypt && pass == MESSAGE && !idle);
    no_associated_data: cover property (@(posedge clk_i)
        in_source && pass == ASSOCIATED && left == 24'd0);
    block_of_padding_only: cover property (@(posedge clk_i) step && none && last);
    memory_holds_up: cover property (@(posedge clk_i) in_word && writes && !none && !write_ready);
`endif
endmodule
