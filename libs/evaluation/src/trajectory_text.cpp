// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/byte_order_mark.h>
#include <pointplane/evaluation/trajectory_text.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>

namespace pointplane
{
namespace
{
constexpr std::size_t kMrptColumns = 7;
constexpr std::size_t kTumColumns = 8;

[[noreturn]] void failAt(const std::string& path, std::size_t line, const std::string& what)
{
    throw std::runtime_error(path + ":" + std::to_string(line) + ": " + what);
}

/** Numbers of a line; the locale must not matter, hence from_chars. */
std::vector<double> parseNumbers(const std::string& text, const std::string& path, std::size_t line)
{
    std::vector<double> numbers;
    const char* const end = text.data() + text.size();
    const char* at = text.data();
    const auto isSeparator = [](char c) { return c == ' ' || c == ',' || c == '\t' || c == '\r'; };
    while (true)
    {
        at = std::find_if_not(at, end, isSeparator);
        if (at == end)
        {
            return numbers;
        }
        const char* const stop = std::find_if(at, end, isSeparator);
        double value = 0;
        const char* const first = (*at == '+' && stop - at > 1) ? at + 1 : at;
        const auto [parsed, error] = std::from_chars(first, stop, value);
        if (error != std::errc() || parsed != stop)
        {
            failAt(path, line, "'" + std::string(at, stop) + "' is not a number");
        }
        numbers.push_back(value);
        at = stop;
    }
}

/** \return a number like 1,5 in a line of columns separated by blanks, or nothing: commas alone
 * separate columns, too */
std::string decimalComma(const std::string& text)
{
    std::istringstream words(text);
    std::string out;
    std::size_t count = 0;
    for (std::string word; words >> word; ++count)
    {
        const std::size_t comma = word.find(',');
        if (out.empty() && comma > 0 && comma != std::string::npos && comma + 1 < word.size())
        {
            out = word;
        }
    }
    return count >= kMrptColumns ? out : "";
}

Eigen::Isometry3d poseFromQuaternion(const std::vector<double>& v)
{
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = Eigen::Quaterniond(v[7], v[4], v[5], v[6]).normalized().toRotationMatrix();
    pose.translation() << v[1], v[2], v[3];
    return pose;
}

/** MRPT's convention: R = Rz(yaw) Ry(pitch) Rx(roll). */
Eigen::Isometry3d poseFromYawPitchRoll(const std::vector<double>& v)
{
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = (Eigen::AngleAxisd(v[4], Eigen::Vector3d::UnitZ()) *
                     Eigen::AngleAxisd(v[5], Eigen::Vector3d::UnitY()) *
                     Eigen::AngleAxisd(v[6], Eigen::Vector3d::UnitX()))
                        .toRotationMatrix();
    pose.translation() << v[1], v[2], v[3];
    return pose;
}

/** What `# pointplane-status` lines say about frames; docs/rawlogs.md describes them. */
struct FrameMarks
{
    bool any{false};
    std::set<double> predicted;  //!< stamps of frames with a pose
    std::vector<double> lost;    //!< of frames without one, in order
    std::size_t lostWithoutTime{0};

    /** \param latest stamp in the lines before */
    void read(const std::string& text, const std::string& path, std::size_t line, double latest);
};

void FrameMarks::read(
    const std::string& text, const std::string& path, std::size_t line, double latest)
{
    static const std::string kKey = "# pointplane-status";
    if (text.compare(0, kKey.size(), kKey) != 0)
    {
        return;
    }
    any = true;
    if (text.compare(kKey.size(), 1, " ") != 0)
    {
        return;  // the line that explains the others
    }
    std::istringstream words(text.substr(kKey.size()));
    std::string stampText;
    std::string status;
    words >> stampText >> status;
    status = status.substr(0, status.find(':'));
    double stamp = 0;
    const char* const end = stampText.data() + stampText.size();
    const auto [parsed, error] = std::from_chars(stampText.data(), end, stamp);
    if (error != std::errc() || parsed != end || (status != "lost" && status != "predicted"))
    {
        failAt(path, line, "not a status: expected # pointplane-status STAMP lost or predicted");
    }
    if (status == "predicted")
    {
        predicted.insert(stamp);
    }
    else if (stamp > std::max(latest, lost.empty() ? 0 : lost.back()))
    {
        lost.push_back(stamp);
    }
    else  // a stamp that is not after the others may be why the frame is lost
    {
        ++lostWithoutTime;
    }
}

/** Lines of one kind that were left out. */
struct LeftOut
{
    const char* kind;
    std::size_t count{0};
    std::size_t firstLine{0};
    void add(std::size_t line) { firstLine = count++ == 0 ? line : firstLine; }
};
}  // namespace

Trajectory readTrajectoryText(const std::string& path)
{
    std::ifstream file(path);
    if (!file || std::filesystem::is_directory(path))
    {
        throw std::runtime_error(
            "cannot open " + path + ": " + (file ? "is a directory" : std::strerror(errno)));
    }
    skipByteOrderMark(file);
    std::vector<StampedPose> poses;
    FrameMarks marks;
    LeftOut notFinite{"NaN or infinity"};
    LeftOut zeroQuaternion{"a zero quaternion"};
    std::size_t columns = 0;
    std::size_t line = 0;
    for (std::string text; std::getline(file, text);)
    {
        ++line;
        if (!text.empty() && (text[0] == '#' || text[0] == '%'))
        {
            marks.read(text, path, line, poses.empty() ? 0 : poses.back().stamp);
            continue;
        }
        if (text.find(',') != std::string::npos && !decimalComma(text).empty())
        {
            failAt(path, line, "'" + decimalComma(text) + "' has a decimal comma; write points");
        }
        const std::vector<double> v = parseNumbers(text, path, line);
        if (v.empty())
        {
            continue;
        }
        columns = columns == 0 ? v.size() : columns;
        if (v.size() < kMrptColumns || (v.size() == kMrptColumns) != (columns == kMrptColumns))
        {
            failAt(
                path,
                line,
                std::to_string(v.size()) +
                    " columns; expected 8 (TUM: stamp tx ty tz qx qy qz qw) or, in all lines, 7 "
                    "(MRPT: stamp x y z yaw pitch roll)");
        }
        if (!std::all_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); }))
        {
            notFinite.add(line);
        }
        else if (columns >= kTumColumns && v[4] == 0 && v[5] == 0 && v[6] == 0 && v[7] == 0)
        {
            zeroQuaternion.add(line);
        }
        else
        {
            const bool isTum = columns >= kTumColumns;
            poses.push_back({v[0], isTum ? poseFromQuaternion(v) : poseFromYawPitchRoll(v)});
        }
    }
    if (poses.empty())
    {
        throw std::runtime_error(
            "'" + path + "' holds no usable pose (" + std::to_string(line) + " lines)");
    }
    for (StampedPose& pose : poses)
    {
        pose.status =
            marks.predicted.count(pose.stamp) > 0 ? FrameStatus::Predicted : FrameStatus::Tracked;
    }
    Trajectory out = makeTrajectory(path, std::move(poses));
    out.marksFrames = marks.any;
    out.lostStamps = std::move(marks.lost);
    out.lostWithoutTime += marks.lostWithoutTime;
    for (const LeftOut& left : {notFinite, zeroQuaternion})
    {
        if (left.count > 0)
        {
            out.warnings.push_back(
                path + ": " + std::to_string(left.count) + " line(s) with " + left.kind +
                " left out, the first is line " + std::to_string(left.firstLine));
        }
    }
    return out;
}
}  // namespace pointplane
