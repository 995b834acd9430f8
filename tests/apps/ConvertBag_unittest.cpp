// SPDX-License-Identifier: BSD-3-Clause
#include <opencv2/imgproc.hpp>

#include <cmath>
#include <cstring>

#include "converted_recordings.h"
#include "ros_images.h"
#include <geometry_msgs/Transform.h>
#include <rosbag/bag.h>
#include <std_msgs/Float32.h>
#include <tf2_msgs/TFMessage.h>

namespace pointplane
{
namespace
{
using sensor_msgs::CameraInfo;
using sensor_msgs::CompressedImage;
using sensor_msgs::Image;
using testing::HasSubstr;

constexpr double kStart = 1000;

[[nodiscard]] ros::Time timeOf(int frame, double delay = 0)
{
    return ros::Time(kStart + frame / 30.0 + delay);
}

[[nodiscard]] Image imageOf(
    const cv::Mat& mat, const std::string& encoding, const std::string& frameId, ros::Time stamp)
{
    Image out;
    out.header.stamp = stamp;
    out.header.frame_id = frameId;
    out.width = static_cast<std::uint32_t>(mat.cols);
    out.height = static_cast<std::uint32_t>(mat.rows);
    out.encoding = encoding;
    out.step = static_cast<std::uint32_t>(mat.cols * static_cast<int>(mat.elemSize()));
    out.data.assign(mat.data, mat.data + mat.total() * mat.elemSize());
    return out;
}

[[nodiscard]] CompressedImage compressedOf(
    const cv::Mat& mat, const std::string& extension, const std::string& format, ros::Time stamp)
{
    CompressedImage out;
    out.header.stamp = stamp;
    out.header.frame_id = "optical";
    out.format = format;
    cv::imencode(extension, mat, out.data);
    return out;
}

[[nodiscard]] CameraInfo cameraInfo(const std::string& frameId, double f = 60)
{
    CameraInfo out;
    out.header.frame_id = frameId;
    out.width = 64;
    out.height = 48;
    out.distortion_model = "plumb_bob";
    out.D = {0, 0, 0, 0, 0};
    out.K = {f, 0, 31.5, 0, f, 23.5, 0, 0, 1};
    return out;
}

/** compressed_depth_image_transport: its header, then a PNG. */
[[nodiscard]] CompressedImage compressedDepth(
    const cv::Mat& depth, const std::string& encoding, ros::Time stamp)
{
    constexpr float kA = 200, kB = -10;
    cv::Mat values = depth;
    if (encoding == "32FC1")
    {
        values = cv::Mat(depth.size(), CV_16UC1);
        for (int i = 0; i < static_cast<int>(depth.total()); ++i)
        {
            values.at<std::uint16_t>(i) =
                static_cast<std::uint16_t>(kA / depth.at<float>(i) + kB + 0.5F);
        }
    }
    CompressedImage out = compressedOf(values, ".png", encoding + "; compressedDepth png", stamp);
    const struct
    {
        std::int32_t format;
        float a, b;
    } header{0, kA, kB};
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(&header);
    out.data.insert(out.data.begin(), bytes, bytes + sizeof(header));
    return out;
}

class ConvertBag : public test::ConvertedRecording
{
 protected:
    void SetUp() override { bag_.open(path_, rosbag::bagmode::Write); }

    [[nodiscard]] int convert(std::vector<std::string> more = {})
    {
        bag_.close();
        more.insert(more.begin(), {"bag", path_});
        return run(more);
    }

    void writeInfos()
    {
        bag_.write("/camera/rgb/camera_info", timeOf(0), cameraInfo("optical"));
        bag_.write("/camera/depth/camera_info", timeOf(0), cameraInfo("optical"));
    }

    void writeColour(int frame)
    {
        bag_.write(
            "/camera/rgb/image_color",
            timeOf(frame),
            imageOf(test::colourImage(frame), "bgr8", "optical", timeOf(frame)));
    }

    void writeDepth(int frame, const std::string& frameId = "optical")
    {
        bag_.write(
            "/camera/depth/image",
            timeOf(frame, 0.005),
            imageOf(test::depthImage(frame), "16UC1", frameId, timeOf(frame, 0.005)));
    }

    void expectFrames(std::size_t count, float tolerance = 1e-5F)
    {
        const auto found = frames();
        ASSERT_EQ(found.size(), count) << text_;
        for (std::size_t i = 0; i < count; ++i)
        {
            EXPECT_NEAR(found[i].stamp, kStart + static_cast<double>(i) / 30, 1e-6);
            EXPECT_NEAR(found[i].shutter.depthDelay, 0.005, 1e-6);
            EXPECT_NEAR(
                found[i].depth.at<float>(20, 30), 1 + 1e-3 * static_cast<double>(i), tolerance);
            EXPECT_NEAR(
                found[i].gray.at<uchar>(20, 30),
                0.114 * 200 + 0.587 * static_cast<double>(20 * i + 10) + 0.299 * 30,
                3);
        }
    }

    std::string path_{dir_ / "in.bag"};
    rosbag::Bag bag_;
};
}  // namespace

TEST_F(ConvertBag, likeTumsBags)
{
    writeInfos();
    for (int i = 0; i < 3; ++i)
    {
        writeColour(i);
        writeDepth(i);
    }
    ASSERT_EQ(convert(), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("/camera/rgb/image_color (bgr8)"));
    expectFrames(3);
    EXPECT_DOUBLE_EQ(frames()[0].camera.fx, 60);
}

TEST_F(ConvertBag, everyEncoding)
{
    const auto colour = [](int frame, const std::string& encoding)
    {
        cv::Mat out = test::colourImage(frame);
        if (encoding != "bgr8")
        {
            cv::cvtColor(
                out,
                out,
                encoding == "rgb8"    ? cv::COLOR_BGR2RGB
                : encoding == "rgba8" ? cv::COLOR_BGR2RGBA
                : encoding == "bgra8" ? cv::COLOR_BGR2BGRA
                                      : cv::COLOR_BGR2GRAY);
        }
        return imageOf(out, encoding, "optical", timeOf(frame));
    };
    const auto depth = [](int frame, const std::string& encoding)
    {
        cv::Mat out = test::depthImage(frame);
        if (encoding == "32FC1")
        {
            out.convertTo(out, CV_32F, 1e-3);
        }
        return imageOf(out, encoding, "optical", timeOf(frame, 0.005));
    };
    bag_.close();
    const std::pair<const char*, const char*> kinds[] = {
        {"rgb8", "16UC1"},
        {"bgr8", "32FC1"},
        {"mono8", "mono16"},
        {"rgba8", "16UC1"},
        {"bgra8", "16UC1"}};
    for (const auto& [colourKind, depthKind] : kinds)
    {
        bag_.open(path_, rosbag::bagmode::Write);
        writeInfos();
        for (int i = 0; i < 3; ++i)
        {
            bag_.write("/camera/rgb/image_raw", timeOf(i), colour(i, colourKind));
            bag_.write("/camera/depth/image_raw", timeOf(i, 0.005), depth(i, depthKind));
        }
        ASSERT_EQ(convert(), kExitOk) << colourKind << " " << text_;
        expectFrames(3, 1.3e-4F);
    }
}

TEST_F(ConvertBag, floatingPointDepthMayHaveAnotherUnit)
{
    writeInfos();
    for (int i = 0; i < 3; ++i)
    {
        cv::Mat millimetres;
        test::depthImage(i).convertTo(millimetres, CV_32F);
        writeColour(i);
        bag_.write(
            "/camera/depth/image",
            timeOf(i, 0.005),
            imageOf(millimetres, "32FC1", "optical", timeOf(i, 0.005)));
    }
    ASSERT_EQ(convert({"--depth-scale", "1000"}), kExitOk) << text_;
    expectFrames(3, 1.3e-4F);
    EXPECT_EQ(convert(), kExitIncomplete);
    EXPECT_THAT(text_, HasSubstr("no depth reading in any frame"));
}

/** By the last part of the topic: "direct" has "rect" in it, too. */
TEST_F(ConvertBag, whatIsRectifiedHasNoDistortion)
{
    bag_.close();
    for (const std::string topic :
         {"/direct/image_raw", "/rectified/rgb/image_color", "/rgb/image_rect_color"})
    {
        bag_.open(path_, rosbag::bagmode::Write);
        sensor_msgs::CameraInfo info = cameraInfo("optical");
        info.D = {0.1, 0, 0, 0, 0};
        info.distortion_model = "plumb_bob";
        bag_.write(topic.substr(0, topic.rfind('/')) + "/camera_info", timeOf(0), info);
        bag_.write("/camera/depth/camera_info", timeOf(0), cameraInfo("optical"));
        bag_.write(topic, timeOf(0), imageOf(test::colourImage(0), "bgr8", "optical", timeOf(0)));
        writeDepth(0);
        ASSERT_EQ(convert(), kExitOk) << topic << text_;
        const bool isRectified = topic.find("image_rect") != std::string::npos;
        EXPECT_EQ(frames().at(0).camera.distortion[0], isRectified ? 0 : 0.1) << topic;
    }
}

TEST_F(ConvertBag, compressedImages)
{
    bag_.close();
    for (const std::string encoding : {"16UC1", "32FC1"})
    {
        bag_.open(path_, rosbag::bagmode::Write);
        writeInfos();
        for (int i = 0; i < 3; ++i)
        {
            cv::Mat depth = test::depthImage(i);
            if (encoding == "32FC1")
            {
                depth.convertTo(depth, CV_32F, 1e-3);
            }
            bag_.write(
                "/camera/rgb/image_raw/compressed",
                timeOf(i),
                compressedOf(
                    test::colourImage(i), ".jpg", "bgr8; jpeg compressed bgr8", timeOf(i)));
            bag_.write(
                "/camera/depth/image_raw/compressedDepth",
                timeOf(i, 0.005),
                compressedDepth(depth, encoding, timeOf(i, 0.005)));
        }
        ASSERT_EQ(convert(), kExitOk) << text_;
        expectFrames(3, encoding == "32FC1" ? 4e-3F : 1e-5F);
    }
}

/** The transport's other coder; its bytes are whole. */
TEST_F(ConvertBag, depthByRvlIsNotSupportedAndNotDamaged)
{
    writeInfos();
    writeColour(0);
    CompressedImage depth = compressedDepth(test::depthImage(0), "16UC1", timeOf(0));
    depth.format = "16UC1; compressedDepth rvl";
    bag_.write("/camera/depth/image_raw/compressedDepth", timeOf(0), depth);
    EXPECT_EQ(convert(), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr("compressedDepth, message 0: depth compressed as RVL is not sup"));
}

TEST_F(ConvertBag, imagesOfAnotherSizeThanTheirCalibrationAreToldWithBoth)
{
    writeInfos();
    const cv::Mat half(24, 32, CV_8UC3, cv::Scalar(1, 2, 3));
    bag_.write("/camera/rgb/image_color", timeOf(0), imageOf(half, "bgr8", "optical", timeOf(0)));
    writeDepth(0);
    EXPECT_EQ(convert(), kExitBadInput);
    EXPECT_THAT(
        text_,
        HasSubstr("colour is 32x24 of 8 bit and 3 channels, depth 64x48 of 16 bit and 1 channel; "
                  "expected are colour of 8 bit and 64x48, depth of 16 bit and 64x48, as the "
                  "calibration says"));
}

/** 21 columns of 64 go with 15.75 rows of 48. */
TEST_F(ConvertBag, smallDepthMayBeRoundedToWholeRows)
{
    writeInfos();
    writeColour(0);
    bag_.write(
        "/camera/depth/image",
        timeOf(0),
        imageOf(test::depthImage(0, 21, 15), "16UC1", "optical", timeOf(0)));
    ASSERT_EQ(convert(), kExitOk) << text_;
    EXPECT_EQ(scans().at(0)->cameraParams.nrows, 15U);
}

TEST_F(ConvertBag, depthOfAnotherCameraIsPlacedByTf)
{
    bag_.write("/camera/rgb/camera_info", timeOf(0), cameraInfo("rgb_optical"));
    bag_.write("/camera/depth/camera_info", timeOf(0), cameraInfo("depth_optical", 50));
    tf2_msgs::TFMessage tf;
    for (const auto& [child, x] : {std::make_pair("rgb_optical", 0.1), {"depth_optical", 0.125}})
    {
        geometry_msgs::TransformStamped link;
        link.header.frame_id = "/base";
        link.child_frame_id = child;
        link.transform.translation.x = x;
        link.transform.rotation.w = 1;
        tf.transforms.push_back(link);
    }
    bag_.write("/tf_static", timeOf(0), tf);
    for (int i = 0; i < 2; ++i)
    {
        bag_.write(
            "/camera/rgb/image_color",
            timeOf(i),
            imageOf(test::colourImage(i), "bgr8", "rgb_optical", timeOf(i)));
        writeDepth(i, "/depth_optical");
    }
    ASSERT_EQ(convert(), kExitOk) << text_;
    const auto scan = scans().at(0);
    EXPECT_DOUBLE_EQ(scan->cameraParams.fx(), 50);
    // Colour is 25 mm to the left of depth: MRPT's y.
    EXPECT_NEAR(scan->relativePoseIntensityWRTDepth.y(), 0.025, 1e-9);
    EXPECT_NEAR(scan->relativePoseIntensityWRTDepth.x(), 0, 1e-9);
}

/** Of an arm that carries one of the cameras. */
/** Frames or names may say that depth is registered; the calibrations say that it is not. */
TEST_F(ConvertBag, depthWithItsOwnCalibrationIsNotRegistered)
{
    bag_.write("/camera/rgb/camera_info", timeOf(0), cameraInfo("optical"));
    bag_.write("/camera/depth/camera_info", timeOf(0), cameraInfo("optical", 45));
    writeColour(0);
    writeDepth(0);
    ASSERT_EQ(convert(), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("another calibration than colour"));
    EXPECT_DOUBLE_EQ(scans().at(0)->cameraParams.fx(), 45);
    EXPECT_DOUBLE_EQ(scans().at(0)->cameraParamsIntensity.fx(), 60);
}

TEST_F(ConvertBag, inverseDistortionIsLeftOutAndSaid)
{
    sensor_msgs::CameraInfo info = cameraInfo("optical");
    info.D = {0.1, 0, 0, 0, 0};
    info.distortion_model = "Inverse Brown Conrady";
    bag_.write("/camera/rgb/camera_info", timeOf(0), info);
    writeColour(0);
    writeDepth(0);
    ASSERT_EQ(convert(), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("distortion (Inverse Brown Conrady) is left out"));
    EXPECT_EQ(frames().at(0).camera.distortion[0], 0);
}

TEST_F(ConvertBag, registeredDepthNeedsNoCalibration)
{
    sensor_msgs::CameraInfo none = cameraInfo("optical", 0);
    bag_.write("/camera/rgb/camera_info", timeOf(0), cameraInfo("optical"));
    bag_.write("/camera/depth/camera_info", timeOf(0), none);
    writeColour(0);
    writeDepth(0);
    ASSERT_EQ(convert(), kExitOk) << text_;
    EXPECT_DOUBLE_EQ(scans().at(0)->cameraParams.fx(), 60);
}

TEST_F(ConvertBag, aTransformThatChangesIsNotTaken)
{
    bag_.close();
    for (const bool moves : {false, true})
    {
        bag_.open(path_, rosbag::bagmode::Write);
        bag_.write("/camera/rgb/camera_info", timeOf(0), cameraInfo("rgb_optical"));
        bag_.write("/camera/depth/camera_info", timeOf(0), cameraInfo("depth_optical", 50));
        for (int i = 0; i < 2; ++i)
        {
            tf2_msgs::TFMessage tf;
            geometry_msgs::TransformStamped link;
            link.header.frame_id = "depth_optical";
            link.child_frame_id = "rgb_optical";
            link.transform.translation.x = moves ? 0.1 * i : 0.1;
            link.transform.rotation.w = 1;
            tf.transforms.push_back(link);
            bag_.write("/tf", timeOf(i), tf);
        }
        bag_.write(
            "/camera/rgb/image_color",
            timeOf(0),
            imageOf(test::colourImage(0), "bgr8", "rgb_optical", timeOf(0)));
        writeDepth(0, "depth_optical");
        ASSERT_EQ(convert(), kExitOk) << text_;
        EXPECT_NEAR(scans().at(0)->relativePoseIntensityWRTDepth.y(), moves ? 0 : -0.1, 1e-9);
        const std::string told = "that from depth_optical to rgb_optical changes";
        EXPECT_EQ(text_.find(told) != std::string::npos, moves) << text_;
    }
}

TEST_F(ConvertBag, whatIsMissingIsTold)
{
    writeInfos();
    writeDepth(0);
    EXPECT_EQ(convert(), kExitBadInput);
    EXPECT_THAT(
        text_,
        HasSubstr("has no topic with colour images, and a frame needs colour and depth (images are "
                  "on: /camera/depth/image); --colour-topic takes"));
}

TEST_F(ConvertBag, aCutPictureIsNamedAndLeftOut)
{
    writeInfos();
    for (int i = 0; i < 2; ++i)
    {
        CompressedImage colour =
            compressedOf(test::colourImage(i), ".jpg", "bgr8; jpeg compressed bgr8", timeOf(i));
        colour.data.resize(colour.data.size() - (i == 0 ? 20 : 0));
        bag_.write("/camera/rgb/image_raw/compressed", timeOf(i), colour);
        writeDepth(i);
    }
    EXPECT_EQ(convert(), kExitIncomplete);
    EXPECT_THAT(text_, HasSubstr("message 0: compressed image: stops before the end"));
    EXPECT_EQ(frames().size(), 1U);
}

TEST_F(ConvertBag, ofRealSensesRecorder)
{
    const std::string depth = "/device_0/sensor_0/Depth_0", colour = "/device_0/sensor_1/Color_0";
    bag_.write(depth + "/info/camera_info", timeOf(0), cameraInfo("0"));
    bag_.write(colour + "/info/camera_info", timeOf(0), cameraInfo("0"));
    geometry_msgs::Transform none, right;
    none.rotation.w = right.rotation.w = 1;
    right.translation.x = 0.015;  // points of the reference in the axes of colour
    bag_.write(depth + "/tf/0", timeOf(0), none);
    bag_.write(colour + "/tf/0", timeOf(0), right);
    std_msgs::Float32 unit;
    unit.data = 0.0005F;
    bag_.write("/device_0/sensor_0/option/Depth_Units/value", timeOf(0), unit);
    for (int i = 0; i < 2; ++i)
    {
        bag_.write(
            colour + "/image/data",
            timeOf(i),
            imageOf(test::colourImage(i), "bgr8", "0", timeOf(i)));
        bag_.write(
            depth + "/image/data",
            timeOf(i, 0.005),
            imageOf(2 * test::depthImage(i), "mono16", "0", timeOf(i, 0.005)));
    }
    ASSERT_EQ(convert(), kExitOk) << text_;
    const auto scan = scans().at(0);
    EXPECT_NEAR(scan->rangeUnits, 0.0005, 1e-9);
    EXPECT_NEAR(scan->relativePoseIntensityWRTDepth.y(), 0.015, 1e-9);
    EXPECT_EQ(scan->rangeImage(20, 30), 2000);
}

/** Frames that arrive out of order, and one whose clock was wrong, have their partners, too. */
TEST_F(ConvertBag, stampsMayGoBack)
{
    writeInfos();
    int arrived = 0;
    for (const int i : {900, 0, 2, 1, 3})
    {
        const ros::Time time = timeOf(++arrived);
        bag_.write(
            "/camera/rgb/image_color",
            time,
            imageOf(test::colourImage(i), "bgr8", "optical", timeOf(i)));
        bag_.write(
            "/camera/depth/image",
            time,
            imageOf(test::depthImage(i), "16UC1", "optical", timeOf(i, 0.005)));
    }
    ASSERT_EQ(convert(), kExitOk) << text_;
    EXPECT_THAT(text_, testing::Not(HasSubstr("left out")));
    EXPECT_THAT(text_, HasSubstr("stamps: 2 of them are before the one before"));
    const auto found = frames();
    ASSERT_EQ(found.size(), 5U);
    for (const RgbdFrame& frame : found)
    {
        const double number = 30 * (frame.stamp - kStart);
        EXPECT_NEAR(frame.depth.at<float>(20, 30), 1 + 1e-3 * number, 1e-5);
    }
}

/** As of a driver that does not set them. */
TEST_F(ConvertBag, headersWithoutStampsAreRefused)
{
    writeInfos();
    for (int i = 0; i < 3; ++i)
    {
        bag_.write(
            "/camera/rgb/image_color",
            timeOf(i),
            imageOf(test::colourImage(i), "bgr8", "optical", ros::Time()));
        writeDepth(i);
    }
    EXPECT_EQ(convert(), kExitBadInput);
    EXPECT_THAT(
        text_, HasSubstr("in.bag: /camera/rgb/image_color: all its images have the stamp 0.000 s"));
}

TEST_F(ConvertBag, severalTopicsAreNamed)
{
    writeInfos();
    for (int i = 0; i < 3; ++i)
    {
        writeColour(i);
        writeDepth(i);
        bag_.write(
            "/other/color/image_raw",
            timeOf(i),
            imageOf(test::colourImage(i), "rgb8", "other", timeOf(i)));
    }
    EXPECT_EQ(convert(), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr("--colour-topic"));
    EXPECT_THAT(text_, HasSubstr("/other/color/image_raw"));
    EXPECT_EQ(convert({"--colour-topic", "/camera/rgb/image_color"}), kExitOk) << text_;
    expectFrames(3);
    EXPECT_EQ(convert({"--colour-topic", "/none"}), kExitBadInput);
    EXPECT_EQ(convert({"--colour-topic", "/other/color/image_raw"}), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr("camera_info"));
}

TEST_F(ConvertBag, aBadImageIsNamedAndLeftOut)
{
    writeInfos();
    for (int i = 0; i < 4; ++i)
    {
        writeColour(i);
        Image depth = imageOf(test::depthImage(i), "16UC1", "optical", timeOf(i, 0.005));
        if (i == 1)
        {
            depth.data.resize(100);
        }
        bag_.write("/camera/depth/image", timeOf(i, 0.005), depth);
    }
    EXPECT_EQ(convert(), kExitIncomplete);
    EXPECT_THAT(text_, HasSubstr("/camera/depth/image, message 1"));
    EXPECT_EQ(frames().size(), 3U);
    std::filesystem::remove(out_);
    EXPECT_EQ(convert({"--strict"}), kExitBadInput);
    EXPECT_FALSE(std::filesystem::exists(out_));
}

TEST_F(ConvertBag, truncatedAndDamagedBagsEndInOneLine)
{
    bag_.setChunkThreshold(20000);
    writeInfos();
    for (int i = 0; i < 8; ++i)
    {
        writeColour(i);
        writeDepth(i);
    }
    bag_.close();
    const std::string whole = test::readBytes(path_);
    for (const std::size_t size :
         {std::size_t{0}, std::size_t{5}, std::size_t{3000}, whole.size() / 2})
    {
        test::writeBytes(path_, whole.substr(0, size));
        EXPECT_EQ(convert(), kExitBadInput) << size;
        EXPECT_EQ(std::count(text_.begin(), text_.end(), '\n'), 1) << text_;
    }
    test::writeBytes(path_, std::string(1000, 'x'));
    EXPECT_EQ(convert(), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr(path_ + ": is not a whole ROS 1 bag: "));
    // The index is whole, a chunk in the middle is not.
    std::string damaged = whole;
    const std::size_t chunk = damaged.find("compression=none", whole.size() / 2);
    ASSERT_NE(chunk, std::string::npos);
    damaged.replace(chunk, 16, "compression=nonx");
    test::writeBytes(path_, damaged);
    EXPECT_EQ(convert(), kExitIncomplete) << text_;
    EXPECT_THAT(text_, HasSubstr("damaged after message"));
    EXPECT_GE(frames().size(), 1U);
    std::filesystem::remove(out_);
    EXPECT_EQ(convert({"--strict"}), kExitBadInput);
    EXPECT_FALSE(std::filesystem::exists(out_));
    EXPECT_EQ(run({"bag", dir_ / "none.bag"}), kExitBadInput);
}
}  // namespace pointplane
