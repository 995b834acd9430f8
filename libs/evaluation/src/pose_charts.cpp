// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/core/se3.h>
#include <pointplane/evaluation/trajectory_charts.h>
#include <pointplane/evaluation/units.h>

#include <array>
#include <cmath>
#include <stdexcept>

namespace pointplane
{
namespace
{
constexpr int kAxes = 6;
constexpr std::array<const char*, kAxes> kNames{"x", "y", "z", "roll", "pitch", "yaw"};

/** A pose of the estimate beside the ground truth's at its stamp. */
struct PoseBeside
{
    double time;               //!< since the first pose [s]
    Vector6d estimate, truth;  //!< x y z [m], roll pitch yaw [rad]
    Vector6d error;  //!< of the position [m] and, as a rotation vector, of the orientation [rad]
    Vector6d sigma;  //!< of that error
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

std::vector<PoseBeside> posesBeside(
    const Trajectory& groundTruth,
    const Trajectory& estimate,
    const AteOptions& options,
    const AteResult& aligned)
{
    const SampledTruth truth =
        sampleTruth(groundTruth, estimate.stamps, options.offset, TruthAt::Interpolated);
    const Matrix6d Ad = adjoint(aligned.T_truth_estimate);
    std::vector<PoseBeside> out;
    for (std::size_t k = 0; k < estimate.size(); ++k)
    {
        if (truth.valid[k] == 0)
        {
            continue;
        }
        Eigen::Isometry3d scaled = estimate.poses[k];
        scaled.translation() *= options.scale;
        const Eigen::Isometry3d T = aligned.T_truth_estimate * scaled;
        PoseBeside pose;
        pose.time = estimate.stamps[k] - estimate.stamps.front();
        pose.truth = coordinatesOf(truth.poses[k]);
        pose.estimate = coordinatesOf(T);
        unwrap(pose.truth, out.empty() ? pose.truth : out.back().truth);
        unwrap(pose.estimate, pose.truth);
        pose.error << T.translation() - truth.poses[k].translation(),
            so3Log(T.linear() * truth.poses[k].linear().transpose());
        pose.sigma.setZero();
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

Chart chartOf(const std::vector<PoseBeside>& poses, int axis, bool error, bool withSigma)
{
    const bool angle = axis >= 3;
    const double unit = angle ? kDegreesPerRadian : (error ? 1000 : 1);
    Chart chart;
    chart.small = true;
    chart.xLabel = "time [s]";
    chart.title = error ? (angle ? std::string("Rotation error about ") + kNames[axis - 3]
                                 : std::string("Error of ") + kNames[axis])
                        : kNames[axis];
    chart.yLabel = angle ? "[deg]" : (error ? "[mm]" : "[m]");
    ChartSeries band{"3 sigma", {}, {}, ChartSeries::Style::Band, false, "accent"};
    ChartSeries estimate{
        error ? "error" : "estimate", {}, {}, ChartSeries::Style::Line, false, "c0"};
    ChartSeries truth{"ground truth", {}, {}, ChartSeries::Style::Dashed, false, "ink"};
    for (const PoseBeside& pose : poses)
    {
        const double middle = error ? 0 : pose.estimate[axis];
        band.x.push_back(pose.time);
        band.y.push_back(unit * (middle - 3 * pose.sigma[axis]));
        band.yUpper.push_back(unit * (middle + 3 * pose.sigma[axis]));
        estimate.x.push_back(pose.time);
        estimate.y.push_back(unit * (error ? pose.error[axis] : pose.estimate[axis]));
        truth.x.push_back(pose.time);
        truth.y.push_back(unit * pose.truth[axis]);
    }
    if (withSigma)
    {
        chart.series.push_back(band);
    }
    chart.series.push_back(estimate);
    if (!error)
    {
        chart.series.push_back(truth);
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
    const std::vector<PoseBeside> poses = posesBeside(groundTruth, estimate, options, aligned);
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
                charts.push_back(chartOf(poses, axis, error, !estimate.covs.empty()));
            }
        }
    }
    return charts;
}
}  // namespace pointplane
