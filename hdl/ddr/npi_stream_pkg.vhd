-- SPDX-License-Identifier: MIT
--
-- npi_stream_pkg: declares the Verilog module npi_stream as a component, for cores in VHDL.

library ieee;
use ieee.std_logic_1164.all;

package npi_stream_pkg is
  component npi_stream is
    port (
      npi_addr_o           : out std_logic_vector(31 downto 0);
      npi_addr_req_o       : out std_logic;
      npi_addr_ack_i       : in  std_logic;
      npi_rnw_o            : out std_logic;
      npi_size_o           : out std_logic_vector(3 downto 0);
      npi_rmw_o            : out std_logic;
      npi_wr_data_o        : out std_logic_vector(63 downto 0);
      npi_wr_be_o          : out std_logic_vector(7 downto 0);
      npi_wr_push_o        : out std_logic;
      npi_wr_empty_i       : in  std_logic;
      npi_wr_almost_full_i : in  std_logic;
      npi_wr_flush_o       : out std_logic;
      npi_rd_data_i        : in  std_logic_vector(63 downto 0);
      npi_rd_word_i        : in  std_logic_vector(3 downto 0);
      npi_rd_pop_o         : out std_logic;
      npi_rd_empty_i       : in  std_logic;
      npi_rd_flush_o       : out std_logic;
      npi_init_done_i      : in  std_logic;
      clk_i                : in  std_logic;
      rst_i                : in  std_logic;
      -- read stream
      read_start_i         : in  std_logic;
      read_base_i          : in  std_logic_vector(31 downto 6);
      read_words_i         : in  std_logic_vector(23 downto 0);
      read_stop_i          : in  std_logic;
      read_valid_o         : out std_logic;
      read_data_o          : out std_logic_vector(63 downto 0);
      read_take_i          : in  std_logic;
      read_idle_o          : out std_logic;
      -- write stream
      write_start_i        : in  std_logic;
      write_base_i         : in  std_logic_vector(31 downto 6);
      write_valid_i        : in  std_logic;
      write_data_i         : in  std_logic_vector(63 downto 0);
      write_be_i           : in  std_logic_vector(7 downto 0);
      write_ready_o        : out std_logic;
      write_flush_i        : in  std_logic;
      write_idle_o         : out std_logic
    );
  end component;
end package;
