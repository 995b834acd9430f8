// SPDX-License-Identifier: BSD-3-Clause
#include "uncertainty/camera_errors.h"

#include <Eigen/QR>

#include <cmath>
#include <utility>
#include <vector>

#include "matchers.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
PinholeCamera camera(double fy = 480, double k1 = 0)
{
    PinholeCamera out;
    out.distortion[0] = k1;
    out.fx = 500;
    out.fy = fy;
    out.cx = 310;
    out.cy = 250;
    return out;
}

/** The k-th error as it changes a calibration. */
PinholeCamera changed(PinholeCamera c, int k, double by)
{
    c.cx += k == kPrincipalPointX ? by : 0;
    c.cy += k == kPrincipalPointY ? by : 0;
    c.fx *= k == kFocalLength ? 1 + by : 1;
    c.fy *= k == kFocalLength ? 1 + by : 1;
    c.distortion[0] += k == kRadial ? by : 0;
    return c;
}

/** Of all depths, changed by the k-th error. */
double scale(int k, double by) { return k == kDepthScale ? 1 + by : 1; }

Eigen::Vector3d lifted(const PinholeCamera& c, const Eigen::Vector2d& uv_px, double z)
{
    return z * c.normalised(uv_px).homogeneous();
}

/** Fitted to the inverse depths of some pixels, which do not change with the calibration. */
Eigen::Vector3d fitted(
    const PinholeCamera& c, const PinholeCamera& truth, const Eigen::Vector3d& theta_m)
{
    Eigen::MatrixX3d A(9, 3);
    Eigen::VectorXd q(9);
    for (int i = 0; i < 9; ++i)
    {
        const Eigen::Vector2d uv_px(100 + 200 * (i % 3), 50 + 180 * (i / 3));
        A.row(i) = c.normalised(uv_px).homogeneous();
        q[i] = truth.normalised(uv_px).homogeneous().dot(theta_m);
    }
    return A.colPivHouseholderQr().solve(q);
}

/** Numerical, by central differences. */
template <class F>
ByCamera differences(F&& of)
{
    constexpr double kStep = 1e-4;
    ByCamera out = ByCamera::Zero();
    for (int k = 1; k < kReadoutColour; ++k)
    {
        out.col(k) = (of(k, kStep) - of(k, -kStep)) / (2 * kStep);
    }
    return out;
}
}  // namespace

TEST(cameraErrors, ofAPointByHand)
{
    const ByCamera J = pointByCamera({0.5, -0.25, 2}, camera());
    EXPECT_EQ(J.col(0).norm(), 0);
    EXPECT_NEAR(J(0, 1), -2.0 / 500, 1e-12);  // a centre farther right: the point is farther left
    EXPECT_NEAR(J(1, 2), -2.0 / 480, 1e-12);
    EXPECT_NEAR(J(0, 3), -0.5, 1e-12);
    EXPECT_NEAR(J(1, 3), 0.25, 1e-12);
    // Half a metre to the right and a quarter up, at 2 m: r^2 = 5/64.
    EXPECT_NEAR(J(0, kRadial), -0.5 * 5 / 64, 1e-12);
    EXPECT_NEAR(J(1, kRadial), 0.25 * 5 / 64, 1e-12);
    EXPECT_THAT(J.col(kDepthScale), test::IsMatrixNear(Eigen::Vector3d(0.5, -0.25, 2), 1e-12));
}

TEST(cameraErrors, beforeTheFirstFrame)
{
    CovarianceParams calibration;
    calibration.vignetting = 0.1;
    calibration.principalPoint = 2;
    calibration.focalLength = 0.003;
    calibration.depthScale = 0.005;
    CameraVector variances;
    variances << 0.01, 4, 4, 9e-6, 0, 2.5e-5, 0, 0, 0;
    EXPECT_THAT(calibrationVariances(calibration, camera()), test::IsMatrixNear(variances, 1e-12));
}

TEST(cameraErrors, nominalIntrinsicsAreThoseOfAModelOfCamera)
{
    PinholeCamera nominal = camera();
    nominal.isNominal = true;
    CovarianceParams calibration;
    const auto sigma = [&](int k)
    { return std::sqrt(calibrationVariances(calibration, nominal)[k]); };
    EXPECT_NEAR(sigma(1), 0.02 * 640, 1e-12);
    EXPECT_NEAR(sigma(2), 0.02 * 640, 1e-12);
    EXPECT_NEAR(sigma(3), 0.02, 1e-12);
    calibration.principalPoint = 20;
    calibration.focalLength = 0.1;
    EXPECT_NEAR(sigma(1), 20, 1e-12) << "who says that they are worse is believed";
    EXPECT_NEAR(sigma(3), 0.1, 1e-12);
}

/** A lens is as little known as depth is bent, and much less if nobody calibrated it. */
TEST(cameraErrors, whatIsToBeLearntOfALens)
{
    PinholeCamera c = camera();
    c.fx = c.fy = 500;
    EXPECT_EQ(lensVariances(c, 0), CameraVector::Zero().eval());
    const double squaredRadius = (1.28 * 1.28 + 0.96 * 0.96) / 12;
    const double bent = 0.005 / squaredRadius;
    EXPECT_THAT(
        lensVariances(c, 0.005),
        test::IsMatrixNear(CameraVector(bent * bent * CameraVector::Unit(kRadial)), 1e-12));
    c.isNominal = true;
    const double unknown = 0.02 / squaredRadius;
    CameraVector variances;
    variances << 0, 12.8 * 12.8, 12.8 * 12.8, 4e-4, unknown * unknown, 0, 0, 0, 0;
    EXPECT_THAT(lensVariances(c, 0.005), test::IsMatrixNear(variances, 1e-9));
    EXPECT_NEAR(calibrationVariances({}, c)[kRadial], unknown * unknown, 1e-12);
}

/** To first order in the distortion, too: at a radius r, a lens with k1 moves features by up to
 * 3 k1 r^2 less. */
TEST(cameraErrors, asCalibrationsChange)
{
    const auto expectColumns = [](const ByCamera& columns, const ByCamera& expected, double part)
    {
        for (int k = 0; k < kNumCameraErrors; ++k)
        {
            EXPECT_LE((columns - expected).col(k).norm(), 1e-6 + part * expected.col(k).norm())
                << k;
        }
    };
    // A negative focal length: the image's y axis points up.
    for (const auto& [fy, k1] :
         {std::pair(480.0, 0.0), std::pair(-480.0, 0.0), std::pair(480.0, 0.2)})
    {
        const PinholeCamera c = camera(fy, k1);
        const double part = 3 * k1 * 0.35;  // r^2 in the corners
        const Eigen::Vector2d uv_px(512, 77);
        const ByCamera point = differences(
            [&](int k, double by)
            { return Eigen::Vector3d(scale(k, by) * lifted(changed(c, k, by), uv_px, 1.7)); });
        expectColumns(pointByCamera(lifted(c, uv_px, 1.7), c), point, part);

        const Eigen::Vector3d theta_m(0.2, -0.4, 0.6);
        const ByCamera plane = differences(
            [&](int k, double by)
            {
                by = k == kRadial ? 0 : by;  // it bends planes, which is not modelled
                return Eigen::Vector3d(fitted(changed(c, k, by), c, theta_m) / scale(k, by));
            });
        expectColumns(planeByCamera(theta_m, c), plane, part);
    }
}
}  // namespace pointplane
