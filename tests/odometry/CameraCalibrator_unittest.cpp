// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/se3.h>
#include <pointplane/odometry/Odometry.h>
#include <pointplane/odometry/uncertainty/CameraCalibrator.h>
#include <pointplane/simulation/SimulatedSequence.h>

#include <Eigen/Cholesky>

#include <cmath>
#include <iostream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "linear_algebra.h"
#include "matchers.h"
#include "monte_carlo.h"
#include "uncertainty/camera_errors.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
constexpr double kUnknown = ShutterModel::kUnknown;
constexpr int kNumLearnt = 7;  // four of the lens, three of the shutter

/** Velocities. */
const Eigen::Matrix3d kExact = Eigen::Matrix3d::Zero();

PinholeCamera nominal()
{
    PinholeCamera out;
    out.isNominal = true;
    return out;
}

CameraCalibrator::TShutter shutter()
{
    CameraCalibrator::TShutter out;
    out.readoutColour = 0.021;
    out.readoutDepth = 0.022;
    out.depthDelay = -0.003;
    out.sigmaPrior = 0.005;
    return out;
}

CameraCalibrator calibratorOf(
    const PinholeCamera& camera, const CameraCalibrator::TShutter& params = shutter())
{
    CameraCalibrator out(params, {});
    out.start(camera, calibrationVariances({}, camera));
    return out;
}

/** What a frame says of lens and shutter. */
PoseAnalysis frameOf(const CameraInformation& said)
{
    PoseAnalysis out;
    out.camera = out.cameraByReference = said;
    return out;
}

/** A tenth of it is as much as is known before. */
CameraInformation asMuchAsBefore()
{
    CameraInformation out;
    const CameraMatrix cov = calibratorOf(nominal()).cov();
    for (const int k : {1, 2, 3, 4, 6, 7, 8})
    {
        out.information(k, k) = 10 / cov(k, k);
    }
    return out;
}

/** Residuals of a frame that depend on lens and shutter, and a little on both together. */
struct Residuals
{
    explicit Residuals(test::GaussianSampler& sampler)
    {
        for (int row = 0; row < J.rows(); ++row)
        {
            J.row(row) = sampler.vector<kNumCameraErrors>().transpose();
        }
        // As much as errors of the camera move features, over their noise.
        CameraVector scale;
        scale << 1, 0.05, 0.05, 20, 10, 100, 40, 40, 40;
        J = (J * scale.asDiagonal()).eval();
        J.topRows<8>().rightCols<3>().setZero();  // rows of the lens
        J.bottomRows<8>().middleCols<5>(kPrincipalPointX).setZero();
    }

    /** With the camera's errors off by `error` and with this noise. */
    [[nodiscard]] CameraInformation about(
        const CameraVector& error, const Eigen::Matrix<double, 16, 1>& noise) const
    {
        return {J.transpose() * J, -J.transpose() * (J * error + noise)};
    }

    Eigen::Matrix<double, 16, kNumCameraErrors> J;
};

/** Of the errors that are learnt. */
template <class Matrix>
Eigen::MatrixXd learntOf(const Matrix& errors)
{
    const std::vector<int> learnt{1, 2, 3, 4, 6, 7, 8};
    return errors.cols() == 1 ? Eigen::MatrixXd(errors(learnt, 0))
                              : Eigen::MatrixXd(errors(learnt, learnt));
}

struct DeskRun
{
    double error{0};  //!< of motions over a second, root mean square [m]
    double nees{0};   //!< of these motions, per degree of freedom
    LearntLens lens;
};

/** Runs over a desk, seen by a camera that nobody calibrated, or wrongly. Motions count from the
 * middle on. \param told what is told of the camera's focal length, over the true one */
DeskRun runDesk(double told, bool learns, unsigned seed = 31, bool isNominal = true)
{
    constexpr int kInterval = 30;
    SimulationParams simulation;
    simulation.width = 320;
    simulation.height = 240;
    simulation.duration = 4;
    const SimulatedSequence sequence("desk", simulation, seed);
    OdometryParams params;
    params.lens.nominal = isNominal;
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

TEST(CameraCalibrator, completesWhatTheSourceDoesNotTell)
{
    const CameraCalibrator calibrator = calibratorOf({});
    const ShutterModel all = calibrator.complete({});
    EXPECT_EQ(all.readoutColour, 0.021);
    EXPECT_EQ(all.readoutDepth, 0.022);
    EXPECT_EQ(all.depthDelay, -0.003);

    const ShutterModel some = calibrator.complete({0.025, kUnknown, kUnknown});
    EXPECT_EQ(some.readoutColour, 0.025);
    EXPECT_EQ(some.readoutDepth, 0.022);
}

/** Stamps tell when an image arrived. */
TEST(CameraCalibrator, addsToADelayFromStamps)
{
    const ShutterModel out = calibratorOf({}).complete({kUnknown, kUnknown, 0.010});
    EXPECT_DOUBLE_EQ(out.depthDelay, 0.007);
}

TEST(CameraCalibrator, believesASourceThatKnowsItsShutter)
{
    const ShutterModel out = calibratorOf({}).complete({0.027, 0.024, -0.010});
    EXPECT_EQ(out.readoutColour, 0.027);
    EXPECT_EQ(out.readoutDepth, 0.024);
    EXPECT_EQ(out.depthDelay, -0.010);
}

TEST(CameraCalibrator, canTakeImagesForThoseOfOneInstant)
{
    CameraCalibrator::TShutter still = shutter();
    still.correct = false;
    const CameraCalibrator calibrator = calibratorOf({}, still);
    EXPECT_TRUE(calibrator.cov().isZero(0));
    for (const ShutterModel& source : {ShutterModel{}, ShutterModel{0.027, 0.024, -0.010}})
    {
        const ShutterModel out = calibrator.complete(source);
        EXPECT_EQ(out.readoutColour, 0);
        EXPECT_EQ(out.readoutDepth, 0);
        EXPECT_EQ(out.depthDelay, 0);
    }
}

TEST(CameraCalibrator, estimatesWhatTheSourceDoesNotTell)
{
    EXPECT_EQ(CameraCalibrator::estimated({}), Eigen::Vector3d(1, 1, 1));
    EXPECT_EQ(CameraCalibrator::estimated({0.025, kUnknown, 0.001}), Eigen::Vector3d(0, 1, 1));
    EXPECT_EQ(CameraCalibrator::estimated({0.025, 0.02, 0.001}), Eigen::Vector3d(0, 0, 0));
}

TEST(CameraCalibrator, refusesParametersOutOfRange)
{
    const auto refused = [](auto change)
    {
        CameraCalibrator::TShutter p = shutter();
        change(p);
        EXPECT_THROW(CameraCalibrator(p, {}), std::invalid_argument);
    };
    refused([](auto& p) { p.readoutColour = 1; });
    refused([](auto& p) { p.readoutDepth = -1; });
    refused([](auto& p) { p.depthDelay = kUnknown; });
    refused([](auto& p) { p.sigmaPrior = 0; });
    refused([](auto& p) { p.varianceFactor = 0; });
}

/** Prior and frame, which counts as a tenth, know the same: the estimate goes half of the way, its
 * error is half of the one before and half of the frame's. */
TEST(CameraCalibrator, learnsALensByHand)
{
    CameraInformation said = asMuchAsBefore();
    said.gradient[kFocalLength] = -0.01 * said.information(kFocalLength, kFocalLength);
    CameraCalibrator calibrator = calibratorOf(nominal());
    const CameraMatrix before = calibrator.cov();
    EXPECT_EQ(calibrator.errors(), CameraVector::Zero().eval());
    const CameraCalibrator::Change change = calibrator.update(frameOf(said), 0, 1, kExact);
    EXPECT_THAT(
        calibrator.errors(),
        test::IsMatrixNear(CameraVector(0.005 * CameraVector::Unit(kFocalLength)), 1e-12));
    CameraVector gain = CameraVector::Constant(0.5);
    gain[kVignetting] = gain[kDepthScale] = 1;
    EXPECT_THAT(change.gain, test::IsMatrixNear(CameraMatrix(gain.asDiagonal()), 1e-12));
    EXPECT_THAT(change.noise, test::IsMatrixNear(CameraMatrix(0.25 * before), 1e-9));
    EXPECT_NEAR(calibrator.lens().errors[2], 0.005, 1e-12);
    EXPECT_NEAR(calibrator.lens().sigmas[2], 0.02 / std::sqrt(2), 1e-12);
}

TEST(CameraCalibrator, learnsAShutterByHand)
{
    CameraCalibrator::TShutter p = shutter();
    p.varianceFactor = 10;
    CameraCalibrator calibrator = calibratorOf({}, p);
    CameraInformation said;
    said.information.setIdentity();
    said.information *= 4e5;
    said.gradient.tail<3>() << -1600, 0, 800;  // 4 ms more readout, 2 ms less delay
    const CameraCalibrator::Change change = calibrator.update(frameOf(said), 0, 1, kExact);
    const ShutterModel learnt = calibrator.complete({});
    EXPECT_NEAR(learnt.readoutColour, 0.021 + 0.002, 1e-12);
    EXPECT_NEAR(learnt.readoutDepth, 0.022, 1e-12);
    EXPECT_NEAR(learnt.depthDelay, -0.003 - 0.001, 1e-12);
    EXPECT_NEAR(change.gain(kReadoutColour, kReadoutColour), 0.5, 1e-12);
    EXPECT_NEAR(change.noise(kDepthDelay, kDepthDelay), 0.25 * 0.005 * 0.005, 1e-15);

    p.selfCalibrate = false;
    CameraCalibrator fixed = calibratorOf({}, p);
    EXPECT_EQ(fixed.update(frameOf(said), 0, 1, kExact).gain(kReadoutColour, kReadoutColour), 1);
    EXPECT_EQ(fixed.complete({}).readoutColour, 0.021);
}

/** What moves with a time that is not known well errs by the time and by its uncertainty. */
TEST(CameraCalibrator, rootMeanSquaresByHand)
{
    const CameraCalibrator calibrator = calibratorOf({});
    const ShutterModel learnt = calibrator.rootMeanSquare({});
    EXPECT_NEAR(learnt.readoutColour, std::hypot(0.021, 0.005), 1e-12);
    EXPECT_NEAR(learnt.readoutDepth, std::hypot(0.022, 0.005), 1e-12);
    EXPECT_NEAR(learnt.depthDelay, -std::hypot(0.003, 0.005), 1e-12);
    const ShutterModel told = calibrator.rootMeanSquare({0.03, kUnknown, kUnknown});
    EXPECT_NEAR(told.readoutColour, 0.03, 1e-12);
    EXPECT_NEAR(told.readoutDepth, std::hypot(0.022, 0.005), 1e-12);
}

/** Images may be turned: the first row or the last one may be exposed first. */
TEST(CameraCalibrator, findsOutWhichRowIsTheFirst)
{
    CameraCalibrator::TShutter p;
    p.readoutColour = 0.02;
    p.readoutDepth = 0.03;
    p.sigmaPrior = 0.01;
    p.varianceFactor = 1;
    EXPECT_EQ(calibratorOf({}, p).complete({}).readoutColour, 0.02);
    PinholeCamera upright;
    std::swap(upright.width, upright.height);
    EXPECT_EQ(calibratorOf(upright, p).complete({}).readoutColour, 0) << "turned, to any side";
    p.findDirection = true;
    const CameraCalibrator start = calibratorOf({}, p);
    EXPECT_EQ(start.complete({}).readoutColour, 0);
    EXPECT_EQ(start.complete({}).readoutDepth, 0);
    EXPECT_NEAR(start.cov()(kReadoutColour, kReadoutColour), 5e-4, 1e-15);
    EXPECT_NEAR(start.cov()(kReadoutDepth, kReadoutDepth), 1e-3, 1e-15);

    // A frame that knows nothing before says `readout`, known to 2 ms.
    const auto after = [&](double readout)
    {
        CameraInformation said;
        said.information(kReadoutColour, kReadoutColour) = 1 / (0.002 * 0.002);
        said.gradient[kReadoutColour] = -readout / (0.002 * 0.002);
        std::pair<CameraCalibrator, CameraCalibrator::Change> out(start, {});
        out.second = out.first.update(frameOf(said), 0, 1, kExact);
        return out;
    };
    EXPECT_LT(after(0.008).first.complete({}).readoutColour, 0.008) << "four standard deviations";
    for (const double direction : {1, -1})
    {
        const auto [learnt, change] = after(direction * 0.012);
        EXPECT_NEAR(learnt.complete({}).readoutColour, direction * 0.02, 1e-15);
        EXPECT_NEAR(learnt.complete({}).readoutDepth, direction * 0.03, 1e-15);
        const Eigen::Vector3d variances = Eigen::Vector3d::Constant(1e-4);
        EXPECT_TRUE(learnt.cov().diagonal().tail<3>().isApprox(variances)) << "learnt from here on";
        EXPECT_TRUE(change.gain.bottomRows<3>().isZero(0)) << "its error is a new one";
        EXPECT_TRUE(change.noise.diagonal().tail<3>().isApprox(variances));
    }
    p.selfCalibrate = false;
    EXPECT_EQ(calibratorOf({}, p).complete({}).readoutColour, 0.02);
}

/** Of the shutter the references speak together: with a motion of its own for each, the motion is
 * as little known as the times. Of the lens each speaks alone. */
TEST(CameraCalibrator, lensAndShutterAreToldByDifferentResiduals)
{
    PoseAnalysis frame;
    frame.camera.gradient.setConstant(1);
    CameraCalibrator together = calibratorOf(nominal());
    (void)together.update(frame, 0, 1, kExact);
    EXPECT_TRUE(together.errors().head<6>().isZero(0));
    EXPECT_LT(together.errors().tail<3>().maxCoeff(), 0);
    std::swap(frame.camera, frame.cameraByReference);
    CameraCalibrator alone = calibratorOf(nominal());
    (void)alone.update(frame, 0, 1, kExact);
    EXPECT_LT(alone.errors().segment<4>(kPrincipalPointX).maxCoeff(), 0);
    EXPECT_TRUE(alone.errors().tail<3>().isZero(0));
}

/** Half of what is told is noise of the velocities: so the times are half as well known. */
TEST(CameraCalibrator, timesAreToldAsWellAsVelocitiesAreKnown)
{
    CameraInformation said = asMuchAsBefore();
    said.gradient = -0.001 * said.information.diagonal();
    const CameraVector before = calibratorOf(nominal()).cov().diagonal();
    CameraCalibrator calibrator = calibratorOf(nominal());
    (void)calibrator.update(
        frameOf(said), 0, 1, Eigen::Matrix3d(10 * said.information.bottomRightCorner<3, 3>()));
    for (const int time : {6, 7, 8})
    {
        EXPECT_NEAR(calibrator.cov()(time, time), before[time] / 1.5, 1e-12);
        EXPECT_NEAR(calibrator.errors()[time], 0.001 / 3, 1e-12);
    }
    EXPECT_NEAR(calibrator.cov()(1, 1), before[1] / 2, 1e-9) << "they say nothing of the lens";

    CameraCalibrator unmoved = calibratorOf(nominal());
    (void)unmoved.update({}, 0, 1, Eigen::Matrix3d::Identity());
    EXPECT_EQ(CameraVector(unmoved.cov().diagonal()), before);
}

TEST(CameraCalibrator, aCalibrationIsBelieved)
{
    CameraInformation said = asMuchAsBefore();
    said.gradient.setConstant(1e-2);
    CameraCalibrator::TShutter known = shutter();
    known.selfCalibrate = false;
    PinholeCamera calibrated = nominal();
    calibrated.isNominal = false;
    CameraCalibrator calibrator = calibratorOf(calibrated, known);
    const CameraCalibrator::Change change = calibrator.update(frameOf(said), 0, 1, kExact);
    EXPECT_EQ(calibrator.errors(), CameraVector::Zero().eval());
    EXPECT_EQ(change.gain, CameraMatrix::Identity().eval());
    EXPECT_EQ(change.noise, CameraMatrix::Zero().eval());
    EXPECT_EQ(describe(calibrator.lens()), "");
}

/** That depth is bent shows after some images. From then on the lens may err, too. */
TEST(CameraCalibrator, depthTurnsOutToBeBent)
{
    const PinholeCamera camera;
    CameraCalibrator calibrator = calibratorOf(camera);
    (void)calibrator.update({}, 0, 1, kExact);
    const CameraCalibrator::Change change =
        calibrator.update(frameOf(asMuchAsBefore()), 0.005, 1, kExact);
    const double variance = std::pow(calibrator.lens().sigmas[3], 2);
    EXPECT_GT(variance, 0.5 * lensVariances(camera, 0.005)[kRadial]);
    EXPECT_LT(variance, lensVariances(camera, 0.005)[kRadial]);
    // Before, there was no error: all that there is now is new.
    EXPECT_NEAR(change.noise(kRadial, kRadial), variance, 1e-12);
    EXPECT_EQ(calibrator.lens().sigmas[2], 0);
}

TEST(CameraCalibrator, anotherCameraStartsAnew)
{
    CameraInformation said = asMuchAsBefore();
    said.gradient.setConstant(-1);
    CameraCalibrator calibrator = calibratorOf(nominal());
    (void)calibrator.update(frameOf(said), 0, 1, kExact);
    EXPECT_GT(calibrator.lens().errors[2], 0);
    EXPECT_GT(calibrator.complete({}).depthDelay, -0.003);
    calibrator.start(nominal(), calibrationVariances({}, nominal()));
    EXPECT_EQ(calibrator.errors(), CameraVector::Zero().eval());
    EXPECT_EQ(calibrator.cov(), calibratorOf(nominal()).cov());
    EXPECT_NEAR(calibrator.lens().sigmas[2], 0.02, 1e-12);
}

TEST(CameraCalibrator, aLensCanBeTakenAsTold)
{
    CameraInformation said = asMuchAsBefore();
    said.gradient.setOnes();
    CameraCalibrator calibrator(shutter(), {false, false});
    calibrator.start(nominal(), calibrationVariances({}, nominal()));
    const CameraMatrix gain = calibrator.update(frameOf(said), 0.01, 1, kExact).gain;
    EXPECT_EQ((gain.topLeftCorner<6, 6>()), (Eigen::Matrix<double, 6, 6>::Identity()));
    EXPECT_TRUE(calibrator.errors().head<6>().isZero(0));
}

/** What frames say one after the other is what they say together: the minimum of the sum of their
 * costs and the prior's. And the change of the error is that of the covariance. */
TEST(CameraCalibrator, framesAddUp)
{
    test::GaussianSampler sampler(5);
    CameraCalibrator::TShutter p = shutter();
    p.varianceFactor = 3;
    CameraCalibrator calibrator = calibratorOf(nominal(), p);
    const Eigen::MatrixXd prior = learntOf(calibrator.cov());
    Eigen::MatrixXd information = test::inverse(prior);
    Eigen::MatrixXd slope = Eigen::VectorXd::Zero(kNumLearnt);
    const CameraVector truth = 1e-3 * CameraVector::Ones();
    for (int i = 0; i < 5; ++i)
    {
        const Residuals residuals(sampler);
        const Eigen::Matrix<double, 16, 1> noise = sampler.vector<16>();
        const CameraVector ofLearnt =
            truth.cwiseProduct(CameraVector(calibrator.cov().diagonal().cwiseSign()));
        const CameraInformation atZero = residuals.about(ofLearnt, noise);
        information += learntOf(atZero.information) / (2 * 3);
        slope -= learntOf(atZero.gradient) / (2 * 3);
        const CameraMatrix before = calibrator.cov();
        const CameraCalibrator::Change change = calibrator.update(
            frameOf(residuals.about(ofLearnt - calibrator.errors(), noise)), 0, 2, kExact);
        EXPECT_THAT(
            CameraMatrix(change.gain * before * change.gain.transpose() + change.noise),
            test::IsMatrixNear(calibrator.cov(), 1e-9));
    }
    const Eigen::MatrixXd cov = test::inverse(information);
    EXPECT_THAT(learntOf(calibrator.cov()), test::IsMatrixNear(cov, 1e-9));
    EXPECT_THAT(
        learntOf(calibrator.errors()), test::IsMatrixNear(Eigen::MatrixXd(cov * slope), 1e-9));
}

/** Its covariance is that of its errors, also if velocities err that have moved the features. */
TEST(CameraCalibrator, errorsOfVelocitiesAreAccountedFor)
{
    constexpr int kRuns = 2000;
    test::GaussianSampler sampler(17);
    CameraCalibrator::TShutter p = shutter();
    p.varianceFactor = 1;
    double nees = 0, unaware = 0;
    for (int run = 0; run < kRuns; ++run)
    {
        CameraCalibrator knows = calibratorOf(nominal(), p), ignores = knows;
        const CameraVector truth = knows.cov().diagonal().cwiseSqrt().cwiseProduct(
            CameraVector(sampler.vector<kNumCameraErrors>()));
        for (int i = 0; i < 5; ++i)
        {
            const Residuals residuals(sampler);
            const Eigen::Matrix<double, 16, 1> noise = sampler.vector<16>();
            const Eigen::Matrix3d root = 500 * Eigen::Matrix3d::Identity();
            const Eigen::Vector3d byVelocity = root * sampler.vector<3>();
            const auto said = [&](const CameraCalibrator& calibrator)
            {
                CameraInformation out = residuals.about(truth - calibrator.errors(), noise);
                out.gradient.tail<3>() += byVelocity;
                return frameOf(out);
            };
            (void)knows.update(said(knows), 0, 1, root * root.transpose());
            (void)ignores.update(said(ignores), 0, 1, kExact);
        }
        const auto of = [&](const CameraCalibrator& calibrator)
        {
            return test::squaredMahalanobis(
                       Eigen::VectorXd((truth - calibrator.errors()).tail<3>()),
                       Eigen::MatrixXd(calibrator.cov().bottomRightCorner<3, 3>())) /
                   (3 * kRuns);
        };
        nees += of(knows);
        unaware += of(ignores);
    }
    EXPECT_NEAR(nees, 1, 0.06);  // three standard deviations
    EXPECT_GT(unaware, 2) << "else this tests nothing";
}

/** Its covariance is that of its errors, if frames err independently, and also if ten of them err
 * alike and count as a tenth each. */
TEST(CameraCalibrator, covarianceIsThatOfMonteCarlo)
{
    constexpr int kRuns = 2000;
    for (const int repeated : {1, 10})
    {
        test::GaussianSampler sampler(7);
        CameraCalibrator::TShutter p = shutter();
        p.varianceFactor = repeated;
        double nees = 0;
        for (int run = 0; run < kRuns; ++run)
        {
            CameraCalibrator calibrator = calibratorOf(nominal(), p);
            const CameraVector truth = calibrator.cov().diagonal().cwiseSqrt().cwiseProduct(
                CameraVector(sampler.vector<kNumCameraErrors>()));
            for (int i = 0; i < 3; ++i)
            {
                const Residuals residuals(sampler);
                const Eigen::Matrix<double, 16, 1> noise = sampler.vector<16>();
                for (int k = 0; k < repeated; ++k)
                {
                    (void)calibrator.update(
                        frameOf(residuals.about(truth - calibrator.errors(), noise)), 0, 1, kExact);
                }
            }
            nees += test::squaredMahalanobis(
                        learntOf(truth - calibrator.errors()), learntOf(calibrator.cov())) /
                    (kNumLearnt * kRuns);
        }
        EXPECT_NEAR(nees, 1, 0.04) << repeated;  // three standard deviations
    }
}

/** A camera at rest tells nothing, one that only turns not all. */
TEST(CameraCalibrator, whatAFrameDoesNotTellStays)
{
    CameraCalibrator calibrator = calibratorOf(nominal());
    const CameraMatrix before = calibrator.cov();
    const CameraCalibrator::Change nothing = calibrator.update({}, 0, 1, kExact);
    EXPECT_EQ(nothing.gain, CameraMatrix::Identity().eval());
    EXPECT_EQ(nothing.noise, CameraMatrix::Zero().eval());
    EXPECT_EQ(calibrator.cov(), before);

    // However much it tells of the sum of two times, it tells nothing of their difference.
    CameraVector sum = CameraVector::Zero(), difference = CameraVector::Zero();
    sum[kReadoutDepth] = sum[kDepthDelay] = difference[kReadoutDepth] = 1;
    difference[kDepthDelay] = -1;
    CameraInformation said;
    said.information = 1e12 * sum * sum.transpose();
    said.gradient = -1e12 * 0.002 * sum;
    (void)calibrator.update(frameOf(said), 0, 1, kExact);
    EXPECT_NEAR(sum.dot(calibrator.errors()), 0.002, 1e-9);
    EXPECT_NEAR(difference.dot(calibrator.errors()), 0, 1e-9);
    EXPECT_NEAR(sum.dot(calibrator.cov() * sum), 1e-11, 1e-13);
    EXPECT_NEAR(
        difference.dot(calibrator.cov() * difference), difference.dot(before * difference), 1e-9);
    EXPECT_GT(test::symmetricEigen(learntOf(calibrator.cov())).values.minCoeff(), 0);
}

/** No camera is as slow as residuals of a wrong motion may say. The next frames can take it back.
 */
TEST(CameraCalibrator, hugeResidualsDoNotTakeTimesOutOfRange)
{
    CameraInformation said = asMuchAsBefore();
    said.gradient.tail<3>() << -1e9, 1e9, -1e9;
    CameraCalibrator calibrator = calibratorOf({});
    (void)calibrator.update(frameOf(said), 0, 1, kExact);
    const ShutterModel learnt = calibrator.complete({});
    EXPECT_DOUBLE_EQ(learnt.readoutColour, 0.05);
    EXPECT_DOUBLE_EQ(learnt.readoutDepth, -0.05);
    EXPECT_DOUBLE_EQ(learnt.depthDelay, 0.05);
    const double wrong = calibrator.errors().norm();
    for (int i = 0; i < 10; ++i)
    {
        // They say that the times are as told, each as much as the prior said.
        CameraInformation right = asMuchAsBefore();
        right.gradient = right.information * calibrator.errors();
        (void)calibrator.update(frameOf(right), 0, 1, kExact);
    }
    EXPECT_NEAR(calibrator.errors().norm(), wrong * 2 / 12, 1e-12);
}

TEST(CameraCalibrator, tellsUsers)
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
TEST(CameraCalibrator, findsTheFocalLength)
{
    const DeskRun given = runDesk(0.97, false);
    EXPECT_EQ(describe(given.lens), "");
    const DeskRun learnt = runDesk(0.97, true);
    EXPECT_LT(learnt.error, given.error / 3);
    EXPECT_NEAR(learnt.lens.errors[2], 1 / 0.97 - 1, 3 * learnt.lens.sigmas[2]);
    EXPECT_LT(learnt.lens.sigmas[2], 0.005);
    EXPECT_LT(learnt.nees, 3);
}

/** Its focal length is told six per cent too short. */
TEST(CameraCalibrator, aCalibrationThatDoesNotFitIsTakenForNominal)
{
    const DeskRun given = runDesk(0.94, false, 31, false);
    EXPECT_FALSE(given.lens.isContradicted);
    const DeskRun learnt = runDesk(0.94, true, 31, false);
    EXPECT_TRUE(learnt.lens.isContradicted);
    EXPECT_LT(learnt.error, given.error / 2);
    EXPECT_NEAR(learnt.lens.errors[2], 1 / 0.94 - 1, 3 * learnt.lens.sigmas[2]);
    EXPECT_LT(learnt.nees, 3);
    EXPECT_GT(given.nees, 10);
    const DeskRun right = runDesk(1, true, 31, false);
    EXPECT_FALSE(right.lens.isContradicted);
    EXPECT_EQ(describe(right.lens), "");
}

/** Noise must not make a lens seem wrong that is right: residuals are shorter with a longer focal
 * length, whatever is seen. */
TEST(CameraCalibrator, aRightLensStays)
{
    double errorsOfGiven = 0, errorsOfLearnt = 0;  // squared: of one run they are much of a chance
    double nees = 0;
    for (unsigned seed = 31; seed < 35; ++seed)
    {
        const DeskRun given = runDesk(1, false, seed);
        const DeskRun learnt = runDesk(1, true, seed);
        errorsOfGiven += given.error * given.error;
        errorsOfLearnt += learnt.error * learnt.error;
        nees += learnt.nees / 4;
        EXPECT_LT(learnt.nees, 3);
        for (int k = 0; k < learnt.lens.errors.size(); ++k)
        {
            EXPECT_LT(std::abs(learnt.lens.errors[k]), 3 * learnt.lens.sigmas[k]) << k;
        }
    }
    EXPECT_LT(std::sqrt(errorsOfLearnt), 1.2 * std::sqrt(errorsOfGiven));
    EXPECT_GT(nees, 0.25) << "errors of the camera that a simulation does not have are considered";
}
}  // namespace pointplane
