// SPDX-License-Identifier: MIT
//
// fir_vectors: rounds of random coefficients and samples with the model's results, for the VHDL
// test bench. Usage: fir_vectors seed. Prints for each round: the shift, 16 coefficients, the
// number of samples, and a line "sample result" for each.

#include "fir_model.h"
#include "random.h"
#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: fir_vectors seed\n");
        return 2;
    }
    Random random(std::strtoull(argv[1], nullptr, 0));
    for (int round = 0; round < 24; ++round) {
        FirModel model;
        model.shift = round < 3 ? static_cast<unsigned>(round) * 15 : random.below(32);
        std::printf("%u\n", model.shift);
        for (auto& c : model.coefficients) {
            c = round % 4 == 0 ? -131072 : static_cast<int32_t>(random.below(262144)) - 131072;
            std::printf("%d\n", c);
        }
        int count = static_cast<int>(20 + random.below(60));
        std::printf("%d\n", count);
        for (int i = 0; i < count; ++i) {
            auto sample = static_cast<int16_t>(round % 4 == 0 ? -32768 : random.next());
            std::printf("%d %d\n", sample, model.step(sample));
        }
    }
    return 0;
}
