// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/PinholeCamera.h>

#include <string>

namespace pointplane
{
/** What images do not say themselves. */
struct Calibration
{
    PinholeCamera camera;
    double unitsPerMetre{5000};  //!< of depth images
    bool tellsUnits{false};      //!< not the usual ones
    std::string guessed{};       //!< name of the preset, if the folder's name told it
    std::string unused{};        //!< what of the file is not used, for people, or empty
};

/** \param camera "fr1", "fr2", "fr3", a file, or empty: camera.txt in the folder, else a preset by
 * a whole word of the folder's name (freiburg1, fr1 and so on)
 * \throws InputError */
[[nodiscard]] Calibration loadCalibration(const std::string& camera, const std::string& folder);

/** The same of a file alone: of images whose depth units a preset does not tell.
 * \throws InputError */
[[nodiscard]] Calibration loadCalibrationFile(const std::string& path);
}  // namespace pointplane
