// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/grabber/RgbdCalibration.h>
#include <pointplane/mrpt_io/camera_ini.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/ini_file.h>
#include <pointplane/mrpt_io/mrpt_camera.h>

#include <mrpt/containers/yaml.h>
#include <mrpt/core/bits_math.h>
#include <mrpt/math/TPose3DQuat.h>
#include <mrpt/poses/CPose3DQuat.h>

#include <cmath>
#include <filesystem>
#include <vector>

namespace pointplane
{
namespace
{
// Of a Kinect or Xtion, when a driver does not state its field of view.
constexpr double kTypicalFocalPerWidth = 525.0 / 640.0;

/** Optical axes in CObservation3DRangeScan's depth frame (x forward, y left, z up). */
mrpt::poses::CPose3D opticalAxes()
{
    return {0, 0, 0, mrpt::DEG2RAD(-90.0), 0, mrpt::DEG2RAD(-90.0)};
}

mrpt::img::TCamera pinhole(const VideoMode& mode, double focal_px)
{
    mrpt::img::TCamera camera;
    camera.ncols = static_cast<std::uint32_t>(mode.width);
    camera.nrows = static_cast<std::uint32_t>(mode.height);
    const double f = focal_px > 0.0 ? focal_px : kTypicalFocalPerWidth * mode.width;
    camera.setIntrinsicParamsFromValues(f, f, 0.5 * (mode.width - 1), 0.5 * (mode.height - 1));
    return camera;
}

/** Registered depth has the mode of colour. */
const VideoMode& colourModeOf(const CameraFacts& facts)
{
    return facts.hasColour && !facts.registered ? facts.colourMode : facts.mode;
}

/** The driver has already moved depth into the colour camera's ideal pinhole. */
void makeRegistered(RgbdCalibration& calibration)
{
    calibration.depth = calibration.colour;
    calibration.depth.dist.fill(0);
    calibration.colourWrtDepth = opticalAxes();
}

/** Checks a camera and brings it to the resolution in use. */
void fitToMode(mrpt::img::TCamera& camera, const VideoMode& mode, const std::string& where)
{
    if (const std::string problem = fromMrpt(camera).problem(); !problem.empty())
    {
        throw InputError(where + ": " + problem);
    }
    const auto width = static_cast<unsigned>(mode.width);
    const auto height = static_cast<unsigned>(mode.height);
    // The Kinect's infrared image has eight lines more than its depth image.
    constexpr unsigned kInfraredLines = 488;
    if (camera.ncols == width && camera.nrows == kInfraredLines && height == 480)
    {
        camera.nrows = height;
    }
    if (camera.ncols * height != camera.nrows * width)
    {
        throw InputError(
            where + ": resolution " + std::to_string(camera.ncols) + "x" +
            std::to_string(camera.nrows) + " does not fit the camera's " + toString(mode));
    }
    camera.scaleToResolution(width, height);
}

/** Of both cameras, and where they are to each other. */
void readBoth(
    RgbdCalibration& calibration,
    const mrpt::config::CConfigFile& file,
    const std::string& path,
    const std::string& section)
{
    calibration.depth = cameraInIni(file, path, section + "_LEFT");
    const std::string poseSection = section + "_LEFT2RIGHT_POSE", key = "pose_quaternion";
    const std::vector<double> p = numbersInIni(file, path, poseSection, key, 7);
    constexpr double kRounding = 0.01;
    const double length = std::hypot(std::hypot(p[3], p[4]), std::hypot(p[5], p[6]));
    if (!(std::abs(length - 1) < kRounding))
    {
        throw InputError(
            path + ": section [" + poseSection + "]: " + key +
            " is not [x y z qr qx qy qz] with a quaternion of length 1");
    }
    calibration.colourWrtDepth =
        opticalAxes() + mrpt::poses::CPose3D(mrpt::poses::CPose3DQuat(
                            mrpt::math::TPose3DQuat(p[0], p[1], p[2], p[3], p[4], p[5], p[6])));
}

RgbdCalibration fromIni(
    const std::string& path, const std::string& section, const CameraFacts& facts)
{
    const auto ini = openIniFile(path);
    const mrpt::config::CConfigFile& file = *ini;
    RgbdCalibration calibration;
    calibration.source = "'" + path + "', section [" + section + "_RIGHT]";
    calibration.colour = cameraInIni(file, path, section + "_RIGHT");
    if (!facts.registered)
    {
        readBoth(calibration, file, path, section);
        calibration.source = "'" + path + "', sections [" + section + "_LEFT], [" + section +
                             "_RIGHT], [" + section + "_LEFT2RIGHT_POSE]";
    }
    fitToMode(calibration.colour, colourModeOf(facts), path + ": section [" + section + "_RIGHT]");
    if (facts.registered)
    {
        makeRegistered(calibration);
    }
    else
    {
        fitToMode(calibration.depth, facts.mode, path + ": section [" + section + "_LEFT]");
    }
    const auto number = [&](const char* key) { return numberInIni(file, path, section, key, 0.0); };
    calibration.sensorPose = mrpt::poses::CPose3D(
        number("pose_x"),
        number("pose_y"),
        number("pose_z"),
        mrpt::DEG2RAD(number("pose_yaw")),
        mrpt::DEG2RAD(number("pose_pitch")),
        mrpt::DEG2RAD(number("pose_roll")));
    calibration.sensorLabel = file.read_string(section, "sensorLabel", calibration.sensorLabel);
    return calibration;
}

/** What camera-calib writes: one camera. */
RgbdCalibration fromYaml(const std::string& path, const CameraFacts& facts)
{
    if (!facts.registered)
    {
        throw InputError(
            path +
            (facts.hasColour
                 ? ": tells one camera, but depth is not registered to colour, so both must be "
                   "known; use --registration on, or calibrate with kinect-stereo-calib (ini)"
                 : ": tells the colour camera, but --depth-only needs the depth camera's "
                   "intrinsics; calibrate with kinect-stereo-calib (ini)"));
    }
    RgbdCalibration calibration;
    try
    {
        calibration.colour = mrpt::img::TCamera::FromYAML(mrpt::containers::yaml::FromFile(path));
    }
    catch (const std::exception& e)
    {
        throw InputError(path + ": is not a calibration of camera-calib: " + oneLine(e));
    }
    fitToMode(calibration.colour, facts.mode, path);
    makeRegistered(calibration);
    calibration.source = "'" + path + "'";
    return calibration;
}
}  // namespace

RgbdCalibration nominalCalibration(const CameraFacts& facts)
{
    RgbdCalibration calibration;
    calibration.isNominal = true;
    calibration.depth = pinhole(facts.mode, facts.depthFocal_px);
    calibration.colour =
        facts.hasColour ? pinhole(colourModeOf(facts), facts.colourFocal_px) : calibration.depth;
    calibration.colourWrtDepth =
        opticalAxes() + mrpt::poses::CPose3D(facts.colourOffset, 0, 0, 0, 0, 0);
    if (facts.registered || !facts.hasColour)
    {
        makeRegistered(calibration);
    }
    const double focal_px = facts.registered ? facts.colourFocal_px : facts.depthFocal_px;
    calibration.source = focal_px > 0.0 ? "the driver's field of view, no distortion"
                                        : "a typical Kinect (the driver states no field of view)";
    if (!facts.registered && facts.hasColour)
    {
        calibration.source += ", colour camera 25 mm right of depth";
    }
    return calibration;
}

RgbdCalibration calibrationFromFile(
    const std::string& path, const std::string& section, const CameraFacts& facts)
{
    const std::string extension = std::filesystem::path(path).extension();
    return extension == ".yml" || extension == ".yaml" ? fromYaml(path, facts)
                                                       : fromIni(path, section, facts);
}
}  // namespace pointplane
