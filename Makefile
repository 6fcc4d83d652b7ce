# SPDX-License-Identifier: MIT
#
# Makefile: `make VERB VARIABLE=value` runs `./icesoc VERB --variable value`; `make` lists the verbs.
# Verbs and values are passed in the environment, so that no shell reads them.

.DEFAULT_GOAL := help
.SUFFIXES:
MAKEFLAGS += --no-builtin-rules
unexport MAKEFILES
# GNU make expands a variable of its command line when it exports the variable, so a $(shell ...) in
# the value would run. The lines below first turn each value into literal text. The command line
# cannot set a variable with the name of the loop's variable, which is "each=".
$(foreach each=,$(.VARIABLES),$(if $(filter command,$(firstword $(origin $(each=)))),\
    $(eval export override $(each=) := $$(value $(each=)))))
export ICESOC_GOALS := $(MAKECMDGOALS)
%: export ICESOC_GOAL = $@

# This rule applies to every goal, even if a file has the name of the goal.
%: always
	@./icesoc

always: ;
Makefile: ;
.PHONY: always
