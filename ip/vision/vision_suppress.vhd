-- SPDX-License-Identifier: MIT
--
-- vision_suppress: keeps a score only if it is the greatest in its neighbourhood of 3 x 3; all
-- other scores become 0.
--
-- Of neighbours with equal scores, the first one in scan order is kept. The result for a score
-- needs the whole neighbourhood, so it appears when the score one line and one column later has
-- entered. kept_o then belongs to the earlier score, not to the score that entered.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity vision_suppress is
  port (
    clk_i   : in  std_logic;
    step_i  : in  std_logic;
    x_i     : in  unsigned(9 downto 0);  -- column of the score that enters
    score_i : in  unsigned(11 downto 0);
    -- score of the centre; valid two steps after the last score of its neighbourhood has entered
    score_o : out unsigned(11 downto 0);
    kept_o  : out std_logic
  );
end entity;

architecture rtl of vision_suppress is
  type ram_t is array (0 to 1023) of std_logic_vector(23 downto 0);
  type row_t is array (0 to 2) of unsigned(11 downto 0); -- column 0 is the oldest column
  type window_t is array (0 to 2) of row_t;              -- row 0 is the oldest row
  signal ram   : ram_t;
  signal above : std_logic_vector(23 downto 0);
  signal score : unsigned(11 downto 0);
  signal x     : unsigned(9 downto 0);
  signal w     : window_t;
begin
  lines : process (clk_i)
  begin
    if rising_edge(clk_i) then
      if step_i = '1' then
        above <= ram(to_integer(x_i));
        score <= score_i;
        x     <= x_i;
        ram(to_integer(x)) <= above(11 downto 0) & std_logic_vector(score);
        for row in 0 to 2 loop
          w(row)(0) <= w(row)(1);
          w(row)(1) <= w(row)(2);
        end loop;
        w(0)(2) <= unsigned(above(23 downto 12));
        w(1)(2) <= unsigned(above(11 downto 0));
        w(2)(2) <= score;
      end if;
    end if;
  end process;

  decide : process (w)
    variable c : unsigned(11 downto 0);
  begin
    c := w(1)(1);
    score_o <= c;
    kept_o <= '0';
    if c > 0 and c > w(0)(0) and c > w(0)(1) and c > w(0)(2) and c > w(1)(0) and
       c >= w(1)(2) and c >= w(2)(0) and c >= w(2)(1) and c >= w(2)(2) then
      kept_o <= '1';
    end if;
  end process;
end architecture;
