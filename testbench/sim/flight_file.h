// SPDX-License-Identifier: MIT
//
// flight_file: the description of a flight, of a file (flight.json) and of words "--name value".
//
// The schema of the file, which ./icesoc writes of its own options, says which fields there are,
// their types and limits.

#ifndef FLIGHT_FILE_H
#define FLIGHT_FILE_H

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

// Reads words up to "--". "--flight FILE" takes all fields of a file, a word behind it one more.
// Throws std::invalid_argument, which names the word, if one is wrong.
nlohmann::json flightOf(const std::vector<std::string>& words);

// Returns a text that names all fields.
std::string flightHelp();

#endif
