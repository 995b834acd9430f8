// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/PinholeCamera.h>
#include <pointplane/sensor/RgbdFrame.h>

#include <string>

namespace pointplane
{
/** What the images of a folder do not say themselves. */
struct TumCamera
{
    PinholeCamera camera;
    double unitsPerMetre{5000};  //!< of depth images
    bool tellsUnits{false};      //!< not the usual ones
    std::string guessed{};       //!< name of the preset, if the folder's name told it
    ShutterModel shutter;        //!< depthDelay is measured from the stamps instead
};

/** \param camera "fr1", "fr2", "fr3", a file, or empty: camera.txt in the folder, else a preset by
 * the folder's name (freiburg1, fr1_... and so on)
 * \throws InputError */
[[nodiscard]] TumCamera loadTumCamera(const std::string& camera, const std::string& folder);
}  // namespace pointplane
