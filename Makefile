# SPDX-License-Identifier: MIT
#
# Makefile: a door to ./icesoc. `make VERB VARIABLE=value` is `./icesoc VERB --variable value`, and `make` lists all verbs.
# Verbs and values reach it in the environment: none is a word of a shell.

.DEFAULT_GOAL := help
.SUFFIXES:
MAKEFLAGS += --no-builtin-rules
unexport MAKEFILES
export ICESOC_GOALS := $(MAKECMDGOALS)
%: export ICESOC_GOAL = $@

# Whatever the goal is, and whether there is a file of its name or not. An empty Debian has no Python yet.
%: always
	@[ -x /usr/bin/python3 ] || cmake/setup.sh
	@./icesoc

always: ;
Makefile: ;
.PHONY: always
