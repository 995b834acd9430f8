// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/trajectory_text.h>
#include <pointplane/mrpt_io/mrpt_poses.h>

#include <opencv2/videoio.hpp>

#include <cmath>
#include <random>

#include "converted_recordings.h"
#include "even_stamps.h"
#include "stamp_check.h"

namespace pointplane
{
namespace
{
using test::colourImage;
using test::depthImage;
using test::numbered;
using testing::HasSubstr;
using testing::Not;

class ConvertFolder : public test::ConvertedRecording
{
 protected:
    /** Frames 0 to 2 under names with the frame's number in them. */
    void writeFrames(const char* colour, const char* depth, int depthWidth = 64)
    {
        for (int i = 0; i < 3; ++i)
        {
            writeImage(numbered(colour, i), colourImage(i));
            writeImage(numbered(depth, i), depthImage(i, depthWidth, depthWidth * 3 / 4));
        }
    }

    /** Three frames, `fps` apart, at 1.000, 1.001 and 1.002 m, each with its own colour. */
    void expectFrames(double fps, double unitsPerMetre = 1000)
    {
        const auto found = frames();
        ASSERT_EQ(found.size(), 3U) << text_;
        for (int i = 0; i < 3; ++i)
        {
            const RgbdFrame& frame = found[static_cast<std::size_t>(i)];
            EXPECT_NEAR(frame.stamp - found[0].stamp, i / fps, 1e-6);
            EXPECT_NEAR(
                frame.depth.at<float>(frame.depth.rows / 2, frame.depth.cols / 2),
                (1000 + i) / unitsPerMetre,
                1e-5);
            const double gray = 0.114 * 200 + 0.587 * (20 * i + 10) + 0.299 * 30;
            EXPECT_NEAR(frame.gray.at<uchar>(20, 30), gray, 2);
        }
    }
};

constexpr const char* kCamera = "60 60 31.5 23.5 0 0 0 0 0 64 48 1000\n";
}  // namespace

TEST_F(ConvertFolder, numberedImagesWithACalibration)
{
    writeFrames("in/rgb/%d.jpg", "in/depth/%d.png");
    write("in/camera.txt", "60 61 31 23 0.1 0 0 0 0 64 48 500\n");
    ASSERT_EQ(run({"folder", in_, "--fps", "15"}), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("3 frames"));
    EXPECT_THAT(text_, HasSubstr("regular by number only"));
    EXPECT_THAT(text_, HasSubstr("\ndepth: 2 m, the median of a frame"));
    expectFrames(15, 500);
    const PinholeCamera camera = frames()[0].camera;
    EXPECT_DOUBLE_EQ(camera.fy, 61);
    EXPECT_DOUBLE_EQ(camera.distortion[0], 0.1);
}

TEST_F(ConvertFolder, withoutACalibrationNothingIsGuessed)
{
    writeFrames("in/rgb/%d.jpg", "in/depth/%d.png");
    EXPECT_EQ(run({"folder", in_}), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr("--camera"));
    EXPECT_FALSE(std::filesystem::exists(out_));
}

/** Its depth has 5000 units per metre, which these folders need not have. */
TEST_F(ConvertFolder, aCameraOfTheTumBenchmarkIsNone)
{
    writeFrames("in/rgb/%d.jpg", "in/depth/%d.png");
    EXPECT_EQ(run({"folder", in_, "--camera", "fr1"}), kExitBadInput);
    EXPECT_THAT(
        text_,
        HasSubstr(
            "--camera fr1: is not a file; only tum and bag know the cameras fr1, fr2, fr3\n"));
    EXPECT_EQ(run({"folder", in_, "--camera", "none.ini"}), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr("--camera none.ini: is not a file\n"));
    EXPECT_FALSE(std::filesystem::exists(out_));
}

TEST_F(ConvertFolder, scanNetHasTwoCamerasInOnePlace)
{
    writeFrames("in/color/%d.jpg", "in/depth/%d.png", 32);
    write("in/intrinsic/intrinsic_color.txt", "60 0 31.5 0\n0 60 23.5 0\n0 0 1 0\n0 0 0 1\n");
    write("in/intrinsic/intrinsic_depth.txt", "30 0 15.5 0\n0 30 11.5 0\n0 0 1 0\n0 0 0 1\n");
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("ScanNet"));
    expectFrames(30);
    const auto scan = scans()[0];
    EXPECT_EQ(scan->cameraParams.ncols, 32U);
    EXPECT_DOUBLE_EQ(scan->cameraParams.fx(), 30);
    EXPECT_DOUBLE_EQ(scan->cameraParamsIntensity.fx(), 60);
}

/** A calibration is of colour: depth stays that of the layout's own camera. */
TEST_F(ConvertFolder, scanNetKeepsItsDepthCameraBesideACalibration)
{
    writeFrames("in/color/%d.jpg", "in/depth/%d.png", 32);
    write("in/intrinsic/intrinsic_color.txt", "60 0 31.5 0\n0 60 23.5 0\n0 0 1 0\n0 0 0 1\n");
    write(  // with a byte order mark
        "in/intrinsic/intrinsic_depth.txt",
        "\xEF\xBB\xBF 29 0 15 0\n0 29 11 0\n0 0 1 0\n0 0 0 1\n");
    write("in/intrinsic/extrinsic_color.txt", "1 0 0 0.03\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    write("calibration.txt", "61 61 31 23 0 0 0 0 0 64 48 1000\n");
    ASSERT_EQ(run({"folder", in_, "--camera", dir_ / "calibration.txt"}), kExitOk) << text_;
    const auto scan = scans()[0];
    EXPECT_DOUBLE_EQ(scan->cameraParamsIntensity.fx(), 61);
    EXPECT_DOUBLE_EQ(scan->cameraParams.fx(), 29);
    EXPECT_NEAR(scan->relativePoseIntensityWRTDepth.norm(), 0.03, 1e-9);
}

/** Of the two cameras that kinect-stereo-calib writes, one is used. */
TEST_F(ConvertFolder, aDepthCameraThatIsNotUsedIsTold)
{
    writeFrames("in/rgb/%d.jpg", "in/depth/%d.png");
    const std::string camera = "resolution=[64 48]\ncx=31\ncy=23\nfy=60\ndist=[0 0 0 0 0]\nfx=";
    write("pair.ini", "[K_LEFT]\n" + camera + "50\n[K_RIGHT]\n" + camera + "60\n");
    ASSERT_EQ(run({"folder", in_, "--camera", dir_ / "pair.ini"}), kExitOk) << text_;
    EXPECT_DOUBLE_EQ(scans()[0]->cameraParams.fx(), 60);
    EXPECT_THAT(
        text_,
        HasSubstr("pair.ini: [K_LEFT], the depth camera, was not used: depth is taken for "
                  "registered to colour\n"));
}

/** As they are before depth is moved to colour: both cameras' poses in a common base. */
TEST_F(ConvertFolder, scanNetTellsWhereItsCamerasAre)
{
    writeFrames("in/color/%d.jpg", "in/depth/%d.png", 32);
    write("in/intrinsic/intrinsic_color.txt", "60 0 31.5 0\n0 60 23.5 0\n0 0 1 0\n0 0 0 1\n");
    write("in/intrinsic/intrinsic_depth.txt", "30 0 15.5 0\n0 30 11.5 0\n0 0 1 0\n0 0 0 1\n");
    write("in/intrinsic/extrinsic_color.txt", "1 0 0 0.03\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    // Turned by 90 degrees about z.
    write("in/intrinsic/extrinsic_depth.txt", "0 -1 0 0.01\n1 0 0 0\n0 0 1 0\n0 0 0 1\n");
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    const Eigen::Isometry3d T_depth_colour =
        opticalInBody().inverse() * fromMrpt(scans()[0]->relativePoseIntensityWRTDepth);
    EXPECT_TRUE(T_depth_colour.translation().isApprox(Eigen::Vector3d(0, -0.02, 0), 1e-9));
    EXPECT_TRUE(T_depth_colour.linear().col(0).isApprox(-Eigen::Vector3d::UnitY(), 1e-9));

    for (const char* bad : {"1 0 0 0\n0 1 0 0\n0 0 1 0\n", "2 0 0 0\n0 2 0 0\n0 0 2 0\n0 0 0 1\n"})
    {
        write("in/intrinsic/extrinsic_color.txt", bad);
        EXPECT_EQ(run({"folder", in_}), kExitBadInput);
        EXPECT_THAT(text_, HasSubstr("extrinsic_color.txt: is not a 4x4 matrix of a rotation"));
    }
}

/** Poses are the depth camera's; frames are seen by the colour camera. Where tracking was lost,
 * they are infinite. */
TEST_F(ConvertFolder, posesOfADataSetAreGroundTruth)
{
    writeFrames("in/color/%d.jpg", "in/depth/%d.png", 32);
    write("in/intrinsic/intrinsic_color.txt", "60 0 31.5 0\n0 60 23.5 0\n0 0 1 0\n0 0 0 1\n");
    write("in/intrinsic/intrinsic_depth.txt", "30 0 15.5 0\n0 30 11.5 0\n0 0 1 0\n0 0 0 1\n");
    write("in/intrinsic/extrinsic_color.txt", "1 0 0 0.03\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    // Turned by 90 degrees about z.
    write("in/pose/1.txt", "0 -1 0 5\n1 0 0 6\n0 0 1 7\n0 0 0 1\n");
    write("in/pose/2.txt", "-inf -inf -inf -inf\n0 0 0 0\n0 0 0 0\n0 0 0 1\n");
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("poses of 1 of 3 frames"));
    const auto truth = readTrajectoryText(dir_ / "out.groundtruth.txt");
    ASSERT_EQ(truth.size(), 1U);
    EXPECT_TRUE(truth.poses[0].translation().isApprox(Eigen::Vector3d(5, 6.03, 7), 1e-6));
    EXPECT_NEAR(truth.stamps[0], frames()[1].stamp, 1e-6);
}

TEST_F(ConvertFolder, posesOfReplicaAreLines)
{
    writeFrames("in/results/frame%06d.jpg", "in/results/depth%06d.png");
    write(
        "in/cam_params.json",
        R"({"camera": {"w": 64, "h": 48, "fx": 60, "fy": 60, "cx": 31.5, "cy": 23.5,
            "scale": 1000}})");
    write(
        "in/traj.txt",
        "1 0 0 1 0 1 0 2 0 0 1 3 0 0 0 1\nnot a pose\n1 0 0 4 0 1 0 5 0 0 1 6 0 0 0 1\n");
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    const auto truth = readTrajectoryText(dir_ / "out.groundtruth.txt");
    ASSERT_EQ(truth.size(), 2U);
    EXPECT_TRUE(truth.poses[1].translation().isApprox(Eigen::Vector3d(4, 5, 6), 1e-6));
    EXPECT_NEAR(truth.stamps[1], frames()[2].stamp, 1e-6);
}

TEST_F(ConvertFolder, sevenScenesMarksNoReadingBy65535)
{
    for (int i = 0; i < 3; ++i)
    {
        cv::Mat depth = depthImage(i, 640, 480);
        depth.at<std::uint16_t>(0, 0) = 65535;
        writeImage(numbered("in/frame-%06d.color.png", i), colourImage(i, 640, 480));
        writeImage(numbered("in/frame-%06d.depth.png", i), depth);
        write(numbered("in/frame-%06d.pose.txt", i), "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    }
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("7-Scenes"));
    EXPECT_THAT(text_, HasSubstr("nominal"));
    ASSERT_EQ(frames().size(), 3U);
    EXPECT_NEAR(frames()[1].stamp - frames()[0].stamp, 1. / 30, 1e-6);
    EXPECT_NEAR(frames()[1].depth.at<float>(240, 320), 1.001, 0.01);
    EXPECT_FALSE(scans().at(0)->rangeImage(0, 0) > 0);
    // Colour and depth are of two cameras.
    EXPECT_DOUBLE_EQ(scans().at(0)->cameraParams.fx(), 585);
    EXPECT_DOUBLE_EQ(scans().at(0)->cameraParamsIntensity.fx(), 525);
    EXPECT_NEAR(scans().at(0)->relativePoseIntensityWRTDepth.norm(), 0.0256, 1e-3);
}

TEST_F(ConvertFolder, aMatrixOfLargerImagesIsNotTaken)
{
    writeFrames("in/rgb/%06d.png", "in/depth/%06d.png", 16);
    write(
        "in/odometry.csv",
        "timestamp, frame, x, y, z, qx, qy, qz, qw\n"
        "7.5, 000000, 0,0,0,0,0,0,1\n7.6, 000001, 0,0,0,0,0,0,1\n7.7, 000002, 0,0,0,0,0,0,1\n");
    write("in/camera_matrix.csv", "80, 0, 42.2\n0, 80, 31.5\n0, 0, 1\n");
    EXPECT_NE(run({"folder", in_}), kExitOk);
    EXPECT_THAT(text_, HasSubstr("is 64x48, but the matrix in"));
    EXPECT_THAT(text_, HasSubstr("seems to be of images of about 84x63"));
}

TEST_F(ConvertFolder, listsTellTumsUnits)
{
    writeFrames("in/rgb/%d.0.png", "in/depth/%d.0.png");
    for (const char* const list : {"rgb", "depth"})
    {
        write(std::string("in/") + list + ".txt", "# stamp file\n");
    }
    write(
        "camera.json",
        R"({"width": 64, "height": 48, "intrinsic_matrix": [60, 0, 0, 0, 60, 0, 31.5, 23.5, 1]})");
    const std::string camera = dir_ / "camera.json";
    ASSERT_EQ(run({"folder", in_, "--camera", camera}), kExitOk) << text_;
    EXPECT_NEAR(frames().at(0).depth.at<float>(24, 32), 0.2, 1e-4);
    ASSERT_EQ(run({"folder", in_, "--camera", camera, "--depth-scale", "1000"}), kExitOk) << text_;
    EXPECT_NEAR(frames().at(0).depth.at<float>(24, 32), 1, 1e-4);
}

TEST_F(ConvertFolder, unitsThatTheLayoutTellsComeBeforeThoseOfLists)
{
    writeFrames("in/color/%d.0.png", "in/depth/%d.0.png");
    for (const char* const list : {"rgb", "depth"})
    {
        write(std::string("in/") + list + ".txt", "# stamp file\n");
    }
    write(
        "in/intrinsic.json",
        R"({"width": 64, "height": 48, "intrinsic_matrix": [60, 0, 0, 0, 60, 0, 31.5, 23.5, 1],)"
        R"( "depth_scale": 2000})");
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    EXPECT_NEAR(frames().at(0).depth.at<float>(24, 32), 0.5, 1e-4);
}

/** Date and time, not Redwood's frame and microseconds. */
TEST_F(ConvertFolder, datesAreNoStamps)
{
    write("in/camera.txt", kCamera);
    for (int i = 0; i < 3; ++i)
    {
        writeImage(numbered("in/rgb/20230501-12000%d.png", i), colourImage(i));
        writeImage(numbered("in/depth/20230501-12000%d.png", i), depthImage(i));
    }
    EXPECT_EQ(run({"folder", in_}), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr("20230501-120000.png"));
}

TEST_F(ConvertFolder, redwoodTellsMicroseconds)
{
    for (int i = 0; i < 3; ++i)
    {
        const int us = 1000000 + 33000 * i;
        writeImage(
            numbered("in/image/%07d", i + 1) + numbered("-%012d.jpg", us),
            colourImage(i, 640, 480));
        writeImage(
            numbered("in/depth/%07d", i + 1) + numbered("-%012d.png", us + 4000),
            depthImage(i, 640, 480));
    }
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("Redwood"));
    expectFrames(1 / 0.033);
    EXPECT_DOUBLE_EQ(frames()[0].stamp, 1);
    EXPECT_NEAR(frames()[0].shutter.depthDelay, 0.004, 1e-6);
}

TEST_F(ConvertFolder, replicaTellsItsScaleInJson)
{
    writeFrames("in/room0/results/frame%06d.jpg", "in/room0/results/depth%06d.png");
    write(
        "in/cam_params.json",
        R"({"camera": {"w": 64, "h": 48, "fx": 60, "fy": 60, "cx": 31.5, "cy": 23.5, "scale": 6553.5}})");
    ASSERT_EQ(run({"folder", in_ + "/room0"}), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("Replica"));
    expectFrames(30, 6553.5);
}

TEST_F(ConvertFolder, bonnHasStampsInItsNames)
{
    for (int i = 0; i < 3; ++i)
    {
        const std::string whole = std::to_string(1548266470 + i);
        writeImage("in/rgbd_bonn_x/rgb/" + whole + ".88633.png", colourImage(i, 640, 480));
        writeImage("in/rgbd_bonn_x/depth/" + whole + ".89633.png", depthImage(i, 640, 480));
    }
    ASSERT_EQ(run({"folder", in_ + "/rgbd_bonn_x"}), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("Bonn"));
    expectFrames(1, 5000);
    EXPECT_NEAR(frames()[0].stamp, 1548266470.88633, 1e-6);
    EXPECT_DOUBLE_EQ(frames()[0].camera.fx, 542.822841);
}

TEST_F(ConvertFolder, record3dHasSmallDepthImages)
{
    writeFrames("in/rgb/%d.jpg", "in/depth/%d.png", 16);
    write(
        "in/metadata.json",
        R"({"w": 64, "h": 48, "K": [60, 0, 0, 0, 61, 0, 31.5, 23.5, 1], "fps": 60})");
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("Record3D"));
    expectFrames(60);
    EXPECT_DOUBLE_EQ(scans()[0]->cameraParams.fx(), 15);
    EXPECT_DOUBLE_EQ(scans()[0]->cameraParamsIntensity.fy(), 61);
    EXPECT_DOUBLE_EQ(scans()[0]->cameraParamsIntensity.cx(), 31.5);
    write(
        "in/metadata.json",
        R"({"w": 64, "h": 48, "K": [60, 0, 30.5, 0, 61, 22.5, 0, 0, 1], "fps": 60})");
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;  // row by row
    EXPECT_DOUBLE_EQ(scans()[0]->cameraParamsIntensity.cx(), 30.5);
    EXPECT_DOUBLE_EQ(scans()[0]->cameraParamsIntensity.cy(), 22.5);
    write("in/metadata.json", R"({"w": 64, "h": 48, "K": [60, 0], "fps": 60})");
    EXPECT_EQ(run({"folder", in_}), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr("metadata.json"));
}

/** As of its recorders for RealSense and Azure Kinect, and of its reader of RealSense's bags, which
 * tells rate and units. */
TEST_F(ConvertFolder, open3dTellsItsCamera)
{
    const std::string camera =
        R"({"width": 64, "height": 48, "intrinsic_matrix": [60, 0, 0, 0, 61, 0, 31.5, 23.5, 1])";
    writeFrames("in/color/%d.jpg", "in/depth/%d.png");
    for (const char* name : {"in/camera_intrinsic.json", "in/intrinsic.json"})
    {
        write(name, camera + "}");
        ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
        EXPECT_THAT(text_, HasSubstr("read as Open3D, 1000 depth units per metre"));
        expectFrames(30);
        EXPECT_DOUBLE_EQ(frames()[0].camera.fy, 61);
        EXPECT_DOUBLE_EQ(frames()[0].camera.cx, 31.5);
        EXPECT_DOUBLE_EQ(frames()[0].camera.cy, 23.5);
        std::filesystem::remove(dir_ / name);
    }
    write("in/intrinsic.json", camera + R"(, "depth_scale": 4000, "fps": 15})");
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    expectFrames(15, 4000);
    write("in/intrinsic.json", R"({"width": 64, "height": 48, "intrinsic_matrix": [60, 0]})");
    EXPECT_EQ(run({"folder", in_}), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr("intrinsic.json: intrinsic_matrix is not a list of 9 numbers\n"));
    write("in/intrinsic.json", "{\"width\": 64");
    EXPECT_EQ(run({"folder", in_}), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr("intrinsic.json: is not JSON\n"));
    write("in/intrinsic.json", "[[60, 0, 31], [0, 60, 23], [0, 0, 1]]");  // another program's
    EXPECT_EQ(run({"folder", in_}), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr("does not tell its camera; give a calibration by --camera"));
    std::filesystem::remove(dir_ / "in/intrinsic.json");

    write("elsewhere.json", camera + "}");
    ASSERT_EQ(run({"folder", in_, "--camera", dir_ / "elsewhere.json"}), kExitOk) << text_;
    EXPECT_DOUBLE_EQ(frames()[0].camera.fy, 61);
    write("elsewhere.json", "{}");
    EXPECT_EQ(run({"folder", in_, "--camera", dir_ / "elsewhere.json"}), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr("has no intrinsic_matrix, as Open3D's calibrations have\n"));
}

TEST_F(ConvertFolder, stampsOfAListThatGoBackAreRefused)
{
    writeFrames("in/rgb/%d.jpg", "in/depth/%d.png");
    const std::string start = R"({"w": 64, "h": 48, "K": [60, 0, 0, 0, 60, 0, 31.5, 23.5, 1], )";
    for (const char* stamps : {"[5.2, 5.1, 5.0]", "[5.2, 5.1, 5.3]"})
    {
        write("in/metadata.json", start + "\"frameTimestamps\": " + stamps + "}");
        EXPECT_EQ(run({"folder", in_}), kExitBadInput);
        EXPECT_THAT(
            text_,
            HasSubstr(
                "in/metadata.json: the stamp of frame 1, 5.1 s, is not after that of frame 0, "
                "5.2 s; correct it, or give a rate by --fps\n"));
    }
    ASSERT_EQ(run({"folder", in_, "--fps", "10"}), kExitOk) << text_;
    expectFrames(10);
}

TEST_F(ConvertFolder, stampsOfAListThatRepeatCanBeEvenedOut)
{
    writeFrames("in/rgb/%d.jpg", "in/depth/%d.png");
    write(
        "in/metadata.json",
        R"({"w": 64, "h": 48, "K": [60, 0, 0, 0, 60, 0, 31.5, 23.5, 1],
            "frameTimestamps": [5.2, 5.2, 5.3]})");
    EXPECT_EQ(run({"folder", in_}), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr("or give a rate by --fps, or use --even-stamps\n"));
    ASSERT_EQ(run({"folder", in_, "--even-stamps"}), kExitOk) << text_;
    const auto found = frames();
    ASSERT_EQ(found.size(), 3U);
    EXPECT_NEAR(found[1].stamp - found[0].stamp, 0.05, 1e-6);
    EXPECT_NEAR(found[2].stamp - found[1].stamp, 0.05, 1e-6);
}

TEST_F(ConvertFolder, framesWithoutAStampInTheListAreLeftOut)
{
    const auto expectTwo = [this](const std::string& list)
    {
        ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
        EXPECT_THAT(text_, HasSubstr("stamps of the recording"));
        EXPECT_THAT(
            text_,
            HasSubstr(
                "\n2 images without a stamp in " + in_ + list +
                " were left out; --fps takes all, at a rate of its own\n"));
        EXPECT_THAT(text_, Not(HasSubstr("no number")));
        const auto found = frames();
        ASSERT_EQ(found.size(), 2U);
        EXPECT_NEAR(found[0].stamp, 7.5, 1e-6);
        EXPECT_NEAR(found[1].stamp, 7.7, 1e-6);
    };
    const auto expectNone = [this](const std::string& list)
    {
        EXPECT_EQ(run({"folder", in_}), kExitBadInput);
        EXPECT_THAT(
            text_,
            HasSubstr(list + ": tells no stamps of the images beside it; give a rate by --fps\n"));
    };
    const std::string record3d = R"({"w": 64, "h": 48, "K": [60, 0, 0, 0, 60, 0, 31.5, 23.5, 1], )";
    writeFrames("in/rgb/%d.png", "in/depth/%d.png");
    write("in/metadata.json", record3d + R"("frameTimestamps": [7.5, 7.7]})");
    expectTwo("/metadata.json");
    write("in/metadata.json", record3d + R"("frameTimestamps": []})");
    expectNone("/metadata.json");
    std::filesystem::remove(dir_ / "in/metadata.json");

    write("in/camera_matrix.csv", "60, 0, 31.5\n0, 60, 23.5\n0, 0, 1\n");
    write("in/odometry.csv", "timestamp, frame, x\n7.5, 000000, 0\n7.7, 000002, 0\n");
    expectTwo("/odometry.csv");
    write("in/odometry.csv", "timestamp, frame, x\n");
    expectNone("/odometry.csv");
}

TEST_F(ConvertFolder, aFolderOfMetadataIsNoFileOfIt)
{
    writeFrames("in/rgb/%d.jpg", "in/depth/%d.png");
    write("in/camera.txt", kCamera);
    write("in/metadata/mine.json", "{}");
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("read as numbered images"));
}

TEST_F(ConvertFolder, strayScannerHasItsColourInAVideo)
{
    writeFrames("in/rgb/%06d.png", "in/depth/%06d.png", 16);
    write("in/camera_matrix.csv", "60, 0, 31.5\n0, 60, 23.5\n0, 0, 1\n");
    write(
        "in/odometry.csv",
        "timestamp, frame, x, y, z, qx, qy, qz, qw\n"
        "7.5, 000000, 0,0,0,0,0,0,1\n7.6, 000001, 0,0,0,0,0,0,1\n7.7, 000002, 0,0,0,0,0,0,1\n");
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("StrayScanner"));
    expectFrames(10);
    EXPECT_NEAR(frames()[0].stamp, 7.5, 1e-6);

    std::filesystem::remove_all(dir_ / "in/rgb");
    // OpenCV's own encoder is always there; what is in a file counts, not its name.
    cv::VideoWriter video(
        dir_ / "in/rgb.avi",
        cv::CAP_OPENCV_MJPEG,
        cv::VideoWriter::fourcc('M', 'J', 'P', 'G'),
        60,
        {64, 48});
    ASSERT_TRUE(video.isOpened());
    for (int i = 0; i < 3; ++i)
    {
        video.write(colourImage(i));
    }
    video.release();
    std::filesystem::rename(dir_ / "in/rgb.avi", dir_ / "in/rgb.mp4");
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    ASSERT_EQ(frames().size(), 3U);
    EXPECT_NEAR(frames()[2].gray.at<uchar>(20, 30), 0.114 * 200 + 0.587 * 50 + 0.299 * 30, 8);
}

/** A phone writes how it was held; its depth images and its calibration are as the sensor is. */
TEST_F(ConvertFolder, aVideoIsNotTurned)
{
    writeFrames("in/rgb/%06d.png", "in/depth/%06d.png", 16);
    std::filesystem::remove_all(dir_ / "in/rgb");
    write("in/camera_matrix.csv", "60, 0, 31.5\n0, 60, 23.5\n0, 0, 1\n");
    write(
        "in/odometry.csv",
        "timestamp, frame, x, y, z, qx, qy, qz, qw\n"
        "7.5, 000000, 0,0,0,0,0,0,1\n7.6, 000001, 0,0,0,0,0,0,1\n7.7, 000002, 0,0,0,0,0,0,1\n");
    cv::VideoWriter video(
        dir_ / "in/rgb.mp4",
        cv::CAP_FFMPEG,
        cv::VideoWriter::fourcc('m', 'p', '4', 'v'),
        60,
        {64, 48});
    ASSERT_TRUE(video.isOpened());
    for (int i = 0; i < 3; ++i)
    {
        video.write(colourImage(i));
    }
    video.release();
    // The matrix of the track, a quarter turn in the place of the identity.
    std::string bytes = test::readBytes(dir_ / "in/rgb.mp4");
    const std::string zero(4, '\0'), one("\0\1\0\0", 4), minusOne("\xFF\xFF\0\0", 4);
    const std::string upright = one + zero + zero + zero + one;
    const std::size_t at = bytes.find(upright, bytes.find("tkhd"));
    ASSERT_NE(at, std::string::npos);
    bytes.replace(at, upright.size(), zero + one + zero + minusOne + zero);
    test::writeBytes(dir_ / "in/rgb.mp4", bytes);
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    EXPECT_EQ(frames().at(0).gray.size(), cv::Size(64, 48));
}

TEST_F(ConvertFolder, depthInFloatingPointMetres)
{
    for (const std::string ending : {"tiff", "pfm", "exr"})
    {
        const std::string folder = "in/" + ending;
        writeFrames((folder + "/rgb/%d.png").c_str(), (folder + "/depth/%d.png").c_str());
        for (int i = 0; i < 3; ++i)
        {
            std::filesystem::remove(dir_ / numbered((folder + "/depth/%d.png").c_str(), i));
            cv::Mat depth(48, 64, CV_32FC1, cv::Scalar((1000 + i) / 500.0));
            depth.at<float>(20, 30) = 1.5;
            writeImage(numbered((folder + "/depth/%d." + ending).c_str(), i), depth);
        }
        write(folder + "/camera.txt", kCamera);
        ASSERT_EQ(run({"folder", dir_ / folder}), kExitOk) << text_;
        const auto found = frames();
        ASSERT_EQ(found.size(), 3U);
        EXPECT_NEAR(found[2].depth.at<float>(27, 30), 2.004, 1.3e-4) << ending;
        EXPECT_NEAR(found[2].depth.at<float>(20, 30), 1.5, 1.3e-4) << ending;
    }
}

TEST_F(ConvertFolder, depthInFloatingPointMayHaveAnotherUnit)
{
    const auto writeDepth = [this](float reading)
    {
        for (int i = 0; i < 3; ++i)
        {
            writeImage(
                numbered("in/depth/%d.tiff", i), cv::Mat(48, 64, CV_32FC1, cv::Scalar(reading)));
        }
    };
    writeFrames("in/rgb/%d.png", "in/depth/%d.png");
    for (int i = 0; i < 3; ++i)
    {
        std::filesystem::remove(dir_ / numbered("in/depth/%d.png", i));
    }
    writeDepth(1500);
    write("in/camera.txt", kCamera);
    ASSERT_EQ(run({"folder", in_, "--depth-scale", "1000"}), kExitOk) << text_;
    EXPECT_NEAR(frames().at(2).depth.at<float>(20, 30), 1.5, 1.3e-4);
    EXPECT_THAT(text_, HasSubstr("1000 depth units per metre"));
    EXPECT_THAT(text_, HasSubstr("depth: 1.5 m"));

    // 1500 m: nothing is left of it.
    EXPECT_EQ(run({"folder", in_}), kExitIncomplete);
    EXPECT_THAT(text_, HasSubstr("no depth reading in any frame; if there are some, give --depth"));
    EXPECT_THAT(text_, HasSubstr(", 1 depth units per metre"));

    writeDepth(1.5F);
    writeImage("in/depth/1.tiff", cv::Mat(48, 64, CV_32FC1, cv::Scalar(0)));
    EXPECT_EQ(run({"folder", in_}), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("depth: no reading in 1 frame\n"));
    EXPECT_THAT(text_, Not(HasSubstr("left out")));

    cv::Mat far(48, 64, CV_32FC1, cv::Scalar(1.5));
    far.row(3).setTo(20);
    far.row(4).setTo(std::numeric_limits<float>::infinity());  // no reading
    writeImage("in/depth/1.tiff", far);
    EXPECT_EQ(run({"folder", in_}), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("depth: 64 readings beyond 16 m left out"));
}

TEST_F(ConvertFolder, imagesWhoseNamesAreNoNumberAreCounted)
{
    writeFrames("in/rgb/%d.png", "in/depth/%d.png");
    write("in/camera.txt", kCamera);
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    EXPECT_THAT(text_, Not(HasSubstr("left out")));
    writeImage("in/rgb/img_6.png", colourImage(0));
    writeImage("in/depth/img_6.png", depthImage(0));
    write("in/depth/notes.txt", "no image");
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    EXPECT_EQ(frames().size(), 3U);
    EXPECT_THAT(
        text_,
        HasSubstr(
            "2 images whose names are no number were left out: " + in_ + "/depth/img_6.png, ..."));
}

/** 0.png, 33.png, 66.png, ... are milliseconds. */
TEST_F(ConvertFolder, numbersThatMayBeTimesAreTold)
{
    write("in/camera.txt", kCamera);
    for (int i = 0; i < 3; ++i)
    {
        writeImage(numbered("in/rgb/%d.png", 33 * i), colourImage(i));
        writeImage(numbered("in/depth/%d.png", 33 * i), depthImage(i));
    }
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("numbers rise by 33, so frames are 1.1 s apart: are they times?"));
    ASSERT_EQ(run({"folder", in_, "--fps", "1000"}), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("numbers rise by 33, so frames are 0.033 s apart\n"));
    EXPECT_NEAR(mrpt::Clock::toDouble(scans().at(1)->timestamp), 0.033, 1e-6);
}

TEST_F(ConvertFolder, aBadImageIsNamedAndLeftOut)
{
    writeFrames("in/rgb/%d.png", "in/depth/%d.png");
    write("in/camera.txt", kCamera);
    const std::string whole = test::readBytes(dir_ / "in/depth/1.png");
    write("in/depth/1.png", whole.substr(0, 20));
    EXPECT_EQ(run({"folder", in_}), kExitIncomplete);
    EXPECT_THAT(text_, HasSubstr("in/depth/1.png"));
    EXPECT_EQ(frames().size(), 2U);

    std::filesystem::remove(out_);
    EXPECT_EQ(run({"folder", in_, "--strict"}), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr("in/depth/1.png"));
    EXPECT_FALSE(std::filesystem::exists(out_));

    // Where the disk fails.
    std::filesystem::remove(dir_ / "in/depth/1.png");
    std::filesystem::create_symlink("/proc/self/mem", dir_ / "in/depth/1.png");
    EXPECT_EQ(run({"folder", in_}), kExitIncomplete);
    EXPECT_THAT(text_, HasSubstr("cannot read " + in_ + "/depth/1.png: Input/output error"));
    EXPECT_EQ(frames().size(), 2U);
    std::filesystem::remove(dir_ / "in/depth/1.png");

    // Of another size, or not depth at all.
    writeImage("in/depth/1.png", depthImage(1, 64, 20));
    EXPECT_EQ(run({"folder", in_}), kExitIncomplete);
    EXPECT_THAT(text_, HasSubstr("64x20"));
    writeImage("in/depth/1.png", colourImage(1));
    EXPECT_EQ(run({"folder", in_}), kExitIncomplete);
    EXPECT_EQ(frames().size(), 2U);
}

TEST_F(ConvertFolder, otherFoldersAreErrorsThatSayWhatIsKnown)
{
    EXPECT_EQ(run({"folder", in_}), kExitBadInput);
    std::filesystem::create_directories(in_);
    EXPECT_EQ(run({"folder", in_}), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr("ScanNet"));
    writeImage("in/rgb/1.png", colourImage(1));
    writeImage("in/depth/2.png", depthImage(1));
    write("in/camera.txt", kCamera);
    EXPECT_EQ(run({"folder", in_}), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr("number"));
}

TEST_F(ConvertFolder, longNumbersAreTimesSince1970)
{
    write("in/camera.txt", kCamera);
    for (const char* unit : {"", "000", "000000", "000000000"})
    {
        std::filesystem::remove_all(dir_ / "in/rgb");
        std::filesystem::remove_all(dir_ / "in/depth");
        for (int i = 0; i < 3; ++i)
        {
            const std::string name = std::to_string(1305031102 + i) + unit + ".png";
            writeImage("in/rgb/" + name, colourImage(i));
            writeImage("in/depth/" + name, depthImage(i));
        }
        ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
        EXPECT_THAT(text_, HasSubstr("stamps of the recording"));
        expectFrames(1);
        EXPECT_NEAR(frames()[0].stamp, 1305031102, 1e-6);
        EXPECT_EQ(run({"folder", in_, "--fps", "30"}), kExitBadInput);
        EXPECT_THAT(text_, HasSubstr("leave --fps out"));
    }
}

TEST_F(ConvertFolder, depthMayBeAlone)
{
    for (const char* name : {"in/depth/%d.png", "in/depth_%04d.png"})
    {
        std::filesystem::remove_all(in_);
        write("in/camera.txt", kCamera);
        for (int i = 0; i < 3; ++i)
        {
            writeImage(numbered(name, i), depthImage(i));
        }
        ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
        EXPECT_THAT(
            text_,
            HasSubstr("\nno colour images: frames have depth alone, and only planes tell the "
                      "motion\n"));
        EXPECT_THAT(text_, Not(HasSubstr("left out")));
        const auto found = frames();
        ASSERT_EQ(found.size(), 3U);
        EXPECT_NEAR(found[2].stamp - found[0].stamp, 2 / 30.0, 1e-6);
        EXPECT_FLOAT_EQ(found[2].depth.at<float>(20, 30), 1.002F);
        EXPECT_TRUE(found[2].gray.empty());
        EXPECT_FALSE(scans()[0]->hasIntensityImage);
    }
}

TEST_F(ConvertFolder, depthAloneMayBeStampedAndSmallerThanItsCalibration)
{
    write("in/camera.txt", kCamera);
    for (int i = 0; i < 3; ++i)
    {
        const std::string stamp = std::to_string(1305031102 + i) + ".25";
        writeImage("in/depth/" + stamp + ".png", depthImage(i, 32, 24));
    }
    EXPECT_EQ(run({"folder", in_, "--max-difference=0"}), kExitBadInput);  // pairs nothing
    EXPECT_THAT(text_, HasSubstr("--max-difference: '0' is not a positive number"));
    for (const std::string option : {"--max-difference=0.02", "--even-stamps"})
    {
        ASSERT_EQ(run({"folder", in_, option}), kExitOk) << text_;
        const auto found = frames();
        ASSERT_EQ(found.size(), 3U);
        EXPECT_NEAR(found[1].stamp, 1305031103.25, 1e-3);
        EXPECT_DOUBLE_EQ(found[1].camera.fx, 30);
    }
    writeImage("in/depth/1305031105.25.png", depthImage(3, 32, 32));
    EXPECT_EQ(run({"folder", in_}), kExitIncomplete);
    EXPECT_THAT(text_, HasSubstr("1305031105.25.png: is 32x32, but the camera is for 64x48"));
}

/** Colour under a name that is not known must not be lost without a word. */
TEST_F(ConvertFolder, depthBesideUnknownImagesIsNotTakenForDepthAlone)
{
    for (const char* other : {"in/left/%d.png", "in/rgb/photo %d.png", "in/photo %d.png"})
    {
        std::filesystem::remove_all(in_);
        write("in/camera.txt", kCamera);
        writeFrames(other, "in/depth/%d.png");
        EXPECT_EQ(run({"folder", in_}), kExitBadInput);
        EXPECT_THAT(
            text_,
            HasSubstr(
                in_ + ": has depth, but its other images are not known as colour: " +
                numbered(other, 0).substr(3) +
                "; name their folder rgb and them by numbers, or move them away\n"));
    }
}

/** By pointplane-convert tum. */
TEST_F(ConvertFolder, aListOfDepthAloneIsNotIgnored)
{
    write("in/camera.txt", kCamera);
    write("in/depth.txt", "1.5 depth/0.png\n");
    writeImage("in/depth/0.png", depthImage(0));
    EXPECT_EQ(run({"folder", in_}), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr(": depth.txt tells the stamps of its numbered images; convert"));
    EXPECT_EQ(run({"folder", in_, "--fps", "30"}), kExitOk);
}

/** As KITTI's. */
TEST_F(ConvertFolder, longNumbersWithZerosInFrontAreFrames)
{
    write("in/camera.txt", kCamera);
    writeFrames("in/rgb/%010d.png", "in/depth/%010d.png");
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    expectFrames(30);
}

TEST_F(ConvertFolder, eachNumberIsOneFrame)
{
    writeFrames("in/rgb/%d.jpg", "in/depth/%d.png");
    writeFrames("in/rgb/%d.png", "in/depth/%d.png");
    write("in/camera.txt", kCamera);
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("3 frames"));
    EXPECT_THAT(text_, Not(HasSubstr("without a partner")));
    EXPECT_THAT(
        text_,
        HasSubstr(
            "\n3 images of a number or time that another one has were left out: " + in_ +
            "/rgb/0.png, ...\n"));
    EXPECT_THAT(text_, Not(HasSubstr("no number")));
}

TEST_F(ConvertFolder, whichNamesOfFoldersAndImagesAreReadIsTold)
{
    write("in/notes.txt", "no image");
    EXPECT_EQ(run({"folder", in_}), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr("Here are no images\n"));
    writeFrames("in/rgb/photo %d.png", "in/depth/photo %d.png");
    std::filesystem::rename(in_ + "/depth/photo 0.png", dir_ / "elsewhere.png");
    std::filesystem::create_symlink(dir_ / "elsewhere.png", in_ + "/depth/photo 0.png");
    EXPECT_EQ(run({"folder", in_}), kExitBadInput);
    EXPECT_THAT(
        text_,
        HasSubstr("two folders, rgb (or color, colour, image, images) and depth (depths), with "
                  "images named by number or stamp, as 12.png, frame_12.png or "
                  "1500000000.25.png; one folder with these words in the names, as rgb_12.png "
                  "and depth_12.png; depth alone. Here is depth/photo 0.png\n"));
}

TEST_F(ConvertFolder, aFolderOfTumIsToldToBeForTum)
{
    writeFrames("in/rgb/%d.png", "in/depth/%d.png");
    EXPECT_EQ(run({"folder", in_}), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr("give a calibration by --camera\n"));
    write("in/depth.txt", "0 depth/0.png\n");
    EXPECT_EQ(run({"folder", in_}), kExitBadInput);
    EXPECT_THAT(
        text_,
        HasSubstr("by --camera; pointplane-convert tum takes folders with lists, and knows TUM's "
                  "cameras\n"));
}

TEST_F(ConvertFolder, namesMayHaveAWordBesideTheNumber)
{
    const std::pair<const char*, const char*> names[] = {
        {"rgb_%04d.jpg", "depth_%04d.png"},
        {"%05d-color.png", "%05d-depth.png"},
        {"colour%d.png", "depth%d.png"},
        {"image.%d.png", "depth.%d.png"},
        {"rgb/rgb_%04d.png", "depth/depth_%04d.png"},
        {"color/frame%06d.png", "depth/frame%06d.png"}};
    for (const auto& [colour, depth] : names)
    {
        std::filesystem::remove_all(in_);
        write("in/camera.txt", kCamera);
        writeFrames((std::string("in/") + colour).c_str(), (std::string("in/") + depth).c_str());
        ASSERT_EQ(run({"folder", in_}), kExitOk) << colour << ": " << text_;
        EXPECT_THAT(text_, HasSubstr("read as numbered images"));
        EXPECT_THAT(text_, Not(HasSubstr("left out")));
        expectFrames(30);
    }
}

TEST_F(ConvertFolder, namesMayHaveAWordBesideTheStamp)
{
    write("in/camera.txt", kCamera);
    for (int i = 0; i < 3; ++i)
    {
        const std::string stamp = std::to_string(1305031102 + i) + ".25.png";
        writeImage("in/rgb_" + stamp, colourImage(i));
        writeImage("in/depth_" + stamp, depthImage(i));
    }
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("stamps of the recording"));
    expectFrames(1);
    EXPECT_NEAR(frames()[0].stamp, 1305031102.25, 1e-6);
}

TEST_F(ConvertFolder, oneImageIsNotToldAsMany)
{
    writeFrames("in/rgb/%d.png", "in/depth/%d.png");
    std::filesystem::copy(in_ + "/rgb/0.png", in_ + "/rgb/7.png");
    std::filesystem::copy(in_ + "/rgb/0.png", in_ + "/rgb/front.png");
    write("in/camera.txt", kCamera);
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("\n1 image without a partner was left out\n"));
    EXPECT_THAT(text_, HasSubstr("\n1 image whose name is no number was left out: "));
}

TEST_F(ConvertFolder, whichOfTwoFoldersWasTakenIsTold)
{
    writeFrames("in/color/%d.jpg", "in/depth/%d.png");
    write("in/camera.txt", kCamera);
    std::filesystem::create_directory_symlink("color", dir_ / "in/rgb");  // no other one
    std::filesystem::create_directory(dir_ / "in/image");
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    EXPECT_THAT(text_, Not(HasSubstr("left out")));
    writeFrames("in/image/%d.jpg", "in/depths/%d.png");
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    for (const char* other : {"/image", "/depths"})
    {
        EXPECT_THAT(
            text_,
            HasSubstr(
                "\n" + in_ + other + " was left out: there are images in " + in_ + "/rgb and " +
                in_ + "/depth; move away what is not meant\n"));
    }
}

/** Else frames would have depth alone, without a word why. */
TEST_F(ConvertFolder, aFolderOfColourThatCannotBeReadIsTold)
{
    for (const auto& [target, why] :
         {std::pair("elsewhere", "No such file or directory"),
          std::pair("rgb", "Too many levels of symbolic links")})
    {
        writeFrames("in/colour/%d.jpg", "in/depth/%d.png");
        write("in/camera.txt", kCamera);
        std::filesystem::remove_all(dir_ / "in/colour");
        std::filesystem::create_directory_symlink(target, dir_ / "in/rgb");
        EXPECT_EQ(run({"folder", in_}), kExitBadInput) << text_;
        EXPECT_THAT(text_, HasSubstr("cannot open " + in_ + "/rgb: " + why + "\n"));
        std::filesystem::remove(dir_ / "in/rgb");
    }
}

TEST_F(ConvertFolder, impossibleCalibrationsRatesAndTimesAreRefused)
{
    const auto expect = [this](const std::string& text)
    {
        EXPECT_EQ(run({"folder", in_}), kExitBadInput) << text;
        EXPECT_THAT(text_, HasSubstr(text));
        EXPECT_FALSE(std::filesystem::exists(out_));
    };
    writeFrames("in/rgb/%d.jpg", "in/depth/%d.png");
    const auto metadata = [this](const std::string& size, const std::string& more)
    {
        write(
            "in/metadata.json",
            R"({"K": [60, 0, 0, 0, 61, 0, 31.5, 23.5, 1], "h": 48, "w": )" + size + more + "}");
    };
    metadata("64", R"(, "fps": 0)");
    expect("metadata.json: 'fps' is not a positive number");
    metadata("64", R"(, "fps": 1e-300)");
    expect("is not a time stamp");
    metadata("64", R"(, "frameTimestamps": [1, 2, 1e300])");
    expect("is not a time stamp");
    metadata("30", "");
    expect("in/metadata.json: calibration of the colour camera: principal point is outside");
    metadata("1e20", "");
    expect("metadata.json: 'w' is not a number of pixels");
    std::filesystem::remove(dir_ / "in/metadata.json");

    write("in/camera_matrix.csv", "0, 0, 31.5\n0, 60, 23.5\n0, 0, 1\n");
    expect("camera_matrix.csv: calibration of the colour camera: focal length is zero");
    write("in/camera_matrix.csv", "60, 0, 0\n0, 60, 0\n31.5, 23.5, 1\n");
    expect("camera_matrix.csv: the third row of a camera's matrix is 0 0 1");
    std::filesystem::remove(dir_ / "in/camera_matrix.csv");
    std::filesystem::create_directory(dir_ / "in/camera_matrix.csv");
    expect("cannot open " + in_ + "/camera_matrix.csv: not a file");
}

/** A principal point at the border of the colour image is outside of one a quarter as large. */
TEST_F(ConvertFolder, calibrationsAreCheckedAtTheSizeOfEachImage)
{
    writeFrames("in/rgb/%d.jpg", "in/depth/%d.png", 16);
    write("in/camera.txt", "60 60 0.5 23.5 0 0 0 0 0 64 48 1000\n");
    EXPECT_EQ(run({"folder", in_}), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr("camera.txt: calibration of the depth camera: principal point"));
    write("in/camera.txt", "240 240 0.5 95.5 0 0 0 0 0 256 192 1000\n");
    EXPECT_EQ(run({"folder", in_}), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr("camera.txt: calibration of the colour camera: principal point"));
    EXPECT_FALSE(std::filesystem::exists(out_));
}

/** Their names are numbers, but their stamps are known: at 30 Hz every velocity would be wrong. */
TEST_F(ConvertFolder, stampsInListsAreNotIgnored)
{
    writeFrames("in/rgb/%d.jpg", "in/depth/%d.png");
    write("in/camera.txt", kCamera);
    write("in/rgb.txt", "1 rgb/0.jpg\n2 rgb/1.jpg\n3 rgb/2.jpg\n");
    write("in/depth.txt", "1 depth/0.png\n2 depth/1.png\n3 depth/2.png\n");
    EXPECT_EQ(run({"folder", in_}), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr(in_ + ": rgb.txt and depth.txt tell the stamps"));
    EXPECT_THAT(text_, HasSubstr("pointplane-convert tum"));
    EXPECT_EQ(run({"folder", in_, "--fps", "1"}), kExitOk) << text_;
    expectFrames(1);
}

TEST_F(ConvertFolder, aTownInThePathIsNoCamera)
{
    writeFrames("in/bonn/rgb/%d.jpg", "in/bonn/depth/%d.png");
    EXPECT_EQ(run({"folder", in_ + "/bonn"}), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr("--camera"));
}

TEST(ProblemOfStamps, saysWhatIsWrong)
{
    std::vector<double> even, rounded, repeated, jittering, back, gaps, slowComputer;
    for (int i = 0; i < 60; ++i)
    {
        const double t = 1000 + i / 30.0;
        even.push_back(t);
        repeated.push_back(std::floor(10 * t) / 10);
        rounded.push_back(std::round(100 * t) / 100);
        jittering.push_back(t + 0.008 * std::sin(7.0 * i));
        back.push_back(i == 30 ? t - 1 : t);
        if (i % 7 != 3)
        {
            gaps.push_back(t);
        }
        if (i % 9 == 0 || i % 9 == 2 || i % 9 == 5)
        {
            slowComputer.push_back(t);
        }
    }
    EXPECT_EQ(problemOfStamps({}), "");
    EXPECT_EQ(problemOfStamps(even), "");
    EXPECT_EQ(problemOfStamps(gaps), "");
    EXPECT_EQ(problemOfStamps(slowComputer), "") << "2, 3 or 4 frames after another";
    EXPECT_THAT(problemOfStamps(rounded), HasSubstr("rounded to 0.01 s"));
    EXPECT_THAT(problemOfStamps(jittering), HasSubstr("jitter"));
    EXPECT_THAT(problemOfStamps(repeated), HasSubstr("40 of them repeat the one before"));
    EXPECT_THAT(problemOfStamps(repeated), HasSubstr("--even-stamps"));
    EXPECT_EQ(problemOfStamps(back), "1 of them is before the one before");
    for (const double unit : {1e3, 1e6, 1e9, 30.0, 1e-3})  // 30: numbers of frames
    {
        std::vector<double> stamps;
        for (std::size_t i = 0; i < 3; ++i)
        {
            stamps.push_back(unit * (even[i] - even[0]));
        }
        EXPECT_THAT(problemOfStamps(stamps), HasSubstr(" s; are they in seconds?")) << unit;
        EXPECT_THAT(problemOfStamps(stamps), HasSubstr(unit < 1 ? " for fast," : " for slow,"));
    }
}

/** Standard deviation of the stamps' errors. */
static double scatter(const std::vector<double>& stamps, const std::vector<double>& truth)
{
    double sum = 0, sumOfSquares = 0;
    for (size_t i = 0; i < stamps.size(); ++i)
    {
        sum += stamps[i] - truth[i];
        sumOfSquares += (stamps[i] - truth[i]) * (stamps[i] - truth[i]);
    }
    const auto n = static_cast<double>(stamps.size());
    return std::sqrt(std::max(0.0, sumOfSquares / n - sum / n * sum / n));
}

TEST(EvenStamps, areThoseOfTheCamerasClock)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> delay(0, 0.01);
    std::vector<double> truth, rounded, delayed;
    for (int i = 0; i < 300; ++i)
    {
        if (i % 17 == 5 || (i > 200 && i < 215))
        {
            continue;  // lost
        }
        truth.push_back(1.3e9 + i * (1 / 30.0 + 1e-7 * i));
        rounded.push_back(std::round(100 * truth.back()) / 100);
        delayed.push_back(truth.back() + delay(random));
    }
    EXPECT_LT(scatter(evenStamps(truth), truth), 1e-5);
    for (const auto& stamps : {rounded, delayed})
    {
        EXPECT_LT(scatter(evenStamps(stamps), truth), 0.3 * scatter(stamps, truth));
        EXPECT_EQ(problemOfStamps(evenStamps(stamps)), "");
    }
}

TEST(EvenStamps, mayRepeatIfTheyAreRoundedCoarsely)
{
    for (const double step : {0.1, 1.0})
    {
        std::vector<double> truth, stamps;
        for (int i = 0; i < 600; ++i)
        {
            if (i > 200 && i < 215 + 60 * step)
            {
                continue;  // a pause
            }
            truth.push_back(1.3e9 + 0.037 + i / 30.0);
            stamps.push_back(std::floor(truth.back() / step) * step);
        }
        const std::vector<double> even = evenStamps(stamps);
        EXPECT_LT(scatter(even, truth), 0.1 * scatter(stamps, truth)) << step;
        double most = 0;
        for (size_t i = 1; i < even.size(); ++i)
        {
            most = std::max(most, std::abs(even[i] - even[i - 1] - (truth[i] - truth[i - 1])));
        }
        EXPECT_LT(most, 0.05 * step);
    }
}

TEST(EvenStamps, followARateThatChanges)
{
    std::vector<double> truth{100};
    for (int i = 0; i < 60; ++i)
    {
        truth.push_back(truth.back() + 0.0333 * (1 + 0.005 * i));
    }
    EXPECT_LT(scatter(evenStamps(truth), truth), 3e-3);
}

TEST(EvenStamps, areRefusedWithoutASteadyRate)
{
    EXPECT_TRUE(evenStamps({}).empty());
    EXPECT_EQ(evenStamps({5}), std::vector<double>{5});
    EXPECT_THROW((void)evenStamps({1, 2, 1.5, 3}), InputError);
    EXPECT_THROW((void)evenStamps({1, 1, 1, 1}), InputError);
    EXPECT_THROW((void)evenStamps({0, 0.033, 0.066, 0.066, 0.1, 0.101, 0.166}), InputError);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> interval(0.02, 0.2);
    std::vector<double> stamps{100};
    for (int i = 0; i < 100; ++i)
    {
        stamps.push_back(stamps.back() + interval(random));
    }
    EXPECT_THROW((void)evenStamps(stamps), InputError);
}

TEST_F(ConvertFolder, stampsAreEvenedOutOnlyIfThereAreAny)
{
    writeFrames("in/rgb/%d.jpg", "in/depth/%d.png");
    write("in/camera.txt", kCamera);
    EXPECT_EQ(run({"folder", in_, "--even-stamps"}), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr("has no stamps"));
}
}  // namespace pointplane
