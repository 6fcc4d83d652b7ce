// SPDX-License-Identifier: MIT
//
// environment: numbers with which a developer makes a test run longer, from environment variables.

#pragma once

#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>

// Returns the number in an environment variable, or `usual` if it is missing or empty. Throws if
// the variable contains anything but a number of at least 0.
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
