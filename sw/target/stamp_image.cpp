// SPDX-License-Identifier: MIT
//
// stamp_image: writes a firmware's checksum into its ELF file.

#include "elf_image.h"
#include <iostream>

int main(int argc, char** argv) {
    if (argc != 2 || std::string(argv[1]) == "--help") {
        std::cerr
            << "Usage: stamp_image firmware.elf\n"
               "Writes the CRC of the words image_begin .. image_end to the word at image_end.\n";
        return argc == 2 ? 0 : 2;
    }
    try {
        ElfImage(argv[1]).stamp();
    } catch (const std::exception& e) {
        std::cerr << "stamp_image: error: " << e.what() << "\n";
        return 1;
    }
}
