# SPDX-License-Identifier: MIT
#
# Makefile: the entrance. `make` lists what can be done; CMake (CMakeLists.txt) does it.

SHELL := /bin/sh
BUILD ?= build/main
JOBS  ?= $(shell nproc)
NINJA  = cmake/ninja.sh $(BUILD) -j $(JOBS)
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
OUT   ?= $(if $(REPLAY),build/replay,build/run)
# host: the firmware's host build; m3: its ARM binary on a model of the Cortex-M3
CPU   ?= host
# uav: the mission; minimal: the program of Table II, with CPU=m3
APP   ?= uav
# The page that shows the mission: its port (0: any); LIVE=1: it stays until Ctrl-C
PORT  ?= 0
LIVE  ?=
# Cores whose part is flown too: CORES="ascon fir camera" (ip/*/ground.py)
CORES ?=
# The simulated chip's clock in Hz; the board's, unless stated
CLK_HZ ?= 100000000
# CAMERA=1: the picture comes through the camera core's pins, and the vision core takes it from there
CAMERA ?=
# KEY=file: the link's key, of vehicle and ground (sw/ground/key_file.h); without one, a demo key; OPEN=1: in the clear
KEY   ?=
OPEN  ?=
# PINS=file: drives the inputs of cores (docs/simulation.md)
PINS ?=
# PROBE=u_fir.sent=1: the trigger of a probe among CORES (ip/probe/README.md); ground.py reads it
PROBE ?=
export PROBE
# FRESH=1: proofs, lints and synthesis of unchanged files are computed again, too (tests/kept.py)
FRESH ?=
export FRESH
# Folder of a flight (its OUT) that make run and make gdb fly again, bit by bit; FROM=1.5 TO=1.6: its waveform, in s
REPLAY ?=
FROM  ?=
TO    ?=
# Firmware (ELF) that is sent to the vehicle in place of the mission (docs/update.md)
UPDATE ?=
# Mutants that are drawn for each proof, with SEED (make mutants)
DRAW ?=
# Folder of the real uC/OS-II: the firmware is built with it, too, and CPU=m3 flies it (docs/firmware.md)
UCOS2 ?=

# The compiler's cache serves every clone: paths below this folder are relative in it.
export CCACHE_BASEDIR := $(CURDIR)
export CCACHE_NOHASHDIR := 1

# A timer or a container may give none: ccache and cmake/fetch.py keep their files there.
export HOME ?= $(shell getent passwd $$(id -u) | cut -d: -f6)

# Numbers have a point in every tool, whatever the user's language.
export LC_ALL := C.UTF-8

.DEFAULT_GOAL := help
.PHONY: help setup setup-tests build run test mutants bench firmware gdb size clean

help: ## this list
	@echo "IceSoC: every function of the UAV, in software or in hardware, is a ZeroC Ice object."
	@echo
	@sed -n 's/^\([a-z-]*\):[^#]*## \(.*\)/  make \1\t\2/p' $(MAKEFILE_LIST) | expand -t 16
	@echo
	@echo "Variables: IMAGE=file SIZE=320x240 THRESHOLD=24 LOSS=0.1 SEED=1 OUT=build/run CPU=host|m3 APP=uav|minimal LIVE=1 PORT=8080 CORES=ascon CAMERA=1 PINS=file PROBE=signal=1 KEY=file OPEN=1 UPDATE=new.elf CLK_HZ=2000000 REPLAY=build/run FROM=1.5 TO=1.6 (make run);"
	@echo "           LABEL=rtl|vhdl|formal|lint|firmware|interop|e2e NAME=regexp SEED=1 (make test)"

setup: ## install the Debian packages that make run needs and the machine lacks
	@cmake/setup.sh

setup-tests: ## install those that tests, reports and debuggers need beside
	@cmake/setup.sh --tests

$(BUILD)/build.ninja: setup
	@cmake/configure.sh $(BUILD)
	@$(if $(UCOS2),cmake/set.sh $(BUILD) $(call quoted,-DUCOS2=$(abspath $(UCOS2))))

build: $(BUILD)/build.ninja ## build everything (simulator, firmware, compiler, plugin, tests)
	@$(NINJA)

# One word for the shell, whatever is in it.
quoted = '$(subst ','\'',$(1))'

run: $(BUILD)/build.ninja ## fly the mission: simulated UAV, ZeroC Ice ground station, pictures in build/run
	@grep -qx $(call quoted,CLK_HZ:STRING=$(CLK_HZ)) $(BUILD)/CMakeCache.txt || cmake/set.sh $(BUILD) $(call quoted,-DCLK_HZ=$(CLK_HZ))
	@$(NINJA) mission $(if $(filter minimal,$(APP)),firmware_minimal)
	@$(if $(REPLAY),exec testbench/sim/replay.sh "$(BUILD)" $(call quoted,$(REPLAY)) $(call quoted,$(OUT)) $(call quoted,$(FROM)) $(call quoted,$(TO));) \
	testbench/sim/run.sh "$(BUILD)" --app $(call quoted,$(APP)) --image $(call quoted,$(IMAGE)) --size $(call quoted,$(SIZE)) \
	    --threshold $(call quoted,$(THRESHOLD)) --loss $(call quoted,$(LOSS)) --seed $(call quoted,$(SEED)) --out $(call quoted,$(OUT)) \
	    --cpu $(call quoted,$(CPU)) --port $(call quoted,$(PORT)) $(if $(LIVE),--live 1) $(if $(CORES),--cores $(call quoted,$(CORES))) \
	    $(if $(CAMERA),--sensor 1) $(if $(PINS),--pins $(call quoted,$(PINS))) $(if $(KEY),--key $(call quoted,$(KEY))) $(if $(OPEN),--open 1) $(if $(UPDATE),--update $(call quoted,$(UPDATE))) $(if $(UCOS2),--firmware "$(BUILD)/firmware/uav_ucos2.elf")

test: setup-tests $(if $(filter-out zeroc,$(or $(LABEL),$(NAME:%=some))),$(BUILD)/build.ninja,build) ## run all tests; firmware, models and IceC once more with sanitizers
ifneq ($(LABEL)$(NAME),)
ifneq ($(LABEL),zeroc)
	@$(NINJA) --quiet regress
	@$(BUILD)/tests/regress/regress --prepare --build $(BUILD) $(if $(NAME),--name $(call quoted,$(NAME))) $(if $(LABEL),--label $(call quoted,$(LABEL)))
endif
	@SEED=$(SEED) tests/ctest.py --test-dir $(BUILD) -j $(TESTS) --output-on-failure --no-tests=error \
	    $(if $(LABEL),-L $(call quoted,$(LABEL))) $(if $(NAME),-R $(call quoted,$(NAME))) $(if $(filter zeroc,$(LABEL)),-C zeroc)
else
	@SEED=$(SEED) tests/ctest.py --test-dir $(BUILD) -j $(TESTS) --output-on-failure --no-tests=error
	@cmake/configure.sh build/sanitized -DSANITIZE=ON -DROOMS="bus;slice;sw;hdl;ip;testbench;tests" >/dev/null
	@cmake/ninja.sh build/sanitized -j $(JOBS) sanitized
	@SEED=$(SEED) tests/ctest.py --test-dir build/sanitized -j $(TESTS) --output-on-failure --no-tests=error -L sanitized
endif

mutants: setup-tests $(BUILD)/build.ninja ## plant every seeded bug of tests/mutants, expect its test to fail (BLOCK=bus, or BLOCK=bus/name); DRAW=20: of mutants that Yosys draws, 20 a proof
	@$(NINJA) regress $(if $(DRAW),regmaps)
	@$(if $(DRAW),tests/mutants/drawn.py --build $(BUILD) --number $(call quoted,$(DRAW)) --seed $(call quoted,$(SEED)),tests/mutants/run.py) --jobs $(JOBS) $(if $(BLOCK),--block $(call quoted,$(BLOCK)))

bench: $(BUILD)/build.ninja ## measure everything that has a figure (tests/bench), write build/bench/*.json and docs/figures.md
	@$(NINJA) bench_programs regress size
	@rm -rf build/bench && mkdir -p build/bench && $(BUILD)/tests/regress/regress --tree "bus hdl ip sw testbench tests" >build/bench/tree
	@$(NINJA) -j 1 -k 0 benches; status=$$?; tests/bench/figures.py docs/figures.md build/bench/*.json build/size.json && exit $$status

firmware: $(BUILD)/build.ninja ## the firmware for the STM32F2: ELF and map in build/main/firmware, table of flash, RAM and stacks
	@$(NINJA) firmware
	@sw/sizes.py firmware $(BUILD)/firmware/uav.map $(BUILD)/sw/target/uav.arm build/firmware.json

gdb: setup-tests $(BUILD)/build.ninja ## debug the firmware's ARM binary against the RTL with gdb-multiarch
	@$(NINJA) mission
	@mkdir -p "$(OUT)"
	@testbench/sim/gdb.sh "$(BUILD)" --out $(call quoted,$(OUT)) $(if $(REPLAY),--replay $(call quoted,$(REPLAY)),--cpu m3 --image $(call quoted,$(IMAGE)) \
	    --size $(call quoted,$(SIZE)) --seed $(call quoted,$(SEED)))

size: $(BUILD)/build.ninja ## bytes of each firmware layer on a Cortex-M3, beside the paper's
	@$(NINJA) size

clean: ## remove what was built
	rm -rf build

include $(wildcard */targets.mk) # what a room adds

# A variable that nobody reads is a typing error.
SPACE   := $(subst ,, )
COMMA   := ,
GIVEN   := $(foreach word,$(subst \$(SPACE),,$(MAKEOVERRIDES)),$(if $(findstring =,$(word)),$(firstword $(subst =, ,$(word)))))
UNKNOWN := $(filter-out LANG $(shell sed -n 's/^\([A-Z0-9_]*\) *?*=.*/\1/p' $(MAKEFILE_LIST)),$(GIVEN))
$(if $(UNKNOWN),$(error there is no variable $(UNKNOWN); `make help` names those that there are))
# A switch that is 0 is off.
$(foreach name,LIVE OPEN CAMERA CHANGED FAILED KEPT FRESH FORCE CHIP PLACE,$(if $(filter 0,$($(name))),$(eval override $(name) :=)))
# expr prints the length of the match.
fits     = $(filter-out 0,$(shell expr x$(call quoted,$(1)) : 'x$(2)$$'))
must     = $(foreach name,$(filter $(1),$(GIVEN)),$(if $(call fits,$($(name)),$(2)),,$(error $(name)='$($(name))' is not $(3))))
$(call must,JOBS TESTS FUZZED REPEAT NIGHTLY MOMENTS SEEDS DRAW,[1-9][0-9]*,a number from 1 on)
$(call must,WAVES,[0-9][0-9]*,a number from 0 on)
$(call must,SEED,[0-9]\{1$(COMMA)18\}$(if $(filter regress,$(MAKECMDGOALS)),$$\|xrandom),a whole number$(if $(filter regress,$(MAKECMDGOALS)), or random))
$(call must,MINUTES,[0-9]*[.]*[0-9]*[1-9][0-9]*,a number of minutes$(COMMA) such as 4 or 0.5)
