# SPDX-License-Identifier: MIT
#
# Makefile: `make VERB VARIABLE=value` runs `./icesoc VERB --variable value`; `make` lists the verbs.
# Verbs and values are passed in the environment, so that no shell reads them.

.DEFAULT_GOAL := help
.SUFFIXES:
MAKEFLAGS += --no-builtin-rules
unexport MAKEFILES
# GNU make expands the variables of its command line when it exports them, and would run $(shell ...)
# in a value. Each is replaced by its text as it was written.
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
