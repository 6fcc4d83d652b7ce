// SPDX-License-Identifier: MIT
//
// table: the report as text, for the terminal and as Markdown.

#pragma once

#include "designs.h"
#include "runner.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

// The rows of a design: its runs by family.
struct Row {
    const Design* design = nullptr;
    const Run* main = nullptr; // Spartan-6
    std::vector<const Run*> others;
};
std::vector<Row> rowsOf(const Plan& plan, const std::vector<Run>& runs, const std::string& family);

class TextTable { // columns as wide as they need; the first is left-aligned
public:
    void add(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
    std::string plain() const;
    std::string markdown() const;
    const std::vector<std::vector<std::string>>& rows() const { return rows_; }

private:
    std::vector<std::vector<std::string>> rows_;
};

TextTable paperTable(const Plan& plan, const Row& row);
// `accepted`: LUTs and flip-flops by design, for the changes.
using AcceptedCounts = std::map<std::string, std::pair<int, int>>;
TextTable designTable(const Plan& plan, const std::vector<Row>& rows,
                      const AcceptedCounts& accepted);
// Writes a design's cost by instance, with all below it.
TextTable costTable(const Library& library, const Row& row, size_t depth);
TextTable pathTable(const Plan& plan, const Row& row, size_t count);
std::string percent(double part, double whole); // "18.9 %"
