-- SPDX-License-Identifier: MIT
--
-- vision_window: stores the last seven lines of a pixel stream and outputs a window of 7 x 7 pixels
-- that moves with the stream.
--
-- One block RAM stores six pixels for each column. window_o is complete two steps after the newest
-- pixel of the window.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity vision_window is
  port (
    clk_i    : in  std_logic;
    -- a pixel arrives, and all registers advance by one step
    step_i   : in  std_logic;
    x_i      : in  unsigned(9 downto 0);         -- its column
    pixel_i  : in  std_logic_vector(7 downto 0);
    -- pixel (row, column) is at bits 8 * (7 * row + column) + 7 downto 8 * (7 * row + column); row
    -- 0 is the oldest line, column 0 the oldest column
    window_o : out std_logic_vector(391 downto 0)
  );
end entity;

architecture rtl of vision_window is
  type ram_t is array (0 to 1023) of std_logic_vector(47 downto 0);
  signal ram    : ram_t;
  -- the six older pixels of the column; the newest of them is in the lowest bits
  signal above  : std_logic_vector(47 downto 0);
  signal pixel  : std_logic_vector(7 downto 0);
  signal x      : unsigned(9 downto 0);
  signal window : std_logic_vector(391 downto 0);
begin
  window_o <= window;

  lines : process (clk_i)
  begin
    if rising_edge(clk_i) then
      if step_i = '1' then
        above <= ram(to_integer(x_i));
        pixel <= pixel_i;
        x     <= x_i;
        ram(to_integer(x)) <= above(39 downto 0) & pixel;
      end if;
    end if;
  end process;

  move : process (clk_i)
    variable column : std_logic_vector(55 downto 0);
  begin
    if rising_edge(clk_i) then
      if step_i = '1' then
        column := above & pixel; -- the oldest line is in the highest bits
        for row in 0 to 6 loop
          window(56 * row + 47 downto 56 * row) <= window(56 * row + 55 downto 56 * row + 8);
          window(56 * row + 55 downto 56 * row + 48) <= column(55 - 8 * row downto 48 - 8 * row);
        end loop;
      end if;
    end if;
  end process;
end architecture;
