// SPDX-License-Identifier: MIT
//
// core_list: lines into cores: slots, memory ports, buffers, pins.

#include "core_list.h"
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fmt/format.h>
#include <set>
#include <sstream>
#include <stdexcept>

using nlohmann::json;

namespace {

constexpr unsigned slotLimit = 64, pinLimit = 32;
constexpr unsigned bufferAlignment = 128; // the largest NPI burst, bytes
// The slowest clock of a core's own, Hz: an access ends within bus_crossing's TIMEOUT.
constexpr double leastHz = 3e6;

[[noreturn]] void fail(unsigned line, const std::string& text) {
    throw std::runtime_error(fmt::format("{}: error: {}", line, text));
}

unsigned constant(const json& base, const std::string& name) {
    for (const json& c : base.at("constants"))
        if (c.at("name") == name)
            return c.at("value").get<unsigned>();
    throw std::runtime_error("1: error: the platform's map has no " + name);
}

bool isName(const std::string& s) {
    return !s.empty() && std::islower(static_cast<unsigned char>(s[0])) &&
           std::all_of(s.begin(), s.end(), [](unsigned char c) {
               return std::islower(c) || std::isdigit(c) || c == '_';
           });
}

class Reader {
public:
    Reader(const json& base, const std::map<std::string, json>& descriptions)
        : descriptions_(descriptions), first_(constant(base, "SLOT_COUNT")),
          buffers_(constant(base, "BUFFERS")), memoryEnd_(1u << constant(base, "DDR_BYTES_LOG2")) {
        chip_.ports = constant(base, "NPI_PORT_COUNT");
        chip_.registers = constant(base, "CONTROL_WINDOW");
        for (const json& c : base.at("constants"))
            if (std::string name = c.at("name"); name.rfind("SLOT_", 0) == 0)
                names_[lower(name.substr(5))] = 0;
    }

    Chip run(const std::string& text) {
        std::istringstream in(text);
        std::string line;
        for (unsigned n = 1; std::getline(in, line); ++n)
            read(line.substr(0, line.find('#')), n);
        giveSlots();
        giveMemory();
        for (Core& c : chip_.cores)
            connect(c);
        std::sort(chip_.cores.begin(), chip_.cores.end(),
                  [](const Core& a, const Core& b) { return a.slot < b.slot; });
        chip_.slots = chip_.cores.empty() ? first_ : chip_.cores.back().slot + 1;
        return chip_;
    }

private:
    static std::string lower(std::string s) {
        for (char& c : s)
            c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        return s;
    }

    void read(const std::string& text, unsigned n) {
        std::istringstream words(text);
        Core c;
        c.line = n;
        if (!(words >> c.folder))
            return;
        auto found = descriptions_.find(c.folder);
        if (found == descriptions_.end())
            fail(n, fmt::format("there is no core '{0}': ip/{0}/CMakeLists.txt, with icesoc_core",
                                c.folder));
        c.name = c.folder;
        describe(c, found->second);
        std::map<std::string, std::string> given;
        for (std::string word; words >> word;) {
            size_t equals = word.find('=');
            if (equals == std::string::npos || equals + 1 == word.size())
                fail(n, fmt::format("'{}': after the core's folder come name=, identity=, slot=, "
                                    "memory=, gate=, signals= and its pins",
                                    word));
            if (!given.emplace(word.substr(0, equals), word.substr(equals + 1)).second)
                fail(n, fmt::format("'{}' is given twice", word.substr(0, equals)));
        }
        for (const auto& [key, value] : given)
            set(c, key, value);
        if (c.isProbe && c.signals.empty())
            fail(n, fmt::format("'{}' records nothing: signals=u_fir.busy,u_fir.count:9", c.name));
        if (c.identity.empty())
            c.identity = c.name;
        auto [it, isNew] = names_.emplace(c.name, n);
        if (!isNew)
            fail(n, it->second
                        ? fmt::format("'{}' is on line {} already; name= tells two of a kind apart",
                                      c.name, it->second)
                        : fmt::format("'{}' is a name of the platform's", c.name));
        if (!identities_.insert(c.identity).second)
            fail(n, fmt::format("the identity '{}' is taken", c.identity));
        chip_.cores.push_back(c);
    }

    [[noreturn]] static void noRoom(const Core& c, unsigned bytes) {
        fail(c.line, fmt::format("no room in DDR3 for the {} bytes of '{}'", bytes, c.folder));
    }

    void describe(Core& c, const json& j) {
        if (!j.contains("type"))
            fail(c.line,
                 fmt::format("'{}' has no type: its description is not a slot's", c.folder));
        if (j.value("memory_port", false))
            c.port = static_cast<int>(chip_.ports++);
        unsigned bytes = j.value("memory_bytes", 0u);
        if (bytes > memoryEnd_ - buffers_)
            noRoom(c, bytes);
        if (bytes)
            for (c.memoryBytes = bufferAlignment; c.memoryBytes < bytes;)
                c.memoryBytes *= 2;
        c.isProbe = j.value("probe", false);
        if (j.contains("servant")) {
            c.servantType = j.at("servant").at("type");
            c.servantHeader = j.at("servant").at("header");
        }
        for (const json& p : j.value("pins", json::array()))
            c.pins.push_back(
                {p.at("name"), p.value("width", 1u), 0, "", p.value("internal", false), {}});
        c.ownClock = j.value("own_clock", 0u);
        if (c.ownClock)
            c.pins.push_back({"clock_i", 1, 0, "", false, {}}); // the last one
    }

    void set(Core& c, const std::string& key, const std::string& value) {
        if (key == "name") {
            if (!isName(value))
                fail(c.line, fmt::format("name={}: small letters, digits and _", value));
            c.name = value;
        } else if (key == "identity") {
            if (value.find_first_of("\"\\/") != std::string::npos)
                fail(c.line, fmt::format("identity={}: without quotes, \\ and /", value));
            c.identity = value;
        } else if (key == "slot") {
            bool isNumber = value.size() < 3 && std::all_of(value.begin(), value.end(), ::isdigit);
            c.slot = isNumber ? static_cast<unsigned>(std::stoul(value)) : 0;
            if (c.slot < first_ || c.slot >= slotLimit)
                fail(c.line,
                     fmt::format("slot={}: {}..{} are for cores", value, first_, slotLimit - 1));
        } else if (key == "memory") {
            size_t read = 0;
            try {
                c.memory = static_cast<unsigned>(std::stoul(value, &read, 0));
            } catch (const std::exception&) {
            }
            if (read != value.size() || !c.memoryBytes)
                fail(c.line,
                     fmt::format("memory={}: a byte address in DDR3, for a core with buffers",
                                 value));
            c.isPlaced = true;
        } else if (key == "signals" && c.isProbe) {
            setSignals(c, value);
        } else if (key == "clock" && c.ownClock) {
            setClock(c, value);
        } else if (key == "gate") {
            if (value != "on")
                fail(c.line, fmt::format("gate={}: on, or without the word", value));
            c.hasGate = true;
        } else {
            for (Pin& p : c.pins)
                if (p.name == key && value[0] == '@') {
                    setPlaces(c, p, value);
                    return;
                } else if (p.name == key && value == "none") {
                    p.isInternal = true;
                    return;
                } else if (p.name == key && !p.isOut()) {
                    p.source = value;
                    return;
                }
            std::string inputs;
            for (const Pin& p : c.pins)
                inputs += p.isOut() ? "" : (inputs.empty() ? "" : ", ") + p.name;
            fail(c.line, fmt::format("'{}' has no input pin '{}'; it has {}", c.folder, key,
                                     inputs.empty() ? "none" : inputs));
        }
    }

    // clock=3/8: of the chip's clock, by a DCM_CLKGEN; there is no pin clock_i then.
    static void setClock(Core& c, const std::string& value) {
        char end = 0;
        if (std::sscanf(value.c_str(), "%3u/%3u%c", &c.multiply, &c.divide, &end) != 2 ||
            c.multiply < 2 || c.multiply > 256 || !c.divide || c.divide > 256 ||
            c.multiply > c.divide)
            fail(c.line,
                 fmt::format("clock={}: a part of the chip's clock, as 3/8: 2..256 / 2..256",
                             value));
        const double hz = c.clockHz();
        if (hz > c.ownClock || hz < leastHz)
            fail(c.line, fmt::format("clock={}: {:.0f} Hz; '{}' is for {:.0f} to {} Hz", value, hz,
                                     c.folder, leastHz, c.ownClock));
        c.pins.back().isInternal = true;
    }

    // signals=u_fir.busy,u_fir.count:9: their names in the simulator, below soc, and their bits.
    static void setSignals(Core& c, const std::string& value) {
        std::istringstream words(value);
        unsigned bits = 0;
        for (std::string word; std::getline(words, word, ',');) {
            size_t colon = word.find(':');
            std::string name = word.substr(0, colon),
                        width = colon < word.size() ? word.substr(colon + 1) : "1";
            auto isOf = [](const std::string& s, const char* others) {
                return !s.empty() && std::all_of(s.begin(), s.end(), [=](unsigned char ch) {
                    return std::isdigit(ch) ||
                           (*others && (std::isalpha(ch) || std::strchr(others, ch)));
                });
            };
            if (!isOf(name, "_.") || !isOf(width, "") || width.size() > 3 || !std::stoul(width))
                fail(c.line,
                     fmt::format("signals: '{}' is no name and width, as u_fir.count:9", word));
            c.signals.push_back({name, static_cast<unsigned>(std::stoul(width))});
            bits += c.signals.back().width;
        }
        if (bits > 223)
            fail(c.line, fmt::format("signals: {} bits; a probe has 223", bits));
    }

    // pwm_o=@A4,B4: where the bits are on the board, from bit 0.
    void setPlaces(const Core& c, Pin& p, const std::string& value) {
        std::istringstream words(value.substr(1));
        for (std::string place; std::getline(words, place, ',');) {
            if (place.empty() || !std::all_of(place.begin(), place.end(), ::isalnum))
                fail(c.line,
                     fmt::format("{}={}: places are letters and digits, as @A4,B4", p.name, value));
            auto [it, isNew] = places_.emplace(place, c.line);
            if (!isNew)
                fail(c.line, fmt::format("place {} is taken on line {}", place, it->second));
            p.places.push_back(place);
        }
        if (p.places.size() != p.width)
            fail(c.line, fmt::format("{}={}: {} places for {} bits", p.name, value, p.places.size(),
                                     p.width));
    }

    void giveSlots() {
        std::map<unsigned, unsigned> taken;
        for (const Core& c : chip_.cores)
            if (c.slot)
                if (auto [it, isNew] = taken.emplace(c.slot, c.line); !isNew)
                    fail(c.line, fmt::format("slot {} is taken on line {}", c.slot, it->second));
        unsigned next = first_;
        for (Core& c : chip_.cores) {
            if (c.slot)
                continue;
            while (taken.count(next))
                ++next;
            if (next >= slotLimit)
                fail(c.line, fmt::format("all {} slots are taken", slotLimit));
            c.slot = next;
            taken[next] = c.line;
        }
    }

    // Places buffers. A wrapper keeps only the address bits above the size of its buffers, so each
    // core's are at a multiple of it. Buffers with memory= come first, the others into the gaps, in
    // order.
    void giveMemory() {
        std::vector<const Core*> placed;
        auto neighbour = [&](const Core& c) -> const Core* {
            for (const Core* other : placed)
                if (c.memory < other->memory + other->memoryBytes &&
                    other->memory < c.memory + c.memoryBytes)
                    return other;
            return nullptr;
        };
        for (Core& c : chip_.cores) {
            if (!c.isPlaced)
                continue;
            if (c.memory % c.memoryBytes || c.memory < buffers_ || c.memory >= memoryEnd_)
                fail(c.line,
                     fmt::format("memory=0x{:X}: buffers of {} bytes begin at a multiple of "
                                 "that, from 0x{:X} on and below 0x{:X}",
                                 c.memory, c.memoryBytes, buffers_, memoryEnd_));
            if (const Core* other = neighbour(c))
                fail(c.line, fmt::format("memory=0x{:X} is within the buffers of line {}", c.memory,
                                         other->line));
            placed.push_back(&c);
        }
        unsigned next = buffers_;
        for (Core& c : chip_.cores) {
            if (c.isPlaced || !c.memoryBytes)
                continue;
            auto align = [&] { return (next + c.memoryBytes - 1) / c.memoryBytes * c.memoryBytes; };
            c.memory = align();
            while (const Core* other = neighbour(c)) {
                next = other->memory + other->memoryBytes;
                c.memory = align();
            }
            next = c.memory + c.memoryBytes;
            if (next > memoryEnd_)
                noRoom(c, c.memoryBytes);
            placed.push_back(&c);
        }
    }

    void connect(Core& c) {
        for (Pin& p : c.pins) {
            if (!p.source.empty()) {
                const Pin* from = nullptr;
                for (const Core& other : chip_.cores)
                    for (const Pin& q : other.pins)
                        if (other.name + "." + q.name == p.source && q.isOut())
                            from = &q;
                // A neighbour that is not in the chip is ignored.
                std::string owner = p.source.substr(0, p.source.find('.'));
                if (p.isInternal && std::none_of(chip_.cores.begin(), chip_.cores.end(),
                                                 [&](const Core& o) { return o.name == owner; })) {
                    p.source.clear();
                    continue;
                }
                if (!from || from->width != p.width)
                    fail(c.line, fmt::format("{}={}: no core's output of {} bits", p.name, p.source,
                                             p.width));
                continue;
            }
            if (p.isInternal)
                continue;
            unsigned& next = chip_.pins[p.isOut()];
            p.lsb = next;
            next += p.width;
            if (next > pinLimit)
                fail(c.line,
                     fmt::format("'{}' of '{}': the chip has {} pins of a direction for cores; "
                                 "{}=none: it is no pin",
                                 p.name, c.name, pinLimit, p.name));
        }
    }

    const std::map<std::string, json>& descriptions_;
    unsigned first_;
    unsigned buffers_, memoryEnd_; // DDR3 for cores
    Chip chip_;
    std::map<std::string, unsigned> names_; // to its line; 0: the platform's
    std::set<std::string> identities_;
    std::map<std::string, unsigned> places_; // to their line
};

} // namespace

Chip readCores(const std::string& list, const json& base,
               const std::map<std::string, json>& descriptions) {
    return Reader(base, descriptions).run(list);
}
