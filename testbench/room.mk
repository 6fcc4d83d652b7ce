# SPDX-License-Identifier: MIT
#
# The regression: the tests of `make test` with selection, history, waveforms of failures and a page.
BLOCK    ?=
REPEAT   ?= 1
WAVES    ?= 3
LAUNCHER ?= local
CHANGED  ?=
FAILED   ?=
KEPT     ?=
# Seeds that `make nightly` draws
NIGHTLY  ?= 3

regress: build ## run the regression, write build/regress/report.html (NAME= BLOCK= LABEL= CHANGED=1 FAILED=1 KEPT=1 SEED=n|random REPEAT=n LAUNCHER=slurm)
	@$(BUILD)/testbench/regress/regress --build $(BUILD) --jobs $(TESTS) --seed $(SEED) --repeat $(REPEAT) --waves $(WAVES) \
	    --launcher $(LAUNCHER) $(if $(NAME),--name '$(NAME)') $(if $(BLOCK),--block '$(BLOCK)') \
	    $(if $(LABEL),--label '$(LABEL)') $(if $(CHANGED),--changed) $(if $(FAILED),--rerun-failed) $(if $(KEPT),--kept)

# Failing seeds stay in build/regress/seeds.jsonl until their tests pass with them.
nightly: build ## what a timer runs: seeds that have failed, then the regression with fresh seeds (NIGHTLY=3 of them)
	@status=0; tool="$(BUILD)/testbench/regress/regress --build $(BUILD) --jobs $(TESTS) --waves $(WAVES) --launcher $(LAUNCHER)"; \
	    $$tool --kept $(if $(LABEL),--label '$(LABEL)') $(if $(NAME),--name '$(NAME)') || status=$$?; \
	    $$tool --seed random --repeat $(NIGHTLY) $(if $(LABEL),--label '$(LABEL)') $(if $(NAME),--name '$(NAME)') || status=$$?; \
	    exit $$status

proofs: $(BUILD)/build.ninja ## run all formal proofs, print the processor time of all together
	@ninja -C $(BUILD) -j $(JOBS) regmaps
	@ctest --test-dir $(BUILD) -j $(JOBS) --output-on-failure --no-tests=error -L formal
	@cat $(BUILD)/tests/hdl/formal/*/cpu | awk '{ n += $$1 } END { printf "%d proofs, %.0f s of a processor\n", NR, n }'

# Gates: testbench/regress/coverage_gates.json
coverage: $(BUILD)/build.ninja ## lines, branches and toggles that the tests reach, write build/coverage/html
	@ninja -C $(BUILD) -j $(JOBS) coverage
	@testbench/regress/coverage.sh $(BUILD) $(JOBS)

.PHONY: regress nightly proofs coverage
