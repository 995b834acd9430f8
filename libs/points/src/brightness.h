// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace pointplane
{
/** What is assumed of the brightness of a patch from image to image. */
enum class Brightness
{
    Constant,  //!< of every point, as in [Lucas & Kanade 1981]
    Shifted    //!< up to an unknown shift of them all, as by automatic exposure and vignetting
};
}  // namespace pointplane
