# SPDX-License-Identifier: MIT
"""examples: public cores that `./icesoc core examples` puts into slots, and where they are
downloaded (docs/guides/fetched-cores.md)."""
import json
import shutil
import sys
from dataclasses import dataclass, field
from pathlib import Path

from icesoc.util import download


@dataclass(frozen=True)
class Core:
    """A core, and what shows that it works in a chip."""
    name: str
    new: str = ""  # top, bus, other arguments and file patterns of `./icesoc core foreign`
    folder: str = ""  # folder of the core, if it is in this tree and has a manifest
    list: str = ""  # rest of the core's line in the list of the chip's cores
    calls: str = ""  # accesses that examples/foreign/call.py makes by radio
    chip: int = 1  # number of the chip that contains it
    netlist: bool = True  # False: Yosys cannot read the core


@dataclass(frozen=True)
class Source:
    """Where cores are downloaded. Without an archive and a repository, they are in this tree."""
    name: str
    cores: list[Core]
    archive: str = ""  # path in Debian's pool
    folder: str = ""  # folder in the archive
    checksum: str = ""  # SHA-256 of the archive
    repository: str = ""  # owner, name and commit on GitHub
    files: dict[str, str] = field(default_factory=dict)  # path -> SHA-256 of each of its files

    @property
    def is_here(self):
        return not self.archive and not self.repository

    def sums(self):
        """Returns a text that changes if the download changes."""
        return json.dumps([self.archive, self.folder, self.checksum, self.repository, self.files])

    def is_in(self, target):
        """Returns whether the source is in this tree or has been downloaded to a folder."""
        note = target / f"{self.name}.done"
        return self.is_here or note.exists() and note.read_text() == self.sums()

    def fetch(self, target):
        """Downloads the source to a folder below `target`."""
        folder = target / self.name
        shutil.rmtree(folder, ignore_errors=True)
        (target / f"{self.name}.done").unlink(missing_ok=True)
        if self.archive:
            download.unpack(download.released(self.archive, self.checksum), self.folder, folder)
        else:
            folder.mkdir(parents=True)
            for path, checksum in self.files.items():
                shutil.copyfile(download.kept(f"{download.GITHUB}/{self.repository}/{path}",
                                              checksum), folder / Path(path).name)
        (target / f"{self.name}.done").write_text(self.sums())


SOURCES = [
    Source("here", [
        Core("servo", folder="tests/e2e/cores/servo"),
        Core("crc32", folder="tests/e2e/cores/crc32")
    ]),
    Source("bladerf", [
        Core("foreign_i2c",
             new="i2c_master_top wishbone CLOCK=24000000 opencores/i2c/rtl/verilog/*.v",
             list="clock=6/25 scl_pad_i=foreign_i2c.scl_padoen_o "
                  "sda_pad_i=foreign_i2c.sda_padoen_o",
             calls="REG0=9 REG1=0 REG0==9 REG2=0x80 REG3=0xA6 REG4=0x90 REG4==0xC1 REG3==0x53 "
                   "REG4=0x40 REG4&0x40==0"),
        Core("foreign_arbiter",
             new="arbiter avalon wdata=din rdata=dout wait=waitreq valid=readack "
                 "interrupt=intr PARAM:N=4 nuand/arbiter/vhdl/arbiter.vhd",
             calls="REG8=0 wait(0) REG0=1 wait(1000)==['CORE'] REG1==1 REG8=1 REG0=2 REG1==0"),
        Core("foreign_time",
             new="time_tamer avalon wdata=din rdata=dout wait=waitreq valid=readack "
                 "interrupt=intr clock=ts_clock reset=ts_reset open=ts_time "
                 "nuand/time_tamer/vhdl/time_tamer.vhd nuand/synthesis/synchronizer.vhd "
                 "nuand/synthesis/handshake.vhd",
             calls="REG0=0 REG1=0 REG2=0 REG3=0 REG4=0 REG5=0 REG6=0 REG7=0 wait(0) REG8=0 "
                   "wait(1000)==['CORE'] REG9==1 REG8=1 REG9==0"),
        Core("foreign_command",
             new="command_uart avalon wdata=din rdata=dout wait=waitreq valid=readack "
                 "ADDRESS=bytes nuand/command_uart/vhdl/command_uart.vhd",
             list="rs232_sin_i=foreign_command.rs232_sout_o",
             calls="REG1=0x11223344 REG3=0x99AABBCC wait(0) REG0=0x41 wait(1000)==['CORE'] "
                   "REG0==0x41 REG1==0x11223344 REG3==0x99AABBCC"),
        Core("foreign_tone",
             new="tone_generator_hw avalon open=* wdata=din rdata=dout wait=waitreq "
                 "valid=readack clock=sample_clk nuand/tone_generator/vhdl/tone_generator*.vhd "
                 "nuand/synthesis/synchronizer.vhd nuand/synthesis/reset_synchronizer.vhd "
                 "nuand/synthesis/cordic.vhd nuand/synthesis/nco.vhd",
             calls="REG1=85 REG1==85 REG2=1000 REG2==1000 REG0=1"),
        Core("foreign_fifo",
             new="util_axis_fifo axis open=* PARAM:DATA_WIDTH=32 PARAM:ASYNC_CLK=0 "
                 "analogdevicesinc/hdl/library/util_axis_fifo/*.v "
                 "analogdevicesinc/hdl/library/common/ad_mem.v "
                 "analogdevicesinc/hdl/library/common/sync_*.v",
             calls="process([1,-2,3])==[1,-2,3]"),
        Core("foreign_slice",
             new="axi_register_slice axis s_tvalid=s_axi_valid s_tready=s_axi_ready "
                 "s_tdata=s_axi_data m_tvalid=m_axi_valid m_tready=m_axi_ready "
                 "m_tdata=m_axi_data PARAM:DATA_WIDTH=16 PARAM:FORWARD_REGISTERED=1 "
                 "PARAM:BACKWARD_REGISTERED=1 "
                 "analogdevicesinc/hdl/library/axi_dmac/axi_register_slice.v",
             calls="process([1,-2,3])==[1,-2,3]"),
        Core("foreign_clkgen",
             new="up_clkgen own write=up_wreq read=up_rreq address=up_waddr address=up_raddr "
                 "wdata=up_wdata rdata=up_rdata ack=up_wack ack=up_rack open=* low=* "
                 "analogdevicesinc/hdl/library/common/up_clkgen.v "
                 "analogdevicesinc/hdl/library/common/ad_rst.v",
             calls="REG0==0x40063 REG2=0x12345678 REG2==0x12345678 REG16=3 REG16==3"),
        Core("foreign_hdmi",
             new="up_hdmi_tx own write=up_wreq read=up_rreq address=up_waddr address=up_raddr "
                 "wdata=up_wdata rdata=up_rdata ack=up_wack ack=up_rack clock=hdmi_clk open=* "
                 "low=* analogdevicesinc/hdl/library/common/up_hdmi_tx.v "
                 "analogdevicesinc/hdl/library/common/ad_rst.v "
                 "analogdevicesinc/hdl/library/common/up_xfer_*.v "
                 "analogdevicesinc/hdl/library/common/up_clock_mon.v",
             calls="REG2=0xCAFE REG2==0xCAFE REG26=0xABCDEF REG26==0xABCDEF"),
        Core("foreign_pmod",
             new="up_pmod own write=up_wreq read=up_rreq address=up_waddr address=up_raddr "
                 "wdata=up_wdata rdata=up_rdata ack=up_wack ack=up_rack open=* low=pmod_* "
                 "analogdevicesinc/hdl/library/common/up_pmod.v "
                 "analogdevicesinc/hdl/library/common/ad_rst.v "
                 "analogdevicesinc/hdl/library/common/up_xfer_status.v",
             calls="REG2=0x87654321 REG2==0x87654321 REG16=1 REG16==1"),
        Core("foreign_dma",
             new="axi_dmac axil open=* low=* analogdevicesinc/hdl/library/axi_dmac/*.v "
                 "analogdevicesinc/hdl/library/axi_dmac/*.h "
                 "analogdevicesinc/hdl/library/common/up_axi.v "
                 "analogdevicesinc/hdl/library/common/sync_*.v "
                 "analogdevicesinc/hdl/library/common/ad_mem.v "
                 "analogdevicesinc/hdl/library/util_axis_fifo/*.v "
                 "analogdevicesinc/hdl/library/util_axis_resize/*.v",
             calls="REG0==0x40062 REG2=0xCAFE REG2==0xCAFE"),
        Core("foreign_control",
             new="axi_ctrlif axil high=rd_stb high=wr_ack open=wr_* open=rd_ack "
                 "PARAM:C_NUM_REG=256 PARAM:C_S_AXI_DATA_WIDTH=8 PARAM:C_S_AXI_ADDR_WIDTH=10 "
                 "analogdevicesinc/hdl/library/common/axi_ctrlif.vhd",
             list="rd_data_i=foreign_control.rd_addr_o rd_addr_o=none",
             calls="REG5=1 REG5==5 REG7==7"),
        Core("foreign_hdmi_rx",
             new="up_hdmi_rx own write=up_wreq read=up_rreq address=up_waddr address=up_raddr "
                 "wdata=up_wdata rdata=up_rdata ack=up_wack ack=up_rack clock=hdmi_clk open=* "
                 "low=* analogdevicesinc/hdl/library/common/up_hdmi_rx.v "
                 "analogdevicesinc/hdl/library/common/ad_rst.v "
                 "analogdevicesinc/hdl/library/common/up_xfer_*.v "
                 "analogdevicesinc/hdl/library/common/up_clock_mon.v",
             calls="REG2=0x600D REG2==0x600D REG16=1 REG17=15 REG17==15"),
        Core("foreign_xcvr",
             new="up_xcvr own write=up_wreq read=up_rreq address=up_waddr address=up_raddr "
                 "wdata=up_wdata rdata=up_rdata ack=up_wack ack=up_rack open=* low=* "
                 "analogdevicesinc/hdl/library/common/up_xcvr.v "
                 "analogdevicesinc/hdl/library/common/ad_rst.v "
                 "analogdevicesinc/hdl/library/common/up_xfer_*.v "
                 "analogdevicesinc/hdl/library/common/up_clock_mon.v "
                 "analogdevicesinc/hdl/library/common/up_drp_cntrl.v",
             calls="REG2=0xBEEF REG2==0xBEEF REG3=1 REG3==1"),
        Core("polar",
             folder="examples/foreign/polar",
             calls="angle(1000,1000)==1025 angle(-12000,5000)==3581")
    ], archive="b/bladerf/bladerf_0.2024.05.orig.tar.gz",
       folder="bladeRF-2024.05/hdl/fpga/ip/",
       checksum="ac7d7991bc1e5faa2509da3c3046c60e9076ac293e479835aea5f19fa71f1fd2"),
    Source("ghdl", [
        Core("foreign_queue",
             new="my_FIFO axis s_tdata=data_in s_tvalid=valid_in s_tready=ready_out "
                 "m_tdata=data_out m_tvalid=valid_out m_tready=ready_in issue412/my_fifo.vhdl "
                 "issue412/generic_sfifo.vhdl",
             calls="process(b'\\x01\\x02\\x03')==b'\\x01\\x02\\x03'")
    ], archive="g/ghdl/ghdl_5.0.1+dfsg.orig.tar.xz",
       folder="ghdl-5.0.1/testsuite/synth/",
       checksum="aa1764e1104c77bac5a4cf2c438ece5c2a1b20e0424f8222ce6c14220ddb02c5"),
    Source("prjtrellis", [
        Core("foreign_simple",
             new="simpleuart own write=reg_dat_we read=reg_dat_re wdata=reg_dat_di "
                 "rdata=reg_dat_do wait=reg_dat_wait low=reg_div_we low=reg_div_di "
                 "open=reg_div_do soc_ecp5_evn/simpleuart.v",
             list="ser_rx_i=foreign_simple.ser_tx_o",
             calls="REG0=0x5A REG0==0x5A")
    ], archive="p/prjtrellis/prjtrellis_1.4.orig.tar.xz",
       folder="prjtrellis-1.4/examples/",
       checksum="67eff0c5e64f63f3a0a3c643bb666085ddfea22f9a901f6171358148cbfcda3a"),
    Source("verilator", [
        Core("foreign_demux",
             new="sv_bus_mux_demux_demux own write=str_vld wdata=str_bus ack=str_rdy "
                 "rdata=bus_dat high=bus_rdy open=* sv_bus_mux_demux_de*.sv",
             calls="REG0=1 REG0=2 REG0=3 REG0=4 REG0=5 REG0=6 REG0=7 REG0=8 REG0==0x04030201",
             chip=2,
             netlist=False)
    ], archive="v/verilator/verilator_5.006.orig.tar.gz",
       folder="verilator-5.006/test_regress/t/t_sv_bus_mux_demux/",
       checksum="732389e5906a600cc65230410c91b16a4fc8911d5455f1b488fc6964b4490b92"),
    Source("neorv32", [
        Core("foreign_spi",
             new="neorv32_spi own *.vhd LIBRARY=neorv32 PARAM:IO_SPI_FIFO=4 "
                 "strobe=bus_req_i_stb write=bus_req_i_rw address=bus_req_i_addr "
                 "enables=bus_req_i_ben wdata=bus_req_i_data rdata=bus_rsp_o_data "
                 "ack=bus_rsp_o_ack error=bus_rsp_o_err high=clkgen_i low=bus_req_i_meta "
                 "low=bus_req_i_amo low=bus_req_i_amoop low=bus_req_i_burst low=bus_req_i_lock",
             list="spi_dat_i=foreign_spi.spi_dat_o",
             calls="REG0=1 REG1=0x5A REG0&0x80000000==0 REG1&0xFF==0x5A")
    ], repository="stnolting/neorv32/b3f390870f77b9bdc4ac282c242742b10408dc53",
       files={
           "rtl/core/neorv32_package.vhd":
               "7b2db0b7afb9a4a4378e6fb7c3b20fd82e6094f617ec9b6f0f2723327cb145ea",
           "rtl/core/neorv32_prim.vhd":
               "a0c8bac70b7e12e72a9c0c3c09b617911c2aa5acb5f0a6c362a5297f0d1adf3d",
           "rtl/core/neorv32_spi.vhd":
               "5a5125a579e1be2537fad1adac48465cea901a619a1056b76658a5a80068903c",
       }),
    Source("aes", [
        Core("foreign_aes", new="aes memory *.v")
    ], repository="secworks/aes/80dc4718e1dcbbdb4b0dd1bdb393d8f7b98981dc",
       files={
           "src/rtl/aes.v":
               "bc52be90d3d1da1ab8cd20a1b126d7e8f55ae4a721e0d478fdf7f901906129cb",
           "src/rtl/aes_core.v":
               "06259118659263d2cc1e9880854c51a981659841e5e6a6179d536fce6c93aa59",
           "src/rtl/aes_decipher_block.v":
               "ab2bcfd2b665b0a41e2b6eec83c7ea1832094865922a0c7c83a93eed00ef3b13",
           "src/rtl/aes_encipher_block.v":
               "333d985833e52e1072ef7705910ebf7d8788d99c3e97c67c4915e524ef7b7c3f",
           "src/rtl/aes_inv_sbox.v":
               "2e64290bf10830008b6cb58427af39e2c6ae9dff5f4cfc282d3afba0cb8dbc35",
           "src/rtl/aes_key_mem.v":
               "d5fbd6124f7b4ac2a50a2dcfaa2a02bfe65f8cb9a387b3488111a257e833ca55",
           "src/rtl/aes_sbox.v":
               "60e7939de3a539176a8514c2e4a477f603173e6ae40512517ed6dfaaa7483fd9",
       }),
    Source("verilog-axis", [
        Core("foreign_cobs", new="axis_cobs_encode axis *.v")
    ], repository="alexforencich/verilog-axis/48ff7a7e2ef782cf778d47910cf85835c64b1bce",
       files={
           "rtl/axis_cobs_encode.v":
               "2aa1b67891e6bf61941678ebbccd0f24ffa1fa0ef899206f06f1f435830ac9b9",
           "rtl/axis_fifo.v":
               "aefddc67fc3552d919280424606fc6b048e61d7df9ee7ee0f8801c082c1cfc39",
       }),
]


def cores():
    """Returns all cores by their names."""
    return {core.name: core for source in SOURCES for core in source.cores}


def fetch(target):
    """Downloads the sources to a folder. Leaves out sources that cannot be downloaded, with a
    message. Returns whether it has any downloaded source."""
    with download.locked():
        for source in SOURCES:
            try:
                if not source.is_in(target):
                    source.fetch(target)
            except download.Unreachable as error:
                names = ", ".join(core.name for core in source.cores)
                print(f"fetch: left out {names}: {error}", file=sys.stderr)
    return any(source.is_in(target) for source in SOURCES if not source.is_here)
