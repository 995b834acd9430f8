// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/core/se3.h>
#include <pointplane/evaluation/trajectory_charts.h>

#include <Eigen/Eigenvalues>

#include <cmath>
#include <limits>

#include "chart_holes.h"

namespace pointplane
{
namespace
{
constexpr std::size_t kEllipses = 12;

/** Positions with a hole before those that have one. */
struct Path
{
    std::vector<Eigen::Vector3d> positions;
    std::vector<bool> holes;
};

/** In two of the world's axes. */
ChartSeries pathSeries(
    const std::string& name,
    const Path& path,
    int horizontal,
    int vertical,
    const std::string& colour,
    ChartSeries::Style style = ChartSeries::Style::Line)
{
    ChartSeries series;
    series.name = name;
    series.colour = colour;
    series.style = style;
    for (std::size_t k = 0; k < path.positions.size(); ++k)
    {
        if (path.holes[k])
        {
            interrupt(series);
        }
        series.x.push_back(path.positions[k][horizontal]);
        series.y.push_back(path.positions[k][vertical]);
    }
    return series;
}

/** In the ground truth's world. */
Path pathOf(const DrawnPath& path)
{
    Path out{{}, holesBefore(path.estimate)};
    for (const Eigen::Isometry3d& pose : path.estimate.poses)
    {
        out.positions.push_back(path.ate.T_truth_estimate * (path.scale * pose.translation()));
    }
    return out;
}

/** Only the part of the ground truth that the estimate covers. */
Path truthOf(const Trajectory& groundTruth, const AteResult& ate)
{
    const std::vector<bool> holes = holesBefore(groundTruth);
    Path out;
    for (std::size_t k = ate.errors.front().truth; k <= ate.errors.back().truth; ++k)
    {
        out.positions.push_back(groundTruth.poses[k].translation());
        out.holes.push_back(holes[k]);
    }
    return out;
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
    series.colour = "accent";
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

namespace
{
/** One path: coloured by its error, with ellipses. */
void addPath(Chart& chart, const DrawnPath& path, int horizontal, int vertical)
{
    const Path whole = pathOf(path);
    chart.series.push_back(pathSeries("", whole, horizontal, vertical, "muted"));
    ChartSeries coloured = pathSeries(path.name, {}, horizontal, vertical, "muted");
    std::size_t before = 0;
    for (const AteError& error : path.ate.errors)
    {
        if (isHoleBetween(whole.holes, before, error.estimate))
        {
            interrupt(coloured);
        }
        before = error.estimate;
        coloured.x.push_back(whole.positions[error.estimate][horizontal]);
        coloured.y.push_back(whole.positions[error.estimate][vertical]);
        coloured.level.push_back(1000 * error.translation);
    }
    chart.levelLabel = "position error [mm]";
    chart.series.push_back(std::move(coloured));
    if (!path.estimate.covs.empty())
    {
        chart.series.push_back(
            ellipseSeries(path.estimate, path.ate.T_truth_estimate, horizontal, vertical));
    }
}
}  // namespace

std::vector<Chart> pathCharts(const Trajectory& groundTruth, const std::vector<DrawnPath>& paths)
{
    const Path truth = truthOf(groundTruth, paths.front().ate);
    std::vector<Chart> charts;
    for (const bool above : {true, false})
    {
        const int vertical = above ? 1 : 2;
        Chart chart;
        chart.title = above ? "Path from above" : "Path from the side";
        chart.xLabel = "x [m]";
        chart.yLabel = above ? "y [m]" : "z [m]";
        chart.equalScales = true;
        for (const DrawnPath& path : paths)
        {
            if (paths.size() == 1)
            {
                addPath(chart, path, 0, vertical);
            }
            else
            {
                chart.series.push_back(pathSeries(path.name, pathOf(path), 0, vertical, ""));
            }
        }
        using Style = ChartSeries::Style;
        chart.series.push_back(pathSeries("ground truth", truth, 0, vertical, "ink"));
        chart.series.push_back(pathSeries(
            "start", {{truth.positions.front()}, {false}}, 0, vertical, "c2", Style::Start));
        chart.series.push_back(pathSeries(
            "end", {{truth.positions.back()}, {false}}, 0, vertical, "alarm", Style::End));
        charts.push_back(std::move(chart));
    }
    return charts;
}
}  // namespace pointplane
