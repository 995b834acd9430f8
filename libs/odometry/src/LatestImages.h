// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/RgbdFrame.h>

namespace pointplane
{
/** Copies of the latest frame's images: the caller may reuse its buffers. Who keeps a frame for
 * longer, as key frames do, shares them and copies nothing. They also tell images that come twice:
 * their noise makes any two others differ. */
class LatestImages
{
 public:
    /** Puts copies in the place of the frame's images.
     * \return whether they differ from those of the frame before, be it by a byte */
    [[nodiscard]] bool renew(RgbdFrame& frame);

 private:
    cv::Mat depth_, gray_;
};
}  // namespace pointplane
