// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/RgbdFrame.h>

namespace pointplane
{
/** Tells images that come twice: their noise makes any two others differ. */
class FrozenImages
{
 public:
    /** Whether depth and grey image are those of the frame before, byte for byte. */
    [[nodiscard]] bool repeats(const RgbdFrame& frame);

 private:
    cv::Mat depth_, gray_;  //!< copies: the caller may reuse its buffers
};
}  // namespace pointplane
