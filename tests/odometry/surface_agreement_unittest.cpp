// SPDX-License-Identifier: BSD-3-Clause
#include "surface_agreement.h"

#include <pointplane/core/se3.h>

#include <limits>

#include "hell_frames.h"
#include "monte_carlo.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/** Two frames of a desk, ten apart: its samples in the second, at the true motion times an error.
 */
class SurfaceAgreement : public testing::Test
{
 protected:
    static test::CachedSequence& desk()
    {
        static test::CachedSequence cached("desk");
        return cached;
    }

    [[nodiscard]] Agreement at(const Vector6d& error) const
    {
        return compareSurfaces(samples, se3Exp(error) * T_cur_ref, current, DepthNoise(), 0.01);
    }

    /** The best of the six directions. */
    [[nodiscard]] double bestWrongBy(double metres, double degrees) const
    {
        double out = 0;
        for (int axis = 0; axis < 6; ++axis)
        {
            const double size = axis < 3 ? metres : degrees * M_PI / 180;
            if (size > 0)
            {
                out = std::max(out, at(size * Vector6d::Unit(axis)).fraction());
            }
        }
        return out;
    }

    RgbdFrame current = desk().frame(50);
    SurfaceSamples samples{desk().frame(40), {}};
    Eigen::Isometry3d T_cur_ref = desk().sequence().trueMotion(50, 40);
};

TEST_F(SurfaceAgreement, surfacesAreWhereTheTrueMotionPutsThem)
{
    const Agreement right = at(Vector6d::Zero());
    EXPECT_GT(right.seen(), 1500);
    EXPECT_GT(right.fraction(), 0.95);
}

TEST_F(SurfaceAgreement, smallErrorsPass)
{
    EXPECT_GT(bestWrongBy(0.01, 0), 0.9);
    EXPECT_GT(bestWrongBy(0, 0.5), 0.9);
}

TEST_F(SurfaceAgreement, errorsOfEveryDirectionLeaveFewerSurfaces)
{
    const double right = at(Vector6d::Zero()).fraction();
    EXPECT_LT(bestWrongBy(0.05, 0), right - 0.1);
    EXPECT_LT(bestWrongBy(0, 5), right - 0.1);
    EXPECT_LT(bestWrongBy(0.2, 0), 0.75);
    EXPECT_LT(bestWrongBy(0, 20), 0.6);
}

TEST_F(SurfaceAgreement, whatIsInFrontHidesAndWhatIsGoneHasVanished)
{
    // A person's width of the image, half a metre in front of it: nothing there agrees.
    const int all = at(Vector6d::Zero()).seen();
    const cv::Rect person(100, 0, 100, current.depth.rows);
    current.depth(person) *= 0.5;
    const Agreement hidden = at(Vector6d::Zero());
    EXPECT_NEAR(hidden.hidden, 0.31 * all, 0.1 * all);
    EXPECT_GT(hidden.fraction(), 0.55) << "a third of the image moves: the rest still agrees";
    current.depth(person) *= 4;
    const Agreement vanished = at(Vector6d::Zero());
    EXPECT_NEAR(vanished.vanished, 0.31 * all, 0.1 * all);
}

TEST_F(SurfaceAgreement, holesSayNothing)
{
    current.depth.colRange(0, 160).setTo(kNaN);
    const Agreement half = at(Vector6d::Zero());
    EXPECT_GT(half.fraction(), 0.95);
    current.depth.setTo(kNaN);
    const Agreement none = at(Vector6d::Zero());
    EXPECT_EQ(none.seen(), 0);
    EXPECT_EQ(none.fraction(), 0) << "nothing speaks for the motion";
}

TEST_F(SurfaceAgreement, thinThingsAreNotCounted)
{
    // A grating of 2 px bars half as far away: its depth jumps belong to neither side.
    RgbdFrame reference = desk().frame(40);
    for (int u = 0; u + 2 <= reference.depth.cols; u += 8)
    {
        reference.depth.colRange(u, u + 2) *= 0.5;
    }
    samples = SurfaceSamples(reference, {});
    EXPECT_GT(samples.points_cam.size(), 500U);
    EXPECT_GT(at(Vector6d::Zero()).fraction(), 0.9);
}

/** Far away, depths of neighbours differ by more than distortion makes them: by noise. */
TEST_F(SurfaceAgreement, noiseIsNoDepthJump)
{
    test::GaussianSampler sampler(8);
    DepthNoise stereo;
    stereo.sigmaInverseDepth = 2 * DepthNoise().sigmaInverseDepth;
    RgbdFrame far = current;
    for (const double z : {3.0, 6.0, 9.0})
    {
        for (int v = 0; v < far.depth.rows; ++v)
        {
            for (int u = 0; u < far.depth.cols; ++u)
            {
                far.depth.at<float>(v, u) =
                    static_cast<float>(z + stereo.sigmaZ(z) * sampler.normal());
            }
        }
        RgbdFrame exact = far;
        exact.depth = cv::Mat(far.depth.size(), CV_32FC1, cv::Scalar(z));
        const auto all = static_cast<double>(SurfaceSamples(exact, stereo).points_cam.size());
        const auto found = static_cast<double>(SurfaceSamples(far, stereo).points_cam.size());
        EXPECT_GT(found, 0.7 * all) << z << " m";
    }
}

TEST_F(SurfaceAgreement, imagesTooSmallToSample)
{
    RgbdFrame tiny = current;
    for (const int size : {0, 1, 2, 3})
    {
        tiny.depth = cv::Mat(size, size, CV_32FC1, cv::Scalar(1));
        EXPECT_LE(SurfaceSamples(tiny, {}).points_cam.size(), 1U);
    }
}
}  // namespace
}  // namespace pointplane
