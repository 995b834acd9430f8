// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/simulation/SimulationParams.h>

namespace pointplane
{
SimulationParams SimulationParams::ideal()
{
    SimulationParams p;
    p.readoutColour = p.readoutDepth = p.depthDelay = p.exposure = 0;
    p.lensBlurPx = p.imageNoise = p.vignetting = p.exposureSwing = 0;
    p.sigmaInverseDepth = p.disparityStepPx = p.lateralSigmaPx = p.calibrationSigma = 0;
    p.edgeLossPx = p.shadowBaseline = 0;
    p.maxIncidenceDeg = 90;
    p.minDepth = 0.05;
    p.maxDepth = 100;
    return p;
}

void SimulationParams::check() const
{
    const auto inRange = [](const char* key, double value, double low, double high)
    {
        POINTPLANE_CHECK(
            value >= low && value <= high,
            key << " = " << value << " is not in [" << low << ", " << high << "]");
    };
    inRange("width", width, 16, 4096);
    inRange("height", height, 16, 4096);
    inRange("focalLengthPx", focalLengthPx, 50, 1e4);
    inRange("fps", fps, 0.1, 1000);
    inRange("duration", duration, 0, 36000);
    inRange("startStamp", startStamp, 0, 1e10);
    inRange("motionScale", motionScale, 0, 10);
    inRange("motionSpeed", motionSpeed, 0, 100);
    inRange("sceneSeed", sceneSeed, 0, 1e9);
    inRange("readoutColour", readoutColour, 0, 1);
    inRange("readoutDepth", readoutDepth, 0, 1);
    inRange("depthDelay", depthDelay, -1, 1);
    inRange("exposure", exposure, 0, 1);
    inRange("maxBlurSamples", maxBlurSamples, 1, 100);
    inRange("lensBlurPx", lensBlurPx, 0, 10);
    inRange("imageNoise", imageNoise, 0, 50);
    inRange("light", light, 1e-4, 1);
    inRange("vignetting", vignetting, 0, 0.9);
    inRange("exposureSwing", exposureSwing, 0, 0.9);
    inRange("sigmaInverseDepth", sigmaInverseDepth, 0, 0.1);
    inRange("disparityStepPx", disparityStepPx, 0, 10);
    inRange("disparityPxMetre", disparityPxMetre, 1, 1e4);
    inRange("noiseWindowPx", noiseWindowPx, 1, 64);
    inRange("calibrationSigma", calibrationSigma, 0, 0.1);
    inRange("lateralSigmaPx", lateralSigmaPx, 0, 5);
    inRange("edgeLossPx", edgeLossPx, 0, 20);
    inRange("shadowBaseline", shadowBaseline, 0, 1);
    inRange("maxIncidenceDeg", maxIncidenceDeg, 10, 90);
    inRange("minDepth", minDepth, 0, 100);
    inRange("maxDepth", maxDepth, minDepth, 1000);
}

PinholeCamera SimulationParams::camera() const
{
    PinholeCamera out;
    const double scale = width / 640.0;
    out.width = width;
    out.height = height;
    out.fx = out.fy = focalLengthPx * scale;
    out.cx = 0.5 * (width - 1);
    out.cy = 0.5 * (height - 1);
    return out;
}

ShutterModel SimulationParams::shutter() const { return {readoutColour, readoutDepth, depthDelay}; }
}  // namespace pointplane
