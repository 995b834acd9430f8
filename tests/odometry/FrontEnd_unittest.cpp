// SPDX-License-Identifier: BSD-3-Clause
#include "FrontEnd.h"

#include <pointplane/core/se3.h>

#include "hell_frames.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
using test::CachedSequence;

RgbdFrame deskFrame(int i) { return CachedSequence::desk().frame(i); }

Eigen::Isometry3d trueMotion(int i)
{
    return CachedSequence::desk().sequence().trueMotion(0, i).inverse();  // T_cur_ref
}

Reference referenceOf(const FrontEnd& frontEnd, const Features& features)
{
    Reference out;
    out.planes = features.planes;
    out.points = frontEnd.pointReference(features, features.frame);
    out.images = frontEnd.keyframeImages(features);
    return out;
}

/** Frames 0 and 5 of the desk. */
class FrontEndTest : public testing::Test
{
 protected:
    explicit FrontEndTest(const OdometryParams& params = {})
        : frontEnd_(params),
          first_(frontEnd_.extract(deskFrame(0), diagnostics_)),
          reference_(referenceOf(frontEnd_, first_)),
          current_(frontEnd_.extract(deskFrame(5), diagnostics_))
    {
    }

    FrameDiagnostics diagnostics_;
    FrontEnd frontEnd_;
    Features first_;
    Reference reference_;
    Features current_;
};

TEST_F(FrontEndTest, pointsAndPlanesAreTakenFromTheImages)
{
    EXPECT_TRUE(first_.hasDepth);
    EXPECT_FALSE(first_.depthIsNoise);
    EXPECT_GT(first_.planes.planes.size(), 2);
    EXPECT_GT(reference_.points.points.size(), 100);
    EXPECT_EQ(diagnostics_.numPlanes, current_.planes.planes.size());
    EXPECT_EQ(frontEnd_.whyNoPoint(deskFrame(0)), "");
}

TEST_F(FrontEndTest, theSameFeaturesWithAnyNumberOfThreads)
{
    OdometryParams params;
    params.pipeline.numThreads = 1;
    FrontEnd alone(params);
    const Features features = alone.extract(deskFrame(0), diagnostics_);
    ASSERT_EQ(features.planes.planes.size(), first_.planes.planes.size());
    const Reference reference = referenceOf(alone, features);
    ASSERT_EQ(reference.points.points.size(), reference_.points.points.size());
    for (size_t i = 0; i < reference.points.points.size(); ++i)
    {
        EXPECT_EQ(reference.points.points[i].uv_px, reference_.points.points[i].uv_px);
    }
}

/** Where the true motion puts them. */
TEST_F(FrontEndTest, featuresAreFoundAgain)
{
    const Association found = frontEnd_.associate(reference_, current_, trueMotion(5), 1);
    EXPECT_EQ(found.reference, &reference_);
    EXPECT_GT(found.planes.size(), 2);
    EXPECT_GT(found.points.size(), reference_.points.points.size() / 2);
    int numRight = 0;
    for (const PointTrack& track : found.points)
    {
        const auto& point = reference_.points.points[static_cast<size_t>(track.ref)];
        const Eigen::Vector2d truth_px =
            current_.frame.camera.project(trueMotion(5) * point.p_cam.mean);
        numRight += (truth_px - track.cur.uv_px).norm() < 2;
    }
    EXPECT_GT(numRight, 0.9 * static_cast<double>(found.points.size()));
    EXPECT_TRUE(found.fixedPoints.empty());
    EXPECT_TRUE(found.doubtedPoints.empty());
}

TEST_F(FrontEndTest, surfacesTellRightMotionsFromWrongOnes)
{
    const Agreement right = frontEnd_.compare(reference_, current_, trueMotion(5));
    EXPECT_GT(right.fraction(), 0.9);
    Eigen::Isometry3d wrong = trueMotion(5);
    wrong.translation() += Eigen::Vector3d(0.05, 0.05, 0.1);
    EXPECT_LT(frontEnd_.compare(reference_, current_, wrong).fraction(), 0.6);
    // Of a frame that is no key frame, nothing is kept to compare with.
    reference_.images.reset();
    EXPECT_EQ(frontEnd_.compare(reference_, current_, trueMotion(5)).seen(), 0);
    EXPECT_FALSE(frontEnd_.alignImages(reference_, current_));
    EXPECT_TRUE(frontEnd_.alignPlanes(reference_, current_).empty());
}

TEST_F(FrontEndTest, imagesTellAMotionWithoutAPrediction)
{
    const auto motion = frontEnd_.alignImages(reference_, current_);
    ASSERT_TRUE(motion);
    EXPECT_THAT(*motion, test::IsNearPose(trueMotion(5), 0.05, 0.05));
}

TEST_F(FrontEndTest, whatIsNotUsedIsNotLookedFor)
{
    OdometryParams params;
    params.pipeline.usePoints = false;
    FrontEnd planes(params);
    const Features ofPlanes = planes.extract(deskFrame(0), diagnostics_);
    EXPECT_TRUE(referenceOf(planes, ofPlanes).points.points.empty());
    EXPECT_FALSE(ofPlanes.planes.planes.empty());
    EXPECT_EQ(planes.whyNoPoint(deskFrame(0)), "");

    params = {};
    params.pipeline.usePlanes = false;
    FrontEnd points(params);
    const Features ofPoints = points.extract(deskFrame(0), diagnostics_);
    EXPECT_TRUE(ofPoints.planes.planes.empty());
    EXPECT_FALSE(referenceOf(points, ofPoints).points.points.empty());
}
}  // namespace
}  // namespace pointplane
