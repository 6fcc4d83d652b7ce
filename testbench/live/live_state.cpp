// SPDX-License-Identifier: MIT
//
// live_state: files into one JSON object.

#include "live_state.h"
#include "sim_status.h"
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>

using nlohmann::json;

namespace {

json parsed(const std::string& path) {
    json value = json::parse(contents(path), nullptr, false);
    if (value.is_discarded())
        throw std::runtime_error("cannot read '" + path + "'");
    return value;
}

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), ::tolower);
    return text;
}

// The fields that a description gives a word: {name, value, doc}; of EVENT and MASK, the block's
// events.
json fieldsOf(const json& description, unsigned word, const json& fields, uint32_t value) {
    json decoded = json::array();
    for (const json& f : fields) {
        const unsigned lsb = f.at("lsb"), width = f.at("width");
        decoded.push_back({{"name", f.at("name")},
                           {"value", value >> lsb & (width < 32 ? (1u << width) - 1 : ~0u)},
                           {"doc", f.value("doc", "")}});
    }
    if (word == 1 || word == 2)
        for (const json& e : description.value("events", json::array()))
            decoded.push_back({{"name", e.at("name")},
                               {"value", value >> e.at("bit").get<unsigned>() & 1},
                               {"doc", e.value("doc", "")}});
    return decoded;
}

// The lines of the file's last 128 KiB, so that a page of a long flight stays as it is.
json newest(const std::string& path) {
    constexpr std::streamoff most = 128 << 10;
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    json list = json::array();
    if (!file)
        return list;
    const std::streamoff size = file.tellg();
    file.seekg(std::max<std::streamoff>(0, size - most));
    std::string line;
    if (size > most)
        std::getline(file, line); // the end of one
    while (std::getline(file, line))
        if (json event = json::parse(line, nullptr, false); event.is_object())
            list.push_back(event);
    return list;
}

} // namespace

std::string contents(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

LiveState::LiveState(std::string folder, const std::string& registers)
    : folder_(std::move(folder)) {
    std::ifstream list(registers);
    if (!list)
        throw std::runtime_error("cannot read '" + registers + "'");
    std::map<std::string, json> blocks;
    for (std::string path; std::getline(list, path);)
        if (!path.empty()) {
            json j = parsed(path);
            blocks[j.value("block", "")] = j;
        }
    for (const json& constant : blocks["map"].value("constants", json::array())) {
        std::string name = constant.at("name");
        if (name.rfind("SLOT_", 0) == 0 && name != "SLOT_COUNT") {
            std::string block = lower(name.substr(5));
            json description =
                blocks.count(block) ? blocks[block] : json{{"registers", json::array()}};
            description["block"] = block;
            blocks_.push_back({constant.at("value"), description});
        }
    }
    std::sort(blocks_.begin(), blocks_.end(),
              [](const Block& a, const Block& b) { return a.slot < b.slot; });
}

json LiveState::slots(const std::string& bytes) const {
    auto status = std::make_unique<SimStatus>();
    std::memcpy(status.get(), bytes.data(), sizeof(SimStatus));
    json list = json::array();
    for (const Block& block : blocks_) {
        json words = json::array();
        for (unsigned word = 0; word < 16; ++word) {
            unsigned at = block.slot * 16 + word;
            if (!status->seen[at])
                continue;
            json w = {{"word", word},
                      {"value", status->registers[at]},
                      {"written", status->seen[at] == 2}};
            static const char* const common[] = {"ID", "EVENT", "MASK"};
            w["name"] = word < 3 ? common[word] : "word " + std::to_string(word);
            json fields = json::array();
            for (const json& r : block.description.value("registers", json::array()))
                if (r.at("word") == word) {
                    w["name"] = r.at("name");
                    w["doc"] = r.value("doc", "");
                    fields = r.value("fields", json::array());
                }
            w["fields"] = fieldsOf(block.description, word, fields, status->registers[at]);
            words.push_back(w);
        }
        list.push_back({{"slot", block.slot},
                        {"block", block.description["block"]},
                        {"doc", block.description.value("doc", "")},
                        {"words", words}});
    }
    return list;
}

std::string LiveState::now() const {
    json state = {{"calls", json::array()}, {"features", json::array()}, {"slots", json::array()}};
    std::string status = contents(folder_ + "/status");
    if (status.size() >= sizeof(SimStatus) && isSimStatus(status.data())) {
        uint64_t values[7];
        std::memcpy(values, status.data() + 8, sizeof values);
        const char* const names[] = {"ns",      "cycles", "bytesUp", "bytesDown",
                                     "packets", "lost",   "wallNs"};
        for (int i = 0; i < 7; ++i)
            state["air"][names[i]] = values[i];
        state["slots"] = slots(status);
    }
    std::istringstream calls(contents(folder_ + "/calls.jsonl"));
    for (std::string line; std::getline(calls, line);) {
        json row = json::parse(line, nullptr, false); // the last one may be half written
        if (!row.is_object())
            continue;
        if (row.contains("features")) {
            state["features"] = row["features"];
            state["found"] = row["found"];
        } else {
            state["calls"].push_back(row);
        }
    }
    state["events"] = newest(folder_ + "/events.jsonl");
    using namespace std::filesystem;
    std::error_code none;
    const path frame = folder_ + "/before.png", report = folder_ + "/report.json";
    state["frame"] = exists(frame, none);
    // A report that is older than the picture is of the mission before.
    state["over"] =
        exists(report, none) && last_write_time(report, none) >= last_write_time(frame, none);
    return state.dump();
}
