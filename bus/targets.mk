# SPDX-License-Identifier: MIT
BASE ?=
contract-diff: $(BUILD)/build.ninja ## what changed in the cores' registers since a commit: BASE=commit; exit status 1: software of then would break
	@$(NINJA) --quiet slice2c
	@bus/contract_diff.py $(BUILD)/slice/slice2c . $(call quoted,$(BASE))
.PHONY: contract-diff
