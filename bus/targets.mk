# SPDX-License-Identifier: MIT
BASE ?=
contract-diff: $(BUILD)/build.ninja ## what changed in the cores' registers since a commit: BASE=commit; exit status 1: software of then would break
	@$(NINJA) --quiet slice2c
	@bus/contract_diff.py $(BUILD)/slice/slice2c . $(call quoted,$(BASE))
.PHONY: contract-diff

RDL ?=
from-rdl: ## register descriptions (*.regs.json) of SystemRDL: RDL=spi.rdl OUT=ip/spi
	@bus/rdl.py $(call quoted,$(RDL)) $(call quoted,$(OUT))
.PHONY: from-rdl
