// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/se3.h>
#include <pointplane/odometry/Odometry.h>
#include <pointplane/odometry/uncertainty/LensCalibrator.h>
#include <pointplane/simulation/SimulatedSequence.h>

#include <Eigen/Cholesky>

#include <cmath>
#include <iostream>

#include "matchers.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
PinholeCamera nominal()
{
    PinholeCamera out;
    out.isNominal = true;
    return out;
}

/** A tenth of it is as much as is known before. */
CameraInformation asMuchAsBefore(const PinholeCamera& camera)
{
    CameraInformation out;
    out.information.block<kNumLensErrors, kNumLensErrors>(kPrincipalPointX, kPrincipalPointX) =
        10 * lensVariances(camera, 0).cwiseInverse().asDiagonal().toDenseMatrix();
    return out;
}

struct DeskRun
{
    double error{0};  //!< of motions over a second, root mean square [m]
    double nees{0};   //!< of these motions, per degree of freedom
    LearntLens lens;
};

/** Runs over a desk, seen by a camera that nobody calibrated. Motions count from the middle on.
 * \param told what is told of the camera's focal length, over the true one */
DeskRun runDesk(double told, bool learns)
{
    constexpr int kInterval = 30;
    SimulationParams simulation;
    simulation.width = 320;
    simulation.height = 240;
    simulation.duration = 4;
    const SimulatedSequence sequence("desk", simulation, 31);
    OdometryParams params;
    params.lens.nominal = true;
    params.lens.selfCalibrate = learns;
    params.covariance.history = kInterval;
    Odometry odometry(params);
    DeskRun out;
    int numMotions = 0;
    for (int i = 0; i < sequence.numFrames(); ++i)
    {
        RgbdFrame frame = sequence.frame(i);
        frame.camera.fx *= told;
        frame.camera.fy *= told;
        const OdometryResult result = odometry.process(frame);
        out.lens = result.diagnostics.lens;
        if (2 * i >= sequence.numFrames())
        {
            const PoseGaussian& motion = result.since.at(kInterval - 1);
            const Vector6d e = leftError(motion.mean, sequence.trueMotion(i - kInterval, i));
            out.error += e.head<3>().squaredNorm();
            out.nees += e.dot(motion.cov.ldlt().solve(e)) / 6;
            ++numMotions;
        }
    }
    out.error = std::sqrt(out.error / numMotions);
    out.nees /= numMotions;
    std::cout << told << ": " << 1e3 * out.error << " mm, NEES " << out.nees << ", "
              << describe(out.lens) << "\n";
    return out;
}
}  // namespace

/** Prior and frame, which counts as a tenth, know the same: the estimate goes half of the way, its
 * error is half of the one before and half of the frame's. */
TEST(LensCalibrator, learnsByHand)
{
    const PinholeCamera camera = nominal();
    const LensVector before = lensVariances(camera, 0);
    CameraInformation frame = asMuchAsBefore(camera);
    frame.gradient[kFocalLength] = -0.01 * frame.information(kFocalLength, kFocalLength);
    LensCalibrator lens({});
    EXPECT_EQ(lens.errors(camera), CameraVector::Zero().eval());
    const LensCalibrator::Change change = lens.update(frame, camera, 0);
    EXPECT_THAT(
        lens.errors(camera),
        test::IsMatrixNear(CameraVector(0.005 * CameraVector::Unit(3)), 1e-12));
    EXPECT_THAT(change.gain, test::IsMatrixNear(LensMatrix(0.5 * LensMatrix::Identity()), 1e-12));
    EXPECT_THAT(
        change.noise, test::IsMatrixNear(LensMatrix(0.25 * LensMatrix(before.asDiagonal())), 1e-9));
    EXPECT_NEAR(lens.learnt(camera).sigmas[2], 0.02 / std::sqrt(2), 1e-12);
}

TEST(LensCalibrator, aCalibrationIsBelieved)
{
    const PinholeCamera camera;
    CameraInformation frame = asMuchAsBefore(nominal());
    frame.gradient.setConstant(1e3);
    LensCalibrator lens({});
    const LensCalibrator::Change change = lens.update(frame, camera, 0);
    EXPECT_EQ(lens.errors(camera), CameraVector::Zero().eval());
    EXPECT_EQ(change.gain, LensMatrix::Identity().eval());
    EXPECT_EQ(change.noise, LensMatrix::Zero().eval());
    EXPECT_EQ(describe(lens.learnt(camera)), "");
}

/** That depth is bent shows after some images. From then on the lens may err, too. */
TEST(LensCalibrator, depthTurnsOutToBeBent)
{
    const PinholeCamera camera;
    LensCalibrator lens({});
    (void)lens.update({}, camera, 0);
    const LensCalibrator::Change change = lens.update(asMuchAsBefore(nominal()), camera, 0.005);
    const double variance = std::pow(lens.learnt(camera).sigmas[3], 2);
    EXPECT_GT(variance, 0.5 * lensVariances(camera, 0.005)[3]);
    EXPECT_LT(variance, lensVariances(camera, 0.005)[3]);
    // Before, there was no error: all that there is now is new.
    EXPECT_NEAR(change.noise(3, 3), variance, 1e-12);
    EXPECT_EQ(lens.learnt(camera).sigmas[2], 0);
}

TEST(LensCalibrator, anotherCameraStartsAnew)
{
    const PinholeCamera camera = nominal();
    CameraInformation frame = asMuchAsBefore(camera);
    frame.gradient[kFocalLength] = -1;
    LensCalibrator lens({});
    (void)lens.update(frame, camera, 0);
    EXPECT_GT(lens.errors(camera).norm(), 0);
    PinholeCamera other = camera;
    other.fx += 1;
    EXPECT_EQ(lens.errors(other), CameraVector::Zero().eval());
    (void)lens.update({}, other, 0);
    EXPECT_EQ(lens.errors(other), CameraVector::Zero().eval());
    EXPECT_NEAR(lens.learnt(other).sigmas[2], 0.02, 1e-12);
}

TEST(LensCalibrator, canBeSwitchedOff)
{
    CameraInformation frame = asMuchAsBefore(nominal());
    frame.gradient.setOnes();
    LensCalibrator lens({false, false});
    EXPECT_EQ(lens.update(frame, nominal(), 0.01).gain, LensMatrix::Identity().eval());
    EXPECT_EQ(lens.errors(nominal()), CameraVector::Zero().eval());
}

TEST(LensCalibrator, tellsUsers)
{
    LearntLens lens;
    EXPECT_EQ(describe(lens), "");
    lens.errors[3] = 0.0123;
    lens.sigmas[3] = 0.0045;
    EXPECT_EQ(describe(lens), "radial distortion +0.0123 +- 0.0045");
    lens.errors << 1.26, -2, -0.0123, 0;
    lens.sigmas << 0.5, 0.5, 0.001, 0.01;
    EXPECT_EQ(
        describe(lens),
        "focal length -1.23 +- 0.10 %, principal point x +1.3 +- 0.5 px, y -2.0 +- 0.5 px, radial "
        "distortion +0.0000 +- 0.0100");
}

/** Its focal length is told three per cent too short. */
TEST(LensCalibrator, findsTheFocalLength)
{
    const DeskRun given = runDesk(0.97, false);
    EXPECT_EQ(describe(given.lens), "");
    const DeskRun learnt = runDesk(0.97, true);
    EXPECT_LT(learnt.error, given.error / 3);
    EXPECT_NEAR(learnt.lens.errors[2], 1 / 0.97 - 1, 3 * learnt.lens.sigmas[2]);
    EXPECT_LT(learnt.lens.sigmas[2], 0.005);
    EXPECT_LT(learnt.nees, 3);
}

/** Noise must not make a lens seem wrong that is right: residuals are shorter with a longer focal
 * length, whatever is seen. */
TEST(LensCalibrator, aRightLensStays)
{
    const DeskRun given = runDesk(1, false);
    const DeskRun learnt = runDesk(1, true);
    EXPECT_LT(learnt.error, 1.2 * given.error);
    EXPECT_LT(learnt.nees, 3);
    for (int k = 0; k < kNumLensErrors; ++k)
    {
        EXPECT_LT(std::abs(learnt.lens.errors[k]), 3 * learnt.lens.sigmas[k]) << k;
    }
}
}  // namespace pointplane
