// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/Plane.h>
#include <pointplane/core/covariance.h>
#include <pointplane/core/se3.h>

#include <cmath>
#include <stdexcept>

#include "matchers.h"
#include "monte_carlo.h"
#include "numeric_jacobian.h"
#include <gtest/gtest.h>

using namespace pointplane;
using namespace pointplane::test;

namespace
{
using Vector4d = Eigen::Vector4d;

Vector4d asVector(const Plane& plane) { return (Vector4d() << plane.n, plane.d).finished(); }

Plane randomPlane(GaussianSampler& random)
{
    return {random.vector<3>().normalized(), random.uniform(0.5, 4)};
}
}  // namespace

TEST(Plane, wallTwoMetresAheadByHand)
{
    const Plane wall{{0, 0, -1}, 2};  // z = 2
    EXPECT_THAT(minimalForm(wall), IsMatrixNear(Eigen::Vector3d(0, 0, -0.5), 0.0));
    const Plane back = hessianForm({0, 0, -0.5});
    EXPECT_THAT(back.n, IsMatrixNear(wall.n, 0.0));
    EXPECT_EQ(back.d, 2);
}

TEST(Plane, minimalFormGivesInverseDepth)
{
    GaussianSampler random(21);
    const Plane plane{Eigen::Vector3d(0.2, 0.3, -1).normalized(), 1.5};
    const Eigen::Vector3d ray(0.1, -0.2, 1);
    const double z = -plane.d / plane.n.dot(ray);
    EXPECT_NEAR(-minimalForm(plane).dot(ray), 1 / z, 1e-15);
}

TEST(Plane, formsRoundTrip)
{
    GaussianSampler random(22);
    for (int i = 0; i < 100; ++i)
    {
        const Plane plane = randomPlane(random);
        EXPECT_THAT(
            asVector(hessianForm(minimalForm(plane))), IsMatrixNear(asVector(plane), 1e-14));
    }
}

TEST(Plane, transformKeepsPointsOnThePlane)
{
    GaussianSampler random(23);
    for (int i = 0; i < 100; ++i)
    {
        const Plane plane_b = randomPlane(random);
        const Eigen::Isometry3d T_a_b = se3Exp(random.vector<6>());
        const Plane plane_a = transformed(T_a_b, plane_b);
        const Eigen::Vector3d any = random.vector<3>();
        const Eigen::Vector3d p_b = any - (plane_b.n.dot(any) + plane_b.d) * plane_b.n;
        EXPECT_NEAR(plane_a.n.dot(T_a_b * p_b) + plane_a.d, 0, 1e-13);
        EXPECT_NEAR(plane_a.n.norm(), 1, 1e-14);
        // The sign is carried along: what was in front stays in front.
        EXPECT_NEAR(plane_a.n.dot(T_a_b * any) + plane_a.d, plane_b.n.dot(any) + plane_b.d, 1e-13);
    }
}

TEST(Plane, hessianJacobianMatchesFiniteDifferences)
{
    GaussianSampler random(24);
    for (int i = 0; i < 20; ++i)
    {
        const Eigen::Vector3d theta = minimalForm(randomPlane(random));
        const auto J = numericJacobian(
            [](const Eigen::Vector3d& m) { return asVector(hessianForm(m)); }, theta, 1e-6);
        EXPECT_THAT(jacobianHessianForm(theta), IsMatrixNear(J, 1e-7 * (1 + J.norm())));
    }
}

TEST(Plane, hessianCovarianceMatchesMonteCarlo)
{
    GaussianSampler random(25);
    const PlaneGaussian plane{
        minimalForm({Eigen::Vector3d(0.3, -0.5, -0.8).normalized(), 1.7}),
        random.covariance<3>(1e-6, 4e-5)};
    const Vector4d mean = asVector(hessianForm(plane.theta_m));
    std::vector<Vector4d> errors;
    for (int i = 0; i < 20000; ++i)
    {
        errors.push_back(asVector(hessianForm(plane.theta_m + random.sample(plane.cov_m))) - mean);
    }
    const Eigen::Matrix4d cov = hessianCovariance(plane);
    EXPECT_LT((sampleCovariance(errors) - cov).norm() / cov.norm(), 0.03);
    // Rank 3: |n| = 1 leaves no uncertainty along n.
    EXPECT_NEAR((cov * (Vector4d() << mean.head<3>(), 0).finished()).norm(), 0, 1e-18);
    EXPECT_TRUE(isPositiveDefinite(plane.cov_m));
}

TEST(Plane, impossibleFormsAreRefused)
{
    EXPECT_THROW((void)minimalForm({{0, 0, 1}, 0}), std::invalid_argument);
    EXPECT_THROW((void)hessianForm(Eigen::Vector3d::Zero()), std::invalid_argument);
    EXPECT_THROW((void)hessianForm(Eigen::Vector3d::Constant(std::nan(""))), std::invalid_argument);
}
