// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/mrpt_io/ObservationConverter.h>
#include <pointplane/mrpt_io/RawlogReader.h>
#include <pointplane/mrpt_io/RawlogWriter.h>

#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace pointplane::test
{
/** A registered RGB-D observation of a textured wall that moves with `index`. */
[[nodiscard]] inline mrpt::obs::CObservation3DRangeScan::Ptr sampleScan(
    int index, int width = 32, int height = 24)
{
    auto scan = mrpt::obs::CObservation3DRangeScan::Create();
    scan->sensorLabel = "RGBD";
    scan->timestamp = mrpt::Clock::fromDouble(1000.0 + index / 32.0);
    scan->cameraParams.ncols = static_cast<std::uint32_t>(width);
    scan->cameraParams.nrows = static_cast<std::uint32_t>(height);
    scan->cameraParams.setIntrinsicParamsFromValues(
        width * 0.82, width * 0.82, (width - 1) / 2.0, (height - 1) / 2.0);
    scan->cameraParamsIntensity = scan->cameraParams;
    scan->relativePoseIntensityWRTDepth =
        mrpt::poses::CPose3D::FromXYZYawPitchRoll(0, 0, 0, -M_PI / 2, 0, -M_PI / 2);
    scan->hasRangeImage = true;
    scan->rangeUnits = 0.001F;
    scan->rangeImage_setSize(height, width);
    scan->hasIntensityImage = true;
    scan->intensityImage.resize(width, height, mrpt::img::CH_RGB);
    for (int v = 0; v < height; ++v)
    {
        for (int u = 0; u < width; ++u)
        {
            scan->rangeImage(v, u) = static_cast<std::uint16_t>(1500 + 4 * u + 3 * v + index);
            const auto gray = static_cast<std::uint8_t>(((u + index) * 37 + v * 91) % 251);
            scan->intensityImage.setPixel(u, v, mrpt::img::TColor(gray, 90, gray));
        }
    }
    return scan;
}

/** The scans 0 to n - 1 as bare observations (format 2). */
inline void writeObservations(
    const std::string& path, int n, const RawlogWriterOptions& options = {})
{
    RawlogWriter writer(path, options);
    for (int i = 0; i < n; ++i)
    {
        writer.write(*sampleScan(i));
    }
    writer.close();
}

/** The scans as action and frame pairs (format 1). */
inline void writeActionsAndFrames(
    const std::string& path, int n, const RawlogWriterOptions& options = {})
{
    RawlogWriter writer(path, options);
    for (int i = 0; i < n; ++i)
    {
        mrpt::obs::CActionRobotMovement3D movement;
        movement.poseChange.cov.setIdentity();
        mrpt::obs::CActionCollection actions;
        actions.insert(movement);
        writer.write(actions);
        mrpt::obs::CSensoryFrame frame;
        frame.insert(sampleScan(i));
        writer.write(frame);
    }
    writer.close();
}

/** One object of each class that robots commonly log beside RGB-D, in each of its forms. */
[[nodiscard]] inline std::vector<mrpt::serialization::CSerializable::Ptr> otherSensors()
{
    auto imu = mrpt::obs::CObservationIMU::Create();
    imu->sensorLabel = "IMU";
    auto laser = mrpt::obs::CObservation2DRangeScan::Create();
    laser->resizeScan(361);
    auto brightLaser = mrpt::obs::CObservation2DRangeScan::Create();
    brightLaser->resizeScan(7);
    brightLaser->setScanHasIntensity(true);
    auto camera = mrpt::obs::CObservationImage::Create();
    camera->image.resize(8, 6, mrpt::img::CH_GRAY);
    auto wheels = mrpt::obs::CObservationOdometry::Create();
    auto fullWheels = mrpt::obs::CObservationOdometry::Create();
    fullWheels->hasEncodersInfo = fullWheels->hasVelocities = true;
    std::vector<mrpt::serialization::CSerializable::Ptr> out{
        imu, laser, brightLaser, camera, wheels, fullWheels};
    using Movement = mrpt::obs::CActionRobotMovement2D;
    for (const auto method : {Movement::emOdometry, Movement::emScan2DMatching})
    {
        Movement movement;
        movement.estimationMethod = method;
        movement.hasVelocities = method == Movement::emOdometry;
        movement.hasEncodersInfo = method == Movement::emScan2DMatching;
        auto actions = mrpt::obs::CActionCollection::Create();
        actions->insert(movement);
        out.push_back(actions);
    }
    return out;
}

/** The decompressed bytes of a gz rawlog. */
[[nodiscard]] inline std::string decompressed(const std::string& path)
{
    mrpt::io::CFileGZInputStream in(path);
    std::string out;
    char buffer[65536];
    while (const std::size_t n = in.Read(buffer, sizeof(buffer)))
    {
        out.append(buffer, n);
    }
    return out;
}

/** Everything in a rawlog, and how it ended. */
struct RawlogContents
{
    std::vector<mrpt::serialization::CSerializable::Ptr> objects;
    RawlogEnding ending;
};
[[nodiscard]] inline RawlogContents readAll(const std::string& path)
{
    RawlogReader reader(path);
    RawlogContents out;
    while (auto object = reader.next())
    {
        out.objects.push_back(object);
    }
    out.ending = reader.ending();
    return out;
}

inline void requireEnding(const RawlogEnding& ending, RawlogEnd expected)
{
    if (ending.kind != expected)
    {
        throw std::runtime_error("the rawlog ends otherwise: " + ending.message);
    }
}

/** The RGB-D observations of a rawlog that ends so. */
[[nodiscard]] inline std::vector<mrpt::obs::CObservation3DRangeScan::Ptr> scansOf(
    const std::string& path, RawlogEnd expectedEnd = RawlogEnd::Clean)
{
    const RawlogContents contents = readAll(path);
    requireEnding(contents.ending, expectedEnd);
    std::vector<mrpt::obs::CObservation3DRangeScan::Ptr> out;
    for (const auto& object : contents.objects)
    {
        if (auto scan = std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(object))
        {
            out.push_back(scan);
        }
    }
    return out;
}

/** The frames of a whole rawlog as pointplane-odometry takes them. */
[[nodiscard]] inline std::vector<ConvertedFrame> convertedFrames(const std::string& path)
{
    RawlogReader reader(path);
    ObservationConverter converter;
    converter.setExternalsDirectory(reader.externalsDirectory());
    std::vector<ConvertedFrame> out;
    while (const auto object = reader.next())
    {
        if (const auto comment = std::dynamic_pointer_cast<mrpt::obs::CObservationComment>(object))
        {
            converter.readComment(*comment);
        }
        else if (
            const auto scan = std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(object))
        {
            out.push_back(converter.convert(*scan));
        }
    }
    requireEnding(reader.ending(), RawlogEnd::Clean);
    return out;
}
}  // namespace pointplane::test
