// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/types.h>
#include <pointplane/pose/InlierRatio.h>
#include <pointplane/pose/pairs.h>

#include <map>
#include <vector>

namespace pointplane
{
/** How much the reference frames contradict each other: how far the features of each draw the pose
 * away from where all together put it (docs/theory.md, Noise of features). */
struct Disagreement
{
    double observed{0};  //!< squared distance, in units of the covariances
    double expected{0};  //!< if errors are as claimed and independent; 0 = nothing to compare
};

/** How an estimate of pose (left perturbation, in the previous frame) and velocity changes with
 * what it was made from, to first order. Rows: [translation; rotation; velocity], in m, rad, m/s,
 * rad/s. */
struct Sensitivity
{
    /** Change with the pose of each reference frame (left perturbation in the previous frame) and
     * with its body velocity, by which its features were moved (rolling shutter). In
     * docs/theory.md, section Window: H^-1 H_r and D_r. */
    std::map<int, Matrix12d> references;
    /** The part of that by points, for the references that have some: H^-1 H_P,r, and of D_r. */
    std::map<int, Matrix12d> referencePoints;
    /** Change if all points, or all planes, of the current frame moved (left perturbation in the
     * previous frame): -H^-1 H_P and -H^-1 H_C. */
    Matrix126d pointsMoved{Matrix126d::Zero()}, planesMoved{Matrix126d::Zero()};
    /** Change with the prior's mean, in the order of MotionPrior::residual(): H^-1 H_0. */
    Matrix12d prior{Matrix12d::Zero()};
    /** Covariance by the noise of the current frame's points and planes, as propagated: without the
     * noise factors and without the errors of the references. S_P and S_C. */
    Matrix12d points{Matrix12d::Zero()}, planes{Matrix12d::Zero()};
    /** Change with errors of the camera, which all features share: B. */
    MotionByCamera camera{MotionByCamera::Zero()};
    /** Change with the scale of depth in each patch of the current image: C, */
    MotionByPatches patches{MotionByPatches::Zero()};
    /** and of the references: C_r. */
    std::map<int, MotionByPatches> referencePatches;
};

/** What the residuals say of the camera's errors, once pose and velocity have been eliminated
 * (Schur complement): half of the cost has the slope gradient + information * error. */
struct CameraInformation
{
    CameraMatrix information{CameraMatrix::Zero()};
    CameraVector gradient{CameraVector::Zero()};  //!< of half of the cost
};

/** How large residuals against one reference are. */
struct ReferenceVariance
{
    int reference;
    double variance;
    double dof;  //!< how much it counts: dimensions less those that poses follow, or patches
};

/** How large the residuals of planes are. */
struct PlaneResiduals
{
    /** Over the propagated variance, of the references whose residuals tell it. */
    std::vector<ReferenceVariance> references;
    /** Part of the features' information that comes from planes, in the direction in which it is
     * smallest; 1: nothing but planes tells of the pose. */
    double followed{1};
};

/** What a solution tells besides the motion. */
struct PoseAnalysis
{
    Sensitivity sensitivity;
    CameraInformation camera;
    /** The same by each reference with a motion of its own, averaged over the references: poses of
     * references that were estimated with a wrong camera would confirm it. */
    CameraInformation cameraByReference;
    /** Change of the gradient of `camera` with the velocity of each reference, by which its
     * features were moved (rolling shutter). */
    std::map<int, CameraByVelocity> cameraByVelocity;
    /** Variance of the residuals of points that count, over the propagated one; 0 = none. */
    double pointVariance{0};
    double planeVariance{0};  //!< the same of all planes
    PlaneResiduals planeResiduals;
    /** Variance of the scale of depth in a patch of an image, as the points' residuals show it. */
    std::vector<ReferenceVariance> patchResiduals;
    Disagreement pointDisagreement;  //!< of the references' points, with all other features
    Disagreement planeDisagreement;  //!< of their planes, likewise
    /** Variance of a turn about an axis, as points tell it: harmonic mean over axes, by the
     * propagated noise alone [rad^2]; 0 = no points. */
    double turnVariance{0};
    /** How far the parts of the image pull the pose apart: mean square of their pulls, over what
     * the propagated noise explains; 0 = too few parts to compare. A part is a cell of the view
     * with its points, or a plane. Where noise is all, it is the variance of the residuals. It is
     * larger where neighbours err together, as by blur, by a shutter in jerky motion, or by bent
     * depth (Liang and Zeger 1986, the variance of clustered data). */
    double scatter{0};
    std::vector<double> pointWeights, planeWeights;  //!< of the pairs: 1 = counts fully
    std::vector<InlierRatio> surfaces;  //!< PoseProblem::surfaces, plus this frame's points
};
}  // namespace pointplane
