// SPDX-License-Identifier: BSD-3-Clause
#include "stray_odometry.h"

#include <pointplane/core/byte_order_mark.h>
#include <pointplane/core/read_errors.h>
#include <pointplane/core/trimmed.h>
#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "layout_files.h"

namespace pointplane
{
namespace
{
constexpr std::size_t kPoseColumns = 9;  //!< up to that of qw

void addStrayFrame(const std::vector<double>& v, StrayOdometry& out)
{
    constexpr double kMostFrames = 1e9;
    if (v.size() < 2 || !std::isfinite(v[0]) || !(std::abs(v[1]) < kMostFrames))
    {
        return;
    }
    const long frame = std::lround(v[1]);
    out.stamps[frame] = v[0];
    const auto pose = v.size() < kPoseColumns
                          ? std::nullopt
                          : poseFromQuaternion({v[2], v[3], v[4]}, {v[5], v[6], v[7], v[8]});
    if (pose)
    {
        out.poses[frame] = *pose;
    }
}
}  // namespace

StrayOdometry readStrayOdometry(const std::filesystem::path& path)
{
    StrayOdometry out;
    std::ifstream file(path);
    skipByteOrderMark(file);
    std::size_t columns = 0;
    int number = 0;
    for (std::string line; std::getline(file, line);)
    {
        ++number;
        const std::string text = trimmed(line);
        const auto found = static_cast<std::size_t>(std::count(text.begin(), text.end(), ',') + 1);
        columns = number == 1 ? found : columns;
        const bool isHeader = number == 1 && std::isalpha(static_cast<unsigned char>(text[0])) != 0;
        const bool isCutOff = file.eof() && found < columns;
        if (text.empty() || isHeader || isCutOff)
        {
            continue;
        }
        const std::string where = path.string() + ":" + std::to_string(number) + ": ";
        const std::vector<double> numbers = numbersInLine(text, where);
        if (numbers.size() < columns)
        {
            throw InputError(
                where + "has " + std::to_string(numbers.size()) + " columns, not " +
                std::to_string(columns) + " as the first line");
        }
        addStrayFrame(numbers, out);
    }
    requireRead(file, path.string());
    return out;
}
}  // namespace pointplane
