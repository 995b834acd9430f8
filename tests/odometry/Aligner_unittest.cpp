// SPDX-License-Identifier: BSD-3-Clause
#include "Aligner.h"

#include <pointplane/core/se3.h>

#include "hell_frames.h"
#include "matchers.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
using test::CachedSequence;

/** A frame of the desk is the only reference; others are laid over it. */
class AlignerTest : public testing::Test
{
 protected:
    AlignerTest() : frontEnd_(params_), aligner_(params_), errors_(params_), track_(params_)
    {
        const Features first = frontEnd_.extract(frame(0), diagnostics_);
        Reference reference;
        reference.stamp = first.frame.stamp;
        reference.shutter = first.frame.shutter;
        reference.planes = first.planes;
        reference.points = frontEnd_.pointReference(first, first.frame);
        reference.images = frontEnd_.keyframeImages(first);
        track_.changeCamera(first.frame.camera, errors_.changeCamera(first.frame.camera));
        (void)track_.restart(std::move(reference));
    }

    static RgbdFrame frame(int i) { return CachedSequence::desk().frame(i); }

    [[nodiscard]] int numPoints() const
    {
        return static_cast<int>(track_.previous().points.points.size());
    }

    /** The next frame, with light on a part of the image only. */
    static RgbdFrame darkBut(const cv::Rect& part)
    {
        RgbdFrame out = frame(1);
        const cv::Mat lit = out.gray(part).clone();
        out.gray.setTo(0);
        lit.copyTo(out.gray(part));
        return out;
    }

    Alignment align(const RgbdFrame& frame)
    {
        track_.noteGap(frame.stamp);
        return aligner_.align(
            frontEnd_, frontEnd_.extract(frame, diagnostics_), track_, errors_, diagnostics_);
    }

    static void expectTrue(const Alignment& alignment, int i)
    {
        EXPECT_TRUE(alignment.holds) << alignment.reason;
        EXPECT_LT(
            test::normalisedError(
                CachedSequence::desk().sequence().trueMotion(0, i), alignment.estimate.pose()),
            3);
    }

    OdometryParams params_;
    FrontEnd frontEnd_;
    Aligner aligner_;
    ErrorModel errors_;
    Track track_;
    FrameDiagnostics diagnostics_;
};

TEST_F(AlignerTest, aFrameIsLaidOverItsReference)
{
    const Alignment alignment = align(frame(1));
    expectTrue(alignment, 1);
    EXPECT_EQ(alignment.observableDirections, 6);
    EXPECT_GT(alignment.agreement.fraction(), 0.9);
    EXPECT_GT(alignment.estimate.numPointInliers, 0.8 * alignment.numSought);
    EXPECT_LE(alignment.numSought, numPoints());
    EXPECT_EQ(diagnostics_.numReferences, 1);
    EXPECT_EQ(diagnostics_.numPointPairs, alignment.problem.points.size());
    EXPECT_EQ(diagnostics_.surfaceAgreement, alignment.agreement.fraction());
}

/** Nothing is known of the motion over 20 s: the images tell it. */
TEST_F(AlignerTest, theImagesTellWhatThePredictionDoesNot)
{
    RgbdFrame later = frame(15);
    later.stamp = frame(0).stamp + 20;
    expectTrue(align(later), 15);
}

/** Points that no image can show do not speak against a motion. */
TEST_F(AlignerTest, withoutAColourImageNoPointIsSought)
{
    RgbdFrame withoutColour = frame(1);
    withoutColour.gray.release();
    const Alignment alignment = align(withoutColour);
    expectTrue(alignment, 1);
    EXPECT_EQ(alignment.numSought, 0);
    EXPECT_GT(align(frame(1)).numSought, 100);
}

TEST_F(AlignerTest, aMirroredPlaceIsNotBelieved)
{
    RgbdFrame foreign = frame(1);
    cv::flip(foreign.depth, foreign.depth, 1);
    cv::flip(foreign.gray, foreign.gray, 1);
    const Alignment alignment = align(foreign);
    EXPECT_FALSE(alignment.holds);
    EXPECT_NE(alignment.reason, "");
}

TEST_F(AlignerTest, withoutFeaturesThereIsOnlyThePrediction)
{
    RgbdFrame none = frame(1);
    none.depth.setTo(0);
    none.gray.setTo(0);
    const Alignment alignment = align(none);
    EXPECT_FALSE(alignment.holds);
    EXPECT_THAT(alignment.reason, testing::StartsWith("too few points and planes"));
    EXPECT_EQ(alignment.numMatches(), 0);
    EXPECT_TRUE(alignment.estimate.motion.mean.T_prev_cur.isApprox(
        alignment.predicted.motion.mean.T_prev_cur));
}

/** All but a corner of the image is dark. The few points there may agree by chance, so planes tell
 * the motion. It is compared with the surfaces anew, and each point in view is counted once. */
TEST_F(AlignerTest, aMotionWithoutItsDoubtfulPointsIsComparedAnew)
{
    const Alignment alignment = align(darkBut(cv::Rect(0, 140, 40, 40)));
    EXPECT_FALSE(alignment.doubt);
    expectTrue(alignment, 1);
    const auto numDoubted = static_cast<int>(alignment.associations[0].doubtedPoints.size());
    EXPECT_GT(numDoubted, 0);
    EXPECT_TRUE(alignment.problem.points.empty());
    EXPECT_GT(alignment.problem.planes.size(), 3);
    EXPECT_LE(alignment.numSought, numPoints() - numDoubted);
    EXPECT_GT(alignment.agreement.fraction(), 0.9);
    EXPECT_LE(alignment.agreement.seen(), PixelGrid::kSamples * PixelGrid::kSamples);
}

/** Nothing is known of the motion over 20 s, and few points agree. Their motion is the
 * best guess, but the one without them may be right as well. */
TEST_F(AlignerTest, aGuessIsAsUncertainAsItsDistanceFromTheOtherOne)
{
    RgbdFrame dark = darkBut(cv::Rect(0, 140, 40, 40));
    dark.stamp = frame(0).stamp + 20;
    const Alignment alignment = align(dark);
    ASSERT_TRUE(alignment.doubt) << alignment.reason;
    const PoseSolver solver(params_.poseSolver);
    const Motion without =
        solver.solve(alignment.problem, alignment.predicted.motion.mean).motion.mean;
    const Vector6d apart = leftError(alignment.estimate.motion.mean.T_prev_cur, without.T_prev_cur);
    EXPECT_GT(apart.norm(), 1e-4);
    EXPECT_THAT(
        *alignment.doubt,
        test::IsMatrixNear(Matrix6d(apart * apart.transpose()), 0.05 * apart.squaredNorm()))
        << "a solution is known to a hundredth of its sigma";
}
}  // namespace
}  // namespace pointplane
