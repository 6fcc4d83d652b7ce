# SPDX-License-Identifier: MIT
#
# Cores: begin one, test one, look at one, take one away (docs/recipes.md).
IP ?=
TEST ?=
ICE ?=
FORCE ?=

# LANG is the core's language here, not that of messages, for which programs would take it.
new-ip: export LC_ALL := C.UTF-8
new-ip: $(BUILD)/build.ninja ## begin a core: NAME=low_pass LANG=verilog|vhdl [ICE=file] writes ip/low_pass, which builds and passes its test
	@[ -z '$(ICE)' ] || ninja -C $(BUILD) -j $(JOBS) --quiet slice2c
	@ip/new.sh '$(NAME)' '$(LANG)' '$(BUILD)' '$(ICE)'

FOREIGN := i2c_master axil_uart spi_master
# Third-party cores come from the network, so they are no part of the rest.
foreign: setup ## put third-party cores (Wishbone and AXI4-Lite in Verilog, records in VHDL) through the recipe and test them; downloads them
	@cmake/fetch.sh foreign build/foreign-cores
	@cmake -S . -B build/foreign -G Ninja -DROOMS="bus;slice;sw;hdl;ip;testbench" -DFOREIGN_CORES='$(CURDIR)/build/foreign-cores' \
	    -DCORE_FOLDERS='$(subst $(eval ) ,;,$(FOREIGN:%=$(CURDIR)/examples/foreign/%))' >/dev/null
	@ninja -C build/foreign -j $(JOBS) --quiet $(FOREIGN:%=test_ip_%)
	@ctest --test-dir build/foreign --output-on-failure --no-tests=error -R '^test_ip_($(subst $(eval ) ,|,$(FOREIGN)))[.]'
.PHONY: foreign

ip-test: $(BUILD)/build.ninja ## build and test one core: IP=fir
	@SEED=$(SEED) ip/test.sh '$(BUILD)' '$(IP)' '$(JOBS)'

ip-synth: $(BUILD)/build.ninja ## utilisation of one core: IP=fir
	@[ -n '$(IP)' ] && [ -d 'ip/$(IP)' ] || { echo "ip-synth: IP=name of a core in ip/, not '$(IP)'" >&2; exit 1; }
	@$(MAKE) --no-print-directory synth DESIGN='$(IP)' FAMILY=xc6s

wave: $(BUILD)/build.ninja ## waveform of one test of a core, for GTKWave: IP=fir TEST=Impulse
	@JOBS=$(JOBS) ip/wave.sh '$(IP)' '$(TEST)'

rm-ip: ## take a core away: NAME=low_pass, its folder and its line (FORCE=1: with changes that are not committed)
	@FORCE='$(FORCE)' ip/rm.sh '$(NAME)' '$(BUILD)'
.PHONY: new-ip ip-test ip-synth wave rm-ip
