// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Parameters.h>
#include <pointplane/sensor/PinholeCamera.h>
#include <pointplane/sensor/RgbdFrame.h>

#include <cstdint>
#include <string>

namespace pointplane
{
/** The simulated camera; each effect has its own switch. The defaults are those of a first
 * generation Kinect. Lengths in pixels are those of a 640 pixel wide image and scale with it;
 * disparities are the sensor's own and do not. */
struct SimulationParams
{
    int width{640};
    int height{480};
    double focalLengthPx{525};
    double focalLengthError{0};
    double principalPointError{0};
    double depthScaleError{0};
    double fps{30};
    double duration{18};
    double startStamp{1500000000};
    double motionScale{1};
    double motionSpeed{1};
    bool motionTurnsOnly{false};
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
    bool mixedPixels{false};
    double lateralSigmaPx{0.6};
    double edgeLossPx{1};
    double shadowBaseline{0.075};
    double maxIncidenceDeg{80};
    double minDepth{0.4};
    double maxDepth{8};

    /** A camera that people own: kinect, d435, azure, phone. Resolution, field of view, rate, depth
     * noise of its kind, shutters. \throws std::invalid_argument naming the cameras */
    [[nodiscard]] static SimulationParams of(const std::string& camera);

    /** The same without noise, blur, gaps or shutter: ground truth in pictures. */
    [[nodiscard]] static SimulationParams ideal(const std::string& camera = "kinect");

    template <class V>
    void visit(V&& v)
    {
        v("width", width, "px", "width of the images");
        v("height", height, "px", "height of the images");
        v("focalLengthPx", focalLengthPx, "px", "focal length of an image 640 px wide");
        v("focalLengthError",
          focalLengthError,
          "-",
          "the stated focal length is off by this fraction (standard deviation over seeds)");
        v("principalPointError",
          principalPointError,
          "px",
          "the stated principal point is off by this, along each axis (standard deviation over "
          "seeds)");
        v("depthScaleError",
          depthScaleError,
          "-",
          "all depths are off by the same fraction (standard deviation over seeds)");
        v("fps", fps, "1/s", "frames a second");
        v("duration", duration, "s", "length of the sequence");
        v("startStamp", startStamp, "s", "time of the first frame, UTC");
        v("motionScale", motionScale, "-", "factor on the hand's motion; 0 = none");
        v("motionSpeed",
          motionSpeed,
          "-",
          "factor on the speed along the same path; 0 = the camera stands still");
        v("motionTurnsOnly",
          motionTurnsOnly,
          "-",
          "true: the camera turns as it would, but stays where it began");
        v("movers", movers, "-", "false: the same scene without what moves in it");
        v("sceneSeed", sceneSeed, "-", "chooses textures and small objects");

        v("readoutColour",
          readoutColour,
          "s",
          "time from the first to the last row of the colour image");
        v("readoutDepth", readoutDepth, "s", "the same of the depth image");
        v("depthDelay",
          depthDelay,
          "s",
          "time from the middle of the colour exposure to that of the depth exposure");
        v("exposure", exposure, "s", "exposure of a colour row, which blurs motion; 0 = no blur");
        v("maxBlurSamples", maxBlurSamples, "-", "most pictures that are averaged for motion blur");

        v("antialias", antialias, "-", "pixels at edges of surfaces are averages of both sides");
        v("lensBlurPx", lensBlurPx, "px", "standard deviation of the lens's blur");
        v("imageNoise", imageNoise, "1/255", "standard deviation of colour noise at mid grey");
        v("light",
          light,
          "-",
          "brightness of the scene, 1 = full; a gain makes up for less, so read-out noise "
          "grows by 1/light and shot noise by its root");
        v("vignetting", vignetting, "-", "how much darker the image's corners are than its centre");
        v("exposureSwing", exposureSwing, "-", "amplitude of slow changes of brightness");

        v("sigmaInverseDepth", sigmaInverseDepth, "1/m", "noise of 1/Z, rounding included");
        v("disparityStepPx",
          disparityStepPx,
          "px",
          "disparities are rounded to multiples of this; 0 = not rounded");
        v("disparityPxMetre",
          disparityPxMetre,
          "px m",
          "disparity times Z: focal length times baseline");
        v("noiseWindowPx",
          noiseWindowPx,
          "px",
          "side of the window over which disparity noise is correlated");
        v("calibrationSigma",
          calibrationSigma,
          "1/m",
          "error of 1/Z that is smooth over the image and the same in every frame");
        v("sigmaDepth", sigmaDepth, "m", "noise of Z that is the same at all depths");
        v("sigmaRelative",
          sigmaRelative,
          "-",
          "error that bends surfaces smoothly, as a fraction of Z; new in every frame");
        v("bendGridPx", bendGridPx, "px", "distance over which surfaces are bent");
        v("upsampling",
          upsampling,
          "px",
          "side of a measured pixel; sigmaDepth is interpolated between measured ones");
        v("mixedPixels",
          mixedPixels,
          "-",
          "true: a measured pixel has the mean depth of what it sees, also at edges");
        v("lateralSigmaPx",
          lateralSigmaPx,
          "px",
          "how far from a pixel its depth is measured (standard deviation)");
        v("edgeLossPx", edgeLossPx, "px", "no depth this near to depth edges; 0 = none is lost");
        v("shadowBaseline",
          shadowBaseline,
          "m",
          "distance from camera to infrared projector, in whose shadow is no depth; 0 = "
          "no shadow");
        v("maxIncidenceDeg",
          maxIncidenceDeg,
          "deg",
          "no depth on surfaces that are seen flatter than this");
        v("minDepth", minDepth, "m", "no depth nearer than this");
        v("maxDepth", maxDepth, "m", "no depth farther than this");
    }

    /** \throws std::invalid_argument naming the key */
    void check() const;

    /** As the recording states it. */
    [[nodiscard]] PinholeCamera camera() const;

    /** Its calibration is off by what the seed draws. */
    [[nodiscard]] PinholeCamera trueCamera(std::uint64_t seed) const;

    /** Factor on all depths, drawn by the seed. */
    [[nodiscard]] double depthScale(std::uint64_t seed) const;

    [[nodiscard]] ShutterModel shutter() const;

    /** Pixels of the image per pixel of one that is 640 wide: lengths in the sensor count in those.
     */
    [[nodiscard]] double pixelScale() const { return width / 640.0; }
};
}  // namespace pointplane
