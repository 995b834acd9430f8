// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/RgbdFrame.h>

#include <cstdint>
#include <optional>

namespace pointplane
{
/** Tells images that come twice: their noise makes any two others differ. */
class FrozenImages
{
 public:
    /** Whether depth and grey image are those of the frame before, byte for byte. */
    [[nodiscard]] bool repeats(const RgbdFrame& frame);

 private:
    std::optional<std::uint64_t> previous_;  //!< what the images of the frame before add up to
};
}  // namespace pointplane
