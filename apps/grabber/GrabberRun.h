// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <filesystem>
#include <iosfwd>
#include <memory>
#include <optional>
#include <string>

#include "GrabberOptions.h"
#include "GrabberOutputs.h"
#include "summary.h"

namespace pointplane
{
/** One recording, from finding the camera to the summary. */
class GrabberRun
{
 public:
    GrabberRun(const GrabberOptions& options, std::ostream& out, std::ostream& err);
    ~GrabberRun();
    GrabberRun(const GrabberRun&) = delete;
    GrabberRun& operator=(const GrabberRun&) = delete;

    /** \return exit code \throws InputError, EnvironmentError before anything is recorded */
    int run();

 private:
    [[nodiscard]] bool openCameraOrWait();
    void calibrate();
    [[nodiscard]] CaptureEnd captureWithStatus();
    void watchDisk();
    [[nodiscard]] RunState state() const;
    void explain(CaptureEnd end);
    void printSummary();
    void fail(const std::string& problem);

    GrabberOptions options_;
    std::ostream& out_;
    std::ostream& err_;
    CameraDrivers drivers_;
    std::unique_ptr<Camera> camera_;
    std::unique_ptr<ObservationBuilder> builder_;
    std::unique_ptr<GrabberOutputs> outputs_;
    std::unique_ptr<Capture> capture_;
    std::atomic<bool> stop_{false};
    std::filesystem::path diskFolder_;  //!< of what is recorded
    double freeBytes_{0};
    int exitCode_{0};
};
}  // namespace pointplane
