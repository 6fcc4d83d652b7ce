-- SPDX-License-Identifier: MIT
--
-- biquad_filter: four second-order sections in a row, coefficients at run time, one multiplier for all.
--
-- A section in use takes eight clocks a sample, another one a clock:
--   y(n) = b0 x(n) + b1 x(n-1) + b2 x(n-2) - a1 y(n-1) - a2 y(n-2), coefficients in units of 2**-16.
-- Between sections values have 24 bits, six of them behind the point; each is rounded to nearest, halves up.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity biquad_filter is
  port (
    clk_i               : in  std_logic;
    rst_i               : in  std_logic; -- no section is in use, earlier values become 0
    -- settings: index 8 * section + 0..4 for b0, b1, b2, a1, a2; a section is in use once its a2 is written
    coefficient_write_i : in  std_logic;
    coefficient_index_i : in  std_logic_vector(4 downto 0);
    coefficient_i       : in  std_logic_vector(17 downto 0);
    clear_i             : in  std_logic; -- earlier values become 0; only while no sample is under way
    -- samples
    sample_valid_i      : in  std_logic;
    sample_ready_o      : out std_logic;
    sample_i            : in  std_logic_vector(15 downto 0);
    -- results, one for each sample: high for one clock
    result_valid_o      : out std_logic;
    result_o            : out std_logic_vector(15 downto 0);
    saturations_o       : out std_logic_vector(2 downto 0) -- sections that kept their result to 24 bits
  );
end entity;

architecture rtl of biquad_filter is
  constant LAST_TAP : natural := 4; -- a2
  constant LAST_STEP : natural := 7; -- three more for operand, product and sum
  constant HALF     : signed(44 downto 0) := to_signed(32768, 45);

  type state_t is (CLEAR_VALUES, WAIT_FOR_SAMPLE, RUN_SECTION, GIVE_RESULT);
  type coefficients_t is array (0 to 31) of signed(17 downto 0);
  type values_t is array (0 to 15) of signed(23 downto 0); -- section & x1, x2, y1, y2
  signal state        : state_t;
  signal coefficients : coefficients_t;
  signal values       : values_t;
  signal used         : std_logic_vector(3 downto 0);
  signal section      : unsigned(1 downto 0);
  signal step         : unsigned(2 downto 0);
  signal cleared      : unsigned(3 downto 0);
  signal value        : signed(23 downto 0); -- that enters the section
  -- of the multiplier; from_value: x(n), which is not among the values
  signal operand      : signed(23 downto 0);
  signal coefficient  : signed(17 downto 0);
  signal product      : signed(41 downto 0);
  signal sum          : signed(44 downto 0);
  signal rounded, kept : signed(23 downto 0);
  signal overflow     : std_logic;
  signal saturations  : unsigned(2 downto 0);
  signal give         : signed(23 downto 0);
  -- the one write of a clock into `values`
  signal write        : std_logic;
  signal write_at, read_at : unsigned(3 downto 0);
  signal write_value  : signed(23 downto 0);
begin
  sample_ready_o <= '1' when state = WAIT_FOR_SAMPLE and clear_i = '0' else '0';
  saturations_o  <= std_logic_vector(saturations);

  -- Taps 1..4 read x1, x2, y1, y2.
  read_at <= section & (step(1 downto 0) - 1);

  -- The sum begins with a half, so that cutting off rounds; it fits if all bits above the sign are like it.
  rounded <= sum(39 downto 16);
  overflow <= '1' when sum(44 downto 39) /= "000000" and sum(44 downto 39) /= "111111" else '0';
  kept <= rounded when overflow = '0' else (23 => sum(44), 22 downto 0 => not sum(44));
  give <= value + 32;

  -- x2 becomes x1 and y2 becomes y1 as they are read, when the one before is the multiplier's operand.
  moves : process (all)
  begin
    write       <= '0';
    write_at    <= section & "00";
    write_value <= value;
    if state = CLEAR_VALUES then
      write       <= '1';
      write_at    <= cleared;
      write_value <= (others => '0');
    elsif state = RUN_SECTION then
      if step = 2 then
        write       <= '1';
        write_at    <= section & "01";
        write_value <= operand;
      elsif step = 3 then
        write       <= '1';
      elsif step = 4 then
        write       <= '1';
        write_at    <= section & "11";
        write_value <= operand;
      elsif step = LAST_STEP then
        write       <= '1';
        write_at    <= section & "10";
        write_value <= kept;
      end if;
      if used(to_integer(section)) = '0' then
        write <= '0';
      end if;
    end if;
  end process;

  memories : process (clk_i)
  begin
    if rising_edge(clk_i) then
      if coefficient_write_i = '1' then
        coefficients(to_integer(unsigned(coefficient_index_i))) <= signed(coefficient_i);
      end if;
      if write = '1' then
        values(to_integer(write_at)) <= write_value;
      end if;
    end if;
  end process;

  multiplier : process (clk_i)
  begin
    if rising_edge(clk_i) then
      coefficient <= coefficients(to_integer(section & step));
      operand     <= values(to_integer(read_at));
      if step = 0 then
        operand <= value;
      end if;
      product <= operand * coefficient;
      -- The product of tap k is there at step k + 2.
      if step < 2 then
        sum <= HALF;
      elsif step < 5 then
        sum <= sum + resize(product, 45);
      else
        sum <= sum - resize(product, 45);
      end if;
    end if;
  end process;

  control : process (clk_i)
  begin
    if rising_edge(clk_i) then
      result_valid_o <= '0';
      if coefficient_write_i = '1' and unsigned(coefficient_index_i(2 downto 0)) = LAST_TAP then
        used(to_integer(unsigned(coefficient_index_i(4 downto 3)))) <= '1';
      end if;
      case state is
        when CLEAR_VALUES =>
          cleared <= cleared + 1;
          if cleared = 15 then
            state <= WAIT_FOR_SAMPLE;
          end if;
        when WAIT_FOR_SAMPLE =>
          section     <= "00";
          step        <= "000";
          saturations <= "000";
          if clear_i = '1' then
            state <= CLEAR_VALUES;
          elsif sample_valid_i = '1' then
            value <= resize(signed(sample_i), 18) & "000000";
            state <= RUN_SECTION;
          end if;
        when RUN_SECTION =>
          step <= step + 1;
          if step = LAST_STEP and overflow = '1' then
            saturations <= saturations + 1;
          end if;
          if step = LAST_STEP then
            value <= kept;
          end if;
          if step = LAST_STEP or used(to_integer(section)) = '0' then
            step    <= "000";
            section <= section + 1;
            if section = 3 then
              state <= GIVE_RESULT;
            end if;
          end if;
        when GIVE_RESULT =>
          result_valid_o <= '1';
          result_o <= std_logic_vector(give(21 downto 6));
          if value(23 downto 21) /= "000" and value(23 downto 21) /= "111" then
            result_o <= (15 => value(23), 14 downto 0 => not value(23));
          elsif value(23) = '0' and give(21) = '1' then
            result_o <= x"7FFF"; -- rounded up beyond it
          end if;
          state <= WAIT_FOR_SAMPLE;
      end case;
      if rst_i = '1' then
        state   <= CLEAR_VALUES;
        cleared <= "0000";
        used    <= "0000";
        result_valid_o <= '0';
      end if;
    end if;
  end process;
end architecture;
