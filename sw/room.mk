# SPDX-License-Identifier: MIT
#
# MINUTES=60 goes on for an hour
MINUTES ?= 3

soak: $(BUILD)/build.ninja ## endurance of the radio link: MINUTES=3 of random messages, bad weather, reboots; SEED=1
	@ninja -C $(BUILD) -j $(JOBS) --quiet soak
	@$(BUILD)/tests/soak/soak --minutes $(MINUTES) --seed $(SEED)
.PHONY: soak
