// SPDX-License-Identifier: BSD-3-Clause
#include "convert_recording.h"

#include <pointplane/core/counted.h>
#include <pointplane/core/quantile.h>
#include <pointplane/mrpt_io/CameraNews.h>
#include <pointplane/mrpt_io/OutputFile.h>
#include <pointplane/mrpt_io/mrpt_poses.h>

#include <opencv2/core.hpp>

#include <algorithm>
#include <iomanip>
#include <iterator>
#include <optional>
#include <ostream>
#include <sstream>

#include "ProgressBar.h"
#include "camera_oddity.h"
#include "stamp_check.h"

namespace pointplane
{
namespace
{
constexpr std::size_t kShown = 5;

/** Of all readings [m]; 0: there are none. */
[[nodiscard]] double medianDepth(const RegisteredScan& scan)
{
    std::vector<std::uint16_t> readings;
    std::copy_if(
        scan.depth.begin<std::uint16_t>(),
        scan.depth.end<std::uint16_t>(),
        std::back_inserter(readings),
        [](std::uint16_t reading) { return reading != 0 && reading != kSaturatedDepth; });
    if (readings.empty())
    {
        return 0;
    }
    return median(std::move(readings)) / scan.unitsPerMetre;
}

/** \throws InputError if nothing was read, or, of strict conversions, if not all was */
void requireUsable(const RecordingSummary& summary, bool strict)
{
    if (summary.numFrames == 0)
    {
        throw InputError(
            !summary.problems.empty() ? summary.problems.front()
            : !summary.damage.empty() ? summary.damage
                                      : "no frame with colour and depth in the recording");
    }
    if (strict && !summary.damage.empty())
    {
        throw InputError(summary.damage);
    }
}

void count(const RecordedFrame& frame, RecordingSummary& out)
{
    out.numWithoutDepth += cv::countNonZero(frame.scan.depth) == 0 ? 1 : 0;
    out.numTooFar += frame.numTooFar;
    out.depth = out.depth > 0 ? out.depth : medianDepth(frame.scan);
    out.camera = out.numFrames == 0 ? oddityOf(frame.scan.camera) : out.camera;
    ++out.numFrames;
}

void count(const BadFrame& bad, RecordingSummary& out)
{
    ++out.numBad;
    if (out.problems.size() < kShown)
    {
        out.problems.push_back(oneLine(bad));
    }
}

/** \throws as convertRecording() */
[[nodiscard]] RecordingSummary writeFrames(
    Recording& recording, const RecordingOutput& output, ScanWriter& writer, std::ostream& progress)
{
    std::optional<ProgressBar> bar;
    if (!output.quiet)
    {
        bar.emplace(progress, standardErrorIsTerminal(), output.path);
    }
    RecordingSummary out;
    CameraNews camera(output.label);
    std::vector<double> stamps;
    for (bool more = true; more;)
    {
        try
        {
            if (const auto frame = recording.next())
            {
                const std::string news = camera.before(frame->depthDelay, frame->isNominal);
                if (!news.empty())
                {
                    writer.writeComment(frame->scan.stamp, news);
                }
                writer.write(frame->scan);
                stamps.push_back(toSeconds(frame->scan.stamp));
                count(*frame, out);
            }
            else
            {
                more = false;
            }
        }
        catch (const BadFrame& bad)
        {
            if (output.strict)
            {
                throw;
            }
            count(bad, out);
        }
        if (bar)
        {
            bar->update(recording.progress(), out.numFrames);
        }
    }
    out.damage = recording.damage();
    requireUsable(out, output.strict);
    out.stamps = problemOfStamps(stamps);
    return out;
}

/** What of the input is not in the output. */
void reportLeftOut(const RecordingSummary& summary, std::ostream& err)
{
    for (const std::string& problem : summary.problems)
    {
        err << "pointplane-convert: left out: " << problem << "\n";
    }
    if (summary.numBad > summary.problems.size())
    {
        err << "pointplane-convert: " << summary.numBad << " frames were left out in all\n";
    }
    if (!summary.damage.empty())
    {
        err << "pointplane-convert: " << summary.damage << "\n";
    }
}
}  // namespace

RecordingSummary convertRecording(
    Recording& recording, const RecordingOutput& output, std::ostream& progress)
{
    ScanWriter writer(output.path, output.label, output.external);
    try
    {
        RecordingSummary out = writeFrames(recording, output, writer, progress);
        writer.close();
        return out;
    }
    catch (const EnvironmentError&)
    {
        throw;  // what was written may be wanted
    }
    catch (...)
    {
        writer.discard();
        throw;
    }
}

int report(
    const RecordingSummary& summary,
    const RecordingOutput& output,
    const std::vector<std::string>& notes,
    std::ostream& standard,
    std::ostream& err)
{
    std::ostream& out = isStandardOutput(output.path) ? err : standard;
    out << output.path << ": " << framesText(summary.numFrames) << "\n";
    for (const std::string& note : notes)
    {
        out << note << "\n";
    }
    if (summary.depth > 0)
    {
        std::ostringstream depth;
        depth << std::setprecision(3) << summary.depth;
        out << "depth: " << depth.str()
            << " m, the median of a frame; if that is wrong, give --depth-scale\n";
    }
    const bool isWithoutDepth = summary.numWithoutDepth == summary.numFrames;
    if (isWithoutDepth)
    {
        err << "pointplane-convert: " << output.path
            << ": no depth reading in any frame; if there are some, give --depth-scale (1000: "
               "millimetres)\n";
    }
    else if (summary.numWithoutDepth > 0)
    {
        out << "depth: no reading in " << framesText(summary.numWithoutDepth) << "\n";
    }
    if (summary.numTooFar > 0)
    {
        out << "depth: " << counted(summary.numTooFar, "reading")
            << " beyond 16 m left out, which floating point can hold and a rawlog cannot\n";
    }
    if (!summary.camera.empty())
    {
        err << "pointplane-convert: " << output.path << ": the camera is odd: " << summary.camera
            << "; if that is wrong, give --camera\n";
    }
    if (!summary.stamps.empty())
    {
        out << "stamps: " << summary.stamps << "\n";
    }
    reportLeftOut(summary, err);
    return summary.numBad == 0 && summary.damage.empty() && !isWithoutDepth ? kExitOk
                                                                            : kExitIncomplete;
}
}  // namespace pointplane
