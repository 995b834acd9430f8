// SPDX-License-Identifier: BSD-3-Clause
#include "camera_oddity.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace pointplane
{
namespace
{
/** Of the focal lengths: pixels are square, or nearly so. */
constexpr double kMostRatio = 1.25;

/** From the principal point to the middle, over the image. */
constexpr double kFarOff = 0.25;

bool foldsInImage(const PinholeCamera& camera)
{
    for (const double u : {0, camera.width - 1})
    {
        for (const double v : {0, camera.height - 1})
        {
            if (!camera.normalised({u, v}).allFinite())
            {
                return true;
            }
        }
    }
    return false;
}
}  // namespace

std::string oddityOf(const PinholeCamera& camera)
{
    const double ratio = std::abs(camera.fx / camera.fy);
    std::ostringstream out;
    if (std::max(ratio, 1 / ratio) > kMostRatio)
    {
        out << "its focal lengths differ (fx=" << camera.fx << " fy=" << camera.fy << ")";
    }
    else if (
        std::abs(camera.cx / camera.width - 0.5) > kFarOff ||
        std::abs(camera.cy / camera.height - 0.5) > kFarOff)
    {
        out << "its principal point (cx=" << camera.cx << " cy=" << camera.cy
            << ") is far from the middle of the image (" << camera.width << "x" << camera.height
            << ")";
    }
    else if (foldsInImage(camera))
    {
        out << "its lens distortion folds the image over itself near a corner";
    }
    return out.str();
}
}  // namespace pointplane
