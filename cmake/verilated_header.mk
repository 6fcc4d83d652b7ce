# SPDX-License-Identifier: MIT
#
# verilated_header.mk: precompiles the header of Verilator's run-time library with the flags of
# Verilator's makefiles. TO is the result; CXX, OPT_FAST and USER_CPPFLAGS are those of the models.
# The result contains the path of its folder, so ccache compares TO.sum instead, which is the same
# in all clones.
VM_COVERAGE = 0
VM_SC = 0
VM_TRACE = 0
VM_TRACE_FST = 0
VM_TRACE_VCD = 0
header := $(VERILATOR_ROOT)/include/verilated.h

$(TO): $(header)
	$(CXX) --version >$@.text
	$(CXX) $(CXXFLAGS) $(CPPFLAGS) $(OPT_FAST) -x c++-header -E $(header) >>$@.text
	sha256sum <$@.text >$@.sum
	$(CXX) $(CXXFLAGS) $(CPPFLAGS) $(OPT_FAST) -x c++-header -o $@ $(header)
	rm $@.text

include $(VERILATOR_ROOT)/include/verilated.mk
# lists of headers would be written to the current folder
CPPFLAGS := $(filter-out -MMD,$(CPPFLAGS))
