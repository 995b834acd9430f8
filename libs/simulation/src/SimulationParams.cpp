// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/range.h>
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
    checkRange("width", width, 16, 4096);
    checkRange("height", height, 16, 4096);
    checkRange("focalLengthPx", focalLengthPx, 50, 1e4);
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
    checkRange("lateralSigmaPx", lateralSigmaPx, 0, 5);
    checkRange("edgeLossPx", edgeLossPx, 0, 20);
    checkRange("shadowBaseline", shadowBaseline, 0, 1);
    checkRange("maxIncidenceDeg", maxIncidenceDeg, 10, 90);
    checkRange("minDepth", minDepth, 0, 100);
    checkRange("maxDepth", maxDepth, minDepth, 1000);
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
