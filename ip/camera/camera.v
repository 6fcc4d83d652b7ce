// SPDX-License-Identifier: MIT
//
// camera: writes frames from a parallel sensor port into three buffers in DDR3, and offers complete
// frames to another core. Registers: camera.regs.json. Page: README.md.
//
// While frame_valid_o is high, the newest frame is available in buffer frame_index_o. The other
// core takes this frame with frame_take_i. The frame is then not overwritten until that core takes
// the next one.

`default_nettype none

module camera (
    `include "slot_ports.vh"
    `include "memory_ports.vh"
    output wire        irq_o,
    // signals to the core that uses the frames
    output wire        frame_valid_o,
    output wire [1:0]  frame_index_o,
    input  wire        frame_take_i,
    // sensor pins, in the clock domain pclk_i
    input  wire        pclk_i,
    input  wire        vsync_i,
    input  wire        href_i,
    input  wire [7:0]  data_i
);
    `include "camera_regs.vh"

    localparam [1:0] PIXEL = 2'd0, LINE_END = 2'd1, FRAME_START = 2'd2;
    localparam [2:0] OFF = 3'd0, WAIT_FOR_FRAME = 3'd1, WAIT_FOR_BUFFER = 3'd2, CAPTURE = 3'd3,
                     FINISH = 3'd4, WAIT_FOR_MEMORY = 3'd5;

    reg [2:0]  state;
    // capturing: state is CAPTURE; listening: the state accepts tokens
    reg        capturing, listening;
    reg        stopping;             // STOP was written, so no further frame is captured
    // the frame that is ending, or that has just ended, is complete
    reg        whole;
    reg        again;                // the next frame has already begun
    // number of words per line, and number of the current word, starting with 1
    reg [8:0]  width, words;
    reg [11:0] height, y;
    reg [2:0]  x;                    // index of the next pixel in its word of eight pixels
    reg        room;                 // the current line still has space for pixels
    // values of words == width and y + 1 == height in the previous clock
    reg        last_word, last_line;
    // address of buffer 1, and distance between the buffers, in bytes
    reg [31:0] base, stride;
    reg [15:0] frames, dropped;
    reg [55:0] pixels;               // pixels of the incomplete word, the newest in the upper bits
    reg        has_newest;
    wire [1:0] writing, newest;
    wire       offered;

    // ---- sensor ----
    wire        push, full, waits, pop;
    wire [10:0] token_in, token_out;
    camera_sensor u_sensor (.pclk_i(pclk_i), .vsync_i(vsync_i), .href_i(href_i), .data_i(data_i),
                            .push_o(push), .token_o(token_in), .full_i(full));
    async_fifo #(.WIDTH(11), .LOG2(5)) u_fifo (
        .write_clk_i(pclk_i), .push_i(push), .data_i(token_in), .full_o(full),
        .read_clk_i(clk_i), .pop_i(fetch), .data_o(token_out), .empty_o(waits));
    // A flip-flop holds the next token, because the logic that uses it has long paths.
    reg [10:0] token;
    reg        has_token;
    wire       fetch = !waits && (!has_token || pop);
    always @(posedge clk_i) begin
        if (fetch)
            token <= token_out;
        has_token <= !rst_i && (fetch || (has_token && !pop));
    end
    wire       lost = token[10];
    wire [1:0] kind = token[9:8];
    wire       starts = kind == FRAME_START, ends_line = kind == LINE_END, is_pixel = kind == PIXEL;

    // ---- registers ----
    wire [15:0] set_width, set_height;
    wire [31:0] set_base, set_stride;
    wire        set_start, stop;
    reg  [6:0]  events;
    camera_regs u_registers (
        `include "slot_connect.vh"
        .irq_o(irq_o),
        .frame_event_i(events[CAMERA_EVENT_FRAME_LSB]),
        .short_line_event_i(events[CAMERA_EVENT_SHORT_LINE_LSB]),
        .long_line_event_i(events[CAMERA_EVENT_LONG_LINE_LSB]),
        .short_frame_event_i(events[CAMERA_EVENT_SHORT_FRAME_LSB]),
        .long_frame_event_i(events[CAMERA_EVENT_LONG_FRAME_LSB]),
        .overflow_event_i(events[CAMERA_EVENT_OVERFLOW_LSB]),
        .refused_event_i(events[CAMERA_EVENT_REFUSED_LSB]),
        .control_start_o(set_start), .control_stop_o(stop),
        .status_active_i(state != OFF), .status_in_frame_i(capturing),
        .size_width_o(set_width), .size_height_o(set_height),
        .base_o(set_base), .stride_o(set_stride),
        .latest_buffer_i(newest), .latest_valid_i(has_newest),
        .frames_i(frames), .dropped_i(dropped));

    wire start = set_start && state == OFF;
    // The settings are checked in the clock in which START is written; the state machine uses the
    // result one clock later.
    reg  asked, good;
    always @(posedge clk_i) begin
        asked <= start && !rst_i;
        good  <= set_width[2:0] == 3'd0 && set_width != 16'd0 && set_width <= 16'd2048 &&
                 set_height != 16'd0 && set_height[15:12] == 4'd0 &&
                 set_base[6:0] == 7'd0 && set_stride[6:0] == 7'd0;
    end

    // ---- memory ----
    wire        write_ready, write_idle;
    // Buffers 1..3 begin at base, base + stride and base + 2 * stride.
    wire [31:0] write_base = base + (writing == 2'd2 ? stride :
                                     writing == 2'd3 ? {stride[30:0], 1'b0} : 32'd0);
    wire        no_data, read_idle;
    wire [63:0] no_words;
    wire        eighth = capturing && has_token && !lost && is_pixel && room && x == 3'd7;
    npi_stream #(.ADDR_BITS(32), .WORD_BITS(4)) u_stream (
        `include "memory_connect.vh"
        .clk_i(clk_i), .rst_i(rst_i),
        .read_start_i(1'b0), .read_base_i(26'd0), .read_words_i(4'd0), .read_stop_i(1'b0),
        .read_valid_o(no_data), .read_data_o(no_words), .read_take_i(1'b0), .read_idle_o(read_idle),
        .write_start_i(state == WAIT_FOR_BUFFER), .write_base_i(write_base[31:6]),
        .write_valid_i(eighth), .write_data_i({token[7:0], pixels}), .write_be_i(8'hFF),
        .write_ready_o(write_ready), .write_flush_i(state == FINISH), .write_idle_o(write_idle));

    // ---- frames ---- Tokens wait in the FIFO while a buffer is being selected, and while a frame
    // is being finished. If the FIFO becomes full, tokens are lost; the core reports this. If a
    // word of eight pixels cannot be written, the next token waits. Tokens of every kind wait,
    // because the kind is decoded too late in the clock to treat some of them differently.
    wire ready  = x != 3'd7 || write_ready;
    assign pop  = has_token && listening && ready;
    wire begins = pop && starts;
    wire token_in_frame = has_token && capturing && ready;
    wire bad    = lost || (is_pixel && !room) || (ends_line && room) || starts;
    wire last   = ends_line && last_line;
    // the whole frame has been written to memory
    wire kept   = state == WAIT_FOR_MEMORY && write_idle && whole;
    camera_buffers u_buffers (
        .clk_i(clk_i), .rst_i(rst_i), .active_i(state != OFF), .kept_i(kept),
        .writing_o(writing), .newest_o(newest), .offered_o(offered), .take_i(frame_take_i)
    );
    assign frame_valid_o = offered;
    assign frame_index_o = newest;

    task enter(input [2:0] to);
        begin
            state     <= to;
            capturing <= to == CAPTURE;
            listening <= to == OFF || to == WAIT_FOR_FRAME || to == CAPTURE;
        end
    endtask

    always @(posedge clk_i) begin
        events    <= 7'd0;
        last_word <= words == width;
        last_line <= y + 12'd1 == height;
        // The token of a line end also shifts a byte in. The pixels of the next line push this
        // byte out again, so it has no effect. If only pixels shifted, the enables of 56 flip-flops
        // would depend on the kind of the token.
        if (capturing && has_token && x != 3'd7)
            pixels <= {token[7:0], pixels[55:8]};
        if (stop && state != OFF)
            stopping <= 1'b1;
        case (state)
            OFF: begin
                stopping <= 1'b0;
                events[CAMERA_EVENT_REFUSED_LSB] <= asked && !good;
                if (asked && good) begin
                    enter(WAIT_FOR_FRAME);
                    width      <= set_width[11:3];
                    height     <= set_height[11:0];
                    base       <= set_base;
                    stride     <= set_stride;
                    frames     <= 16'd0;
                    dropped    <= 16'd0;
                    whole      <= 1'b0;
                    has_newest <= 1'b0;
                end
            end
            WAIT_FOR_FRAME: begin
                if (stopping)
                    enter(OFF);
                else if (begins)
                    enter(WAIT_FOR_BUFFER);
                if (pop && ends_line) // this event is reported only once per frame
                    whole <= 1'b0;
                events[CAMERA_EVENT_LONG_FRAME_LSB] <= pop && ends_line && whole;
            end
            // A buffer is selected in this clock; the previous frame is completely in memory.
            WAIT_FOR_BUFFER: begin
                x     <= 3'd0;
                y     <= 12'd0;
                words <= 9'd1;
                room  <= 1'b1;
                whole <= 1'b0;
                again <= 1'b0;
                enter(CAPTURE);
            end
            CAPTURE: if (token_in_frame) begin
                if (is_pixel) begin
                    x <= x + 3'd1;
                    if (x == 3'd7) begin
                        words <= words + 9'd1;
                        room  <= !last_word;
                    end
                end
                if (ends_line) begin
                    words <= 9'd1;
                    room  <= 1'b1;
                    y     <= y + 12'd1;
                end
                events[CAMERA_EVENT_OVERFLOW_LSB]    <= lost;
                events[CAMERA_EVENT_LONG_LINE_LSB]   <= !lost && is_pixel && !room;
                events[CAMERA_EVENT_SHORT_LINE_LSB]  <= !lost && ends_line && room;
                events[CAMERA_EVENT_SHORT_FRAME_LSB] <= !lost && starts;
                whole <= last && !bad;
                again <= starts;
                if (bad)
                    dropped <= dropped + 16'd1;
                if (bad || last)
                    enter(FINISH);
            end else if (stopping) begin
                enter(FINISH);
            end
            FINISH: enter(WAIT_FOR_MEMORY);
            default: if (write_idle) // WAIT_FOR_MEMORY
                enter(stopping ? OFF : again ? WAIT_FOR_BUFFER : WAIT_FOR_FRAME);
        endcase

        if (kept) begin
            has_newest <= 1'b1;
            frames     <= frames + 16'd1;
            events[CAMERA_EVENT_FRAME_LSB] <= 1'b1;
        end

        if (rst_i) begin
            enter(OFF);
            stopping   <= 1'b0;
            events     <= 7'd0;
            has_newest <= 1'b0;
            frames     <= 16'd0;
            dropped    <= 16'd0;
        end
    end

    wire unused = &{1'b0, no_data, no_words, read_idle, write_base[5:0], 1'b0};
`ifdef COVER_POINTS
    replaces_what_nobody_took: cover property (@(posedge clk_i) kept && offered);
    stopped_in_a_frame: cover property (@(posedge clk_i) capturing && stopping && !token_in_frame);
    frame_in_a_frame: cover property (@(posedge clk_i) token_in_frame && starts);
    memory_holds_up: cover property (@(posedge clk_i) eighth && !write_ready);
    pixels_lost: cover property (@(posedge clk_i) token_in_frame && lost);
`endif
endmodule
