-- SPDX-License-Identifier: MIT
--
-- spi_master: a slot with NEORV32's SPI controller, an entity with generics and record ports. This file is all that
-- a core with a bus of its own needs: the slot's first words, and the other bus's handshake.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
library neorv32;
use neorv32.neorv32_package.all;
use neorv32.spi_master_regs_pkg.all;

entity spi_master is
  port (
    clk_i       : in  std_logic;
    rst_i       : in  std_logic;
    -- register bus
    bus_valid_i : in  std_logic;
    bus_write_i : in  std_logic;
    bus_addr_i  : in  std_logic_vector(3 downto 0);
    bus_wdata_i : in  std_logic_vector(31 downto 0);
    bus_ready_o : out std_logic;
    bus_rdata_o : out std_logic_vector(31 downto 0);
    bus_error_o : out std_logic;
    irq_o       : out std_logic;
    -- SPI
    spi_clk_o   : out std_logic;
    spi_dat_o   : out std_logic;
    spi_dat_i   : in  std_logic;
    spi_csn_o   : out std_logic_vector(7 downto 0)
  );
end entity;

architecture rtl of spi_master is
  signal word           : natural range 0 to 15;
  signal own, waiting   : std_logic; -- a word of the core's; its strobe has been given
  signal sticky, mask   : std_logic;
  signal irq            : std_ulogic;
  signal reset_n        : std_ulogic;
  signal req            : bus_req_t;
  signal rsp            : bus_rsp_t;
  signal ticks          : std_ulogic_vector(7 downto 0);
  signal prescaler      : unsigned(11 downto 0);
begin
  word    <= to_integer(unsigned(bus_addr_i));
  own     <= '1' when word = SPI_MASTER_CTRL or word = SPI_MASTER_DATA else '0';
  reset_n <= not rst_i;

  request : process (all)
  begin
    req      <= req_terminate_c;
    req.addr <= (2 => '1', others => '0');
    if word = SPI_MASTER_CTRL then
      req.addr(2) <= '0';
    end if;
    req.data <= std_ulogic_vector(bus_wdata_i);
    req.ben  <= "1111";
    req.rw   <= bus_write_i;
    req.stb  <= bus_valid_i and own and not waiting;
  end process;

  answer : process (all)
  begin
    bus_rdata_o <= (others => '0');
    bus_error_o <= '0';
    bus_ready_o <= '1';
    case word is
      when SPI_MASTER_ID    => bus_rdata_o <= std_logic_vector(to_unsigned(SPI_MASTER_ID_VALUE, 32));
      when SPI_MASTER_EVENT => bus_rdata_o(0) <= sticky;
      when SPI_MASTER_MASK  => bus_rdata_o(0) <= mask;
      when SPI_MASTER_CTRL | SPI_MASTER_DATA =>
        bus_rdata_o <= std_logic_vector(rsp.data);
        bus_error_o <= rsp.err;
        bus_ready_o <= rsp.ack;
      when others => bus_error_o <= '1';
    end case;
  end process;
  irq_o <= sticky and mask;

  -- NEORV32's clock enables: 1 in 2, 4, 8, 64, 128, 1024, 2048, 4096 clocks.
  ticks <= (0 => prescaler(0), 1 => prescaler(1) and prescaler(0), 2 => and prescaler(2 downto 0),
            3 => and prescaler(5 downto 0), 4 => and prescaler(6 downto 0), 5 => and prescaler(9 downto 0),
            6 => and prescaler(10 downto 0), 7 => and prescaler);

  registers : process (clk_i)
  begin
    if rising_edge(clk_i) then
      prescaler <= prescaler + 1;
      waiting   <= bus_valid_i and own and not rsp.ack;
      if bus_valid_i = '1' and bus_write_i = '1' then
        if word = SPI_MASTER_MASK then
          mask <= bus_wdata_i(0);
        elsif word = SPI_MASTER_EVENT and bus_wdata_i(0) = '1' then
          sticky <= '0';
        end if;
      end if;
      if irq = '1' then
        sticky <= '1';
      end if;
      if rst_i = '1' then
        waiting   <= '0';
        sticky    <= '0';
        mask      <= '0';
        prescaler <= (others => '0');
      end if;
    end if;
  end process;

  u_core : entity neorv32.neorv32_spi
    generic map (IO_SPI_FIFO => 4)
    port map (
      clk_i => clk_i, rstn_i => reset_n, bus_req_i => req, bus_rsp_o => rsp, clkgen_i => ticks,
      spi_clk_o => spi_clk_o, spi_dat_o => spi_dat_o, spi_dat_i => spi_dat_i, spi_csn_o => spi_csn_o, irq_o => irq
    );
end architecture;
