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

/** In two of the world's axes. */
struct PathView
{
    int horizontal, vertical;

    void add(ChartSeries& series, const Eigen::Vector3d& position) const
    {
        series.x.push_back(position[horizontal]);
        series.y.push_back(position[vertical]);
    }
};

ChartSeries markAt(
    const Eigen::Vector3d& position,
    const PathView& view,
    const std::string& name,
    const std::string& colour,
    ChartSeries::Style style)
{
    ChartSeries series{name, {}, {}, style, false, colour};
    view.add(series, position);
    return series;
}

/** Only the part of the ground truth that the estimate covers. */
ChartSeries truthOf(const Trajectory& groundTruth, const AteResult& ate, const PathView& view)
{
    const ChartHoles holes(groundTruth);
    ChartSeries series{"ground truth", {}, {}, ChartSeries::Style::Line, false, "ink"};
    for (std::size_t k = ate.errors.front().truth; k <= ate.errors.back().truth; ++k)
    {
        if (holes.isBefore(k))
        {
            interrupt(series);
        }
        view.add(series, groundTruth.poses[k].translation());
    }
    return series;
}

/** An estimate in the ground truth's world. */
struct PathSeries
{
    ChartSeries compared;   //!< where there is ground truth
    ChartSeries remainder;  //!< the other parts, beyond its end for example
};

/** Of a pose of the path, in the ground truth's frame [m]. */
Eigen::Vector3d pointOf(const DrawnPath& path, std::size_t pose)
{
    return path.ate.T_truth_estimate * (path.scale * path.estimate.poses[pose].translation());
}

/** \param hasTruth of each pose \param isCompared of the way to each pose, and to one more */
ChartSeries remainderOf(
    const DrawnPath& path,
    const PathView& view,
    const ChartHoles& holes,
    const std::vector<bool>& hasTruth,
    const std::vector<bool>& isCompared)
{
    ChartSeries out;
    out.name = "no ground truth";
    out.style = ChartSeries::Style::Dashed;
    const auto isWay = [&](std::size_t to)
    { return to > 0 && to < path.estimate.size() && !isCompared[to] && !holes.isBefore(to); };
    for (std::size_t k = 0; k < path.estimate.size(); ++k)
    {
        const bool isAlone = !hasTruth[k] && !isCompared[k] && !isCompared[k + 1];
        if (!isWay(k))
        {
            interrupt(out);
        }
        if (isWay(k) || isWay(k + 1) || isAlone)
        {
            view.add(out, pointOf(path, k));
        }
    }
    return out;
}

PathSeries pathSeries(const DrawnPath& path, const PathView& view)
{
    const Trajectory& estimate = path.estimate;
    const ChartHoles holes(estimate);
    PathSeries out;
    out.compared.name = path.name;
    std::vector<bool> hasTruth(estimate.size(), false);
    std::vector<bool> isCompared(estimate.size() + 1, false);  // the way to each pose
    std::size_t before = path.ate.errors.front().estimate;
    for (const AteError& error : path.ate.errors)
    {
        if (holes.isBetween(before, error.estimate))
        {
            interrupt(out.compared);
        }
        else
        {
            for (std::size_t k = before + 1; k <= error.estimate; ++k)
            {
                isCompared[k] = true;
            }
        }
        before = error.estimate;
        hasTruth[before] = true;
        view.add(out.compared, pointOf(path, before));
        out.compared.level.push_back(1000 * error.translation);
    }
    out.remainder = remainderOf(path, view, holes, hasTruth, isCompared);
    return out;
}

/** All ellipses as one line with gaps. */
ChartSeries ellipseSeries(
    const Trajectory& estimate, const Eigen::Isometry3d& T_world_poses, const PathView& view)
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
            view.horizontal,
            view.vertical);
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
/** The paths, and then what of them was not compared. */
std::vector<ChartSeries> pathsIn(const PathView& view, const std::vector<DrawnPath>& paths)
{
    const bool isSingle = paths.size() == 1;
    std::vector<ChartSeries> out, remainders;
    for (const DrawnPath& path : paths)
    {
        PathSeries series = pathSeries(path, view);
        series.remainder.colour = isSingle ? "muted" : "c" + std::to_string(out.size() % 8);
        if (!isSingle)
        {
            series.compared.level.clear();
        }
        if (!series.remainder.x.empty())
        {
            series.remainder.name = remainders.empty() ? series.remainder.name : "";
            remainders.push_back(std::move(series.remainder));
        }
        out.push_back(std::move(series.compared));
    }
    out.insert(out.end(), remainders.begin(), remainders.end());
    return out;
}
}  // namespace

std::vector<Chart> pathCharts(const Trajectory& groundTruth, const std::vector<DrawnPath>& paths)
{
    using Style = ChartSeries::Style;
    const DrawnPath& first = paths.front();
    const bool isSingle = paths.size() == 1;
    std::vector<Chart> charts;
    for (const bool above : {true, false})
    {
        const PathView view{0, above ? 1 : 2};
        Chart chart;
        chart.title = above ? "Path from above" : "Path from the side";
        chart.xLabel = "x [m]";
        chart.yLabel = above ? "y [m]" : "z [m]";
        chart.equalScales = true;
        chart.series = pathsIn(view, paths);
        if (isSingle)
        {
            chart.levelLabel =
                first.estimate.covs.empty() ? "error [mm]" : "error, aligned at start [mm]";
        }
        if (isSingle && !first.estimate.covs.empty())
        {
            chart.series.push_back(ellipseSeries(first.estimate, first.ate.T_truth_estimate, view));
        }
        const auto placeOf = [&](const AteError& error)
        { return groundTruth.poses[error.truth].translation(); };
        chart.series.push_back(truthOf(groundTruth, first.ate, view));
        if (!isSingle)
        {
            chart.series.back().style = Style::Dashed;  // hides no run that is right
        }
        chart.series.push_back(
            markAt(placeOf(first.ate.errors.front()), view, "start", "c2", Style::Start));
        chart.series.push_back(
            markAt(placeOf(first.ate.errors.back()), view, "end", "alarm", Style::End));
        charts.push_back(std::move(chart));
    }
    return charts;
}
}  // namespace pointplane
