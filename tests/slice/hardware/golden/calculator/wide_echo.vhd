-- SPDX-License-Identifier: MIT
--
-- wide_echo: answers every call of ::Demo::WideEcho with zeros; registers by the generated wide_echo_wrapper.

library ieee;
use ieee.std_logic_1164.all;

entity wide_echo is
  port (
    -- clock, reset
    clk_i : in  std_logic;
    rst_i : in  std_logic;
    -- register bus
    bus_valid_i : in  std_logic;
    bus_write_i : in  std_logic;
    bus_addr_i : in  std_logic_vector(3 downto 0);
    bus_wdata_i : in  std_logic_vector(31 downto 0);
    bus_ready_o : out std_logic;
    bus_rdata_o : out std_logic_vector(31 downto 0);
    bus_error_o : out std_logic;
    -- interrupt
    irq_o : out std_logic
  );
end entity;

architecture rtl of wide_echo is
  signal core_rst : std_logic;
  signal negate_start : std_logic;
  signal negate_v : std_logic_vector(63 downto 0);
  signal negate_result : std_logic_vector(63 downto 0);
  signal same_start : std_logic;
  signal same_v : std_logic_vector(63 downto 0);
  signal same_result : std_logic_vector(63 downto 0);
  signal same_float_start : std_logic;
  signal same_float_v : std_logic_vector(31 downto 0);
  signal same_float_result : std_logic_vector(31 downto 0);
  signal pause_start : std_logic;
  signal pause_done : std_logic;
  signal pause_refused : std_logic;
  signal nothing_start : std_logic;
begin

  u_wrapper : entity work.wide_echo_wrapper
    port map (
      clk_i => clk_i, rst_i => rst_i,
      bus_valid_i => bus_valid_i, bus_write_i => bus_write_i, bus_addr_i => bus_addr_i,
      bus_wdata_i => bus_wdata_i, bus_ready_o => bus_ready_o, bus_rdata_o => bus_rdata_o,
      bus_error_o => bus_error_o, irq_o => irq_o,
      core_rst_o => core_rst,
      negate_start_o => negate_start,
      negate_v_o => negate_v,
      negate_result_i => negate_result,
      same_start_o => same_start,
      same_v_o => same_v,
      same_result_i => same_result,
      same_float_start_o => same_float_start,
      same_float_v_o => same_float_v,
      same_float_result_i => same_float_result,
      pause_start_o => pause_start,
      pause_done_i => pause_done,
      pause_refused_i => pause_refused,
      nothing_start_o => nothing_start);

  negate_result <= (others => '0');
  same_result <= (others => '0');
  same_float_result <= (others => '0');
  pause_refused <= '0';

  ends : process (clk_i)
  begin
    if rising_edge(clk_i) then
      pause_done <= pause_start and not core_rst;
    end if;
  end process;

end architecture;
