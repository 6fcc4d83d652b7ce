-- SPDX-License-Identifier: MIT
--
-- scaler: answers every call of ::Demo::Scaler with zeros; registers by the generated scaler_wrapper.

library ieee;
use ieee.std_logic_1164.all;

entity scaler is
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

architecture rtl of scaler is
  signal core_rst : std_logic;
  signal set_limit_start : std_logic;
  signal set_limit_limit : std_logic_vector(15 downto 0);
  signal peak_event : std_logic;
  signal peak_largest_index : std_logic_vector(15 downto 0);
  signal peak_largest_value : std_logic_vector(15 downto 0);
  signal peak_taken : std_logic;
  signal finished_event : std_logic;
  signal finished_taken : std_logic;
  signal shift_start : std_logic;
  signal shift_list_base : std_logic_vector(31 downto 0);
  signal shift_list_count : std_logic_vector(6 downto 0);
  signal shift_offset : std_logic_vector(15 downto 0);
  signal shift_exception : std_logic;
  signal shift_shifted_base : std_logic_vector(31 downto 0);
  signal shift_shifted_count : std_logic_vector(6 downto 0);
  signal shift_result : std_logic_vector(31 downto 0);
  signal shift_overflow_index : std_logic_vector(15 downto 0);
  signal shift_overflow_code : std_logic_vector(7 downto 0);
  signal shift_done : std_logic;
  signal shift_refused : std_logic;
begin

  u_wrapper : entity work.scaler_wrapper
    port map (
      clk_i => clk_i, rst_i => rst_i,
      bus_valid_i => bus_valid_i, bus_write_i => bus_write_i, bus_addr_i => bus_addr_i,
      bus_wdata_i => bus_wdata_i, bus_ready_o => bus_ready_o, bus_rdata_o => bus_rdata_o,
      bus_error_o => bus_error_o, irq_o => irq_o,
      core_rst_o => core_rst,
      set_limit_start_o => set_limit_start,
      set_limit_limit_o => set_limit_limit,
      peak_event_i => peak_event,
      peak_largest_index_i => peak_largest_index,
      peak_largest_value_i => peak_largest_value,
      peak_taken_o => peak_taken,
      finished_event_i => finished_event,
      finished_taken_o => finished_taken,
      shift_start_o => shift_start,
      shift_list_base_o => shift_list_base,
      shift_list_count_o => shift_list_count,
      shift_offset_o => shift_offset,
      shift_exception_i => shift_exception,
      shift_shifted_base_o => shift_shifted_base,
      shift_shifted_count_i => shift_shifted_count,
      shift_result_i => shift_result,
      shift_overflow_index_i => shift_overflow_index,
      shift_overflow_code_i => shift_overflow_code,
      shift_done_i => shift_done,
      shift_refused_i => shift_refused);

  peak_event <= '0';
  peak_largest_index <= (others => '0');
  peak_largest_value <= (others => '0');
  finished_event <= '0';
  shift_exception <= '0';
  shift_shifted_count <= (others => '0');
  shift_result <= (others => '0');
  shift_overflow_index <= (others => '0');
  shift_overflow_code <= (others => '0');
  shift_refused <= '0';
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

  ends : process (clk_i)
  begin
    if rising_edge(clk_i) then
      shift_done <= shift_start and not core_rst;
    end if;
  end process;

end architecture;
