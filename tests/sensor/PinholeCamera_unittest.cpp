// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/sensor/PinholeCamera.h>

#include <cmath>
#include <limits>

#include "matchers.h"
#include "numeric_jacobian.h"
#include <gtest/gtest.h>

using namespace pointplane;
using namespace pointplane::test;

namespace
{
/** The colour camera of TUM fr1: strongly distorted. */
PinholeCamera distortedCamera()
{
    PinholeCamera camera;
    camera.fx = 517.306408;
    camera.fy = 516.469215;
    camera.cx = 318.643040;
    camera.cy = 255.313989;
    camera.distortion = {{0.262383, -0.953104, -0.005358, 0.002628, 1.163314}};
    return camera;
}

/** ICL-NUIM: image y axis up. */
PinholeCamera upwardCamera()
{
    PinholeCamera camera;
    camera.fx = 481.2;
    camera.fy = -480;
    return camera;
}

template <class F>
void forPixels(const PinholeCamera& camera, F&& f)
{
    for (int v = 0; v < camera.height; v += 37)
    {
        for (int u = 0; u < camera.width; u += 37)
        {
            f(Eigen::Vector2d(u + 0.3, v - 0.2));
        }
    }
}
}  // namespace

TEST(PinholeCamera, projectByHand)
{
    PinholeCamera camera;
    camera.fx = 500;
    camera.fy = 400;
    camera.cx = 320;
    camera.cy = 240;
    EXPECT_THAT(camera.project({1, -0.5, 2}), IsMatrixNear(Eigen::Vector2d(570, 140), 0.0));
    camera.distortion = {{0.1, 0.01, 0.002, -0.003, 0.001}};
    // x = 0.5, y = -0.25, r2 = 0.3125, radial = 1.032257080078125
    const double radial = 1 + 0.1 * 0.3125 + 0.01 * 0.09765625 + 0.001 * 0.030517578125;
    const double x = 0.5 * radial + 2 * 0.002 * -0.125 - 0.003 * (0.3125 + 0.5);
    const double y = -0.25 * radial + 0.002 * (0.3125 + 0.125) + 2 * -0.003 * -0.125;
    EXPECT_THAT(
        camera.project({1, -0.5, 2}),
        IsMatrixNear(Eigen::Vector2d(500 * x + 320, 400 * y + 240), 1e-12));
}

TEST(PinholeCamera, distortionRoundTripOverTheWholeImage)
{
    for (const PinholeCamera& camera : {PinholeCamera{}, distortedCamera(), upwardCamera()})
    {
        forPixels(
            camera,
            [&](const Eigen::Vector2d& uv)
            {
                const Eigen::Vector2d xy = camera.normalised(uv);
                EXPECT_THAT(
                    camera.project(3.7 * Eigen::Vector3d(xy.x(), xy.y(), 1)),
                    IsMatrixNear(uv, 1e-9));
            });
    }
}

TEST(PinholeCamera, jacobianMatchesFiniteDifferences)
{
    for (const PinholeCamera& camera : {distortedCamera(), upwardCamera()})
    {
        forPixels(
            camera,
            [&](const Eigen::Vector2d& uv)
            {
                Eigen::Matrix2d J;
                (void)camera.normalised(uv, &J);
                const auto expected = numericJacobian(
                    [&](const Eigen::Vector2d& p) { return camera.normalised(p); }, uv, 1e-3);
                EXPECT_THAT(J, IsMatrixNear(expected, 1e-8)) << uv.transpose();
            });
    }
}

TEST(PinholeCamera, negativeFyFlipsTheImage)
{
    EXPECT_GT(PinholeCamera{}.normalised({320, 400}).y(), 0);
    EXPECT_LT(upwardCamera().normalised({320, 400}).y(), 0);
    EXPECT_EQ(upwardCamera().problem(), "");
}

TEST(PinholeCamera, depthPixelSeesTheSameRay)
{
    const PinholeCamera camera = distortedCamera();
    forPixels(
        camera,
        [&](const Eigen::Vector2d& uv)
        {
            EXPECT_THAT(
                camera.normalisedOfDepth(camera.depthPixel(uv)),
                IsMatrixNear(camera.normalised(uv), 1e-12));
        });
    EXPECT_GT((camera.depthPixel({20, 20}) - Eigen::Vector2d(20, 20)).norm(), 3);
    EXPECT_THAT(upwardCamera().depthPixel({20, 20}), IsMatrixNear(Eigen::Vector2d(20, 20), 0.0));
}

TEST(PinholeCamera, scaledKeepsRays)
{
    // A pixel's centre c of the full image lies at (c + 1/2) s - 1/2 of the resized one.
    for (const PinholeCamera& camera : {distortedCamera(), upwardCamera()})
    {
        const PinholeCamera half = camera.scaled(0.5);
        EXPECT_EQ(half.width, 320);
        EXPECT_EQ(half.height, 240);
        forPixels(
            camera,
            [&](const Eigen::Vector2d& uv)
            {
                const Eigen::Vector2d small = (uv.array() + 0.5) * 0.5 - 0.5;
                EXPECT_THAT(half.normalised(small), IsMatrixNear(camera.normalised(uv), 1e-12));
            });
    }
}

TEST(PinholeCamera, whereTheDistortionFoldsThereIsNoRay)
{
    // Strong barrel distortion: no ray reaches the corners. A pixel has its ray or none.
    for (const double k1 : {-0.1, -0.3, -0.4, -0.6, -1.0})
    {
        PinholeCamera camera;
        camera.distortion = {{k1, 0, 0, 0, 0}};
        int numRays = 0, numNone = 0;
        forPixels(
            camera,
            [&](const Eigen::Vector2d& uv)
            {
                const Eigen::Vector2d xy = camera.normalised(uv);
                if (xy.allFinite())
                {
                    ++numRays;
                    EXPECT_THAT(camera.project(xy.homogeneous()), IsMatrixNear(uv, 1e-3));
                    EXPECT_LT(xy.squaredNorm(), 1 / (-3 * k1)) << "beyond the fold";
                }
                else
                {
                    ++numNone;
                }
            });
        EXPECT_GT(numRays, 0);
        EXPECT_EQ(numNone > 0, k1 < -0.2) << k1;
    }
}

/** Beyond the fold, the polynomial leads back into the image. */
TEST(PinholeCamera, whereTheDistortionFoldsNothingIsSeen)
{
    PinholeCamera camera{525, 525, 319.5, 239.5, 640, 480};
    camera.distortion = {-0.4, 0, 0, 0, 0};
    EXPECT_TRUE(camera.project({0.8, 0, 1}).allFinite());
    for (const double x : {1.0, 1.5, 2.0, 5.0})
    {
        EXPECT_FALSE(camera.project({x, 0, 1}).allFinite()) << x;
        EXPECT_FALSE(camera.project({0, -x, 1}).allFinite()) << x;
    }
}

TEST(PinholeCamera, problemNamesWhatIsWrong)
{
    using testing::HasSubstr;
    EXPECT_EQ(PinholeCamera{}.problem(), "");
    PinholeCamera camera;
    camera.fx = -525;
    EXPECT_THAT(camera.problem(), HasSubstr("negative"));
    camera.fx = 0.5;
    EXPECT_THAT(camera.problem(), HasSubstr("too short"));
    camera.fx = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THAT(camera.problem(), HasSubstr("not finite"));
    camera = {};
    camera.distortion[4] = std::numeric_limits<double>::infinity();
    EXPECT_THAT(camera.problem(), HasSubstr("not finite"));
    camera = {};
    camera.fy = 0;
    EXPECT_THAT(camera.problem(), HasSubstr("focal length is zero"));
    camera = {};
    camera.height = 0;
    EXPECT_THAT(camera.problem(), HasSubstr("640x0"));
    for (const auto& [cx, cy] :
         {std::pair{0.0, 240.0},
          {320.0, 0.0},
          {640.0, 240.0},
          {5000.0, 1.0},
          {320.0, 480.0},
          {320.0, -1e9}})
    {
        camera = {};
        camera.cx = cx;
        camera.cy = cy;
        EXPECT_THAT(camera.problem(), HasSubstr("principal point is outside of the image (cx="));
        EXPECT_THAT(camera.problem(), HasSubstr("image 640x480)"));
    }
    camera.cx = 1;  // of an image that has been cropped
    camera.cy = 479;
    EXPECT_EQ(camera.problem(), "");
}
