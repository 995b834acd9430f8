// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/grabber/Camera.h>
#include <pointplane/grabber/Capture.h>
#include <pointplane/grabber/LiveOdometry.h>
#include <pointplane/grabber/RecordingWriter.h>

#include <string>

namespace pointplane
{
struct GrabberOptions
{
    std::string driver{"auto"};
    std::string device;       //!< empty = the first
    double waitSeconds{0};    //!< for a camera to appear
    std::string calibration;  //!< ini file; empty = nominal
    std::string section{"OPENNI2"};
    std::string label;   //!< overrides the ini's
    std::string output;  //!< .rawlog or .oni; empty = nothing is recorded
    std::string preview;
    bool live{false};
    bool quiet{false};
    double minFreeMb{100};
    CameraSettings camera;
    CaptureOptions capture;
    RecordingOptions recording;
    LiveOptions liveOdometry;

    [[nodiscard]] bool recordsRawlog() const;
    [[nodiscard]] bool recordsOni() const;
};
}  // namespace pointplane
