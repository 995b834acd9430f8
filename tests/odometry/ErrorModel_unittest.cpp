// SPDX-License-Identifier: BSD-3-Clause
#include "uncertainty/ErrorModel.h"

#include <cmath>
#include <vector>

#include "matchers.h"
#include "monte_carlo.h"
#include "uncertainty/view_errors.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
/** Features as noisy as propagated, and a camera that has moved by 0.6 m since its only reference.
 */
class ErrorModelTest : public testing::Test
{
 protected:
    ErrorModelTest()
    {
        params.noiseScale.adaptive = false;
        camera.fx = 500;
        reference.id = 1;
        nearReference.id = 2;
        nearReference.T_world_cam.translation().x() = 0.65;
        estimate.motion.mean.T_prev_cur.translation().x() = 0.6;
        estimate.infoPoints = Matrix6d::Identity();
        estimate.infoPoints.bottomRightCorner<3, 3>() *= 2;  // as if they were 1 m away
        analysis.sensitivity.points = Matrix12d::Identity();
        analysis.sensitivity.planes = 2 * Matrix12d::Identity();
        analysis.pointVariance = analysis.planeVariance = 1;
        analysis.turnVariance = 1e-6;
    }

    [[nodiscard]] ErrorModel::Measured measured(double dt = 1e-9) const
    {
        ErrorModel::Measured out;
        out.references = {&reference};
        out.estimate = estimate;
        out.analysis = analysis;
        out.dt = dt;
        out.shutter = {0, 0, 0};
        return out;
    }

    [[nodiscard]] JointCovariance::Measurement learn() const
    {
        ErrorModel model(params);
        (void)model.changeCamera(camera);
        return model.learn(measured());
    }

    /** The last of many frames of these residuals, seen from two places. */
    [[nodiscard]] JointCovariance::Measurement learnForLong(double dt, double bend = 0)
    {
        params.noiseScale.adaptive = true;
        ErrorModel model(params);
        (void)model.changeCamera(camera);
        ErrorModel::Measured frame = measured(dt);
        frame.references.push_back(&nearReference);
        frame.bend = bend;
        JointCovariance::Measurement out;
        for (int i = 0; i < 300; ++i)
        {
            out = model.learn(frame);
        }
        return out;
    }

    /** What both references show of errors with these variances, of which the latter depends on the
     * view. */
    [[nodiscard]] std::vector<ReferenceVariance> residuals(double own, double byView) const
    {
        std::vector<ReferenceVariance> out;
        for (const Reference* of : {&reference, &nearReference})
        {
            const Eigen::Isometry3d motion =
                of->T_world_cam.inverse() * estimate.motion.mean.T_prev_cur;
            out.push_back(
                {of->id, own + byView * (1 - planeViewCorrelation(motion, 1, viewAngle())), 9});
        }
        return out;
    }

    [[nodiscard]] double viewAngle() const
    {
        return 2 * std::atan(std::sqrt(camera.width / camera.fx * camera.height / camera.fy) / 2);
    }

    OdometryParams params;
    PinholeCamera camera;
    Reference reference, nearReference;
    PoseEstimate estimate;
    PoseAnalysis analysis;
};
}  // namespace

TEST_F(ErrorModelTest, aFrameWhoseImageIsPulledApartErrsMore)
{
    params.noiseScale.adaptive = true;
    const auto learnt = [&](double scatter)
    {
        ErrorModel model(params);
        (void)model.changeCamera(camera);
        JointCovariance::Measurement out;
        for (const double next : {5.0, 5.0, scatter})
        {
            analysis.scatter = next;
            out = model.learn(measured());
        }
        return out;
    };
    const JointCovariance::Measurement usual = learnt(5), bad = learnt(50);
    EXPECT_NEAR(bad.noise(0, 0), 10 * usual.noise(0, 0), 1e-9);
    EXPECT_NEAR(bad.views.pointSigma[0], std::sqrt(10) * usual.views.pointSigma[0], 1e-9);
}

/** Of points, a part of what the residuals show, which is one where nothing is learnt. Planes are
 * as noisy as propagated. */
TEST_F(ErrorModelTest, noiseByHand)
{
    EXPECT_NEAR(learn().noise(0, 0), params.covariance.noise + 2, 1e-12);
}

/** The rest of the residuals is not noise of this frame. */
TEST_F(ErrorModelTest, noiseOfPointsIsAPartOfTheirResiduals)
{
    analysis.pointVariance = 9;
    analysis.sensitivity.planes.setZero();
    EXPECT_NEAR(learnForLong(1).noise(0, 0), 9 * params.covariance.noise, 1e-9);
}

/** Within what the prior weighs: 3 of 1100 dimensions. */
TEST_F(ErrorModelTest, planesErrAsTheirResidualsTell)
{
    analysis.planeResiduals.references = residuals(2, 8);
    analysis.planeResiduals.followed = 0;
    analysis.sensitivity.points.setZero();
    const JointCovariance::Measurement out = learnForLong(1.0 / 30);
    EXPECT_NEAR(out.noise(0, 0), 2 * 2, 0.2);
    EXPECT_NEAR(std::pow(out.views.planeRoot(0, 0), 2), 8 * 2, 0.5);
}

TEST_F(ErrorModelTest, aSmoothErrorOfDepthIsAsLargeAsItsResidualsTell)
{
    constexpr double kBend = 0.1;  // as much is expected: half of its square is new in each image
    analysis.patchResiduals = residuals(2, 8);
    for (ReferenceVariance& of : analysis.patchResiduals)
    {
        of.variance *= kBend * kBend / 2;
    }
    const JointCovariance::Measurement out = learnForLong(1.0 / 30, kBend);
    EXPECT_NEAR(
        std::pow(out.views.patchSigma, 2), 10 * kBend * kBend / 2, 0.02 * 10 * kBend * kBend / 2);
    EXPECT_NEAR(out.views.ofPatches(0, 1), 0.8 * out.views.ofPlanes(0, 1), 0.01);
    EXPECT_NEAR(out.views.ofPatches(2, 2), 1, 1e-12);
}

/** A part of the predicted motion that the solution follows brings its own noise. */
TEST_F(ErrorModelTest, whatTimeAddsToThePredictedMotionIsNoise)
{
    test::GaussianSampler sampler(7);
    analysis.sensitivity.points.setZero();
    analysis.sensitivity.planes.setZero();
    const Matrix12d motionNoise = sampler.covariance<12>(0.1, 1);
    analysis.sensitivity.prior = sampler.vector<12>() * sampler.vector<12>().transpose();
    analysis.sensitivity.prior += 0.5 * Matrix12d::Identity();
    ErrorModel model(params);
    (void)model.changeCamera(camera);
    ErrorModel::Measured frame = measured();
    frame.motionNoise = motionNoise;
    const JointCovariance::Measurement out = model.learn(frame);
    EXPECT_EQ(out.factors.prior, analysis.sensitivity.prior);
    const Matrix12d expected = out.factors.prior * motionNoise * out.factors.prior.transpose();
    EXPECT_THAT(out.noise, test::IsMatrixNear(expected, 1e-9));
}

/** Points that may be wrong add what they may be wrong by, in either model. */
TEST_F(ErrorModelTest, doubtIsNoise)
{
    for (const char* model : {"joint", "independent"})
    {
        params.covariance.model = model;
        ErrorModel errors(params);
        (void)errors.changeCamera(camera);
        ErrorModel::Measured frame = measured();
        Matrix6d doubt = Matrix6d::Zero();
        frame.doubt = doubt;
        const Matrix12d without = errors.learn(frame).noise;
        doubt(0, 0) = 0.25;
        doubt(0, 5) = doubt(5, 0) = 0.1;
        frame.doubt = doubt;
        const Matrix12d added = errors.learn(frame).noise - without;
        EXPECT_THAT(Matrix6d(added.topLeftCorner<6, 6>()), test::IsMatrixNear(doubt, 1e-12));
        EXPECT_TRUE(added.bottomRows<6>().isZero(1e-12));
    }
}

/** Planes err by the view as the noise of planes makes the pose err. Nothing is known of it but the
 * prior, by which both are as large as propagated. */
TEST_F(ErrorModelTest, planesErrByTheirView)
{
    const double angle = viewAngle();
    estimate.motion.mean.T_prev_cur.linear() =
        Eigen::AngleAxisd(angle / 3, Eigen::Vector3d::UnitY()).toRotationMatrix();
    analysis.sensitivity.planes(3, 3) = 8;
    const JointCovariance::Measurement out = learn();
    EXPECT_NEAR(out.views.ofPlanes(0, 1), std::exp(-3 * 0.6 / angle - 1), 1e-6)
        << "0.6 m of 1 m, and a third of the view";
    EXPECT_NEAR(out.views.ofPoints(0, 1), std::exp(-0.6 / angle - 1.0 / 3), 1e-6) << "of points";
    EXPECT_NEAR(out.views.planeRoot(0, 0), std::sqrt(2), 1e-9);
    EXPECT_NEAR(out.views.planeRoot(3, 3), std::sqrt(8), 1e-9);
    EXPECT_NEAR(out.views.planeRoot(0, 3), 0, 1e-9);
    analysis.sensitivity.planes.setZero();
    EXPECT_TRUE(learn().views.planeRoot.isZero(1e-12));
}

/** Where the camera has turned by the angle of its view, which is that of both sides' mean. */
TEST_F(ErrorModelTest, viewsAreAsWideAsTheCamera)
{
    camera.width = 4000;
    camera.height = 1000;
    camera.fy = -camera.fx;
    estimate.motion.mean.T_prev_cur = Eigen::AngleAxisd(M_PI_2, Eigen::Vector3d::UnitY());
    const double angle = 2 * std::atan(2);  // 2000 pixels in the mean, at 500 pixels
    EXPECT_NEAR(learn().views.ofPoints(0, 1), std::exp(-M_PI_2 / angle), 1e-6);
}

/** Planes tell turns as if they were far away: all features together, as if they were 2 m away. */
TEST_F(ErrorModelTest, viewsAreAsFarAwayAsPointsAndPlanes)
{
    estimate.infoPlanes.bottomRightCorner<3, 3>() = 6 * Eigen::Matrix3d::Identity();
    const JointCovariance::Measurement out = learn();
    EXPECT_NEAR(out.views.ofPoints(0, 1), std::exp(-0.6 / 2 / viewAngle()), 1e-6);
    EXPECT_NEAR(out.views.pointSigma[0], 2 * out.views.pointSigma[3], 1e-12);
}

/** The new frame is 0.6 m from the previous one, which is 0.2 m from another reference. */
TEST_F(ErrorModelTest, allViewsAreCompared)
{
    reference.T_world_cam = Eigen::Translation3d(1, 2, 3) *
                            Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 0.5).normalized());
    nearReference.T_world_cam = reference.T_world_cam * Eigen::Translation3d(-0.2, 0, 0);
    ErrorModel model(params);
    (void)model.changeCamera(camera);
    ErrorModel::Measured frame = measured();
    frame.references.push_back(&nearReference);
    const JointCovariance::Views views = model.learn(frame).views;
    EXPECT_EQ(views.frames, (std::vector<int>{1, 2}));
    Eigen::Matrix3d apart;
    apart << 0, 0.2, 0.6, 0.2, 0, 0.8, 0.6, 0.8, 0;
    apart /= viewAngle();
    EXPECT_THAT(
        views.ofPoints, test::IsMatrixNear(Eigen::Matrix3d((-apart.array()).exp().matrix()), 1e-6));
    EXPECT_THAT(
        views.ofPlanes,
        test::IsMatrixNear(Eigen::Matrix3d((-3 * apart.array()).exp().matrix()), 1e-6));
}

TEST_F(ErrorModelTest, aFrameErrsByItsView)
{
    const JointCovariance::Measurement out = learn();
    EXPECT_EQ(out.views.frames, std::vector<int>{1});
    ASSERT_EQ(out.views.ofPoints.rows(), 2);
    EXPECT_EQ(out.views.ofPoints(0, 0), 1);
    EXPECT_NEAR(out.views.ofPoints(0, 1), std::exp(-0.6 / viewAngle()), 1e-6);
    EXPECT_EQ(out.views.ofPoints(1, 0), out.views.ofPoints(0, 1));
    EXPECT_GT(out.views.pointSigma[0], 0);
    EXPECT_NEAR(out.views.pointSigma[3], out.views.pointSigma[0], 1e-12)
        << "a turn errs as much, 1 m away";
    params.covariance.viewNoise *= 2;
    EXPECT_NEAR(learn().views.pointSigma[0], 2 * out.views.pointSigma[0], 1e-15);
}

/** Points tell a turn to 1 mrad. The references contradict each other as if all of it were noise of
 * each; 0.22 of it is noise of the frame. */
TEST_F(ErrorModelTest, errorByTheViewByHand)
{
    params.covariance.viewNoise = 10;
    EXPECT_NEAR(learn().views.pointSigma[3], 0.01 * std::sqrt(1 - params.covariance.noise), 1e-12);
}

/** What the references contradict each other by is what the frame's own noise explains: views do
 * not err. */
TEST_F(ErrorModelTest, withoutContradictionsViewsDoNotErr)
{
    params.covariance.noise = 1;
    EXPECT_TRUE(learn().views.pointSigma.isZero(0));
}

/** The same errors, whatever noise is beside them: with a quarter of the points, or four times the
 * variance of each, they make references contradict each other a quarter as much, over the noise.
 */
TEST_F(ErrorModelTest, errorByTheViewDoesNotDependOnTheNoiseOfPoints)
{
    params.noiseScale.adaptive = true;
    params.covariance.noise = 1;
    const auto learnt = [&](double turnVariance, double pointVariance)
    {
        ErrorModel model(params);
        (void)model.changeCamera(camera);
        JointCovariance::Measurement out;
        for (int i = 0; i < 200; ++i)
        {
            analysis.turnVariance = turnVariance;
            analysis.pointVariance = pointVariance;
            const double needed = 1 + 3e-6 / (turnVariance * pointVariance);
            const double told = model.noise().points / std::min(100.0, pointVariance);
            analysis.pointDisagreement = {needed / told, 1};
            out = model.learn(measured(1));
        }
        return out.views.pointSigma[3];
    };
    const double usual = learnt(1e-6, 1);
    EXPECT_NEAR(usual, params.covariance.viewNoise * std::sqrt(3e-6), 0.02 * usual);
    EXPECT_NEAR(learnt(4e-6, 1), usual, 0.02 * usual) << "a quarter of the points";
    EXPECT_NEAR(learnt(1e-6, 4), usual, 0.02 * usual) << "four times the variance of each";
    EXPECT_NEAR(learnt(0.25e-6, 4), usual, 0.02 * usual) << "half the size of images";
}

TEST_F(ErrorModelTest, aSmoothErrorOfDepthIsPassedOn)
{
    analysis.sensitivity.patches.setConstant(2);
    analysis.sensitivity.referencePatches[1].setConstant(3);
    ErrorModel model(params);
    ErrorModel::Measured frame = measured();
    frame.bend = 0.1;
    const JointCovariance::Measurement out = model.learn(frame);
    EXPECT_NEAR(out.views.patchSigma, 0.1, 1e-12);
    EXPECT_NEAR(out.views.ofPatches(0, 0), 1, 1e-12);
    EXPECT_NEAR(out.views.ofPatches(0, 1), out.views.ofPlanes(0, 1) / 2, 1e-12) << "half is new";
    EXPECT_EQ(out.factors.patches(0, 5), 2);
    EXPECT_EQ(out.factors.referencePatches.at(1)(0, 5), 3);
}

/** Points that a frame does not have say nothing of what it errs by. */
TEST_F(ErrorModelTest, withoutPointsOnlyPlanesErrByTheView)
{
    EXPECT_GT(learn().views.pointSigma[0], 0);
    analysis.sensitivity.points.setZero();
    EXPECT_TRUE(learn().views.pointSigma.isZero(0));
    EXPECT_GT(learn().views.planeRoot(0, 0), 0);
}

TEST_F(ErrorModelTest, aFrameErrsByAccelerationWhileItIsExposed)
{
    analysis.sensitivity.planesMoved.topRows<6>().setIdentity();
    const auto noise = [&](double depthDelay)
    {
        ErrorModel model(params);
        (void)model.changeCamera(camera);
        ErrorModel::Measured frame = measured();
        frame.acceleration2.setConstant(4);
        frame.shutter.depthDelay = depthDelay;
        return model.learn(frame).noise(0, 0);
    };
    EXPECT_NEAR(noise(0.02) - noise(0), 0.0004 * 0.0004, 1e-13);
    EXPECT_NEAR(noise(ShutterModel::kUnknown) - noise(0), 0.0001 * 0.0001, 1e-13)
        << "it may be 10 ms";
}

/** The larger of what a calibration may err by and what is to be learnt. */
TEST_F(ErrorModelTest, aCameraErrsByItsCalibrationAndWhatIsToBeLearnt)
{
    const auto sigma = [&](int k)
    { return std::sqrt(ErrorModel(params).changeCamera(camera)(k, k)); };
    EXPECT_NEAR(sigma(kFocalLength), params.covariance.focalLength, 1e-12);
    EXPECT_NEAR(sigma(kDepthScale), params.covariance.depthScale, 1e-12);
    EXPECT_NEAR(sigma(kDepthDelay), params.shutter.sigmaPrior, 1e-12);
    EXPECT_EQ(sigma(kRadial), 0);
    camera.isNominal = true;
    EXPECT_NEAR(sigma(kFocalLength), 0.02, 1e-12);
    params.covariance.focalLength = 0.1;
    EXPECT_NEAR(sigma(kFocalLength), 0.1, 1e-12) << "who says that it is worse is believed";
    params.shutter.selfCalibrate = false;
    EXPECT_EQ(sigma(kDepthDelay), 0);
    params.shutter.selfCalibrate = true;
    params.shutter.correct = false;
    EXPECT_EQ(sigma(kDepthDelay), 0) << "images are taken for those of one instant";
}

/** What is learnt of the camera changes its errors, which all poses share. */
TEST_F(ErrorModelTest, whatIsLearntOfTheCameraIsPassedOn)
{
    ErrorModel model(params);
    (void)model.changeCamera({});
    analysis.camera.information(kDepthDelay, kDepthDelay) = 1e5;
    analysis.camera.gradient[kDepthDelay] = -200;
    const JointCovariance::Measurement out = model.learn(measured());
    EXPECT_NEAR(out.camera.gain(kDepthDelay, kDepthDelay), 0.5, 1e-12);
    EXPECT_NEAR(out.camera.noise(kDepthDelay, kDepthDelay), 0.25e-4, 1e-12);
    EXPECT_NEAR(model.camera().errors()[kDepthDelay], 0.001, 1e-12);
}

/** Twice what the frame tells of the delay, its velocities may have told by mistake (S of 1e6
 * against an information of 1e5, which counts for a tenth): 0.5 of the variance would stay, 2/3 do.
 */
TEST_F(ErrorModelTest, timesAreToldAsWellAsVelocitiesAreKnown)
{
    analysis.camera.information(kDepthDelay, kDepthDelay) = 1e5;
    const auto gain = [&](double ofReference, double ofFrame)
    {
        ErrorModel model(params);
        (void)model.changeCamera({});
        estimate.motion.cov.setZero();
        estimate.motion.cov(6, 6) = ofFrame;
        ErrorModel::Measured frame = measured();
        frame.velocities[reference.id] = ofReference * Matrix6d::Identity();
        return model.learn(frame).camera.gain(kDepthDelay, kDepthDelay);
    };
    EXPECT_NEAR(gain(1, 1), 0.5, 1e-9) << "of global shutters, velocities tell nothing";
    CameraByVelocity& change = analysis.cameraByVelocity[reference.id];
    change.setZero();
    change(kDepthDelay, 0) = 1e3;
    EXPECT_NEAR(gain(0, 0), 0.5, 1e-9);
    EXPECT_NEAR(gain(1, 0), 2.0 / 3, 1e-9);
    EXPECT_NEAR(gain(0, 1), 0.5, 1e-9) << "the solution follows the frame's own velocity";
    params.shutter.findDirection = true;
    EXPECT_NEAR(gain(0, 1), 2.0 / 3, 1e-9) << "as long as it does not know the readout";
    EXPECT_NEAR(gain(1, 1), 0.75, 1e-9);
}

TEST_F(ErrorModelTest, independentIncrementsErrAsTheSolverSays)
{
    params.covariance.model = "independent";
    estimate.motion.cov = 3 * Matrix12d::Identity();
    const JointCovariance::Measurement out = learn();
    EXPECT_THAT(
        Matrix6d(out.noise.topLeftCorner<6, 6>()),
        test::IsMatrixNear(Matrix6d(3 * Matrix6d::Identity()), 1e-15));
    EXPECT_TRUE(out.factors.references.empty());
    EXPECT_TRUE(out.views.pointSigma.isZero(0));
}
}  // namespace pointplane
