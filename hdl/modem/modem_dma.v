// SPDX-License-Identifier: MIT
//
// modem_dma: one memory port for the transmitter's reads and the receiver's writes, a word each.
//
// A request stays, stable, until its done. Writes go first: the receiver cannot wait.

`default_nettype none

module modem_dma (
    input  wire        clk_i,
    input  wire        rst_i,
    // read a word
    input  wire        rd_req_i,
    input  wire [31:0] rd_addr_i,
    output wire        rd_done_o, // one cycle, with the data
    output wire [63:0] rd_data_o,
    // write a word
    input  wire        wr_req_i,
    input  wire [31:0] wr_addr_i,
    input  wire [63:0] wr_data_i,
    input  wire [7:0]  wr_be_i,
    output wire        wr_done_o, // one cycle: the write is acknowledged
    // memory port
    output wire [31:0] npi_addr_o,
    output wire        npi_addr_req_o,
    input  wire        npi_addr_ack_i,
    output wire        npi_rnw_o,
    output wire [63:0] npi_wr_data_o,
    output wire [7:0]  npi_wr_be_o,
    output wire        npi_wr_push_o,
    output wire        npi_rd_pop_o,
    input  wire [63:0] npi_rd_data_i,
    input  wire        npi_rd_empty_i,
    input  wire        npi_init_done_i
);
    localparam [1:0] IDLE = 2'd0, WRITE = 2'd1, READ = 2'd2, WAIT_WORD = 2'd3;

    reg [1:0] state;
    reg       pushed;
    reg [31:0] addr; // stays, even if the request is withdrawn by a reset of the rings

    assign npi_addr_o     = addr;
    assign npi_addr_req_o = state == WRITE || state == READ;
    assign npi_rnw_o      = state != WRITE;
    assign npi_wr_data_o  = wr_data_i;
    assign npi_wr_be_o    = wr_be_i;
    assign npi_wr_push_o  = state == WRITE && !pushed;
    assign npi_rd_pop_o   = state == WAIT_WORD && !npi_rd_empty_i;
    assign rd_data_o      = npi_rd_data_i;
    assign rd_done_o      = npi_rd_pop_o;
    assign wr_done_o      = state == WRITE && npi_addr_ack_i;

    always @(posedge clk_i) begin
        pushed <= state == WRITE;
        case (state)
            IDLE: if (npi_init_done_i && !wr_done_o) begin
                addr <= wr_req_i ? wr_addr_i : rd_addr_i;
                if (wr_req_i)
                    state <= WRITE;
                else if (rd_req_i)
                    state <= READ;
            end
            WRITE: if (npi_addr_ack_i)
                state <= IDLE;
            READ: if (npi_addr_ack_i)
                state <= WAIT_WORD;
            default: if (!npi_rd_empty_i)
                state <= IDLE;
        endcase
        if (rst_i) begin
            state  <= IDLE;
            pushed <= 1'b0;
        end
    end

`ifdef FORMAL
    reg past = 1'b0;
    initial assume (rst_i);
    always @(posedge clk_i) begin
        past <= 1'b1;
        if (past && !rst_i && !$past(rst_i)) begin
            // A request stays, with its address, until it is acknowledged.
            if ($past(npi_addr_req_o) && !$past(npi_addr_ack_i))
                assert (npi_addr_req_o && $stable(npi_addr_o) && $stable(npi_rnw_o));
            // A write's word is pushed once, in the first cycle of its request.
            assert (npi_wr_push_o == (state == WRITE && $past(state) != WRITE));
            assert (!(npi_rd_pop_o && npi_rd_empty_i));
            assert (!(rd_done_o && wr_done_o));
        end
        cover (past && wr_done_o);
        cover (past && rd_done_o);
    end
`endif
endmodule
