// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <iostream>

#include "hell_frames.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
constexpr int kFrames = 75, kSeeds = 4;
constexpr std::array kSpans{1, 10, 30};  // [frames]: up to a second

/** Of motions over so many frames, per degree of freedom: mean over all motions. */
struct MeanNees
{
    std::array<double, kSpans.size()> sums{}, counts{};

    void add(const SimulatedSequence& truth, int frame, const std::vector<PoseGaussian>& since)
    {
        for (size_t k = 0; k < kSpans.size(); ++k)
        {
            if (const auto span = static_cast<size_t>(kSpans[k]); span <= since.size())
            {
                const Eigen::Isometry3d motion = truth.trueMotion(frame - kSpans[k], frame);
                const double sigmas = test::normalisedError(motion, since[span - 1]);
                sums[k] += sigmas * sigmas;
                counts[k] += 1;
            }
        }
    }
};
}  // namespace

/** Neither too sure nor too unsure. Half a second of errors is one sample, so the means of 18
 * samples of six degrees of freedom scatter by 0.14: three standard deviations. */
TEST(OdometryNees, covariancesAreTrueOverAFrameAndOverASecond)
{
    OdometryParams params;
    params.covariance.history = kSpans.back() + 1;
    MeanNees nees;
    for (unsigned seed = 1; seed <= kSeeds; ++seed)
    {
        SimulationParams small;
        small.width = 320;
        small.height = 240;
        const SimulatedSequence desk("desk", small, seed);
        test::CheckedOdometry odometry(params);
        for (int i = 0; i < kFrames; ++i)
        {
            nees.add(desk, i, odometry.process(desk.frame(i)).since);
        }
    }
    for (size_t k = 0; k < kSpans.size(); ++k)
    {
        const double mean = nees.sums[k] / nees.counts[k];
        std::cout << "over " << kSpans[k] << " frames: NEES " << mean << "\n";
        EXPECT_NEAR(mean, 1, 0.42) << kSpans[k];
    }
}
}  // namespace pointplane
