// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/odometry/uncertainty/CalibrationCheck.h>

#include <Eigen/Cholesky>

#include <cmath>

#include "matchers.h"
#include "monte_carlo.h"
#include "uncertainty/camera_errors.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
constexpr int kNumLensErrors = 4;
using LensVector = Eigen::Matrix<double, kNumLensErrors, 1>;

PinholeCamera vga()
{
    PinholeCamera out;
    out.width = 640;
    out.height = 480;
    out.fx = out.fy = 525;
    out.cx = 319.5;
    out.cy = 239.5;
    return out;
}

PinholeCamera nominalVga()
{
    PinholeCamera out = vga();
    out.isNominal = true;
    return out;
}

CameraVector calibrated() { return calibrationVariances({}, vga()); }

CalibrationCheck checkOfVga()
{
    CalibrationCheck out;
    out.start(vga(), calibrated());
    return out;
}

/** Standard deviations of the lens's errors, if its intrinsics are nominal. */
LensVector nominalSigmas()
{
    return lensVariances(nominalVga(), 0).segment<kNumLensErrors>(kPrincipalPointX).cwiseSqrt();
}

CameraVector ofLens(const LensVector& errors)
{
    CameraVector out = CameraVector::Zero();
    out.segment<kNumLensErrors>(kPrincipalPointX) = errors;
    return out;
}

/** What frames tell of a lens that is off by `error`, when features are corrected by `corrected`.
 * \param share of a nominal standard deviation, to which each error is told */
CameraInformation frameOf(
    const CameraVector& error,
    const CameraVector& corrected,
    test::GaussianSampler& sampler,
    double share)
{
    using LensMatrix = Eigen::Matrix<double, kNumLensErrors, kNumLensErrors>;
    const LensMatrix mix = sampler.covariance<kNumLensErrors>(0.5, 2);
    const LensMatrix J = mix * LensVector(share * nominalSigmas()).cwiseInverse().asDiagonal();
    const LensVector left =
        CameraVector(error - corrected).segment<kNumLensErrors>(kPrincipalPointX);
    const LensVector residual = -J * left + sampler.vector<kNumLensErrors>();
    CameraInformation out;
    out.information.block<kNumLensErrors, kNumLensErrors>(kPrincipalPointX, kPrincipalPointX) =
        J.transpose() * J;
    out.gradient.segment<kNumLensErrors>(kPrincipalPointX) = J.transpose() * residual;
    return out;
}

const CameraVector kNothing = CameraVector::Zero();
}  // namespace

TEST(CalibrationCheck, withoutFramesNothingIsContradicted)
{
    const CalibrationCheck check = checkOfVga();
    EXPECT_FALSE(check.isContradicted(kNothing));
    EXPECT_TRUE(check.errors().isZero(0));
    const CameraMatrix nominal = lensVariances(nominalVga(), 0).asDiagonal();
    EXPECT_THAT(check.cov(), test::IsMatrixNear(nominal, 1e-12));
}

TEST(CalibrationCheck, aCalibrationAsGoodAsStatedIsNotContradicted)
{
    test::GaussianSampler sampler(41);
    for (int draw = 0; draw < 300; ++draw)
    {
        const CameraMatrix cov = calibrated().asDiagonal();
        CameraVector error = sampler.sample(cov);
        error[kVignetting] = error[kDepthScale] = 0;
        CalibrationCheck check = checkOfVga();
        for (int frame = 0; frame < 20; ++frame)
        {
            check.add(frameOf(error, kNothing, sampler, 0.5), kNothing);
            ASSERT_FALSE(check.isContradicted(kNothing)) << draw;
        }
    }
}

TEST(CalibrationCheck, eachErrorOfTheLensIsFound)
{
    test::GaussianSampler sampler(42);
    for (int k = 0; k < kNumLensErrors; ++k)
    {
        const CameraVector error = ofLens(nominalSigmas()[k] * LensVector::Unit(k));
        CalibrationCheck check = checkOfVga();
        for (int frame = 0; frame < 100; ++frame)
        {
            check.add(frameOf(error, kNothing, sampler, 0.5), kNothing);
        }
        EXPECT_TRUE(check.isContradicted(kNothing)) << k;
        check.start(vga(), calibrated());
        EXPECT_FALSE(check.isContradicted(kNothing));
    }
}

/** Errors of nominal intrinsics, and what the check makes of them. */
TEST(CalibrationCheck, itsEstimateIsAsGoodAsItSays)
{
    test::GaussianSampler sampler(43);
    constexpr int kDraws = 400;
    double nees = 0;
    for (int draw = 0; draw < kDraws; ++draw)
    {
        const LensVector sigmas = nominalSigmas();
        const CameraVector error = ofLens(sigmas.cwiseProduct(sampler.vector<kNumLensErrors>()));
        CalibrationCheck check = checkOfVga();
        for (int frame = 0; frame < 3; ++frame)
        {
            check.add(frameOf(error, kNothing, sampler, 1), kNothing);
        }
        const LensVector e =
            CameraVector(check.errors() - error).segment<kNumLensErrors>(kPrincipalPointX);
        const Eigen::Matrix4d cov = check.cov().block<4, 4>(kPrincipalPointX, kPrincipalPointX);
        nees += e.dot(cov.ldlt().solve(e)) / kNumLensErrors;
    }
    EXPECT_NEAR(nees / kDraws, 1, 3 * std::sqrt(2.0 / (kNumLensErrors * kDraws)));
}

/** Radial distortion is learnt while the calibration is trusted, if depth is bent. */
TEST(CalibrationCheck, itCountsFromTheStatedLens)
{
    const CameraVector error = ofLens(nominalSigmas());
    CalibrationCheck stated = checkOfVga(), corrected = checkOfVga();
    for (int frame = 0; frame < 5; ++frame)
    {
        test::GaussianSampler same(44 + static_cast<unsigned>(frame)), again = same;
        const CameraVector by = 0.1 * frame * error;
        stated.add(frameOf(error, kNothing, same, 1), kNothing);
        corrected.add(frameOf(error, by, again, 1), by);
    }
    EXPECT_THAT(corrected.errors(), test::IsMatrixNear(stated.errors(), 1e-9));
}

TEST(CalibrationCheck, bentDepthExcusesRadialDistortion)
{
    test::GaussianSampler sampler(45);
    const CameraVector error = ofLens(nominalSigmas().cwiseProduct(LensVector::Unit(3)));
    CalibrationCheck check = checkOfVga();
    for (int frame = 0; frame < 100; ++frame)
    {
        check.add(frameOf(error, kNothing, sampler, 0.5), kNothing);
    }
    EXPECT_TRUE(check.isContradicted(kNothing));
    EXPECT_FALSE(check.isContradicted(lensVariances(vga(), PinholeCamera::kNominal)));
}
}  // namespace pointplane
