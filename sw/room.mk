# SPDX-License-Identifier: MIT
#
# MINUTES=60 goes on for an hour: a third the link alone, a third stock Ice through the plugin to a stock server, a third
# to IceC on the chip's RTL (there simulated seconds). Then noise:
# FUZZED bytes into the modem controller's UART (10,000,000 take 5 minutes of a core), 10,000,000 into
# the link layer and the plugin's engine.
MINUTES ?= 4
FUZZED  ?= 1000000
third   := $$(echo $(MINUTES) | awk '{print $$1 / 3}')
seconds := $$(echo $(MINUTES) | awk '{print $$1 * 20}')

soak: $(BUILD)/build.ninja ## endurance of the radio: MINUTES=4 of messages and of stock Ice's calls, bad weather, reboots; FUZZED=1000000 bytes of noise; SEED=1
	@ninja -C $(BUILD) -j $(JOBS) --quiet soak test_radio_ice test_chip_soak test_engine test_modem_soak test_link
	@$(BUILD)/tests/soak/soak --minutes $(third) --seed $(SEED)
	@SEED=$(SEED) SOAK_SECONDS=$(seconds) $(BUILD)/tests/ground/ice/test_radio_ice --gtest_brief=1 --gtest_filter='IceSoak*'
	@SEED=$(SEED) SOAK_SECONDS=$(seconds) $(BUILD)/tests/ground/chip/test_chip_soak --gtest_brief=1
	@SEED=$(SEED) $(BUILD)/tests/sw/link/test_link --gtest_brief=1 --gtest_filter='*TenMillion*'
	@SEED=$(SEED) $(BUILD)/tests/ground/test_engine --gtest_brief=1 --gtest_filter='Engine.RandomBytes*'
	@SEED=$(SEED) SOAK_BYTES=$(FUZZED) $(BUILD)/tests/hdl/modem/test_modem_soak --gtest_brief=1
.PHONY: soak
