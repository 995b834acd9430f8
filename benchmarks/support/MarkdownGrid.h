// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace pointplane
{
/** A Markdown table, cell by cell; rows and columns in the order in which they come first. */
class MarkdownGrid
{
 public:
    void add(const std::string& row, const std::string& column, std::string text)
    {
        for (auto [names, name] : {std::pair(&rows_, &row), std::pair(&columns_, &column)})
        {
            if (std::find(names->begin(), names->end(), *name) == names->end())
            {
                names->push_back(*name);
            }
        }
        cells_[{row, column}] = std::move(text);
    }

    /** \param heading above the first column */
    [[nodiscard]] std::string markdown(const std::string& heading) const
    {
        std::string out = "| " + heading + " |", line = "|---|";
        for (const std::string& column : columns_)
        {
            out += " " + column + " |";
            line += "---|";
        }
        out += "\n" + line + "\n";
        for (const std::string& row : rows_)
        {
            out += "| " + row + " |";
            for (const std::string& column : columns_)
            {
                const auto cell = cells_.find({row, column});
                out += cell == cells_.end() ? " |" : " " + cell->second + " |";
            }
            out += "\n";
        }
        return out;
    }

    [[nodiscard]] bool isEmpty() const { return cells_.empty(); }

 private:
    std::vector<std::string> rows_, columns_;
    std::map<std::pair<std::string, std::string>, std::string> cells_;
};
}  // namespace pointplane
