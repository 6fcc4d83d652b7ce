-- SPDX-License-Identifier: MIT
--
-- lamps_types: defines the record of the inputs of lamps.
library ieee;
use ieee.std_logic_1164.all;

package lamps_types is
  type request_t is record
    rd, wr : std_logic;
    a      : std_logic_vector(0 downto 0);
    d      : std_logic_vector(15 downto 0);
  end record;
end package;
