// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/grabber/RgbdCalibration.h>
#include <pointplane/mrpt_io/errors.h>

#include <mrpt/core/bits_math.h>

#include "TempDir.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace
{
using namespace pointplane;
using pointplane::test::TempDir;
using pointplane::test::writeBytes;

const std::string kIni = R"(
[OPENNI2]
sensorLabel = FRONT
pose_x = 0.1
pose_z = 1.2
pose_pitch = 10  // degrees

[OPENNI2_LEFT]
rawlog-grabber-ignore = true
resolution = [640 488]
cx = 314.6
cy = 240.2
fx = 572.9
fy = 542.7
dist = [-4.7e-03 -4.4e-03 0 0 0]

[OPENNI2_RIGHT]
resolution = [640 480]
cx = 322.5
cy = 259.1
fx = 521.2
fy = 493.0
dist = [5.9e-02 3.9e-02 0 0 0]

[OPENNI2_LEFT2RIGHT_POSE]
pose_quaternion = [0.025575 -0.000609 -0.001462 1 0 0 0]
)";

/** Of camera-calib. */
const std::string kYaml = R"(%YAML 1.2
---
camera_name: camera
camera_matrix:
  rows: 3
  cols: 3
  data: [521.2, 0, 322.5, 0, 521.0, 239.1, 0, 0, 1]
distortion_coefficients:
  rows: 1
  cols: 5
  data: [0.059, 0.039, 0, 0, 0]
distortion_model: plumb_bob
focal_length: 0
image_height: 480
image_width: 640
)";

CameraFacts facts(bool registered)
{
    CameraFacts f;
    f.registered = registered;
    f.depthFocal_px = 575.0;
    f.colourFocal_px = 525.0;
    f.colourOffset = 0.025;
    return f;
}

class CalibrationFile : public ::testing::Test
{
 protected:
    std::string write(std::string text, const std::string& from = "", const std::string& to = "")
    {
        if (!from.empty())
        {
            text.replace(text.find(from), from.size(), to);
        }
        writeBytes(path_, text);
        return path_;
    }
    void expectRejected(const std::string& from, const std::string& to, const std::string& words)
    {
        try
        {
            (void)calibrationFromFile(write(kIni, from, to), "OPENNI2", facts(false));
            FAIL() << "accepted " << to;
        }
        catch (const InputError& e)
        {
            EXPECT_THAT(e.what(), ::testing::HasSubstr(words));
            EXPECT_THAT(e.what(), ::testing::HasSubstr(path_));
        }
    }

    TempDir dir_;
    std::string path_{dir_ / "camera.ini"};
};

/** In .oni files, whose modes nobody chose. */
TEST_F(CalibrationFile, colourMayHaveAnotherSizeThanDepth)
{
    CameraFacts f = facts(false);
    f.colourMode = {320, 240, 30, ""};
    f.colourFocal_px = 262.5;
    for (const bool isNominal : {true, false})
    {
        const auto c =
            isNominal ? nominalCalibration(f) : calibrationFromFile(write(kIni), "OPENNI2", f);
        EXPECT_EQ(c.depth.ncols, 640U);
        EXPECT_EQ(c.colour.ncols, 320U);
        EXPECT_EQ(c.colour.nrows, 240U);
        EXPECT_NEAR(c.colour.fx(), isNominal ? 262.5 : 260.6, 1e-9);
    }
}

TEST_F(CalibrationFile, unregisteredDepthHasItsOwnCamera)
{
    const auto c = calibrationFromFile(write(kIni), "OPENNI2", facts(false));
    EXPECT_EQ(c.depth.fx(), 572.9);
    EXPECT_EQ(c.depth.nrows, 480U);
    EXPECT_EQ(c.colour.fx(), 521.2);
    EXPECT_NEAR(c.colour.dist[0], 0.059, 1e-12);
    EXPECT_EQ(c.sensorLabel, "FRONT");
    EXPECT_NEAR(c.sensorPose.pitch(), mrpt::DEG2RAD(10.0), 1e-12);
    // Right in the image (optical x) is -y in MRPT's depth frame.
    EXPECT_NEAR(c.colourWrtDepth.y(), -0.025575, 1e-9);
    EXPECT_NEAR(c.colourWrtDepth.yaw(), mrpt::DEG2RAD(-90.0), 1e-9);
    EXPECT_NEAR(c.colourWrtDepth.roll(), mrpt::DEG2RAD(-90.0), 1e-9);
}

TEST_F(CalibrationFile, registeredDepthLiesInTheColourCamera)
{
    const auto c = calibrationFromFile(write(kIni), "OPENNI2", facts(true));
    EXPECT_EQ(c.depth.fx(), 521.2);
    EXPECT_EQ(c.depth.dist[0], 0.0);  // at undistorted pixels
    EXPECT_EQ(c.colourWrtDepth.norm(), 0.0);
}

TEST_F(CalibrationFile, registeredDepthNeedsTheColourCameraAlone)
{
    const size_t begin = kIni.find("[OPENNI2_RIGHT]"), end = kIni.find("[OPENNI2_LEFT2RIGHT_POSE]");
    writeBytes(path_, kIni.substr(begin, end - begin));
    const auto c = calibrationFromFile(path_, "OPENNI2", facts(true));
    EXPECT_EQ(c.depth.fx(), 521.2);
    EXPECT_NEAR(c.colour.dist[0], 0.059, 1e-12);
    EXPECT_THAT(c.source, ::testing::HasSubstr("section [OPENNI2_RIGHT]"));
    EXPECT_THROW((void)calibrationFromFile(path_, "OPENNI2", facts(false)), InputError);
}

TEST_F(CalibrationFile, yamlOfCameraCalibTellsTheColourCamera)
{
    path_ = dir_ / "calibration.yml";
    auto f = facts(true);
    f.mode = {320, 240, 30, ""};
    const auto c = calibrationFromFile(write(kYaml), "OPENNI2", f);
    EXPECT_NEAR(c.colour.fx(), 260.6, 1e-9);
    EXPECT_NEAR(c.colour.dist[1], 0.039, 1e-12);
    EXPECT_EQ(c.depth.fx(), c.colour.fx());
    EXPECT_EQ(c.depth.dist[0], 0.0);
    EXPECT_FALSE(c.isNominal);

    EXPECT_THROW((void)calibrationFromFile(path_, "OPENNI2", facts(false)), InputError);
    for (const auto& [from, to] :
         {std::pair("521.2", "abc"),
          std::pair("521.2", "-5"),
          std::pair("camera_matrix:", "K:"),
          std::pair("image_height: 480", "image_height: 400")})
    {
        try
        {
            (void)calibrationFromFile(write(kYaml, from, to), "OPENNI2", f);
            ADD_FAILURE() << "accepted " << to;
        }
        catch (const InputError& e)
        {
            EXPECT_THAT(e.what(), ::testing::StartsWith(path_));
            EXPECT_THAT(e.what(), ::testing::Not(::testing::HasSubstr("\n")));
        }
    }
}

/** Depth alone is never registered: it has the infrared camera's intrinsics. */
TEST_F(CalibrationFile, yamlOfTheColourCameraIsNotForDepthAlone)
{
    path_ = dir_ / "calibration.yml";
    auto f = facts(false);
    f.hasColour = false;
    try
    {
        (void)calibrationFromFile(write(kYaml), "OPENNI2", f);
        FAIL() << "accepted";
    }
    catch (const InputError& e)
    {
        EXPECT_THAT(e.what(), ::testing::StartsWith(path_));
        EXPECT_THAT(e.what(), ::testing::HasSubstr("--depth-only needs the depth camera's"));
    }
    path_ = dir_ / "camera.ini";
    EXPECT_EQ(calibrationFromFile(write(kIni), "OPENNI2", f).depth.fx(), 572.9);
}

TEST_F(CalibrationFile, scalesToTheMode)
{
    auto f = facts(false);
    f.mode = f.colourMode = {320, 240, 30, ""};
    const auto c = calibrationFromFile(
        write(kIni, "resolution = [640 488]", "resolution = [640 480]"), "OPENNI2", f);
    EXPECT_NEAR(c.colour.fx(), 260.6, 1e-9);
    EXPECT_EQ(c.colour.ncols, 320U);
}

TEST_F(CalibrationFile, errorsNameFileSectionAndKey)
{
    expectRejected("fx = 572.9", "fz = 1", "[OPENNI2_LEFT] has no key 'fx'");
    expectRejected("[OPENNI2_RIGHT]", "[OTHER_RIGHT]", "[OPENNI2_RIGHT] has no key 'resolution'");
    expectRejected("fx = 521.2", "fx = abc", "[OPENNI2_RIGHT]: fx = 'abc': 'abc' is not a number");
    expectRejected("fx = 521.2", "fx = -5", "[OPENNI2_RIGHT]: focal length is negative");
    expectRejected("cx = 322.5", "cx = 0", "[OPENNI2_RIGHT]: principal point is outside");
    expectRejected(
        "fx = 572.9", "fx = 572.9\nfx = 5", ":14: key 'fx' appears twice in [OPENNI2_LEFT]");
    expectRejected("-0.001462 1 0 0 0]", "-0.001462 1 0 0]", "is not 7 numbers");
    expectRejected("-0.001462 1 0 0 0]", "-0.001462 0 0 0 0]", "a quaternion of length 1");
    expectRejected("pose_z = 1.2", "pose_z = 1,2", "[OPENNI2]: pose_z = '1,2' is not one number");
    expectRejected("resolution = [640 480]", "resolution = [640 400]", "does not fit");
    expectRejected("pose_quaternion", "pose", "has no key 'pose_quaternion'");
    expectRejected("fx = 572.9", "fx = $eval{572.9", "Expected closing `}`");
    EXPECT_THROW(
        (void)calibrationFromFile(dir_ / "missing.ini", "OPENNI2", facts(true)), InputError);
}

TEST(NominalCalibration, comesFromTheFieldOfViewAndSaysSo)
{
    const auto registered = nominalCalibration(facts(true));
    EXPECT_EQ(registered.depth.fx(), 525.0);
    EXPECT_EQ(registered.depth.cx(), 319.5);
    EXPECT_THAT(registered.source, ::testing::HasSubstr("field of view"));

    const auto separate = nominalCalibration(facts(false));
    EXPECT_EQ(separate.depth.fx(), 575.0);
    EXPECT_EQ(separate.colour.fx(), 525.0);
    EXPECT_NEAR(separate.colourWrtDepth.y(), -0.025, 1e-12);

    CameraFacts silent;
    silent.registered = true;
    EXPECT_EQ(nominalCalibration(silent).colour.fx(), 525.0);
    EXPECT_THAT(nominalCalibration(silent).source, ::testing::HasSubstr("typical Kinect"));
}
}  // namespace
