// SPDX-License-Identifier: BSD-3-Clause
// Any observations through the facade: ranges, units, cameras and poses as MRPT holds them.
#include <pointplane/mrpt_io/VisualOdometry.h>
#include <pointplane/mrpt_io/mrpt_poses.h>

#include "frame_records.h"
#include "fuzzing.h"

namespace
{
using namespace pointplane;
using fuzzing::ByteSource;
using fuzzing::CameraRecord;
using fuzzing::ScanRecord;

constexpr int kMaxScans = 6;

mrpt::img::TCamera cameraOf(const CameraRecord& record)
{
    mrpt::img::TCamera camera;
    camera.ncols = record.width;
    camera.nrows = record.height;
    camera.setIntrinsicParamsFromValues(record.fx, record.fy, record.cx, record.cy);
    std::memcpy(camera.dist.data(), record.distortion, sizeof(record.distortion));
    camera.distortion = static_cast<mrpt::img::DistortionModel>(record.model % 3);
    return camera;
}

mrpt::poses::CPose3D poseOf(const double (&p)[6])
{
    return mrpt::poses::CPose3D::FromXYZYawPitchRoll(p[0], p[1], p[2], p[3], p[4], p[5]);
}

mrpt::obs::CObservation3DRangeScan takeScan(ByteSource& bytes)
{
    const auto record = bytes.take<ScanRecord>();
    const auto is = [&record](ScanRecord::Flag flag) { return (record.flags & flag) != 0; };
    mrpt::obs::CObservation3DRangeScan scan;
    scan.timestamp = mrpt::Clock::time_point(mrpt::Clock::duration(record.stamp_100ns));
    scan.cameraParams = cameraOf(record.depthCamera);
    scan.cameraParamsIntensity = cameraOf(record.intensityCamera);
    scan.relativePoseIntensityWRTDepth = poseOf(record.intensityPose);
    scan.sensorPose = poseOf(record.sensorPose);
    scan.rangeUnits = record.rangeUnits;
    scan.range_is_depth = !is(ScanRecord::RangesAlongRays);
    scan.hasIntensityImage = is(ScanRecord::HasIntensity);
    if (scan.hasIntensityImage && record.intensityWidth > 0 && record.intensityHeight > 0)
    {
        scan.intensityImage = mrpt::img::CImage(
            bytes.takeImage(
                record.intensityHeight,
                record.intensityWidth,
                is(ScanRecord::IsColour) ? CV_8UC3 : CV_8UC1),
            mrpt::img::DEEP_COPY);
    }
    scan.hasRangeImage = is(ScanRecord::HasRange);
    if (scan.hasRangeImage)
    {
        const cv::Mat ranges = bytes.takeImage(record.rangeHeight, record.rangeWidth, CV_16UC1);
        scan.rangeImage.setSize(ranges.rows, ranges.cols);
        if (!ranges.empty())
        {
            std::memcpy(scan.rangeImage.data(), ranges.data, ranges.total() * ranges.elemSize());
        }
    }
    return scan;
}

void requireSound(const mrpt::poses::CPose3DPDFGaussian& pdf)
{
    fuzzing::require(fromMrpt(pdf.mean).matrix().allFinite(), "a finite pose");
    fuzzing::require(isPositiveDefinite(pdf.cov.asEigen()), "a positive definite covariance");
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    ByteSource bytes(data, size);
    VisualOdometry odometry;
    odometry.logging_enable_console_output = false;
    for (int i = 0; i < kMaxScans && !bytes.isEmpty(); ++i)
    {
        const RobotMotion motion = odometry.process(takeScan(bytes));
        requireSound(motion.increment);
        requireSound(motion.pose);
        if (motion.status == TrackingStatus::Predicted || motion.status == TrackingStatus::Lost)
        {
            fuzzing::requireOneLine(motion.reason);
        }
    }
    return 0;
}
