// SPDX-License-Identifier: MIT
//
// bus_crossing: connects a slot to a core in a separate clock domain: accesses, interrupt and reset
// cross through hdl/cdc.
//
// An access takes four to five clocks of the core plus six clocks of the chip. If the core does not
// answer within TIMEOUT clocks, because its clock has stopped or it hangs, the access ends with an
// error. The core may still perform this access later. Until the core has answered this access, all
// further accesses end with an error, and the interrupt line is low. core_valid_o falls only when
// core_ready_i is high or the core is reset. The handshake has no reset, so a reset of either side
// neither creates nor loses a request. Constraints: as for cdc_bus, cdc_bit and cdc_reset;
// coremap writes them for each core with a separate clock.

`default_nettype none

module bus_crossing #(
    parameter TIMEOUT = 250 // time-out in clocks of clk_i, 1..255
) (
    `include "slot_ports.vh"
    output wire        irq_o,
    // clock of the core, and the signals of the slot in the clock domain of the core
    input  wire        core_clk_i,
    output wire        core_rst_o,
    output wire        core_valid_o,
    output wire        core_write_o,
    output wire [3:0]  core_addr_o,
    output wire [31:0] core_wdata_o,
    input  wire        core_ready_i,
    input  wire [31:0] core_rdata_i,
    input  wire        core_error_i,
    input  wire        core_irq_i
);
    // ---- clk_i
    reg       owes;     // a request was sent to the core and has not been answered yet
    reg       asked;    // the current access has sent its request
    // the answer arrived one clock ago, so irq_o is already low if the access has cleared an
    // interrupt
    reg       answered;
    reg       deaf;     // an earlier access timed out, and the core has not answered it yet
    reg [7:0] patience;
    wire      handed, irq, error;
    wire [31:0] rdata;
    wire      given_up = bus_valid_i && !answered && patience == 8'd0;
    wire      ask      = bus_valid_i && !bus_ready_o && !owes && !asked && !rst_i;
    initial   owes     = 1'b0;

    assign bus_ready_o = answered || given_up;
    assign bus_error_o = !answered || error;
    assign bus_rdata_o = answered && !error ? rdata : 32'd0;
    assign irq_o       = irq && !deaf;

    always @(posedge clk_i) begin
        owes     <= ask || (owes && !handed);
        asked    <= ask || (asked && !answered && bus_valid_i && !given_up);
        answered <= handed && asked && bus_valid_i && !given_up;
        deaf     <= given_up || (deaf && owes && !handed);
        patience <= bus_valid_i && !bus_ready_o ? patience - 8'd1 : TIMEOUT[7:0];
        if (rst_i) begin
            asked    <= 1'b0;
            answered <= 1'b0;
            deaf     <= 1'b0;
            patience <= TIMEOUT[7:0];
        end
    end

    // ---- core_clk_i
    wire        begins, ended, core_irq;
    wire [32:0] answer;
    bus_crossing_core u_bus_crossing_core (
        .clk_i(core_clk_i), .rst_i(core_rst_o), .begins_i(begins), .ended_o(ended),
        .answer_o(answer), .irq_o(core_irq), .core_valid_o(core_valid_o),
        .core_ready_i(core_ready_i), .core_rdata_i(core_rdata_i), .core_error_i(core_error_i),
        .core_irq_i(core_irq_i));

    // ---- Crossings
    wire [36:0] request_kept;
    wire [3:0]  pending;
    cdc_bus #(.WIDTH(37)) u_request (
        .src_clk_i(clk_i), .src_valid_i(ask), .src_data_i({bus_write_i, bus_addr_i, bus_wdata_i}),
        .src_data_o(request_kept),
        .dst_clk_i(core_clk_i), .dst_valid_o(begins),
        .dst_data_o({core_write_o, core_addr_o, core_wdata_o}),
        .pending_sync_o(pending[0]), .pending_async_o(pending[1]));
    cdc_pulse u_handed (
        .src_clk_i(core_clk_i),
        .src_valid_i(ended), .dst_clk_i(clk_i), .dst_valid_o(handed),
        .pending_sync_o(pending[2]), .pending_async_o(pending[3]));
    cdc_copy #(.WIDTH(33))
        u_answer (.clk_i(clk_i), .bus_async_i(answer), .bus_sync_o({error, rdata}));
    cdc_bit u_irq (.clk_i(clk_i), .bit_async_i(core_irq), .bit_sync_o(irq));
    reg rst; // a flip-flop, because an asynchronous reset must have no glitches
    initial rst = 1'b1;
    always @(posedge clk_i) rst <= rst_i;
    cdc_reset u_rst (.clk_i(core_clk_i), .rst_async_i(rst), .rst_o(core_rst_o));
    wire unused = &{1'b0, request_kept, pending, 1'b0};

`ifdef FORMAL
    // Proves that the slot never hangs the bus, whatever the clock of the core does. For this proof
    // the crossings are removed, so that an answer arrives at any time after its request, or never.
    // The proof of cdc_bus shows that each request and each answer arrives exactly once and
    // complete. bus_crossing_core is proven separately.
    bus_rules #(.LIMIT(TIMEOUT + 1), .PATIENCE(TIMEOUT + 2)) u_rules (
        .clk_i(clk_i), .rst_i(rst_i), .valid_i(bus_valid_i), .write_i(bus_write_i),
        .addr_i({6'd0, bus_addr_i}), .wdata_i(bus_wdata_i), .ready_i(bus_ready_o),
        .rdata_i(bus_rdata_o), .error_i(bus_error_o));
    reg past = 1'b0;
    // an access timed out one clock ago, or the core still owes the answer to it
    reg late = 1'b0;
    reg [15:0] used = 16'd0; // number of clocks for which the access has waited before this clock
    initial assume (rst_i);
    always @(posedge clk_i) begin
        past <= 1'b1;
        late <= !rst_i && (given_up || (late && owes && !handed));
        used <= bus_valid_i && !bus_ready_o && !rst_i ? used + 16'd1 : 16'd0;
        if (past && $past(given_up) && !$past(rst_i))
            assert (!asked && !irq_o);
        if (past && !rst_i && !$past(given_up) && !$past(rst_i))
            assert (owes || irq_o == irq);
        cover (past && !rst_i && $past(given_up) && handed && !asked);
        cover (bus_valid_i && bus_ready_o && !bus_error_o && !rst_i);
    end
    always @* begin
        assume (!handed || owes); // an answer comes only after a request
        if (!rst_i) begin
            assert (patience + used == TIMEOUT);
            assert (!ask || !owes);                          // one request at a time
            // the request of a waiting access is not answered yet, or was answered one clock ago
            assert (!asked || owes || answered);
            assert (!answered || !owes);
            // After a time-out, the interrupt line is low while the core owes an answer.
            assert (irq_o == (irq && !late));
            // An access succeeds only with the answer to its own request.
            assert (!(bus_valid_i && bus_ready_o && !bus_error_o) || asked);
        end
    end
`endif
`ifdef COVER_POINTS
    clock_stands: cover property (@(posedge clk_i) given_up);
    late_answer: cover property (@(posedge clk_i) handed && !asked);
    waits_for_the_last: cover property (@(posedge clk_i) bus_valid_i && owes && !asked);
`endif
endmodule
