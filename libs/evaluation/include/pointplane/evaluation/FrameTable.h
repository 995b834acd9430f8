// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace pointplane
{
/** The table with a line per frame that pointplane-odometry --diagnostics writes: named columns of
 * numbers, and the tracking status. Only the column `stamp` is required. */
class FrameTable
{
 public:
    /** \throws std::runtime_error naming the file and, if one is malformed, the line */
    [[nodiscard]] static FrameTable read(const std::string& path);

    [[nodiscard]] std::size_t size() const { return stamps_.size(); }
    [[nodiscard]] const std::vector<double>& stamps() const { return stamps_; }  //!< [s]
    /** first, tracked, predicted or lost; empty when the table has no such column. */
    [[nodiscard]] const std::vector<std::string>& status() const { return status_; }
    [[nodiscard]] bool has(const std::string& column) const;
    /** Numbers of a column; empty when there is none of that name. */
    [[nodiscard]] std::vector<double> column(const std::string& name) const;

 private:
    // They throw std::runtime_error for what is wrong in the line.
    void setHeader(const std::string& line);
    void addRow(const std::string& line);
    [[nodiscard]] std::size_t indexOf(const std::string& column) const;  //!< of names_, or its size

    std::vector<std::string> names_;
    std::vector<std::vector<double>> columns_;  //!< NaN where a field is not a number
    std::vector<double> stamps_;
    std::vector<std::string> status_;
};

/** Index of a stamp and of the row that has it, to within half the interval of the table's frames;
 * without stamps that the table does not have, and without rows of lost frames. */
[[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> rowsOf(
    const std::vector<double>& stamps, const FrameTable& table);

/** Fields of one line of CSV; quotes as RFC 4180. */
[[nodiscard]] std::vector<std::string> splitCsvLine(const std::string& line);
}  // namespace pointplane
