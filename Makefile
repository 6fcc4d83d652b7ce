# SPDX-License-Identifier: MIT
#
# Makefile: `make VERB VARIABLE=value` runs `./icesoc VERB --variable value`; `make` lists the verbs.
# Verbs and values are passed in the environment, so that no shell reads them.

.DEFAULT_GOAL := help
.SUFFIXES:
MAKEFLAGS += --no-builtin-rules
unexport MAKEFILES
# When GNU make exports a variable from its command line, it expands the value, and so would run a
# $(shell ...) in it. The lines below make each value literal text first.
$(foreach v,$(.VARIABLES),$(if $(filter command,$(firstword $(origin $v))),\
    $(eval export override $v := $$(value $v))))
export ICESOC_GOALS := $(MAKECMDGOALS)
%: export ICESOC_GOAL = $@

# Runs for every goal, whether or not a file has its name. An empty Debian has no Python yet.
%: always
	@[ -x /usr/bin/python3 ] || cmake/setup.sh
	@./icesoc

always: ;
Makefile: ;
.PHONY: always
