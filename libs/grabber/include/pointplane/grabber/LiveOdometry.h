// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/grabber/LatestPair.h>
#include <pointplane/grabber/ObservationBuilder.h>
#include <pointplane/mrpt_io/CameraNews.h>
#include <pointplane/mrpt_io/RawlogWriter.h>
#include <pointplane/mrpt_io/VisualOdometry.h>

#include <atomic>
#include <cstdint>
#include <iosfwd>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

namespace pointplane
{
struct LiveOptions
{
    std::string config;      //!< ini file; empty = built-in parameters
    std::string mask;        //!< image file; empty = none
    std::string poseRawlog;  //!< empty = none
    bool waits{false};       //!< the source can wait: every frame is processed
    bool knowsDelay{false};  //!< of depth after colour: images have device times
};

struct LiveStats
{
    std::uint64_t processed{0};
    std::uint64_t skipped{0};     //!< newer frames came before their turn
    std::uint64_t notTracked{0};  //!< predicted or lost
    std::string problem;          //!< why the odometry or its rawlog ended early, or empty
};

/** The odometry on the camera's stream, in a thread of low priority that always takes the newest
 * frame. Prints a line per frame: stamp, status, pose (x y z yaw pitch roll in m and rad) and the
 * 21 upper-triangular elements of its covariance in that order. */
class LiveOdometry
{
 public:
    /** \param out for the lines, usually std::cout
     * \throws InputError, EnvironmentError from the configuration and the rawlog */
    LiveOdometry(const LiveOptions& options, const ObservationBuilder& builder, std::ostream& out);
    ~LiveOdometry();
    LiveOdometry(const LiveOdometry&) = delete;
    LiveOdometry& operator=(const LiveOdometry&) = delete;

    void add(const ImagePair& pair);

    /** Processes the last frame and completes the rawlog; once. \throws EnvironmentError */
    void finish();

    [[nodiscard]] LiveStats stats() const;

 private:
    void work();
    void process(const ImagePair& pair);
    void readNews(const ImagePair& pair);
    void giveUp(const std::exception& e, const std::string& what);
    void write(const RobotMotion& motion, mrpt::Clock::time_point stamp);

    const LiveOptions options_;
    const ObservationBuilder& builder_;
    std::ostream& out_;
    VisualOdometry odometry_;
    CameraNews camera_;
    std::unique_ptr<RawlogWriter> rawlog_;
    LatestPair latest_;
    mutable std::mutex mutex_;
    LiveStats stats_;
    std::thread thread_;
};
}  // namespace pointplane
