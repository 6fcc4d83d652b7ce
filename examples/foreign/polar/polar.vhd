-- SPDX-License-Identifier: MIT
--
-- polar: bladeRF's CORDIC, which turns a vector until its y is 0; registers by the generated
-- polar_wrapper.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
use work.cordic_p.all;

entity polar is
  port (
    clk_i, rst_i             : in  std_logic;
    -- register bus
    bus_valid_i, bus_write_i : in  std_logic;
    bus_addr_i               : in  std_logic_vector(3 downto 0);
    bus_wdata_i              : in  std_logic_vector(31 downto 0);
    bus_ready_o              : out std_logic;
    bus_rdata_o              : out std_logic_vector(31 downto 0);
    bus_error_o, irq_o       : out std_logic
  );
end entity;

architecture rtl of polar is
  signal core_rst, start : std_logic;
  signal x, y            : std_logic_vector(15 downto 0);
  signal point, turned   : cordic_xyz_t;
begin

  u_wrapper : entity work.polar_wrapper
    port map (
      clk_i => clk_i, rst_i => rst_i,
      bus_valid_i => bus_valid_i, bus_write_i => bus_write_i, bus_addr_i => bus_addr_i,
      bus_wdata_i => bus_wdata_i, bus_ready_o => bus_ready_o, bus_rdata_o => bus_rdata_o,
      bus_error_o => bus_error_o, irq_o => irq_o, core_rst_o => core_rst,
      angle_start_o => start, angle_x_o => x, angle_y_o => y,
      angle_result_i => std_logic_vector(turned.z), angle_done_i => turned.valid,
      angle_refused_i => '0');

  point <= (x => signed(x), y => signed(y), z => (others => '0'), valid => start);

  u_cordic : entity work.cordic
    port map (
      clock => clk_i, reset => core_rst, mode => CORDIC_VECTORING,
      inputs => point, outputs => turned);

end architecture;
