// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/mrpt_poses.h>

#include <mrpt/vision/CDifodo.h>

#include <cmath>

#include "methods.h"

namespace pointplane
{
namespace
{
constexpr unsigned int kStep = 2;       //!< of the full image: what the pyramid starts from
constexpr unsigned int kCoarsest = 20;  //!< columns of the coarsest level
constexpr float kMaxDepth = 4.5F;       //!< [m] as in MRPT's DifOdometry-Datasets
using Matrices = std::vector<mrpt::math::CMatrixFloat>;

/** MRPT's CDifodo as its DifOdometry-Datasets runs it. Depth only; x forward, y left, z up. */
class Difodo : public mrpt::vision::CDifodo
{
 public:
    Difodo(unsigned int width, unsigned int height)
    {
        cam_mode = 1;
        downsample = kStep;
        rows = height;
        cols = width;
        m_width = 640 / kStep;
        m_height = 480 / kStep;
        // The fast one indexes a 4x4 matrix with [], which MRPT 2.5.8 forbids at run time.
        fast_pyramid = false;
        fps = 30;
        unsigned int numLevels = 1;
        while (m_width >> numLevels >= kCoarsest)
        {
            ++numLevels;
        }
        ctf_levels = numLevels - static_cast<unsigned int>(std::lround(std::log2(m_width / cols)));
        for (Matrices* pyramid :
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
            pyramid->resize(numLevels);
            for (unsigned int i = 0; i < numLevels; ++i)
            {
                (*pyramid)[i].setZero(m_height >> i, m_width >> i);
            }
        }
        transformations.assign(numLevels, mrpt::math::CMatrixFloat(4, 4));
        depth_wf.setZero(m_height, m_width);
    }

    /** The camera's principal point is moved to the middle of the image, where DIFODO has it. */
    void setFrame(const RgbdFrame& frame)
    {
        const PinholeCamera& c = frame.camera;
        // Not setFOV(): declared inline, defined in no header.
        fovh = static_cast<float>(2 * std::atan(0.5 * c.width / c.fx));
        fovv = static_cast<float>(2 * std::atan(0.5 * c.height / c.fy));
        const double step = static_cast<double>(c.width) / m_width;
        for (unsigned int i = 0; i < m_height; ++i)
        {
            const int v = static_cast<int>(std::lround(c.cy - step * (i - 0.5 * (m_height - 1.0))));
            for (unsigned int j = 0; j < m_width; ++j)
            {
                const int u =
                    static_cast<int>(std::lround(c.cx - step * (j - 0.5 * (m_width - 1.0))));
                const bool isInside = u >= 0 && v >= 0 && u < c.width && v < c.height;
                const float z = isInside ? frame.depth.at<float>(v, u) : 0.0F;
                depth_wf(static_cast<int>(i), static_cast<int>(j)) = z < kMaxDepth ? z : 0.0F;
            }
        }
    }
    void loadFrame() override {}
    void start() { buildCoordinatesPyramid(); }
};

class DifodoMethod : public Method
{
 public:
    explicit DifodoMethod(unsigned int width) : difodo_(width, width * 3 / 4) {}
    MethodStep process(const RgbdFrame& frame) override
    {
        difodo_.setFrame(withYDown(frame));
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
        const Eigen::Isometry3d motion = T_body_cam.inverse() * last_.inverse() * pose * T_body_cam;
        last_ = pose;
        if (motion.matrix().allFinite())
        {
            out.T_prev_cur = motion;
        }
        else
        {
            out.outcome = Outcome::Lost;
        }
        return out;
    }

 private:
    Difodo difodo_;
    Eigen::Isometry3d last_{Eigen::Isometry3d::Identity()};
    bool first_{true};
};
}  // namespace

NamedMethod difodoMethod(int width)
{
    return {"DIFODO " + std::to_string(width) + "x" + std::to_string(width * 3 / 4), true, [width] {
                return std::make_unique<DifodoMethod>(static_cast<unsigned int>(width));
            }};
}
}  // namespace pointplane
