# SPDX-License-Identifier: MIT
#
# model.mk: compiles a Verilated model, in the folder that Verilator has written. CLASS is the class
# of the model, for example VSoc. STATE is the name of the file that lists the signals of the model
# (state_members.awk), without .cpp; it is empty for a model without such a file.
#
# Each file of a model includes the header of the model's state, and reading this header takes
# longer than compiling a small file. Therefore all small files, and all code that runs only once,
# are compiled as one file. Large files are compiled separately, at the same time. Code that runs
# only once is not optimised: with -O1, compiling it took half of the time after an edit, and
# minutes with coverage counters. With g++ this needs a second file, because g++ warns about
# functions that are declared with other options than defined.

include $(CLASS)_classes.mk # CLASS.mk includes it again, and adds to variables without override
large := $(filter $(VM_CLASSES_FAST),\
  $(basename $(shell find -maxdepth 1 -name '*.cpp' -size +96k -printf '%f\n')))
small := $(filter-out $(large),$(VM_CLASSES_FAST) $(VM_SUPPORT_FAST))
once := $(VM_CLASSES_SLOW) $(VM_SUPPORT_SLOW) $(STATE)
is_clang := $(findstring clang,$(CXX))
objects := $(addsuffix .o,$(large) $(CLASS)_rest $(if $(is_clang),,$(CLASS)_once))

# Verilator's makefile then compiles none of the files itself; newer versions would use precompiled
# headers that contain the state of the model.
override VM_CLASSES_FAST :=
override VM_CLASSES_SLOW :=
override VM_SUPPORT_FAST :=
override VM_SUPPORT_SLOW :=
override VM_GLOBAL_FAST :=
override VM_PARALLEL_BUILDS := 1
include $(CLASS).mk

$(CLASS)__ALL.a: $(objects)
$(CLASS)_once.o: override OPT_FAST = -O0
$(CLASS)_rest.cpp: $(addsuffix .cpp,$(small) $(once))
	printf '#include "%s.cpp"\n' $(small) >$@
	$(if $(is_clang),printf '#pragma clang optimize off\n' >>$@)
	$(if $(is_clang),printf '#include "%s.cpp"\n' $(once) >>$@)
$(CLASS)_once.cpp: $(addsuffix .cpp,$(once))
	printf '#include "%s.cpp"\n' $(once) >$@
