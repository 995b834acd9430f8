// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/types.h>
#include <pointplane/pose/pairs.h>

#include <map>
#include <vector>

namespace pointplane
{
/** How far groups of features, those of each reference frame, draw the pose away from where all
 * together put it. */
struct Disagreement
{
    double observed{0};  //!< squared, in units of the covariances
    double expected{0};  //!< were errors as claimed and independent; 0 = nothing to compare
};

/** On what an estimate of pose (left perturbation) and velocity depends, to first order. */
struct Sensitivity
{
    /** By reference frame: change of the estimate with a change of that frame's pose (left
     * perturbation in the previous frame). */
    std::map<int, Matrix126d> references;
    /** Change with that of the prior's mean, in the order of MotionPrior::residual(). */
    Matrix12d prior{Matrix12d::Zero()};
    /** Covariance that comes from the current frame's points and planes, as propagated: without
     * the noise factors, and without the references' own errors. */
    Matrix12d points{Matrix12d::Zero()}, planes{Matrix12d::Zero()};
    /** Change with errors of the camera, by which all features err together. */
    MotionByCamera camera{MotionByCamera::Zero()};
};

/** What the residuals say of the camera's errors once pose and velocity have been eliminated (Schur
 * complement): to first order, they are gradient + information * change. */
struct CameraInformation
{
    CameraMatrix information{CameraMatrix::Zero()};
    CameraVector gradient{CameraVector::Zero()};  //!< of half of the cost
};

/** How far a feature is from where the estimate puts it, and what the current frame's noise makes
 * of that. With a noise of w times the propagated covariance for features of its own kind, w_points
 * for all points and w_planes for all planes, the mean of r^T curCov^-1 r / 3 is
 * own * w + ofPoints * w_points + ofPlanes * w_planes. */
struct FeatureResidual
{
    int reference{0}, inReference{-1};                //!< as in the pair
    Eigen::Vector3d r{0, 0, 0};                       //!< in the previous frame [m] or [1/m]
    Eigen::Matrix3d curCov{Eigen::Matrix3d::Zero()};  //!< of the current feature, in r
    double own{1};       //!< below 1: the estimate follows the feature and takes a part away
    double ofPoints{0};  //!< by what all points move the estimate
    double ofPlanes{0};  //!< by what all planes move it
    double weight{1};    //!< robust, 1: counts fully, 0: not at all
};

/** What can be learnt from a solution beside the motion. */
struct PoseAnalysis
{
    Sensitivity sensitivity;
    CameraInformation camera;
    double pointVariance{0};  //!< of points over the propagated one, from the median; 0 = none
    double planeVariance{0};  //!< of planes, likewise
    Disagreement pointDisagreement;  //!< of the references' points, with all other features
    Disagreement planeDisagreement;  //!< of their planes, likewise
    std::vector<FeatureResidual> pointResiduals, planeResiduals;  //!< of the pairs
};
}  // namespace pointplane
