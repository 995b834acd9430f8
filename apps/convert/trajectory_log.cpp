// SPDX-License-Identifier: BSD-3-Clause
#include "trajectory_log.h"

#include <pointplane/core/read_errors.h>
#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "layout_files.h"

namespace pointplane
{
namespace fs = std::filesystem;

namespace
{
constexpr std::size_t kIds = 3, kRow = 4, kItem = kIds + kRow * kRow;

[[nodiscard]] bool isBlankOrComment(const std::string& line)
{
    const auto first = line.find_first_not_of(" \t\r");
    return first == std::string::npos || line[first] == '#';
}

/** The numbers of a line after `before` numbers of the same frame. */
[[nodiscard]] std::vector<double> numbersOfItem(
    const std::string& line, std::size_t before, const std::string& where)
{
    std::vector<double> out = numbersInLine(line, where);
    if (out.size() != (before == 0 ? kIds : kRow))
    {
        throw InputError(
            where + "has " + std::to_string(out.size()) + " numbers, where " +
            (before == 0 ? "those of a frame are 3" : "a row of a matrix has 4"));
    }
    return out;
}

void addItem(const std::vector<double>& item, NumberedPoses& out)
{
    constexpr double kMostFrames = 1e9;
    const auto pose = poseFromMatrix(std::vector<double>(item.begin() + kIds, item.end()));
    if (pose && std::abs(item[2]) < kMostFrames)
    {
        out[std::lround(item[2])] = *pose;
    }
}

/** By its first line: of a frame's pose. That of a motion between two has two numbers that differ.
 */
[[nodiscard]] bool isTrajectory(const fs::path& path)
{
    constexpr std::size_t kEnough = 1000;
    std::error_code error;
    std::ifstream file(path);
    if (!fs::is_regular_file(path, error))
    {
        return false;
    }
    std::istringstream begin(readAll(file, kEnough));
    std::string line;
    while (std::getline(begin, line) && isBlankOrComment(line))
    {
    }
    std::istringstream words(line);
    long i = 0, j = 0, number = 0;
    std::string more;
    return words >> i >> j >> number && i == j && !(words >> more);
}

[[nodiscard]] std::vector<fs::path> trajectoriesIn(const fs::path& folder)
{
    constexpr const char* kEnd = "traj.txt";
    std::vector<fs::path> out;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error))
    {
        const std::string name = entry.path().filename();
        const bool isNamedSo = entry.path().extension() == ".log" ||
                               (name.size() >= std::string(kEnd).size() &&
                                name.substr(name.size() - std::string(kEnd).size()) == kEnd);
        if (isNamedSo && isTrajectory(entry.path()))
        {
            out.push_back(entry.path());
        }
    }
    std::sort(out.begin(), out.end());
    return out;
}
}  // namespace

NumberedPoses readTrajectoryLog(const fs::path& path)
{
    NumberedPoses out;
    std::ifstream file(path);
    std::vector<double> item;
    int number = 0;
    const auto where = [&] { return path.string() + ":" + std::to_string(number) + ": "; };
    for (std::string line; std::getline(file, line);)
    {
        ++number;
        if (isBlankOrComment(line))
        {
            continue;
        }
        const std::vector<double> numbers = numbersOfItem(line, item.size(), where());
        item.insert(item.end(), numbers.begin(), numbers.end());
        if (item.size() == kItem)
        {
            addItem(item, out);
            item.clear();
        }
    }
    requireRead(file, path.string());
    if (!item.empty())
    {
        throw InputError(where() + "ends within a matrix");
    }
    return out;
}

void readTrajectoryIn(const fs::path& folder, FolderLayout& out)
{
    const std::vector<fs::path> found = trajectoriesIn(folder);
    const auto usual = std::find(found.begin(), found.end(), folder / "trajectory.log");
    if (found.size() > 1 && usual == found.end())
    {
        out.aboutTruth = folder.string() + ": has several trajectories, " +
                         found[0].filename().string() + " and " + found[1].filename().string() +
                         ", so none is ground truth; name one trajectory.log";
    }
    else if (!found.empty())
    {
        const bool isFromZero = out.depth.front().key == 0;
        NumberedPoses poses;
        for (auto& [number, pose] : readTrajectoryLog(usual == found.end() ? found[0] : *usual))
        {
            poses.emplace(isFromZero ? number - 1 : number, pose);
        }
        out.poseOf = poseByNumber(std::move(poses));
    }
}
}  // namespace pointplane
