# SPDX-License-Identifier: MIT
#
# DESIGN=modem: one design only, of the others what is known; FAMILY="xc7 ecp5": these chips, too
DESIGN ?=
FAMILY ?=
# PLACE=1: on ECP5 also placed and routed, by nextpnr of Debian 13; DESIGN= or Table I's content and the chip
PLACE  ?=
# BASE=main: and what has changed since that commit, as Markdown; BASE=v1..main: only what has changed between these
BASE   ?=

synth: setup-tests $(BUILD)/build.ninja ## utilisation: LUTs, flip-flops, slices of the chip and each part, against limits and paper (DESIGN=modem FAMILY=xc7 PLACE=1 BASE=main BASE=v1..main)
	@$(NINJA) --quiet synth_inputs
	@$(if $(findstring ..,$(BASE)),exec synth/compare.sh $(BUILD)/synth/utilisation $(call quoted,$(BASE)) $(JOBS);) \
	$(if $(BASE),git rev-parse --verify -q $(call quoted,$(BASE)^{commit}) >/dev/null || { echo "synth: there is no commit BASE="$(call quoted,$(BASE)) >&2; exit 2; };) \
	$(if $(PLACE),cmake/fetch.py nextpnr $(BUILD)/nextpnr &&) \
	$(BUILD)/synth/utilisation --generated $(BUILD)/gen --jobs $(JOBS) \
	    $(addprefix --design ,$(or $(DESIGN),$(PLACE:%=table1 soc))) $(addprefix --family ,$(FAMILY)) \
	    $(PLACE:%=--place $(BUILD)/nextpnr/nextpnr-ecp5); status=$$?; \
	$(if $(BASE),[ $$status -gt 1 ] || synth/compare.sh $(BUILD)/synth/utilisation $(call quoted,$(BASE)) $(JOBS) || exit;) exit $$status
.PHONY: synth

synth-accept: $(BUILD)/build.ninja ## record today's utilisation as what is wanted (synth/baseline.json)
	@$(NINJA) --quiet synth_inputs
	@$(BUILD)/synth/utilisation --generated $(BUILD)/gen --jobs $(JOBS) --accept $(DESIGN:%=--design %)
.PHONY: synth-accept

synth-edif: $(BUILD)/build.ninja ## the chip as EDIF for Xilinx ISE, in build/synth/ise (DESIGN=soc)
	@$(NINJA) --quiet synth_inputs
	@$(BUILD)/synth/utilisation --generated $(BUILD)/gen --edif $(or $(DESIGN),soc)
.PHONY: synth-edif
