// SPDX-License-Identifier: BSD-3-Clause
#include "GrabberRun.h"

#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/params_ini.h>
#include <pointplane/mrpt_io/rawlog_names.h>

#include <chrono>
#include <filesystem>
#include <ostream>
#include <thread>

#include "OutputGuard.h"
#include "ProgressBar.h"
#include "StopSignals.h"

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
    checkFiles();
    installStopSignals();
    drivers_ = makeCameraDrivers(options_.driver);
    if (!openCameraOrWait())
    {
        return kExitOk;
    }
    calibrate();
    openOutputs();
    const CaptureEnd end = captureWithStatus();
    finishOutputs();
    explain(end);
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

void GrabberRun::keepFilesApart() const
{
    OutputGuard guard;
    std::error_code error;
    if (fs::is_regular_file(options_.device, error))
    {
        guard.addInput(options_.device);
    }
    guard.addInput(options_.calibration);
    guard.addInput(options_.liveOdometry.config);
    constexpr int kSegments = 1000;
    const bool splits = options_.recordsRawlog() && options_.recording.splitAfter > 0.0;
    for (int i = 0; i < (splits ? kSegments : 1); ++i)
    {
        const std::string path = splits ? segmentPath(options_.output, i) : options_.output;
        guard.addOutput("-o", path);
        if (options_.recordsRawlog() &&
            options_.recording.encoding.storage == ImageStorage::External)
        {
            guard.addFolderBeside("images of -o", path, imagesFolderOf(path));
        }
    }
    guard.addOutput("--preview", options_.preview);
    guard.addOutput("--live-output", options_.liveOdometry.poseRawlog);
}

void GrabberRun::checkFiles()
{
    keepFilesApart();
    std::error_code error;
    if (!options_.calibration.empty() && !fs::is_regular_file(options_.calibration, error))
    {
        throw InputError("--calibration " + options_.calibration + ": no such file");
    }
    if (!options_.liveOdometry.config.empty())
    {
        (void)loadOdometryParams(options_.liveOdometry.config, {});
    }
    if (options_.output.empty())
    {
        return;
    }
    const bool splits = options_.recordsRawlog() && options_.recording.splitAfter > 0.0;
    const std::string first = splits ? segmentPath(options_.output, 0) : options_.output;
    if (fs::exists(first, error))
    {
        throw InputError("'" + first + "' exists already; recordings never overwrite");
    }
    // Now: later, the working folder may be gone.
    diskFolder_ = fs::absolute(options_.output, error).parent_path();
}

void GrabberRun::openOutputs()
{
    if (options_.recordsOni())
    {
        options_.capture.oniPath = options_.output;
    }
    if (!options_.preview.empty())
    {
        preview_ = std::make_unique<Preview>(options_.preview);
    }
    if (options_.live)
    {
        options_.liveOdometry.waits = camera_->facts().isFile;
        live_ = std::make_unique<LiveOdometry>(options_.liveOdometry, *builder_, out_);
    }
    if (options_.recordsRawlog())
    {
        options_.recording.marksEnds = true;
        options_.recording.tellDelay =
            !camera_->facts().isFile;  // a file's streams both start at 0
        writer_ = std::make_unique<RecordingWriter>(options_.recording, *builder_);
    }
}

bool GrabberRun::consume(const ImagePair& pair)
{
    if (writer_)
    {
        const bool taken = camera_->facts().isFile ? writer_->push(pair) : writer_->tryPush(pair);
        if (!taken && writer_->hasFailed())
        {
            return false;
        }
        queueDrops_ += taken ? 0 : 1;
    }
    if (live_)
    {
        live_->add(pair);
    }
    if (preview_)
    {
        preview_->show(pair);
    }
    return true;
}

CaptureEnd GrabberRun::captureWithStatus()
{
    capture_ = std::make_unique<Capture>(
        *camera_, options_.capture, [this](const ImagePair& pair) { return consume(pair); });
    if (!options_.quiet)
    {
        err_ << "pointplane-grabber: " << describe(camera_->facts()) << std::endl;
    }
    // The terminal may be slow: the camera gets a thread of its own.
    std::atomic<bool> done{false};
    CaptureEnd end = CaptureEnd::Error;
    std::thread thread(
        [&]
        {
            end = capture_->run(stop_);
            done = true;
        });
    // Whatever happens here, the recording gets its end.
    struct Joiner
    {
        std::thread& thread;
        std::atomic<bool>& stop;
        ~Joiner()
        {
            if (thread.joinable())
            {
                stop = true;
                thread.join();
            }
        }
    } const joiner{thread, stop_};
    StatusLine status(err_, standardErrorIsTerminal());
    while (!done)
    {
        std::this_thread::sleep_for(kPoll);
        stop_ = stop_ || stopRequested() || (writer_ && writer_->hasFailed());
        watchDisk();
        if (!options_.quiet)
        {
            status.update(state());
        }
    }
    thread.join();
    status.end();
    return end;
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
    state.queueDrops = queueDrops_;
    state.freeBytes = freeBytes_;
    if (writer_)
    {
        state.isRecording = true;
        state.recording = writer_->stats();
        state.queueCapacity = options_.recording.queueFrames;
        state.bytesPerSecond =
            state.capture.recordedTime > 0.0
                ? static_cast<double>(state.recording.bytesWritten) / state.capture.recordedTime
                : 0.0;
    }
    return state;
}

void GrabberRun::finishOutputs()
{
    if (const std::string problem = preview_ ? preview_->finish() : ""; !problem.empty())
    {
        fail(problem + "; the picture is not the latest");
    }
    try
    {
        if (writer_)
        {
            writer_->finish();
        }
    }
    catch (const std::exception& e)
    {
        fail(oneLine(e) + "; what was recorded before is complete");
    }
    try
    {
        if (live_)
        {
            live_->finish();
            if (const std::string problem = live_->stats().problem; !problem.empty())
            {
                fail(problem);
            }
        }
    }
    catch (const std::exception& e)
    {
        fail(oneLine(e));
    }
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
    if (end == CaptureEnd::EndOfFile && capture_->stats().pairing.pairs == 0)
    {
        fail("recording '" + uri + "' has no depth image with a colour image near it in time");
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
    if (writer_)
    {
        summary.outputs = writer_->paths();
    }
    else if (options_.recordsOni())
    {
        summary.outputs = {options_.output};
    }
    if (live_)
    {
        summary.hasLive = true;
        summary.live = live_->stats();
    }
    print(summary, err_);
}
}  // namespace pointplane
