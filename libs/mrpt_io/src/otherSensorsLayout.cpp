// SPDX-License-Identifier: BSD-3-Clause
// The layouts of what robots commonly log beside RGB-D, as MRPT serialises it.
#include "ObjectScanner.h"

namespace pointplane
{
using scanning::require;

namespace
{
constexpr std::uint32_t kMaxParticles = 1U << 20U;
}

bool ObjectScanner::otherSensor(const Header& header, int depth)
{
    const std::string& name = header.className;
    const int version = header.version;
    if (name == "CObservation2DRangeScan" && (version == 6 || version == 7))
    {
        rangeScan2D(version);
    }
    else if (name == "CObservationIMU" && version >= 1 && version <= 4)
    {
        imu(version);
    }
    else if (name == "CObservationOdometry" && version == 2)
    {
        wheelOdometry();
    }
    else if (name == "CObservationImage" && version == 4)
    {
        copyObject("CPose3D");
        copyObject("TCamera");
        copyObject("CImage");
        copy(sizeof(std::uint64_t));  // time stamp
        copyString();
    }
    else if (name == "CActionRobotMovement2D" && version == 7)
    {
        movement2D(depth);
    }
    else if (name == "CPose2D" && version == 1)
    {
        copyArray(3, sizeof(double));
    }
    else if (name == "CPosePDFGaussian" && version == 2)
    {
        copyObject("CPose2D");
        copyArray(6, sizeof(double));
    }
    else
    {
        return false;
    }
    return true;
}

void ObjectScanner::rangeScan2D(int version)
{
    copy(sizeof(float));  // aperture
    copyBool();           // right to left
    copy(sizeof(float));  // maxRange
    copyObject("CPose3D");
    const auto n = copyValue<std::uint32_t>();
    copyArray(n, sizeof(float));         // ranges
    copyArray(n, sizeof(std::uint8_t));  // which are valid
    // stdError, time stamp, beam aperture
    copy(sizeof(float) + sizeof(std::uint64_t) + sizeof(float));
    copyString();
    copy(sizeof(double));  // pitch
    if (version >= 7 && copyBool())
    {
        copyArray(n, sizeof(std::int32_t));  // intensities
    }
}

void ObjectScanner::imu(int version)
{
    constexpr std::uint64_t kFields = 31;
    copyObject("CPose3D");
    copyArray(version >= 4 ? kFields : copyValue<std::uint32_t>(), sizeof(std::uint8_t));
    copy(sizeof(std::uint64_t));  // time stamp
    copyArray(version >= 4 ? kFields : copyValue<std::uint32_t>(), sizeof(double));
    copyString();
}

void ObjectScanner::wheelOdometry()
{
    copyObject("CPose2D");
    copyString();
    copy(sizeof(std::uint64_t));  // time stamp
    wheels();
    velocities();
}

void ObjectScanner::movement2D(int depth)
{
    constexpr std::uint32_t kFromOdometry = 0;
    if (copyValue<std::uint32_t>() == kFromOdometry)
    {
        copyObject("CPose2D");
        copy(sizeof(std::uint32_t));  // motion model
        copyArray(6, sizeof(float));  // of the Gaussian one
        // MRPT draws as many particles while it reads.
        const auto numParticles = copyValue<std::uint32_t>();
        require(
            numParticles <= kMaxParticles,
            "a motion model of " + std::to_string(numParticles) + " particles");
        copyArray(6, sizeof(float));  // of the particles' one
    }
    else
    {
        copyAnyObject(depth + 1);
    }
    velocities();
    wheels();
    copy(sizeof(std::uint64_t));  // time stamp
}

void ObjectScanner::velocities()
{
    if (copyBool())
    {
        copyArray(3, sizeof(double));
    }
}

void ObjectScanner::wheels()
{
    if (copyBool())
    {
        copyArray(2, sizeof(std::int32_t));
    }
}
}  // namespace pointplane
