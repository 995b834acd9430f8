// SPDX-License-Identifier: BSD-3-Clause
#include "exposure_errors.h"

#include <pointplane/core/covariance.h>

namespace pointplane
{
namespace
{
/** Mean of s^2 over the rows [s^2]. */
double meanSquare(double delay, double readout) { return delay * delay + readout * readout / 12; }
}  // namespace

Matrix12d accelerationWhileExposed(
    const Sensitivity& of, const ShutterModel& shutter, const Vector6d& acceleration2)
{
    const Matrix126d byAcceleration =
        (meanSquare(0, shutter.readoutColour) * of.pointsMoved +
         meanSquare(shutter.depthDelay, shutter.readoutDepth) * of.planesMoved) /
        2;
    return propagate(byAcceleration, Matrix6d(acceleration2.asDiagonal()));
}
}  // namespace pointplane
