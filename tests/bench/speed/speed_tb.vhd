-- SPDX-License-Identifier: MIT
--
-- speed_tb: what speed_tb.v does, in VHDL, for GHDL. Generic frames.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
use work.vision_regs_pkg.all;

entity speed_tb is
  generic (frames : natural := 1);
end entity;

architecture test of speed_tb is
  constant WIDTH  : natural := 256;
  constant HEIGHT : natural := 64;
  signal clk : std_logic := '0';
  signal rst : std_logic := '1';
  signal done : boolean := false;
  signal bus_valid, irq, npi_req, npi_ack, npi_rnw, npi_pop : std_logic := '0';
  signal bus_addr : std_logic_vector(3 downto 0) := "0000";
  signal bus_wdata, npi_addr : std_logic_vector(31 downto 0) := (others => '0');
  signal npi_empty : std_logic := '1';
  signal npi_rd_data : std_logic_vector(63 downto 0) := (others => '0');
  signal clocks : natural := 0;

  function pixel(address : unsigned(31 downto 0)) return std_logic_vector is
    variable value : unsigned(7 downto 0);
  begin
    value := (address(4 downto 0) xor address(12 downto 8)) & "000";
    if (address(5) xor address(10)) = '1' then
      value := value + 90;
    end if;
    return std_logic_vector(value);
  end function;
begin
  clk <= not clk after 5 ns when not done;

  u_vision : entity work.vision
    port map (
      clk_i => clk, rst_i => rst, bus_valid_i => bus_valid, bus_write_i => '1', bus_addr_i => bus_addr,
      bus_wdata_i => bus_wdata, bus_ready_o => open, bus_rdata_o => open, bus_error_o => open, irq_o => irq,
      npi_addr_o => npi_addr, npi_addr_req_o => npi_req, npi_addr_ack_i => npi_ack, npi_rnw_o => npi_rnw,
      npi_size_o => open, npi_rmw_o => open, npi_wr_data_o => open, npi_wr_be_o => open, npi_wr_push_o => open,
      npi_wr_empty_i => '1', npi_wr_almost_full_i => '0', npi_wr_flush_o => open,
      npi_rd_data_i => npi_rd_data, npi_rd_word_i => "0000", npi_rd_pop_o => npi_pop,
      npi_rd_empty_i => npi_empty, npi_rd_flush_o => open, npi_init_done_i => '1'
    );

  memory : process (clk)
    variable at, next_at : unsigned(31 downto 0) := (others => '0');
    variable left, next_left : natural := 0;
  begin
    if rising_edge(clk) then
      clocks <= clocks + 1;
      npi_ack <= '0';
      if npi_req = '1' and npi_ack = '0' and (npi_rnw = '0' or next_left = 0) then
        npi_ack <= '1';
      end if;
      if npi_pop = '1' then
        if left > 1 then
          at := at + 8;
          left := left - 1;
        else
          at := next_at;
          left := next_left;
          next_left := 0;
        end if;
      end if;
      if npi_ack = '1' and npi_rnw = '1' then
        if left = 0 then
          at := unsigned(npi_addr);
          left := 16;
        else
          next_at := unsigned(npi_addr);
          next_left := 16;
        end if;
      end if;
      npi_empty <= '1' when left = 0 else '0';
      for b in 0 to 7 loop
        npi_rd_data(8 * b + 7 downto 8 * b) <= pixel(at + b);
      end loop;
    end if;
  end process;

  stimulus : process
    procedure write_register(word : natural; value : natural) is
    begin
      bus_valid <= '1';
      bus_addr  <= std_logic_vector(to_unsigned(word, 4));
      bus_wdata <= std_logic_vector(to_unsigned(value, 32));
      wait until rising_edge(clk);
      wait for 1 ns;
      bus_valid <= '0';
    end procedure;
  begin
    for i in 1 to 4 loop
      wait until rising_edge(clk);
    end loop;
    wait for 1 ns;
    rst <= '0';
    write_register(VISION_MASK, 3);
    write_register(VISION_THRESHOLD, 20);
    write_register(VISION_FRAME_BASE, 0);
    write_register(VISION_FRAME_SIZE, HEIGHT * 65536 + WIDTH);
    write_register(VISION_RESULT_BASE, 16#100000#);
    write_register(VISION_RESULT_MAX, 0);
    for frame in 1 to frames loop
      write_register(VISION_EVENT, 3);
      write_register(VISION_CONTROL, 1);
      while irq = '0' loop
        wait until rising_edge(clk);
        wait for 1 ns;
      end loop;
    end loop;
    report "clocks " & to_string(clocks);
    done <= true;
    wait;
  end process;
end architecture;
