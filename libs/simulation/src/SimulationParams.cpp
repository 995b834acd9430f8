// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/core/choice.h>
#include <pointplane/core/range.h>
#include <pointplane/simulation/Random.h>
#include <pointplane/simulation/SimulationParams.h>

namespace pointplane
{
SimulationParams SimulationParams::ideal(const std::string& camera)
{
    SimulationParams p = of(camera);
    p.readoutColour = p.readoutDepth = p.depthDelay = p.exposure = 0;
    p.lensBlurPx = p.imageNoise = p.vignetting = p.exposureSwing = 0;
    p.sigmaInverseDepth = p.disparityStepPx = p.lateralSigmaPx = p.calibrationSigma = 0;
    p.focalLengthError = p.principalPointError = p.depthScaleError = 0;
    p.sigmaDepth = p.sigmaRelative = 0;
    p.upsampling = 1;
    p.mixedPixels = false;
    p.edgeLossPx = p.shadowBaseline = 0;
    p.maxIncidenceDeg = 90;
    p.minDepth = 0.05;
    p.maxDepth = 100;
    return p;
}

namespace
{
/** Streams of random numbers. */
constexpr std::uint64_t kCalibrationPurpose = 0xca11b, kDepthScalePurpose = 0x5ca1e;

/** Active stereo, 848x480, f = 424 px at that width (not decimated: disparities are of it), b = 50
 * mm; 0.08 px rms of disparity in 1/32 px (Keselman et al. 2017; Intel's data sheet 337029). The
 * infrared cameras have a global shutter. */
void makeD435(SimulationParams& p)
{
    p.width = 848;
    p.height = 480;
    p.focalLengthPx = 424.0 * 640 / 848;
    p.disparityPxMetre = 424 * 0.05;
    p.disparityStepPx = 1.0 / 32;
    p.sigmaInverseDepth = 0.08 / p.disparityPxMetre;
    p.noiseWindowPx = 7;
    p.shadowBaseline = 0.05;
    p.readoutColour = 0.016;
    p.readoutDepth = 0;
    p.depthDelay = 0;
    p.minDepth = 0.2;
    p.maxDepth = 10;
}

/** Without what comes of matching a pattern. */
void makeTimeOfFlight(SimulationParams& p)
{
    p.sigmaInverseDepth = p.disparityStepPx = p.shadowBaseline = 0;
    p.readoutDepth = p.depthDelay = 0;
    p.mixedPixels = true;
}

/** Time of flight, 320x288 (narrow, binned) enlarged to 640x576, 75 deg; 1.5 mm of noise and 0.3 %
 * of what calibration and several paths of light bend (Tolgyessy et al. 2021). */
void makeAzure(SimulationParams& p)
{
    makeTimeOfFlight(p);
    p.width = 640;
    p.height = 576;
    p.focalLengthPx = 417;
    p.sigmaDepth = 0.0015;
    p.sigmaRelative = 0.003;
    p.upsampling = 2;
    p.lateralSigmaPx = 0.3;
    p.readoutColour = 0.016;
    p.minDepth = 0.25;
    p.maxDepth = 5.5;
}

/** LiDAR, 256x192 enlarged to 640x480 by the phone, which smooths the noise and bends surfaces by
 * half a per cent; 66 deg. */
void makePhone(SimulationParams& p)
{
    makeTimeOfFlight(p);
    p.focalLengthPx = 490;
    p.sigmaDepth = 0.002;
    p.sigmaRelative = 0.005;
    p.upsampling = 3;
    p.lateralSigmaPx = 1;
    p.edgeLossPx = 0;
    p.readoutColour = 0.020;
    p.exposure = 0.008;
    p.minDepth = 0.15;
    p.maxDepth = 5;
}
}  // namespace

SimulationParams SimulationParams::of(const std::string& camera)
{
    using Make = void (*)(SimulationParams&);
    SimulationParams out;
    chosen<Make>(
        "camera",
        camera,
        {{"kinect", [](SimulationParams&) {}},
         {"d435", makeD435},
         {"azure", makeAzure},
         {"phone", makePhone}})(out);
    return out;
}

void SimulationParams::check() const
{
    checkRange("width", width, 16, 4096);
    checkRange("height", height, 16, 4096);
    checkRange("focalLengthPx", focalLengthPx, 50, 1e4);
    checkRange("focalLengthError", focalLengthError, 0, 0.1);
    checkRange("principalPointError", principalPointError, 0, 50);
    checkRange("depthScaleError", depthScaleError, 0, 0.1);
    checkRange("fps", fps, 0.1, 1000);
    checkRange("duration", duration, 0, 36000);
    checkRange("startStamp", startStamp, 0, 1e10);
    checkRange("motionScale", motionScale, 0, 10);
    checkRange("motionSpeed", motionSpeed, 0, 100);
    checkRange("sceneSeed", sceneSeed, 0, 1e9);
    checkRange("readoutColour", readoutColour, 0, 1);
    checkRange("readoutDepth", readoutDepth, 0, 1);
    checkRange("depthDelay", depthDelay, -1, 1);
    checkRange("exposure", exposure, 0, 1);
    checkRange("maxBlurSamples", maxBlurSamples, 1, 100);
    checkRange("lensBlurPx", lensBlurPx, 0, 10);
    checkRange("imageNoise", imageNoise, 0, 50);
    checkRange("light", light, 1e-4, 1);
    checkRange("vignetting", vignetting, 0, 0.9);
    checkRange("exposureSwing", exposureSwing, 0, 0.9);
    checkRange("sigmaInverseDepth", sigmaInverseDepth, 0, 0.1);
    checkRange("disparityStepPx", disparityStepPx, 0, 10);
    checkRange("disparityPxMetre", disparityPxMetre, 1, 1e4);
    checkRange("noiseWindowPx", noiseWindowPx, 1, 64);
    checkRange("calibrationSigma", calibrationSigma, 0, 0.1);
    checkLength("sigmaDepth", sigmaDepth, 0, 0.5);
    checkRange("sigmaRelative", sigmaRelative, 0, 0.2);
    checkRange("bendGridPx", bendGridPx, 4, 1000);
    checkRange("upsampling", upsampling, 1, 16);
    checkRange("lateralSigmaPx", lateralSigmaPx, 0, 5);
    checkRange("edgeLossPx", edgeLossPx, 0, 20);
    checkRange("shadowBaseline", shadowBaseline, 0, 1);
    checkRange("maxIncidenceDeg", maxIncidenceDeg, 10, 90);
    checkLength("minDepth", minDepth, 0, 10);
    checkLength("maxDepth", maxDepth, minDepth, 200);
    POINTPLANE_CHECK(
        height <= width || (readoutColour == 0 && readoutDepth == 0),
        "height = " << height << " is more than width = " << width
                    << ": upright images have columns for lines, which are not simulated; set "
                       "readoutColour and readoutDepth to 0");
}

PinholeCamera SimulationParams::camera() const
{
    PinholeCamera out;
    const double scale = pixelScale();
    out.width = width;
    out.height = height;
    out.fx = out.fy = focalLengthPx * scale;
    out.cx = 0.5 * (width - 1);
    out.cy = 0.5 * (height - 1);
    return out;
}

PinholeCamera SimulationParams::trueCamera(std::uint64_t seed) const
{
    PinholeCamera out = camera();
    Random random({seed, kCalibrationPurpose});
    const double focal = 1 + focalLengthError * random.gaussian();
    out.fx *= focal;
    out.fy *= focal;
    out.cx += principalPointError * width / 640.0 * random.gaussian();
    out.cy += principalPointError * width / 640.0 * random.gaussian();
    return out;
}

double SimulationParams::depthScale(std::uint64_t seed) const
{
    return 1 + depthScaleError * Random({seed, kDepthScalePurpose}).gaussian();
}

ShutterModel SimulationParams::shutter() const { return {readoutColour, readoutDepth, depthDelay}; }
}  // namespace pointplane
