// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/RgbdFrame.h>

#include <optional>
#include <string>

namespace pointplane
{
struct LabelledShutter
{
    std::string label;
    ShutterModel shutter;
};

/** Empty if the text does not start with "pointplane-camera". \throws InputError naming the key */
[[nodiscard]] std::optional<LabelledShutter> parseShutterComment(const std::string& text);
}  // namespace pointplane
