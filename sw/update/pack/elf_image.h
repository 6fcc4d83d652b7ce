// SPDX-License-Identifier: MIT
//
// elf_image: reads a program for the Cortex-M3 from its ELF file: its bytes in flash, its symbols,
// and its checksum.

#pragma once

#include <cstdint>
#include <elf.h>
#include <map>
#include <string>
#include <vector>

// Returns the bytes of a file. Throws std::runtime_error if the file cannot be read; `what`
// describes the file, such as "firmware".
std::vector<uint8_t> readBytes(const std::string& what, const std::string& path);

class ElfImage {
public:
    // Reads the file. Throws std::runtime_error with the reason if the file cannot be used.
    explicit ElfImage(const std::string& path);

    struct Segment {
        uint32_t address; // load address, in flash
        uint32_t runAt;   // address at run time; the initial values of variables are copied to RAM
        uint32_t offset;  // offset in the file
        std::vector<uint8_t> bytes;
    };
    const std::vector<Segment>& segments() const { return segments_; }
    bool has(const std::string& symbol) const { return symbols_.count(symbol) != 0; }
    // Returns the value of a symbol. Throws std::runtime_error if no such symbol exists.
    uint32_t symbol(const std::string& name) const;
    uint32_t size(const std::string& name) const { return sizes_.at(name); }
    // Returns the name of the function at an address; "?" if the address is in no function.
    std::string functionAt(uint32_t address) const;

    // Writes the checksum of the words image_begin .. image_end into the file, at image_end.
    void stamp() const;

    // Returns the image (the bytes of flash from image_begin to the checksum), relocated to another
    // address. The program must have been linked with --emit-relocs.
    std::vector<uint8_t> movedTo(uint32_t address) const;

private:
    struct Relocation {
        // at: address in the running program. type: as in <elf.h>. symbol: value of the symbol.
        uint32_t at, type, symbol;
    };
    void readRelocations(const std::vector<uint8_t>& file, const Elf32_Ehdr& header,
                         const Elf32_Shdr& section);
    std::vector<uint8_t> image() const; // Returns the image as it is in the file.

    std::string path_;
    std::vector<Segment> segments_;
    std::vector<Relocation> relocations_;
    std::map<std::string, uint32_t> symbols_, sizes_;
    std::map<uint32_t, std::string> functions_;
};
