// SPDX-License-Identifier: MIT
//
// axis_scale: multiplies 16-bit samples, as a foreign core with AXI-Streams, a setting and a pin; it has no tlast.

`default_nettype none

module axis_scale (
    input  wire        aclk,
    input  wire        aresetn,
    input  wire [7:0]  gain_factor,
    output reg         over, // a product was too large
    input  wire [15:0] s_axis_tdata,
    input  wire        s_axis_tvalid,
    output wire        s_axis_tready,
    output reg  [15:0] m_axis_tdata,
    output reg         m_axis_tvalid,
    input  wire        m_axis_tready
);
    wire [23:0] product = s_axis_tdata * gain_factor;
    assign s_axis_tready = !m_axis_tvalid || m_axis_tready;
    always @(posedge aclk) begin
        if (s_axis_tready) begin
            m_axis_tvalid <= s_axis_tvalid;
            m_axis_tdata  <= product[15:0];
            over          <= s_axis_tvalid ? |product[23:16] : over;
        end
        if (!aresetn) begin
            m_axis_tvalid <= 1'b0;
            over          <= 1'b0;
        end
    end
endmodule
