// SPDX-License-Identifier: BSD-3-Clause
#include "bag_cameras.h"

#include <pointplane/mrpt_io/errors.h>

#include <cmath>
#include <vector>

#include "StaticTransforms.h"
#include "calibration_file.h"
#include "ros_images.h"
#include <geometry_msgs/Transform.h>
#include <std_msgs/Float32.h>
#include <tf2_msgs/TFMessage.h>

namespace pointplane
{
namespace
{
using sensor_msgs::CameraInfo;

[[nodiscard]] Eigen::Isometry3d fromRos(const geometry_msgs::Transform& t)
{
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    out.linear() = Eigen::Quaterniond(t.rotation.w, t.rotation.x, t.rotation.y, t.rotation.z)
                       .normalized()
                       .toRotationMatrix();
    out.translation() << t.translation.x, t.translation.y, t.translation.z;
    return out;
}

/** By ROS's names: .../image_rect, image_rect_color, image_rect_raw, perhaps with a transport
 * behind it. Other words with "rect" in them, such as direct, tell nothing. */
[[nodiscard]] bool isRectified(std::string topic)
{
    for (const std::string transport : {"/compressed", "/compressedDepth"})
    {
        if (topic.size() > transport.size() &&
            topic.compare(topic.size() - transport.size(), transport.size(), transport) == 0)
        {
            topic.erase(topic.size() - transport.size());
        }
    }
    return topic.compare(topic.rfind('/') + 1, 10, "image_rect") == 0;
}

struct ToldCamera
{
    std::string topic;
    CameraInfo info;
};

[[nodiscard]] std::optional<ToldCamera> infoOf(const rosbag::Bag& bag, const ImageTopic& images)
{
    // .../camera_info beside the images; RealSense's recorder: .../Depth_0/info/camera_info.
    std::string base = images.name;
    std::vector<std::string> names;
    for (int up = 0; up < 2; ++up)
    {
        const auto slash = base.rfind('/');
        base = slash == std::string::npos ? "" : base.substr(0, slash);
        names.push_back(base + "/camera_info");
        names.push_back(base + "/info/camera_info");
    }
    std::optional<ToldCamera> out;
    for (const std::string& name : names)
    {
        forEachMessage<CameraInfo>(
            bag,
            name,
            [&](const CameraInfo& info)
            {
                out = ToldCamera{name, info};
                return false;
            });
        if (out)
        {
            break;
        }
    }
    return out;
}

[[nodiscard]] std::optional<PinholeCamera> toldCameraOf(
    const rosbag::Bag& bag, const ImageTopic& topic, const std::string& file)
{
    const auto told = infoOf(bag, topic);
    if (!told)
    {
        return {};
    }
    const PinholeCamera out = toCamera(told->info, isRectified(topic.name));
    if (const std::string problem = out.problem(); !problem.empty())
    {
        throw InputError(file + ": " + told->topic + ": " + problem);
    }
    return out;
}

/** Of a camera whose lens distortion is left out. \return empty: of no such */
[[nodiscard]] std::string noteOnDistortion(const rosbag::Bag& bag, const ImageTopic& topic)
{
    const auto told = infoOf(bag, topic);
    return told && hasInverseDistortion(told->info) && !isRectified(topic.name)
               ? told->topic + ": its distortion (" + told->info.distortion_model +
                     ") is left out; a calibration by --camera can have it"
               : "";
}

[[nodiscard]] PinholeCamera cameraOf(
    const rosbag::Bag& bag, const ImageTopic& topic, const std::string& file)
{
    if (const auto told = toldCameraOf(bag, topic, file))
    {
        return *told;
    }
    throw InputError(
        file + ": has no camera_info beside " + topic.name + "; give a calibration by --camera");
}

/** RealSense's recorder: points of the reference stream in this one's axes. */
[[nodiscard]] std::optional<Eigen::Isometry3d> extrinsicsOf(
    const rosbag::Bag& bag, const ImageTopic& topic)
{
    const auto image = topic.name.rfind("/image/data");
    std::optional<Eigen::Isometry3d> out;
    if (image != std::string::npos)
    {
        forEachMessage<geometry_msgs::Transform>(
            bag,
            topic.name.substr(0, image) + "/tf/0",
            [&](const geometry_msgs::Transform& t)
            {
                out = fromRos(t);
                return false;
            });
    }
    return out;
}

/** RealSense's recorder: units per metre of the depth images. */
[[nodiscard]] std::optional<double> recordedUnits(const rosbag::Bag& bag, const ImageTopic& depth)
{
    std::optional<double> out;
    const auto sensor = depth.name.find("/Depth_0/");
    if (sensor != std::string::npos)
    {
        forEachMessage<std_msgs::Float32>(
            bag,
            depth.name.substr(0, sensor) + "/option/Depth_Units/value",
            [&](const std_msgs::Float32& unit)
            {
                if (unit.data > 0)
                {
                    out = std::round(1e6 / static_cast<double>(unit.data)) * 1e-6;
                }
                return false;
            });
    }
    return out;
}

[[nodiscard]] StaticTransforms transformsOf(const rosbag::Bag& bag)
{
    StaticTransforms out;
    for (const char* topic : {"/tf_static", "tf_static", "/tf", "tf"})
    {
        forEachMessage<tf2_msgs::TFMessage>(
            bag,
            topic,
            [&](const tf2_msgs::TFMessage& message)
            {
                for (const auto& t : message.transforms)
                {
                    out.add(t.header.frame_id, t.child_frame_id, fromRos(t.transform));
                }
                return true;
            });
    }
    return out;
}

/** Takes points from the axes of colour to those of depth. \param[in,out] notes one more where the
 * bag does not tell: they are taken to be the same */
[[nodiscard]] Eigen::Isometry3d depthFromColour(
    const rosbag::Bag& bag,
    const ImageTopic& colour,
    const ImageTopic& depth,
    std::vector<std::string>& notes)
{
    const auto ofDepth = extrinsicsOf(bag, depth), ofColour = extrinsicsOf(bag, colour);
    if (ofDepth && ofColour)
    {
        return *ofDepth * ofColour->inverse();
    }
    const StaticTransforms transforms = transformsOf(bag);
    if (const auto T_depth_colour = transforms.between(depth.frame, colour.frame))
    {
        return *T_depth_colour;
    }
    std::string moving = transforms.movingAbove(depth.frame);
    moving = moving.empty() ? transforms.movingAbove(colour.frame) : moving;
    notes.push_back(
        "no transform between " + depth.frame + " and " + colour.frame +
        (moving.empty() ? "" : " that stays (that " + moving + " changes)") +
        ": the two cameras are taken to be in one place");
    return Eigen::Isometry3d::Identity();
}

/** Registered images do not need a calibration of their own: one that cannot be used is none. */
[[nodiscard]] std::optional<PinholeCamera> usableCameraOf(
    const rosbag::Bag& bag, const ImageTopic& topic)
{
    try
    {
        return toldCameraOf(bag, topic, "");
    }
    catch (const InputError&)
    {
        return {};
    }
}

/** Whether pixels of registered images cannot have these two, as they are of one camera. */
[[nodiscard]] bool areOfTwoCameras(const PinholeCamera& depth, const PinholeCamera& colour)
{
    constexpr double kMost = 0.01;  // of the focal length
    const PinholeCamera scaled = colour.scaled(static_cast<double>(depth.width) / colour.width);
    const double most = kMost * scaled.fx;
    return std::abs(depth.fx - scaled.fx) > most || std::abs(depth.fy - scaled.fy) > most ||
           std::abs(depth.cx - scaled.cx) > most || std::abs(depth.cy - scaled.cy) > most;
}
}  // namespace

BagCameras readBagCameras(
    const rosbag::Bag& bag,
    const ImageTopic& colour,
    const ImageTopic& depth,
    const BagOptions& options)
{
    BagCameras out;
    out.unitsPerMetre =
        options.depthScale > 0 ? options.depthScale : recordedUnits(bag, depth).value_or(1000);
    if (const std::string problem = problemOfDepthUnits(out.unitsPerMetre); !problem.empty())
    {
        throw InputError(
            options.file + ": depth units per metre: " + problem + "; give them by --depth-scale");
    }
    out.colour = options.camera.empty() ? cameraOf(bag, colour, options.file)
                                        : loadCalibration(options.camera, "").camera;
    if (options.camera.empty())
    {
        out.notes.push_back(noteOnDistortion(bag, colour));
    }
    const bool isOneFrame = colour.frame == depth.frame && !colour.frame.empty();
    if (isOneFrame ? !extrinsicsOf(bag, depth) : depth.isRegistered())
    {
        // The depth image may yet have another size.
        const auto own = options.camera.empty() ? usableCameraOf(bag, depth) : std::nullopt;
        if (own && areOfTwoCameras(*own, out.colour))
        {
            out.depth = DepthCamera{*own, Eigen::Isometry3d::Identity()};
            out.notes.emplace_back(
                "depth images have another calibration than colour images, so they are not "
                "registered; the two cameras are taken to be in one place");
        }
        return out;
    }
    const Eigen::Isometry3d T_depth_colour = depthFromColour(bag, colour, depth, out.notes);
    out.depth = DepthCamera{cameraOf(bag, depth, options.file), T_depth_colour};
    return out;
}
}  // namespace pointplane
