-- SPDX-License-Identifier: MIT
--
-- vision_memory: reads the frame pixel by pixel, and writes the records, through one memory port.
--
-- A read is a burst of 128 bytes; at most two reads are outstanding. A record is written as one
-- word. A record that is waiting is written before the next read.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity vision_memory is
  port (
    clk_i          : in  std_logic;
    rst_i          : in  std_logic;
    -- high while the frame control is idle; the addresses are then loaded in each clock
    idle_i         : in  std_logic;
    -- high in the first clock in which idle_i is low
    start_i        : in  std_logic;
    -- ends reading; words that arrive later are discarded
    stop_i         : in  std_logic;
    frame_base_i   : in  std_logic_vector(31 downto 0);
    result_base_i  : in  std_logic_vector(31 downto 0);
    quiet_o        : out std_logic;                     -- high while no transfer is pending
    -- pixels
    pixel_valid_o  : out std_logic;
    pixel_o        : out std_logic_vector(7 downto 0);
    pixel_take_i   : in  std_logic;
    -- a record; it may be pushed only if record_ready_o was high one clock ago, and never in two
    -- successive clocks
    record_push_i  : in  std_logic;
    record_i       : in  std_logic_vector(63 downto 0);
    record_ready_o : out std_logic;
    -- memory port
    npi_addr_o           : out std_logic_vector(31 downto 0);
    npi_addr_req_o       : out std_logic;
    npi_addr_ack_i       : in  std_logic;
    npi_rnw_o            : out std_logic;
    npi_size_o           : out std_logic_vector(3 downto 0);
    npi_wr_data_o        : out std_logic_vector(63 downto 0);
    npi_wr_push_o        : out std_logic;
    npi_rd_data_i        : in  std_logic_vector(63 downto 0);
    npi_rd_pop_o         : out std_logic;
    npi_rd_empty_i       : in  std_logic;
    npi_init_done_i      : in  std_logic
  );
end entity;

architecture rtl of vision_memory is
  signal request     : std_logic;              -- the memory has not acknowledged the request yet
  signal writes      : std_logic;              -- the request is a write
  signal active      : std_logic;              -- high from start to stop
  signal read_addr   : unsigned(31 downto 7);
  signal write_addr  : unsigned(31 downto 3);
  -- number of words that were requested and have not been popped
  signal outstanding : unsigned(5 downto 0);
  signal word        : std_logic_vector(63 downto 0);
  -- one bit for each byte of `word` that has not been taken yet
  signal left        : std_logic_vector(7 downto 0);
  signal slot        : std_logic_vector(63 downto 0); -- a record that waits to be written
  signal slot_full   : std_logic;
  signal pushed      : std_logic;
  signal pop, refill : std_logic;
  signal room        : std_logic;              -- another read may be requested
begin
  refill <= not left(0) or (not left(1) and pixel_take_i);
  pop    <= not npi_rd_empty_i and (refill or not active);

  room   <= '1' when outstanding <= 16 else '0';

  npi_rd_pop_o   <= pop;
  npi_addr_req_o <= request;
  npi_rnw_o      <= not writes;
  npi_size_o     <= "0000" when writes = '1' else "0100";
  npi_addr_o     <= std_logic_vector(write_addr) & "000" when writes = '1' else
                    std_logic_vector(read_addr) & "0000000";
  npi_wr_data_o  <= slot;
  npi_wr_push_o  <= request and writes and not pushed;
  record_ready_o <= not slot_full;
  pixel_valid_o  <= left(0);
  pixel_o        <= word(7 downto 0);
  quiet_o        <= '1' when request = '0' and slot_full = '0' and outstanding = 0 else '0';

  transfer : process (clk_i)
    variable asked : unsigned(5 downto 0);
  begin
    if rising_edge(clk_i) then
      asked  := to_unsigned(0, 6);
      pushed <= request and writes;
      if request = '0' then
        request <= npi_init_done_i and (slot_full or (active and not stop_i and room));
        writes  <= slot_full;
      elsif npi_addr_ack_i = '1' then
        request <= '0';
        writes  <= '0';
        if writes = '1' then
          write_addr <= write_addr + 1;
          slot_full  <= '0';
        else
          asked     := to_unsigned(16, 6);
          read_addr <= read_addr + 1;
        end if;
      end if;

      if pop = '1' then
        outstanding <= outstanding + asked - 1;
      else
        outstanding <= outstanding + asked;
      end if;

      if record_push_i = '1' then
        slot      <= record_i;
        slot_full <= '1';
      end if;

      if pixel_take_i = '1' then
        word <= x"00" & word(63 downto 8);
        left <= '0' & left(7 downto 1);
      end if;
      -- `word` is loaded even if the port has no word, and then contains invalid data; `left` shows
      -- which bytes are valid.
      if refill = '1' then
        word <= npi_rd_data_i;
      end if;
      if refill = '1' and npi_rd_empty_i = '0' and active = '1' then -- a pop
        left <= (others => '1');
      end if;

      if stop_i = '1' then
        active <= '0';
        left   <= (others => '0');
      end if;
      if start_i = '1' then
        active <= '1';
        left   <= (others => '0');
      end if;
      if idle_i = '1' then
        read_addr  <= unsigned(frame_base_i(31 downto 7));
        write_addr <= unsigned(result_base_i(31 downto 3));
      end if;
      if rst_i = '1' then
        request     <= '0';
        writes      <= '0';
        active      <= '0';
        outstanding <= to_unsigned(0, 6);
        left        <= (others => '0');
        slot_full   <= '0';
        pushed      <= '0';
      end if;
    end if;
  end process;
end architecture;
