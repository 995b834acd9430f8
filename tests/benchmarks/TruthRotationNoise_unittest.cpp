// SPDX-License-Identifier: BSD-3-Clause
#include "TruthRotationNoise.h"

#include <pointplane/core/se3.h>
#include <pointplane/simulation/SimulatedSequence.h>

#include <cmath>

#include "matchers.h"
#include "monte_carlo.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

using namespace pointplane;

namespace
{
constexpr double kRadiansPerDegree = M_PI / 180;

/** Points around the optical axis, rotated by omega, and by growth from the top row to the bottom
 * row, and seen with noise. */
std::vector<Sighting> sightingsOf(
    const Eigen::Vector3d& omega,
    double noise,
    int n,
    const Eigen::Vector3d& growth = Eigen::Vector3d::Zero())
{
    test::GaussianSampler random(4);
    std::vector<Sighting> out;
    for (int k = 0; k < n; ++k)
    {
        const Eigen::Vector3d p(std::sin(3.0 * k), std::cos(5.0 * k), 2.5 + std::sin(7.0 * k));
        const double row = p.y() / (2 * p.z());
        const Eigen::Vector2d exact = (so3Exp(omega + row * growth) * p).hnormalized();
        out.push_back({p, exact + noise * random.vector<2>(), row});
    }
    return out;
}

/** The first second of a scene under truth with noise of the given sigmas [rad].
 * \param drawn if given: rms of the motions' errors that were drawn, over sqrt(2) */
RotationNoise measure(
    const SimulationParams& params, const Eigen::Vector3d& sigma, Eigen::Vector3d* drawn = nullptr)
{
    const SimulatedSequence sequence("desk", params, 3);
    test::GaussianSampler random(5);
    TruthRotationNoise noise;
    RgbdFrame from = sequence.frame(0);
    Eigen::Vector3d error = sigma.cwiseProduct(random.vector<3>());
    Eigen::Vector3d squares = Eigen::Vector3d::Zero();
    const int n = sequence.numFrames();
    for (int k = 1; k < n; ++k)
    {
        const RgbdFrame to = sequence.frame(k);
        const Eigen::Vector3d next = sigma.cwiseProduct(random.vector<3>());
        Eigen::Isometry3d T = sequence.trueMotion(k, k - 1);
        T.linear() = so3Exp(-next) * T.linear() * so3Exp(error);
        EXPECT_TRUE(noise.add(from, to, T));
        squares += (next - error).cwiseAbs2() / (2 * (n - 1));
        error = next;
        from = to;
    }
    if (drawn != nullptr)
    {
        *drawn = squares.cwiseSqrt();
    }
    return noise.result();
}

SimulationParams oneSecond(SimulationParams params)
{
    params.duration = 1;
    params.width = 320;
    params.height = 240;
    return params;
}
}  // namespace

TEST(RotationFit, findsTheRotationAmongOutliers)
{
    const Eigen::Vector3d omega(0.004, -0.002, 0.006);
    std::vector<Sighting> sightings = sightingsOf(omega, 2e-4, 200);
    for (std::size_t k = 0; k < sightings.size(); k += 4)
    {
        sightings[k].seen += Eigen::Vector2d(0.02, -0.01);
    }
    const auto found = fitRotation(sightings);
    ASSERT_TRUE(found);
    EXPECT_THAT(*found, test::IsMatrixNear(omega, 1e-4));
    const auto exact = fitRotation(sightingsOf(omega, 0, 20));
    ASSERT_TRUE(exact);
    EXPECT_THAT(*exact, test::IsMatrixNear(omega, 1e-9));
}

TEST(RotationFit, aShearedImageIsNotTakenForARotation)
{
    const Eigen::Vector3d omega(0.004, -0.002, 0.006), growth(0.003, -0.008, 0.002);
    const auto found = fitRotation(sightingsOf(omega, 0, 100, growth));
    ASSERT_TRUE(found);
    EXPECT_THAT(*found, test::IsMatrixNear(omega, 1e-9));
}

TEST(RotationFit, saysWhenItCannotTell)
{
    EXPECT_FALSE(fitRotation(sightingsOf({0, 0, 0}, 1e-4, 9)));
    // One ray does not tell the rotation about itself.
    EXPECT_FALSE(fitRotation(std::vector<Sighting>(50)));
}

TEST(TruthRotationNoise, exactTruthHasNone)
{
    const RotationNoise ideal =
        measure(oneSecond(SimulationParams::ideal()), Eigen::Vector3d::Zero());
    EXPECT_EQ(ideal.numPairs, 30U);
    EXPECT_LT(ideal.sigma.maxCoeff(), 0.002 * kRadiansPerDegree);
    const RotationNoise kinect = measure(oneSecond({}), Eigen::Vector3d::Zero());
    EXPECT_LT(kinect.sigma.maxCoeff(), 0.008 * kRadiansPerDegree);
    EXPECT_LT(kinect.sigmaOfTracks.maxCoeff(), 0.005 * kRadiansPerDegree);
    EXPECT_GT(kinect.sigmaOfTracks.minCoeff(), 0);
}

TEST(TruthRotationNoise, noiseIsFoundAboutEachAxis)
{
    const Eigen::Vector3d sigma = Eigen::Vector3d(0.14, 0.06, 0.03) * kRadiansPerDegree;
    Eigen::Vector3d drawn;
    const RotationNoise ideal = measure(oneSecond(SimulationParams::ideal()), sigma, &drawn);
    EXPECT_THAT(ideal.sigma, test::IsMatrixNear(drawn, 0.002 * kRadiansPerDegree));
    const RotationNoise kinect = measure(oneSecond({}), sigma, &drawn);
    EXPECT_THAT(kinect.sigma, test::IsMatrixNear(drawn, 0.01 * kRadiansPerDegree));
}

TEST(TruthRotationNoise, imagesWithoutCornersTellNothing)
{
    RgbdFrame blank;
    blank.gray = cv::Mat(480, 640, CV_8UC1, cv::Scalar(128));
    blank.depth = cv::Mat(480, 640, CV_32FC1, cv::Scalar(2));
    TruthRotationNoise noise;
    EXPECT_FALSE(noise.add(blank, blank, Eigen::Isometry3d::Identity()));
    EXPECT_EQ(noise.result().numPairs, 0U);
    EXPECT_EQ(noise.result().sigma, Eigen::Vector3d::Zero());
}
