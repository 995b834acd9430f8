// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/core/se3.h>
#include <pointplane/pose/PoseSolver.h>

#include <Eigen/Cholesky>

#include <limits>
#include <vector>

#include "matchers.h"
#include "synthetic_pairs.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
using PatchVector = Eigen::Matrix<double, kNumPatches, 1>;

struct Solved
{
    PoseEstimate estimate;
    PoseAnalysis analysis;
};

Solved solve(const PoseProblem& problem)
{
    const PoseSolver solver(test::gaussianSolver());
    const PoseEstimate estimate = solver.solve(problem, problem.prior.mean);
    return {estimate, solver.analyse(problem, estimate)};
}

/** Of two references, with a prior and a rolling shutter. */
PoseProblem makeProblem(unsigned seed)
{
    test::PairWorld world(seed);
    world.addPoints(30);
    world.addPlanes(4);
    world.T_prev_cur = world.randomMotion(0.03, 0.035);
    PoseProblem out{world.drawPoints(0), world.drawPlanes(0), {}, {2, 3}};
    for (size_t i = 0; i < out.points.size(); ++i)
    {
        out.points[i].reference = i % 2 == 0 ? 1 : 2;
        out.points[i].dCur_dV = 0.01 * world.sampler().uniform(-1, 1) * Matrix36d::Ones();
        out.points[i].dRef_dV = 0.01 * world.sampler().vector<3>() * Vector6d::Ones().transpose();
    }
    for (size_t i = 0; i < out.planes.size(); ++i)
    {
        out.planes[i].reference = i % 2 == 0 ? 1 : 2;
        out.planes[i].dRef_dV = 0.01 * world.sampler().vector<3>() * Vector6d::Ones().transpose();
    }
    MotionGaussian predicted;
    predicted.mean.T_prev_cur = world.T_prev_cur;
    predicted.cov = world.sampler().covariance<12>(1e-5, 1e-4);
    out.prior = MotionPrior::from(predicted);
    return out;
}

/** The same with a smooth error of depth: each point is in one patch of each image. */
PoseProblem makeBentProblem(unsigned seed)
{
    PoseProblem out = makeProblem(seed);
    for (size_t i = 0; i < out.points.size(); ++i)
    {
        PointPair& pair = out.points[i];
        pair.dRef_dCamera.col(kDepthScale) = pair.ref.mean;
        pair.dCur_dCamera.col(kDepthScale) = pair.cur.mean;
        pair.refPatch = static_cast<int>(i) % 3;
        pair.curPatch = static_cast<int>(i) % 5;
    }
    return out;
}

/** Scales the depth of the points in each patch of the current image, and of one reference's. */
void bend(
    PoseProblem& problem,
    const PatchVector& current,
    int reference = 0,
    const PatchVector& ofReference = PatchVector::Zero())
{
    for (PointPair& pair : problem.points)
    {
        pair.cur.mean += current[pair.curPatch] * pair.dCur_dCamera.col(kDepthScale);
        if (pair.reference == reference)
        {
            pair.ref.mean += ofReference[pair.refPatch] * pair.dRef_dCamera.col(kDepthScale);
        }
    }
}

/** How a feature changes with errors of the camera: along one direction. */
ByCamera randomByCamera(test::GaussianSampler& sampler)
{
    return 0.02 * sampler.vector<3>() * sampler.vector<kNumCameraErrors>().transpose();
}

/** Where the estimate goes when the problem changes. */
Vector12d change(const PoseEstimate& before, const PoseEstimate& after)
{
    Vector12d out;
    out << leftError(after.motion.mean.T_prev_cur, before.motion.mean.T_prev_cur),
        after.motion.mean.velocity - before.motion.mean.velocity;
    return out;
}
}  // namespace

/** A pair that is not finite counts for nothing here, too. */
TEST(Sensitivity, brokenPairsDoNotSpoilThePatches)
{
    PoseProblem broken = makeBentProblem(81);
    PoseProblem without = broken;
    without.points.erase(without.points.begin());
    PointPair& pair = broken.points.front();
    pair.cur.mean.setConstant(std::numeric_limits<double>::quiet_NaN());
    pair.dCur_dCamera.col(kDepthScale) = pair.cur.mean;
    pair.dRef_dCamera.col(kDepthScale) = pair.cur.mean;
    const MotionByPatches spoilt = solve(broken).analysis.sensitivity.patches;
    EXPECT_TRUE(spoilt.allFinite());
    EXPECT_THAT(spoilt, test::IsMatrixNear(solve(without).analysis.sensitivity.patches, 1e-9));
}

TEST(Sensitivity, toTheReferences)
{
    const PoseProblem problem = makeProblem(81);
    const Solved solved = solve(problem);
    ASSERT_EQ(solved.analysis.sensitivity.references.size(), 2U);
    for (int axis = 0; axis < 6; ++axis)
    {
        PoseProblem moved = problem;
        const Vector6d xi = 1e-3 * Vector6d::Unit(axis);
        for (PointPair& pair : moved.points)
        {
            pair.ref.mean = pair.reference == 2 ? se3Exp(xi) * pair.ref.mean : pair.ref.mean;
        }
        for (PlanePair& pair : moved.planes)
        {
            pair.ref.theta_m =
                pair.reference == 2 ? transformed(se3Exp(xi), pair.ref).theta_m : pair.ref.theta_m;
        }
        const Vector12d expected = solved.analysis.sensitivity.references.at(2).leftCols<6>() * xi;
        EXPECT_THAT(
            change(solved.estimate, solve(moved).estimate), test::IsMatrixNear(expected, 4e-5))
            << axis;
        EXPECT_GT(expected.norm(), 2e-4);
    }
}

/** A rolling shutter has moved their features by it. */
TEST(Sensitivity, toTheVelocityOfTheReferences)
{
    const PoseProblem problem = makeProblem(81);
    const Solved solved = solve(problem);
    const Sensitivity& sensitivity = solved.analysis.sensitivity;
    PoseProblem moved = problem, pointsAlone = problem;
    const Vector6d dV = 0.01 * Vector6d::LinSpaced(0.5, 1);
    const auto move = [&dV](auto& pair, Eigen::Vector3d& feature)
    {
        if (pair.reference == 2)
        {
            feature += pair.dRef_dV * dV;
        }
    };
    for (size_t i = 0; i < problem.points.size(); ++i)
    {
        move(moved.points[i], moved.points[i].ref.mean);
        move(pointsAlone.points[i], pointsAlone.points[i].ref.mean);
    }
    for (PlanePair& pair : moved.planes)
    {
        move(pair, pair.ref.theta_m);
    }
    const Vector12d expected = sensitivity.references.at(2).rightCols<6>() * dV;
    EXPECT_THAT(change(solved.estimate, solve(moved).estimate), test::IsMatrixNear(expected, 1e-6));
    EXPECT_GT(expected.norm(), 1e-4);
    const Vector12d byPoints = sensitivity.referencePoints.at(2).rightCols<6>() * dV;
    EXPECT_THAT(
        change(solved.estimate, solve(pointsAlone).estimate), test::IsMatrixNear(byPoints, 1e-6));
    EXPECT_GT((expected - byPoints).norm(), 1e-5);
}

TEST(Sensitivity, toWherePointsAndPlanesAre)
{
    const PoseProblem problem = makeProblem(81);
    const Solved solved = solve(problem);
    const Eigen::Isometry3d& T_prev_cur = solved.estimate.motion.mean.T_prev_cur;
    for (int axis = 0; axis < 6; ++axis)
    {
        const Vector6d xi = 1e-3 * Vector6d::Unit(axis);
        const Eigen::Isometry3d moved = T_prev_cur.inverse() * se3Exp(xi) * T_prev_cur;
        PoseProblem points = problem, planes = problem;
        for (PointPair& pair : points.points)
        {
            pair.cur.mean = moved * pair.cur.mean;
        }
        for (PlanePair& pair : planes.planes)
        {
            pair.cur.theta_m = transformed(moved, pair.cur).theta_m;
        }
        const Sensitivity& of = solved.analysis.sensitivity;
        EXPECT_THAT(
            change(solved.estimate, solve(points).estimate),
            test::IsMatrixNear(Vector12d(of.pointsMoved * xi), 4e-5));
        EXPECT_THAT(
            change(solved.estimate, solve(planes).estimate),
            test::IsMatrixNear(Vector12d(of.planesMoved * xi), 4e-5));
        EXPECT_GT((of.pointsMoved * xi).norm() + (of.planesMoved * xi).norm(), 2e-4);
    }
}

TEST(Sensitivity, toThePrior)
{
    const PoseProblem problem = makeProblem(82);
    const Solved solved = solve(problem);
    for (int axis = 0; axis < 12; ++axis)
    {
        PoseProblem moved = problem;
        const Vector12d x = 1e-3 * Vector12d::Unit(axis);
        Motion& mean = moved.prior.mean;
        mean.T_prev_cur = se3Exp(x.head<6>()) * mean.T_prev_cur;
        mean.velocity += x.tail<6>();
        const Vector12d expected = solved.analysis.sensitivity.prior * x;
        EXPECT_THAT(
            change(solved.estimate, solve(moved).estimate), test::IsMatrixNear(expected, 4e-5))
            << axis;
    }
}

TEST(Sensitivity, toErrorsOfTheCamera)
{
    PoseProblem problem = makeProblem(85);
    test::GaussianSampler sampler(86);
    const auto by = [&](double scale) {
        return ByCamera(
            scale * sampler.vector<3>() * sampler.vector<kNumCameraErrors>().transpose());
    };
    for (size_t i = 0; i < problem.points.size(); i += 3)
    {
        problem.points[i].dRef_dCamera = by(0.1);
        problem.points[i].dCur_dCamera = by(0.1);
    }
    problem.planes[1].dRef_dCamera = by(0.02);
    problem.planes[2].dCur_dCamera = by(0.02);
    problem.planes[3].dRef_dCamera = by(0.02);
    problem.planes[3].dCur_dCamera = by(0.02);
    const Solved solved = solve(problem);
    for (int k = 0; k < kNumCameraErrors; ++k)
    {
        const CameraVector camera = 0.01 * CameraVector::Unit(k);
        PoseProblem displaced = problem;
        for (PointPair& pair : displaced.points)
        {
            pair.ref.mean += pair.dRef_dCamera * camera;
            pair.cur.mean += pair.dCur_dCamera * camera;
        }
        for (PlanePair& pair : displaced.planes)
        {
            pair.ref.theta_m += pair.dRef_dCamera * camera;
            pair.cur.theta_m += pair.dCur_dCamera * camera;
        }
        const Vector12d expected = solved.analysis.sensitivity.camera * camera;
        EXPECT_THAT(
            change(solved.estimate, solve(displaced).estimate), test::IsMatrixNear(expected, 2e-5))
            << k;
        EXPECT_GT(expected.head<6>().norm(), 1e-4);
    }
}

TEST(Sensitivity, toTheScaleOfDepthInPatches)
{
    const PoseProblem problem = makeBentProblem(87);
    const Solved solved = solve(problem);
    const Sensitivity& of = solved.analysis.sensitivity;
    for (const int patch : {0, 2, 4})
    {
        const PatchVector scale = 0.001 * PatchVector::Unit(patch);
        PoseProblem bent = problem;
        bend(bent, scale);
        EXPECT_THAT(
            change(solved.estimate, solve(bent).estimate),
            test::IsMatrixNear(Vector12d(of.patches * scale), 1e-5))
            << patch;
        bent = problem;
        bend(bent, PatchVector::Zero(), 2, scale);
        EXPECT_THAT(
            change(solved.estimate, solve(bent).estimate),
            test::IsMatrixNear(Vector12d(of.referencePatches.at(2) * scale), 1e-5))
            << patch;
    }
    EXPECT_GT((of.patches * 0.001 * PatchVector::Unit(2)).norm(), 1e-4);
    EXPECT_TRUE(of.patches.rightCols<11>().isZero(0)) << "patches without points";
}

/** All patches of all images scaled alike: an error of the camera. */
TEST(Sensitivity, toAllPatchesIsThatToTheScaleOfDepth)
{
    const Sensitivity of = solve(makeBentProblem(88)).analysis.sensitivity;
    Vector12d sum = of.patches * PatchVector::Ones();
    for (const auto& [reference, change] : of.referencePatches)
    {
        sum += change * PatchVector::Ones();
    }
    EXPECT_THAT(sum, test::IsMatrixNear(Vector12d(of.camera.col(kDepthScale)), 1e-9));
    EXPECT_GT(sum.norm(), 1e-3);
}

/** Points of a patch err together, and do not average. */
TEST(Sensitivity, errorsOfPatchesAreAsLargeAsTold)
{
    constexpr int kRuns = 1000;
    constexpr double kBend = 0.002;
    const PoseProblem problem = makeBentProblem(89);
    const Solved solved = solve(problem);
    test::GaussianSampler sampler(90);
    std::vector<Vector6d> errors;
    for (int run = 0; run < kRuns; ++run)
    {
        PoseProblem bent = problem;
        bend(bent, kBend * sampler.vector<kNumPatches>());
        errors.push_back(change(solved.estimate, solve(bent).estimate).head<6>());
    }
    const Matrix12d told = kBend * kBend * solved.analysis.sensitivity.patches *
                           solved.analysis.sensitivity.patches.transpose();
    // Five patches with points span five directions; the sixth is made definite alike.
    const Matrix6d floor = 1e-3 * told.topLeftCorner<6, 6>().trace() / 6 * Matrix6d::Identity();
    EXPECT_LT(
        test::whitenedDifference(
            Matrix6d(test::sampleCovariance(errors) + floor),
            Matrix6d(told.topLeftCorner<6, 6>() + floor)),
        0.3);
}

/** Features that err by the camera alone: where motion and camera are told apart, the residuals say
 * by how much. */
TEST(Sensitivity, theCameraIsToldByTheResiduals)
{
    PoseProblem problem = makeProblem(87);
    test::GaussianSampler sampler(88);
    const CameraVector errors = 0.01 * sampler.vector<kNumCameraErrors>();
    for (PointPair& pair : problem.points)
    {
        pair.dRef_dCamera = randomByCamera(sampler);
        pair.dCur_dCamera = randomByCamera(sampler);
        pair.ref.mean += pair.dRef_dCamera * errors;
        pair.cur.mean += pair.dCur_dCamera * errors;
    }
    const CameraInformation camera = solve(problem).analysis.camera;
    EXPECT_THAT(
        camera.information, test::IsMatrixNear(CameraMatrix(camera.information.transpose()), 1e-6));
    // What is added to the features' errors to explain them is the opposite of these.
    const CameraVector found = camera.information.ldlt().solve(camera.gradient);
    EXPECT_THAT(found, test::IsMatrixNear(errors, 3e-4));
    EXPECT_GT(errors.norm(), 0.01);
}

/** A wrong velocity of a reference looks like an error of the camera. */
TEST(Sensitivity, whatIsToldOfTheCameraChangesWithTheVelocityOfTheReferences)
{
    PoseProblem problem = makeProblem(93);
    test::GaussianSampler sampler(94);
    for (PointPair& pair : problem.points)
    {
        pair.dRef_dCamera = randomByCamera(sampler);
        pair.dCur_dCamera = randomByCamera(sampler);
    }
    for (PlanePair& pair : problem.planes)
    {
        pair.dCur_dCamera = randomByCamera(sampler);
    }
    const PoseAnalysis before = solve(problem).analysis;
    ASSERT_EQ(before.cameraByVelocity.size(), 2U);
    const Vector6d dV = 0.01 * Vector6d::LinSpaced(0.5, 1);
    PoseProblem moved = problem;
    for (PointPair& pair : moved.points)
    {
        pair.ref.mean += pair.reference == 2 ? (pair.dRef_dV * dV).eval() : Eigen::Vector3d::Zero();
    }
    for (PlanePair& pair : moved.planes)
    {
        pair.ref.theta_m +=
            pair.reference == 2 ? (pair.dRef_dV * dV).eval() : Eigen::Vector3d::Zero();
    }
    const CameraVector expected = before.cameraByVelocity.at(2) * dV;
    const CameraVector change = solve(moved).analysis.camera.gradient - before.camera.gradient;
    EXPECT_LT((change - expected).norm(), 0.02 * expected.norm());
    EXPECT_GT(expected.norm(), 1);
}

/** Each reference has a pose that errs in its own way. Together they say nothing right of the
 * camera; each with a motion of its own does. */
TEST(Sensitivity, theCameraIsToldByReferencesThatAreWrong)
{
    PoseProblem problem = makeProblem(91);
    test::GaussianSampler sampler(92);
    const CameraVector errors = 0.01 * sampler.vector<kNumCameraErrors>();
    const Eigen::Isometry3d wrong = se3Exp(0.01 * sampler.vector<6>());
    problem.planes.clear();
    for (PointPair& pair : problem.points)
    {
        pair.dCur_dV.setZero();
        pair.dRef_dCamera = randomByCamera(sampler);
        pair.dCur_dCamera = randomByCamera(sampler);
        pair.ref.mean += pair.dRef_dCamera * errors;
        pair.cur.mean += pair.dCur_dCamera * errors;
        if (pair.reference == 2)
        {
            pair.ref.mean = wrong * pair.ref.mean;
        }
    }
    const PoseAnalysis analysis = solve(problem).analysis;
    const auto found = [](const CameraInformation& camera) -> CameraVector
    { return camera.information.ldlt().solve(camera.gradient); };
    EXPECT_THAT(found(analysis.cameraByReference), test::IsMatrixNear(errors, 5e-4));
    EXPECT_GT((found(analysis.camera) - errors).norm(), 0.01);
}

/** All that the estimate depends on moves: so does the estimate. */
TEST(Sensitivity, toAllTogetherIsOne)
{
    const Solved solved = solve(makeProblem(83));
    Matrix6d sum = solved.analysis.sensitivity.prior.topLeftCorner<6, 6>();
    for (const auto& [reference, gain] : solved.analysis.sensitivity.references)
    {
        sum += gain.topLeftCorner<6, 6>();
    }
    EXPECT_THAT(sum, test::IsMatrixNear(Matrix6d(Matrix6d::Identity()), 1e-6));
}

/** Noise of the current frame alone, of which each feature is in one pair or in two. */
TEST(Sensitivity, noiseOfTheCurrentFrame)
{
    constexpr int kRuns = 2000;
    PoseProblem problem = makeProblem(84);
    const size_t numPoints = problem.points.size(), numPlanes = problem.planes.size();
    for (size_t i = 0; i < numPoints; ++i)
    {
        problem.points[i].feature = static_cast<int>(i);
    }
    for (size_t i = 0; i < numPlanes; ++i)
    {
        problem.planes[i].feature = static_cast<int>(i);
    }
    // The first half is seen from both references.
    problem.points.insert(
        problem.points.end(),
        problem.points.begin(),
        problem.points.begin() + static_cast<std::ptrdiff_t>(numPoints / 2));
    problem.planes.push_back(problem.planes.front());
    const Solved solved = solve(problem);

    test::GaussianSampler sampler(85);
    std::vector<Vector6d> errors;
    for (int run = 0; run < kRuns; ++run)
    {
        PoseProblem noisy = problem;
        std::vector<Eigen::Vector3d> noise;
        for (size_t i = 0; i < numPoints; ++i)
        {
            noise.push_back(sampler.sample(problem.points[i].cur.cov));
        }
        for (PointPair& pair : noisy.points)
        {
            pair.cur.mean += noise[static_cast<size_t>(pair.feature)];
        }
        noise.clear();
        for (size_t i = 0; i < numPlanes; ++i)
        {
            noise.push_back(sampler.sample(problem.planes[i].cur.cov_m));
        }
        for (PlanePair& pair : noisy.planes)
        {
            pair.cur.theta_m += noise[static_cast<size_t>(pair.feature)];
        }
        const Solved after = solve(noisy);
        errors.push_back(change(solved.estimate, after.estimate).head<6>());
    }
    const Matrix12d expected =
        solved.analysis.sensitivity.points + solved.analysis.sensitivity.planes;
    // sqrt(42 / 2000) = 0.14 for a right covariance.
    EXPECT_LT(
        test::whitenedDifference(
            test::sampleCovariance(errors), Matrix6d(expected.topLeftCorner<6, 6>())),
        0.25);
}
}  // namespace pointplane
