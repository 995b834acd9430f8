// SPDX-License-Identifier: BSD-3-Clause
#include "PosesFromStart.h"

#include <Eigen/Geometry>

#include <cmath>

#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
/** Each second 0.1 m along the body's x axis and 10 degrees about its z axis, from anywhere. */
Trajectory moving(const Eigen::Isometry3d& start, double metres)
{
    Trajectory out;
    for (int k = 0; k <= 3; ++k)
    {
        out.stamps.push_back(100 + k);
        out.poses.push_back(
            start * Eigen::Translation3d(metres * k, 0, 0) *
            Eigen::AngleAxisd(k * M_PI / 18, Eigen::Vector3d::UnitZ()));
    }
    return out;
}
}  // namespace

TEST(PosesFromStart, ofDifferentWorldsBeginTogether)
{
    Eigen::Isometry3d elsewhere = Eigen::Isometry3d::Identity();
    elsewhere.translation() << 5, -3, 1;
    elsewhere.linear() =
        Eigen::AngleAxisd(1.2, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    const PosesFromStart same(moving(elsewhere, 0.1), moving(Eigen::Isometry3d::Identity(), 0.1));
    EXPECT_NEAR(same.finalError(), 0, 1e-12);

    const PosesFromStart poses(moving(elsewhere, 0.1), moving(Eigen::Isometry3d::Identity(), 0.12));
    EXPECT_NEAR(poses.finalError(), 0.06, 1e-12);
    const std::vector<Chart> charts = poses.charts("planes");
    ASSERT_EQ(charts.size(), 2U);
    for (const Chart& chart : charts)
    {
        ASSERT_EQ(chart.series.size(), 6U);  // x, y, z of the estimate, then of the truth
        EXPECT_EQ(chart.series[0].x, (std::vector<double>{0, 1, 2, 3}));
    }
    EXPECT_EQ(charts[0].title, "Fig. 5: planes, position");
    EXPECT_NEAR(charts[0].series[0].y.back(), 360, 1e-9);
    EXPECT_NEAR(charts[0].series[3].y.back(), 300, 1e-9);
    EXPECT_NEAR(charts[0].series[1].y.back(), 0, 1e-9);
    EXPECT_NEAR(charts[1].series[2].y.back(), 30, 1e-9);
    EXPECT_NEAR(charts[1].series[5].y.back(), 30, 1e-9);
}
}  // namespace pointplane
