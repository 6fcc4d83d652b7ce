-- SPDX-License-Identifier: MIT
--
-- biquad_tb: the filter as VHDL against the model's results (vectors.txt), with gaps between samples,
-- and the clocks that each sample takes.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
use std.textio.all;

entity biquad_tb is
end entity;

architecture test of biquad_tb is
  constant RESETS : integer := 2;
  constant CLEARS : integer := 1;
  signal clk : std_logic := '0';
  signal rst : std_logic := '1';
  signal done : boolean := false;
  signal write, clear, in_valid, in_ready, out_valid : std_logic := '0';
  signal index : std_logic_vector(4 downto 0) := "00000";
  signal coefficient : std_logic_vector(17 downto 0) := (others => '0');
  signal sample, result : std_logic_vector(15 downto 0) := (others => '0');
  signal saturations : std_logic_vector(2 downto 0);
begin
  clk <= not clk after 5 ns when not done;

  u_filter : entity work.biquad_filter
    port map (
      clk_i => clk, rst_i => rst,
      coefficient_write_i => write, coefficient_index_i => index, coefficient_i => coefficient, clear_i => clear,
      sample_valid_i => in_valid, sample_ready_o => in_ready, sample_i => sample,
      result_valid_o => out_valid, result_o => result, saturations_o => saturations
    );

  samples_and_checks : process
    variable l : line;
    variable n, how, sections, count, value, wanted, kept, clocks, most, total : integer := 0;
    variable used : std_logic_vector(3 downto 0) := "0000";
    variable random : natural := 1;
    file vectors : text open read_mode is "vectors.txt";

    procedure next_number(number : out integer) is
    begin
      readline(vectors, l);
      read(l, number);
    end procedure;
    procedure clock is
    begin
      wait until rising_edge(clk);
      wait for 1 ns;
    end procedure;
    procedure idle(least : natural) is
    begin
      random := (random * 75 + 74) mod 65537;
      for gap in 1 to least + random mod 4 loop
        assert out_valid = '0' report "a result that nobody asked for" severity failure;
        clock;
      end loop;
    end procedure;
  begin
    while not endfile(vectors) loop
      next_number(how);
      rst <= '1' when how = RESETS else '0';
      clear <= '1' when how = CLEARS else '0';
      clock;
      rst <= '0';
      clear <= '0';
      if how = RESETS then
        used := "0000";
      end if;
      next_number(sections);
      for s in 0 to 3 loop
        if to_unsigned(sections, 4)(s) = '1' then
          used(s) := '1';
          for k in 0 to 4 loop
            next_number(n);
            write <= '1';
            index <= std_logic_vector(to_unsigned(8 * s + k, 5));
            coefficient <= std_logic_vector(to_signed(n, 18));
            clock;
          end loop;
          write <= '0';
        end if;
      end loop;
      most := 1 + 1 + 4; -- taken, given, four sections; seven clocks more for each in use
      for s in 0 to 3 loop
        if used(s) = '1' then
          most := most + 7;
        end if;
      end loop;
      next_number(count);
      for i in 0 to count - 1 loop
        readline(vectors, l);
        read(l, value);
        read(l, wanted);
        read(l, kept);
        idle(0);
        sample <= std_logic_vector(to_signed(value, 16));
        in_valid <= '1';
        for guard in 0 to 20 loop -- sixteen clocks clear the values
          wait until falling_edge(clk); -- settled
          exit when in_ready = '1';
          assert guard < 20 report "no sample is taken" severity failure;
          clock;
        end loop;
        clock;
        in_valid <= '0';
        clocks := 1;
        while out_valid = '0' loop
          assert clocks < most report "no result after " & to_string(clocks) & " clocks" severity failure;
          assert in_ready = '0' report "a sample would be taken while one is under way" severity failure;
          clock;
          clocks := clocks + 1;
        end loop;
        assert clocks = most
          report to_string(clocks) & " clocks, " & to_string(most) & " were to come" severity failure;
        assert to_integer(signed(result)) = wanted
          report "sample " & to_string(total + i) & " became " & to_string(to_integer(signed(result))) &
                 ", the model says " & to_string(wanted) severity failure;
        assert to_integer(unsigned(saturations)) = kept
          report to_string(to_integer(unsigned(saturations))) & " sections kept their value, the model says " &
                 to_string(kept) severity failure;
        clock;
      end loop;
      idle(0);
      total := total + count;
    end loop;
    assert total > 400 report "too few vectors" severity failure;
    report "biquad: " & to_string(total) & " results equal the model's";
    done <= true;
    wait;
  end process;
end architecture;
