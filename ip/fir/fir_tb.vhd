-- SPDX-License-Identifier: MIT
--
-- fir_tb: compares the results of the VHDL filter with the results of the model (vectors.txt), with
-- gaps in the input and stalls of the output.

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
use std.textio.all;

entity fir_tb is
end entity;

architecture test of fir_tb is
  signal clk : std_logic := '0';
  signal rst : std_logic := '1';
  signal done : boolean := false;
  signal write, clear, in_valid, in_ready, out_valid, out_ready, saturated : std_logic := '0';
  signal index : std_logic_vector(3 downto 0) := "0000";
  signal coefficient : std_logic_vector(17 downto 0) := (others => '0');
  signal shift : std_logic_vector(4 downto 0) := "00000";
  signal sample, result : std_logic_vector(15 downto 0) := (others => '0');
begin
  clk <= not clk after 5 ns when not done;

  u_filter : entity work.fir_filter
    port map (
      clk_i => clk, rst_i => rst,
      coefficient_write_i => write, coefficient_index_i => index, coefficient_i => coefficient,
      shift_i => shift, clear_i => clear,
      sample_valid_i => in_valid, sample_ready_o => in_ready, sample_i => sample,
      result_valid_o => out_valid, result_ready_i => out_ready, result_o => result,
      saturated_o => saturated
    );

  samples_and_checks : process
    type list_t is array (0 to 255) of integer;
    variable samples, wanted : list_t;
    variable l : line;
    variable n, count, sent, got, total : integer := 0;
    variable random : natural := 1;
    file vectors : text open read_mode is "vectors.txt";

    procedure next_number(value : out integer) is
    begin
      readline(vectors, l);
      read(l, value);
    end procedure;
    procedure clock is
    begin
      wait until rising_edge(clk);
      wait for 1 ns;
    end procedure;
  begin
    clock;
    clock;
    rst <= '0';
    while not endfile(vectors) loop
      next_number(n);
      shift <= std_logic_vector(to_unsigned(n, 5));
      write <= '1';
      for k in 0 to 15 loop
        next_number(n);
        index <= std_logic_vector(to_unsigned(k, 4));
        coefficient <= std_logic_vector(to_signed(n, 18));
        clock;
      end loop;
      write <= '0';
      clear <= '1';
      clock;
      clear <= '0';
      next_number(count);
      for i in 0 to count - 1 loop
        readline(vectors, l);
        read(l, samples(i));
        read(l, wanted(i));
      end loop;
      sent := 0;
      got := 0;
      for guard in 0 to 5000 loop
        exit when got = count;
        random := (random * 75 + 74) mod 65537;
        in_valid <= '1' when sent < count and random mod 3 /= 0 else '0';
        sample <= std_logic_vector(to_signed(samples(sent mod 256), 16));
        out_ready <= '1' when random mod 5 /= 0 else '0';
        wait until falling_edge(clk); -- settled
        if out_valid = '1' and out_ready = '1' then
          assert to_integer(signed(result)) = wanted(got)
            report "result(" & to_string(got) & "): expected " & to_string(wanted(got)) & ", got " &
                   to_string(to_integer(signed(result))) severity failure;
          assert saturated = '0' or abs (2 * wanted(got) + 1) = 65535
            report "saturated inside the range" severity failure;
          got := got + 1;
        end if;
        if in_valid = '1' and in_ready = '1' then
          sent := sent + 1;
        end if;
        clock;
      end loop;
      assert got = count report "only " & to_string(got) & " results" severity failure;
      in_valid <= '0';
      total := total + count;
    end loop;
    assert total > 400 report "too few vectors" severity failure;
    report "fir: " & to_string(total) & " results equal the model's";
    done <= true;
    wait;
  end process;
end architecture;
