// SPDX-License-Identifier: MIT
//
// modem_ring: manages a ring of sixteen buffers: which buffers are in use, and how many bytes each
// buffer contains.
//
// The user of the module must not push while the ring is full, and must not pop while it is empty;
// modem.v excludes both.

`default_nettype none
`include "count_up.vh"

module modem_ring (
    input  wire       clk_i,
    input  wire       rst_i,   // reset; it also empties the ring
    input  wire       push_i,  // buffer next_o now contains bytes_i bytes and is in use
    input  wire [6:0] bytes_i,
    input  wire       pop_i,   // frees the oldest buffer
    output wire [3:0] next_o,
    output wire [3:0] oldest_o,
    output wire [6:0] bytes_o, // number of bytes in the oldest buffer
    output wire [4:0] free_o   // number of free buffers, 0..16
);
    reg [6:0] bytes [0:15];
    // number of the oldest buffer; the upper bit counts turns of the ring. The initial value
    // prevents Yosys from duplicating the register (as in npi_queue).
    reg [4:0] head = 5'd16;
    // number of the buffer that is filled next; the upper bit counts turns of the ring
    reg [4:0] tail;
    `COUNT_UP(up, 5)

    assign next_o   = tail[3:0];
    assign oldest_o = head[3:0];
    assign bytes_o  = bytes[head[3:0]];
    assign free_o   = head - tail;

    always @(posedge clk_i) begin
        if (push_i)
            bytes[tail[3:0]] <= bytes_i;
        if (push_i)
            tail <= up(tail);
        if (pop_i)
            head <= up(head);
        if (rst_i) begin
            head <= 5'd16;
            tail <= 5'd0;
        end
    end

`ifdef FORMAL
    // Proves that the length of a buffer stays unchanged until the buffer is freed, and that the
    // number of free buffers is correct.
    reg past = 1'b0;
    initial assume (rst_i);
    // The proof holds for the length of any buffer, in any turn of the ring.
    (* anyconst *) reg [4:0] place;
    reg [6:0] length;
    reg       inside = 1'b0;
    wire [4:0] used = 5'd16 - free_o;
    wire [4:0] oldest = head - 5'd16;
    always @(posedge clk_i) begin
        past <= 1'b1;
        assume (!(push_i && free_o == 5'd0));
        assume (!(pop_i && free_o == 5'd16));
        if (push_i && tail == place) begin
            length <= bytes_i;
            inside <= 1'b1;
        end
        if ((pop_i && oldest == place) || rst_i)
            inside <= 1'b0;
        if (past) begin
            assert (free_o <= 5'd16);
            if ($past(rst_i))
                assert (free_o == 5'd16);
            if (inside) begin
                assert ((place - oldest) < used);
                assert (bytes[place[3:0]] == length);
            end
            if (inside && oldest == place)
                assert (bytes_o == length && oldest_o == place[3:0]);
            cover (free_o == 5'd0);
            cover ($past(free_o) == 5'd0 && free_o == 5'd1 && inside);
            cover (push_i && pop_i && inside);
        end
    end
`endif
`ifdef COVER_POINTS
    is_full: cover property (@(posedge clk_i) free_o == 5'd0);
`endif
endmodule
