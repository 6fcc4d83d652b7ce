// SPDX-License-Identifier: MIT
//
// wavesvg: draws a waveform in WaveJSON (the format of WaveDrom, strict JSON) as SVG.
//
// A signal has name, wave (0 1 p x z = 2..9 . |), data. Signals are grouped by nested lists that
// begin with a name; {} is an empty line. head.text and foot.text, config.hscale. What it does not
// know is an error that names the signal.

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

namespace {

using Json = nlohmann::json;
constexpr double lane = 30, high = 5, low = 23, mid = 14, slope = 3;

struct Signal {
    std::string name, wave;
    std::vector<std::string> data;
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
            out.push_back({item, "", {}, depth - 1, true});
        } else if (item.is_array()) {
            collect(item, depth + 1, out);
        } else if (item.is_object()) {
            for (const auto& [key, value] : item.items())
                if (key != "name" && key != "wave" && key != "data")
                    fail("signal '" + item.value("name", "") + "': '" + key + "' is not drawn");
            out.push_back({item.value("name", ""), item.value("wave", ""),
                           item.value("data", std::vector<std::string>()), depth});
        } else {
            fail("a signal is an object, a list or a string");
        }
    }
}

bool isBus(char c) {
    return c == '=' || (c >= '2' && c <= '9');
}
double level(char c) {
    return c == '1' ? high : c == 'z' ? mid : low;
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
            if (!same && !isBus(c) && std::string("01pxz").find(c) == std::string::npos)
                fail("signal '" + s.name + "': '" + std::string(1, c) + "' is no state of a wave");
            if (!same)
                state = c;
            double w = unit_, x = left_ + w * static_cast<double>(i);
            if (state == 'p') {
                clock(x, y, w);
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
        if (!lines_.empty())
            svg_ += fmt::format("<path d='{}' class='line'/>\n", lines_);
        lines_.clear();
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
    void plain(char last, char state, bool same, double x, double y, double w) {
        double to = y + level(state), from = same || !last || last == 'p' ? to : y + level(last);
        if (isBus(last) || last == 'x')
            from = to;
        std::string begin =
            same ? "" : fmt::format("M{},{} L{},{}", x, from, x + (from != to ? slope : 0), to);
        lines_ += begin + fmt::format(" H{}", x + w);
    }
    void clock(double x, double y, double w) {
        lines_ +=
            fmt::format("M{0},{1} V{2} H{3} V{1} H{4}", x, y + low, y + high, x + w / 2, x + w);
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
    std::string svg_, lines_; // the latter of the signal under way: one path
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
        cycles = std::max(cycles, static_cast<double>(s.wave.size()));
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
        ".line,.grid,.gap{{fill:none}} .grid{{stroke:#ccc;stroke-dasharray:1 3}} "
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
