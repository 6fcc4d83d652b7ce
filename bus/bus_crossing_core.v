// SPDX-License-Identifier: MIT
//
// bus_crossing_core: the part of bus_crossing in the clock domain of the core. It carries out each
// request as one access to the core, and keeps the answer until the next access ends.
//
// A reset of the core ends the access with an error. Requests do not overlap: the next request
// comes after ended_o of the previous request.

`default_nettype none

module bus_crossing_core (
    input  wire        clk_i,  // clock of the core
    input  wire        rst_i,  // reset, which may begin at any time and ends synchronously to clk_i
    // request and answer; begins_i is high for one cycle
    input  wire        begins_i, // one cycle
    output wire        ended_o,  // high for one cycle, one clock after the access
    output reg  [32:0] answer_o, // error and data of the access, valid with ended_o
    // interrupt; comes from a flip-flop, because a glitch must not reach the other clock domain
    output reg         irq_o,
    // core
    output wire        core_valid_o,
    input  wire        core_ready_i,
    input  wire [31:0] core_rdata_i,
    input  wire        core_error_i,
    input  wire        core_irq_i
);
    reg  busy, ended;
    wire ends = busy && (core_ready_i || rst_i);
    initial {busy, ended, irq_o} = 3'b000;
    assign core_valid_o = busy && !rst_i;
    assign ended_o      = ended;
    always @(posedge clk_i) begin
        busy  <= begins_i || (busy && !ends);
        // high one clock after the access, because core_irq_i then shows the effect of the access
        ended <= ends;
        irq_o <= core_irq_i;
        if (ends)
            answer_o <= {core_error_i || rst_i, core_rdata_i};
    end

`ifdef FORMAL
    bus_rules #(.MASTER(1), .LIMIT(60000), .PATIENCE(60000)) u_rules (
        .clk_i(clk_i), .rst_i(rst_i), .valid_i(core_valid_o), .write_i(1'b0), .addr_i(10'd0),
        .wdata_i(32'd0), .ready_i(core_ready_i), .rdata_i(core_rdata_i), .error_i(core_error_i));
    reg        past = 1'b0, open = 1'b0; // open: a request has not been answered yet
    // known: an access has ended; done: an access ended in the previous clock
    reg        known = 1'b0, done = 1'b0;
    reg [32:0] answer;                    // error and data of the access that ended last
    reg        irq_was = 1'b0;            // interrupt of the core in the previous clock
    wire       completes = core_valid_o && core_ready_i;
    always @(posedge clk_i) begin
        past  <= 1'b1;
        irq_was <= core_irq_i;
        open  <= begins_i || (open && !ended_o);
        done  <= busy && (completes || rst_i);
        known <= known || (busy && (completes || rst_i));
        if (busy && (completes || rst_i))
            answer <= completes ? {core_error_i, core_rdata_i} : {1'b1, core_rdata_i};
        assume (!begins_i || !open);
    end
    always @* begin
        // Each request leads to one access and one answer.
        assert (open == (busy || ended));
        assert (!(busy && ended));
        assert (!core_valid_o || open);
        assert (ended_o == done);
        // The core's answer is passed on; if the core was reset, the answer is an error. The answer
        // is stable until the next access ends.
        assert (!known || answer_o == answer);
        assert (known || !ended_o);
        assert (irq_o == irq_was);
        cover (ended_o && !answer_o[32] && answer_o[31:0] == 32'd5);
        cover (ended_o && answer_o[32] && past);
        cover (known && begins_i);
    end
`endif
endmodule
