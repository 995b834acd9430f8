// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/trajectory_text.h>

#include <opencv2/videoio.hpp>

#include "converted_recordings.h"

namespace pointplane
{
namespace
{
using test::colourImage;
using test::depthImage;
using test::numbered;
using testing::HasSubstr;
using testing::Not;

/** Folders whose poses become the ground truth of the camera: x right, y down, z forward. */
class ConvertPoses : public test::ConvertedRecording
{
 protected:
    /** Three frames, numbered from `first`. */
    void writeFrames(const char* colour, const char* depth, int first = 0) const
    {
        for (int i = 0; i < 3; ++i)
        {
            writeImage(numbered(colour, first + i), colourImage(i));
            writeImage(numbered(depth, first + i), depthImage(i));
        }
    }

    void writeRecord3d(const std::string& poses) const
    {
        writeFrames("in/rgb/%d.png", "in/depth/%d.png");
        write(
            "in/metadata.json",
            R"({"w": 64, "h": 48, "K": [60, 0, 0, 0, 60, 0, 31.5, 23.5, 1], "fps": 10, "poses": )" +
                poses + "}");
    }

    void writeStray(const std::string& odometry) const
    {
        writeFrames("in/rgb/%06d.png", "in/depth/%06d.png");
        write("in/camera_matrix.csv", "60, 0, 31.5\n0, 60, 23.5\n0, 0, 1\n");
        write("in/odometry.csv", odometry);
    }

    void writeOpen3d(int firstNumber) const
    {
        writeFrames("in/color/%05d.png", "in/depth/%05d.png", firstNumber);
        write(
            "in/camera_intrinsic.json",
            R"({"width": 64, "height": 48, "intrinsic_matrix": [60, 0, 0, 0, 60, 0, 31.5, 23.5, 1]})");
    }

    void writeBonn() const
    {
        for (int i = 0; i < 3; ++i)
        {
            const std::string name = std::to_string(1548266470 + i) + ".5.png";
            writeImage("rgbd_bonn_x/rgb/" + name, colourImage(i, 640, 480));
            writeImage("rgbd_bonn_x/depth/" + name, depthImage(i, 640, 480));
        }
    }

    [[nodiscard]] Trajectory truth() const
    {
        return readTrajectoryText(dir_ / "out.groundtruth.txt");
    }

    [[nodiscard]] bool hasTruth() const
    {
        return std::filesystem::exists(dir_ / "out.groundtruth.txt");
    }

    /** Converts `in` and expects one line that tells this. */
    void expectRefused(const std::string& what)
    {
        EXPECT_EQ(run({"folder", in_}), kExitBadInput) << text_;
        EXPECT_THAT(text_, HasSubstr("pointplane-convert: " + in_ + what + "\n"));
        EXPECT_FALSE(std::filesystem::exists(out_));
        EXPECT_FALSE(hasTruth());
    }
};

const std::string kStrayHeader = "timestamp, frame, x, y, z, qx, qy, qz, qw\n";

/** An item of a trajectory: this place, not turned. */
std::string logItem(int index, int number, double x)
{
    return numbered("%d ", index) + numbered("%d ", index) + numbered("%d\n", number) + "1 0 0 " +
           std::to_string(x) + "\n0 1 0 2\n0 0 1 3\n0 0 0 1\n";
}
}  // namespace

/** They are of a camera as OpenGL has it: x right, y up, z backward. */
TEST_F(ConvertPoses, record3dsCameraLooksAlongMinusZ)
{
    // Not turned; turned by 90 degrees about its x: up.
    writeRecord3d("[[0, 0, 0, 1, 1, 2, 3], [0.70710678, 0, 0, 0.70710678, 4, 5, 6], null]");
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("poses of 2 of 3 frames"));
    const Trajectory found = truth();
    ASSERT_EQ(found.size(), 2U);
    EXPECT_NEAR(found.stamps[1] - found.stamps[0], 0.1, 1e-6);
    const Eigen::Vector3d forward(0, 0, 1), right(1, 0, 0), down(0, 1, 0);
    EXPECT_TRUE((found.poses[0] * forward).isApprox(Eigen::Vector3d(1, 2, 2), 1e-6));
    EXPECT_TRUE((found.poses[0] * right).isApprox(Eigen::Vector3d(2, 2, 3), 1e-6));
    EXPECT_TRUE((found.poses[0] * down).isApprox(Eigen::Vector3d(1, 1, 3), 1e-6));
    EXPECT_TRUE((found.poses[1] * forward).isApprox(Eigen::Vector3d(4, 6, 6), 1e-6));
}

/** A selfie has the same place in all frames: none was measured. */
TEST_F(ConvertPoses, placeholdersAreNoPoses)
{
    const std::string none = "[0, 0, 0, 1, 0, 0, 0]";
    writeRecord3d("[" + none + "," + none + "," + none + "]");
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("poses of 0 of 3 frames"));
    EXPECT_FALSE(hasTruth());

    // The first place is zero where the recording tells so.
    writeRecord3d("[" + none + ", [0, 0, 0, 1, 0.1, 0, 0], [0, 0, 0, 1, 0.2, 0, 0]]");
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("poses of 3 of 3 frames"));
}

TEST_F(ConvertPoses, posesOfRecord3dThatAreNoneAreNamed)
{
    writeRecord3d("[[0, 0, 0, 1, 1, 2, 3], [0, 0, 0, 1, 1, 2]]");
    expectRefused("/metadata.json: the pose of frame 1 is not a list of 7 numbers");
    writeRecord3d("{}");
    expectRefused("/metadata.json: 'poses' is not a list");
    writeRecord3d("[[0, 0, 0, 0, 1, 2, 3], [0, 0, 0, 1, 4, 5, 6]]");  // no quaternion
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("poses of 1 of 3 frames"));
}

/** The recorder has turned ARKit's axes already. Lines need not be in order. */
TEST_F(ConvertPoses, strayScannersCameraLooksAlongZ)
{
    writeStray(
        kStrayHeader +
        "7.7, 000002, 4, 5, 6, 0, 0.70710678, 0, 0.70710678\n"
        "7.5, 000000, 1, 2, 3, 0, 0, 0, 1\n"
        "7.6, 000001, nan, nan, nan, nan, nan, nan, nan\n"
        "7.8, 000003, 7, 8, 9, 0, 0, 0, 1\n");
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("poses of 2 of 3 frames"));
    const Trajectory found = truth();
    ASSERT_EQ(found.size(), 2U);
    EXPECT_NEAR(found.stamps[0], 7.5, 1e-6);
    EXPECT_NEAR(found.stamps[1], 7.7, 1e-6);
    const Eigen::Vector3d forward(0, 0, 1);
    EXPECT_TRUE((found.poses[0] * forward).isApprox(Eigen::Vector3d(1, 2, 4), 1e-6));
    EXPECT_TRUE((found.poses[1] * forward).isApprox(Eigen::Vector3d(5, 5, 6), 1e-6));
}

/** The pose is that of the frame's number, also where the images before it are not there. */
TEST_F(ConvertPoses, framesOfAVideoHaveThePoseOfTheirNumber)
{
    writeStray(
        kStrayHeader +
        "7.5, 000000, 1, 0, 0, 0, 0, 0, 1, 60, 60, 31.5, 23.5\n"
        "7.6, 000001, 2, 0, 0, 0, 0, 0, 1, 60, 60, 31.5, 23.5\n"
        "7.7, 000002, 3, 0, 0, 0, 0, 0, 1, 60, 60, 31.5, 23.5\n");
    std::filesystem::remove_all(dir_ / "in/rgb");
    std::filesystem::remove(dir_ / "in/depth/000000.png");
    // OpenCV's own encoder is always there; what is in a file counts, not its name.
    cv::VideoWriter video(
        dir_ / "in/rgb.avi",
        cv::CAP_OPENCV_MJPEG,
        cv::VideoWriter::fourcc('M', 'J', 'P', 'G'),
        60,
        {64, 48});
    for (int i = 0; i < 3; ++i)
    {
        video.write(colourImage(i));
    }
    video.release();
    std::filesystem::rename(dir_ / "in/rgb.avi", dir_ / "in/rgb.mp4");
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("poses of 2 of 2 frames"));
    const Trajectory found = truth();
    ASSERT_EQ(found.size(), 2U);
    EXPECT_NEAR(found.stamps[0], 7.6, 1e-6);
    EXPECT_NEAR(found.poses[0].translation().x(), 2, 1e-9);
}

TEST_F(ConvertPoses, linesOfStrayScannerThatAreNoneAreNamed)
{
    const std::string first = kStrayHeader + "7.5, 000000, 1, 2, 3, 0, 0, 0, 1\n";
    writeStray(first + "7.6, 000001, one, 2, 3, 0, 0, 0, 1\n");
    expectRefused("/odometry.csv:3: 'one' is not a number");
    writeStray(first + "7.6, 000001, 1, 2, 3\n7.7, 000002, 1, 2, 3, 0, 0, 0, 1\n");
    expectRefused("/odometry.csv:3: has 5 columns, not 9 as the first line");
    // A phone that ran out of power: the last line is cut off.
    writeStray(first + "7.6, 000001, 4, 5, 6, 0, 0, 0, 1\n7.7, 0000");
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("poses of 2 of 2 frames"));
}

/** The third number is that of the depth image, from 1; files are numbered from 0 or from 1. */
TEST_F(ConvertPoses, aTrajectoryOfRedwoodTellsTheNumberOfTheImage)
{
    for (const int first : {0, 1})
    {
        std::filesystem::remove_all(dir_ / "in");
        writeOpen3d(first);
        write(
            "in/trajectory.log",
            "# of Open3D\n" + logItem(0, 1, 0.5) + "\n" + logItem(2, 3, 2.5) + logItem(3, 4, 3.5));
        ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
        EXPECT_THAT(text_, HasSubstr("poses of 2 of 3 frames"));
        const Trajectory found = truth();
        ASSERT_EQ(found.size(), 2U);
        EXPECT_TRUE(found.poses[0].translation().isApprox(Eigen::Vector3d(0.5, 2, 3), 1e-6));
        EXPECT_TRUE(found.poses[1].translation().isApprox(Eigen::Vector3d(2.5, 2, 3), 1e-6));
        EXPECT_NEAR(found.stamps[1] - found.stamps[0], 2. / 30, 1e-6);
    }
}

TEST_F(ConvertPoses, aTrajectoryMayHaveTheNameOfItsScene)
{
    const std::string items = logItem(0, 1, 0.5) + logItem(1, 2, 1.5);
    for (const std::string name : {"lounge_trajectory.log", "livingroom1-traj.txt"})
    {
        std::filesystem::remove_all(dir_ / "in");
        writeOpen3d(1);
        write("in/recorder.log", "started\n");
        write("in/pairs.log", "0 1 3\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");  // of fragments
        write("in/" + name, items);
        ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
        EXPECT_THAT(text_, HasSubstr("poses of 2 of 3 frames")) << name;
    }
    std::filesystem::remove(dir_ / "out.groundtruth.txt");
    write("in/other.log", items);
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    EXPECT_THAT(
        text_,
        HasSubstr("has several trajectories, livingroom1-traj.txt and other.log, so none is ground "
                  "truth; name one trajectory.log\n"));
    EXPECT_FALSE(hasTruth());
    write("in/trajectory.log", items);
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    EXPECT_TRUE(hasTruth());
    EXPECT_THAT(text_, Not(HasSubstr("several")));
}

TEST_F(ConvertPoses, linesOfATrajectoryThatAreNoneAreNamed)
{
    writeOpen3d(0);
    write("in/trajectory.log", logItem(0, 1, 0.5) + "1 1 2\n1 0 0 0\n0 1 zero 0\n");
    expectRefused("/trajectory.log:8: 'zero' is not a number");
    write("in/trajectory.log", logItem(0, 1, 0.5) + "1 1 2\n1 0 0\n");
    expectRefused("/trajectory.log:7: has 3 numbers, where a row of a matrix has 4");
    write("in/trajectory.log", logItem(0, 1, 0.5) + "1 1\n");
    expectRefused("/trajectory.log:6: has 2 numbers, where those of a frame are 3");
    write("in/trajectory.log", logItem(0, 1, 0.5) + "1 1 2\n1 0 0 0\n");
    expectRefused("/trajectory.log:7: ends within a matrix");
    // Where tracking was lost.
    write(
        "in/trajectory.log",
        logItem(0, 1, 0.5) + "1 1 2\nnan nan nan nan\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("poses of 1 of 3 frames"));
}

/** Its file has the markers on the camera, in other axes. By hand: 1.0593 is a scale that the
 * published rotation has, and no part of a pose. */
TEST_F(ConvertPoses, bonnsMarkersAreNotTheCamera)
{
    writeBonn();
    write("rgbd_bonn_x/groundtruth.txt", "# stamp\n1548266470.4 1 2 3 0 0 0 1\n");
    ASSERT_EQ(run({"folder", dir_ / "rgbd_bonn_x"}), kExitOk) << text_;
    EXPECT_THAT(
        text_,
        HasSubstr("rgbd_bonn_x/groundtruth.txt: poses of the markers, moved to the camera\n"));
    const Trajectory found = truth();
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NEAR(found.stamps[0], 1548266470.4, 1e-6);
    EXPECT_TRUE(
        found.poses[0].translation().isApprox(Eigen::Vector3d(-0.9887, 2.9902, 2.0111), 1e-6));
    EXPECT_TRUE(found.poses[0].linear().col(2).isApprox(
        Eigen::Vector3d(-0.2389, -0.6413, -0.8085) / 1.0593, 1e-3));
    EXPECT_NEAR(found.poses[0].linear().determinant(), 1, 1e-9);

    // The same, where its lists are read.
    write("rgbd_bonn_x/rgb.txt", "1548266470.5 rgb/1548266470.5.png\n");
    write("rgbd_bonn_x/depth.txt", "1548266470.5 depth/1548266470.5.png\n");
    write("rgbd_bonn_x/camera.txt", "543 543 316 238 0 0 0 0 0 640 480 5000\n");
    ASSERT_EQ(run({"tum", dir_ / "rgbd_bonn_x"}), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("moved to the camera\n"));
    EXPECT_TRUE(truth().poses.at(0).isApprox(found.poses[0], 1e-9));
}

/** As `tum` reads it. */
TEST_F(ConvertPoses, groundTruthBesideStampedImagesIsCopied)
{
    for (int i = 0; i < 3; ++i)
    {
        const std::string name = std::to_string(1548266470 + i) + ".5.png";
        writeImage("in/rgb/" + name, colourImage(i));
        writeImage("in/depth/" + name, depthImage(i));
    }
    write("in/camera.txt", "60 60 31.5 23.5 0 0 0 0 0 64 48 1000\n");
    const std::string poses = "# truth\n1548266470.4 1 2 3 0 0 0 1\n";
    write("in/groundtruth.txt", poses);
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    EXPECT_THAT(test::readBytes(dir_ / "out.groundtruth.txt"), HasSubstr(poses));
    write("in/groundtruth.txt", "# truth\n");
    std::filesystem::remove(dir_ / "out.groundtruth.txt");
    ASSERT_EQ(run({"folder", in_}), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("has no poses, so no ground truth is written"));
    EXPECT_FALSE(hasTruth());
}

TEST_F(ConvertPoses, malformedGroundTruthOfBonnIsNamed)
{
    writeBonn();
    write("rgbd_bonn_x/groundtruth.txt", "1548266470.4 1 2 3 0 0 0 1\n1548266470.5 1 2\n");
    EXPECT_EQ(run({"folder", dir_ / "rgbd_bonn_x"}), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr("rgbd_bonn_x/groundtruth.txt:2: 3 columns"));
}
}  // namespace pointplane
