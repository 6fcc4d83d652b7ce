# SPDX-License-Identifier: MIT
#
# Makefile: the entrance. `make` lists what can be done; CMake (CMakeLists.txt) does it.

SHELL := /bin/sh
BUILD ?= build/main
JOBS  ?= $(shell nproc)
# Tests at once: some wait for a clock, so two more than there are processors keep all of these busy
TESTS ?= $(shell expr $(JOBS) + 2)
SEED  ?= 1
LOSS  ?= 0
SIZE  ?= 320x240
IMAGE ?= /usr/share/xplanet/images/earth.jpg
THRESHOLD ?= 24
# Which tests: LABEL=rtl, NAME=regular-expression
LABEL ?=
NAME  ?=
OUT   ?= build/run
# host: the firmware's host build; m3: its ARM binary on a model of the Cortex-M3
CPU   ?= host
# The page that shows the mission: its port (0: any); LIVE=1: it stays until Ctrl-C
PORT  ?= 0
LIVE  ?=
# Cores whose part is flown too: CORES="ascon fir camera" (ip/*/ground.py)
CORES ?=
# CAMERA=1: the picture comes through the camera core's pins, and the vision core takes it from there
CAMERA ?=
# Folder of the real uC/OS-II: the firmware is built with it, too, and CPU=m3 flies it (docs/ucos2.md)
UCOS2 ?=

.DEFAULT_GOAL := help
.PHONY: help setup build run test mutants bench firmware gdb size clean

help: ## this list
	@echo "IceSoC: every function of the UAV, in software or in hardware, is a ZeroC Ice object."
	@echo
	@sed -n 's/^\([a-z-]*\):[^#]*## \(.*\)/  make \1\t\2/p' $(MAKEFILE_LIST) | expand -t 16
	@echo
	@echo "Variables: IMAGE=file SIZE=320x240 THRESHOLD=24 LOSS=0.1 SEED=1 OUT=build/run CPU=host|m3 LIVE=1 PORT=8080 CORES=ascon CAMERA=1 (make run);"
	@echo "           LABEL=rtl|vhdl|formal|lint|firmware|interop|e2e NAME=regexp SEED=1 (make test)"

setup: ## install the Debian packages that are missing
	@cmake/setup.sh

$(BUILD)/build.ninja: setup
	@[ -f $@ ] || cmake -S . -B $(BUILD) -G Ninja
	@$(if $(UCOS2),cmake -S . -B $(BUILD) "-DUCOS2=$(abspath $(UCOS2))" >/dev/null)

build: $(BUILD)/build.ninja ## build everything (simulator, firmware, compiler, plugin, tests)
	@ninja -C $(BUILD) -j $(JOBS)

run: $(BUILD)/build.ninja ## fly the mission: simulated UAV, ZeroC Ice ground station, pictures in build/run
	@ninja -C $(BUILD) -j $(JOBS) mission
	@testbench/sim/run.sh "$(BUILD)" --image "$(IMAGE)" --size "$(SIZE)" --threshold "$(THRESHOLD)" \
	    --loss "$(LOSS)" --seed "$(SEED)" --out "$(OUT)" --cpu "$(CPU)" \
	    --port "$(PORT)" $(if $(LIVE),--live 1) $(if $(CORES),--cores "$(CORES)") $(if $(CAMERA),--sensor 1) $(if $(UCOS2),--firmware "$(BUILD)/firmware/uav_ucos2.elf")

# What the sanitized build covers: the firmware's layers and their peers.
# Not the interop programs of the minimal configuration: they leave out unused sections, which sanitizers keep.
SANITIZED := test_os test_os_cases test_link test_engine test_icec icec_server icec_client everything_cpp_client everything_cpp_server everything_server \
    everything_client everything_strings ice_relay test_icec_minimal test_icec_minimal_calls
test: build ## run all tests; firmware, models and IceC once more with sanitizers
ifneq ($(LABEL)$(NAME),)
	@SEED=$(SEED) ctest --test-dir $(BUILD) -j $(TESTS) --output-on-failure --no-tests=error \
	    $(if $(LABEL),-L '$(LABEL)') $(if $(NAME),-R '$(NAME)')
else
	@SEED=$(SEED) ctest --test-dir $(BUILD) -j $(TESTS) --output-on-failure --no-tests=error
	@[ -f build/sanitized/build.ninja ] || cmake -S . -B build/sanitized -G Ninja -DSANITIZE=ON \
	    -DROOMS="bus;slice;sw;hdl;ip;testbench;tests" >/dev/null
	@ninja -C build/sanitized -j $(JOBS) $(SANITIZED)
	@SEED=$(SEED) ctest --test-dir build/sanitized -j $(TESTS) --output-on-failure --no-tests=error \
	    -R '^(test_os[.]|test_os_cases|test_link|test_engine[.]Engine[.]|test_icec|interop)' -E '^interop.minimal'
endif

mutants: $(BUILD)/build.ninja ## plant every seeded bug of tests/mutants, expect its test to fail (BLOCK=bus for one block)
	@tests/mutants/run.sh --jobs $(JOBS) $(if $(BLOCK),--block '$(BLOCK)')

bench: $(BUILD)/build.ninja ## measure simulator, radio link, FSMC bridge, memory ports, modem set-up, firmware, cores and Slice compiler, write build/bench/*.json
	@ninja -C $(BUILD) -j $(JOBS) measure_simulator
	@ninja -C $(BUILD) -j $(JOBS) measure_link
	@ninja -C $(BUILD) -j $(JOBS) measure_plugin
	@ninja -C $(BUILD) -j $(JOBS) measure_fsmc
	@ninja -C $(BUILD) -j $(JOBS) measure_memory
	@ninja -C $(BUILD) -j $(JOBS) measure_modem
	@ninja -C $(BUILD) -j $(JOBS) measure_speed
	@ninja -C $(BUILD) -j $(JOBS) measure_cores
	@ninja -C $(BUILD) -j $(JOBS) measure_wrapper
	@ninja -C $(BUILD) -j $(JOBS) measure_latency
	@ninja -C $(BUILD) -j $(JOBS) measure_firmware
	@ninja -C $(BUILD) -j $(JOBS) measure_new_ip
	@ninja -C $(BUILD) -j $(JOBS) slice2c
	@tests/slice/bench.sh $(BUILD)/slice/slice2c build/bench/slice.json

firmware: $(BUILD)/build.ninja ## the firmware for the STM32F2: ELF and map in build/main/firmware, table of flash, RAM and stacks
	@ninja -C $(BUILD) -j $(JOBS) firmware
	@sw/target/table.sh $(BUILD)/firmware/uav.map $(BUILD)/sw/target/uav.arm build/firmware.json

gdb: $(BUILD)/build.ninja ## debug the firmware's ARM binary against the RTL with gdb-multiarch
	@ninja -C $(BUILD) -j $(JOBS) mission
	@mkdir -p "$(OUT)"
	@testbench/sim/gdb.sh "$(BUILD)" --image "$(IMAGE)" --size "$(SIZE)" --seed "$(SEED)" --out "$(OUT)"

size: $(BUILD)/build.ninja ## bytes of each firmware layer on a Cortex-M3, beside the paper's
	@ninja -C $(BUILD) size

clean: ## remove what was built
	rm -rf build

include $(wildcard */room.mk) # what a room adds
