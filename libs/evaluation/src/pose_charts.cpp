// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/core/se3.h>
#include <pointplane/evaluation/stamp_intervals.h>
#include <pointplane/evaluation/trajectory_charts.h>
#include <pointplane/evaluation/units.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "chart_holes.h"

namespace pointplane
{
namespace
{
constexpr int kAxes = 6;
constexpr std::array<const char*, kAxes> kNames{"x", "y", "z", "roll", "pitch", "yaw"};

/** A pose of the ground truth, or of the estimate with its error. */
struct DrawnPose
{
    double time{0};  //!< since the estimate's first pose [s]
    bool afterHole{false};
    Vector6d pose{Vector6d::Zero()};  //!< x y z [m], roll pitch yaw [rad]
    /** Of the position [m] and, as a rotation vector, of the orientation [rad]. */
    Vector6d error{Vector6d::Zero()};
    Vector6d sigma{Vector6d::Zero()};  //!< of that error
};

Vector6d coordinatesOf(const Eigen::Isometry3d& T)
{
    const Eigen::Matrix3d& R = T.linear();
    Vector6d out;
    out << T.translation(), std::atan2(R(2, 1), R(2, 2)),
        std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0))), std::atan2(R(1, 0), R(0, 0));
    return out;
}

/** Angles as they go on, without jumps of a turn. */
void unwrap(Vector6d& current, const Vector6d& near)
{
    constexpr double kTurn = 2 * 3.14159265358979323846;
    for (int k = 3; k < kAxes; ++k)
    {
        current[k] += kTurn * std::round((near[k] - current[k]) / kTurn);
    }
}

/** At its own stamps, as long as the estimate is. */
std::vector<DrawnPose> truthOf(
    const Trajectory& groundTruth, const Trajectory& estimate, double offset)
{
    const std::vector<bool> holes = holesBefore(groundTruth);
    std::vector<DrawnPose> out;
    for (std::size_t k = 0; k < groundTruth.size(); ++k)
    {
        const double stamp = groundTruth.stamps[k] - offset;
        if (stamp >= estimate.stamps.front() && stamp <= estimate.stamps.back())
        {
            DrawnPose drawn;
            drawn.time = stamp - estimate.stamps.front();
            drawn.afterHole = holes[k];
            drawn.pose = coordinatesOf(groundTruth.poses[k]);
            unwrap(drawn.pose, out.empty() ? drawn.pose : out.back().pose);
            out.push_back(drawn);
        }
    }
    return out;
}

/** The nearest in time. */
const DrawnPose& nearestTo(double time, const std::vector<DrawnPose>& poses)
{
    const auto isBefore = [](const DrawnPose& pose, double t) { return pose.time < t; };
    const auto after = std::lower_bound(poses.begin(), poses.end(), time, isBefore);
    return after == poses.end() ||
                   (after != poses.begin() && time - (after - 1)->time < after->time - time)
               ? *(after - 1)
               : *after;
}

/** Poses that have ground truth. \param drawnTruth tells how many turns there were */
std::vector<DrawnPose> estimateOf(
    const Trajectory& groundTruth,
    const Trajectory& estimate,
    const AteOptions& options,
    const AteResult& aligned,
    const std::vector<DrawnPose>& drawnTruth)
{
    const SampledTruth truth =
        sampleTruth(groundTruth, estimate.stamps, options.offset, TruthAt::Interpolated);
    const Matrix6d Ad = adjoint(aligned.T_truth_estimate);
    const std::vector<bool> holes = holesBefore(estimate);
    bool afterHole = false;
    std::vector<DrawnPose> out;
    for (std::size_t k = 0; k < estimate.size(); ++k)
    {
        afterHole = afterHole || holes[k] || truth.valid[k] == 0;
        if (truth.valid[k] == 0)
        {
            continue;
        }
        Eigen::Isometry3d scaled = estimate.poses[k];
        scaled.translation() *= options.scale;
        const Eigen::Isometry3d T = aligned.T_truth_estimate * scaled;
        DrawnPose pose;
        pose.time = estimate.stamps[k] - estimate.stamps.front();
        pose.afterHole = afterHole;
        afterHole = false;
        pose.pose = coordinatesOf(T);
        Vector6d beside = coordinatesOf(truth.poses[k]);
        unwrap(beside, drawnTruth.empty() ? beside : nearestTo(pose.time, drawnTruth).pose);
        unwrap(pose.pose, beside);
        pose.error << T.translation() - truth.poses[k].translation(),
            so3Log(T.linear() * truth.poses[k].linear().transpose());
        if (!estimate.covs.empty())
        {
            Matrix6d J = Matrix6d::Identity();  // of position and rotation by the left perturbation
            J.topRightCorner<3, 3>() = -hat(T.translation());
            pose.sigma = propagate(J, propagate(Ad, estimate.covs[k])).diagonal().cwiseSqrt();
        }
        out.push_back(pose);
    }
    return out;
}

/** A coordinate of the pose, or its error. */
struct ShownAxis
{
    int axis;
    bool error;

    [[nodiscard]] bool isAngle() const { return axis >= 3; }
    [[nodiscard]] double unit() const { return isAngle() ? kDegreesPerRadian : (error ? 1000 : 1); }
    [[nodiscard]] double of(const DrawnPose& pose) const
    {
        return (error ? pose.error : pose.pose)[axis];
    }
};

/** Adds the poses to a line. */
ChartSeries lineOf(const std::vector<DrawnPose>& poses, const ShownAxis& shown, ChartSeries line)
{
    for (const DrawnPose& pose : poses)
    {
        if (pose.afterHole)
        {
            interrupt(line);
        }
        line.x.push_back(pose.time);
        line.y.push_back(shown.unit() * shown.of(pose));
    }
    return line;
}

/** About the estimated pose, or about no error. */
ChartSeries bandOf(const std::vector<DrawnPose>& poses, const ShownAxis& shown)
{
    ChartSeries band{"3 sigma", {}, {}, ChartSeries::Style::Band, false, "accent"};
    for (const DrawnPose& pose : poses)
    {
        if (pose.afterHole)
        {
            interrupt(band);
        }
        const double middle = shown.error ? 0 : pose.pose[shown.axis];
        band.x.push_back(pose.time);
        band.y.push_back(shown.unit() * (middle - 3 * pose.sigma[shown.axis]));
        band.yUpper.push_back(shown.unit() * (middle + 3 * pose.sigma[shown.axis]));
    }
    return band;
}

Chart chartOf(
    const std::vector<DrawnPose>& poses,
    const std::vector<DrawnPose>& truths,
    const ShownAxis& shown,
    bool withSigma)
{
    const std::string name = kNames[shown.axis];
    Chart chart;
    chart.small = true;
    chart.xLabel = "time [s]";
    chart.title = !shown.error      ? name
                  : shown.isAngle() ? std::string("Rotation error about ") + kNames[shown.axis - 3]
                                    : "Error of " + name;
    chart.yLabel = shown.isAngle() ? "[deg]" : (shown.error ? "[mm]" : "[m]");
    if (withSigma)
    {
        chart.series.push_back(bandOf(poses, shown));
    }
    const ChartSeries estimate{
        shown.error ? "error" : "estimate", {}, {}, ChartSeries::Style::Line, false, "c0"};
    chart.series.push_back(lineOf(poses, shown, estimate));
    if (!shown.error)
    {
        const ChartSeries truth{"ground truth", {}, {}, ChartSeries::Style::Dashed, false, "ink"};
        chart.series.push_back(lineOf(truths, shown, truth));
    }
    return chart;
}
}  // namespace

std::vector<Chart> poseCharts(
    const Trajectory& groundTruth,
    const Trajectory& estimate,
    const AteOptions& options,
    const AteResult& aligned)
{
    const std::vector<DrawnPose> truths = truthOf(groundTruth, estimate, options.offset);
    const std::vector<DrawnPose> poses =
        estimateOf(groundTruth, estimate, options, aligned, truths);
    if (poses.empty())
    {
        throw std::runtime_error("no pose has ground truth before and after it");
    }
    std::vector<Chart> charts;
    for (const int first : {0, 3})
    {
        for (const bool error : {false, true})
        {
            for (int axis = first; axis < first + 3; ++axis)
            {
                charts.push_back(chartOf(poses, truths, {axis, error}, !estimate.covs.empty()));
            }
        }
    }
    return charts;
}
}  // namespace pointplane
