// SPDX-License-Identifier: MIT
//
// biquad_vectors: rounds of random coefficients and samples with the model's results, for the VHDL
// test bench. Usage: biquad_vectors folder seed. Writes vectors.txt, for each round: 0 goes on, 1
// clears, 2 resets; sections in use from this round on, as bits, with five coefficients for each;
// the number of samples, and a line "sample result sections-that-were-kept" for each.

#include "biquad_model.h"
#include "random.h"
#include <cstdlib>
#include <fstream>
#include <string>

int main(int argc, char** argv) {
    if (argc != 3)
        return 2;
    std::ofstream vectors(std::string(argv[1]) + "/vectors.txt");
    Random random(std::strtoull(argv[2], nullptr, 0));
    BiquadModel model;
    for (unsigned round = 0; round < 48; ++round) {
        unsigned how = round == 0 ? 2 : random.below(3);
        if (how == 2)
            model = BiquadModel();
        else if (how == 1)
            model.clear();
        unsigned sections = round == 0 ? 0 : random.below(16); // samples pass first
        vectors << how << "\n" << sections << "\n";
        // Now and then the largest, else random ones, half of them with feedback that keeps values
        // small.
        unsigned kind = random.below(5);
        for (size_t s = 0; s < BiquadModel::sections; ++s) {
            if (!(sections >> s & 1))
                continue;
            model.cascade[s].isUsed = true;
            for (size_t k = 0; k < 5; ++k) {
                int32_t c = static_cast<int32_t>(random.below(262144)) - 131072;
                if (kind == 0)
                    c = k < 3 ? -131072 : 131071;
                else if (kind >= 3 && k >= 3)
                    c /= 8;
                model.cascade[s].coefficients[k] = c;
                vectors << c << "\n";
            }
        }
        unsigned count = 8 + random.below(32);
        vectors << count << "\n";
        for (unsigned i = 0; i < count; ++i) {
            auto sample =
                static_cast<int16_t>(kind == 0 ? (i % 2 ? -32768 : 32767) : random.next());
            unsigned before = model.saturations;
            int16_t result = model.step(sample);
            vectors << sample << " " << result << " " << model.saturations - before << "\n";
        }
    }
    return vectors ? 0 : 1;
}
