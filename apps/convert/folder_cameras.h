// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "Recording.h"
#include "folder_layout.h"

namespace pointplane
{
/** Sets the cameras of a scan, of its images' sizes.
 *
 * A calibration for another size of the same picture is scaled. Depth of another size than colour,
 * and without a camera in the layout, is taken as seen by colour's, without distortion. Depth alone
 * has the calibration.
 * \param scan with its images \param layout with a camera of colour \param name of the frame, for
 * errors \throws BadFrame if the sizes do not fit */
void setCameras(RegisteredScan& scan, const FolderLayout& layout, const std::string& name);
}  // namespace pointplane
