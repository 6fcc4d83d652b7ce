#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""parts_test: compares parts of the utilisation report with published reports of Xilinx's tools,
and with figures that can be calculated by hand."""
import copy, json, os, pathlib, statistics, tempfile, types, unittest, unittest.mock

from icesoc.synth import (baseline, batch, cores, equivalence, owners, published, report, slices,
                          sources, synthesis, timing)
from icesoc.util.errors import Stop
from icesoc.synth.netlist import Cell, Name, Netlist, Pin, Port, ZERO
from icesoc.synth.owners import Cost

YOSYS = "Yosys 0.23 (git sha1 7ce5011c24b)"


def cell(type, inputs, outputs, name=""):
    """Returns a cell. `inputs` and `outputs` are {port: bit}."""
    pins = [Pin(port, False, [bit]) for port, bit in inputs.items()]
    pins += [Pin(port, True, [bit]) for port, bit in outputs.items()]
    return Cell(name or type, type, pins, bool(name))


def lut(inputs, output):
    return cell(f"LUT{len(inputs)}", {f"I{i}": bit for i, bit in enumerate(inputs)}, {"O": output})


class Slices(unittest.TestCase):
    def test_eight_flip_flops_of_one_control_set_are_one_slice_and_of_two_are_two(self):
        flip_flops = [cell("FDRE", {"C": 2, "CE": 3, "R": ZERO, "D": 10 + i}, {"Q": 30 + i})
                      for i in range(8)]
        self.assertEqual(slices.slices_of(Netlist(flip_flops))["low"], 1)
        flip_flops[7] = cell("FDRE", {"C": 2, "CE": 4, "R": ZERO, "D": 17}, {"Q": 37})
        found = slices.slices_of(Netlist(flip_flops))
        self.assertEqual((found["low"], found["sets"]), (2, 2))

    def test_luts_of_five_common_inputs_share_a_site_and_those_of_six_do_not(self):
        for inputs, sites in (([2, 3, 4, 5], 1), ([2, 3, 4, 5, 6, 7], 2), ([2, 3, 4, 7], 2)):
            n = Netlist([lut([2, 3, 4, 5, 6], 20), lut(inputs, 21)])
            self.assertEqual(slices.slices_of(n)["sites"], sites, inputs)
        # Each LUT RAM occupies a separate slice, of the kind that can contain RAM.
        found = slices.slices_of(Netlist([cell("RAM32M", {}, {})] * 3))
        self.assertEqual((found["slicem"], found["low"]), (3, 3))


def chain(fanouts, end_pin, middle=None):
    """Returns a path of one-input LUTs between two flip-flops; the nets have these fan-outs."""
    n = Netlist([cell("FDRE", {"C": 2}, {"Q": 10})])
    for bit, fanout in enumerate(fanouts, 10):
        n.readers.setdefault(bit, []).extend([0] * (fanout - 1))  # other readers
        if bit - 9 < len(fanouts):
            n.add(middle or lut([bit], bit + 1))
    n.add(cell("FDRE", {"C": 2, end_pin: 9 + len(fanouts)}, {"Q": 100}))
    n.names = {10: [Name("from")], 100: [Name("to")]}
    return n


def longest(n):
    return timing.timing_of(n, [""] * len(n.cells))[0]["paths"][0]


class Timing(unittest.TestCase):
    """Tests of the longest paths, and of the figures that are reported for a design that was mapped
    several times, each time with its ports in another sequence."""

    def test_a_path_is_the_sum_of_its_cells_and_nets(self):
        p = longest(chain([4, 1, 88, 26, 2, 5, 16], "CE"))
        self.assertAlmostEqual(p["ns"], 0.447 + 6 * 0.205 + 0.322 + 0.682 + 0.580 + 1.799 + 1.207
                               + 0.617 + 0.715 + 1.004, delta=0.002)
        self.assertEqual((p["levels"], p["from"], p["to"], p["pin"]), (6, "from", "to", "CE"))
        p = longest(chain([7, 2, 1], "D"))  # the last LUT drives the flip-flop next to it
        self.assertEqual((p["levels"], p["steps"][-1][4]), (2, 0))

    def test_each_register_is_counted_once_by_its_longest_path(self):
        t = timing.timing_of(chain([4, 1, 88, 26, 2, 5, 16], "CE"), [""] * 8)[0]
        bins = int(2 * timing.SLOW_GRADE * t["paths"][0]["ns"])
        self.assertEqual(t["ends"], [0] * bins + [1])  # no path ends at the first register

    def test_through_a_memory_only_the_address_of_that_output_leads(self):
        # ADDRD belongs to the write port, so a path ends there, and another path begins at the
        # memory.
        for address, levels in (("ADDRA", 1), ("ADDRD", 0), ("ADDRB", 0)):
            p = longest(chain([1, 1], "D", cell("RAM32M", {address: 10}, {"DOA": 11})))
            self.assertEqual(p["levels"], levels, address)
            self.assertEqual(p["from"] == "from", levels == 1, address)

    def test_a_multiplier_without_registers_is_logic(self):
        for pins, levels, ns in ({"B": 10}, 1, 0.447 + 0.58 + 4.56 + 0.58 + 0.102), \
                                ({"C": 10}, 1, 0.447 + 0.58 + 2.687 + 0.58 + 0.102), \
                                ({"B": 10, "CLK": 2}, 0, 4.7 + 0.58 + 0.102):
            p = longest(chain([1, 1], "D", cell("DSP48A1", pins, {"P": 11})))
            self.assertEqual(p["levels"], levels)
            self.assertAlmostEqual(p["ns"], ns)

    def test_paths_of_pads_contain_their_buffers(self):
        # Two pads drive a LUT. The LUT drives a third pad and a flip-flop, and the flip-flop drives
        # a fourth pad. For such a design, XST reports 5.645 ns from pad to pad with a fan-out of 8,
        # and 3.597 ns from register to pad.
        n = Netlist([lut([10, 11], 12), cell("FDRE", {"C": 2, "D": 12}, {"Q": 13}),
                             *(lut([10], 20 + i) for i in range(7))])
        n.ports = [Port("a", True, False, [10]), Port("clk", True, False, [2]),
                   Port("mcb_x", True, False, [11]),
                   Port("y", False, True, [12]), Port("z", False, True, [13])]
        found = {(p["kind"], p["port"]): p for p in timing.pads_of(n, [""] * len(n.cells))}
        self.assertEqual(set(found), {("pad to pad", "y"), ("pad to register", "a"),
                                      ("register to pad", "z")})
        self.assertAlmostEqual(found["pad to pad", "y"]["ns"], 5.645, delta=0.3)
        self.assertAlmostEqual(found["register to pad", "z"]["ns"], 3.597, delta=0.01)
        self.assertEqual(timing.slowest_pad(found.values(), "z"), 0)
        self.assertEqual(timing.delay_range(10), "6.4-10.9")
        row = types.SimpleNamespace(figures={"timing": {"pads": list(found.values())}, "lut": 1},
                                    design=sources.Design("d", "d", pads={"y": 6, "z": 1}))
        self.assertEqual(baseline.above_limits(row), [
            "d: 6.49 ns from a pad to y; the limit is 6 ns (-2)"])

    def test_a_loop_of_logic_ends_the_search_and_more_fan_out_is_never_faster(self):
        # A LUT that reads its own output.
        self.assertEqual(longest(chain([1, 1], "D", lut([10, 11], 11)))["levels"], 1)
        delays = [timing.net_delay(fanout) for fanout in range(1, 152)]
        self.assertEqual(delays, sorted(delays))

    def test_time_is_that_of_the_order_that_sets_the_clock(self):
        def order(lut, mhz):
            pad = {"kind": timing.PAD_TO_PAD, "port": "y", "ns": mhz / 10}
            return {"lut": lut, "mhz": mhz, "timing": {"paths": [mhz], "pads": [pad]}, "nets": mhz,
                    "places": {"at": mhz}, "sites": 2 * lut}
        f = synthesis.together([order(10, 102), order(12, 109), order(11, 108), order(13, 104),
                                order(14, 105)])
        self.assertEqual((f["lut"], f["mhz"], f["nets"]), (12, 105, 105))
        self.assertEqual((f["timing"]["paths"], f["timing"]["slowest"]), ([105], [102]))
        self.assertEqual((timing.slowest_pad(f["timing"]["pads"], "y"), f["sites"]), (10.9, 24))
        self.assertEqual(f["luts"], [10, 11, 12, 13, 14])
        self.assertEqual(f["clocks"], [102, 104, 105, 108, 109])
        self.assertEqual(report.clock_of(f), "105.0 (102.0-109.0)")
        # clock_text() rounds to 0.1 MHz, as the page does.
        self.assertEqual([baseline.clock_text(mhz) for mhz in (104.46, 104.44, 104.0)],
                         ["104.5", "104.4", "104.0"])

    def test_what_is_left_is_told_by_luts_and_by_what_has_ended(self):
        work = tempfile.TemporaryDirectory()
        self.addCleanup(work.cleanup)
        folder = pathlib.Path(work.name)

        def run(name, begun=0, spent=None, orders=0):
            return synthesis.Run(sources.Design(name, name, orders=orders), "xc6s", begun=begun,
                                 spent=spent, netlist=folder / name)
        options = synthesis.Options(None, None, jobs=2,
                                    luts={"chip": 5800, "large": 2000, "small": 200})
        chip, large, small = run("chip", orders=4), run("large"), run("small")

        def shows(text, load=0):
            with unittest.mock.patch("os.getloadavg", lambda: (load * os.cpu_count(), 0, 0)):
                self.assertEqual(batch.time_left([chip, large, small], options, 30), text)
        # two processes share 146 s, 11 s and 2 s of work
        shows("0 of 3 designs, about 1:20 left: ")
        shows("0 of 3 designs, about 3:58 left: ", load=3)
        chip.begun = 10
        shows("0 of 3 designs, about 2:06 left: chip")
        large.begun, large.spent = 1, 22  # this design took twice as long as expected
        shows("1 of 3 designs, about 4:32 left: chip")
        for suffix in ".part", ".1":  # two of five mappings are done
            (folder / f"chip{suffix}").touch()
        shows("1 of 3 designs, about 0:30 left: chip")
        # the result of `small` comes from the cache
        chip.begun, chip.spent, small.begun, small.spent = 1, 290, 1, 0
        shows("3 of 3 designs, about 0:00 left: ")


class Reports(unittest.TestCase):
    """Tests of the published reports, and of the statements about them."""
    TREE = pathlib.Path(__file__).resolve().parents[2]

    def setUp(self):
        self.reports = published.read(self.TREE)
        self.designs = [r for r in self.reports if "netlist" in r]

    def stated(self):
        """Raises an exception if a stated figure is not in the reports."""
        maps = [r["map"] for r in self.reports]
        for said, found in ((timing.ROUTED, published.range_of(self.ratios("routed"))),
                            (slices.SITES_OF_MAP, published.range_of(self.sites())),
                            (slices.MAPPED, published.slices_range(maps))):
            self.assertEqual(said.count, found.count)
            for figure, recomputed in zip(said, found):
                self.assertAlmostEqual(figure, recomputed, delta=0.006)
        self.assertEqual(slices.USUAL_SHARE, published.best_share(maps))
        self.assertLess(slices.USUAL_PAIRING, statistics.mean(map(published.paired, maps)))

    def sites(self):
        return published.site_ratios(self.reports)

    def ratios(self, kind):
        return published.clock_ratios(self.reports, kind)

    def test_the_errors_that_are_stated_are_those_of_the_reports(self):
        self.stated()
        for key, ns in ("routed", 99.0), ("synthesised", 99.0):  # adds an entry with wrong figures
            broken = next(r for r in self.designs if key in r)
            kept, broken[key] = broken[key], ns
            before = published.range_of(self.ratios(key))
            broken[key] = kept
            self.assertLess(before.low, 0.9 * published.range_of(self.ratios(key)).low)
        self.designs[0]["routed"] = 99.0
        self.assertRaises(AssertionError, self.stated)

    def test_each_is_predicted_by_the_others(self):
        self.assertEqual(published.left_out([1, 2, 4], statistics.median),
                         [1 / 3, 2 / 2.5, 4 / 1.5])
        found = published.range_of([1.0] * 19 + [2.0])
        self.assertEqual((found.median, found.low, found.count), (1, 1, 20))
        self.assertEqual(timing.ROUTED._replace(low=0.9, high=1.25).of(100), "90-125")

    def test_paths_have_the_delays_of_now_and_designs_are_those_of_their_reports(self):
        self.assertGreaterEqual(len(self.designs), 10)
        for r in self.designs:
            n = r["netlist"]
            (first, *_, delay, _), *rest = n["path"]
            self.assertEqual(delay, timing.start_delay(first), r["design"])
            self.assertTrue(all(ns == timing.LUT for type, _, ns, _ in rest
                                if type.startswith("LUT")), r["design"])
            for type, fanout, _, ns in n["path"]:
                self.assertIn(ns, (0, round(timing.net_delay(fanout), 3)), r["design"])
            self.assertAlmostEqual(n["ff"] / r["map"]["ff"], 1, delta=0.1, msg=r["design"])
            self.assertTrue(0.5 < (n["lut"] + n["through"]) / r["map"]["sites"] < 2, r["design"])

    def test_a_report_that_cannot_be_read_is_refused(self):
        whole = sources.read_designs(self.TREE)
        for change, why in (
                (lambda r: r.pop("device"), "no device"),
                (lambda r: r["map"].pop("slices"), "map has no slices"),
                (lambda r: r["netlist"].pop("end"), "netlist has no end"),
                (lambda r: r.update(routed="4.9"), "clock: expected a time in ns"),
                (lambda r: [r.pop(key) for key in ("routed", "synthesised")], "published clock"),
                (lambda r: r.pop("netlist"), "clock without one"),
                (lambda r: r.pop("map"), "no map")):
            broken = copy.deepcopy(whole)
            change(broken["reports"][0])
            with tempfile.TemporaryDirectory() as folder:
                file = pathlib.Path(folder, sources.DESIGNS)
                file.parent.mkdir()
                file.write_text(json.dumps(broken))
                with self.assertRaisesRegex(Stop, f"report 1 cannot be read: .*{why}"):
                    published.read(folder)
                file.write_text("{}")
                self.assertRaisesRegex(Stop, "expected a list of reports", published.read, folder)


class Baseline(unittest.TestCase):
    """Tests of the limits for growth, of accepted names, and of the contents of the committed
    file."""

    def setUp(self):
        self.design = sources.Design("block", "block")
        self.row = report.Row(self.design, synthesis.Run(self.design, "xc6s"))
        self.row.main.figures = {
            "lut": 100, "ff": 50, "slices": 30, "carry": 0, "dsp": 2, "ram": 1.5, "mhz": 0,
            "costs": {"u_part": {"state": Cost(60, 0, 30, 0, 1.5, 2)},
                      "": {"count": Cost(40, 0, 20)}}}
        self.accept()

    def accept(self):
        self.accepted = baseline.accepted_from(self.row.figures, "abc")
        self.baseline = {"yosys": YOSYS, "designs": {"block": self.accepted}}

    def grow(self, luts, flip_flops):
        f = self.row.figures
        part = {"state": f["costs"]["u_part"]["state"] + Cost(lut=luts, ff=flip_flops)}
        self.row.main.figures = f | {"lut": f["lut"] + luts, "ff": f["ff"] + flip_flops,
                                     "costs": f["costs"] | {"u_part": part}}

    def slow(self, mhz):
        path = {"from": "u_a.from", "to": "u_b.to", "pin": "D", "levels": 7}
        self.row.main.figures |= {"mhz": mhz, "timing": {"paths": [path]}}

    def judged(self, yosys=YOSYS):
        return baseline.judge(self.row, self.baseline, yosys, 100)

    def fails(self, *texts):
        (failure,), notes = self.judged()
        for text in texts:
            self.assertIn(text, failure)
        return failure

    def passes(self):
        self.assertEqual(self.judged(), ([], []))

    def test_growth_within_the_budget_passes_and_so_does_shrinking(self):
        # allowed growth: 3 % and 4 LUTs; 1 % and 2 flip-flops
        for luts, flip_flops in (7, 2), (-57, -27):
            self.grow(luts, flip_flops)
            self.passes()

    def test_growth_beyond_the_budget_names_the_module_and_the_signal_of_flip_flops_too(self):
        self.grow(8, 0)
        failure = self.fails("108 LUT, 50 FF; accepted were 100 and 50",
                             "modules that grew:\n      u_part +8 LUT",
                             "signals that grew:\n      u_part.state +8 LUT")
        self.assertNotIn("count", failure)
        self.grow(-8, 3)
        self.fails("100 LUT, 53 FF")

    def test_a_limit_holds_whatever_was_accepted(self):
        self.design.limits = {"lut": 102}
        self.grow(3, 0)  # within the allowed growth
        self.fails("103 lut, 1 above the limit of 102")
        self.accept()
        self.fails("103 lut, 1 above the limit of 102")

    def test_figures_of_another_yosys_are_not_judged_but_its_limits_are_noted(self):
        self.grow(80, 30)
        self.assertEqual(self.judged("Yosys 0.52"), ([], []))
        self.design.limits = {"lut": 179}
        failures, (note,) = self.judged("Yosys 0.52")
        self.assertEqual(failures, [])
        self.assertIn("1 above the limit of 179 (by another Yosys", note)

    def test_a_clock_that_was_reached_must_be_reached_another_may_lose_a_tenth(self):
        for accepted, enough, slow, *said in (
                (104.2, 104.2, 99.6, "99.6 MHz; accepted were 104.2, the least is 100",
                 "u_a.from to u_b.to D, 7 levels"), (83, 76, 74, "74.0 MHz")):
            self.slow(accepted)
            self.accept()
            self.slow(enough)
            self.passes()
            self.slow(slow)
            self.fails(*said)

    def test_a_failed_synthesis_is_a_failure_also_for_another_chip(self):
        self.row.others = [synthesis.Run(self.design, "xc7", error="no such thing")]
        self.fails("block: synthesis for xc7 failed")
        self.row.main.error = "syntax error"
        self.fails("block: synthesis failed")

    def test_what_is_written_is_read_again(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "baseline.json"
            file.write_text(baseline.written(self.baseline))
            again = baseline.read_baseline(file)
            self.assertEqual(again, self.baseline)
            self.assertEqual(baseline.written(again), baseline.written(self.baseline))
            for text in ('{"designs": 3}', "not json"):
                file.write_text(text)
                self.assertRaises(Stop, baseline.read_baseline, file)
            file.unlink()
            self.assertEqual(baseline.read_baseline(file)["designs"], {})

    def test_a_design_is_in_one_of_four_states(self):
        run = self.row.main
        self.assertEqual(baseline.state_of(run, "abc", None), "measured now")
        run.wanted, run.figures = False, None
        older = self.accepted | {"sources": ""}  # a file that was written before this key existed
        for hash, accepted, state in (
                ("abc", self.accepted, "as accepted"), ("other", self.accepted, "changed since"),
                ("abc", None, "never measured here"), ("abc", older, "never measured here")):
            self.assertEqual(baseline.state_of(run, hash, accepted), state)
        run.known = True
        self.assertEqual(baseline.state_of(run, "abc", None), "changed since")

    def test_a_difference_invents_no_savings(self):
        def entries(states, **luts):
            return {"states": states, "entries": [{"name": f"{name} lut", "value": value}
                                                  for name, value in luts.items()]}
        before = entries({"a": "measured now"}, a=10, b=20, c=30)
        after = entries({"a": "measured now", "b": "changed since"}, a=12)
        for line in "| a | 10 -> 12 (+2) |", "| b | changed since |", "| c | gone |":
            self.assertIn(line, report.differences(before, after))
        for line in "| b | 20 (changed since) |", "| c | 30 (new) |":
            self.assertIn(line, report.differences(after, before))


class Cores(unittest.TestCase):
    MAP = {"SLOT_SYSTEM": 0, "SLOT_MODEM": 1, "SLOT_LOW": 2, "SLOT_PLAIN": 3, "SLOT_OWN": 4,
           "SLOT_GONE": 5, "SLOT_COUNT": 6, "NPI_PORT_COUNT": 3, "NPI_PORT_LOW": 1}
    COSTS = {path: {"signal": Cost(lut=lut, ff=ff, ram=sum(more[:1]), dsp=sum(more[1:]))}
             for path, lut, ff, *more in (
                 ("u_modem", 900, 900), ("u_platform.u_bus_decoder", 400, 4), ("u_low", 15, 3),
                 ("u_low.u_wrapper", 3, 30), ("u_low.u_wrapper.u_registers", 1, 2),
                 ("u_low.u_filter", 7, 8, 1.5, 4), ("u_lower", 1000, 1000), ("u_plain", 9, 9),
                 ("u_plain.u_bus.u_window", 4, 5), ("u_own.u_crossing", 20, 60),
                 ("u_own.u_core.u_bus", 6, 7), ("u_own.u_core.u_core", 1, 1),
                 ("u_platform.u_memory.u_arbiter", 20, 6), ("u_platform.u_memory.u_backend", 10, 0),
                 ("u_platform.u_memory.u_arbiter.g_port[1].u_write", 5, 6, 2),
                 ("u_platform.u_memory.u_arbiter.g_port[10].u_write", 500, 500))}

    def rows(self, *names):
        return cores.core_table(self.COSTS, self.MAP, Cost(lut=12, ff=5), names, "here").rows

    def test_a_share_has_each_part_once_and_the_largest_core_is_first(self):
        self.assertEqual(self.rows(), [
            ["core in the chip", "LUT", "FF", "RAM16", "DSP", "itself", "registers", "slot 6",
             "memory port", "arbiter"],
            ["low", "53", "56", "3.5", "4", "22 / 11", "4 / 32", "12 / 5", "5 / 6", "10 / 2"],
            ["own", "39", "73", "0", "0", "1 / 1", "26 / 67", "12 / 5", "", ""],
            ["plain", "25", "19", "0", "0", "9 / 9", "4 / 5", "12 / 5", "", ""]])

    def test_only_those_asked_for_are_told(self):
        self.assertEqual(len(self.rows("plain")), 2)
        # ip/cores.list contains "gone", but this chip has not been measured yet
        for name, advice in ("gone", "./icesoc core synth gone --chip"), ("none", "add the"):
            with self.assertRaisesRegex(cores.NotInChip,
                                        f"{name} is not in the chip of here: {advice}"):
                self.rows("plain", name)

    def test_logic_that_reads_one_slot_is_its_blocks(self):
        """Two LUTs each read a register of one block; a third LUT reads both registers, and is
        therefore part of the decoder's multiplexer."""
        names = "u_a.count", "u_b.u_part.state", "u_platform.u_bus_decoder.index"
        n = Netlist([*(cell("FDRE", {}, {"Q": bit}, name) for bit, name in enumerate(names, 2)),
                     lut([2, 4], 5), lut([3, 4], 6), lut([2, 3, 4], 7), lut([5], 8),
                     lut([6, 7, 8], 9)])
        n.names[9] = [Name("u_platform.u_bus_decoder.bus_rdata_o", 0)]
        self.assertEqual(owners.owners_of(n, lambda path: set()), [
            "u_a.count", "u_b.u_part.state", "u_platform.u_bus_decoder.index", "u_a.bus_rdata_o",
            "u_b.bus_rdata_o", "u_platform.u_bus_decoder.bus_rdata_o", "u_a.bus_rdata_o",
            "u_platform.u_bus_decoder.bus_rdata_o"])


class Simulated(unittest.TestCase):
    """Tests of blocks with a netlist that is tested by simulation instead of a proof."""

    def test_each_kind_of_tests_must_have_run_and_passed(self):
        for ran, red, said, good in (
                ("test_a.One test_ab.Two", "", "1 tests, none of test_b", False),
                ("test_a.One test_b.Two", "", "2 tests", True),
                ("test_a.One test_b.Two test_b.Three", "test_b.Two", "3 tests, 1 failed", False)):
            cases = "".join(f'<testcase name="{name}" time="1.5" status='
                            f'"{"fail" if name == red else "run"}"/>' for name in ran.split())
            with tempfile.NamedTemporaryFile("w") as junit:
                junit.write(f"<testsuite>{cases}</testsuite>")
                junit.flush()
                found = equivalence.simulated("test_a test_b", junit.name)
            self.assertEqual(found[:2], (f"simulated by test_a test_b: {said}", good))
        self.assertEqual(found[2], 4.5)
        self.assertFalse(equivalence.simulated("test_a", None)[1])


if __name__ == "__main__":
    unittest.main()
