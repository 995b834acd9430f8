// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Parameters.h>
#include <pointplane/sensor/PinholeCamera.h>
#include <pointplane/sensor/RgbdFrame.h>

#include <string>

namespace pointplane
{
/** The simulated camera; each effect has its own switch. The defaults are those of a first
 * generation Kinect. Lengths in pixels are those of a 640 pixel wide image and scale with it. */
struct SimulationParams
{
    int width{640};
    int height{480};
    double focalLengthPx{525};
    double fps{30};
    double duration{18};
    double startStamp{1500000000};
    double motionScale{1};
    double motionSpeed{1};
    bool movers{true};
    int sceneSeed{1};

    double readoutColour{0.8 / 30};
    double readoutDepth{0.8 / 30};
    double depthDelay{-0.010};
    double exposure{0.010};
    int maxBlurSamples{8};

    bool antialias{true};
    double lensBlurPx{0.5};
    double imageNoise{1.5};
    double light{1};
    double vignetting{0.15};
    double exposureSwing{0};

    double sigmaInverseDepth{1.4e-3};
    double disparityStepPx{0.125};
    double disparityPxMetre{43.5};
    double noiseWindowPx{9};
    double calibrationSigma{0};
    double sigmaDepth{0};
    double sigmaRelative{0};
    double bendGridPx{100};
    int upsampling{1};
    double lateralSigmaPx{0.6};
    double edgeLossPx{1};
    double shadowBaseline{0.075};
    double maxIncidenceDeg{80};
    double minDepth{0.4};
    double maxDepth{8};

    /** A camera without noise, blur, gaps or shutter: ground truth in pictures. */
    [[nodiscard]] static SimulationParams ideal();

    /** A camera that people own: kinect, d435, azure, phone. Resolution, field of view, rate, depth
     * noise of its kind, shutters. \throws std::invalid_argument naming the cameras */
    [[nodiscard]] static SimulationParams of(const std::string& camera);

    template <class V>
    void visit(V&& v)
    {
        v("width", width, "px", "of the images");
        v("height", height, "px", "of the images");
        v("focalLengthPx", focalLengthPx, "px", "of an image 640 px wide");
        v("fps", fps, "1/s", "frames a second");
        v("duration", duration, "s", "of the sequence");
        v("startStamp", startStamp, "s", "UTC of the first frame");
        v("motionScale", motionScale, "-", "multiplies the hand's motion");
        v("motionSpeed", motionSpeed, "-", "how much faster the camera goes along the same path");
        v("movers", movers, "-", "false: the same scene without what moves in it");
        v("sceneSeed", sceneSeed, "-", "chooses textures and small objects");

        v("readoutColour", readoutColour, "s", "first to last row of the colour image");
        v("readoutDepth", readoutDepth, "s", "first to last row of the depth image");
        v("depthDelay", depthDelay, "s", "middle of the depth exposure minus colour's");
        v("exposure", exposure, "s", "of a colour row: motion blur; 0 = none");
        v("maxBlurSamples", maxBlurSamples, "-", "pictures averaged for motion blur, at most");

        v("antialias", antialias, "-", "pixels at edges of surfaces are averages");
        v("lensBlurPx", lensBlurPx, "px", "standard deviation of the lens's blur");
        v("imageNoise", imageNoise, "1/255", "standard deviation of colour noise at mid grey");
        v("light",
          light,
          "-",
          "share of the light that the gain makes up for: shot noise grows by its root, read-out "
          "noise by itself");
        v("vignetting", vignetting, "-", "loss of brightness in the corners");
        v("exposureSwing", exposureSwing, "-", "amplitude of slow changes of brightness");

        v("sigmaInverseDepth", sigmaInverseDepth, "1/m", "noise of 1/Z, quantisation included");
        v("disparityStepPx", disparityStepPx, "px", "disparities are multiples of it; 0 = none");
        v("disparityPxMetre", disparityPxMetre, "px m", "focal length x baseline: disparity x Z");
        v("noiseWindowPx", noiseWindowPx, "px", "window over which disparity noise is correlated");
        v("calibrationSigma",
          calibrationSigma,
          "1/m",
          "error of 1/Z, smooth over the image and the same in every frame");
        v("sigmaDepth", sigmaDepth, "m", "noise of Z that does not depend on it");
        v("sigmaRelative",
          sigmaRelative,
          "-",
          "error of Z over Z that bends surfaces smoothly, new in every frame");
        v("bendGridPx", bendGridPx, "px", "over which surfaces are bent");
        v("upsampling",
          upsampling,
          "-",
          "pixels per measured one, along each side: sigmaDepth is interpolated between them");
        v("lateralSigmaPx", lateralSigmaPx, "px", "from which neighbour a pixel gets its depth");
        v("edgeLossPx", edgeLossPx, "px", "no depth this near to depth edges; 0 = all kept");
        v("shadowBaseline",
          shadowBaseline,
          "m",
          "from camera to infrared projector: no depth in its shadow; 0 = none");
        v("maxIncidenceDeg", maxIncidenceDeg, "deg", "no depth on surfaces seen flatter than that");
        v("minDepth", minDepth, "m", "no depth nearer than that");
        v("maxDepth", maxDepth, "m", "no depth farther than that");
    }

    /** \throws std::invalid_argument naming the key */
    void check() const;

    [[nodiscard]] PinholeCamera camera() const;
    [[nodiscard]] ShutterModel shutter() const;
};
}  // namespace pointplane
