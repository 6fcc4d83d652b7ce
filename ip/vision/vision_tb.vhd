-- SPDX-License-Identifier: MIT
--
-- vision_tb: compares the records of the VHDL core with the records of the model, while the memory
-- stalls.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
use std.textio.all;
use work.vision_regs_pkg.all;

entity vision_tb is
end entity;

architecture test of vision_tb is
  constant WIDTH  : natural := 64;
  constant HEIGHT : natural := 40;
  constant THRESHOLD : natural := 20;
  constant RESULTS : natural := 8192; -- byte address of the records; the frame is at 0
  type bytes_t is array (0 to 16383) of std_logic_vector(7 downto 0);

  signal clk : std_logic := '0';
  signal rst : std_logic := '1';
  signal done : boolean := false;
  signal bus_valid, bus_write, bus_ready, bus_error, irq : std_logic := '0';
  signal bus_addr : std_logic_vector(3 downto 0) := "0000";
  signal bus_wdata, bus_rdata, npi_addr : std_logic_vector(31 downto 0) := (others => '0');
  signal npi_req, npi_ack, npi_rnw, npi_push, npi_pop : std_logic := '0';
  signal npi_empty : std_logic := '1';
  signal npi_size : std_logic_vector(3 downto 0);
  signal npi_wr_data, npi_rd_data : std_logic_vector(63 downto 0) := (others => '0');
  signal npi_be : std_logic_vector(7 downto 0);
begin
  clk <= not clk after 5 ns when not done;

  u_vision : entity work.vision
    port map (
      clk_i => clk, rst_i => rst,
      bus_valid_i => bus_valid, bus_write_i => bus_write, bus_addr_i => bus_addr,
      bus_wdata_i => bus_wdata, bus_ready_o => bus_ready, bus_rdata_o => bus_rdata,
      bus_error_o => bus_error, irq_o => irq,
      npi_addr_o => npi_addr, npi_addr_req_o => npi_req, npi_addr_ack_i => npi_ack,
      npi_rnw_o => npi_rnw, npi_size_o => npi_size, npi_rmw_o => open,
      npi_wr_data_o => npi_wr_data, npi_wr_be_o => npi_be, npi_wr_push_o => npi_push,
      npi_wr_empty_i => '1', npi_wr_almost_full_i => '0', npi_wr_flush_o => open,
      npi_rd_data_i => npi_rd_data, npi_rd_word_i => "0000", npi_rd_pop_o => npi_pop,
      npi_rd_empty_i => npi_empty, npi_rd_flush_o => open, npi_init_done_i => '1'
    );

  memory_and_checks : process
    variable memory : bytes_t := (others => x"00");
    variable pushed : std_logic_vector(63 downto 0);
    variable read_at, left : natural := 0;
    -- address and remaining words of a second burst that waits
    variable next_at, next_left : natural := 0;
    variable random : natural := 1;
    variable l : line;
    variable n, x, y, score : integer;
    file picture : text open read_mode is "picture.txt";
    file records : text open read_mode is "records.txt";
    variable index : natural := 0;

    procedure clock is
      variable address : natural;
      variable acked, popped : boolean;
    begin
      wait until rising_edge(clk);
      -- The memory model behaves like registers: it samples its inputs at the edge and drives its
      -- outputs after the edge.
      random := (random * 75 + 74) mod 65537;
      address := to_integer(unsigned(npi_addr(20 downto 0)));
      if npi_push = '1' then
        pushed := npi_wr_data;
      end if;
      popped := npi_pop = '1';
      acked := npi_req = '1' and npi_ack = '0' and random mod 3 /= 0 and
               (npi_rnw = '0' or next_left = 0);
      if npi_ack = '1' then -- the request ends at this edge
        if npi_rnw = '1' then
          if left = 0 then
            read_at := address;
            left := 16;
          else
            next_at := address;
            next_left := 16;
          end if;
        else
          for b in 0 to 7 loop
            memory(address + b) := pushed(8 * b + 7 downto 8 * b);
          end loop;
        end if;
      end if;
      if popped then
        read_at := read_at + 8;
        left := left - 1;
        if left = 0 then
          read_at := next_at;
          left := next_left;
          next_left := 0;
        end if;
      end if;
      npi_ack <= '1' when acked else '0';
      npi_empty <= '1' when left = 0 or random mod 5 = 0 else '0';
      for b in 0 to 7 loop
        npi_rd_data(8 * b + 7 downto 8 * b) <= memory((read_at + b) mod 16384);
      end loop;
      wait for 1 ns;
    end procedure;

    procedure write_register(word : natural; value : natural) is
    begin
      bus_valid <= '1';
      bus_write <= '1';
      bus_addr  <= std_logic_vector(to_unsigned(word, 4));
      bus_wdata <= std_logic_vector(to_unsigned(value, 32));
      clock;
      bus_valid <= '0';
    end procedure;
  begin
    while not endfile(picture) loop
      readline(picture, l);
      read(l, n);
      memory(index) := std_logic_vector(to_unsigned(n, 8));
      index := index + 1;
    end loop;
    clock;
    clock;
    rst <= '0';
    write_register(VISION_MASK, 3);
    write_register(VISION_THRESHOLD, THRESHOLD);
    write_register(VISION_FRAME_BASE, 0);
    write_register(VISION_FRAME_SIZE, HEIGHT * 65536 + WIDTH);
    write_register(VISION_RESULT_BASE, RESULTS);
    write_register(VISION_RESULT_MAX, 1000);
    write_register(VISION_CONTROL, 1);
    for i in 0 to 50000 loop
      exit when irq = '1';
      clock;
    end loop;
    assert irq = '1' report "no interrupt after 50000 clocks" severity failure;

    index := 0;
    while not endfile(records) loop
      readline(records, l);
      read(l, x);
      read(l, y);
      read(l, score);
      n := RESULTS + 8 * index;
      assert to_integer(unsigned(memory(n + 1)) & unsigned(memory(n))) = x and
             to_integer(unsigned(memory(n + 3)) & unsigned(memory(n + 2))) = y and
             to_integer(unsigned(memory(n + 5)) & unsigned(memory(n + 4))) = score
        report "record " & to_string(index) & " differs from the model" severity failure;
      index := index + 1;
    end loop;
    bus_addr <= std_logic_vector(to_unsigned(VISION_FOUND, 4));
    wait for 1 ns;
    assert to_integer(unsigned(bus_rdata)) = index
      report "FOUND: expected " & to_string(index) & ", got " &
             to_string(to_integer(unsigned(bus_rdata))) severity failure;
    report "vision: " & to_string(index) & " records equal the model's";
    done <= true;
    wait;
  end process;
end architecture;
