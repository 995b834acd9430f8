// SPDX-License-Identifier: BSD-3-Clause
#include "GrabberRun.h"

#include <pointplane/grabber/DurableFile.h>
#include <pointplane/mrpt_io/errors.h>

#include <chrono>
#include <filesystem>
#include <future>
#include <ostream>
#include <thread>

#include "ProgressBar.h"
#include "StopSignals.h"
#include "file_check.h"

namespace pointplane
{
namespace
{
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kPoll{50};
}  // namespace

GrabberRun::GrabberRun(const GrabberOptions& options, std::ostream& out, std::ostream& err)
    : options_(options), out_(out), err_(err)
{
}

GrabberRun::~GrabberRun() = default;

int GrabberRun::run()
{
    checkFilesOf(options_);
    // Now: later, the working folder may be gone.
    std::error_code error;
    diskFolder_ = fs::absolute(options_.output, error).parent_path();
    installStopSignals();
    drivers_ = makeCameraDrivers(options_.driver);
    if (!openCameraOrWait())
    {
        fail("stopped before a camera appeared: nothing was recorded");
        return exitCode_;
    }
    calibrate();
    outputs_ = std::make_unique<GrabberOutputs>(options_, camera_->facts(), *builder_, out_);
    if (options_.recordsOni())
    {
        options_.capture.oniPath = options_.output;
        DurableFile(options_.output).close();  // OpenNI2 would write over another's
    }
    const CaptureEnd end = captureWithStatus();
    for (const std::string& problem : outputs_->finish())
    {
        fail(problem);
    }
    explain(end);
    if (options_.recordsOni() && capture_->stats().pairing.pairs == 0)
    {
        fs::remove(options_.output, error);  // it would be in the way of the next attempt
    }
    printSummary();
    return exitCode_;
}

bool GrabberRun::openCameraOrWait()
{
    const auto deadline = Clock::now() + std::chrono::duration<double>(options_.waitSeconds);
    bool announced = false;
    while (!stopRequested())
    {
        try
        {
            camera_ = openCamera(drivers_, options_.device, options_.camera);
            return true;
        }
        catch (const NoCameraError&)
        {
            if (Clock::now() >= deadline)
            {
                throw;
            }
        }
        if (!announced)
        {
            err_ << "pointplane-grabber: waiting for a camera" << std::endl;
            announced = true;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(500));
    }
    return false;
}

void GrabberRun::calibrate()
{
    auto calibration =
        options_.calibration.empty()
            ? nominalCalibration(camera_->facts())
            : calibrationFromFile(options_.calibration, options_.section, camera_->facts());
    if (!options_.label.empty())
    {
        calibration.sensorLabel = options_.label;
    }
    builder_ = std::make_unique<ObservationBuilder>(std::move(calibration));
}

CaptureEnd GrabberRun::captureWithStatus()
{
    capture_ = std::make_unique<Capture>(
        *camera_, options_.capture, [this](const ImagePair& pair) { return outputs_->add(pair); });
    if (!options_.quiet)
    {
        err_ << "pointplane-grabber: " << describe(camera_->facts()) << std::endl;
    }
    // The terminal may be slow: the camera gets a thread of its own.
    auto end = std::async(std::launch::async, [this] { return capture_->run(stop_); });
    struct Stopper  // whatever happens here, the recording gets its end
    {
        std::atomic<bool>& stop;
        ~Stopper() { stop = true; }
    } const stopper{stop_};
    StatusLine status(err_, standardErrorIsTerminal());
    for (bool done = false; !done;)
    {
        done = end.wait_for(kPoll) == std::future_status::ready;
        stop_ = stop_ || stopRequested() || outputs_->hasFailed();
        watchDisk();
        if (!options_.quiet)
        {
            status.update(state());
        }
    }
    status.end();
    return end.get();
}

void GrabberRun::watchDisk()
{
    if (options_.output.empty())
    {
        return;
    }
    std::error_code error;
    const auto space = fs::space(diskFolder_, error);
    if (error)
    {
        return;
    }
    freeBytes_ = static_cast<double>(space.available);
    if (freeBytes_ < 1e6 * options_.minFreeMb && !stop_)
    {
        stop_ = true;
        fail("the disk of '" + options_.output + "' is nearly full: stopped (--min-free-mb)");
    }
}

RunState GrabberRun::state() const
{
    RunState state;
    state.capture = capture_->stats();
    state.freeBytes = freeBytes_;
    outputs_->describeIn(state);
    return state;
}

void GrabberRun::explain(CaptureEnd end)
{
    const auto& uri = camera_->facts().device.uri;
    switch (end)
    {
        case CaptureEnd::Stopped:
        case CaptureEnd::EndOfFile:
        case CaptureEnd::SinkFull:
            break;
        case CaptureEnd::Unplugged:
            fail("camera " + uri + " was unplugged; everything before is kept");
            break;
        case CaptureEnd::Stalled:
        case CaptureEnd::Error:
            fail(capture_->problem());
            break;
    }
    if (exitCode_ == 0 && capture_->stats().pairing.pairs == 0)
    {
        fail(
            end == CaptureEnd::EndOfFile
                ? "recording '" + uri + "' has no depth image with a colour image near it in time"
                : "ended before the first frame: nothing was recorded");
    }
}

void GrabberRun::fail(const std::string& problem)
{
    err_ << "pointplane-grabber: " << problem << std::endl;
    exitCode_ = kExitEnvironment;
}

void GrabberRun::printSummary()
{
    RunSummary summary;
    summary.state = state();
    summary.camera = camera_->facts();
    summary.calibration = builder_->calibration().source;
    summary.notes = camera_->facts().notes;
    for (const auto& note : capture_->notes())
    {
        summary.notes.push_back(note);
    }
    std::error_code error;
    if (options_.recordsOni() && fs::exists(options_.output, error))
    {
        summary.outputs = {options_.output};
    }
    outputs_->describeIn(summary);
    print(summary, err_);
}
}  // namespace pointplane
