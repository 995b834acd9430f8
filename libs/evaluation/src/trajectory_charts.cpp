// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/core/se3.h>
#include <pointplane/evaluation/chi_square.h>
#include <pointplane/evaluation/trajectory_charts.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pointplane
{
namespace
{
constexpr double kDegrees = 180 / 3.14159265358979323846;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kEllipses = 12;
constexpr const char* kGrey = "#868e96";
constexpr const char* kOrange = "#f08c00";
constexpr const char* kRed = "#c2255c";
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
        series.y.push_back(kNaN);
    }
    return series;
}

/** Horizontal lines over [0, end], as one series. */
ChartSeries levels(
    const std::string& name, const std::vector<double>& values, double end, const char* colour)
{
    ChartSeries series{name, {}, {}, ChartSeries::Style::Dashed, false, colour};
    for (const double value : values)
    {
        series.x.insert(series.x.end(), {0, end, end});
        series.y.insert(series.y.end(), {value, value, kNaN});
    }
    return series;
}

ChartSeries columnSeries(
    const FrameTable& table, const std::string& column, const std::string& name, bool rightAxis)
{
    ChartSeries series;
    series.name = name;
    series.rightAxis = rightAxis;
    series.y = table.column(column);
    for (const double stamp : table.stamps())
    {
        series.x.push_back(stamp - table.stamps().front());
    }
    return series;
}

/** Adds a chart of those columns that are there. */
void addColumns(
    std::vector<Chart>& charts,
    Chart chart,
    const FrameTable& table,
    const std::vector<std::pair<std::string, std::string>>& left,
    const std::vector<std::pair<std::string, std::string>>& right)
{
    for (const auto& [column, name] : left)
    {
        if (table.has(column))
        {
            chart.series.push_back(columnSeries(table, column, name, false));
        }
    }
    for (const auto& [column, name] : right)
    {
        if (table.has(column))
        {
            chart.series.push_back(columnSeries(table, column, name, true));
        }
    }
    if (!chart.series.empty())
    {
        charts.push_back(std::move(chart));
    }
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

Chart relativeErrorChart(
    const Trajectory& estimate, const RpeOptions& options, const RpeResult& result)
{
    Chart chart;
    char delta[64];
    std::snprintf(delta, sizeof delta, "%g %s", options.delta, nameOf(options.unit).c_str());
    chart.title = std::string("Relative error over ") + delta;
    chart.xLabel = "time of the pair's start [s]";
    chart.yLabel = "translation [mm]";
    chart.yRightLabel = "rotation [deg]";
    ChartSeries translation;
    translation.name = "translation";
    ChartSeries rotation;
    rotation.name = "rotation";
    rotation.rightAxis = true;
    for (const RpePair& pair : result.pairs)
    {
        const double t = estimate.stamps[pair.i] - estimate.stamps.front();
        translation.x.push_back(t);
        translation.y.push_back(1000 * pair.translation);
        rotation.x.push_back(t);
        rotation.y.push_back(kDegrees * pair.rotation);
    }
    chart.series = {translation, rotation};
    return chart;
}

Chart positionErrorChart(const Trajectory& estimate, const AteResult& result)
{
    Chart chart;
    chart.title = "Position error";
    chart.xLabel = "time [s]";
    chart.yLabel = "distance to the ground truth [mm]";
    ChartSeries series;
    series.name = "position error";
    for (const AteError& error : result.errors)
    {
        series.x.push_back(estimate.stamps[error.estimate] - estimate.stamps.front());
        series.y.push_back(1000 * error.translation);
    }
    chart.series.push_back(std::move(series));
    return chart;
}

Chart neesChart(
    const Trajectory& estimate,
    const std::vector<NeesIncrement>& increments,
    const NeesResult& result)
{
    Chart chart;
    chart.title = "NEES of increments of " + nameOf(result.interval);
    chart.xLabel = "time of the increment's start [s]";
    chart.yLabel = "NEES per degree of freedom";
    chart.logY = true;
    ChartSeries series;
    series.name = "NEES";
    series.style = ChartSeries::Style::Points;
    for (const NeesIncrement& increment : increments)
    {
        series.x.push_back(estimate.stamps[increment.i] - estimate.stamps.front());
        series.y.push_back(increment.nees / 6);
    }
    const double end = series.x.empty() ? 1 : series.x.back();
    chart.series.push_back(std::move(series));
    chart.series.push_back(levels(
        "95 % of single ones",
        {chiSquareQuantile(0.025, 6) / 6, chiSquareQuantile(0.975, 6) / 6},
        end,
        kGrey));
    chart.series.push_back(levels("mean", {result.joint.nees}, end, kRed));
    chart.series.push_back(
        levels("95 % of means", {result.joint.lower, result.joint.upper}, end, kOrange));
    return chart;
}

std::vector<Chart> errorAgainstSigmaCharts(
    const Trajectory& estimate, const std::vector<NeesIncrement>& increments)
{
    static const char* const kNames[] = {"x", "y", "z", "rx", "ry", "rz"};
    std::vector<Chart> charts;
    for (const bool translation : {true, false})
    {
        Chart chart;
        chart.title = translation ? "Translation error in standard deviations"
                                  : "Rotation error in standard deviations";
        chart.xLabel = "time of the increment's start [s]";
        chart.yLabel = "error / sigma";
        double end = 1;
        for (int k = translation ? 0 : 3; k < (translation ? 3 : 6); ++k)
        {
            ChartSeries series;
            series.name = kNames[k];
            for (const NeesIncrement& increment : increments)
            {
                series.x.push_back(estimate.stamps[increment.i] - estimate.stamps.front());
                series.y.push_back(increment.error[k] / std::sqrt(increment.cov(k, k)));
            }
            end = series.x.empty() ? end : series.x.back();
            chart.series.push_back(std::move(series));
        }
        chart.series.push_back(levels("3 sigma", {-3, 3}, end, kGrey));
        charts.push_back(std::move(chart));
    }
    return charts;
}

std::vector<Chart> frameCharts(const FrameTable& table)
{
    std::vector<Chart> charts;
    if (table.size() == 0)
    {
        return charts;
    }
    Chart features;
    features.title = "Points and planes per frame";
    features.xLabel = "time [s]";
    features.yLabel = "points";
    features.yRightLabel = "planes";
    addColumns(
        charts,
        features,
        table,
        {{"numPoints", "points"}, {"numPointPairs", "point pairs"}, {"numPointInliers", "inliers"}},
        {{"numPlanes", "planes"}, {"numPlanePairs", "plane pairs"}});

    if (!table.status().empty())
    {
        Chart status;
        status.title = "Tracking status";
        status.xLabel = "time [s]";
        status.yLabel = "";
        status.yNames = {"lost", "predicted", "tracked"};
        ChartSeries series;
        series.name = "status";
        series.style = ChartSeries::Style::Steps;
        for (std::size_t k = 0; k < table.size(); ++k)
        {
            const std::string& s = table.status()[k];
            series.x.push_back(table.stamps()[k] - table.stamps().front());
            series.y.push_back(s == "lost" ? 0 : s == "predicted" ? 1 : 2);
        }
        status.series.push_back(std::move(series));
        charts.push_back(std::move(status));
    }
    Chart times;
    times.title = "Time per stage";
    times.xLabel = "time [s]";
    times.yLabel = "ms per frame";
    addColumns(
        charts,
        times,
        table,
        {{"msTotal", "total"},
         {"msPoints", "points"},
         {"msPlanes", "planes"},
         {"msMatching", "matching"},
         {"msPose", "pose"}},
        {});
    return charts;
}
}  // namespace pointplane
