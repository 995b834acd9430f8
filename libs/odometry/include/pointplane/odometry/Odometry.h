// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/odometry/OdometryParams.h>
#include <pointplane/odometry/OdometryResult.h>
#include <pointplane/sensor/RgbdFrame.h>

#include <memory>

namespace pointplane
{
/** RGB-D odometry from noisy points and planes [P17]. Give it frames in order of time; each yields
 * a result. The same frames and parameters give the same bits, whatever the number of threads.
 *
 * A frame that cannot be used (no depth image, unusable intrinsics, a stamp not after the previous
 * one or not in seconds) is Lost and never an exception; the next good frame recovers.
 *
 * Do not use one object from two threads at once. One that was moved from may only be destroyed or
 * assigned to. */
class Odometry
{
 public:
    /** \throws std::invalid_argument naming the key when a parameter is out of range */
    explicit Odometry(const OdometryParams& params = {});
    ~Odometry();
    Odometry(Odometry&&) noexcept;
    Odometry& operator=(Odometry&&) noexcept;

    /** Estimates the motion since the previous frame. \param frame images are neither modified nor
     * kept \return status, increment and pose of the camera, with covariances */
    [[nodiscard]] OdometryResult process(const RgbdFrame& frame);

    /** Points and planes of the latest frame. Copy it to keep it: process() changes it, and reset()
     * ends it. */
    [[nodiscard]] const FrameFeatures& features() const;

    [[nodiscard]] const OdometryParams& params() const;

    /** From the next frame on, leaves out what the camera sees of the robot that carries it: it
     * moves along and would tell that nothing moves.
     * \param mask of the images' size, see withoutRobot(); empty: nothing is left out. A frame of
     * another size is Lost. \throws std::invalid_argument as withoutRobot() */
    void setMask(const cv::Mat& mask);
    [[nodiscard]] cv::Mat mask() const;  //!< 0 or 255

    /** Forgets everything but the parameters and the mask. */
    void reset();

 private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};
}  // namespace pointplane
