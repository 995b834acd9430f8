// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/se3.h>
#include <pointplane/mrpt_io/ObservationConverter.h>
#include <pointplane/mrpt_io/SimplemapWriter.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/external_range.h>
#include <pointplane/mrpt_io/mrpt_poses.h>

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>

#include <opencv2/imgcodecs.hpp>

#include <cmath>
#include <limits>

#include "TempDir.h"
#include "matchers.h"
#include "rawlog_samples.h"
#include "scan_images.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
using mrpt::obs::CObservation3DRangeScan;
using test::IsNearPose;
using test::sampleScan;
using test::TempDir;

[[nodiscard]] std::string problemOf(const CObservation3DRangeScan& scan)
{
    const ConvertedFrame converted = ObservationConverter().convert(scan);
    const double seconds = toSeconds(scan.timestamp);
    EXPECT_TRUE(
        std::isnan(seconds) ? std::isnan(converted.frame.stamp) : converted.frame.stamp == seconds);
    if (!converted.problem.empty())
    {
        EXPECT_TRUE(converted.frame.depth.empty());
    }
    return converted.problem;
}

TEST(ObservationConverter, registeredFrameByHand)
{
    const auto scan = sampleScan(2);
    scan->rangeImage(3, 4) = 0;
    const ConvertedFrame converted = ObservationConverter().convert(*scan);
    ASSERT_EQ(converted.problem, "");
    const RgbdFrame& frame = converted.frame;
    EXPECT_EQ(frame.depth.type(), CV_32FC1);
    EXPECT_EQ(frame.gray.type(), CV_8UC1);
    EXPECT_EQ(frame.depth.size(), cv::Size(32, 24));
    EXPECT_EQ(frame.gray.size(), cv::Size(32, 24));
    EXPECT_FLOAT_EQ(frame.depth.at<float>(5, 7), 0.001F * (1500 + 4 * 7 + 3 * 5 + 2));
    EXPECT_TRUE(std::isnan(frame.depth.at<float>(3, 4)));
    EXPECT_DOUBLE_EQ(frame.camera.fx, 32 * 0.82);
    EXPECT_DOUBLE_EQ(frame.stamp, 1000.0 + 2 / 32.0);
    EXPECT_TRUE(std::isnan(frame.shutter.depthDelay));
    EXPECT_THAT(converted.T_robot_cam, IsNearPose(opticalInBody(), 1e-9, 1e-12));
}

TEST(ObservationConverter, sensorPoseIsHonoured)
{
    const auto scan = sampleScan(0);
    scan->sensorPose = mrpt::poses::CPose3D::FromXYZYawPitchRoll(0.1, 0.2, 0.9, 0.3, 0.2, 0);
    const ConvertedFrame converted = ObservationConverter().convert(*scan);
    EXPECT_THAT(
        converted.T_robot_cam,
        IsNearPose(fromMrpt(scan->sensorPose) * opticalInBody(), 1e-9, 1e-9));
}

TEST(ObservationConverter, rangeUnitsScale)
{
    const auto scan = sampleScan(0);
    scan->rangeUnits = 1.0F / 5000;
    const ConvertedFrame converted = ObservationConverter().convert(*scan);
    EXPECT_FLOAT_EQ(converted.frame.depth.at<float>(0, 0), 1500.0F / 5000);
}

TEST(ObservationConverter, rangesAlongRaysBecomeDepths)
{
    const auto scan = sampleScan(0);
    scan->range_is_depth = false;
    const ConvertedFrame converted = ObservationConverter().convert(*scan);
    const PinholeCamera& camera = converted.frame.camera;
    const double x = (31 - camera.cx) / camera.fx, y = (2 - camera.cy) / camera.fy;
    const double range = 0.001 * (1500 + 4 * 31 + 3 * 2);
    EXPECT_NEAR(converted.frame.depth.at<float>(2, 31), range / std::sqrt(1 + x * x + y * y), 1e-6);
}

TEST(ObservationConverter, monochromeAndDeepImages)
{
    const auto gray = sampleScan(0);
    gray->intensityImage = gray->intensityImage.grayscale();
    EXPECT_EQ(ObservationConverter().convert(*gray).frame.gray.type(), CV_8UC1);
    const auto deep = sampleScan(0);
    cv::Mat pixels(24, 32, CV_16UC1, cv::Scalar(0x4000));
    deep->intensityImage = mrpt::img::CImage(pixels, mrpt::img::DEEP_COPY);
    const ConvertedFrame converted = ObservationConverter().convert(*deep);
    ASSERT_EQ(converted.problem, "");
    EXPECT_EQ(converted.frame.gray.at<std::uint8_t>(3, 3), 0x40);
}

/** Cameras of 10, 12 or 14 bit leave the upper bits empty. */
TEST(ObservationConverter, deepImagesAreAsBrightAsTheirCameraCanBe)
{
    const ObservationConverter converter;
    const auto middleOf = [&](int brightest, const char* label)
    {
        const auto scan = sampleScan(0);
        scan->sensorLabel = label;
        cv::Mat pixels(24, 32, CV_16UC1, cv::Scalar(brightest / 2.0));
        pixels.at<std::uint16_t>(0, 0) = static_cast<std::uint16_t>(brightest);
        scan->intensityImage = mrpt::img::CImage(pixels, mrpt::img::DEEP_COPY);
        return converter.convert(*scan).frame.gray.at<std::uint8_t>(3, 3);
    };
    EXPECT_EQ(middleOf(1023, "ten"), 128);
    EXPECT_EQ(middleOf(4095, "twelve"), 128);
    EXPECT_EQ(middleOf(16383, "fourteen"), 128);
    EXPECT_EQ(middleOf(65535, "sixteen"), 128);
    EXPECT_EQ(middleOf(4095, "sixteen"), 8) << "a dark image is dark";
    EXPECT_EQ(middleOf(1023, "twelve"), 32);
    EXPECT_EQ(middleOf(4095, "ten"), 128) << "it has more bits than were seen";
}

TEST(ObservationConverter, aHotPixelDoesNotDarkenTheImage)
{
    cv::Mat pixels(48, 64, CV_16UC1, cv::Scalar(512));
    pixels.row(0).setTo(1023);
    pixels.at<std::uint16_t>(20, 20) = 65535;
    int bits = kFewestBits;
    const cv::Mat gray = grayOf(pixels, bits);
    EXPECT_EQ(bits, 10);
    EXPECT_EQ(gray.at<std::uint8_t>(3, 3), 128);
    EXPECT_EQ(gray.at<std::uint8_t>(20, 20), 255);
}

TEST(ObservationConverter, saturatedDepthIsNoReading)
{
    const auto scan = sampleScan(0);
    scan->rangeImage(0, 0) = 65535;
    scan->rangeImage(0, 1) = 65534;
    const ConvertedFrame converted = ObservationConverter().convert(*scan);
    EXPECT_TRUE(std::isnan(converted.frame.depth.at<float>(0, 0)));
    EXPECT_FLOAT_EQ(converted.frame.depth.at<float>(0, 1), 65.534F);
}

TEST(ObservationConverter, depthAloneIsEnough)
{
    const auto scan = sampleScan(0);
    scan->hasIntensityImage = false;
    scan->cameraParamsIntensity = mrpt::img::TCamera();
    const ConvertedFrame converted = ObservationConverter().convert(*scan);
    ASSERT_EQ(converted.problem, "");
    EXPECT_TRUE(converted.frame.gray.empty());
    EXPECT_FALSE(converted.frame.depth.empty());
    EXPECT_THAT(converted.T_robot_cam, IsNearPose(opticalInBody(), 1e-9, 0.0));
}

/** Recorders may leave the depth camera of such a scan unset. */
TEST(ObservationConverter, colourAloneIsAFrameWithoutDepth)
{
    const auto scan = sampleScan(3);
    const ConvertedFrame whole = ObservationConverter().convert(*scan);
    scan->hasRangeImage = false;
    scan->cameraParams = {};
    const ConvertedFrame converted = ObservationConverter().convert(*scan);
    ASSERT_EQ(converted.problem, "");
    EXPECT_EQ(converted.frame.depth.size(), converted.frame.gray.size());
    EXPECT_EQ(cv::countNonZero(converted.frame.depth == converted.frame.depth), 0);
    EXPECT_EQ(cv::countNonZero(converted.frame.gray != whole.frame.gray), 0);
    EXPECT_EQ(converted.frame.camera.fx, whole.frame.camera.fx);
    EXPECT_THAT(converted.T_robot_cam.matrix(), test::IsMatrixNear(whole.T_robot_cam.matrix(), 0));
}

TEST(ObservationConverter, distortionAndWhereDepthLies)
{
    const auto scan = sampleScan(0);
    auto& intensity = scan->cameraParamsIntensity;
    intensity.distortion = mrpt::img::DistortionModel::plumb_bob;
    intensity.dist[0] = 0.1;
    intensity.dist[4] = -0.3;
    const PinholeCamera ideal = ObservationConverter().convert(*scan).frame.camera;
    EXPECT_EQ(ideal.distortion, (std::array<double, 5>{{0.1, 0, 0, 0, -0.3}}));
    // Depth at raw pixels, too: it moves to those of an ideal pinhole.
    scan->cameraParams = intensity;
    const ConvertedFrame raw = ObservationConverter().convert(*scan);
    EXPECT_EQ(raw.frame.camera.distortion, ideal.distortion);
    // MRPT: without a model the coefficients mean nothing.
    intensity.distortion = mrpt::img::DistortionModel::none;
    scan->cameraParams = intensity;
    EXPECT_FALSE(ObservationConverter().convert(*scan).frame.camera.isDistorted());
}

/** A slanted wall, as an infrared camera with a distorted image sees it. */
TEST(ObservationConverter, distortedDepthMovesToIdealPixels)
{
    for (const double k1 : {-0.2, 0.1})
    {
        const auto scan = sampleScan(0, 320, 240);
        scan->hasIntensityImage = false;
        auto& camera = scan->cameraParams;
        camera.setIntrinsicParamsFromValues(260, 260, 159.5, 119.5);
        camera.distortion = mrpt::img::DistortionModel::plumb_bob;
        camera.dist.fill(0);
        camera.dist[0] = k1;
        PinholeCamera lens;
        lens.width = 320;
        lens.height = 240;
        lens.fx = lens.fy = 260;
        lens.cx = 159.5;
        lens.cy = 119.5;
        lens.distortion[0] = k1;
        // 1/Z = a + b x: linear in the ideal pixel, bent in the raw one.
        const auto depthAt = [](const Eigen::Vector2d& xy) { return 1 / (0.5 + 0.2 * xy.x()); };
        for (int v = 0; v < 240; ++v)
        {
            for (int u = 0; u < 320; ++u)
            {
                scan->rangeImage(v, u) = static_cast<std::uint16_t>(
                    std::lround(depthAt(lens.normalised({u, v})) / scan->rangeUnits));
            }
        }
        const ConvertedFrame converted = ObservationConverter().convert(*scan);
        ASSERT_EQ(converted.problem, "");
        int numNone = 0;
        double worst = 0;
        for (int v = 20; v < 220; ++v)
        {
            for (int u = 30; u < 290; ++u)
            {
                const float z = converted.frame.depth.at<float>(v, u);
                numNone += z > 0 ? 0 : 1;
                const double truth = depthAt(lens.normalisedOfDepth({u, v}));
                worst = std::max(worst, z > 0 ? std::abs(z / truth - 1) : 0);
            }
        }
        EXPECT_EQ(numNone, 0) << k1;
        EXPECT_LT(worst, 2e-3) << k1;
    }
}

TEST(ObservationConverter, negativeFocalLengthIsLegal)
{
    const auto scan = sampleScan(0);
    for (auto* camera : {&scan->cameraParams, &scan->cameraParamsIntensity})
    {
        camera->setIntrinsicParamsFromValues(26, -26, 15.5, 11.5);
    }
    EXPECT_EQ(problemOf(*scan), "");
}

/** A slanted plane n.x = d in front of two cameras. */
struct PlaneScene
{
    Eigen::Vector3d n{Eigen::Vector3d(0.3, -0.2, 1).normalized()};  // depth camera, optical
    double d{2.0};

    [[nodiscard]] double depthAt(const Eigen::Vector3d& ray) const { return d / n.dot(ray); }
};

/** An observation whose depth camera sees the plane; colour camera beside it, of another size. */
[[nodiscard]] CObservation3DRangeScan::Ptr unregisteredScan(
    const PlaneScene& scene, const Eigen::Isometry3d& T_depth_cam, int colourWidth)
{
    auto scan = sampleScan(0, 160, 120);
    scan->cameraParams.setIntrinsicParamsFromValues(143, 144, 80.2, 59.1);
    scan->rangeUnits = 1e-4F;
    for (int v = 0; v < 120; ++v)
    {
        for (int u = 0; u < 160; ++u)
        {
            const Eigen::Vector3d ray((u - 80.2) / 143, (v - 59.1) / 144, 1);
            scan->rangeImage(v, u) =
                static_cast<std::uint16_t>(std::lround(scene.depthAt(ray) / 1e-4));
        }
    }
    const int colourHeight = colourWidth * 3 / 4;
    scan->intensityImage.resize(colourWidth, colourHeight, mrpt::img::CH_RGB);
    auto& intensity = scan->cameraParamsIntensity;
    intensity.ncols = static_cast<std::uint32_t>(colourWidth);
    intensity.nrows = static_cast<std::uint32_t>(colourHeight);
    intensity.setIntrinsicParamsFromValues(
        0.82 * colourWidth, 0.82 * colourWidth, 0.5 * colourWidth, 0.5 * colourHeight);
    scan->relativePoseIntensityWRTDepth = toMrpt(opticalInBody() * T_depth_cam);
    return scan;
}

/** Width of the colour image, and the roll of its camera [deg]. */
class UnregisteredDepth : public testing::TestWithParam<std::tuple<int, int>>
{
};

TEST_P(UnregisteredDepth, isRenderedIntoTheColourCamera)
{
    const PlaneScene scene;
    Vector6d xi;
    xi << 0.025, -0.003, 0.004, 0.01, -0.02, 0.015;
    const auto [width, roll_deg] = GetParam();
    const Eigen::Isometry3d T_depth_cam =
        se3Exp(xi) * Eigen::AngleAxisd(roll_deg * M_PI / 180, Eigen::Vector3d::UnitZ());
    const auto scan = unregisteredScan(scene, T_depth_cam, width);
    const ConvertedFrame converted = ObservationConverter().convert(*scan);
    ASSERT_EQ(converted.problem, "");
    EXPECT_THAT(converted.T_robot_cam, IsNearPose(opticalInBody() * T_depth_cam, 1e-7, 1e-9));
    const cv::Mat& depth = converted.frame.depth;
    ASSERT_EQ(depth.size(), cv::Size(width, width * 3 / 4));
    // The plane in the colour camera.
    const Eigen::Vector3d n_cam = T_depth_cam.linear().transpose() * scene.n;
    const double d_cam = scene.d - scene.n.dot(T_depth_cam.translation());
    const PinholeCamera& camera = converted.frame.camera;
    int numHoles = 0;
    double worst = 0;
    const int margin = width / 5;
    for (int v = margin; v < depth.rows - margin; ++v)
    {
        for (int u = margin; u < depth.cols - margin; ++u)
        {
            if (std::hypot(u - camera.cx, v - camera.cy) > 0.3 * width)
            {
                continue;  // may be beside the depth image
            }
            const float z = depth.at<float>(v, u);
            if (std::isnan(z))
            {
                ++numHoles;
                continue;
            }
            const Eigen::Vector3d ray((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1);
            worst = std::max(worst, std::abs(z - d_cam / n_cam.dot(ray)));
        }
    }
    EXPECT_EQ(numHoles, 0);
    EXPECT_LT(worst, 1e-3);  // [m], of readings quantised to 0.1 mm
}
INSTANTIATE_TEST_SUITE_P(
    WidthsAndRolls,
    UnregisteredDepth,
    testing::Combine(testing::Values(80, 160, 400), testing::Values(0, 30, 45, 90, 180)));

/** Intrinsics of a damaged file: whatever they are, registration ends, and soon. */
TEST(ObservationConverter, unregisteredDepthWithAnyIntrinsics)
{
    for (const double focal_px : {4.0, 1e8, 1e300})
    {
        for (const double centre_px : {1.0, 0.0, 1e30, -1e300})
        {
            const auto scan = sampleScan(0, 320, 240);
            scan->cameraParams.setIntrinsicParamsFromValues(focal_px, focal_px, 16, 12);
            scan->cameraParamsIntensity.setIntrinsicParamsFromValues(260, 260, centre_px, 120);
            const ConvertedFrame converted = ObservationConverter().convert(*scan);
            if (centre_px == 1)
            {
                ASSERT_EQ(converted.problem, "");
                EXPECT_EQ(converted.frame.depth.size(), cv::Size(320, 240));
            }
            else
            {
                EXPECT_THAT(converted.problem, testing::HasSubstr("principal point"));
            }
        }
    }
}

/** A dropped image must not end the track, nor move the robot by the cameras' distance. */
TEST(ObservationConverter, aScanThatLacksColourIsStillSeenByTheColourCamera)
{
    const Eigen::Isometry3d T_depth_cam(Eigen::Translation3d(0.1, 0, 0));
    const auto scan = unregisteredScan({}, T_depth_cam, 80);
    const ObservationConverter converter;
    const ConvertedFrame whole = converter.convert(*scan);
    scan->hasIntensityImage = false;
    scan->cameraParamsIntensity = {};
    const ConvertedFrame lacking = converter.convert(*scan);
    ASSERT_EQ(lacking.problem, "");
    EXPECT_TRUE(lacking.frame.gray.empty());
    EXPECT_EQ(lacking.frame.camera.fx, whole.frame.camera.fx);
    EXPECT_EQ(lacking.frame.depth.size(), whole.frame.depth.size());
    EXPECT_EQ(cv::norm(whole.frame.depth - lacking.frame.depth, cv::NORM_INF), 0);
    EXPECT_THAT(lacking.T_robot_cam.matrix(), test::IsMatrixNear(whole.T_robot_cam.matrix(), 0));
    scan->sensorLabel = "of depth alone";
    EXPECT_EQ(converter.convert(*scan).frame.depth.cols, 160);
}

TEST(ObservationConverter, nearSurfaceHidesTheFarOne)
{
    const PlaneScene scene;
    Eigen::Isometry3d T_depth_cam = Eigen::Isometry3d::Identity();
    T_depth_cam.translation().x() = 0.3;  // wide baseline: the box shifts over the wall
    const auto scan = unregisteredScan(scene, T_depth_cam, 160);
    for (int v = 40; v < 80; ++v)
    {
        for (int u = 90; u < 120; ++u)
        {
            scan->rangeImage(v, u) = 8000;  // 0.8 m
        }
    }
    const ConvertedFrame converted = ObservationConverter().convert(*scan);
    // Box at u = 80.2 + 143 X / 0.8 in the depth camera; 0.3 m further left in the colour camera.
    const double x = (105 - 80.2) / 143 * 0.8 - 0.3;
    const int u = static_cast<int>(std::lround(converted.frame.camera.fx * x / 0.8 + 80));
    const int v = static_cast<int>(std::lround(converted.frame.camera.fy * 0.9 / 144 + 60));
    EXPECT_NEAR(converted.frame.depth.at<float>(v, u), 0.8, 1e-3);
}

/** A book on a wall: the depths of both, and none between. */
TEST(ObservationConverter, anEdgeIsNoSlope)
{
    PlaneScene scene;
    scene.n = Eigen::Vector3d::UnitZ();
    const auto scan = unregisteredScan(scene, Eigen::Isometry3d::Identity(), 480);
    for (int v = 40; v < 80; ++v)
    {
        for (int u = 60; u < 100; ++u)
        {
            scan->rangeImage(v, u) = 19000;  // 1.9 m, before 2 m
        }
    }
    const cv::Mat depth = ObservationConverter().convert(*scan).frame.depth;
    for (int v = 0; v < depth.rows; ++v)
    {
        for (int u = 0; u < depth.cols; ++u)
        {
            const float z = depth.at<float>(v, u);
            EXPECT_TRUE(std::isnan(z) || std::abs(z - 1.9F) < 1e-4F || std::abs(z - 2.0F) < 1e-4F)
                << z << " at " << u << " " << v;
        }
    }
}

TEST(ObservationConverter, mrptsOwnUnregisteredFrame)
{
    const std::string path = "/usr/share/mrpt/datasets/tests_rgbd.rawlog";
    if (!std::filesystem::exists(path))
    {
        GTEST_SKIP() << path << " is not installed (package mrpt-common)";
    }
    RawlogReader reader(path);
    const auto scan = std::dynamic_pointer_cast<CObservation3DRangeScan>(reader.next());
    ASSERT_TRUE(scan);
    const ConvertedFrame converted = ObservationConverter().convert(*scan);
    ASSERT_EQ(converted.problem, "");
    EXPECT_EQ(converted.frame.depth.size(), converted.frame.gray.size());
    const int numBefore = cv::countNonZero(
        cv::Mat(480, 640, CV_16UC1, const_cast<std::uint16_t*>(scan->rangeImage.data())));
    const int numAfter = cv::countNonZero(converted.frame.depth == converted.frame.depth);
    // The colour camera's view is wider than the depth camera's: what is seen fills less of it.
    EXPECT_GT(numAfter, numBefore / 2);
    EXPECT_LT(numAfter, numBefore * 5 / 4);
}

TEST(ObservationConverter, everyBadFrameHasItsText)
{
    const auto with = [](const auto& change)
    {
        const auto scan = sampleScan(0);
        change(*scan);
        return problemOf(*scan);
    };
    using Scan = CObservation3DRangeScan;
    using testing::HasSubstr;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(
        with([](Scan& s) { s.hasRangeImage = s.hasIntensityImage = false; }),
        "observation has no range image");
    EXPECT_EQ(  // beside colour
        with([](Scan& s) { s.hasRangeImage = !(s.hasPoints3D = true); }),
        "observation has no range image, and 3D points cannot replace it: record it, too "
        "(grab_depth = true for MRPT's rawlog-grabber)");
    EXPECT_THAT(
        with([](Scan& s) { s.timestamp = INVALID_TIMESTAMP; }), HasSubstr("has no time stamp"));
    EXPECT_THAT(
        with([nan](Scan& s) { s.cameraParams.setIntrinsicParamsFromValues(nan, 1, 1, 1); }),
        HasSubstr("cameraParams: camera intrinsics are not finite"));
    EXPECT_THAT(
        with([](Scan& s) { s.cameraParamsIntensity.setIntrinsicParamsFromValues(0, 26, 15, 11); }),
        HasSubstr("cameraParamsIntensity: focal length is zero"));
    EXPECT_EQ(
        with([](Scan& s) { s.cameraParams.ncols = 640; }),
        "range image is 32x24 but cameraParams is for 640x24");
    EXPECT_EQ(
        with([](Scan& s) { s.cameraParamsIntensity.nrows = 480; }),
        "intensity image is 32x24 but cameraParamsIntensity is for 32x480");
    EXPECT_THAT(with([](Scan& s) { s.rangeUnits = 0; }), HasSubstr("rangeUnits"));
    EXPECT_THAT(
        with([](Scan& s) { s.rangeUnits = std::numeric_limits<float>::infinity(); }),
        HasSubstr("rangeUnits"));
    EXPECT_EQ(with([](Scan& s) { s.rangeImage.setSize(0, 0); }), "range image is empty");
    EXPECT_EQ(
        with([](Scan& s) { s.intensityImage = mrpt::img::CImage(); }), "intensity image is empty");
    EXPECT_THAT(
        with([](Scan& s)
             { s.cameraParams.distortion = mrpt::img::DistortionModel::kannala_brandt; }),
        HasSubstr("fisheye"));
    EXPECT_EQ(with([](Scan& s) { s.sensorPose.x(1e200); }), "sensorPose is longer than 10 km");
    for (const double y : {0.0, -0.025})
    {
        EXPECT_THAT(
            with([y](Scan& s) { s.relativePoseIntensityWRTDepth.setFromValues(0, y, 0); }),
            HasSubstr(
                "relativePoseIntensityWRTDepth has no rotation, so the colour camera looks up"));
    }
    EXPECT_EQ(
        with(
            [](Scan& s)
            {
                mrpt::math::CMatrixDouble33 shear = mrpt::math::CMatrixDouble33::Identity();
                shear(0, 1) = 2;
                s.relativePoseIntensityWRTDepth.setRotationMatrix(shear);
            }),
        "relativePoseIntensityWRTDepth has no rotation matrix");
}

TEST(ObservationConverter, aNewLineInAPathDoesNotEndTheProblem)
{
    const auto scan = sampleScan(0);
    scan->intensityImage.setExternalStorage("rgb.png");
    ObservationConverter converter;
    converter.setExternalsDirectory("/no\nsuch");
    EXPECT_EQ(converter.convert(*scan).problem, "cannot open /no?such: no such folder");
}

TEST(ObservationConverter, tinyAndHugeImages)
{
    for (const auto& [width, height] : {std::pair{1, 1}, {2, 1}, {4096, 3072}})
    {
        const auto scan = sampleScan(0, width, height);
        scan->cameraParams.setIntrinsicParamsFromValues(width, width, width / 2.0, height / 2.0);
        scan->cameraParamsIntensity = scan->cameraParams;
        EXPECT_EQ(problemOf(*scan), "");
        scan->relativePoseIntensityWRTDepth.x(0.02);  // rendered
        EXPECT_EQ(problemOf(*scan), "");
    }
}

class ExternalFiles : public testing::Test
{
 protected:
    void SetUp() override
    {
        moveRangeToFile(*scan_, dir_ / "", "range.bin");
        cv::imwrite(dir_ / "colour.png", embedded_->intensityImage.asCvMatRef());
        scan_->intensityImage.setExternalStorage("colour.png");
        // As it comes out of a rawlog: without readings.
        mrpt::io::CMemoryStream stream;
        auto archive = mrpt::serialization::archiveFrom(stream);
        archive << *scan_;
        stream.Seek(0);
        scan_ = archive.ReadObject<CObservation3DRangeScan>();
        scan_->rangeImage.setSize(0, 0);
        converter_.setExternalsDirectory(dir_ / "");
    }
    [[nodiscard]] std::string problem() { return converter_.convert(*scan_).problem; }

    TempDir dir_;
    CObservation3DRangeScan::Ptr embedded_{sampleScan(5)};
    CObservation3DRangeScan::Ptr scan_{sampleScan(5)};
    ObservationConverter converter_;
};

TEST_F(ExternalFiles, areReadAsIfEmbedded)
{
    const ConvertedFrame a = ObservationConverter().convert(*embedded_);
    const ConvertedFrame b = converter_.convert(*scan_);
    ASSERT_EQ(b.problem, "");
    EXPECT_EQ(cv::norm(a.frame.gray, b.frame.gray, cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(a.frame.depth, b.frame.depth, cv::NORM_INF), 0);
}

/** As MRPT's own programs find them. */
TEST_F(ExternalFiles, areInMrptsFolderUnlessAnotherIsGiven)
{
    const std::string before = mrpt::img::CImage::getImagesPathBase();
    mrpt::img::CImage::setImagesPathBase(dir_ / "");
    EXPECT_EQ(ObservationConverter().convert(*scan_).problem, "");
    EXPECT_GT(withPoints(*scan_)->points3D_x.size(), 0U);
    mrpt::img::CImage::setImagesPathBase(before);
}

TEST_F(ExternalFiles, missingOnesAreNamed)
{
    std::filesystem::remove(dir_ / "range.bin");
    EXPECT_THAT(problem(), testing::HasSubstr("range.bin: No such file"));
    moveRangeToFile(*embedded_, dir_ / "", "range.bin");
    std::filesystem::remove(dir_ / "colour.png");
    EXPECT_THAT(problem(), testing::HasSubstr("colour.png: no such file"));
}

TEST_F(ExternalFiles, damagedOnesAreNamedAndNeverCrash)
{
    const std::string good = test::readBytes(dir_ / "range.bin");
    for (std::size_t cut = 0; cut < good.size(); cut += 7)
    {
        test::writeBytes(dir_ / "range.bin", good.substr(0, cut));
        EXPECT_THAT(problem(), testing::HasSubstr("range.bin")) << cut;
    }
    // Plain, with sizes that the file does not hold, and of another size than the camera's.
    test::writeBytes(dir_ / "range.bin", std::string("\xff\xff\xff\x7f\xff\xff\xff\x7f", 8));
    EXPECT_THAT(problem(), testing::HasSubstr("is not a range image"));
    test::writeBytes(dir_ / "range.bin", std::string("\x01\0\0\0\x02\0\0\0\x05\0\x06\0", 12));
    EXPECT_EQ(problem(), "range image is 2x1 but cameraParams is for 32x24");
    test::writeBytes(dir_ / "range.bin", test::readBytes(dir_ / "colour.png"));
    EXPECT_THAT(problem(), testing::HasSubstr("range.bin"));
    test::writeBytes(dir_ / "range.bin", good);
    const std::string picture = test::readBytes(dir_ / "colour.png");
    test::writeBytes(dir_ / "colour.png", picture.substr(0, 60));
    EXPECT_THAT(problem(), testing::HasSubstr("colour.png: stops before the end of the image"));
    test::writeBytes(dir_ / "colour.png", "");
    EXPECT_THAT(problem(), testing::HasSubstr("colour.png"));
}

TEST(ShutterComment, roundTripPerLabel)
{
    ObservationConverter converter;
    mrpt::obs::CObservationComment comment;
    comment.text = cameraComment("RGBD", {0.021, 0.029, ShutterModel::kUnknown});
    EXPECT_EQ(comment.text, "pointplane-camera label=RGBD readoutColour=0.021 readoutDepth=0.029");
    converter.readComment(comment);
    const auto scan = sampleScan(0);
    const ShutterModel shutter = converter.convert(*scan).frame.shutter;
    EXPECT_DOUBLE_EQ(shutter.readoutColour, 0.021);
    EXPECT_DOUBLE_EQ(shutter.readoutDepth, 0.029);
    EXPECT_TRUE(std::isnan(shutter.depthDelay));
    scan->sensorLabel = "OTHER";
    EXPECT_TRUE(std::isnan(converter.convert(*scan).frame.shutter.readoutColour));
    EXPECT_FALSE(converter.convert(*scan).frame.camera.isNominal);
    comment.text = cameraComment("OTHER", {}, true);
    EXPECT_EQ(comment.text, "pointplane-camera label=OTHER intrinsics=nominal");
    converter.readComment(comment);
    EXPECT_TRUE(converter.convert(*scan).frame.camera.isNominal);
    scan->sensorLabel = "front camera\n100%20";
    comment.text = cameraComment(scan->sensorLabel, {}, true);
    EXPECT_EQ(comment.text, "pointplane-camera label=front%20camera%0A100%2520 intrinsics=nominal");
    converter.readComment(comment);
    EXPECT_TRUE(converter.convert(*scan).frame.camera.isNominal);
    scan->sensorLabel = "50%";  // as it was written before
    comment.text = "pointplane-camera label=50% intrinsics=nominal";
    converter.readComment(comment);
    EXPECT_TRUE(converter.convert(*scan).frame.camera.isNominal);
    comment.text = "driver: left the garage";
    EXPECT_NO_THROW(converter.readComment(comment));
}

TEST(ShutterComment, mistakesNameTheKey)
{
    const auto messageOf = [](const std::string& text)
    {
        mrpt::obs::CObservationComment comment;
        comment.text = text;
        try
        {
            ObservationConverter().readComment(comment);
        }
        catch (const InputError& e)
        {
            return std::string(e.what());
        }
        return std::string();
    };
    EXPECT_EQ(messageOf("pointplane-camera label=A readout=1"), "");  // of a newer version
    EXPECT_THAT(messageOf("pointplane-camera label=A depthDelay=0,1"), testing::HasSubstr("'0,1'"));
    EXPECT_THAT(messageOf("pointplane-camera depthDelay=0.1"), testing::HasSubstr("label"));
    EXPECT_THAT(messageOf("pointplane-camera label=A depthDelay=nan"), testing::HasSubstr("nan"));
}
}  // namespace
}  // namespace pointplane
