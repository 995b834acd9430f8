// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/choice.h>
#include <pointplane/core/range.h>
#include <pointplane/odometry/uncertainty/CovarianceParams.h>

namespace pointplane
{
bool CovarianceParams::isJoint() const
{
    return chosen<bool>("model", model, {{"joint", true}, {"independent", false}});
}

void CovarianceParams::check() const
{
    (void)isJoint();
    checkRange("noise", noise, 1e-3, 1000);
    checkRange("viewNoise", viewNoise, 0, 1000);
    checkRange("vignetting", vignetting, 0, 1);
    checkRange("principalPoint", principalPoint, 0, 100);
    checkRange("focalLength", focalLength, 0, 10);
    checkRange("depthScale", depthScale, 0, 10);
    checkRange("history", history, 1, 300);
}
}  // namespace pointplane
