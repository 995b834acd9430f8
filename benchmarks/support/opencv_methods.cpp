// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <opencv2/rgbd.hpp>

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
    MethodStep process(const RgbdFrame& raw) override
    {
        const RgbdFrame frame = withYDown(raw);
        const PinholeCamera& c = frame.camera;
        const cv::Mat K = (cv::Mat_<double>(3, 3) << c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1);
        odometry_->setCameraMatrix(K);
        cv::Mat gray = frame.gray;
        if (c.isDistorted())
        {
            gray = cv::Mat();
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
}  // namespace

NamedMethod openCvMethod(const std::string& type)
{
    return {"OpenCV " + type, true, [type] { return std::make_unique<OpenCvMethod>(type); }};
}

std::vector<NamedMethod> peerMethods()
{
    return {
        openCvMethod("RgbdOdometry"),
        openCvMethod("ICPOdometry"),
        openCvMethod("RgbdICPOdometry"),
        difodoMethod(160),
        difodoMethod(320)};
}

RgbdFrame withYDown(const RgbdFrame& frame)
{
    if (frame.camera.fy > 0)
    {
        return frame;
    }
    RgbdFrame out = frame;
    out.camera.fy = -frame.camera.fy;
    out.camera.cy = frame.camera.height - 1 - frame.camera.cy;
    out.gray = cv::Mat();
    out.depth = cv::Mat();
    cv::flip(frame.gray, out.gray, 0);
    cv::flip(frame.depth, out.depth, 0);
    return out;
}
}  // namespace pointplane
