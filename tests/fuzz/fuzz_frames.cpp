// SPDX-License-Identifier: BSD-3-Clause
// Any frames through the pipeline: sizes, pixels, intrinsics, stamps.
#include <pointplane/odometry/Odometry.h>

#include "frame_records.h"
#include "fuzzing.h"

namespace
{
using namespace pointplane;
using fuzzing::ByteSource;
using fuzzing::FrameRecord;

constexpr int kMaxFrames = 6;

OdometryParams paramsNumber(std::uint8_t number)
{
    OdometryParams params;
    params.points.method = (number & 1U) != 0 ? "match" : "track";
    params.pipeline.degeneracy = (number & 2U) != 0 ? "gate" : "fuse";
    params.pipeline.usePlanes = (number & 12U) != 4U;
    params.pipeline.usePoints = (number & 12U) != 8U;
    return params;
}

RgbdFrame takeFrame(ByteSource& bytes)
{
    const auto record = bytes.take<FrameRecord>();
    const auto is = [&record](FrameRecord::Flag flag) { return (record.flags & flag) != 0; };
    RgbdFrame frame;
    frame.stamp = record.stamp;
    frame.camera.width = record.width;
    frame.camera.height = record.height;
    frame.camera.fx = record.fx;
    frame.camera.fy = record.fy;
    frame.camera.cx = record.cx;
    frame.camera.cy = record.cy;
    std::memcpy(frame.camera.distortion.data(), record.distortion, sizeof(record.distortion));
    if (is(FrameRecord::HasShutter))
    {
        frame.shutter = {record.shutter[0], record.shutter[1], record.shutter[2]};
    }
    const int rows = record.height, cols = record.width;
    if (is(FrameRecord::HasGray))
    {
        const int extra = is(FrameRecord::GrayOfAnotherSize) ? 1 : 0;
        frame.gray = bytes.takeImage(rows + extra, cols, CV_8UC1);
    }
    const int extra = is(FrameRecord::DepthOfAnotherSize) ? 1 : 0;
    if (is(FrameRecord::DepthIsFloat))
    {
        frame.depth = bytes.takeImage(rows, cols + extra, CV_32FC1);
    }
    else
    {
        const cv::Mat steps = bytes.takeImage(rows, cols + extra, CV_16UC1);
        if (!steps.empty())
        {
            steps.convertTo(frame.depth, CV_32FC1, fuzzing::kDepthStep);
            frame.depth.setTo(std::numeric_limits<float>::quiet_NaN(), steps == 0);
        }
    }
    return frame;
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    ByteSource bytes(data, size);
    Odometry odometry(paramsNumber(bytes.take<std::uint8_t>()));
    for (int i = 0; i < kMaxFrames && !bytes.isEmpty(); ++i)
    {
        const OdometryResult result = odometry.process(takeFrame(bytes));
        fuzzing::requireSound(result.increment);
        fuzzing::requireSound(result.pose);
        if (result.status == TrackingStatus::Predicted || result.status == TrackingStatus::Lost)
        {
            fuzzing::requireOneLine(result.reason);
        }
    }
    return 0;
}
