-- SPDX-License-Identifier: MIT
--
-- calculator: answers every call of ::Demo::Calculator with zeros; registers by the generated calculator_wrapper.

library ieee;
use ieee.std_logic_1164.all;

entity calculator is
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

architecture rtl of calculator is
  signal core_rst : std_logic;
  signal set_mode_start : std_logic;
  signal set_mode_mode : std_logic_vector(1 downto 0);
  signal set_mode_negate : std_logic;
  signal set_mode_shift : std_logic_vector(7 downto 0);
  signal get_mode_start : std_logic;
  signal get_mode_negate : std_logic;
  signal get_mode_shift : std_logic_vector(7 downto 0);
  signal get_mode_result : std_logic_vector(1 downto 0);
  signal add_start : std_logic;
  signal add_a : std_logic_vector(31 downto 0);
  signal add_b : std_logic_vector(31 downto 0);
  signal add_result : std_logic_vector(31 downto 0);
  signal divide_start : std_logic;
  signal divide_a : std_logic_vector(31 downto 0);
  signal divide_b : std_logic_vector(31 downto 0);
  signal divide_remainder : std_logic_vector(31 downto 0);
  signal divide_result : std_logic_vector(31 downto 0);
  signal divide_done : std_logic;
  signal divide_refused : std_logic;
  signal swap_start : std_logic;
  signal swap_p_x : std_logic_vector(15 downto 0);
  signal swap_p_y : std_logic_vector(15 downto 0);
  signal swap_result_x : std_logic_vector(15 downto 0);
  signal swap_result_y : std_logic_vector(15 downto 0);
begin

  u_wrapper : entity work.calculator_wrapper
    port map (
      clk_i => clk_i, rst_i => rst_i,
      bus_valid_i => bus_valid_i, bus_write_i => bus_write_i, bus_addr_i => bus_addr_i,
      bus_wdata_i => bus_wdata_i, bus_ready_o => bus_ready_o, bus_rdata_o => bus_rdata_o,
      bus_error_o => bus_error_o, irq_o => irq_o,
      core_rst_o => core_rst,
      set_mode_start_o => set_mode_start,
      set_mode_mode_o => set_mode_mode,
      set_mode_negate_o => set_mode_negate,
      set_mode_shift_o => set_mode_shift,
      get_mode_start_o => get_mode_start,
      get_mode_negate_i => get_mode_negate,
      get_mode_shift_i => get_mode_shift,
      get_mode_result_i => get_mode_result,
      add_start_o => add_start,
      add_a_o => add_a,
      add_b_o => add_b,
      add_result_i => add_result,
      divide_start_o => divide_start,
      divide_a_o => divide_a,
      divide_b_o => divide_b,
      divide_remainder_i => divide_remainder,
      divide_result_i => divide_result,
      divide_done_i => divide_done,
      divide_refused_i => divide_refused,
      swap_start_o => swap_start,
      swap_p_x_o => swap_p_x,
      swap_p_y_o => swap_p_y,
      swap_result_x_i => swap_result_x,
      swap_result_y_i => swap_result_y);

  get_mode_negate <= '0';
  get_mode_shift <= (others => '0');
  get_mode_result <= (others => '0');
  add_result <= (others => '0');
  divide_remainder <= (others => '0');
  divide_result <= (others => '0');
  divide_refused <= '0';
  swap_result_x <= (others => '0');
  swap_result_y <= (others => '0');

  ends : process (clk_i)
  begin
    if rising_edge(clk_i) then
      divide_done <= divide_start and not core_rst;
    end if;
  end process;

end architecture;
