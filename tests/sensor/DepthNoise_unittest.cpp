// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/sensor/DepthNoise.h>

#include <stdexcept>

#include "matchers.h"
#include "monte_carlo.h"
#include "numeric_jacobian.h"
#include <gtest/gtest.h>

using namespace pointplane;
using namespace pointplane::test;

namespace
{
PinholeCamera lensCamera()
{
    PinholeCamera camera;
    camera.distortion = {{0.262383, -0.953104, -0.005358, 0.002628, 1.163314}};
    return camera;
}

Eigen::Vector3d backProjected(const PinholeCamera& camera, const Eigen::Vector3d& uvz)
{
    return backProject(camera, DepthNoise{}, uvz.head<2>(), uvz.z()).mean;
}
}  // namespace

TEST(DepthNoise, khoshelhamInMetres)
{
    // sigma_Z = 1.425e-6 Z^2 with both in mm: 2 m -> 5.7 mm.
    EXPECT_NEAR(DepthNoise{}.sigmaZ(2), 0.0057, 1e-12);
    EXPECT_NEAR(DepthNoise{}.sigmaZ(2), 1.425e-6 * 2000 * 2000 / 1000, 1e-12);
}

TEST(DepthNoise, ofOtherKindsByHand)
{
    DepthNoise noise;
    noise.sigmaInverseDepth = 1e-3;
    noise.sigmaDepth = 2e-3;
    noise.sigmaRelative = 3e-3;
    // At 2 m: 4, 2 and 6 mm.
    EXPECT_NEAR(noise.sigmaZ(2), std::sqrt(16 + 4 + 36) * 1e-3, 1e-12);
    EXPECT_NEAR(noise.inverseDepthVariance(0.5), (16 + 4 + 36) * 1e-6 / 16, 1e-15);
    EXPECT_NEAR(noise.relativeShare(0.5), 36.0 / 56, 1e-12);
    EXPECT_NEAR(noise.weight(0.5), 16.0 / 56, 1e-12);
    EXPECT_NEAR(noise.scaled(2).sigmaZ(2), 2 * noise.sigmaZ(2), 1e-12);
    noise.kind = "timeOfFlight";
    EXPECT_EQ(
        describe(noise),
        "timeOfFlight, 2.2 mm at 1 m, 9.2 mm at 3 m; surfaces count as bent by 0.3 % of their "
        "depth");
    noise.learntFrom = 0.2;
    noise.learntTo = 2;
    EXPECT_EQ(
        describe(noise),
        "timeOfFlight, 2.2 mm at 1 m; surfaces count as bent by 0.3 % of their depth");
    noise.learntTo = 0.8;
    EXPECT_EQ(
        describe(noise),
        "timeOfFlight, 2 mm at 0.4 m; surfaces count as bent by 0.3 % of their depth");
    EXPECT_EQ(DepthNoise{}.weight(0.5), 1);
    EXPECT_EQ(describe(DepthNoise{}), "assumed (nothing told it), 1.4 mm at 1 m, 13 mm at 3 m");
}

TEST(DepthNoise, backProjectionByHand)
{
    PinholeCamera camera;
    camera.fx = camera.fy = 500;
    camera.cx = 320;
    camera.cy = 240;
    // On the axis at 2 m: half a pixel is 2 mm, depth sigma 5.7 mm, nothing correlated.
    const PointGaussian centre = backProject(camera, DepthNoise{}, {320, 240}, 2);
    EXPECT_THAT(centre.mean, IsMatrixNear(Eigen::Vector3d(0, 0, 2), 1e-15));
    EXPECT_THAT(
        centre.cov,
        IsMatrixNear(
            Eigen::Matrix3d(Eigen::Vector3d(4e-6, 4e-6, 5.7e-3 * 5.7e-3).asDiagonal()), 1e-18));
    // At x = 0.5 z, half of the depth error goes into X.
    const PointGaussian side = backProject(camera, DepthNoise{}, {570, 240}, 2);
    EXPECT_THAT(side.mean, IsMatrixNear(Eigen::Vector3d(1, 0, 2), 1e-15));
    EXPECT_NEAR(side.cov(0, 2), 0.5 * 5.7e-3 * 5.7e-3, 1e-18);
    EXPECT_NEAR(side.cov(0, 0), 4e-6 + 0.25 * 5.7e-3 * 5.7e-3, 1e-18);
}

TEST(DepthNoise, covarianceIsTheNumericJacobians)
{
    const DepthNoise noise;
    PinholeCamera upward;
    upward.fy = -480;
    for (const PinholeCamera& camera : {PinholeCamera{}, lensCamera(), upward})
    {
        for (const Eigen::Vector3d& uvz :
             {Eigen::Vector3d(5, 9, 1.2),
              Eigen::Vector3d(333, 250, 4),
              Eigen::Vector3d(630, 470, 2)})
        {
            const Eigen::Matrix3d J = numericJacobian(
                [&](const Eigen::Vector3d& x) { return backProjected(camera, x); }, uvz, 1e-4);
            const double sigmaZ = noise.sigmaZ(uvz.z());
            const Eigen::Matrix3d S = Eigen::Vector3d(0.25, 0.25, sigmaZ * sigmaZ).asDiagonal();
            const Eigen::Matrix3d cov = backProject(camera, noise, uvz.head<2>(), uvz.z()).cov;
            EXPECT_LT(whitenedDifference(cov, propagate(J, S)), 1e-6) << uvz.transpose();
        }
    }
}

TEST(DepthNoise, covarianceMatchesMonteCarlo)
{
    GaussianSampler random(41);
    const DepthNoise noise;
    const PinholeCamera camera = lensCamera();
    const Eigen::Vector3d uvz(590, 60, 3);
    const PointGaussian point = backProject(camera, noise, uvz.head<2>(), uvz.z());
    const Eigen::Vector3d sigma(0.5, 0.5, noise.sigmaZ(uvz.z()));
    std::vector<Eigen::Vector3d> errors;
    for (int i = 0; i < 20000; ++i)
    {
        errors.push_back(
            backProjected(camera, uvz + sigma.cwiseProduct(random.vector<3>())) - point.mean);
    }
    EXPECT_LT(whitenedDifference(sampleCovariance(errors), point.cov), 0.05);
}

TEST(DepthNoise, covarianceIsPositiveDefiniteEverywhere)
{
    for (const double z : {0.3, 1.0, 5.0, 10.0})
    {
        for (const double u : {0.0, 320.0, 639.0})
        {
            EXPECT_TRUE(isPositiveDefinite(
                backProject(lensCamera(), DepthNoise{}, {u, 479 - 0.7 * u}, z).cov));
        }
    }
}

TEST(DepthNoise, checkNamesTheKey)
{
    DepthNoise noise;
    EXPECT_NO_THROW(noise.check());
    noise.sigmaInverseDepth = -1;
    try
    {
        noise.check();
        FAIL() << "a negative sigma was accepted";
    }
    catch (const std::invalid_argument& e)
    {
        EXPECT_THAT(e.what(), testing::HasSubstr("sigmaInverseDepth = -1"));
    }
    noise = {};
    noise.sigmaPixelPx = 0;
    EXPECT_THROW(noise.check(), std::invalid_argument);
}
