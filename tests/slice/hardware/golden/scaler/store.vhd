-- SPDX-License-Identifier: MIT
--
-- store: answers every call of ::Demo::Store with zeros; registers by the generated store_wrapper.

library ieee;
use ieee.std_logic_1164.all;

entity store is
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
    -- memory port
    npi_addr_o : out std_logic_vector(31 downto 0);
    npi_addr_req_o : out std_logic;
    npi_addr_ack_i : in  std_logic;
    npi_rnw_o : out std_logic;
    npi_size_o : out std_logic_vector(3 downto 0);
    npi_rmw_o : out std_logic;
    npi_wr_data_o : out std_logic_vector(63 downto 0);
    npi_wr_be_o : out std_logic_vector(7 downto 0);
    npi_wr_push_o : out std_logic;
    npi_wr_empty_i : in  std_logic;
    npi_wr_almost_full_i : in  std_logic;
    npi_wr_flush_o : out std_logic;
    npi_rd_data_i : in  std_logic_vector(63 downto 0);
    npi_rd_word_i : in  std_logic_vector(3 downto 0);
    npi_rd_pop_o : out std_logic;
    npi_rd_empty_i : in  std_logic;
    npi_rd_flush_o : out std_logic;
    npi_init_done_i : in  std_logic
  );
end entity;

architecture rtl of store is
  signal core_rst : std_logic;
  signal exchange_start : std_logic;
  signal exchange_v_base : std_logic_vector(31 downto 0);
  signal exchange_v_count : std_logic_vector(1 downto 0);
  signal exchange_peaks_base : std_logic_vector(31 downto 0);
  signal exchange_peaks_count : std_logic_vector(2 downto 0);
  signal exchange_bytes_base : std_logic_vector(31 downto 0);
  signal exchange_bytes_count : std_logic_vector(11 downto 0);
  signal exchange_w_base : std_logic_vector(31 downto 0);
  signal exchange_w_count : std_logic_vector(1 downto 0);
  signal exchange_result : std_logic_vector(7 downto 0);
begin

  u_wrapper : entity work.store_wrapper
    port map (
      clk_i => clk_i, rst_i => rst_i,
      bus_valid_i => bus_valid_i, bus_write_i => bus_write_i, bus_addr_i => bus_addr_i,
      bus_wdata_i => bus_wdata_i, bus_ready_o => bus_ready_o, bus_rdata_o => bus_rdata_o,
      bus_error_o => bus_error_o, irq_o => irq_o,
      core_rst_o => core_rst,
      exchange_start_o => exchange_start,
      exchange_v_base_o => exchange_v_base,
      exchange_v_count_o => exchange_v_count,
      exchange_peaks_base_o => exchange_peaks_base,
      exchange_peaks_count_o => exchange_peaks_count,
      exchange_bytes_base_o => exchange_bytes_base,
      exchange_bytes_count_i => exchange_bytes_count,
      exchange_w_base_o => exchange_w_base,
      exchange_w_count_i => exchange_w_count,
      exchange_result_i => exchange_result);

  exchange_bytes_count <= (others => '0');
  exchange_w_count <= (others => '0');
  exchange_result <= (others => '0');
  npi_addr_o <= (others => '0');
  npi_addr_req_o <= '0';
  npi_rnw_o <= '0';
  npi_size_o <= (others => '0');
  npi_rmw_o <= '0';
  npi_wr_data_o <= (others => '0');
  npi_wr_be_o <= (others => '0');
  npi_wr_push_o <= '0';
  npi_wr_flush_o <= '0';
  npi_rd_pop_o <= '0';
  npi_rd_flush_o <= '0';

end architecture;
