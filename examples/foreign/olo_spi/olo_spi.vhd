-- SPDX-License-Identifier: MIT
--
-- olo_spi: open-logic's SPI master, 10 MHz at a clock of 100 MHz; registers by the generated olo_spi_wrapper.

library ieee;
use ieee.std_logic_1164.all;

entity olo_spi is
  port (
    clk_i, rst_i             : in  std_logic;
    -- register bus
    bus_valid_i, bus_write_i : in  std_logic;
    bus_addr_i               : in  std_logic_vector(3 downto 0);
    bus_wdata_i              : in  std_logic_vector(31 downto 0);
    bus_ready_o              : out std_logic;
    bus_rdata_o              : out std_logic_vector(31 downto 0);
    bus_error_o, irq_o       : out std_logic;
    -- SPI
    sclk_o, mosi_o, cs_n_o   : out std_logic;
    miso_i                   : in  std_logic
  );
end entity;

architecture rtl of olo_spi is
  signal core_rst, start, came, done : std_logic;
  signal data, response, result      : std_logic_vector(31 downto 0);
  signal miso                        : std_logic_vector(1 downto 0);
begin

  u_wrapper : entity work.olo_spi_wrapper
    port map (
      clk_i => clk_i, rst_i => rst_i,
      bus_valid_i => bus_valid_i, bus_write_i => bus_write_i, bus_addr_i => bus_addr_i,
      bus_wdata_i => bus_wdata_i, bus_ready_o => bus_ready_o, bus_rdata_o => bus_rdata_o,
      bus_error_o => bus_error_o, irq_o => irq_o, core_rst_o => core_rst,
      transfer_start_o => start, transfer_data_o => data, transfer_result_i => result,
      transfer_done_i => done, transfer_refused_i => '0');

  u_spi : entity work.olo_intf_spi_master
    generic map (ClkFreq_g => 100.0e6, SclkFreq_g => 10.0e6)
    port map (
      Clk => clk_i, Rst => core_rst, Cmd_Valid => start, Cmd_Ready => open, Cmd_Data => data,
      Resp_Valid => came, Resp_Data => response,
      Spi_Sclk => sclk_o, Spi_Mosi => mosi_o, Spi_Miso => miso(1), Spi_Cs_n(0) => cs_n_o);

  registers : process (clk_i)
  begin
    if rising_edge(clk_i) then
      miso <= miso(0) & miso_i; -- an input belongs to no clock of the chip
      done <= came and not core_rst;
      if came = '1' then
        result <= response;
      end if;
    end if;
  end process;

end architecture;
