#!/bin/sh
# SPDX-License-Identifier: MIT
# cost: cost.py work-folder   A core's share of the chip, of figures that can be added up by hand.
set -eu
cost=$1 work=$2
mkdir -p "$work"
cat >"$work/baseline.json" <<'END'
{"designs": {"soc": {"lut": 1700, "ff": 1600, "ram": 14.5, "signals": {
  "u_bus_decoder": {"rdata": [40, 0], "selected": [0, 4]},
  "u_low": {"a": [10, 1], "b": [5, 2]}, "u_low.u_wrapper": {"c": [3, 30]}, "u_low.u_wrapper.u_registers": {"d": [1, 2]},
  "u_low.u_filter": {"e": [7, 8]}, "u_lower": {"f": [1000, 1000]},
  "u_plain.u_core": {"g": [9, 9]}, "u_plain.u_bus.u_window": {"h": [4, 5]},
  "u_memory.u_arbiter": {"i": [20, 6]}, "u_memory.u_backend": {"j": [10, 0]},
  "u_memory.u_arbiter.g_port[1].u_write": {"k": [5, 6]}, "u_memory.u_arbiter.g_port[10].u_write": {"l": [500, 500]}}}}}
END
cat >"$work/map.json" <<'END'
{"constants": [{"name": "SLOT_COUNT", "value": 4}, {"name": "NPI_PORT_COUNT", "value": 3}, {"name": "SLOT_LOW", "value": 2},
  {"name": "NPI_PORT_LOW", "value": 1}, {"name": "SLOT_PLAIN", "value": 3}]}
END
cd "$work"
"$cost" baseline.json map.json low plain other >out
cat >"$work/wanted" <<'END'
low in the chip, by baseline.json:
  the core                       22 LUT     11 FF
  its registers                   4 LUT     32 FF
  decoder, one of 4 slots        10 LUT      1 FF
  memory port 1                   5 LUT      6 FF
  arbiter, one of 3 ports        10 LUT      2 FF
  together                       51 LUT     52 FF
plain in the chip, by baseline.json:
  the core                        9 LUT      9 FF
  its registers                   4 LUT      5 FF
  decoder, one of 4 slots        10 LUT      1 FF
  together                       23 LUT     15 FF
other in the chip: not in baseline.json: a line in ip/cores.list, then make ip-synth IP=other CHIP=1
the chip: 1700 LUT, 1600 FF, 14.5 block RAMs
END
diff "$work/wanted" "$work/out"
