// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/RgbdFrame.h>

#include <optional>
#include <string>

namespace pointplane
{
/** Keeps copies of the latest images, so that the caller may reuse its buffers. Key frames share
 * these copies. */
class LatestImages
{
 public:
    /** \param minDepth, maxDepth readings outside of these [m] are none */
    LatestImages(double minDepth, double maxDepth);

    /** Depth where the mask has the robot is no reading. \param mask withoutRobot()'s; empty: none
     */
    void setMask(const cv::Mat& mask);
    [[nodiscard]] const cv::Mat& mask() const { return mask_; }

    /** Puts copies in the place of the frame's images. Depth that is no reading becomes NaN. An
     * image that is that of the frame before, byte for byte, is left out: a stream that hangs shows
     * what was, not what is. \param frame of the mask's size, if there is one \return which images
     * are left out for that reason, or empty */
    [[nodiscard]] std::string renew(RgbdFrame& frame);

    /** The next frame repeats nothing. */
    void forget();

 private:
    /** Not 0 where the mask is 0, in this camera's depth images. */
    [[nodiscard]] const cv::Mat& leftOut(const PinholeCamera& camera);

    float minDepth_, maxDepth_;
    cv::Mat depth_, gray_;
    cv::Mat readings_;  //!< memory of the next depth image
    cv::Mat mask_;
    std::optional<PinholeCamera> leftOutOf_;
    cv::Mat leftOut_;
};
}  // namespace pointplane
