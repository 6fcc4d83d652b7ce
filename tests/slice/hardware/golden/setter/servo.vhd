-- SPDX-License-Identifier: MIT
--
-- servo: answers every call of ::Demo::Servo with zeros; registers by the generated servo_wrapper.

library ieee;
use ieee.std_logic_1164.all;

entity servo is
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
    irq_o : out std_logic;
    -- pins
    pwm_o : out std_logic_vector(3 downto 0);
    fault_i : in  std_logic
  );
end entity;

architecture rtl of servo is
  signal core_rst : std_logic;
  signal set_pulse_start : std_logic;
  signal set_pulse_pulse : std_logic_vector(15 downto 0);
begin

  u_wrapper : entity work.servo_wrapper
    port map (
      clk_i => clk_i, rst_i => rst_i,
      bus_valid_i => bus_valid_i, bus_write_i => bus_write_i, bus_addr_i => bus_addr_i,
      bus_wdata_i => bus_wdata_i, bus_ready_o => bus_ready_o, bus_rdata_o => bus_rdata_o,
      bus_error_o => bus_error_o, irq_o => irq_o,
      core_rst_o => core_rst,
      set_pulse_start_o => set_pulse_start,
      set_pulse_pulse_o => set_pulse_pulse);

  pwm_o <= (others => '0');

end architecture;
