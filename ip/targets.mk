# SPDX-License-Identifier: MIT
#
# Cores: begin one, test one, look at one, take one away (docs/recipes.md).
IP ?=
TEST ?=
ICE ?=
FORCE ?=

# LANG here is the core's language. The environment's LANG is hidden from programs, which would take
# it for messages.
new-ip: language = $(if $(filter command,$(origin LANG)),$(LANG),$(filter verilog vhdl,$(LANG)))
new-ip: export LC_ALL := C.UTF-8
new-ip: $(BUILD)/build.ninja ## begin a core: NAME=low_pass LANG=verilog|vhdl [ICE=file] writes ip/low_pass, which builds and passes its test
	@[ -z '$(ICE)' ] || $(NINJA) --quiet slice2c
	@ip/new.sh '$(NAME)' '$(language)' '$(BUILD)' '$(ICE)'

TOP ?=
BUS ?=
FILES ?=
PORTS ?=
CLOCK ?=
LIBRARY ?=
PARAMS ?=
DEFINES ?=
new-foreign: $(BUILD)/build.ninja ## put a third-party core into a slot: NAME=my_uart TOP=its_module BUS=wishbone|axil|apb|memory|own|axis FILES="a.v b.v" [PORTS="write=we ack=done"] [PARAMS="depth=16"] [DEFINES="wide"] [CLOCK=24000000] [LIBRARY=of_the_vhdl]
	@$(if $(filter %.vhd %.vhdl %.VHD %.VHDL,$(FILES)),$(NINJA) --quiet ghdl)
	@GHDL='$(BUILD)/ghdl/ghdl' ip/new_foreign.py '$(NAME)' '$(TOP)' '$(BUS)' 'ip/$(NAME)' $(if $(CLOCK),'CLOCK=$(CLOCK)') $(if $(LIBRARY),'LIBRARY=$(LIBRARY)') $(addprefix PARAM:,$(PARAMS)) $(addprefix DEFINE:,$(DEFINES)) $(PORTS) $(FILES)
.PHONY: new-foreign

# Put into slots by new-foreign: slot=module=bus=repository, and =Hz of a clock of its own.
FOREIGN_NEW := foreign_aes=aes=memory=aes foreign_uart=wbuart=wishbone=wbuart32=24000000 foreign_axil=axiluart=axil=wbuart32 \
    foreign_i2c=i2c_master_top=wishbone=i2c foreign_cobs=axis_cobs_encode=axis=verilog-axis
foreign_slots = foreign_spi $(foreach f,$(FOREIGN_NEW),$(firstword $(subst =, ,$(f))))
# Third-party cores come from the network, so they are apart.
foreign: setup-tests ## put third-party cores (Wishbone, AXI4-Lite, AXI-Stream and plain buses in Verilog, records in VHDL) and two of one's own through the recipe, in three orders, test them and call them by radio; downloads them (CHIP=1: and what each costs in that chip)
	@cmake/fetch.py foreign build/foreign-cores
	@cmake/fetch.py ghdl build/foreign-cores/ghdl
	@rm -rf build/foreign-cores/slots
	@GHDL=build/foreign-cores/ghdl/ghdl ip/new_foreign.py foreign_spi neorv32_spi own build/foreign-cores/slots/foreign_spi LIBRARY=neorv32 PARAM:IO_SPI_FIFO=4 \
	    strobe=bus_req_i_stb write=bus_req_i_rw address=bus_req_i_addr enables=bus_req_i_ben wdata=bus_req_i_data \
	    rdata=bus_rsp_o_data ack=bus_rsp_o_ack error=bus_rsp_o_err high=clkgen_i \
	    $(addprefix low=bus_req_i_,meta amo amoop burst lock) build/foreign-cores/neorv32/*.vhd >/dev/null
	@for f in $(FOREIGN_NEW); do \
	    echo "$$f" | { IFS='=' read -r slot top bus from clock; \
	        ip/new_foreign.py "$$slot" "$$top" "$$bus" "$(CURDIR)/build/foreign-cores/slots/$$slot" $${clock:+CLOCK=$$clock} $(CURDIR)/build/foreign-cores/"$$from"/*.v >/dev/null; } || exit 1; \
	done
	@IMAGE='$(IMAGE)' JOBS='$(JOBS)' SEED='$(SEED)' CHIP='$(CHIP)' examples/foreign/orders.sh examples/foreign/olo_spi \
	    $(addprefix tests/e2e/cores/,servo crc32) $(addprefix build/foreign-cores/slots/,$(foreign_slots))
.PHONY: foreign

# Folders of cores outside of ip/, separated by ;: the build folder keeps them. CORE_FOLDERS=none: none from now on.
CORE_FOLDERS ?=
core-folders: $(BUILD)/build.ninja
	@[ -z '$(CORE_FOLDERS)' ] || cmake/set.sh $(BUILD) '-DCORE_FOLDERS=$(filter-out none,$(CORE_FOLDERS))'
.PHONY: core-folders

ip-test: core-folders ## build and test one core: IP=fir (CORE_FOLDERS=/path/to/it where it is not in ip/)
	@SEED=$(SEED) ip/test.sh '$(BUILD)' '$(IP)' '$(JOBS)'

# CHIP=1: in the chip as listed now, which takes minutes, instead of the accepted one.
CHIP ?=
ip-synth: core-folders ## utilisation of one core, alone and in the chip: IP=fir (CORE_FOLDERS=/path/to/it where it is not in ip/; CHIP=1: the chip of today, not the accepted one)
	@grep -qx '$(or $(IP),none)' $(BUILD)/cores.known || { echo "ip-synth: IP=name of a core, not '$(IP)'" >&2; exit 1; }
	@make --no-print-directory synth DESIGN='$(IP)'
	@$(BUILD)/synth/utilisation --generated $(BUILD)/gen --jobs $(JOBS) --core '$(IP)' $(if $(CHIP),--design soc)

wave: $(BUILD)/build.ninja ## waveform of one test of a core, for GTKWave: IP=fir TEST=Impulse
	@JOBS=$(JOBS) ip/wave.sh '$(IP)' '$(TEST)'

rm-ip: ## take a core away: NAME=low_pass, its folder and its line (FORCE=1: with changes that are not committed)
	@FORCE='$(FORCE)' ip/rm.sh '$(NAME)' '$(BUILD)'
.PHONY: new-ip ip-test ip-synth wave rm-ip
