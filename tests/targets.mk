# SPDX-License-Identifier: MIT

# MINUTES=60 goes on for an hour: half of it the link alone (half of that under attack), then as many simulated seconds of stock
# Ice through the plugin to IceC on the chip's RTL. Then noise follows: FUZZED bytes into the modem controller's UART
# (10,000,000 take 5 minutes of a core), ten times as many into the link layer and the plugin's engine.
MINUTES ?= 4
FUZZED  ?= 1000000
quarter := $$(echo $(MINUTES) | awk '{print $$1 / 4}')
seconds := $$(echo $(MINUTES) | awk '{print $$1 * 30}')

soak: $(BUILD)/build.ninja ## endurance of the radio: MINUTES=4 of messages and of stock Ice's calls, bad weather, reboots; FUZZED=1000000 bytes of noise; SEED=1
	@$(NINJA) --quiet soak test_chip_soak test_engine test_modem_soak test_link
	@$(BUILD)/tests/soak/soak --minutes $(quarter) --seed $(SEED)
	@$(BUILD)/tests/soak/soak --minutes $(quarter) --seed $(SEED) --attacked
	@SEED=$(SEED) SOAK_SECONDS=$(seconds) $(BUILD)/tests/sw/ground/chip/test_chip_soak --gtest_brief=1
	@SEED=$(SEED) BYTES=$(FUZZED)0 $(BUILD)/tests/sw/link/test_link --gtest_brief=1 --gtest_filter='*TenMillion*'
	@SEED=$(SEED) BYTES=$(FUZZED)0 $(BUILD)/tests/sw/ground/test_engine --gtest_brief=1 --gtest_filter='Engine.RandomBytes*'
	@SEED=$(SEED) SOAK_BYTES=$(FUZZED) $(BUILD)/tests/hdl/modem/test_modem_soak --gtest_brief=1
.PHONY: soak

# Simulated time: an hour of it is minutes of a processor.
fly: $(BUILD)/build.ninja ## a long flight: MINUTES=4 of stock Ice's calls now and then, loss, reboots of UAV, modems and ground; SEED=1
	@$(NINJA) --quiet test_chip_soak
	@SEED=$(SEED) SOAK_REST=10 SOAK_SECONDS=$$(echo $(MINUTES) | awk '{print $$1 * 60}') $(BUILD)/tests/sw/ground/chip/test_chip_soak --gtest_brief=1
.PHONY: fly

# The regression: the tests of `make test` with selection, history, waveforms of failures and a page.
BLOCK    ?=
REPEAT   ?= 1
WAVES    ?= 3
CHANGED  ?=
FAILED   ?=
KEPT     ?=
# Seeds that `make nightly` draws
NIGHTLY  ?= 3

regress: setup-tests $(BUILD)/build.ninja ## run the regression, write build/regress/report.html (NAME= BLOCK= LABEL= CHANGED=1 FAILED=1 KEPT=1 SEED=n|random REPEAT=n)
	@$(NINJA) --quiet regress
	@$(BUILD)/tests/regress/regress --make --build $(BUILD) --jobs $(TESTS) --seed $(SEED) --repeat $(REPEAT) --waves $(WAVES) \
	    $(if $(NAME),--name $(call quoted,$(NAME))) $(if $(BLOCK),--block $(call quoted,$(BLOCK))) \
	    $(if $(LABEL),--label $(call quoted,$(LABEL))) $(if $(CHANGED),--changed) $(if $(FAILED),--rerun-failed) $(if $(KEPT),--kept)

# TEST=test_fifo.Fifo.Wraps GOOD=commit that it passed at (the last one noted) BAD=HEAD
TEST ?=
GOOD ?=
BAD  ?= HEAD
bisect: setup-tests $(BUILD)/build.ninja ## find the commit since which a test fails: TEST=test_fifo.Fifo.Wraps (GOOD=commit BAD=commit SEED=n)
	@$(NINJA) --quiet regress
	@tests/regress/bisect.sh $(BUILD)/tests/regress/regress $(call quoted,$(TEST)) $(call quoted,$(GOOD)) $(call quoted,$(BAD)) $(call quoted,$(SEED)) $(JOBS)

# build/sanitized is that of make test. ThreadSanitizer leaves out what Python loads: Python's own locks are not built with it.
ROOMS_OF_PROGRAMS = bus;slice;sw;hdl;ip;testbench;tests
GUARDED = test_engine gateway test_radio_ice
sanitizers: setup-tests $(BUILD)/build.ninja ## tests of engine, gateway and plugin with AddressSanitizer and with ThreadSanitizer; fuzzer of the debugger's stub
	@cmake/configure.sh build/sanitized -DSANITIZE=ON -DROOMS="$(ROOMS_OF_PROGRAMS)" >/dev/null
	@cmake/configure.sh build/thread -DSANITIZE=thread -DROOMS="$(ROOMS_OF_PROGRAMS)" >/dev/null
	@ASAN_OPTIONS=detect_leaks=0 cmake/ninja.sh build/sanitized -j $(JOBS) $(GUARDED) # libmcpp leaks
	@cmake/ninja.sh build/thread -j $(JOBS) $(GUARDED)
	@$(NINJA) fuzz_gdb
	@status=0; for build in sanitized thread; do for test in test_engine ice/test_radio_ice; do \
	    ASAN_OPTIONS=detect_leaks=0 TSAN_OPTIONS=suppressions=$(CURDIR)/tests/sw/ground/threads.supp \
	    build/$$build/tests/sw/ground/$$test --gtest_brief=1 $$([ $$build != thread ] || echo --gtest_filter=-*Python*) || status=1; done; done; \
	    ctest --test-dir $(BUILD) -R '^fuzz[.]gdb$$' --output-on-failure || status=1; exit $$status

# Not by $$(MAKE), which `make -n` would carry out, and the whole line with it.
# Failing seeds stay in build/regress/seeds.jsonl until their tests pass with them. COMPARE_MS: test_quiet compares a second; FUZZ: times as many inputs of fuzzers; HOSTILE: packets of test_link.
nightly: setup-tests build ## what a timer runs: seeds that have failed, the regression with fresh seeds (NIGHTLY=3 of them), ZeroC's own suites, faults, sanitizers
	@status=0; export FRESH=1 FUZZ=10 COMPARE_MS=1000 HOSTILE=10000000; tool="$(BUILD)/tests/regress/regress --build $(BUILD) --jobs $(TESTS) --waves $(WAVES)"; \
	    $$tool --kept $(if $(LABEL),--label $(call quoted,$(LABEL))) $(if $(NAME),--name $(call quoted,$(NAME))) || status=$$?; \
	    $$tool --seed random --repeat $(NIGHTLY) $(if $(LABEL),--label $(call quoted,$(LABEL))) $(if $(NAME),--name $(call quoted,$(NAME))) || status=$$?; \
	    ctest --test-dir $(BUILD) -C zeroc -L zeroc -j $(TESTS) --output-on-failure || status=$$?; \
	    make mutants DRAW=8 SEED=$$(date +%Y%m%d) || status=$$?; make faults SEED=$$(date +%Y%m%d) || status=$$?; make sanitizers || status=$$?; \
	    ctest --test-dir $(BUILD) -C nightly -L nightly -j $(TESTS) --output-on-failure || status=$$?; \
	    exit $$status

# MOMENTS of each fault are drawn from each of SEEDS seeds, the first of which is SEED. Tools are interrupted for the first.
MOMENTS ?= 10
SEEDS   ?= 1
faults: $(BUILD)/build.ninja ## kill, stop and starve each process of a mission at ten moments drawn from a seed (MOMENTS=10 SEED=1 SEEDS=1 NAME=killed), expect docs/regression.md
	@$(NINJA) mission clock_step regress utilisation regmaps
	@[ -n $(call quoted,$(NAME)) ] || SEED=$(SEED) tests/regress/test/interrupted.py . "$(BUILD)" build/faults/interrupted $(MOMENTS) new_ip regress synth
	@/usr/bin/python3 tests/e2e/mission/faults.py "$(CURDIR)" "$(BUILD)" build/faults/missions --seed $(SEED) --seeds $(SEEDS) --moments $(MOMENTS) \
	    --jobs $(JOBS) --deaths 2 $(if $(NAME),--only $(call quoted,$(NAME)))

proofs: $(BUILD)/build.ninja ## run all formal proofs, print the processor time of all together
	@$(NINJA) regmaps
	@FRESH=1 ctest --test-dir $(BUILD) -j $(JOBS) --output-on-failure --no-tests=error -L formal
	@cat $(BUILD)/tests/hdl/formal/*/cpu | awk '{ n += $$1 } END { printf "%d proofs, %.0f s of a processor\n", NR, n }'

# Gates: tests/regress/coverage_gates.json
coverage: setup-tests $(BUILD)/build.ninja ## lines, branches and toggles that the tests reach, write build/coverage/html
	@$(NINJA) coverage regress
	@tests/regress/coverage.sh $(BUILD) $(JOBS)

.PHONY: regress bisect nightly sanitizers faults proofs coverage
