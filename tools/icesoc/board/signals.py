# SPDX-License-Identifier: MIT
"""signals: names of nets in board.toml, and what each name implies: the port of synth/ise/chip.v,
the function of the microcontroller's pin, and the side that drives the net."""
from dataclasses import dataclass

MCU, FPGA, BOTH, MODEM, OTHER = "mcu", "fpga", "both", "modem", "other"


@dataclass(frozen=True)
class Signal:
    name: str
    driver: str  # MCU, FPGA, BOTH, MODEM, or OTHER (the part that `to` names)
    port: str = ""  # pad of the chip, spelled as in UCF; empty: not connected to the FPGA
    function: str = ""  # ST's name of the function, or GPIO; empty: not connected to the CPU
    # pin that the firmware (sw/) requires, such as PA9; empty: any pin that has the function
    pin: str = ""
    modem: str = ""  # pin of the modem's socket
    is_clock: bool = False  # an edge of the signal clocks registers of the FPGA
    # an edge of the signal ends an access to the FPGA, so a slow or noisy edge could cause an
    # additional access
    is_strobe: bool = False
    needed: bool = True  # True: every board must connect the signal


def _signals():
    for bit in range(25):
        yield Signal(f"A{bit}", MCU, f"fsmc_a_i<{bit}>", f"FSMC_A{bit}")
    for bit in range(16):
        yield Signal(f"D{bit}", BOTH, f"fsmc_d_io<{bit}>", f"FSMC_D{bit}")
    for bit in range(2):
        yield Signal(f"NBL{bit}", MCU, f"fsmc_nbl_n_i<{bit}>", f"FSMC_NBL{bit}")
        yield Signal(f"NE{bit + 1}", MCU, f"fsmc_ne_n_i<{bit}>", f"FSMC_NE{bit + 1}",
                     is_strobe=True)
    yield Signal("NOE", MCU, "fsmc_noe_n_i", "FSMC_NOE", is_strobe=True)
    yield Signal("NWE", MCU, "fsmc_nwe_n_i", "FSMC_NWE", is_clock=True, is_strobe=True)
    yield Signal("NADV", MCU, "fsmc_nadv_n_i", "FSMC_NL", is_clock=True, is_strobe=True)
    yield Signal("NWAIT", FPGA, "fsmc_nwait_n_o", "FSMC_NWAIT")
    # EXTI0_Handler of sw/board/board.c requires this pin
    yield Signal("IRQ", FPGA, "irq_o", "GPIO", pin="PB0")
    yield Signal("CLOCK", OTHER, "sys_clk_i", is_clock=True)
    yield Signal("RESET", OTHER, "sys_rst_i")
    yield Signal("MODEM_RXD", MODEM, "modem_rxd_i", modem="DOUT")
    yield Signal("MODEM_TXD", FPGA, "modem_txd_o", modem="DIN")
    yield Signal("MODEM_CTS", MODEM, "modem_cts_n_i", modem="CTS")
    yield Signal("MODEM_RTS", FPGA, "modem_rts_n_o", modem="RTS")
    yield Signal("MODEM_RESET", FPGA, "modem_reset_n_o", modem="RESET")
    yield Signal("CONSOLE_TX", MCU, "", "USART1_TX", pin="PA9")  # sw/vehicle/provision.c
    yield Signal("CONSOLE_RX", OTHER, "", "USART1_RX", pin="PA10")
    yield Signal("JUMPER_WIRED", OTHER, "", "GPIO", pin="PB1")
    yield Signal("JUMPER_OPEN", OTHER, "", "GPIO", pin="PC2", needed=False)
    yield Signal("FPGA_DONE", OTHER, "", "GPIO", pin="PC1")  # sw/update/loader/fpga.c
    yield Signal("FPGA_PROGRAM", MCU, "", "GPIO", pin="PC0", needed=False)
    yield Signal("FLASH_SELECT", MCU, "", "GPIO", pin="PA4", needed=False)
    yield Signal("FLASH_CLOCK", MCU, "", "SPI1_SCK", pin="PA5", needed=False)
    yield Signal("FLASH_OUT", OTHER, "", "SPI1_MISO", pin="PA6", needed=False)
    yield Signal("FLASH_IN", MCU, "", "SPI1_MOSI", pin="PA7", needed=False)
    for bit in range(32):
        yield Signal(f"CORE_I{bit}", OTHER, f"core_pins_i<{bit}>", needed=False)
        yield Signal(f"CORE_O{bit}", FPGA, f"core_pins_o<{bit}>", needed=False)


SIGNALS = {signal.name: signal for signal in _signals()}


def needed(muxed, address_lines):
    """Returns the names of the signals that a board must connect at both ends."""
    absent = {f"A{bit}" for bit in range(25) if (muxed and bit < 16) or bit >= address_lines}
    absent |= set() if muxed else {"NADV"}
    return [s.name for s in SIGNALS.values() if s.needed and s.name not in absent]
