// SPDX-License-Identifier: MIT
//
// drawing: the last moments of a waveform, as the page draws them.

#include "failures.h"
#include "files.h"
#include "process.h"
#include <algorithm>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>
#include <tuple>

using nlohmann::json;

namespace {

constexpr size_t mostChanges = 400, fewestChanges = 25, mostSignals = 200;

struct Signal {
    std::string name;  // with its scopes: "TOP.bridge.u_write.full"
    unsigned bits = 1; // 0: text
    size_t depth = 0;  // scopes around it
    std::vector<std::pair<uint64_t, std::string>> changes;
};

// A value in hexadecimal, "x" or "z" where a bit of it is; one bit as it is.
std::string shortened(const std::string& bits) {
    if (bits.size() <= 1)
        return bits;
    const size_t strange = bits.find_first_not_of("01");
    if (strange != std::string::npos)
        return bits.substr(strange, 1);
    std::string digits;
    for (size_t end = bits.size(); end > 0; end -= std::min<size_t>(4, end)) {
        unsigned digit = 0;
        for (size_t i = end > 4 ? end - 4 : 0; i < end; ++i)
            digit = 2 * digit + static_cast<unsigned>(bits[i] - '0');
        digits.insert(digits.begin(), "0123456789abcdef"[digit]);
    }
    return digits;
}

// Proofs' traces repeat at each step what has not changed.
void change(Signal& signal, uint64_t now, const std::string& value) {
    if (signal.changes.empty() || signal.changes.back().second != value)
        signal.changes.emplace_back(now, value);
}

// Reads a VCD file (IEEE 1364-2005, 18.2). A signal that goes by several names has its outermost.
std::map<std::string, Signal> readVcd(const std::string& text, std::vector<uint64_t>& moments) {
    std::map<std::string, Signal> signals; // by the file's identifier
    std::vector<std::string> scopes;
    std::istringstream words(text);
    uint64_t now = 0;
    bool defined = false;
    for (std::string word; words >> word;) {
        std::string kind, id, name;
        defined = defined || word == "$enddefinitions";
        if (word == "$scope") {
            words >> kind >> name;
            scopes.push_back(name);
        } else if (word == "$upscope") {
            scopes.pop_back();
        } else if (word == "$var") {
            Signal signal;
            words >> kind >> signal.bits >> id >> name;
            for (const std::string& scope : scopes)
                signal.name += scope + ".";
            signal.name += name;
            signal.depth = scopes.size();
            if (kind == "string")
                signal.bits = 0;
            if (name.rfind("smt_", 0) == 0) // the solver's own
                continue;
            const auto known = signals.find(id);
            if (known == signals.end() || signal.depth < known->second.depth)
                signals[id] = signal;
        } else if (!defined) {
        } else if (word[0] == '#') {
            now = std::stoull(word.substr(1));
            moments.push_back(now);
        } else if (word[0] == 'b' || word[0] == 's') {
            words >> id;
            change(signals[id], now, word.substr(1));
        } else if (word[0] != '$' && word.size() > 1 && std::string("01xz").find(word[0]) < 4) {
            change(signals[word.substr(1)], now, word.substr(0, 1));
        }
    }
    return signals;
}

json draw(const Failure& failure, size_t room) {
    const std::string& wave = failure.wave;
    const bool compressed = wave.size() > 4 && wave.compare(wave.size() - 4, 4, ".fst") == 0;
    const std::string text = compressed ? run({"fst2vcd", "-f", wave}).text : readFile(wave);
    std::vector<uint64_t> moments;
    std::map<std::string, Signal> signals = readVcd(text, moments);
    if (moments.empty())
        return nullptr;
    std::vector<const Signal*> order;
    for (const auto& [id, signal] : signals)
        if (!signal.changes.empty())
            order.push_back(&signal);
    static const std::regex word("[A-Za-z_]\\w+");
    const std::set<std::string> words(
        std::sregex_token_iterator(failure.about.begin(), failure.about.end(), word), {});
    const auto isWithin = [&](const Signal* s) {
        return failure.scope.empty() ? s->depth <= 3
                                     : s->name.find("." + failure.scope + ".") != std::string::npos;
    };
    static const std::regex nameless("n\\d+(_o)?"); // a converter's
    const auto rank = [&](const Signal* s) {
        const std::string name = s->name.substr(s->name.rfind('.') + 1);
        const bool named = words.count(name) && isWithin(s);
        const bool moves = s->changes.size() > 1;
        return std::tuple(s->bits != 0, std::regex_match(name, nameless), !named,
                          !(moves && !failure.scope.empty() && isWithin(s)), !moves, s->depth,
                          s->name);
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](const Signal* a, const Signal* b) { return rank(a) < rank(b); });
    const auto rowsOf = [&](size_t shown, size_t changes) {
        json rows = json::array();
        for (size_t row = 0; row < shown; ++row) {
            json pairs = json::array(); // time, value, time, value
            const auto& all = order[row]->changes;
            for (size_t i = all.size() - std::min(all.size(), changes); i < all.size(); ++i) {
                pairs.push_back(all[i].first);
                pairs.push_back(order[row]->bits ? shortened(all[i].second) : all[i].second);
            }
            rows.push_back({order[row]->name, order[row]->bits, pairs});
        }
        return json{{"from", moments.front()},
                    {"to", moments.back()},
                    {"signals", rows},
                    {"more", order.size() - shown}};
    };
    size_t shown = std::min(order.size(), mostSignals), changes = mostChanges;
    json drawing = rowsOf(shown, changes);
    while (drawing.dump().size() > room && shown > 1) {
        (changes > fewestChanges ? changes : shown) /= 2;
        drawing = rowsOf(shown, changes);
    }
    return drawing;
}

} // namespace

json drawingOf(const Failure& failure, size_t room) {
    try {
        return draw(failure, room);
    } catch (const std::exception& error) { // the report is worth more than a drawing
        std::cout << failure.wave << " is damaged, and not drawn (" << error.what() << ")\n";
        return nullptr;
    }
}
