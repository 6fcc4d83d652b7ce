# SPDX-License-Identifier: MIT
"""wrong_test: checks that `./icesoc board check` rejects boards that cannot work, with the correct
message and no other. Each line of WRONG contains a change to the kit and the expected message."""
import codecs
import copy
import sys
import tempfile
import unittest
from pathlib import Path

from icesoc.board import check, model

KIT = model.find("nucleo-qmtech")


def net(name, **changes):
    """Returns a function that changes one net; the value None removes a key."""
    def change(facts):
        entry = next(n for n in facts["nets"] if n["name"] == name)
        entry.update(changes)
        for key in [key for key, value in entry.items() if value is None]:
            del entry[key]
    return change


def swap(first, second, end):
    """Returns a function that swaps the ends of two nets."""
    def change(facts):
        one, two = (next(n for n in facts["nets"] if n["name"] == name)
                    for name in (first, second))
        one[end], two[end] = two[end], one[end]
    return change


def without(name):
    def change(facts):
        facts["nets"] = [n for n in facts["nets"] if n["name"] != name]
    return change


def put(table, key, value):
    def change(facts):
        (facts[table] if table else facts)[key] = value
    return change


def shut(bridge):
    """Returns a function that closes a solder bridge."""
    def change(facts):
        facts["open"].remove(bridge)
    return change


def both(*changes):
    def change(facts):
        for each in changes:
            each(facts)
    return change


WRONG = {
    "two data pins swapped": (swap("D0", "D1", "mcu"), [
        "net D0: PD15 does not have the function FSMC_D0; FSMC_D0 is on PD14",
        "net D1: PD14 does not have the function FSMC_D1; FSMC_D1 is on PD15"]),
    "a pin that the package lacks": (put("mcu", "part", "stm32f207vgt6"), [
        "net A0: the stm32f207vgt6 has no pin PF0"]),
    "a function of another pin": (net("NE2", mcu="PG8"), [
        "net NE2: PG8 does not have the function FSMC_NE2; FSMC_NE2 is on PG9"]),
    "an alternate function that is not the net's": (net("NWE", function="USART2_TX"), [
        "net NWE: expected the function FSMC_NWE, got USART2_TX"]),
    "a ball used twice": (net("D3", fpga="E12"), [
        "net D3: ball E12 is used twice, also by D0"]),
    "a pin used twice": (net("JUMPER_OPEN", mcu="PC1"), [
        "net JUMPER_OPEN: expected pin PC2, which the firmware uses, got PC1",
        "net FPGA_DONE: pin PC1 is used twice, also by JUMPER_OPEN"]),
    "the interrupt's pin drives an LED": (shut("SB120"), [
        "net IRQ: PB0 is occupied by the green LED LD1; open SB120 (add it to 'open')"]),
    "data lines on ST-LINK's serial port": (both(shut("SB5"), shut("SB6")), [
        "net D13: PD8 is occupied by ST-LINK's serial port (STLK_RX); open SB5 (add it to 'open')",
        "net D14: PD9 is occupied by ST-LINK's serial port (STLK_TX); open SB6 (add it to "
        "'open')"]),
    "an address line on Ethernet": (shut("SB182"), [
        "net A24: PG13 is occupied by Ethernet RMII_TXD0; open SB182 (add it to 'open')"]),
    "the console on USB": (shut("SB127"), [
        "net CONSOLE_TX: PA9 is occupied by USB_VBUS of the user's USB connector; open SB127 (add "
        "it to 'open')"]),
    "a solder bridge that the module lacks": (put("", "open", [*KIT.facts["open"], "SB999"]), [
        "open: nucleo-f207zg has no solder bridge or jumper SB999"]),
    "a bank at 2.5 V": (put("fpga", "banks", [2.5, 3.3, 3.3, 1.5]), [
        "net CLOCK: 3.3 V on ball A10, and its bank 0 has 2.5 V"]),
    "a bank without supply": (put("fpga", "banks", [3.3, 0, 3.3, 1.5]), [
        "net A0: ball K15 is in bank 1, which has no supply"]),
    "the memory's bank at 3.3 V": (put("fpga", "banks", [3.3, 3.3, 3.3, 3.3]), [
        "fpga.banks: bank 3 has the DDR3 and needs 1.5 V, got 3.3 V"]),
    "the clock on an ordinary ball": (net("CLOCK", fpga="A14"), [
        "net CLOCK: ball A14 (IO_L65N_SCP2_0) is not a global clock pin; choose one with GCLK in "
        "its name"]),
    "a strobe on an ordinary ball": (swap("NWE", "A0", "fpga"), [
        "net NWE: its edge clocks registers, and ball K15 (IO_L44P_A3_M1DQ6_1) is not a clock "
        "input; choose one with GCLK in its name"]),
    "an input without a driver": (net("MODEM_CTS", modem=None), [
        "net MODEM_CTS: missing 'modem', the pin CTS of the socket",
        "net MODEM_CTS: the input has no driver: expected 'modem', or 'pull' for a fixed level"]),
    "a strobe that only a pull holds": (net("NOE", mcu=None, pull="up"), [
        "net NOE: the input has no driver: a pull holds it for ever"]),
    "a multiplexed board with NADV held only by a pull": (put("fsmc", "muxed", True), [
        "net NADV: the input has no driver: a pull holds it for ever"]),
    "5 V on a ball": (net("CORE_I0", level=5.0), [
        "net CORE_I0: 5 V on C9, which takes 3.6 V at most; use a level shifter or a divider"]),
    "a modem at 5 V": (put("", "supplies", [{"name": "5V", "volts": 5.0, "source": "CN11",
                                             "feeds": ["xbee"]}]), [
        "supplies: 5 V at xbee, which takes 3.6 V"]),
    "a missing data line": (without("D7"), [
        "net D7: missing; the chip and the firmware need it"]),
    "a modem's UART not crossed": (swap("MODEM_TXD", "MODEM_RXD", "modem"), [
        "net MODEM_RXD: expected modem = \"DOUT\", got \"DIN\": two outputs would drive the wire",
        "net MODEM_TXD: expected modem = \"DIN\", got \"DOUT\": two outputs would drive the "
        "wire"]),
    "a ball that is ground": (net("D0", fpga="A1"), ["net D0: ball A1 is GND, not an I/O"]),
    "a ball that configures the FPGA": (net("D0", fpga="R3"), [
        "net D0: ball R3 (IO_L65P_INIT_B_2) configures the FPGA at start; choose another"]),
    "a ball of the memory": (net("CORE_I10", fpga="K5", level=1.5), [
        "net CORE_I10: ball K5 (IO_L47P_M3A0_3) belongs to the DDR3"]),
    "an oscillator that makes no 120 MHz": (put("mcu", "hse_hz", 12_288_000), [
        "mcu.hse_hz: expected whole MHz, 4 to 26, got 12.288 MHz: the PLL divides to 1 MHz and "
        "makes 120 MHz of it"]),
    "an FPGA clock that makes no 100 MHz": (put("fpga", "clock_hz", 66_000_000), [
        "fpga.clock_hz: MIG's PLL cannot make 100 MHz of 66 MHz (600 MHz is not a multiple of "
        "this)"]),
    "a strobe later than its data": (net("NWE", delay_ns=8.0), [
        "net D0: NWE arrives 8 ns after it; at most 5 ns, or the FPGA takes the next word's "
        "value"]),
    "unknown facts": (put("", "unknown", ["the pin of D0"]), ["unknown: the pin of D0"]),
}


def case(change, expected):
    def test(self):
        facts = copy.deepcopy(KIT.facts)
        change(facts)
        nets = [model.Net(n["name"], n) for n in facts["nets"]]
        parts = dict(KIT.parts)
        if facts["mcu"]["part"] != KIT.facts["mcu"]["part"]:
            parts["mcu"] = model.mcu_part(model.BOARDS / f"parts/{facts['mcu']['part']}.csv")
        found = check.problems(model.Board(KIT.path, KIT.name, facts, parts, KIT.modules, nets))
        for text in expected:
            self.assertIn(text, found)
        reasons = {self.reason(text) for text in expected}
        self.assertEqual([text for text in found if self.reason(text) not in reasons], [])
    return test


class Wrong(unittest.TestCase):
    @staticmethod
    def reason(text):
        """Returns a message without its names and figures; the result identifies the kind of
        error."""
        return " ".join(word for word in text.partition(": ")[2].split()
                        if word.isalpha() and word.islower())[:14]

    def test_the_kit_has_no_problem(self):
        self.assertEqual(check.problems(KIT), [])

    def test_there_are_at_least_20(self):
        self.assertGreaterEqual(len(WRONG), 20)


class Parts(unittest.TestCase):
    def test_a_byte_order_mark_is_skipped(self):
        with tempfile.NamedTemporaryFile(suffix=".csv") as file:
            file.write(codecs.BOM_UTF8 + "ball,name # \x85\f\nA1,x\n".encode())
            file.flush()
            self.assertEqual(model.rows(Path(file.name)), [{"ball": "A1", "name # \x85\f": "x"}])


for title, (changed, texts) in WRONG.items():
    setattr(Wrong, "test_" + title.replace(" ", "_").replace("'", "").replace(".", "_"),
            case(changed, texts))

if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
