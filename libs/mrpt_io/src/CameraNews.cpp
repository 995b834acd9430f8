// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/CameraNews.h>
#include <pointplane/mrpt_io/ObservationConverter.h>

#include <cmath>

namespace pointplane
{
namespace
{
/** Delays this close are not told anew [s]. */
constexpr double kSameDelay = 1e-4;
}  // namespace

std::string CameraNews::before(double depthDelay, bool isNominal)
{
    const bool isNewDelay =
        std::isfinite(depthDelay) && !(std::abs(depthDelay - told_.depthDelay) <= kSameDelay);
    if (!isNewDelay && isNominal == isNominal_)
    {
        return "";
    }
    told_.depthDelay = isNewDelay ? depthDelay : told_.depthDelay;
    isNominal_ = isNominal;
    return cameraComment(label_, told_, isNominal_);
}
}  // namespace pointplane
