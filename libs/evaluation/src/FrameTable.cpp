// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/number_text.h>
#include <pointplane/core/read_errors.h>
#include <pointplane/evaluation/FrameTable.h>
#include <pointplane/evaluation/association.h>
#include <pointplane/evaluation/stamp_intervals.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>

namespace pointplane
{
namespace
{
double numberOrNaN(const std::string& text)
{
    return parseNumber<double>(text).value_or(std::numeric_limits<double>::quiet_NaN());
}
}  // namespace

std::vector<std::string> splitCsvLine(const std::string& line)
{
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (std::size_t k = 0; k < line.size(); ++k)
    {
        const char c = line[k];
        if (c == '"' && quoted && k + 1 < line.size() && line[k + 1] == '"')
        {
            fields.back() += line[++k];
        }
        else if (c == '"')
        {
            quoted = !quoted;
        }
        else if (c == ',' && !quoted)
        {
            fields.emplace_back();
        }
        else if (c != '\r')
        {
            fields.back() += c;
        }
    }
    return fields;
}

FrameTable FrameTable::read(const std::string& path)
{
    std::ifstream file(path);
    if (!file || std::filesystem::is_directory(path))
    {
        throw std::runtime_error(
            "cannot open " + path + ": " + (file ? "is a directory" : std::strerror(errno)));
    }
    std::string line;
    const bool hasHeader = static_cast<bool>(std::getline(file, line));
    requireRead(file, path);
    if (!hasHeader)
    {
        throw std::runtime_error(path + ": is empty, not a table of --diagnostics");
    }
    FrameTable table;
    table.names_ = splitCsvLine(line);
    table.columns_.resize(table.names_.size());
    const auto statusAt = std::find(table.names_.begin(), table.names_.end(), "status");
    const auto stampAt = static_cast<std::size_t>(
        std::find(table.names_.begin(), table.names_.end(), "stamp") - table.names_.begin());
    if (stampAt == table.names_.size())
    {
        throw std::runtime_error(path + ":1: no column 'stamp'; is this a table of --diagnostics?");
    }
    for (std::size_t number = 2; std::getline(file, line); ++number)
    {
        if (line.empty())
        {
            continue;
        }
        const std::vector<std::string> fields = splitCsvLine(line);
        if (fields.size() != table.names_.size())
        {
            throw std::runtime_error(
                path + ":" + std::to_string(number) + ": " + std::to_string(fields.size()) +
                " fields, " + std::to_string(table.names_.size()) + " in the header");
        }
        if (!std::isfinite(numberOrNaN(fields[stampAt])))
        {
            throw std::runtime_error(
                path + ":" + std::to_string(number) + ": the stamp is not a number");
        }
        for (std::size_t k = 0; k < fields.size(); ++k)
        {
            table.columns_[k].push_back(numberOrNaN(fields[k]));
        }
        if (statusAt != table.names_.end())
        {
            table.status_.push_back(
                fields[static_cast<std::size_t>(statusAt - table.names_.begin())]);
        }
    }
    requireRead(file, path);
    table.stamps_ = table.column("stamp");
    return table;
}

std::vector<std::pair<std::size_t, std::size_t>> rowsOf(
    const std::vector<double>& stamps, const FrameTable& table)
{
    std::vector<double> all = table.stamps();
    std::sort(all.begin(), all.end());  // frames that are lost for a late stamp are not in order
    constexpr double kRounding = 1e-6;  // of texts
    const double tolerance = 0.5 * medianInterval(all) + kRounding;
    std::vector<std::pair<double, std::size_t>> rows;
    for (std::size_t row = 0; row < table.size(); ++row)
    {
        if (table.status().empty() || table.status()[row] != "lost")
        {
            rows.emplace_back(table.stamps()[row], row);
        }
    }
    std::sort(rows.begin(), rows.end());
    std::vector<double> sorted;
    for (const auto& [stamp, row] : rows)
    {
        sorted.push_back(stamp);
    }
    std::vector<std::pair<std::size_t, std::size_t>> out;
    for (std::size_t k = 0; k < stamps.size() && !sorted.empty(); ++k)
    {
        const std::size_t nearest = nearestIndex(sorted, stamps[k]);
        if (std::abs(sorted[nearest] - stamps[k]) <= tolerance)
        {
            out.emplace_back(k, rows[nearest].second);
        }
    }
    return out;
}

bool FrameTable::has(const std::string& column) const
{
    return std::find(names_.begin(), names_.end(), column) != names_.end();
}

std::vector<double> FrameTable::column(const std::string& name) const
{
    const auto found = std::find(names_.begin(), names_.end(), name);
    return found == names_.end() ? std::vector<double>()
                                 : columns_[static_cast<std::size_t>(found - names_.begin())];
}
}  // namespace pointplane
