// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/RgbdFrame.h>

#include <array>
#include <cstddef>

namespace pointplane
{
/** Keeps copies of the latest images, so that the caller may reuse its buffers. Key frames share
 * these copies. It also tells which images came before: noise makes any two others differ. */
class LatestImages
{
 public:
    /** \param minDepth, maxDepth readings outside of these [m] are none */
    LatestImages(double minDepth, double maxDepth);

    /** Which images of a frame differ, be it by a byte, from those of the two frames before. */
    struct Novelty
    {
        bool depth{true}, gray{true};
    };

    /** Puts copies in the place of the frame's images. Depth that is no reading becomes NaN. */
    [[nodiscard]] Novelty renew(RgbdFrame& frame);

 private:
    /** The latest two of a stream: some buffers that hang give the same two in turns. */
    class Stream
    {
     public:
        /** \return whether the image is new; it becomes a copy */
        bool renew(cv::Mat& image);

     private:
        std::array<cv::Mat, 2> images_;
        std::size_t older_{0};
    };

    float minDepth_, maxDepth_;
    cv::Mat readings_;
    Stream depth_, gray_;
};
}  // namespace pointplane
