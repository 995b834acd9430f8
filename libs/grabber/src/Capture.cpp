// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/grabber/Capture.h>

#include <utility>

#include "drivers.h"
#include "oni_file.h"

namespace pointplane
{
namespace
{
constexpr std::chrono::milliseconds kPoll{100};  // how late a request to stop is noticed

FramePairer pairerOf(const CaptureOptions& options, const CameraFacts& camera)
{
    const double period = 1.0 / camera.mode.fps;
    return {options.maxSkew > 0.0 ? options.maxSkew : 0.5 * period, period, !camera.hasColour};
}
}  // namespace

Capture::Capture(Camera& camera, const CaptureOptions& options, Consumer consumer)
    : camera_(camera),
      options_(options),
      consumer_(std::move(consumer)),
      pairer_(pairerOf(options, camera.facts())),
      warm_(camera.facts().isFile)
{
    stats_.started = warm_;
}

CaptureEnd Capture::run(const std::atomic<bool>& stop)
{
    CaptureEnd end = CaptureEnd::Error;
    try
    {
        if (!options_.oniPath.empty())
        {
            camera_.recordTo(options_.oniPath);
            waitsForOni_ = !(camera_.facts().isFile && camera_.startRecording());
        }
        camera_.start();
        end = capture(stop);
    }
    catch (const std::exception& e)
    {
        problem_ = oneLine(e);
    }
    camera_.stop();
    pairer_.finish();
    if (!options_.oniPath.empty() && problem_.empty())
    {
        problem_ = problemOfOniFile(options_.oniPath);
        end = problem_.empty() ? end : CaptureEnd::Error;
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    stats_.pairing = pairer_.counts();
    return end;
}

CaptureEnd Capture::capture(const std::atomic<bool>& stop)
{
    double now = hostTime();
    lastDepth_ = lastColour_ = lastPair_ = warmUpStart_ = now;
    while (!stop)
    {
        CameraImage image;
        switch (camera_.wait(image, kPoll))
        {
            case Delivery::Disconnected:
                return CaptureEnd::Unplugged;
            case Delivery::EndOfFile:
                return CaptureEnd::EndOfFile;
            case Delivery::Timeout:
                break;
            case Delivery::Image:
                (image.stream == StreamKind::Depth ? lastDepth_ : lastColour_) = image.arrival;
                if (!warm_)
                {
                    warmUp(image);
                }
                else if (const auto end = record(std::move(image)))
                {
                    return *end;
                }
                break;
        }
        const double before = std::exchange(now, hostTime());
        addPause(now - before - std::chrono::duration<double>(kPoll).count());
        if (isStalled(now))
        {
            return CaptureEnd::Stalled;
        }
    }
    return CaptureEnd::Stopped;
}

bool Capture::isStampStream(const CameraImage& image) const
{
    return (image.stream == StreamKind::Colour) == camera_.facts().hasColour;
}

void Capture::warmUp(const CameraImage& image)
{
    if (isStampStream(image))
    {
        readings_.push_back({image.deviceTime, image.arrival});
    }
    // Both streams must run, and the clock must have been seen for a while.
    const bool bothRun =
        lastDepth_ > warmUpStart_ && (!camera_.facts().hasColour || lastColour_ > warmUpStart_);
    const bool longEnough = !readings_.empty() &&
                            readings_.back().arrival - readings_.front().arrival >= options_.warmUp;
    if (bothRun && longEnough)
    {
        finishWarmUp();
    }
}

void Capture::finishWarmUp()
{
    const auto scale = deviceTimeScale(readings_);
    hostStamps_ = options_.warmUp > 0.0 && !scale;
    timeScale_ = scale.value_or(1.0);
    if (hostStamps_)
    {
        note("the camera's time stamps follow no clock: times of arrival are used instead");
    }
    else if (timeScale_ != 1.0)
    {
        note(
            "the driver's time stamps are in a wrong unit: scaled by " +
            std::to_string(timeScale_));
    }
    for (const auto& reading : readings_)
    {
        clock_.observe({reading.device * timeScale_, reading.arrival});
    }
    clock_.lock();
    if (options_.lockExposure && !camera_.lockExposure())
    {
        note("the camera cannot lock its exposure");
    }
    if (options_.lockWhiteBalance && !camera_.lockWhiteBalance())
    {
        note("the camera cannot lock its white balance");
    }
    warm_ = true;
    lastPair_ = hostTime();
    const std::lock_guard<std::mutex> lock(mutex_);
    stats_.started = true;
    stats_.hasClock = !hostStamps_;
}

void Capture::tryToStartOni()
{
    lastPair_ = hostTime();
    pairer_ = pairerOf(options_, camera_.facts());  // of what came so far, nothing is recorded
    waitsForOni_ = !camera_.startRecording();
}

double Capture::stampOf(const ImagePair& pair) const
{
    const auto& facts = camera_.facts();
    const double deviceTime = facts.hasColour ? pair.colour.deviceTime : pair.depth.deviceTime;
    if (facts.isFile)
    {
        return facts.startTime + deviceTime;
    }
    return hostStamps_ ? deviceTime : clock_.utc(deviceTime);
}

std::optional<CaptureEnd> Capture::record(CameraImage image)
{
    image.hasClock = !hostStamps_;
    image.deviceTime = hostStamps_ ? image.arrival : image.deviceTime * timeScale_;
    if (!hostStamps_ && !camera_.facts().isFile && isStampStream(image))
    {
        clock_.observe({image.deviceTime, image.arrival});
    }
    auto pairs = pairer_.add(image);
    if (waitsForOni_)
    {
        if (!pairs.empty())
        {
            tryToStartOni();
        }
        return std::nullopt;
    }
    for (auto& pair : pairs)
    {
        pair.stamp = stampOf(pair);
        if (numPairs_ == 0)
        {
            firstStamp_ = rateStart_ = pair.stamp;
        }
        if (options_.duration > 0.0 && pair.stamp - firstStamp_ >= options_.duration)
        {
            return CaptureEnd::Stopped;
        }
        if (!consumer_(pair))
        {
            return CaptureEnd::SinkFull;
        }
        lastPair_ = image.arrival;
        publish(pair.stamp);
        if (++numPairs_ == options_.maxFrames)
        {
            return CaptureEnd::Stopped;
        }
    }
    return std::nullopt;
}

void Capture::publish(double stamp)
{
    const std::lock_guard<std::mutex> lock(mutex_);
    stats_.pairing = pairer_.counts();
    stats_.recordedTime = stamp - firstStamp_;
    stats_.clockJumps = clock_.numJumps();
    stats_.clockDrift = clock_.drift();
    ++ratePairs_;
    if (stamp - rateStart_ >= 1.0)
    {
        stats_.frameRate = static_cast<double>(ratePairs_ - 1) / (stamp - rateStart_);
        rateStart_ = stamp;
        ratePairs_ = 1;
    }
}

void Capture::addPause(double pause)
{
    if (pause > 0)
    {
        lastDepth_ += pause;
        lastColour_ += pause;
        lastPair_ += pause;
    }
}

bool Capture::isStalled(double now)
{
    const auto& facts = camera_.facts();
    const auto silent = [&](double last, const char* stream)
    {
        if (now - last < options_.stallTimeout)
        {
            return false;
        }
        problem_ = "camera " + facts.device.uri + " sends no " + stream + " images";
        return true;
    };
    if (silent(lastDepth_, "depth"))
    {
        const bool both = facts.hasColour && now - lastColour_ >= options_.stallTimeout;
        problem_ = both ? "camera " + facts.device.uri + " sends no images" : problem_;
        return true;
    }
    if (facts.hasColour && silent(lastColour_, "colour"))
    {
        return true;
    }
    if (warm_ && now - lastPair_ >= options_.stallTimeout)
    {
        problem_ = "camera " + facts.device.uri +
                   ": depth and colour images are farther apart in " +
                   "time than a pair may be (--max-skew)";
        return true;
    }
    return false;
}

CaptureStats Capture::stats() const
{
    const std::lock_guard<std::mutex> lock(mutex_);
    return stats_;
}

std::vector<std::string> Capture::notes() const
{
    const std::lock_guard<std::mutex> lock(mutex_);
    return notes_;
}

void Capture::note(const std::string& text)
{
    const std::lock_guard<std::mutex> lock(mutex_);
    notes_.push_back(text);
}
}  // namespace pointplane
