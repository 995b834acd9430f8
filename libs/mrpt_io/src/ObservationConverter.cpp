// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/ObservationConverter.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/external_range.h>
#include <pointplane/mrpt_io/image_file.h>
#include <pointplane/mrpt_io/mrpt_camera.h>
#include <pointplane/mrpt_io/mrpt_poses.h>

#include <mrpt/img/CImage.h>

#include <opencv2/imgcodecs.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "DepthRegistration.h"
#include "cameraText.h"
#include "scan_images.h"

namespace pointplane
{
namespace
{
using mrpt::obs::CObservation3DRangeScan;

[[nodiscard]] std::string sizeText(int width, int height)
{
    return std::to_string(width) + "x" + std::to_string(height);
}

[[nodiscard]] PinholeCamera cameraOf(const mrpt::img::TCamera& from, const std::string& name)
{
    const PinholeCamera camera = fromMrpt(from);
    const bool isRational =
        from.distortion == mrpt::img::DistortionModel::plumb_bob &&
        std::any_of(from.dist.begin() + 5, from.dist.end(), [](double k) { return k != 0; });
    requireUsable(!isRational, name + ": distortion k4 to k6 is not supported");
    requireUsable(
        from.distortion != mrpt::img::DistortionModel::kannala_brandt,
        name + ": fisheye distortion is not supported");
    requireUsable(camera.problem().empty(), name + ": " + camera.problem());
    return camera;
}

void requirePose(const Eigen::Isometry3d& T, const std::string& name)
{
    const std::string problem = problemOfPose(T, name);
    requireUsable(problem.empty(), problem);
}

[[nodiscard]] bool sameProjection(const PinholeCamera& a, const PinholeCamera& b)
{
    const auto near = [](double x, double y) { return std::abs(x - y) < 1e-6; };
    return a.width == b.width && a.height == b.height && near(a.fx, b.fx) && near(a.fy, b.fy) &&
           near(a.cx, b.cx) && near(a.cy, b.cy);
}
}  // namespace

struct ObservationConverter::Impl
{
    struct ColourCamera
    {
        PinholeCamera camera;
        Eigen::Isometry3d T_body_cam;  //!< on the depth camera's body
    };

    [[nodiscard]] std::string resolved(const std::string& name) const
    {
        const std::string folder =
            externals.empty() ? mrpt::img::CImage::getImagesPathBase() + "/" : externals;
        return name.empty() || name.front() == '/' ? name : folder + name;
    }
    [[nodiscard]] static ColourCamera colourCameraOf(const CObservation3DRangeScan& scan);
    [[nodiscard]] cv::Mat intensityOf(
        const CObservation3DRangeScan& scan, const PinholeCamera& camera) const;
    [[nodiscard]] cv::Mat depthOf(
        const CObservation3DRangeScan& scan, const PinholeCamera& camera) const;
    [[nodiscard]] const DepthRegistration& registration(
        const PinholeCamera& source,
        const PinholeCamera& target,
        const Eigen::Isometry3d& T_target_source) const;
    void fill(const CObservation3DRangeScan& scan, ConvertedFrame& out) const;
    [[nodiscard]] cv::Mat depthSeenBy(
        const ColourCamera& colour, const PinholeCamera& depthCamera, const cv::Mat& depth) const;

    std::string externals;
    std::map<std::string, CameraComment> told;                  // by label
    mutable std::map<std::string, int> grayBits;                // likewise; of 16 bit images so far
    mutable std::map<std::string, ColourCamera> colourCameras;  // likewise; of the latest image
    std::set<std::string> unknownKeys;

    // The latest registration: its ray table is the costly part.
    mutable std::optional<DepthRegistration> registrationCache;
    mutable PinholeCamera cachedSource, cachedTarget;
    mutable Eigen::Isometry3d cachedTransform{Eigen::Isometry3d::Identity()};
};

ObservationConverter::Impl::ColourCamera ObservationConverter::Impl::colourCameraOf(
    const CObservation3DRangeScan& scan)
{
    const PinholeCamera camera = cameraOf(scan.cameraParamsIntensity, "cameraParamsIntensity");
    const Eigen::Isometry3d T_body_cam = fromMrpt(scan.relativePoseIntensityWRTDepth);
    requirePose(T_body_cam, "relativePoseIntensityWRTDepth");
    requireUsable(
        !T_body_cam.linear().isIdentity(1e-3),
        "relativePoseIntensityWRTDepth has no rotation, so the colour camera looks up; where it "
        "coincides with the depth camera, it is 0 0 0 -90 0 -90 deg");
    return {camera, T_body_cam};
}

cv::Mat ObservationConverter::Impl::intensityOf(
    const CObservation3DRangeScan& scan, const PinholeCamera& camera) const
{
    const mrpt::img::CImage& image = scan.intensityImage;
    const bool isExternal = image.isExternallyStored();
    requireUsable(isExternal || !image.isEmpty(), "intensity image is empty");
    int& bits = grayBits.try_emplace(scan.sensorLabel, kFewestBits).first->second;
    const cv::Mat gray = grayOf(
        isExternal ? readImageFile(
                         resolved(image.getExternalStorageFile()),
                         cv::IMREAD_ANYCOLOR | cv::IMREAD_ANYDEPTH)
                   : image.asCvMatRef(),
        bits);
    requireUsable(
        gray.cols == camera.width && gray.rows == camera.height,
        "intensity image is " + sizeText(gray.cols, gray.rows) +
            " but cameraParamsIntensity is for " + sizeText(camera.width, camera.height));
    return gray;
}

cv::Mat ObservationConverter::Impl::depthOf(
    const CObservation3DRangeScan& scan, const PinholeCamera& camera) const
{
    requireUsable(
        std::isfinite(scan.rangeUnits) && scan.rangeUnits > 0,
        "rangeUnits is " + std::to_string(scan.rangeUnits) + ", not a positive number");
    cv::Mat depth;
    if (scan.rangeImage_isExternallyStored() && scan.rangeImage.size() == 0)
    {
        depth = depthInMetres(
            readExternalRange(resolved(scan.rangeImage_getExternalStorageFile(""))),
            scan.rangeUnits);
    }
    else
    {
        requireUsable(scan.rangeImage.size() != 0, "range image is empty");
        depth = depthInMetres(scan.rangeImage, scan.rangeUnits);
    }
    requireUsable(
        depth.cols == camera.width && depth.rows == camera.height,
        "range image is " + sizeText(depth.cols, depth.rows) + " but cameraParams is for " +
            sizeText(camera.width, camera.height));
    if (!scan.range_is_depth)
    {
        rangesToDepths(camera, depth);
    }
    return depth;
}

const DepthRegistration& ObservationConverter::Impl::registration(
    const PinholeCamera& source,
    const PinholeCamera& target,
    const Eigen::Isometry3d& T_target_source) const
{
    const bool hit = registrationCache && sameProjection(source, cachedSource) &&
                     source.distortion == cachedSource.distortion &&
                     sameProjection(target, cachedTarget) &&
                     T_target_source.isApprox(cachedTransform, 1e-12);
    if (!hit)
    {
        registrationCache.emplace(source, target, T_target_source);
        cachedSource = source;
        cachedTarget = target;
        cachedTransform = T_target_source;
    }
    return *registrationCache;
}

void ObservationConverter::Impl::fill(
    const CObservation3DRangeScan& scan, ConvertedFrame& out) const
{
    requireUsable(
        scan.timestamp != INVALID_TIMESTAMP,
        "has no time stamp (MRPT's INVALID_TIMESTAMP); the program that recorded it must set it");
    requireUsable(
        scan.hasRangeImage || (scan.hasIntensityImage && !scan.hasPoints3D),
        std::string("observation has no range image") +
            (scan.hasPoints3D ? ", and 3D points cannot replace it: record it, too (grab_depth = "
                                "true for MRPT's rawlog-grabber)"
                              : ""));
    const Eigen::Isometry3d T_robot_body = fromMrpt(scan.sensorPose);
    requirePose(T_robot_body, "sensorPose");
    PinholeCamera depthCamera;
    cv::Mat depth;
    if (scan.hasRangeImage)
    {
        depthCamera = cameraOf(scan.cameraParams, "cameraParams");
        depth = depthOf(scan, depthCamera);
    }
    if (scan.hasIntensityImage)
    {
        const ColourCamera colour = colourCameraOf(scan);
        out.frame.gray = intensityOf(scan, colour.camera);
        colourCameras.insert_or_assign(scan.sensorLabel, colour);
    }
    // A scan without colour is of the colour camera, too, if there was one.
    if (const auto colour = colourCameras.find(scan.sensorLabel); colour != colourCameras.end())
    {
        out.frame.camera = colour->second.camera;
        out.frame.depth = depthSeenBy(colour->second, depthCamera, depth);
        out.T_robot_cam = T_robot_body * colour->second.T_body_cam;
        return;
    }
    out.frame.camera = depthCamera;
    out.frame.depth =
        depthCamera.isDistorted()
            ? registration(depthCamera, depthCamera, Eigen::Isometry3d::Identity()).render(depth)
            : depth;
    out.T_robot_cam = T_robot_body * opticalInBody();
}

/** Depth is rendered into the colour camera, unless it is registered to it. \param depth may be
 * empty */
cv::Mat ObservationConverter::Impl::depthSeenBy(
    const ColourCamera& colour, const PinholeCamera& depthCamera, const cv::Mat& depth) const
{
    const PinholeCamera& camera = colour.camera;
    if (depth.empty())
    {
        return {
            camera.height,
            camera.width,
            CV_32FC1,
            cv::Scalar(std::numeric_limits<float>::quiet_NaN())};
    }
    const Eigen::Isometry3d T_cam_depth = colour.T_body_cam.inverse() * opticalInBody();
    const bool registered = T_cam_depth.isApprox(Eigen::Isometry3d::Identity(), 1e-6) &&
                            sameProjection(depthCamera, camera) && !depthCamera.isDistorted();
    return registered ? depth : registration(depthCamera, camera, T_cam_depth).render(depth);
}

ObservationConverter::ObservationConverter() : impl_(std::make_unique<Impl>()) {}
ObservationConverter::~ObservationConverter() = default;
ObservationConverter::ObservationConverter(ObservationConverter&&) noexcept = default;
ObservationConverter& ObservationConverter::operator=(ObservationConverter&&) noexcept = default;

void ObservationConverter::setExternalsDirectory(const std::string& directory)
{
    impl_->externals = directory;
    if (!directory.empty() && directory.back() != '/')
    {
        impl_->externals += '/';
    }
}

std::string ObservationConverter::readComment(const mrpt::obs::CObservationComment& comment)
{
    const auto parsed = parseCameraComment(comment.text);
    if (!parsed)
    {
        return "";
    }
    impl_->told[parsed->label] = *parsed;
    impl_->unknownKeys.insert(parsed->unknownKeys.begin(), parsed->unknownKeys.end());
    return parsed->label;
}

const std::set<std::string>& ObservationConverter::unknownKeys() const
{
    return impl_->unknownKeys;
}

ConvertedFrame ObservationConverter::convert(const CObservation3DRangeScan& scan) const
{
    ConvertedFrame out;
    try
    {
        impl_->fill(scan, out);
        if (const auto it = impl_->told.find(scan.sensorLabel); it != impl_->told.end())
        {
            out.frame.shutter = it->second.shutter;
            out.frame.camera.isNominal = it->second.isNominal;
        }
    }
    catch (const std::exception& e)
    {
        if (isOutOfMemory(e))
        {
            throw;  // says nothing about the frame
        }
        out = ConvertedFrame();
        out.problem = oneLine(e);
    }
    out.frame.stamp = toSeconds(scan.timestamp);
    out.sensorLabel = scan.sensorLabel;
    return out;
}

void ObservationConverter::reset()
{
    auto anew = std::make_unique<Impl>();
    anew->externals = impl_->externals;
    impl_ = std::move(anew);
}

ConvertedFrame ofOneCamera(const ConvertedFrame& converted, std::optional<std::string>& label)
{
    label = label.value_or(converted.sensorLabel);
    if (converted.sensorLabel == *label)
    {
        return converted;
    }
    ConvertedFrame out;
    out.frame.stamp = std::numeric_limits<double>::quiet_NaN();
    out.problem = "is of camera '" + converted.sensorLabel + "', not of '" + *label +
                  "': each camera needs an object of its own";
    return out;
}
}  // namespace pointplane
