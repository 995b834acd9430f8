// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Plane.h>
#include <pointplane/core/PointGaussian.h>
#include <pointplane/core/patches.h>

namespace pointplane
{
/** Errors of the camera, the same in all frames. */
enum CameraError : int
{
    kVignetting,       //!< [-]
    kPrincipalPointX,  //!< [px]
    kPrincipalPointY,  //!< [px]
    kFocalLength,      //!< [relative]
    kRadial,           //!< radial distortion k1 [-]
    kDepthScale,       //!< [relative]
    kReadoutColour,    //!< [s]
    kReadoutDepth,     //!< [s]
    kDepthDelay,       //!< [s]
    kNumCameraErrors
};
using CameraVector = Eigen::Matrix<double, kNumCameraErrors, 1>;
using CameraMatrix = Eigen::Matrix<double, kNumCameraErrors, kNumCameraErrors>;
using ByCamera = Eigen::Matrix<double, 3, kNumCameraErrors>;  //!< of a feature or residual
using CameraByVelocity = Eigen::Matrix<double, kNumCameraErrors, 6>;
using MotionByCamera = Eigen::Matrix<double, 12, kNumCameraErrors>;  //!< of pose and velocity

using MotionByPatches = Eigen::Matrix<double, 12, kNumPatches>;  //!< of pose and velocity

/** The same point seen twice.
 *
 * Rows of a rolling shutter are exposed one after the other. So what the current frame shows
 * depends on its body velocity V [m/s, rad/s]; to first order, by dCur_dV. */
struct PointPair
{
    PointGaussian ref;                        //!< from a reference frame, in the previous frame [m]
    PointGaussian cur;                        //!< in the current camera, were it at rest [m]
    Matrix36d dCur_dV{Matrix36d::Zero()};     //!< rolling shutter: cur is at cur.mean + dCur_dV V
    Matrix36d dRef_dV{Matrix36d::Zero()};     //!< change of ref with its frame's velocity
    ByCamera dRef_dCamera{ByCamera::Zero()};  //!< change of ref with errors of the camera [m]
    ByCamera dCur_dCamera{ByCamera::Zero()};  //!< likewise of cur
    int reference{0};                         //!< which of the frames that cur is compared with
    int feature{-1};                          //!< pairs of the same one err together; -1: none
    int surface{-1};                          //!< PlanePair::feature of the plane it is on; or -1
    int refPatch{-1}, curPatch{-1};           //!< of their images; -1: depth has no smooth error
    bool hasDepth{true};                      //!< else cur may be anywhere along its ray
    int directions{2};                        //!< of the image; 1: cur may be anywhere on an edge

    /** Directions in which the two can disagree. */
    [[nodiscard]] int dof() const { return directions + (hasDepth ? 1 : 0); }
};

/** The same plane seen twice. */
struct PlanePair
{
    PlaneGaussian ref;                        //!< from a reference frame, in the previous frame
    PlaneGaussian cur;                        //!< in the current camera, were it at rest
    Matrix36d dCur_dV{Matrix36d::Zero()};     //!< rolling shutter: cur is at theta_m + dCur_dV V
    Matrix36d dRef_dV{Matrix36d::Zero()};     //!< change of ref with its frame's velocity
    ByCamera dRef_dCamera{ByCamera::Zero()};  //!< change of ref with errors of the camera [1/m]
    ByCamera dCur_dCamera{ByCamera::Zero()};  //!< likewise of cur
    int reference{0};                         //!< which of the frames that cur is compared with
    int feature{-1};                          //!< pairs of the same one err together; -1: none

    /** Directions in which the two can disagree. */
    [[nodiscard]] static int dof() { return 3; }
};
}  // namespace pointplane
