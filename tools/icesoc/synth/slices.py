# SPDX-License-Identifier: MIT
"""slices: estimates the number of slices for a netlist; a slice has four LUT6 and eight flip-flops
(docs/utilisation.md).

Rules of Spartan-6 and 7-series slices (UG384, UG474): clock, enable and set/reset are common to
a slice. A LUT6 can hold two functions of at most five common inputs. A carry chain takes one slice
for every four bits, including the LUTs in front of it. A LUT RAM needs a SLICEM.
"""
import typing

from icesoc.synth import netlist
from icesoc.synth.netlist import LUT_INPUTS, MEMORY_LUTS, UNDEFINED

SITES, FLIP_FLOPS, MUXES, SHARED_INPUTS = 4, 8, 2, 5

# Fraction of flip-flops that do not share a site with a LUT. map needs (sites + fraction *
# flip-flops) / 4 slices. The value is fitted to published reports (published.py).
USUAL_SHARE = 0.74
# Fraction of functions that need no separate site, because two functions share one. In the reports
# it is 2 to 31 %, and 14 % on average. A lower value is used, because map needs more sites than
# estimated (published.py).
USUAL_PAIRING = 0.11


class Range(typing.NamedTuple):
    """Ratios of published to estimated figures: the median, and the range that contains nine of
    ten. `count` is the number of designs; the estimate for each design is fitted to the other
    designs."""
    median: float
    low: float
    high: float
    count: int  # type: ignore[assignment]  # tuple.count is not used

    def of(self, value):
        return f"{value * self.low:.0f}-{value * self.high:.0f}"


MAPPED = Range(median=1.02, low=0.73, high=1.40, count=58)
# The same ratios for LUT sites, from reports whose sources Yosys can read.
SITES_OF_MAP = Range(median=1.11, low=0.92, high=1.57, count=14)


def occupied(sites, flip_flops, share):
    return (sites + share * flip_flops) / SITES


def map_sites(luts, memory, through):
    """Returns the number of LUT sites as map counts them. Some sites contain two functions, and
    route-throughs also take sites. `memory`: number of LUTs that are RAM or shift registers."""
    return memory + (1 - USUAL_PAIRING) * (luts - memory + through)


def sites_for(luts):
    """Returns the number of LUT6 sites for LUTs with these sets of inputs. Two LUTs share a site if
    together they have at most five inputs. The method is greedy: each LUT takes the partner with
    most inputs in common. LUTs without common inputs do not share a site, as in map."""
    readers = {}
    for i, inputs in enumerate(luts):
        if len(inputs) <= SHARED_INPUTS:
            for bit in inputs:
                readers.setdefault(bit, []).append(i)
    placed, sites = set(), 0
    for i, inputs in enumerate(luts):
        if i in placed:
            continue
        placed.add(i)
        sites += 1
        if len(inputs) > SHARED_INPUTS:
            continue
        common = {}
        for bit in inputs:
            # a signal with many loads, such as a reset, is no reason to share a site
            if len(readers[bit]) <= 64:
                for k in readers[bit]:
                    if k not in placed:
                        common[k] = common.get(k, 0) + 1
        partners = [(-count, k) for k, count in common.items()
                    if count > 1 and len(inputs) + len(luts[k]) - count <= SHARED_INPUTS]
        if partners:
            placed.add(min(partners)[1])
    return sites


def through_sites(n, carry):
    """Returns the number of carry bits whose input S is not driven by a separate LUT. Each of these
    takes a site as a route-through."""
    return sum(bit >= 0 and n.driver_type(bit) not in LUT_INPUTS for bit in carry.bits("S"))


def control_set(cell):
    """Returns the control set of a flip-flop: clock, enable, and set or reset."""
    resets = (cell.bit(port) for port in ("R", "S", "CLR", "PRE"))
    return (cell.bit("C"), cell.bit("CE"), next((b for b in resets if b != UNDEFINED), UNDEFINED))


def slices_of(n):
    """Returns the estimate ("slices"), a minimum for any placer ("low"), an upper bound that one of
    twenty published designs exceeds ("high"), and the counts from which they are computed."""
    luts, sets = [], {}  # sets: control set -> [flip-flops fed by a separate LUT, others]
    memory = carry = through = wide = flip_flops = 0
    for cell in n.cells:
        if cell.type in LUT_INPUTS:
            luts.append({bit for pin in cell.pins if not pin.output
                         for bit in pin.bits if bit >= 0})
        elif netlist.is_memory(cell.type):
            memory += MEMORY_LUTS.get(cell.type, 1)
        elif cell.type == "MUXF7":
            wide += 1
        elif cell.type == "CARRY4":
            carry += 1
            through += through_sites(n, cell)
        elif netlist.is_register(cell.type):
            flip_flops += 1
            d = cell.bit("D")
            fed = n.driver_type(d) in LUT_INPUTS and n.fanout(d) == 1
            sets.setdefault(control_set(cell), [0, 0])[not fed] += 1

    def up(number, unit):
        return -(-number // unit)

    sites = sites_for(luts) + memory + through
    slicem = up(memory, SITES)
    usual = max(sites, (1 - USUAL_PAIRING) * len(luts) + memory + through)
    low = max(up(sites, SITES), slicem + carry + up(wide, MUXES),
              sum(max(up(fed, SITES), up(fed + rest, FLIP_FLOPS)) for fed, rest in sets.values()))
    estimate = occupied(usual, flip_flops, USUAL_SHARE)
    likely, high = (max(low, int(n + 0.5)) for n in (estimate, estimate * MAPPED.high))
    return {"low": low, "slices": likely, "high": high,
            "slicem": slicem, "sites": sites, "through": through, "sets": len(sets)}
