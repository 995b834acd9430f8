// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/mrpt_io/RawlogWriter.h>
#include <pointplane/sensor/PinholeCamera.h>

#include <mrpt/core/Clock.h>

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace pointplane
{
/** A depth camera that is not registered to the colour camera. */
struct DepthCamera
{
    PinholeCamera camera;
    Eigen::Isometry3d T_depth_colour{Eigen::Isometry3d::Identity()};  //!< optical axes
};

/** A depth image, and the colour image that goes with it. */
struct RegisteredScan
{
    mrpt::Clock::time_point stamp;
    PinholeCamera camera;
    std::optional<DepthCamera> depthCamera;  //!< nothing: depth is registered
    cv::Mat colour;  //!< CV_8UC3 BGR, or CV_8UC1, of the camera's size; empty: depth alone
    cv::Mat depth;   //!< CV_16UC1 along the optical axis, of its camera's size; 0 = none
    double unitsPerMetre{5000};  //!< of depth
    std::string colourFile;      //!< what colour was read from; copied where images are external
};

class ImagesFolder;

/** Writes images to a rawlog as CObservation3DRangeScan, pixels and readings unchanged.
 * Axes are MRPT's, sensorPose is the identity. Complete and partial files are as RawlogWriter says.
 * All members throw EnvironmentError naming the file that cannot be written. */
class ScanWriter
{
 public:
    /** \param label sensorLabel of all scans
     * \param external images as files in imagesFolderOf(path), which is partialFolderOf() that
     * until close() */
    ScanWriter(const std::string& path, std::string label, bool external);
    ~ScanWriter();
    ScanWriter(const ScanWriter&) = delete;
    ScanWriter& operator=(const ScanWriter&) = delete;

    void writeComment(mrpt::Clock::time_point stamp, const std::string& text);
    /** \throws std::invalid_argument for images that are not as RegisteredScan says */
    void write(const RegisteredScan& scan);
    void close();
    /** Removes the partial rawlog and its images. */
    void discard() noexcept;

 private:
    /** How the names of a frame's files begin: frames may share a stamp. */
    [[nodiscard]] std::string imageName(mrpt::Clock::time_point stamp);

    RawlogWriter writer_;
    std::string label_;
    std::unique_ptr<ImagesFolder> images_;  //!< none: embedded
    std::map<std::string, int> numOfStamp_;
};

/** A 16 bit reading that is none, as 0: farther than its units reach. */
constexpr std::uint16_t kSaturatedDepth = 65535;

/** Fewest and most units per metre: metres, micrometres. */
constexpr double kLeastDepthUnits = 1, kMostDepthUnits = 1e6;

/** \return why no camera's depth has so many units per metre, or empty: 16 bits of them would show
 * nothing or span less than a hand, and floats cannot hold what is far beyond that */
[[nodiscard]] std::string problemOfDepthUnits(double unitsPerMetre);

/** Depth as 16 bit readings (CV_16UC1, 0 = none). \param depth CV_32FC1 [m], NaN = none; what is
 * farther than 16 bits reach becomes none */
[[nodiscard]] cv::Mat depthInUnits(const cv::Mat& depth, double unitsPerMetre);
}  // namespace pointplane
