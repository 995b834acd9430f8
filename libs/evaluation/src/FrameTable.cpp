// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/byte_order_mark.h>
#include <pointplane/core/counted.h>
#include <pointplane/core/number_text.h>
#include <pointplane/core/read_errors.h>
#include <pointplane/core/trimmed.h>
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

void FrameTable::setHeader(const std::string& line)
{
    names_ = splitCsvLine(line);
    if (!has("stamp"))
    {
        throw std::runtime_error("no column 'stamp'; is this a table of --diagnostics?");
    }
    columns_.resize(names_.size());
}

void FrameTable::addRow(const std::string& line)
{
    const std::vector<std::string> fields = splitCsvLine(line);
    if (fields.size() != names_.size())
    {
        throw std::runtime_error(
            counted(fields.size(), "field") + ", " + std::to_string(names_.size()) +
            " in the header");
    }
    for (std::size_t k = 0; k < fields.size(); ++k)
    {
        columns_[k].push_back(numberOrNaN(fields[k]));
    }
    stamps_.push_back(columns_[indexOf("stamp")].back());
    if (!std::isfinite(stamps_.back()))
    {
        throw std::runtime_error("the stamp is not a number");
    }
    if (has("status"))
    {
        status_.push_back(fields[indexOf("status")]);
    }
}

FrameTable FrameTable::read(const std::string& path)
{
    std::ifstream file(path);
    if (!file || std::filesystem::is_directory(path))
    {
        throw std::runtime_error(
            "cannot open " + path + ": " + (file ? "is a directory" : std::strerror(errno)));
    }
    skipByteOrderMark(file);
    std::string line;
    const bool hasHeader = static_cast<bool>(std::getline(file, line));
    requireRead(file, path);
    if (!hasHeader)
    {
        throw std::runtime_error(path + ": is empty, not a table of --diagnostics");
    }
    FrameTable table;
    std::size_t number = 1;
    try
    {
        table.setHeader(line);
        for (++number; std::getline(file, line); ++number)
        {
            if (!trimmed(line).empty())
            {
                table.addRow(line);
            }
        }
    }
    catch (const std::runtime_error& e)
    {
        throw std::runtime_error(path + ":" + std::to_string(number) + ": " + e.what());
    }
    requireRead(file, path);
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

std::size_t FrameTable::indexOf(const std::string& column) const
{
    return static_cast<std::size_t>(
        std::find(names_.begin(), names_.end(), column) - names_.begin());
}

bool FrameTable::has(const std::string& column) const { return indexOf(column) < names_.size(); }

std::vector<double> FrameTable::column(const std::string& name) const
{
    return has(name) ? columns_[indexOf(name)] : std::vector<double>();
}
}  // namespace pointplane
