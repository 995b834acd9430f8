// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/mrpt_poses.h>

#include <mrpt/vision/CDifodo.h>

#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <opencv2/rgbd.hpp>

#include <cmath>

#include "methods.h"

namespace pointplane
{
namespace
{
/** src = current and dst = previous, so that Rt is T_prev_cur. */
class OpenCvMethod : public Method
{
 public:
    explicit OpenCvMethod(const std::string& type) : odometry_(cv::rgbd::Odometry::create(type)) {}
    MethodStep process(const RgbdFrame& frame) override
    {
        const PinholeCamera& c = frame.camera;
        const cv::Mat K = (cv::Mat_<double>(3, 3) << c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1);
        odometry_->setCameraMatrix(K);
        cv::Mat gray = frame.gray;
        if (c.isDistorted())
        {
            cv::undistort(frame.gray, gray, K, c.distortion);
        }
        auto current =
            cv::rgbd::OdometryFrame::create(gray, frame.depth.clone(), frame.depth == frame.depth);
        MethodStep out;
        if (previous_)
        {
            cv::Mat Rt;
            if (odometry_->compute(current, previous_, Rt) && !Rt.empty())
            {
                Eigen::Matrix4d T;
                cv::cv2eigen(Rt, T);
                motion_.matrix() = T;
            }
            else
            {
                out.outcome = Outcome::Lost;
            }
            out.T_prev_cur = motion_;
        }
        previous_ = current;
        return out;
    }

 private:
    cv::Ptr<cv::rgbd::Odometry> odometry_;
    cv::Ptr<cv::rgbd::OdometryFrame> previous_;
    Eigen::Isometry3d motion_{Eigen::Isometry3d::Identity()};
};

/** Depth only; x forward, y left, z up. Ignores the principal point. */
class Difodo : public mrpt::vision::CDifodo
{
 public:
    Difodo(unsigned int width, unsigned int height)
    {
        constexpr unsigned int kCoarsestWidth = 20;
        cam_mode = 640 / width;
        downsample = 1;
        rows = height;
        cols = width;
        m_width = width;
        m_height = height;
        fast_pyramid = true;
        fps = 30;
        ctf_levels = 1;
        while ((width >> ctf_levels) >= kCoarsestWidth)
        {
            ++ctf_levels;
        }
        for (auto* pyramid :
             {&depth,
              &depth_old,
              &depth_inter,
              &depth_warped,
              &xx,
              &xx_inter,
              &xx_old,
              &xx_warped,
              &yy,
              &yy_inter,
              &yy_old,
              &yy_warped})
        {
            pyramid->resize(ctf_levels);
            for (unsigned int i = 0; i < ctf_levels; ++i)
            {
                (*pyramid)[i].setZero(height >> i, width >> i);
            }
        }
        transformations.assign(ctf_levels, mrpt::math::CMatrixFloat(4, 4));
        depth_wf.setZero(height, width);
    }
    void setFrame(const RgbdFrame& frame)
    {
        const PinholeCamera& c = frame.camera;
        // Not setFOV(): declared inline, defined in no header.
        fovh = static_cast<float>(2 * std::atan(0.5 * c.width / c.fx));
        fovv = static_cast<float>(2 * std::atan(0.5 * c.height / std::abs(c.fy)));
        const int step = c.width / static_cast<int>(cols);
        for (int v = 0; v < static_cast<int>(rows); ++v)
        {
            for (int u = 0; u < static_cast<int>(cols); ++u)
            {
                const float z =
                    frame.depth.at<float>(c.height - step * v - 1, c.width - step * u - 1);
                depth_wf(v, u) = std::isfinite(z) ? z : 0.0F;
            }
        }
    }
    void loadFrame() override {}
    void start() { buildCoordinatesPyramidFast(); }
};

class DifodoMethod : public Method
{
 public:
    explicit DifodoMethod(unsigned int width) : difodo_(width, width * 3 / 4) {}
    MethodStep process(const RgbdFrame& frame) override
    {
        difodo_.setFrame(frame);
        MethodStep out;
        if (first_)
        {
            difodo_.start();
            first_ = false;
            return out;
        }
        difodo_.odometryCalculation();
        const Eigen::Matrix4d now =
            difodo_.cam_pose.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen();
        const Eigen::Isometry3d pose(now);
        const Eigen::Isometry3d T_body_cam = opticalInBody();
        out.T_prev_cur = T_body_cam.inverse() * last_.inverse() * pose * T_body_cam;
        last_ = pose;
        if (!out.T_prev_cur.matrix().allFinite())
        {
            out = {Outcome::Lost, Eigen::Isometry3d::Identity(), {}};
        }
        return out;
    }

 private:
    Difodo difodo_;
    Eigen::Isometry3d last_{Eigen::Isometry3d::Identity()};
    bool first_{true};
};
}  // namespace

std::vector<NamedMethod> peerMethods()
{
    std::vector<NamedMethod> out;
    for (const char* type : {"RgbdOdometry", "ICPOdometry", "RgbdICPOdometry"})
    {
        const std::string name = type;
        out.push_back({"OpenCV " + name, [name] { return std::make_unique<OpenCvMethod>(name); }});
    }
    for (const unsigned int width : {160U, 320U})
    {
        out.push_back(
            {"DIFODO " + std::to_string(width) + "x" + std::to_string(width * 3 / 4),
             [width] { return std::make_unique<DifodoMethod>(width); }});
    }
    return out;
}
}  // namespace pointplane
