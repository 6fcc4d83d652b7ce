// SPDX-License-Identifier: MIT
//
// primitives_test: checks the models with which netlists are simulated and proven against the rules
// in Xilinx's guides: UG389 (DSP48A1), UG383 (block RAM), UG384 (LUT RAM, shift registers,
// flip-flops, carry chains). A comment above each check states its rule.
`default_nettype none
`timescale 1ns / 1ps

module primitives_test;
    reg clk = 0;
    integer wrong = 0, i;
    task check(input ok, input [30*8-1:0] rule);
        if (!ok) begin
            wrong = wrong + 1;
            $display("primitives_test: at %0t: %0s", $time, rule);
        end
    endtask
    task edges(input integer count);
        repeat (count) begin
            #4 clk = 1;
            #4 clk = 0;
            #2;
        end
    endtask

    // Two DSP48A1: one has only the register P, the other has all registers.
    reg signed  [17:0] a = 0, b = 0, d = 0;
    reg signed  [47:0] c = 0, pcin = 0;
    reg  [7:0]  opmode = 0;
    reg  [7:0]  ce = 8'hff, rst = 0; // bits 0 to 7: A, B, C, D, M, P, OPMODE, CARRYIN
    reg         carryin = 0;
    wire signed [47:0] p0, p1, pcout;
    wire signed [35:0] m0, m1;
    wire signed [17:0] bcout;
    wire        carry0, carry1, carry_f;
    `define PORTS .A(a), .B(b), .C(c), .D(d), .PCIN(pcin), .CARRYIN(carryin), .OPMODE(opmode), \
        .CEA(ce[0]), .CEB(ce[1]), .CEC(ce[2]), .CED(ce[3]), .CEM(ce[4]), .CEP(ce[5]), \
        .CEOPMODE(ce[6]), .CECARRYIN(ce[7]), .RSTA(rst[0]), .RSTB(rst[1]), .RSTC(rst[2]), \
        .RSTD(rst[3]), .RSTM(rst[4]), .RSTP(rst[5]), .RSTOPMODE(rst[6]), .RSTCARRYIN(rst[7]), \
        .CLK(clk)
    DSP48A1 #(.A1REG(0), .B1REG(0), .CREG(0), .DREG(0), .MREG(0), .CARRYINREG(0), .CARRYOUTREG(0),
        .OPMODEREG(0), .CARRYINSEL("CARRYIN")) plain (`PORTS, .P(p0), .M(m0), .CARRYOUT(carry0));
    DSP48A1 #(.A0REG(1), .B0REG(1)) full (`PORTS, .P(p1), .M(m1), .BCOUT(bcout), .PCOUT(pcout),
        .CARRYOUT(carry1), .CARRYOUTF(carry_f));

    // UG389, OPMODE: [4] selects the pre-adder for B, and [6] makes it subtract B from D; [1:0]
    // selects X: 0, M, P, D:A:B; [3:2] selects Z: 0, PCIN, P, C; [7] changes Z + (X + carry) to Z -
    // (X + carry). [5] is the carry if CARRYINSEL selects it. The 49th bit is CARRYOUT.
    function [17:0] factor(input [7:0] op);
        factor = !op[4] ? b : op[6] ? d - b : d + b;
    endfunction
    function [48:0] sum(input [7:0] op, input carry, input [47:0] p);
        reg signed [35:0] m;
        reg [47:0] x, z;
        begin
            m = a * $signed(factor(op));
            x = op[1:0] == 0 ? 48'd0 : op[1:0] == 1 ? {{12{m[35]}}, m} : op[1:0] == 2 ? p :
                {d[11:0], a, factor(op)};
            z = op[3:2] == 0 ? 48'd0 : op[3:2] == 1 ? pcin : op[3:2] == 2 ? p : c;
            sum = op[7] ? {1'b0, z} - {1'b0, x} - {48'd0, carry}
                        : {1'b0, z} + {1'b0, x} + {48'd0, carry};
        end
    endfunction
    reg [48:0] want;
    // random operations with stable inputs; the result P may be an input of the next operation
    task dsp_random;
        for (i = 0; i < 2000; i = i + 1) begin
            {a, b, d, c, pcin} = {$random, $random, $random, $random, $random};
            {opmode, carryin}  = $random;
            if (i % 4 == 0) {a, b} = {18'h20000, i[2] ? 18'h20000 : 18'h1ffff}; // most negative
            #1 want = sum(opmode, carryin, p0);
            check(m0 == a * $signed(factor(opmode)), "M is A times B or pre-adder");
            check(carry0 == want[48], "CARRYOUT is the 49th bit");
            edges(1);
            check(p0 == want[47:0], "P is Z + X + carry");
            edges(5);
            want = sum(opmode, opmode[5], p1);
            check(bcout == factor(opmode) && pcout == p1, "BCOUT is B1, PCOUT is P");
            check(m1 == a * $signed(factor(opmode)), "M of all registers");
            edges(1);
            check(p1 == want[47:0], "P of all registers");
            check(carry1 == want[48] && carry_f == carry1, "CARRYOUT of all registers");
        end
    endtask

    // UG389, number of registers: A and B pass through two registers, then M and P. D passes
    // through one register before B1, M and P. C, OPMODE and the carry pass through one register
    // before P. PCIN passes only through P. Each register has an enable, and a reset that has
    // priority over the enable.
    reg [47:0] held;
    task latency(input integer port, input integer clocks);
        begin
            {a, b, d, c, pcin, carryin} = {18'd3, 18'd5, 18'd7, 48'd11, 48'd13, 1'b0};
            opmode = port == 4 ? 8'b00010101 : 8'b00011101; // Z is PCIN or C; X is A * (D + B)
            edges(6);
            held = p1;
            case (port)
                0: a = 4;
                1: b = 6;
                2: c = 12;
                3: d = 8;
                4: pcin = 14;
                5: opmode[5] = 1; // two registers, for OPMODE and for the carry
                6: opmode[7] = 1;
            endcase
            edges(clocks - 1);
            check(p1 == held, "fewer registers than in UG389");
            edges(1);
            check(p1 != held, "more registers than in UG389");
        end
    endtask
    task dsp_registers;
        begin
            latency(0, 4);
            latency(1, 4);
            latency(2, 2);
            latency(3, 4);
            latency(4, 1);
            latency(5, 3);
            latency(6, 2);
            for (i = 0; i < 8; i = i + 1) begin // a register keeps its value while it is disabled
                {a, b, d, c, opmode} = {18'd3, 18'd5, 18'd7, 48'd11, 8'b00111101};
                edges(6);
                held = p1;
                ce[i]  = 0;
                {a, b} = {18'd3 + (i == 0), 18'd5 + (i == 1)};
                {c, d} = {48'd11 + (i == 2), 18'd7 + (i == 3)};
                if (i == 4 || i == 5) a = 9;
                if (i == 6 || i == 7) opmode[5] = 0;
                edges(6);
                check(p1 == held, "a disabled register moved");
                ce[i] = 1;
                edges(6);
                check(p1 != held, "an enabled register rests");
            end
            ce = 0;
            for (i = 0; i < 8; i = i + 1) begin
                rst = 1 << i;
                edges(1);
                rst = 0;
                #1 case (i)
                    1: check(bcout == 0, "RSTB clears B1");
                    4: check(m1 == 0, "RSTM clears M");
                    5: check(p1 == 0, "RSTP clears P");
                    7: check(carry1 == 0, "RSTCARRYIN clears CARRYOUT");
                endcase
            end
            ce = 8'b00110000; // enables only M and P, which then depend on the cleared registers
            edges(2);
            check(m1 == 0 && p1 == 0, "RSTA, RSTC, RSTOPMODE clear");
            ce = 8'hff;
        end
    endtask

    // UG384: distributed RAM is written at the clock edge while WE is high, at the address of port
    // D (RAM32M) or A (RAM32X1D), and is read without a clock. A shift register shifts while CE is
    // high; Q is the bit at address A, and the bit at address 0 is the one that entered last.
    reg         we = 0;
    reg  [4:0]  at = 0, from = 0;
    reg  [7:0]  word = 0;
    wire [7:0]  read;
    wire        spo, dpo, srl, srl31, srl16;
    reg  [7:0]  words [0:31];
    reg  [31:0] shifted = 32'h8000_0001;
    RAM32M lut_ram (.DOA(read[1:0]), .DOB(read[3:2]), .DOC(read[5:4]), .DOD(read[7:6]),
        .ADDRA(from), .ADDRB(from), .ADDRC(from), .ADDRD(at), .DIA(word[1:0]), .DIB(word[3:2]),
        .DIC(word[5:4]), .DID(word[7:6]), .WCLK(clk), .WE(we));
    RAM32X1D dual (.SPO(spo), .DPO(dpo), .D(word[0]), .WCLK(clk), .WE(we), .A0(at[0]), .A1(at[1]),
        .A2(at[2]), .A3(at[3]), .A4(at[4]), .DPRA0(from[0]), .DPRA1(from[1]), .DPRA2(from[2]),
        .DPRA3(from[3]), .DPRA4(from[4]));
    SRLC32E #(.INIT(32'h8000_0001)) long (.Q(srl), .Q31(srl31), .A(from), .CE(we), .CLK(clk),
        .D(word[0]));
    SRL16E #(.INIT(16'h0001)) short (.Q(srl16), .A0(from[0]), .A1(from[1]), .A2(from[2]),
        .A3(from[3]), .CE(we), .CLK(clk), .D(word[0]));
    task lut_memories;
        begin
            for (i = 0; i < 32; i = i + 1) words[i] = 0;
            for (i = 0; i < 2000; i = i + 1) begin
                {at, from, word, we} = $random;
                #1 check(read == {words[at][7:6], words[from][5:0]}, "RAM32M reads");
                check(spo == words[at][0] && dpo == words[from][0], "RAM32X1D reads");
                check(srl == shifted[from] && srl31 == shifted[31], "SRLC32E reads");
                check(i < 16 || srl16 == shifted[from[3:0]] || shifted == 0, "SRL16E reads");
                edges(1);
                if (we) words[at] = word;
                if (we) shifted = {shifted[30:0], word[0]};
            end
        end
    endtask

    // UG384: a synchronous set or reset has priority over the enable; an asynchronous one needs no
    // clock. The carry output is CI if S is high, otherwise DI; O is S ^ CI.
    reg         s = 0, value = 0;
    reg         r_held = 0, s_held = 1;
    wire        r_q, s_q, c_q, p_q;
    wire [3:0]  co, o;
    FDRE fdre (.C(clk), .CE(we), .D(value), .R(s), .Q(r_q));
    FDSE #(.INIT(1)) fdse (.C(clk), .CE(we), .D(value), .S(s), .Q(s_q));
    FDCE fdce (.C(clk), .CE(we), .D(value), .CLR(s), .Q(c_q));
    FDPE #(.INIT(1)) fdpe (.C(clk), .CE(we), .D(value), .PRE(s), .Q(p_q));
    CARRY4 chain (.CO(co), .O(o), .CI(s), .CYINIT(1'b0), .DI(word[3:0]), .S(word[7:4]));
    task registers;
        for (i = 0; i < 500; i = i + 1) begin
            {s, value, we, word} = $random;
            #1 check(!s || (c_q == 0 && p_q == 1), "CLR and PRE act at once");
            check(word[7:4] != 4'hf || co[3] == s, "S high: the carry passes");
            check(word[7:4] != 0 || co == word[3:0], "S low: DI");
            check(o == (word[7:4] ^ {co[2:0], s}), "O is S ^ CI");
            edges(1);
            r_held = s ? 0 : we ? value : r_held;
            s_held = s ? 1 : we ? value : s_held;
            check(r_q == r_held && s_q == s_held, "R and S go before CE");
        end
    endtask

    // UG383: during a write, WRITE_FIRST outputs the new word, READ_FIRST the old word, and
    // NO_CHANGE the previous output. WE has one bit per byte, and a parity bit belongs to its byte.
    // Without EN nothing happens. A reset of the output does not prevent a write. Without the
    // priority "SR", the reset needs EN. The lower address bits of the narrower port are the lower
    // bits of the wider port.
    reg         en = 0, reset = 0, en_b = 0;
    reg  [3:0]  bytes = 0;
    reg  [8:0]  place = 0, place_b = 0;
    reg  [35:0] in = 0;
    wire [35:0] first, old, same, narrow_in, narrow;
    reg  [35:0] rows [0:511], shown_first, shown_old, shown_same, next;
    `define RAM(name, mode, priority, out) \
        block_ram #(.MODE_A(mode), .RESET_A(36'h5a5a5a5a5), .PRIORITY_A(priority), \
            .WIDTH_B(9)) name ( \
            .clk_a_i(clk), .en_a_i(en), .rst_a_i(reset), .we_a_i(bytes), \
            .addr_a_i({place, 5'd0}), .data_a_i(in), .data_a_o(out), .clk_b_i(clk), \
            .en_b_i(en_b), .rst_b_i(1'b0), .we_b_i(4'd0), .addr_b_i({place_b, lane, 3'd0}), \
            .data_b_i(36'd0), .data_b_o(out``_b))
    reg  [1:0]  lane = 0;
    wire [35:0] first_b, old_b, same_b;
    reg  [8:0]  shown_b;
    `RAM(write_first, "WRITE_FIRST", "CE", first);
    `RAM(read_first, "READ_FIRST", "CE", old);
    `RAM(no_change, "NO_CHANGE", "SR", same);
    task block_rams;
        begin
            for (i = 0; i < 512; i = i + 1) rows[i] = 0;
            {shown_first, shown_old, shown_same, shown_b} = 0;
            for (i = 0; i < 4000; i = i + 1) begin
                {en, en_b, bytes, place[2:0], place_b[2:0], lane} = $random;
                in    = {$random, $random};
                reset = $random & $random;
                if (place == place_b) en_b = 0; // avoids a collision, which is tested below
                next = rows[place];
                if (bytes[0]) {next[32], next[7:0]}   = {in[32], in[7:0]};
                if (bytes[1]) {next[33], next[15:8]}  = {in[33], in[15:8]};
                if (bytes[2]) {next[34], next[23:16]} = {in[34], in[23:16]};
                if (bytes[3]) {next[35], next[31:24]} = {in[35], in[31:24]};
                if (en) shown_first = reset ? 36'h5a5a5a5a5 : next;
                if (en) shown_old   = reset ? 36'h5a5a5a5a5 : rows[place];
                if (reset) shown_same = 36'h5a5a5a5a5;
                else if (en && bytes == 0) shown_same = rows[place];
                if (en_b) shown_b = {rows[place_b][32 + lane], rows[place_b][8 * lane +: 8]};
                edges(1);
                if (en) rows[place] = next;
                check(first == shown_first, "WRITE_FIRST");
                check(old == shown_old, "READ_FIRST");
                check(same == shown_same, "NO_CHANGE");
                check({first_b[32], first_b[7:0]} == shown_b, "a port of 9 bits");
            end
            // "Conflict Avoidance": the other port reads the old value only if the writing port is
            // READ_FIRST.
            {en, en_b, reset, bytes, place, place_b, lane} = {7'b1101111, 9'd3, 9'd3, 2'd0};
            in      = ~rows[3];
            shown_b = {rows[3][32], rows[3][7:0]};
            edges(1);
            check({old_b[32], old_b[7:0]} == shown_b, "READ_FIRST: the old word");
            check(first_b[7:0] != shown_b[7:0] && first_b[7:0] != in[7:0], "a conflict");
        end
    endtask

    initial begin
        dsp_random;
        dsp_registers;
        lut_memories;
        registers;
        block_rams;
        if (wrong != 0) $fatal(1, "%0d rules are broken", wrong);
        $display("all rules hold");
        $finish;
    end
endmodule
