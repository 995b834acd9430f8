// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/byte_order_mark.h>
#include <pointplane/core/counted.h>
#include <pointplane/core/read_errors.h>
#include <pointplane/evaluation/trajectory_text.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "FrameMarks.h"
#include "text_line.h"

namespace pointplane
{
namespace
{
constexpr std::size_t kMrptColumns = 7;
constexpr std::size_t kTumColumns = 8;
constexpr double kNormTolerance = 0.01;  // files have four digits and more

bool isBeyondATurn(double angle)
{
    constexpr double kTurn = 2 * 3.14159265358979323846;
    return std::abs(angle) > kTurn;
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

/** Lines of one kind that the user is told of. */
struct NotedLines
{
    std::size_t count{0};
    std::size_t firstLine{0};
    void add(std::size_t line) { firstLine = count++ == 0 ? line : firstLine; }

    /** Adds "FILE: 2 lines with WHAT, the first is line 3MORE", if there are any. */
    void warn(Trajectory& trajectory, const std::string& what, const std::string& more = "") const
    {
        if (count > 0)
        {
            trajectory.warnings.push_back(
                trajectory.name + ": " + counted(count, "line") + " with " + what +
                ", the first is line " + std::to_string(firstLine) + more);
        }
    }
};

/** What a comment like those of pointplane-odometry and pointplane-simulate says of the axes. */
Body bodyOf(const std::string& comment)
{
    return comment.find("x right, y down") != std::string::npos     ? Body::Camera
           : comment.find("x forward, y left") != std::string::npos ? Body::Robot
                                                                    : Body::Unknown;
}

/** Which other format has so many columns: read as TUM's, its lines would give a score. */
std::string otherFormat(std::size_t columns)
{
    constexpr std::size_t kEuroc = 17, kKitti = 12;
    return columns == kEuroc
               ? ", as EuRoC's ground truth (nanoseconds, quaternion qw qx qy qz: convert it)"
           : columns == kKitti ? ", as KITTI's poses (matrices without stamps: convert them)"
                               : "";
}

/** Poses from the lines of a file that are no comments. */
class PoseLines
{
 public:
    explicit PoseLines(const std::string& path) : path_(path) {}

    void add(const std::string& text, std::size_t line);
    [[nodiscard]] double latestStamp() const { return poses_.empty() ? 0 : poses_.back().stamp; }

    /** \param numLines of the file \throws std::runtime_error if there is no pose */
    [[nodiscard]] Trajectory result(const FrameMarks& marks, std::size_t numLines);

 private:
    void requireColumns(std::size_t columns, std::size_t line);

    const std::string& path_;
    std::vector<StampedPose> poses_;
    std::vector<double> lost_;  // stamps of lines without a usable pose
    std::size_t columns_{0};
    NotedLines notFinite_, zeroQuaternion_, otherNorm_, largeAngle_;
};

void PoseLines::requireColumns(std::size_t columns, std::size_t line)
{
    columns_ = columns_ == 0 ? columns : columns_;
    if ((columns != kMrptColumns && columns != kTumColumns) || columns != columns_)
    {
        failAt(
            path_,
            line,
            std::to_string(columns) + " columns" + otherFormat(columns) +
                "; expected 8 (TUM: stamp tx ty tz qx qy qz qw) or 7 (MRPT: stamp x y z yaw pitch "
                "roll), the same in all lines");
    }
}

void PoseLines::add(const std::string& text, std::size_t line)
{
    const std::vector<double> v =
        numbersOfLine(text, path_, line, columns_ == 0 ? "; a header must begin with #" : "");
    if (v.empty())
    {
        return;
    }
    requireColumns(v.size(), line);
    const bool isTum = columns_ == kTumColumns;
    const double norm = isTum ? Eigen::Vector4d(v[4], v[5], v[6], v[7]).norm() : 1;
    const bool isFinite =
        std::isfinite(norm) &&  // of huge numbers it is not
        std::all_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); });
    if (!isFinite || norm == 0)
    {
        (isFinite ? zeroQuaternion_ : notFinite_).add(line);
        if (std::isfinite(v[0]))
        {
            lost_.push_back(v[0]);
        }
    }
    else
    {
        if (std::abs(norm - 1) > kNormTolerance)
        {
            otherNorm_.add(line);
        }
        if (!isTum && std::any_of(v.begin() + 4, v.end(), isBeyondATurn))
        {
            largeAngle_.add(line);
        }
        poses_.push_back({v[0], isTum ? poseFromQuaternion(v) : poseFromYawPitchRoll(v)});
    }
}

Trajectory PoseLines::result(const FrameMarks& marks, std::size_t numLines)
{
    if (poses_.empty())
    {
        throw std::runtime_error(
            "'" + path_ + "' holds no usable pose (" + std::to_string(numLines) + " lines)");
    }
    for (StampedPose& pose : poses_)
    {
        pose.status =
            marks.predicted.count(pose.stamp) > 0 ? FrameStatus::Predicted : FrameStatus::Tracked;
    }
    Trajectory out = makeTrajectory(path_, std::move(poses_));
    out.marksFrames = marks.any;
    std::vector<double>& lost = out.lostStamps;
    lost.insert(lost.end(), marks.lost.begin(), marks.lost.end());
    lost.insert(lost.end(), lost_.begin(), lost_.end());
    std::sort(lost.begin(), lost.end());
    out.lostWithoutTime += marks.lostWithoutTime;
    notFinite_.warn(out, "NaN or infinity left out");
    zeroQuaternion_.warn(out, "a zero quaternion left out");
    otherNorm_.warn(out, "a quaternion whose norm is not 1", "; are columns 5 to 8 qx qy qz qw?");
    largeAngle_.warn(
        out, "an angle beyond 2 pi", "; are angles in degrees? They must be in radians");
    return out;
}
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
    PoseLines poses(path);
    FrameMarks marks;
    Body body = Body::Unknown;
    std::size_t line = 0;
    for (std::string text; std::getline(file, text);)
    {
        ++line;
        if (!text.empty() && (text[0] == '#' || text[0] == '%'))
        {
            marks.read(text, path, line, poses.latestStamp());
            body = body == Body::Unknown ? bodyOf(text) : body;
        }
        else
        {
            poses.add(text, line);
        }
    }
    requireRead(file, path);
    Trajectory out = poses.result(marks, line);
    out.body = body;
    return out;
}
}  // namespace pointplane
