# SPDX-License-Identifier: MIT
#
# Cores: begin one, test one, take one away (docs/recipes.md).
IP ?=

new-ip: ## begin a core: NAME=fir LANG=verilog|vhdl writes ip/fir, which builds and passes its test
	@ip/new.sh '$(NAME)' '$(LANG)' '$(BUILD)'
.PHONY: new-ip

ip-test: $(BUILD)/build.ninja ## build and test one core: IP=fir
	@[ -n '$(IP)' ] && [ -f 'ip/$(IP)/$(IP).ice' ] || { echo "ip-test: IP=name of a core with ip/name/name.ice, not '$(IP)'" >&2; exit 1; }
	@ninja -C $(BUILD) -j $(JOBS) --quiet 'test_ip_$(IP)'
	@SEED=$(SEED) ctest --test-dir $(BUILD) --output-on-failure --no-tests=error -R '^test_ip_$(IP)[.]'
.PHONY: ip-test
