// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/se3.h>
#include <pointplane/odometry/uncertainty/ResidualVariogram.h>

#include <cmath>
#include <functional>
#include <vector>

#include "monte_carlo.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
constexpr double kFrame = 1.0 / 30;
constexpr int kReference = 7;

/** Features whose residuals have white noise beside a random walk, both over a covariance. With a
 * length in views, the walk forgets where it came from (Gauss-Markov): it is bounded. */
class Features
{
 public:
    Features(unsigned seed, int n, double white, double drift, double length = 1e9)
        : sampler_(seed), white_(white), drift_(drift), length_(length)
    {
        for (int i = 0; i < n; ++i)
        {
            covs_.push_back(sampler_.covariance<3>(1e-6, 1e-4));
            walks_.push_back(3 * sampler_.sample(covs_.back()));  // of the reference: stays
        }
    }

    /** The next frame. */
    std::vector<FeatureResidual> next(double views, const Eigen::Matrix3d& R_world_prev)
    {
        std::vector<FeatureResidual> out;
        for (size_t i = 0; i < covs_.size(); ++i)
        {
            const double kept = std::exp(-views / length_);
            const double gained = drift_ * length_ * -std::expm1(-2 * views / length_);
            walks_[i] = kept * walks_[i] + std::sqrt(gained) * sampler_.sample(covs_[i]);
            const Eigen::Vector3d r = walks_[i] + std::sqrt(white_) * sampler_.sample(covs_[i]);
            FeatureResidual f;
            f.reference = kReference;
            f.inReference = static_cast<int>(i);
            f.r = R_world_prev.transpose() * r;
            f.curCov = R_world_prev.transpose() * covs_[i] * R_world_prev;
            out.push_back(f);
        }
        return out;
    }

 private:
    test::GaussianSampler sampler_;
    double white_, drift_, length_;
    std::vector<Eigen::Matrix3d> covs_;
    std::vector<Eigen::Vector3d> walks_;
};

struct Scenario
{
    double views{0.1};  //!< between neighbouring frames
    int frames{90};
    NoiseFactors residuals{};
    std::function<void(int frame, FeatureResidual&)> change{[](int, FeatureResidual&) {}};
    std::function<Eigen::Matrix3d(int frame)> R_world_prev{
        [](int) { return Eigen::Matrix3d(Eigen::Matrix3d::Identity()); }};
};

/** Of points and planes that are other features, all of which are changed likewise. */
ResidualVariogram::Levels levelsOf(Features points, Features planes, const Scenario& run = {})
{
    ResidualVariogram out(2);
    for (int k = 0; k < run.frames; ++k)
    {
        const Eigen::Matrix3d R = run.R_world_prev(k);
        PoseAnalysis analysis;
        analysis.pointResiduals = points.next(run.views, R);
        analysis.planeResiduals = planes.next(run.views, R);
        for (auto* residuals : {&analysis.pointResiduals, &analysis.planeResiduals})
        {
            for (FeatureResidual& f : *residuals)
            {
                run.change(k, f);
            }
        }
        out.update(analysis, R, run.views, kFrame, run.residuals);
    }
    return out.levels();
}

const Features kNone(0, 0, 0, 0);
}  // namespace

/** 2 g per view: the variogram is half of the mean squared difference. */
TEST(ResidualVariogram, tellsNoiseFromDriftForEachKind)
{
    const auto levels = levelsOf({1, 150, 0.5, 0.8}, {2, 30, 3, 20});
    EXPECT_NEAR(levels.white.points, 0.5, 0.08);
    EXPECT_NEAR(levels.drift.points, 0.8, 0.12);
    EXPECT_NEAR(levels.white.planes, 3, 0.8);
    EXPECT_NEAR(levels.drift.planes, 20, 5);
}

TEST(ResidualVariogram, noiseAloneHasNoDrift)
{
    const auto levels = levelsOf({3, 150, 0.5, 0}, {4, 30, 3, 0});
    EXPECT_NEAR(levels.white.points, 0.5, 0.08);
    EXPECT_LT(levels.drift.points, 0.1);
}

/** Errors saturate: what frames ten views apart differ by is not ten times what one view brings. */
TEST(ResidualVariogram, slowRecordingsDoNotTakeDriftForNoise)
{
    const auto levels = levelsOf({13, 150, 0.1, 0.8, 1.5}, {14, 30, 0.1, 20, 1.5}, {1.5});
    EXPECT_GT(levels.drift.points, 0.15 * 0.8);
    EXPECT_GT(levels.drift.planes, 0.15 * 20);
}

/** A slow camera needs the time constant to come far enough for a slope. */
TEST(ResidualVariogram, slowCamerasTellDrift)
{
    const auto levels = levelsOf({17, 150, 0.5, 3}, {18, 30, 0.5, 3}, {0.005, 300});
    EXPECT_NEAR(levels.drift.points, 3, 0.45);
    EXPECT_NEAR(levels.white.points, 0.5, 0.08);
}

/** A camera at rest says nothing of what another view would bring. */
TEST(ResidualVariogram, atRestTheFirstGuessOfDriftStays)
{
    const auto levels = levelsOf({5, 150, 0.5, 0.8}, {6, 30, 3, 20}, {0});
    EXPECT_NEAR(levels.white.points, 0.5, 0.08);
    EXPECT_NEAR(levels.drift.points, 0.3, 1e-9);
}

TEST(ResidualVariogram, wrongMatchesDoNotMatter)
{
    test::GaussianSampler sampler(70);
    Scenario run;
    run.change = [&](int, FeatureResidual& f)
    { f.r += (f.inReference % 10 == 0 ? 0.1 : 0) * sampler.vector<3>(); };
    const auto levels = levelsOf({7, 150, 0.5, 0.8}, kNone, run);
    EXPECT_NEAR(levels.white.points, 0.5, 0.2);
    EXPECT_NEAR(levels.drift.points, 0.8, 0.25);
}

/** The previous frame turns with the camera; features and their errors do not. */
TEST(ResidualVariogram, axesAreThoseOfTheWorld)
{
    Scenario run;
    run.R_world_prev = [](int k) { return so3Exp(Eigen::Vector3d(0.1 * k, 0.2 * k, 0)); };
    const auto levels = levelsOf({8, 150, 0.5, 0.8}, kNone, run);
    EXPECT_NEAR(levels.white.points, 0.5, 0.08);
    EXPECT_NEAR(levels.drift.points, 0.8, 0.12);
}

/** Of four planes the pose follows half of the noise: half of it is left in the residuals. */
TEST(ResidualVariogram, noiseThatTheEstimateFollowsIsCountedToo)
{
    const auto white = [](double own, double ofPlanes)
    {
        Scenario run;
        run.change = [=](int, FeatureResidual& f)
        {
            f.own = own;
            f.ofPlanes = ofPlanes;
        };
        return levelsOf(kNone, {9, 40, 1, 0}, run).white.planes;
    };
    EXPECT_NEAR(white(1, 0), 1, 0.2);
    EXPECT_NEAR(white(0, 0.5), 2 * white(1, 0), 0.3);
    EXPECT_NEAR(white(0.05, 0.05), 0.3, 1e-9) << "says nothing: the first guess";
}

/** The median of one is itself: on average 3, over the median 2.366 of chi-square. */
TEST(ResidualVariogram, oneFeatureTells)
{
    Scenario run{0, 900};
    run.residuals = {2, 2};
    const auto levels = levelsOf(kNone, {16, 1, 1, 0}, run);
    EXPECT_NEAR(levels.white.planes, 3 / 2.366, 0.35);
}

/** The same frame again and again, or features that jump by metres. */
TEST(ResidualVariogram, staysWithinReason)
{
    const auto same = levelsOf({11, 150, 0, 0}, {12, 30, 0, 0}, {0.1, 900});
    EXPECT_GT(same.white.points, 1e-4);
    EXPECT_GT(same.drift.planes, 0.01);
    const auto odd = levelsOf({13, 150, 1e9, 0}, {14, 30, 1e9, 1e9}, {0.1, 900});
    EXPECT_LE(odd.white.points, 1000);
    EXPECT_LE(odd.drift.planes, 10000);
}

TEST(ResidualVariogram, otherFeaturesAreNotCompared)
{
    Scenario run{0.1, 30, {1, 2}};
    run.change = [](int k, FeatureResidual& f) { f.inReference += 1000 * k; };
    const auto levels = levelsOf({10, 150, 0.5, 0.8}, kNone, run);
    EXPECT_NEAR(levels.white.points, 0.3, 1e-9);
    EXPECT_NEAR(levels.drift.points, 0.3, 1e-9);
    EXPECT_NEAR(levels.white.planes, 0.6, 1e-9) << "a part of the residuals' variance";
}

/** Frame to frame, each feature is compared once: what changes is its residual. */
TEST(ResidualVariogram, ofNewReferencesTheResidualsAreTheChange)
{
    Scenario run{0.1, 300, {3, 1}};
    run.change = [](int k, FeatureResidual& f) { f.reference = k; };
    const auto levels = levelsOf({15, 150, 0.5, 0.8}, kNone, run);
    EXPECT_NEAR(levels.white.points, 3, 0.3);
    EXPECT_NEAR(levels.white.planes, 0.3, 1e-9) << "there are none";
}
}  // namespace pointplane
