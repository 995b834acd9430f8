// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/RgbdFrame.h>

#include <optional>
#include <string>
#include <vector>

namespace pointplane
{
struct CameraComment
{
    std::string label;
    ShutterModel shutter;
    bool isNominal{false};
    std::vector<std::string> unknownKeys;
};

/** Empty if the text does not start with "pointplane-camera". \throws InputError naming the key */
[[nodiscard]] std::optional<CameraComment> parseCameraComment(const std::string& text);
}  // namespace pointplane
