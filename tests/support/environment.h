// SPDX-License-Identifier: MIT
//
// environment: reads numbers from environment variables, with which a developer can make a test run
// longer.

#pragma once

#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>

// Returns the number in an environment variable, or `usual` if the variable is missing or empty.
// Throws if the variable does not contain a number of at least 0.
inline double numberFromEnvironment(const char* name, double usual) {
    const char* text = std::getenv(name);
    if (!text || !*text)
        return usual;
    char* end = nullptr;
    const double number = std::strtod(text, &end);
    if (*end || !std::isfinite(number) || number < 0)
        throw std::invalid_argument(std::string(name) + ": expected a number of at least 0, got " +
                                    text);
    return number;
}
