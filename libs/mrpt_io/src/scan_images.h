// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/PinholeCamera.h>

#include <mrpt/math/CMatrixDynamic.h>

#include <opencv2/core/mat.hpp>

#include <stdexcept>
#include <string>

namespace pointplane
{
/** Why a frame cannot be used; caught in convert(). */
class FrameProblem : public std::runtime_error
{
 public:
    using std::runtime_error::runtime_error;
};

/** \throws FrameProblem unless the condition is met */
void requireUsable(bool condition, const std::string& problem);

/** Why T is no pose of a camera, or empty: those of damaged files may be any numbers. */
[[nodiscard]] std::string problemOfPose(const Eigen::Isometry3d& T, const std::string& name);

/** @name Images of a scan as the odometry takes them
 * @{ */

/** CV_8UC1. \param image of 8 or 16 bit, grey, BGR or BGRA
 * \param bits that its camera has used of 16, kFewestBits at first: grows to 10, 12, 14 or 16
 * \throws FrameProblem */
[[nodiscard]] cv::Mat grayOf(const cv::Mat& image, int& bits);
constexpr int kFewestBits = 8;

/** CV_32FC1, NaN = no reading. \param raw readings; 0 and kSaturatedDepth are none */
[[nodiscard]] cv::Mat depthInMetres(const mrpt::math::CMatrix_u16& raw, float units);

/** Distances along the rays to distances along the optical axis. */
void rangesToDepths(const PinholeCamera& camera, cv::Mat& depth);
/** @} */
}  // namespace pointplane
