// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Plane.h>
#include <pointplane/sensor/PinholeCamera.h>

#include <opencv2/core/mat.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include "monte_carlo.h"

namespace pointplane::test
{
constexpr float kNoDepth = std::numeric_limits<float>::quiet_NaN();

/** A camera of the given size with a Kinect's field of view. \param fySign -1: image y axis up */
inline PinholeCamera kinectCamera(int width = 640, int height = 480, double fySign = 1)
{
    PinholeCamera camera;
    camera.width = width;
    camera.height = height;
    camera.fx = 525.0 * width / 640;
    camera.fy = fySign * camera.fx;
    camera.cx = 0.5 * (width - 1);
    camera.cy = 0.5 * (height - 1);
    return camera;
}

inline Eigen::Vector3d pixelRay(const PinholeCamera& camera, double u, double v)
{
    return {(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1};
}

/** theta_m of the plane through `point` with the given normal, turned to the camera. */
inline Eigen::Vector3d thetaThrough(const Eigen::Vector3d& point, const Eigen::Vector3d& normal)
{
    return -normal / normal.dot(point);
}

/** Depth image whose pixel (u, v) lies on thetas[pick(u, v)]; pick < 0 or a plane that is not in
 * front of the camera: no reading. */
template <class Pick>
cv::Mat renderDepth(
    const PinholeCamera& camera, const std::vector<Eigen::Vector3d>& thetas, const Pick& pick)
{
    cv::Mat depth(camera.height, camera.width, CV_32FC1, cv::Scalar(kNoDepth));
    for (int v = 0; v < depth.rows; ++v)
    {
        for (int u = 0; u < depth.cols; ++u)
        {
            const int i = pick(u, v);
            if (i >= 0)
            {
                const double q = -thetas[static_cast<size_t>(i)].dot(pixelRay(camera, u, v));
                depth.at<float>(v, u) = q > 0 ? static_cast<float>(1 / q) : kNoDepth;
            }
        }
    }
    return depth;
}

/** Which of the planes a pixel sees: the nearest in front. */
inline int nearestPlane(
    const PinholeCamera& camera, const std::vector<Eigen::Vector3d>& thetas, int u, int v)
{
    int best = -1;
    double largest = 0;
    for (size_t i = 0; i < thetas.size(); ++i)
    {
        const double q = -thetas[i].dot(pixelRay(camera, u, v));
        if (q > largest)
        {
            largest = q;
            best = static_cast<int>(i);
        }
    }
    return best;
}

/** The inside of a room whose walls are the given planes. */
inline cv::Mat renderRoom(const PinholeCamera& camera, const std::vector<Eigen::Vector3d>& thetas)
{
    return renderDepth(
        camera, thetas, [&](int u, int v) { return nearestPlane(camera, thetas, u, v); });
}

/** A corner of a room at 2 m: two walls and the floor. */
inline std::vector<Eigen::Vector3d> cornerThetas()
{
    const Eigen::Vector3d corner(0.1, 0.3, 2.4);
    return {
        thetaThrough(corner, Eigen::Vector3d(0.8, 0, -0.6)),
        thetaThrough(corner, Eigen::Vector3d(-0.6, 0, -0.8)),
        thetaThrough(corner, Eigen::Vector3d(0.05, -0.95, -0.3).normalized())};
}

/** Adds independent normal noise to the inverse depth. \param sigma [1/m] */
inline void addInverseDepthNoise(cv::Mat& depth, double sigma, GaussianSampler& sampler)
{
    for (int v = 0; v < depth.rows; ++v)
    {
        for (int u = 0; u < depth.cols; ++u)
        {
            float& z = depth.at<float>(v, u);
            z = static_cast<float>(1 / (1 / static_cast<double>(z) + sigma * sampler.normal()));
        }
    }
}
}  // namespace pointplane::test
