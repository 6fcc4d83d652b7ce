-- SPDX-License-Identifier: MIT
--
-- cutter: cuts a window out of a picture in DDR3: the read stream goes into the written one,
-- between two descriptors.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
use work.axis_memory_pkg.all;

entity cutter is
  port (
    clk_i : in std_logic;
    rst_i : in std_logic;
    -- register bus
    bus_valid_i : in  std_logic;
    bus_write_i : in  std_logic;
    bus_addr_i  : in  std_logic_vector(3 downto 0);
    bus_wdata_i : in  std_logic_vector(31 downto 0);
    bus_ready_o : out std_logic;
    bus_rdata_o : out std_logic_vector(31 downto 0);
    bus_error_o : out std_logic;
    -- interrupt
    irq_o : out std_logic;
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
end entity;

architecture rtl of cutter is
  signal core_rst, start, done, refused, no_window, over       : std_logic;
  signal picture, result                                       : std_logic_vector(31 downto 0);
  signal width, x, y, columns, rows                            : std_logic_vector(15 downto 0);
  signal bytes                                                 : std_logic_vector(23 downto 0);
  signal corner                                                : unsigned(31 downto 0);
  signal bad, offer_read, offer_write, read_ready, write_ready : std_logic;
  signal data                                                  : std_logic_vector(63 downto 0);
  signal keep                                                  : std_logic_vector(7 downto 0);
  signal valid, ready, last, ended                             : std_logic;
begin

  u_wrapper : entity work.cutter_wrapper
    port map (
      clk_i => clk_i, rst_i => rst_i,
      bus_valid_i => bus_valid_i, bus_write_i => bus_write_i, bus_addr_i => bus_addr_i,
      bus_wdata_i => bus_wdata_i, bus_ready_o => bus_ready_o, bus_rdata_o => bus_rdata_o,
      bus_error_o => bus_error_o, irq_o => irq_o, core_rst_o => core_rst,
      cut_start_o => start, cut_picture_base_o => picture, cut_picture_count_o => open,
      cut_width_o => width, cut_x_o => x, cut_y_o => y, cut_columns_o => columns, cut_rows_o => rows,
      cut_result_base_o => result, cut_result_count_i => bytes(10 downto 0),
      cut_done_i => done, cut_refused_i => no_window);

  u_memory : axis_memory
    port map (
      clk_i => clk_i, rst_i => rst_i, stop_i => core_rst, idle_o => open,
      read_valid_i => offer_read, read_ready_o => read_ready, read_base_i => std_logic_vector(corner),
      read_bytes_i => x"00" & columns, read_rows_i => rows, read_stride_i => x"0000" & width, read_tag_i => "0",
      m_axis_tvalid_o => valid, m_axis_tready_i => ready, m_axis_tdata_o => data, m_axis_tkeep_o => keep,
      m_axis_tlast_o => last, m_axis_tid_o => open,
      write_valid_i => offer_write, write_ready_o => write_ready, write_base_i => result,
      write_bytes_i => x"000400", write_rows_i => x"0001", write_stride_i => x"00000000", write_tag_i => "0",
      s_axis_tvalid_i => valid, s_axis_tready_o => ready, s_axis_tdata_i => data, s_axis_tkeep_i => keep,
      s_axis_tlast_i => last,
      done_valid_o => ended, done_ready_i => '1', done_bytes_o => bytes, done_over_o => over, done_tag_o => open,
      npi_addr_o => npi_addr_o, npi_addr_req_o => npi_addr_req_o, npi_addr_ack_i => npi_addr_ack_i,
      npi_rnw_o => npi_rnw_o, npi_size_o => npi_size_o, npi_rmw_o => npi_rmw_o, npi_wr_data_o => npi_wr_data_o,
      npi_wr_be_o => npi_wr_be_o, npi_wr_push_o => npi_wr_push_o, npi_wr_empty_i => npi_wr_empty_i,
      npi_wr_almost_full_i => npi_wr_almost_full_i, npi_wr_flush_o => npi_wr_flush_o,
      npi_rd_data_i => npi_rd_data_i, npi_rd_word_i => npi_rd_word_i, npi_rd_pop_o => npi_rd_pop_o,
      npi_rd_empty_i => npi_rd_empty_i, npi_rd_flush_o => npi_rd_flush_o, npi_init_done_i => npi_init_done_i);

  bad <= '1' when unsigned(width(2 downto 0)) /= 0 or unsigned(x(2 downto 0)) /= 0 or unsigned(columns(2 downto 0)) /= 0
         or unsigned(columns) = 0 or unsigned(rows) = 0 else '0';
  done      <= ended or refused;
  no_window <= refused or over; -- of more pixels than the answer has room for, too

  descriptors : process (clk_i)
  begin
    if rising_edge(clk_i) then
      corner <= unsigned(picture) + unsigned(y) * unsigned(width) + unsigned(x);
      if read_ready = '1' then
        offer_read <= '0';
      end if;
      if write_ready = '1' then
        offer_write <= '0';
      end if;
      refused <= '0';
      if start = '1' then
        offer_read  <= not bad;
        offer_write <= not bad;
        refused     <= bad;
      end if;
      if core_rst = '1' then
        offer_read  <= '0';
        offer_write <= '0';
        refused     <= '0';
      end if;
    end if;
  end process;

end architecture;
