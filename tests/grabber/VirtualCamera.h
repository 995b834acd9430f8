// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "ChildProcess.h"
#include "grabber_testing.h"

namespace pointplane::test
{
/** A folder in which the real OpenNI2 runtime finds the virtual camera as its only device. */
class VirtualCamera
{
 public:
    /** \param settings lines of `key value`, see VirtualCameraDriver.cpp */
    VirtualCamera(
        const std::string& settings, const std::vector<PlainFrame>& frames, double focal_px)
    {
        namespace fs = std::filesystem;
        fs::create_directories(dir_ / "OpenNI2/Drivers");
        // The runtime looks for drivers beside the path by which it was loaded: a link is enough.
        fs::create_symlink(OPENNI2_LIBRARY, dir_ / "libOpenNI2.so.0");
        fs::create_symlink(VIRTUAL_CAMERA_DRIVER, dir_ / "OpenNI2/Drivers/libVirtualCamera.so.0");
        fs::create_symlink(VIRTUAL_CAMERA_DRIVER, dir_ / "OpenNI2/Drivers/libVirtualCamera.so");
        fs::create_symlink(ONI_FILE_DRIVER, dir_ / "OpenNI2/Drivers/libOniFile.so.0");
        fs::create_symlink(ONI_FILE_DRIVER, dir_ / "OpenNI2/Drivers/libOniFile.so");
        writeFrameFile(dir_ / "frames.bin", frames, focal_px);
        writeBytes(dir_ / "settings", settings + "\nframes " + (dir_ / "frames.bin") + "\n");
    }

    [[nodiscard]] ChildProcess::Environment environment() const
    {
        return {{"LD_LIBRARY_PATH", dir_ / ""}, {"POINTPLANE_VIRTUAL_CAMERA", dir_ / "settings"}};
    }

 private:
    TempDir dir_;
};
}  // namespace pointplane::test
