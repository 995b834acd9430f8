// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/grabber/Preview.h>

#include <atomic>
#include <filesystem>
#include <iosfwd>
#include <memory>
#include <optional>
#include <string>

#include "GrabberOptions.h"
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
    /** Before there is a camera: a typo should not have to wait for one. */
    void checkFiles();
    void keepFilesApart() const;
    void openOutputs();
    [[nodiscard]] bool consume(const ImagePair& pair);
    [[nodiscard]] CaptureEnd captureWithStatus();
    void watchDisk();
    [[nodiscard]] RunState state() const;
    void finishOutputs();
    void explain(CaptureEnd end);
    void printSummary();
    void fail(const std::string& problem);

    GrabberOptions options_;
    std::ostream& out_;
    std::ostream& err_;
    CameraDrivers drivers_;
    std::unique_ptr<Camera> camera_;
    std::unique_ptr<ObservationBuilder> builder_;
    std::unique_ptr<Preview> preview_;
    std::unique_ptr<LiveOdometry> live_;
    std::unique_ptr<RecordingWriter> writer_;
    std::unique_ptr<Capture> capture_;
    std::atomic<bool> stop_{false};
    std::atomic<std::uint64_t> queueDrops_{0};
    std::filesystem::path diskFolder_;  //!< of what is recorded
    double freeBytes_{0};
    int exitCode_{0};
};
}  // namespace pointplane
