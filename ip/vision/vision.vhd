-- SPDX-License-Identifier: MIT
--
-- vision: finds the FAST-9 corners of a grey-scale frame in DDR3, with one pixel per clock
-- (ip/vision/README.md).
--
-- Registers: ip/vision/vision.regs.json.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
use work.vision_regs_pkg.all;

entity vision is
  port (
    clk_i                : in  std_logic;
    rst_i                : in  std_logic;
    -- register bus
    bus_valid_i          : in  std_logic;
    bus_write_i          : in  std_logic;
    bus_addr_i           : in  std_logic_vector(3 downto 0);
    bus_wdata_i          : in  std_logic_vector(31 downto 0);
    bus_ready_o          : out std_logic;
    bus_rdata_o          : out std_logic_vector(31 downto 0);
    bus_error_o          : out std_logic;
    irq_o                : out std_logic;
    -- high while the core neither processes a frame nor waits for one
    idle_o               : out std_logic;
    -- frames that another core offers, in buffers 1..3 (used with MODE.FOLLOW)
    frame_valid_i        : in  std_logic := '0';
    frame_index_i        : in  std_logic_vector(1 downto 0) := "00";
    frame_take_o         : out std_logic;
    -- memory port
    npi_addr_o           : out std_logic_vector(31 downto 0);
    npi_addr_req_o       : out std_logic;
    npi_addr_ack_i       : in  std_logic;
    npi_rnw_o            : out std_logic;
    npi_size_o           : out std_logic_vector(3 downto 0);
    npi_rmw_o            : out std_logic;
    npi_wr_data_o        : out std_logic_vector(63 downto 0);
    npi_wr_be_o          : out std_logic_vector(7 downto 0);
    npi_wr_push_o        : out std_logic;
    npi_wr_empty_i       : in  std_logic;
    npi_wr_almost_full_i : in  std_logic;
    npi_wr_flush_o       : out std_logic;
    npi_rd_data_i        : in  std_logic_vector(63 downto 0);
    npi_rd_word_i        : in  std_logic_vector(3 downto 0);
    npi_rd_pop_o         : out std_logic;
    npi_rd_empty_i       : in  std_logic;
    npi_rd_flush_o       : out std_logic;
    npi_init_done_i      : in  std_logic
  );
end entity;

architecture rtl of vision is
  -- SCORE_DELAY is the number of steps from the newest pixel of a window to its score at the output
  -- of vision_fast. KEPT_DELAY is the number of steps through vision_suppress.
  constant SCORE_DELAY : natural := 5;
  constant KEPT_DELAY  : natural := 2;

  type state_t is (WAIT_FOR_START, STREAM, DRAIN);
  signal state : state_t;

  -- registers
  signal set_threshold : std_logic_vector(7 downto 0);
  -- addresses, which vision_memory loads at START
  signal frame_base, result_base : std_logic_vector(31 downto 0);
  signal frame_stride  : std_logic_vector(31 downto 0);
  signal follow        : std_logic;
  signal busy, done, done_pending, refused : std_logic;
  -- buffer that contained the last frame; 0 means that the frame was at FRAME_BASE
  signal taken         : std_logic_vector(1 downto 0);
  signal set_width, set_height, set_result_max : std_logic_vector(15 downto 0);
  signal found, stored : unsigned(15 downto 0);
  -- settings of the current frame, loaded at START
  signal threshold     : unsigned(7 downto 0);
  signal last_column   : unsigned(9 downto 0);
  signal height, result_max : unsigned(15 downto 0);
  signal cycles        : unsigned(31 downto 0);
  signal aborted, stop : std_logic;
  -- A command takes effect one clock after it was written, so that the address decoder and the
  -- frame control are not on the same path. A register that is written in this additional clock
  -- must not affect the frame that is starting.
  signal start, abort  : std_logic;
  -- a register was written in the last clock, so size_ok is not up to date
  signal written       : std_logic;
  signal size_ok       : std_logic; -- result of the check of the registers in the previous clock
  signal idle, offered, accept : std_logic;
  signal go            : std_logic; -- one clock after `accept`; an idle core loads the settings
  signal first_pixel, memory_base : std_logic_vector(31 downto 0);

  -- stream: x is the column of the pixel that is being taken. lines_left is the number of lines
  -- that are left, including the current line. (score_x, score_y) is the position of the score
  -- that enters vision_suppress, (kept_x, kept_y) the position of the score that leaves it
  signal x             : unsigned(9 downto 0);
  signal lines_left    : unsigned(15 downto 0);
  signal score_x, kept_x : unsigned(9 downto 0);
  signal score_y, kept_y : unsigned(16 downto 0);
  -- number of steps since the start; counting stops when the first score has left vision_suppress
  signal fill          : unsigned(3 downto 0);
  signal take, real_pixel, pixel_valid, pixel_take, last : std_logic;
  signal streaming     : std_logic; -- high while the state is STREAM and stop is low
  -- `step` is `take`, delayed by one clock. All logic after the window advances with `step`;
  -- because of its high fan-out, `step` comes from a flip-flop.
  signal step          : std_logic;
  -- a copy of `step` with a small fan-out; all decisions use this copy
  signal decide        : std_logic;
  signal step_x        : unsigned(9 downto 0);
  signal pixel, step_pixel : std_logic_vector(7 downto 0);
  signal window        : std_logic_vector(391 downto 0);
  signal raw_score, score, centre_score : unsigned(11 downto 0);
  signal kept, is_corner, record_ready, record_push, quiet : std_logic;
  -- high if kept_y was inside the frame one step ago. The delay makes a difference only in the
  -- first column of a line, where all scores are 0 anyway.
  signal in_frame      : std_logic;
  signal data          : std_logic_vector(63 downto 0);
  signal frame_x, frame_y : unsigned(15 downto 0);

  procedure advance(signal px : inout unsigned(9 downto 0); signal py : inout unsigned(16 downto 0);
                    last_column : unsigned(9 downto 0)) is
  begin
    if px = last_column then
      px <= to_unsigned(0, 10);
      py <= py + 1;
    else
      px <= px + 1;
    end if;
  end procedure;
begin
  npi_rmw_o      <= '0';
  npi_wr_flush_o <= '0';
  npi_rd_flush_o <= '0';
  npi_wr_be_o    <= x"FF";

  -- ---- registers ----

  u_registers : entity work.vision_regs
    port map (
      clk_i => clk_i, rst_i => rst_i,
      bus_valid_i => bus_valid_i, bus_write_i => bus_write_i, bus_addr_i => bus_addr_i,
      bus_wdata_i => bus_wdata_i, bus_ready_o => bus_ready_o, bus_rdata_o => bus_rdata_o,
      bus_error_o => bus_error_o, irq_o => irq_o,
      done_event_i => done, done_pending_o => done_pending, done_clear_o => open,
      refused_event_i => refused,
      control_start_o => start, control_abort_o => abort,
      status_busy_i => busy, status_aborted_i => aborted, threshold_o => set_threshold,
      frame_base_o => frame_base, frame_size_width_o => set_width,
      frame_size_height_o => set_height, result_base_o => result_base,
      result_max_o => set_result_max, found_i => std_logic_vector(found),
      stored_i => std_logic_vector(stored), cycles_i => std_logic_vector(cycles),
      frame_stride_o => frame_stride, mode_follow_clear_i => refused, mode_follow_o => follow,
      frame_buffer_i => taken
    );

  busy    <= not idle or start;
  done    <= quiet when state = DRAIN else '0';
  refused <= ((start and idle) or offered) and not size_ok;

  -- The next frame starts only when the results of the last frame have been read. Software
  -- indicates this by clearing DONE.
  offered <= follow and frame_valid_i and not written and not done_pending
             and idle;
  idle   <= '1' when state = WAIT_FOR_START and go = '0' else '0';
  accept <= (start or offered) and size_ok and idle;
  frame_take_o <= offered and size_ok;
  idle_o <= idle and quiet and not follow;

  with frame_index_i select first_pixel <=
    frame_base when "01",
    std_logic_vector(unsigned(frame_base) + unsigned(frame_stride)) when "10",
    std_logic_vector(unsigned(frame_base) + unsigned(frame_stride(30 downto 0) & '0')) when others;

  starting : process (clk_i)
  begin
    if rising_edge(clk_i) then
      written <= bus_valid_i and bus_write_i;
      size_ok <= '0';
      if unsigned(set_width(2 downto 0)) = 0 and unsigned(set_width) >= VISION_MIN_SIDE and
         unsigned(set_width) <= VISION_MAX_WIDTH and unsigned(set_height) >= VISION_MIN_SIDE and
         unsigned(frame_base(6 downto 0)) = 0 and unsigned(result_base(6 downto 0)) = 0 and
         unsigned(frame_stride(6 downto 0)) = 0 then
        size_ok <= '1';
      end if;
      go <= accept;
      if accept = '1' then
        taken <= frame_index_i and (1 downto 0 => offered);
      end if;
      if rst_i = '1' then
        written <= '0';
        go      <= '0';
        taken   <= "00";
      end if;
    end if;
  end process;

  -- ---- stream ----

  -- After the last line of the frame, the core generates additional lines. Their scores are 0; they
  -- push the last corners out of the pipeline. Records are never pushed in two successive steps,
  -- because vision_suppress keeps at most one of two successive scores: the first if it is not less
  -- than the second, otherwise at most the second. One record may still be pushed in the step after
  -- record_ready_o has fallen.
  take       <= streaming and (pixel_valid or not real_pixel) and record_ready;
  pixel_take <= streaming and pixel_valid and real_pixel and record_ready;

  taking : process (clk_i)
  begin
    if rising_edge(clk_i) then
      step   <= take; -- no reset; otherwise synthesis would merge step and decide
      decide <= take;
      step_x <= x;
      step_pixel <= pixel and (7 downto 0 => real_pixel);
      if take = '1' then
        x <= x + 1;
        if x = last_column then
          x          <= to_unsigned(0, 10);
          lines_left <= lines_left - 1;
          if lines_left = 1 then
            real_pixel <= '0';
          end if;
        end if;
      end if;
      if go = '1' then
        x          <= to_unsigned(0, 10);
        lines_left <= height;
        real_pixel <= '1';
      end if;
      if rst_i = '1' then
        decide <= '0';
      end if;
    end if;
  end process;

  -- A score is valid only if its column and its line in the stream are at least 6. Otherwise its
  -- window would contain pixels from the end of the previous line.
  score <= raw_score when score_x >= 6 and score_y >= 6 and score_y < resize(height, 17) and
                          fill >= SCORE_DELAY else to_unsigned(0, 12);

  -- Centre of the window in coordinates of the frame: three columns and three lines before the
  -- position of the kept score.
  frame_x     <= resize(kept_x, 16) - 3;
  frame_y     <= resize(kept_y, 16) - 3;
  -- The block RAMs still contain lines of an earlier frame until the first lines of this frame have
  -- passed.
  is_corner   <= decide and kept and in_frame when fill = SCORE_DELAY + KEPT_DELAY else '0';
  record_push <= is_corner when stored < result_max else '0';
  data        <= x"00000" & std_logic_vector(centre_score) &
                 std_logic_vector(frame_y) & std_logic_vector(frame_x);
  last        <= '1' when kept_y = resize(height, 17) else '0';
  memory_base  <= first_pixel when offered = '1' else frame_base;

  stream_control : process (clk_i)
  begin
    if rising_edge(clk_i) then
      case state is
        when WAIT_FOR_START =>
          if go = '1' then
            state   <= STREAM;
            stop    <= abort;
            streaming <= not abort;
            aborted <= abort;
            found   <= to_unsigned(0, 16);
            stored  <= to_unsigned(0, 16);
            cycles  <= to_unsigned(0, 32);
            fill    <= to_unsigned(0, 4);
            score_x <= to_unsigned(0, 10);
            score_y <= to_unsigned(0, 17);
          else
            threshold  <= unsigned(set_threshold);
            last_column <= resize(unsigned(set_width) - 1, 10);
            height     <= unsigned(set_height);
            result_max <= unsigned(set_result_max);
          end if;
        when STREAM =>
          cycles <= cycles + 1;
          if abort = '1' then
            aborted <= '1';
            stop    <= '1';
            streaming <= '0';
          end if;
          if stop = '1' or (last = '1' and fill = SCORE_DELAY + KEPT_DELAY) then
            stop  <= '1';
            streaming <= '0';
            state <= DRAIN;
          end if;
        when DRAIN =>
          cycles <= cycles + 1;
          if quiet = '1' then
            state <= WAIT_FOR_START;
          end if;
      end case;

      if decide = '1' then
        in_frame <= '0';
        if kept_y >= 6 and kept_y < resize(height, 17) then
          in_frame <= '1';
        end if;
        if fill >= SCORE_DELAY then
          advance(score_x, score_y, last_column);
        end if;
        if fill /= SCORE_DELAY + KEPT_DELAY then
          fill <= fill + 1;
        end if;
      end if;
      if is_corner = '1' and found /= 65535 then
        found <= found + 1;
      end if;
      if record_push = '1' then
        stored <= stored + 1;
      end if;
      if rst_i = '1' then
        state   <= WAIT_FOR_START;
        stop    <= '0';
        streaming <= '0';
        aborted <= '0';
        found   <= to_unsigned(0, 16);
        stored  <= to_unsigned(0, 16);
        cycles  <= to_unsigned(0, 32);
      end if;
    end if;
  end process;

  -- The score that leaves vision_suppress belongs to the centre of its neighbourhood. This centre
  -- is one line and one column before the pixel of the score that entered KEPT_DELAY steps ago.
  kept_position : process (clk_i)
  begin
    if rising_edge(clk_i) then
      if go = '1' then
        -- The first centre is the pixel before (0, -1): the last column of line -2. kept_y is
        -- unsigned, so 131070 stands for -2.
        kept_x <= last_column;
        kept_y <= to_unsigned(131070, 17); -- -2
      elsif decide = '1' and fill = SCORE_DELAY + KEPT_DELAY then
        advance(kept_x, kept_y, last_column);
      end if;
    end if;
  end process;

  u_memory : entity work.vision_memory
    port map (
      clk_i => clk_i, rst_i => rst_i,
      idle_i => idle, start_i => go, stop_i => stop,
      frame_base_i => memory_base, result_base_i => result_base, quiet_o => quiet,
      pixel_valid_o => pixel_valid, pixel_o => pixel, pixel_take_i => pixel_take,
      record_push_i => record_push, record_i => data, record_ready_o => record_ready,
      npi_addr_o => npi_addr_o, npi_addr_req_o => npi_addr_req_o,
      npi_addr_ack_i => npi_addr_ack_i, npi_rnw_o => npi_rnw_o, npi_size_o => npi_size_o,
      npi_wr_data_o => npi_wr_data_o, npi_wr_push_o => npi_wr_push_o,
      npi_rd_data_i => npi_rd_data_i, npi_rd_pop_o => npi_rd_pop_o,
      npi_rd_empty_i => npi_rd_empty_i, npi_init_done_i => npi_init_done_i
    );

  u_window : entity work.vision_window
    port map (clk_i => clk_i, step_i => step, x_i => step_x, pixel_i => step_pixel,
              window_o => window);

  u_fast : entity work.vision_fast
    port map (clk_i => clk_i, step_i => step, threshold_i => threshold, window_i => window,
              score_o => raw_score);

  u_suppress : entity work.vision_suppress
    port map (clk_i => clk_i, step_i => step, x_i => score_x, score_i => score,
              score_o => centre_score, kept_o => kept);
end architecture;
