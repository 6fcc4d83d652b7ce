-- SPDX-License-Identifier: MIT
--
-- lamps: a core in VHDL with a strobe for reading and one for writing; it counts what is read.
library ieee, lights; -- the second one is its own
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity lamps is
  port (
    clk, reset : in  std_logic;
    rd, wr     : in  std_logic;
    a          : in  std_logic_vector(0 downto 0);
    d          : in  std_logic_vector(15 downto 0);
    q          : out std_logic_vector(15 downto 0);
    lamp       : out std_logic_vector(3 downto 0));
end entity;

architecture rtl of lamps is
  signal lit, reads : unsigned(15 downto 0);
begin
  lamp <= std_logic_vector(lit(3 downto 0));
  q    <= std_logic_vector(lit) when a = "0" else std_logic_vector(reads);

  process (clk)
  begin
    if rising_edge(clk) then
      if wr = '1' and a = "0" then
        lit <= unsigned(d);
      end if;
      if rd = '1' then
        reads <= reads + 1;
      end if;
      if reset = '1' then
        lit   <= (others => '0');
        reads <= (others => '0');
      end if;
    end if;
  end process;
end architecture;
