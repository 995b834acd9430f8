// SPDX-License-Identifier: BSD-3-Clause
#include "report_paths.h"

#include <pointplane/evaluation/trajectory_charts.h>
#include <pointplane/evaluation/units.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "report_section.h"
#include "result_output.h"

namespace pointplane
{
namespace
{
const std::vector<std::string> kStatisticsHeader{"", "rmse", "mean", "median", "std", "min", "max"};

/** With as many decimals as show four digits of the RMSE. */
std::vector<std::string> statisticsCells(const std::string& name, const Statistics& s)
{
    constexpr double kRoundsUp = 1.00005;  // 9.9996 is shown as 10.00
    const double digits = s.rmse > 0 ? 3 - std::floor(std::log10(kRoundsUp * s.rmse)) : 4;
    const int decimals = static_cast<int>(std::clamp(digits, 0.0, 6.0));
    std::vector<std::string> cells{name};
    for (const double value : {s.rmse, s.mean, s.median, s.std, s.min, s.max})
    {
        cells.push_back(format("%.*f", decimals, value));
    }
    return cells;
}

class PathSections
{
 public:
    explicit PathSections(const ReportedRun& run)
        : run_(run),
          truth_(withBody(run.groundTruth, run.nees.T_truth_body)),
          measured_(withoutLost(run.estimate)),
          fixedDelta_(run.rpe)
    {
        fixedDelta_.fixedDelta = true;
        fixedDelta_.maxPairs = run.rpe.fixedDelta ? run.rpe.maxPairs : 0;
    }

    void addTo(HtmlReport& report) const
    {
        addSection(report, "relative pose error", [&] { addRelativeTable(report); });
        addSection(report, "absolute trajectory error", [&] { addAbsolute(report); });
        addSection(report, "charts of relative errors", [&] { addRelativeCharts(report); });
        addAll(report, errorOverInterval(truth_, measured_, run_.rpe));
        addSection(report, "poses over time", [&] { addPoses(report); });
    }

 private:
    static void addAll(HtmlReport& report, const std::vector<Chart>& charts)
    {
        for (const Chart& chart : charts)
        {
            report.addChart(chart);
        }
    }

    void addRelativeTable(HtmlReport& report) const
    {
        const RpeResult rpe = relativePoseError(truth_, measured_, run_.rpe);
        report.addTable(
            "Relative pose error",
            kStatisticsHeader,
            {statisticsCells("translation [mm]", scaled(rpe.translation, 1000)),
             statisticsCells("rotation [deg]", scaled(rpe.rotation, kDegreesPerRadian))},
            describe(run_.rpe, rpe) + ", " + describe(rpe.coverage));
    }

    void addAbsolute(HtmlReport& report) const
    {
        const AteResult ate = absoluteTrajectoryError(truth_, measured_, run_.ate);
        report.addTable(
            "Absolute trajectory error",
            kStatisticsHeader,
            {statisticsCells("translation [mm]", scaled(ate.translation, 1000))},
            describe(run_.ate, ate, measured_.size()) + ", " + describe(ate.coverage));
        // Covariances are relative to the first pose, so that is where ellipses start from.
        const bool fromStart =
            !measured_.covs.empty() && run_.ate.alignment != Alignment::FirstPose;
        const AteResult map =
            fromStart ? absoluteTrajectoryError(truth_, measured_, aligned()) : ate;
        if (fromStart)
        {
            report.addParagraph(
                "The two paths are aligned at the first pose, where the covariances start. So "
                "their "
                "errors grow from there, and are not the absolute trajectory error.");
        }
        addAll(report, pathCharts(truth_, {{"estimate", measured_, map, run_.ate.scale}}));
        report.addChart(positionErrorChart(measured_, ate));
        report.addChart(positionErrorHistogram(ate));
    }

    void addRelativeCharts(HtmlReport& report) const
    {
        const RpeResult rpe = relativePoseError(truth_, measured_, fixedDelta_);
        addAll(report, relativeErrorCharts(measured_, fixedDelta_, rpe));
        addAll(report, errorHistograms(fixedDelta_, rpe));
    }

    void addPoses(HtmlReport& report) const
    {
        const std::vector<Chart> charts = poseCharts(
            truth_, measured_, run_.ate, absoluteTrajectoryError(truth_, measured_, aligned()));
        report.addParagraph("Poses in the ground truth's world, aligned at the first one:");
        addAll(report, charts);
    }

    [[nodiscard]] AteOptions aligned() const
    {
        AteOptions out = run_.ate;
        out.alignment = Alignment::FirstPose;
        return out;
    }

    const ReportedRun& run_;
    Trajectory truth_, measured_;
    RpeOptions fixedDelta_;
};
}  // namespace

void addPathSections(HtmlReport& report, const ReportedRun& run)
{
    PathSections(run).addTo(report);
}
}  // namespace pointplane
