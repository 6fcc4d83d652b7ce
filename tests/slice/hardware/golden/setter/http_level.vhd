-- SPDX-License-Identifier: MIT
--
-- http_level: answers every call of ::Demo::HTTPLevel with zeros; registers by the generated http_level_wrapper.

library ieee;
use ieee.std_logic_1164.all;

entity http_level is
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

architecture rtl of http_level is
  signal core_rst : std_logic;
  signal set_level_start : std_logic;
  signal set_level_level : std_logic_vector(7 downto 0);
  signal level_start : std_logic;
  signal level_result : std_logic_vector(7 downto 0);
begin

  u_wrapper : entity work.http_level_wrapper
    port map (
      clk_i => clk_i, rst_i => rst_i,
      bus_valid_i => bus_valid_i, bus_write_i => bus_write_i, bus_addr_i => bus_addr_i,
      bus_wdata_i => bus_wdata_i, bus_ready_o => bus_ready_o, bus_rdata_o => bus_rdata_o,
      bus_error_o => bus_error_o, irq_o => irq_o,
      core_rst_o => core_rst,
      set_level_start_o => set_level_start,
      set_level_level_o => set_level_level,
      level_start_o => level_start,
      level_result_i => level_result);

  level_result <= (others => '0');

end architecture;
