-- SPDX-License-Identifier: MIT
--
-- spi_plain: NEORV32's SPI controller with plain ports in place of generics and records. This file is all that such a core
-- needs: `make new-foreign BUS=own LIBRARY=neorv32` puts it into a slot.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library neorv32;
use neorv32.neorv32_package.all;

entity spi_plain is
  port (
    clk_i, rst_i : in  std_ulogic;
    -- NEORV32's bus: a strobe of one clock, answered later
    stb_i, we_i  : in  std_ulogic;
    adr_i        : in  std_ulogic_vector(0 downto 0);
    dat_i        : in  std_ulogic_vector(31 downto 0);
    dat_o        : out std_ulogic_vector(31 downto 0);
    ack_o, err_o : out std_ulogic;
    irq_o        : out std_ulogic;
    -- SPI
    spi_clk_o    : out std_ulogic;
    spi_dat_o    : out std_ulogic;
    spi_dat_i    : in  std_ulogic;
    spi_csn_o    : out std_ulogic_vector(7 downto 0)
  );
end entity;

architecture rtl of spi_plain is
  signal req       : bus_req_t;
  signal rsp       : bus_rsp_t;
  signal resetn    : std_ulogic;
  signal ticks     : std_ulogic_vector(7 downto 0);
  signal prescaler : unsigned(11 downto 0);
begin
  request : process (all)
  begin
    req         <= req_terminate_c;
    req.addr(2) <= adr_i(0);
    req.data    <= dat_i;
    req.ben     <= "1111";
    req.rw      <= we_i;
    req.stb     <= stb_i;
  end process;
  dat_o  <= rsp.data;
  ack_o  <= rsp.ack;
  err_o  <= rsp.err;
  resetn <= not rst_i;

  -- NEORV32's clock enables: 1 in 2, 4, 8, 64, 128, 1024, 2048, 4096 clocks.
  ticks <= (0 => prescaler(0), 1 => and prescaler(1 downto 0), 2 => and prescaler(2 downto 0),
            3 => and prescaler(5 downto 0), 4 => and prescaler(6 downto 0), 5 => and prescaler(9 downto 0),
            6 => and prescaler(10 downto 0), 7 => and prescaler);
  count : process (clk_i)
  begin
    if rising_edge(clk_i) then
      prescaler <= (others => '0') when rst_i else prescaler + 1;
    end if;
  end process;

  u_core : entity neorv32.neorv32_spi
    generic map (IO_SPI_FIFO => 4)
    port map (
      clk_i => clk_i, rstn_i => resetn, bus_req_i => req, bus_rsp_o => rsp, clkgen_i => ticks,
      spi_clk_o => spi_clk_o, spi_dat_o => spi_dat_o, spi_dat_i => spi_dat_i, spi_csn_o => spi_csn_o, irq_o => irq_o
    );
end architecture;
