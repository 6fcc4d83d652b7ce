// SPDX-License-Identifier: MIT
//
// wavesvg: draws a waveform in WaveJSON (the format of WaveDrom, strict JSON) as SVG.
//
// Of a signal: name, wave (0 1 l h L H p n P N x z u d = 2..9 . |), data (list or words), period,
// phase. Signals are grouped by nested lists that begin with a name; {} is an empty line. head.text
// and foot.text, config.hscale. What it does not know is an error that names the signal.

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

namespace {

using Json = nlohmann::json;
constexpr double lane = 30, high = 5, low = 23, mid = 14, slope = 3;

struct Signal {
    std::string name, wave;
    std::vector<std::string> data;
    double period = 1, phase = 0;
    int depth = 0; // groups around it
    bool heading = false;
};

[[noreturn]] void fail(const std::string& what) {
    throw std::runtime_error(what);
}

std::string escape(const std::string& text) {
    std::string out;
    for (char c : text)
        out += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
    return out;
}

void collect(const Json& list, int depth, std::vector<Signal>& out) {
    for (const Json& item : list) {
        if (item.is_string()) {
            out.push_back({item, "", {}, 1, 0, depth - 1, true});
        } else if (item.is_array()) {
            collect(item, depth + 1, out);
        } else if (item.is_object()) {
            Signal s;
            s.name = item.value("name", "");
            s.wave = item.value("wave", "");
            s.period = item.value("period", 1.0);
            s.phase = item.value("phase", 0.0);
            s.depth = depth;
            if (item.contains("data") && item["data"].is_string()) {
                std::istringstream words(item["data"].get<std::string>());
                for (std::string word; words >> word;)
                    s.data.push_back(word);
            } else if (item.contains("data")) {
                s.data = item["data"].get<std::vector<std::string>>();
            }
            if (s.period <= 0)
                fail("signal '" + s.name + "': period must be above 0");
            out.push_back(s);
        } else {
            fail("a signal is an object, a list or a string");
        }
    }
}

bool isBus(char c) {
    return c == '=' || (c >= '2' && c <= '9');
}
bool isClock(char c) {
    return std::string("pnPN").find(c) != std::string::npos;
}
double level(char c) {
    return c == '1' || c == 'h' || c == 'H' || c == 'u' ? high : c == 'z' ? mid : low;
}

class Drawing {
public:
    Drawing(double unit, double left) : unit_(unit), left_(left) {}

    void draw(const Signal& s, double y) {
        char last = 0, state = 0; // before this brick, and what a '.' continues
        size_t datum = 0;
        for (size_t i = 0; i < s.wave.size(); ++i) {
            char c = s.wave[i];
            bool same = c == '.' || c == '|', first = i == 0;
            if (same && first)
                fail("signal '" + s.name + "': the wave begins with '" + std::string(1, c) + "'");
            if (!same && !isBus(c) && !isClock(c) &&
                std::string("01lhLHxzud").find(c) == std::string::npos)
                fail("signal '" + s.name + "': '" + std::string(1, c) + "' is no state of a wave");
            if (!same)
                state = c;
            double w = unit_ * s.period, x = left_ + w * static_cast<double>(i) - unit_ * s.phase;
            if (isClock(state)) {
                clock(state, x, y, w);
            } else if (isBus(state) || state == 'x') {
                size_t end = i + 1;
                while (end < s.wave.size() && (s.wave[end] == '.' || s.wave[end] == '|'))
                    ++end;
                if (!same) {
                    std::string text = isBus(state) && datum < s.data.size() ? s.data[datum++] : "";
                    bus(state, x, y, w * static_cast<double>(end - i), text);
                }
            } else {
                plain(last, state, same, x, y, w);
            }
            if (c == '|')
                svg_ += fmt::format("<path d='M{0},{2} l4,-9 l-6,-8 l4,-9' class='gap'/>\n",
                                    x + w / 2, 0, y + 27);
            last = state;
        }
        for (const auto& [style, path] : paths_)
            svg_ += fmt::format("<path d='{}' class='{}'/>\n", path, style);
        paths_.clear();
    }
    void text(double x, double y, const std::string& text, const char* style) {
        svg_ +=
            fmt::format("<text x='{}' y='{}' class='{}'>{}</text>\n", x, y, style, escape(text));
    }
    void grid(int lines, double top, double bottom) {
        svg_ += "<path d='";
        for (int i = 0; i < lines; ++i)
            svg_ += fmt::format("M{},{} V{}", left_ + unit_ * i, top, bottom);
        svg_ += "' class='grid'/>\n";
    }
    const std::string& svg() const { return svg_; }

private:
    // A signal's lines of one style are one path.
    void line(const std::string& path, const char* style = "line") { paths_[style] += path; }
    void plain(char last, char state, bool same, double x, double y, double w) {
        double to = y + level(state), from = same || !last || isClock(last) ? to : y + level(last);
        if (isBus(last) || last == 'x')
            from = to;
        std::string begin =
            same ? "" : fmt::format("M{},{} L{},{}", x, from, x + (from != to ? slope : 0), to);
        line(begin + fmt::format(" H{}", x + w), state == 'u' || state == 'd' ? "weak" : "line");
    }
    void clock(char c, double x, double y, double w) {
        bool rising = c == 'p' || c == 'P';
        double first = y + (rising ? high : low), second = y + (rising ? low : high);
        line(fmt::format("M{0},{1} V{2} H{3} V{1} H{4}", x, second, first, x + w / 2, x + w));
        if (c == 'P' || c == 'N')
            line(fmt::format("M{},{} l3,{} l3,{} z", x - 3, y + mid + (rising ? 2 : -2),
                             rising ? -6 : 6, rising ? 6 : -6),
                 "arrow");
    }
    void bus(char c, double x, double y, double w, const std::string& label) {
        static const char* const fills[] = {"#fff",    "#ffffb4", "#ffe0b9", "#b9e0ff",
                                            "#ccfdfe", "#cdfdc5", "#f0c1fb", "#f5c2c0"};
        const char* fill = c == 'x' ? "url(#unknown)" : fills[c >= '2' ? c - '2' : 0];
        svg_ += fmt::format(
            "<path d='M{0},{1} L{2},{3} H{4} L{5},{1} L{4},{6} H{2} z' class='bus' fill='{7}'/>\n",
            x, y + mid, x + slope, y + high, x + w - slope, x + w, y + low, fill);
        if (!label.empty())
            text(x + w / 2, y + mid + 4, label, "data");
    }

    double unit_, left_;
    std::string svg_;
    std::map<std::string, std::string> paths_; // of the signal under way, by style
};

std::string render(const Json& wave) {
    std::vector<Signal> signals;
    if (!wave.contains("signal") || !wave["signal"].is_array())
        fail("no list 'signal'");
    collect(wave["signal"], 0, signals);
    double hscale = wave.contains("config") ? wave["config"].value("hscale", 1.0) : 1.0;
    double unit = 40 * hscale, names = 40, cycles = 1;
    for (const Signal& s : signals) {
        names = std::max(names, 7.2 * static_cast<double>(s.name.size()) + 12.0 * s.depth + 16);
        cycles = std::max(cycles, static_cast<double>(s.wave.size()) * s.period - s.phase);
    }
    auto words = [&](const char* part) {
        return wave.contains(part) ? wave[part].value("text", std::string()) : std::string();
    };
    std::string head = words("head"), foot = words("foot");
    double top = head.empty() ? 8 : 32, bottom = top + lane * static_cast<double>(signals.size());
    double width = names + unit * cycles + 12, height = bottom + (foot.empty() ? 8 : 26);

    Drawing drawing(unit, names);
    drawing.grid(static_cast<int>(cycles) + 1, top, bottom);
    double y = top;
    for (const Signal& s : signals) {
        drawing.text(6 + 12.0 * s.depth, y + mid + 5, s.name, s.heading ? "group" : "name");
        drawing.draw(s, y);
        y += lane;
    }
    if (!head.empty())
        drawing.text(names + unit * cycles / 2, 20, head, "title");
    if (!foot.empty())
        drawing.text(names + unit * cycles / 2, bottom + 18, foot, "data");
    return fmt::format(
        "<svg xmlns='http://www.w3.org/2000/svg' width='{0}' height='{1}' viewBox='0 0 {0} {1}'>\n"
        "<style>text{{font:12px sans-serif;fill:#000}} .data,.title{{text-anchor:middle}} "
        ".title,.group{{font-weight:bold}} .line,.bus{{stroke:#000}} "
        ".weak{{stroke:#000;stroke-dasharray:3 2}} "
        ".line,.weak,.grid,.gap{{fill:none}} .grid{{stroke:#ccc;stroke-dasharray:1 3}} "
        ".gap{{stroke:#888}}</style>\n"
        "<defs><pattern id='unknown' width='6' height='6' patternUnits='userSpaceOnUse'>"
        "<path d='M0,6 L6,0' stroke='#888'/></pattern></defs>\n<rect width='{0}' height='{1}' "
        "fill='#fff'/>\n{2}</svg>\n",
        width, height, drawing.svg());
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app{"Draws WaveJSON as SVG."};
    std::string input, output;
    app.add_option("wave", input, "WaveJSON file")->required();
    app.add_option("svg", output, "SVG file to write")->required();
    CLI11_PARSE(app, argc, argv);
    try {
        std::ifstream in(input);
        if (!in)
            fail("cannot be read");
        std::string svg = render(Json::parse(in));
        std::ofstream out(output);
        out << svg;
        if (!out.flush())
            fail("cannot write " + output);
    } catch (const std::exception& e) {
        std::cerr << "wavesvg: " << input << ": " << e.what() << '\n';
        return 1;
    }
    return 0;
}
