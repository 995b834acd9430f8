// SPDX-License-Identifier: BSD-3-Clause
#include "PosesFromStart.h"

#include <pointplane/core/se3.h>
#include <pointplane/evaluation/association.h>
#include <pointplane/evaluation/units.h>

namespace pointplane
{
PosesFromStart::PosesFromStart(const Trajectory& truth, const Trajectory& estimate)
{
    const auto trueAt = [&](double stamp)
    { return truth.poses[nearestIndex(truth.stamps, stamp)]; };
    const Eigen::Isometry3d trueStart = trueAt(estimate.stamps.front());
    for (std::size_t k = 0; k < estimate.size(); ++k)
    {
        time_.push_back(estimate.stamps[k] - estimate.stamps.front());
        estimates_.push_back(estimate.poses.front().inverse() * estimate.poses[k]);
        truths_.push_back(trueStart.inverse() * trueAt(estimate.stamps[k]));
    }
}

double PosesFromStart::finalError() const
{
    return (truths_.back().translation() - estimates_.back().translation()).norm();
}

std::vector<Chart> PosesFromStart::charts(const std::string& name) const
{
    std::vector<Chart> charts(2);
    charts[0].title = "Fig. 5: " + name + ", position";
    charts[0].yLabel = "position [mm]";
    charts[1].title = "Fig. 5: " + name + ", rotation";
    charts[1].yLabel = "rotation [deg]";
    for (const bool rotation : {false, true})
    {
        Chart& chart = charts[rotation ? 1 : 0];
        chart.xLabel = "time [s]";
        const auto add =
            [&](const std::vector<Eigen::Isometry3d>& poses, int axis, ChartSeries series)
        {
            series.x = time_;
            for (const Eigen::Isometry3d& T : poses)
            {
                series.y.push_back(
                    rotation ? kDegreesPerRadian * so3Log(T.linear())[axis]
                             : 1000 * T.translation()[axis]);
            }
            chart.series.push_back(std::move(series));
        };
        const char* const names[] = {"x", "y", "z"};
        const char* const colours[] = {"c0", "c1", "c2"};
        using Style = ChartSeries::Style;
        for (int axis = 0; axis < 3; ++axis)
        {
            add(estimates_, axis, {names[axis], {}, {}, Style::Line, false, colours[axis]});
        }
        for (int axis = 0; axis < 3; ++axis)
        {
            add(truths_,
                axis,
                {axis == 0 ? "ground truth" : "", {}, {}, Style::Dashed, false, "ink"});
        }
    }
    return charts;
}
}  // namespace pointplane
