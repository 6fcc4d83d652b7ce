// SPDX-License-Identifier: MIT
//
// camera_sensor: converts the signals of a parallel sensor port into tokens, in the clock domain of
// the sensor, and sends them to an async_fifo.
//
// A token has 11 bits: LOST, kind, pixel. LOST means that earlier tokens were lost because the FIFO
// was full. While the FIFO is full, pixels are lost. A frame start or line end waits until the FIFO
// has room; it is lost only if the next frame start or line end arrives before that.

`default_nettype none

module camera_sensor (
    // pins, which are sampled at the rising edge of the pixel clock
    input  wire        pclk_i,
    input  wire        vsync_i, // high between frames
    input  wire        href_i,  // high while data_i is a pixel of a line
    input  wire [7:0]  data_i,
    // tokens
    output wire        push_o,
    output wire [10:0] token_o,
    input  wire        full_i
);
    localparam [1:0] PIXEL = 2'd0, LINE_END = 2'd1, FRAME_START = 2'd2;

    reg       vsync, vsync_before, href, href_before;
    reg [7:0] data;
    reg       owes_line_end, owes_frame_start, lost;

    // This clock domain has no reset: after a few clocks the registers follow the pins of the
    // sensor, and only complete frames are used.
    initial begin
        {vsync, vsync_before, href, href_before} = 4'd0;
        {owes_line_end, owes_frame_start, lost}  = 3'd0;
    end

    wire line_end    = owes_line_end || (href_before && !href);
    wire frame_start = owes_frame_start || (vsync_before && !vsync);
    // A pixel cannot wait, so it is sent before a line end or frame start that is waiting.
    wire [1:0] kind  = href ? PIXEL : line_end ? LINE_END : FRAME_START;
    wire       any   = href || line_end || frame_start;

    assign push_o  = any && !full_i;
    assign token_o = {lost, kind, data};

    always @(posedge pclk_i) begin
        vsync        <= vsync_i;
        href         <= href_i;
        data         <= data_i;
        vsync_before <= vsync;
        href_before  <= href;
        owes_line_end    <= line_end && !(push_o && kind == LINE_END);
        owes_frame_start <= frame_start && !(push_o && kind == FRAME_START);
        lost             <= push_o ? 1'b0 : lost || (href && full_i);
    end
`ifdef COVER_POINTS
    pixel_lost: cover property (@(posedge pclk_i) href && full_i);
    frame_start_waits: cover property (@(posedge pclk_i) owes_frame_start);
    line_end_waits: cover property (@(posedge pclk_i) owes_line_end);
`endif
endmodule
