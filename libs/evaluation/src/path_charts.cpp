// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/core/se3.h>
#include <pointplane/evaluation/trajectory_charts.h>

#include <Eigen/Eigenvalues>

#include <cmath>
#include <limits>

namespace pointplane
{
namespace
{
constexpr std::size_t kEllipses = 12;
constexpr const char* kGrey = "#868e96";
constexpr const char* kOrange = "#f08c00";
constexpr const char* kBlue = "#0a66c2";

ChartSeries pathSeries(
    const std::string& name,
    const std::vector<Eigen::Isometry3d>& poses,
    const Eigen::Isometry3d& T_world_poses,
    int horizontal,
    int vertical)
{
    ChartSeries series;
    series.name = name;
    for (const Eigen::Isometry3d& pose : poses)
    {
        const Eigen::Vector3d p = T_world_poses * pose.translation();
        series.x.push_back(p[horizontal]);
        series.y.push_back(p[vertical]);
    }
    return series;
}

/** All ellipses as one line with gaps. */
ChartSeries ellipseSeries(
    const Trajectory& estimate,
    const Eigen::Isometry3d& T_world_poses,
    int horizontal,
    int vertical)
{
    ChartSeries series;
    series.name = "3 sigma";
    series.colour = kOrange;
    const Matrix6d Ad = adjoint(T_world_poses);
    for (std::size_t n = 1; n <= kEllipses; ++n)
    {
        const std::size_t k = n * (estimate.size() - 1) / kEllipses;
        const auto contour = positionEllipse(
            T_world_poses * estimate.poses[k],
            propagate(Ad, estimate.covs[k]),
            horizontal,
            vertical);
        for (const Eigen::Vector2d& p : contour)
        {
            series.x.push_back(p.x());
            series.y.push_back(p.y());
        }
        series.x.push_back(contour.front().x());
        series.y.push_back(std::numeric_limits<double>::quiet_NaN());
    }
    return series;
}
}  // namespace

std::vector<Eigen::Vector2d> positionEllipse(
    const Eigen::Isometry3d& T_world_body,
    const Matrix6d& cov,
    int horizontalAxis,
    int verticalAxis,
    int points)
{
    const Eigen::Vector3d p = T_world_body.translation();
    Matrix36d J;  // of p with respect to the left perturbation
    J << Eigen::Matrix3d::Identity(), -hat(p);
    const Eigen::Matrix3d C = propagate(J, cov);
    Eigen::Matrix2d C2;
    C2 << C(horizontalAxis, horizontalAxis), C(horizontalAxis, verticalAxis),
        C(verticalAxis, horizontalAxis), C(verticalAxis, verticalAxis);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> es(C2);
    const Eigen::Vector2d radii = 3 * es.eigenvalues().cwiseMax(0).cwiseSqrt();
    std::vector<Eigen::Vector2d> out;
    for (int k = 0; k < points; ++k)
    {
        const double angle = 2 * 3.14159265358979323846 * k / (points - 1);
        const Eigen::Vector2d onCircle(std::cos(angle), std::sin(angle));
        out.push_back(
            Eigen::Vector2d(p[horizontalAxis], p[verticalAxis]) +
            es.eigenvectors() * radii.cwiseProduct(onCircle));
    }
    return out;
}

std::vector<Chart> pathCharts(
    const Trajectory& groundTruth, const Trajectory& estimate, const AteResult& ate)
{
    // Only the part of the ground truth that the estimate covers.
    std::vector<Eigen::Isometry3d> truth;
    for (const AteError& pair : ate.errors)
    {
        truth.push_back(groundTruth.poses[pair.truth]);
    }
    std::vector<Chart> charts;
    for (const bool above : {true, false})
    {
        const int vertical = above ? 1 : 2;
        Chart chart;
        chart.title = above ? "Path from above" : "Path from the side";
        chart.xLabel = "x [m]";
        chart.yLabel = above ? "y [m]" : "z [m]";
        chart.equalScales = true;
        chart.series.push_back(
            pathSeries("ground truth", truth, Eigen::Isometry3d::Identity(), 0, vertical));
        chart.series.back().colour = kGrey;
        chart.series.push_back(
            pathSeries("estimate", estimate.poses, ate.T_truth_estimate, 0, vertical));
        chart.series.back().colour = kBlue;
        if (!estimate.covs.empty())
        {
            chart.series.push_back(ellipseSeries(estimate, ate.T_truth_estimate, 0, vertical));
        }
        charts.push_back(std::move(chart));
    }
    return charts;
}
}  // namespace pointplane
