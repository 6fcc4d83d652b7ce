# SPDX-License-Identifier: MIT
#
# verilated_header.mk: precompiles the header of Verilator's run-time library with the flags of
# Verilator's makefiles. TO is the result; CXX, OPT_FAST and USER_CPPFLAGS are those of the models.
# The result contains the path of its folder, so ccache compares TO.sum instead, which is the same
# in all clones.
header := $(VERILATOR_ROOT)/include/verilated.h

$(TO): $(header)
	$(CXX) --version >$@.text
	$(CXX) $(CXXFLAGS) $(CPPFLAGS) $(OPT_FAST) -x c++-header -E $(header) >>$@.text
	sha256sum <$@.text >$@.sum
	$(CXX) $(CXXFLAGS) $(CPPFLAGS) $(OPT_FAST) -x c++-header -o $@ $(header)
	rm $@.text

include $(VERILATOR_ROOT)/include/verilated.mk
# The makefile of a model sets all variables VM_* that define a macro, to 0 for a model without
# traces and coverage. Which variables these are depends on Verilator's version. The macros must be
# the same here, because clang rejects a precompiled header with other macros. MMD is left out,
# because lists of headers would be written to the current folder.
CPPFLAGS := $(patsubst -DVM_%=,-DVM_%=0,$(filter-out -MMD,$(CPPFLAGS)))
