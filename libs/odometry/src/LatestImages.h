// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/RgbdFrame.h>

namespace pointplane
{
/** Keeps copies of the latest frame's images, so that the caller may reuse its buffers. Key frames
 * share these copies. It also tells whether images came twice: noise makes any two others differ.
 */
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
