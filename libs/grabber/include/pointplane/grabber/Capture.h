// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/grabber/Camera.h>
#include <pointplane/grabber/DeviceClock.h>
#include <pointplane/grabber/FramePairer.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace pointplane
{
struct CaptureOptions
{
    double duration{0};          //!< [s] of camera time; 0 = until stopped
    std::uint64_t maxFrames{0};  //!< 0 = until stopped
    double warmUp{1.0};          //!< [s] not recorded: exposure settles, the clock is learned
    double maxSkew{0};           //!< [s] between the images of a pair; 0 = half a frame period
    double stallTimeout{10.0};   //!< [s] without an image of a stream until the camera is given up
    bool lockExposure{false};    //!< after the warm-up
    bool lockWhiteBalance{false};  //!< likewise
    std::string oniPath;           //!< of an .oni recording besides; empty = none
};

enum class CaptureEnd
{
    Stopped,    //!< asked to, or as many frames or seconds as wanted
    EndOfFile,  //!< of an .oni recording
    Unplugged,
    Stalled,   //!< the camera is there but sends nothing
    SinkFull,  //!< the consumer returned false
    Error      //!< see Capture::problem()
};

struct CaptureStats
{
    PairingCounts pairing;
    double recordedTime{0};     //!< [s] from the first to the latest pair
    double frameRate{0};        //!< [Hz] of pairs, by the camera's clock, over the last second
    std::size_t clockJumps{0};  //!< \sa DeviceClock::numJumps()
    double clockDrift{0};       //!< \sa DeviceClock::drift()
    bool hasClock{true};        //!< stamps are the camera's, not times of arrival
    bool started{false};        //!< the warm-up is over
};

/** Takes images from a camera, pairs them, stamps the pairs, and hands them on. It runs in a thread
 * of its own and waits for nothing but the camera. */
class Capture
{
 public:
    /** \return false to end the capture */
    using Consumer = std::function<bool(const ImagePair&)>;

    Capture(Camera& camera, const CaptureOptions& options, Consumer consumer);

    /** Starts the camera and works until there is a reason to end. Never throws. */
    CaptureEnd run(const std::atomic<bool>& stop);

    [[nodiscard]] CaptureStats stats() const;              //!< from any thread
    [[nodiscard]] std::vector<std::string> notes() const;  //!< what the user should know
    [[nodiscard]] const std::string& problem() const { return problem_; }  //!< after run()

 private:
    [[nodiscard]] CaptureEnd capture(const std::atomic<bool>& stop);
    void warmUp(const CameraImage& image);
    void finishWarmUp();
    void tryToStartOni();
    [[nodiscard]] std::optional<CaptureEnd> record(CameraImage image);
    /** The camera is not to blame for the time in which nobody listened to it. */
    void addPause(double pause);
    [[nodiscard]] bool isStalled(double now);
    [[nodiscard]] double stampOf(const ImagePair& pair) const;
    [[nodiscard]] bool isStampStream(const CameraImage& image) const;
    void publish(double stamp);
    void note(const std::string& text);

    Camera& camera_;
    const CaptureOptions options_;
    const Consumer consumer_;
    DeviceClock clock_;
    FramePairer pairer_;
    std::vector<ClockReading> readings_;  // of the warm-up
    double warmUpStart_{0};
    bool warm_{false};
    bool waitsForOni_{false};                            // until its recording can begin
    double timeScale_{1.0};                              // of the device's stamps
    bool hostStamps_{false};                             // the device's are useless
    double lastDepth_{0}, lastColour_{0}, lastPair_{0};  // arrival of the latest
    double firstStamp_{0}, rateStart_{0};
    std::uint64_t numPairs_{0}, ratePairs_{0};
    std::string problem_;
    mutable std::mutex mutex_;  // of what follows
    CaptureStats stats_;
    std::vector<std::string> notes_;
};
}  // namespace pointplane
