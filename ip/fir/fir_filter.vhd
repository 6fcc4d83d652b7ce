-- SPDX-License-Identifier: MIT
--
-- fir_filter: computes a FIR filter of 16 taps in transposed form, one sample per clock, with
-- coefficients set at run time.
--
-- Each tap consists of a multiplier of 18 x 16 bits and an adder, each with a register, and uses
-- one DSP48A1. result = (sum of coefficient(k) * sample(n - k)) / 2**shift, rounded to nearest,
-- halves up, saturated to 16 bits.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

entity fir_filter is
  port (
    clk_i               : in  std_logic;
    rst_i               : in  std_logic;
    -- settings; a coefficient applies to samples that arrive after the coefficient was written
    coefficient_write_i : in  std_logic;
    coefficient_index_i : in  std_logic_vector(3 downto 0);
    coefficient_i       : in  std_logic_vector(17 downto 0);
    shift_i             : in  std_logic_vector(4 downto 0);
    -- sets all earlier samples to 0; allowed only while the pipeline is empty
    clear_i             : in  std_logic;
    -- samples
    sample_valid_i      : in  std_logic;
    sample_ready_o      : out std_logic;
    sample_i            : in  std_logic_vector(15 downto 0);
    -- results, one for each sample
    result_valid_o      : out std_logic;
    result_ready_i      : in  std_logic;
    result_o            : out std_logic_vector(15 downto 0);
    saturated_o         : out std_logic  -- high if this result was saturated
  );
end entity;

architecture rtl of fir_filter is
  constant TAPS     : positive := 16;
  constant SUM_BITS : positive := 18 + 16 + 4; -- sum of 16 products of 34 bits
  type coefficients_t is array (0 to TAPS - 1) of signed(17 downto 0);
  type products_t is array (0 to TAPS - 1) of signed(33 downto 0);
  type sums_t is array (0 to TAPS) of signed(SUM_BITS - 1 downto 0);

  signal coefficients : coefficients_t;
  signal products     : products_t;
  signal sums         : sums_t; -- sums(0) is the sum for the next result; sums(TAPS) is always 0
  -- the sum, shifted by a multiple of 8, with one additional bit for rounding
  signal coarse       : signed(SUM_BITS downto 0);
  signal scaled       : signed(SUM_BITS downto 0); -- shifted
  signal result       : signed(15 downto 0);
  signal saturated    : std_logic;
  -- one bit per pipeline stage that contains a value: products, sums, coarse, scaled, result
  signal full         : std_logic_vector(1 to 5);
  signal step         : std_logic;
begin
  step           <= result_ready_i or not full(5);
  sample_ready_o <= step;
  result_valid_o <= full(5);
  result_o       <= std_logic_vector(result);
  saturated_o    <= saturated;
  sums(TAPS)     <= (others => '0');

  settings : process (clk_i)
  begin
    if rising_edge(clk_i) then
      if coefficient_write_i = '1' then
        coefficients(to_integer(unsigned(coefficient_index_i))) <= signed(coefficient_i);
      end if;
      if rst_i = '1' then
        coefficients <= (others => (others => '0'));
      end if;
    end if;
  end process;

  taps_of_the_filter : for k in 0 to TAPS - 1 generate
    tap : process (clk_i)
    begin
      if rising_edge(clk_i) then
        if step = '1' and sample_valid_i = '1' then
          products(k) <= coefficients(k) * signed(sample_i);
        end if;
        if step = '1' and full(1) = '1' then
          sums(k) <= sums(k + 1) + resize(products(k), SUM_BITS);
        end if;
        if rst_i = '1' or clear_i = '1' then
          sums(k) <= (others => '0');
        end if;
      end if;
    end process;
  end generate;

  scaling : process (clk_i)
    variable rounded  : signed(SUM_BITS downto 0);
    variable overflow : std_logic;
  begin
    if rising_edge(clk_i) then
      if step = '1' then
        full   <= sample_valid_i & full(1 to 4);
        coarse <= shift_right(sums(0) & '0', to_integer(unsigned(shift_i(4 downto 3)) & "000"));
        scaled <= shift_right(coarse, to_integer(unsigned(shift_i(2 downto 0))));
        rounded := shift_right(scaled, 1) + signed'("0" & scaled(0));
        -- The value fits into 16 bits if all its higher bits are equal to its sign bit. The code
        -- compares bits instead of integers, because GHDL 5 converts a comparison of more than 32
        -- bits with a negative integer incorrectly.
        overflow := '0';
        for b in 16 to SUM_BITS loop
          overflow := overflow or (rounded(b) xor rounded(15));
        end loop;
        saturated <= overflow;
        if overflow = '1' then
          result <= (15 => rounded(SUM_BITS), others => not rounded(SUM_BITS));
        else
          result <= rounded(15 downto 0);
        end if;
      end if;
      if rst_i = '1' then
        full <= (others => '0');
      end if;
    end if;
  end process;
end architecture;
