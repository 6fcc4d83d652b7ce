// SPDX-License-Identifier: MIT
//
// fir_vectors: writes random coefficients and samples, and the results of the model, for the VHDL
// test bench. Usage: fir_vectors FOLDER SEED. Writes FOLDER/vectors.txt. For each round the file
// contains the shift, the 16 coefficients, the number of samples, and one line "sample result" per
// sample.

#include "fir_model.h"
#include "random.h"
#include <cstdlib>
#include <fstream>
#include <string>

int main(int argc, char** argv) {
    if (argc != 3)
        return 2;
    std::ofstream vectors(std::string(argv[1]) + "/vectors.txt");
    Random random(std::strtoull(argv[2], nullptr, 0));
    for (int round = 0; round < 24; ++round) {
        FirModel model;
        model.shift = round < 3 ? static_cast<unsigned>(round) * 15 : random.below(32);
        vectors << model.shift << "\n";
        for (auto& c : model.coefficients) {
            c = round % 4 == 0 ? -131072 : static_cast<int32_t>(random.below(262144)) - 131072;
            vectors << c << "\n";
        }
        int count = static_cast<int>(20 + random.below(60));
        vectors << count << "\n";
        for (int i = 0; i < count; ++i) {
            auto sample = static_cast<int16_t>(round % 4 == 0 ? -32768 : random.next());
            vectors << sample << " " << model.step(sample) << "\n";
        }
    }
    return vectors ? 0 : 1;
}
