// SPDX-License-Identifier: MIT
//
// vehicle_folder: a test's own folder, since tests run side by side, in which pack_update works.

#pragma once

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <unistd.h>
#include <vector>

struct VehicleFolder {
    using Bytes = std::vector<uint8_t>;
    VehicleFolder() { std::filesystem::create_directories(path); }
    ~VehicleFolder() { std::filesystem::remove_all(path); }
    int pack(const std::string& words) const {
        return std::system(("cd " + path + " && " PACK_UPDATE " " + words + " >said 2>&1").c_str());
    }
    Bytes read(const std::string& name) const {
        std::ifstream in(path + "/" + name, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    void save(const std::string& name, const Bytes& bytes) const {
        std::ofstream(path + "/" + name, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()),
                   static_cast<std::streamsize>(bytes.size()));
    }
    std::string said() const {
        const Bytes text = read("said");
        return {text.begin(), text.end()};
    }
    std::string path = FOLDER + std::to_string(getpid());
};
