// SPDX-License-Identifier: MIT
//
// elf_image: reads ELF files with the structures of <elf.h>; works only on little-endian hosts.

#include "elf_image.h"
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace {

template <class T> T at(const std::vector<uint8_t>& file, size_t offset) {
    T value;
    if (offset + sizeof value > file.size())
        throw std::runtime_error("the file ends too early");
    std::memcpy(&value, file.data() + offset, sizeof value);
    return value;
}

// Returns the CRC over all words of an image except the last word, which contains the CRC. The CRC
// is computed as in the STM32's CRC unit (RM0033, 3.2).
uint32_t checksum(const std::vector<uint8_t>& image) {
    uint32_t crc = 0xFFFFFFFF;
    for (size_t offset = 0; offset + 4 < image.size(); offset += 4) {
        crc ^= at<uint32_t>(image, offset);
        for (int bit = 0; bit < 32; ++bit)
            crc = crc & 0x80000000 ? crc << 1 ^ 0x04C11DB7 : crc << 1;
    }
    return crc;
}

} // namespace

std::vector<uint8_t> readBytes(const std::string& what, const std::string& path) {
    const auto fail = [&](const std::string& why) {
        throw std::runtime_error("cannot read " + what + " '" + path + "': " + why);
    };
    if (std::filesystem::is_directory(path))
        fail("it is a folder");
    std::ifstream in(path, std::ios::binary);
    if (!in)
        fail(std::strerror(errno));
    return {std::istreambuf_iterator<char>(in), {}};
}

ElfImage::ElfImage(const std::string& path) : path_(path) {
    if (!std::filesystem::exists(path))
        throw std::runtime_error("cannot read firmware '" + path +
                                 "'; ./icesoc build firmware builds it");
    const std::vector<uint8_t> file = readBytes("firmware", path);
    try {
        auto header = at<Elf32_Ehdr>(file, 0);
        if (std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0 ||
            header.e_ident[EI_CLASS] != ELFCLASS32 || header.e_ident[EI_DATA] != ELFDATA2LSB ||
            header.e_machine != EM_ARM)
            throw std::runtime_error("not a 32-bit ARM ELF file");
        for (unsigned i = 0; i < header.e_phnum; ++i) {
            auto p = at<Elf32_Phdr>(file, header.e_phoff + i * sizeof(Elf32_Phdr));
            if (p.p_type != PT_LOAD || p.p_filesz == 0)
                continue;
            if (size_t(p.p_offset) + p.p_filesz > file.size())
                throw std::runtime_error("the file ends too early");
            auto begin = file.begin() + p.p_offset;
            segments_.push_back({p.p_paddr, p.p_vaddr, p.p_offset, {begin, begin + p.p_filesz}});
        }
        for (unsigned i = 0; i < header.e_shnum; ++i) {
            auto s = at<Elf32_Shdr>(file, header.e_shoff + i * sizeof(Elf32_Shdr));
            if (s.sh_type == SHT_REL)
                readRelocations(file, header, s);
            if (s.sh_type != SHT_SYMTAB)
                continue;
            auto names = at<Elf32_Shdr>(file, header.e_shoff + s.sh_link * sizeof(Elf32_Shdr));
            for (size_t n = 0; n < s.sh_size / sizeof(Elf32_Sym); ++n) {
                auto symbol = at<Elf32_Sym>(file, s.sh_offset + n * sizeof(Elf32_Sym));
                if (size_t(names.sh_offset) + symbol.st_name >= file.size())
                    throw std::runtime_error("a symbol has no name");
                const char* text =
                    reinterpret_cast<const char*>(file.data()) + names.sh_offset + symbol.st_name;
                std::string name(text,
                                 strnlen(text, file.size() - names.sh_offset - symbol.st_name));
                bool isFunction = ELF32_ST_TYPE(symbol.st_info) == STT_FUNC;
                symbols_[name] = isFunction ? symbol.st_value & ~1u : symbol.st_value;
                sizes_[name] = symbol.st_size;
                if (isFunction)
                    functions_[symbol.st_value & ~1u] = name;
            }
        }
    } catch (const std::exception& e) {
        throw std::runtime_error("firmware '" + path + "': " + e.what());
    }
}

// Stores the relocations of those sections that are loaded.
void ElfImage::readRelocations(const std::vector<uint8_t>& file, const Elf32_Ehdr& header,
                               const Elf32_Shdr& section) {
    const auto of = at<Elf32_Shdr>(file, header.e_shoff + section.sh_info * sizeof(Elf32_Shdr));
    const auto symbols =
        at<Elf32_Shdr>(file, header.e_shoff + section.sh_link * sizeof(Elf32_Shdr));
    for (size_t n = 0; (of.sh_flags & SHF_ALLOC) && n < section.sh_size / sizeof(Elf32_Rel); ++n) {
        const auto r = at<Elf32_Rel>(file, section.sh_offset + n * sizeof(Elf32_Rel));
        const auto symbol =
            at<Elf32_Sym>(file, symbols.sh_offset + ELF32_R_SYM(r.r_info) * sizeof(Elf32_Sym));
        relocations_.push_back({r.r_offset, ELF32_R_TYPE(r.r_info), symbol.st_value});
    }
}

uint32_t ElfImage::symbol(const std::string& name) const {
    auto found = symbols_.find(name);
    if (found == symbols_.end())
        throw std::runtime_error("firmware '" + path_ + "' has no symbol " + name);
    return found->second;
}

std::string ElfImage::functionAt(uint32_t address) const {
    auto after = functions_.upper_bound(address);
    return after == functions_.begin() ? "?" : std::prev(after)->second;
}

std::vector<uint8_t> ElfImage::image() const {
    const uint32_t begin = symbol("image_begin");
    std::vector<uint8_t> image(symbol("image_end") + 4 - begin, 0xFF); // erased
    for (const Segment& s : segments_)
        if (s.address >= begin && s.address + s.bytes.size() <= begin + image.size())
            std::copy(s.bytes.begin(), s.bytes.end(), image.begin() + (s.address - begin));
    return image;
}

std::vector<uint8_t> ElfImage::movedTo(uint32_t address) const {
    const uint32_t begin = symbol("image_begin"), end = symbol("image_end");
    if (relocations_.empty())
        throw std::runtime_error("firmware '" + path_ +
                                 "' cannot be relocated: link it with --emit-relocs");
    std::vector<uint8_t> image = this->image();
    for (const Relocation& r : relocations_) {
        if (r.type == R_ARM_THM_PC22 || r.type == R_ARM_THM_JUMP24 || r.type == R_ARM_NONE)
            continue; // a PC-relative address stays the same when the image moves
        if (r.type != R_ARM_ABS32 && r.type != R_ARM_TARGET1)
            throw std::runtime_error("firmware '" + path_ + "' has a relocation of type " +
                                     std::to_string(r.type) + ": compile with -mword-relocations");
        if (r.symbol < begin || r.symbol > end)
            continue; // addresses of RAM and registers stay the same when the image moves
        for (const Segment& s : segments_)
            if (r.at >= s.runAt && r.at + 4 <= s.runAt + s.bytes.size()) {
                const uint32_t where = s.address - begin + (r.at - s.runAt);
                const uint32_t value = at<uint32_t>(image, where) + address - begin;
                std::memcpy(&image[where], &value, sizeof value);
            }
    }
    const uint32_t crc = checksum(image);
    std::memcpy(&image[end - begin], &crc, sizeof crc);
    return image;
}

void ElfImage::stamp() const {
    const uint32_t end = symbol("image_end"), crc = checksum(image());
    std::fstream out(path_, std::ios::in | std::ios::out | std::ios::binary);
    for (const Segment& s : segments_)
        if (end >= s.address && end + 4 <= s.address + s.bytes.size()) {
            out.seekp(s.offset + (end - s.address));
            out.write(reinterpret_cast<const char*>(&crc), sizeof crc);
            if (out.flush())
                return;
        }
    throw std::runtime_error("cannot write the checksum into '" + path_ + "'");
}
