// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/external_range.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <vector>

#include "GzInput.h"
#include "ObjectScanner.h"

namespace pointplane
{
mrpt::math::CMatrix_u16 readExternalRange(const std::string& path)
{
    GzInput in(path);
    std::uint32_t size[2] = {0, 0};
    if (in.read(size, sizeof(size)) != sizeof(size))
    {
        throw InputError(path + ": is not a range image");
    }
    const std::uint64_t count = static_cast<std::uint64_t>(size[0]) * size[1];
    const std::string sizeText = std::to_string(size[1]) + "x" + std::to_string(size[0]);
    if (count == 0 || count > scanning::kMaxPixels)
    {
        throw InputError(path + ": is not a range image (its size would be " + sizeText + ")");
    }
    std::vector<std::uint16_t> readings;
    constexpr std::size_t kChunk = 1U << 19U;
    while (readings.size() < count)  // in steps: a wrong size must not cost memory
    {
        const std::size_t at = readings.size();
        const std::size_t step = std::min<std::size_t>(kChunk, count - at);
        readings.resize(at + step);
        if (in.read(readings.data() + at, step * sizeof(std::uint16_t)) !=
            step * sizeof(std::uint16_t))
        {
            throw InputError(path + ": stops before the end of its " + sizeText + " readings");
        }
    }
    std::uint8_t extra = 0;
    if (in.read(&extra, 1) != 0 || in.end() != GzInput::End::Clean)
    {
        throw InputError(
            path + ": " +
            (in.problem().empty() ? "has more than its " + sizeText + " readings" : in.problem()));
    }
    mrpt::math::CMatrix_u16 out(size[0], size[1]);
    std::memcpy(out.data(), readings.data(), readings.size() * sizeof(std::uint16_t));
    return out;
}

void moveRangeToFile(
    mrpt::obs::CObservation3DRangeScan& scan, const std::string& directory, const std::string& name)
{
    const std::string path = directory + "/" + name;
    const mrpt::math::CMatrix_u16 readings = scan.rangeImage;
    bool same = false;
    try
    {
        scan.rangeImage_convertToExternalStorage(name, directory + "/");
        same = readExternalRange(path) == readings;
    }
    catch (const std::exception&)  // MRPT's, when a large write fails
    {
    }
    if (!same)
    {
        std::error_code ignored;
        std::filesystem::remove(path, ignored);
        throw EnvironmentError("cannot write " + path + ": disk full or not writable");
    }
}

bool makeExternalsAbsolute(mrpt::obs::CObservation3DRangeScan& scan, const std::string& directory)
{
    /** MRPT has no setter for the names of external ranges and points. */
    struct Access : mrpt::obs::CObservation3DRangeScan
    {
        static std::string CObservation3DRangeScan::*rangeFile()
        {
            return &Access::m_rangeImage_external_file;
        }
        static std::string CObservation3DRangeScan::*pointsFile()
        {
            return &Access::m_points3D_external_file;
        }
    };
    bool changed = false;
    const auto absolute = [&](const std::string& name)
    {
        if (name.empty() || name.front() == '/')
        {
            return name;
        }
        changed = true;
        return std::filesystem::absolute(std::filesystem::path(directory) / name)
            .lexically_normal()
            .string();
    };
    if (scan.rangeImage_isExternallyStored())
    {
        scan.*Access::rangeFile() = absolute(scan.*Access::rangeFile());
    }
    if (scan.points3D_isExternallyStored())
    {
        scan.*Access::pointsFile() = absolute(scan.*Access::pointsFile());
    }
    for (auto* image : {&scan.intensityImage, &scan.confidenceImage})
    {
        if (image->isExternallyStored())
        {
            image->setExternalStorage(absolute(image->getExternalStorageFile()));
        }
    }
    return changed;
}
}  // namespace pointplane
