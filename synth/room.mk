# SPDX-License-Identifier: MIT
#
# DESIGN=modem one design only; FAMILY=xc6s one chip family only
DESIGN ?=
FAMILY ?=

synth: $(BUILD)/build.ninja ## utilisation: LUTs, flip-flops, slices of the chip and each part, against limits and paper
	@flock $(BUILD) ninja -C $(BUILD) -j $(JOBS) --quiet synth_inputs
	@$(BUILD)/synth/utilisation --generated $(BUILD)/gen --jobs $(JOBS) \
	    $(DESIGN:%=--design %) $(FAMILY:%=--family %)
.PHONY: synth

synth-accept: $(BUILD)/build.ninja ## record today's utilisation as what is wanted (synth/baseline.json)
	@flock $(BUILD) ninja -C $(BUILD) -j $(JOBS) --quiet synth_inputs
	@$(BUILD)/synth/utilisation --generated $(BUILD)/gen --jobs $(JOBS) --accept --family xc6s $(DESIGN:%=--design %)
.PHONY: synth-accept

synth-edif: $(BUILD)/build.ninja ## the chip as EDIF for Xilinx ISE, in build/synth/ise (DESIGN=soc)
	@flock $(BUILD) ninja -C $(BUILD) -j $(JOBS) --quiet synth_inputs
	@$(BUILD)/synth/utilisation --generated $(BUILD)/gen --edif $(or $(DESIGN),soc)
.PHONY: synth-edif
