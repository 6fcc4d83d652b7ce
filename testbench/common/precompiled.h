// SPDX-License-Identifier: MIT
//
// precompiled: headers that the tests of cores include. The build precompiles them, because
// compiling them took most of the compile time of a test (icesoc_core_program).

#pragma once

#include <deque>
#include <functional>
#include <gtest/gtest.h>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <unordered_map>
#include <vector>
#include <verilated.h>
