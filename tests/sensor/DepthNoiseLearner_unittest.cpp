// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/sensor/DepthNoiseLearner.h>

#include <opencv2/imgproc.hpp>

#include <cmath>
#include <functional>
#include <limits>

#include "monte_carlo.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
/** A floor that rises from `far` at the top of the image to `near` at its bottom, each depth [m]
 * changed by the sensor. */
cv::Mat floorImage(double near, double far, const std::function<double(double)>& sensor)
{
    cv::Mat depth(240, 320, CV_32FC1);
    for (int v = 0; v < depth.rows; ++v)
    {
        const double share = static_cast<double>(v) / (depth.rows - 1);
        const double q = (1 - share) / far + share / near;
        for (int u = 0; u < depth.cols; ++u)
        {
            depth.at<float>(v, u) = static_cast<float>(sensor(1 / q));
        }
    }
    return depth;
}

DepthNoise learnt(
    double near, double far, const std::function<double(double)>& sensor, const DepthNoise& given)
{
    DepthNoiseLearner learner(given);
    for (int i = 0; i < 3; ++i)
    {
        learner.update(floorImage(near, far, sensor));
    }
    return learner.noise();
}

double inMillimetres(double z) { return 1e-3 * std::round(1e3 * z); }

class DepthNoiseLearnerTest : public testing::Test
{
 protected:
    double normal() { return sampler_.normal(); }

    test::GaussianSampler sampler_{5};
};

void expectGiven(const DepthNoise& noise)
{
    EXPECT_EQ(noise.sigmaInverseDepth, DepthNoise().sigmaInverseDepth);
    EXPECT_TRUE(noise.isConstantInInverseDepth());
}
}  // namespace

TEST_F(DepthNoiseLearnerTest, disparityLevelsAreStructuredLight)
{
    // A Kinect's levels, with half of the noise that is published, in millimetres.
    const auto kinect = [&](double z)
    { return inMillimetres(1 / (2.87e-3 * std::round((1 / z + 0.7e-3 * normal()) / 2.87e-3))); };
    const DepthNoise noise = learnt(0.8, 4, kinect, {});
    EXPECT_EQ(noise.kind, "structuredLight");
    expectGiven(noise);
}

/** A RealSense D435 of 424x240 px: its steps of 1/32 px are nearly those of a Kinect. */
TEST_F(DepthNoiseLearnerTest, levelsOfMoreNoiseAreActiveStereo)
{
    const auto d435 = [&](double z)
    { return inMillimetres(1 / (2.95e-3 * std::round((1 / z + 7.5e-3 * normal()) / 2.95e-3))); };
    const DepthNoise noise = learnt(0.8, 4, d435, {});
    EXPECT_EQ(noise.kind, "activeStereo");
    EXPECT_GT(noise.sigmaInverseDepth, 5e-3);
    EXPECT_LT(noise.sigmaInverseDepth, 1.4 * 1.4 * 7.5e-3);
}

TEST_F(DepthNoiseLearnerTest, itsNoiseWithoutLevelsIsStructuredLight)
{
    const DepthNoise noise =
        learnt(0.8, 4, [&](double z) { return 1 / (1 / z + 1e-3 * normal()); }, {});
    EXPECT_EQ(noise.kind, "structuredLight");
    expectGiven(noise);
}

TEST_F(DepthNoiseLearnerTest, moreNoiseWithoutLevelsIsLearnt)
{
    const DepthNoise noise =
        learnt(0.8, 4, [&](double z) { return 1 / (1 / z + 2.2e-3 * normal()); }, {});
    EXPECT_NEAR(noise.sigmaInverseDepth, 1.4 * 2.2e-3, 6e-4);
    EXPECT_TRUE(noise.isConstantInInverseDepth());
}

/** As large as a Kinect's in the middle of the room, but not growing with the distance. */
TEST_F(DepthNoiseLearnerTest, noiseThatDoesNotGrowIsTimeOfFlight)
{
    const DepthNoise noise = learnt(0.8, 4, [&](double z) { return z + 4e-3 * normal(); }, {});
    EXPECT_EQ(noise.kind, "timeOfFlight");
    EXPECT_NEAR(noise.sigmaDepth, 1.4 * 4e-3, 1.5e-3);
}

TEST_F(DepthNoiseLearnerTest, constantNoiseIsTimeOfFlight)
{
    const DepthNoise noise =
        learnt(0.5, 4, [&](double z) { return inMillimetres(z + 1e-3 * normal()); }, {});
    EXPECT_EQ(noise.kind, "timeOfFlight");
    // 1 mm and the rounding's 0.3 within a cell, times what cells do not see.
    EXPECT_NEAR(noise.sigmaDepth, 1.4 * std::hypot(1e-3, 1e-3 / std::sqrt(12)), 3e-4);
    EXPECT_GT(noise.sigmaRelative, 0);
    EXPECT_LT(noise.sigmaInverseDepth, 2e-4);
}

/** A table top tells nothing of the noise at 3 m. */
TEST_F(DepthNoiseLearnerTest, itIsToldAtWhichDistancesItWasLearnt)
{
    const auto camera = [&](double z) { return inMillimetres(z + 1e-3 * normal()); };
    const DepthNoise noise = learnt(0.3, 0.6, camera, {});
    EXPECT_NEAR(noise.learntFrom, 0.3, 0.06);  // half an octave
    EXPECT_NEAR(noise.learntTo, 0.6, 0.12);
    EXPECT_DOUBLE_EQ(learnt(0.5, 4, camera, DepthNoise()).learntTo, 4);
    DepthNoise given;
    given.kind = "given";
    EXPECT_EQ(learnt(0.5, 4, camera, given).learntTo, 0);
}

/** Depth of 256 columns, enlarged to the size of colour images. */
TEST_F(DepthNoiseLearnerTest, theSizeToWhichDepthIsEnlargedDoesNotMatter)
{
    const auto sigmaAt = [&](int width)
    {
        DepthNoiseLearner learner(DepthNoise{});
        for (int i = 0; i < 3; ++i)
        {
            cv::Mat image;
            cv::resize(
                floorImage(0.8, 4, [&](double z) { return z + 6e-3 * normal(); }),
                image,
                {256, 192},
                0,
                0,
                cv::INTER_NEAREST);
            cv::resize(image, image, {width, width * 3 / 4}, 0, 0, cv::INTER_LINEAR);
            learner.update(image);
        }
        return learner.noise().sigmaZ(2);
    };
    const double sigma = sigmaAt(640);
    EXPECT_GT(sigma, 3e-3);
    for (const int width : {1280, 1920, 2560})
    {
        EXPECT_NEAR(sigmaAt(width), sigma, 0.2 * sigma) << width;
    }
}

TEST_F(DepthNoiseLearnerTest, muchNoiseInInverseDepthIsActiveStereo)
{
    const DepthNoise noise =
        learnt(0.5, 4, [&](double z) { return inMillimetres(1 / (1 / z + 5e-3 * normal())); }, {});
    EXPECT_EQ(noise.kind, "activeStereo");
    EXPECT_NEAR(noise.sigmaInverseDepth, 1.4 * 5e-3, 2e-3);
    EXPECT_GT(noise.sigmaRelative, 0);
}

TEST_F(DepthNoiseLearnerTest, noNoiseIsRendered)
{
    const DepthNoise noise = learnt(0.5, 4, [](double z) { return z; }, {});
    EXPECT_EQ(noise.kind, "rendered");
    expectGiven(noise);
}

/** A hand scanner over a table: what is near is known, and beyond, what is given. */
TEST_F(DepthNoiseLearnerTest, nearReadingsDoNotTellHowNoiseGrows)
{
    const auto scanner = [&](double z) { return inMillimetres(z + 0.4e-3 * normal()); };
    DepthNoise given;
    for (const char* kind : {"learn", "activeStereo"})
    {
        given.kind = kind;
        const DepthNoise noise = learnt(0.2, 0.4, scanner, given);
        EXPECT_EQ(noise.kind, kind);
        EXPECT_NEAR(noise.sigmaDepth, 1.4 * std::hypot(0.4e-3, 1e-3 / std::sqrt(12)), 2e-4);
        EXPECT_EQ(noise.sigmaInverseDepth, given.sigmaInverseDepth);
    }
    given.kind = "timeOfFlight";  // which does not grow
    EXPECT_LT(learnt(0.2, 0.4, scanner, given).sigmaInverseDepth, 1e-5);
}

TEST_F(DepthNoiseLearnerTest, aKindThatIsSaidHasTheGivenNoiseUntilItIsMeasured)
{
    for (const char* kind : {"timeOfFlight", "activeStereo"})
    {
        DepthNoise given;
        given.kind = kind;
        DepthNoiseLearner learner(given);
        expectGiven(learner.noise());
        learner.update(cv::Mat(20, 20, CV_32FC1, cv::Scalar(1)));  // four cells
        learner.update(cv::Mat(240, 320, CV_32FC1, cv::Scalar(std::nan(""))));
        expectGiven(learner.noise());
    }
}

/** Before a wall square to it, all readings of a quiet camera round to the same millimetre. */
TEST_F(DepthNoiseLearnerTest, aQuietCameraIsNotRendered)
{
    for (const double sigma : {0.05e-3, 0.1e-3, 0.2e-3, 0.5e-3})
    {
        for (const double far : {2.0003, 2.1, 3.0})
        {
            for (const double near : {2.0003, 1.2})
            {
                const DepthNoise noise = learnt(
                    near, far, [&](double z) { return inMillimetres(z + sigma * normal()); }, {});
                EXPECT_NE(noise.kind, "rendered") << sigma << ", " << near << " to " << far;
                // Rounded readings tell no less than the rounding.
                EXPECT_GT(noise.sigmaZ(2), 1e-3 / std::sqrt(12)) << sigma << ", " << near;
                const bool isSquare = near == far;
                if (!isSquare)
                {
                    EXPECT_EQ(noise.kind, "timeOfFlight") << sigma << ", " << near << " " << far;
                }
            }
        }
    }
}

TEST_F(DepthNoiseLearnerTest, whatIsSaidIsKept)
{
    DepthNoise given;
    given.kind = "given";
    given.sigmaDepth = 0.01;
    given.sigmaRelative = 0.02;
    const auto flight = [&](double z) { return inMillimetres(z + 1e-3 * normal()); };
    const DepthNoise kept = learnt(0.5, 4, flight, given);
    EXPECT_EQ(kept.kind, "given");
    EXPECT_EQ(kept.sigmaDepth, 0.01);
    EXPECT_EQ(kept.sigmaRelative, 0.02);

    given = {};
    given.kind = "structuredLight";
    expectGiven(learnt(0.5, 4, flight, given));
    given.kind = "activeStereo";
    EXPECT_NEAR(learnt(0.5, 4, flight, given).sigmaDepth, 1.4e-3, 3e-4);
}

TEST_F(DepthNoiseLearnerTest, imagesThatTellNothingLeaveWhatIsGiven)
{
    DepthNoiseLearner learner({});
    EXPECT_EQ(learner.noise().kind, "learn");
    learner.update(cv::Mat(240, 320, CV_32FC1, cv::Scalar(std::nan(""))));
    learner.update(cv::Mat(5, 5, CV_32FC1, cv::Scalar(1)));
    learner.update(cv::Mat());
    EXPECT_EQ(learner.noise().kind, "learn");
    expectGiven(learner.noise());
}

/** Cells of one distance tell the noise there, and not how it grows. (Nearer, it is that of a
 * Kinect.) */
TEST_F(DepthNoiseLearnerTest, aWallTellsTheNoiseAtItsDistance)
{
    for (double z = 1.5; z < 40; z *= 1.09)
    {
        DepthNoiseLearner learner({});
        learner.update(floorImage(z, z, [&](double depth) { return depth + 2e-3 * normal(); }));
        const DepthNoise& noise = learner.noise();
        DepthNoise unbent = noise;
        unbent.sigmaRelative = 0;
        EXPECT_EQ(noise.kind, "timeOfFlight") << z;
        EXPECT_NEAR(unbent.sigmaZ(z), 1.4 * 2e-3, 0.6e-3) << z;
    }
}

/** A camera that gives no depth for a while is the same afterwards. */
TEST_F(DepthNoiseLearnerTest, imagesWithoutDepthAreNotForgetting)
{
    DepthNoiseLearner learner({});
    const cv::Mat blank(240, 320, CV_32FC1, std::numeric_limits<float>::quiet_NaN());
    learner.update(blank);
    const auto image = [&]
    { return floorImage(0.8, 4, [&](double z) { return z + 2e-3 * normal(); }); };
    learner.update(image());
    const DepthNoise before = learner.noise();
    EXPECT_EQ(before.kind, "timeOfFlight");
    for (int i = 0; i < 2000; ++i)
    {
        learner.update(blank);
    }
    EXPECT_EQ(learner.noise().kind, before.kind);
    EXPECT_EQ(learner.noise().sigmaDepth, before.sigmaDepth);
    learner.update(image());
    EXPECT_EQ(learner.noise().kind, before.kind);
}

/** A camera that first looks at something near is known when it has seen the room. */
TEST_F(DepthNoiseLearnerTest, aKinectThatStartsNearIsKnownLater)
{
    const auto kinect = [&](double z)
    { return inMillimetres(1 / (2.87e-3 * std::round((1 / z + 0.7e-3 * normal()) / 2.87e-3))); };
    DepthNoiseLearner learner({});
    for (int i = 0; i < 30; ++i)
    {
        learner.update(i < 5 ? floorImage(0.45, 0.7, kinect) : floorImage(0.8, 4, kinect));
    }
    EXPECT_EQ(learner.noise().kind, "structuredLight");
}
}  // namespace pointplane
