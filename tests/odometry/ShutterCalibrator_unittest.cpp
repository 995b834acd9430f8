// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/odometry/uncertainty/ShutterCalibrator.h>

#include <stdexcept>

#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
constexpr double kUnknown = ShutterModel::kUnknown;

ShutterCalibrator::TParams params()
{
    ShutterCalibrator::TParams out;
    out.readoutColour = 0.021;
    out.readoutDepth = 0.022;
    out.depthDelay = -0.003;
    return out;
}
}  // namespace

TEST(ShutterCalibrator, completesWhatTheSourceDoesNotTell)
{
    const ShutterModel all = ShutterCalibrator(params()).complete({});
    EXPECT_EQ(all.readoutColour, 0.021);
    EXPECT_EQ(all.readoutDepth, 0.022);
    EXPECT_EQ(all.depthDelay, -0.003);

    const ShutterModel some = ShutterCalibrator(params()).complete({0.025, kUnknown, kUnknown});
    EXPECT_EQ(some.readoutColour, 0.025);
    EXPECT_EQ(some.readoutDepth, 0.022);
}

/** Stamps tell when an image arrived. */
TEST(ShutterCalibrator, addsToADelayFromStamps)
{
    const ShutterModel out = ShutterCalibrator(params()).complete({kUnknown, kUnknown, 0.010});
    EXPECT_DOUBLE_EQ(out.depthDelay, 0.007);
}

TEST(ShutterCalibrator, believesASourceThatKnowsItsShutter)
{
    const ShutterModel out = ShutterCalibrator(params()).complete({0.027, 0.024, -0.010});
    EXPECT_EQ(out.readoutColour, 0.027);
    EXPECT_EQ(out.readoutDepth, 0.024);
    EXPECT_EQ(out.depthDelay, -0.010);
}

TEST(ShutterCalibrator, canTakeImagesForThoseOfOneInstant)
{
    ShutterCalibrator::TParams still = params();
    still.correct = false;
    for (const ShutterModel& source : {ShutterModel{}, ShutterModel{0.027, 0.024, -0.010}})
    {
        const ShutterModel out = ShutterCalibrator(still).complete(source);
        EXPECT_EQ(out.readoutColour, 0);
        EXPECT_EQ(out.readoutDepth, 0);
        EXPECT_EQ(out.depthDelay, 0);
    }
}

TEST(ShutterCalibrator, estimatesWhatTheSourceDoesNotTell)
{
    const ShutterCalibrator calibrator(params());
    EXPECT_EQ(calibrator.estimated({}), Eigen::Vector3d(1, 1, 1));
    EXPECT_EQ(calibrator.estimated({0.025, kUnknown, 0.001}), Eigen::Vector3d(0, 1, 1));
    EXPECT_EQ(calibrator.estimated({0.025, 0.02, 0.001}), Eigen::Vector3d(0, 0, 0));
}

/** Prior and frame, which counts as a tenth, know the same: the estimate goes half of the way, its
 * error is half of the one before and half of the frame's. */
TEST(ShutterCalibrator, learnsByHand)
{
    ShutterCalibrator::TParams p = params();
    p.sigmaPrior = 0.01;
    p.varianceFactor = 10;
    ShutterCalibrator calibrator(p);
    CameraInformation camera;
    camera.information.setIdentity();
    camera.information *= 1e5;
    camera.gradient.tail<3>() << -400, 0, 200;  // 4 ms more readout, 2 ms less delay
    const ShutterCalibrator::Change change = calibrator.update(camera);
    EXPECT_NEAR(calibrator.estimate()[0], 0.021 + 0.002, 1e-12);
    EXPECT_NEAR(calibrator.estimate()[1], 0.022, 1e-12);
    EXPECT_NEAR(calibrator.estimate()[2], -0.003 - 0.001, 1e-12);
    EXPECT_NEAR(change.gain(0, 0), 0.5, 1e-12);
    EXPECT_NEAR(change.noise(2, 2), 0.25e-4, 1e-15);

    p.selfCalibrate = false;
    ShutterCalibrator fixed(p);
    EXPECT_EQ(fixed.update(camera).gain(0, 0), 1);
    EXPECT_EQ(fixed.estimate()[0], 0.021);
}

TEST(ShutterCalibrator, refusesParametersOutOfRange)
{
    const auto refused = [](auto change)
    {
        ShutterCalibrator::TParams p = params();
        change(p);
        EXPECT_THROW(ShutterCalibrator{p}, std::invalid_argument);
    };
    refused([](auto& p) { p.readoutColour = 1; });
    refused([](auto& p) { p.readoutDepth = -1; });
    refused([](auto& p) { p.depthDelay = kUnknown; });
    refused([](auto& p) { p.sigmaPrior = 0; });
    refused([](auto& p) { p.varianceFactor = 0; });
}
}  // namespace pointplane
