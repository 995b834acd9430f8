// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Plane.h>
#include <pointplane/core/PointGaussian.h>

namespace pointplane
{
/** The same point seen twice.
 *
 * Rows of a rolling shutter are exposed one after the other: what the current frame shows depends
 * on its body velocity V [m/s, rad/s], to first order by dCur_dV. */
struct PointPair
{
    PointGaussian base;                         //!< from a reference frame, in the base frame [m]
    PointGaussian cur;                          //!< in the current camera, were it at rest [m]
    Matrix36d dCur_dV{Matrix36d::Zero()};       //!< rolling shutter: cur is at cur.mean + dCur_dV V
    Eigen::Vector3d dCur_dVignetting{0, 0, 0};  //!< error of cur with that of the lens [m]
    int reference{0};                           //!< which of the frames that cur is compared with
    int feature{-1};  //!< pairs of equal ones err together; -1: of its own
};

/** The same plane seen twice. */
struct PlanePair
{
    PlaneGaussian base;                    //!< from a reference frame, in the base frame
    PlaneGaussian cur;                     //!< in the current camera, were it at rest
    Matrix36d dCur_dV{Matrix36d::Zero()};  //!< rolling shutter: cur is at theta_m + dCur_dV V
    int reference{0};                      //!< which of the frames that cur is compared with
    int feature{-1};                       //!< pairs of equal ones err together; -1: of its own
};
}  // namespace pointplane
