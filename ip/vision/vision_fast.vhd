-- SPDX-License-Identifier: MIT
--
-- vision_fast: computes the FAST-9 score of the pixel in the centre of the window; the score is 0
-- if the pixel is not a corner.
--
-- Each of the 16 pixels on the circle of radius 3 is brighter (> centre + threshold), darker (<
-- centre - threshold) or neither. Nine consecutive brighter pixels, or nine consecutive darker
-- pixels, make a corner. The score of a corner is a sum over all brighter, or over all darker,
-- pixels; each pixel adds the amount by which its difference from the centre exceeds the threshold.
-- The score is valid three steps after the window.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity vision_fast is
  port (
    clk_i       : in  std_logic;
    step_i      : in  std_logic;
    threshold_i : in  unsigned(7 downto 0);
    -- window in the format of vision_window's output
    window_i    : in  std_logic_vector(391 downto 0);
    score_o     : out unsigned(11 downto 0)
  );
end entity;

architecture rtl of vision_fast is
  type coordinates_t is array (0 to 15) of integer range 0 to 6;
  -- Positions of the pixels on the circle, clockwise, starting above the centre.
  constant CIRCLE_X : coordinates_t := (3, 4, 5, 6, 6, 6, 5, 4, 3, 2, 1, 0, 0, 0, 1, 2);
  constant CIRCLE_Y : coordinates_t := (0, 0, 1, 2, 3, 4, 5, 6, 6, 6, 5, 4, 3, 2, 1, 0);

  type excess_t is array (0 to 15) of unsigned(7 downto 0);
  type quarter_t is array (0 to 3) of unsigned(9 downto 0);

  signal brighter, darker : std_logic_vector(15 downto 0);
  signal excess           : excess_t;
  signal is_bright, is_dark : std_logic;
  signal bright, dark     : quarter_t;

  function pixel(window : std_logic_vector; x, y : integer) return unsigned is
  begin
    return unsigned(window(56 * y + 8 * x + 7 downto 56 * y + 8 * x));
  end function;

  function nine_in_a_row(ring : std_logic_vector(15 downto 0)) return std_logic is
    variable twice : std_logic_vector(31 downto 0);
    variable found : std_logic;
    variable all_set : std_logic;
  begin
    twice := ring & ring;
    found := '0';
    for first in 0 to 15 loop
      all_set := '1';
      for i in 0 to 8 loop
        all_set := all_set and twice(first + i);
      end loop;
      found := found or all_set;
    end loop;
    return found;
  end function;
begin
  compare : process (clk_i)
    variable centre, p, high, low, beyond : unsigned(9 downto 0);
  begin
    if rising_edge(clk_i) then
      if step_i = '1' then
        centre := resize(pixel(window_i, 3, 3), 10);
        high   := centre + threshold_i;
        for i in 0 to 15 loop
          p   := resize(pixel(window_i, CIRCLE_X(i), CIRCLE_Y(i)), 10);
          low := p + threshold_i;
          brighter(i) <= '0';
          darker(i)   <= '0';
          beyond := to_unsigned(0, 10);
          if p > high then
            brighter(i) <= '1';
            beyond := p - high;
          elsif low < centre then
            darker(i) <= '1';
            beyond := centre - low;
          end if;
          excess(i) <= beyond(7 downto 0);
        end loop;
      end if;
    end if;
  end process;

  add : process (clk_i)
    variable sum_bright, sum_dark : unsigned(9 downto 0);
  begin
    if rising_edge(clk_i) then
      if step_i = '1' then
        is_bright <= nine_in_a_row(brighter);
        is_dark   <= nine_in_a_row(darker);
        for quarter in 0 to 3 loop
          sum_bright := to_unsigned(0, 10);
          sum_dark   := to_unsigned(0, 10);
          for i in 4 * quarter to 4 * quarter + 3 loop
            if brighter(i) = '1' then
              sum_bright := sum_bright + excess(i);
            end if;
            if darker(i) = '1' then
              sum_dark := sum_dark + excess(i);
            end if;
          end loop;
          bright(quarter) <= sum_bright;
          dark(quarter)   <= sum_dark;
        end loop;
      end if;
    end if;
  end process;

  choose : process (clk_i)
  begin
    if rising_edge(clk_i) then
      if step_i = '1' then
        if is_bright = '1' then
          score_o <= resize(bright(0), 12) + bright(1) + bright(2) + bright(3);
        elsif is_dark = '1' then
          score_o <= resize(dark(0), 12) + dark(1) + dark(2) + dark(3);
        else
          score_o <= to_unsigned(0, 12);
        end if;
      end if;
    end if;
  end process;
end architecture;
