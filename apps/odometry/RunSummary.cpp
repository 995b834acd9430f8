// SPDX-License-Identifier: BSD-3-Clause
#include "RunSummary.h"

#include <pointplane/core/counted.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/mrpt_poses.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ostream>

#include "mostly_predicted.h"
#include "stamp_check.h"

namespace pointplane
{
namespace
{
void addTimes(const FrameDiagnostics& frame, FrameDiagnostics& sum)
{
    sum.msPoints += frame.msPoints;
    sum.msPlanes += frame.msPlanes;
    sum.msMatching += frame.msMatching;
    sum.msPose += frame.msPose;
    sum.msTotal += frame.msTotal;
}
}  // namespace

void RunSummary::add(const OutputItem& item)
{
    const RobotMotion& motion = item.frame->motion;
    ++numFrames;
    // Also of lost frames: a stamp that repeats the one before may be why. Some have none.
    if (const double stamp = item.source.converted->frame.stamp; std::isfinite(stamp))
    {
        stamps.push_back(stamp);
    }
    hasMotion = hasMotion || motion.status == TrackingStatus::Tracked;
    switch (motion.status)
    {
        case TrackingStatus::First:
        case TrackingStatus::Tracked:
            ++numTracked;
            inPart.add(item);
            break;
        case TrackingStatus::Predicted:
            ++numPredicted;
            untracked.add(item);
            break;
        case TrackingStatus::Lost:
            ++numLost;
            untracked.add(item);
            break;
    }
    if (attachedShare == 0)
    {
        firstAttached = item.source.frameIndex;
    }
    attachedShare = std::max(attachedShare, motion.diagnostics.attachedShare);
    pathLength += motion.increment.mean.norm();
    const FrameDiagnostics& d = motion.diagnostics;
    addTimes(d, sum);
    if (isMeasured(motion.status))
    {
        if (d.lens.isContradicted && !firstContradicted)
        {
            firstContradicted = item.source.frameIndex;
        }
        sum.depthNoise = d.depthNoise;
        sum.lens = d.lens;
        lensPrior = lensPrior.cwiseMax(d.lens.sigmas);
    }
}

/** Where the motion told less than was known before, nothing was learnt. */
LearntLens RunSummary::learntLens() const
{
    constexpr double kLearnt = 0.7;  // of the standard deviation: as much information again
    LearntLens out = sum.lens;
    out.sigmas = (out.sigmas.array() < kLearnt * lensPrior.array()).select(out.sigmas, 0);
    return out;
}

double RunSummary::perFrame(double total) const
{
    return total / static_cast<double>(std::max<std::size_t>(1, numFrames));
}

void RunSummary::printFrames(std::ostream& out) const
{
    const bool isFirstAlone = numFrames == 1 && numTracked == 1 && !hasMotion;
    out << (label.empty() ? "camera ''" : label) << ": " << framesText(numFrames);
    if (isFirstAlone)
    {
        out << ", the first: nothing to compare it with";
    }
    else
    {
        const std::size_t numInPart = inPart.number(numTracked);
        out << ": " << numTracked << " tracked"
            << (numInPart == 0 ? "" : " (" + std::to_string(numInPart) + " in part)") << ", "
            << numPredicted << " predicted, " << numLost << " lost";
    }
    char line[256];
    std::snprintf(
        line,
        sizeof(line),
        "; path %.3f m; %.1f ms/frame (odometry %.1f), %.1f fps\n",
        pathLength,
        perFrame(1e3 * seconds),
        perFrame(sum.msTotal),
        static_cast<double>(std::max<std::size_t>(1, numFrames)) / std::max(seconds, 1e-9));
    out << line;
}

void RunSummary::printAttached(std::ostream& out) const
{
    if (attachedShare > 0)
    {
        char line[256];
        std::snprintf(
            line,
            sizeof(line),
            "  from frame %zu on, up to %.0f %% of the view moved with the camera: left out as a "
            "part of the robot; until then it may have misled the poses (--mask leaves it out from "
            "the start)\n",
            firstAttached,
            100 * attachedShare);
        out << line;
    }
}

void RunSummary::printCalibration(std::ostream& out) const
{
    if (firstContradicted)
    {
        out << "  after frame " << *firstContradicted
            << ", the intrinsics were taken for nominal: the images do not fit them; until then "
               "they may have misled the poses (calibrate the camera, or give --set "
               "Lens.nominal=true)\n";
    }
}

void RunSummary::printStamps(std::ostream& out) const
{
    if (const std::string problem = problemOfStamps(stamps); !problem.empty())
    {
        out << "stamps: " << problem << "\n";
    }
}

void RunSummary::printLearnt(std::ostream& out) const
{
    if (numTracked > 0)
    {
        out << "depth noise: " << describe(sum.depthNoise) << "\n";
    }
    if (const std::string lens = describe(learntLens()); hasMotion && !lens.empty())
    {
        out << "lens, learnt from the motion: " << lens << "\n";
    }
}

void RunSummary::printTimes(std::ostream& out) const
{
    char line[256];
    std::snprintf(
        line,
        sizeof(line),
        "ms/frame: points %.2f, planes %.2f, matching %.2f, pose %.2f, total %.2f\n",
        perFrame(sum.msPoints),
        perFrame(sum.msPlanes),
        perFrame(sum.msMatching),
        perFrame(sum.msPose),
        perFrame(sum.msTotal));
    out << line;
}

void RunSummary::print(std::ostream& out, bool profile) const
{
    printFrames(out);
    untracked.print(out);
    inPart.print(out, numTracked);
    printAttached(out);
    printCalibration(out);
    for (const std::string& note : notes)
    {
        out << note << "\n";
    }
    printStamps(out);
    printLearnt(out);
    if (profile)
    {
        printTimes(out);
    }
    for (const std::string& output : outputs)
    {
        out << output << "\n";
    }
}

void RunSummary::printProblems(std::ostream& err) const
{
    if (numLost > 0)
    {
        const std::string first = untracked.firstLost();
        err << "pointplane-odometry: " << numLost << " of " << framesText(numFrames)
            << " could not be used" << (first.empty() ? "" : ", first " + first) << "\n";
    }
    if (isMostlyUnmeasured() && numPredicted > 0)
    {
        err << kMostlyPredicted << numTracked << " of " << framesText(numFrames)
            << " tracked; the summary says why the others were not\n";
    }
    if (!damage.empty())
    {
        err << "pointplane-odometry: " << damage << "\n";
    }
}

int RunSummary::exitCode() const
{
    return damage.empty() && numLost == 0 && !isMostlyUnmeasured() ? kExitOk : kExitIncomplete;
}

bool RunSummary::isMostlyUnmeasured() const
{
    return (numPredicted > 0 && !hasMotion) || 2 * numTracked < numFrames;
}
}  // namespace pointplane
