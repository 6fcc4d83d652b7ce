// SPDX-License-Identifier: MIT
//
// apb_narrow: an APB core for tests, in the style of other people: 8-bit data, registers at
// consecutive byte addresses, request and response as packed structures of a package, and pins as
// one structure.

package apb_narrow_types;
    typedef struct packed {
        logic [3:0] paddr;
        logic [2:0] pprot;
        logic       psel, penable, pwrite;
        logic [7:0] pwdata;
    } request_t;
    typedef struct packed {
        logic       pready;
        logic [7:0] prdata;
        logic       pslverr;
        logic [1:0] pruser;
    } response_t;
    typedef struct packed {
        logic [2:0] colour;
        logic       is_lit;
    } lamp_t;
endpackage

module apb_narrow import apb_narrow_types::*; (
    input  logic      clk_i,
    input  logic      rst_ni,
    input  request_t  req_i,
    output response_t rsp_o,
    output lamp_t     lamp_o
);
    logic [7:0] registers [0:8];
    assign rsp_o = '{pready: 1'b1, prdata: registers[req_i.paddr], pslverr: req_i.paddr > 8,
                     pruser: '0};
    assign lamp_o = '{colour: registers[8][2:0], is_lit: registers[8][7]};
    always_ff @(posedge clk_i or negedge rst_ni)
        if (!rst_ni)
            registers <= '{default: '0};
        else if (req_i.psel && req_i.penable && req_i.pwrite && req_i.paddr <= 8)
            registers[req_i.paddr] <= req_i.pwdata;
endmodule
