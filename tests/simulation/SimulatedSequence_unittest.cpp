// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/se3.h>
#include <pointplane/simulation/SimulatedSequence.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <cmath>
#include <cstring>

#include "matchers.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
bool sameBytes(const cv::Mat& a, const cv::Mat& b)
{
    return a.size() == b.size() && a.type() == b.type() &&
           std::memcmp(a.data, b.data, a.total() * a.elemSize()) == 0;
}

Eigen::Vector3d backProjected(const RgbdFrame& frame, int u, int v)
{
    const Eigen::Vector2d xy = frame.camera.normalised(Eigen::Vector2d(u, v));
    return static_cast<double>(frame.depth.at<float>(v, u)) * Eigen::Vector3d(xy.x(), xy.y(), 1);
}

/** Inverse depth between four pixels of one plane, where it is bilinear; NaN elsewhere. */
double interpolatedInverseDepth(const RgbdFrame& frame, const cv::Mat& labels, double u, double v)
{
    const int x = static_cast<int>(std::floor(u)), y = static_cast<int>(std::floor(v));
    if (x < 0 || y < 0 || x + 1 >= labels.cols || y + 1 >= labels.rows)
    {
        return NAN;
    }
    const uchar label = labels.at<uchar>(y, x);
    double sum = 0;
    for (int k = 0; k < 4; ++k)
    {
        const int dx = k % 2, dy = k / 2;
        if (label == 0 || labels.at<uchar>(y + dy, x + dx) != label)
        {
            return NAN;
        }
        const double weight = (dx ? u - x : 1 - u + x) * (dy ? v - y : 1 - v + y);
        sum += weight / static_cast<double>(frame.depth.at<float>(y + dy, x + dx));
    }
    return sum;
}
}  // namespace

TEST(SimulatedSequence, sameSeedGivesTheSameBytesInAnyOrder)
{
    SimulationParams params;
    params.width = 320;
    params.height = 240;
    const SimulatedSequence a("desk", params, 11), b("desk", params, 11), c(a.scene(), params, 12);
    cv::Mat colourA, colourB;
    (void)b.frame(300);
    const RgbdFrame second = b.frame(7, &colourB), first = a.frame(7, &colourA);
    EXPECT_TRUE(sameBytes(first.depth, second.depth));
    EXPECT_TRUE(sameBytes(first.gray, second.gray));
    EXPECT_TRUE(sameBytes(colourA, colourB));
    EXPECT_FALSE(sameBytes(first.gray, c.frame(7).gray));
}

/** The recording states the calibration that it was told; the pictures are those of the true
 * camera. */
TEST(SimulatedSequence, aWrongCalibrationIsNotStated)
{
    SimulationParams wrong = SimulationParams::ideal();
    wrong.width = 320;
    wrong.height = 240;
    wrong.focalLengthError = 0.05;
    wrong.depthScaleError = 0.05;
    const std::uint64_t seed = 3;
    SimulationParams right = SimulationParams::ideal();
    right.width = 320;
    right.height = 240;
    right.focalLengthPx = 2 * wrong.trueCamera(seed).fx;
    const SimulatedSequence a("desk", wrong, seed), b(a.scene(), right, seed);
    const RgbdFrame seen = a.frame(0), asIfRight = b.frame(0);
    EXPECT_DOUBLE_EQ(seen.camera.fx, 525 / 2.0);
    EXPECT_GT(std::abs(asIfRight.camera.fx - seen.camera.fx), 1);
    EXPECT_TRUE(sameBytes(seen.gray, asIfRight.gray));
    const double scale = wrong.depthScale(seed);
    EXPECT_GT(std::abs(scale - 1), 1e-3);
    EXPECT_LT(cv::norm(seen.depth, scale * asIfRight.depth, cv::NORM_INF), 1e-5);
}

TEST(SimulationParams, calibrationsOfManySeedsErrAsTold)
{
    SimulationParams params;
    params.width = 1280;
    params.focalLengthError = 0.01;
    params.principalPointError = 2;
    params.depthScaleError = 0.005;
    const PinholeCamera stated = params.camera();
    const int numSeeds = 2000;
    double focal = 0, x = 0, y = 0, xy = 0, scale = 0;
    for (int seed = 0; seed < numSeeds; ++seed)
    {
        const PinholeCamera camera = params.trueCamera(static_cast<std::uint64_t>(seed));
        EXPECT_EQ(camera.fx, camera.fy);
        focal += std::pow(camera.fx / stated.fx - 1, 2) / numSeeds;
        x += std::pow(camera.cx - stated.cx, 2) / numSeeds;
        y += std::pow(camera.cy - stated.cy, 2) / numSeeds;
        xy += (camera.cx - stated.cx) * (camera.cy - stated.cy) / numSeeds;
        scale += std::pow(params.depthScale(static_cast<std::uint64_t>(seed)) - 1, 2) / numSeeds;
    }
    // Twice as many pixels as 640 wide: twice as many of them off.
    EXPECT_NEAR(std::sqrt(focal), 0.01, 0.0006);
    EXPECT_NEAR(std::sqrt(x), 4, 0.25);
    EXPECT_NEAR(std::sqrt(y), 4, 0.25);
    EXPECT_LT(std::abs(xy), 1.2);
    EXPECT_NEAR(std::sqrt(scale), 0.005, 0.0003);
}

TEST(SimulatedSequence, noiseOfFramesIsIndependent)
{
    SimulationParams params = SimulationParams::ideal();
    params.motionScale = 0;
    const SimulatedSequence quiet("corner", params, 1);
    params.sigmaInverseDepth = 1.4e-3;
    const SimulatedSequence noisy(quiet.scene(), params, 1);
    const cv::Mat truth = 1.0 / quiet.frame(0).depth;
    const cv::Mat a = 1.0 / noisy.frame(0).depth - truth, b = 1.0 / noisy.frame(1).depth - truth;
    // 640 x 480 pixels are about 3800 independent windows.
    EXPECT_LT(std::abs(a.dot(b)) / std::sqrt(a.dot(a) * b.dot(b)), 0.06);
}

TEST(SimulatedSequence, depthOfOneFrameReprojectsIntoTheOther)
{
    const SimulationParams params = SimulationParams::ideal();
    for (const char* scene : {"corner", "desk", "notexture"})
    {
        const SimulatedSequence sequence(scene, params, 3);
        const int i = 40, j = 52;
        const RgbdFrame a = sequence.frame(i), b = sequence.frame(j);
        const cv::Mat labelsA = sequence.truePlanes(i).labels;
        const cv::Mat labelsB = sequence.truePlanes(j).labels;
        const Eigen::Isometry3d T_b_a = sequence.trueMotion(j, i);
        EXPECT_GT(se3Log(T_b_a).norm(), 0.03);
        int compared = 0;
        double worst = 0;
        for (int v = 0; v < 480; v += 3)
        {
            for (int u = 0; u < 640; u += 3)
            {
                const Eigen::Vector3d p = T_b_a * backProjected(a, u, v);
                const Eigen::Vector2d at = b.camera.project(p);
                const double q = interpolatedInverseDepth(b, labelsB, at.x(), at.y());
                // Occluded points are behind what is seen; others agree.
                if (std::isnan(q) || labelsA.at<uchar>(v, u) == 0 || 1 / q < p.z() - 5e-3)
                {
                    continue;
                }
                worst = std::max(worst, std::abs(1 / q - p.z()));
                ++compared;
            }
        }
        EXPECT_GT(compared, 15000) << scene;
        EXPECT_LT(worst, 1e-4) << scene;
    }
}

TEST(SimulatedSequence, colourOfOneFrameWarpsOntoTheOther)
{
    const SimulatedSequence sequence("corner", SimulationParams::ideal(), 3);
    const RgbdFrame a = sequence.frame(100), b = sequence.frame(106);
    const Eigen::Isometry3d T_b_a = sequence.trueMotion(106, 100);
    cv::Mat mapX(480, 640, CV_32FC1), mapY(480, 640, CV_32FC1);
    for (int v = 0; v < 480; ++v)
    {
        for (int u = 0; u < 640; ++u)
        {
            const Eigen::Vector2d at = b.camera.project(T_b_a * backProjected(a, u, v));
            mapX.at<float>(v, u) = static_cast<float>(at.x());
            mapY.at<float>(v, u) = static_cast<float>(at.y());
        }
    }
    cv::Mat warped;
    cv::remap(b.gray, warped, mapX, mapY, cv::INTER_CUBIC, cv::BORDER_REPLICATE);
    // Remaining shift by one Gauss-Newton step, for the whole picture and for its quarters.
    cv::Mat gx, gy, ga, gw;
    a.gray.convertTo(ga, CV_64F);
    warped.convertTo(gw, CV_64F);
    cv::Sobel(ga, gx, CV_64F, 1, 0, 3, 1.0 / 8);
    cv::Sobel(ga, gy, CV_64F, 0, 1, 3, 1.0 / 8);
    for (const cv::Rect& part :
         {cv::Rect(40, 40, 560, 400), cv::Rect(60, 60, 240, 160), cv::Rect(340, 260, 240, 160)})
    {
        const cv::Mat x = gx(part), y = gy(part), e = gw(part) - ga(part);
        Eigen::Matrix2d A;
        A << x.dot(x), x.dot(y), x.dot(y), y.dot(y);
        const Eigen::Vector2d shift = A.ldlt().solve(Eigen::Vector2d(x.dot(e), y.dot(e)));
        EXPECT_LT(shift.norm(), 0.1) << part;
    }
}

TEST(SimulatedSequence, rowsAreExposedWhenTheShutterModelSays)
{
    SimulationParams params = SimulationParams::ideal();
    params.readoutDepth = 0.8 / 30;
    params.depthDelay = -0.01;
    const SimulatedSequence sequence("corner", params, 5);
    const RgbdFrame frame = sequence.frame(77);
    EXPECT_EQ(frame.shutter.depthDelay, -0.01);
    const TruePlanes truth = sequence.truePlanes(77);
    const Eigen::Isometry3d T_world_cam = sequence.truth(frame.stamp);
    double worst = 0, worstGlobal = 0;
    for (int v = 0; v < 480; v += 16)
    {
        const double stamp =
            frame.stamp + frame.shutter.depthDelay + (v / 480.0 - 0.5) * frame.shutter.readoutDepth;
        const Eigen::Isometry3d T_row_cam = sequence.truth(stamp).inverse() * T_world_cam;
        for (int u = 0; u < 640; u += 16)
        {
            const Plane& plane_cam = truth.planes_cam.at(truth.labels.at<uchar>(v, u) - 1U);
            const Eigen::Vector3d p = backProjected(frame, u, v);
            const Plane plane_row = transformed(T_row_cam, plane_cam);
            worst = std::max(worst, std::abs(plane_row.n.dot(p) + plane_row.d));
            worstGlobal = std::max(worstGlobal, std::abs(plane_cam.n.dot(p) + plane_cam.d));
        }
    }
    EXPECT_LT(worst, 2e-6);
    EXPECT_GT(worstGlobal, 1e-3) << "the shutter has no effect";
}

TEST(SimulatedSequence, truePlanesAreTheSurfacesOfTheDepthImage)
{
    const SimulatedSequence sequence("cabinet", SimulationParams::ideal(), 2);
    const RgbdFrame frame = sequence.frame(30);
    const TruePlanes truth = sequence.truePlanes(30);
    for (const Plane& plane : truth.planes_cam)
    {
        EXPECT_GT(plane.d, 0) << "normals point to the camera";
    }
    for (int v = 0; v < 480; v += 8)
    {
        for (int u = 0; u < 640; u += 8)
        {
            const int label = truth.labels.at<uchar>(v, u);
            ASSERT_GT(label, 0);
            const Plane& plane = truth.planes_cam.at(static_cast<std::size_t>(label) - 1);
            EXPECT_NEAR(plane.n.dot(backProjected(frame, u, v)) + plane.d, 0, 5e-6);
        }
    }
}

TEST(SimulatedSequence, kinectNoiseOnPlanesIsTheSensorsSigmaAndGrowsWithTheSlope)
{
    SimulationParams params;
    params.readoutDepth = params.depthDelay = params.exposure = 0;
    const SimulatedSequence sequence("corner", params, 2);
    double s2 = 0, predicted = 0, n = 0;
    for (int i = 0; i < 60; i += 12)
    {
        const RgbdFrame frame = sequence.frame(i);
        const TruePlanes truth = sequence.truePlanes(i);
        for (int v = 4; v < 480; v += 5)
        {
            for (int u = 4; u < 640; u += 5)
            {
                const double z = static_cast<double>(frame.depth.at<float>(v, u));
                if (std::isnan(z))
                {
                    continue;
                }
                const Plane& plane = truth.planes_cam.at(truth.labels.at<uchar>(v, u) - 1U);
                const Eigen::Vector3d theta_m = minimalForm(plane);
                const double error = 1 / z + theta_m.dot(backProjected(frame, u, v)) / z;
                s2 += error * error;
                // Displacements are rounded to whole pixels.
                const double lateral_px2 = params.lateralSigmaPx * params.lateralSigmaPx + 1.0 / 12;
                predicted +=
                    params.sigmaInverseDepth * params.sigmaInverseDepth +
                    lateral_px2 * theta_m.head<2>().squaredNorm() / std::pow(frame.camera.fx, 2);
                n += 1;
            }
        }
    }
    EXPECT_GT(std::sqrt(s2 / n), 1.4e-3);
    EXPECT_NEAR(std::sqrt(s2 / predicted), 1, 0.04);
}

TEST(SimulatedSequence, motionBlurSmoothsAndSizesScale)
{
    SimulationParams sharp = SimulationParams::ideal(), blurred = sharp;
    blurred.exposure = 0.03;
    const auto detail = [](const cv::Mat& image)
    {
        cv::Mat out;
        cv::Laplacian(image, out, CV_64F);
        return cv::norm(out);
    };
    const SimulatedSequence a("desk", sharp, 4);
    const SimulatedSequence b(a.scene(), blurred, 4);
    EXPECT_LT(detail(b.frame(20).gray), 0.8 * detail(a.frame(20).gray));

    SimulationParams small = sharp;
    small.width = 320;
    small.height = 240;
    const SimulatedSequence c(a.scene(), small, 4);
    const RgbdFrame half = c.frame(20), full = a.frame(20);
    EXPECT_EQ(half.depth.size(), cv::Size(320, 240));
    // The same point of the scene: pixel (u, v) of the half image is (2u + 1/2, 2v + 1/2).
    const double q = interpolatedInverseDepth(full, a.truePlanes(20).labels, 200.5, 300.5);
    EXPECT_NEAR(1 / q, static_cast<double>(half.depth.at<float>(150, 100)), 1e-5);
}

TEST(SimulatedSequence, badParametersAreNamed)
{
    SimulationParams params;
    params.fps = 0;
    try
    {
        const SimulatedSequence sequence("corner", params, 1);
        FAIL() << "fps = 0 was accepted";
    }
    catch (const std::invalid_argument& e)
    {
        EXPECT_THAT(e.what(), testing::HasSubstr("fps"));
    }
    const SimulatedSequence good("corner", SimulationParams::ideal(), 1);
    EXPECT_EQ(good.numFrames(), 541);
    EXPECT_THROW((void)good.frame(541), std::invalid_argument);
    EXPECT_THROW((void)good.frame(-1), std::invalid_argument);
}
}  // namespace pointplane
