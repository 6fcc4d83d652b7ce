-- SPDX-License-Identifier: MIT
--
-- axis_memory_pkg: axis_memory.v as a component, for cores in VHDL (docs/memory.md).

library ieee;
use ieee.std_logic_1164.all;

package axis_memory_pkg is

  component axis_memory is
    generic (
      ADDR_BITS : integer := 32; -- of a byte address, 7..32
      BYTE_BITS : integer := 24; -- of a row's number of bytes, 7..32
      ROWS      : integer := 1;  -- 0: each packet is one row, and rows and stride are not looked at
      TAG_BITS  : integer := 1   -- tag, repeated with each packet
    );
    port (
      clk_i  : in  std_logic;
      rst_i  : in  std_logic;
      stop_i : in  std_logic;
      idle_o : out std_logic;
      -- buffers to read
      read_valid_i  : in  std_logic;
      read_ready_o  : out std_logic;
      read_base_i   : in  std_logic_vector(ADDR_BITS - 1 downto 0);
      read_bytes_i  : in  std_logic_vector(BYTE_BITS - 1 downto 0);
      read_rows_i   : in  std_logic_vector(15 downto 0);
      read_stride_i : in  std_logic_vector(ADDR_BITS - 1 downto 0);
      read_tag_i    : in  std_logic_vector(TAG_BITS - 1 downto 0);
      -- their packets
      m_axis_tvalid_o : out std_logic;
      m_axis_tready_i : in  std_logic;
      m_axis_tdata_o  : out std_logic_vector(63 downto 0);
      m_axis_tkeep_o  : out std_logic_vector(7 downto 0);
      m_axis_tlast_o  : out std_logic;
      m_axis_tid_o    : out std_logic_vector(TAG_BITS - 1 downto 0);
      -- buffers to write
      write_valid_i  : in  std_logic;
      write_ready_o  : out std_logic;
      write_base_i   : in  std_logic_vector(ADDR_BITS - 1 downto 0);
      write_bytes_i  : in  std_logic_vector(BYTE_BITS - 1 downto 0);
      write_rows_i   : in  std_logic_vector(15 downto 0);
      write_stride_i : in  std_logic_vector(ADDR_BITS - 1 downto 0);
      write_tag_i    : in  std_logic_vector(TAG_BITS - 1 downto 0);
      -- packets
      s_axis_tvalid_i : in  std_logic;
      s_axis_tready_o : out std_logic;
      s_axis_tdata_i  : in  std_logic_vector(63 downto 0);
      s_axis_tkeep_i  : in  std_logic_vector(7 downto 0);
      s_axis_tlast_i  : in  std_logic;
      -- a packet is in memory
      done_valid_o : out std_logic;
      done_ready_i : in  std_logic;
      done_bytes_o : out std_logic_vector(BYTE_BITS - 1 downto 0);
      done_over_o  : out std_logic;
      done_tag_o   : out std_logic_vector(TAG_BITS - 1 downto 0);
      -- memory port
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
      npi_init_done_i      : in  std_logic
    );
  end component;

end package;
