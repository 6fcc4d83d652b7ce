-- SPDX-License-Identifier: MIT
--
-- lamps: a core in VHDL for tests; its strobes for reading and writing are in a record of
-- lamps_types.vhd. It counts reads. It uses a Synopsys package, an attribute of an output, and an
-- assertion for simulation.
library ieee, lights; -- the library `lights` contains the core's package
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
use ieee.std_logic_misc.all;
use lights.lamps_types.all;

entity lamps is
  generic (
    lamps_lit : positive);
  port (
    clk, reset : in  std_logic;
    request    : in  request_t;
    q          : out std_logic_vector(15 downto 0);
    lamp       : out std_logic_vector(lamps_lit - 1 downto 0));
end entity;

architecture rtl of lamps is
  signal lit, reads : unsigned(15 downto 0);
  attribute preserve : boolean;
  attribute preserve of lamp : signal is true;
begin
  lamp <= std_logic_vector(lit(lamp'range));
  q    <= std_logic_vector(lit) when request.a = "0" else std_logic_vector(reads);

  process (clk)
  begin
    if rising_edge(clk) then
      if request.wr = '1' and request.a = "0" then
        lit <= unsigned(request.d);
      end if;
      if request.rd = '1' then
        reads <= reads + 1;
      end if;
      assert or_reduce(request.d) = '0' or request.wr = '1' report "data without a write";
      if reset = '1' then
        lit   <= (others => '0');
        reads <= (others => '0');
      end if;
    end if;
  end process;
end architecture;
