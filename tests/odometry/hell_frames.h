// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/covariance.h>
#include <pointplane/odometry/Odometry.h>
#include <pointplane/simulation/SimulatedSequence.h>

#include <opencv2/core.hpp>

#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <string>

#include "linear_algebra.h"
#include "matchers.h"
#include <gtest/gtest.h>

namespace pointplane::test
{
/** A small simulated sequence whose frames are rendered once per process. */
class CachedSequence
{
 public:
    explicit CachedSequence(const std::string& scene, int width = 320, int height = 240)
        : sequence_(std::make_unique<SimulatedSequence>(scene, small(width, height), 5))
    {
    }

    [[nodiscard]] RgbdFrame frame(int i)
    {
        const auto [it, isNew] = frames_.try_emplace(i);
        if (isNew)
        {
            it->second = sequence_->frame(i);
        }
        RgbdFrame copy = it->second;
        copy.depth = it->second.depth.clone();
        copy.gray = it->second.gray.clone();
        return copy;
    }
    [[nodiscard]] const SimulatedSequence& sequence() const { return *sequence_; }

    static CachedSequence& corner()
    {
        static CachedSequence cached("corner");
        return cached;
    }
    static CachedSequence& desk()
    {
        static CachedSequence cached("desk");
        return cached;
    }

 private:
    static SimulationParams small(int width, int height)
    {
        SimulationParams params;
        params.width = width;
        params.height = height;
        return params;
    }
    std::unique_ptr<SimulatedSequence> sequence_;
    std::map<int, RgbdFrame> frames_;
};

/** What is true of every result, whatever the frame. */
inline void expectSound(const OdometryResult& result)
{
    EXPECT_TRUE(isPositiveDefinite(result.increment.cov)) << result.increment.cov;
    EXPECT_TRUE(isPositiveDefinite(result.pose.cov)) << result.pose.cov;
    EXPECT_TRUE(result.increment.mean.matrix().allFinite()) << result.increment.mean.matrix();
    EXPECT_TRUE(result.pose.mean.matrix().allFinite()) << result.pose.mean.matrix();
    EXPECT_NEAR(result.pose.mean.linear().determinant(), 1, 1e-9);
    if (result.status == TrackingStatus::Predicted || result.status == TrackingStatus::Lost)
    {
        EXPECT_FALSE(result.reason.empty());
        EXPECT_EQ(result.reason.find('\n'), std::string::npos);
        if (!result.since.empty())
        {
            // The joint covariance and the motion model speak of the same motion.
            const Vector6d ratio =
                result.since.front().cov.diagonal().cwiseQuotient(result.increment.cov.diagonal());
            EXPECT_GT(ratio.minCoeff(), 0.99) << ratio.transpose();
            EXPECT_LT(ratio.maxCoeff(), 1.01) << ratio.transpose();
        }
    }
}

/** Runs an odometry and checks each result on the way. */
class CheckedOdometry
{
 public:
    explicit CheckedOdometry(const OdometryParams& params = {}) : odometry_(params) {}

    [[nodiscard]] bool isKeyframe() const { return odometry_.features().isKeyframe; }

    OdometryResult process(const RgbdFrame& frame)
    {
        SCOPED_TRACE(testing::Message() << "result number " << numResults_++);
        const OdometryResult result = odometry_.process(frame);
        expectSound(result);
        return result;
    }

    /** Frames first..last of the corner sequence; the last result. */
    OdometryResult run(int first, int last)
    {
        OdometryResult result;
        for (int i = first; i <= last; ++i)
        {
            result = process(CachedSequence::corner().frame(i));
        }
        return result;
    }
    [[nodiscard]] const Odometry& odometry() const { return odometry_; }

 private:
    Odometry odometry_;
    int numResults_{0};
};

/** Largest error of pose or increment in units of its own sigma: sqrt(e^T cov^-1 e / 6). */
inline double normalisedError(const Eigen::Isometry3d& truth, const PoseGaussian& estimate)
{
    const Vector6d e = leftError(truth, estimate.mean);
    return std::sqrt(squaredMahalanobis(e, estimate.cov) / 6);
}
}  // namespace pointplane::test
